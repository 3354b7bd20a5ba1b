// Frame: an image from its first sample to its last.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>

#include <optional>

#include "guide_builder.h"
#include "printing.h"

namespace odis::python {

namespace {

using Counts = NumpyArray<uint32_t, -1, -1>;
using Image = NumpyArray<float, -1, -1, 3>;
using PixelValues = NumpyArray<const float, -1, -1>;

// FramePass with a reference to its guide.
struct Pass {
  FramePass described;
  Guide guide;
};

FrameOptions interruptible(FrameOptions options, const Builder* builder) {
  options.guide.progressFunction = goOn;
  if (builder) options.builder = builder->handle();
  return options;
}

class ImageFrame {
 public:
  ImageFrame(const FrameOptions& options, const LoggingContext* context, const Builder* builder)
      : ImageFrame(Frame(interruptible(options, builder), contextOrShared(context))) {}
  explicit ImageFrame(Frame frame)
      : m_frame(std::move(frame)),
        m_width(m_frame.statistics().width),
        m_height(m_frame.statistics().height) {}

  static ImageFrame* load(const std::filesystem::path& path, const std::optional<Model>& model,
                          const LoggingContext* context) {
    Frame frame = withoutLock([&] { return Frame::load(path.string(), model, contextOrShared(context)); });
    frame.setProgress(goOn);
    return new ImageFrame(std::move(frame));
  }
  void save(const std::filesystem::path& path) {
    callAlone(m_calls, [&] { m_frame.save(path.string()); });
  }
  void setHostData(const nb::bytes& bytes) {
    const ArrayView<const uint8_t> view(static_cast<const uint8_t*>(bytes.data()), bytes.size());
    callAlone(m_calls, [&] { m_frame.setHostData(view); });
  }
  nb::bytes hostData() {
    const ArrayView<const uint8_t> bytes = callAlone(m_calls, [&] { return m_frame.hostData(); });
    return nb::bytes(bytes.data(), bytes.size());
  }

  std::optional<Pass> beginPass() {
    return callAlone(m_calls, [&]() -> std::optional<Pass> {
      const FramePass* pass = m_frame.beginPass();
      if (!pass) return {};
      return Pass{*pass, m_frame.guide()};
    });
  }
  std::pair<Counts, Counts> samples() {
    const Counts first = newArray<Counts>({m_height, m_width}), count = newArray<Counts>({m_height, m_width});
    callBeside(m_calls, [&] {
      for (uint32_t pixel = 0; pixel < pixels(); ++pixel) {
        const SampleRange range = m_frame.samples(pixel);
        first.data()[pixel] = range.first;
        count.data()[pixel] = range.count;
      }
    });
    return {first, count};
  }
  void addSamples(const Array& pixel, const Array& sample, const Array& value,
                  const std::optional<Array>& rays, const std::optional<VerticesArgument>& given) {
    const Rows<uint32_t> pixelAt(pixel, "pixel"), sampleAt(sample, "sample", 0, pixelAt.size());
    const Rows<float> valueAt(value, "value", 3, pixelAt.size());
    std::optional<Rows<uint32_t>> raysAt;
    if (rays) raysAt.emplace(*rays, "rays", 0, pixelAt.size());
    std::optional<VertexArrays> vertices;
    if (given) vertices = vertexArrays(*given);
    callBeside(m_calls, [&] {
      std::vector<FrameSample> samples;
      samples.reserve(pixelAt.size());
      for (size_t i = 0; i < pixelAt.size(); ++i)
        samples.push_back({pixelAt(i), sampleAt(i), vectorAt(valueAt, i), raysAt ? (*raysAt)(i) : 0});
      m_frame.add(samples, vertices ? vertices->described() : OdisPathVertices());
    });
  }
  void endPass(bool interrupted) {
    callAlone(m_calls, [&] { m_frame.endPass(interrupted); });
  }
  void extend(uint32_t samplesPerPixel) {
    callAlone(m_calls, [&] { m_frame.extend(samplesPerPixel); });
  }

  // Lies in the frame, which `self` is; None before the pilot has ended.
  static std::optional<PixelValues> pixelValues(nb::pointer_and_handle<ImageFrame> self) {
    const ArrayView<const float> values =
        callAlone(self.p->m_calls, [&] { return self.p->m_frame.pixelValues(); });
    if (values.empty()) return {};
    return PixelValues(values.data(), {self.p->m_height, self.p->m_width}, self.h);
  }
  std::pair<Image, Image> image() {
    const Image mean = newArray<Image>({m_height, m_width, 3}),
                variance = newArray<Image>({m_height, m_width, 3});
    callAlone(m_calls, [&] {
      for (uint32_t pixel = 0; pixel < pixels(); ++pixel) {
        const PixelMean found = m_frame.mean(pixel);
        std::memcpy(mean.data() + 3 * size_t(pixel), &found.color, sizeof found.color);
        std::memcpy(variance.data() + 3 * size_t(pixel), &found.variance, sizeof found.variance);
      }
    });
    return {mean, variance};
  }
  Counts sampleCounts() {
    const Counts result = newArray<Counts>({m_height, m_width});
    callAlone(m_calls, [&] {
      for (uint32_t pixel = 0; pixel < pixels(); ++pixel) result.data()[pixel] = m_frame.sampleCount(pixel);
    });
    return result;
  }
  NumpyArray<float, -1> sampleWeights(const Array& pixel, const Array& sample) {
    const Rows<uint32_t> pixelAt(pixel, "pixel"), sampleAt(sample, "sample", 0, pixelAt.size());
    const auto result = newArray<NumpyArray<float, -1>>({pixelAt.size()});
    callAlone(m_calls, [&] {
      for (size_t i = 0; i < pixelAt.size(); ++i) {
        if (pixelAt(i) >= pixels())
          throw Error(ODIS_ERROR_INVALID_ARGUMENT, "Frame.sample_weights: expected pixels of the frame");
        result.data()[i] = m_frame.sampleWeight(pixelAt(i), sampleAt(i));
      }
    });
    return result;
  }
  FrameStatistics statistics() {
    return callAlone(m_calls, [&] { return m_frame.statistics(); });
  }
  VertexCounts vertexCounts() {
    return callAlone(m_calls, [&] { return m_frame.vertexCounts(); });
  }
  std::string text() {
    const std::string size = std::to_string(m_width) + " x " + std::to_string(m_height) + " pixels, ";
    try {
      const FrameStatistics now = statistics();
      return "<odis.Frame: " + size + std::to_string(now.samples) +
             " samples by now, samples_per_pixel=" + std::to_string(now.samplesPerPixel) +
             ", cells=" + std::to_string(now.cells) + ">";
    } catch (const Error& error) {
      return "<odis.Frame: " + size + error.what() + ">";
    }
  }
  Guide guide() {
    return callAlone(m_calls, [&] { return m_frame.guide(); });
  }
  bool guideIsFinal() {
    return callAlone(m_calls, [&] { return m_frame.guideIsFinal(); });
  }

 private:
  uint32_t pixels() const { return m_width * m_height; }

  Frame m_frame;
  uint32_t m_width, m_height;
  Calls m_calls;
};

void bindPass(nb::module_& module) {
  nb::enum_<OdisPassKind>(module, "PassKind", "What a pass is for.")
      .value("PILOT", ODIS_PASS_PILOT, "The first, unguided samples, which the first guide is made from.")
      .value("ORACLE", ODIS_PASS_ORACLE, "Samples that are no part of the image.")
      .value("GUIDED", ODIS_PASS_GUIDED, "The others.");
  nb::class_<Pass> pass(module, "FramePass", "What a frame asks the host to trace.");
  pass.def_prop_ro("kind", [](const Pass& pass) { return pass.described.kind; })
      .def_prop_ro(
          "wants_vertices", [](const Pass& pass) { return pass.described.wantsVertices; },
          "Whether the samples should come with their vertices.")
      .def_prop_ro("part_of_image", [](const Pass& pass) { return pass.described.partOfImage; })
      .def_prop_ro(
          "weights_later", [](const Pass& pass) { return pass.described.weightsLater; },
          "Whether Frame.sample_weights of the pass's samples are known only when it has ended, since\n"
          "they depend on how many samples each pixel will have.")
      .def_prop_ro(
          "seed", [](const Pass& pass) { return pass.described.seed; },
          "Seed of the random numbers that the samples are drawn with, in [0, 2^64).")
      .def_prop_ro(
          "stage_samples", [](const Pass& pass) { return pass.described.stageSamples; },
          "About how many samples all passes of this kind have, over all pixels: for progress.")
      .def_ro("guide", &Pass::guide, "What guides the samples; without cells where nothing was learned.");
  printAttributes(
      pass, {"kind", "wants_vertices", "part_of_image", "weights_later", "seed", "stage_samples", "guide"});
  nb::class_<FrameStatistics> statistics(module, "FrameStatistics", "Numbers of a frame.");
  statistics.def_ro("samples", &FrameStatistics::samples)
      .def_ro("samples_per_pixel", &FrameStatistics::samplesPerPixel, "That are asked for by now.")
      .def_ro("pilot_samples", &FrameStatistics::pilotSamples)
      .def_ro("not_finite", &FrameStatistics::notFinite, "Samples that counted as black.")
      .def_ro("pilot_vertices", &FrameStatistics::pilotVertices)
      .def_ro("cells", &FrameStatistics::cells)
      .def_ro("guide_bytes", &FrameStatistics::guideBytes)
      .def_ro("building_bytes", &FrameStatistics::buildingBytes, "Held at most while guides were built.")
      .def_ro("pilot_fraction", &FrameStatistics::pilotFraction,
              "Of the pilot's samples in the mean of the image's weights.")
      .def_ro("missing_samples", &FrameStatistics::missingSamples,
              "That passes asked for and did not get, interrupted ones not included.")
      .def_ro("passes_without_vertices", &FrameStatistics::passesWithoutVertices,
              "Passes that wanted vertices and got none, though their samples had been at surfaces.")
      .def_ro("guides_built", &FrameStatistics::guidesBuilt)
      .def_ro("predicted_variance_ratio", &FrameStatistics::predictedVarianceRatio,
              "Variance of a guided sample over that of an unguided one, as the pilot predicts it.")
      .def_ro("measured_cost_ratio", &FrameStatistics::measuredCostRatio,
              "Variance times cost of the first guided samples over the pilot's; 0: not measured.")
      .def_ro("guiding_given_up", &FrameStatistics::guidingGivenUp,
              "Whether samples are not guided any more, because that does not pay.");
  printAttributes(statistics, {"samples", "samples_per_pixel", "pilot_samples", "not_finite",
                               "pilot_vertices", "cells", "guide_bytes", "building_bytes", "pilot_fraction",
                               "missing_samples", "passes_without_vertices", "guides_built",
                               "predicted_variance_ratio", "measured_cost_ratio", "guiding_given_up"});
}

void bindPasses(nb::class_<ImageFrame>& frame) {
  frame
      .def("begin_pass", &ImageFrame::beginPass,
           "Begins the next pass; None when the image is complete or a pass was interrupted.")
      .def("samples", &ImageFrame::samples,
           R"(The samples that the pass asks for: `first` and `count` of each pixel, (height, width), uint32.

A pixel's samples are first, ..., first + count - 1.)")
      .def("add_samples", &ImageFrame::addSamples, "pixel"_a, "sample"_a, "value"_a, "rays"_a = nb::none(),
           "vertices"_a = nb::none(),
           R"(Hands over samples of the pass, in any order and in portions of any size; several threads may.

pixel, sample: uint32 of shape (count,); pixels are counted row by row.
value: float32 of shape (count, 3): what the path brought; what is not finite counts as black.
rays: uint32 of shape (count,): traced for it, camera ray and shadow rays included; None: unknown.
vertices: PathVertices of these samples, or a dict of its fields, if the pass wants them.
A sample that the pass did not ask for, or that comes twice, raises Error.)")
      .def("end_pass", &ImageFrame::endPass, "interrupted"_a = false,
           R"(Ends the pass: learns, builds the guide, settles what there is to settle.

An interrupted pass may lack samples; nothing is learned from it, and it is the last one. So is a pass whose
learning Ctrl-C calls off, which raises KeyboardInterrupt.)")
      .def("extend", &ImageFrame::extend, "samples_per_pixel"_a,
           R"(Asks for more samples per pixel between two passes; the number counts those of before.

Up to FrameOptions.most_samples_per_pixel the frame is then what it would be had it been asked for as many
from the beginning; beyond, the guide and the pixels' shares stay as they are. Raises Error where it is no
more than before or beyond 2^28 (INVALID_ARGUMENT), and within a pass, after an interrupted one, or before the
last one if the frame was asked for most_samples_per_pixel (INVALID_OPERATION).)");
}

void bindResults(nb::class_<ImageFrame>& frame) {
  frame
      .def_prop_ro(
          "pixel_values", &ImageFrame::pixelValues,
          "(height, width), float32: estimates of the pixels' luminance, from the pilot, where they\n"
          "lie in the frame; None before the pilot has ended.")
      .def("image", &ImageFrame::image,
           R"(The means of the pixels' samples, and their variances: two of (height, width, 3), float32.

Means are black where there are no samples, variances 0 where there are fewer than two.)")
      .def("sample_counts", &ImageFrame::sampleCounts,
           "The number of samples that each pixel has by now: (height, width), uint32.")
      .def("sample_weights", &ImageFrame::sampleWeights, "pixel"_a, "sample"_a,
           R"(Weights of samples in the image: (count,), float32.

pixel, sample: uint32 of shape (count,). Those of a pixel add up to the samples per pixel that are asked for
by now, however many it has, so that a film that splats may add all samples of all pixels by their weights.
Known in the pass already, but for passes with weights_later, and the same for all samples of a pixel in a
pass. A pixel outside of the frame, or a sample that its pixel never has, raises Error (INVALID_ARGUMENT).)")
      .def_prop_ro("statistics", &ImageFrame::statistics, "FrameStatistics by now.")
      .def_prop_ro("vertex_counts", &ImageFrame::vertexCounts, "VertexCounts of the vertices learned from.")
      .def_prop_ro("guide", &ImageFrame::guide, "The Guide of today; without cells before one is built.")
      .def_prop_ro("guide_is_final", &ImageFrame::guideIsFinal,
                   "Whether all further samples will be guided by the guide of today.");
}

void bindFiles(nb::class_<ImageFrame>& frame) {
  frame.def("__repr__", &ImageFrame::text)
      .def("save", &ImageFrame::save, "path"_a,
           R"(Writes all that the frame is, between two passes or within one. Raises Error (FILE).

What a tile of 16 x 16 pixels has that is not complete is left out: it is to be traced again.)")
      .def_static(
          "load", &ImageFrame::load, "path"_a, "model"_a = nb::none(), "context"_a = nb::none(),
          R"(The frame of a file, which goes on where it was; begin_pass() begins the rest of the pass.

model: the Model that the frame had; None: the networks that come with the library. Raises Error (FILE).)")
      .def_prop_rw("host_data", &ImageFrame::hostData, &ImageFrame::setHostData,
                   "bytes of the host's that are saved with the frame.");
}

}  // namespace

void bindFrame(nb::module_& module) {
  bindPass(module);
  nb::class_<ImageFrame> frame(module, "Frame", R"(An image from its first sample to its last.

    frame = odis.Frame(odis.FrameOptions(640, 480, samples_per_pixel=16))
    while (render_pass := frame.begin_pass()) is not None:
        first, count = frame.samples()
        ...  # traces those samples, guided by render_pass.guide
        frame.add_samples(pixel, sample, value, rays, vertices if render_pass.wants_vertices else None)
        frame.end_pass()
    mean, variance = frame.image()

Calls in the wrong order raise Error (INVALID_OPERATION). add_samples and samples may be called by several
threads at once, everything else by one at a time.)");
  frame.def(nb::init<const FrameOptions&, const LoggingContext*, const Builder*>(), "options"_a,
            "context"_a = nb::none(), "builder"_a = nb::none(),
            R"(builder: a GuideBuilder that the frame adds its vertices to, and that may hold those of
    earlier frames. Its own options apply, options.guide is ignored. Nothing else may use it until the
    frame has ended. None: the frame makes one.

Raises Error (INVALID_ARGUMENT) for an option out of its range.)");
  bindPasses(frame);
  bindResults(frame);
  bindFiles(frame);
}

}  // namespace odis::python
