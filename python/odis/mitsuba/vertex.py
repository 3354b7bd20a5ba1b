"""What a path decides at a vertex, whatever it lies on: steps that the loops of path.py and volume_path.py share."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi

import odis

from . import guide_tables
from .materials import GUIDABLE, HAS_DELTA, SEES_THROUGH

# Smoother surfaces end no paths: what they scatter depends too much on the direction. Nor do coats that are met at an
# angle of a smaller cosine: half of the draws at a cosine of 0.2 are mirrored, for an index of refraction of 1.5 over a
# diffuse reflectance of 0.5. Where light passes only diffuse surfaces do: what is refracted spreads over a quarter of
# the angle of a reflection of the same roughness, or less.
LEAST_CACHED_ROUGHNESS, LEAST_CACHED_COSINE = 0.3, 0.2


def power_heuristic(pdf, other):
    ratio = other / pdf
    return dr.select(pdf > 0, 1 / (1 + ratio * ratio), 0)


def to_rgb(spectrum, wavelengths):
    """The colour, linear with the primaries of sRGB, that a sample of radiance adds."""
    if mi.is_spectral:
        return mi.spectrum_to_srgb(spectrum, wavelengths)
    return mi.Color3f(spectrum)


def luminance_of(spectrum, wavelengths):
    return mi.luminance(to_rgb(spectrum, wavelengths))


@dataclass
class Before:
    """The vertex that a ray comes from, where there is one: what light that the ray meets is weighed by."""

    p: object
    n: object
    pdf: object  # of the direction
    bsdf_pdf: object  # that of the BSDF alone; counts where lights are uneven
    delta: object  # whether next-event estimation could not have found what is met, as what the camera's ray meets
    cell: object
    fraction: object  # of the choices of a light that are learned

    def interaction(self, ray):
        before = dr.zeros(mi.Interaction3f)
        before.p, before.n, before.time, before.wavelengths = self.p, self.n, ray.time, ray.wavelengths
        return before

    def weigh(self, lights, tables, ray, met, lit):
        """The MIS weight of light that was met (a DirectionSample3f), and the density of its choice by next-event
        estimation. Where the light is uneven the weight is that of `path` (uneven_lights.py)."""
        weighed, previous = lit & ~self.delta, self.interaction(ray)
        light_pdf = lights.pdf(tables, self.cell, self.fraction, previous, met, weighed)
        mis = dr.select(weighed, power_heuristic(self.pdf, light_pdf), 1)
        if lights.uneven is not None:
            plain = lights.pdf(None, None, None, previous, met, weighed)
            uneven = dr.gather(mi.Bool, lights.uneven, lights.place_of(met.emitter, weighed), weighed)
            mis = dr.select(uneven, power_heuristic(self.bsdf_pdf, plain), mis)
        return mis, light_pdf


def nothing_before():
    return Before(mi.Point3f(0), mi.Normal3f(0), mi.Float(1), mi.Float(1), mi.Bool(True), mi.UInt32(odis.NO_CELL),
                  mi.Float(0))


def weight_toward(lights, mis, place, choice, pdf, bsdf_pdf, active):
    """The weight of light that was sampled, with the density pdf that has the choice of its place in it: `mis`, or as
    `path` has it where the light is uneven."""
    if lights.uneven is None:
        return mis
    plain = pdf / choice * dr.gather(mi.Float, lights.probabilities, place, active)
    return dr.select(dr.gather(mi.Bool, lights.uneven, place, active), power_heuristic(plain, bsdf_pdf), mis)


def scatters_evenly(flags, roughness, cosine, least_roughness):
    """Whether what a vertex scatters depends so little on the direction that a path may end there with the mean."""
    return ((flags & (GUIDABLE | SEES_THROUGH)) == GUIDABLE) \
        & (((flags & HAS_DELTA) == 0) | (dr.abs(cosine) >= LEAST_CACHED_COSINE)) & (roughness >= least_roughness)


def end_in_cache(settings, tables, cell, sample, relative, footprint, depth, active):
    """The cached radiance that a path may end with, and whether it does. sample: numbers of pixel and sample."""
    # With an endless max_depth there are no shares, and the number of bounces left is not looked at.
    share = guide_tables.cached_share(tables, mi.UInt32(max(settings.max_depth, 1)) - 1 - depth, active)
    return guide_tables.cached_radiance(
        tables, cell, guide_tables.path_half(*sample), relative, footprint, share, active)


def play_on_arrival(tables, decisions, throughput, relative, depth, u, plays):
    """Roulette where the guide knows what the path would bring: the probability to go on, whether it does, and what is
    added for the paths that end, as a control variate."""
    survival = guide_tables.survival_probability(tables, decisions.survival_factor, relative, depth + 1)
    survival = dr.select(plays, survival, 1)
    stand_in = decisions.outgoing_radiance if not mi.is_spectral \
        else mi.Spectrum(mi.luminance(decisions.outgoing_radiance))
    goes_on = u < survival
    added = throughput * stand_in * dr.select(goes_on, 1 - 1 / survival, 1)
    return survival, goes_on, dr.select(plays & (survival < 1), added, 0)


def play_on_departure(settings, tables, most, eta, depth, cell, active):
    """The probability with which a path goes on by its throughput, where nothing was learned.

    most: the greatest channel of that."""
    plays = active & (most > 0) & (depth >= settings.rr_depth)
    survival = dr.minimum(most * eta * eta, 0.95)
    if tables is not None and settings.learned_roulette:
        plays &= cell == odis.NO_CELL
        survival = dr.maximum(survival, tables.least_survival)  # as on arrival
    return dr.select(plays, survival, 1)


class Mixture:
    """Directions of a cell's map, and of the BSDF or phase function. fraction: how often the latter draws; guided: where
    there is a map."""

    def __init__(self, tables, cell, fraction, guided):
        self.map, self.fraction, self.guided = guide_tables.SamplingMap(tables, cell), fraction, guided

    def choose(self, u):
        """Whether the map is to draw, and u stretched."""
        from_map = self.guided & (u >= self.fraction)
        u_within = dr.select(self.guided, dr.select(from_map, (u - self.fraction) / (1 - self.fraction),
                                                    u / self.fraction), u)
        return from_map, dr.minimum(u_within, guide_tables.ONE_MINUS_EPSILON)

    def pdf(self, direction, own_pdf, share_of_smooth, active):
        """The density of a direction, of own_pdf by the BSDF. share_of_smooth: how often that draws no delta lobe."""
        map_pdf = self.map.pdf(direction, self.guided & active)
        return dr.fma(1 - self.fraction, map_pdf * share_of_smooth - own_pdf, own_pdf)

    def take(self, drawn, discrete, from_map, map_direction, map_value, map_pdf, share_of_smooth):
        """What a vertex leaves by: `drawn`, of the BSDF, or the map's direction, with the weight that both make."""
        from_map = from_map & ~discrete
        wi, pdf = dr.select(from_map, map_direction, drawn.wi), dr.select(from_map, map_pdf, drawn.pdf)
        mixed = self.pdf(wi, pdf, share_of_smooth, ~discrete)
        reweighed = self.guided & ~discrete & (mixed > 0)
        weight = dr.select(from_map, map_value / mixed,
                           dr.select(reweighed, drawn.weight * (pdf / mixed), drawn.weight))
        return Bounce(wi, dr.select(reweighed, mixed, pdf), pdf, weight, from_map)


@dataclass
class Bounce:
    """The direction in which a path goes on."""

    wi: object
    pdf: object
    own_pdf: object  # of the BSDF or phase function
    weight: object
    from_map: object


def play_for_shadow_ray(tables, adds, cell, pixel_value):
    """The probability of tracing a shadow ray for light that adds so much luminance."""
    return dr.select(cell != odis.NO_CELL, guide_tables.shadow_ray_probability(tables, adds / pixel_value), 1)
