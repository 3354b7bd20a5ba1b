"""Places on the film around pixels' centres, drawn by a reconstruction filter."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

from .arrays import array_of

STEPS = 256


@dataclass
class FilmFilter:
    """A film's reconstruction filter. As with `path`, a pixel at the border of what the film shows sees nothing of what
    lies beyond, unless the film has `sample_border`: the part of the filter on the film counts as the whole."""

    rfilter: object
    size: object  # of what the film shows, in pixels
    quantiles: object  # Float [STEPS + 1]: offsets that divide the filter's absolute value into equal parts; None: a box
    integral: float  # of the filter
    reach: int  # of so many pixels along a border it reaches beyond
    # Float [2 (reach + 1)]: for a pixel with 0, 1, ... others before the border the probability of an offset toward it
    # that stays on the film, and the part of the integral there. None where the filter ends before the border.
    sides: object

    def sample(self, pixel, draws):
        """An offset from a pixel's centre, and its weight: the filter over the density of the offset."""
        if self.quantiles is None:
            return draws.next_2d() - 0.5, mi.Float(1)
        offset, weight, numbers = mi.Vector2f(0), mi.Float(1), draws.next_2d()
        for axis in range(2):
            u = numbers[axis]
            if self.sides is not None:
                drawn, share = self._side(pixel[axis])
                drawn_after, share_after = self._side(self.size[axis] - 1 - pixel[axis])
                u = dr.fma(u, drawn + drawn_after, 0.5 - drawn)
                weight *= (drawn + drawn_after) / (share + share_after)
            u *= STEPS
            step = dr.minimum(mi.UInt32(u), STEPS - 1)
            low, high = dr.gather(mi.Float, self.quantiles, step), dr.gather(mi.Float, self.quantiles, step + 1)
            offset[axis] = dr.lerp(low, high, u - mi.Float(step))
            weight *= self.rfilter.eval(offset[axis]) * (high - low) * (STEPS / self.integral)
        return offset, weight

    def _side(self, pixels):
        return dr.gather(mi.Vector2f, self.sides, dr.minimum(pixels, self.reach))


def make_film_filter(film):
    rfilter, size = film.rfilter(), film.crop_size()
    if rfilter.is_box_filter():
        return FilmFilter(rfilter, size, None, 1.0, 0, None)
    radius = rfilter.radius()
    x = np.linspace(-radius, radius, 4097)
    values = np.array(rfilter.eval(mi.Float(x.astype(np.float32))), np.float64)
    middle = (np.abs(values[1:]) + np.abs(values[:-1])) / 2
    cdf = np.concatenate([[0], np.cumsum(middle)]) + 1e-9 * np.arange(x.size)
    quantiles = np.interp(np.linspace(0, cdf[-1], STEPS + 1), cdf, x)
    integral = float(values.sum() * (x[1] - x[0]))
    reach = 0 if film.sample_border() else int(np.ceil(radius - 0.5))
    if reach > 0:
        border = np.arange(reach) + 0.5
        drawn = np.interp(border, quantiles, np.linspace(0, 1, STEPS + 1)) - 0.5
        sums = np.concatenate([[0], np.cumsum(values[1:] + values[:-1])]) / 2 * (x[1] - x[0]) / integral
        share = np.interp(border, x, sums) - 0.5
        sides = np.append(np.stack([drawn, share], axis=1), [[0.5, 0.5]], axis=0)
    return FilmFilter(rfilter, size, array_of(mi.Float, quantiles.astype(np.float32)), integral, reach,
                      array_of(mi.Float, sides.astype(np.float32)) if reach > 0 else None)
