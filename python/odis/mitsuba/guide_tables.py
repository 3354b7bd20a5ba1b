"""A guide as Dr.Jit arrays, and what a path looks up in it: odis/guide_view.h and odis/sampling_map.h for kernels."""

from dataclasses import dataclass
from functools import cache

import drjit as dr
import mitsuba as mi
import numpy as np

import odis

from .arrays import array_of

MAP_BLOCKS = 16
BLOCK_TEXELS = 16
# Brings what a map has into the range of half floats.
TEXEL_SCALE, SUM_SCALE = 1 / 2, 1 / 32
LEAST_HALF, MOST_HALF = 2.0 ** -24, 65504.0
NORMAL_STEPS = 11  # along each side of the octahedral map; odd, so that axes are among the normals
TEXELS_PER_STERADIAN = 256 / (4 * np.pi)
ONE_MINUS_EPSILON = float(np.nextafter(np.float32(1), np.float32(0)))
# Cells are found in a grid of the finest ones, which spans at most this many of them and this much beyond those that
# most vertices lie in; places outside are not guided. 4 bytes an entry.
MOST_ENTRIES = 1 << 21
MARGIN = 16
# The normals of the six orientations of cells, in the order of the grid: +x, -x, +y, -y, +z, -z.
ORIENTATIONS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], np.float32)


@dataclass
class GuideTables:
    """What kernels read of a guide.

    4 bytes an entry of the grid; a cell has 512 bytes of texels, 32 bytes a slot (up to 1.4 KB, twice that with both
    sides), 16 of decisions, and 4 bytes a group of lights.
    """

    origin: object  # Point3f: corner of the grid
    inverse_edge: object  # Float: 1 / edge of its cells
    size: object  # Vector3i: of the grid, in cells
    entries: object  # UInt32 [z][y][x][orientation]: numbers of cells, or odis.NO_CELL
    # Half floats are read several times as fast as floats, and a density may be rounded: what is sampled is what is
    # evaluated.
    texels: object  # Float16 [cell][block][16]: relative incident radiance, TEXEL_SCALE times that of the guide
    blocks: object  # Float16 [cell][slot][block]: sums of texel times cosine to the normal of the slot, SUM_SCALE times
    slots: object  # UInt32 [orientation][normal]: slots of the normals that cells of this orientation have
    slot_count: object  # UInt32: for each cell
    cosines: object  # Float16 [both sides][normal][texel]: what counts of the cosine, and the rim
    both_sides_slot: object  # UInt32: first slot for surfaces that scatter to both sides
    decisions: object  # Float16 [cell][8]: BSDF fractions of the roughness classes, survival factor, outgoing radiance
    # over radiance_scale, fraction of the choices of a light that are learned
    radiance_scale: object  # Float
    light_tables: object  # Float [cell][groups + 1]: cumulative probabilities of the groups of lights
    roughness_bounds: object  # [2] least roughness of the classes diffuse and rough
    least_survival: object
    full_shadow_ray_contribution: object
    least_shadow_ray_probability: object


def grid_box(guide):
    """The box of the finest cells to tabulate, in cells from the guide's origin: lowest corner and size, int64 (3,)."""
    keys = guide.cell_keys
    level = (keys >> np.uint64(60)).astype(np.int64)
    axes = [((keys >> np.uint64(19 * a)) & np.uint64((1 << 19) - 1)).astype(np.int64) - (1 << 18) for a in range(3)]
    low, high = np.zeros(3, np.int64), np.zeros(3, np.int64)
    finest = level == 0 if (level == 0).any() else level == level.min()
    for a, coordinate in enumerate(axes):
        begin, end = coordinate << level, (coordinate + 1) << level
        core_low, core_high = np.quantile(begin[finest], [0.02, 0.98])
        low[a] = max(begin.min(), int(core_low) - MARGIN)
        high[a] = min(end.max(), int(core_high) + 1 + MARGIN)
    while np.prod(high - low) * 6 > MOST_ENTRIES:
        widest = np.argmax(high - low)
        cut = max(1, (high - low)[widest] // 8)
        low[widest] += cut
        high[widest] -= cut
    return low, high - low


def tabulate_cells(guide):
    """The grid: its corner (3,), size (3,), and the cells' numbers [z][y][x][orientation], uint32."""
    low, size = grid_box(guide)
    edge, origin = guide.finest_edge, np.asarray(guide.origin)
    z, y, x = (np.arange(size[a], dtype=np.float32) + np.float32(0.5) for a in (2, 1, 0))
    middle = np.empty((size[2], size[1], size[0], 6, 3), np.float32)
    middle[..., 0] = (origin[0] + (x + low[0]) * edge)[None, None, :, None]
    middle[..., 1] = (origin[1] + (y + low[1]) * edge)[None, :, None, None]
    middle[..., 2] = (origin[2] + (z + low[2]) * edge)[:, None, None, None]
    normals = np.broadcast_to(ORIENTATIONS, middle.shape).reshape(-1, 3)
    cells = guide.find_cells(middle.reshape(-1, 3), np.ascontiguousarray(normals))
    return origin + low * edge, size, cells


@cache
def quantized_normals():
    """The unit normals that maps are multiplied with: [normal] (3,), and the numbers of those of each orientation."""
    steps = np.arange(NORMAL_STEPS, dtype=np.float32) / (NORMAL_STEPS - 1)
    y, x = (axis.ravel() for axis in np.meshgrid(steps, steps, indexing="ij"))
    normals = np.array(square_to_direction(mi.Float(x), mi.Float(y))).T
    fine = (np.arange(400, dtype=np.float32) + 0.5) / 400
    y, x = (axis.ravel() for axis in np.meshgrid(fine, fine, indexing="ij"))
    direction = square_to_direction(mi.Float(x), mi.Float(y))
    number, orientation = np.array(quantize_normal(direction)), np.array(orientation_of(direction))
    return normals, [np.unique(number[orientation == o]) for o in range(len(ORIENTATIONS))]


def make_products(guide, both_sides):
    """The products of the cells' maps with cosines, for each normal that is told apart."""
    normals, needed = quantized_normals()
    per_side = max(len(numbers) for numbers in needed)
    sides = 2 if both_sides else 1
    slots = np.zeros((len(needed), len(normals)), np.uint32)
    of_slot = np.zeros((len(needed), per_side), np.uint32)
    for orientation, numbers in enumerate(needed):
        slots[orientation, numbers] = np.arange(len(numbers))
        of_slot[orientation, :len(numbers)] = numbers
    count = per_side * sides
    sums, rim = array_of(mi.Float, guide.block_sums), mi.Float(guide.rules.rim)
    orientation = array_of(mi.UInt32, ((guide.cell_keys >> np.uint64(57)) & np.uint64(7)).astype(np.uint32))
    # One lane for each slot.
    lane = dr.arange(mi.UInt32, len(guide) * count)
    cell, slot = lane // count, lane % count
    number = dr.gather(mi.UInt32, array_of(mi.UInt32, of_slot), dr.gather(mi.UInt32, orientation, cell) * per_side
                       + slot % per_side)
    normal = dr.gather(mi.Vector3f, array_of(mi.Float, normals), number)
    below_sign = dr.select(slot >= per_side, mi.Float(-1), 0)
    x, y, z, total = (dr.gather(mi.ArrayXf, sums, cell * 4 + i, shape=(MAP_BLOCKS, -1)) for i in range(4))
    blocks = []
    for block in range(MAP_BLOCKS):
        cosine = x[block] * normal.x + y[block] * normal.y + z[block] * normal.z
        weight = dr.maximum(cosine, below_sign * cosine) + rim * total[block]
        blocks.append(mi.Float16(dr.maximum(weight * SUM_SCALE, LEAST_HALF)))
    table = dr.zeros(mi.Float16, len(guide) * count * MAP_BLOCKS)
    dr.scatter(table, mi.ArrayXf16(blocks), lane)
    cosine = normals @ guide.texel_directions
    counted = [np.maximum(cosine, 0) + guide.rules.rim] + ([np.abs(cosine) + guide.rules.rim] if both_sides else [])
    return {"blocks": table, "slots": array_of(mi.UInt32, slots), "slot_count": mi.UInt32(count),
            "cosines": array_of(mi.Float16, half_floats(np.array(counted))),
            "both_sides_slot": mi.UInt32(per_side if both_sides else 0)}


def make_guide_tables(guide, both_sides):
    """The tables of a guide that has cells. both_sides: whether surfaces are guided that scatter to both sides."""
    corner, size, cells = tabulate_cells(guide)
    rules = guide.rules
    radiance_scale = max(float(guide.outgoing_radiance.max()) / MOST_HALF, 1e-30)
    decisions = np.concatenate([guide.bsdf_fractions, guide.survival_factors[:, None],
                                guide.outgoing_radiance / np.float32(radiance_scale),
                                guide.learned_light_fractions[:, None]], axis=1)
    tables = GuideTables(
        origin=mi.Point3f(*map(float, corner)), inverse_edge=mi.Float(1 / guide.finest_edge),
        size=mi.Vector3i(*map(int, size)), entries=array_of(mi.UInt32, cells),
        texels=array_of(mi.Float16, positive_halves(guide.texels * np.float32(TEXEL_SCALE))),
        **make_products(guide, both_sides),
        decisions=array_of(mi.Float16, half_floats(decisions)), radiance_scale=mi.Float(radiance_scale),
        light_tables=array_of(mi.Float, guide.light_tables if guide.light_groups else np.zeros(2, np.float32)),
        roughness_bounds=[mi.Float(x) for x in rules.roughness_bounds[:2]],
        least_survival=mi.Float(rules.least_survival),
        full_shadow_ray_contribution=mi.Float(rules.full_shadow_ray_contribution),
        least_shadow_ray_probability=mi.Float(rules.least_shadow_ray_probability))
    dr.make_opaque(tables)
    return tables


def orientation_of(normal):
    """The number of the axis that a normal points along, in the order of ORIENTATIONS."""
    a = dr.abs(normal)
    x_most, y_most = (a.x >= a.y) & (a.x >= a.z), a.y >= a.z
    most = dr.select(x_most, normal.x, dr.select(y_most, normal.y, normal.z))
    return dr.select(x_most, mi.UInt32(0), dr.select(y_most, mi.UInt32(2), mi.UInt32(4))) \
        + dr.select(most >= 0, mi.UInt32(0), mi.UInt32(1))


def quantize_normal(normal):
    """The number of the normal nearest to this one, by the octahedral map."""
    x, y = direction_to_square(normal)
    last = NORMAL_STEPS - 1
    return mi.UInt32(dr.round(y * last)) * NORMAL_STEPS + mi.UInt32(dr.round(x * last))


def find_cell(tables, position, normal, active):
    """The finest cell of a vertex, odis.NO_CELL where there is none."""
    local = (position - tables.origin) * tables.inverse_edge
    at = mi.Vector3i(dr.floor(local))
    inside = active & dr.all((local >= 0) & (at < tables.size))
    entry = ((at.z * tables.size.y + at.y) * tables.size.x + at.x) * 6 + mi.Int32(orientation_of(normal))
    return dr.select(inside, dr.gather(mi.UInt32, tables.entries, mi.UInt32(entry), inside), odis.NO_CELL)


@dataclass
class Decisions:
    """What a cell decides beside directions; without a cell, what path tracing does."""

    bsdf_fraction: object
    survival_factor: object
    outgoing_radiance: object
    learned_light_fraction: object


def decisions_of(tables, cell, roughness, active):
    known = active & (cell != odis.NO_CELL)
    row = halves(tables.decisions, cell, 8, known)
    diffuse, rough = roughness >= tables.roughness_bounds[0], roughness >= tables.roughness_bounds[1]
    fraction = dr.select(diffuse, row[0], dr.select(rough, row[1], row[2]))
    return Decisions(bsdf_fraction=dr.select(known, fraction, 1), survival_factor=dr.select(known, row[3], dr.inf),
                     outgoing_radiance=dr.select(known, mi.Color3f(row[4], row[5], row[6]) * tables.radiance_scale, 0),
                     learned_light_fraction=dr.select(known, row[7], 0))


def survival_probability(tables, survival_factor, throughput):
    """The probability that a path goes on; `throughput` over the pixel's value, as luminance."""
    survival = throughput * survival_factor
    return dr.select(survival < 1, dr.maximum(survival, tables.least_survival), 1)


def shadow_ray_probability(tables, contribution):
    """The probability of tracing a shadow ray for light that adds this much, over the pixel's value, as luminance."""
    full = tables.full_shadow_ray_contribution
    return dr.select(contribution < full,
                     dr.maximum(contribution / full, tables.least_shadow_ray_probability), 1)


def half_floats(numbers):
    with np.errstate(over="ignore"):
        return numbers.astype(np.float16)


def positive_halves(numbers):
    """Half floats of which none is zero, infinite or not a number: a block that is drawn has a texel to draw."""
    return half_floats(np.fmin(np.fmax(numbers, np.float32(LEAST_HALF)), np.float32(MOST_HALF)))


def halves(table, row, length, active):
    """A row of a table of half floats with so many columns, as floats."""
    return [mi.Float(x) for x in dr.gather(mi.ArrayXf16, table, row, active, shape=(length, -1))]


def element(values, index):
    """values[index] of a list whose length is a power of two, lane by lane, by halving."""
    bit = 1
    while len(values) > 1:
        odd = (index & bit) != 0
        values = [dr.select(odd, values[i + 1], values[i]) for i in range(0, len(values), 2)]
        bit *= 2
    return values[0]


def row_of(table, index):
    """The four numbers table[4 index + i] of a list of 16."""
    return [element(table[i::4], index) for i in range(4)]


def pick(weights, u):
    """Which of four weights u, uniform in [0, 1), falls into, and its place within that."""
    begin = [mi.Float(0), weights[0], weights[0] + weights[1], weights[0] + weights[1] + weights[2]]
    target = u * (begin[3] + weights[3])
    one, zero = mi.UInt32(1), mi.UInt32(0)
    index = sum((dr.select(target >= begin[i], one, zero) for i in (2, 3)), dr.select(target >= begin[1], one, zero))
    within = (target - element(begin, index)) / element(weights, index)
    return index, dr.clip(within, 0, ONE_MINUS_EPSILON)


def row_sums(table):
    return [(table[i] + table[i + 1]) + (table[i + 2] + table[i + 3]) for i in range(0, 16, 4)]


def square_to_direction(x, y):
    """Clarberg's equal-area octahedral map, from the unit square to unit directions (odis/octahedral.h)."""
    u, v = 2 * x - 1, 2 * y - 1
    au, av = dr.abs(u), dr.abs(v)
    signed_distance = 1 - (au + av)
    r = 1 - dr.abs(signed_distance)
    q = dr.select(r == 0, 0, (av - au) / r)
    sine, cosine = dr.sincos(q * (dr.pi / 4))
    z = dr.copysign(1 - r * r, signed_distance)
    sin_theta = r * dr.sqrt(dr.maximum(2 - r * r, 0)) * dr.inv_sqrt_two
    return mi.Vector3f(dr.copysign((cosine - sine) * sin_theta, u), dr.copysign((cosine + sine) * sin_theta, v), z)


def direction_to_square(w):
    """The inverse of square_to_direction."""
    r = dr.sqrt(dr.maximum(1 - dr.abs(w.z), 0))
    x, y = dr.abs(w.x), dr.abs(w.y)
    most, least = dr.maximum(x, y), dr.minimum(x, y)
    t = dr.select(most > 0, least / most, 0)
    t2 = t * t
    octant = t * (0.6366173 + t2 * (-0.21210495 + t2 * (0.12610047 + t2 * (-0.08424606 + t2 * (
        0.05068998 + t2 * (-0.02139309 + t2 * 0.0043365154))))))
    phi = dr.select(y > x, 1 - octant, octant)
    v = phi * r
    u = r - v
    below = w.z < 0
    return ((dr.copysign(dr.select(below, 1 - v, u), w.x) + 1) * 0.5,
            (dr.copysign(dr.select(below, 1 - u, v), w.y) + 1) * 0.5)


def texel_of(direction):
    """The block that a direction falls into, and the texel within it."""
    x, y = direction_to_square(direction)
    column, row = dr.minimum(mi.UInt32(x * 16), 15), dr.minimum(mi.UInt32(y * 16), 15)
    return (row & ~mi.UInt32(3)) + (column >> 2), ((row & 3) << 2) + (column & 3)


class VertexMap:
    """A cell's map times the cosine at a vertex: a density over directions (odis::VertexMap).

    The normal is rounded to one of 121, axes among them, for which products are tabulated. The density remains exact:
    it is that of the rounded normal, in sampling and in evaluation.

    normal: unit shading normal on the side of the outgoing direction. both_sides: where the surface scatters to both.
    """

    def __init__(self, tables, cell, normal, both_sides, active):
        self.tables, self.cell = tables, cell
        self.normal = quantize_normal(normal)
        slot = dr.gather(mi.UInt32, tables.slots, orientation_of(normal) * NORMAL_STEPS ** 2 + self.normal, active)
        both = both_sides & (tables.both_sides_slot > 0)
        slot += dr.select(both, tables.both_sides_slot, 0)
        self.normal += dr.select(both, mi.UInt32(NORMAL_STEPS ** 2), 0)
        self.blocks = halves(tables.blocks, cell * tables.slot_count + slot, MAP_BLOCKS, active)
        self.rows = row_sums(self.blocks)
        total = (self.rows[0] + self.rows[1]) + (self.rows[2] + self.rows[3])
        self.sampleable = active & (total > 0) & (total < dr.inf)
        self.to_pdf = dr.select(self.sampleable, TEXELS_PER_STERADIAN / total, 0)

    def _weigh(self, block, active):
        """The weights of a block's 16 texels, and the density of a unit of weight."""
        texels = halves(self.tables.texels, self.cell * MAP_BLOCKS + block, BLOCK_TEXELS, active)
        cosines = halves(self.tables.cosines, self.normal * MAP_BLOCKS + block, BLOCK_TEXELS, active)
        weights = [texel * cosine for texel, cosine in zip(texels, cosines)]
        rows = row_sums(weights)
        total = (rows[0] + rows[1]) + (rows[2] + rows[3])
        return weights, rows, self.to_pdf * element(self.blocks, block) / total

    def pick_block(self, u, v):
        """Chooses a block; returns it and the numbers stretched again."""
        y, v = pick(self.rows, v)
        x, u = pick(row_of(self.blocks, y), u)
        return y * 4 + x, u, v

    def sample_or_evaluate(self, sampling, u, v, direction, active):
        """Where `sampling`, draws a direction from u, v; elsewhere keeps `direction`. Returns it and its density.

        Both at once, because the lanes of a SIMD packet would otherwise do one after the other.
        """
        drawn_block, u, v = self.pick_block(u, v)
        given_block, given_texel = texel_of(direction)
        block = dr.select(sampling, drawn_block, given_block)
        weights, rows, to_pdf = self._weigh(block, active)
        drawn_y, v = pick(rows, v)
        y = dr.select(sampling, drawn_y, given_texel >> 2)
        texels = row_of(weights, y)
        drawn_x, u = pick(texels, u)
        x = dr.select(sampling, drawn_x, given_texel & 3)
        pdf = dr.select(active & self.sampleable, element(texels, x) * to_pdf, 0)
        square_x = (mi.Float((block & 3) * 4 + x) + u) * (1 / 16)
        square_y = (mi.Float((block & ~mi.UInt32(3)) + y) + v) * (1 / 16)
        return dr.select(sampling, square_to_direction(square_x, square_y), direction), pdf

    def pdf(self, direction, active):
        """The density of a direction, with respect to solid angle."""
        block, texel = texel_of(direction)
        weights, _, to_pdf = self._weigh(block, active)
        return dr.select(active & self.sampleable, element(weights, texel) * to_pdf, 0)
