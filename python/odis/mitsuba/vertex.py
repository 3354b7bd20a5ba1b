"""What a path decides at a vertex, whatever it lies on: steps that the loops of path.py and volume_path.py share."""

import drjit as dr
import mitsuba as mi

import odis

from . import guide_tables


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


def weight_of_met(lights, mis, bsdf_pdf, previous, met, active):
    """The weight of light that was met: `mis`, or as `path` has it where the light is uneven (uneven_lights.py)."""
    if lights.uneven is None:
        return mis
    plain = lights.pdf(None, None, None, previous, met, active)
    uneven = dr.gather(mi.Bool, lights.uneven, lights.place_of(met.emitter, active), active)
    return dr.select(uneven, power_heuristic(bsdf_pdf, plain), mis)


def weight_toward(lights, mis, place, choice, pdf, bsdf_pdf, active):
    """The same of light that was sampled, with the density pdf that has the choice of its place in it."""
    if lights.uneven is None:
        return mis
    plain = pdf / choice * dr.gather(mi.Float, lights.probabilities, place, active)
    return dr.select(dr.gather(mi.Bool, lights.uneven, place, active), power_heuristic(plain, bsdf_pdf), mis)


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
    """The probability with which a path goes on by its throughput, where nothing was learned. most: its greatest channel."""
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


def play_for_shadow_ray(tables, adds, cell, pixel_value):
    """The probability of tracing a shadow ray for light that adds so much luminance."""
    return dr.select(cell != odis.NO_CELL, guide_tables.shadow_ray_probability(tables, adds / pixel_value), 1)
