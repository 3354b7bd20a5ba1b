"""Records the vertices of paths in a kernel, as rows of numbers that odis.PathVertices describes without a copy."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

import odis

# A row is written in packets of eight numbers, each when its numbers are known:
#   0 position (3), normal (3), pixel, sample             4 throughput up to here (3), survival on arrival,
#   1 wi (3), pdf, weight (3), survival                       rays before, previous row, -, -
#   2 direct (3), light, light direction (3), light pdf   5 what wi met: emission (3), its MIS weight, light pdf,
#   3 light BSDF pdf, light guidable pdf, light group,        distance, -, -
#     its probability, guidable pdf, guidable
#     probability, roughness, depth and flags
# In scenes with media what multiplies light on its way from the vertex to the one before, (attenuation over survival on
# arrival) takes the place of that survival, and the two that are free in packet 4.
# Once the path is complete a further packet is written, apart, as Dr.Jit copies arrays that a kernel reads and writes:
# radiance (3), indirect, emission, rays after, -, -.
PACKET = 8
PACKETS = 6
ROW = PACKET * PACKETS
NO_ROW = 0xffffffff
DISCRETE, BOTH_SIDES = 1 << 16, 1 << 24  # beside the depth in the lower 16 bits


@dataclass
class Recorder:
    """224 bytes a row, in two arrays."""

    rows: object  # Float, [capacity][ROW]
    completions: object  # Float, [capacity][PACKET]
    count: object  # UInt32: rows asked for, which may be more than there are
    capacity: object  # UInt32
    attenuated: bool  # whether there are media


def make_recorder(capacity, attenuated=False):
    recorder = Recorder(dr.empty(mi.Float, capacity * ROW), dr.empty(mi.Float, capacity * PACKET),
                        dr.zeros(mi.UInt32, 1), mi.UInt32(capacity), attenuated)
    dr.make_opaque(recorder.count, recorder.capacity)
    return recorder


def bits(whole):
    return dr.reinterpret_array(mi.Float, mi.UInt32(whole))


def write(recorder, row, packet, numbers, active):
    numbers = list(numbers) + [mi.Float(0)] * (PACKET - len(numbers))
    dr.scatter(recorder.rows, mi.ArrayXf(numbers), row * PACKETS + packet, active)


def read(recorder, row, packet, active):
    return dr.gather(mi.ArrayXf, recorder.rows, row * PACKETS + packet, active, shape=(PACKET, -1))


def color_in(packet, first):
    return mi.Color3f(packet[first], packet[first + 1], packet[first + 2])


def tag_of(depth, discrete, both_sides):
    """Vertex.tag, of the number of vertices before."""
    return (depth + 1) | dr.select(discrete, mi.UInt32(DISCRETE), 0) | dr.select(both_sides, mi.UInt32(BOTH_SIDES), 0)


def new_row(recorder, active):
    """A free row for each active lane; NO_ROW where there is none left."""
    row = dr.scatter_inc(recorder.count, mi.UInt32(0), active)
    return dr.select(active & (row < recorder.capacity), row, NO_ROW)


@dataclass
class Vertex:
    """What is known of a vertex once it has drawn a direction: the fields of odis.PathVertices, as Dr.Jit's arrays;
    colours are mi.Color3f."""

    position: object
    normal: object
    pixel: object
    sample: object
    wi: object
    pdf: object
    weight: object
    survival: object
    direct: object
    light: object
    light_direction: object
    light_pdf: object
    light_bsdf_pdf: object
    light_guidable_pdf: object
    light_group: object
    light_group_probability: object
    guidable_pdf: object
    guidable_probability: object
    roughness: object
    tag: object  # UInt32: depth, from 1 on, and flags
    throughput: object  # Color3f: of the path up to here
    arrival: list  # survival on arrival; with media, attenuation over survival, of three channels
    rays: object  # UInt32: of the path up to here
    previous_row: object


def write_vertex(recorder, row, v, active):
    p, n, d, w, c, l, t = v.position, v.normal, v.wi, v.weight, v.direct, v.light_direction, v.throughput
    write(recorder, row, 0, [p.x, p.y, p.z, n.x, n.y, n.z, bits(v.pixel), bits(v.sample)], active)
    write(recorder, row, 1, [d.x, d.y, d.z, v.pdf, w.x, w.y, w.z, v.survival], active)
    write(recorder, row, 2, [c.x, c.y, c.z, v.light, l.x, l.y, l.z, v.light_pdf], active)
    write(recorder, row, 3, [v.light_bsdf_pdf, v.light_guidable_pdf, bits(v.light_group), v.light_group_probability,
                             v.guidable_pdf, v.guidable_probability, v.roughness, bits(v.tag)], active)
    write(recorder, row, 4, [t.x, t.y, t.z, v.arrival[0], mi.Float(v.rays), bits(v.previous_row), *v.arrival[1:]], active)
    write(recorder, row, 5, [mi.Float(0)] * 5 + [mi.Float(dr.inf)], active)


@dataclass
class Met:
    """Emission that the ray of a vertex met by now, where it may meet several lights."""

    emission: object  # Color3f: as attenuated
    weight: object  # MIS weight of that, in the mean
    light_pdf: object  # of the brightest one


def nothing_met():
    return Met(mi.Color3f(0), mi.Float(0), mi.Float(0))


def also_met(met, emission, weight, light_pdf):
    """With a further emission (odis::PathRecorder)."""
    before, now = mi.luminance(met.emission), mi.luminance(emission)
    both = before + now
    return Met(met.emission + emission, dr.select(both > 0, (before * met.weight + now * weight) / both, met.weight),
               dr.select(now > before, light_pdf, met.light_pdf))


def write_met(recorder, row, met, distance, active):
    """distance: to the next vertex."""
    color = met.emission
    write(recorder, row, 5, [color.x, color.y, color.z, met.weight, met.light_pdf, distance], active)


def factor_of(spectrum):
    """A factor of radiance as one of colours."""
    return mi.Color3f(dr.mean(spectrum)) if mi.is_spectral else mi.Color3f(spectrum)


def complete_paths(recorder, last_row, ended_with, rays):
    """Fills in what only complete paths know, from their last rows back to the first (odis::PathRecorder).

    last_row, rays: UInt32, of each path its last row and its number of rays. ended_with: Float [path][3], the cached
    radiance that it ended with.
    """
    rays = mi.Float(rays)
    row, beyond = mi.UInt32(last_row), dr.unravel(mi.Color3f, ended_with)

    def body(row, beyond):
        active = row != NO_ROW
        of_weight, of_light = read(recorder, row, 1, active), read(recorder, row, 2, active)
        of_path, met = read(recorder, row, 4, active), read(recorder, row, 5, active)
        weight, direct = color_in(of_weight, 4), color_in(of_light, 0)
        throughput, emission = color_in(of_path, 0), color_in(met, 0)
        radiance = emission * met[3] + beyond
        to_pixel = throughput * weight
        completion = [radiance.x, radiance.y, radiance.z, mi.luminance(to_pixel * beyond),
                      mi.luminance(to_pixel * emission), rays - of_path[4], mi.Float(0), mi.Float(0)]
        dr.scatter(recorder.completions, mi.ArrayXf(completion), row, active)
        beyond = direct + weight * radiance
        beyond = beyond * mi.Color3f(of_path[3], of_path[6], of_path[7]) if recorder.attenuated else beyond / of_path[3]
        return dr.reinterpret_array(mi.UInt32, of_path[5]), beyond

    dr.while_loop((row, beyond), lambda row, beyond: row != NO_ROW, body, label="odis: complete paths")


def path_vertices(recorder, count):
    """The first `count` rows as odis.PathVertices, which keeps the rows alive."""
    rows = np.asarray(recorder.rows).reshape(-1, ROW)[:count]
    completions = np.asarray(recorder.completions).reshape(-1, PACKET)[:count]
    whole, halves, flags = rows.view(np.uint32), rows.view(np.uint16), rows.view(np.bool_)
    at = lambda packet, number: PACKET * packet + number
    return odis.PathVertices(
        position=rows[:, 0:3], normal=rows[:, 3:6], pixel=whole[:, 6], sample=whole[:, 7],
        wi=rows[:, at(1, 0):at(1, 3)], pdf=rows[:, at(1, 3)], weight=rows[:, at(1, 4):at(1, 7)],
        survival=rows[:, at(1, 7)],
        direct=rows[:, at(2, 0):at(2, 3)], light=rows[:, at(2, 3)], light_direction=rows[:, at(2, 4):at(2, 7)],
        light_pdf=rows[:, at(2, 7)],
        light_bsdf_pdf=rows[:, at(3, 0)], light_guidable_pdf=rows[:, at(3, 1)], light_group=whole[:, at(3, 2)],
        light_group_probability=rows[:, at(3, 3)], guidable_pdf=rows[:, at(3, 4)],
        guidable_probability=rows[:, at(3, 5)], roughness=rows[:, at(3, 6)], depth=halves[:, 2 * at(3, 7)],
        discrete=flags[:, 4 * at(3, 7) + 2], scatters_both_sides=flags[:, 4 * at(3, 7) + 3],
        emission_light_pdf=rows[:, at(5, 4)], distance=rows[:, at(5, 5)],
        radiance=completions[:, 0:3], indirect=completions[:, 3], emission=completions[:, 4],
        rays_after=completions[:, 5])
