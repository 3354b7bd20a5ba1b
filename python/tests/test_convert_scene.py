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
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        picture = np.repeat(STEPS[:, None, None], 3, axis=2)
        mi.Bitmap(np.ascontiguousarray(picture)).write(str(cls.folder / "steps.png"))
        cls.said, cls.text = cls.convert(SCENE, "out")

    @classmethod
    def convert(cls, scene, out):
        """Returns what is said on stderr, and the scene that was written to that folder."""
        (cls.folder / "scene.xml").write_text(scene)
        command = [sys.executable, PROGRAM, cls.folder / "scene.xml", cls.folder / out, "--pixels", "24"]
        said = subprocess.run(command, check=True, capture_output=True, text=True).stderr
        return said, (cls.folder / out / "scene.xml").read_text()

    def with_light(self, emitter):
        """What is said, and the mesh that shines: its positions, triangles and radiance."""
        said, text = self.convert(SCENE.replace('<emitter type="constant"/>', emitter), "light")
        shader = re.search(r'<shader name="(\w+)">\n  <emission name="front" color="([^"]*)"', text)
        mesh = re.search(rf'<state shader="{shader[1]}"[^>]*>\n  <mesh P="([^"]*)"\n[^\n]*\n    verts="([^"]*)"', text)
        array = lambda numbers: np.array(numbers.split(), float).reshape(-1, 3)
        return said, array(mesh[1]), array(mesh[2]).astype(int), array(shader[2])[0]

    def test_without_light(self):
        dark, _ = self.convert(SCENE.replace('<emitter type="constant"/>', '<emitter type="directional"/>'), "dark")
        self.assertIn("DirectionalEmitter is left out", dark)
        self.assertIn("no light is left", dark)
        self.assertNotIn("no light is left", self.said)

    def test_point_light(self):
        _, positions, faces, radiance = self.with_light(
            '<emitter type="point"><point name="position" x="1" y="2" z="3"/><rgb name="intensity" value="1 2 4"/></emitter>')
        np.testing.assert_allclose(positions.mean(0), [1, 2, 3], atol=1e-3)
        corners = positions[faces]
        areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
        self.assertTrue((np.sum(areas * (corners.mean(1) - [1, 2, 3]), 1) >= 0).all())  # outwards
        # What a convex surface of constant radiance gives all directions in the mean: a quarter of its area.
        np.testing.assert_allclose(radiance * np.linalg.norm(areas, axis=1).sum() / 4, [1, 2, 4], rtol=0.1)

    def test_spot(self):
        said, positions, faces, radiance = self.with_light(
            '<emitter type="spot"><transform name="to_world"><lookat origin="1,2,3" target="1,5,3" up="0,0,1"/></transform>'
            '<rgb name="intensity" value="3"/></emitter>')
        self.assertIn("a spot shines as wide as a disk does", said)
        np.testing.assert_allclose(positions.mean(0), [1, 2, 3], atol=1e-3)
        corners = positions[faces]
        area = np.sum(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2, 0)
        np.testing.assert_allclose(area / np.linalg.norm(area), [0, 1, 0], atol=1e-4)
        np.testing.assert_allclose(radiance * np.linalg.norm(area), 3, rtol=0.05)  # along its axis

    def test_cylinder(self):
        shape = ('<shape type="cylinder"><point name="p0" x="5" y="0" z="0"/>'
                 '<point name="p1" x="5" y="4" z="0"/><float name="radius" value="0.5"/></shape>')
        _, text = self.convert(SCENE.replace('<emitter', shape + '<emitter'), "cylinder")
        meshes = [np.array(p.split(), float).reshape(-1, 3) for p in re.findall(r'<mesh P="([^"]*)"', text)]
        tube = next(mesh for mesh in meshes if len(mesh) > 100)
        np.testing.assert_allclose(np.hypot(tube[:, 0] - 5, tube[:, 2]), 0.5, atol=1e-5)
        np.testing.assert_allclose(np.unique(tube[:, 1].round(5)), [0, 4])

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
