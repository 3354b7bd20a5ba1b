"""Random numbers of paths: Sobol' points, padded by dimension, as odis render has them (Burley 2020, "Practical
Hash-based Owen Scrambling")."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi

HASH_FACTORS = (0xff51afd7ed558ccd, 0xc4ceb9fe1a85ec53)
# Dimensions of the camera's numbers, and after these of each vertex's. A number takes one, and a pair of numbers, too.
OF_CAMERA, OF_VERTEX = 4, 8
GOLDEN_RATIO = 0x9e3779b9  # the fractional part's 32 bits


def mix_bits(x):
    """A hash of 32 bits (MurmurHash3's finalizer)."""
    x = (x ^ (x >> 16)) * 0x85ebca6b
    x = (x ^ (x >> 13)) * 0xc2b2ae35
    return x ^ (x >> 16)


def scramble(x, seed):
    """Owen scrambling by hashing (Laine and Karras 2011), on bits from the lowest up."""
    x = x ^ x * 0x3d20adea
    x = (x + seed) * ((seed >> 16) | 1)
    x ^= x * 0x05526c56
    return x ^ x * 0x53a22864


def second_sobol_reversed(index):
    """The second coordinate of a Sobol' point, bit-reversed: the Pascal triangle modulo two, in five butterflies. (The
    first coordinate is the index, bit-reversed.)"""
    x = mi.UInt32(index)
    for shift, mask in ((1, 0x55555555), (2, 0x33333333), (4, 0x0f0f0f0f), (8, 0x00ff00ff), (16, 0x0000ffff)):
        x ^= (x >> shift) & mask
    return x


def to_unit(bits):
    """A fraction in [0, 1), of 23 bits."""
    return dr.reinterpret_array(mi.Float, (bits >> 9) | 0x3f800000) - 1


@dataclass
class RandomNumbers:
    """The numbers of a sample: those of a point of its pixel's set, which all passes with one seed share."""

    key: object  # UInt32: of the pixel and the seed
    index: object  # UInt32: number of the sample in its pixel, bit-reversed

    def of_camera(self):
        return Draws(self, mi.UInt32(0))

    def of_vertex(self, depth):
        """Every vertex has dimensions of its own, whatever the vertices before it drew."""
        return Draws(self, OF_CAMERA + OF_VERTEX * depth)

    def further(self, count):
        """An independent number, uniform in [0, 1): the one after `count` others. For what draws any number of them."""
        return to_unit(mix_bits(mix_bits(self.key ^ (~count * GOLDEN_RATIO)) ^ self.index))


class Draws:
    """Numbers of consecutive dimensions. Each number, or pair, is the one-dimensional or two-dimensional Sobol' sequence,
    shuffled and scrambled anew."""

    def __init__(self, numbers, dimension):
        self.numbers, self.dimension = numbers, dimension

    def next(self):
        """A number uniform in [0, 1)."""
        index, hashed = self._begin()
        return to_unit(dr.brev(scramble(index, mix_bits(hashed + GOLDEN_RATIO))))

    def next_2d(self):
        index, hashed = self._begin()
        return mi.Point2f(to_unit(dr.brev(scramble(index, mix_bits(hashed + GOLDEN_RATIO)))),
                          to_unit(dr.brev(scramble(second_sobol_reversed(index), mix_bits(hashed ^ GOLDEN_RATIO)))))

    def _begin(self):
        """The shuffled index in the next dimension, and a hash of it."""
        hashed = mix_bits(self.numbers.key ^ (self.dimension * GOLDEN_RATIO))
        self.dimension += 1
        return dr.brev(scramble(self.numbers.index, hashed)), hashed


def hash_seed(seed):
    """Spreads the seeds of passes, which are often 0, 1, 2, ..., over 64 bits."""
    seed = (seed + 0x9e3779b97f4a7c15) % 2 ** 64
    for factor in HASH_FACTORS:
        seed = ((seed ^ seed >> 33) * factor) % 2 ** 64
    return seed ^ seed >> 33


def numbers_of(seed, pixel, number):
    """The random numbers of a sample of a pixel. seed: that of the pass, hashed, a UInt64."""
    key = mi.UInt64(pixel) ^ seed
    for factor in HASH_FACTORS:
        key = (key ^ (key >> 33)) * mi.UInt64(factor)
    return RandomNumbers(mi.UInt32(key >> 32), dr.brev(mi.UInt32(number)))
