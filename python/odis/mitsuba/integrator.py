"""The integrator `odis`."""

import time
from collections import defaultdict
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache

import drjit as dr
import mitsuba as mi
import numpy as np

import odis

from . import checks, path, recording, volume_path
from .aovs import make_aovs, nested_integrators
from .arrays import array_of
from .film import make_film
from .guide_tables import make_guide_tables
from .kernel_history import compile_seconds
from .lights import make_light_table
from .materials import make_material_table
from .media import make_media_table, media_of
from .parameters import read_parameters
from .progress import default_progress
from .random_numbers import hash_seed, numbers_of

# Vertices are recorded by so many paths at once at most, into so many rows; paths that need more come in smaller parts.
RECORDED_PATHS = 1 << 17
ROWS = 1 << 20
# Of the samples of a guided pass that the guide learns from only those of one pixel in so many are recorded. Cached
# radiance is worth all of them: their paths are short.
PIXELS_PER_RECORDED, PIXELS_PER_RECORDED_IF_CACHED = 4, 1
# Other paths are traced by so many at once at most.
PATHS = 1 << 22
# A lane traces this many samples one after the other, and there are at least so many lanes a thread: SIMD packets stay
# full, whatever the lengths of their paths. Where a sample has fewer rays than that on average, a lane traces one: most
# paths are about as long then, and packets of neighbours are coherent.
SAMPLES_PER_LANE, LEAST_LANES = 32, 4096
MANY_RAYS = 5
# Side of the tiles that odis.Frame takes samples by, in pixels: it is fastest if all of a tile come at once.
TILE = 16
METER = "IrradianceMeter"


class Camera:
    """Rays of the samples of a sensor's film. seed: that of their random numbers; film: PixelFilm or SplatFilm."""

    def __init__(self, sensor, seed, film):
        self.sensor, self.seed, self.film = sensor, seed, film
        medium = sensor.get_medium()
        self.medium = dr.zeros(mi.MediumPtr) if medium is None else mi.MediumPtr(medium)

    def __call__(self, pixel, number):
        sensor = self.sensor
        numbers = numbers_of(self.seed, pixel, number)
        draws = numbers.of_camera()
        position, filter_weight = self.film.place(pixel, draws)
        aperture = mi.Point2f(0.5)
        if sensor.needs_aperture_sample():
            aperture = draws.next_2d()
        moment = mi.Float(sensor.shutter_open())
        if sensor.shutter_open_time() > 0:
            moment += draws.next() * sensor.shutter_open_time()
        wavelength = draws.next() if mi.is_spectral else mi.Float(0.5)
        # The irradiance meter has rays with differentials alone.
        sample_ray = sensor.sample_ray_differential if sensor.class_name() == METER else sensor.sample_ray
        ray, weight = sample_ray(moment, wavelength, position / mi.ScalarVector2f(sensor.film().crop_size()),
                                 aperture)
        ray = mi.Ray3f(ray)
        return numbers, ray, weight * filter_weight


def trace_samples(scene, camera, settings, known, tables, samples):
    """Traces samples; where some are recorded returns the recorder, with what only complete paths know filled in."""
    in_media = known.media is not None
    recorder = recording.make_recorder(ROWS, in_media) if samples.last_row is not None else None
    (volume_path if in_media else path).trace(scene, camera, settings, known, tables, recorder, samples)
    dr.eval(samples.result, samples.last_row, samples.ended_with, recorder)
    if recorder is not None:
        recording.complete_paths(recorder, samples.last_row, samples.ended_with, path.ray_counts(samples))
        dr.eval(recorder)
    dr.sync_thread()
    return recorder


def choose_samples(samples, places, recorded, samples_per_lane):
    """Those of path.Samples that a kernel is to trace, and which of them it records (arrays of numpy)."""
    count = places.size
    chosen = places.astype(np.uint32) | np.where(recorded, np.uint32(path.RECORDED), np.uint32(0))
    lanes = min(count, max(LEAST_LANES * dr.thread_count(), count // samples_per_lane))
    samples = replace(samples, chosen=array_of(mi.UInt32, chosen), count=mi.UInt32(count),
                      lane=dr.arange(mi.UInt32, lanes), lanes=mi.UInt32(lanes),
                      last_row=dr.zeros(mi.UInt32, count) if recorded.any() else None,
                      ended_with=dr.zeros(mi.Float, 3 * count) if recorded.any() else None)
    dr.make_opaque(samples)
    return samples


@lru_cache(maxsize=4)
def tile_order(width, height):
    """The pixels of an image in the order of the frame's tiles: their numbers, and where each tile begins and ends."""
    y, x = np.divmod(np.arange(width * height, dtype=np.uint32), np.uint32(width))
    tile = y // TILE * ((width + TILE - 1) // TILE) + x // TILE
    order = np.argsort(tile, kind="stable").astype(np.uint32)
    return order, np.append(np.searchsorted(tile[order], np.arange(tile.max() + 1)), order.size)


@dataclass
class PartOfPass:
    """Samples of a pass, of whole tiles, in the order of the tiles: arrays of one length."""

    pixel: object  # uint32
    number: object  # uint32: of the sample in its pixel
    recorded: object  # bool: whether its vertices are


def parts_of_pass(frame_pass, first, count, pixels_per_recorded):
    """The samples of a pass, in parts that fit. first, count: odis.Frame.samples()."""
    height, width = first.shape
    order, tile_begin = tile_order(width, height)
    first, count = first.ravel()[order], count.ravel()[order]
    recorded = np.full(order.size, frame_pass.wants_vertices)
    if frame_pass.kind == odis.PassKind.GUIDED:
        y, x = np.divmod(order, np.uint32(width))
        recorded &= (x + 2 * y) % pixels_per_recorded == 0
    samples_before, recorded_before = (np.concatenate([[0], np.cumsum(counts)])[tile_begin]
                                       for counts in (count, count * recorded))
    begin, tiles = 0, tile_begin.size - 1
    while begin < tiles:
        fits = (samples_before <= samples_before[begin] + PATHS) \
            & (recorded_before <= recorded_before[begin] + RECORDED_PATHS)
        end = max(begin + 1, int(np.flatnonzero(fits)[-1]))
        pixels = slice(tile_begin[begin], tile_begin[end])
        counts = count[pixels]
        before = np.cumsum(counts, dtype=np.uint32) - counts
        repeat = lambda values: np.repeat(values, counts)
        number = np.arange(samples_before[end] - samples_before[begin], dtype=np.uint32)
        number += repeat(first[pixels] - before)
        if number.size:
            yield PartOfPass(repeat(order[pixels]), number, repeat(recorded[pixels]))
        begin = end


def check_variant():
    variant = mi.variant()
    if not variant.startswith(("llvm_ad_", "cuda_ad_")):
        raise RuntimeError(f"odis: expected a variant that compiles kernels, such as llvm_ad_rgb, found {variant}")
    if mi.is_polarized or mi.is_monochromatic:
        raise RuntimeError(f"odis: expected a variant in rgb or spectral without polarisation, found {variant}")


def refuse_gradients():
    raise RuntimeError("odis: has no gradients: images of odis can't be differentiated. Mitsuba's integrators prb and "
                       "path have gradients")


def make_integrator():
    """The class of the integrator for the variant that is set."""

    class OdisIntegrator(mi.SamplingIntegrator):
        """Parameters: max_depth (-1), rr_depth (5) and hide_emitters (false), as of `path`; aovs (""), as of `aov`;
        volumetric (false): as of `volpath`, which scenes with media always are;
        cached (false): paths may end with cached radiance, which biases the image (docs/cached.md);
        film ("splat"): each sample is added to all pixels that the film's filter reaches, as those of `path` are, or,
        with "pixels", drawn by the filter for one, as a denoiser wants it;
        preset ("default", or "paper" and "paper-fast", docs/paper.md); settings (""): words key=value with blanks
        between them (docs/settings.md), such as "cells=64 refine=0", which win over those of the preset.

        After a rendering `seconds` holds the time of its stages, `rays` the number of rays, `frame` the odis.Frame.
        `progress`, if set, is called with the fraction of the samples that are traced. If `separate_compile` is set and
        so is Dr.Jit's flag KernelHistory, seconds["compile"] is what code generation and compilation took, which the
        other stages leave out then; that clears the history.
        """

        # Dr.Jit traverses __dict__, also of an integrator that a scene holds, and would compile kernels anew whenever
        # something in there changes: all is kept out of it.
        __slots__ = ("settings", "scene", "known", "film", "frame", "rays", "seconds",
                     "progress", "separate_compile", "aovs", "given", "cached", "unguided", "said_unguided",
                     "samples_per_lane")

        def __init__(self, props):
            check_variant()
            parameters = read_parameters(props)
            super().__init__(props)
            self.given, self.settings, self.cached = parameters.given, parameters.path, parameters.cached
            self.film = parameters.film
            self.scene, self.known = None, None
            self.progress, self.separate_compile = None, False
            self.aovs = make_aovs(mi.load_dict({"type": "aov", "aovs": parameters.aovs})) if parameters.aovs else None
            self.unguided = {}
            self.said_unguided = False

        def render(self, scene, sensor=0, seed=0, spp=0, develop=True, evaluate=True):
            sensor = checks.sensor_of(checks.scene("render", scene), sensor)
            seed = checks.whole_number("seed", seed, 0, 2**32 - 1)
            film = sensor.film()
            if mi.has_flag(film.flags(), mi.FilmFlags.Special):
                raise RuntimeError(f"odis: expected a film that stores colours, found {film.class_name()}")
            spp = checks.whole_number("spp", spp, 0) or sensor.sampler().sample_count()
            self.seconds = defaultdict(float)
            with dr.suspend_grad():
                if self.scene is not scene or not self.known.has_medium_of(sensor):
                    with self._timed("prepare"):
                        self._meet(scene, sensor)
                image = self._render(sensor, seed, spp)
                if self.aovs is not None:
                    with self._timed("aovs"):
                        # The film divides them by the weights, too.
                        image, aovs = np.array(image), self.aovs.image(scene, sensor, seed, spp)
                        image = np.concatenate([image, aovs * image[..., -1:]], axis=2)
                film.prepare(self.aov_names())
                film.put_block(mi.ImageBlock(mi.TensorXf(image), film.crop_offset()))
                own = scene.integrator()
                if own is self or (own is not None and self in nested_integrators(own)):
                    self.scene = None  # Otherwise they would keep each other forever.
                return film.develop() if develop else mi.TensorXf()

        def render_forward(self, scene, params, sensor=0, seed=0, spp=0):
            refuse_gradients()

        def render_backward(self, scene, params, grad_in, sensor=0, seed=0, spp=0):
            refuse_gradients()

        def sample(self, scene, sampler, ray, medium=None, active=True):
            """Single rays, which other integrators ask for, are traced without guidance."""
            kind = "volpath" if self.settings.volumetric or media_of(scene) else "path"
            if not self.said_unguided:
                self.said_unguided = True
                mi.Log(mi.LogLevel.Warn, f"odis: another integrator asks for single rays, which are traced as `{kind}` "
                                         "does; for AOVs, odis has the parameter `aovs`")
            if kind not in self.unguided:
                self.unguided[kind] = mi.load_dict({"type": kind, "max_depth": self.settings.max_depth,
                                                    "rr_depth": self.settings.rr_depth,
                                                    "hide_emitters": self.settings.hide_emitters})
            radiance, valid, _ = self.unguided[kind].sample(scene, sampler, ray, medium, active)
            values = self.aovs.sample(scene, sampler, ray, medium, active)[2] if self.aovs is not None else []
            return radiance, valid, values

        def aov_names(self):
            return self.aovs.aov_names() if self.aovs is not None else []

        def to_string(self):
            return f"OdisIntegrator[max_depth = {self.settings.max_depth}, rr_depth = {self.settings.rr_depth}]"

        @property
        def volumetric(self):
            return self.settings.volumetric

        def _meet(self, scene, sensor):
            """Finds out what there is to know of a scene once."""
            materials, left_out = make_material_table(scene)
            found, media = media_of(scene, sensor), None
            if found or self.settings.volumetric:
                media, of_phases = make_media_table(found)
                left_out += of_phases
            if left_out:
                mi.Log(mi.LogLevel.Info, "odis: traced without guidance: " + ", ".join(left_out))
            self.scene, self.known = scene, path.SceneTables(materials, make_light_table(scene), media)

        def _render(self, sensor, seed, spp):
            """The image as the film stores it: colours, alpha if it has it, and weights."""
            film = make_film(self.film, sensor.film())
            width, height = film.size
            cached = self.cached and not 0 <= self.settings.max_depth < odis.LEAST_CACHED_MAX_DEPTH
            self.frame = frame = odis.Frame(
                self.given.frame_options((width, height), spp, seed, self.known.lights, cached,
                                         self.settings.max_depth))
            pixels_per_recorded = PIXELS_PER_RECORDED_IF_CACHED if cached else PIXELS_PER_RECORDED
            progress, traced, self.rays = checks.progress(self.progress or default_progress()), 0, 0
            progress(0)
            tables, values, rebuilt = None, None, False
            while (frame_pass := frame.begin_pass()) is not None:
                with self._timed("tables"):
                    if not len(frame_pass.guide):  # not yet, or guiding does not pay
                        tables, values = None, None
                    elif rebuilt:
                        tables = make_guide_tables(frame_pass.guide, self.known.media is not None)
                        values = array_of(mi.Float, frame.pixel_values)
                self.samples_per_lane = SAMPLES_PER_LANE if self.rays >= MANY_RAYS * traced else 1
                rebuilt = frame_pass.wants_vertices
                # An opaque number, so that the same kernel serves all seeds.
                camera = Camera(sensor, dr.opaque(mi.UInt64, hash_seed(frame_pass.seed)), film)
                with self._timed("add"):
                    first, count = frame.samples()
                    film.begin_pass(frame, frame_pass, first, count)
                for part in parts_of_pass(frame_pass, first, count, pixels_per_recorded):
                    self._trace_part(camera, frame_pass, tables, values, part)
                    traced += part.pixel.size
                    progress(min(traced / (spp * width * height), 1))  # adaptive passes may take a few samples more
                with self._timed("build"):
                    frame.end_pass()
                with self._timed("add"):
                    film.end_pass(frame)
            progress(1)
            return film.image(frame)

        def _trace_part(self, camera, frame_pass, tables, values, part):
            """Traces some samples of a pass and hands them to the film and the frame."""
            with self._timed("pilot" if frame_pass.kind == odis.PassKind.PILOT else "guided"):
                samples = path.Samples(array_of(mi.UInt32, part.pixel), array_of(mi.UInt32, part.number), values,
                                       result=dr.zeros(mi.Float, 4 * part.pixel.size))
                vertices = self._trace(camera, tables, samples, part.recorded)
            with self._timed("add"):
                camera.film.add(camera.seed, samples)
                result = np.asarray(samples.result).reshape(-1, 4)
                tags = result[:, 3].view(np.uint32)
                rays = tags & np.uint32(path.VALID - 1)
                self.rays += int(rays.sum())
                self.frame.add_samples(part.pixel, part.number, result[:, :3], rays, vertices)

        def _trace(self, camera, tables, samples, recorded):
            """Traces samples; returns the vertices of those that are recorded, None without any. Should these be too
            many at once, it hands all but the last ones to the frame."""
            vertices = None
            pending = [np.arange(recorded.size)]
            while pending:
                places = pending.pop()
                if not places.size:
                    continue
                chosen = choose_samples(samples, places, recorded[places], self.samples_per_lane)
                recorder = trace_samples(self.scene, camera, self.settings, self.known, tables, chosen)
                if recorder is None:
                    continue
                count = int(recorder.count[0])
                if count > ROWS and places.size > 1:
                    pending += np.array_split(places, 2)
                    continue
                if vertices is not None:
                    none = np.zeros(0, np.uint32)
                    self.frame.add_samples(none, none, np.zeros((0, 3), np.float32), none, vertices)
                vertices = recording.path_vertices(recorder, min(count, ROWS))
            return vertices

        @contextmanager
        def _timed(self, stage):
            begin = time.perf_counter()
            yield
            self.seconds[stage] += time.perf_counter() - begin
            if self.separate_compile:
                compiling = compile_seconds()
                self.seconds[stage] -= compiling
                self.seconds["compile"] += compiling

    return OdisIntegrator
