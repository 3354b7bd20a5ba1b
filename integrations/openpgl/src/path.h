// A path under way on one thread: the segments that a host fills in, and what is made of them.
#pragma once

#include <odis/odis.hpp>

#include <deque>
#include <vector>

#include "openpgl/openpgl.h"
#include "samples.h"

// The type behind Open PGL's handle, which has no namespace. Threads have one each, on cache lines of its own.
struct alignas(64) PathSegmentStorage {
 public:
  // Hosts keep pointers to segments until the path is cleared. A segment that has no direction yet has the
  // density 0.
  PGLPathSegmentData* next();
  void add(const PGLPathSegmentData& segment);
  void addSample(const PGLSampleData& sample);
  void clear();

  // Makes the path's vertices and samples, if it is to be kept; returns how many of the latter there are.
  size_t prepare();
  // What decides from now on which paths are kept.
  void follow(std::shared_ptr<const Thinning> thinning) { m_thinning = std::move(thinning); }
  // Valid until the next call of prepare().
  odis::ArrayView<const odis::PathVertex> vertices() const { return m_vertices; }
  const std::vector<PGLSampleData>& samples() const { return m_samples; }
  const std::vector<PGLZeroValueSampleData>& zeroSamples() const { return m_zeroSamples; }
  // What the path brought to its pixel.
  pgl_vec3f radiance() const;
  size_t size() const { return m_count; }
  bool isValid() const;

  float maxDistance = 1e6f;

 private:
  bool scatters(size_t segment) const;
  void recordArrival(uint32_t path, size_t segment);
  void record(uint32_t path, size_t segment);
  void addSampleOf(const odis::PathVertex& vertex);

  std::deque<PGLPathSegmentData> m_segments;  // m_count of them are in use
  size_t m_count = 0;
  std::vector<PGLSampleData> m_given;  // by the host, beside the path
  odis::PathRecorder m_recorder;
  odis::ArrayView<const odis::PathVertex> m_vertices;
  std::shared_ptr<const Thinning> m_thinning;
  std::vector<PGLSampleData> m_samples;
  std::vector<PGLZeroValueSampleData> m_zeroSamples;
};

namespace odis::openpgl_interface {

// What was prepared last on this thread, so that samples that come back from the host are known to be these.
PathSegmentStorage* preparedLast();

}  // namespace odis::openpgl_interface
