"""The integrator `odis` against Mitsuba's `path`, on scenes made here. Skipped where Mitsuba does not run."""

import unittest
from types import SimpleNamespace

import made_up
import numpy as np
import odis

try:
    import drjit as dr
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    dr.eval(mi.Float(1) + dr.opaque(mi.Float, 1))
    import odis.mitsuba
    from odis.mitsuba import guide_tables, materials, recording
    from odis.mitsuba.arrays import array_of
    from odis.mitsuba.random_numbers import hash_seed, numbers_of
    from odis.mitsuba.settings import GivenSettings
except (ImportError, AttributeError, RuntimeError) as missing:
    raise unittest.SkipTest(f"Mitsuba does not run here: {missing}")

SIZE, BLOCKS, SEEDS = 32, 4, 12


def box(**changes):
    scene = mi.cornell_box()
    scene["sensor"]["film"] = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}}
    scene["large-box"]["bsdf"] = {"type": "plastic", "diffuse_reflectance": {"type": "rgb", "value": [0.3, 0.4, 0.6]}}
    scene["small-box"]["bsdf"] = {"type": "roughconductor", "alpha": 0.2}
    del scene["integrator"]
    scene.update(changes)
    return scene


def blocks(image):
    return np.asarray(image, np.float64).reshape(BLOCKS, SIZE // BLOCKS, BLOCKS, SIZE // BLOCKS, -1).mean((1, 3, 4))


def render(scene, kind, seed, spp, **parameters):
    return np.array(mi.render(scene, integrator=mi.load_dict({"type": kind, **parameters}), spp=spp, seed=seed))


def z_scores(scene, spp=64, odis_alone={}, **parameters):
    """Differences between `odis` and `path` in the means of blocks over seeds, in standard errors; and these errors,
    relative to the means."""
    ours = mi.load_dict({"type": "odis", **parameters, **odis_alone})
    path = mi.load_dict({"type": "path", **parameters})
    means = [np.array([blocks(np.array(mi.render(scene, integrator=one, spp=spp, seed=first + i))[..., :3])
                       for i in range(SEEDS)]) for one, first in ((ours, 0), (path, 1000))]
    error = np.sqrt(sum(m.var(0, ddof=1) / SEEDS for m in means))
    difference = means[0].mean(0) - means[1].mean(0)
    return difference / np.maximum(error, 1e-6), error / means[1].mean(0)


class Unbiased(unittest.TestCase):
    ODIS = {}  # parameters of `odis` that `path` does not have

    def compare(self, scene, spp=64, **parameters):
        """Tests of the means of 16 blocks and three colours over seeds: by chance one fails in some 400 such images."""
        z, error = z_scores(scene, spp, self.ODIS, **parameters)
        # |t| > 5 with 22 degrees of freedom: 5 in 100,000.
        self.assertLess(np.abs(z).max(), 5.0, z)
        self.assertLess(np.median(error), 0.02)

    def test_plastic_metal_and_one_light(self):
        self.compare(mi.load_dict(box()), max_depth=6)

    def test_many_lights_and_an_environment(self):
        lamps = {f"lamp{i}": {"type": "sphere", "radius": 0.03, "center": [-0.8 + 0.4 * i, -0.9, 0.5],
                              "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 2.0 + 3 * i}}}
                 for i in range(5)}
        self.compare(mi.load_dict(box(sky={"type": "constant", "radiance": 0.3}, **lamps)), max_depth=5)

    def test_glass_and_transmission(self):
        scene = box()
        scene["large-box"]["bsdf"] = {"type": "dielectric"}
        scene["small-box"]["bsdf"] = {"type": "roughdielectric", "alpha": 0.3}
        self.compare(mi.load_dict(scene), max_depth=6)


class PixelMaps(Unbiased):
    """The preset `paper`, with histograms at pixels in place of the network, which not every build has."""

    ODIS = {"preset": "paper", "settings": "pixel-maps=histogram pixel-tile=2"}

    def compare(self, scene, spp=64, **parameters):
        self.assertGreater(len(self.guide_of(scene).pixel_cells), 0)
        super().compare(scene, spp, **parameters)

    def guide_of(self, scene):
        integrator = mi.load_dict({"type": "odis", **self.ODIS})
        mi.render(scene, integrator=integrator, spp=4)
        guide = integrator.frame.guide
        # First vertices alone are guided: there are no cells but those of pixels.
        self.assertEqual(len(guide), (guide.pixel_cells != odis.NO_CELL).any() and guide.pixel_cells[
            guide.pixel_cells != odis.NO_CELL].max() + 1)
        return guide


class OtherDecisions(unittest.TestCase):
    """Settings under which kernels decide otherwise."""

    def test_first_bounce_alone_and_roulette_by_throughput(self):
        settings = "guide-bounces=1 roulette=throughput shadow-rays=all lights=hierarchy samples=even"
        z, error = z_scores(mi.load_dict(box()), odis_alone={"settings": settings}, max_depth=12, rr_depth=2)
        self.assertLess(np.abs(z).max(), 5.0, z)  # as of Unbiased
        self.assertLess(np.median(error), 0.02)

    def test_fewer_guided_bounces_change_the_image(self):
        scene = mi.load_dict(box())
        images = [render(scene, "odis", 0, 8, max_depth=6, settings=f"guide-bounces={count}") for count in (-1, 5, 1)]
        np.testing.assert_array_equal(images[0], images[1])
        self.assertGreater(np.abs(images[0] - images[2]).max(), 0)


class Cached(unittest.TestCase):
    def test_means_rays_and_noise(self):
        """Cached radiance moves the image little, and leaves fewer rays and less noise, with a finite depth as well."""
        changed = box()
        changed["sensor"]["film"] |= {"width": 3 * SIZE, "height": 3 * SIZE}  # so that cells know enough
        scene = mi.load_dict(changed)
        for max_depth in (-1, 12):
            images, rays = {}, {}
            for cached in (False, True):
                # In so few pixels it would not pay to refine what cells know.
                integrator = mi.load_dict({"type": "odis", "cached": cached, "settings": "guided-cost=0",
                                           "max_depth": max_depth, "rr_depth": 5 if max_depth < 0 else 1000})
                images[cached] = np.array([np.array(mi.render(scene, integrator=integrator, spp=16, seed=seed))[..., :3]
                                           for seed in range(4)], np.float64)
                rays[cached] = integrator.rays
            self.assertLess(rays[True], 0.9 * rays[False])
            self.assertLess(images[True].var(0).mean(), images[False].var(0).mean())
            self.assertAlmostEqual(images[True].mean() / images[False].mean(), 1, delta=0.01)

    def test_what_is_seen_through_is_no_coat(self):
        inside = {"type": "diffuse"}
        flags = [materials.describe(mi.load_dict(bsdf))[0] & (materials.HAS_DELTA | materials.SEES_THROUGH) for bsdf in (
            inside, {"type": "plastic"}, {"type": "mask", "opacity": 0.5, "inside": inside}, {"type": "dielectric"})]
        through = materials.HAS_DELTA | materials.SEES_THROUGH
        self.assertEqual(flags, [0, materials.HAS_DELTA, through, through])

    def test_short_paths_are_not_cached(self):
        scene = mi.load_dict(box())
        images = [render(scene, "odis", 0, 8, max_depth=7, cached=cached) for cached in (False, True)]
        np.testing.assert_array_equal(*images)

    def test_recorded_paths_end_with_it(self):
        """Of two paths, with one and two vertices, the second one ends with cached radiance; no emission is met."""
        recorder = recording.make_recorder(8)
        row = recording.new_row(recorder, mi.Bool([True, True, True]))
        previous = mi.UInt32([recording.NO_ROW, recording.NO_ROW, int(row[1])])
        zero, one = dr.zeros(mi.Float, 3), dr.ones(mi.Float, 3)
        recording.write(recorder, row, 1, [zero] * 4 + [one / 2] * 3 + [one], True)  # weight
        recording.write(recorder, row, 2, [one, zero, zero] + [zero] * 5, True)  # direct
        recording.write(recorder, row, 4, [one] * 4 + [zero, recording.bits(previous)], True)
        recording.write(recorder, row, 5, [zero] * 6, True)
        dr.eval(recorder)
        recording.complete_paths(recorder, mi.UInt32([int(row[0]), int(row[2])]),
                                 mi.Float([0, 0, 0, 4, 8, 16]), mi.UInt32([2, 4]))
        radiance = np.array(recorder.completions).reshape(-1, recording.PACKET)[np.array(row), :3]
        np.testing.assert_allclose(radiance, [[0, 0, 0], [1 + 4 / 2, 8 / 2, 16 / 2], [4, 8, 16]])


class Settings(unittest.TestCase):
    def cells(self, spp, text="", preset="default", cached=False):
        lights = SimpleNamespace(groups=0, parts=[])
        options = GivenSettings.read(preset, text).frame_options((8, 8), spp, 0, lights, cached, -1)
        return int(odis.read_setting(options.settings, "cells"))

    def test_few_samples_have_fewer_cells(self):
        self.assertEqual([self.cells(spp) for spp in (1, 4, 7, 8, 64)], [24, 24, 24, 32, 32])
        self.assertEqual(self.cells(4, cached=True), 32)

    def test_what_is_given_wins(self):
        self.assertEqual(self.cells(4, "cells=64"), 64)
        self.assertEqual(self.cells(4, preset="paper"), 0)


class Images(unittest.TestCase):
    def test_same_seed_same_bits(self):
        scene = mi.load_dict(box())
        np.testing.assert_array_equal(render(scene, "odis", 3, 8), render(scene, "odis", 3, 8))

    def test_other_seed_other_samples(self):
        # Seeds that differ in few bits must not share random numbers.
        scene = mi.load_dict(box())
        a, b = (render(scene, "odis", seed, 16) for seed in (0, 1))
        noise = [image - (a + b) / 2 for image in (a, b)]
        self.assertGreater(np.abs(noise[0]).mean(), 0.001)

    def test_seeds_share_no_random_numbers(self):
        pixel = dr.arange(mi.UInt32, 4096)
        first = [np.array(numbers_of(mi.UInt64(hash_seed(seed)), pixel, mi.UInt32(0)).key) for seed in range(4)]
        self.assertGreater(np.unique(np.concatenate(first)).size, 4 * 4096 - 4)

    def test_alpha_and_filter(self):
        scene = box()
        scene["sensor"]["film"] = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "pixel_format": "rgba",
                                   "rfilter": {"type": "gaussian"}}
        del scene["back"]
        scene = mi.load_dict(scene)
        splat, pixels, theirs = (
            np.mean([render(scene, kind, seed, 64, max_depth=3, **film) for seed in range(4)], axis=0)
            for kind, film in (("odis", {"film": "splat"}), ("odis", {"film": "pixels"}), ("path", {})))
        for ours in (splat, pixels):
            self.assertEqual(ours.shape, theirs.shape)
            self.assertLess(np.abs(ours[..., 3] - theirs[..., 3])[2:-2, 2:-2].max(), 0.15)
            self.assertLess(np.abs((ours - theirs).mean((0, 1))).max(), 0.02)

    def test_without_emitters(self):
        scene = box()
        del scene["light"]
        self.assertEqual(np.abs(render(mi.load_dict(scene), "odis", 0, 4)).max(), 0)

    def test_several_scenes_at_once(self):
        """Virtual calls are compiled for the objects of all scenes that exist."""
        picture = {"type": "bitmap", "data": mi.TensorXf(np.ones((4, 4, 3), np.float32)), "raw": True}
        screen = {"type": "rectangle", "emitter": {"type": "area", "radiance": picture}}
        plain, textured = mi.load_dict(box()), mi.load_dict(box(screen=screen))
        for scene in (plain, textured, plain):
            ours, theirs = (render(scene, kind, 0, 64, max_depth=3).mean() for kind in ("odis", "path"))
            self.assertAlmostEqual(ours / theirs, 1, delta=0.05)

    def test_hidden_emitters(self):
        scene = mi.load_dict(box())
        ours, theirs = (render(scene, kind, 0, 64, hide_emitters=True, max_depth=1) for kind in ("odis", "path"))
        np.testing.assert_array_equal(ours, theirs)


class Errors(unittest.TestCase):
    def test_arguments(self):
        """What `render` and `guide` are handed is refused in their own words."""
        scene = mi.load_dict(box())
        guide, render = odis.mitsuba.guide, odis.mitsuba.guide(scene).render
        spoiled = odis.mitsuba.guide(scene)
        spoiled.progress = 3
        for call, expected in (
                (lambda: guide("scene.xml"), "guide: expected a mi.Scene, found a str; .*load_file"),
                (lambda: guide(box()), "guide: expected a mi.Scene, found a dict; mi.load_dict"),
                (lambda: guide(None), "guide: expected a mi.Scene, found a NoneType"),
                (lambda: guide(scene, max_dept=3), "no parameter max_dept; expected one of max_depth"),
                (lambda: guide(scene, max_depth="3"), "max_depth: expected -1"),
                (lambda: guide(scene, rr_depth=0), "^odis: rr_depth: expected a whole number from 1"),
                (lambda: guide(scene, hide_emitters=1), "hide_emitters: expected true or false, found 1"),
                (lambda: guide(scene, settings=["cells=3"]), "settings: expected a string"),
                (lambda: guide(scene, aovs="foo"), "^odis: aovs: expected NAME:TYPE .* types are albedo, depth"),
                (lambda: render(scene, seed=-1), "seed: expected a whole number from 0 to 4294967295, found -1"),
                (lambda: render(scene, seed=2**32), "seed: expected"), (lambda: render(scene, seed=1.5), "seed: expected"),
                (lambda: render(scene, seed=mi.UInt32([1, 2])), "seed: expected"),
                (lambda: render(scene, spp=-1), "spp: expected a whole number from 0 to 2147483647, found -1"),
                (lambda: render(scene, spp=2.5), "spp: expected"),
                (lambda: render(scene, 1), "sensor: expected a mi.Sensor or the number of one of the scene's 1, found 1"),
                (lambda: render(scene, None), "sensor: expected"),
                (lambda: render("scene.xml"), "render: expected a mi.Scene"),
                (lambda: spoiled.render(scene), "progress: expected a function")):
            with self.assertRaisesRegex((TypeError, ValueError), expected):
                call()
        mi.set_variant("scalar_rgb")
        self.addCleanup(mi.set_variant, "llvm_ad_rgb")
        with self.assertRaisesRegex(TypeError, "^odis: guide: expected a mi.Scene, found a str"):
            guide("scene.xml")
        with self.assertRaisesRegex(RuntimeError, "^odis: expected a variant that compiles kernels"):
            guide(mi.load_dict({"type": "scene"}))

    def test_gradients(self):
        scene = mi.load_dict(box())
        integrator, parameters = odis.mitsuba.guide(scene, max_depth=2), mi.traverse(scene)
        key = next(key for key in parameters.keys() if key.endswith("reflectance.value"))
        dr.enable_grad(parameters[key])
        parameters.update()
        for differentiate in (lambda: dr.backward(dr.sum(mi.render(scene, parameters, integrator=integrator, spp=1).array)),
                              lambda: dr.forward_to(mi.render(scene, parameters, integrator=integrator, spp=1))):
            with self.assertRaisesRegex(RuntimeError, "has no gradients"):
                differentiate()

    def test_parameters(self):
        for parameters, expected in (({"max_depth": -2}, "max_depth: expected"), ({"rr_depth": 0}, "rr_depth: expected"),
                                     ({"max_dept": 3}, "max_dept"),
                                     ({"preset": "papre"}, "preset: expected one of default, paper, paper-fast"),
                                     ({"film": "spalt"}, "film: expected one of splat, pixels, found spalt"),
                                     ({"film": True}, "film: expected a string, found True"),
                                     ({"cached": "no"}, "cached: expected true or false, found no"),
                                     ({"settings": "cells"}, 'found "cells", expected name=value'),
                                     ({"settings": "cels=3"}, 'there is no setting "cels". Did you mean cells?'),
                                     ({"settings": "refine=1 cells=1.5"}, 'cells: found "1.5", expected a whole number from 0 '
                                      "to 65536"),
                                     ({"settings": "map-floor=2"}, 'map-floor: found "2", expected a number from 0 to 1'),
                                     ({"settings": "map-floor=nan"}, 'map-floor: found "nan", expected a number'),
                                     ({"settings": "lights=all"}, 'lights: found "all", expected one of network.formula.hierarchy'),
                                     ({"settings": "prior-samples=1:2:3"}, 'prior-samples: found "1:2:3", expected four numbers'),
                                     ({"settings": "guide=oracle"}, "there is no oracle in Mitsuba")):
            with self.assertRaisesRegex(Exception, expected):
                mi.load_dict({"type": "odis", **parameters})


class Maps(unittest.TestCase):
    """The kernels' look-ups against the library's own."""

    def setUp(self):
        vertices = made_up.vertices(20000)
        builder = odis.GuideBuilder(odis.GuideOptions())
        builder.add(vertices)
        self.guide = builder.build()
        self.tables = guide_tables.make_guide_tables(self.guide)

    def places(self, count):
        random = np.random.default_rng(5)
        position = random.random((count, 3), np.float32)
        position[:, 2] = 0
        return position, np.tile(np.array([0, 0, 1], np.float32), (count, 1))

    def test_cells(self):
        position, normal = self.places(2000)
        found = guide_tables.find_cell(self.tables, mi.Point3f(position.T), mi.Vector3f(normal.T), True)
        expected = self.guide.find_cells(position, normal)
        # Places on the border of two cells may be rounded to either.
        self.assertLess((np.array(found) != expected).mean(), 0.005)
        in_media = guide_tables.find_cell(self.tables, mi.Point3f(position.T), mi.Vector3f(0), True)
        np.testing.assert_array_equal(np.array(in_media), odis.NO_CELL)

    def test_what_is_no_number(self):
        """Places that are huge or no numbers lie in no cell; such directions have some place in tables."""
        bad = array_of(mi.Float, np.array([np.nan, np.inf, -np.inf, 1e30, -1e30], np.float32))
        found = guide_tables.find_cell(self.tables, mi.Point3f(bad, 0.5, 0), mi.Vector3f(0, 0, 1), True)
        np.testing.assert_array_equal(np.array(found), np.full(5, odis.NO_CELL, np.uint32))
        for direction in (mi.Vector3f(bad, 0, 0.5), mi.Vector3f(0, bad, bad), mi.Vector3f(0, 1, bad)):
            block, texel = guide_tables.texel_of(direction)
            self.assertLess(max(np.array(block).max(), np.array(texel).max()), 16)

    def test_halves_of_paths(self):
        """odis::pathHalf, by whole numbers of Python."""
        def half(pixel, sample):
            word = pixel << 32 | sample
            for factor in (0xff51afd7ed558ccd, 0xc4ceb9fe1a85ec53):
                word = (word ^ word >> 33) * factor % 2**64
            return word >> 63
        pixel, sample = (np.random.default_rng(8).integers(0, 2**32, 1000, np.uint32) for _ in range(2))
        found = np.array(guide_tables.path_half(array_of(mi.UInt32, pixel), array_of(mi.UInt32, sample)))
        np.testing.assert_array_equal(found, [half(int(p), int(s)) for p, s in zip(pixel, sample)])

    def test_cached_radiance(self):
        """A path ends where it is wide enough and what the cell doesn't know matters little enough."""
        vertices = made_up.vertices(20000)
        builder = odis.GuideBuilder(odis.GuideOptions(settings="cached=on cached-error=0.5"))
        builder.add(vertices)
        guide = builder.build()
        tables = guide_tables.make_guide_tables(guide)
        count = 2000
        random = np.random.default_rng(9)
        cell, half = (random.integers(0, most, count, np.uint32) for most in (len(guide), 2))
        throughput, footprint = random.random(count, np.float32), (3 * random.random(count)).astype(np.float32)
        radiance, ends = guide_tables.cached_radiance(
            tables, array_of(mi.UInt32, cell), array_of(mi.UInt32, half), mi.Float(throughput), mi.Float(footprint),
            mi.Float(0.5), mi.Bool(True))
        row = guide.cached_radiance[cell, half]
        edge = guide.finest_edge * 2.0 ** (guide.cell_keys[cell] >> np.uint64(60)).astype(float)
        expected = (throughput * row[:, 3] < guide.rules.cached_error) & \
            (footprint >= guide.rules.least_cached_footprint * edge)
        self.assertGreater(expected.sum(), 100)
        self.assertGreater((~expected).sum(), 100)
        self.assertEqual(guide.rules.cached_error, 0.5)
        self.assertLess((np.array(ends) != expected).sum(), 3)  # edges are rounded
        np.testing.assert_allclose(np.array(radiance).T[expected], 0.5 * row[expected, :3])

    def test_density_and_samples_are_the_librarys(self):
        count = 5000
        random = np.random.default_rng(6)
        cells, uv = random.integers(len(self.guide), size=count, dtype=np.uint32), random.random((count, 2), np.float32)
        wi, pdf = self.guide.sample(cells, uv)
        cell_map = guide_tables.SamplingMap(self.tables, array_of(mi.UInt32, cells))
        ours = cell_map.sample(array_of(mi.Float, uv[:, 0]), array_of(mi.Float, uv[:, 1]), mi.Bool(True))
        np.testing.assert_allclose(np.array(ours).T, wi, atol=1e-4)
        other = np.array(cell_map.pdf(mi.Vector3f(wi.T), mi.Bool(True)))
        # Directions on the border of two texels may be rounded to either.
        self.assertGreater(np.isclose(other, pdf, rtol=1e-6).mean(), 0.998)

    def test_samples_follow_the_density(self):
        """chi^2 of 100,000 samples over 64 cells of the octahedral map; also that the density integrates to one."""
        count = 100_000
        random = np.random.default_rng(7)
        position, up = self.places(1)
        cell = mi.UInt32(int(self.guide.find_cells(position, up)[0])) + dr.zeros(mi.UInt32, count)
        cell_map = guide_tables.SamplingMap(self.tables, cell)
        u, v = (mi.Float(random.random(count, np.float32)) for _ in range(2))
        wi = cell_map.sample(u, v, mi.Bool(True))
        self.assertTrue((np.array(cell_map.pdf(wi, mi.Bool(True))) > 0).all())
        x, y = (np.array(axis) for axis in guide_tables.direction_to_square(wi))
        observed = np.histogram2d(x, y, bins=8, range=[[0, 1], [0, 1]])[0]
        grid = (np.arange(512) + 0.5) / 512
        gx, gy = (axis.ravel().astype(np.float32) for axis in np.meshgrid(grid, grid, indexing="ij"))
        wide = guide_tables.SamplingMap(self.tables, cell[0] + dr.zeros(mi.UInt32, gx.size))
        density = np.array(wide.pdf(guide_tables.square_to_direction(mi.Float(gx), mi.Float(gy)), mi.Bool(True)))
        self.assertAlmostEqual(density.mean() * 4 * np.pi, 1, delta=0.01)
        expected = density.reshape(8, 64, 8, 64).mean((1, 3)) / density.sum() * density.size / 64 * count
        used = expected > 5
        chi2 = ((observed - expected)[used] ** 2 / expected[used]).sum()
        self.assertLess(chi2, 64 + 5 * np.sqrt(2 * 64))

    def test_groups_follow_their_probabilities(self):
        """Groups of lights, where some have next to nothing, and where u lies within their parts."""
        u = (np.arange(1 << 18) + 0.5) / (1 << 18)
        for groups in (1, 2, 3, 6, 17, 32):
            probabilities = np.random.default_rng(groups).random((5, groups)) ** 20
            probabilities /= probabilities.sum(axis=1, keepdims=True)
            cumulative = np.pad(np.cumsum(probabilities, axis=1), ((0, 0), (1, 0))).astype(np.float32)
            sums, rounded = guide_tables.group_tables(cumulative)
            self.assertGreater(rounded.min(), 0)
            np.testing.assert_allclose(rounded, probabilities, atol=1e-3)
            np.testing.assert_allclose(rounded.sum(axis=1), 1)
            tables = SimpleNamespace(group_sums=array_of(mi.UInt32, sums))
            for cell in range(5):
                drawn, within = guide_tables.choose_group(tables, mi.UInt32(cell) + dr.zeros(mi.UInt32, u.size), groups,
                                                          mi.Float(u.astype(np.float32)), mi.Bool(True))
                drawn = np.broadcast_to(np.array(drawn), u.size)
                np.testing.assert_allclose(np.bincount(drawn, minlength=groups) / u.size, rounded[cell], atol=2e-5)
                before = np.cumsum(rounded[cell], dtype=np.float64) - rounded[cell]
                np.testing.assert_allclose(np.array(within), (u - before[drawn]) / rounded[cell][drawn], atol=0.02)


if __name__ == "__main__":
    unittest.main()
