"""The parameters of the integrator `odis`."""

from dataclasses import dataclass

import mitsuba as mi

from . import path
from .aovs import check_aovs
from .checks import of_type, whole_number
from .film import FILMS
from .settings import GivenSettings

TEXTS = ("aovs", "film", "preset", "settings")
NAMES = ("max_depth", "rr_depth", "hide_emitters", "volumetric", "cached", *TEXTS)


@dataclass
class Parameters:
    given: GivenSettings
    path: path.Settings
    cached: bool
    film: str  # one of FILMS
    aovs: str


def read_parameters(props):
    """Those of a mi.Properties. Raises TypeError or ValueError."""
    given = GivenSettings.read(*(of_type(name, props.get(name, default), str, "a string")
                                 for name, default in (("preset", "default"), ("settings", ""))))
    flag = lambda name: of_type(name, props.get(name, False), bool, "true or false")
    settings = path.Settings(
        whole_number("max_depth", props.get("max_depth", -1), -1, expected="-1 (no limit) or a whole number from 0"),
        whole_number("rr_depth", props.get("rr_depth", 5), 1), flag("hide_emitters"), volumetric=flag("volumetric"),
        **given.of_paths())
    cached = flag("cached")
    if cached and mi.is_spectral:
        raise ValueError(f"odis: cached: expected a variant in rgb, found {mi.variant()}")
    aovs = of_type("aovs", props.get("aovs", ""), str, "a string")
    if aovs:
        check_aovs(aovs)
    film = of_type("film", props.get("film", FILMS[0]), str, "a string")
    if film not in FILMS:
        raise ValueError(f"odis: film: expected one of {', '.join(FILMS)}, found {film}")
    return Parameters(given, settings, cached, film, aovs)
