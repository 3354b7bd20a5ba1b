"""Participating media: what there is to know of a scene's, how far rays get in them, and what they leave of light."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

from .arrays import array_of, number_of
from .materials import GUIDABLE, LEAST_GUIDED_ROUGHNESS, SEES_THROUGH, SMOOTH, material_at, mean_of

# Shadow rays of which less is left are played for, so that those through dense media end.
LEAST_TRANSMITTANCE = 0.1


def media_of(scene, sensor=None):
    """The media of a scene, those of its sensors included, and that of a further sensor."""
    nodes = [*mi.traverse(scene).hierarchy, sensor and sensor.get_medium()]
    return [node for node in nodes if isinstance(node, mi.Medium)]


def nested_phases(phase):
    return [node for node in mi.traverse(phase).hierarchy if isinstance(node, mi.PhaseFunction) and node is not phase]


def mean_cosine_of_table(values):
    """The mean cosine of a `tabphase`, whose values lie evenly over [-1, 1] with straight lines between."""
    cosine = np.linspace(-1, 1, len(values))
    a, b, from_a, to_b = values[:-1], values[1:], cosine[:-1], cosine[1:]
    total = ((a + b) / 2).sum()
    return ((from_a * a + to_b * b) / 3 + (from_a * b + to_b * a) / 6).sum() / max(total, 1e-30)


def phase_roughness(phase):
    """1 - |mean cosine|; of a blend, the mean of both."""
    parameters, nested = mi.traverse(phase), nested_phases(phase)
    if phase.class_name() == "HGPhaseFunction":
        return 1 - min(abs(mean_of(parameters, "g")), 1)
    if phase.class_name() == "TabulatedPhaseFunction":
        return 1 - abs(mean_cosine_of_table(np.array(parameters["values"]).ravel()))
    if len(nested) >= 2:
        weight = mean_of(parameters, "weight.value")
        # A volume that is no single number: equal parts.
        weight = 0.5 if weight is None else min(max(weight, 0), 1)
        return (1 - weight) * phase_roughness(nested[0]) + weight * phase_roughness(nested[-1])
    return 1


def describe_phase(phase):
    """Flags and roughness, as of BSDFs. The density of Mitsuba's microflakes is not that of what they sample."""
    roughness = phase_roughness(phase)
    exact = not mi.has_flag(phase.flags(), mi.PhaseFunctionFlags.Microflake)
    return SMOOTH | (GUIDABLE if exact and roughness >= LEAST_GUIDED_ROUGHNESS else 0), roughness


@dataclass
class MediaTable:
    """What kernels know of the media of a scene."""

    entries: object  # UInt32: flags and roughness, by the numbers of phase functions in Dr.Jit's registry (material_at)
    any_homogeneous: bool
    any_heterogeneous: bool
    numbers: set  # of the media in Dr.Jit's registry


def make_media_table(media):
    """The table, and the class names of phase functions that are not guided."""
    found = {}
    for medium in media:
        phase = medium.phase_function()
        found[number_of(mi.PhaseFunctionPtr(phase))] = (phase.class_name(), *describe_phase(phase))
    entries = np.zeros(max(found, default=0) + 1, np.uint32)
    for number, (_, flags, roughness) in found.items():
        entries[number] = flags | int(round(roughness * 65535)) << 16
    homogeneous = [medium.is_homogeneous() for medium in media]
    table = MediaTable(array_of(mi.UInt32, entries), any(homogeneous), not all(homogeneous),
                       {number_of(mi.MediumPtr(medium)) for medium in media})
    dr.make_opaque(table)
    return table, sorted({name for name, flags, _ in found.values() if not flags & GUIDABLE})


def shares_of(throughput):
    """How much each channel counts where one decision is taken for all of them."""
    amount = dr.abs(throughput)
    total = dr.sum(amount)
    return dr.select(total > 0, amount / total, 1 / len(amount))


def channel_of(shares, u):
    """A channel by its share. Mitsuba draws distances for the first wavelength of a spectrum alone."""
    if mi.is_spectral:
        return mi.Spectrum(1, 0, 0, 0), mi.UInt32(0)
    return shares, dr.select(u < shares[0], mi.UInt32(0), dr.select(u < shares[0] + shares[1], mi.UInt32(1), 2))


def optical_depth(extinction, distance):
    """That of a homogeneous medium, which may be empty and without an end."""
    return dr.select(extinction > 0, extinction * distance, 0)


@dataclass
class Flight:
    """How far a ray gets."""

    si: object  # SurfaceInteraction3f: what it meets if nothing scatters it before
    scattered: object  # Bool: in the medium, at
    p: object  # Point3f
    distance: object  # Float: to there, or to the surface
    weight: object  # Spectrum: transmittance, times the scattering coefficient where scattered, over the probability
    drawn: object  # UInt32: numbers of the path drawn by now


@dr.syntax
def fly(scene, media, ray, medium, throughput, u, numbers, drawn, active):
    """Draws how far a ray gets: in homogeneous media in closed form, in others by delta tracking.

    One distance is drawn for all channels, by one of them, and weighed by the densities with which each of them would
    have drawn it (one-sample MIS). u: uniform in [0, 1).
    """
    inside = active & (medium != None)
    shares, channel = channel_of(shares_of(throughput), numbers.further(drawn))
    drawn = drawn + 1
    event = medium.sample_interaction(ray, u, channel, inside)
    closed = inside & medium.is_homogeneous()
    until = mi.Ray3f(ray)
    until.maxt = dr.select(closed & event.is_valid(), event.t, ray.maxt)
    si = scene.ray_intersect(until, mi.RayFlags.All, coherent=False, active=active)
    scattered = inside & event.is_valid() & (event.t < si.t)
    weight, p, distance = mi.Spectrum(1), mi.Point3f(event.p), mi.Float(event.t)
    if dr.hint(media.any_homogeneous, mode="scalar"):
        extinction = mi.Spectrum(event.combined_extinction)
        passing = mi.Spectrum(dr.exp(-optical_depth(extinction, dr.select(scattered, distance, si.t))))
        density = dr.sum(shares * dr.select(scattered, extinction * passing, passing))
        value = dr.select(scattered, mi.Spectrum(event.sigma_s) * passing, passing)
        weight = dr.select(closed, dr.select(density > 0, value / density, 0), weight)
    if dr.hint(media.any_heterogeneous, mode="scalar"):
        tracking = scattered & ~closed
        scattered &= closed
        majorant = mi.Float(event.combined_extinction[0])
        sigma_s, sigma_n = mi.Spectrum(event.sigma_s), mi.Spectrum(event.sigma_n)
        onward = mi.Ray3f(ray)
        while dr.hint(tracking, label="odis: tracking", exclude=[scene, media, numbers]):
            empty = sigma_n / majorant
            passes = dr.clip(dr.sum(shares_of(throughput * weight) * empty), 0, 1)
            stops = numbers.further(drawn) >= passes
            factor = dr.select(stops, sigma_s / (majorant * (1 - passes)), empty / passes)
            weight = dr.select(tracking, weight * factor, weight)
            scattered |= tracking & stops
            tracking &= ~stops & dr.any(weight != 0)
            onward.o = p
            event = medium.sample_interaction(onward, numbers.further(drawn + 1), mi.UInt32(0), tracking)
            drawn += 2
            tracking &= event.is_valid() & (distance + event.t < si.t)
            p, distance = dr.select(tracking, event.p, p), dr.select(tracking, distance + event.t, distance)
            majorant = mi.Float(event.combined_extinction[0])
            sigma_s, sigma_n = mi.Spectrum(event.sigma_s), mi.Spectrum(event.sigma_n)
    return Flight(si, scattered, p, dr.select(scattered, distance, si.t), weight, drawn)


@dr.syntax
def transmittance(scene, known, ray, medium, numbers, drawn, active):
    """What is left of light on its way along a ray of some length, through media and what light passes straight. Returns
    it, how many rays that took, and the numbers drawn by now.

    In homogeneous media it is computed, in others estimated by ratio tracking.
    """
    media = known.media
    left, rays, length = mi.Spectrum(1), mi.UInt32(0), mi.Float(ray.maxt)
    active = mi.Bool(active)
    while dr.hint(active, label="odis: shadow rays", exclude=[scene, known, media, numbers]):
        ray.maxt = length
        si = scene.ray_intersect(ray, mi.RayFlags.All, coherent=False, active=active)
        rays += dr.select(active, mi.UInt32(1), 0)
        met = active & si.is_valid()
        bsdf = si.bsdf(ray)
        flags, _ = material_at(known.materials, bsdf, met)
        passes = met & ((flags & SEES_THROUGH) != 0)
        left = dr.select(met & ~passes, 0, left)
        active &= passes | ~met
        through = bsdf.eval_null_transmission(si, passes)
        left = dr.select(passes, left * through, left)
        active &= dr.any(left != 0)

        segment = dr.minimum(si.t, length)
        inside = active & (medium != None)
        if dr.hint(media.any_homogeneous, mode="scalar"):
            closed = inside & medium.is_homogeneous()
            of_medium = dr.zeros(mi.MediumInteraction3f)
            of_medium.wi, of_medium.p, of_medium.wavelengths = -ray.d, ray.o, ray.wavelengths
            extinction = mi.Spectrum(medium.get_majorant(of_medium, closed))
            passing = mi.Spectrum(dr.exp(-optical_depth(extinction, segment)))
            left = dr.select(closed, left * passing, left)
            inside &= ~closed
        if dr.hint(media.any_heterogeneous, mode="scalar"):
            tracking, distance = mi.Bool(inside), mi.Float(0)
            onward = mi.Ray3f(ray)
            while dr.hint(tracking, label="odis: ratio tracking", exclude=[scene, known, media, numbers]):
                event = medium.sample_interaction(onward, numbers.further(drawn), mi.UInt32(0), tracking)
                distance += event.t
                tracking &= event.is_valid() & (distance < segment)
                left = dr.select(tracking, left * mi.Spectrum(event.sigma_n / event.combined_extinction), left)
                onward.o = dr.select(tracking, event.p, onward.o)
                # Roulette where little is left.
                most = dr.max(dr.abs(left))
                little = tracking & (most < LEAST_TRANSMITTANCE)
                goes_on = numbers.further(drawn + 1) * LEAST_TRANSMITTANCE < most
                left = dr.select(little, dr.select(goes_on, left * (LEAST_TRANSMITTANCE / most), 0), left)
                tracking &= ~little | goes_on
                drawn += 2
        # On to what lies beyond.
        active &= passes & dr.any(left != 0)
        medium = dr.select(active & si.is_medium_transition(), si.target_medium(ray.d), medium)
        beyond = si.spawn_ray(ray.d)
        length = dr.select(active, length - si.t, length)
        ray = dr.select(active, beyond, ray)
        active &= length > 0
    return left, rays, drawn
