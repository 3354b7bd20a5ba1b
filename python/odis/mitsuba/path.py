"""The path tracer: Mitsuba's `path`, with every decision that an odis guide makes."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi

import odis

from . import guide_tables, recording, vertex
from .arrays import number_of
from .materials import BOTH_SIDES, GUIDABLE, HAS_DELTA, SEES_THROUGH, SMOOTH, material_at
from .random_numbers import RandomNumbers
from .vertex import luminance_of, power_heuristic, to_rgb

VALID = 1 << 31  # marks samples in Samples.result, beside their number of rays
RECORDED = 1 << 31  # marks samples in Samples.chosen whose vertices are recorded


@dataclass
class Settings:
    """What is the same for all paths, known when kernels are compiled; as in `path`."""

    max_depth: int  # 1 is emission that the camera sees; -1 is no limit
    rr_depth: int
    hide_emitters: bool
    guide_bounces: int = -1  # how many vertices of a path are guided; -1: all
    learned_roulette: bool = True  # whether guided paths end by the light that comes back; by throughput otherwise
    shadow_roulette: bool = True  # whether guided paths' shadow rays are played for
    volumetric: bool = False  # as of `volpath`, even without media


@dataclass
class SceneTables:
    """What kernels read of a scene beside the scene itself."""

    materials: object  # MaterialTable
    lights: object  # LightTable
    media: object = None  # MediaTable; None where paths are those of `path`

    def has_medium_of(self, sensor):
        medium = sensor.get_medium()
        return medium is None or (self.media is not None and number_of(mi.MediumPtr(medium)) in self.media.numbers)


@dataclass
class Samples:
    """Samples, and which of them a kernel traces."""

    pixel: object  # UInt32 [sample]
    number: object  # UInt32 [sample]: in its pixel
    pixel_values: object  # Float [pixel]: luminance of the pixel as the frame estimates it; None without tables
    # Float [sample][4]: what the sample adds to its pixel, in linear sRGB; and, as a UInt32, its number of rays, shadow
    # rays included, with the highest bit set where something opaque or an environment was met, for alpha.
    result: object
    chosen: object = None  # UInt32 [count]: the samples of the kernel, with RECORDED where they are to be
    count: object = None  # UInt32
    lane: object = None  # UInt32 [lanes]: 0, 1, ...: as many samples are under way at once
    lanes: object = None  # UInt32
    last_row: object = None  # UInt32 [count]: of the path's last recorded vertex, or NO_ROW; None without a recorder
    ended_with: object = None  # Float [count][3]: cached radiance that the path ended with; None without a recorder


def next_sample(samples, index, begins, sample, pixel, number):
    """The entry of `chosen`, number, pixel and number in the pixel of the sample that a lane traces, where it begins
    one; else those that are given."""
    chosen = dr.gather(mi.UInt32, samples.chosen, index, begins)
    sample = dr.select(begins, chosen & (RECORDED - 1), sample)
    pixel = dr.select(begins, dr.gather(mi.UInt32, samples.pixel, sample, begins), pixel)
    number = dr.select(begins, dr.gather(mi.UInt32, samples.number, sample, begins), number)
    return chosen, sample, pixel, number


def ray_counts(samples):
    """The number of rays of each sample of the kernel, UInt32."""
    tags = dr.reinterpret_array(mi.UInt32, samples.result)
    return dr.gather(mi.UInt32, tags, (samples.chosen & (RECORDED - 1)) * 4 + 3) & (VALID - 1)


@dataclass
class Scattering:
    """What a BSDF answers at a vertex about the direction to a light, one of the map, and one that it samples."""

    light_value: object
    light_pdf: object
    map_value: object
    map_pdf: object
    sample: object
    weight: object
    share_of_smooth: object  # how often it draws from lobes that are no delta lobes


def scatter(bsdf, si, toward_light, toward_map, from_map, u_lobe, u, any_delta, active):
    """Asks BSDFs for all that a vertex needs. (dr.dispatch would ask once for everything, but is traced in Python for
    each BSDF of the scene, in every pass.) toward_map counts where `from_map`."""
    context = mi.BSDFContext()
    light_value, light_pdf, sample, weight = bsdf.eval_pdf_sample(context, si, toward_light, u_lobe, u, active)
    map_value, map_pdf = mi.Spectrum(0), mi.Float(0)
    if toward_map is not None:
        map_value, map_pdf = bsdf.eval_pdf(context, si, toward_map, from_map)
    share = mi.Float(1)
    if any_delta:
        # The density over that of these lobes alone, which is the same for all directions that have one.
        wo, pdf = dr.select(light_pdf > 0, toward_light, sample.wo), dr.select(light_pdf > 0, light_pdf, sample.pdf)
        if toward_map is not None:
            wo, pdf = dr.select(map_pdf > 0, toward_map, wo), dr.select(map_pdf > 0, map_pdf, pdf)
        context.type_mask = mi.BSDFFlags.Smooth
        alone = bsdf.pdf(context, si, wo, active)
        share = dr.select(alone > 0, pdf / alone, 1)
    return Scattering(light_value, light_pdf, map_value, map_pdf, sample, weight, share)


@dr.syntax
def trace(scene, camera, settings, known, tables, recorder, samples):
    """Traces the paths of samples. A lane whose path has ended goes on with the next sample, so that SIMD packets are
    full nearly all the time: without this they would be as slow as their longest path.

    camera(pixel, number): random numbers, a ray, and what its radiance is multiplied by, for a sample.
    known: SceneTables. tables: GuideTables or None. recorder: Recorder or None. samples: Samples.
    """
    lights = known.lights
    sees_anything = settings.max_depth != 0
    sees_environment = sees_anything and not settings.hide_emitters and scene.environment() is not None

    index = mi.UInt32(samples.lane)
    under_way = mi.Bool(False)  # a path is
    more = index < samples.count
    sample, pixel, number, pixel_value = mi.UInt32(0), mi.UInt32(0), mi.UInt32(0), mi.Float(1)
    numbers, ray = RandomNumbers(mi.UInt32(0), mi.UInt32(0)), dr.zeros(mi.Ray3f)
    radiance, throughput, eta = mi.Spectrum(0), mi.Spectrum(0), mi.Float(1)
    depth, rays, valid = mi.UInt32(0), mi.UInt32(0), mi.Bool(False)
    before = vertex.nothing_before()
    row, recorded = mi.UInt32(recording.NO_ROW), mi.Bool(False)
    # How many vertices before had lobes that may be guided: the first ones have maps at pixels.
    has_pixel_maps = tables is not None and tables.pixel_cells is not None
    guidable_before, footprint = mi.UInt32(0), mi.Float(0)

    while dr.hint(more, label="odis: paths", exclude=[known, tables, recorder, lights, samples, camera]):
        # The next sample, where none is under way.
        begins = more & ~under_way
        chosen, sample, pixel, number = next_sample(samples, index, begins, sample, pixel, number)
        new_numbers, new_ray, ray_weight = camera(pixel, number)
        numbers, ray = dr.select(begins, new_numbers, numbers), dr.select(begins, new_ray, ray)
        throughput, radiance = dr.select(begins, ray_weight, throughput), dr.select(begins, 0, radiance)
        eta, depth, rays = dr.select(begins, 1, eta), dr.select(begins, 0, depth), dr.select(begins, 0, rays)
        valid = dr.select(begins, mi.Bool(sees_environment), valid)
        before.delta |= begins
        if dr.hint(recorder is not None, mode="scalar"):
            row = dr.select(begins, recording.NO_ROW, row)
            recorded = dr.select(begins, chosen >= RECORDED, recorded)
        if dr.hint(tables is not None, mode="scalar"):
            pixel_value = dr.select(begins, dr.gather(mi.Float, samples.pixel_values, pixel, begins), pixel_value)
            guidable_before, footprint = dr.select(begins, 0, guidable_before), dr.select(begins, 0, footprint)

        draws = numbers.of_vertex(depth)
        active = mi.Bool(more)
        si = scene.ray_intersect(ray, mi.RayFlags.All, coherent=False, active=active)
        rays += 1
        bsdf = si.bsdf(ray)

        # Emission that the ray met.
        met = mi.DirectionSample3f(scene, si=si, ref=before.interaction(ray))
        lit = active & (met.emitter != None)
        passes = mi.Bool(False)  # through an emitter that the camera does not see
        if dr.hint(settings.hide_emitters, mode="scalar"):
            passes = lit & (depth == 0) & si.is_valid()
            lit &= depth > 0
        emitted = met.emitter.eval(si, lit)
        mis, light_pdf = before.weigh(lights, tables, ray, met, lit)
        radiance += dr.select(lit, throughput * emitted * mis, 0)
        if dr.hint(recorder is not None, mode="scalar"):
            had_row = active & (row != recording.NO_ROW)
            color = dr.select(lit, to_rgb(emitted, ray.wavelengths), 0)
            recording.write(recorder, row, 5, [color.x, color.y, color.z, mis, light_pdf,
                                               dr.select(si.is_valid(), si.t, dr.inf)], had_row)

        arrived = active & si.is_valid() & ~passes & sees_anything
        active = mi.Bool(arrived)
        if dr.hint(settings.max_depth >= 0, mode="scalar"):
            active &= depth + 1 < settings.max_depth
        flags, roughness = material_at(known.materials, bsdf, arrived)
        normal = mi.Vector3f(dr.mulsign(si.sh_frame.n, si.wi.z))
        both_sides = (flags & BOTH_SIDES) != 0

        # Roulette on arrival, where the guide knows what the path would bring; what it expects stands in for the
        # paths that end, as a control variate.
        cell, survival_on_arrival = mi.UInt32(odis.NO_CELL), mi.Float(1)
        fraction, learned_lights = mi.Float(1), mi.Float(0)
        if dr.hint(tables is not None, mode="scalar"):
            # Of what mirrors and glass return a cell knows nothing.
            known_here = active & ((flags & SMOOTH) != 0)
            if dr.hint(settings.guide_bounces >= 0, mode="scalar"):
                known_here &= guidable_before < settings.guide_bounces
            cell = guide_tables.find_cell(tables, si.p, normal, known_here)
            if dr.hint(has_pixel_maps, mode="scalar"):
                first = known_here & (guidable_before == 0)
                own = dr.gather(mi.UInt32, tables.pixel_cells, pixel, first)
                cell = dr.select(first & (own != odis.NO_CELL), own, cell)
            guidable_before += dr.select((flags & GUIDABLE) != 0, mi.UInt32(1), mi.UInt32(0))
            relative = luminance_of(throughput, ray.wavelengths) / pixel_value
            if dr.hint(tables.cached is not None, mode="scalar"):
                # What ends here adds the cached radiance in place of what it would find.
                facing = dr.abs(dr.dot(si.sh_frame.n, ray.d))
                footprint += dr.select(active & ~before.delta,
                                       guide_tables.segment_footprint(si.t, before.pdf, facing), 0)
                may_end = active & (depth > 0) & vertex.scatters_evenly(
                    flags, roughness, si.wi.z, dr.select(both_sides, 1, vertex.LEAST_CACHED_ROUGHNESS))
                there, ends_here = vertex.end_in_cache(settings, tables, cell, (pixel, number), relative, footprint,
                                                       depth, may_end)
                radiance += dr.select(ends_here, throughput * there, 0)
                if dr.hint(recorder is not None, mode="scalar"):
                    dr.scatter(samples.ended_with, there, index, ends_here & recorded)
                active &= ~ends_here
            decisions = guide_tables.decisions_of(tables, cell, roughness, active)
            if dr.hint(settings.learned_roulette, mode="scalar"):
                plays = active & (depth > 0) & valid & (cell != odis.NO_CELL)
                survival_on_arrival, goes_on, added = vertex.play_on_arrival(
                    tables, decisions, throughput, relative, depth, draws.next(), plays)
                radiance += added
                active = active & goes_on
                throughput /= survival_on_arrival
            fraction = dr.select((flags & GUIDABLE) != 0, decisions.bsdf_fraction, 1)
            learned_lights = decisions.learned_light_fraction

        # Next-event estimation: what a light would add if nothing hid it.
        scattering = active & ((flags & SMOOTH) != 0)
        place, choice, toward, light = lights.sample(
            tables, cell, learned_lights, si, draws.next(), draws.next_2d(), scattering)
        lightable = scattering & (toward.pdf > 0) & (choice > 0)
        toward_pdf = mi.Float(toward.pdf)
        u_lobe = draws.next()
        u, v = draws.next_2d()
        toward_wo = si.to_local(toward.d)

        # A direction of the guide's map, where one is drawn. The map is asked about the direction that the path takes, and
        # about that of a light where it is seen.
        guided, from_map, toward_map, u_within = active & (fraction < 1), mi.Bool(False), None, u
        if dr.hint(tables is not None, mode="scalar"):
            mixture = vertex.Mixture(tables, cell, fraction, guided)
            from_map, u_within = mixture.choose(u)
            map_direction = mixture.map.sample(u_within, v, from_map)
            toward_map = si.to_local(map_direction)

        # Paths that end here are asked, too, whether they pass straight through: `valid` says so.
        asked = active | (arrived & ~valid & ((flags & SEES_THROUGH) != 0))
        scattered = scatter(dr.select(asked, bsdf, dr.zeros(mi.BSDFPtr)), si, toward_wo, toward_map, from_map,
                            u_lobe, mi.Point2f(u_within, v), known.materials.any_delta, asked)
        sampled, weight, bsdf_pdf = scattered.sample, scattered.weight, scattered.light_pdf
        discrete = mi.has_flag(sampled.sampled_type, mi.BSDFFlags.Delta)
        mixes = ((flags & HAS_DELTA) != 0) & ((flags & GUIDABLE) != 0)
        share_of_smooth = dr.select(mixes, scattered.share_of_smooth, 1)
        bounce = vertex.Bounce(si.to_world(sampled.wo), mi.Float(sampled.pdf), sampled.pdf, weight, from_map)
        if dr.hint(tables is not None, mode="scalar"):
            bounce = mixture.take(bounce, discrete, from_map, map_direction, scattered.map_value, scattered.map_pdf,
                                  share_of_smooth)
        wi, pdf, guidable_pdf, weight = bounce.wi, bounce.pdf, bounce.own_pdf, bounce.weight

        unweighted = scattered.light_value * light
        lightable &= dr.max(dr.abs(unweighted)) > 0
        shadow = mi.Float(1)
        if dr.hint(tables is not None and settings.shadow_roulette, mode="scalar"):
            # As if the BSDF alone drew directions: most lights are played for before the map is asked about them.
            alone = dr.select(toward.delta, 1, power_heuristic(toward_pdf, bsdf_pdf))
            adds = luminance_of(throughput * unweighted * alone, ray.wavelengths)
            shadow = vertex.play_for_shadow_ray(tables, adds, cell, pixel_value)
            lightable &= draws.next() < shadow
            unweighted /= shadow
        rays += dr.select(lightable, mi.UInt32(1), mi.UInt32(0))
        seen = lightable & ~scene.ray_test(si.spawn_ray_to(toward.p), coherent=False, active=lightable)
        light_mix_pdf = mi.Float(bsdf_pdf)
        if dr.hint(tables is not None, mode="scalar"):
            light_mix_pdf = mixture.pdf(toward.d, bsdf_pdf, share_of_smooth, seen & ~toward.delta)
            light_mix_pdf = dr.select(guided, light_mix_pdf, bsdf_pdf)
        mis = dr.select(toward.delta, 1, power_heuristic(toward_pdf, light_mix_pdf))
        mis = vertex.weight_toward(lights, mis, place, choice, toward_pdf, bsdf_pdf, lightable)
        direct = unweighted * mis
        radiance += dr.select(seen, throughput * direct, 0)

        # Roulette on departure, where nothing was learned.
        weight = dr.select(active & dr.all(dr.isfinite(weight)), weight, 0)
        eta *= dr.select(bounce.from_map | passes, 1, sampled.eta)
        most = dr.max(throughput * weight)
        survival = vertex.play_on_departure(settings, tables, most, eta, depth, cell, active)
        goes_on = active & (most > 0) & (draws.next() < survival)
        weight = dr.select(goes_on, weight / survival, 0)

        if dr.hint(recorder is not None, mode="scalar"):
            previous_row = row
            row = recording.new_row(recorder, active & recorded)
            has_row = row != recording.NO_ROW
            group, group_choice = lights.group_of(place, choice * shadow, lightable)
            can_guide = (flags & GUIDABLE) != 0
            recording.write_vertex(recorder, row, recording.Vertex(
                position=si.p, normal=normal, pixel=pixel, sample=number, wi=wi, pdf=pdf,
                weight=to_rgb(weight, ray.wavelengths), survival=survival,
                direct=to_rgb(dr.select(seen, direct, 0), ray.wavelengths),
                light=luminance_of(dr.select(seen, throughput * unweighted, 0), ray.wavelengths),
                light_direction=toward.d, light_pdf=dr.select(seen & ~toward.delta, toward_pdf, 0),
                light_bsdf_pdf=bsdf_pdf, light_guidable_pdf=dr.select(can_guide, bsdf_pdf, 0), light_group=group,
                light_group_probability=group_choice, guidable_pdf=dr.select(can_guide, guidable_pdf, 0),
                guidable_probability=dr.select(can_guide, dr.select(discrete, 1, share_of_smooth), 0),
                roughness=roughness, tag=recording.tag_of(depth, discrete, both_sides),
                throughput=to_rgb(throughput, ray.wavelengths), arrival=[survival_on_arrival], rays=rays,
                previous_row=previous_row), has_row)
            row = dr.select(active, row, previous_row)

        valid |= arrived & ~mi.has_flag(sampled.sampled_type, mi.BSDFFlags.Null)
        throughput *= dr.select(passes, 1, weight)
        before = vertex.Before(mi.Point3f(si.p), mi.Normal3f(si.n), pdf,
                               mi.Float(guidable_pdf) if lights.uneven is not None else before.bsdf_pdf, discrete, cell,
                               learned_lights)
        if dr.hint(settings.hide_emitters, mode="scalar"):
            wi, before.delta = dr.select(passes, ray.d, wi), before.delta | passes
        ray = dr.select(goes_on | passes, si.spawn_ray(wi), ray)
        depth += dr.select(goes_on, mi.UInt32(1), mi.UInt32(0))

        # The sample is complete where the path does not go on. As with `path` it is black where nothing was met that
        # is neither hidden nor passed straight through.
        under_way = more & (goes_on | passes)
        ends = more & ~under_way
        color = to_rgb(dr.select(valid, radiance, 0), ray.wavelengths)
        count = recording.bits(rays | dr.select(valid, mi.UInt32(VALID), 0))
        dr.scatter(samples.result, mi.Vector4f(color.x, color.y, color.z, count), sample, ends)
        if dr.hint(recorder is not None, mode="scalar"):
            dr.scatter(samples.last_row, row, index, ends)
        index += dr.select(ends, samples.lanes, 0)
        more = index < samples.count
