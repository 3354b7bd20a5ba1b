"""The choice of an emitter for next-event estimation: as Mitsuba chooses, or by what a guide learned of groups."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

import odis

from .arrays import array_of
from .environment import REGIONS, make_environment
from .guide_tables import choose_group
from .uneven_lights import is_uneven

MOST_GROUPS = 32


@dataclass
class LightTable:
    """Emitters in the order of their groups, 32 bytes each. Each region of the environment has a place of its own; they
    come first."""

    environment: object  # Environment or None
    emitters: object  # EmitterPtr, by place
    probabilities: object  # Float, by place: with which Mitsuba chooses it
    cdf: object  # Float, [places + 1]: sums of that
    group_begin: object  # UInt32, [groups + 1]: first place of a group
    place: object  # UInt32, by number in Dr.Jit's registry
    # UInt32 [place][4]: the group, and as bits of floats Mitsuba's probability and its share of that of the group.
    of_place: object
    uneven: object  # Bool, by place: weighed as `path` does; None where no emitter is (uneven_lights.py)
    count: int  # of emitters
    groups: int  # that are learned about; 0 where there is nothing to choose

    def choose(self, tables, cell, fraction, u, active):
        """Chooses an emitter by u, uniform in [0, 1): its place and the probability of that place."""
        if self.count == 1:
            return mi.UInt32(0), mi.Float(1)
        if tables is not None and self.groups:
            learned = active & (u < fraction)
            u = dr.select(learned, u / fraction, (u - fraction) / (1 - fraction))
            group, within = choose_group(tables, cell, self.groups, u, learned)
            low, high = self._cdf_of_group(group, learned)
            u = dr.select(learned, dr.fma(within, high - low, low), u)
        place = mi.UInt32(dr.binary_search(
            0, self.count - 1, lambda i: dr.gather(mi.Float, self.cdf, i + 1, active) <= u))
        return place, self.probability(tables, cell, fraction, place, active)

    def probability(self, tables, cell, fraction, place, active):
        """The probability with which `choose` gives a place."""
        if self.count == 1:
            return mi.Float(1)
        if tables is None or not self.groups:
            return dr.gather(mi.Float, self.probabilities, place, active)
        group, plain, share = self._of_place(place, active)
        learned = active & (fraction > 0)
        share *= dr.gather(mi.Float, tables.group_probabilities, cell * self.groups + group, learned)
        return dr.select(learned, dr.fma(fraction, share - plain, plain), plain)

    def _of_place(self, place, active):
        group, plain, share, _ = dr.gather(mi.ArrayXu, self.of_place, place, active, shape=(4, -1))
        return group, dr.reinterpret_array(mi.Float, plain), dr.reinterpret_array(mi.Float, share)

    @property
    def regions(self):
        """The number of places that are regions of the environment."""
        return self.environment.regions if self.environment is not None else 0

    @property
    def parts(self):
        """Which groups are parts of one light, as odis.GuideOptions has it."""
        return [(0, REGIONS)] if self.regions and self.groups else []

    def sample(self, tables, cell, fraction, si, u, v, active):
        """Chooses a light and samples a direction toward it, for next-event estimation at an interaction.

        u: uniform in [0, 1); v: Point2f. Returns the place; with which probability it is chosen; the DirectionSample3f,
        whose pdf has the choice in it; and the radiance from there over this pdf, if nothing hides it.
        """
        place, choice = self.choose(tables, cell, fraction, u, active)
        toward, light = dr.zeros(mi.DirectionSample3f), mi.Spectrum(0)
        of_emitter = active & (place >= self.regions)
        if self.count > self.regions:
            emitter = dr.gather(mi.EmitterPtr, self.emitters, place, of_emitter)
            toward, light = emitter.sample_direction(si, v, of_emitter)
            toward.pdf *= choice
            light /= choice
        if self.environment is not None:
            far = active & (place < self.regions)
            direction = self.environment.sample(place, v, far)
            pdf = self.environment_pdf(tables, cell, fraction, direction, far)
            radiance = self.environment.radiance(si, direction, far)
            toward.d, toward.pdf = dr.select(far, direction, toward.d), dr.select(far, pdf, toward.pdf)
            toward.p = dr.select(far, self.environment.place_beyond(si.p, direction), toward.p)
            toward.delta &= ~far
            light = dr.select(far, dr.select(pdf > 0, radiance / pdf, 0), light)
        return place, choice, toward, light

    def pdf(self, tables, cell, fraction, reference, met, active):
        """The density with which `sample` gives the direction in which light was met: a DirectionSample3f."""
        pdf, of_emitter = mi.Float(0), mi.Bool(active)
        if self.environment is not None:
            far = active & met.emitter.is_environment()
            of_emitter &= ~far
            pdf = self.environment_pdf(tables, cell, fraction, met.d, far)
        if self.count > self.regions:
            place = self.place_of(met.emitter, of_emitter)
            pdf = dr.select(of_emitter, met.emitter.pdf_direction(reference, met, of_emitter)
                            * self.probability(tables, cell, fraction, place, of_emitter), pdf)
        return pdf

    def place_of(self, emitter, active):
        return dr.gather(mi.UInt32, self.place, dr.reinterpret_array(mi.UInt32, emitter), active)

    def environment_pdf(self, tables, cell, fraction, direction, active):
        region, density = self.environment.region_and_density(direction, active)
        pdf = density * self.probability(tables, cell, fraction, region, active)
        if self.environment.sun is not None:
            in_sun = active & self.environment.sun.contains(direction)
            pdf += dr.select(in_sun, self.environment.sun.density * self.probability(
                tables, cell, fraction, mi.UInt32(REGIONS), in_sun), 0)
        return pdf

    def group_of(self, place, probability, active):
        """The group of a place that was chosen with this probability, and the probability of the group."""
        if not self.groups:
            return mi.UInt32(odis.NO_LIGHT_GROUP), mi.Float(0)
        group, _, share = self._of_place(place, active)
        return dr.select(active, group, odis.NO_LIGHT_GROUP), dr.select(share > 0, probability / share, 0)

    def _cdf_of_group(self, group, active):
        """Where a group begins and ends in the sums of Mitsuba's probabilities."""
        return (dr.gather(mi.Float, self.cdf, dr.gather(mi.UInt32, self.group_begin, group + i, active), active)
                for i in range(2))


def split_groups(centers, most):
    """Splits points into at most so many groups of neighbours: halves the largest one along its longest axis."""
    groups = [np.arange(len(centers))]
    while len(groups) < most:
        largest = max(range(len(groups)), key=lambda i: len(groups[i]))
        members = groups[largest]
        if len(members) < 2:
            break
        points = centers[members]
        axis = np.argmax(points.max(0) - points.min(0))
        order = members[np.argsort(points[:, axis], kind="stable")]
        groups[largest:largest + 1] = [order[:len(order) // 2], order[len(order) // 2:]]
    return groups


def center_of(emitter):
    center = np.asarray(emitter.bbox().center()).ravel()
    return center if np.isfinite(center).all() else np.zeros(3)


def make_groups(emitters, numbers, most):
    """Numbers of emitters, in at most so many groups of neighbours: each infinite one by itself if these are few."""
    infinite = [i for i in numbers if mi.has_flag(emitters[i].flags(), mi.EmitterFlags.Infinite)]
    finite = np.array([i for i in numbers if i not in infinite], int)
    groups = [[i] for i in infinite[:7]] + ([infinite[7:]] if infinite[7:] else [])
    if finite.size:
        centers = np.array([center_of(emitters[i]) for i in finite])
        groups += [list(finite[members]) for members in split_groups(centers, most - len(groups))]
    return groups


def make_light_table(scene):
    """The emitters of a scene, in groups of neighbours. Without emitters it has a null one, which gives no light."""
    emitters, environment = scene.emitters(), make_environment(scene)
    weights = np.array([float(np.asarray(e.sampling_weight()).ravel()[0]) for e in emitters] or [0.0])
    regions = environment.probabilities if environment is not None else []
    # Places, as numbers of emitters: regions of the environment first, then the other emitters.
    far = [i for i, emitter in enumerate(emitters) if regions and emitter.is_environment()]
    groups = [far for _ in regions] + make_groups(
        emitters, [i for i in np.flatnonzero(weights > 0) if i not in far], MOST_GROUPS - len(regions)) or [[0]]
    order = [i for members in groups for i in members]
    # Emitters that are never chosen come last, as if they were of the first group, outside its range.
    order += [i for i in range(len(weights)) if i not in order]
    probabilities = weights[order] / max(weights.sum(), 1e-30)
    probabilities[:len(regions)] *= regions
    numbers = np.array(dr.reinterpret_array(mi.UInt32, scene.emitters_dr()))[order] if emitters else np.zeros(1, int)
    place = np.zeros(int(numbers.max()) + 1, np.uint32)
    place[numbers] = np.arange(len(numbers))
    begin = np.cumsum([0] + [len(members) for members in groups])
    uneven = np.array([is_uneven(emitter) for emitter in emitters] or [False])[order]
    whole = lambda values: array_of(mi.UInt32, np.asarray(values, np.uint32))
    real = lambda values: array_of(mi.Float, np.asarray(values, np.float32))
    group = np.append(np.repeat(np.arange(len(groups)), np.diff(begin)), [0] * (len(order) - begin[-1])).astype(int)
    of_group = np.bincount(group, probabilities, len(groups))[group]
    share = np.divide(probabilities, of_group, out=np.zeros(len(order)), where=of_group > 0)
    bits = lambda values: np.asarray(values, np.float32).view(np.uint32)
    of_place = np.stack([group, bits(probabilities), bits(share), 0 * group], axis=1)
    table = LightTable(
        environment=environment, emitters=dr.reinterpret_array(mi.EmitterPtr, mi.UInt32(numbers)),
        probabilities=real(probabilities), cdf=real(np.concatenate([[0], np.cumsum(probabilities)])),
        group_begin=whole(begin), place=whole(place), of_place=whole(of_place),
        uneven=array_of(mi.Bool, uneven) if uneven.any() else None,
        count=len(order), groups=len(groups) if len(groups) > 1 else 0)
    dr.make_opaque(table)
    return table
