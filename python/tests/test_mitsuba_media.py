"""Participating media: the integrator `odis` against Mitsuba's `volpath`. Skipped where Mitsuba does not run."""

import unittest

import made_up
import numpy as np
import odis
import test_mitsuba as base

try:
    import drjit as dr
    import mitsuba as mi
    from odis.mitsuba import from_scene, guide_tables, integrator, media, path, recording
    from odis.mitsuba.arrays import array_of
    from odis.mitsuba.film import make_film
    from odis.mitsuba.random_numbers import RandomNumbers, hash_seed
except ImportError as missing:
    raise unittest.SkipTest(f"Mitsuba does not run here: {missing}")

SEEDS = 8
UNGUIDED, GUIDED = {"settings": "guided=off samples=even"}, {"settings": "guided-cost=0"}


def rgb(*values):
    return {"type": "rgb", "value": list(values)}


def at(x, y, z):
    return mi.ScalarTransform4f().translate([x, y, z])


def sensor(origin, target, medium=None):
    film = {"type": "hdrfilm", "width": base.SIZE, "height": base.SIZE, "rfilter": {"type": "box"}}
    return {"type": "perspective", "fov": 45, "film": film, **({"medium": medium} if medium else {}),
            "to_world": mi.ScalarTransform4f().look_at(origin, target, [0, 1, 0])}


def room():
    """A floor, a wall and a lamp."""
    return {"type": "scene",
            "floor": {"type": "rectangle", "to_world": at(0, -1, 0).rotate([1, 0, 0], -90).scale(4)},
            "wall": {"type": "rectangle", "to_world": at(0, 0, -2).scale(4),
                     "bsdf": {"type": "diffuse", "reflectance": rgb(0.7, 0.5, 0.3)}},
            "lamp": {"type": "rectangle", "to_world": at(1, 2.5, 0).rotate([1, 0, 0], 90).scale(0.6),
                     "emitter": {"type": "area", "radiance": rgb(10, 9, 7)}}}


def fog(**more):
    """A block of fog that scatters forwards, which nothing but `null` bounds."""
    medium = {"type": "homogeneous", "sigma_t": 1.2, "albedo": rgb(0.95, 0.9, 0.8), "phase": {"type": "hg", "g": 0.6}}
    block = {"type": "cube", "to_world": at(0, -0.2, 0).scale([1.2, 0.7, 0.8]), "bsdf": {"type": "null"},
             "interior": medium}
    return {**room(), "sensor": sensor([0, 0.5, 5], [0, 0, 0]), "block": block, **more}


def smoke():
    """A coloured grid of smoke under a sky and a lamp that is a point."""
    random = np.random.default_rng(5)
    grid = lambda values: {"type": "gridvolume", "grid": mi.VolumeGrid(values.astype(np.float32)),
                           "to_world": at(-1, -1, -1).scale(2)}
    medium = {"type": "heterogeneous", "sigma_t": grid(random.random((6, 6, 6, 1)) ** 2), "scale": 6.0,
              "albedo": grid(0.5 + 0.5 * random.random((3, 3, 3, 3))),
              "phase": {"type": "blendphase", "weight": 0.4, "a": {"type": "isotropic"}, "b": {"type": "hg", "g": -0.4}}}
    return {**room(), "sensor": sensor([0, 0.5, 5], [0, 0, 0]),
            "block": {"type": "cube", "bsdf": {"type": "null"}, "interior": medium},
            "point": {"type": "point", "position": [-2.0, 1.5, 2.0], "intensity": rgb(4, 6, 9)},
            "sky": {"type": "constant", "radiance": rgb(0.3, 0.4, 0.5)}}


def milk():
    """The camera stands in haze, before a ball of glass with a liquid whose extinction has a colour, under a sky that is
    seen through the haze's boundary."""
    haze = mi.load_dict({"type": "homogeneous", "sigma_t": 0.08, "albedo": 0.9})
    liquid = {"type": "homogeneous", "sigma_t": rgb(0.3, 0.5, 1.0), "scale": 3.0, "albedo": rgb(0.95, 0.9, 0.6)}
    ball = {"type": "sphere", "radius": 0.9, "bsdf": {"type": "dielectric", "int_ior": 1.3}, "interior": liquid,
            "exterior": haze}
    boundary = {"type": "cube", "to_world": at(0, 0, 0).scale(4.5), "bsdf": {"type": "null"}, "interior": haze}
    scene = {**room(), "sensor": sensor([0, 0.5, 4], [0, 0, 0], haze), "ball": ball, "boundary": boundary,
             "sky": {"type": "constant", "radiance": rgb(0.5, 0.4, 0.3)}}
    del scene["lamp"]  # whose caustic would be noise
    return scene


def shine(image):
    """Means of 16 blocks, and of the colours."""
    return np.append(base.blocks(image), image.mean((0, 1)))


class Unbiased(unittest.TestCase):
    def means(self, scene, kind, spp, first, **parameters):
        made = mi.load_dict({"type": kind, **parameters})
        return np.array([shine(np.array(mi.render(scene, integrator=made, spp=spp, seed=first + i))[..., :3])
                         for i in range(SEEDS)])

    def compare(self, scene, variants, spp=48, **parameters):
        scene = mi.load_dict(scene)
        theirs = self.means(scene, "volpath", spp, 1000, **parameters)
        for variant in variants:
            ours = self.means(scene, "odis", spp, 0, **parameters, **variant)
            error = np.sqrt((ours.var(0, ddof=1) + theirs.var(0, ddof=1)) / SEEDS)
            z = (ours.mean(0) - theirs.mean(0)) / np.maximum(error, 1e-6)
            # |t| > 6 with 14 degrees of freedom: 3 in 100,000, and there are 19 means.
            self.assertLess(np.abs(z).max(), 6.0, z)
            self.assertLess(np.median(error / theirs.mean(0)), 0.02)

    def test_fog_within_a_boundary(self):
        self.compare(fog(), [UNGUIDED, GUIDED, {**GUIDED, "cached": True}])

    def test_a_grid_of_smoke(self):
        self.compare(smoke(), [UNGUIDED, GUIDED], max_depth=12)

    def test_a_liquid_in_glass_seen_from_within_haze(self):
        self.compare(milk(), [UNGUIDED, GUIDED], max_depth=16)


def wrong_guide(scene, known, random):
    """A guide that learned nonsense: light from random directions at random places, in media and on surfaces."""
    count = 20000
    fields = made_up.vertices(count)
    unit = lambda v: (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32)
    box = scene.bbox()
    low, high = (np.array(corner).ravel() for corner in (box.min, box.max))
    normals = guide_tables.ORIENTATIONS[random.integers(0, 7, count)]
    fields |= {"position": (low + (high - low) * random.random((count, 3))).astype(np.float32),
               "normal": np.ascontiguousarray(normals), "wi": unit(random.normal(size=(count, 3))),
               "radiance": np.repeat(random.random((count, 1)) ** 8, 3, axis=1).astype(np.float32),
               "pdf": np.full(count, 1 / (4 * np.pi), np.float32), "wo": np.zeros((count, 3), np.float32)}
    fields["guidable_pdf"] = fields["pdf"]
    fields["light_group"] %= max(known.lights.groups, 1)
    builder = odis.GuideBuilder(odis.GuideOptions(light_groups=known.lights.groups, settings="bsdf-fraction=0.3"))
    builder.add(fields)
    return builder.build()


class WrongGuide(unittest.TestCase):
    """Whatever a guide says, the mean stays: images with and without it, in pairs of the same random numbers."""

    def test_mean_stays(self):
        described = milk()
        described["ball"] |= {"bsdf": {"type": "null"}}
        described["lamp"] = room()["lamp"]
        scene = mi.load_dict(described)
        made = mi.load_dict({"type": "odis", "max_depth": 6, "settings": "guided=off"})
        mi.render(scene, integrator=made, spp=1)
        guide = wrong_guide(scene, made.known, np.random.default_rng(3))
        self.assertTrue((guide.cell_keys >> np.uint64(57) & np.uint64(7) == guide_tables.OF_MEDIUM).any())
        tables, pixels, spp = guide_tables.make_guide_tables(guide, True), base.SIZE ** 2, 64
        pixel = np.repeat(np.arange(pixels, dtype=np.uint32), spp)
        number = np.tile(np.arange(spp, dtype=np.uint32), pixels)
        values = array_of(mi.Float, np.full(pixels, 0.5, np.float32))

        def image(seed, used):
            film = make_film("pixels", scene.sensors()[0].film())
            camera = integrator.Camera(scene.sensors()[0], dr.opaque(mi.UInt64, hash_seed(seed)), film)
            samples = path.Samples(array_of(mi.UInt32, pixel), array_of(mi.UInt32, number), values if used else None,
                                   result=dr.zeros(mi.Float, 4 * pixel.size))
            samples = integrator.choose_samples(samples, np.arange(pixel.size), np.zeros(pixel.size, bool), 1)
            integrator.trace_samples(scene, camera, made.settings, made.known, used, samples)
            colors = np.asarray(samples.result).reshape(base.SIZE, base.SIZE, spp, 4)[..., :3]
            return shine(colors.mean(2))

        differences = np.array([image(seed, tables) - image(seed, None) for seed in range(SEEDS)])
        self.assertGreater(np.abs(differences).min(), 0)
        z = differences.mean(0) / (differences.std(0, ddof=1) / np.sqrt(SEEDS))
        # |t| > 8 with 7 degrees of freedom: 9 in 100,000, and there are 19 means.
        self.assertLess(np.abs(z).max(), 8.0, z)


class Parts(unittest.TestCase):
    def test_which_scenes_are_volumetric(self):
        sphere = {"type": "sphere"}
        for scene, expected in (({"type": "scene", "sphere": sphere}, False), (fog(), True),
                                ({"type": "scene", "integrator": {"type": "volpath"}, "sphere": sphere}, True),
                                ({"type": "scene", "integrator": {"type": "path"}, "sphere": sphere}, False),
                                ({"type": "scene", "sensor": milk()["sensor"]}, True)):
            scene = mi.load_dict(scene)
            self.assertEqual(from_scene.is_volumetric(scene), expected)
            self.assertEqual(odis.mitsuba.guide(scene).settings.volumetric, expected)

    def test_boundaries_do_not_count_without_media(self):
        """Light of a lamp behind three sheets of `null` is seen with a depth of 1 and reaches a wall with 2."""
        sheet = {"type": "rectangle", "bsdf": {"type": "null"}}
        sheets = {f"sheet{i}": {**sheet, "to_world": at(0, 0, 0.5 + 0.1 * i).scale(9)} for i in range(3)}
        scene = mi.load_dict({**room(), **sheets, "sensor": sensor([0, 0.5, 5], [0, 0, 0]),
                              "ball": {"type": "sphere", "radius": 0.3, "emitter": {"type": "area", "radiance": 2.0}}})
        for depth in (1, 2):
            ours, theirs = (base.render(scene, kind, 0, 64, max_depth=depth, **more).mean()
                            for kind, more in (("odis", {"volumetric": True}), ("volpath", {})))
            self.assertAlmostEqual(ours / theirs, 1, delta=0.05)

    def test_a_sensor_in_a_medium_of_its_own(self):
        """A medium that only a sensor outside of the scene names."""
        scene = mi.load_dict({**room(), "sensor": sensor([0, 0.5, 5], [0, 0, 0])})
        other = mi.load_dict(sensor([0, 0.5, 5], [0, 0, 0], {"type": "homogeneous", "sigma_t": 0.2, "albedo": 0.0}))
        made = mi.load_dict({"type": "odis", "max_depth": 2})
        clear, foggy = (np.array(mi.render(scene, integrator=made, sensor=one, spp=16)).mean()
                        for one in (scene.sensors()[0], other))
        self.assertLess(foggy, 0.6 * clear)

    def test_cells_of_media(self):
        """Places with a normal of zero lie in cells of media, others do not."""
        fields = made_up.vertices(20000)
        fields["normal"][::2] = 0
        builder = odis.GuideBuilder(odis.GuideOptions())
        builder.add(fields)
        guide = builder.build()
        tables = guide_tables.make_guide_tables(guide, True)
        places = np.random.default_rng(5).random((2000, 3), np.float32) * np.array([1, 1, 0], np.float32)
        for normal in ([0, 0, 1], [0, 0, 0]):
            normals = np.tile(np.array(normal, np.float32), (2000, 1))
            found = guide_tables.find_cell(tables, mi.Point3f(places.T), mi.Vector3f(normals.T), True)
            # Places on the border of two cells may be rounded to either.
            self.assertLess((np.array(found) != guide.find_cells(places, normals)).mean(), 0.005)
            self.assertGreater((np.array(found) != odis.NO_CELL).mean(), 0.99)

    def test_roughness_of_phase_functions(self):
        hg = lambda g: {"type": "hg", "g": g}
        flakes = mi.VolumeGrid(np.broadcast_to(np.float32([1, 1, 1, 0, 0, 0]), (2, 2, 2, 6)).copy())
        for phase, roughness, guided in (
                ({"type": "isotropic"}, 1, True), ({"type": "rayleigh"}, 1, True), (hg(-0.6), 0.4, True),
                (hg(0.97), 0.03, False), ({"type": "blendphase", "weight": 0.25, "a": hg(0.0), "b": hg(0.8)}, 0.8, True),
                ({"type": "tabphase", "values": "0, 0, 1"}, 1 / 3, True),
                ({"type": "sggx", "S": {"type": "gridvolume", "grid": flakes}}, 1, False)):
            flags, found = media.describe_phase(mi.load_dict(phase))
            self.assertAlmostEqual(found, roughness, delta=0.001)
            self.assertEqual(bool(flags & media.GUIDABLE), guided)

    def test_recorded_attenuation(self):
        """Of a path of two vertices that meets two lights on the way between, and what multiplies them."""
        recorder = recording.make_recorder(4, True)
        row = recording.new_row(recorder, mi.Bool([True, True]))
        previous = mi.UInt32([recording.NO_ROW, int(row[0])])
        zero, one = dr.zeros(mi.Float, 2), dr.ones(mi.Float, 2)
        recording.write(recorder, row, 1, [zero] * 4 + [one / 2] * 3 + [one], True)  # weight
        recording.write(recorder, row, 2, [one, zero, zero] + [zero] * 5, True)  # direct
        recording.write(recorder, row, 4, [one] * 3 + [one / 4] + [zero, recording.bits(previous), one / 2, one], True)
        met = recording.also_met(recording.nothing_met(), mi.Color3f(1), mi.Float(0.5), mi.Float(7))
        met = recording.also_met(met, mi.Color3f(3), mi.Float(0.1), mi.Float(9))
        recording.write_met(recorder, row, met, one, mi.Bool([True, False]))
        recording.write(recorder, row, 5, [zero] * 6, mi.Bool([False, True]))
        dr.eval(recorder)
        recording.complete_paths(recorder, row[1], mi.Float([4, 8, 16]), mi.UInt32([2]))
        completions = np.array(recorder.completions).reshape(-1, recording.PACKET)[np.array(row)]
        arriving = 1 * 0.5 + 3 * 0.1
        np.testing.assert_allclose(completions[1, :3], [4, 8, 16])
        expected = [arriving + (1 + 4 / 2) / 4, arriving + 8 / 2 / 2, arriving + 16 / 2]
        np.testing.assert_allclose(completions[0, :3], expected, rtol=1e-6)
        self.assertAlmostEqual(float(completions[0, 4]), 4 / 2, delta=1e-5)
        self.assertEqual(np.array(recorder.rows).reshape(-1, recording.ROW)[int(row[0]), 5 * recording.PACKET + 4], 9)

    def test_further_numbers_are_even(self):
        """chi^2 of pairs of consecutive numbers over 16 x 16 squares."""
        key = mi.UInt32(np.random.default_rng(1).integers(0, 2**32, 1 << 16, np.uint32))
        numbers = RandomNumbers(key, dr.brev(dr.arange(mi.UInt32, 1 << 16) & 15))
        x, y = (np.array(numbers.further(mi.UInt32(count))) for count in (4, 5))
        observed, expected = np.histogram2d(x, y, bins=16, range=[[0, 1], [0, 1]])[0], (1 << 16) / 256
        self.assertLess(((observed - expected) ** 2 / expected).sum(), 255 + 5 * np.sqrt(2 * 255))


if __name__ == "__main__":
    unittest.main()
