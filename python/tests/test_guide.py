"""Guides: the same bits as in C++, whatever arrays the vertices lie in; arrays that outlive their guide."""

import gc
import logging
import os
import pathlib
import signal
import tempfile
import threading
import unittest
import weakref

import made_up
import numpy as np
import odis


def build(fields, context=None):
    builder = odis.GuideBuilder(odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS), context)
    vertices = odis.PathVertices(**fields)
    builder.add(vertices)
    return builder.build()


class SameBits(unittest.TestCase):
    def setUp(self):
        self.fields = made_up.vertices(20000)
        self.expected = made_up.guide_bytes(build(self.fields))

    def expect_same(self, fields):
        self.assertEqual(made_up.guide_bytes(build(fields)), self.expected)

    def test_as_in_cpp(self):
        program = os.environ.get("ODIS_GUIDE_OF_FILES")
        if not program:
            self.skipTest("ODIS_GUIDE_OF_FILES does not name the program: scripts/wheel builds it")
        with tempfile.TemporaryDirectory() as folder:
            in_cpp = made_up.InCpp(program, folder, self.fields, threads=1)
            in_cpp.build()
            self.assertEqual(in_cpp.guide_bytes(), self.expected)

    def test_any_number_of_threads(self):
        for threads in (1, 2, 5):
            guide = build(self.fields, odis.Context(threads=threads))
            self.assertEqual(made_up.guide_bytes(guide), self.expected)

    def test_strides(self):
        self.expect_same({name: np.repeat(array, 2, axis=0)[::2] for name, array in self.fields.items()})
        # An array of structs, whose parts are not aligned.
        kinds = [("gap", np.uint8, 4)] + [(n, a.dtype, a.shape[1:]) for n, a in self.fields.items()]
        records = np.zeros(20000, np.dtype(kinds + [("end", np.uint8, 1)]))
        for name, array in self.fields.items():
            records[name] = array
        self.assertEqual(records.dtype.itemsize % 4, 0)
        self.expect_same({name: records[name] for name in self.fields})

    def test_read_only(self):
        fields = {name: array.copy() for name, array in self.fields.items()}
        for array in fields.values():
            array.flags.writeable = False
        self.expect_same(fields)

    def test_half_floats(self):
        def rounded(array, dtype):
            return array.astype(np.float16).astype(dtype) if array.dtype == np.float32 else array

        single = {name: rounded(array, np.float32) for name, array in self.fields.items()}
        expected = made_up.guide_bytes(build(single))
        half = {name: rounded(array, np.float16) for name, array in self.fields.items()}
        self.assertEqual(half["wi"].dtype, np.float16)
        self.assertEqual(made_up.guide_bytes(build(half)), expected)
        apart = {name: np.repeat(array, 3, axis=0)[::3] for name, array in half.items()}
        self.assertEqual(made_up.guide_bytes(build(apart)), expected)

    def test_other_libraries(self):
        class ByDlpack:
            """An array of a library that knows DLPack and nothing else."""

            def __init__(self, array):
                self._array = array

            def __dlpack__(self, **arguments):
                return self._array.__dlpack__(**arguments)

            def __dlpack_device__(self):
                return self._array.__dlpack_device__()

        self.expect_same({name: ByDlpack(array) for name, array in self.fields.items()})
        self.expect_same({name: memoryview(array) for name, array in self.fields.items()})

    def test_dict_or_described(self):
        builder = odis.GuideBuilder(odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS))
        builder.add(self.fields)
        self.assertEqual(made_up.guide_bytes(builder.build()), self.expected)
        self.assertEqual(builder.vertex_counts.accepted, 20000)
        self.assertGreater(builder.bytes, 0)

    def test_rebuild(self):
        builder = odis.GuideBuilder(odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS))
        builder.add(self.fields)
        first = builder.build()
        builder.add(made_up.vertices(20000, seed=2))
        again = builder.rebuild(first)
        self.assertNotEqual(made_up.guide_bytes(again), self.expected)
        self.assertEqual(made_up.guide_bytes(first), self.expected)

    def test_merging(self):
        options = odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS)
        builders = []
        for part in range(3):
            builders.append(odis.GuideBuilder(options))
            builders[-1].set_part_id(part + 1)
            builders[-1].set_bounds([-1, -1, -1], [1, 1, 1])
            builders[-1].add(made_up.vertices(5000, seed=part))
            builders[-1].add(made_up.vertices(1000, seed=part + 10), guided=True)
        whole, backwards = odis.GuideBuilder(options), odis.GuideBuilder(options)
        whole.merge(builders)
        with tempfile.TemporaryDirectory() as folder:
            for part in reversed(range(3)):
                path = pathlib.Path(folder) / "part.builder"
                builders[part].save(path)
                backwards.merge([odis.GuideBuilder.load(path)])
        guide = whole.build()
        self.assertEqual(made_up.guide_bytes(guide), made_up.guide_bytes(backwards.build()))
        self.assertEqual(whole.vertex_counts.accepted, 18000)
        with self.assertRaisesRegex(odis.Error, "two parts have the id 2"):
            whole.merge([builders[1]])

    def test_models(self):
        for settings in ("", "guide=histogram lights=formula"):
            builder = odis.GuideBuilder(odis.GuideOptions(model=odis.Model(), light_groups=made_up.LIGHT_GROUPS,
                                                          settings=settings))
            builder.add(self.fields)
            same = made_up.guide_bytes(builder.build()) == self.expected
            self.assertEqual(same, not settings)

    def test_pixel_values(self):
        builder = odis.GuideBuilder(odis.GuideOptions(light_groups=made_up.LIGHT_GROUPS))
        builder.add(self.fields)
        ones = builder.build(np.ones(20000, np.float32))
        np.testing.assert_array_equal(ones.maps, builder.build().maps)
        tens = builder.build(pixel_values=np.full(20000, 10, np.float32))
        np.testing.assert_array_equal(tens.maps, ones.maps)
        self.assertTrue((tens.survival_factors != ones.survival_factors).any())


class Maps(unittest.TestCase):
    def test_shares_add_up(self):
        maps = build(made_up.vertices(20000)).maps
        self.assertEqual(maps.shape[1:], (17, 16))
        self.assertGreater(maps.min(), 0)
        np.testing.assert_array_equal(maps.sum(axis=2, dtype=np.int64), 1 << 15)

    def test_are_what_the_density_is_made_of(self):
        guide = build(made_up.vertices(20000))
        cells = np.repeat(np.arange(20, dtype=np.uint32), 500)
        wi, pdf = guide.sample(cells, np.random.default_rng(3).random((cells.size, 2), np.float32))
        shares = guide.maps[cells].astype(np.float64) / 2 ** 15
        texels = (shares[:, :1].transpose(0, 2, 1) * shares[:, 1:]).reshape(cells.size, 256) * 256 / (4 * np.pi)
        nearest = np.abs(texels / pdf[:, None] - 1).min(axis=1)
        self.assertLess(nearest.max(), 1e-6)


class Lifetimes(unittest.TestCase):
    def test_arrays_are_the_guides_own(self):
        guide = build(made_up.vertices(5000))
        names = ["cell_keys", "maps", "bsdf_fractions", "survival_factors",
                 "outgoing_radiance", "learned_light_fractions", "light_tables"]
        for name in names:
            array = getattr(guide, name)
            self.assertFalse(array.flags.owndata, name)
            self.assertFalse(array.flags.writeable, name)
            again = getattr(guide, name)
            self.assertEqual(array.__array_interface__["data"][0], again.__array_interface__["data"][0], name)

    def test_arrays_outlive_the_guide(self):
        context = odis.Context()
        guide = build(made_up.vertices(5000), context)
        maps = guide.maps
        expected, held = maps.copy(), context.memory_use
        del guide
        gc.collect()
        self.assertEqual(context.memory_use, held)
        np.testing.assert_array_equal(maps, expected)
        del maps
        gc.collect()
        self.assertEqual(context.memory_use, 0)

    def test_vertices_keep_their_arrays(self):
        fields = made_up.vertices(1000)
        array = fields["wi"]
        alive = weakref.ref(array)
        vertices = odis.PathVertices(**fields)
        del fields, array
        gc.collect()
        self.assertIsNotNone(alive())
        del vertices
        gc.collect()
        self.assertIsNone(alive())

    def test_without_cells(self):
        guide = odis.Frame(odis.FrameOptions(4, 4)).guide
        self.assertEqual(len(guide), 0)
        self.assertEqual(guide.maps.shape, (0, 17, 16))
        self.assertEqual(guide.light_tables.shape, (0, 1))
        cells = guide.find_cells(np.zeros((2, 3), np.float32), np.ones((2, 3), np.float32))
        self.assertEqual(list(cells), [odis.NO_CELL] * 2)

    def test_empty_vertices(self):
        builder = odis.GuideBuilder()
        builder.add({"position": np.zeros((0, 3), np.float32)})
        self.assertEqual(builder.vertex_counts.accepted, 0)


class Threads(unittest.TestCase):
    def test_one_call_at_a_time(self):
        """Calls of one builder by two threads succeed or raise Error, and spoil nothing."""
        fields = made_up.vertices(100000)
        builder = odis.GuideBuilder()
        outcomes = []

        def add():
            try:
                builder.add(fields)
                outcomes.append(True)
            except odis.Error as error:
                self.assertEqual(error.code, odis.ErrorCode.INVALID_OPERATION)
                outcomes.append(False)

        threads = [threading.Thread(target=add) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(builder.vertex_counts.accepted, 100000 * sum(outcomes))
        self.assertGreaterEqual(sum(outcomes), 1)


    def test_ctrl_c(self):
        """A signal while a guide is built raises KeyboardInterrupt, and the builder works on."""
        fields = made_up.vertices(100000)
        builder = odis.GuideBuilder()
        builder.add(fields)
        # Where a shell started this in the background, Ctrl-C is ignored.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        main = threading.get_ident()
        other = threading.Thread(target=lambda: signal.pthread_kill(main, signal.SIGINT))
        with self.assertRaises(KeyboardInterrupt):
            other.start()
            builder.build()
            other.join()
        self.assertGreater(len(builder.build()), 0)

    def test_ctrl_c_while_logging(self):
        """A signal that arrives while a message is logged is not lost."""
        class Interrupted(logging.Handler):
            def emit(self, record):
                raise KeyboardInterrupt

        logger, handler = logging.getLogger("odis"), Interrupted()
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        self.addCleanup(logger.setLevel, logger.level)
        self.addCleanup(logger.removeHandler, handler)
        logger.setLevel(logging.INFO)
        logger.addHandler(handler)
        builder = odis.GuideBuilder()
        builder.add(made_up.vertices(2000))
        with self.assertRaises(KeyboardInterrupt):
            builder.build()
            self.fail("the signal did not come again")


if __name__ == "__main__":
    unittest.main()
