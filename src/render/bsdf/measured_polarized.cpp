// measured_polarized: an isotropic measured surface, one-sided, of which the file says how it polarises
// light. Light is not polarised here: what is left is that of Mitsuba's unpolarised variants.
//
//   filename       string, of the measurements (".pbsdf")
//   wavelength     number, nanometres: the one that is drawn, in grey; required, as without it Mitsuba's
//                  variants without spectra refuse the model
//   alpha_sample   0 to 1, roughness of the GGX distribution that directions are sampled from; 0.1
//
// Baek et al. 2020, "Image-Based Acquisition and Modeling of Polarimetric Reflectance". The file holds
// Mueller matrices M over the angles of Rusinkiewicz (1998) and some wavelengths: of each the first element
// counts.
#include <fmt/format.h>

#include "render/bsdf/factories.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/parameter.h"
#include "render/bsdf/table_axis.h"
#include "render/math/warp.h"

namespace odis::render {
namespace {

constexpr float kDiffuseShare = 0.1f;  // of the samples

struct ReflectanceTable {
  TableAxis phiD, thetaD, thetaH;
  std::vector<float> values;  // [phiD][thetaD][thetaH]; not a number where nothing was measured

  float operator()(float phi, float theta, float half) const {
    const TableAxis::Position a = phiD.find(phi), b = thetaD.find(theta), c = thetaH.find(half);
    const auto row = [&](uint64_t i, uint64_t j) {
      const float* at = &values[(i * thetaD.size() + j) * thetaH.size() + c.first];
      return lerp(c.share, at[0], at[c.step]);
    };
    const auto plane = [&](uint64_t i) { return lerp(b.share, row(i, b.first), row(i, b.first + b.step)); };
    return std::max(0.0f, lerp(a.share, plane(a.first), plane(a.first + a.step)));
  }
};

class MeasuredPolarized final : public Bsdf {
 public:
  MeasuredPolarized(ReflectanceTable table, float alpha)
      : m_table(std::move(table)), m_facets(Microfacet::Type::ggx, alpha, alpha) {}

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const override {
    if (!(wo.z > 0)) return {};
    const bool diffuse = uLobe < kDiffuseShare;
    const Vec3 wi = diffuse ? squareToCosineHemisphere(u) : reflect(wo, m_facets.sample(wo, u));
    return finishSample(wi, evaluate(at, wo, wi), diffuse ? Lobe::smooth : m_facets.lobe());
  }

  BsdfValue evaluate(const SurfacePoint&, const Vec3& wo, const Vec3& wi) const override {
    if (!(wo.z > 0) || !(wi.z > 0)) return {};
    const Vec3 h = normalize(wo + wi);
    const float diffusePdf = kDiffuseShare * cosineHemispherePdf(wi.z);
    BsdfValue result;
    result.pdf = diffusePdf + (1 - kDiffuseShare) * m_facets.pdf(wo, h) / (4 * dot(wi, h));
    result.guidablePdf = m_facets.lobe() == Lobe::smooth ? result.pdf : diffusePdf;
    result.value = Rgb(reflectance(wi, h) * wi.z);
    return result;
  }

  float guidableProbability(const SurfacePoint&, const Vec3& wo) const override {
    if (!(wo.z > 0)) return 0;
    return m_facets.lobe() == Lobe::smooth ? 1 : kDiffuseShare;
  }

  // The albedo is that of a diffuse surface that is as bright 30 degrees away from the mirror direction.
  BsdfFeatures features(const SurfacePoint&, const Vec3&) const override {
    return {clampUnit(Rgb(kPi * m_table(0, 0, kPi / 12))), std::min(m_facets.alphaMax(), 1.0f)};
  }

 private:
  float reflectance(const Vec3& wi, const Vec3& h) const {
    // The frame about the half vector, whose first axis points away from the normal.
    const Vec3 bitangent = Vec3(-h.y, h.x, 0), tangent = cross(bitangent, h);
    const Vec3 projected = wi - h * dot(wi, h);
    const float phi = std::atan2(dot(bitangent, projected), dot(tangent, projected));
    return m_table(phi, safeAcos(dot(h, wi)), safeAcos(h.z));
  }
  static float safeAcos(float x) { return std::acos(std::clamp(x, -1.0f, 1.0f)); }

  ReflectanceTable m_table;
  Microfacet m_facets;
};

// The first element of all matrices, at one wavelength.
ReflectanceTable readTable(const TensorFile& file, float wavelength) {
  const auto axis = [&](const char* name) { return TableAxis(file, name, file.floats(name)); };
  ReflectanceTable table{axis("phi_d"), axis("theta_d"), axis("theta_h"), {}};
  const std::vector<uint16_t> nanometres = file.shorts("wvls");
  const TableAxis wavelengths(file, "wvls", {nanometres.begin(), nanometres.end()});
  const std::vector<uint64_t> expected = {
      table.phiD.size(), table.thetaD.size(), table.thetaH.size(), wavelengths.size(), 4, 4};
  const TensorFile::FloatView matrices = file.view("M");
  if (file.shape("M") != expected)
    file.refuse("M", file.shapeText("M") + " values",
                fmt::format("{}, as many as there are angles and wavelengths", fmt::join(expected, " x ")));
  const TableAxis::Position at = wavelengths.find(wavelength);
  table.values.resize(expected[0] * expected[1] * expected[2]);
  for (uint64_t i = 0; i < table.values.size(); ++i) {
    const uint64_t first = (i * wavelengths.size() + at.first) * 16;
    table.values[i] = lerp(at.share, matrices[first], matrices[first + 16 * at.step]);
    if (std::isinf(table.values[i])) file.refuse("M", "an infinite reflectance", "finite ones");
  }
  return table;
}

}  // namespace

BsdfPtr makeMeasuredPolarized(const Properties& properties, Builder& builder) {
  const SourceLocation& location = properties.placeOf("filename");
  const std::string path = builder.resolvePath(properties.string("filename"), location);
  const float wavelength = properties.number("wavelength", between(1, 100000)),
              alpha = properties.number("alpha_sample", kUnit, 0.1f);
  return std::make_shared<MeasuredPolarized>(readTable(TensorFile(path, location), wavelength), alpha);
}

}  // namespace odis::render
