#include "learn/data/starts.h"

namespace odis::learn {

using render::Ray;
using render::Vec2;
using render::Vec3;

namespace {

float distanceFromCamera(const render::Scene& scene, const PathVertex& v) {
  const render::Crop& crop = scene.film().crop;
  const int x = crop.x + int(v.pixel) % crop.width, y = crop.y + int(v.pixel) / crop.width;
  const Vec2 pixel(float(x) + 0.5f, float(y) + 0.5f);
  return render::length(render::fromOdis(v.position) - scene.sensor().ray(pixel, Vec2(0.5f, 0.5f), 0).origin);
}

}  // namespace

std::optional<Start> findStart(const render::Scene& scene, std::span<const PathVertex> vertices,
                               size_t index) {
  const PathVertex& v = vertices[index];
  const float fromPrevious = v.depth > 1 ? vertices[index - 1].distance : distanceFromCamera(scene, v);
  // Nothing lies between a vertex and the one before it, or the camera: a ray from the middle finds it.
  const Vec3 wo = render::fromOdis(v.wo), position = render::fromOdis(v.position);
  Start start;
  start.towards = Ray{position + wo * (fromPrevious / 2), -wo, render::kInfinity};
  if (!scene.intersect(start.towards, start.at)) return std::nullopt;
  if (render::length(start.at.p - position) > 1e-3f * fromPrevious) return std::nullopt;
  start.wo = start.at.shading.toLocal(wo);
  start.reference = render::lightReference(start.at, start.wo);
  return start;
}

}  // namespace odis::learn
