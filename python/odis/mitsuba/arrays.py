"""numpy's arrays as Dr.Jit's."""

import drjit as dr
import mitsuba as mi
import numpy as np


def array_of(kind, numbers):
    """A copy of numbers as an evaluated array of this type.

    Without the copy Dr.Jit may refer to numpy's memory. Its alignment differs from array to array, and kernels are
    compiled again when it changes.
    """
    mapped = kind(np.ascontiguousarray(numbers).ravel())
    copy = dr.gather(kind, mapped, dr.arange(mi.UInt32, dr.width(mapped)))
    dr.eval(copy)
    return copy


def number_of(pointer):
    """The number of a single pointer (mi.BSDFPtr and the like) in Dr.Jit's registry."""
    return int(dr.reinterpret_array(mi.UInt32, pointer)[0])
