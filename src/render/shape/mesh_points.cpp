#include "render/shape/mesh_points.h"

#include <odis/instruction_sets.h>

#include <new>

#include "render/shape/surface_math.h"

namespace odis::render {

namespace {

// Rows of four numbers begin at pointers, one of each lane, and an offset.
template <class T>
auto rowsOf(const T* const* pointers, size_t offset) {
  return [=](size_t lane) { return reinterpret_cast<const float*>(pointers[lane]) + offset; };
}

void findAlone(const Hit& hit, const Ray& ray, Vertex& vertex) {
  new (&vertex.at) SurfacePoint(hit.surfacePoint(ray));  // without a copy
  vertex.wo = vertex.at.shading.toLocal(-ray.direction);
}

}  // namespace

void MeshPoints::add(const Hit& hit, const Ray& ray, Vertex& vertex) {
  if (!knows(hit) || hit.raw.instance || hit.shape->tangents() ||
      hit.shape->mesh()->isLarge(hit.raw.primitive)) {
    findAlone(hit, ray, vertex);
    return;
  }
  const size_t i = m_count++;
  assert(i < kLanes);
  const Mesh& mesh = *hit.shape->mesh();
  const Mesh::Face& face = mesh.faceOf(hit.raw.primitive);
  m_faces[i] = &face;
  for (size_t corner = 0; corner < 3; ++corner) m_corners[corner][i] = &mesh.m_vertices[face.corners[corner]];
  m_hits[i] = &hit;
  m_rays[i] = &ray;
  m_vertices[i] = &vertex;
  m_columns.b1[i] = hit.raw.u;
  m_columns.b2[i] = hit.raw.v;
  m_columns.time[i] = ray.time;
  m_columns.hasUvs[i] = mesh.m_hasUvs;
}

void MeshPoints::gather() {
  Columns& c = m_columns;
  Column ignored[3];
  for (size_t first = 0; first < m_count; first += 4) {
    toColumns(first, rowsOf(m_faces, 0), ignored[0].of, ignored[1].of, ignored[2].of, c.faceNormal.x.of);
    toColumns(first, rowsOf(m_faces, 4), c.faceNormal.y.of, c.faceNormal.z.of, ignored[0].of, c.pError.of);
    for (size_t k = 0; k < 3; ++k) {
      Columns3 &position = c.position[k], &normal = c.normal[k];
      toColumns(first, rowsOf(m_corners[k], 0), position.x.of, position.y.of, position.z.of, normal.x.of);
      toColumns(first, rowsOf(m_corners[k], 4), normal.y.of, normal.z.of, c.u[k].of, c.v[k].of);
    }
    toColumns(first, rowsOf(m_rays, 3), c.direction.x.of, c.direction.y.of, c.direction.z.of, ignored[0].of);
  }
}

ODIS_WIDE void MeshPoints::compute(size_t count, Columns& c) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const float b1 = c.b1[i], b2 = c.b2[i], b0 = 1 - b1 - b2;
    const auto mix = [&](const Columns3(&of)[3]) { return of[0][i] * b0 + of[1][i] * b1 + of[2][i] * b2; };
    c.p.set(i, pointOnTriangle(c.position[0][i], c.position[1][i], c.position[2][i], {b1, b2}));
    const bool hasUvs = c.hasUvs[i];
    c.uvX[i] = hasUvs ? c.u[0][i] * b0 + c.u[1][i] * b1 + c.u[2][i] * b2 : b1;
    c.uvY[i] = hasUvs ? c.v[0][i] * b0 + c.v[1][i] * b1 + c.v[2][i] * b2 : b2;

    const Vec3 ng = c.faceNormal[i], sum = mix(c.normal);
    const float squared = lengthSquared(sum);
    const bool usable = (squared > 1e-20f) & (squared < 1e20f);
    const Vec3 n = select(usable, sum * (1 / std::sqrt(squared)), ng);
    c.isDegenerate[i] = !usable & !(squared == 0);
    c.ng.set(i, select(dot(n, ng) < 0, -ng, ng));
    const CoordinateFrame frame(n);
    c.s.set(i, frame.s);
    c.t.set(i, frame.t);
    c.n.set(i, n);
    c.wo.set(i, frame.toLocal(-c.direction[i]));
  }
}

void MeshPoints::find() {
  Vertex spare;
  for (size_t i = m_count; i % 4 != 0; ++i) {  // rows come in fours
    m_faces[i] = m_faces[i - 1];
    for (auto& corners : m_corners) corners[i] = corners[i - 1];
    m_rays[i] = m_rays[i - 1];
    m_vertices[i] = &spare;
  }
  gather();
  compute(m_count, m_columns);
  m_columns.write(m_vertices, m_count);
  for (size_t i = 0; i < m_count; ++i) {
    SurfacePoint& at = m_vertices[i]->at;
    at.shape = m_hits[i]->shape;
    at.primitive = m_hits[i]->raw.primitive;
    at.texture = nullptr;
    if (m_columns.isDegenerate[i]) findAlone(*m_hits[i], *m_rays[i], *m_vertices[i]);
  }
  m_count = 0;
}

}  // namespace odis::render
