#include "field.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

namespace {

// A guide is built again when it can know this many times as many vertices; until then as many more are kept.
constexpr size_t kGrowth = 2;
// Training is over when this many vertices are known, or this many times those of the first update: the host need
// not record any more. With twice as many the error of small images is the same at four samples per pixel, which take a
// tenth longer, and 3 % lower at sixteen.
constexpr size_t kEnough = 8, kEnoughVertices = 100'000;
// Up to this many vertices are kept between two updates, however few are known.
constexpr size_t kFewestKept = size_t(1) << 16;
// What a host is told then: more than the training samples of any setting.
constexpr size_t kTrained = 1u << 30;
// Nothing is guided where more than this part of the image's variance is predicted to stay. Fewer first vertices don't
// predict it well enough.
constexpr float kMostVarianceLeft = 0.98f;
constexpr size_t kFewestToPredict = 10'000;

// Hosts call C functions, which don't throw: a guide that can't be built is a warning, and rendering goes on.
template <class Body>
bool attempt(const Body& body) {
  try {
    body();
    return true;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "odis: %s\n", e.what());
    return false;
  }
}

PGLString copyOf(const std::string& text) {
  PGLString copy{new char[text.size() + 1], text.size()};
  std::memcpy(copy.m_str, text.c_str(), text.size() + 1);
  return copy;
}

}  // namespace

void Field::update(SampleStorage& samples) {
  const odis::ArrayView<const odis::PathVertex> vertices = samples.vertices();
  if (vertices.empty()) return;
  ++m_updates;
  // Until the first update all directions are the BSDF's, unless a guide was loaded.
  const bool first = !m_builder, loaded = first && m_guide;
  if (first) m_builder.emplace();
  first ? m_builder->add(vertices) : m_builder->addGuided(vertices);
  m_vertices += vertices.size();
  if (first) {
    m_firstVertices = m_vertices;
    show(m_builder->build());
    if (!loaded) judge(vertices);
  } else if (m_vertices >= kGrowth * m_builtFrom) {
    show(m_builder->rebuild(*m_guide));
  }
  // Thinning out leaves between one half of this and all.
  samples.keepAtMost(std::max(kGrowth * m_vertices, kFewestKept));
}

void Field::show(odis::Guide guide) {
  m_guide = std::move(guide);
  m_view = m_guide->view();
  m_builtFrom = m_vertices;
}

void Field::judge(odis::ArrayView<const odis::PathVertex> vertices) {
  // Samples that came without paths don't tell what they are worth.
  const auto isKnown = [](const odis::PathVertex& v) { return !std::isnan(v.indirect); };
  const bool predicted = size_t(std::count_if(vertices.begin(), vertices.end(), isKnown)) >= kFewestToPredict;
  m_gains = !predicted || m_guide->predictedVarianceRatio() < kMostVarianceLeft;
  m_unguided = {odis::CellGrid(m_view.grid), vertices};
}

void Field::reset() {
  *this = {};
}

size_t Field::iteration() const {
  const bool enough =
      m_firstVertices > 0 && m_vertices >= std::min(kEnough * m_firstVertices, kEnoughVertices);
  return enough || !m_gains ? kTrained : m_updates;
}

void Field::save(const char* file) const {
  if (!m_guide) throw std::runtime_error("a field that was never updated can't be stored");
  m_guide->save(file);
}

void Field::load(const char* file) {
  show(odis::Guide::load(file));
  m_updates = kTrained;
}

std::string Field::statistics() const {
  if (!m_gains) return "ODIS: nothing is guided, as the first paths tell that it would gain little";
  return "ODIS: " + std::to_string(m_view.cellCount) + " cells from " + std::to_string(m_vertices) +
         " vertices in " + std::to_string(m_updates) + " updates, " + std::to_string(m_unguided.size()) +
         " places left to BSDFs";
}

// The types behind two more handles.
struct Device {};
struct FieldStatistics {
  std::string text;
};

extern "C" {

void pglReleaseString(PGLString string) {
  delete[] string.m_str;
}

PGLDevice pglNewDevice(PGL_DEVICE_TYPE, size_t) {
  return new Device;
}
void pglReleaseDevice(PGLDevice device) {
  delete device;
}
void pglFieldArgumentsSetDefaults(PGLFieldArguments& arguments, PGL_SPATIAL_STRUCTURE_TYPE spatial,
                                  PGL_DIRECTIONAL_DISTRIBUTION_TYPE directional, bool, size_t) {
  // Hosts write into what these point to.
  static thread_local PGLKDTreeArguments tree;
  static thread_local char directionalArguments[256];
  arguments = {spatial, &tree, directional, directionalArguments, true, {}};
}
PGLField pglDeviceNewField(PGLDevice, PGLFieldArguments) {
  return new Field;
}
PGLField pglDeviceNewFieldFromFile(PGLDevice, const char* file) {
  auto field = std::make_unique<Field>();
  return attempt([&] { field->load(file); }) ? field.release() : nullptr;
}
void pglReleaseField(PGLField field) {
  delete field;
}
bool pglFieldStoreToFile(PGLField field, const char* file) {
  return attempt([&] { field->save(file); });
}
size_t pglFieldGetIteration(PGLField field) {
  return field->iteration();
}
void pglFieldSetSceneBounds(PGLField field, pgl_box3f bounds) {
  field->bounds = bounds;
}
pgl_box3f pglFieldGetSceneBounds(PGLField field) {
  return field->bounds;
}
void pglFieldUpdate(PGLField field, PGLSampleStorage samples) {
  attempt([&] { field->update(*samples); });
}
void pglFieldUpdateSurface(PGLField field, PGLSampleStorage samples) {
  pglFieldUpdate(field, samples);
}
void pglFieldUpdateVolume(PGLField, PGLSampleStorage) {}  // the update of surfaces takes all samples
void pglFieldReset(PGLField field) {
  field->reset();
}
bool pglFieldValidate(PGLField) {
  return true;
}
bool pglFieldCompare(PGLField a, PGLField b) {
  const odis::GuideView &ofA = a->view(), &ofB = b->view();
  const size_t shares = size_t(ofA.cellCount) * odis::kMapShares;
  return ofA.cellCount == ofB.cellCount &&
         (shares == 0 || std::memcmp(ofA.maps, ofB.maps, shares * sizeof(uint16_t)) == 0);
}

PGLFieldStatistics pglFieldGetSurfaceStatistics(PGLField field) {
  return new FieldStatistics{field->statistics()};
}
PGLFieldStatistics pglFieldGetVolumeStatistics(PGLField) {
  return new FieldStatistics{"ODIS: volumes are counted with surfaces"};
}
void pglReleaseFieldStatistics(PGLFieldStatistics statistics) {
  delete statistics;
}
PGLString pglFieldStatisticsToString(PGLFieldStatistics statistics) {
  return copyOf(statistics->text);
}
PGLString pglFieldStatisticsHeaderCSVString(PGLFieldStatistics) {
  return copyOf("statistics");
}
PGLString pglFieldStatisticsToCSVString(PGLFieldStatistics statistics) {
  return copyOf(statistics->text);
}

}  // extern "C"
