// A scene that needs no library of rays: a room of diffuse walls with a ball in it and two lamps in the
// ceiling.
#pragma once

#include <odis/types.h>

#include <algorithm>
#include <cmath>

namespace odis::test {

inline constexpr float kPi = 3.14159265f;

// The room is [0, 1]^3, the camera looks along y. Lamps are squares in the ceiling that are groups of their
// own; `patch` is a square in the floor that glows and that next-event estimation does not know.
struct ToyRoom {
  float lampSize = 0.2f, lampRadiance[2] = {12, 4};
  float patchSize = 0, patchRadiance = 0;
  float albedo = 0.6f;
  // Fog that fills the room, of an isotropic phase function: the extinction coefficient, and which part of it
  // scatters.
  float extinction = 0, fogAlbedo = 0.9f;

  struct Hit {
    Float3 position, normal;  // a little off the surface, so that rays may start there
    float distance = 0;
    Float3 emission;
    int lamp = -1;  // 0 or 1 where the hit is on one
  };
  Hit intersect(const Float3& o, const Float3& d) const;
  bool isHidden(const Float3& from, const Float3& to) const;
  float transmittance(float distance) const { return std::exp(-extinction * distance); }
  float lampLeft(int lamp) const { return lamp == 0 ? 0.1f : 0.7f; }
};

inline float component(const Float3& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
inline float lengthOf(const Float3& v) {
  return std::sqrt(dot(v, v));
}
inline Float3 gray(float value) {
  return {value, value, value};
}

// The distance to the ball; infinity if the ray misses it.
inline float distanceToBall(const Float3& o, const Float3& d) {
  const Float3 toCenter = Float3{0.5f, 0.6f, 0.35f} - o;
  const float along = dot(toCenter, d), squared = dot(toCenter, toCenter) - along * along;
  const float half = std::sqrt(std::max(0.04f - squared, 0.0f)), t = along - half;
  return squared < 0.04f && t > 1e-3f ? t : INFINITY;
}

inline ToyRoom::Hit ToyRoom::intersect(const Float3& o, const Float3& d) const {
  Hit hit;
  hit.distance = distanceToBall(o, d);
  const float ball = hit.distance;
  int wall = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float speed = component(d, axis);
    if (speed == 0) continue;
    const float t = ((speed > 0 ? 1.0f : 0.0f) - component(o, axis)) / speed;
    if (t < hit.distance) {
      hit.distance = std::max(t, 0.0f);
      wall = speed > 0 ? axis + 1 : -axis - 1;
    }
  }
  hit.position = o + d * hit.distance;
  if (hit.distance == ball) {
    hit.normal = (hit.position - Float3{0.5f, 0.6f, 0.35f}) * 5.0f;
    hit.position = hit.position + hit.normal * 1e-4f;
    return hit;
  }
  const float side = wall > 0 ? -1.0f : 1.0f;
  hit.normal = {std::abs(wall) == 1 ? side : 0, std::abs(wall) == 2 ? side : 0,
                std::abs(wall) == 3 ? side : 0};
  hit.position = hit.position + hit.normal * 1e-4f;
  const Float3& p = hit.position;
  for (int lamp = 0; wall == 3 && lamp < 2; ++lamp)
    if (p.x >= lampLeft(lamp) && p.x < lampLeft(lamp) + lampSize && p.y >= 0.4f && p.y < 0.4f + lampSize) {
      hit.lamp = lamp;
      hit.emission = gray(lampRadiance[lamp]);
    }
  if (wall == -3 && std::abs(p.x - 0.5f) < patchSize / 2 && std::abs(p.y - 0.2f) < patchSize / 2)
    hit.emission = gray(patchRadiance);
  return hit;
}

inline bool ToyRoom::isHidden(const Float3& from, const Float3& to) const {
  const float length = lengthOf(to - from);
  return distanceToBall(from, (to - from) / length) < length * 0.999f;
}

}  // namespace odis::test
