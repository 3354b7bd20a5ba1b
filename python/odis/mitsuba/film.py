"""Where samples lie in the image, and which pixels they are added to."""

import drjit as dr
import mitsuba as mi
import numpy as np

from .arrays import array_of
from .film_filter import make_film_filter
from .path import VALID
from .random_numbers import numbers_of

FILMS = ("splat", "pixels")


def film_of(kind, rfilter):
    """The one of FILMS that an image has if `kind` is asked for: with a box filter no sample reaches further pixels."""
    return "pixels" if rfilter.is_box_filter() else kind


def make_film(kind, film):
    """kind: one of FILMS; film: the sensor's mi.Film."""
    return {"pixels": PixelFilm, "splat": SplatFilm}[film_of(kind, film.rfilter())](film)


def has_alpha(film):
    return mi.has_flag(film.flags(), mi.FilmFlags.Alpha)


class PixelFilm:
    """Each sample is drawn for a pixel, at a place that has the reconstruction filter as its density, and counts there
    alone: the noise of neighbouring pixels is independent, which a denoiser wants. The frame has the pixels' means."""

    def __init__(self, film):
        self.size = film.crop_size()  # of the frame, in pixels
        self.filter = make_film_filter(film)
        self.valid = np.zeros(self.size[0] * self.size[1]) if has_alpha(film) else None  # samples of each pixel

    def place(self, pixel, draws):
        """Where a sample of a pixel lies, in pixels from the corner of what the film shows, and its weight."""
        at = mi.Point2u(pixel % self.size[0], pixel // self.size[0])
        offset, weight = self.filter.sample(at, draws)
        return mi.Point2f(at) + 0.5 + offset, weight

    def begin_pass(self, frame, frame_pass, first, count):
        """first, count: frame.samples()."""

    def add(self, seed, samples):
        """Adds samples of the pass (path.Samples), which are traced. seed: that of their random numbers."""
        if self.valid is not None:
            tags = np.asarray(samples.result).reshape(-1, 4)[:, 3].view(np.uint32)
            self.valid += np.bincount(np.asarray(samples.pixel), weights=tags >= VALID, minlength=self.valid.size)

    def end_pass(self, frame):
        """Once the frame has ended the pass."""

    def image(self, frame):
        """What mi.Film stores, [height, width, channel]: colours, alpha if it has it, and weights."""
        channels = [frame.image()[0]]
        height, width, _ = channels[0].shape
        if self.valid is not None:
            alpha = self.valid.reshape(height, width, 1) / np.maximum(frame.sample_counts(), 1)[..., None]
            channels.append(alpha.astype(np.float32))
        return mi.TensorXf(np.concatenate(channels + [np.ones((height, width, 1), np.float32)], axis=2))


class SplatFilm:
    """Samples lie evenly in their pixels, and are added to all pixels that the reconstruction filter reaches, by
    Mitsuba's own mi.ImageBlock, as those of `path` are. There is less noise, which neighbouring pixels share.

    The weights of a pixel's samples add up to the same sum in all pixels (odis.Frame.sample_weights), however many
    there are. With `sample_border` the frame has pixels around what the film shows.
    """

    def __init__(self, film):
        rfilter, shown = film.rfilter(), film.crop_size()
        self.border = rfilter.border_size() if film.sample_border() else 0
        self.size = shown + 2 * self.border
        # "Coalesced" accumulation visits pixels that the filter does not reach, and takes longer.
        block = lambda channels: mi.ImageBlock(shown, [0, 0], channels, rfilter, border=False, coalesce=False)
        # Dr.Jit adds two or four numbers at once, and takes up to ten times as long for five.
        self.colors, self.alpha = block(4), block(2) if has_alpha(film) else None
        self.first, self.counts, self.weights = None, None, None
        self.waiting = []  # samples whose weights are known only when the pass has ended

    def place(self, pixel, draws):
        at = mi.Point2i(mi.Point2u(pixel % self.size[0], pixel // self.size[0])) - self.border
        return mi.Point2f(at) + draws.next_2d(), mi.Float(1)

    def begin_pass(self, frame, frame_pass, first, count):
        self.first, self.counts = first.ravel(), count.ravel()
        self.weights = None if frame_pass.weights_later else self._weights(frame)

    def add(self, seed, samples):
        self.waiting.append((seed, samples.pixel, samples.number, samples.result))
        if self.weights is not None:
            self._splat_waiting()

    def end_pass(self, frame):
        if self.waiting:
            self.weights = self._weights(frame)
            self._splat_waiting()

    def image(self, frame):
        if self.alpha is None:
            return self.colors.tensor()
        colors, alpha = np.array(self.colors.tensor()), np.array(self.alpha.tensor())
        return mi.TensorXf(np.concatenate([colors[..., :3], alpha[..., :1], colors[..., 3:]], axis=2))

    def _weights(self, frame):
        """Of the samples of the pass, which are the same for all of a pixel, by the numbers of the pixels."""
        pixels, weights = np.flatnonzero(self.counts).astype(np.uint32), np.zeros(self.counts.size, np.float32)
        weights[pixels] = frame.sample_weights(pixels, self.first[pixels])
        return array_of(mi.Float, weights)

    def _splat_waiting(self):
        while self.waiting:
            seed, pixel, number, result = self.waiting.pop(0)
            # Places are what a sample's numbers begin with, so that they need not be kept.
            place, _ = self.place(pixel, numbers_of(seed, pixel, number).of_camera())
            traced = dr.gather(mi.Vector4f, result, dr.arange(mi.UInt32, dr.width(pixel)))
            weight = dr.gather(mi.Float, self.weights, pixel)
            color = mi.Color3f(traced.x, traced.y, traced.z)
            color = dr.select(dr.all(dr.isfinite(color)), color * weight, 0)  # as the frame has it
            with dr.scoped_set_flag(dr.JitFlag.SymbolicLoops, False):  # unrolled, which is faster
                self.colors.put(place, [color.x, color.y, color.z, weight])
                if self.alpha is not None:
                    valid = dr.reinterpret_array(mi.UInt32, traced.w) >= VALID
                    self.alpha.put(place, [dr.select(valid, weight, 0), mi.Float(0)])
            dr.eval(self.colors.tensor(), self.alpha.tensor() if self.alpha is not None else None)
