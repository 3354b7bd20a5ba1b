// measured: a measured surface, one-sided.
//
//   filename   string, of the measurements in RGB (".bsdf"; those with spectra are refused, as in Mitsuba's
//              variants in RGB)
//
// Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering": the
// file holds what was measured over the numbers that the directions of light are sampled with.
#include <fmt/format.h>

#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"
#include "render/bsdf/table_warp.h"

namespace odis::render {
namespace {

struct Measurements {
  TableAxis phi, theta;  // of the direction that light leaves along
  TableWarp visibleNormals, luminance;
  std::vector<float> rgb;  // [phi][theta][channel][y][x]
  uint32_t rgbSize = 2;
  std::vector<float> normals, area;  // distribution of normals and projected area, with their widths, heights
  uint32_t normalsSize[2], areaSize[2];
  bool byArea = true;  // whether values are relative to these two
  bool isotropic = true;
  int symmetry = 1;  // into how many alike parts planes divide the azimuth
};

float elevation(const Vec3& w) {
  return 2 * std::asin(std::min(0.5f * length(w - Vec3(0, 0, 1)), 1.0f));
}
float toUnit(float theta) {
  return std::sqrt(theta * (2 / kPi));
}
float azimuthToUnit(float phi) {
  const float turns = (phi + kPi) * (0.5f * kInvPi);
  return turns - std::floor(turns);
}

class Measured final : public Bsdf {
 public:
  explicit Measured(Measurements data) : m_data(std::move(data)) {
    m_traits.tangents = !m_data.isotropic;
    // The roughness is that of the GGX distribution which falls to a quarter at the same angle.
    const auto d = [&](float u) {
      return interpolate(m_data.normals.data(), m_data.normalsSize[0], m_data.normalsSize[1], {u, 0.5f});
    };
    float u = 0;
    while (u < 0.8f && d(u) > 0.25f * d(0)) u += 0.005f;
    m_roughness = std::min(std::tan(0.5f * kPi * u * u), 1.0f);
    m_lobe = m_roughness < kMinGuidedRoughness ? Lobe::nearDelta : Lobe::smooth;
  }

  BsdfSample sample(const SurfacePoint&, const Vec3& wo, float, const Vec2& u) const override {
    if (!(wo.z > 0)) return {};
    const View view(m_data, wo);
    const Vec2 drawn = m_data.luminance.sample(view.mix, {u.y, u.x}).point;
    const Vec2 m = m_data.visibleNormals.sample(view.mix, drawn).point;
    const float theta = 0.5f * kPi * m.x * m.x;
    const float phi = (2 * m.y - 1) * kPi + (m_data.isotropic ? view.phi : 0);
    const Vec3 normal(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const Vec3 wi = view.turned(reflect(view.wo, normal));
    return wi.z > 0 ? finishSample(wi, evaluate(view, wi), m_lobe) : BsdfSample{};
  }

  BsdfValue evaluate(const SurfacePoint&, const Vec3& wo, const Vec3& wi) const override {
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    return evaluate(View(m_data, wo), wi);
  }

  float guidableProbability(const SurfacePoint&, const Vec3& wo) const override {
    return wo.z > 0 && m_lobe == Lobe::smooth ? 1 : 0;
  }

  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const override {
    const Vec3 front(wo.x, wo.y, std::max(std::abs(wo.z), 1e-3f));
    Rgb sum(0.0f);
    for (const float x : {0.25f, 0.75f})
      for (const float y : {0.25f, 0.75f}) sum += sample(at, normalize(front), 0, {x, y}).weight;
    return {clampUnit(sum * 0.25f), m_roughness};
  }
  float roughness(const SurfacePoint&, const Vec3&) const override { return m_roughness; }

 private:
  // What depends on wo alone; symmetric materials are seen from where they were measured.
  struct View {
    float signX = 1, signY = 1;
    Vec3 wo;
    float phi, theta;
    TableWarp::Mix mix;

    View(const Measurements& data, const Vec3& direction) {
      if (data.symmetry >= 2) {
        signY = direction.y < 0 ? 1 : -1;
        signX = data.symmetry == 4 ? (direction.x < 0 ? 1 : -1) : signY;
      }
      wo = turned(direction);
      phi = std::atan2(wo.y, wo.x);
      theta = elevation(wo);
      mix = TableWarp::mixAt(data.phi, data.theta, phi, theta);
    }
    Vec3 turned(const Vec3& w) const { return {signX * w.x, signY * w.y, w.z}; }
  };

  BsdfValue evaluate(const View& view, const Vec3& unturned) const {
    const Vec3 wi = view.turned(unturned), m = normalize(view.wo + wi);
    const float phiM = std::atan2(m.y, m.x) - (m_data.isotropic ? view.phi : 0);
    const Vec2 normal(toUnit(elevation(m)), azimuthToUnit(phiM));
    const TableWarp::Sample drawn = m_data.visibleNormals.invert(view.mix, normal);
    const float sinM = safeSqrt(1 - m.z * m.z);
    const float jacobian = std::max(2 * sqr(kPi) * normal.x * sinM, 1e-6f) * 4 * dot(view.wo, m);
    BsdfValue result;
    result.pdf = drawn.pdf * m_data.luminance.pdf(view.mix, drawn.point) / jacobian;
    const uint64_t size = uint64_t(m_data.rgbSize) * m_data.rgbSize;
    for (int k = 0; k < 4; ++k)
      for (uint64_t c = 0; c < 3; ++c)
        result.value[int(c)] +=
            view.mix.weights[k] * interpolate(&m_data.rgb[(view.mix.tables[k] * 3 + c) * size],
                                              m_data.rgbSize, m_data.rgbSize, drawn.point);
    if (m_data.byArea)
      result.value *=
          interpolate(m_data.normals.data(), m_data.normalsSize[0], m_data.normalsSize[1], normal) /
          (4 * interpolate(m_data.area.data(), m_data.areaSize[0], m_data.areaSize[1],
                           {toUnit(view.theta), azimuthToUnit(view.phi)}));
    if (!std::isfinite(result.pdf) || !isFinite(result.value)) return {};
    if (m_lobe == Lobe::smooth) result.guidablePdf = result.pdf;
    return result;
  }

  Measurements m_data;
  float m_roughness;
  Lobe m_lobe;
};

// A table of two dimensions, of values of at least 0.
std::vector<float> readPlane(const TensorFile& file, const char* name, uint32_t (&size)[2]) {
  std::vector<float> values = file.floats(name);
  const std::vector<uint64_t>& shape = file.shape(name);
  if (shape.size() != 2 || shape[0] < 2 || shape[1] < 2 || values.size() > UINT32_MAX)
    file.refuse(name, file.shapeText(name) + " values", "a table of at least 2 x 2");
  for (const float value : values)
    if (!(value >= 0) || !std::isfinite(value))
      file.refuse(name, fmt::format("the value {}", value), "finite ones of at least 0");
  size[0] = uint32_t(shape[1]);
  size[1] = uint32_t(shape[0]);
  return values;
}

Measurements readMeasurements(const TensorFile& file) {
  if (file.has("wavelengths"))
    file.refuse("wavelengths", "spectra", "measurements in RGB, which have a field 'rgb' instead");
  Measurements data;
  data.phi = TableAxis(file, "phi_i", file.floats("phi_i"));
  data.theta = TableAxis(file, "theta_i", file.floats("theta_i"));
  data.visibleNormals = TableWarp(file, "vndf", data.phi, data.theta);
  data.luminance = TableWarp(file, "luminance", data.phi, data.theta);
  data.rgb = file.floats("rgb");
  const std::vector<uint64_t>& shape = file.shape("rgb");
  if (shape.size() != 5 || shape[0] != data.phi.size() || shape[1] != data.theta.size() || shape[2] != 3 ||
      shape[3] != shape[4] || shape[4] < 2 || shape[4] > UINT32_MAX)
    file.refuse("rgb", file.shapeText("rgb") + " values",
                fmt::format("{} x {} x 3 square tables", data.phi.size(), data.theta.size()));
  data.rgbSize = uint32_t(shape[4]);
  for (float& value : data.rgb) value = std::max(0.0f, value);
  data.normals = readPlane(file, "ndf", data.normalsSize);
  data.area = readPlane(file, "sigma", data.areaSize);
  data.byArea = file.bytes("jacobian")[0] != 0;
  data.isotropic = data.phi.size() <= 2;
  if (!data.isotropic)
    data.symmetry = int(std::lround(std::min(2 * kPi / (data.phi.last() - data.phi.first()), 4.0f)));
  return data;
}

}  // namespace

BsdfPtr makeMeasured(const Properties& properties, Builder& builder) {
  const SourceLocation& location = properties.placeOf("filename");
  const std::string path = builder.resolvePath(properties.string("filename"), location);
  return std::make_shared<Measured>(readMeasurements(TensorFile(path, location)));
}

}  // namespace odis::render
