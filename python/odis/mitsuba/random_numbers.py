"""Random numbers of paths."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi


@dataclass
class RandomNumbers:
    """xoroshiro64* (Blackman and Vigna 2021, "Scrambled Linear Pseudorandom Number Generators"), one generator a lane.

    It works with 32 bits, which SIMD units multiply several times as fast as the 64 of PCG32.
    """

    s0: object  # UInt32
    s1: object

    def next(self):
        """A number uniform in [0, 1), of 23 bits."""
        result = self.s0 * mi.UInt32(0x9E3779BB)
        s1 = self.s1 ^ self.s0
        self.s0 = ((self.s0 << 26) | (self.s0 >> 6)) ^ s1 ^ (s1 << 9)
        self.s1 = (s1 << 13) | (s1 >> 19)
        return dr.reinterpret_array(mi.Float, (result >> 9) | 0x3f800000) - 1

    def next_2d(self):
        u = self.next()
        return mi.Point2f(u, self.next())


HASH_FACTORS = (0xff51afd7ed558ccd, 0xc4ceb9fe1a85ec53)


def hash_seed(seed):
    """Spreads the seeds of passes, which are often 0, 1, 2, ..., over 64 bits."""
    seed = (seed + 0x9e3779b97f4a7c15) % 2 ** 64
    for factor in HASH_FACTORS:
        seed = ((seed ^ seed >> 33) * factor) % 2 ** 64
    return seed ^ seed >> 33


def generator_of(seed, pixel, number):
    """The generator of a sample of a pixel, by MurmurHash3's finalizer. seed: that of the pass, hashed, a UInt64."""
    key = (mi.UInt64(pixel) << 32 | mi.UInt64(number)) ^ seed
    for factor in HASH_FACTORS:
        key = (key ^ (key >> 33)) * mi.UInt64(factor)
    key ^= key >> 33
    s0, s1 = mi.UInt32(key), mi.UInt32(key >> 32)
    return RandomNumbers(s0, dr.select((s0 | s1) == 0, 1, s1))
