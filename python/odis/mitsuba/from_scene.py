"""The integrator `odis` in place of a scene's own."""

import builtins
import re

import mitsuba as mi

from . import checks
from .aovs import make_aovs, nested_integrators
from .media import media_of
from .parameters import NAMES, TEXTS

PATH_TRACERS = {"PathIntegrator", "OdisIntegrator", "PRBIntegrator", "BasicPRBIntegrator", "PathProjectiveIntegrator"}
VOLUMETRIC = {"VolumetricSimplePathIntegrator", "VolumetricMisPathIntegrator", "PRBVolpathIntegrator"}


def _name(integrator):
    return str(integrator).split("[")[0]


def path_tracer_of(scene):
    """The integrator that traces a scene's paths, which `aov` may hold, and the `aov` around it or None."""
    integrator = scene.integrator()
    if integrator is None or _name(integrator) != "AOVIntegrator":
        return integrator, None
    nested = nested_integrators(integrator)
    known = [one for one in nested if _name(one) in PATH_TRACERS | VOLUMETRIC]
    return next(iter(known + nested), None), integrator


def settings_of(integrator):
    """max_depth, rr_depth and hide_emitters of an integrator that traces paths; none of others."""
    if integrator is None or _name(integrator) not in PATH_TRACERS | VOLUMETRIC:
        return {}
    settings = {name: int(value) for name, value in re.findall(r"\b(max_depth|rr_depth) = (\d+)", str(integrator))}
    if settings.get("max_depth") == 0xFFFFFFFF:
        settings["max_depth"] = -1
    return {**settings, "hide_emitters": bool(integrator.hide_emitters)}


def is_volumetric(scene):
    """Whether a scene's image is one of `volpath`, not of `path`: it has media, or names an integrator for such."""
    integrator, _ = path_tracer_of(scene)
    named = integrator is not None and (_name(integrator) in VOLUMETRIC or getattr(integrator, "volumetric", False))
    return named or bool(media_of(scene))


def settings_of_scene(scene):
    """The settings that a path tracer takes over from a scene's integrator. Mitsuba's log warns where it is of another
    kind."""
    integrator, _ = path_tracer_of(scene)
    if integrator is not None and _name(integrator) not in PATH_TRACERS | VOLUMETRIC:
        tracer = "volpath" if is_volumetric(scene) else "path"
        mi.Log(mi.LogLevel.Warn, f"odis: {_name(integrator)} is no path tracer: the image will be that of `{tracer}` "
                                 "with its default parameters")
    return settings_of(integrator)


def _make(parameters):
    """The integrator with these parameters. Raises TypeError, ValueError, or RuntimeError for the variant."""
    for name, value in parameters.items():
        if name not in NAMES:
            raise TypeError(f"odis: guide: there is no parameter {name}; expected one of {', '.join(NAMES)}")
        if name in TEXTS:
            checks.of_type(name, value, str, "a string")
    try:
        return mi.load_dict({"type": "odis", **parameters})
    except RuntimeError as error:
        # Mitsuba reports what the integrator raised as the text of a traceback.
        raised = re.search(r"^(TypeError|ValueError|RuntimeError): (odis: .*)\Z", str(error).strip(), re.MULTILINE)
        if raised is None:
            raise
        raise getattr(builtins, raised[1])(raised[2]) from None


def guide(scene, **parameters):
    """An integrator `odis` in place of a scene's own, with its max_depth, rr_depth, hide_emitters and AOVs:

        image = mi.render(scene, integrator=odis.mitsuba.guide(scene), spp=16)

    The scene stays as it is. Further arguments are parameters of `odis` that take the place of the scene's.
    An integrator that traces no paths is replaced by `odis` with default parameters; Mitsuba's log warns of that.
    """
    checks.scene("guide", scene)
    integrator = _make({**settings_of_scene(scene), "volumetric": is_volumetric(scene), **parameters})
    if integrator.aovs is None:
        path_tracer, around = path_tracer_of(scene)
        if around is not None:
            integrator.aovs = make_aovs(around)
        elif _name(path_tracer) == "OdisIntegrator":
            integrator.aovs = path_tracer.aovs
    return integrator
