// irradiancemeter: measures the irradiance on the outside of a shape, W/m^2.
//
// Nested in a shape, over which the film is spread, so that its only pixel, or the mean of all, is the mean
// over the shape. On meshes, rectangles among them, the pixels lie elsewhere than in Mitsuba. No parameters.
#pragma once

#include "render/sensor/sensor.h"
#include "render/shape/shape.h"

namespace odis::render {

class IrradianceMeter final : public Sensor {
 public:
  IrradianceMeter(std::shared_ptr<const Shape> shape, const Vec2i& resolution)
      : m_shape(std::move(shape)), m_resolution(resolution) {}
  // Directions are spread by their cosine with the normal.
  Ray ray(const Vec2& film, const Vec2& lens) const override;
  // Irradiance is pi times the mean of the radiance over such directions.
  float weight(const Vec2& film) const override;

 private:
  Vec2 onShape(const Vec2& film) const;

  std::shared_ptr<const Shape> m_shape;
  Vec2i m_resolution;
};

}  // namespace odis::render
