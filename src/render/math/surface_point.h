// Where a ray met a surface: all that a BSDF, a texture or an emitter may know of the place.
#pragma once

#include <cstdint>

#include "render/math/vec.h"

namespace odis::render {

class Bsdf;
class Shape;
class Texture;

struct SurfacePoint {
  // Paths read these in rows of four numbers.
  Vec3 p;                   // world space
  Vec3 ng;                  // unit geometric normal, on the side that the shape calls its outside
  CoordinateFrame shading;  // unit shading frame; n points to the same side as ng, s follows dpdu
  Vec2 uv;                  // texture coordinates
  float time = 0;           // of the ray that met it
  Vec2 barycentric;         // (b1, b2) on a triangle

  uint32_t primitive = 0;  // triangle of a mesh; 0 for analytic shapes
  const Shape* shape = nullptr;
  // World-space partial derivatives of p with respect to uv; zero where there are none.
  Vec3 dpdu{0, 0, 0}, dpdv{0, 0, 0};

  // The latest look-up in a texture at this uv: light, direction and features ask for the same one.
  mutable const Texture* texture = nullptr;
  mutable Rgb textureValue;

  float pError = 0;  // how far p may be off the surface, set by shapes for Scene::spawn()
};

enum class VertexKind : uint8_t {
  escaped,   // the ray left the scene: there is no vertex
  absorbed,  // nor is there where a medium left nothing of the path
  surface,
  medium,  // the path is scattered within one
};

// Where a ray of a path ended. In a medium there is a place, its shading frame are the axes of the world, and
// `ng` is zero.
struct Vertex {
  SurfacePoint at;
  Vec3 wo;  // towards where the path came from, in the shading frame; a row of four numbers with at.pError
  VertexKind kind = VertexKind::surface;
  const Bsdf* bsdf = nullptr;  // the surface's or Medium::bsdf(); null where there is no vertex

  bool inMedium() const { return kind == VertexKind::medium; }
};

}  // namespace odis::render
