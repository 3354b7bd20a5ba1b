// Is a decision of the guide unbiased? The same seeds are rendered with it and in its constant form; the mean
// of the differences must be zero. Small images and rare light are where a decision that knows what it
// decides over shows: there a single path tells much of all that the guide learns.
//
// Each case states the half-width that the 95 % interval of the mean difference has at most, relative to the
// image's mean. The environment variable ODIS_PAIRED_SEEDS multiplies the number of seeds; the interval
// narrows by its square root, and is printed.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cstdlib>
#include <iomanip>

#include "integrator/test_scenes.h"
#include "support/sanitizers.h"

namespace odis::render {
namespace {

// The film of an image of size x size pixels: a whole one, or a crop of one of twice as many a side.
std::string film(int size, bool crop) {
  const auto integer = [](const std::string& name, int value) {
    return "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
  };
  const int full = crop ? 2 * size : size;
  std::string text =
      "<film type=\"hdrfilm\"><rfilter type=\"box\"/>" + integer("width", full) + integer("height", full);
  if (crop)
    text += integer("crop_width", size) + integer("crop_height", size) + integer("crop_offset_x", size / 2) +
            integer("crop_offset_y", size / 2);
  return text + "</film>";
}

// A floor that is lit by a patch of the wall beside it, which some .6 % of the paths from the floor find;
// with `lamps` also directly by two dim lamps, so that there is a choice of lights, and shadow rays are worth
// a roulette.
std::string rarePatch(int size, bool crop, bool lamps) {
  return R"(<sensor type="perspective"><float name="fov" value="8"/><transform name="to_world">
      <lookat origin="0,4,0" target="0,0,0" up="0,0,1"/></transform>)" +
         film(size, crop) + R"(</sensor>
    <shape type="rectangle">
      <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="-90"/></transform>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf>
    </shape>
    <shape type="rectangle">
      <transform name="to_world">
        <scale x="0.6" y="0.4"/><rotate y="1" angle="-90"/><translate x="1" y="0.6"/>
      </transform>
      <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.9"/></bsdf></bsdf>
    </shape>
    <emitter type="spot">
      <transform name="to_world"><lookat origin="-3,0.6,0" target="1,0.6,0" up="0,1,0"/></transform>
      <rgb name="intensity" value="400"/><float name="cutoff_angle" value="2.5"/>
    </emitter>)" +
         (lamps ? R"(<emitter type="point">
      <point name="position" x="-0.3" y="1" z="0.4"/><rgb name="intensity" value="0.003"/>
    </emitter>
    <emitter type="point">
      <point name="position" x="0.5" y="0.5" z="-0.3"/><rgb name="intensity" value="0.001"/>
    </emitter>)"
                : "");
}

using ChangeOptions = void (*)(RenderOptions&);

struct Decision {
  const char* name;
  ChangeOptions makeConstant;
  int seeds;         // at 16 x 16 pixels; 1 / 16 of them at 64 x 64
  double halfWidth;  // of the 95 % interval of all these seeds at 2 samples per pixel
  bool lamps = false;
  // Otherwise there are as many samples everywhere and one guide: what follows from one decision would change
  // the later ones, and with them all random numbers.
  bool withAllOthers = false;
};

const Decision kDecisions[] = {
    {"pilot weight", [](RenderOptions& o) { o.pilotWeight = 1; }, 1600, 0.008},
    {"ended paths", [](RenderOptions& o) { o.guideOptions.controlVariate = false; }, 800, 0.001},
    {"shadow rays", [](RenderOptions& o) { o.shadowRays = ShadowRayKind::all; }, 800, 0.001, true},
    {"lights", [](RenderOptions& o) { o.lights = LightChoiceKind::hierarchy; }, 600, 0.08, true},
    {"roulette", [](RenderOptions& o) { o.roulette = RouletteKind::throughput; }, 1600, 0.02},
    {"maps", [](RenderOptions& o) { o.guideOptions.fixedBsdfFraction = 1; }, 800, 0.05},
    {"refinement", [](RenderOptions& o) { o.refineSpp = 0; }, 1600, 0.022, false, true},
    {"samples", [](RenderOptions& o) { o.samples = SampleSpread::even; }, 1600, 0.005, false, true},
    {"everything", [](RenderOptions& o) { o.integrator = IntegratorKind::path; }, 800, 0.05, false, true},
};

struct PairedCase {
  Decision decision;
  SamplerKind sampler;
  int size, spp;
  bool crop;

  int seeds() const { return size == 16 ? decision.seeds : decision.seeds / 16; }
};

void PrintTo(const PairedCase& c, std::ostream* out) {
  *out << c.decision.name << ", " << c.size << " x " << c.size << (c.crop ? " crop" : "") << ", " << c.spp
       << " spp, " << (c.sampler == SamplerKind::sobol ? "sobol" : "independent");
}

double meanOf(const RenderResult& result) {
  double sum = 0;
  for (const Rgb& color : result.image.color) sum += color.y;
  return sum / double(result.image.color.size());
}

class Paired : public ::testing::TestWithParam<PairedCase> {};

double seedFactor() {
  const char* factor = std::getenv("ODIS_PAIRED_SEEDS");
  return factor ? std::atof(factor) : 1;
}

TEST_P(Paired, DecisionAndItsConstantFormHaveTheSameMean) {
  if (test::kSanitized) GTEST_SKIP() << "takes many seeds, which tell the sanitizers nothing";
  const PairedCase& c = GetParam();
  const auto scene = test::loadScene(rarePatch(c.size, c.crop, c.decision.lamps));
  std::vector<double> with(size_t(c.seeds() * seedFactor())), without(with.size());
  tbb::parallel_for(size_t(0), with.size(), [&](size_t i) {
    RenderOptions options;
    options.maxDepth = 3;
    options.spp = c.spp;
    options.sampler = c.sampler;
    options.seed = i + 1;
    if (!c.decision.withAllOthers) {
      options.samples = SampleSpread::even;
      options.refineSpp = 0;
    }
    with[i] = meanOf(test::renderScene(*scene, options));
    c.decision.makeConstant(options);
    without[i] = meanOf(test::renderScene(*scene, options));
  });
  const double count = double(with.size());
  double mean = 0, difference = 0, squares = 0;
  for (size_t i = 0; i < with.size(); ++i) {
    mean += without[i] / count;
    difference += (with[i] - without[i]) / count;
    squares += (with[i] - without[i]) * (with[i] - without[i]);
  }
  const double error = std::sqrt((squares / count - difference * difference) / (count - 1));
  ::testing::Message figures;
  figures << std::setprecision(3) << "difference " << 100 * difference / mean << " ± " << 196 * error / mean
          << " % of the mean (95 %), z = " << difference / error << ", " << with.size() << " seeds";
  if (seedFactor() > 1) std::cout << ::testing::PrintToString(c) << ": " << figures << std::endl;
  EXPECT_GT(error, 0) << "the decision changes nothing here";
  // A significance of .01 % each, 1 % over all cases (Šidák).
  EXPECT_LT(std::abs(difference / error), 3.8) << figures;
  EXPECT_LT(1.96 * error / mean, c.decision.halfWidth / std::sqrt(seedFactor())) << figures;
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

}  // namespace
}  // namespace odis::render
