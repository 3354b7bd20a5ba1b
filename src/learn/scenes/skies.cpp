#include "learn/scenes/skies.h"

#include <algorithm>

#include "learn/scenes/shrink.h"

namespace odis::learn {

Vec3 skyDirection(double azimuth, double elevation) {
  const double c = std::cos(elevation);
  return Vec3(float(c * std::cos(azimuth)), float(c * std::sin(azimuth)), float(std::sin(elevation)));
}

std::string drawSky(Random random, const Vec3& toSun) {
  constexpr int kWidth = 256, kHeight = 128;
  const bool night = random.chance(0.2);
  const ValueNoise noise(random.bits());
  const Rgb zenith =
                hue(random.range(0.55, 0.65), random.range(0.2, 0.8), night ? 0.01 : random.range(0.2, 0.7)),
            horizon =
                hue(random.range(0.02, 0.6), random.range(0.05, 0.6), night ? 0.03 : random.range(0.4, 1.2)),
            ground =
                hue(random.range(0.05, 0.3), random.range(0.1, 0.5), night ? 0.005 : random.range(0.05, 0.3));
  const double cover = random.range(0, 0.9), cloud = night ? 0.02 : random.range(0.5, 2);
  // The sun is a lobe of some degrees; by night there are lamps near the horizon.
  const double width = random.logRange(0.015, 0.2), power = night ? 0 : random.logRange(0.3, 10);
  const Rgb sun = hue(random.range(0.05, 0.13), random.range(0, 0.6), power / (2 * M_PI * width * width));
  std::vector<std::pair<Vec3, Rgb>> lamps;
  for (int i = night ? random.integer(5, 60) : 0; i > 0; --i)
    lamps.emplace_back(skyDirection(random.range(0, 2 * M_PI), random.range(-0.1, 0.3)),
                       hue(random.range(0.02, 0.15), random.range(0.1, 0.8), random.logRange(0.5, 50)));
  std::vector<Rgb> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      // Of the map's own space: +y up, the middle of the image -z; in the scene +z is up.
      const double theta = M_PI * (y + 0.5) / kHeight, phi = 2 * M_PI * (x + 0.5) / kWidth;
      const Vec3 d(float(std::sin(theta) * std::sin(phi)), float(std::sin(theta) * std::cos(phi)),
                   float(std::cos(theta)));
      Rgb color;
      if (d.z < 0) {
        color = render::lerp(std::min(1.0f, -8 * d.z), horizon * 0.5f, ground);
      } else {
        color = render::lerp(std::pow(d.z, 0.4f), horizon, zenith);
        const double n = noise.at(x * 16.0 / kWidth, std::pow(y / double(kHeight), 2) * 24, 16, 4);
        const double t = std::clamp((n - (1 - cover)) * 4, 0.0, 1.0);
        color = render::lerp(float(t), color, Rgb(float(cloud)));
        const double angle = std::acos(std::clamp(double(render::dot(d, toSun)), -1.0, 1.0));
        color += sun * float(std::exp(-angle * angle / (2 * width * width)) * (1 - 0.7 * t));
      }
      for (const auto& [at, light] : lamps)
        if (render::dot(d, at) > 0.9996f) color += light;
      pixels.push_back(color);
    }
  return encodeHdr(kWidth, kHeight, pixels);
}

void addDaylight(Draft& draft, const Vec3& toSun, float sunScale) {
  Environment& e = draft.scene.environment;
  e.kind = Environment::Kind::daylight;
  e.sunDirection = toSun;
  e.turbidity = float(draft.random.range(1.5, 8));
  // Behind haze the sun looks wider.
  e.sunAperture = draft.random.chance(0.75) ? 0.5358f : float(draft.random.logRange(0.6, 5));
  e.sunScale = sunScale;
}

void addSky(Draft& draft, const Vec3& toSun) {
  Random& random = draft.random;
  Environment& e = draft.scene.environment;
  const bool maps = !draft.assets.hdris().empty();
  switch (random.weighted({5, 1, 2, maps ? 4.0 : 0.0, 0.4})) {
    case 0:
      addDaylight(draft, toSun, float(random.logRange(0.3, 1)));
      break;
    case 1:
      addDaylight(draft, toSun, 0);
      break;
    case 2:
      e.kind = Environment::Kind::map;
      e.file = "textures/sky.hdr";
      draft.scene.files.push_back({e.file, drawSky(random.fork("sky"), toSun)});
      break;
    case 3:
      e.kind = Environment::Kind::map;
      e.file = "textures/environment.hdr";
      e.turn = float(random.range(0, 2 * M_PI));
      draft.scene.files.push_back({e.file, draft.assets.environment(random.pick(
                                               std::span<const std::string>(draft.assets.hdris())))});
      break;
    default:
      e.kind = Environment::Kind::constant;
      e.radiance = hue(0.6, random.range(0, 0.4), 1);
  }
}

void addSurroundings(Draft& draft, const Box& building, float below) {
  Random& random = draft.random;
  const float reach = float(random.logRange(15, 80)), z = -below;
  MeshData plain;
  const Vec3 corner(building.min.x - reach, building.min.y - reach, z);
  addQuad(plain, corner, {building.max.x - building.min.x + 2 * reach, 0, 0},
          {0, building.max.y - building.min.y + 2 * reach, 0}, {0, 0, 1});
  draft.add(std::move(plain), random.chance(0.5)
                                  ? draft.materials.foliage()
                                  : draft.materials.matt(hue(0.1, 0.1, random.range(0.1, 0.5))));
  // Houses keep a street's width away.
  for (int i = random.chance(0.5) ? random.integer(1, 8) : 0; i > 0; --i) {
    const Vec3 middle = (building.min + building.max) * 0.5f;
    const float away = render::length(building.max - building.min) * 0.5f + float(random.range(6, 14));
    const Vec3 at = middle + skyDirection(random.range(0, 2 * M_PI), 0) * (away + 5);
    const Vec2 half(float(random.range(2, 5)), float(random.range(2, 5)));
    draft.addBox({at.x - half.x, at.y - half.y, z},
                 {at.x + half.x, at.y + half.y, z + float(random.range(3, 14))}, draft.materials.wall());
  }
}

}  // namespace odis::learn
