// ODIS's interface in C++17: odis/odis.h with exceptions in the place of codes and objects that release
// themselves, and, inline, what a host does at every vertex. Header-only; what the functions do is said in
// odis/odis.h.
//
//   odis::FrameOptions options;
//   options.width = 1280, options.height = 720;
//   odis::Frame frame(options);
//   while (const odis::FramePass* pass = frame.beginPass()) {
//     for each pixel, in any order, on any number of threads:
//       for each sample of frame.samples(pixel):
//         trace a path, guided by *pass->guide (odis/guided_vertex.h);
//         record its vertices with a PathRecorder (odis/events.h) if frame.wantsVertices(pixel)
//       frame.add(samples, vertices);  // of one path, of a tile, of everything
//     frame.endPass();
//   }
//   image[pixel] = frame.mean(pixel).color;
#pragma once

#include "odis/cpp17.h"  // first of all

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "odis/events.h"
#include "odis/guided_vertex.h"
#include "odis/odis.h"
#include "odis/path_vertex.h"
#include "odis/pixel_sums.h"

namespace odis {

using ContextOptions = OdisContextOptions;
using LightParts = OdisLightParts;
using Setting = OdisSetting;
using FramePass = OdisFramePass;
using SampleRange = OdisSampleRange;
using FrameSample = OdisFrameSample;
using FrameStatistics = OdisFrameStatistics;
using PathIdentity = OdisPathIdentity;
using SurfaceEvent = OdisSurfaceEvent;
using MediumEvent = OdisMediumEvent;
using EmissionEvent = OdisEmissionEvent;
using LightEvent = OdisLightEvent;
using BounceEvent = OdisBounceEvent;

// What every function here throws when the library refuses.
class Error : public std::runtime_error {
 public:
  Error(OdisError code, const std::string& message) : std::runtime_error(message), m_code(code) {}
  OdisError code() const { return m_code; }

 private:
  OdisError m_code;
};

// Throws this thread's error, if there is one.
inline void throwError() {
  const char* message = nullptr;
  const OdisError code = odisGetError(&message);
  if (code != ODIS_ERROR_NONE) throw Error(code, message);
}

// The answer of a function of the library, which fails with `failed`, too; throws the function's error. An error
// that a function in C left and nobody asked for is forgotten: it is not this function's.
template <class Answer, class Call>
Answer checked(Answer failed, const Call& call) {
  odisGetError(nullptr);
  const Answer answer = call();
  if (answer == failed) throwError();
  return answer;
}
template <class Call>
void orThrow(const Call& call) {
  checked(false, call);
}
// The pointer or the handle that a function returns, NULL where it fails.
template <class Call>
auto made(const Call& call) {
  return checked(decltype(call())(nullptr), call);
}

// The table of what is set by name.
inline std::vector<Setting> settings() {
  std::vector<Setting> all(odisGetSettingCount());
  for (size_t i = 0; i < all.size(); ++i) orThrow([&] { return odisGetSetting(i, &all[i]); });
  return all;
}
// The value that a text of settings gives to one of them, or its default.
inline std::string readSetting(const std::string& settings, const std::string& name) {
  return made([&] { return odisReadSetting(settings.c_str(), name.c_str()); });
}

// A reference to an object of the library: copies share it.
template <class Object, void (*retain)(Object), void (*release)(Object)>
class Handle {
 public:
  Handle(const Handle& other) : m_object(other.m_object) { retain(m_object); }
  Handle(Handle&& other) noexcept : m_object(std::exchange(other.m_object, nullptr)) {}
  Handle& operator=(Handle other) noexcept {
    std::swap(m_object, other.m_object);
    return *this;
  }
  ~Handle() { release(m_object); }
  Object get() const { return m_object; }

 protected:
  // Takes over a reference that a function of the library returned; throws its error where it returned none.
  explicit Handle(Object object) : m_object(object) {
    if (!object) throwError();
  }

 private:
  Object m_object;
};

class Context : public Handle<OdisContext, odisRetainContext, odisReleaseContext> {
 public:
  explicit Context(const ContextOptions& options = {})
      : Handle(made([&] { return odisNewContext(&options); })) {}
  // The one that objects are made in which are told of none, with the defaults.
  static const Context& shared() {
    static const Context context;
    return context;
  }
  uint64_t memoryUse() const { return odisGetMemoryUse(get()); }
};

class Model : public Handle<OdisModel, odisRetainModel, odisReleaseModel> {
 public:
  explicit Model(OdisModel model) : Handle(model) {}
  // The networks that come with the library.
  Model() : Model(Context::shared()) {}
  explicit Model(const Context& context) : Handle(made([&] { return odisNewModel(context.get()); })) {}
  // The networks of a file of weights.
  static Model load(const std::string& path, const Context& context = Context::shared()) {
    return Model(made([&] { return odisNewModelFromFile(context.get(), path.c_str()); }));
  }
  static Model parse(const void* bytes, size_t size, const Context& context = Context::shared()) {
    return Model(made([&] { return odisNewModelFromMemory(context.get(), bytes, size); }));
  }
};

// OdisGuideOptions with owners in place of pointers.
struct GuideOptions {
  std::optional<Model> model = {};  // none: the networks that come with the library
  uint32_t lightGroups = OdisGuideOptions().lightGroups;
  std::vector<LightParts> lightParts = {};
  OdisProgressFunction progressFunction = nullptr;
  void* progressUser = nullptr;
  std::string settings = {};

  // Sets more by name; wins over what was set before.
  GuideOptions& set(const std::string& text) {
    settings += " " + text;
    return *this;
  }
  // Valid as long as this object stays as it is.
  OdisGuideOptions flat() const {
    OdisGuideOptions options;
    if (model) options.model = model->get();
    options.lightGroups = lightGroups;
    options.lightParts = lightParts.data();
    options.lightPartCount = lightParts.size();
    options.progressFunction = progressFunction;
    options.progressUser = progressUser;
    options.settings = settings.c_str();
    return options;
  }
};

// Describes vertices that lie side by side.
inline OdisPathVertices describe(ArrayView<const PathVertex> vertices) {
  OdisPathVertices described;
  if (!vertices.empty()) odisDescribeVertices(&described, vertices.data(), vertices.size());
  return described;
}

// Stands for a path that is not recorded: its events are ignored.
inline constexpr uint32_t kNoPath = UINT32_MAX;

class PathRecorder : public Handle<OdisRecorder, odisRetainRecorder, odisReleaseRecorder> {
 public:
  explicit PathRecorder(const Context& context = Context::shared())
      : Handle(made([&] { return odisNewRecorder(context.get()); })) {}

  uint32_t begin(const PathIdentity& identity) {
    return checked(UINT32_MAX, [&] { return odisBeginPath(get(), &identity); });
  }
  void surface(uint32_t path, const SurfaceEvent& e) { record(path, odisRecordSurface, &e); }
  void medium(uint32_t path, const MediumEvent& e) { record(path, odisRecordMedium, &e); }
  void attenuation(uint32_t path, const Float3& factor) { record(path, odisRecordAttenuation, &factor); }
  void escape(uint32_t path) { record(path, odisRecordEscape); }
  void emission(uint32_t path, const EmissionEvent& e) { record(path, odisRecordEmission, &e); }
  void cached(uint32_t path, const Float3& radiance) { record(path, odisRecordCachedRadiance, &radiance); }
  void survived(uint32_t path, float probability) { record(path, odisRecordSurvival, probability); }
  void light(uint32_t path, const LightEvent& e) { record(path, odisRecordLight, &e); }
  void lightHidden(uint32_t path) { record(path, odisRecordLightHidden); }
  void bounce(uint32_t path, const BounceEvent& e) { record(path, odisRecordBounce, &e); }
  // Closes all paths; their vertices stay until the next begin().
  ArrayView<const PathVertex> finish() {
    size_t count = 0;
    const PathVertex* vertices = odisFinishPaths(get(), &count);
    require(vertices);
    return {vertices, count};
  }

 private:
  template <class Function, class... Event>
  void record(uint32_t path, const Function& function, Event... event) {
    if (path != kNoPath) require(function(get(), path, event...));
  }
  static void require(bool succeeded) {
    if (!succeeded) throwError();
  }
};

class Guide : public Handle<OdisGuide, odisRetainGuide, odisReleaseGuide> {
 public:
  explicit Guide(OdisGuide guide) : Handle(guide) {}
  static Guide load(const std::string& path, const Context& context = Context::shared()) {
    return Guide(made([&] { return odisLoadGuide(context.get(), path.c_str()); }));
  }
  void save(const std::string& path) const {
    orThrow([&] { return odisSaveGuide(get(), path.c_str()); });
  }

  // Valid as long as a reference to the guide is held.
  GuideView view() const {
    GuideView view;
    orThrow([&] { return odisGetGuideView(get(), &view); });
    return view;
  }
  uint64_t bytes() const {
    return checked(uint64_t(0), [&] { return odisGetGuideBytes(get()); });
  }
  float predictedVarianceRatio() const {
    return checked(1.0f, [&] { return odisGetPredictedVarianceRatio(get()); });
  }
};

class GuideBuilder : public Handle<OdisGuideBuilder, odisRetainGuideBuilder, odisReleaseGuideBuilder> {
 public:
  explicit GuideBuilder(const GuideOptions& options = {}, const Context& context = Context::shared())
      : GuideBuilder(made([&] {
          const OdisGuideOptions flat = options.flat();
          return odisNewGuideBuilder(context.get(), &flat);
        })) {}

  // A builder that was saved, with the model that it had.
  static GuideBuilder load(const std::string& path, const std::optional<Model>& model = std::nullopt,
                           const Context& context = Context::shared()) {
    return GuideBuilder(made(
        [&] { return odisLoadGuideBuilder(context.get(), path.c_str(), model ? model->get() : nullptr); }));
  }
  void save(const std::string& path) const {
    orThrow([&] { return odisSaveGuideBuilder(get(), path.c_str()); });
  }

  // Vertices of unguided paths, and of guided ones.
  void add(ArrayView<const PathVertex> vertices) { add(describe(vertices)); }
  void add(const OdisPathVertices& vertices) {
    orThrow([&] { return odisAddVertices(get(), &vertices, false); });
  }
  void addGuided(ArrayView<const PathVertex> vertices) { addGuided(describe(vertices)); }
  void addGuided(const OdisPathVertices& vertices) {
    orThrow([&] { return odisAddVertices(get(), &vertices, true); });
  }
  Guide build(ArrayView<const float> pixelValues = {}) const {
    return Guide(made([&] { return odisBuildGuide(get(), pixelValues.data(), pixelValues.size()); }));
  }
  Guide rebuild(const Guide& previous) const {
    return Guide(made([&] { return odisRebuildGuide(get(), previous.get()); }));
  }

  VertexCounts vertexCounts() const {
    VertexCounts counts;
    orThrow([&] { return odisGetVertexCounts(get(), &counts); });
    return counts;
  }
  uint64_t bytes() const {
    return checked(uint64_t(0), [&] { return odisGetGuideBuilderBytes(get()); });
  }

  // Several builders: an id for what is added to this one, and the parts of others.
  void setPartId(uint64_t id) {
    orThrow([&] { return odisSetPartId(get(), id); });
  }
  void merge(const std::vector<GuideBuilder>& others) {
    std::vector<OdisGuideBuilder> builders;
    for (const GuideBuilder& other : others) builders.push_back(other.get());
    orThrow([&] { return odisMergeGuideBuilders(get(), builders.data(), builders.size()); });
  }

  // From frame to frame.
  void fade(float weight) {
    orThrow([&] { return odisFadeVertices(get(), weight); });
  }
  void forget() {
    orThrow([&] { return odisForgetVertices(get()); });
  }
  void setBounds(const Float3& lower, const Float3& upper) {
    orThrow([&] { return odisSetBounds(get(), &lower, &upper); });
  }

 private:
  explicit GuideBuilder(OdisGuideBuilder builder) : Handle(builder) {}
};

// OdisFrameOptions with owners in place of pointers.
struct FrameOptions {
  uint32_t width = 0, height = 0;
  uint32_t samplesPerPixel = OdisFrameOptions().samplesPerPixel;
  uint32_t mostSamplesPerPixel = OdisFrameOptions().mostSamplesPerPixel;
  uint64_t seed = OdisFrameOptions().seed;
  bool keepPixelMeans = OdisFrameOptions().keepPixelMeans;
  uint32_t tileOffsetX = 0, tileOffsetY = 0;
  GuideOptions guide = {};                   // of a frame without a builder of the host's
  std::optional<GuideBuilder> builder = {};  // with its own options: those of `guide` have no effect
  std::string settings = {};

  // Sets more by name; wins over what was set before.
  FrameOptions& set(const std::string& text) {
    settings += " " + text;
    return *this;
  }
  // Valid as long as this object and that of `guide`, this->guide.flat(), stay as they are.
  OdisFrameOptions flat(const OdisGuideOptions& flatGuide) const {
    OdisFrameOptions options;
    options.width = width;
    options.height = height;
    options.samplesPerPixel = samplesPerPixel;
    options.mostSamplesPerPixel = mostSamplesPerPixel;
    options.seed = seed;
    options.keepPixelMeans = keepPixelMeans;
    options.tileOffsetX = tileOffsetX;
    options.tileOffsetY = tileOffsetY;
    if (builder)
      options.builder = builder->get();
    else
      options.guide = &flatGuide;
    options.settings = settings.c_str();
    return options;
  }
};

class Frame : public Handle<OdisFrame, odisRetainFrame, odisReleaseFrame> {
 public:
  explicit Frame(const FrameOptions& options, const Context& context = Context::shared())
      : Frame(made([&] {
          const OdisGuideOptions guide = options.guide.flat();
          const OdisFrameOptions flat = options.flat(guide);
          return odisNewFrame(context.get(), &flat);
        })) {}

  // A frame that was saved, with the model that it had; it goes on where it was.
  static Frame load(const std::string& path, const std::optional<Model>& model = std::nullopt,
                    const Context& context = Context::shared()) {
    return Frame(
        made([&] { return odisLoadFrame(context.get(), path.c_str(), model ? model->get() : nullptr); }));
  }
  void save(const std::string& path) const {
    orThrow([&] { return odisSaveFrame(get(), path.c_str()); });
  }

  // Bytes of the host's that are saved with the frame; valid until they are set again.
  void setHostData(ArrayView<const uint8_t> bytes) {
    orThrow([&] { return odisSetFrameHostData(get(), bytes.data(), bytes.size()); });
  }
  ArrayView<const uint8_t> hostData() const {
    size_t size = 0;
    const auto* bytes = made([&] { return odisGetFrameHostData(get(), &size); });
    return {static_cast<const uint8_t*>(bytes), size};
  }

  // Tells another function of progress from now on.
  void setProgress(OdisProgressFunction function, void* user = nullptr) {
    orThrow([&] { return odisSetFrameProgress(get(), function, user); });
  }

  // Null when the image is complete, or a pass was interrupted. Valid until the pass ends.
  const FramePass* beginPass() {
    return checked(false, [&] { return odisBeginPass(get(), m_pass.get()); }) ? m_pass.get() : nullptr;
  }
  SampleRange samples(uint32_t pixel) const {
    SampleRange range;
    orThrow([&] { return odisGetSamples(get(), pixel, &range); });
    return range;
  }
  bool wantsVertices(uint32_t pixel) const {
    return checked(false, [&] { return odisWantsVertices(get(), pixel); });
  }
  ArrayView<const float> pixelValues() const {
    const auto* values = made([&] { return odisGetPixelValues(get()); });
    return {values, values ? m_pixels : 0};
  }
  void add(ArrayView<const FrameSample> samples, ArrayView<const PathVertex> vertices = {}) {
    add(samples, describe(vertices));
  }
  void add(ArrayView<const FrameSample> samples, const OdisPathVertices& vertices) {
    orThrow([&] { return odisAddSamples(get(), samples.data(), samples.size(), &vertices); });
  }
  void endPass(bool interrupted = false) {
    orThrow([&] { return odisEndPass(get(), interrupted); });
  }
  // endPass() in two steps, which leave the host's thread free in between.
  void startEndPass(bool interrupted = false) {
    orThrow([&] { return odisStartEndPass(get(), interrupted); });
  }
  void waitForPass() {
    orThrow([&] { return odisWaitForPass(get()); });
  }
  // Asks for more samples per pixel, so many in all.
  void extend(uint32_t samplesPerPixel) {
    orThrow([&] { return odisExtendFrame(get(), samplesPerPixel); });
  }
  bool guideIsFinal() const {
    return checked(false, [&] { return odisGuideIsFinal(get()); });
  }

  float sampleWeight(uint32_t pixel, uint32_t sample) const {
    return checked(0.0f, [&] { return odisGetSampleWeight(get(), pixel, sample); });
  }
  PixelMean mean(uint32_t pixel) const {
    PixelMean mean;
    orThrow([&] { return odisGetPixelMean(get(), pixel, &mean); });
    return mean;
  }
  uint32_t sampleCount(uint32_t pixel) const {
    return checked(0u, [&] { return odisGetSampleCount(get(), pixel); });
  }
  FrameStatistics statistics() const {
    FrameStatistics statistics;
    orThrow([&] { return odisGetFrameStatistics(get(), &statistics); });
    return statistics;
  }
  VertexCounts vertexCounts() const {
    VertexCounts counts;
    orThrow([&] { return odisGetFrameVertexCounts(get(), &counts); });
    return counts;
  }
  Guide guide() const {
    return Guide(made([&] { return odisGetFrameGuide(get()); }));
  }
  ArrayView<const PixelSums> pilotImage() const {
    return {made([&] { return odisGetPilotImage(get()); }), m_pixels};
  }
  std::vector<PathVertex> pilotVertices() const {
    const auto copy = [this](PathVertex* vertices, size_t capacity) {
      return checked(size_t(0), [&] { return odisGetPilotVertices(get(), vertices, capacity); });
    };
    std::vector<PathVertex> vertices(copy(nullptr, 0));
    if (!vertices.empty()) copy(vertices.data(), vertices.size());
    return vertices;
  }

 private:
  explicit Frame(OdisFrame frame)
      : Handle(frame), m_pixels(pixelsOf(statistics())), m_pass(std::make_shared<FramePass>()) {}
  static size_t pixelsOf(const FrameStatistics& s) { return size_t(s.width) * s.height; }

  size_t m_pixels;
  std::shared_ptr<FramePass> m_pass;
};

}  // namespace odis
