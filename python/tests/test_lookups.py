"""What a guide answers: densities that fit what is sampled, probabilities within their range."""

import unittest

import made_up
import numpy as np
import odis


def chi_square_threshold(degrees, significance):
    """Where a chi-square variable is exceeded with that probability, by Wilson and Hilferty's approximation."""
    z = {0.01: 2.3263479}[significance]
    return degrees * (1 - 2 / (9 * degrees) + z * np.sqrt(2 / (9 * degrees))) ** 3


def uniform_directions(random, count):
    z, phi = 2 * random.random(count) - 1, 2 * np.pi * random.random(count)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1).astype(np.float32)


class Lookups(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        fields = made_up.vertices(50000)
        builder = odis.GuideBuilder(odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS))
        builder.add(fields)
        cls.guide = builder.build()
        cls.positions, cls.normals = fields["position"], fields["normal"]
        cls.cells = cls.guide.find_cells(cls.positions, cls.normals)

    def test_cells_exist(self):
        self.assertEqual(self.cells.dtype, np.uint32)
        self.assertLess(self.cells.max(), len(self.guide))
        # The keys of the finest cells name the cubes that the positions lie in.
        self.assertEqual(set(self.guide.cell_keys[self.cells] >> np.uint64(60)), {0})
        away = self.guide.find_cells(self.positions + np.float32(1e6), self.normals)
        self.assertEqual(set(away), {odis.NO_CELL})

    def test_media_have_cells_of_their_own(self):
        fields = made_up.vertices(2000)
        fog = dict(fields, normal=np.zeros_like(fields["normal"]), cosine=np.zeros(2000, np.float32))
        builder = odis.GuideBuilder()
        builder.add(odis.PathVertices(**fog))
        self.assertEqual(builder.vertex_counts.in_media, 2000)
        builder.add(odis.PathVertices(**fields))
        self.assertEqual((builder.vertex_counts.in_media, builder.vertex_counts.accepted), (2000, 4000))
        guide = builder.build()
        in_fog = guide.find_cells(fog["position"], fog["normal"])
        on_floor = guide.find_cells(fields["position"], fields["normal"])
        self.assertEqual(set(guide.cell_keys[in_fog] >> np.uint64(57) & np.uint64(7)), {6})
        self.assertEqual(set(guide.cell_keys[on_floor] >> np.uint64(57) & np.uint64(7)), {4})

    def test_samples_have_their_density(self):
        """Chi-square at 0.01: counts in bins of (cos theta, phi) against the integral of the density over each bin."""
        random = np.random.default_rng(3)
        count, rows, columns = 200000, 16, 24
        cells = np.full(count, self.cells[7], np.uint32)
        uv = random.random((count, 2), np.float32)
        wi, pdf = self.guide.sample(cells, uv)
        np.testing.assert_allclose(np.linalg.norm(wi, axis=1), 1, atol=1e-5)
        # The direction may have been rounded into the next texel.
        again = self.guide.pdf(cells, wi)
        self.assertGreater((again == pdf).mean(), 0.999)

        def bins(directions):
            z = np.clip((directions[:, 2] + 1) / 2 * rows, 0, rows - 1).astype(int)
            phi = np.arctan2(directions[:, 1], directions[:, 0]) / (2 * np.pi) % 1
            return z * columns + np.minimum((phi * columns).astype(int), columns - 1)

        observed = np.bincount(bins(wi), minlength=rows * columns)
        # A fine grid in each bin, since the density is constant within texels that no bin follows.
        fine = 64
        z, phi = np.meshgrid((np.arange(rows * fine) + 0.5) / (rows * fine) * 2 - 1,
                             (np.arange(columns * fine) + 0.5) / (columns * fine) * 2 * np.pi, indexing="ij")
        r = np.sqrt(1 - z * z)
        grid = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).reshape(-1, 3).astype(np.float32)
        size = len(grid)
        density = self.guide.pdf(np.full(size, self.cells[7], np.uint32), grid)
        expected = np.bincount(bins(grid), weights=density.astype(np.float64), minlength=rows * columns)
        expected *= 4 * np.pi / size
        self.assertAlmostEqual(expected.sum(), 1, delta=2e-3)
        expected *= count / expected.sum()
        # Bins of few samples are pooled.
        order = np.argsort(expected)
        small = np.searchsorted(np.cumsum(expected[order]), 20) + 1
        pooled = lambda x: np.append(x[order[small:]], x[order[:small]].sum())
        o, e = pooled(observed), pooled(expected)
        statistic = ((o - e) ** 2 / e).sum()
        self.assertLess(statistic, chi_square_threshold(len(e) - 1, 0.01))

    def test_density_integrates_to_one(self):
        random = np.random.default_rng(4)
        count = 400000
        directions = uniform_directions(random, count)
        density = self.guide.pdf(np.full(count, self.cells[0], np.uint32), directions)
        mean, error = density.mean() * 4 * np.pi, density.std() * 4 * np.pi / np.sqrt(count)
        self.assertLess(abs(mean - 1), 4 * error)

    def test_learns_the_bright_patch(self):
        count = 2000
        uv = np.random.default_rng(5).random((count, 2), np.float32)
        wi, _ = self.guide.sample(self.cells[:count], uv)
        self.assertGreater((wi @ made_up.BRIGHT > 0.9).mean(), 0.5)

    def test_strided_and_reversed_arguments(self):
        count = 100
        cells = self.cells[:count][::-1]
        uv = np.random.default_rng(7).random((2, count), np.float32).T
        wi, pdf = self.guide.sample(cells, uv)
        expected = self.guide.sample(cells.copy(), np.ascontiguousarray(uv))
        np.testing.assert_array_equal(wi, expected[0])
        np.testing.assert_array_equal(pdf, expected[1])

    def test_without_a_cell(self):
        cells = np.array([odis.NO_CELL, len(self.guide)], np.uint32)
        wi, pdf = self.guide.sample(cells, np.full((2, 2), 0.5, np.float32))
        self.assertEqual((wi.tolist(), pdf.tolist()), ([[0, 0, 0]] * 2, [0, 0]))
        self.assertEqual(self.guide.pdf(cells, self.normals[:2]).tolist(), [0, 0])
        ones = np.ones(2, np.float32)
        self.assertEqual(self.guide.bsdf_fraction(cells, ones).tolist(), [1, 1])
        self.assertEqual(self.guide.survival_probability(cells, ones).tolist(), [1, 1])
        deep = self.guide.survival_probability(cells, ones, np.array([31, 32], np.uint32))
        self.assertEqual(deep.tolist(), [1, float(np.float32(0.95))])

    def test_decisions(self):
        cells = self.cells[:3000]
        for column, roughness in enumerate((1, 0.3, 0.1)):
            fractions = self.guide.bsdf_fraction(cells, np.full(3000, roughness, np.float32))
            np.testing.assert_array_equal(fractions, self.guide.bsdf_fractions[cells, column])
        throughput = np.random.default_rng(8).random(3000, np.float32)
        survival = self.guide.survival_probability(cells, throughput)
        expected = np.clip(throughput * self.guide.survival_factors[cells], np.float32(0.3), 1)
        np.testing.assert_array_equal(survival, expected)
        deep = self.guide.survival_probability(cells, throughput, depth=32)
        np.testing.assert_array_equal(deep, np.minimum(expected, np.float32(0.95)))
        shadow = self.guide.shadow_ray_probability(np.array([0, 0.01, 0.02, 0.1, np.nan], np.float32))
        np.testing.assert_allclose(shadow, [0.2, 0.2, 0.4, 1, 1], rtol=1e-6)
        tables = self.guide.light_tables[self.guide.learned_light_fractions > 0]
        self.assertGreater(len(tables), 0)
        self.assertTrue((np.diff(tables, axis=1) >= 0).all() and (tables[:, 0] == 0).all())
        np.testing.assert_allclose(tables[:, -1], 1)


if __name__ == "__main__":
    unittest.main()
