"""Films of the integrator `odis`: splats as those of Mitsuba's `path`, and samples that count in one pixel."""

import unittest
from types import SimpleNamespace

import numpy as np
import test_mitsuba as base

try:
    import mitsuba as mi
    from odis.mitsuba.arrays import array_of
    from odis.mitsuba.film import SplatFilm
except ImportError as missing:
    raise unittest.SkipTest(f"Mitsuba does not run here: {missing}")

FILTERS = ("box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos")
SIZE, SEEDS = 32, 16
CROP = {"crop_width": 40, "crop_height": 6, "crop_offset_x": 5, "crop_offset_y": 1}


def glow(radiance):
    return {"type": "area", "radiance": {"type": "rgb", "value": radiance}}


def orthographic(film, **shapes):
    """Shapes in parallel projection, where -1 to 1 is the width of the picture."""
    sensor = {"type": "orthographic", "film": {"type": "hdrfilm", **film},
              "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0])}
    return mi.load_dict({"type": "scene", "sensor": sensor, **shapes})


def square(x, y, half_width, radiance):
    to_world = mi.ScalarTransform4f().translate([x, y, 0]).scale(half_width)
    return {"type": "rectangle", "to_world": to_world, "emitter": glow(radiance)}


def images(scene, first, spp, kind="odis", **parameters):
    """Of SEEDS seeds, by one integrator."""
    integrator = mi.load_dict({"type": kind, **parameters})
    return np.array([np.array(mi.render(scene, integrator=integrator, spp=spp, seed=first + i)) for i in range(SEEDS)],
                    np.float64)


def z_scores(ours, theirs):
    """Differences of the means over seeds, in standard errors."""
    error = np.sqrt(sum(values.var(0, ddof=1) / SEEDS for values in (ours, theirs)))
    return (ours.mean(0) - theirs.mean(0)) / np.maximum(error, 1e-6)


class Splat(unittest.TestCase):
    def compare(self, ours, theirs, most):
        z = z_scores(ours, theirs)
        self.assertLess(np.abs(z).max(), most, z)

    def test_constant_image(self):
        """With all filters, at borders and corners, also of a crop with samples beyond the border."""
        for rfilter in FILTERS:
            for more in ({}, {**CROP, "sample_border": True}):
                scene = orthographic({"width": 48, "height": 8, "rfilter": {"type": rfilter}, **more},
                                     wall=square(0, 0, 20, 0.7))
                image = base.render(scene, "odis", 1, 4, max_depth=1)
                self.assertEqual(image.shape, (6, 40, 3) if more else (8, 48, 3))
                # Sums of four samples and their weights are rounded, with `path` as well.
                np.testing.assert_allclose(image, 0.7, rtol=0, atol=1e-6, err_msg=f"{rfilter} {more}")

    def test_weights(self):
        """Where pixels left of an edge have half as many samples and those right of it three times as many, the picture
        is that of the filter; weights that are known only after the pass count as others do."""
        width, height, spp = 16, 64, 64
        for later in (False, True):
            film = SplatFilm(mi.load_dict({"type": "hdrfilm", "width": width, "height": height,
                                           "rfilter": {"type": "tent"}}))
            right = np.tile(np.arange(width) >= width // 2, height)
            counts = np.where(right, 3 * spp, spp // 2).astype(np.uint32)
            pixel = np.repeat(np.arange(counts.size, dtype=np.uint32), counts)
            number = np.concatenate([np.arange(count, dtype=np.uint32) for count in counts])
            result = np.where(right[pixel], 0.8, 0.1).astype(np.float32)[:, None].repeat(4, axis=1)
            frame = SimpleNamespace(known=not later)
            frame.sample_weights = lambda pixel, number: (spp if frame.known else 0) / counts[pixel]
            film.begin_pass(frame, SimpleNamespace(weights_later=later), 0 * counts, counts)
            film.add(mi.UInt64(7), SimpleNamespace(pixel=array_of(mi.UInt32, pixel), number=array_of(mi.UInt32, number),
                                                   result=array_of(mi.Float, result)))
            frame.known = True
            film.end_pass(frame)
            sums = np.array(film.image(frame))
            # The means over rows; an eighth of a tent lies beyond the pixel's own border.
            expected = np.where(np.arange(width) < width // 2, 0.1, 0.8)
            expected[width // 2 - 1] += 0.7 / 8
            expected[width // 2] -= 0.7 / 8
            self.assertEqual(sums.shape, (height, width, 4))
            np.testing.assert_allclose(sums[2:-2, 2:-2, 3].mean(0), spp, rtol=0.03)
            np.testing.assert_allclose((sums[..., 0] / sums[..., 3]).mean(0), expected, rtol=0, atol=0.005)

    def test_edges_as_path_has_them(self):
        """Pixel by pixel, where pixels have different numbers of samples, and in crops and with samples beyond the
        border, where what lies beside the picture is bright."""
        edges = {"inside": square(-0.7, 0.05, 0.105, 1.0), "beside": square(-2.0, 0, 1.0, 4.0)}
        for rfilter, more in (("tent", {}), ("gaussian", {"sample_border": True}), ("mitchell", CROP),
                              ("lanczos", {**CROP, "sample_border": True})):
            with self.subTest(rfilter):
                scene = orthographic({"width": 48, "height": 8, "rfilter": {"type": rfilter}, **more}, **edges)
                integrator = mi.load_dict({"type": "odis", "max_depth": 1})
                mi.render(scene, integrator=integrator, spp=64)
                self.assertGreater(integrator.frame.sample_counts().std(), 0)
                ours, theirs = (images(scene, first, 64, kind, max_depth=1)[..., 0]
                                for first, kind in ((0, "odis"), (1000, "path")))
                # 384 pixels at most; |t| > 6 with 30 degrees of freedom: 1 in 700,000.
                self.compare(ours, theirs, 6.0)

    def test_means_of_a_room(self):
        """Both films and `path`, by 16 blocks."""
        scene = base.box()
        scene["sensor"]["film"] |= {"rfilter": {"type": "gaussian"}}
        scene = mi.load_dict(scene)
        means = [np.array([base.blocks(image) for image in images(scene, first, 64, kind, max_depth=6, **film)])
                 for first, kind, film in ((0, "odis", {"film": "splat"}), (500, "odis", {"film": "pixels"}),
                                           (1000, "path", {}))]
        # |t| > 5 with 30 degrees of freedom: 2 in 100,000.
        self.compare(means[0], means[1], 5.0)
        self.compare(means[0], means[2], 5.0)

    def test_less_noise(self):
        scene = base.box()
        scene["sensor"]["film"] |= {"rfilter": {"type": "tent"}}
        scene = mi.load_dict(scene)
        splat, pixels = (images(scene, 0, 16, max_depth=4, film=film).var(0, ddof=1).mean()
                         for film in ("splat", "pixels"))
        # A sample counts 2.25 times, but for the pixels at the border.
        self.assertLess(splat, pixels / 1.7)

    def test_alpha(self):
        """That of `path`, pixel by pixel, where emitters are hidden as well."""
        for hidden in (False, True):
            film = {"width": 12, "height": 12, "rfilter": {"type": "gaussian"}, "pixel_format": "rgba"}
            diffuse = {"type": "rectangle", "to_world": mi.ScalarTransform4f().translate([0.4, -0.2, 0]).scale(0.43)}
            scene = orthographic(film, lamp=square(-0.5, 0.5, 0.31, 2.0), plain=diffuse)
            ours, theirs = (images(scene, first, 64, kind, max_depth=3, hide_emitters=hidden)
                            for first, kind in ((0, "odis"), (1000, "path")))
            self.assertEqual(ours.shape, (SEEDS, 12, 12, 4))
            self.assertGreater(ours[..., 3].mean(), 0.1)
            self.compare(ours[..., 3], theirs[..., 3], 6.0)

    def test_same_seed(self):
        """Sums may differ in their last bits, decisions may not."""
        scene = base.box()
        scene["sensor"]["film"] |= {"rfilter": {"type": "gaussian"}}
        scene = mi.load_dict(scene)
        integrator, found, counts = mi.load_dict({"type": "odis", "max_depth": 4}), [], []
        for _ in range(2):
            found.append(np.array(mi.render(scene, integrator=integrator, spp=16, seed=3)))
            counts.append(integrator.frame.sample_counts())
        np.testing.assert_array_equal(*counts)
        np.testing.assert_allclose(*found, rtol=1e-5, atol=1e-7)

    def test_aovs_beside_it(self):
        """The film divides them by the weights, as it does the colours."""
        scene = orthographic({"width": 8, "height": 6, "rfilter": {"type": "mitchell"}}, wall=square(0, 0, 20, 0.7))
        image = base.render(scene, "odis", 1, 8, max_depth=1, aovs="d:depth")
        # From the near plane, at .01.
        np.testing.assert_allclose(image, np.broadcast_to([0.7, 0.7, 0.7, 4.99], image.shape), rtol=1e-5)


class Pixels(unittest.TestCase):
    def test_noise_of_neighbours_is_independent(self):
        """Of an even picture, by the correlation of pixels side by side over all of them and all seeds."""
        scene = base.box()
        scene["sensor"]["film"] |= {"rfilter": {"type": "gaussian"}}
        scene = mi.load_dict(scene)
        correlations = []
        for film in ("pixels", "splat"):
            noise = images(scene, 0, 8, max_depth=3, film=film)[..., 1]
            noise = (noise - noise.mean(0)) / noise.std(0).clip(1e-6)
            correlations.append((noise[:, :, 1:] * noise[:, :, :-1]).mean())
        # The standard error is .01 for 16,000 pairs.
        self.assertLess(abs(correlations[0]), 0.04)
        self.assertGreater(correlations[1], 0.3)

    def test_a_box_filter_leaves_no_choice(self):
        scene = mi.load_dict(base.box())
        np.testing.assert_array_equal(*(base.render(scene, "odis", 2, 8, film=film) for film in ("splat", "pixels")))


if __name__ == "__main__":
    unittest.main()
