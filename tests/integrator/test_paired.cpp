// Is a decision of the guide unbiased? Small images and rare light are where a decision that knows what it
// decides over shows: there a single path tells much of all that the guide learns.
//
// What the image's mean must be is known (rare_patch.h), and so is what the pilot's mean must be, which is
// plain path tracing. So there are two ways to compare, each with less noise than two images have:
//
//   - with the integral: image − s (pilot − integral) − integral is zero in the mean, s being the pilot's
//     share in the image. What is left is the noise of the guided samples.
//   - with the constant form: the same seed is rendered with the decision and without it, and the two images
//     are subtracted. That is for decisions which leave most paths as they are, so that most noise cancels.
//     Where the pilot's shares differ, the pilot is replaced by the integral as above.
//
// Where all guided samples of a pixel are alike, many stand in for the one or three that the image has, and
// the pilot weighs as much more as keeps its share. The expectation stays, and the noise falls at the cost of
// some samples, not of another guide.
//
// Each decision states the half-width that the 95 % interval of the mean difference has at most, relative to
// the image's mean. The environment variable ODIS_PAIRED_SEEDS multiplies the number of seeds; the interval
// narrows by its square root, and is printed.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cstdlib>
#include <functional>
#include <iomanip>
#include <sstream>

#include "integrator/rare_patch.h"
#include "integrator/test_scenes.h"
#include "support/sanitizers.h"

namespace odis::render {
namespace {

using test::RarePatch;
using ChangeOptions = void (*)(RenderOptions&);

struct Decision {
  const char* name;
  ChangeOptions makeConstant;  // null: compared with the integral
  int seeds;                   // at 16 x 16 pixels; 1 / 8 of them at 64 x 64
  double halfWidth;            // of the 95 % interval of all these seeds
  bool lamps = false;
  // Otherwise there are as many samples everywhere and one guide: what follows from one decision would change
  // the later ones, and with them all random numbers.
  bool withAllOthers = false;
};

constexpr ChangeOptions kIntegral = nullptr;

// Maps, the choice of lights and refinement change where most paths go: they are compared with the integral.
// So the images of "everything" are those of "refinement" at 4 samples per pixel, and those of "maps" at 2.
const Decision kDecisions[] = {
    {"pilot weight", [](RenderOptions& o) { o.set("pilot-weight=1"); }, 200, 0.006},
    {"ended paths", [](RenderOptions& o) { o.set("ended-paths=nothing"); }, 200, 0.001},
    {"shadow rays", [](RenderOptions& o) { o.set("shadow-rays=all"); }, 200, 0.001, true},
    {"lights", kIntegral, 400, 0.035, true},
    {"roulette", [](RenderOptions& o) { o.set("roulette=throughput"); }, 200, 0.015},
    {"maps", kIntegral, 400, 0.018},
    {"refinement", kIntegral, 1000, 0.022, false, true},
    {"samples", [](RenderOptions& o) { o.set("samples=even"); }, 1000, 0.005, false, true},
    {"everything", kIntegral, 1000, 0.022, false, true},
};

struct PairedCase {
  Decision decision;
  SamplerKind sampler;
  int size, spp;
  bool crop;

  int seeds() const { return size == 16 ? decision.seeds : decision.seeds / 8; }
  RarePatch patch() const { return {size, crop, decision.lamps}; }
  // Whether a pixel's guided samples are alike, given the pilot, because nothing follows from the first one:
  // two samples are too few to refine or to spread.
  bool oneGuide() const { return !decision.withAllOthers || spp == 2; }
  RenderOptions options(uint64_t seed) const {
    RenderOptions options;
    options.maxDepth = 3;
    options.spp = spp;
    options.sampler = sampler;
    options.seed = seed;
    options.set("guided-cost=0");  // in so few pixels it would not pay to refine the guide
    if (oneGuide()) {
      options.set("samples=even");
      options.set("refine=0");
    }
    return options;
  }
};

void PrintTo(const PairedCase& c, std::ostream* out) {
  *out << c.decision.name << ", " << c.size << " x " << c.size << (c.crop ? " crop" : "") << ", " << c.spp
       << " spp, " << (c.sampler == SamplerKind::sobol ? "sobol" : "independent");
}

double renderMean(const Scene& scene, const RenderOptions& options) {
  const RenderResult result = test::renderScene(scene, options);
  double sum = 0;
  for (const Rgb& color : result.image.color) sum += color.y;
  return sum / double(result.image.color.size());
}

// Takes so many guided samples in each pixel. The pilot keeps its share: the mean has the same expectation.
void takeMany(int guided, RenderOptions& options) {
  const double weight = options.settingNumber("pilot-weight") * guided / (options.spp - 1);
  options.set("pilot-weight=" + std::to_string(weight));
  options.spp = 1 + guided;
}

// The mean of the pilot's samples: path tracing draws the same ones, of which there is one a pixel.
double pilotMean(const Scene& scene, RenderOptions options) {
  options.integrator = IntegratorKind::path;
  options.spp = 1;
  return renderMean(scene, options);
}

// The pilot's share in the mean of an image. It has to be a constant: one that depends on the pilot would
// hide the bias of a weight that does.
double pilotShare(const RenderOptions& options) {
  const double weight = options.settingNumber("pilot-weight");
  return weight / (weight + options.spp - 1);
}

// A random number whose expectation is the difference that the decision makes to the image's mean.
double difference(const PairedCase& c, const Scene& scene, double integral, uint64_t seed) {
  RenderOptions options = c.options(seed), constant = options;
  if (c.decision.makeConstant) c.decision.makeConstant(constant);
  if (c.oneGuide()) {
    const int guided = c.size == 16 ? 24 : 6;
    takeMany(guided, options);
    takeMany(guided, constant);
  }
  double without = integral, share = pilotShare(options);
  if (c.decision.makeConstant) {
    without = renderMean(scene, constant);
    share -= pilotShare(constant);
  }
  const double pilot = share != 0 ? pilotMean(scene, options) : integral;
  return renderMean(scene, options) - without - share * (pilot - integral);
}

// The mean of a random number, and its standard error.
struct Estimate {
  double mean, error;
  size_t count;

  double z() const { return mean / error; }
  std::string figures(double integral) const {
    std::ostringstream text;
    text << std::setprecision(3) << "difference " << 100 * mean / integral << " ± " << 196 * error / integral
         << " % of the mean (95 %), z = " << z() << ", " << count << " seeds";
    return text.str();
  }
};

// From the values of the seeds from 1 on.
Estimate estimate(size_t count, const std::function<double(uint64_t seed)>& valueOf) {
  std::vector<double> values(count);
  tbb::parallel_for(size_t(0), count, [&](size_t i) { values[i] = valueOf(i + 1); });
  double mean = 0, squares = 0;
  for (const double value : values) {
    mean += value / double(count);
    squares += value * value / double(count);
  }
  return {mean, std::sqrt((squares - mean * mean) / double(count - 1)), count};
}

class Paired : public ::testing::TestWithParam<PairedCase> {};

double seedFactor() {
  const char* factor = std::getenv("ODIS_PAIRED_SEEDS");
  return factor ? std::atof(factor) : 1;
}

TEST_P(Paired, DecisionLeavesTheMean) {
  if (test::kSanitized) GTEST_SKIP() << "takes many seeds, which tell the sanitizers nothing";
  const PairedCase& c = GetParam();
  const auto scene = test::loadScene(c.patch().text());
  const double integral = c.patch().mean();
  const Estimate result = estimate(size_t(c.seeds() * seedFactor()),
                                   [&](uint64_t seed) { return difference(c, *scene, integral, seed); });
  const std::string figures = result.figures(integral);
  if (seedFactor() > 1) std::cout << ::testing::PrintToString(c) << ": " << figures << std::endl;
  EXPECT_GT(result.error, 0) << "the decision changes nothing here";
  // A significance of .01 % each, 1 % over all cases (Šidák).
  EXPECT_LT(std::abs(result.z()), 3.8) << figures;
  EXPECT_LT(1.96 * result.error / integral, c.decision.halfWidth / std::sqrt(seedFactor())) << figures;
}

// Refinement and the spreading of samples need 4 samples per pixel.
std::vector<PairedCase> allCases() {
  std::vector<PairedCase> cases;
  for (const Decision& decision : kDecisions)
    for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::independent})
      for (const int size : {16, 64})
        for (const int spp : {2, 4}) {
          const std::string name = decision.name;
          if (spp == 2 && (name == "refinement" || name == "samples")) continue;
          cases.push_back({decision, sampler, size, spp, (sampler == SamplerKind::sobol) == (spp == 4)});
        }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(RarePatch, Paired, ::testing::ValuesIn(allCases()));

// The integral does not depend on how many points it is computed with, and path tracing comes to it.
TEST(RarePatch, MeanIsThatOfPathTracing) {
  if (test::kSanitized) GTEST_SKIP() << "takes many seeds, which tell the sanitizers nothing";
  for (const RarePatch& patch :
       {RarePatch{32, false, false}, {32, true, false}, {32, false, true}, {32, true, true}}) {
    const double integral = patch.mean();
    EXPECT_NEAR(patch.mean(8) / integral, 1, 1e-7);
    EXPECT_NEAR(patch.mean(24) / integral, 1, 1e-9);

    const auto scene = test::loadScene(patch.text());
    RenderOptions options;
    options.integrator = IntegratorKind::path;
    options.sampler = SamplerKind::independent;
    options.maxDepth = 3;
    options.spp = 16;
    const Estimate path = estimate(size_t(64 * seedFactor()), [&](uint64_t seed) {
      RenderOptions seeded = options;
      seeded.seed = seed;
      return renderMean(*scene, seeded) - integral;
    });
    const auto figures = path.figures(integral);
    if (seedFactor() > 1) std::cout << "path tracing: " << figures << std::endl;
    EXPECT_LT(std::abs(path.z()), 3.5) << figures;
    EXPECT_LT(1.96 * path.error / integral, 0.03 / std::sqrt(seedFactor())) << figures;
  }
}

}  // namespace
}  // namespace odis::render
