#include "odis/pixels/pixel_model.h"

namespace odis::core {

namespace {

class PixelHistogram : public PixelModel {
 public:
  explicit PixelHistogram(IncidentRadiance radiance) : m_radiance(radiance) {}
  IncidentRadiance radiance() const override { return m_radiance; }
  void predict(size_t count, const Neighbourhood* seen, const PixelPlace*, Histogram* result) const override {
    for (size_t i = 0; i < count; ++i) result[i] = histogramOf(seen[i]);
  }

 private:
  IncidentRadiance m_radiance;
};

}  // namespace

std::shared_ptr<const PixelModel> pixelHistogram(IncidentRadiance radiance) {
  return std::make_shared<PixelHistogram>(radiance);
}

}  // namespace odis::core
