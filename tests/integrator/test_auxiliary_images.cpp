// What the denoiser is told of a scene.
#include "render/integrators/auxiliary_images.h"

#include <gtest/gtest.h>

#include <cmath>

#include "integrator/media_scenes.h"
#include "integrator/test_scenes.h"

namespace odis::render {
namespace {

AuxiliaryImages auxiliaries(const Scene& scene, int threads = 0) {
  Progress quiet;
  return renderAuxiliaries(scene, 7, threads, quiet);
}

std::string diffuse(const std::string& color) {
  return R"(<bsdf type="diffuse"><rgb name="reflectance" value=")" + color + R"("/></bsdf>)";
}

// A rectangle across the view, `depth` before the camera, which looks along -z from the origin.
std::string screen(const std::string& bsdf, float depth) {
  return R"(<shape type="rectangle"><transform name="to_world"><scale value="9"/><translate z="-)" +
         std::to_string(depth) + R"("/></transform>)" + bsdf + "</shape>";
}

// What is behind the camera.
std::string wallBehind(const std::string& bsdf) {
  return R"(<shape type="rectangle"><transform name="to_world"><scale value="99"/>)"
         R"(<rotate x="1" angle="180"/><translate z="5"/></transform>)" +
         bsdf + "</shape>";
}

std::string camera(int size = 16) {
  return test::sensor(R"(origin="0,0,0" target="0,0,-1" up="0,1,0")", 40, size, size);
}

void expectAlbedo(const AuxiliaryImages& images, const Rgb& expected) {
  ASSERT_EQ(images.albedo.size(), 256u);
  for (const Rgb& albedo : images.albedo)
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(albedo[c], expected[c], 1e-5f);
}

TEST(AuxiliaryImages, ShowWhatIsSeenInMirrors) {
  const auto scene = test::loadScene(camera() + screen(R"(<bsdf type="conductor"/>)", 3) +
                                     wallBehind(diffuse("0.5 0.2 0.1")));
  const AuxiliaryImages images = auxiliaries(*scene);
  expectAlbedo(images, {0.5f, 0.2f, 0.1f});
  for (const Vec3& normal : images.normal) ASSERT_NEAR(normal.z, -1, 1e-5f);
}

TEST(AuxiliaryImages, ShowMediaAndWhatIsSeenThroughThem) {
  // The fog has the albedo .9, the walls have .6; the lamp reflects nothing.
  const auto scene = test::loadMediaScene("fog-room");
  const AuxiliaryImages images = auxiliaries(*scene);
  float sum = 0;
  for (const Rgb& albedo : images.albedo) {
    ASSERT_GT(albedo.x, 0.2f);
    ASSERT_LE(albedo.x, 0.91f);
    sum += albedo.x;
  }
  EXPECT_NEAR(sum / float(images.albedo.size()), 0.75f, 0.1f);
}

TEST(AuxiliaryImages, ShowWhatCoatsCover) {
  const auto scene = test::loadScene(
      camera() +
      screen(R"(<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.5 0.2 0.1"/></bsdf>)", 3) +
      wallBehind(diffuse("0 0 1")));
  const AuxiliaryImages images = auxiliaries(*scene);
  ASSERT_EQ(images.albedo.size(), 256u);
  for (const Rgb& albedo : images.albedo) ASSERT_NEAR(albedo.z, images.albedo[0].z, 2e-3f);  // without noise
  EXPECT_GT(images.albedo[0].x, 2 * images.albedo[0].z);
  for (const Vec3& normal : images.normal) ASSERT_NEAR(normal.z, 1, 1e-5f);
}

TEST(AuxiliaryImages, MixWhatVeilsAndWhatIsBehindThem) {
  const std::string veil =
      R"(<bsdf type="mask"><float name="opacity" value="0.75"/>)" + diffuse("0.8 0.8 0.8") + "</bsdf>";
  const auto scene = test::loadScene(camera() + screen(veil, 3) + screen(diffuse("0 0 0"), 4));
  double sum = 0;
  for (const Rgb& albedo : auxiliaries(*scene).albedo) sum += albedo.x / 256;
  // Four standard deviations of 256 x 32 independent samples, which Sobol' points are better than.
  EXPECT_NEAR(sum, 0.75 * 0.8, 4 * 0.8 * std::sqrt(0.75 * 0.25 / (256 * 32)));
}

// Without coats they are the features of paths, but for their noise.
TEST(AuxiliaryImages, AreFeaturesOfPaths) {
  const auto scene = test::loadScene(
      camera(24) + screen(diffuse("0.7 0.3 0.2"), 6) + wallBehind(diffuse("0.1 0.4 0.6")) +
      R"(<shape type="sphere"><point name="center" x="-0.7" y="0" z="-4"/><bsdf type="dielectric"/></shape>
         <shape type="sphere"><point name="center" x="0.9" y="0.4" z="-4"/><bsdf type="conductor"/></shape>
         <emitter type="constant"/>)");
  RenderOptions options;
  options.integrator = IntegratorKind::path;
  options.features = true;
  options.spp = 512;
  options.maxDepth = 9;
  const RenderedImage paths = test::renderScene(*scene, options).image;
  const AuxiliaryImages images = auxiliaries(*scene);
  ASSERT_EQ(images.albedo.size(), paths.albedo.size());
  double albedo = 0, normal = 0;
  for (size_t i = 0; i < paths.albedo.size(); ++i) {
    const Rgb difference = images.albedo[i] - paths.albedo[i];
    albedo += lengthSquared(Vec3(difference.x, difference.y, difference.z));
    normal += lengthSquared(images.normal[i] - paths.normal[i]);
  }
  EXPECT_LT(std::sqrt(albedo / double(paths.albedo.size())), 0.03);
  EXPECT_LT(std::sqrt(normal / double(paths.albedo.size())), 0.1);
}

// A board whose squares are smaller than pixels is grey, which few samples don't find out.
TEST(AuxiliaryImages, TakeMoreSamplesWhereTheyDiffer) {
  const auto scene = test::loadScene(
      camera(24) + screen(R"(<bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
                  <transform name="to_uv"><scale value="97"/></transform>
                  <rgb name="color0" value="0"/><rgb name="color1" value="0.8"/></texture></bsdf>)",
                          9));
  RenderOptions options;
  options.integrator = IntegratorKind::path;
  options.features = true;
  options.maxDepth = 2;
  options.spp = 8;
  const auto deviation = [](const std::vector<Rgb>& albedo, const std::vector<Rgb>& truth) {
    double sum = 0;
    for (size_t i = 0; i < albedo.size(); ++i) sum += sqr(albedo[i].x - truth[i].x);
    return std::sqrt(sum / double(albedo.size()));
  };
  const std::vector<Rgb> few = test::renderScene(*scene, options).image.albedo;
  options.spp = 1024;
  const std::vector<Rgb> truth = test::renderScene(*scene, options).image.albedo;
  EXPECT_LT(deviation(auxiliaries(*scene).albedo, truth), 0.6 * deviation(few, truth));
}

TEST(AuxiliaryImages, SameBitsForAnyNumberOfThreads) {
  const auto scene = test::loadScene(test::indirectRoom(40));
  const AuxiliaryImages one = auxiliaries(*scene, 1), two = auxiliaries(*scene, 2);
  EXPECT_EQ(one.albedo, two.albedo);
  EXPECT_EQ(one.normal, two.normal);
}

TEST(AuxiliaryImages, AreEmptyWhenCancelled) {
  struct Cancelled : Progress {
    bool cancelled() const override { return true; }
  } progress;
  const auto scene = test::loadScene(camera() + screen(diffuse("0.5 0.5 0.5"), 3));
  const AuxiliaryImages images = renderAuxiliaries(*scene, 0, 0, progress);
  EXPECT_TRUE(images.albedo.empty());
  EXPECT_TRUE(images.normal.empty());
}

}  // namespace
}  // namespace odis::render
