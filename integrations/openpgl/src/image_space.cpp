// Estimates of pixels, which hosts compare what a path may still bring with.
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "vectors.h"
#include "volume_scatter.h"

// The type behind Open PGL's handle.
struct ImageSpaceGuidingBuffer {
 public:
  explicit ImageSpaceGuidingBuffer(const PGLImageSpaceGuidingBufferConfig& config)
      : m_width(config.resolution.x > 0 ? uint32_t(config.resolution.x) : 0),
        m_height(config.resolution.y > 0 ? uint32_t(config.resolution.y) : 0),
        m_sums(size_t(m_width) * m_height) {
    if (config.vspEstimate) m_scatter.emplace(config.vspType, m_sums.size());
  }

  void add(const pgl_point2i& pixel, const PGLImageSpaceSample& sample) {
    const odis::Float3 contribution = odis::openpgl_interface::toOdis(sample.contribution);
    const bool finite =
        std::isfinite(contribution.x) && std::isfinite(contribution.y) && std::isfinite(contribution.z);
    if (!contains(pixel) || !finite) return;
    odis::addSample(m_sums[indexOf(pixel)], contribution, 0);
    if (m_scatter) m_scatter->add(indexOf(pixel), !sample.IsSurfaceEvent(), odis::luminance(contribution));
  }
  void update() {
    m_values = odis::estimatePixelValues(m_sums, m_width);
    if (m_scatter) m_scatterProbabilities = m_scatter->estimate(m_width);
  }
  void reset() {
    m_sums.assign(m_sums.size(), {});
    m_values.clear();
    if (m_scatter) m_scatter->forget();
  }
  bool isReady() const { return !m_values.empty(); }
  float estimate(const pgl_point2i& pixel) const {
    return contains(pixel) && isReady() ? m_values[indexOf(pixel)] : 0;
  }
  float scatterProbability(const pgl_point2i& pixel) const {
    if (!m_scatter || !isReady()) return 0.5f;
    return contains(pixel) ? m_scatterProbabilities[indexOf(pixel)] : -1;
  }

 private:
  bool contains(const pgl_point2i& pixel) const {
    return pixel.x >= 0 && pixel.y >= 0 && uint32_t(pixel.x) < m_width && uint32_t(pixel.y) < m_height;
  }
  size_t indexOf(const pgl_point2i& pixel) const { return size_t(pixel.y) * m_width + size_t(pixel.x); }

  uint32_t m_width, m_height;
  std::vector<odis::PixelSums> m_sums;
  std::vector<float> m_values;  // empty before the first update
  std::optional<odis::openpgl_interface::VolumeScatterProbability> m_scatter;  // if it was asked for
  std::vector<float> m_scatterProbabilities;
};

extern "C" {

PGLImageSpaceGuidingBuffer pglFieldNewImageSpaceGuidingBuffer(PGLImageSpaceGuidingBufferConfig config) {
  return new ImageSpaceGuidingBuffer(config);
}
PGLImageSpaceGuidingBuffer pglFieldNewImageSpaceGuidingBufferFromFile(const char*) {
  return nullptr;  // only fields can be stored
}
void pglReleaseImageSpaceGuidingBuffer(PGLImageSpaceGuidingBuffer buffer) {
  delete buffer;
}
void pglImageSpaceGuidingBufferUpdate(PGLImageSpaceGuidingBuffer buffer) {
  buffer->update();
}
void pglImageSpaceGuidingBufferAddSample(PGLImageSpaceGuidingBuffer buffer, pgl_point2i pixel,
                                         PGLImageSpaceSample sample) {
  buffer->add(pixel, sample);
}
void pglImageSpaceGuidingBufferStore(PGLImageSpaceGuidingBuffer, const char*) {
  std::fputs("odis: image-space guiding buffers can't be stored\n", stderr);
}
pgl_vec3f pglImageSpaceGuidingBufferGetContributionEstimate(PGLImageSpaceGuidingBuffer buffer,
                                                            pgl_point2i pixel) {
  const float value = buffer->estimate(pixel);
  return {value, value, value};
}
float pglImageSpaceGuidingBufferGetVolumeScatterProbabilityEstimate(PGLImageSpaceGuidingBuffer buffer,
                                                                    pgl_point2i pixel) {
  return buffer->scatterProbability(pixel);
}
bool pglImageSpaceGuidingBufferIsReady(PGLImageSpaceGuidingBuffer buffer) {
  return buffer->isReady();
}
void pglImageSpaceGuidingBufferReset(PGLImageSpaceGuidingBuffer buffer) {
  buffer->reset();
}

}  // extern "C"
