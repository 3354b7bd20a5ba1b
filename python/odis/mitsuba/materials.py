"""What may be guided of Mitsuba's BSDFs, found when a scene is first rendered."""

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

from .arrays import array_of, number_of

# Lobes of a smaller roughness (alpha of a microfacet distribution) are left alone, as the library's networks expect.
LEAST_GUIDED_ROUGHNESS = 0.05
# Plugins that scatter by delta and other lobes and whose density of the others alone, as the type mask of BSDFContext
# asks for it, is normalised. Their children need to be such, too.
SEPARABLE = {"SmoothPlastic", "MaskBSDF", "TwoSidedBRDF", "BumpMap", "NormalMap"}
# SEES_THROUGH: some of the delta lobes let light pass, so that they are no coat.
GUIDABLE, HAS_DELTA, BOTH_SIDES, SMOOTH, SEES_THROUGH = 1, 2, 4, 8, 16


def nodes_below(bsdf):
    """The BSDF and the BSDFs that it nests."""
    hierarchy = mi.traverse(bsdf).hierarchy
    return [node for node in hierarchy if isinstance(node, mi.BSDF)] or [bsdf]


def mean_of(parameters, name):
    """The mean of a parameter that may be a number or a texture; None without one."""
    for suffix in ("", ".value", ".data"):
        value = parameters.get(name + suffix)
        if value is not None:
            return float(np.mean(np.asarray(value)))
    return None


def leaf_roughness(bsdf):
    """alpha of the lobe of a BSDF that matters most, 1 for diffuse, and the least alpha of its lobes."""
    kind, parameters = bsdf.class_name(), mi.traverse(bsdf)
    alpha = mean_of(parameters, "alpha")
    if alpha is None:
        along = [mean_of(parameters, "alpha_u"), mean_of(parameters, "alpha_v")]
        alpha = None if None in along else min(along)
    if kind == "RoughPlastic":
        base = mean_of(parameters, "diffuse_reflectance")
        return (1 if base is None or base > 0.04 else alpha), alpha
    if kind.startswith("Principled"):
        roughness = mean_of(parameters, "roughness")
        alpha = 0.25 if roughness is None else roughness ** 2
        metallic, transmission = (mean_of(parameters, name) or 0 for name in ("metallic", "spec_trans"))
        return (alpha if max(metallic, transmission) >= 0.5 else 1), alpha
    if alpha is not None and mi.has_flag(bsdf.flags(), mi.BSDFFlags.Glossy):
        return alpha, alpha
    return 1, 1


def describe(bsdf):
    """Flags (GUIDABLE ...) and roughness of a BSDF."""
    flags, everything = bsdf.flags(), nodes_below(bsdf)
    smooth, delta = mi.has_flag(flags, mi.BSDFFlags.Smooth), mi.has_flag(flags, mi.BSDFFlags.Delta)
    transmits = mi.has_flag(flags, mi.BSDFFlags.Transmission)
    leaves = [leaf_roughness(node) for node in everything if mi.has_flag(node.flags(), mi.BSDFFlags.Smooth)]
    roughness = min((r for r, _ in leaves), default=1)
    passes = mi.has_flag(flags, mi.BSDFFlags.DeltaTransmission) or mi.has_flag(flags, mi.BSDFFlags.Null)
    result = (SMOOTH if smooth else 0) | (BOTH_SIDES if transmits else 0) | (HAS_DELTA if delta else 0) \
        | (SEES_THROUGH if passes else 0)
    separable = not delta or all(node.class_name() in SEPARABLE or not mi.has_flag(node.flags(), mi.BSDFFlags.Delta)
                                 for node in everything)
    if smooth and separable and min((least for _, least in leaves), default=1) >= LEAST_GUIDED_ROUGHNESS:
        result |= GUIDABLE
    return result, roughness


@dataclass
class MaterialTable:
    """What there is to know of the scene's BSDFs, by their numbers in Dr.Jit's registry. 4 bytes each."""

    entries: object  # UInt32: flags, and 65,535 times the roughness in the upper half
    any_delta: bool  # whether a BSDF that may be guided scatters by delta lobes, too


def make_material_table(scene):
    """The table, and the class names of BSDFs with smooth lobes that are not guided."""
    found = {}
    for node in mi.traverse(scene).hierarchy:
        if isinstance(node, mi.BSDF):
            found[number_of(mi.BSDFPtr(node))] = (node.class_name(), *describe(node))
    flags = np.zeros(max(found, default=0) + 1, np.uint32)
    roughness = np.ones(flags.size, np.float32)
    for number, (_, flag, alpha) in found.items():
        flags[number], roughness[number] = flag, alpha
    entries = flags | np.round(np.clip(roughness, 0, 1) * 65535).astype(np.uint32) << 16
    guidable = flags[(flags & GUIDABLE) != 0]
    table = MaterialTable(array_of(mi.UInt32, entries), any_delta=bool((guidable & HAS_DELTA).any()))
    dr.make_opaque(table)
    return table, sorted({name for name, flag, _ in found.values() if flag & SMOOTH and not flag & GUIDABLE})


def material_at(table, bsdf, active):
    """Flags and roughness of the BSDFs that vertices lie on."""
    entry = dr.gather(mi.UInt32, table.entries, dr.reinterpret_array(mi.UInt32, bsdf), active)
    return entry, mi.Float(entry >> 16) * (1 / 65535)
