"""The path tracer for scenes with media: Mitsuba's `volpath`, with every decision that an odis guide makes."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi

import odis

from . import guide_tables, recording, vertex
from .materials import BOTH_SIDES, GUIDABLE, HAS_DELTA, SEES_THROUGH, SMOOTH, material_at
from .media import fly, transmittance
from .path import RECORDED, VALID, next_sample, scatter
from .random_numbers import RandomNumbers
from .vertex import luminance_of, power_heuristic, to_rgb


def medium_interaction(ray, p):
    """The interaction at a place in a medium where a ray is scattered, as phase functions want it."""
    event = dr.zeros(mi.MediumInteraction3f)
    event.p, event.wi, event.time, event.wavelengths = p, -ray.d, ray.time, ray.wavelengths
    event.sh_frame = mi.Frame3f(event.wi)
    return event


@dataclass
class PhaseScattering:
    """What a phase function answers about the direction to a light, one of the map, and one that it samples."""

    light_value: object
    light_pdf: object
    map_value: object
    map_pdf: object
    sample: object  # direction in the world
    weight: object
    pdf: object


def scatter_in_medium(phase, event, toward_light, toward_map, from_map, u_lobe, u, active):
    """Asks phase functions for all that a vertex needs; as path.scatter, with directions in the world."""
    context = mi.PhaseFunctionContext(None)
    light_value, light_pdf = phase.eval_pdf(context, event, toward_light, active)
    map_value, map_pdf = mi.Spectrum(0), mi.Float(0)
    if toward_map is not None:
        map_value, map_pdf = phase.eval_pdf(context, event, toward_map, from_map)
    return PhaseScattering(light_value, light_pdf, map_value, map_pdf,
                           *phase.sample(context, event, u_lobe, u, active))


@dr.syntax
def trace(scene, camera, settings, known, tables, recorder, samples):
    """Traces the paths of samples, as path.trace does, whose arguments these are.

    In a round of the loop a path gets to where it is scattered next, in a medium or on a surface, or to a surface that it
    passes straight (`null` and the like), which is no vertex.
    """
    lights, media = known.lights, known.media
    sees_environment = not settings.hide_emitters and scene.environment() is not None

    index = mi.UInt32(samples.lane)
    under_way = mi.Bool(False)  # a path is
    more = index < samples.count
    sample, pixel, number, pixel_value = mi.UInt32(0), mi.UInt32(0), mi.UInt32(0), mi.Float(1)
    numbers, ray = RandomNumbers(mi.UInt32(0), mi.UInt32(0)), dr.zeros(mi.Ray3f)
    medium = dr.zeros(mi.MediumPtr)
    radiance, throughput, eta = mi.Spectrum(0), mi.Spectrum(0), mi.Float(1)
    # place: all that the path came to, also what it passed straight; drawn: its numbers beside those of its places.
    depth, place, drawn, rays, valid = mi.UInt32(0), mi.UInt32(0), mi.UInt32(0), mi.UInt32(0), mi.Bool(False)
    before = vertex.nothing_before()
    row, recorded, vertices = mi.UInt32(recording.NO_ROW), mi.Bool(False), mi.UInt32(0)
    # What the ray from there met by now: what multiplied it, and emission (recording.Met).
    attenuation, met_before, travelled = mi.Spectrum(1), recording.nothing_met(), mi.Float(0)
    has_pixel_maps = tables is not None and tables.pixel_cells is not None
    guidable_before, footprint = mi.UInt32(0), mi.Float(0)

    while dr.hint(more, label="odis: paths in media", exclude=[known, tables, recorder, lights, media, samples, camera]):
        # The next sample, where none is under way.
        begins = more & ~under_way
        chosen, sample, pixel, number = next_sample(samples, index, begins, sample, pixel, number)
        new_numbers, new_ray, ray_weight = camera(pixel, number)
        numbers, ray = dr.select(begins, new_numbers, numbers), dr.select(begins, new_ray, ray)
        medium = dr.select(begins, camera.medium, medium)
        throughput, radiance = dr.select(begins, ray_weight, throughput), dr.select(begins, 0, radiance)
        eta, depth, rays = dr.select(begins, 1, eta), dr.select(begins, 0, depth), dr.select(begins, 0, rays)
        place, drawn = dr.select(begins, 0, place), dr.select(begins, 0, drawn)
        attenuation, travelled = dr.select(begins, 1, attenuation), dr.select(begins, 0, travelled)
        valid = dr.select(begins, mi.Bool(sees_environment), valid)
        before.delta |= begins
        if dr.hint(recorder is not None, mode="scalar"):
            row, vertices = dr.select(begins, recording.NO_ROW, row), dr.select(begins, 0, vertices)
            recorded = dr.select(begins, chosen >= RECORDED, recorded)
            met_before = dr.select(begins, recording.nothing_met(), met_before)
        if dr.hint(tables is not None, mode="scalar"):
            pixel_value = dr.select(begins, dr.gather(mi.Float, samples.pixel_values, pixel, begins), pixel_value)
            guidable_before, footprint = dr.select(begins, 0, guidable_before), dr.select(begins, 0, footprint)

        draws = numbers.of_vertex(place)
        active = more & (settings.max_depth != 0)
        flight = fly(scene, media, ray, medium, throughput, draws.next(), numbers, drawn, active)
        si, drawn = flight.si, flight.drawn
        rays += 1
        throughput *= dr.select(active, flight.weight, 0)
        attenuation *= flight.weight
        travelled += flight.distance
        active &= dr.any(throughput != 0)
        in_medium = active & flight.scattered
        on_surface = active & ~flight.scattered

        # Emission that the ray met.
        met = mi.DirectionSample3f(scene, si=si, ref=before.interaction(ray))
        lit = on_surface & (met.emitter != None)
        hidden = mi.Bool(False)  # an emitter that the camera does not see
        if dr.hint(settings.hide_emitters, mode="scalar"):
            hidden = lit & (depth == 0) & si.is_valid()
            lit &= depth > 0
        emitted = met.emitter.eval(si, lit)
        mis, light_pdf = before.weigh(lights, tables, ray, met, lit)
        radiance += dr.select(lit, throughput * emitted * mis, 0)
        arrived = on_surface & si.is_valid() & ~hidden
        if dr.hint(recorder is not None, mode="scalar"):
            arriving = to_rgb(emitted, ray.wavelengths) * recording.factor_of(attenuation)
            met_before = recording.also_met(met_before, dr.select(lit, arriving, 0), mis, light_pdf)
            recording.write_met(recorder, row, met_before, dr.select(in_medium | si.is_valid(), travelled, dr.inf),
                                more & (row != recording.NO_ROW))

        # What scatters here: a BSDF or a phase function.
        deepest = mi.Bool(False)
        if dr.hint(settings.max_depth >= 0, mode="scalar"):
            deepest = depth + 1 >= settings.max_depth
        in_medium &= ~deepest
        active = in_medium | (arrived & ~deepest)
        bsdf = dr.select(arrived, si.bsdf(ray), dr.zeros(mi.BSDFPtr))
        phase = dr.select(in_medium, medium.phase_function(), dr.zeros(mi.PhaseFunctionPtr))
        flags, roughness = material_at(known.materials, bsdf, arrived)
        phase_flags, phase_roughness = material_at(media, phase, in_medium)
        flags, roughness = dr.select(in_medium, phase_flags, flags), dr.select(in_medium, phase_roughness, roughness)
        at = dr.zeros(mi.Interaction3f)
        at.p, at.n = dr.select(in_medium, flight.p, si.p), dr.select(in_medium, 0, si.n)
        at.time, at.wavelengths = ray.time, ray.wavelengths
        event = medium_interaction(ray, flight.p)
        normal = dr.select(in_medium, 0, mi.Vector3f(dr.mulsign(si.sh_frame.n, si.wi.z)))
        both_sides = in_medium | ((flags & BOTH_SIDES) != 0)

        # Cached radiance, and roulette on arrival.
        cell, survival_on_arrival = mi.UInt32(odis.NO_CELL), mi.Float(1)
        fraction, learned_lights = mi.Float(1), mi.Float(0)
        if dr.hint(tables is not None, mode="scalar"):
            known_here = active & ((flags & SMOOTH) != 0)
            if dr.hint(settings.guide_bounces >= 0, mode="scalar"):
                known_here &= guidable_before < settings.guide_bounces
            cell = guide_tables.find_cell(tables, at.p, normal, known_here)
            if dr.hint(has_pixel_maps, mode="scalar"):
                first = known_here & (guidable_before == 0) & ~in_medium
                own = dr.gather(mi.UInt32, tables.pixel_cells, pixel, first)
                cell = dr.select(first & (own != odis.NO_CELL), own, cell)
            guidable_before += dr.select(active & ((flags & GUIDABLE) != 0), mi.UInt32(1), mi.UInt32(0))
            relative = luminance_of(throughput, ray.wavelengths) / pixel_value
            if dr.hint(tables.cached is not None, mode="scalar"):
                facing = dr.select(in_medium, 1, dr.abs(dr.dot(si.sh_frame.n, ray.d)))
                footprint += dr.select(active & ((flags & SMOOTH) != 0) & ~before.delta,
                                       guide_tables.segment_footprint(travelled, before.pdf, facing), 0)
                may_end = active & (depth > 0) & vertex.scatters_evenly(
                    flags, roughness, si.wi.z,
                    dr.select(both_sides & ~in_medium, 1, vertex.LEAST_CACHED_ROUGHNESS))
                there, ends_here = vertex.end_in_cache(settings, tables, cell, (pixel, number), relative, footprint,
                                                       depth, may_end)
                radiance += dr.select(ends_here, throughput * there, 0)
                if dr.hint(recorder is not None, mode="scalar"):
                    dr.scatter(samples.ended_with, there * recording.factor_of(attenuation), index, ends_here & recorded)
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
        in_medium &= active

        # Next-event estimation: what a light would add if nothing hid it.
        scattering = active & ((flags & SMOOTH) != 0) & (~in_medium | medium.use_emitter_sampling())
        light_place, choice, toward, light = lights.sample(
            tables, cell, learned_lights, at, draws.next(), draws.next_2d(), scattering)
        lightable = scattering & (toward.pdf > 0) & (choice > 0)
        toward_pdf = mi.Float(toward.pdf)
        u_lobe = draws.next()
        u, v = draws.next_2d()

        # A direction of the guide's map, where one is drawn.
        guided, from_map, u_within = active & (fraction < 1), mi.Bool(False), u
        map_direction, toward_map = None, None
        if dr.hint(tables is not None, mode="scalar"):
            mixture = vertex.Mixture(tables, cell, fraction, guided)
            from_map, u_within = mixture.choose(u)
            map_direction = mixture.map.sample(u_within, v, from_map)
            toward_map = si.to_local(map_direction)

        # Paths that depth ends here are asked, too, whether they pass straight through.
        asked = (active & ~in_medium) | (arrived & deepest & ((flags & SEES_THROUGH) != 0))
        u_direction = mi.Point2f(u_within, v)
        scattered = scatter(dr.select(asked, bsdf, dr.zeros(mi.BSDFPtr)), si, si.to_local(toward.d), toward_map,
                            from_map & ~in_medium, u_lobe, u_direction, known.materials.any_delta, asked)
        of_phase = scatter_in_medium(dr.select(in_medium, phase, dr.zeros(mi.PhaseFunctionPtr)), event, toward.d,
                                     map_direction, from_map & in_medium, u_lobe, u_direction, in_medium)
        sampled = scattered.sample
        discrete = ~in_medium & mi.has_flag(sampled.sampled_type, mi.BSDFFlags.Delta)
        passes = asked & mi.has_flag(sampled.sampled_type, mi.BSDFFlags.Null)
        mixes = ((flags & HAS_DELTA) != 0) & ((flags & GUIDABLE) != 0)
        share_of_smooth = dr.select(mixes, scattered.share_of_smooth, 1)
        light_value = dr.select(in_medium, of_phase.light_value, scattered.light_value)
        bsdf_pdf = dr.select(in_medium, of_phase.light_pdf, scattered.light_pdf)
        own_pdf = dr.select(in_medium, of_phase.pdf, sampled.pdf)
        bounce = vertex.Bounce(dr.select(in_medium, of_phase.sample, si.to_world(sampled.wo)), own_pdf, own_pdf,
                               dr.select(in_medium, of_phase.weight, scattered.weight), from_map)
        if dr.hint(tables is not None, mode="scalar"):
            bounce = mixture.take(bounce, discrete, from_map, map_direction,
                                  dr.select(in_medium, of_phase.map_value, scattered.map_value),
                                  dr.select(in_medium, of_phase.map_pdf, scattered.map_pdf), share_of_smooth)
        wi, pdf, guidable_pdf, weight = bounce.wi, bounce.pdf, bounce.own_pdf, bounce.weight

        unweighted = light_value * light
        lightable &= dr.max(dr.abs(unweighted)) > 0
        shadow = mi.Float(1)
        if dr.hint(tables is not None and settings.shadow_roulette, mode="scalar"):
            alone = dr.select(toward.delta, 1, power_heuristic(toward_pdf, bsdf_pdf))
            adds = luminance_of(throughput * unweighted * alone, ray.wavelengths)
            shadow = vertex.play_for_shadow_ray(tables, adds, cell, pixel_value)
            lightable &= draws.next() < shadow
            unweighted /= shadow
        crosses = ~in_medium & si.is_medium_transition()
        medium_there = dr.select(crosses, si.target_medium(toward.d), medium)
        toward_ray = at.spawn_ray_to(toward.p)
        # An environment lies beyond all media: one without an end lets nothing of it through, as rays find out, too.
        toward_ray.maxt = dr.select(light_place < lights.regions, dr.inf, toward_ray.maxt)
        left, shadow_rays, drawn = transmittance(scene, known, toward_ray, medium_there, numbers, drawn, lightable)
        rays += shadow_rays
        seen = lightable & dr.any(left != 0)
        unweighted *= left
        light_mix_pdf = mi.Float(bsdf_pdf)
        if dr.hint(tables is not None, mode="scalar"):
            light_mix_pdf = mixture.pdf(toward.d, bsdf_pdf, share_of_smooth, seen & ~toward.delta)
            light_mix_pdf = dr.select(guided, light_mix_pdf, bsdf_pdf)
        mis = dr.select(toward.delta, 1, power_heuristic(toward_pdf, light_mix_pdf))
        mis = vertex.weight_toward(lights, mis, light_place, choice, toward_pdf, bsdf_pdf, lightable)
        direct = unweighted * mis
        radiance += dr.select(seen, throughput * direct, 0)

        # Roulette on departure, where nothing was learned; not where the path passes straight through.
        weight = dr.select((active | passes) & dr.all(dr.isfinite(weight)), weight, 0)
        eta *= dr.select(bounce.from_map | hidden | in_medium | ~active, 1, sampled.eta)
        most = dr.max(dr.abs(throughput * weight))
        survival = vertex.play_on_departure(settings, tables, most, eta, depth, cell, active & ~passes)
        goes_on = (active | passes) & (most > 0) & (draws.next() < survival)
        weight = dr.select(goes_on, weight / survival, 0)

        # A surface that is only passed is no vertex.
        is_vertex = active & ~(passes & ((flags & SMOOTH) == 0))
        if dr.hint(recorder is not None, mode="scalar"):
            previous_row = row
            new_row = recording.new_row(recorder, is_vertex & recorded)
            group, group_choice = lights.group_of(light_place, choice * shadow, lightable)
            can_guide = (flags & GUIDABLE) != 0
            recording.write_vertex(recorder, new_row, recording.Vertex(
                position=at.p, normal=normal, pixel=pixel, sample=number, wi=wi, pdf=pdf,
                weight=to_rgb(weight, ray.wavelengths), survival=survival,
                direct=to_rgb(dr.select(seen, direct, 0), ray.wavelengths),
                light=luminance_of(dr.select(seen, throughput * unweighted, 0), ray.wavelengths),
                light_direction=toward.d, light_pdf=dr.select(seen & ~toward.delta, toward_pdf, 0),
                light_bsdf_pdf=bsdf_pdf, light_guidable_pdf=dr.select(can_guide, bsdf_pdf, 0), light_group=group,
                light_group_probability=group_choice, guidable_pdf=dr.select(can_guide, guidable_pdf, 0),
                guidable_probability=dr.select(can_guide, dr.select(discrete, 1, share_of_smooth), 0),
                roughness=roughness, tag=recording.tag_of(vertices, discrete, both_sides),
                throughput=to_rgb(throughput, ray.wavelengths),
                arrival=list(recording.factor_of(attenuation) / survival_on_arrival), rays=rays,
                previous_row=previous_row), new_row != recording.NO_ROW)
            row = dr.select(is_vertex, new_row, row)
            vertices += dr.select(is_vertex, mi.UInt32(1), 0)
            met_before = dr.select(is_vertex, recording.nothing_met(), met_before)

        valid |= in_medium | (arrived & ~passes)
        throughput *= dr.select(hidden, 1, weight)
        # What is passed straight multiplies the ray of the vertex before, unless it is one itself.
        attenuation = dr.select(is_vertex, 1, attenuation * dr.select(hidden, 1, weight))
        travelled = dr.select(is_vertex, 0, travelled)
        wi = dr.select(hidden | passes, ray.d, wi)
        turns = goes_on & ~passes
        here = vertex.Before(at.p, mi.Normal3f(at.n), pdf, guidable_pdf if lights.uneven is not None else before.bsdf_pdf,
                             discrete | (in_medium & ~medium.use_emitter_sampling()), cell, learned_lights)
        before = dr.select(turns, here, before)
        medium = dr.select((arrived | hidden) & si.is_medium_transition(), si.target_medium(wi), medium)
        ray = dr.select(goes_on | hidden, at.spawn_ray(wi), ray)
        depth += dr.select(turns, mi.UInt32(1), mi.UInt32(0))
        place += 1

        # The sample is complete where the path does not go on.
        under_way = more & (goes_on | hidden)
        ends = more & ~under_way
        color = to_rgb(radiance, ray.wavelengths)
        count = recording.bits(rays | dr.select(valid, mi.UInt32(VALID), 0))
        dr.scatter(samples.result, mi.Vector4f(color.x, color.y, color.z, count), sample, ends)
        if dr.hint(recorder is not None, mode="scalar"):
            dr.scatter(samples.last_row, row, index, ends)
        index += dr.select(ends, samples.lanes, 0)
        more = index < samples.count
