"""How the integrator `odis` samples environments."""

import unittest

import numpy as np
import test_mitsuba  # noqa: F401 (chooses the variant, or skips)

try:
    import drjit as dr
    import mitsuba as mi
    from odis.mitsuba import environment as env
except ImportError as missing:
    raise unittest.SkipTest(f"Mitsuba does not run here: {missing}")

COUNT = 1 << 20
BINS = 8  # along a side of the square of directions


def picture(height, width, **pixels):
    values = np.random.default_rng(1).random((height, width, 3)).astype(np.float32)
    for value in pixels.values():
        values[height // 3, width // 3] = value
    return {"type": "envmap", "bitmap": mi.Bitmap(values)}


def environments():
    return {
        "constant": {"type": "constant"},
        "black": {"type": "constant", "radiance": 0.0},
        "black image": {"type": "envmap", "bitmap": mi.Bitmap(np.zeros((8, 16, 3), np.float32))},
        "small image": picture(3, 2),
        "image with a bright pixel": picture(64, 128, bright=1e5),
        "image with a pixel that is no number": picture(64, 128, spoiled=np.nan),
        "turned image": {**picture(32, 64), "to_world": mi.ScalarTransform4f().rotate([1, 2, 3], 70)},
        "sky and sun": {"type": "sunsky"},
        "large sun": {"type": "sunsky", "sun_aperture": 40.0, "sun_direction": [1, 0, 0.1]},
        "sky": {"type": "sunsky", "sun_scale": 0.0},
    }


def environment_of(description):
    return env.make_environment(mi.load_dict({"type": "scene", "environment": description, "a": {"type": "sphere"}}))


def density(environment, direction):
    """Of all regions together, as Mitsuba's probabilities choose among them."""
    region, within = environment.region_and_density(direction, mi.Bool(True))
    pdf = dr.gather(mi.Float, mi.Float(environment.probabilities), region) * within
    if environment.sun is not None:
        pdf += environment.probabilities[env.REGIONS] * dr.select(
            environment.sun.contains(direction), environment.sun.density, 0)
    return pdf


def drawn(environment, seed=1):
    random = np.random.default_rng(seed)
    region = random.choice(environment.regions, COUNT, p=np.array(environment.probabilities) /
                           sum(environment.probabilities)).astype(np.uint32)
    u = random.random((2, COUNT)).astype(np.float32)
    return mi.UInt32(region), environment.sample(mi.UInt32(region), mi.Point2f(mi.Float(u[0]), mi.Float(u[1])),
                                                 mi.Bool(True))


def square(side):
    """The middles of side² equal squares, as directions, and the bins that these are in."""
    i = dr.arange(mi.UInt32, side * side)
    x, y = (mi.Float(i % side) + 0.5) / side, (mi.Float(i // side) + 0.5) / side
    return env.square_to_direction(x, y), np.array(bin_of(x, y))


def bin_of(x, y):
    return dr.minimum(mi.UInt32(y * BINS), BINS - 1) * BINS + dr.minimum(mi.UInt32(x * BINS), BINS - 1)


def standard_score(chi_squared, degrees):
    """Of a chi-squared statistic, by the approximation of Wilson and Hilferty (1931)."""
    spread = 2 / (9 * degrees)
    return ((chi_squared / degrees) ** (1 / 3) - (1 - spread)) / np.sqrt(spread)


class Environments(unittest.TestCase):
    def each(self):
        for name, description in environments().items():
            with self.subTest(environment=name):
                try:
                    environment = environment_of(description)
                except RuntimeError as refused:  # by Mitsuba itself
                    self.assertIn("no probability mass", str(refused))
                    continue
                yield environment

    def test_directions_follow_the_density(self):
        """Chi-squared, over bins of equal solid angle and the sun's cone: p > 1e-4 for each of ten."""
        for environment in self.each():
            _, direction = drawn(environment)
            self.assertLess(np.abs(np.array(dr.norm(direction)) - 1).max(), 1e-5)
            sun = np.zeros(COUNT, bool)
            middles, bins = square(2048)
            expected = np.array(density(environment, middles), np.float64)
            if environment.sun is not None:
                sun = np.array(environment.sun.contains(direction))
                expected[np.array(environment.sun.contains(middles))] = 0
            expected = np.bincount(bins, expected, BINS ** 2) * (4 * np.pi / bins.size * COUNT)
            found = np.bincount(np.array(bin_of(*env.direction_to_square(direction)))[~sun], minlength=BINS ** 2)
            expected, found = np.append(expected, COUNT - expected.sum()), np.append(found, sun.sum())
            enough = expected > 20
            self.assertLess(abs(found[~enough].sum() - expected[~enough].sum()), 100)
            statistic = ((found - expected) ** 2 / np.maximum(expected, 1e-9))[enough].sum()
            # The squares' middles miss the sun's border and its share of the sky, by less than a tenth of a sigma.
            self.assertLess(standard_score(statistic, max(1, enough.sum() - 1)), 3.72)

    def test_regions_hold_what_is_drawn_in_them(self):
        for environment in self.each():
            region, direction = drawn(environment)
            found, _ = environment.region_and_density(direction, mi.Bool(True))
            wrong = np.array((found != region) & (region < env.REGIONS)).mean()
            self.assertLess(wrong, 1e-4)  # by rounding, at borders

    def test_light_is_that_of_quadrature(self):
        """|z| < 4 for each."""
        for environment in self.each():
            nothing, on = dr.zeros(mi.SurfaceInteraction3f), mi.Bool(True)
            luminance = lambda direction: np.nan_to_num(np.broadcast_to(np.array(mi.luminance(
                environment.radiance(nothing, direction, on)), np.float64), dr.width(direction)))
            middles, _ = square(4096)
            sky, sun = luminance(middles), 0.0
            if environment.sun is not None:
                sky[np.array(environment.sun.contains(middles))] = 0
                _, in_cone = drawn(environment, seed=3)
                in_cone = dr.gather(mi.Vector3f, in_cone, mi.UInt32(np.flatnonzero(
                    np.array(environment.sun.contains(in_cone))).astype(np.uint32)))
                sun = luminance(in_cone).mean() / environment.sun.density[0]
            _, direction = drawn(environment)
            values = luminance(direction) / np.array(density(environment, direction))
            error = values.std() / np.sqrt(COUNT) + 1e-4 * values.mean()
            self.assertLess(abs(values.mean() - sky.mean() * 4 * np.pi - sun), 4 * error + 1e-12)

    def test_what_is_never_chosen_has_no_tables(self):
        never = {"type": "constant", "sampling_weight": 0.0}
        for lights in ({"bulb": {"type": "point"}}, {"bulb": {"type": "point"}, "sky": never}):
            self.assertIsNone(env.make_environment(mi.load_dict({"type": "scene", **lights})))


class AliasTables(unittest.TestCase):
    def test_probabilities(self):
        random = np.random.default_rng(1)
        for weights in (np.ones(1), np.array([1.0, 3.0]), np.full(7, 0.1), random.random(1000) ** 8 + 1e-3,
                        np.array([0.0, 0, 5, 0, 0, 2e-9]), np.repeat([1e-6, 1e6], 50)):
            part, other = env.alias_table(weights)
            found = np.bincount(other, 1 - part, weights.size) + part
            np.testing.assert_allclose(found / weights.size, weights / weights.sum(), atol=1e-9)


if __name__ == "__main__":
    unittest.main()
