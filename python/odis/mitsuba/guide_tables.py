"""A guide as Dr.Jit arrays, and what a path looks up in it: odis/guide_view.h and odis/sampling_map.h for kernels."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

import odis

from .arrays import array_of

MOST_HALF = 65504.0
# A map has a table of 16 shares for its blocks and one for the texels of each block (odis.Guide.maps), two shares a word.
TABLE_WORDS = 8
MAP_WORDS = 17 * TABLE_WORDS
# What the product of the shares of block and texel is multiplied by for the density over solid angle.
TO_DENSITY = 256 / (4 * np.pi) / 2.0 ** 30
ONE_MINUS_EPSILON = float(np.nextafter(np.float32(1), np.float32(0)))
# Cells are found in a grid of the finest ones, which spans at most this many of them and this much beyond those that
# most vertices lie in; places outside are not guided. 4 bytes an entry.
MOST_ENTRIES = 1 << 21
MARGIN = 16
# Learned probabilities of groups of lights are multiples of 1 / WHOLE, so that their sums fit in 16 bits.
WHOLE = 1 << 16
DEEP_PATH, MOST_DEEP_SURVIVAL = 32, 0.95  # as in odis/guide_view.h
# The normals of the orientations of cells, in the order of the grid: +x, -x, +y, -y, +z, -z, and zero for cells of media.
# Scenes without media do without the last one.
ORIENTATIONS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [0, 0, 0]], np.float32)
OF_SURFACES, OF_MEDIUM = 6, 6  # how many are those of surfaces, and which one is that of media


@dataclass
class GuideTables:
    """What kernels read of a guide.

    4 bytes an entry of the grid; a cell has 544 bytes for its map, which are the library's own, 16 bytes of decisions,
    up to 8 bytes a group of lights, and 36 bytes of cached radiance.
    """

    origin: object  # Point3f: corner of the grid
    inverse_edge: object  # Float: 1 / edge of its cells
    size: object  # Vector3i: of the grid, in cells
    orientations: int  # of the grid: 6, or 7 with media
    entries: object  # UInt32 [z][y][x][orientation]: numbers of cells, or odis.NO_CELL
    maps: object  # UInt32 [cell][MAP_WORDS]
    decisions: object  # Float16 [cell][8]: BSDF fractions of the roughness classes, survival factor, outgoing radiance
    # over radiance_scale, fraction of the choices of a light that are learned
    radiance_scale: object  # Float
    group_sums: object  # UInt32 [cell][...]: sums of the learned probabilities of groups of lights (group_tables)
    group_probabilities: object  # Float [cell][group]
    roughness_bounds: object  # [2] least roughness of the classes diffuse and rough
    least_survival: object
    full_shadow_ray_contribution: object
    least_shadow_ray_probability: object
    pixel_cells: object = None  # UInt32 [pixel]: the cell of the pixel's own map, or odis.NO_CELL; None without such maps
    # Float [cell][half][4]: radiance that a path may end with, and its standard error; None where none may.
    cached: object = None
    cached_footprints: object = None  # Float [cell]: that a path has to have for that
    cached_error: object = None  # that it may make, over the pixel's value
    # Float [bounces left]: the part of it that a path still finds; the last for all that are left more. None without a
    # limit of depth.
    cached_shares: object = None
    last_share: object = None  # UInt32


def levels_of(keys):
    """The levels of cells, 0 for the finest, and how often their edges are doubled: int64 (cells,) each."""
    level = (keys >> np.uint64(60)).astype(np.int64)
    in_medium = ((keys >> np.uint64(57)) & np.uint64(7)) == 6
    return level, level + in_medium


def grid_box(guide, orientations):
    """The box of the finest cells to tabulate, in cells from the guide's origin: lowest corner and size, int64 (3,)."""
    keys = guide.cell_keys
    level, doublings = levels_of(keys)
    axes = [((keys >> np.uint64(19 * a)) & np.uint64((1 << 19) - 1)).astype(np.int64) - (1 << 18) for a in range(3)]
    near = axes[0] << doublings < 1024  # without the rings of larger cells, far out (odis/cell_grid.h)
    level, doublings, axes = level[near], doublings[near], [coordinate[near] for coordinate in axes]
    if not len(level):
        return np.zeros(3, np.int64), np.ones(3, np.int64)
    low, high = np.zeros(3, np.int64), np.zeros(3, np.int64)
    finest = level == 0 if (level == 0).any() else level == level.min()
    for a, coordinate in enumerate(axes):
        begin, end = coordinate << doublings, (coordinate + 1) << doublings
        core_low, core_high = np.quantile(begin[finest], [0.02, 0.98])
        low[a] = max(begin.min(), int(core_low) - MARGIN)
        high[a] = min(end.max(), int(core_high) + 1 + MARGIN)
    while np.prod(high - low) * orientations > MOST_ENTRIES:
        widest = np.argmax(high - low)
        cut = max(1, (high - low)[widest] // 8)
        low[widest] += cut
        high[widest] -= cut
    return low, high - low


def tabulate_cells(guide, orientations=OF_SURFACES):
    """The grid: its corner (3,), size (3,), and the cells' numbers [z][y][x][orientation], uint32."""
    low, size = grid_box(guide, orientations)
    edge, origin = guide.finest_edge, np.asarray(guide.origin)
    z, y, x = (np.arange(size[a], dtype=np.float32) + np.float32(0.5) for a in (2, 1, 0))
    middle = np.empty((size[2], size[1], size[0], orientations, 3), np.float32)
    middle[..., 0] = (origin[0] + (x + low[0]) * edge)[None, None, :, None]
    middle[..., 1] = (origin[1] + (y + low[1]) * edge)[None, :, None, None]
    middle[..., 2] = (origin[2] + (z + low[2]) * edge)[:, None, None, None]
    normals = np.broadcast_to(ORIENTATIONS[:orientations], middle.shape).reshape(-1, 3)
    cells = guide.find_cells(middle.reshape(-1, 3), np.ascontiguousarray(normals))
    return origin + low * edge, size, cells


def words_of(groups):
    """Words that hold the sums before groups, two a word: a power of two of them, which Dr.Jit reads at once."""
    return 1 << max(groups // 2 - 1, 0).bit_length()


def group_tables(cumulative):
    """GuideTables.group_sums and group_probabilities of cells' cumulative probabilities of groups [cell][groups + 1]: the
    sums that all groups but the first begin at, two a word; all probabilities are positive."""
    groups = cumulative.shape[1] - 1
    sums = np.rint(cumulative[:, 1:-1] * (WHOLE - groups)).astype(np.uint32) + np.arange(1, groups, dtype=np.uint32)
    whole = np.pad(sums, ((0, 0), (1, 1)))
    whole[:, -1] = WHOLE
    padded = np.pad(sums, ((0, 0), (0, 2 * words_of(groups) - groups + 1))).astype(np.uint16)
    return padded.view(np.uint32), (np.diff(whole, axis=1) / WHOLE).astype(np.float32)


def make_guide_tables(guide, has_media=False):
    """The tables of a guide that has cells. has_media: whether vertices may lie in media."""
    orientations = OF_SURFACES + has_media
    corner, size, cells = tabulate_cells(guide, orientations)
    rules = guide.rules
    radiance_scale = max(float(guide.outgoing_radiance.max()) / MOST_HALF, 1e-30)
    decisions = np.concatenate([guide.bsdf_fractions, guide.survival_factors[:, None],
                                guide.outgoing_radiance / np.float32(radiance_scale),
                                guide.learned_light_fractions[:, None]], axis=1)
    sums, probabilities = group_tables(guide.light_tables if guide.light_groups else np.array([[0, 1]], np.float32))
    tables = GuideTables(
        origin=mi.Point3f(*map(float, corner)), inverse_edge=mi.Float(1 / guide.finest_edge),
        size=mi.Vector3i(*map(int, size)), orientations=orientations, entries=array_of(mi.UInt32, cells),
        maps=array_of(mi.UInt32, guide.maps.reshape(-1).view(np.uint32)),
        decisions=array_of(mi.Float16, half_floats(decisions)), radiance_scale=mi.Float(radiance_scale),
        group_sums=array_of(mi.UInt32, sums), group_probabilities=array_of(mi.Float, probabilities),
        roughness_bounds=[mi.Float(x) for x in rules.roughness_bounds[:2]],
        least_survival=mi.Float(rules.least_survival),
        full_shadow_ray_contribution=mi.Float(rules.full_shadow_ray_contribution),
        least_shadow_ray_probability=mi.Float(rules.least_shadow_ray_probability),
        pixel_cells=array_of(mi.UInt32, guide.pixel_cells) if guide.pixel_cells.size else None)
    if guide.cached_radiance.size:
        edges = guide.finest_edge * (1 << levels_of(guide.cell_keys)[1])
        tables.cached = array_of(mi.Float, guide.cached_radiance)
        tables.cached_footprints = array_of(mi.Float, (rules.least_cached_footprint * edges).astype(np.float32))
        tables.cached_error = mi.Float(rules.cached_error)
        if guide.cached_shares.size:
            tables.cached_shares = array_of(mi.Float, np.append(guide.cached_shares, np.float32(1)))
            tables.last_share = mi.UInt32(guide.cached_shares.size)
    dr.make_opaque(tables)
    return tables


def orientation_of(normal):
    """The number of the axis that a normal, not zero, points along, in the order of ORIENTATIONS."""
    a = dr.abs(normal)
    x_most, y_most = (a.x >= a.y) & (a.x >= a.z), a.y >= a.z
    most = dr.select(x_most, normal.x, dr.select(y_most, normal.y, normal.z))
    return dr.select(x_most, mi.UInt32(0), dr.select(y_most, mi.UInt32(2), mi.UInt32(4))) \
        + dr.select(most >= 0, mi.UInt32(0), mi.UInt32(1))


def find_cell(tables, position, normal, active):
    """The finest cell of a vertex, odis.NO_CELL where there is none. normal: zero in a medium."""
    local = (position - tables.origin) * tables.inverse_edge
    at = mi.Vector3i(dr.floor(local))
    # Before they become integers: what is huge has none.
    inside, on_surface = active & dr.all((local >= 0) & (local < mi.Vector3f(tables.size))), dr.any(normal != 0)
    orientation = orientation_of(normal)
    if tables.orientations == OF_SURFACES:
        inside &= on_surface
    else:
        orientation = dr.select(on_surface, orientation, OF_MEDIUM)
    entry = ((at.z * tables.size.y + at.y) * tables.size.x + at.x) * tables.orientations + mi.Int32(orientation)
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


def choose_group(tables, cell, groups, u, active):
    """A group of lights by a cell's learned probabilities and u in [0, 1); and where in the group's part u lies.

    All sums are read at once and compared with; a search would wait for one read after the other.
    """
    words = dr.gather(mi.ArrayXu, tables.group_sums, cell, active, shape=(words_of(groups), -1))
    u = u * WHOLE
    group, begin, end = mi.UInt32(0), mi.Float(0), mi.Float(WHOLE)
    for i in range(groups - 1):
        sum_before = mi.Float((words[i // 2] >> (16 * (i % 2))) & 0xffff)
        passed = sum_before <= u
        group += dr.select(passed, mi.UInt32(1), 0)
        begin, end = dr.select(passed, sum_before, begin), dr.select(passed, end, dr.minimum(end, sum_before))
    return group, dr.minimum((u - begin) / (end - begin), 1)


def survival_probability(tables, survival_factor, throughput, depth):
    """The probability that a path goes on (odis::survivalProbability); `throughput` over the pixel's value."""
    survival, most = throughput * survival_factor, dr.select(depth < DEEP_PATH, 1, MOST_DEEP_SURVIVAL)
    return dr.select(survival < most, dr.maximum(survival, tables.least_survival), most)


def shadow_ray_probability(tables, contribution):
    """The probability of tracing a shadow ray for light that adds this much, over the pixel's value, as luminance."""
    full = tables.full_shadow_ray_contribution
    return dr.select(contribution < full,
                     dr.maximum(contribution / full, tables.least_shadow_ray_probability), 1)


def path_half(pixel, sample):
    """The half of the paths that a path belongs to, 0 or 1 (odis::pathHalf)."""
    word = (mi.UInt64(pixel) << 32) | mi.UInt64(sample)
    word = (word ^ (word >> 33)) * 0xff51afd7ed558ccd
    word = (word ^ (word >> 33)) * 0xc4ceb9fe1a85ec53
    return mi.UInt32(word >> 63)


def segment_footprint(distance, pdf, cosine):
    """What a segment adds to the footprint of its path (odis::segmentFootprint)."""
    return distance * dr.rsqrt(dr.maximum(pdf * cosine, 1e-20))


def cached_share(tables, bounces_left, active):
    """What is left of cached radiance for a path that may be scattered so many times yet (odis::cachedShare)."""
    if tables.cached_shares is None:
        return mi.Float(1)
    return dr.gather(mi.Float, tables.cached_shares, dr.minimum(bounces_left, tables.last_share), active)


def cached_radiance(tables, cell, half, throughput, footprint, share, active):
    """The radiance that a path which arrives in a cell may end with, and whether it does (odis::cachedRadiance)."""
    active = active & (cell != odis.NO_CELL)
    row = dr.gather(mi.ArrayXf, tables.cached, 2 * cell + half, active, shape=(4, -1))
    least = dr.gather(mi.Float, tables.cached_footprints, cell, active)
    ends = active & (throughput * row[3] < tables.cached_error) & (footprint >= least) & (share > 0)
    return mi.Color3f(row[0], row[1], row[2]) * share, ends


def half_floats(numbers):
    with np.errstate(over="ignore"):
        return numbers.astype(np.float16)


def halves(table, row, length, active):
    """A row of a table of half floats with so many columns, as floats."""
    return [mi.Float(x) for x in dr.gather(mi.ArrayXf16, table, row, active, shape=(length, -1))]


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
    """The inverse of square_to_direction, in [0, 1]: 0 for what is no number, as that would have no texel."""
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
    x = (dr.copysign(dr.select(below, 1 - v, u), w.x) + 1) * 0.5
    y = (dr.copysign(dr.select(below, 1 - u, v), w.y) + 1) * 0.5
    return dr.select(x > 0, x, 0), dr.select(y > 0, y, 0)


def texel_of(direction):
    """The block that a direction falls into, and the texel within it."""
    x, y = direction_to_square(direction)
    column, row = dr.minimum(mi.UInt32(x * 16), 15), dr.minimum(mi.UInt32(y * 16), 15)
    return (row & ~mi.UInt32(3)) + (column >> 2), ((row & 3) << 2) + (column & 3)


def pick(weights, u):
    """The one of four weights that a number u in [0, 1) falls into, and u stretched to its place in it."""
    target = u * (weights[0] + weights[1] + weights[2] + weights[3])
    picked, begin, width, end = mi.UInt32(0), mi.Float(0), weights[0], weights[0]
    for i in range(1, 4):
        passed = target >= end
        picked, begin, width = (dr.select(passed, mi.UInt32(i), picked), dr.select(passed, end, begin),
                                dr.select(passed, weights[i], width))
        end = end + weights[i]
    return picked, dr.minimum((target - begin) / width, ONE_MINUS_EPSILON)


def draw(maps, table, u, v, active):
    """Draws an entry of a table of shares, four rows of four: v chooses the row, u the entry in it. Returns it and both
    numbers stretched. table: number of its first word."""
    words = dr.gather(mi.ArrayXu, maps, table // TABLE_WORDS, active, shape=(TABLE_WORDS, -1))
    shares = [mi.Float(words[i // 2] & 0xffff if i % 2 == 0 else words[i // 2] >> 16) for i in range(16)]
    row, v = pick([shares[4 * y] + shares[4 * y + 1] + (shares[4 * y + 2] + shares[4 * y + 3]) for y in range(4)], v)
    column, u = pick([dr.select(row < 2, dr.select(row == 0, shares[x], shares[4 + x]),
                                       dr.select(row == 2, shares[8 + x], shares[12 + x])) for x in range(4)], u)
    return row * 4 + column, u, v


def share_of(maps, table, entry, active):
    word = dr.gather(mi.UInt32, maps, table + (entry >> 1), active)
    return mi.Float((word >> ((entry & 1) << 4)) & 0xffff)


class SamplingMap:
    """A cell's map: a density over directions (odis::SamplingMap)."""

    def __init__(self, tables, cell):
        self.maps, self.blocks = tables.maps, cell * MAP_WORDS

    def table_of(self, block):
        return self.blocks + (block + 1) * TABLE_WORDS

    def sample(self, u, v, active):
        """A direction, by u and v in [0, 1)."""
        block, u, v = draw(self.maps, self.blocks, u, v, active)
        texel, u, v = draw(self.maps, self.table_of(block), u, v, active)
        x = (mi.Float((block & 3) * 4 + (texel & 3)) + u) * (1 / 16)
        y = (mi.Float((block & ~mi.UInt32(3)) + (texel >> 2)) + v) * (1 / 16)
        return square_to_direction(x, y)

    def pdf(self, direction, active):
        """The density of a direction, with respect to solid angle; 0 where not active."""
        block, texel = texel_of(direction)
        of_block = share_of(self.maps, self.blocks, block, active)
        of_texel = share_of(self.maps, self.table_of(block), texel, active)
        return dr.select(active, of_block * of_texel * TO_DENSITY, 0)
