"""An environment's directions for next-event estimation: tables of its radiance, in regions that a guide chooses among."""

import re
from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

from .arrays import array_of
from .guide_tables import ONE_MINUS_EPSILON, direction_to_square, square_to_direction

REGIONS = 16  # a power of two
# Texels along a side of the table; an image of more pixels is as good as averaged within them.
LEAST_SIDE, MOST_SIDE = 128, 1024
POINTS = 1 << 22  # at which the radiance is asked for, about
UNIFORM = 0.01  # share of the directions that are uniform, so that every region has some
# By how much 1 - cosine of an angle is off in single precision, some ulps of 1. Mitsuba's `eval` sees the sun where that
# of the angle to its centre says so, within a disk that is some .5 % larger or smaller than the one it samples.
ROUNDING = 2.5e-7


@dataclass
class Sun:
    """The cone of directions that `sunsky` sends the sun's light from. Numbers are differences from 1 where these are
    small, which rounding would spoil otherwise."""

    axis: object  # Vector3f, unit, in the world
    height: object  # Float: 1 - cosine of the half angle, as Mitsuba samples it
    density: object  # Float: of uniform directions in the cone, over solid angle

    def sample(self, u):
        below = u.x * self.height
        sine = dr.safe_sqrt(below * (2 - below))
        sin_phi, cos_phi = dr.sincos(dr.two_pi * u.y)
        return dr.normalize(mi.Frame3f(self.axis).to_world(mi.Vector3f(cos_phi * sine, sin_phi * sine, 1 - below)))

    def contains(self, direction):
        """Whether a direction is, or may by rounding be taken for one, of the cone."""
        return dr.squared_norm(direction - self.axis) <= 2 * (self.height + ROUNDING)

    def seen(self, direction):
        """A direction of the cone, away from the border, where `eval` may not see the sun; others as they are."""
        offset = direction - self.axis
        most = 2 * dr.maximum(self.height - ROUNDING, 0)
        shrink = dr.minimum(1, dr.sqrt(most / dr.maximum(dr.squared_norm(offset), 1e-30)))
        return dr.select(self.contains(direction), dr.normalize(self.axis + offset * shrink), direction)


@dataclass
class Environment:
    """Texels of Clarberg's map of all directions, in rectangles of about the same radiance: the regions.

    The sun, where there is one, is a region of its own after them. 20 bytes a texel.
    """

    emitter: object  # mi.Emitter
    center: object  # Point3f: of the scene's bounding sphere
    radius: object  # Float
    side: object  # UInt32: texels along a side
    # UInt32 [entry][3]: alias tables, one for each region over its texels: a texel, another one, and the probability of
    # the first as bits of a float.
    alias: object
    first: object  # UInt32 [region + 1]: first entry of a region
    # UInt32 [texel][2]: region, and as bits of a float the density within that region, over solid angle.
    texels: object
    probabilities: list  # of the regions: shares of the emitter's choices
    sun: object  # Sun or None

    @property
    def regions(self):
        return len(self.probabilities)

    def sample(self, region, u, active):
        """A unit direction within a region by u (Point2f), uniform in [0, 1)²."""
        is_sun = region == REGIONS
        begin = dr.gather(mi.UInt32, self.first, region, active & ~is_sun)
        count = dr.gather(mi.UInt32, self.first, region + 1, active & ~is_sun) - begin
        scaled = u.x * mi.Float(count)
        entry = dr.minimum(mi.UInt32(scaled), count - 1)
        x = scaled - mi.Float(entry)
        own, other, bits = dr.gather(mi.Vector3u, self.alias, begin + entry, active & ~is_sun)
        part = dr.reinterpret_array(mi.Float, bits)
        itself = x < part
        x = dr.minimum(dr.select(itself, x / part, (x - part) / (1 - part)), ONE_MINUS_EPSILON)
        texel = dr.select(itself, own, other)
        direction = square_to_direction((mi.Float(texel % self.side) + x) / mi.Float(self.side),
                                        (mi.Float(texel // self.side) + u.y) / mi.Float(self.side))
        if self.sun is not None:
            direction = dr.select(is_sun, self.sun.sample(u), direction)
        return direction

    def region_and_density(self, direction, active):
        """The region of the sky that a direction lies in, and its density there; the sun apart."""
        x, y = direction_to_square(direction)
        last = self.side - 1
        column = dr.minimum(mi.UInt32(x * mi.Float(self.side)), last)
        row = dr.minimum(mi.UInt32(y * mi.Float(self.side)), last)
        region, bits = dr.gather(mi.Point2u, self.texels, row * self.side + column, active)
        return region, dr.select(active, dr.reinterpret_array(mi.Float, bits), 0)

    def radiance(self, si, direction, active):
        """What arrives at an interaction from a direction, if nothing hides it."""
        if self.sun is not None:
            direction = self.sun.seen(direction)
        seen = dr.zeros(mi.SurfaceInteraction3f)
        seen.wi, seen.wavelengths, seen.time = -direction, si.wavelengths, si.time
        return self.emitter.eval(seen, active)

    def place_beyond(self, p, direction):
        """A place outside of the scene in a direction."""
        return p + direction * (2 * dr.maximum(self.radius, dr.norm(p - self.center)))


def luminance_of(emitter, direction):
    """Of the radiance from directions, in numpy; what is negative or no number counts as none."""
    seen = dr.zeros(mi.SurfaceInteraction3f, dr.width(direction))
    seen.wi = -direction
    if mi.is_spectral:
        seen.wavelengths, weight = mi.sample_rgb_spectrum(mi.sample_shifted(mi.Float(0.5)))
        color = mi.spectrum_to_srgb(emitter.eval(seen) * weight, seen.wavelengths)
    else:
        color = emitter.eval(seen)
    values = np.array(mi.luminance(color), np.float64)
    return np.broadcast_to(np.where(np.isfinite(values) & (values > 0), values, 0), dr.width(direction)).copy()


def find_sun(emitter):
    """The cone of the sun of `sunsky`; None of other emitters, and where it does not shine: too small a sun does not."""
    if emitter.class_name() != "SunskyEmitter":
        return None
    parameters = mi.traverse(emitter)
    aperture = re.search(r"Sun aperture = ([0-9.e+-]+)", str(emitter))
    if aperture is None or parameters["sun_scale"] <= 0:
        return None
    axis = np.array(parameters["sun_direction"], np.float64).ravel()
    height = 1 - float(np.float32(np.cos(np.radians(float(aperture[1])) / 2)))
    if height <= 0:
        return None
    return Sun(mi.Vector3f(*map(float, axis / np.linalg.norm(axis))), mi.Float(height),
               mi.Float(1 / (2 * np.pi * height)))


def image_size(emitter):
    """The number of pixels of an environment's image, 0 without one."""
    data = mi.traverse(emitter).get("data")
    return data.shape[0] * data.shape[1] if data is not None else 0


def tabulate(emitter, side, sun):
    """Mean luminance within the texels [row][column], without the sun, and the mean of the sun's over the sphere."""
    steps = max(1, int(np.sqrt(POINTS) / side))
    row, column = dr.meshgrid(dr.arange(mi.Float, side * steps), dr.arange(mi.Float, side * steps), indexing="ij")
    direction = square_to_direction((column + 0.5) / (side * steps), (row + 0.5) / (side * steps))
    values, of_sun = luminance_of(emitter, direction), 0.0
    if sun is not None:
        values[np.array(sun.contains(direction))] = 0
        u = (np.arange(64, dtype=np.float32) + 0.5) / 64
        y, x = (axis.ravel() for axis in np.meshgrid(u, u, indexing="ij"))
        in_cone = luminance_of(emitter, sun.sample(mi.Point2f(mi.Float(x), mi.Float(y)))).mean()
        of_sun = in_cone * float(sun.height[0]) / 2
    return values.reshape(side, steps, side, steps).mean(axis=(1, 3)), of_sun


def split_regions(weights, count):
    """Divides a table of weights into `count` rectangles of about the same sum: for each texel its region."""
    regions = np.zeros(weights.shape, np.uint32)
    boxes = [(0, weights.shape[0], 0, weights.shape[1])]
    while len(boxes) < count:
        # The first one that is more than a texel, so that no region is empty.
        top, bottom, left, right = boxes.pop(next(i for i, b in enumerate(boxes) if (b[1] - b[0]) * (b[3] - b[2]) > 1))
        along_rows = bottom - top >= right - left
        sums = np.cumsum(weights[top:bottom, left:right].sum(axis=1 if along_rows else 0))
        at = int(np.clip(np.searchsorted(sums, sums[-1] / 2) + 1, 1, sums.size - 1))
        boxes += [(top, top + at, left, right), (top + at, bottom, left, right)] if along_rows else \
            [(top, bottom, left, left + at), (top, bottom, left + at, right)]
    for region, (top, bottom, left, right) in enumerate(boxes):
        regions[top:bottom, left:right] = region
    return regions


def alias_table(weights):
    """An alias table (Walker 1977): for each entry the probability that it stands for itself, and what it stands for
    otherwise.

    Entries that have too little are filled, in order, from those that have too much; one of these that is left with
    too little itself is filled from the next. So all follows from running sums of what is missing and what is over.
    """
    scaled = weights * (weights.size / weights.sum())
    part, other = np.ones(weights.size), np.arange(weights.size)
    small, large = np.flatnonzero(scaled < 1), np.flatnonzero(scaled >= 1)
    if not small.size or not large.size:
        return part, other
    missing, over = np.cumsum(1 - scaled[small]), np.cumsum(scaled[large] - 1)
    last = large.size - 1
    giver = np.minimum(np.searchsorted(over, np.append(0, missing[:-1]), side="right"), last)
    part[small], other[small] = scaled[small], large[giver]
    taker = np.searchsorted(missing, over, side="left")  # the one that takes the last of what is over
    given = (taker < small.size) & (np.arange(large.size) < last)
    part[large[given]] = np.clip(1 - (missing[taker[given]] - over[given]), 0, 1)
    other[large[:-1]] = large[1:]
    return part, other


def make_tables(texels):
    """Alias tables [entry][3], the first entry of each region, and [texel][2], as Environment has them; and the
    regions' shares of all radiance. texels: mean luminance [row][column]."""
    side, mean = len(texels), texels.mean()
    # Multiple importance sampling leaves what is not brighter than the mean to directions of surfaces (Karlík et al.
    # 2019, "MIS Compensation").
    brighter = np.maximum(texels - mean, 0)
    weights = brighter if brighter.sum() > UNIFORM * texels.sum() else texels
    weights = weights / weights.mean() * (1 - UNIFORM) + UNIFORM if weights.any() else np.ones_like(texels)
    regions = split_regions(weights, REGIONS)
    order = np.argsort(regions, axis=None, kind="stable")
    first = np.searchsorted(regions.ravel()[order], np.arange(REGIONS + 1))
    weights, shares = weights.ravel(), np.zeros(REGIONS)
    alias, density = np.empty((side * side, 3), np.uint32), np.empty(side * side, np.float32)
    for region in range(REGIONS):
        entries = slice(first[region], first[region + 1])
        members = order[entries]
        part, other = alias_table(weights[members])
        alias[entries] = np.stack([members, members[other], part.astype(np.float32).view(np.uint32)], axis=1)
        total = weights[members].sum()
        density[members] = weights[members] / total * (side * side / (4 * np.pi))
        shares[region] = total / weights.sum()
    return alias, first, np.stack([regions.ravel(), density.view(np.uint32)], axis=1), shares


def make_environment(scene):
    """The tables of a scene's environment; None without one, or where Mitsuba never chooses it."""
    emitter = scene.environment()
    if emitter is None or float(np.asarray(emitter.sampling_weight()).ravel()[0]) <= 0:
        return None
    side = LEAST_SIDE
    while side < MOST_SIDE and side * side < image_size(emitter):
        side *= 2
    sun = find_sun(emitter)
    texels, of_sun = tabulate(emitter, side, sun)
    alias, first, table, shares = make_tables(texels)
    if sun is not None:
        # As often as it adds to the light from all directions, but neither is left out.
        of_sun = np.clip(of_sun / max(of_sun + texels.mean(), 1e-30), 0.1, 0.9)
        shares = np.append(shares * (1 - of_sun), of_sun)
    sphere = scene.bbox().bounding_sphere() if scene.bbox().valid() else mi.ScalarBoundingSphere3f([0, 0, 0], 0)
    environment = Environment(
        emitter, mi.Point3f(*map(float, sphere.center)), mi.Float(max(float(sphere.radius), 1e-3) * 1.01),
        mi.UInt32(side), array_of(mi.UInt32, alias), array_of(mi.UInt32, first.astype(np.uint32)),
        array_of(mi.UInt32, table), shares.tolist(), sun)
    dr.make_opaque(environment.center, environment.radius, environment.side)
    if sun is not None:
        dr.make_opaque(sun)
    return environment
