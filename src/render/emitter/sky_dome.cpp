#include "render/emitter/sky_dome.h"

#include <odis/instruction_sets.h>

#include "render/math/angles.h"

namespace odis::render {

namespace {

// One of the rows is the horizon if nothing is stretched.
int rowsFor(int width) {
  return width / 4 * 2 + 1;
}

}  // namespace

SkyDome::SkyDome(const Sky& sky, const Vec3& sunDirection, float scale, float stretch, int width,
                 const Matrix4& toWorld)
    : m_model{sky, sunDirection, scale, stretch, toWorld.inverse()},
      m_table(tabulate(width, rowsFor(width)), width, rowsFor(width), toWorld, stretch / 2) {}

std::vector<Rgb> SkyDome::tabulate(int width, int rows) const {
  std::vector<Rgb> pixels(size_t(width) * size_t(rows));
  const int lit = int(std::ceil(m_model.stretch / 2 * float(rows - 1))) + 1;
  for (int y = 0; y < lit; ++y)
    for (int x = 0; x < width; ++x) {
      const float theta = kPi * float(y) / float(rows - 1) / m_model.stretch;
      const float phi = 2 * kPi * (float(x) + 0.5f) / float(width), sinTheta = std::sin(theta);
      // The row just below the horizon, which patches across it need, shines like the horizon.
      const float up = std::max(0.0f, std::cos(theta));
      pixels[size_t(y) * size_t(width) + size_t(x)] =
          m_model.radianceAbove({std::sin(phi) * sinTheta, up, -std::cos(phi) * sinTheta});
    }
  return pixels;
}

[[gnu::always_inline]] inline Vec3 SkyDome::Model::unstretched(const Vec3& wi) const {
  const Vec3 local = normalize(transformVector(toLocal, wi));
  const float horizontal = std::sqrt(local.x * local.x + local.z * local.z);
  const auto [sinTheta, cosTheta] = sinCosOfTurns(angleInTurns(horizontal, local.y) / stretch);
  const float scale = sinTheta / std::max(horizontal, 1e-30f);
  const Vec3 direction(local.x * scale, cosTheta, local.z * scale);
  return select(stretch == 1, local, direction);
}

[[gnu::always_inline]] inline Rgb SkyDome::Model::radianceAbove(const Vec3& direction) const {
  const float cosGamma = std::min(std::max(dot(direction, sunDirection), -1.0f), 1.0f);
  // The arc tangent keeps its precision near the sun, where the arc cosine has lost it.
  const float gamma = 2 * kPi * angleInTurns(length(cross(direction, sunDirection)), cosGamma);
  return sky.radiance(std::max(direction.y, 0.0f), gamma, cosGamma) * scale;
}

ODIS_WIDE void SkyDome::findRadiance(const Model& sky, size_t count, const Columns3& wi, Columns3& radiance) {
  const Model copy = sky;  // NOLINT(performance-unnecessary-copy-initialization): see columns.h
  const size_t end = endOfLanes(count);
  Columns3 directions;
  for (size_t i = 0; i < end; ++i) directions.set(i, copy.unstretched(wi[i]));
  for (size_t i = 0; i < end; ++i) radiance.set(i, copy.radianceAbove(directions[i]));
  for (size_t i = 0; i < end; ++i) {
    const Vec3 above = radiance[i];
    radiance.set(i, select(directions.y[i] >= 0, above, Vec3(0, 0, 0)));
  }
}

Rgb SkyDome::radiance(const Vec3& wi) const {
  Columns3 directions{}, radiance;
  directions.set(0, wi);
  findRadiance(m_model, 1, directions, radiance);
  return Rgb(radiance[0]);
}

void SkyDome::view(std::span<EnvironmentView> views) const {
  Columns3 wi{}, radiance;
  for (size_t i = 0; i < views.size(); ++i) wi.set(i, views[i].wi);
  findRadiance(m_model, views.size(), wi, radiance);
  for (size_t i = 0; i < views.size(); ++i) views[i].radiance = Rgb(radiance[i]);
  m_table.viewDensities(views);
}

EmitterSample SkyDome::sample(uint32_t part, const Vec3& ref, const Vec2& u) const {
  const LightDraw draw{part, ref, u};
  EmitterSample result;
  sampleEach({&draw, 1}, {&result, 1});
  return result;
}

void SkyDome::sampleEach(std::span<const LightDraw> draws, std::span<EmitterSample> samples) const {
  EnvironmentMap::ImagePlaces places{};
  m_table.sampleDirections(draws, samples, places);
  Columns3 wi{}, radiance;
  for (size_t i = 0; i < draws.size(); ++i) wi.set(i, samples[i].wi);
  findRadiance(m_model, draws.size(), wi, radiance);
  for (size_t i = 0; i < draws.size(); ++i)
    if (samples[i].pdf > 0) samples[i].radiance = Rgb(radiance[i]);
}

}  // namespace odis::render
