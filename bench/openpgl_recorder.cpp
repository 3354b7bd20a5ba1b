// Writes what a renderer calls of Open PGL into the file OPENPGL_CALLS, for tests/openpgl to play again: all
// calls, or those of one path and of one vertex in OPENPGL_CALLS_EVERY. Loaded in front of a libopenpgl:
//   c++ -std=c++17 -O2 -shared -fPIC -Iintegrations/openpgl/include bench/openpgl_recorder.cpp -o recorder.so
//   OPENPGL_CALLS=cycles.calls LD_PRELOAD=./recorder.so odis-cycles cycles scene.xml
#include <dlfcn.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "../tests/openpgl/recorded_calls.h"

namespace {

using odis::test::RecordedCall;

std::mutex g_mutex;

void write(const std::string& records) {
  const std::lock_guard lock(g_mutex);
  static const char* const name = std::getenv("OPENPGL_CALLS");
  static FILE* const file = name ? std::fopen(name, "wb") : nullptr;
  if (!file || std::fwrite(records.data(), 1, records.size(), file) < records.size() || std::fflush(file)) {
    std::fprintf(stderr, "openpgl_recorder: OPENPGL_CALLS does not name a file that can be written\n");
    std::_Exit(2);
  }
}

// Whether the next of the paths, or of the vertices, is written.
bool isChosen(std::atomic<uint64_t>& count) {
  static const char* const every = std::getenv("OPENPGL_CALLS_EVERY");
  static const uint64_t n = every && std::atoi(every) > 0 ? uint64_t(std::atoi(every)) : 1;
  return count++ % n == 0;
}

template <class T>
void append(std::string& records, RecordedCall call, const T& value) {
  records += char(call);
  records.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// What a thread's path and its current vertex are so far.
struct Thread {
  std::vector<std::pair<RecordedCall, const PGLPathSegmentData*>> segments;
  std::deque<PGLPathSegmentData> copies;
  pgl_point3f position;
  std::string vertex;

  void endVertex() {
    static std::atomic<uint64_t> count;
    if (!vertex.empty() && isChosen(count)) write(vertex);
    vertex.clear();
  }
  void endPath() {
    static std::atomic<uint64_t> count;
    if (!isChosen(count)) return;
    std::string records;
    for (const auto& [call, segment] : segments) append(records, call, *segment);
    write(records + char(RecordedCall::kPath));
  }
};
thread_local Thread t_thread;

// The function of this name in the library behind this one.
template <class Function>
Function* behind(Function*, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define BEHIND(function) static auto* const next = behind(&function, #function)

extern "C" {

PGLPathSegmentData* pglPathSegmentStorageNextSegment(PGLPathSegmentStorage path) {
  BEHIND(pglPathSegmentStorageNextSegment);
  PGLPathSegmentData* segment = next(path);
  t_thread.segments.push_back({RecordedCall::kSegment, segment});
  return segment;
}
void pglPathSegmentStorageAddSegment(PGLPathSegmentStorage path, PGLPathSegmentData segment) {
  BEHIND(pglPathSegmentStorageAddSegment);
  t_thread.copies.push_back(segment);
  t_thread.segments.push_back({RecordedCall::kCopied, &t_thread.copies.back()});
  next(path, segment);
}
void pglPathSegmentStorageClear(PGLPathSegmentStorage path) {
  BEHIND(pglPathSegmentStorageClear);
  t_thread.segments.clear();
  t_thread.copies.clear();
  next(path);
}
void pglSampleStorageAddSamples(PGLSampleStorage samples, const PGLSampleData* data, size_t count) {
  BEHIND(pglSampleStorageAddSamples);
  t_thread.endVertex();
  t_thread.endPath();
  next(samples, data, count);
}
void pglFieldUpdate(PGLField field, PGLSampleStorage samples) {
  BEHIND(pglFieldUpdate);
  write(std::string(1, char(RecordedCall::kUpdate)));
  next(field, samples);
}

bool pglFieldInitSurfaceSamplingDistribution(PGLField field, PGLSurfaceSamplingDistribution distribution,
                                             pgl_point3f position, float* number, bool useParallax) {
  BEHIND(pglFieldInitSurfaceSamplingDistribution);
  t_thread.position = position;
  return next(field, distribution, position, number, useParallax);
}
void pglSurfaceSamplingDistributionApplyCosineProduct(PGLSurfaceSamplingDistribution distribution,
                                                      pgl_vec3f normal) {
  BEHIND(pglSurfaceSamplingDistributionApplyCosineProduct);
  t_thread.endVertex();
  append(t_thread.vertex, RecordedCall::kVertex, t_thread.position);
  t_thread.vertex.append(reinterpret_cast<const char*>(&normal), sizeof normal);
  next(distribution, normal);
}
float pglSurfaceSamplingDistributionPDF(PGLSurfaceSamplingDistribution distribution, pgl_vec3f direction) {
  BEHIND(pglSurfaceSamplingDistributionPDF);
  append(t_thread.vertex, RecordedCall::kPdf, direction);
  return next(distribution, direction);
}
float pglSurfaceSamplingDistributionSamplePDF(PGLSurfaceSamplingDistribution distribution,
                                              pgl_point2f numbers, pgl_vec3f& direction) {
  BEHIND(pglSurfaceSamplingDistributionSamplePDF);
  append(t_thread.vertex, RecordedCall::kSample, numbers);
  return next(distribution, numbers, direction);
}

}  // extern "C"
