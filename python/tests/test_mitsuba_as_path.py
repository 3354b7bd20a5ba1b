"""Where Mitsuba's `path` has rules of its own, the integrator `odis` follows: hidden emitters, alpha, meshes that emit, and
the sun's disk."""

import tempfile
import unittest
import warnings

import numpy as np
import test_mitsuba as base

try:
    import drjit as dr
    import mitsuba as mi
    from odis.mitsuba import environment as env
    from odis.mitsuba.uneven_lights import is_uneven
except ImportError as missing:
    raise unittest.SkipTest(f"Mitsuba does not run here: {missing}")

LIGHT = {"type": "area", "radiance": {"type": "rgb", "value": [2.0, 3.0, 4.0]}}
MASK = {"type": "mask", "opacity": 0.4, "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse"}}}
# Corners on the axes, whose normals point away from the centre.
OCTAHEDRON = "".join(f"v {x} {y} {z}\nvn {x} {y} {z}\n" for x, y, z in (
    (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))) + "".join(
    f"f {a}//{a} {b}//{b} {c}//{c}\n" for a, b, c in (
        (1, 3, 5), (3, 2, 5), (2, 4, 5), (4, 1, 5), (3, 1, 6), (2, 3, 6), (4, 2, 6), (1, 4, 6)))


def at(x, y, z):
    return mi.ScalarTransform4f().translate([x, y, z])


def view(**more):
    """A grey wall seen through 32 x 32 pixels with alpha."""
    film = {"type": "hdrfilm", "width": base.SIZE, "height": base.SIZE, "rfilter": {"type": "box"}, "pixel_format": "rgba"}
    sensor = {"type": "perspective", "fov": 40, "film": film,
              "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0])}
    wall = {"type": "rectangle", "to_world": at(0, 0, -2).scale(1.5)}
    return mi.load_dict({"type": "scene", "sensor": sensor, "wall": wall, **more})


def octahedron(**parameters):
    with tempfile.NamedTemporaryFile("w", suffix=".obj") as file:
        file.write(OCTAHEDRON)
        file.flush()
        return mi.load_dict({"type": "obj", "filename": file.name, **parameters})


class AsPath(unittest.TestCase):
    def compare(self, scene, spp=64, settings="guided-cost=0", **parameters):
        """Means of 16 blocks of colours and alpha over seeds: by chance one fails in some 300 such images."""
        made = [mi.load_dict({"type": "odis", "settings": settings, **parameters}),
                mi.load_dict({"type": "path", **parameters})]
        means = [np.array([base.blocks(np.array(mi.render(scene, integrator=one, spp=spp, seed=first + i)))
                           for i in range(base.SEEDS)]) for one, first in zip(made, (0, 1000))]
        error = np.sqrt(sum(m.var(0, ddof=1) / base.SEEDS for m in means))
        z = (means[0].mean(0) - means[1].mean(0)) / np.maximum(error, 1e-6)
        self.assertLess(np.abs(z).max(), 5.0, z)


class HiddenEmitters(AsPath):
    """What is behind them shows; light that only they or the sky behind half of nothing would send does not."""

    def lamps(self):
        return {"sphere": {"type": "sphere", "center": [-1, 1, 0], "radius": 0.4, "emitter": LIGHT},
                "behind": {"type": "sphere", "center": [-1, 1, -1], "radius": 0.3, "emitter": LIGHT},
                "disk": {"type": "disk", "to_world": at(1, 1, 0).scale(0.4), "emitter": LIGHT},
                "rectangle": {"type": "rectangle", "to_world": at(-1, -1, 0).scale(0.4), "emitter": LIGHT},
                "mesh": {"type": "cube", "to_world": at(1, -1, 0).scale(0.3), "emitter": LIGHT}}

    def test_under_a_constant_sky(self):
        self.compare(view(sky={"type": "constant", "radiance": 0.4}, **self.lamps()), hide_emitters=True)

    def test_under_an_image(self):
        pixels = np.random.default_rng(3).random((8, 16, 3)).astype(np.float32)
        self.compare(view(sky={"type": "envmap", "bitmap": mi.Bitmap(pixels)}, **self.lamps()), hide_emitters=True,
                     max_depth=4)

    def test_masks(self):
        sheet = {"type": "rectangle", "to_world": at(0.8, 0, -1).scale(1), "bsdf": MASK}
        for sky, hidden in (({}, False), ({"sky": {"type": "constant", "radiance": 0.4}}, True)):
            self.compare(view(sheet=sheet, **sky, **self.lamps()), hide_emitters=hidden)

    def test_no_depth_and_depth_one(self):
        scene = view(sky={"type": "constant", "radiance": 0.4}, **self.lamps())
        for depth in (0, 1):
            for hidden in (False, True):
                ours, theirs = (base.render(scene, kind, 0, 256, hide_emitters=hidden, max_depth=depth)
                                for kind in ("odis", "path"))
                np.testing.assert_allclose(ours.mean((0, 1)), theirs.mean((0, 1)), rtol=0.03, atol=1e-6)


class UnevenLights(AsPath):
    def test_a_mesh_with_vertex_normals(self):
        lamp = octahedron(face_normals=False, to_world=at(0, 0, -0.5).scale(0.5), emitter=LIGHT)
        floor = {"type": "rectangle", "to_world": at(0, -1.3, -0.5).rotate([1, 0, 0], -90).scale(2)}
        self.compare(view(lamp=lamp, floor=floor), spp=128)

    def test_which_lights_are(self):
        def uneven(shape):
            scene = mi.load_dict({"type": "scene", "shape": shape})  # which keeps the emitter's shape
            return is_uneven(scene.emitters()[0])
        self.assertTrue(uneven(octahedron(emitter=LIGHT)))
        self.assertFalse(uneven(octahedron(emitter=LIGHT, face_normals=True)))
        for kind in ("cube", "rectangle", "disk", "sphere", "cylinder"):
            self.assertFalse(uneven({"type": kind, "emitter": LIGHT}), kind)
            self.assertFalse(uneven({"type": kind, "emitter": LIGHT, "flip_normals": True}), kind)
        self.assertFalse(is_uneven(mi.load_dict({"type": "point"})))
        self.assertFalse(is_uneven(mi.load_dict({"type": "constant"})))


class FilmBorder(unittest.TestCase):
    def test_nothing_beyond_it_shows(self):
        """A wall of 1 fills the picture, one of 100 begins where it ends."""
        def walls(**film):
            sensor = {"type": "orthographic", "film": {"type": "hdrfilm", "width": 8, "height": 8, **film},
                      "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0])}
            glow = lambda radiance: {"type": "area", "radiance": {"type": "rgb", "value": radiance}}
            return mi.load_dict({"type": "scene", "sensor": sensor, "wall": {"type": "rectangle", "emitter": glow(1.0)},
                                 "beside": {"type": "rectangle", "to_world": at(-2, 0, 0), "emitter": glow(100.0)}})
        crop = {"crop_width": 3, "crop_height": 4, "crop_offset_x": 5, "crop_offset_y": 2}
        for kind in ("gaussian", "tent", "mitchell"):
            for more in ({}, crop):
                image = base.render(walls(rfilter={"type": kind}, **more), "odis", 1, 1024, max_depth=1, film="pixels")
                # The filter's weights vary by 1 to 5 % of the mean of 1024.
                np.testing.assert_allclose(image, 1, atol=0.25 if kind == "mitchell" else 0.1)
                self.assertAlmostEqual(image.mean(), 1, delta=0.02)
        scene = walls(rfilter={"type": "gaussian"}, sample_border=True)
        ours, theirs = (base.render(scene, kind, 1, 4096, max_depth=1, **film).mean((0, 2))
                        for kind, film in (("odis", {"film": "pixels"}), ("path", {})))
        self.assertGreater(theirs[0], 10)
        np.testing.assert_allclose(ours, theirs, rtol=0.1)


class SunsDisk(unittest.TestCase):
    def test_light_is_that_of_sample_direction(self):
        """Without a sky, means over the same grid; `eval` sees a disk that is up to .5 % larger or smaller."""
        side = 128
        i = dr.arange(mi.UInt32, side * side)
        u = mi.Point2f((mi.Float(i % side) + 0.5) / side, (mi.Float(i // side) + 0.5) / side)
        turned = mi.ScalarTransform4f().rotate([0.6, 0.8, 0], 20)
        for aperture in (0.1, 0.5358, 3.0, 20.0):
            for k, direction in enumerate(np.random.default_rng(4).normal(size=(5, 3))):
                sun = {"type": "sunsky", "sky_scale": 0.0, "sun_aperture": aperture, "complex_sun": k == 4,
                       "sun_direction": [*direction[:2], abs(direction[2]) + 1], **({"to_world": turned} if k == 3 else {})}
                scene = mi.load_dict({"type": "scene", "sun": sun, "shape": {"type": "sphere"}})
                environment = env.make_environment(scene)
                _, weight = scene.environment().sample_direction(dr.zeros(mi.Interaction3f, side * side), u)
                radiance = environment.radiance(dr.zeros(mi.SurfaceInteraction3f, side * side),
                                                environment.sun.sample(u), mi.Bool(True))
                ours = np.array(radiance).mean(1) / np.array(environment.sun.density)
                with self.subTest(aperture=aperture, direction=direction):
                    if k < 4 or aperture > 0.5:  # the limb of a tiny sun is darkened at the border
                        np.testing.assert_allclose(ours, np.array(weight).mean(1), rtol=2e-3 if k == 4 else 2e-4)

    def test_a_sun_that_is_too_small(self):
        """Mitsuba's own is no number then."""
        scene = mi.load_dict({"type": "scene", "sun": {"type": "sunsky", "sun_aperture": 0.01},
                              "shape": {"type": "sphere"}})
        self.assertIsNone(env.find_sun(scene.environment()))


class Regions(unittest.TestCase):
    def test_none_is_empty(self):
        """Where all the light is in a texel at the border."""
        for place in ((0, 0), (127, 127), (0, 127), (0, 64), (64, 64)):
            for rest in (0, 1e-9):
                texels = np.full((128, 128), float(rest))
                texels[place] = 1e6
                with warnings.catch_warnings():
                    warnings.simplefilter("error")
                    alias, first, table, shares = env.make_tables(texels)
                self.assertTrue((np.diff(first) > 0).all())
                self.assertAlmostEqual(shares.sum(), 1)
                self.assertTrue(np.isfinite(shares).all() and (table.view(np.float32)[:, 1] > 0).all())


if __name__ == "__main__":
    unittest.main()
