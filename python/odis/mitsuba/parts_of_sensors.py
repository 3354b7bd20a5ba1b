"""Films, reconstruction filters and samplers of old scene files as Mitsuba 3 takes them, or where it takes them."""

from copy import deepcopy

import mitsuba as mi

from .elements import defaults_of, drop, name_of, snake_case, value_of

# What takes the place of types that Mitsuba does not have (`ldrfilm`, `mfilm` and `halton` of 0.6, say), and which of
# their parameters stay.
SIZE = {"width", "height", "crop_offset_x", "crop_offset_y", "crop_width", "crop_height"}
PLACE_TAKERS = {"film": ("hdrfilm", SIZE), "rfilter": ("gaussian", set()), "sampler": ("independent", {"sample_count"})}
# What `hdrfilm` may be told, beside other things that the formats of 0.6 could be.
FORMATS = {"pixel_format": {"luminance", "luminance_alpha", "rgb", "rgba", "xyz", "xyza"},
           "file_format": {"openexr", "exr", "rgbe", "pfm"}, "component_format": {"float16", "float32", "uint32"}}


def renew_parts_of_sensors(root, warn):
    """`warn` is called with a sentence about each thing that is left out or replaced."""
    _gather(root)
    _keep_first(root, warn)
    _replace_unknown(root, warn)
    _drop_unknown_formats(root, warn)


def _gather(root):
    """Puts films and samplers that lie beside the sensors into those that refer to them or, as in files of Mitsuba 0.5,
    have none."""
    for tag in ("film", "sampler"):
        beside = root.findall(tag)
        by_id = {node.get("id"): node for node in beside if node.get("id")}
        for sensor in root.iter("sensor") if beside else ():
            for ref in sensor.findall("ref"):
                if ref.get("id") in by_id:
                    sensor.remove(ref)
                    sensor.append(_copy_without_id(by_id[ref.get("id")]))
            if sensor.find(tag) is None:
                sensor.append(_copy_without_id(beside[0]))
        for node in beside:
            root.remove(node)


def _copy_without_id(node):
    copy = deepcopy(node)
    copy.attrib.pop("id", None)
    return copy


def _keep_first(root, warn):
    """A sensor has one film and one sampler, a film one filter."""
    for owner, tag in (("sensor", "film"), ("sensor", "sampler"), ("film", "rfilter")):
        for node in root.iter(owner):
            for further in node.findall(tag)[1:]:
                node.remove(further)
                warn(f"a {owner} has one {tag} only, the further {tag} {further.get('type')} is left out")


def _is_known(tag, kind):
    if tag == "film" and kind == "specfilm" and not mi.is_spectral:
        return False
    type_of_tag = {"film": mi.ObjectType.Film, "rfilter": mi.ObjectType.ReconstructionFilter,
                   "sampler": mi.ObjectType.Sampler}[tag]
    return mi.PluginManager.instance().plugin_type(kind) == type_of_tag


def _replace_unknown(root, warn):
    defaults = defaults_of(root)
    for tag, (taker, kept) in PLACE_TAKERS.items():
        for node in root.iter(tag):
            kind = value_of(node.get("type", ""), defaults)
            if kind and _is_known(tag, kind):
                continue
            warn(f"the {tag} {kind or node.get('type')} is not known here; {taker} takes its place")
            node.set("type", taker)
            for child in list(node):
                if child.tag not in ("rfilter", "ref") and name_of(child) not in kept:
                    node.remove(child)


def _drop_unknown_formats(root, warn):
    defaults = defaults_of(root)
    for film in root.iter("film"):
        for child in list(film):
            name, value = name_of(child), value_of(child.get("value", ""), defaults)
            if film.get("type") != "hdrfilm" or name not in FORMATS or not value:
                continue
            if snake_case(value) in FORMATS[name]:  # `luminanceAlpha`
                child.set("value", snake_case(value))
            elif value.lower() not in FORMATS[name]:
                warn(f"the {name} {value} of a film is not known here; the default takes its place")
                drop(film, {name})
