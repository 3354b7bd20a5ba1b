#include "render/bsdf/parameter.h"

#include <fmt/format.h>

#include "render/bsdf/fresnel.h"
#include "render/bsdf/ior.h"
#include "render/scene/builder.h"
#include "render/xml/names.h"

namespace odis::render {

Rgb RgbParameter::lookUp(const SurfacePoint& at) const {
  if (at.texture != m_texture.get()) {
    at.texture = m_texture.get();
    at.textureValue = m_texture->rgbAt(at);
  }
  return m_clamped ? clampUnit(at.textureValue) : at.textureValue;
}

float ScalarParameter::lookUp(const SurfacePoint& at) const {
  return clamped(m_texture->scalarAt(at));
}

RgbParameter readReflectance(const Properties& properties, Builder& builder, const std::string& name,
                             float fallback) {
  const RgbParameter result(
      builder.texture(properties, name, {"colour or texture", kUnit, "", true}, Rgb(fallback)), true);
  if (!result.isConstant()) return result;
  const Rgb clamped = clampUnit(result.mean());
  if (clamped == result.mean()) return result;
  builder.warn(properties.placeOf(name),
               fmt::format("\"{}\" of {} is outside [0, 1] and was clamped", name, properties.type));
  return clamped;
}

RgbParameter readDiffuseReflectance(const Properties& properties, Builder& builder) {
  const char* const other = "diffuse_reflectance";
  const RgbParameter reflectance = readReflectance(properties, builder, "reflectance", 0.5f),
                     otherwise = readReflectance(properties, builder, other, 0.5f);
  return properties.has(other) || properties.child("texture", other) ? otherwise : reflectance;
}

ScalarParameter readScalar(const Properties& properties, Builder& builder, const std::string& name,
                           const NumberRange& range, float fallback) {
  return {builder.texture(properties, name, {"number or texture", range}, Rgb(fallback)), range};
}

RoughnessParameters readRoughness(const Properties& properties, Builder& builder) {
  RoughnessParameters result;
  const std::string distribution = properties.word("distribution", "beckmann|ggx|phong|as", "beckmann");
  if (distribution == "ggx") {
    result.type = Microfacet::Type::ggx;
  } else if (distribution == "phong" || distribution == "as") {
    builder.warn(properties.placeOf("distribution"),
                 "the \"" + distribution +
                     "\" distribution of microfacets is drawn as the \"beckmann\" distribution "
                     "of the same roughness");
  }
  result.sampleVisible = properties.boolean("sample_visible", true);
  const auto read = [&](const char* name, const char* otherwise) {
    return builder.optionalTexture(properties, name,
                                   {.type = "number or texture", .range = kUnit, .otherwise = otherwise});
  };
  const TexturePtr alpha = read("alpha", "0.1"), alphaU = read("alpha_u", "alpha"),
                   alphaV = read("alpha_v", "alpha");
  if (!alphaU != !alphaV)
    throw SceneError(properties.location, "\"alpha_u\" and \"alpha_v\" must be given together");
  if (alpha && alphaU)
    throw SceneError(properties.location,
                     "found both \"alpha\" and \"alpha_u\", \"alpha_v\", expected one or the other");
  if (alphaU) {
    result.alphaU = ScalarParameter(alphaU, kUnit);
    result.alphaV = ScalarParameter(alphaV, kUnit);
    result.anisotropic = true;
  } else {
    result.alphaU = result.alphaV = alpha ? ScalarParameter(alpha, kUnit) : ScalarParameter(0.1f);
  }
  return result;
}

RoughnessParameters readConstantRoughness(const Properties& properties, Builder& builder) {
  RoughnessParameters result = readRoughness(properties, builder);
  if (result.alphaU.mean() != result.alphaV.mean())
    throw SceneError(properties.location,
                     "found different \"alpha_u\" and \"alpha_v\", but " + properties.type + " is isotropic");
  if (!result.alphaU.isConstant())
    builder.warn(properties.location,
                 "the roughness of " + properties.type + " cannot vary; the texture's average is used");
  return result;
}

float readRelativeIor(const Properties& properties, const std::string& interior,
                      const std::string& exterior) {
  return readIor(properties, "int_ior", interior) / readIor(properties, "ext_ior", exterior);
}

Rgb ComplexIor::reflectance(const SurfacePoint& at, float cosTheta) const {
  return fresnelConductor(cosTheta, eta(at) * scale, k(at) * scale);
}

ComplexIor readComplexIor(const Properties& properties, Builder& builder) {
  ComplexIor result;
  const std::string material = properties.string("material", "none");
  // Mirrors are made with a large k.
  // Spectra of coloured metals have negative channels in linear sRGB. Fresnel's equations take the squares.
  const auto read = [&](const char* name, const char* otherwise) {
    return builder.optionalTexture(
        properties, name, {.type = "colour or texture", .range = between(-1e6, 1e6), .otherwise = otherwise});
  };
  const TexturePtr eta = read("eta", "0, or material's"), k = read("k", "1, or material's");
  if (eta || k || material == "none") {
    if (material != "none")
      builder.warn(properties.location, "found both \"material\" and \"eta\", \"k\"; the material is ignored",
                   Effect::same);
    result.eta = eta ? RgbParameter(eta) : RgbParameter(Rgb(0.0f));
    result.k = k ? RgbParameter(k) : RgbParameter(Rgb(1.0f));
  } else {
    const Metal* metal = findMetal(material);
    if (!metal)
      properties.refuse("material", "'" + material + "'",
                        "a metal such as \"Au\", \"Ag\", \"Al\", \"Cu\", or \"none\"");
    result.eta = Rgb(metal->eta[0], metal->eta[1], metal->eta[2]);
    result.k = Rgb(metal->k[0], metal->k[1], metal->k[2]);
  }
  result.scale = 1 / readIor(properties, "ext_eta", "vacuum");
  return result;
}

}  // namespace odis::render
