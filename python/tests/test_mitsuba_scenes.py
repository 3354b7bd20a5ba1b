"""The integrator `odis` against Mitsuba's `path`: each BSDF, lights, cameras, and guides that are as bad as can be."""

import unittest
import warnings
from unittest import mock

import numpy as np
import test_mitsuba as base

try:
    import mitsuba as mi
    from odis.mitsuba import guide_tables, integrator, version
except ImportError as missing:
    raise unittest.SkipTest(f"Mitsuba does not run here: {missing}")

GRAY = {"type": "rgb", "value": 0.5}
DIFFUSE = {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.6, 0.5, 0.3]}}


def picture(channels, seed=1):
    pixels = np.random.default_rng(seed).random((8, 8, channels), np.float32)
    return {"type": "bitmap", "data": mi.TensorXf(pixels), "raw": True}


def tilts():
    pixels = np.tile(np.array([0.6, 0.45, 0.9], np.float32), (4, 4, 1))
    return {"type": "bitmap", "data": mi.TensorXf(pixels), "raw": True}


SMOOTH = {
    "diffuse": DIFFUSE,
    "twosided": {"type": "twosided", "front": DIFFUSE, "back": {"type": "roughplastic", "alpha": 0.3}},
    "roughplastic": {"type": "roughplastic", "alpha": 0.2, "diffuse_reflectance": GRAY},
    "sharp roughplastic": {"type": "roughplastic", "alpha": 0.01, "diffuse_reflectance": GRAY},
    "roughconductor": {"type": "roughconductor", "alpha": 0.3},
    "anisotropic roughconductor": {"type": "roughconductor", "alpha_u": 0.1, "alpha_v": 0.4, "distribution": "ggx"},
    "roughdielectric": {"type": "roughdielectric", "alpha": 0.3},
    "principled": {"type": "principled", "base_color": GRAY, "roughness": 0.4, "metallic": 0.3, "clearcoat": 0.5},
    "sharp principled": {"type": "principled", "base_color": GRAY, "roughness": 0.1, "specular": 0.5},
    "transmitting principled": {"type": "principled", "base_color": GRAY, "roughness": 0.5, "spec_trans": 0.6},
    "principledthin": {"type": "principledthin", "base_color": GRAY, "roughness": 0.4, "diff_trans": 0.6},
    "pplastic": {"type": "pplastic", "alpha": 0.2, "diffuse_reflectance": GRAY},
    "hair": {"type": "hair"},
    "bumpmap": {"type": "bumpmap", "arbitrary": picture(1), "scale": 0.2, "bsdf": DIFFUSE},
    "normalmap": {"type": "normalmap", "normalmap": tilts(), "bsdf": DIFFUSE},
    "blendbsdf": {"type": "blendbsdf", "weight": 0.4, "a": DIFFUSE, "b": {"type": "roughconductor", "alpha": 0.2}},
}
WITH_DELTA = {
    "plastic": {"type": "plastic", "diffuse_reflectance": GRAY},
    "twosided plastic": {"type": "twosided", "front": {"type": "plastic", "nonlinear": True}},
    "conductor": {"type": "conductor", "material": "Al"},
    "dielectric": {"type": "dielectric"},
    "thindielectric": {"type": "thindielectric"},
    "null": {"type": "null"},
    "mask": {"type": "mask", "opacity": picture(1), "bsdf": DIFFUSE},
    "mask of plastic": {"type": "mask", "opacity": 0.6, "bsdf": {"type": "plastic"}},
    "mask of roughdielectric": {"type": "mask", "opacity": 0.6, "bsdf": {"type": "roughdielectric", "alpha": 0.2}},
    "blendbsdf with conductor": {"type": "blendbsdf", "weight": 0.4, "a": DIFFUSE, "b": {"type": "conductor"}},
    "blendbsdf with plastic": {"type": "blendbsdf", "weight": 0.3, "a": {"type": "plastic"},
                               "b": {"type": "roughconductor", "alpha": 0.2}},
    "nested blendbsdf": {"type": "blendbsdf", "weight": 0.5, "a": DIFFUSE, "b": {
        "type": "blendbsdf", "weight": 0.5, "a": {"type": "dielectric"}, "b": {"type": "diffuse"}}},
    "mask of blendbsdf": {"type": "mask", "opacity": 0.7, "bsdf": {
        "type": "blendbsdf", "weight": 0.5, "a": DIFFUSE, "b": {"type": "conductor"}}},
    "bumpmap of plastic": {"type": "bumpmap", "arbitrary": picture(1), "scale": 0.2, "bsdf": {"type": "plastic"}},
    "normalmap of plastic": {"type": "normalmap", "normalmap": tilts(), "bsdf": {"type": "plastic"}},
    "rough plastic, thin mask": {"type": "mask", "opacity": 0.1, "bsdf": {"type": "roughplastic", "alpha": 0.2}},
}


def at(x, y, z):
    return mi.ScalarTransform4f().translate([x, y, z])


def film(size=base.SIZE, **changes):
    return {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}, **changes}


def spheres(bsdfs):
    """A sphere of each BSDF over a floor, one in each of the image's 4 x 4 blocks, in the order of reading."""
    scene = {"type": "scene", "floor": {"type": "rectangle", "to_world": at(0, 0, -0.6).scale(3), "bsdf": DIFFUSE},
             "lamp": {"type": "rectangle", "to_world": at(0, 4, 3).rotate([1, 0, 0], 130).scale(1.5),
                      "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 6.0}}},
             "bulb": {"type": "point", "position": [-3, -3, 4], "intensity": {"type": "rgb", "value": 5.0}},
             "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.3, 0.4, 0.5]}},
             "sensor": {"type": "orthographic", "film": film(),
                        "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]).scale(2)}}
    for i, bsdf in enumerate(bsdfs.values()):
        column, row = i % 4, i // 4
        # The view is mirrored: x grows to the left.
        scene[f"sphere{i}"] = {"type": "sphere", "center": [1.5 - column, 1.5 - row, 0], "radius": 0.42, "bsdf": bsdf}
    return mi.load_dict(scene)


class Scattering(unittest.TestCase):
    def check(self, bsdfs):
        z, error = base.z_scores(spheres(bsdfs), spp=64, max_depth=6)
        for name, block, accuracy in zip(bsdfs, z.ravel(), error.ravel()):
            with self.subTest(bsdf=name):
                self.assertLess(abs(block), 5)
                self.assertLess(accuracy, 0.02)

    def test_smooth_lobes(self):
        self.check(SMOOTH)

    def test_delta_lobes(self):
        self.check(WITH_DELTA)


def lamps():
    return {f"lamp{i}": {"type": "sphere", "radius": 0.03, "center": [-0.8 + 0.4 * i, -0.9, 0.5],
                         "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 2.0 + 3 * i}}}
            for i in range(5)}


class Scenes(unittest.TestCase):
    """Cameras, shapes, lights and variants."""

    def check(self, scene, accuracy=0.02, **parameters):
        z, error = base.z_scores(mi.load_dict(scene), spp=64, **{"max_depth": 4, **parameters})
        self.assertLess(np.abs(z).max(), 5, z)
        self.assertLess(np.median(error), accuracy)

    def test_crop_window(self):
        scene = base.box()
        scene["sensor"]["film"] = film(80, crop_width=base.SIZE, crop_height=base.SIZE, crop_offset_x=30,
                                       crop_offset_y=7)
        self.check(scene)

    def test_irradiance_meter(self):
        scene = base.box()
        scene["floor"]["meter"] = {"type": "irradiancemeter", "film": scene.pop("sensor")["film"]}
        self.check(scene, 0.1)

    def test_thin_lens(self):
        scene = base.box()
        scene["sensor"].update(type="thinlens", aperture_radius=0.3, focus_distance=3.0)
        self.check(scene)

    def test_instances(self):
        turned = mi.ScalarTransform4f().translate([0.4, 0.2, 0.2]).rotate([1, 1, 0], 40).scale(0.25)
        self.check(base.box(group={"type": "shapegroup", "ball": {"type": "sphere", "bsdf": DIFFUSE},
                                   "cube": {"type": "cube", "to_world": at(1, 1, 0), "bsdf": WITH_DELTA["plastic"]}},
                            one={"type": "instance", "shapes": {"type": "ref", "id": "group"}, "to_world": turned},
                            other={"type": "instance", "shapes": {"type": "ref", "id": "group"},
                                   "to_world": at(-0.5, -0.6, 0.4).scale(0.2)}))

    def test_emitters(self):
        white, toward = {"type": "rgb", "value": 1.5}, mi.ScalarTransform4f().look_at
        self.check(base.box(
            spot={"type": "spot", "intensity": white, "to_world": toward([0, 0, 3], [0.3, -0.5, 0], [0, 1, 0])},
            sun={"type": "directional", "direction": [0.2, -0.4, -1], "irradiance": white},
            slides={"type": "projector", "irradiance": picture(3), "scale": 8.0,
                    "to_world": toward([0, 0, 2], [0, 0, 0], [0, 1, 0])},
            beam={"type": "rectangle", "to_world": toward([-0.9, 0.5, 0.5], [0, 0, 0], [0, 1, 0]).scale(0.1),
                  "emitter": {"type": "directionalarea", "radiance": white}},
            screen={"type": "rectangle", "to_world": toward([0.95, 0, 0], [0, 0, 0], [0, 1, 0]).scale(0.4),
                    "emitter": {"type": "area", "radiance": picture(3, seed=2)}},
            sky={"type": "envmap", "bitmap": mi.Bitmap(np.random.default_rng(3).random((8, 16, 3), np.float32))}))

    def test_sky_with_sun(self):
        self.check(base.box(sky={"type": "sunsky", "sun_direction": [0.3, 0.4, 0.8], "sun_scale": 0.1}), 0.05)

    def test_emitters_that_are_never_chosen(self):
        lamps = {f"lamp{i}": {"type": "sphere", "radius": 0.2, "center": [-0.75 + 0.05 * i, -0.8, 0.5], "emitter": {
            "type": "area", "radiance": {"type": "rgb", "value": 1.0}, "sampling_weight": float(i > 15)}}
            for i in range(0, 36, 5)}
        dark = {"type": "constant", "radiance": 0.2, "sampling_weight": 0.0}
        self.check(base.box(sky=dark, **lamps))

    def test_spectral(self):
        mi.set_variant("llvm_ad_spectral")
        self.addCleanup(mi.set_variant, "llvm_ad_rgb")
        mi.set_log_level(mi.LogLevel.Error)
        self.addCleanup(mi.set_log_level, mi.LogLevel.Error)
        self.check(base.box())


class ChangedGuide:
    """A guide with other contents."""

    def __init__(self, guide, **changes):
        self.guide = guide
        for name, change in changes.items():
            array = np.array(getattr(guide, name))
            setattr(self, name, np.ascontiguousarray(change(array), array.dtype))

    def __getattr__(self, name):
        return getattr(self.guide, name)

    def __len__(self):
        return len(self.guide)


def noise(low, high):
    """A change to independent numbers between 10^low and 10^high."""
    random = np.random.default_rng(5)
    return lambda array: 10 ** random.uniform(low, high, array.shape)


def maps_of(weights):
    """Valid maps (odis.Guide.maps) of any weights in [0, 1], [cell][table][16]."""
    begins = np.cumsum(weights, axis=2) / weights.sum(axis=2, keepdims=True) * ((1 << 15) - 16)
    begins = np.floor(begins).astype(np.int64) + np.arange(1, 17)
    begins[..., -1] = 1 << 15
    return np.diff(begins, axis=2, prepend=0).astype(np.uint16)


def random_maps(maps):
    return maps_of(np.random.default_rng(9).random(maps.shape) ** 8)


def one_texel(maps):
    """Maps that nearly always draw the same texel."""
    chosen = np.random.default_rng(6).integers(16, size=(*maps.shape[:-1], 1))
    return maps_of((np.arange(16) == chosen).astype(float))


def constant(value):
    return lambda array: np.full(array.shape, value)


def one_group(array):
    """Tables of lights, cumulative, that always choose the same group in a cell."""
    chosen = np.random.default_rng(7).integers(array.shape[1] - 1, size=(len(array), 1))
    return np.arange(array.shape[1]) > chosen


def with_nan(change):
    def changed(array):
        result = change(array)
        result[np.random.default_rng(8).random(array.shape) < 0.05] = np.nan
        return result
    return changed


class Versions(unittest.TestCase):
    def test_one_that_is_too_old_is_an_error_and_one_that_is_new_a_warning(self):
        with self.assertRaisesRegex(ImportError, "needs Mitsuba 3.9 or later, found 3.8.0: `pip install"):
            version.check("3.8.0")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            version.check(mi.__version__)
            version.check("3.9.7")
        with self.assertWarnsRegex(UserWarning, "tried with Mitsuba 3.9, not yet with 3.10.0"):
            version.check("3.10.0")


class BadGuides(unittest.TestCase):
    """The image is right whatever the guide says, as long as the BSDF keeps a part of the choices of a direction, and
    Mitsuba's own probabilities a part of those of a light."""

    @classmethod
    def setUpClass(cls):
        lamps = {f"lamp{i}": {"type": "sphere", "radius": 0.05, "center": [-0.8 + 0.4 * i, -0.9, 0.5],
                              "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 1.0 + 2 * i}}}
                 for i in range(5)}
        # Two of them are never chosen: what they give is met by chance.
        for name, radiance in (("lamp0", 1.0), ("lamp3", 0.5)):
            lamps[name]["emitter"].update(sampling_weight=0.0, radiance={"type": "rgb", "value": radiance})
        cls.scene = mi.load_dict(base.box(sky={"type": "constant", "radiance": 0.3}, **lamps))

    def check(self, **changes):
        changes = {"bsdf_fractions": constant(0.5), **changes}
        make = guide_tables.make_guide_tables
        with mock.patch.object(integrator, "make_guide_tables",
                               lambda guide, *more: make(ChangedGuide(guide, **changes), *more)):
            z, error = base.z_scores(self.scene, spp=64, max_depth=5)
        self.assertLess(np.abs(z).max(), 5, z)
        self.assertLess(np.median(error), 0.05)

    def test_noise(self):
        self.check(maps=random_maps, survival_factors=noise(-1, 1), outgoing_radiance=noise(-2, 0.5),
                   bsdf_fractions=noise(-0.7, -0.01), learned_light_fractions=noise(-1, -0.05))

    def test_one_texel_and_one_light(self):
        self.check(maps=one_texel, light_tables=one_group, learned_light_fractions=constant(0.9))

    def test_not_a_number(self):
        self.check(survival_factors=constant(np.nan), bsdf_fractions=with_nan(constant(0.5)),
                   outgoing_radiance=constant(0.2))


if __name__ == "__main__":
    unittest.main()
