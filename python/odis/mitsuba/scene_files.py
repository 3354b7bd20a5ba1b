"""Loads scene files of Mitsuba 3, and those of older versions with what Mitsuba 3 no longer takes left out."""

import os
import re
from xml.etree import ElementTree
from xml.parsers import expat

import mitsuba as mi
import numpy as np

from .aovs import check_aovs
from .elements import defaults_of, drop, name_of, number_of, set_number, value_of
from .parts_of_sensors import renew_parts_of_sensors

# What is kept of an integrator that Mitsuba does not have.
KEPT = {"max_depth", "rr_depth", "hide_emitters"}
# What only the skies of Mitsuba 0.6 know, and only those of Mitsuba 3; what says where the sun stands.
OLD_SKY, NEW_SKY = {"extend", "resolution", "scale", "stretch", "sun_radius_scale"}, {"sun_aperture", "complex_sun"}
TIME_AND_PLACE = {"year", "month", "day", "hour", "minute", "second", "latitude", "longitude", "timezone"}
SUN_DIAMETER, LEAST_APERTURE = 0.5358, 0.1  # degrees; single precision in Mitsuba loses smaller suns


def load_file(path, size=None, pixels=None, rfilter=None, sampler=None, warn=None):
    """The scene (mi.Scene) of an XML file.

    Mitsuba upgrades old versions itself. Beyond that, parameters that it refuses as unreferenced are dropped, texture
    filters that it no longer has become `bilinear`, and an integrator that it does not have becomes `path`, with its
    max_depth, rr_depth and hide_emitters. The `sun`, `sky` and `sunsky` of Mitsuba 0.6, where +Y is up, become `sunsky`
    as it is now, where +Z is. `warn` is called with a sentence about each of these; by default it goes to
    Mitsuba's log.

    size: (width, height) in place of what the films of the file say; their crop windows are dropped then.
    pixels: about so many pixels with the proportions of the file, in place of a size.
    rfilter, sampler: types of reconstruction filter and of sampler in place of the file's.

    Raises ValueError if the file is no scene in XML, RuntimeError if Mitsuba does not load it.
    """
    warn = warn or (lambda text: mi.Log(mi.LogLevel.Warn, f"odis: {path}: {text}"))
    with open(path, "rb") as file:
        text = file.read()
    text = _without_rest(text, warn)
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise ValueError(f"expected a scene in XML: {error}") from None
    if root.tag != "scene":
        raise ValueError(f"expected a scene in XML, found the element <{root.tag}>")
    places = dict(zip(root.iter(), _start_tags(text), strict=True))
    _replace_unknown_integrators(root, warn)
    _check_aovs(root)
    renew_parts_of_sensors(root, warn)
    _replace_texture_filters(root, warn)
    _renew_skies(root)
    if size or pixels or rfilter or sampler:
        _set_sensors(root, size, pixels, rfilter, sampler)
    outside = mi.file_resolver()
    resolver = mi.FileResolver(outside)
    resolver.prepend(os.path.dirname(os.path.abspath(path)))
    mi.set_file_resolver(resolver)
    try:
        scene = _load(root, places, warn)
    finally:
        mi.set_file_resolver(outside)
    if not isinstance(scene, mi.Scene):
        raise ValueError("expected one scene")
    return scene


def _without_rest(text, warn):
    """The bytes of a file up to the end of its first element."""
    parser = expat.ParserCreate()
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        if error.code == expat.errors.codes[expat.errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT]:
            warn(f"what follows </scene> (line {error.lineno}) is left out")
            return text[:parser.ErrorByteIndex]
    return text


def _check_aovs(root):
    """Refuses what Mitsuba's integrator `aov` would crash at."""
    defaults = defaults_of(root)
    for node in root.iter("integrator"):
        for child in node.findall("string"):
            value = value_of(child.get("value", ""), defaults)
            if name_of(child) == "aovs" and value:
                check_aovs(value)


def _load(root, places, warn):
    """places: line and column of elements in the file, which Mitsuba's errors are made to speak of."""
    while True:
        text = ElementTree.tostring(root, encoding="unicode")
        try:
            return mi.load_string(text)
        except RuntimeError as error:
            culprit, match = _culprit(root, text, str(error))
            if culprit is None:
                raise
            dropped = _drop_unreferenced(root, culprit, str(error))
            if not dropped:
                place = "line {}, col {}".format(*places[culprit]) if culprit in places else "an added element"
                raise RuntimeError(str(error).replace(match[0], place)) from None
            warn(dropped)


def _culprit(root, text, error):
    """The element that an error speaks of, and where it does."""
    match = re.search(r"string \(line (\d+), col (\d+)\)", error)
    at = (int(match[1]), int(match[2])) if match else None
    return next((node for place, node in zip(_start_tags(text), root.iter(), strict=True) if place == at), None), match


def _start_tags(text):
    """Line and column of the names of all elements, in their order."""
    parser, found = expat.ParserCreate(), []
    parser.StartElementHandler = lambda *_: found.append((parser.CurrentLineNumber, parser.CurrentColumnNumber + 2))
    parser.Parse(text, True)
    return found


def _names(node):
    return sorted(child.get("name", "") for child in node)


def _drop_unreferenced(root, culprit, error):
    """Drops parameters of the element that an error speaks of, and of others of its type with the same parameters.
    Returns what was dropped in words; None if the error is another one."""
    if not re.search(r"Found \d+ unreferenced", error):
        return None
    unknown = set(re.findall(r'^ +- \w+ "([^"]+)"', error, re.MULTILINE))
    alike = [node for node in root.iter(culprit.tag)
             if node.get("type") == culprit.get("type") and _names(node) == _names(culprit)]
    dropped = set()
    for node in alike:
        for child in list(node):
            if {child.get("name"), name_of(child)} & unknown:
                node.remove(child)
                dropped.add(child.get("name"))
    if not dropped:
        return None
    return f"dropped of {culprit.tag} {culprit.get('type')}, which does not know them: " + ", ".join(sorted(dropped))


def _is_integrator(kind):
    if mi.PluginManager.instance().plugin_type(kind) == mi.ObjectType.Integrator:
        return True
    try:  # Those written in Python are not known before they are made.
        mi.load_dict({"type": kind})
    except RuntimeError as error:
        return "not found" not in str(error)
    return True


def _replace_unknown_integrators(root, warn):
    defaults = defaults_of(root)
    for further in root.findall("integrator")[1:]:
        root.remove(further)
        warn(f"a scene has one integrator only, the further integrator {further.get('type')} is left out")
    for node in root.iter("integrator"):
        kind = value_of(node.get("type", ""), defaults)
        if kind and _is_integrator(kind):
            continue
        warn(f"the integrator {kind or node.get('type')} is not known here; path takes its place")
        node.set("type", "path")
        for child in list(node):
            name, value = name_of(child), value_of(child.get("value", ""), defaults)
            if name not in KEPT or not value:
                node.remove(child)


def _replace_texture_filters(root, warn):
    unknown = [node for node in root.iter("string") if node.get("value") in ("trilinear", "ewa")]
    for node in unknown:
        node.set("value", "bilinear")
    if unknown:
        warn("the texture filters trilinear and ewa are not known any more; bilinear takes their place")


def _renew_skies(root):
    """Turns skies of Mitsuba 0.6 into those of Mitsuba 3."""
    defaults = defaults_of(root)
    before_2 = root.get("version", "3").startswith(("0.", "1."))
    for node in root.iter("emitter"):
        kind = value_of(node.get("type", ""), defaults)
        given = {name_of(child): value_of(child.get("value", ""), defaults) for child in node}
        old = kind in ("sun", "sky") or kind == "sunsky" and (before_2 or OLD_SKY & set(given))
        if not old or NEW_SKY & set(given):
            continue
        node.set("type", "sunsky")
        for part in ("sun", "sky"):
            if kind not in (part, "sunsky"):
                set_number(node, f"{part}_scale", 0)
            elif f"{part}_scale" not in given and given.get("scale"):
                set_number(node, f"{part}_scale", given["scale"])
        if given.get("sun_radius_scale"):  # 0 was a sun without a diameter
            scale = number_of(node, given["sun_radius_scale"])
            set_number(node, "sun_aperture", max(SUN_DIAMETER * scale, LEAST_APERTURE))
        drop(node, {"scale", "sun_radius_scale"})
        to_world = node.find("transform")
        if to_world is None:
            to_world = ElementTree.SubElement(node, "transform", name="to_world")
        to_world.insert(0, ElementTree.Element("rotate", x="1", angle="-90"))
        if "sun_direction" not in given:
            when = {name: number_of(node, given[name]) for name in TIME_AND_PLACE & set(given) if given[name]}
            to_world.insert(0, ElementTree.Element("rotate", z="1", angle=repr(_turn_of_the_sun(when))))


def _turn_of_the_sun(when):
    """The angle, in degrees about +Z, from where Mitsuba 3 puts the sun at a time to where Mitsuba 0.6 does, both with
    +Z up. North and east are -X and -Y there; they were +Y and +X."""
    integers = {name: int(value) for name, value in when.items() if name in ("year", "month", "day")}
    sky = mi.load_dict({"type": "sunsky", **when, **integers})
    south, west, _ = np.array(mi.traverse(sky)["sun_direction"], float).ravel()
    return float(np.degrees(np.arctan2(-south, -west) - np.arctan2(west, south)))


def _set_sensors(root, size, pixels, rfilter, sampler):
    sensors = list(root.iter("sensor"))
    if not sensors:
        raise ValueError("expected a sensor")
    for sensor in sensors:
        film = sensor.find("film")
        if film is None:
            film = ElementTree.SubElement(sensor, "film", type="hdrfilm")
        if size or pixels:
            _set_size(film, size or _scaled_size(film, pixels, defaults_of(root)))
        if rfilter:
            for child in film.findall("rfilter"):
                film.remove(child)
            ElementTree.SubElement(film, "rfilter", type=rfilter)
        for child in sensor.findall("sampler") if sampler else []:
            child.set("type", sampler)


def _scaled_size(film, pixels, defaults):
    """About so many pixels with a film's proportions."""
    size = {"width": 768, "height": 576}  # Mitsuba's own
    for child in film.findall("integer"):
        value = value_of(child.get("value", ""), defaults)
        if child.get("name") in size and value:
            size[child.get("name")] = int(value)
    scale = (pixels / (size["width"] * size["height"])) ** 0.5
    return [max(1, round(axis * scale)) for axis in size.values()]


def _set_size(film, size):
    for child in list(film):
        if child.get("name", "") in ("width", "height") or child.get("name", "").startswith("crop"):
            film.remove(child)
    for name, pixels in zip(("width", "height"), size, strict=True):
        ElementTree.SubElement(film, "integer", name=name, value=str(pixels))
