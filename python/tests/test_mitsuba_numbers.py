"""Random numbers of the integrator `odis`: Sobol' points that are stratified in a pixel, and independent otherwise."""

import unittest

import numpy as np
import test_mitsuba  # noqa: F401, sets the variant, or skips

try:
    import drjit as dr
    import mitsuba as mi
    from odis.mitsuba.random_numbers import OF_CAMERA, OF_VERTEX, hash_seed, numbers_of
except ImportError as missing:
    raise unittest.SkipTest(f"Mitsuba does not run here: {missing}")

PIXELS, POINTS = 2048, 16


def draws_of(seed, depth):
    """Of a vertex, for the first POINTS samples of each of PIXELS pixels."""
    pixel, number = (mi.UInt32(values.ravel()) for values in np.mgrid[0:PIXELS, 0:POINTS].astype(np.uint32))
    return numbers_of(mi.UInt64(hash_seed(seed)), pixel, number).of_vertex(mi.UInt32(depth))


def by_pixel(numbers):
    return np.array(numbers, np.float64).reshape(PIXELS, POINTS)


class Numbers(unittest.TestCase):
    def test_each_interval_has_one(self):
        draws = draws_of(3, 2)
        x, y = (by_pixel(axis) for axis in draws.next_2d())
        for numbers in (by_pixel(draws.next()), x, y):
            self.assertTrue(((0 <= numbers) & (numbers < 1)).all())
            np.testing.assert_array_equal(np.sort(np.floor(numbers * POINTS)), [np.arange(POINTS)] * PIXELS)

    def test_each_rectangle_has_one(self):
        x, y = (by_pixel(axis) for axis in draws_of(0, 0).next_2d())
        for columns in (1, 2, 4, 8, 16):
            rows = POINTS // columns
            rectangle = np.floor(x * columns) * rows + np.floor(y * rows)
            np.testing.assert_array_equal(np.sort(rectangle), [np.arange(POINTS)] * PIXELS)

    def test_a_sample_is_uniform(self):
        """Each sample of a pixel by itself, over pixels, in each of 16 intervals: a multinomial count."""
        draws = draws_of(1, 1)
        x, y = draws.next_2d()
        for numbers in (x, y, draws.next()):
            for sample in range(4):
                counts = np.histogram(by_pixel(numbers)[:, sample], 16, (0, 1))[0]
                chi_square = ((counts - PIXELS / 16) ** 2 / (PIXELS / 16)).sum()
                self.assertLess(chi_square, 38.2)  # 15 degrees of freedom, p = .01 over 12 tests

    def test_dimensions_are_independent(self):
        """Those of a vertex, of vertices, and of seeds: correlations of the first samples' numbers, over pixels."""
        columns = []
        for seed, depth in ((0, 0), (0, 1), (0, 9), (1, 0)):
            draws = draws_of(seed, depth)
            for _ in range(OF_VERTEX - 2):
                columns.append(by_pixel(draws.next()))
            columns += [by_pixel(axis) for axis in draws.next_2d()]
        for sample in (0, 1, 5):
            z = np.corrcoef([column[:, sample] for column in columns]) * np.sqrt(PIXELS)
            pairs = z[np.triu_indices(len(columns), 1)]
            self.assertLess(np.abs(pairs).max(), 4.44)  # p = .01 over 3 x 378 pairs

    def test_products_are_unbiased(self):
        """The mean over a pixel's points of a product over two dimensions, as a path's contributions are."""
        draws = draws_of(5, 3)
        first, second = by_pixel(draws.next()), by_pixel(draws.next())
        means = ((first > 0.7) & (second > 0.9)).mean(axis=1)
        z = (means.mean() - 0.03) / (means.std(ddof=1) / np.sqrt(PIXELS))
        self.assertLess(abs(z), 2.6)

    def test_camera_and_vertices_share_none(self):
        draws = numbers_of(mi.UInt64(hash_seed(0)), dr.arange(mi.UInt32, 4096), mi.UInt32(0)).of_camera()
        for _ in range(OF_CAMERA):
            last = np.array(draws.next())
        first = np.array(numbers_of(mi.UInt64(hash_seed(0)), dr.arange(mi.UInt32, 4096),
                                    mi.UInt32(0)).of_vertex(mi.UInt32(0)).next())
        self.assertFalse((first == last).all())
        self.assertLess(abs(np.corrcoef(first, last)[0, 1]) * 64, 2.6)


if __name__ == "__main__":
    unittest.main()
