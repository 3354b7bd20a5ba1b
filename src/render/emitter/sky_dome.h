// The clear sky as a light.
#pragma once

#include "render/emitter/daylight.h"
#include "render/emitter/environment_map.h"

namespace odis::render {

// Its radiance is that of the model for every direction; a table of it drives the sampling.
class SkyDome final : public EnvironmentEmitter {
 public:
  // `sunDirection`, unit, is in the sky's space, where up is +Y; so is the sky before it is stretched: what
  // is at an angle from the zenith moves to `stretch` (1 to 2) times that angle. The linear part of toWorld
  // must have an inverse. The table has `width` >= 4 columns.
  SkyDome(const Sky& sky, const Vec3& sunDirection, float scale, float stretch, int width,
          const Matrix4& toWorld);

  // By the table, see EnvironmentMap.
  EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const override;
  void sampleEach(std::span<const LightDraw> draws, std::span<EmitterSample> samples) const override;
  float meanIrradiance() const override { return m_table.meanIrradiance(); }
  Rgb radiance(const Vec3& wi) const override;
  void view(std::span<EnvironmentView> views) const override;
  float pdf(const Vec3& wi) const override { return m_table.pdf(wi); }
  bool invertible() const override { return true; }
  Vec2 invert(const Vec3& wi) const override { return m_table.invert(wi); }

 private:
  // What the sky shows, and where.
  struct Model {
    Sky sky;
    Vec3 sunDirection;
    float scale, stretch;
    Matrix4 toLocal;

    // A direction of the world in the sky's space, before the sky is stretched.
    Vec3 unstretched(const Vec3& wi) const;
    // The radiance from a direction of that space, as if those below the horizon lay on it.
    Rgb radianceAbove(const Vec3& direction) const;
  };
  // The radiance from the first `count` directions of the world, black below the horizon.
  static void findRadiance(const Model& sky, size_t count, const Columns3& wi, Columns3& radiance);
  std::vector<Rgb> tabulate(int width, int rows) const;

  Model m_model;
  EnvironmentMap m_table;
};

}  // namespace odis::render
