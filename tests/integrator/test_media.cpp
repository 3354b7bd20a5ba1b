// Paths through participating media: images that are known on paper, those of Mitsuba, and guided ones.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "integrator/adversarial_model.h"
#include "integrator/foggy_room.h"
#include "integrator/media_scenes.h"
#include "integrator/same_expectation.h"

namespace odis::render {
namespace {

using test::loadScene, test::renderScene;

RenderOptions pathOptions(int spp) {
  RenderOptions options;
  options.integrator = IntegratorKind::path;
  options.spp = spp;
  return options;
}
RenderOptions pathOptions(int spp, int maxDepth) {
  RenderOptions options = pathOptions(spp);
  options.maxDepth = maxDepth;
  return options;
}

Rgbd meanOf(const std::vector<Rgb>& image) {
  Rgbd sum(0, 0, 0);
  for (const Rgb& c : image) sum += Rgbd(c.x, c.y, c.z);
  return sum / double(image.size());
}
void expectMean(const std::vector<Rgb>& image, const Rgbd& expected, double relativeTolerance) {
  const Rgbd mean = meanOf(image);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], expected[c], relativeTolerance * expected[c]) << c;
}

// The camera looks along -z, all but orthogonally, at a slab from z = 0 to z = 2 under an even sky.
std::string slab(const std::string& medium, const std::string& light) {
  return test::sensor("origin=\"0,0,300\" target=\"0,0,0\" up=\"0,1,0\"", 0.01f, 4, 4) +
         "<shape type=\"cube\"><transform name=\"to_world\"><scale x=\"1000\" y=\"1000\"/>"
         "<translate z=\"1\"/></transform><bsdf type=\"null\"/>" +
         medium + "</shape>" + light;
}
std::string homogeneous(const std::string& extinction, const std::string& albedo,
                        const std::string& more = "") {
  return "<medium name=\"interior\" type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"" + extinction +
         "\"/><rgb name=\"albedo\" value=\"" + albedo + "\"/>" + more + "</medium>";
}
constexpr char kWhiteSky[] = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>";

TEST(Media, SlabsAbsorbExponentially) {
  // Transmittance exp(-sigma_t 2) of each channel.
  const Rgbd expected(std::exp(-0.4), std::exp(-1.0), std::exp(-2.0));
  for (const std::string medium :
       {homogeneous("0.2, 0.5, 1", "0"),
        homogeneous("0.02, 0.05, 0.1", "0", "<float name=\"scale\" value=\"10\"/>")})
    expectMean(renderScene(*loadScene(slab(medium, kWhiteSky)), pathOptions(4096)).image.color, expected,
               0.01);
}

TEST(Media, SlabsScatterOnce) {
  // Light falls straight down upon the slab with the irradiance E: at the depth z it is E exp(-s z), a share
  // albedo s / (4 pi) of which turns back to the camera, so that L = albedo E / (8 pi) (1 - exp(-2 s d)).
  const auto scene = loadScene(slab(homogeneous("0.5", "0.8"),
                                    "<emitter type=\"directional\"><vector name=\"direction\" z=\"-1\"/>"
                                    "<rgb name=\"irradiance\" value=\"10\"/></emitter>"));
  const double expected = 0.8 * 10 / (8 * M_PI) * (1 - std::exp(-2 * 0.5 * 2));
  expectMean(renderScene(*scene, pathOptions(4096, 2)).image.color, Rgbd(expected), 0.01);
}

TEST(Media, WhiteFurnace) {
  // What absorbs nothing can't be seen under an even sky, whatever it scatters to where. With decisions that
  // the channels share their mean is known much better than each of them.
  for (const std::string phase :
       {"<phase type=\"isotropic\"/>", "<phase type=\"hg\"><float name=\"g\" value=\"0.9\"/></phase>",
        "<phase type=\"hg\"><float name=\"g\" value=\"-0.5\"/></phase>", "<phase type=\"rayleigh\"/>",
        "<phase type=\"tabphase\"><string name=\"values\" value=\"1, 0.2, 2\"/></phase>"})
    for (const std::string bsdf : {"<bsdf type=\"null\"/>", "<bsdf type=\"dielectric\"/>"}) {
      const auto scene = loadScene(test::sensor("origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"", 40, 8, 8) +
                                   "<shape type=\"sphere\">" + bsdf + homogeneous("1, 2, 3", "1", phase) +
                                   "</shape>" + kWhiteSky);
      const Rgbd mean = meanOf(renderScene(*scene, pathOptions(512)).image.color);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 1, 0.05);
      EXPECT_NEAR((mean.x + mean.y + mean.z) / 3, 1, 0.01);
    }
}

TEST(Media, WhiteFurnaceOfMicroflakes) {
  const test::TemporaryFolder folder;
  test::writeVolume(folder.path("S.vol"), 2, 6,
                    [](int, int, int, int channel) { return channel < 3 ? std::pow(0.25, channel) : 0; });
  const std::string phase =
      "<phase type=\"sggx\"><volume name=\"S\" type=\"gridvolume\"><string "
      "name=\"filename\" value=\"" +
      folder.path("S.vol") + "\"/></volume></phase>";
  const auto scene = loadScene(test::sensor("origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"", 40, 8, 8) +
                               "<shape type=\"sphere\"><bsdf type=\"null\"/>" + homogeneous("3", "1", phase) +
                               "</shape>" + kWhiteSky);
  const Rgbd mean = meanOf(renderScene(*scene, pathOptions(512)).image.color);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 1, 0.01);
}

TEST(Media, PathsEndByDepthAsWithoutThem) {
  // Boundaries count for nothing: with depth 1 the sky is seen through them.
  const auto scene = loadScene(slab(homogeneous("0.5", "0.9"), kWhiteSky));
  expectMean(renderScene(*scene, pathOptions(4096, 1)).image.color, Rgbd(std::exp(-1.0)), 0.01);
}

TEST(Media, SameBitsForAnyNumberOfThreads) {
  const auto scene = test::loadMediaScene("colored-smoke");
  for (const IntegratorKind kind : {IntegratorKind::path, IntegratorKind::odis}) {
    RenderOptions options = pathOptions(8);
    options.integrator = kind;
    options.threads = 1;
    const RenderResult one = renderScene(*scene, options);
    options.threads = 3;
    EXPECT_TRUE(test::sameBits(one.image.color, renderScene(*scene, options).image.color));
  }
}

// Means of blocks of 8 x 8 pixels as Mitsuba 3.9.1's volpathmis has them, and their standard errors, by
// bench/media_references.py.
class MediaOfMitsuba : public ::testing::TestWithParam<std::string> {};

TEST_P(MediaOfMitsuba, BlocksAgree) {
  std::ifstream file(ODIS_TEST_DATA "/media/references.json");
  const nlohmann::json all = nlohmann::json::parse(file), &reference = all.at(GetParam());
  const auto scene = test::loadMediaScene(GetParam());
  constexpr int kBlocks = 4, kSize = 32 / kBlocks, kSeeds = 12;
  std::vector<double> sums(kBlocks * kBlocks * 3), squares(sums.size());
  for (int seed = 0; seed < kSeeds; ++seed) {
    RenderOptions options = pathOptions(64, scene->integrator().maxDepth);
    options.rrDepth = scene->integrator().rrDepth;
    options.seed = uint64_t(seed);
    const std::vector<Rgb> image = renderScene(*scene, options).image.color;
    std::vector<double> blocks(sums.size());
    for (size_t i = 0; i < image.size(); ++i) {
      const size_t block = i / 32 / kSize * kBlocks + i % 32 / kSize;
      for (size_t c = 0; c < 3; ++c) blocks[3 * block + c] += double(image[i][int(c)]) / (kSize * kSize);
    }
    for (size_t i = 0; i < blocks.size(); ++i) {
      sums[i] += blocks[i] / kSeeds;
      squares[i] += blocks[i] * blocks[i] / kSeeds;
    }
  }
  // Significance .01 over all blocks of all scenes: standard errors of 12 seeds are uncertain, so that the
  // bound is that of Student's distribution with 11 degrees of freedom, and of the mean of the squares.
  double total = 0;
  for (size_t i = 0; i < sums.size(); ++i) {
    const double expected = reference.at("mean")[i], error = reference.at("error")[i];
    const double variance = std::max(squares[i] - sums[i] * sums[i], 0.0) / (kSeeds - 1) + error * error;
    const double z = (sums[i] - expected) / (std::sqrt(variance) + 1e-5 * expected + 1e-9);
    EXPECT_LT(std::abs(z), 9) << "block " << i / 3 << " channel " << i % 3 << ": " << sums[i] << ", expected "
                              << expected;
    total += z * z;
  }
  EXPECT_LT(total / double(sums.size()), 2.5);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MediaOfMitsuba,
                         ::testing::Values("fog-room", "milk-in-glass", "cloud", "colored-smoke", "phases",
                                           "panes", "hidden-lights", "spots", "instances", "nested-media",
                                           "microflakes", "cube-of-jelly"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

class GuidedInFog : public test::AgainstPath<test::FoggyRoom> {};
constexpr int kGuidedTests = 5;

TEST_F(GuidedInFog, Histogram) {
  expectUnbiased(guidedOptions(), 96, kGuidedTests);
}

TEST_F(GuidedInFog, RoughGuesses) {
  RenderOptions options = guidedOptions();
  options.set("pilot-spp=0.25");
  expectUnbiased(options, 96, kGuidedTests);
}

TEST_F(GuidedInFog, AdversarialMaps) {
  using Kind = test::AdversarialModel::Kind;
  for (const Kind kind : {Kind::random, Kind::oneHot, Kind::notANumber}) {
    RenderOptions options = guidedOptions();
    options.model = test::makeModel(std::make_shared<test::AdversarialModel>(kind), nullptr);
    options.set("bsdf-fraction=0.6");
    options.set("refine=1");
    expectUnbiased(options, 192, kGuidedTests);
  }
}

}  // namespace
}  // namespace odis::render
