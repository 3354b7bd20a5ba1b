"""The command odis-mitsuba, odis.mitsuba.guide(), AOVs and the notebook. Skipped where Mitsuba does not run."""

import contextlib
import io
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np
import odis
import test_mitsuba

try:
    import drjit as dr
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    dr.eval(mi.Float(1) + dr.opaque(mi.Float, 1))
    import odis.mitsuba
    from odis.mitsuba import command, scene_files
    from odis.mitsuba.progress import ProgressLine
except (ImportError, AttributeError, RuntimeError) as missing:
    raise unittest.SkipTest(f"Mitsuba does not run here: {missing}")

SCENE = """<scene version="3.0.0">
  <integrator type="{integrator}"><integer name="max_depth" value="4"/><integer name="rr_depth" value="3"/>
    {parameters}</integrator>
  <sensor type="perspective"><transform name="to_world">
      <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sample_count" value="4"/></sampler>
    <film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="8"/>
      <rfilter type="box"/></film></sensor>
  <shape type="sphere"><bsdf type="diffuse"/></shape>
  <emitter type="constant"><rgb name="radiance" value="0.5"/></emitter>
  {more}
</scene>
"""
OLD_SCENE = """<scene version="0.6.0">
  <integrator type="$method"><integer name="maxDepth" value="7"/><integer name="photonCount" value="10"/></integrator>
  <sensor type="perspective"><film type="hdrfilm"><float name="gamma" value="2"/></film></sensor>
  <shape type="sphere"><bsdf type="roughconductor"><float name="extEta" value="1"/></bsdf></shape>
  <shape type="sphere"><bsdf type="roughconductor"><float name="alpha" value=".2"/></bsdf></shape>
  <emitter type="constant"/>
</scene>
"""
EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples" / "mitsuba.ipynb"


def scene_text(integrator="path", parameters="", more=""):
    return SCENE.format(integrator=integrator, parameters=parameters, more=more)


def run(*words):
    """Exit code, what was written to stderr."""
    stderr = io.StringIO()
    with contextlib.redirect_stderr(stderr):
        try:
            code = command.main([str(word) for word in words])
        except SystemExit as stop:
            code = stop.code
    mi.set_log_level(mi.LogLevel.Error)
    return code, stderr.getvalue()


def channels_of(path):
    return [field.name for field in mi.Bitmap(str(path)).struct_()]


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = self.folder / "scene.xml"
        self.scene.write_text(scene_text())

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name


class Command(InFolder):
    def test_image_and_statistics(self):
        for integrator in ("odis", "path"):
            image, stats = self.folder / f"{integrator}.exr", self.folder / f"{integrator}.json"
            code, said = run("render", self.scene, "--spp", 8, "--seed", 3, "--integrator", integrator, "-o", image,
                             "--stats-json", stats)
            self.assertEqual(code, 0, said)
            self.assertIn("100 % of the samples", said)
            bitmap = mi.Bitmap(str(image))
            self.assertEqual((bitmap.width(), bitmap.height()), (12, 8))
            self.assertEqual(bitmap.component_format(), mi.Struct.Type.Float32)
            metadata = dict(bitmap.metadata().items())
            self.assertEqual((metadata["seed"], metadata["samplesPerPixel"]), ("3", "8"))
            self.assertIn(str(self.scene), metadata["commandLine"])
            # In an empty corner there is the sky alone.
            np.testing.assert_allclose(np.array(bitmap)[0, 0], 0.5, rtol=1e-5)
            result = json.loads(stats.read_text())
            self.assertEqual(result["samples"], 12 * 8 * 8)
            seconds = result["seconds"]
            self.assertGreater(seconds["compile"], 0)
            self.assertGreater(seconds["load"], 0)
            self.assertGreater(seconds["guided" if integrator == "odis" else "render"], 0)
            self.assertTrue(all(value >= -0.01 for value in seconds.values()), seconds)
            self.assertEqual(result["rays"] is None, integrator == "path")
        self.assertEqual(len(list(self.folder.iterdir())), 5)

    def test_vertices_of_paths_that_fail_are_no_mistake(self):
        # A rough conductor fails to reflect some directions: roulette has nothing to decide there.
        rough = '<bsdf type="roughconductor"><float name="alpha" value="0.6"/></bsdf>'
        ground = f'<shape type="sphere"><point name="center" value="0, -101, 0"/><float name="radius" value="100"/>{rough}</shape>'
        scene = self.write("rough.xml", scene_text(more=ground).replace('<bsdf type="diffuse"/>', rough))
        code, said = run("render", scene, "--spp", 16, "--resolution", "48x32", "--rr-depth", 1, "-o", self.folder / "a.exr")
        self.assertEqual(code, 0, said)
        self.assertNotIn("nothing is learned from", said)

    def test_same_as_in_python(self):
        self.assertEqual(run("render", self.scene, "--seed", 5, "--quiet", "-o", self.folder / "a.exr"), (0, ""))
        scene = mi.load_file(str(self.scene))
        integrator = odis.mitsuba.guide(scene)
        self.assertEqual((integrator.settings.max_depth, integrator.settings.rr_depth), (4, 3))
        np.testing.assert_array_equal(np.array(mi.Bitmap(str(self.folder / "a.exr"))),
                                      np.array(mi.render(scene, integrator=integrator, seed=5)))

    def test_settings_and_cached_images(self):
        words = ("render", self.scene, "--quiet", "--max-depth", -1, "-o", self.folder / "a.exr")
        stats = self.folder / "stats.json"
        self.assertEqual(run(*words, "--cached", "--set", "refine=0", "--set", "cells=8", "--stats-json", stats), (0, ""))
        result = json.loads(stats.read_text())
        self.assertEqual((result["settings"], result["cached"]), (["refine=0", "cells=8"], True))
        self.assertIn("biased", dict(mi.Bitmap(str(self.folder / "a.exr")).metadata().items())["cached"])
        scene = mi.load_file(str(self.scene))
        integrator = odis.mitsuba.guide(scene, max_depth=-1, cached=True, settings="refine=0 cells=8")
        np.testing.assert_array_equal(np.array(mi.Bitmap(str(self.folder / "a.exr"))),
                                      np.array(mi.render(scene, integrator=integrator)))

    def test_film(self):
        """The file says which; with a box filter both are one."""
        scenes = {"box": self.scene, "tent": self.write("tent.xml", scene_text().replace('"box"', '"tent"'))}
        for rfilter, words, expected in (("tent", (), "splat"), ("tent", ("--film", "splat"), "splat"),
                                         ("tent", ("--film", "pixels"), "pixels"), ("box", (), "pixels"),
                                         ("tent", ("--integrator", "path"), "splat")):
            image, stats = self.folder / "a.exr", self.folder / "stats.json"
            self.assertEqual(run("render", scenes[rfilter], "--quiet", "--spp", 8, *words, "-o", image, "--stats-json",
                                 stats), (0, ""))
            self.assertEqual(dict(mi.Bitmap(str(image)).metadata().items())["odis:film"], expected)
            self.assertEqual(json.loads(stats.read_text())["film"], expected)
            if words[:1] != ("--integrator",):
                scene = mi.load_file(str(scenes[rfilter]))
                integrator = odis.mitsuba.guide(scene, film=expected)
                np.testing.assert_allclose(np.array(mi.Bitmap(str(image))), np.array(
                    mi.render(scene, integrator=integrator, spp=8)), rtol=1e-5)

    def test_resolution_aovs_and_formats(self):
        words = ("render", self.scene, "--resolution", "10x6", "--quiet", "--spp", 4, "--aovs", "dd:depth,n:sh_normal")
        for integrator in ("odis", "path"):
            self.assertEqual(run(*words, "--integrator", integrator, "-o", self.folder / "a.exr"), (0, ""))
            names = channels_of(self.folder / "a.exr")
            depth = np.array(mi.Bitmap(str(self.folder / "a.exr")))[..., names.index("dd.T")]
            self.assertEqual(depth.shape, (6, 10))
            self.assertAlmostEqual(depth[2:4, 4:6].mean(), 2.05, delta=0.06)
        self.assertEqual(run(*words, "-o", self.folder / "a.png")[0], 0)
        self.assertEqual(mi.Bitmap(str(self.folder / "a.png")).channel_count(), 3)

    def test_spectral(self):
        self.addCleanup(mi.set_variant, "llvm_ad_rgb")
        images = []
        for integrator in ("odis", "path"):
            words = ("render", self.scene, "--variant", "llvm_ad_spectral", "--spp", 64, "--quiet")
            self.assertEqual(run(*words, "--integrator", integrator, "-o", self.folder / "a.exr"), (0, ""))
            images.append(np.array(mi.Bitmap(str(self.folder / "a.exr"))).mean((0, 1)))
        np.testing.assert_allclose(images[0], images[1], rtol=0.03)

    def test_wrong_usage(self):
        scene = self.scene
        cases = (((self.folder / "none.xml",), "no such file"), ((scene, "--spp", 0), "from 1 to 2147483647, found 0"),
                 ((scene, "--resolution", "640"), "640x360, found 640"), ((scene, "--rr-depth", 0), "from 1"),
                 ((scene, "-o", self.folder / "no" / "a.exr"), "folder exists"),
                 ((scene, "-o", self.folder), "a folder"),
                 ((scene, "-o", "a.gif"), "ends with one of"), ((scene, "--variant", "scalar_rgb"), "llvm_ad_rgb"),
                 ((scene, "--variant", "metal"), "llvm_ad_rgb"),
                 ((scene, "--set", "cels=3"), "Did you mean cells"), ((scene, "--set", "refine=x"), "found \"x\""),
                 ((scene, "--cached", "--integrator", "path"), "--cached: expected --integrator odis"),
                 ((scene, "--set", "refine=0", "--integrator", "path"), "--set: expected --integrator odis"),
                 ((scene, "--film", "pixel"), "--film: invalid choice: 'pixel' (choose from"),
                 ((scene, "--film", "pixels", "--integrator", "path"), "--film pixels: expected --integrator odis"),
                 ((scene, "--cached", "--variant", "llvm_ad_spectral"), "cached: expected a variant in rgb"),
                 ((scene, "--variant", "llvm_ad_mono"), "rgb or spectral"),
                 ((scene, "-o", self.folder / "a.exr", "--aovs", "a:b"), "found a:b; the types are albedo, depth"),
                 ((scene, "-o", self.folder / "a.exr", "--aovs", "foo"), "aovs: expected NAME:TYPE"),
                 ((scene, "-o", self.folder / "a.exr", "--aovs", "d:depth,:uv", "--integrator", "path"), "found :uv"),
                 ((scene, "-o", self.folder / "a.exr", "--aovs", "a:depth,a:depth"), "found a twice"),
                 ((self.write("aov.xml", scene_text("aov", '<string name="aovs" value="foo"/>')), "-o",
                   self.folder / "a.exr"), "aovs: expected NAME:TYPE"),
                 ((scene, "-o", ""), "expected the name of a file"), ((scene, "--stats-json", scene), "a file of its own"),
                 ((scene, "-o", self.folder / "a.exr", "--stats-json", self.folder / "a.exr"), "a file of its own"),
                 ((scene, "--resolution", "100000x100000"), "at most 2147483647 pixels"),
                 ((self.write("e.xml", scene_text().replace('"12"', '"65536"').replace('"8"', '"65536"')), "-o",
                   self.folder / "a.exr"), "pixels, found 65536x65536"),
                 ((self.write("f.xml", scene_text().replace('"4"/></s', '"0"/></s')), "-o", self.folder / "a.exr"),
                  "a sampler of at least one sample"),
                 ((self.write("g.xml", scene_text(more="<include filename='g.xml'/>")), "-o", self.folder / "a.exr"),
                  "g.xml: Exceeded maximum include"),
                 ((self.write("text.xml", "hello"), "-o", self.folder / "a.exr"), "expected a scene in XML"),
                 ((self.write("b.xml", "<bsdf/>"), "-o", self.folder / "a.exr"), "found the element <bsdf>"),
                 ((self.write("c.xml", "<scene version='3.0.0'/>"), "-o", self.folder / "a.exr"), "expected a sensor"),
                 ((self.write("d.xml", scene_text(more="<shape type='spere'/>")), "-o", self.folder / "a.exr"),
                  "At line 11, col 4"))
        for words, expected in cases:
            with self.subTest(words):
                code, said = run("render", *words)
                mi.set_variant("llvm_ad_rgb")
                self.assertEqual(code, 2, said)
                self.assertIn(expected, said)
                self.assertTrue(said.splitlines()[-1].startswith("odis-mitsuba"), said)
                self.assertNotIn("odis: ", said.splitlines()[-1])
        self.assertFalse((self.folder / "a.exr").exists())

    def test_rendering_that_fails(self):
        with mock.patch.object(command.from_scene, "guide") as guide:
            guide.return_value.render.side_effect = RuntimeError("no memory")
            code, said = run("render", self.scene, "-o", self.folder / "a.exr")
        self.assertEqual(code, 1)
        self.assertIn(f"odis-mitsuba: {self.scene}: rendering failed: no memory", said)
        self.assertEqual(list(self.folder.iterdir()), [self.scene])

    def test_special_files_and_interruption(self):
        """In a process of its own, which another one may interrupt."""
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        words = [sys.executable, "-m", "odis.mitsuba", "render", str(self.scene)]
        # As /dev/stdout does, this leads to what a process has open, here a plain file.
        shown, link = self.folder / "shown", self.folder / "link"
        link.symlink_to("/proc/self/fd/1")
        with shown.open("wb") as file:
            file.write(b"before")
            file.flush()
            subprocess.run([*words, "--integrator", "path", "--quiet", "-o", str(link)], stdout=file, check=True,
                           env=environment)
        self.assertTrue(link.is_symlink())
        self.assertTrue(shown.read_bytes().startswith(b"before\x76\x2f\x31\x01"))  # OpenEXR's first bytes
        self.assertTrue(all(command.is_special(path) for path in ("/dev/stdout", "/dev/fd/1", "/dev/null", link)))
        self.assertFalse(any(command.is_special(path) for path in (self.scene, shown, self.folder / "new")))
        # What a shell runs in the background ignores interrupts, and so would what it starts.
        heed = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)
        long = subprocess.Popen([*words, "--spp", "1000000", "-o", str(self.folder / "b.exr")], env=environment,
                                stderr=subprocess.PIPE, text=True, preexec_fn=heed)
        self.assertIn(" % of the samples", long.stderr.readline())
        long.send_signal(signal.SIGINT)
        self.assertIn("interrupted", long.communicate(timeout=50)[1])
        self.assertEqual(long.returncode, 130)
        self.assertEqual(sorted(file.name for file in self.folder.iterdir()), ["link", "scene.xml", "shown"])


class SceneFiles(InFolder):
    def test_old_file(self):
        warnings = []
        scene = scene_files.load_file(self.write("old.xml", OLD_SCENE), size=(6, 4), warn=warnings.append)
        self.assertEqual(list(scene.sensors()[0].film().size()), [6, 4])
        self.assertIn("max_depth = 7", str(scene.integrator()))
        text = "\n".join(warnings)
        for part in ("$method", "gamma", "extEta"):
            self.assertIn(part, text)
        self.assertEqual(len(warnings), 3)
        # Of the other conductor nothing was dropped.
        self.assertEqual({round(float(np.array(value).ravel()[0]), 3) for key, value in mi.traverse(scene)
                          if key.endswith("alpha.value")}, {0.1, 0.2})

    def test_old_films_and_samplers(self):
        """Those that Mitsuba 3 has not, and where it does not look for them."""
        size = '<integer name="width" value="8"/><integer name="height" value="6"/><rfilter type="{}"/>'
        box = size.format("box")
        sensor = '<sensor type="perspective">{}</sensor>'
        film = '<film type="{}">{}{}</film>'
        text = lambda name, value: f'<string name="{name}" value="{value}"/>'
        cases = [
            ("0.6.0", sensor.format(film.format("ldrfilm", text("fileFormat", "png") + text("tonemapMethod", "gamma"), box)),
             "ldrfilm is not known"),
            ("0.5.0", sensor.format(film.format("mfilm", text("pixelFormat", "spectrum"), box)), "mfilm is not known"),
            ("0.6.0", sensor.format(film.format("$kind", "", box)), "ldrfilm is not known"),
            ("0.6.0", sensor.format(film.format("tiledhdrfilm", "", box)), "tiledhdrfilm is not known"),
            ("3.0.0", sensor.format(film.format("specfilm", "", box)), "specfilm is not known"),
            ("0.6.0", sensor.format(film.format("hdrfilm", text("pixelFormat", "rgb, luminance"), box)), "pixel_format"),
            ("0.6.0", sensor.format(film.format("hdrfilm", text("pixelFormat", "luminanceAlpha"), box)), None),
            ("0.6.0", sensor.format(film.format("hdrfilm", "", size.format("wsinc"))), "wsinc is not known"),
            ("0.5.0", sensor.format("") + film.format("hdrfilm", "", box), None),
            ("3.0.0", film.format("hdrfilm", "", '<integer name="width" value="5"/>')
             + sensor.format(film.format("hdrfilm", "", box)), None),
            ("3.0.0", '<film type="hdrfilm" id="f">' + box + "</film>" + sensor.format('<ref id="f"/>'), None),
            ("0.6.0", sensor.format(film.format("hdrfilm", "", box) + film.format("hdrfilm", "", "")), "one film only"),
            ("0.6.0", sensor.format(film.format("hdrfilm", "", box) + '<sampler type="halton"><integer '
                                    'name="sampleCount" value="9"/><integer name="scramble" value="1"/></sampler>'),
             "halton is not known"),
        ]
        for version, elements, expected in cases:
            with self.subTest(elements):
                warnings = []
                path = self.write("film.xml", f'<scene version="{version}"><default name="kind" value="ldrfilm"/>'
                                  f'{elements}<shape type="sphere"/></scene>')
                found = scene_files.load_file(path, warn=warnings.append).sensors()[0]
                self.assertEqual(list(found.film().size()), [8, 6])
                self.assertEqual(len(warnings), 0 if expected is None else 1)
                self.assertIn(expected or "", "".join(warnings))
                smaller = scene_files.load_file(path, size=(4, 3), warn=warnings.append).sensors()[0]
                self.assertEqual(list(smaller.film().size()), [4, 3])
        self.assertEqual(found.sampler().sample_count(), 9)

    def test_further_and_nested_integrators(self):
        warnings = []
        aov = '<string name="aovs" value="d:depth"/><integrator type="erpt"/>'
        self.scene.write_text(scene_text("aov", aov, "<integrator type='path'/>").replace(
            '<integer name="max_depth" value="4"/><integer name="rr_depth" value="3"/>', ""))
        scene = scene_files.load_file(self.scene, warn=warnings.append)
        self.assertIn("AOV", str(scene.integrator()))
        self.assertEqual(["one integrator only" in text or "erpt is not known" in text for text in warnings], [True, True])

    def test_elements_behind_the_scene(self):
        warnings = []
        self.scene.write_text(scene_text() + "<bsdf/>\n<scene>")
        self.assertIsInstance(scene_files.load_file(self.scene, warn=warnings.append), mi.Scene)
        self.assertEqual(warnings, ["what follows </scene> (line 13) is left out"])

    def test_changes_of_the_sensor(self):
        scene = scene_files.load_file(self.scene, pixels=24, rfilter="gaussian", sampler="stratified")
        sensor = scene.sensors()[0]
        self.assertEqual(list(sensor.film().size()), [6, 4])
        self.assertIn("Gaussian", str(sensor.film().rfilter()))
        self.assertIn("Stratified", str(sensor.sampler()))

    def test_old_skies(self):
        """+Y was up, north -Z and east +X; the sun of 9 o'clock stands in the east."""
        morning = [0.615, 0.783, 0.096]
        turned = '<transform name="toWorld"><rotate y="1" angle="90"/></transform>'
        cases = [
            ("0.6.0", "sunsky", '<float name="hour" value="9"/>', morning, True),
            ("0.6.0", "sunsky", '<float name="hour" value="9"/>' + turned, [0.096, 0.783, -0.615], True),
            ("0.6.0", "sunsky", '<vector name="sunDirection" x="1" y="2" z="-3"/>', [1, 2, -3], True),
            ("3.0.0", "sun", '<float name="hour" value="9"/>', morning, True),
            ("0.6.0", "sky", '<float name="hour" value="9"/>', morning, False),
            ("3.0.0", "sunsky", '<vector name="sun_direction" x="1" y="-3" z="2"/>', [1, -3, 2], True),
        ]
        for version, kind, parameters, towards, shines in cases:
            with self.subTest(version=version, kind=kind, parameters=parameters):
                text = f'<scene version="{version}"><emitter type="{kind}">{parameters}</emitter></scene>'
                sky = scene_files.load_file(self.write("sky.xml", text)).environment()
                at = mi.SurfaceInteraction3f()
                at.wi = -mi.Vector3f((np.array(towards, float) / np.linalg.norm(towards)).tolist())
                self.assertEqual(np.max(np.array(sky.eval(at))) > 100, shines)
                self.assertEqual("Sky scale = 0" in str(sky), kind == "sun")
        # The sun keeps its power where it is larger, and `scale` is that of both parts.
        old = '<scene version="0.6.0"><emitter type="sunsky"><float name="sunRadiusScale" value="4"/>{}</emitter></scene>'
        sky = str(scene_files.load_file(self.write("sky.xml", old.format('<float name="scale" value="3"/>'))).environment())
        for part in ("Sun aperture = 2.1432", "Sun scale = 3", "Sky scale = 3"):
            self.assertIn(part, sky)
        with self.assertRaisesRegex(ValueError, "emitter sunsky: expected a number, found x"):
            scene_files.load_file(self.write("sky.xml", old.format('<float name="hour" value="x"/>')))

    def test_file_resolver_stays(self):
        before = str(mi.file_resolver())
        scene_files.load_file(self.scene)
        self.assertEqual(str(mi.file_resolver()), before)


class Guide(unittest.TestCase):
    def test_settings(self):
        for integrator, expected in (("path", (4, 3, True)), ("volpath", (4, 3, True)), ("odis", (4, 3, True))):
            scene = mi.load_string(scene_text(integrator, '<boolean name="hide_emitters" value="true"/>'))
            settings = odis.mitsuba.guide(scene).settings
            self.assertEqual((settings.max_depth, settings.rr_depth, settings.hide_emitters), expected)
        scene = mi.load_dict({"type": "scene", "sensor": {"type": "perspective"}, "integrator": {"type": "direct"}})
        settings = odis.mitsuba.guide(scene).settings
        self.assertEqual((settings.max_depth, settings.rr_depth, settings.hide_emitters), (-1, 5, False))
        self.assertEqual(odis.mitsuba.guide(scene, max_depth=2).settings.max_depth, 2)

    def test_a_scene_with_odis(self):
        scene = mi.load_string(scene_text("odis"))
        image = np.array(mi.render(scene, spp=4))
        np.testing.assert_array_equal(image, np.array(mi.render(scene, integrator=odis.mitsuba.guide(scene), spp=4)))

    def test_aovs(self):
        """Those of Mitsuba's aov, in the same places; odis nested there; and its own parameter."""
        aovs = "dd:depth,nn:sh_normal,al:albedo"
        for nested in ("path", "odis"):
            scene = mi.load_string(SCENE.format(
                integrator="aov", more="", parameters=f'<string name="aovs" value="{aovs}"/>'
                f'<integrator type="{nested}"><integer name="max_depth" value="3"/></integrator>')
                .replace('<integer name="max_depth" value="4"/><integer name="rr_depth" value="3"/>', ""))
            theirs = np.array(mi.render(scene, spp=64))
            ours = np.array(mi.render(scene, integrator=odis.mitsuba.guide(scene), spp=64))
            self.assertEqual(channels_of_film(scene), ["R", "G", "B", "dd.T", "nn.X", "nn.Y", "nn.Z",
                                                       "al.R", "al.G", "al.B"])
            self.assertEqual(ours.shape, theirs.shape)
            self.assertLess(np.abs(ours - theirs)[2:-2, 4:-4].max(), 0.2)
            if nested == "odis":
                np.testing.assert_array_equal(ours[..., :3], theirs[..., :3])
            else:
                own = mi.load_dict({"type": "odis", "max_depth": 3, "aovs": aovs})
                np.testing.assert_array_equal(ours, np.array(mi.render(scene, integrator=own, spp=64)))

    def test_progress(self):
        scene, fractions = mi.load_string(scene_text()), []
        integrator = odis.mitsuba.guide(scene)
        integrator.progress = fractions.append
        mi.render(scene, integrator=integrator, spp=8)
        self.assertEqual((fractions[0], fractions[-1]), (0, 1))
        self.assertEqual(fractions, sorted(fractions))
        # Here adaptive passes take more samples than were asked for.
        cornell_box, fractions[:] = mi.load_dict(test_mitsuba.box()), []
        integrator = odis.mitsuba.guide(cornell_box, max_depth=6)
        integrator.progress = fractions.append
        mi.render(cornell_box, integrator=integrator, spp=33)
        self.assertGreater(integrator.frame.sample_counts().sum(), 33 * test_mitsuba.SIZE ** 2)
        self.assertEqual((fractions[0], fractions[-1]), (0, 1))
        self.assertEqual(fractions, sorted(fractions))
        stream = io.StringIO()
        with mock.patch("time.monotonic") as clock:
            clock.return_value = 100
            line = ProgressLine(stream, "image")
            for seconds, fraction in ((0, 0), (9, 0.2), (11, 0.3), (20, 0.5), (22, 0.6), (23, 1), (24, 1)):
                clock.return_value = 100 + seconds
                line(fraction)
        self.assertEqual(stream.getvalue(), "".join(f"image: {p:3d} % of the samples\n" for p in (30, 60, 100)))


def channels_of_film(scene):
    return [field.name for field in scene.sensors()[0].film().bitmap().struct_()]


@unittest.skipUnless(EXAMPLE.is_file(), "the notebook is part of the sources")
class Notebook(unittest.TestCase):
    def test_runs(self):
        cells = json.loads(EXAMPLE.read_text())["cells"]
        code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
        small, sizes = "SIZE, REFERENCE_SPP, SEEDS = 32, 1024, 8", "SIZE, REFERENCE_SPP, SEEDS = 192, 1024, 4"
        self.assertIn(sizes, code)
        names = {}
        with contextlib.redirect_stdout(io.StringIO()):
            exec(code.replace(sizes, small), names)
        self.assertLess(names["errors"]["odis"], names["errors"]["path"])
        self.assertEqual(names["channels"].shape, (32, 32, 7))


if __name__ == "__main__":
    unittest.main()
