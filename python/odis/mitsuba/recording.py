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


def make_recorder(capacity):
    recorder = Recorder(dr.empty(mi.Float, capacity * ROW), dr.empty(mi.Float, capacity * PACKET),
                        dr.zeros(mi.UInt32, 1), mi.UInt32(capacity))
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


def new_row(recorder, active):
    """A free row for each active lane; NO_ROW where there is none left."""
    row = dr.scatter_inc(recorder.count, mi.UInt32(0), active)
    return dr.select(active & (row < recorder.capacity), row, NO_ROW)


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
        beyond = (direct + weight * radiance) / of_path[3]
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
