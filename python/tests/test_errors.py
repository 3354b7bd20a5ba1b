"""What is refused, and how it is said."""

import unittest

import made_up
import numpy as np
import odis


class PixelNetworks(unittest.TestCase):
    def test_a_model_without_one(self):
        with self.assertRaisesRegex(odis.Error, "expected one with a network for maps at pixels"):
            odis.GuideBuilder(odis.GuideOptions(settings="pixel-maps=network"))

    def test_options(self):
        for settings in ("pixel-tile=0", "pixel-share=2", "pixel-network=papre"):
            name, value = settings.split("=")
            with self.assertRaisesRegex(odis.Error, f'{name}: found "{value}", expected'):
                odis.GuideBuilder(odis.GuideOptions(settings=settings))


class Arrays(unittest.TestCase):
    def setUp(self):
        self.fields = made_up.vertices(10)

    def expect_refused(self, name, array, message):
        with self.assertRaisesRegex(ValueError, f"^{name}: expected .*{message}"):
            odis.PathVertices(**{**self.fields, name: array})

    def test_types(self):
        self.expect_refused("pdf", self.fields["pdf"].astype(np.float64), "float32 .* found float64")
        self.expect_refused("pixel", self.fields["pixel"].astype(np.int32), "uint32 .* found int32")
        self.expect_refused("depth", self.fields["depth"].astype(np.uint32), "uint16 .* found uint32")
        self.expect_refused("discrete", np.zeros(10, np.uint8), "bool .* found uint8")
        self.expect_refused("light_group", np.zeros(10, np.float16), "uint32 .* found float16")
        self.expect_refused("pdf", self.fields["pdf"].astype(">f4"), "DLPack")
        self.expect_refused("pdf", [1.0] * 10, "found <class 'list'>")
        self.expect_refused("pdf", None, "found <class 'NoneType'>")

    def test_shapes(self):
        self.expect_refused("pdf", np.ones(9, np.float32), r"\(10,\), found float32 of shape \(9,\)")
        self.expect_refused("pdf", np.ones((10, 1), np.float32), r"\(10,\), found .*\(10, 1\)")
        self.expect_refused("wi", np.ones((10, 4), np.float32), r"\(10, 3\), found .*\(10, 4\)")
        self.expect_refused("wi", np.ones(30, np.float32), r"\(10, 3\), found .*\(30,\)")
        self.expect_refused("position", np.ones((3, 10), np.float32), r"\(3, 3\), found .*\(3, 10\)")

    def test_strides(self):
        self.expect_refused("wi", np.ones((3, 10), np.float32).T, "side by side")
        self.expect_refused("wi", self.fields["wi"][:, ::-1], "side by side")
        self.expect_refused("pdf", self.fields["pdf"][::-1], "ascontiguousarray")
        self.expect_refused("normal", np.broadcast_to(np.ones(3, np.float32), (10, 3)), "ascontiguousarray")
        windows = np.lib.stride_tricks.sliding_window_view(np.ones(12, np.float32), 3)
        self.expect_refused("wi", windows, "a stride of 4 bytes")

    def test_names(self):
        with self.assertRaisesRegex(ValueError, "'radience' is no field"):
            odis.PathVertices(**self.fields, radience=self.fields["radiance"])
        with self.assertRaisesRegex(ValueError, "^position: "):
            odis.PathVertices(normal=self.fields["normal"])
        with self.assertRaisesRegex(ValueError, "^position: "):
            odis.PathVertices()

    def test_fields_that_lack(self):
        for name in ("position", "normal", "wi", "radiance", "pdf", "depth"):
            fields = {other: array for other, array in self.fields.items() if other != name}
            for call in (lambda: odis.PathVertices(**fields), lambda: odis.GuideBuilder().add(fields)):
                with self.assertRaisesRegex(ValueError, f"^{name}: expected an array, found none"):
                    call()
        self.assertEqual(len(odis.PathVertices(position=np.zeros((0, 3), np.float32))), 0)

    def test_lookups(self):
        builder = odis.GuideBuilder()
        builder.add(self.fields)
        guide = builder.build()
        position, normal = self.fields["position"], self.fields["normal"]
        with self.assertRaisesRegex(ValueError, r"^positions: expected float32 of shape \(count, 3\), found float64"):
            guide.find_cells(position.astype(np.float64), normal)
        with self.assertRaisesRegex(ValueError, r"^normals: expected float32 of shape \(10, 3\), found .*\(9, 3\)"):
            guide.find_cells(position, normal[1:])
        cells = guide.find_cells(position, normal)
        with self.assertRaisesRegex(ValueError, r"^uv: expected .*\(10, 2\)"):
            guide.sample(cells, normal)
        with self.assertRaisesRegex(ValueError, "^cells: expected uint32"):
            guide.pdf(cells.astype(np.int64), normal)
        with self.assertRaisesRegex(ValueError, r"^directions: expected .*\(10, 3\)"):
            guide.pdf(cells, normal[1:])
        with self.assertRaisesRegex(ValueError, "^pixel_values: expected float32"):
            builder.build(np.ones(10))

    def test_values_in_lookups(self):
        builder = odis.GuideBuilder()
        builder.add(self.fields)
        guide = builder.build()
        uv = np.full((2, 2), 0.5, np.float32)
        known = np.array([0, odis.NO_CELL], np.uint32)
        self.assertEqual(guide.sample(known, uv)[1][1], 0)
        for wrong in (1, -0.1, np.nan, np.inf):
            with self.assertRaisesRegex(ValueError, r"^uv: expected numbers in \[0, 1\), found"):
                guide.sample(known, np.array([[0.5, 0.5], [0.5, wrong]], np.float32))
        self.assertEqual(guide.pdf(known, np.full((2, 3), np.nan, np.float32)).tolist(), [0, 0])


class Library(unittest.TestCase):
    def expect_error(self, code, call, *arguments, **named):
        with self.assertRaises(odis.Error) as caught:
            call(*arguments, **named)
        self.assertEqual(caught.exception.code, code)
        self.assertTrue(str(caught.exception))

    def test_options(self):
        invalid = odis.ErrorCode.INVALID_ARGUMENT
        for name, value in (("settings", "cells=-1"), ("settings", "map-floor=2"), ("settings", "map-clamp=0"),
                            ("settings", "prior-samples=-1:0:0:0"), ("settings", "cels=3"), ("light_groups", 129)):
            options = odis.GuideOptions(**{name: value})
            self.assertEqual(getattr(options, name), value)
            self.expect_error(invalid, odis.GuideBuilder, options)
            self.expect_error(invalid, odis.Frame, odis.FrameOptions(4, 4, guide=options))
        for name, value in (("samples_per_pixel", 0), ("settings", "pilot-spp=-1"), ("settings", "pilot-weight=-1"),
                            ("settings", "built-cell-cost=-1"), ("settings", "recorded-ray-cost=inf")):
            self.expect_error(invalid, odis.Frame, odis.FrameOptions(4, 4, **{name: value}))
        self.expect_error(invalid, odis.Frame, odis.FrameOptions(0, 4))
        with self.assertRaises(TypeError):
            odis.GuideOptions(lights=1)
        self.assertEqual(odis.GuideOptions(light_parts=[(1, 2)]).light_parts, [(1, 2)])
        options = odis.GuideOptions()
        options.settings, options.light_parts = "cells=3", [(5, 6)]
        self.assertEqual((options.settings, options.light_parts), ("cells=3", [(5, 6)]))

    def test_settings(self):
        names = [setting.name for setting in odis.settings()]
        self.assertEqual(len(set(names)), len(names))
        for setting in odis.settings():
            self.assertTrue(setting.help)
            self.assertEqual(odis.read_setting("", setting.name), setting.default)
            self.assertEqual(odis.read_setting(f"{setting.name}={setting.default}", setting.name), setting.default)
        self.assertEqual(odis.read_setting("cells=3 preset=paper refine=2", "cells"), "0")
        self.assertEqual(odis.read_setting("cells=3 preset=paper refine=2", "refine"), "2")
        for text, name in (("", "cels"), ("cells=x", "refine"), ("cells", "cells")):
            self.expect_error(odis.ErrorCode.INVALID_ARGUMENT, odis.read_setting, text, name)

    def test_context(self):
        self.expect_error(odis.ErrorCode.INVALID_ARGUMENT, odis.Context, threads=10**6)

    def test_models(self):
        self.expect_error(odis.ErrorCode.FILE, odis.Model.from_file, "there is no such file")
        self.expect_error(odis.ErrorCode.FILE, odis.Model.from_bytes, b"no weights")

    def test_guides_of_other_builders(self):
        fields = made_up.vertices(100)
        first, second = odis.GuideBuilder(), odis.GuideBuilder()
        for builder in (first, second):
            builder.add(fields)
        self.assertEqual(len(second.rebuild(first.build())), len(first.build()))
        second.set_bounds([-5, -5, -5], [5, 5, 5])
        self.expect_error(odis.ErrorCode.INVALID_ARGUMENT, second.rebuild, first.build())
        # A vertex of a pixel that there is no value for.
        values = np.ones(50, np.float32)
        self.expect_error(odis.ErrorCode.INVALID_ARGUMENT, first.build, values)

    def test_order_of_calls(self):
        frame = odis.Frame(odis.FrameOptions(4, 4))
        wrong = odis.ErrorCode.INVALID_OPERATION
        self.expect_error(wrong, frame.end_pass)
        self.expect_error(wrong, frame.samples)
        frame.begin_pass()
        self.expect_error(wrong, frame.begin_pass)
        one = np.zeros(1, np.uint32)
        self.expect_error(odis.ErrorCode.INVALID_ARGUMENT, frame.add_samples, one + 16, one,
                          np.ones((1, 3), np.float32))

    def test_is_a_runtime_error(self):
        self.assertTrue(issubclass(odis.Error, RuntimeError))


if __name__ == "__main__":
    unittest.main()
