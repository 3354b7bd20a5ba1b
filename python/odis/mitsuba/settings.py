"""Settings of `odis` in Mitsuba: those of `odis render --set` that there are here, with the same names and values
(docs/settings.md), and the presets that are made of them."""

import difflib
import math
from dataclasses import dataclass, field

import odis

# Time of a ray of a guided path over that of a ray of another, in the kernels.
GUIDED_COST = 1.4
# With a smaller max_depth nothing is cached: how much light comes from how many bounces differs too much from place to
# place.
LEAST_CACHED_MAX_DEPTH = 8
# How far off cached radiance may be in an image of one sample per pixel, over the pixel's value.
CACHED_ERROR_OF_ONE_SAMPLE = 0.6

_PAPER = ("pixel-maps=network pixel-network=paper map-cosine=off bsdf-fraction=0.5 cells=0 guide-bounces=1 "
          "roulette=throughput lights=hierarchy shadow-rays=all samples=even refine=0 pilot-spp=1 pilot-weight=1 "
          "guided-cost=0")
# `paper` and `paper-fast` are the method of Bako et al. 2019, with a map for each pixel or for tiles of 4 x 4.
PRESETS = {"default": "", "paper": _PAPER, "paper-fast": f"{_PAPER} pixel-network=fast pixel-tile=4"}


class Number:
    """A number from `least` to `most`."""

    def __init__(self, kind, least, most):
        self.kind, self.least, self.most = kind, least, most
        self.values = f"a {'whole number' if kind is int else 'number'} from {least} to {most}"

    def read(self, text):
        value = self.kind(text)
        if not self.least <= value <= self.most:
            raise ValueError
        return value


class Choice:
    """One word of several, each with what it stands for."""

    def __init__(self, **words):
        self.words = {word.replace("_", "-"): value for word, value in words.items()}
        self.values = f"one of {', '.join(self.words)}"

    def read(self, text):
        if text not in self.words:
            raise ValueError
        return self.words[text]


class Levels:
    """A number for each level of cells."""

    values = "four numbers from 0 to 1e9 with colons between them, as in 250:250:120:30"

    def read(self, text):
        levels = [Number(float, 0, 1e9).read(part) for part in text.split(":")]
        if len(levels) != 4:
            raise ValueError
        return levels


# Where a setting belongs: the kernels' path.Settings, odis.FrameOptions, odis.GuideOptions, or what networks there are.
_SETTINGS = {
    "samples": ("frame", "adaptive", Choice(auto=True, even=False, adaptive=True)),
    "guide-bounces": ("path", "guide_bounces", Number(int, -1, 1 << 20)),
    "guide": ("model", "directions", Choice(network=True, histogram=False)),
    "lights": ("model", "lights", Choice(network="network", formula="formula", hierarchy="hierarchy")),
    "roulette": ("path", "learned_roulette", Choice(formula=True, throughput=False)),
    "ended-paths": ("guide", "control_variate", Choice(mean=True, nothing=False)),
    "cached-error": ("guide", "cached_error", Number(float, 0, 1e6)),
    "shadow-rays": ("path", "shadow_roulette", Choice(roulette=True, all=False)),
    "pilot-spp": ("frame", "pilot_samples_per_pixel", Number(float, 0, 1e6)),
    "refine": ("frame", "refinement_samples", Number(int, 0, 1 << 20)),
    "pilot-weight": ("frame", "pilot_weight", Number(float, 0, 1e6)),
    "guided-cost": ("frame", "guided_cost", Number(float, 0, 1e6)),
    "built-cell-cost": ("frame", "built_cell_cost", Number(float, 0, 1e6)),
    "recorded-ray-cost": ("frame", "recorded_ray_cost", Number(float, 0, 1e6)),
    "bsdf-fraction": ("guide", "fixed_bsdf_fraction", Number(float, 0, 1)),
    "cells": ("guide", "cells_per_diagonal", Number(int, 0, 1 << 16)),
    "prior-samples": ("guide", "prior_samples", Levels()),
    "map-floor": ("guide", "floor", Number(float, 0, 1)),
    "pixel-maps": ("guide", "pixel_maps", Choice(none=odis.PixelMaps.NONE, histogram=odis.PixelMaps.HISTOGRAM,
                                                 network=odis.PixelMaps.NETWORK)),
    "pixel-network": ("model", "pixels", Choice(model=None, paper="paper", paper_gan="paper-gan", fast="fast",
                                                fast_gan="fast-gan")),
    "pixel-tile": ("guide", "pixel_tile", Number(int, 1, 16)),
    "pixel-share": ("guide", "pixel_share", Number(float, 0, 1)),
    "pixel-light": ("guide", "pixel_direct_light", Choice(all=True, without_direct=False)),
    "map-cosine": ("guide", "cosine_product", Choice(on=True, off=False)),
}


@dataclass
class GivenSettings:
    """What was set, by the options that it changes; what is not set is as the library has it."""

    path: dict = field(default_factory=dict)
    frame: dict = field(default_factory=dict)
    guide: dict = field(default_factory=dict)
    model: dict = field(default_factory=dict)

    @classmethod
    def read(cls, preset, text):
        """Those of a preset, and of a text of words key=value, of which later ones win. Raises ValueError."""
        if preset not in PRESETS:
            raise ValueError(f"odis: preset: expected one of {', '.join(PRESETS)}, found {preset}")
        settings = cls()
        for word in f"{PRESETS[preset]} {text}".split():
            settings._set(word)
        return settings

    def _set(self, word):
        key, equals, value = word.partition("=")
        if not (key and equals):
            raise ValueError(f"odis: settings: expected words key=value with blanks between them, found {word}")
        if key not in _SETTINGS:
            near = difflib.get_close_matches(key, _SETTINGS, 1)
            raise ValueError(f"odis: settings: there is no {key} in Mitsuba"
                             + (f"; did you mean {near[0]}?" if near else ""))
        options, name, kind = _SETTINGS[key]
        try:
            getattr(self, options)[name] = kind.read(value)
        except ValueError:
            raise ValueError(f"odis: settings: {key}: expected {kind.values}, found {value}") from None

    def frame_options(self, size, spp, seed, lights, cached, max_depth):
        """odis.FrameOptions of an image of this width and height. lights: LightTable; cached: whether paths may end with
        cached radiance; max_depth: Mitsuba's."""
        guide = dict(self.guide)
        learned_lights = self.model.get("lights", "network")
        if learned_lights != "hierarchy":
            guide |= {"light_groups": lights.groups, "light_parts": lights.parts}
        error = guide.pop("cached_error", 0) or CACHED_ERROR_OF_ONE_SAMPLE / math.sqrt(spp)
        model = odis.Model()
        if not self.model.get("directions", True):
            model = model.with_direction_formula()
        if learned_lights != "network":
            model = model.with_light_formula()
        if guide.get("pixel_maps") == odis.PixelMaps.NETWORK and self.model.get("pixels"):
            model = model.with_pixel_network(self.model["pixels"])
        return odis.FrameOptions(
            *size, samples_per_pixel=spp, seed=seed, **{"guided_cost": GUIDED_COST, **self.frame},
            guide=odis.GuideOptions(model=model, cached_error=error if cached else 0, max_depth=max(max_depth, 0), **guide))
