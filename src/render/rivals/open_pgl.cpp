#include "render/rivals/open_pgl.h"

#include <openpgl/cpp/OpenPGL.h>
#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <cstring>

#include "render/sampler/sampler.h"

namespace odis::render {

namespace {

namespace pgl = openpgl::cpp;

pgl_vec3f toPgl(const Vec3& v) {
  return {v.x, v.y, v.z};
}
pgl_vec3f toPgl(const Float3& v) {
  return {v.x, v.y, v.z};
}

// As Cycles uses the library: half of the draws for the guide, an update after the first sample and then
// after every fourth, as soon as there are enough samples to fit, up to the 128th.
constexpr float kBsdfFraction = 0.5f;
constexpr uint32_t kSamplesPerUpdate = 4, kTrainingSamples = 128;
constexpr size_t kFewestSamples = 1024;
// As the library's own PathSegmentStorage prepares samples.
constexpr float kLeastPdf = 0.1f, kFarthest = 1e6f;

PGL_DEVICE_TYPE deviceType() {
  return __builtin_cpu_supports("avx2") ? PGL_DEVICE_TYPE_CPU_8 : PGL_DEVICE_TYPE_CPU_4;
}

// The library chooses among neighbouring mixtures by a random number: one that the place determines.
float randomOf(const Vec3& position) {
  uint64_t hash = 0;
  for (int a = 0; a < 3; ++a) {
    uint32_t bits;
    std::memcpy(&bits, &position[a], sizeof(bits));
    hash = mixBits(hash ^ bits);
  }
  return float(hash >> 40) * 0x1p-24f;
}

// A place for the distribution at a vertex, of the surfaces' field or of the media's.
template <class Distribution>
class PglVertex final : public DirectionSampler {
 public:
  explicit PglVertex(const pgl::Field* field) : m_distribution(field) {}

  // Says whether there is a distribution.
  bool prepare(const pgl::Field& field, const Vec3& position) {
    float random = randomOf(position);
    return m_distribution.Init(&field, toPgl(position), random);
  }
  Distribution& distribution() { return m_distribution; }

  SamplingMap<float>::Sample sample(const Vec2& u) const override {
    pgl_vec3f wi;
    const float pdf = m_distribution.SamplePDF({u.x, u.y}, wi);
    return {{wi.x, wi.y, wi.z}, pdf};
  }
  float pdf(const Vec3& wi) const override { return m_distribution.PDF(toPgl(wi)); }
  float bsdfFraction() const override { return kBsdfFraction; }

 private:
  Distribution m_distribution;
};
using PglSurfaceVertex = PglVertex<pgl::SurfaceSamplingDistribution>;
using PglVolumeVertex = PglVertex<pgl::VolumeSamplingDistribution>;

// A thread's places, which vertices take in turns.
template <class Vertex>
class PglVertices {
 public:
  Vertex& next(const pgl::Field* field) {
    std::unique_ptr<Vertex>& vertex = m_of[m_next++ % DirectionGuide::kVerticesAtOnce];
    if (!vertex) vertex = std::make_unique<Vertex>(field);
    return *vertex;
  }

 private:
  std::array<std::unique_ptr<Vertex>, DirectionGuide::kVerticesAtOnce> m_of;
  size_t m_next = 0;
};

class OpenPgl final : public Rival {
 public:
  OpenPgl() : m_device(deviceType()) {
    pgl::FieldConfig config;
    config.Init(PGL_SPATIAL_STRUCTURE_KDTREE, PGL_DIRECTIONAL_DISTRIBUTION_PARALLAX_AWARE_VMM, true);
    m_field = std::make_unique<pgl::Field>(&m_device, config);
  }

  const DirectionSampler* at(const Vec3& position, const Vec3& normal,
                             bool scattersBothSides) const override {
    if (!m_trained) return nullptr;
    PglSurfaceVertex& vertex = m_onSurfaces.local().next(m_field.get());
    if (!vertex.prepare(*m_field, position)) return nullptr;
    // What transmits receives light from both sides.
    if (!scattersBothSides) vertex.distribution().ApplyCosineProduct(toPgl(normal));
    return &vertex;
  }

  const DirectionSampler* inMedium(const Vec3& position, const Vec3& wo, float meanCosine) const override {
    if (!m_trained) return nullptr;
    PglVolumeVertex& vertex = m_inMedia.local().next(m_field.get());
    if (!vertex.prepare(*m_field, position)) return nullptr;
    if (meanCosine != 0) vertex.distribution().ApplySingleLobeHenyeyGreensteinProduct(toPgl(-wo), meanCosine);
    return &vertex;
  }

  Combination combination() const override { return Combination::all; }

  uint32_t iterationEnd(uint32_t done, uint32_t spp) const override {
    if (done >= kTrainingSamples) return spp;
    return std::min(done == 0 ? 1 : done + kSamplesPerUpdate, spp);
  }

  void learn(std::span<const std::vector<PathVertex>> tiles, uint32_t) override {
    std::vector<pgl::SampleData> samples;
    for (const std::vector<PathVertex>& tile : tiles)
      for (const PathVertex& v : tile) {
        const float radiance = luminance(v.radiance);
        if (!isUsable(v) || !(radiance > 0) || !(v.distance > 0)) continue;
        pgl::SampleData& sample = samples.emplace_back();
        sample.position = toPgl(v.position);
        sample.direction = toPgl(v.wi);
        sample.pdf = std::max(survivingPdf(v), kLeastPdf);
        sample.weight = radiance / sample.pdf;
        sample.distance = std::min(v.distance, kFarthest);
        sample.flags = isInMedium(v) ? pgl::SampleData::EInsideVolume : 0;
      }
    if (!samples.empty()) m_samples.AddSamples(samples.data(), samples.size());
    m_peak = std::max(m_peak, sampleCount());
  }

  void endIteration() override {
    if (sampleCount() < kFewestSamples) return;
    m_field->Update(m_samples);
    m_samples.Clear();
    m_trained = true;
  }

  // Of the samples; the library does not tell what its field takes.
  uint64_t bytes() const override { return m_peak * sizeof(pgl::SampleData); }

 private:
  size_t sampleCount() const { return m_samples.GetSizeSurface() + m_samples.GetSizeVolume(); }

  pgl::Device m_device;
  std::unique_ptr<pgl::Field> m_field;
  pgl::SampleStorage m_samples;
  mutable tbb::enumerable_thread_specific<PglVertices<PglSurfaceVertex>> m_onSurfaces;
  mutable tbb::enumerable_thread_specific<PglVertices<PglVolumeVertex>> m_inMedia;
  bool m_trained = false;
  size_t m_peak = 0;
};

}  // namespace

bool hasOpenPgl() {
  return true;
}

std::unique_ptr<Rival> makeOpenPgl() {
  return std::make_unique<OpenPgl>();
}

}  // namespace odis::render
