#include "learn/scenes/solids.h"

#include <algorithm>
#include <cmath>

namespace odis::learn {

using render::cross;
using render::dot;
using render::kPi;
using render::normalize;

static void addTriangles(MeshData& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

static void addVertex(MeshData& mesh, const Vec3& p, const Vec3& n, const Vec2& uv) {
  mesh.positions.push_back(p);
  mesh.normals.push_back(n);
  mesh.uvs.push_back(uv);
}

void addQuad(MeshData& mesh, const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& facing,
             const Vec2& uv) {
  Vec3 n = normalize(cross(u, v));
  const bool turned = dot(n, facing) < 0;
  if (turned) n = -n;
  const auto first = uint32_t(mesh.positions.size());
  const float width = render::length(u), height = render::length(v);
  addVertex(mesh, corner, n, uv);
  addVertex(mesh, corner + u, n, uv + Vec2(width, 0));
  addVertex(mesh, corner + u + v, n, uv + Vec2(width, height));
  addVertex(mesh, corner + v, n, uv + Vec2(0, height));
  if (turned)
    addTriangles(mesh, first, first + 3, first + 2, first + 1);
  else
    addTriangles(mesh, first, first + 1, first + 2, first + 3);
}

void addBox(MeshData& mesh, const Vec3& min, const Vec3& max) {
  const Vec3 size = max - min;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 n(0), u(0), v(0);
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    // v is the vertical where there is one, so that textures stand upright.
    const int upright = a == 2 ? a : b, level = a == 2 ? b : a;
    u[level] = size[level];
    v[upright] = size[upright];
    n[axis] = 1;
    addQuad(mesh, min, u, v, -n);
    Vec3 corner = min;
    corner[axis] = max[axis];
    addQuad(mesh, corner, u, v, n);
  }
}

void addPanel(MeshData& mesh, const Panel& p, std::span<const Hole> holes) {
  // The edges of all holes cut the panel into a grid of cells, each of which is solid or open.
  std::vector<float> us{p.left, p.right}, vs{p.bottom, p.top};
  for (const Hole& hole : holes) {
    for (const float u : {hole.left, hole.right}) us.push_back(std::clamp(u, p.left, p.right));
    for (const float v : {hole.bottom, hole.top}) vs.push_back(std::clamp(v, p.bottom, p.top));
  }
  for (std::vector<float>* cuts : {&us, &vs}) {
    std::sort(cuts->begin(), cuts->end());
    cuts->erase(std::unique(cuts->begin(), cuts->end()), cuts->end());
  }
  const int columns = int(us.size()) - 1, rows = int(vs.size()) - 1;
  const auto solid = [&](int i, int j) {
    if (i < 0 || j < 0 || i >= columns || j >= rows) return false;
    const float u = (us[size_t(i)] + us[size_t(i) + 1]) / 2, v = (vs[size_t(j)] + vs[size_t(j) + 1]) / 2;
    return std::none_of(holes.begin(), holes.end(), [&](const Hole& h) {
      return u > h.left && u < h.right && v > h.bottom && v < h.top;
    });
  };
  const Vec3 back = p.n * -p.thickness;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      if (!solid(i, j)) continue;
      const float u0 = us[size_t(i)], u1 = us[size_t(i) + 1], v0 = vs[size_t(j)], v1 = vs[size_t(j) + 1];
      const Vec3 corner = p.origin + p.u * u0 + p.v * v0, du = p.u * (u1 - u0), dv = p.v * (v1 - v0);
      addQuad(mesh, corner, du, dv, p.n, {u0, v0});
      addQuad(mesh, corner + back, du, dv, -p.n, {u0, v0});
      if (!solid(i - 1, j)) addQuad(mesh, corner, back, dv, -p.u, {0, v0});
      if (!solid(i + 1, j)) addQuad(mesh, corner + du, back, dv, p.u, {0, v0});
      if (!solid(i, j - 1)) addQuad(mesh, corner, du, back, -p.v, {u0, 0});
      if (!solid(i, j + 1)) addQuad(mesh, corner + dv, du, back, p.v, {u0, 0});
    }
}

void addLathe(MeshData& mesh, const Vec3& center, std::span<const Vec2> profile, int segments, bool smooth) {
  const auto normalOf = [&](size_t i) {  // of the piece from point i to the next
    const Vec2 d = profile[i + 1] - profile[i];
    return Vec2(d.y, -d.x).normalized();
  };
  float along = 0;
  for (size_t i = 0; i + 1 < profile.size(); ++i) {
    const float piece = (profile[i + 1] - profile[i]).length();
    if (!(piece > 0)) continue;
    Vec2 normals[2] = {normalOf(i), normalOf(i)};
    if (smooth && i > 0) normals[0] = (normals[0] + normalOf(i - 1)).normalized();
    if (smooth && i + 2 < profile.size()) normals[1] = (normals[1] + normalOf(i + 1)).normalized();
    const float around = 2 * kPi * std::max(profile[i].x, profile[i + 1].x);
    const auto first = uint32_t(mesh.positions.size());
    for (int k = 0; k <= segments; ++k) {
      const float turn = float(k % segments) / float(segments), phi = 2 * kPi * turn;
      const Vec3 out(std::cos(phi), std::sin(phi), 0);
      for (size_t end = 0; end < 2; ++end) {
        const Vec2 at = profile[i + end];
        addVertex(mesh, center + out * at.x + Vec3(0, 0, at.y),
                  out * normals[end].x + Vec3(0, 0, normals[end].y),
                  {around * float(k) / float(segments), along + piece * float(end)});
      }
    }
    for (uint32_t k = 0; k < uint32_t(segments); ++k) {
      const uint32_t a = first + 2 * k;
      // At the axis one of the two triangles has no area.
      if (profile[i].x > 0) mesh.triangles.push_back({a, a + 2, a + 3});
      if (profile[i + 1].x > 0) mesh.triangles.push_back({a, a + 3, a + 1});
    }
    along += piece;
  }
}

void addCylinder(MeshData& mesh, const Vec3& base, float radius, float height, int segments) {
  const Vec2 profile[] = {{0, 0}, {radius, 0}, {radius, height}, {0, height}};
  addLathe(mesh, base, profile, segments);
}

void addBall(MeshData& mesh, const Vec3& center, float radius, int segments) {
  std::vector<Vec2> profile;
  const int rings = segments / 2;
  for (int i = 0; i <= rings; ++i) {
    const float theta = kPi * float(i) / float(rings);
    profile.emplace_back(i == 0 || i == rings ? 0.0f : radius * std::sin(theta), -radius * std::cos(theta));
  }
  addLathe(mesh, center, profile, segments, true);
}

void addShade(MeshData& mesh, const Vec3& base, const Shade& shade, int segments) {
  const auto [lower, upper, height, thickness] = shade;
  const Vec2 profile[] = {{lower - thickness, 0},
                          {lower, 0},
                          {upper, height},
                          {std::max(upper - thickness, 0.0f), height},
                          {lower - thickness, 0}};
  addLathe(mesh, base, profile, segments);
}

void addCushion(MeshData& mesh, const Vec3& center, const Vec3& half, float exponent) {
  constexpr int kRings = 10, kSegments = 20;
  const auto power = [&](float x) { return std::copysign(std::pow(std::abs(x), exponent), x); };
  const auto first = uint32_t(mesh.positions.size());
  for (int i = 0; i <= kRings; ++i)
    for (int k = 0; k <= kSegments; ++k) {
      const float theta = kPi * float(i) / kRings, phi = 2 * kPi * float(k % kSegments) / kSegments;
      const float ring = i == 0 || i == kRings ? 0.0f : std::sin(theta);
      const Vec3 p(power(ring) * power(std::cos(phi)), power(ring) * power(std::sin(phi)),
                   -power(std::cos(theta)));
      // The gradient of |x|^(2/e) + |y|^(2/e) + |z|^(2/e).
      Vec3 n;
      for (int c = 0; c < 3; ++c)
        n[c] = std::copysign(std::pow(std::abs(p[c]), 2 / exponent - 1), p[c]) / half[c];
      addVertex(mesh, center + p * half, normalize(n), {2 * half.x * phi, 2 * half.z * theta});
    }
  for (uint32_t i = 0; i < kRings; ++i)
    for (uint32_t k = 0; k < kSegments; ++k) {
      const uint32_t a = first + i * (kSegments + 1) + k, b = a + kSegments + 1;
      if (i > 0) mesh.triangles.push_back({a, a + 1, b + 1});
      if (i + 1 < kRings) mesh.triangles.push_back({a, b + 1, b});
    }
}

void addPrism(MeshData& mesh, std::span<const Vec2> polygon, float bottom, float top) {
  const size_t n = polygon.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % n], along = b - a;
    addQuad(mesh, {a.x, a.y, bottom}, {along.x, along.y, 0}, {0, 0, top - bottom}, {along.y, -along.x, 0});
  }
  // Bottom and top as fans: polygons are convex.
  for (const bool upper : {false, true}) {
    const auto first = uint32_t(mesh.positions.size());
    for (const Vec2& p : polygon)
      addVertex(mesh, {p.x, p.y, upper ? top : bottom}, {0, 0, upper ? 1.0f : -1.0f}, p);
    for (uint32_t i = 1; i + 1 < n; ++i) {
      if (upper)
        mesh.triangles.push_back({first, first + i, first + i + 1});
      else
        mesh.triangles.push_back({first, first + i + 1, first + i});
    }
  }
}

void addBar(MeshData& mesh, const Vec3& from, const Vec3& to, float radius, int segments) {
  const Vec3 axis = to - from;
  MeshData bar;
  addCylinder(bar, Vec3(0), radius, render::length(axis), segments);
  const render::CoordinateFrame frame(normalize(axis));
  append(mesh, bar,
         Matrix4(frame.s.x, frame.s.y, frame.s.z, 0, frame.t.x, frame.t.y, frame.t.z, 0, frame.n.x, frame.n.y,
                 frame.n.z, 0, from.x, from.y, from.z, 1));
}

void append(MeshData& mesh, const MeshData& other, const Matrix4& placement) {
  const auto first = uint32_t(mesh.positions.size());
  for (size_t i = 0; i < other.positions.size(); ++i)
    addVertex(mesh, render::transformPoint(placement, other.positions[i]),
              normalize(render::transformVector(placement, other.normals[i])), other.uvs[i]);
  for (const render::Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

void flip(MeshData& mesh) {
  for (Vec3& n : mesh.normals) n = -n;
  for (render::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

Matrix4 placed(const Vec3& position, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, position.x, position.y, position.z, 1};
}

}  // namespace odis::learn
