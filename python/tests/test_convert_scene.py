"""integrations/openpgl/convert_scene.py: scenes of Mitsuba for Cycles. Skipped where Mitsuba does not run."""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

try:
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    mi.Float(1)
except (ImportError, AttributeError, RuntimeError) as missing:
    raise unittest.SkipTest(f"Mitsuba does not run here: {missing}")

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "integrations/openpgl/convert_scene.py"
SCENE = """<scene version="3.0.0">
  <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="12"/>
    <integer name="height" value="8"/></film></sensor>
  <shape type="rectangle"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
    <string name="filename" value="steps.png"/></texture></bsdf></shape>
  <shape type="rectangle"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
    <rgb name="color0" value="0.1"/><rgb name="color1" value="0.7"/>
    <transform name="to_uv"><scale x="10" y="4"/></transform></texture></bsdf></shape>
  <emitter type="constant"/>
</scene>
"""
STEPS = np.array([255, 128, 64, 0], np.uint8)  # of the picture, from its first row to its last


def gray(file):
    picture = mi.Bitmap(str(file)).convert(mi.Bitmap.PixelFormat.Y, mi.Struct.Type.Float32)
    return np.array(picture).reshape(picture.height(), picture.width())


class ConvertScene(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        picture = np.repeat(STEPS[:, None, None], 3, axis=2)
        mi.Bitmap(np.ascontiguousarray(picture)).write(str(self.folder / "steps.png"))
        self.said = self.convert(SCENE)
        self.text = (self.folder / "out/scene.xml").read_text()

    def convert(self, scene):
        """Returns what is said on stderr."""
        (self.folder / "scene.xml").write_text(scene)
        command = [sys.executable, PROGRAM, self.folder / "scene.xml", self.folder / "out", "--pixels", "24"]
        return subprocess.run(command, check=True, capture_output=True, text=True).stderr

    def test_without_light(self):
        dark = self.convert(SCENE.replace('<emitter type="constant"/>', '<emitter type="point"/>'))
        self.assertIn("lights without a shape are left out", dark)
        self.assertIn("no light is left", dark)
        self.assertNotIn("no light is left", self.said)

    def test_textures(self):
        """Linear, the row of v = 0 last, as Cycles reads them."""
        files = re.findall('filename="(texture[^"]*)"', self.text)
        steps, checks = sorted((gray(self.folder / "out" / name) for name in files), key=len)
        encoded = STEPS / 255
        linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
        si = mi.SurfaceInteraction3f()
        si.uv = mi.Point2f(0.5, 0.125)
        bitmap = mi.load_dict({"type": "bitmap", "filename": str(self.folder / "steps.png")})
        first = float(np.array(bitmap.eval_1(si)).item())  # of the row of least v
        np.testing.assert_allclose(steps[:, 0], linear[::-1] if first > 0.5 else linear, atol=1e-3)
        self.assertAlmostEqual(float(steps[-1, 0]), first, places=3)
        np.testing.assert_allclose(sorted(np.unique(checks.round(3))), [0.1, 0.7], atol=1e-3)
        self.assertAlmostEqual(float(checks.mean()), 0.4, places=2)
        self.assertIn('tex_mapping.type="point" tex_mapping.scale="10 4 1"', self.text)

    def test_environment_is_a_light(self):
        self.assertIn('<state shader="default_background">\n  <light light_type="background"', self.text)
        np.testing.assert_allclose(gray(self.folder / "out/environment.exr"), 1, atol=1e-3)

    def test_size(self):
        self.assertIn('<camera width="6" height="4"', self.text)


if __name__ == "__main__":
    unittest.main()
