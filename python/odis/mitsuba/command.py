"""The command `odis-mitsuba`: renders a scene file of Mitsuba. docs/mitsuba.md."""

import argparse
import json
import os
import re
import shlex
import sys
import time
from collections import defaultdict

import drjit as dr
import mitsuba as mi

import odis

from . import from_scene, scene_files
from .aovs import check_aovs
from .film import FILMS, film_of
from .integrator import check_variant
from .kernel_history import compile_seconds
from .outputs import check_outputs, is_special, write_whole
from .progress import ProgressLine
from .settings import PRESETS

NAME = "odis-mitsuba"
DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
MOST_PIXELS = 2**31 - 1
FORMATS = {".exr": mi.Bitmap.FileFormat.OpenEXR, ".png": mi.Bitmap.FileFormat.PNG, ".jpg": mi.Bitmap.FileFormat.JPEG,
           ".jpeg": mi.Bitmap.FileFormat.JPEG, ".bmp": mi.Bitmap.FileFormat.BMP, ".tga": mi.Bitmap.FileFormat.TGA,
           ".ppm": mi.Bitmap.FileFormat.PPM, ".pfm": mi.Bitmap.FileFormat.PFM, ".hdr": mi.Bitmap.FileFormat.RGBE}
OF_FLOATS = {".pfm", ".hdr"}
STAGES = ("load", "prepare", "compile", "pilot", "tables", "add", "build", "guided", "render", "aovs", "write", "other")


class Problem(Exception):
    """Ends the command with a sentence and an exit code."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


def number_from(least, most=2**31 - 1):
    def parse(text):
        try:
            value = int(text)
        except ValueError:
            value = None
        if value is None or not least <= value <= most:
            raise argparse.ArgumentTypeError(f"expected a whole number from {least} to {most}, found {text}")
        return value
    return parse


def resolution(text):
    match = re.fullmatch(r"(\d+)x(\d+)", text)
    size = tuple(int(group) for group in match.groups()) if match else (0, 0)
    if not 1 <= size[0] * size[1] <= MOST_PIXELS:
        raise argparse.ArgumentTypeError(f"expected at most {MOST_PIXELS} pixels and WIDTHxHEIGHT, such as 640x360, "
                                         f"found {text}")
    return size


def file_name(text):
    if not text:
        raise argparse.ArgumentTypeError("expected the name of a file, found nothing")
    return text


def aovs(text):
    try:
        check_aovs(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error).removeprefix("odis: aovs: ")) from None
    return text


def make_parser():
    parser = argparse.ArgumentParser(prog=NAME, description="Renders scenes of Mitsuba with guided paths.")
    parser.add_argument("--version", action="version", version=f"{NAME} {odis.__version__}, Mitsuba {mi.__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    render = commands.add_parser(
        "render", help="renders a scene file", description="Renders a scene file (XML) of Mitsuba. Depth, roulette and "
        "hidden emitters are as the scene's own integrator has them, if that traces paths.",
        epilog="Exit codes: 0 done, 1 rendering failed, 2 wrong usage or input, 130 interrupted.")
    render.add_argument("scene", type=file_name, metavar="SCENE.xml")
    render.add_argument("-o", "--output", type=file_name, metavar="IMAGE", help="image file; its ending says the format: "
                        f"{', '.join(sorted(FORMATS))} (the scene's name with .exr, in the current folder)")
    render.add_argument("--spp", type=number_from(1), metavar="N", help="samples per pixel (the scene's)")
    render.add_argument("--seed", type=number_from(0, 2**32 - 1), default=0, metavar="N",
                        help="seed of the random numbers (0)")
    render.add_argument("--resolution", type=resolution, metavar="WxH",
                        help="size of the image, in place of the film's size and crop window (the scene's)")
    render.add_argument("--variant", default="llvm_ad_rgb",
                        help="variant of Mitsuba: llvm_ad_rgb, llvm_ad_spectral, cuda_ad_rgb or cuda_ad_spectral "
                        "(llvm_ad_rgb)")
    render.add_argument("--integrator", choices=("odis", "path"), default="odis",
                        help="odis is guided, path is Mitsuba's path tracer (odis)")
    render.add_argument("--cached", action="store_true", help="ends paths with the mean radiance of where they "
                        "arrive: less noise, less time, but biased: docs/cached.md")
    render.add_argument("--film", choices=FILMS, default=FILMS[0],
                        help="splat adds each sample to all pixels that the film's filter reaches, as path does; "
                        "pixels to one, for which the filter draws it: noisier, and what a denoiser wants (splat)")
    render.add_argument("--preset", choices=PRESETS, default="default",
                        help="paper, paper-fast: the method of Bako et al. 2019, docs/paper.md (default)")
    render.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", dest="settings",
                        help="changes a part of odis, as often as you like: docs/settings.md")
    render.add_argument("--max-depth", type=number_from(-1), metavar="N",
                        help="longest path: 1 is light that the camera sees, -1 is no limit (the scene's, or -1)")
    render.add_argument("--rr-depth", type=number_from(1), metavar="N",
                        help="depth from which Russian roulette may end paths (the scene's, or 5)")
    render.add_argument("--hide-emitters", action=argparse.BooleanOptionalAction,
                        help="the camera does not see emitters (the scene's, or it does)")
    render.add_argument("--aovs", type=aovs, metavar="LIST",
                        help="further channels, as of Mitsuba's integrator aov, such as dd:depth,nn:sh_normal (the "
                        "scene's with odis, none with path)")
    render.add_argument("--stats-json", type=file_name, metavar="FILE", help="writes times, rays and settings there")
    render.add_argument("--quiet", action="store_true", help="says nothing but errors")
    return parser


def format_of(path):
    ending = os.path.splitext(path)[1].lower()
    if ending in FORMATS:
        return ending
    if is_special(path):
        return ".exr"
    raise Problem(BAD_INPUT, f"{path}: expected a name that ends with one of {', '.join(sorted(FORMATS))}")


def encoded(bitmap, ending, metadata):
    """The bytes of an image file. Files other than OpenEXR hold the colours alone, 8 bits as sRGB or floats."""
    if ending != ".exr":
        bitmap = dict(bitmap.split()).get("<root>", bitmap)
        floats = ending in OF_FLOATS
        bitmap = bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32 if floats else mi.Struct.Type.UInt8,
                                not floats)
    for name, value in metadata.items():
        bitmap.metadata()[name] = str(value)
    stream = mi.MemoryStream()
    bitmap.write(stream, FORMATS[ending])
    return bytes(stream.raw_buffer())


def set_variant(variant):
    if variant not in mi.variants():
        raise Problem(BAD_INPUT, f"--variant: expected one that compiles kernels, such as llvm_ad_rgb, found {variant}")
    try:
        mi.set_variant(variant)
        check_variant()
        dr.eval(mi.Float(1) + dr.opaque(mi.Float, 1))
    except (ImportError, AttributeError) as error:
        if variant.startswith("llvm"):
            raise Problem(BAD_INPUT, f"--variant {variant}: needs the library libLLVM: install it (Debian: libllvm19), "
                                     f"or say by DRJIT_LIBLLVM_PATH where it lies: {error}") from None
        raise Problem(BAD_INPUT, f"--variant {variant}: needs an NVIDIA GPU and its driver; llvm_ad_rgb runs on CPUs: "
                                 f"{error}") from None
    except RuntimeError as error:
        raise Problem(BAD_INPUT, f"--variant: {str(error).removeprefix('odis: ')}") from None


def cause_of(error):
    """What an error comes from in the end: Dr.Jit reports all, Ctrl-C as well, as errors of its own."""
    while error.__cause__ or error.__context__:
        error = error.__cause__ or error.__context__
    return error


def sentence_of(error):
    """What an error says in one line. Mitsuba tells of places in its own sources, and of each file that includes the
    one with the mistake."""
    text = getattr(error, "strerror", None) or str(error)
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    if any(line.endswith("while processing <include>:") for line in lines[:-1]):
        lines = lines[-1:]
    return re.sub(r"\[[\w.]*(parser|properties)\.(cpp|h):\d+\] |^odis: |^\w*Error: ", "", " ".join(lines))


class Rendering:
    """A rendering by the command, stage by stage; `seconds` has their times."""

    def __init__(self, args):
        self.args = args
        self.output = args.output or os.path.splitext(os.path.basename(args.scene))[0] + ".exr"
        self.seconds = defaultdict(float)
        self.line = (lambda fraction: None) if args.quiet else ProgressLine(title=NAME)

    def say(self, text):
        if not self.args.quiet:
            print(f"{NAME}: {text}", file=sys.stderr)

    def check(self):
        if not os.path.exists(self.args.scene):
            raise Problem(BAD_INPUT, f"{self.args.scene}: there is no such file")
        args = self.args
        for option, given in (("--preset", args.preset != "default"), ("--set", args.settings),
                              ("--cached", args.cached), ("--film pixels", args.film == "pixels")):
            if given and args.integrator != "odis":
                raise Problem(BAD_INPUT, f"{option}: expected --integrator odis, path has no such thing")
        format_of(self.output)
        try:
            check_outputs(args.scene, filter(None, (self.output, args.stats_json)))
        except ValueError as error:
            raise Problem(BAD_INPUT, str(error)) from None
        set_variant(self.args.variant)
        mi.set_log_level(mi.LogLevel.Error if self.args.quiet else mi.LogLevel.Warn)

    def load(self):
        path, begin = self.args.scene, time.perf_counter()
        try:
            scene = scene_files.load_file(path, self.args.resolution, warn=lambda text: self.say(f"{path}: {text}"))
            self.check_scene(scene)
        except (OSError, ValueError, RuntimeError) as error:
            raise Problem(BAD_INPUT, f"{path}: {sentence_of(error)}") from None
        compiling = compile_seconds()
        self.seconds["compile"] += compiling
        self.seconds["load"] += time.perf_counter() - begin - compiling
        return scene

    def check_scene(self, scene):
        if not scene.sensors():
            raise ValueError("expected a sensor")
        sensor = scene.sensors()[0]
        width, height = sensor.film().crop_size()
        if not 1 <= width * height <= MOST_PIXELS:
            raise ValueError(f"expected an image of 1 to {MOST_PIXELS} pixels, found {width}x{height}")
        if not self.args.spp and sensor.sampler().sample_count() < 1:
            raise ValueError("expected a sampler of at least one sample, found none; --spp says how many to take")

    def make_integrator(self, scene):
        """The integrator that was asked for, with the scene's settings where the command line has no others."""
        kind, args = self.args.integrator, self.args
        given = {"max_depth": args.max_depth, "rr_depth": args.rr_depth, "hide_emitters": args.hide_emitters}
        given = {name: value for name, value in given.items() if value is not None}
        try:
            if kind == "odis":
                return from_scene.guide(scene, preset=args.preset, settings=" ".join(args.settings), cached=args.cached,
                                        film=args.film, **given, **({"aovs": args.aovs} if args.aovs else {}))
            kind = "volpath" if from_scene.is_volumetric(scene) else "path"
            path = {"type": kind, **from_scene.settings_of_scene(scene), **given}
            return mi.load_dict({"type": "aov", "aovs": args.aovs, "image": path} if args.aovs else path)
        except (RuntimeError, TypeError, ValueError) as error:
            raise Problem(BAD_INPUT, sentence_of(error)) from None

    def render(self, scene):
        """The film's image, a mi.Bitmap."""
        integrator, sensor = self.make_integrator(scene), scene.sensors()[0]
        odis_renders = self.args.integrator == "odis"
        spp = self.args.spp or sensor.sampler().sample_count()
        if odis_renders:
            integrator.progress, integrator.separate_compile = self.line, True
        else:
            self.line(0)
        begin = time.perf_counter()
        integrator.render(scene, sensor, self.args.seed, spp, develop=False)
        dr.sync_thread()
        if integrator.should_stop():  # Mitsuba's own integrators end early then, and return what they have.
            raise KeyboardInterrupt
        bitmap = sensor.film().bitmap()
        if not odis_renders:
            self.line(1)
        seconds = defaultdict(float, integrator.seconds if odis_renders else {})
        seconds["compile"] += compile_seconds()
        rest = time.perf_counter() - begin - sum(seconds.values())
        seconds["other" if odis_renders else "render"] += rest
        for stage, value in seconds.items():
            self.seconds[stage] += value
        self.result = {
            "width": bitmap.width(), "height": bitmap.height(), "samples": bitmap.width() * bitmap.height() * spp,
            "spp": spp, "seed": self.args.seed, "integrator": self.args.integrator, "preset": self.args.preset,
            "settings": self.args.settings, "cached": self.args.cached,
            "film": film_of(self.args.film, sensor.film().rfilter()), "variant": self.args.variant,
            "rays": integrator.rays if odis_renders else None}
        return bitmap

    def run(self):
        self.check()
        with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
            scene = self.load()
            try:
                bitmap = self.render(scene)
            except Problem:
                raise
            except Exception as error:
                cause = cause_of(error)
                if isinstance(cause, KeyboardInterrupt):
                    raise KeyboardInterrupt from None
                text = sentence_of(cause) or repr(cause)
                raise Problem(FAILED, f"{self.args.scene}: rendering failed: {text}") from error
            begin = time.perf_counter()
            versions = {"odis": odis.__version__, "mitsuba": mi.__version__, "drjit": dr.__version__}
            metadata = {"generatedBy": ", ".join(f"{name} {version}" for name, version in versions.items()),
                        "commandLine": shlex.join([NAME, *self.args.words]), "seed": self.args.seed,
                        "samplesPerPixel": self.result["spp"], "integrator": self.args.integrator,
                        "variant": self.args.variant, "odis:film": self.result["film"],
                        "cached": "yes: the image is biased" if self.args.cached else "no"}
            self.write(self.output, encoded(bitmap, format_of(self.output), metadata))
            self.seconds["compile"] += (compiling := compile_seconds())
            self.seconds["write"] += time.perf_counter() - begin - compiling
        if self.args.stats_json:
            stats = {**self.result, "versions": versions, "scene": self.args.scene, "image": self.output,
                     "seconds": {stage: round(self.seconds[stage], 4) for stage in STAGES}}
            self.write(self.args.stats_json, (json.dumps(stats, indent=2) + "\n").encode())
        self.say(f"{self.output}: {sum(self.seconds.values()):.1f} s, of them {self.seconds['compile']:.1f} s to "
                 "compile kernels")

    def write(self, path, data):
        try:
            write_whole(path, data)
        except OSError as error:
            raise Problem(FAILED, f"{path}: can't be written: {error.strerror}") from None


def main(words=None):
    words = sys.argv[1:] if words is None else words
    args = make_parser().parse_args(words)
    args.words = words
    try:
        Rendering(args).run()
    except Problem as problem:
        print(f"{NAME}: {problem}", file=sys.stderr)
        return problem.code
    except KeyboardInterrupt:
        print(f"\n{NAME}: interrupted", file=sys.stderr)
        return INTERRUPTED
    return DONE
