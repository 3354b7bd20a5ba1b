// Scenes of many lights against sums of scenes of one: light adds up, whichever is chosen.
#include <gtest/gtest.h>

#include <cmath>

#include "integrator/test_scenes.h"

namespace odis::render {
namespace {

constexpr int kSize = 12;

// A floor and a matt and a glossy sphere under a box-shaped room's worth of lights.
std::string stage() {
  return test::sensor("origin=\"0,4,6\" target=\"0,0,0\" up=\"0,1,0\"", 45, kSize, kSize) +
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"6\"/><rotate x=\"1\" "
         "angle=\"-90\"/>"
         "</transform><bsdf type=\"diffuse\"/></shape>"
         "<shape type=\"sphere\"><point name=\"center\" x=\"-1\" y=\"0.7\" z=\"0\"/><float name=\"radius\" "
         "value=\"0.7\"/>"
         "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.2\"/></bsdf></shape>"
         "<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"0.7\" z=\"0\"/><float name=\"radius\" "
         "value=\"0.7\"/>"
         "<bsdf type=\"roughdielectric\"><float name=\"alpha\" value=\"0.3\"/></bsdf></shape>";
}

std::string number(float x) {
  return std::to_string(x);
}

// Little quadrilaterals that look every way, among them some that look away from everything; spheres, a disk;
// point and spot lights; an environment and a directional light.
std::vector<std::string> lights() {
  std::vector<std::string> result;
  const auto emission = [](int i) {
    return "<emitter type=\"area\"><rgb name=\"radiance\" value=\"" + number(float(5 + 7 * (i % 3))) +
           "\"/></emitter>";
  };
  for (int i = 0; i < 12; ++i)
    result.push_back("<shape type=\"" +
                     std::string(i % 4 == 3   ? "cube"
                                 : i % 4 == 2 ? "disk"
                                              : "rectangle") +
                     "\"><transform name=\"to_world\"><scale value=\"0.15\"/><rotate x=\"1\" angle=\"" +
                     number(float(i * 60)) + "\"/><translate x=\"" + number(float(i % 4) * 1.5f - 2) +
                     "\" y=\"" + number(1.5f + float(i % 3)) + "\" z=\"" + number(float(i) * 0.4f - 2) +
                     "\"/></transform>" + "<bsdf type=\"diffuse\"/>" + emission(i) + "</shape>");
  result.push_back(
      "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"2\" z=\"-1\"/><float name=\"radius\" "
      "value=\"0.3\"/><bsdf type=\"diffuse\"/>" +
      emission(1) + "</shape>");
  // A wide panel and a box close by, which directions find as often as the choice among lights does.
  for (const char* placed :
       {"rectangle\"><transform name=\"to_world\"><scale value=\"1.5\"/><rotate y=\"1\" "
        "angle=\"60\"/><translate "
        "x=\"-2.5\" y=\"1\" z=\"-1\"/>",
        "cube\"><transform name=\"to_world\"><scale value=\"0.5\"/><translate x=\"2.5\" y=\"0.8\" z=\"0\"/>"})
    result.push_back("<shape type=\"" + std::string(placed) +
                     "</transform><bsdf type=\"diffuse\"/><emitter type=\"area\"><rgb name=\"radiance\" "
                     "value=\"2\"/></emitter></shape>");
  // One that grazes the floor.
  result.push_back(
      "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0.2\" z=\"2\"/><rgb name=\"intensity\" "
      "value=\"20\"/></emitter>");
  result.push_back(
      "<emitter type=\"point\"><point name=\"position\" x=\"2\" y=\"2\" z=\"1\"/><rgb name=\"intensity\" "
      "value=\"3\"/></emitter>");
  result.push_back(
      "<emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"-3,3,0\" target=\"0,0,0\" "
      "up=\"0,0,1\"/></transform><rgb name=\"intensity\" value=\"9\"/></emitter>");
  result.push_back(
      "<emitter type=\"directional\"><vector name=\"direction\" x=\"0.3\" y=\"-1\" z=\"-0.2\"/><rgb "
      "name=\"irradiance\" value=\"0.4\"/></emitter>");
  result.push_back("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.1\"/></emitter>");
  return result;
}

struct Image {
  std::vector<double> mean, variance;  // of the mean
};

Image renderMany(const std::string& body, int seeds, int spp, int maxDepth) {
  const auto scene = test::loadScene(body);
  RenderOptions options;
  options.integrator = IntegratorKind::path;
  options.spp = spp;
  options.maxDepth = maxDepth;
  std::vector<double> sum(kSize * kSize), squares(kSize * kSize);
  for (int seed = 0; seed < seeds; ++seed) {
    options.seed = uint64_t(seed);
    const RenderResult result = test::renderScene(*scene, options);
    for (size_t i = 0; i < sum.size(); ++i) {
      const double value = result.image.color[i].y;
      sum[i] += value;
      squares[i] += value * value;
    }
  }
  Image image;
  for (size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / seeds;
    image.mean.push_back(mean);
    image.variance.push_back(std::max(squares[i] / seeds - mean * mean, 0.0) / (seeds - 1));
  }
  return image;
}

// Replaces every emission by black, so that the shapes stay where they are.
std::string darkened(std::string light) {
  for (const char* name : {"radiance", "intensity", "irradiance"}) {
    const size_t at = light.find(std::string("name=\"") + name + "\"");
    if (at == std::string::npos) continue;
    const size_t value = light.find("value=\"", at) + 7;
    light.replace(value, light.find('"', value) - value, "0");
  }
  return light;
}

// All lights at once, chosen by the tree, against the sum of images in which one alone is not black and so
// always chosen: the estimate without any choice. Two bounces, so that choices at both ends of a path take
// part.
TEST(ManyLights, AddUpToTheSumOfSingleLights) {
  const std::vector<std::string> all = lights();
  std::string together = stage();
  for (const std::string& light : all) together += light;
  const Image chosen = renderMany(together, 64, 32, 3);
  Image sum{std::vector<double>(kSize * kSize), std::vector<double>(kSize * kSize)};
  for (size_t lit = 0; lit < all.size(); ++lit) {
    std::string body = stage();
    for (size_t i = 0; i < all.size(); ++i) body += i == lit ? all[i] : darkened(all[i]);
    const Image one = renderMany(body, 32, 16, 3);
    for (size_t i = 0; i < sum.mean.size(); ++i) {
      sum.mean[i] += one.mean[i];
      sum.variance[i] += one.variance[i];
    }
  }
  double difference = 0, variance = 0, squares = 0;
  for (size_t i = 0; i < sum.mean.size(); ++i) {
    const double d = chosen.mean[i] - sum.mean[i], v = chosen.variance[i] + sum.variance[i];
    difference += d;
    variance += v;
    squares += v > 0 ? d * d / v : 0;
    EXPECT_LT(d * d, 36 * v + 1e-12) << "pixel " << i << ": " << chosen.mean[i] << " and " << sum.mean[i];
  }
  EXPECT_GT(std::erfc(std::abs(difference) / std::sqrt(2 * variance)), 0.01);
  const double n = kSize * kSize;
  EXPECT_LT(squares / n, 1 + 5 * 1.25 * std::sqrt(2 / n) + 0.1);
}

// Lights that cannot be hit by chance: irradiance E on a white floor gives radiance E / pi * albedo.
TEST(ManyLights, OnlyDeltaLights) {
  const std::string body =
      test::sensor("origin=\"0,5,0\" target=\"0,0,0\" up=\"0,0,1\"", 1, kSize, kSize) +
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"50\"/><rotate x=\"1\" "
      "angle=\"-90\"/>"
      "</transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf></shape>"
      // One above, one to the side at 45 degrees, one below, where it gives nothing.
      "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"2\" z=\"0\"/><rgb name=\"intensity\" "
      "value=\"4\"/></emitter>"
      "<emitter type=\"point\"><point name=\"position\" x=\"3\" y=\"3\" z=\"0\"/><rgb name=\"intensity\" "
      "value=\"9\"/></emitter>"
      "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"-1\" z=\"0\"/><rgb name=\"intensity\" "
      "value=\"99\"/></emitter>"
      "<emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"-1\" z=\"0\"/><rgb "
      "name=\"irradiance\" value=\"2\"/></emitter>";
  const Image image = renderMany(body, 32, 64, 2);
  // 4 / 2^2, 9 / (9 + 9) cos 45, and 2.
  const double expected = (1 + 0.5 * std::sqrt(0.5) + 2) / M_PI * 0.5;
  double mean = 0, variance = 0;
  for (size_t i = 0; i < image.mean.size(); ++i) {
    mean += image.mean[i] / (kSize * kSize);
    variance += image.variance[i] / std::pow(kSize, 4);
  }
  // The footprint of the pixels moves the irradiance by less than one part in a thousand.
  EXPECT_NEAR(mean, expected, 4 * std::sqrt(variance) + 1e-3 * expected);
}

TEST(ManyLights, WithoutLightThereIsBlack) {
  for (const double value : renderMany(stage(), 2, 2, -1).mean) EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace odis::render
