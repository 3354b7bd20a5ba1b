"""Frames: a host in numpy, whose paths end at the first vertex, on a floor under light from a patch and a sky."""

import gc
import pathlib
import tempfile
import threading
import unittest

import made_up
import numpy as np
import odis

WIDTH, HEIGHT, ALBEDO = 48, 32, 0.5


def incident(wi):
    return np.where(wi @ made_up.BRIGHT > 0.97, 20, 0.1) * (wi[:, 2] > 0)


# Light scattered towards the camera: albedo / pi times the integral of the radiance times the cosine. The patch is a
# cap of solid angle 2 pi (1 - 0.97), whose mean direction is made_up.BRIGHT times (1 + 0.97) / 2.
CAP = 2 * np.pi * 0.03 * (1.97 / 2) * 0.8
EXPECTED = ALBEDO / np.pi * (0.1 * np.pi + 19.9 * CAP)


def trace(render_pass, pixel, sample):
    """Values and vertices of samples: one bounce each, from the mixture of cosine and map."""
    random = np.random.default_rng([render_pass.seed & 0xFFFFFFFF, int(render_pass.kind.value), int(sample.min())])
    count = len(pixel)
    position = np.stack([(pixel % WIDTH + random.random(count)) / WIDTH,
                         (pixel // WIDTH + random.random(count)) / HEIGHT, np.zeros(count)], 1).astype(np.float32)
    normal = np.tile(np.array([0, 0, 1], np.float32), (count, 1))
    guide, ones = render_pass.guide, np.ones(count, np.float32)
    cells = guide.find_cells(position, normal)
    fraction = guide.bsdf_fraction(cells, ones)
    wi = made_up.cosine_directions(random, count)
    from_map, map_pdf = guide.sample(cells, random.random((count, 2), np.float32))
    chosen = random.random(count) >= np.where(map_pdf > 0, fraction, 1)
    wi[chosen] = from_map[chosen]
    bsdf_pdf = np.maximum(wi[:, 2], 0) / np.float32(np.pi)
    alpha = np.where(map_pdf > 0, fraction, 1)
    pdf = alpha * bsdf_pdf + (1 - alpha) * guide.pdf(cells, wi)
    radiance = incident(wi)
    weight = ALBEDO * bsdf_pdf / pdf
    gray = lambda x: np.repeat(x.astype(np.float32)[:, None], 3, axis=1)
    vertices = {"position": position, "normal": normal, "wi": wi, "radiance": gray(radiance), "weight": gray(weight),
                "pdf": pdf.astype(np.float32), "guidable_pdf": bsdf_pdf, "guidable_probability": ones,
                "indirect": (weight * radiance).astype(np.float32), "emission": 0 * ones, "light": 0 * ones,
                "rays_after": ones, "pixel": pixel, "sample": sample, "depth": ones.astype(np.uint16)}
    return gray(weight * radiance), vertices


def samples_of(frame):
    first, count = (array.ravel() for array in frame.samples())
    pixel = np.repeat(np.arange(first.size, dtype=np.uint32), count)
    within = np.arange(pixel.size, dtype=np.uint32) - np.repeat(np.cumsum(count) - count, count).astype(np.uint32)
    return pixel, first[pixel] + within


def render(options, parts=1, builder=None):
    """The frame, and how the passes were; samples are handed over by several threads in `parts`."""
    frame = odis.Frame(options, builder=builder)
    return frame, finish(frame, parts)


def finish(frame, parts=1):
    """Takes a frame through the passes that are left."""
    passes = []
    while (render_pass := frame.begin_pass()) is not None:
        pixel, sample = samples_of(frame)
        value, vertices = trace(render_pass, pixel, sample)
        rays = np.full(len(pixel), 2, np.uint32)

        def add(part):
            chosen = slice(part, None, parts)
            fields = {name: array[chosen] for name, array in vertices.items()}
            frame.add_samples(pixel[chosen], sample[chosen], value[chosen], rays[chosen],
                              fields if render_pass.wants_vertices else None)

        threads = [threading.Thread(target=add, args=(part,)) for part in range(parts)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        frame.end_pass()
        passes.append((render_pass.kind, len(render_pass.guide)))
    return passes


class Frames(unittest.TestCase):
    OPTIONS = odis.FrameOptions(WIDTH, HEIGHT, samples_per_pixel=16, seed=2**63 + 5)

    @classmethod
    def setUpClass(cls):
        cls.frame, cls.passes = render(cls.OPTIONS)

    def test_passes(self):
        kinds = [kind for kind, _ in self.passes]
        self.assertEqual(kinds[0], odis.PassKind.PILOT)
        self.assertEqual(set(kinds[1:]), {odis.PassKind.GUIDED})
        self.assertEqual(self.passes[0][1], 0)
        self.assertTrue(all(cells > 0 for _, cells in self.passes[1:]))
        self.assertTrue(self.frame.guide_is_final)

    def test_image_is_unbiased_and_less_noisy(self):
        mean, variance = self.frame.image()
        self.assertEqual((mean.shape, mean.dtype, variance.shape), ((HEIGHT, WIDTH, 3), np.float32, mean.shape))
        error = np.sqrt(mean[..., 0].var() / mean[..., 0].size)
        self.assertLess(abs(mean[..., 0].mean() - EXPECTED), 2.58 * error)  # two-sided, significance 0.01
        plain, _ = render(odis.FrameOptions(WIDTH, HEIGHT, samples_per_pixel=16, settings="guided=off"))
        self.assertLess(mean[..., 0].var(), 0.5 * plain.image()[0][..., 0].var())

    def test_counts(self):
        counts = self.frame.sample_counts()
        self.assertEqual((counts.shape, counts.dtype), ((HEIGHT, WIDTH), np.uint32))
        statistics = self.frame.statistics
        self.assertEqual(counts.sum(), statistics.samples)
        self.assertEqual(statistics.pilot_samples, WIDTH * HEIGHT)
        self.assertEqual(statistics.not_finite, 0)
        self.assertEqual(statistics.cells, len(self.frame.guide))
        self.assertEqual(self.frame.vertex_counts.outside_frame, 0)
        self.assertGreaterEqual(self.frame.vertex_counts.accepted, WIDTH * HEIGHT)

    def test_extension(self):
        """A frame that is asked for more has the counts and weights of one that was asked for as many at once."""
        at_once, _ = render(odis.FrameOptions(WIDTH, HEIGHT, samples_per_pixel=8, most_samples_per_pixel=odis.UNLIMITED,
                                              settings="samples=even"))
        frame, _ = render(odis.FrameOptions(WIDTH, HEIGHT, samples_per_pixel=1, most_samples_per_pixel=odis.UNLIMITED,
                                            settings="samples=even"))
        np.testing.assert_array_equal(frame.sample_counts(), 1)
        for samples_per_pixel in (3, 8):
            frame.extend(samples_per_pixel)
            self.assertEqual(frame.statistics.samples_per_pixel, samples_per_pixel)
            finish(frame)
        np.testing.assert_array_equal(frame.sample_counts(), at_once.sample_counts())
        pixel = np.arange(WIDTH * HEIGHT, dtype=np.uint32)
        weights = [frame.sample_weights(pixel, 0 * pixel + sample) for sample in range(8)]
        np.testing.assert_allclose(np.sum(weights, axis=0), 8, rtol=1e-5)
        with self.assertRaises(odis.Error):
            frame.extend(8)

    def test_weights(self):
        """Those of a pixel add up to the samples asked for; a film that splats them gives the pixels' means."""
        frame, splatted = odis.Frame(self.OPTIONS), np.zeros((WIDTH * HEIGHT, 4))
        later = []
        while (render_pass := frame.begin_pass()) is not None:
            pixel, sample = samples_of(frame)
            value, vertices = trace(render_pass, pixel, sample)
            weight = frame.sample_weights(pixel, sample)
            frame.add_samples(pixel, sample, value, np.full(len(pixel), 2, np.uint32), vertices)
            frame.end_pass()
            later.append(render_pass.weights_later)
            if render_pass.weights_later:
                weight = frame.sample_weights(pixel, sample)
            np.add.at(splatted, pixel, np.insert(value * weight[:, None], 3, weight, axis=1))
        self.assertEqual(later, [False, True] + [False] * (len(later) - 2))
        np.testing.assert_allclose(splatted[:, 3], 16, rtol=1e-5)
        np.testing.assert_allclose(splatted[:, :3] / 16, frame.image()[0].reshape(-1, 3), rtol=1e-4, atol=1e-6)
        counts = frame.sample_counts().ravel()
        self.assertGreater(counts.std(), 0)
        pixel = np.arange(WIDTH * HEIGHT, dtype=np.uint32)
        first, last = (frame.sample_weights(pixel, number) for number in (0 * pixel, counts - 1))
        # A pilot sample weighs .6 times as much as another one would if all pixels had as many.
        np.testing.assert_allclose(first, 0.6 * 16 / 15.6, rtol=1e-5)
        np.testing.assert_allclose(last, 16 / 15.6 * 15 / (counts - 1), rtol=1e-5)
        for outside, number in ((pixel + 1, pixel), (pixel, counts)):
            with self.assertRaises(odis.Error):
                frame.sample_weights(outside, number)

    def test_tiles_of_a_crop(self):
        """Parts of tiles that begin before the image come as whole ones do: the guide is another one."""
        for offset in (dict(tile_offset_x=5, tile_offset_y=15), dict(tile_offset_x=15)):
            frame, _ = render(odis.FrameOptions(WIDTH, HEIGHT, samples_per_pixel=4, **offset))
            self.assertGreater(frame.statistics.samples, 0.95 * WIDTH * HEIGHT * 4)
            self.assertEqual(frame.statistics.missing_samples, 0)
        with self.assertRaisesRegex(odis.Error, "tileOffsetX, tileOffsetY: expected 0 to 15"):
            odis.Frame(odis.FrameOptions(WIDTH, HEIGHT, tile_offset_x=16))

    def test_parts_of_many_threads_give_the_same_bits(self):
        again, _ = render(self.OPTIONS, parts=3)
        for expected, found in zip(self.frame.image(), again.image()):
            np.testing.assert_array_equal(found, expected)
        self.assertEqual(made_up.guide_bytes(again.guide), made_up.guide_bytes(self.frame.guide))

    def test_pixel_values_outlive_the_frame(self):
        frame = odis.Frame(odis.FrameOptions(4, 4))
        self.assertIsNone(frame.pixel_values)
        frame.begin_pass()
        pixel, sample = samples_of(frame)
        frame.add_samples(pixel, sample, np.ones((len(pixel), 3), np.float32))
        frame.end_pass()
        values = frame.pixel_values
        self.assertEqual((values.shape, values.flags.owndata, values.flags.writeable), ((4, 4), False, False))
        del frame
        gc.collect()
        np.testing.assert_allclose(values, 1.1, rtol=1e-5)

    def test_goes_on_from_a_file(self):
        frame = odis.Frame(self.OPTIONS)
        render_pass = frame.begin_pass()
        pixel, sample = samples_of(frame)
        value, vertices = trace(render_pass, pixel, sample)
        frame.add_samples(pixel, sample, value, np.full(len(pixel), 2, np.uint32), vertices)
        frame.end_pass()
        frame.host_data = b"what the host knows"
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "frame.odis"
            frame.save(path)
            loaded = odis.Frame.load(path)
            frame.guide.save(path)
            self.assertEqual(made_up.guide_bytes(odis.Guide.load(path)), made_up.guide_bytes(frame.guide))
            with self.assertRaises(odis.Error) as raised:
                odis.Frame.load(path)
            self.assertIn(str(path), str(raised.exception))
        self.assertEqual(loaded.host_data, b"what the host knows")
        finish(loaded)
        for expected, found in zip(self.frame.image(), loaded.image()):
            np.testing.assert_array_equal(found, expected)

    def test_learns_on_from_frame_to_frame(self):
        builder = odis.GuideBuilder()
        cells = []
        for seed in range(3):
            frame, _ = render(odis.FrameOptions(WIDTH, HEIGHT, seed=seed), builder=builder)
            cells.append(len(frame.guide))
            builder.fade(0.5)
        self.assertGreater(cells[2], cells[0])
        builder.set_bounds((0, 0, -1), (4, 4, 1))
        frame, _ = render(odis.FrameOptions(WIDTH, HEIGHT, seed=3), builder=builder)
        self.assertLess(len(frame.guide), cells[2])
        builder.forget()
        self.assertEqual(builder.vertex_counts.accepted, 0)
        with self.assertRaises(odis.Error):
            builder.fade(2)

    def test_interrupted(self):
        frame = odis.Frame(odis.FrameOptions(4, 4))
        frame.begin_pass()
        frame.end_pass(interrupted=True)
        self.assertIsNone(frame.begin_pass())
        self.assertEqual(frame.image()[0].max(), 0)


if __name__ == "__main__":
    unittest.main()
