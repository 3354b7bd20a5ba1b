#include "render/shape/curves.h"

#include "render/shape/embree.h"
#include "render/shape/surface_math.h"

namespace odis::render {
namespace {

// Light that has passed the surface leaves on the other side without meeting it from within.
void rejectBackFaces(const RTCFilterFunctionNArguments* arguments) {
  for (unsigned i = 0, n = arguments->N; i < n; ++i) {
    const Vec3 direction(RTCRayN_dir_x(arguments->ray, n, i), RTCRayN_dir_y(arguments->ray, n, i),
                         RTCRayN_dir_z(arguments->ray, n, i)),
        normal(RTCHitN_Ng_x(arguments->hit, n, i), RTCHitN_Ng_y(arguments->hit, n, i),
               RTCHitN_Ng_z(arguments->hit, n, i));
    if (dot(direction, normal) > 0) arguments->valid[i] = 0;
  }
}

// Where u is zero, and at right angles to it and the axis: as far as can be towards +z.
struct TubeFrame {
  Vec3d radial, around;

  explicit TubeFrame(const Vec3d& axis) : around(Vec3d(0, 0, 1) - axis * axis.z) {
    const double length = around.length();
    around = length > 1e-7 ? around / length : Vec3d(0, 1, 0);
    radial = around.cross(axis);
  }
};

}  // namespace

Curves::Curves(CurveData data, CurveBasis basis) : m_basis(basis), m_points(std::move(data.points)) {
  const uint32_t perPiece = basis == CurveBasis::linear ? 2 : 4;
  data.starts.push_back(uint32_t(m_points.size()));
  for (size_t curve = 0; curve + 1 < data.starts.size(); ++curve)
    for (uint32_t first = data.starts[curve]; first + perPiece <= data.starts[curve + 1]; ++first)
      m_pieces.push_back(first);
  double area = 0;
  for (uint32_t piece = 0; piece < m_pieces.size(); ++piece) {
    const Axis a = axisAt(piece, 0), b = axisAt(piece, 1);
    area += M_PI * (a.radius + b.radius) * std::hypot((b.p - a.p).length(), b.radius - a.radius);
  }
  m_area = float(area);
}

RTCGeometryTy* Curves::makeGeometry(RTCDeviceTy* device) const {
  const bool linear = m_basis == CurveBasis::linear;
  RTCGeometry geometry = rtcNewGeometry(
      device, linear ? RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE : RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, m_points.data(), 0,
                             sizeof(CurveData::Point), m_points.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, m_pieces.data(), 0,
                             sizeof(uint32_t), m_pieces.size());
  rtcSetGeometryIntersectFilterFunction(geometry, rejectBackFaces);
  rtcSetGeometryOccludedFilterFunction(geometry, rejectBackFaces);
  rtcCommitGeometry(geometry);
  return geometry;
}

Curves::Axis Curves::axisAt(uint32_t piece, double v) const {
  const CurveData::Point* q = &m_points[m_pieces[piece]];
  // Weights of the control points for the value and its two derivatives.
  double w[3][4] = {{1 - v, v}, {-1, 1}, {}};
  int count = 2;
  if (m_basis == CurveBasis::bspline) {
    count = 4;
    const double s = 1 - v, v2 = v * v;
    const double cubic[3][4] = {
        {s * s * s / 6, (3 * v2 * v - 6 * v2 + 4) / 6, (-3 * v2 * v + 3 * v2 + 3 * v + 1) / 6, v2 * v / 6},
        {-s * s / 2, (3 * v2 - 4 * v) / 2, (-3 * v2 + 2 * v + 1) / 2, v2 / 2},
        {s, 3 * v - 2, 1 - 3 * v, v}};
    std::copy(&cubic[0][0], &cubic[0][0] + 12, &w[0][0]);
  }
  Axis axis{};
  for (int i = 0; i < count; ++i) {
    const Vec3d p(q[i].x, q[i].y, q[i].z);
    axis.p += p * w[0][i];
    axis.d += p * w[1][i];
    axis.dd += p * w[2][i];
    axis.radius += q[i].radius * w[0][i];
    axis.dRadius += q[i].radius * w[1][i];
  }
  return axis;
}

SurfacePoint Curves::surfacePoint(const Ray& ray, const RawHit& hit) const {
  const Ray inObject = toObject(ray, hit);
  const Axis axis = axisAt(hit.primitive, hit.u);
  const double squared = axis.d.dot(axis.d);
  Vec3d outward = Vec3d(inObject.origin) + Vec3d(inObject.direction) * double(hit.t) - axis.p;
  // t is rounded, so the point is moved onto the tube.
  if (const double length = outward.length(); length > 0) outward *= axis.radius / length;
  const Vec3d along = squared > 0 ? axis.d / std::sqrt(squared) : Vec3d(1, 0, 0);

  SurfacePoint at;
  at.shape = this;
  at.primitive = hit.primitive;
  at.p = Vec3(axis.p + outward);
  at.pError = positionError(maxAbs(axis.p) + float(axis.radius));
  // Embree takes the place on the axis of a straight piece such that the normal points away from it.
  Vec3d normal = outward;
  if (m_basis == CurveBasis::bspline)
    normal = outward * (squared - outward.dot(axis.dd)) - axis.d * (axis.dRadius * axis.radius);
  at.ng = normalizeOr(normal, Vec3(-inObject.direction));

  const TubeFrame frame(along);
  double turns = std::atan2(frame.around.dot(outward), frame.radial.dot(outward)) / (2 * M_PI);
  if (turns < 0) turns += 1;
  const double pieces = double(m_pieces.size());
  at.uv = {float(turns), float((hit.primitive + double(hit.u)) / pieces)};
  at.dpdu = Vec3(along.cross(outward) * (2 * M_PI));
  // The derivative leaves out that the frame turns about the axis along the curve.
  const Vec3d radial = outward.length() > 0 ? outward.normalized() : frame.radial;
  const double stretch = squared > 0 ? 1 - outward.dot(axis.dd) / squared : 1;
  at.dpdv = Vec3((axis.d * stretch + radial * axis.dRadius) * pieces);
  at.shading = CoordinateFrame::fromTangent(at.ng, at.dpdu);
  toWorld(at, hit);
  return at;
}

PrimitiveExtent Curves::extent(uint32_t piece) const {
  PrimitiveExtent result;
  const CurveData::Point* q = &m_points[m_pieces[piece]];
  result.min = Vec3(kInfinity);
  result.max = Vec3(-kInfinity);
  for (int i = 0; i < (m_basis == CurveBasis::linear ? 2 : 4); ++i)
    for (int k = 0; k < 3; ++k) {
      const float center = k == 0 ? q[i].x : k == 1 ? q[i].y : q[i].z;
      result.min[k] = std::min(result.min[k], center - q[i].radius);
      result.max[k] = std::max(result.max[k], center + q[i].radius);
    }
  return result;
}

uint64_t Curves::bytes() const {
  return sizeof(*this) + m_points.size() * sizeof(m_points[0]) + m_pieces.size() * sizeof(m_pieces[0]);
}

}  // namespace odis::render
