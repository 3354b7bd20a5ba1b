// Estimates of pixels, which hosts compare what a path may still bring with.
#include <cmath>
#include <cstdio>
#include <vector>

#include "vectors.h"

// The type behind Open PGL's handle.
struct ImageSpaceGuidingBuffer {
 public:
  explicit ImageSpaceGuidingBuffer(const pgl_point2i& resolution)
      : m_width(resolution.x > 0 ? uint32_t(resolution.x) : 0),
        m_height(resolution.y > 0 ? uint32_t(resolution.y) : 0),
        m_sums(size_t(m_width) * m_height) {}

  void add(const pgl_point2i& pixel, const pgl_vec3f& contribution) {
    const bool finite =
        std::isfinite(contribution.x) && std::isfinite(contribution.y) && std::isfinite(contribution.z);
    if (contains(pixel) && finite)
      odis::addSample(m_sums[indexOf(pixel)], odis::openpgl_interface::toOdis(contribution), 0);
  }
  void update() { m_values = odis::estimatePixelValues(m_sums, m_width); }
  void reset() {
    m_sums.assign(m_sums.size(), {});
    m_values.clear();
  }
  bool isReady() const { return !m_values.empty(); }
  float estimate(const pgl_point2i& pixel) const {
    return contains(pixel) && isReady() ? m_values[indexOf(pixel)] : 0;
  }

 private:
  bool contains(const pgl_point2i& pixel) const {
    return pixel.x >= 0 && pixel.y >= 0 && uint32_t(pixel.x) < m_width && uint32_t(pixel.y) < m_height;
  }
  size_t indexOf(const pgl_point2i& pixel) const { return size_t(pixel.y) * m_width + size_t(pixel.x); }

  uint32_t m_width, m_height;
  std::vector<odis::PixelSums> m_sums;
  std::vector<float> m_values;  // empty before the first update
};

extern "C" {

PGLImageSpaceGuidingBuffer pglFieldNewImageSpaceGuidingBuffer(PGLImageSpaceGuidingBufferConfig config) {
  return new ImageSpaceGuidingBuffer(config.resolution);
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
  buffer->add(pixel, sample.contribution);
}
void pglImageSpaceGuidingBufferStore(PGLImageSpaceGuidingBuffer, const char*) {
  std::fputs("odis: image-space guiding buffers can't be stored\n", stderr);
}
pgl_vec3f pglImageSpaceGuidingBufferGetContributionEstimate(PGLImageSpaceGuidingBuffer buffer,
                                                            pgl_point2i pixel) {
  const float value = buffer->estimate(pixel);
  return {value, value, value};
}
bool pglImageSpaceGuidingBufferIsReady(PGLImageSpaceGuidingBuffer buffer) {
  return buffer->isReady();
}
void pglImageSpaceGuidingBufferReset(PGLImageSpaceGuidingBuffer buffer) {
  buffer->reset();
}

}  // extern "C"
