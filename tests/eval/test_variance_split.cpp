// The split of variance, on scenes whose variance is known on paper.
#include "eval/variance_split.h"

#include <gtest/gtest.h>

#include <map>

#include "eval/metrics.h"
#include "integrator/same_expectation.h"
#include "render/emitter/light_sampler.h"

namespace odis::eval {
namespace {

using namespace render;

RenderOptions options(IntegratorKind integrator, int maxDepth, int rrDepth = 100) {
  RenderOptions o;
  o.integrator = integrator;
  o.maxDepth = maxDepth;
  o.rrDepth = rrDepth;
  return o;
}

VarianceSplit split(const Scene& scene, const RenderOptions& options, Rgb expected, int samples) {
  const Crop& crop = scene.film().crop;
  Progress quiet;
  return splitVariance(
      scene, options, {crop.width, crop.height, std::vector<Rgb>(size_t(crop.width) * crop.height, expected)},
      samples, quiet);
}

size_t indexOf(const std::string& column) {
  for (size_t i = 0; i < causes().size(); ++i)
    if (causes()[i].column == column) return i;
  ADD_FAILURE() << column;
  return 0;
}

// Every share is that of the causes named here, all others are zero. Standard errors of a single test at
// significance 0.01, over some 40 comparisons in this file: 4.
constexpr double kErrors = 4;
void expectShares(const VarianceSplit& split, const std::map<std::string, double>& expected) {
  ASSERT_EQ(split.shares.size(), causes().size());
  for (size_t i = 0; i < causes().size(); ++i) {
    const auto found = expected.find(causes()[i].column);
    const double share = found == expected.end() ? 0 : found->second;
    EXPECT_NEAR(split.shares[i].value, share, kErrors * split.shares[i].error + 2e-4) << causes()[i].name;
  }
}

std::string narrowSensor(int size) {
  return test::sensor("origin=\"0,1,0.001\" target=\"0,0,0\" up=\"0,0,1\"", 0.02f, size, size);
}
const std::string kFloor =
    "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"10\"/><rotate x=\"1\" "
    "angle=\"-90\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
    "value=\"0.5\"/></bsdf></shape>";

std::string pointLight(const std::string& position, const std::string& intensity) {
  return "<emitter type=\"point\"><point name=\"position\" value=\"" + position +
         "\"/><rgb name=\"intensity\" value=\"" + intensity + "\"/></emitter>";
}

TEST(VarianceSplit, TwoPointLightsAreAChoice) {
  // A floor of reflectance 0.5 in the origin under point lights of intensity I at distance d, each seen at
  // the angle theta, scatters c = 0.5 / pi I cos(theta) / d^2 of each. Chosen with probability p, the
  // channel's variance is the sum of c^2 / p less the square of the sum of c.
  const auto scene = test::loadScene(narrowSensor(16) + kFloor + pointLight("0,2,0", "9,1,1") +
                                     pointLight("2,2,0", "1,1,20"));
  const LightSampler lights(scene->emitters());
  const LightReference reference{Vec3(0, 0, 0), Vec3(0, 1, 0), false};
  const double share[2] = {0.5 / kPi / 4, 0.5 / kPi * std::sqrt(0.5) / 8};  // of the intensity
  const Rgb intensity[2] = {Rgb(9, 1, 1), Rgb(1, 1, 20)};
  Rgbd mean(0, 0, 0), square(0, 0, 0);
  for (int i = 0; i < 2; ++i) {
    const double p = double(lights.probability(reference, *scene->emitters()[size_t(i)], 0, {0.5f, 0.5f}));
    ASSERT_GT(p, 0.1);
    const Rgbd c = Rgbd(intensity[i].x, intensity[i].y, intensity[i].z) * share[i];
    mean += c;
    square += c * c / p;
  }
  const Rgb expected(float(mean.x), float(mean.y), float(mean.z));
  const double scale = 1 / double(luminance(expected));
  double variance = 0;
  for (int c = 0; c < 3; ++c)
    variance +=
        scale * scale * (square[c] - mean[c] * mean[c]) / (scale * scale * mean[c] * mean[c] + 0.01) / 3;
  ASSERT_GT(variance, 0.1);

  const VarianceSplit result = split(*scene, options(IntegratorKind::path, 2), expected, 64);
  EXPECT_NEAR(result.variance.value, variance, kErrors * result.variance.error);
  EXPECT_LT(result.variance.error, 0.02 * variance);
  expectShares(result, {{"1st light", 1}, {"all lights", 1}, {"all NEE", 1}, {"after camera", 1}});
  EXPECT_NEAR(result.raysPerSample, 3, 1e-9);  // from the camera, to a light and on
}

TEST(VarianceSplit, AnAreaLightIsAPointAndADirection) {
  // Next-event estimation and the direction's ray each bring a part of the light, MIS between them: two
  // independent terms, so the shares of the two add up to one exactly and both are there.
  const auto scene = test::loadScene(
      narrowSensor(16) + kFloor +
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.8\"/><rotate x=\"1\" "
      "angle=\"90\"/><translate y=\"2\"/></transform><emitter type=\"area\"><rgb name=\"radiance\" "
      "value=\"5\"/></emitter></shape>");
  RenderOptions o = options(IntegratorKind::path, 2);
  o.spp = 1024;
  const Rgb expected = test::renderScene(*scene, o).image.color[0];
  const VarianceSplit result = split(*scene, o, expected, 128);
  const double point = result.shares[indexOf("1st point")].value;
  EXPECT_GT(point, 0.03);
  EXPECT_LT(point, 0.97);
  expectShares(result, {{"1st point", point},
                        {"all NEE", point},
                        {"1st direction", 1 - point},
                        {"all directions", 1 - point},
                        {"after camera", 1}});
}

TEST(VarianceSplit, RouletteAlone) {
  // Inside of a mirror of reflectance 0.5 that emits 1, roulette from the first vertex on: a path survives
  // with 1/2 and brings 1 at each vertex, so it brings 2 on average and has the geometric distribution's
  // variance, 2.
  const auto scene =
      test::loadScene(test::furnace("<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/><rgb "
                                    "name=\"specular_reflectance\" value=\"0.5\"/></bsdf>"));
  const VarianceSplit result = split(*scene, options(IntegratorKind::path, -1, 1), Rgb(2), 256);
  const double variance = 2.0 / 4 / 1.01;
  EXPECT_NEAR(result.variance.value, variance, kErrors * result.variance.error);
  EXPECT_LT(result.variance.error, 0.05 * variance);
  expectShares(result, {{"roulette", 1}, {"after 1st direction", 1}, {"after camera", 1}});
}

TEST(VarianceSplit, NothingWhereNothingIsRandom) {
  // The same mirror without roulette: 1 + 1/2 + 1/4.
  const auto scene =
      test::loadScene(test::furnace("<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/><rgb "
                                    "name=\"specular_reflectance\" value=\"0.5\"/></bsdf>"));
  const VarianceSplit result = split(*scene, options(IntegratorKind::path, 3), Rgb(1.75f), 4);
  EXPECT_LT(result.variance.value, 1e-9);
  const VarianceSplit black = split(*scene, options(IntegratorKind::path, 0), Rgb(0), 4);
  EXPECT_EQ(black.variance.value, 0);
  for (const Estimated& share : black.shares) EXPECT_EQ(share.value, 0);
}

TEST(VarianceSplit, AnEdgeIsThePixels) {
  // A pixel that is half covered by an emitter: 0 or 2 around a mean of 1.
  const auto scene =
      test::loadScene(test::sensor("origin=\"0,0,1\" target=\"0,0,0\" up=\"0,1,0\"", 40, 1, 1) +
                      "<shape type=\"rectangle\"><transform name=\"to_world\"><translate x=\"1\"/><scale "
                      "value=\"5\"/></transform>"
                      "<emitter type=\"area\"><rgb name=\"radiance\" value=\"2\"/></emitter></shape>");
  const VarianceSplit result = split(*scene, options(IntegratorKind::path, 1), Rgb(1), 4096);
  EXPECT_NEAR(result.variance.value, 1 / 1.01, kErrors * result.variance.error + 1e-3);
  expectShares(result, {{"pixel, lens", 1}, {"emission", 1}});
}

class VarianceSplitRoom : public ::testing::TestWithParam<IntegratorKind> {};

// The variance by the numbers that are all redrawn is the one that the renderer estimates from independent
// samples, and a union has no less of it than each of its parts.
TEST_P(VarianceSplitRoom, AddsUp) {
  const auto scene = test::loadScene(test::indirectRoom());
  RenderOptions o = options(GetParam(), 6, 3);
  o.spp = 2;
  RenderOptions many = o;
  many.sampler = SamplerKind::independent;
  many.spp = 512;
  many.set("refine=0");
  many.set("pilot-weight=0");  // the guided samples' variance
  many.variance = true;
  many.seed = 99;
  const RenderedImage frame = test::renderScene(*scene, many).image;
  const ColorImage reference{frame.width, frame.height, frame.color};
  const std::vector<Rgbd> weights = relMseWeights(reference);
  const double samples = GetParam() == IntegratorKind::odis ? 511 : 512;
  double variance = 0;
  for (size_t i = 0; i < weights.size(); ++i)
    for (int c = 0; c < 3; ++c)
      variance += samples * frame.variance[i][c] * weights[i][c] / double(weights.size());

  Progress quiet;
  const VarianceSplit result = splitVariance(*scene, o, reference, 320, quiet);
  EXPECT_LT(result.variance.error, 0.06 * variance);
  // Another seed learned another guide, whose variance differs by some per cent.
  const double guides = GetParam() == IntegratorKind::odis ? 0.05 * variance : 0;
  EXPECT_NEAR(result.variance.value, variance,
              kErrors * std::hypot(result.variance.error, 0.01 * variance) + guides);

  for (size_t whole = 0; whole < causes().size(); ++whole) {
    if (causes()[whole].emission) continue;  // not of the whole sample
    EXPECT_LE(result.shares[whole].value, 1 + kErrors * result.shares[whole].error);
    for (size_t part = 0; part < causes().size(); ++part)
      if ((causes()[part].purposes & ~causes()[whole].purposes) == 0)
        EXPECT_LE(
            result.shares[part].value,
            result.shares[whole].value + kErrors * (result.shares[part].error + result.shares[whole].error))
            << causes()[part].name << " in " << causes()[whole].name;
  }
  EXPECT_GT(result.shares[indexOf("later direction")].value, 0.05);
  EXPECT_GT(result.shares[indexOf("1st direction")].value, 0.05);
}

TEST_P(VarianceSplitRoom, IsTheSameForAnyNumberOfThreads) {
  const auto scene = test::loadScene(test::indirectRoom(40));
  RenderOptions o = options(GetParam(), 6, 3);
  o.threads = 1;
  const VarianceSplit one = split(*scene, o, Rgb(1), 2);
  o.threads = 3;
  const VarianceSplit three = split(*scene, o, Rgb(1), 2);
  EXPECT_GT(one.variance.value, 0);
  EXPECT_EQ(one.variance.value, three.variance.value);
  EXPECT_EQ(one.varianceMap, three.varianceMap);
  EXPECT_EQ(one.maps, three.maps);
  for (size_t i = 0; i < causes().size(); ++i) EXPECT_EQ(one.shares[i].value, three.shares[i].value);
}

INSTANTIATE_TEST_SUITE_P(Methods, VarianceSplitRoom,
                         ::testing::Values(IntegratorKind::path, IntegratorKind::odis), [](const auto& info) {
                           return info.param == IntegratorKind::path ? "path" : "odis";
                         });

TEST(VarianceSplit, RefusesWhatHasNoSamples) {
  const auto scene = test::loadScene(test::indirectRoom(8));
  EXPECT_THROW(split(*scene, options(IntegratorKind::restir, 4), Rgb(1), 2), OptionError);
  RenderOptions o = options(IntegratorKind::odis, 4);
  o.set("pilot-spp=" + std::to_string(o.spp));
  EXPECT_THROW(split(*scene, o, Rgb(1), 2), OptionError);
  Progress quiet;
  EXPECT_THROW(splitVariance(*scene, options(IntegratorKind::path, 4), {1, 1, {Rgb(1)}}, 2, quiet),
               std::invalid_argument);
}

}  // namespace
}  // namespace odis::eval
