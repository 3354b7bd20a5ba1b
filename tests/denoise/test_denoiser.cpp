// Open Image Denoise, where it is found: that it is given the images it expects, and stopped when asked to.
#include "render/denoise/denoiser.h"

#include <atomic>
#include <cmath>
#include <random>

#include "support/denoiser.h"

namespace odis::render {
namespace {

constexpr int kWidth = 96, kHeight = 64;

// A wall of two albedos, lit evenly, and what a renderer makes of it with few samples.
struct Wall {
  std::vector<Rgb> truth, noisy, albedo;
  std::vector<Vec3> normal;

  Wall() {
    std::mt19937 random(1);
    std::exponential_distribution<float> light(1);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool dark = (x / 4 + y / 4) % 2 == 1;
        albedo.push_back(dark ? Rgb(0.2f, 0.1f, 0.1f) : Rgb(0.8f, 0.7f, 0.6f));
        truth.push_back(albedo.back() * 3.0f);
        noisy.push_back(truth.back() * light(random));
        normal.emplace_back(0, 0, 1);
      }
  }
  DenoiserInput input() const { return {kWidth, kHeight, noisy, albedo, normal}; }
  double error(const std::vector<Rgb>& image) const {
    double sum = 0;
    for (size_t i = 0; i < image.size(); ++i) sum += sqr(image[i].x - truth[i].x);
    return sum / double(image.size());
  }
};

std::vector<Rgb> denoised(const DenoiserInput& input, Auxiliaries auxiliaries = Auxiliaries::prefiltered,
                          int threads = 0) {
  Progress quiet;
  return Denoiser(threads).denoise(input, auxiliaries, quiet).value();
}

TEST(Denoiser, SaysItsVersion) {
  ODIS_NEEDS_DENOISER();
  const std::string name = Denoiser(0).name();
  EXPECT_TRUE(name.starts_with("Open Image Denoise 1.4") || name.starts_with("Open Image Denoise 2."))
      << name;
}

// The checkerboard's squares of 4 x 4 pixels drown in noise: only who is told the albedo finds them all.
TEST(Denoiser, TakesNoiseAwayAndFollowsTheAlbedo) {
  ODIS_NEEDS_DENOISER();
  const Wall wall;
  const double before = wall.error(wall.noisy), alone = wall.error(denoised(wall.input(), Auxiliaries::none)),
               noisy = wall.error(denoised(wall.input(), Auxiliaries::noisy)),
               clean = wall.error(denoised(wall.input(), Auxiliaries::clean)),
               prefiltered = wall.error(denoised(wall.input(), Auxiliaries::prefiltered));
  EXPECT_LT(alone, 0.3 * before);
  EXPECT_LT(noisy, 0.5 * alone);
  EXPECT_LT(clean, 0.5 * alone);
  EXPECT_LT(prefiltered, 0.5 * alone);
}

TEST(Denoiser, TakesAnAlbedoAlone) {
  ODIS_NEEDS_DENOISER();
  const Wall wall;
  DenoiserInput input = wall.input();
  input.normal = {};
  EXPECT_EQ(auxiliariesText(input, Auxiliaries::prefiltered), "albedo");
  EXPECT_LT(wall.error(denoised(input)), wall.error(denoised(input, Auxiliaries::none)));
}

TEST(Denoiser, SameBitsForAnyNumberOfThreads) {
  ODIS_NEEDS_DENOISER();
  const Wall wall;
  const std::vector<Rgb> one = denoised(wall.input(), Auxiliaries::prefiltered, 1);
  EXPECT_EQ(one, denoised(wall.input(), Auxiliaries::prefiltered, 2));
  EXPECT_EQ(one, denoised(wall.input(), Auxiliaries::prefiltered, 3));
}

TEST(Denoiser, SurvivesWhatIsNoColor) {
  ODIS_NEEDS_DENOISER();
  Wall wall;
  const float infinity = INFINITY;
  wall.noisy[5] = {NAN, 1, 1};
  wall.noisy[500] = {infinity, infinity, infinity};
  wall.noisy[900] = {-1, -infinity, 0};
  wall.albedo[300] = {NAN, 70, -3};
  wall.normal[300] = {NAN, infinity, -3};
  for (const Auxiliaries auxiliaries :
       {Auxiliaries::clean, Auxiliaries::prefiltered, Auxiliaries::noisy, Auxiliaries::none}) {
    const std::vector<Rgb> image = denoised(wall.input(), auxiliaries);
    for (size_t i = 0; i < image.size(); ++i) {
      ASSERT_TRUE(isFinite(image[i])) << i;
      ASSERT_GE(std::min({image[i].x, image[i].y, image[i].z}), 0) << i;
    }
    EXPECT_NEAR(image[5].x, wall.truth[5].x, 2);  // from its neighbours
  }
}

// An exposure is none of the denoiser's business.
TEST(Denoiser, ScalesWithTheLight) {
  ODIS_NEEDS_DENOISER();
  Wall wall;
  const std::vector<Rgb> image = denoised(wall.input());
  for (Rgb& color : wall.noisy) color *= 1024.0f;
  const std::vector<Rgb> bright = denoised(wall.input());
  for (size_t i = 0; i < image.size(); i += 7)
    ASSERT_NEAR(bright[i].x / 1024, image[i].x, 1e-2 * image[i].x + 1e-3) << i;
}

TEST(Denoiser, TakesTheSmallestImages) {
  ODIS_NEEDS_DENOISER();
  const std::vector<Rgb> pixels(7, Rgb(0.5f, 0.5f, 0.5f));
  const std::vector<Vec3> normals(7, Vec3(0, 0, 1));
  EXPECT_EQ(
      denoised({1, 1, std::span(pixels).first(1), std::span(pixels).first(1), std::span(normals).first(1)})
          .size(),
      1u);
  EXPECT_EQ(denoised({7, 1, pixels, pixels, normals}).size(), 7u);
  EXPECT_EQ(denoised({1, 7, pixels, {}, {}}).size(), 7u);
}

TEST(Denoiser, StopsWhenAskedTo) {
  ODIS_NEEDS_DENOISER();
  struct Cancelled : Progress {
    bool cancelled() const override { return true; }
  } progress;
  const Wall wall;
  EXPECT_FALSE(Denoiser(0).denoise(wall.input(), Auxiliaries::prefiltered, progress).has_value());
}

TEST(Denoiser, SaysHowFarItIs) {
  ODIS_NEEDS_DENOISER();
  struct Counted : Progress {
    void begin(const std::string& stage, uint64_t all, uint64_t, const char* of) override {
      name = stage, total = all, unit = of;
    }
    void advance(uint64_t more) override { done += more; }
    void end() override { ++ends; }
    std::string name, unit;
    uint64_t total = 0;
    std::atomic<uint64_t> done{0};
    int ends = 0;
  } progress;
  const Wall wall;
  Denoiser(0).denoise(wall.input(), Auxiliaries::prefiltered, progress);
  EXPECT_EQ(progress.name, "denoise");
  EXPECT_EQ(progress.unit, "pixels");
  EXPECT_EQ(progress.total, 3u * kWidth * kHeight);
  EXPECT_EQ(progress.done, progress.total);
  EXPECT_EQ(progress.ends, 1);
}

TEST(Denoiser, RefusesImagesThatDontFit) {
  ODIS_NEEDS_DENOISER();
  const Wall wall;
  DenoiserInput input = wall.input();
  input.albedo = input.albedo.first(9);
  EXPECT_THROW(denoised(input), std::invalid_argument);
  input.albedo = {};
  EXPECT_THROW(denoised(input), std::invalid_argument);
  EXPECT_THROW(denoised({}), std::invalid_argument);
}

}  // namespace
}  // namespace odis::render
