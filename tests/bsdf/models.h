// The models under test, made by their factories from data/models.json.
#pragma once

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "render/bsdf/factories.h"
#include "render/bsdf/parameter.h"

namespace odis::render {

inline std::shared_ptr<Properties> propertiesOf(const nlohmann::json& json, const std::string& tag = "bsdf") {
  auto result = std::make_shared<Properties>();
  result->tag = tag;
  result->type = json.at("type");
  for (const auto& [name, value] : json.items()) {
    if (name == "type") continue;
    if (value.is_object()) {
      result->children.push_back({name, propertiesOf(value)});
      continue;
    }
    Properties::Parameter& parameter = result->parameters[name];
    if (value.is_boolean())
      parameter.value = value.get<bool>();
    else if (value.is_string())
      parameter.value = value.get<std::string>();
    else if (value.is_array())
      parameter.value = Rgb(value[0], value[1], value[2]);
    else
      parameter.value = value.get<double>();
  }
  return result;
}

inline BsdfPtr makeModel(const nlohmann::json& json, Warnings& warnings) {
  // Children live as long as the builder, which remembers them by address.
  const auto properties = propertiesOf(json);
  Builder builder(warnings, {ODIS_TEST_DATA});
  const BsdfFactory factory = findBsdfFactory(properties->type);
  if (!factory) throw std::runtime_error("no factory for " + properties->type);
  return factory(*properties, builder);
}

inline BsdfPtr makeModel(const nlohmann::json& json) {
  Warnings warnings;
  BsdfPtr result = makeModel(json, warnings);
  EXPECT_TRUE(warnings.texts().empty()) << warnings.texts()[0];
  return result;
}

inline const std::map<std::string, BsdfPtr>& allModels() {
  static const std::map<std::string, BsdfPtr> models = [] {
    std::map<std::string, BsdfPtr> result;
    std::ifstream file(ODIS_TEST_DATA "/models.json");
    const nlohmann::json all = nlohmann::json::parse(file);
    for (const auto& [name, json] : all.items()) result[name] = makeModel(json);
    return result;
  }();
  return models;
}

// A point on the plane z = 0.
inline SurfacePoint flatPoint(const Vec2& uv = {0.3f, 0.7f}) {
  SurfacePoint at;
  at.ng = Vec3(0, 0, 1);
  at.uv = uv;
  at.dpdu = Vec3(1, 0, 0);
  at.dpdv = Vec3(0, 1, 0);
  return at;
}

inline Vec3 direction(float cosTheta, float phi) {
  const float s = safeSqrt(1 - cosTheta * cosTheta);
  return {s * std::cos(phi), s * std::sin(phi), cosTheta};
}

// Where light may leave: some angles, on both sides where the model has two.
inline std::vector<Vec3> outgoing(const std::string& name) {
  std::vector<Vec3> result = {direction(0.95f, 0.4f), direction(0.6f, 2.0f), direction(0.2f, 4.0f)};
  for (const char* part : {"dielectric", "glass", "twosided"})
    if (name.find(part) != std::string::npos) {
      result.push_back(direction(-0.8f, 1.0f));
      result.push_back(direction(-0.3f, 3.0f));
      break;
    }
  return result;
}

class Uniform {
 public:
  explicit Uniform(uint64_t seed) : m_engine(seed) {}
  float next() { return std::min(m_uniform(m_engine), kOneMinusEpsilon); }
  Vec2 next2() {
    const float x = next();
    return {x, next()};
  }

 private:
  std::mt19937_64 m_engine;
  std::uniform_real_distribution<float> m_uniform{0.0f, 1.0f};
};

}  // namespace odis::render
