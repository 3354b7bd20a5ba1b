"""Objects as objects of Python: how they print themselves, copies, pickles, and one number for all vertices."""

import copy
import os
import pathlib
import pickle
import tempfile
import threading
import unittest
import zlib
from unittest import mock

import made_up
import numpy as np
import odis

ROOT = pathlib.Path(__file__).parents[2]


def built(count=5000, **options):
    builder = odis.GuideBuilder(odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS, **options))
    builder.add(made_up.vertices(count))
    return builder, builder.build()


class Printing(unittest.TestCase):
    def test_guides_and_builders(self):
        builder, guide = built()
        self.assertRegex(repr(guide), rf"^<odis.Guide: {len(guide)} cells, finest_edge=0\.\d+, light_groups=3, "
                         rf"predicted_variance_ratio=\d\.\d+, bytes={guide.bytes}>$")
        self.assertEqual(repr(builder), f"<odis.GuideBuilder: 5000 vertices, bytes={builder.bytes}>")
        self.assertRegex(repr(guide.rules), r"^odis.GuideRules\(roughness_bounds=\[.*least_survival=0\.\d{1,6}, .*cached_error=")
        self.assertRegex(repr(builder.vertex_counts), r"^odis.VertexCounts\(accepted=5000, discrete=0, .*in_media=0\)$")

    def test_options_are_what_makes_them_again(self):
        options = odis.GuideOptions(light_groups=3, light_parts=[(1, 2)], settings="cells=64")
        self.assertEqual(repr(options),
                         "odis.GuideOptions(model=None, light_groups=3, light_parts=[(1, 2)], settings='cells=64')")
        self.assertEqual(repr(eval(repr(options))), repr(options))
        frame = odis.FrameOptions(64, 32, samples_per_pixel=7, guide=options)
        self.assertEqual(repr(eval(repr(frame))), repr(frame))
        self.assertIn("samples_per_pixel=7", repr(frame))
        self.assertEqual(repr(eval(repr(frame)).guide), repr(options))

    def test_frames_and_their_passes(self):
        frame = odis.Frame(odis.FrameOptions(64, 32, samples_per_pixel=7))
        self.assertEqual(repr(frame), "<odis.Frame: 64 x 32 pixels, 0 samples by now, samples_per_pixel=7, cells=0>")
        self.assertRegex(repr(frame.begin_pass()),
                         r"^odis.FramePass\(kind=PassKind.PILOT, wants_vertices=True, .*guide=<odis.Guide: 0 cells")
        self.assertRegex(repr(frame.statistics), r"^odis.FrameStatistics\(samples=0, samples_per_pixel=7, .*=False\)$")

    def test_models_and_contexts(self):
        model = odis.Model()
        self.assertRegex(repr(model), "^<odis.Model at 0x[0-9a-f]+>$")
        self.assertEqual(repr(odis.GuideOptions(model=model).model), repr(model))
        self.assertNotEqual(repr(odis.Model()), repr(model))
        self.assertEqual(repr(odis.Context(threads=3)), "odis.Context(threads=3, memory_use=0)")

    def test_vertices_and_settings(self):
        vertices = odis.PathVertices(**made_up.vertices(10))
        self.assertRegex(repr(vertices), "^<odis.PathVertices: 10 vertices, fields: position, normal, wo, wi, .*discrete>$")
        self.assertRegex(repr(odis.settings()[0]), r"^odis.Setting\(name='[a-z-]+', values='.*research=(True|False)\)$")

    def test_every_class_has_one(self):
        for name in odis.__all__:
            bound = getattr(odis, name)
            if isinstance(bound, type) and not issubclass(bound, (Exception,)):
                self.assertNotEqual(bound.__repr__, object.__repr__, name)


class Copies(unittest.TestCase):
    def test_guides_are_pickled(self):
        _, guide = built()
        for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
            again = pickle.loads(pickle.dumps(guide, protocol))
            self.assertEqual(made_up.guide_bytes(again), made_up.guide_bytes(guide))
            self.assertEqual(again.predicted_variance_ratio, guide.predicted_variance_ratio)
        self.assertIs(copy.copy(guide), guide)
        self.assertIs(copy.deepcopy([guide])[0], guide)

    def test_builders_go_on_where_they_were(self):
        builder, guide = built()
        copies = [copy.copy(builder), copy.deepcopy(builder), pickle.loads(pickle.dumps(builder))]
        more = made_up.vertices(5000, seed=2)
        builder.add(more)
        both = made_up.guide_bytes(builder.build())
        self.assertNotEqual(both, made_up.guide_bytes(guide))
        for other in copies:
            self.assertEqual(made_up.guide_bytes(other.build()), made_up.guide_bytes(guide))
            other.add(more)
            self.assertEqual(made_up.guide_bytes(other.build()), both)

    def test_builders_with_a_model_of_their_own(self):
        weights = bytearray((ROOT / "weights/odis.weights").read_bytes()[:-4])
        weights[-4] ^= 1  # the last number's last bit; a checksum follows
        model = odis.Model.from_bytes(bytes(weights) + zlib.crc32(weights).to_bytes(4, "little"))
        builder, guide = built(model=model)
        again = copy.copy(copy.deepcopy(builder))
        self.assertEqual(made_up.guide_bytes(again.build()), made_up.guide_bytes(guide))
        with self.assertRaisesRegex(odis.Error, "model") as raised:
            pickle.loads(pickle.dumps(builder))
        self.assertEqual(raised.exception.code, odis.ErrorCode.FILE)

    def test_nothing_stays_behind(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, {"TMPDIR": folder}), \
                mock.patch.object(tempfile, "tempdir", None):
            builder, guide = built(100)
            pickle.loads(pickle.dumps((builder, guide)))
            self.assertEqual(os.listdir(folder), [])

    def test_what_is_no_guide(self):
        _, guide = built(100)
        state = guide.__getstate__()
        for damaged in (b"", b"no guide", state[:-20], built(100)[0].__getstate__()):
            with self.assertRaises(odis.Error) as raised:
                odis.Guide.__new__(odis.Guide).__setstate__(damaged)
            self.assertEqual(raised.exception.code, odis.ErrorCode.FILE)
        with self.assertRaises(TypeError):
            odis.Guide.__new__(odis.Guide).__setstate__(3)

    def test_frames_are_not_pickled(self):
        with self.assertRaises(TypeError):
            pickle.dumps(odis.Frame(odis.FrameOptions(8, 8)))


class OneNumber(unittest.TestCase):
    def setUp(self):
        self.fields = made_up.vertices(3000)

    def test_for_all_vertices(self):
        builder = odis.GuideBuilder(odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS))
        builder.add({**self.fields, "roughness": np.full(3000, 0.25, np.float32),
                     "light_group": np.full(3000, 2, np.uint32)})
        expected = made_up.guide_bytes(builder.build())
        for roughness, group, depth, discrete in (
                (0.25, 2, 1, False), (np.float32(0.25), np.uint32(2), np.uint16(1), np.False_),
                (np.float64(0.25), np.int64(2), np.uint8(1), np.zeros((), bool))):
            builder = odis.GuideBuilder(odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS))
            vertices = odis.PathVertices(**{**self.fields, "roughness": roughness, "light_group": group,
                                            "depth": depth, "discrete": discrete})
            builder.add(vertices)
            self.assertEqual(made_up.guide_bytes(builder.build()), expected)
        self.assertEqual(len(odis.PathVertices(**{name: array[:0] for name, array in self.fields.items()} |
                                               {"depth": 1})), 0)

    def test_that_is_none_of_the_field(self):
        for name, value, found in (
                ("depth", 70000, "uint16, found 70000"), ("depth", -1, "uint16, found -1"),
                ("depth", 1.0, "uint16, found 1.0"), ("depth", np.int64(70000), "uint16, found int64"),
                ("depth", True, "uint16, found True"), ("discrete", 1, "bool, found 1"),
                ("discrete", np.int32(1), "bool, found int32"), ("roughness", True, "float32, found True"),
                ("pixel", np.float64(0.5), "uint32, found"), ("pixel", 1 << 32, "uint32, found 4294967296"),
                ("normal", 1.0, "found <class 'float'>"), ("normal", np.float32(1), r"\(3000, 3\), found")):
            with self.assertRaisesRegex(ValueError, f"^{name}: expected .*{found}"):
                odis.PathVertices(**{**self.fields, name: value})

    def test_in_lookups(self):
        _, guide = built()
        cells = guide.find_cells(self.fields["position"], self.fields["normal"])
        half, ones = np.full(3000, 0.5, np.float32), np.full(3000, 2, np.uint32)
        for number in (0.5, np.float32(0.5), np.float64(0.5), np.array(0.5)):
            np.testing.assert_array_equal(guide.bsdf_fraction(cells, number), guide.bsdf_fraction(cells, half))
            for depth in (2, np.uint32(2), np.int64(2), ones):
                np.testing.assert_array_equal(guide.survival_probability(cells, number, depth),
                                              guide.survival_probability(cells, half, ones))
        np.testing.assert_array_equal(guide.bsdf_fraction(cells, roughness=1),
                                      guide.bsdf_fraction(cells, np.ones(3000, np.float32)))
        with self.assertRaisesRegex(ValueError, r"^roughness: expected float32 of shape \(3000,\), found .*\(1,\)"):
            guide.bsdf_fraction(cells, np.ones(1, np.float32))
        with self.assertRaisesRegex(ValueError, "^depth: expected uint32, found int64"):
            guide.survival_probability(cells, half, np.int64(-1))


class Threads(unittest.TestCase):
    def test_a_builder_that_is_busy_prints_itself(self):
        builder, _ = built(100)
        vertices, stop, texts = odis.PathVertices(**made_up.vertices(200000)), threading.Event(), set()

        def add():
            for _ in range(10):
                builder.add(vertices)
            stop.set()

        thread = threading.Thread(target=add)
        thread.start()
        while not stop.is_set():
            texts.add(repr(builder))
        thread.join()
        self.assertTrue(any("expected a call by another thread to end first" in text for text in texts), texts)


if __name__ == "__main__":
    unittest.main()
