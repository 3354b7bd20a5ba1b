// Solids that scenes are put together from. Each adds triangles to a mesh; normals point outwards, texture
// coordinates are lengths in metres.
#pragma once

#include <span>
#include <vector>

#include "render/shape/mesh.h"

namespace odis::learn {

using render::Matrix4;
using render::MeshData;
using render::Rgb;
using render::Vec2;
using render::Vec2i;
using render::Vec3;

// A rectangular hole in a panel, in the panel's own coordinates.
struct Hole {
  float left, right, bottom, top;
};

// The parallelogram corner + s u + t v, seen from the side that `facing` points to.
void addQuad(MeshData& mesh, const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& facing,
             const Vec2& uv = {0, 0});
void addBox(MeshData& mesh, const Vec3& min, const Vec3& max);
// A slab with holes: its front is origin + s u + t v for s from left to right and t from bottom to top,
// facing n; it is `thickness` thick behind that. u, v and n are unit vectors.
struct Panel {
  Vec3 origin, u, v, n;
  float left, right, bottom, top, thickness;
};
void addPanel(MeshData& mesh, const Panel& panel, std::span<const Hole> holes);
// The surface that a profile of (radius, height) sweeps about the vertical through `center`. The outside is
// to the right of the way along the profile: bottom to top for what is convex. `smooth` blends normals
// along it.
void addLathe(MeshData& mesh, const Vec3& center, std::span<const Vec2> profile, int segments,
              bool smooth = false);
void addCylinder(MeshData& mesh, const Vec3& base, float radius, float height, int segments);
void addBall(MeshData& mesh, const Vec3& center, float radius, int segments);
// A tube of thin walls about the vertical, open at both ends, from the lower to the upper radius: shades.
struct Shade {
  float lower, upper;  // radii
  float height, thickness;
};
void addShade(MeshData& mesh, const Vec3& base, const Shade& shade, int segments);
// A box with rounded edges (a superellipsoid): exponent 1 is an ellipsoid, towards 0 a box.
void addCushion(MeshData& mesh, const Vec3& center, const Vec3& half, float exponent);
// The polygon (counter-clockwise) extruded from `bottom` to `top`.
void addPrism(MeshData& mesh, std::span<const Vec2> polygon, float bottom, float top);
// A round bar from one point to another.
void addBar(MeshData& mesh, const Vec3& from, const Vec3& to, float radius, int segments);

// Adds a mesh under a transform that keeps angles.
void append(MeshData& mesh, const MeshData& other, const Matrix4& placement);
// Turns a mesh inside out.
void flip(MeshData& mesh);

// About z by `angle` (radians, from x to y), then to `position`.
Matrix4 placed(const Vec3& position, float angle);

}  // namespace odis::learn
