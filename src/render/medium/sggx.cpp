// sggx: microflakes, each a perfect mirror, whose normals are distributed as those of an ellipsoid.
//
//   s   volume of six channels, the symmetric matrix Sxx, Syy, Szz, Sxy, Sxz, Syz; Mitsuba calls it S
//
// The square root of w^T S w is the area that flakes show to the direction w, by which the density of the
// medium is multiplied. Nothing is scattered where S is not positive definite.
//
// Heitz, Dupuy, Crassin and Dachsbacher 2015, "The SGGX Microflake Distribution".
#include "render/math/warp.h"
#include "render/medium/volume_factories.h"
#include "render/shape/affine.h"

namespace odis::render {
namespace {

// In double precision: of thin fibres the matrix is nearly singular.
class SggxMatrix {
 public:
  explicit SggxMatrix(const std::array<float, 6>& s)
      : m_xx(s[0]), m_yy(s[1]), m_zz(s[2]), m_xy(s[3]), m_xz(s[4]), m_yz(s[5]) {}

  bool isPositiveDefinite() const { return m_xx > 0 && m_xx * m_yy - m_xy * m_xy > 0 && determinant() > 0; }
  double product(const Vec3d& a, const Vec3d& b) const {
    return a.x * (m_xx * b.x + m_xy * b.y + m_xz * b.z) + a.y * (m_xy * b.x + m_yy * b.y + m_yz * b.z) +
           a.z * (m_xz * b.x + m_yz * b.y + m_zz * b.z);
  }
  double projectedArea(const Vec3d& w) const { return std::sqrt(std::max(product(w, w), 0.0)); }
  // Density of normals, 1/sr over the whole sphere, times the area of flakes.
  double normals(const Vec3d& m) const {
    const double det = determinant();
    const double squared =
        m.x * m.x * (m_yy * m_zz - m_yz * m_yz) + m.y * m.y * (m_xx * m_zz - m_xz * m_xz) +
        m.z * m.z * (m_xx * m_yy - m_xy * m_xy) +
        2 * (m.x * m.y * (m_xz * m_yz - m_zz * m_xy) + m.x * m.z * (m_xy * m_yz - m_yy * m_xz) +
             m.y * m.z * (m_xy * m_xz - m_xx * m_yz));
    return det * std::sqrt(det) / (std::numbers::pi * squared * squared);
  }
  // A normal that is visible from `wo`, in proportion to its projected area; u uniform in [0, 1)^2.
  Vec3d visibleNormal(const Vec3& wo, const Vec2& u) const {
    // The frame (k, j, i) of the paper, in which wo is i.
    const CoordinateFrame frame(wo);
    const Vec3d k(frame.s), j(frame.t), i(frame.n);
    const double ii = product(i, i), jj = product(j, j), kj = product(k, j), ki = product(k, i),
                 ji = product(j, i);
    const double root = std::sqrt(ii), minor = std::sqrt(std::max(jj * ii - ji * ji, 0.0));
    const Vec3d local(squareToCosineHemisphere(u));
    const Vec3d m = k * (local.x * std::sqrt(determinant()) / minor +
                         local.y * (kj * ii - ki * ji) / (root * minor) + local.z * ki / root) +
                    j * (local.y * minor / root + local.z * ji / root) + i * (local.z * root);
    return m.normalized();
  }

 private:
  double determinant() const {
    return m_xx * (m_yy * m_zz - m_yz * m_yz) - m_xy * (m_xy * m_zz - m_yz * m_xz) +
           m_xz * (m_xy * m_yz - m_yy * m_xz);
  }

  double m_xx, m_yy, m_zz, m_xy, m_xz, m_yz;
};

class Sggx final : public PhaseFunction {
 public:
  explicit Sggx(VolumePtr parameters) : m_parameters(std::move(parameters)) {
    // The greatest eigenvalue is at most the sum of all of them, the trace.
    const Rgb trace = m_parameters->greatest();
    m_greatestArea = std::sqrt(std::max(trace.x, 0.0f) + std::max(trace.y, 0.0f) + std::max(trace.z, 0.0f));
  }

  Sample sample(const MediumPoint& at, float, const Vec2& u) const override {
    const SggxMatrix s(m_parameters->six(at.p));
    if (!s.isPositiveDefinite()) return {};
    const Vec3d wo(at.wo), m = s.visibleNormal(at.wo, u);
    const Vec3d wi = (m * (2 * wo.dot(m)) - wo).normalized();
    return {Vec3(wi), density(s, wo, m)};
  }
  float pdf(const MediumPoint& at, const Vec3& wi) const override {
    const SggxMatrix s(m_parameters->six(at.p));
    const Vec3d wo(at.wo), sum = wo + Vec3d(wi);
    if (!s.isPositiveDefinite() || !(sum.dot(sum) > 0)) return 0;
    return density(s, wo, sum.normalized());
  }
  float projectedArea(const MediumPoint& at) const override {
    return float(SggxMatrix(m_parameters->six(at.p)).projectedArea(Vec3d(at.wo)));
  }
  float greatestProjectedArea() const override { return m_greatestArea; }

 private:
  static float density(const SggxMatrix& s, const Vec3d& wo, const Vec3d& m) {
    const double result = s.normals(m) / (4 * s.projectedArea(wo));
    return std::isfinite(result) ? float(result) : 0;
  }

  VolumePtr m_parameters;
  float m_greatestArea;
};

}  // namespace

PhaseFunctionPtr makeSggx(const Properties& node, Builder& builder) {
  node.declare("s", {.type = "volume"});
  if (node.has("s")) node.refuse("s", "a value", "a volume of 6 channels");
  const Properties* parameters = node.child("volume", "s");
  if (!parameters) throw SceneError(node.location, "sggx has no volume 'S', expected one of 6 channels");
  const VolumePtr volume = builder.volume(*parameters);
  if (volume->channels() != 6)
    throw SceneError(
        parameters->placeOf("filename"),
        fmt::format("found {} channels in the volume 'S' of sggx, expected 6", volume->channels()));
  return std::make_shared<Sggx>(volume);
}

}  // namespace odis::render
