#include "render/emitter/sky_dome.h"

namespace odis::render {

namespace {

// One of the rows is the horizon if nothing is stretched.
int rowsFor(int width) {
  return width / 4 * 2 + 1;
}

}  // namespace

SkyDome::SkyDome(const Sky& sky, const Vec3& sunDirection, float scale, float stretch, int width,
                 const Matrix4& toWorld)
    : m_sky(sky),
      m_sunDirection(sunDirection),
      m_scale(scale),
      m_stretch(stretch),
      m_toLocal(toWorld.inverse()),
      m_table(tabulate(width, rowsFor(width)), width, rowsFor(width), toWorld, stretch / 2) {}

std::vector<Rgb> SkyDome::tabulate(int width, int rows) const {
  std::vector<Rgb> pixels(size_t(width) * size_t(rows));
  const int lit = int(std::ceil(m_stretch / 2 * float(rows - 1))) + 1;
  for (int y = 0; y < lit; ++y)
    for (int x = 0; x < width; ++x) {
      const float theta = kPi * float(y) / float(rows - 1) / m_stretch;
      const float phi = 2 * kPi * (float(x) + 0.5f) / float(width), sinTheta = std::sin(theta);
      // The row just below the horizon, which patches across it need, shines like the horizon.
      const float up = std::max(0.0f, std::cos(theta));
      pixels[size_t(y) * size_t(width) + size_t(x)] =
          unstretchedRadiance({std::sin(phi) * sinTheta, up, -std::cos(phi) * sinTheta});
    }
  return pixels;
}

Rgb SkyDome::unstretchedRadiance(const Vec3& direction) const {
  const float gamma = std::acos(std::clamp(dot(direction, m_sunDirection), -1.0f, 1.0f));
  return m_sky.radiance(direction.y, gamma) * m_scale;
}

Rgb SkyDome::radiance(const Vec3& wi) const {
  Vec3 local = normalize(transformVector(m_toLocal, wi));
  const float horizontal = std::hypot(local.x, local.z);
  if (m_stretch != 1 && horizontal > 0) {
    const float theta = std::atan2(horizontal, local.y) / m_stretch, sinTheta = std::sin(theta);
    local = {local.x / horizontal * sinTheta, std::cos(theta), local.z / horizontal * sinTheta};
  }
  return unstretchedRadiance(local);
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
  for (EmitterSample& sample : samples.first(draws.size()))
    if (sample.pdf > 0) sample.radiance = radiance(sample.wi);
}

}  // namespace odis::render
