// Looking into the guide: where what arrives is known, maps and numbers must say so.
#include "learn/inspect/inspect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "integrator/test_scenes.h"
#include "learn/inspect/picture.h"
#include "learn/inspect/place.h"
#include "learn/inspect/vertex_integral.h"
#include "odis/maps/texel_directions.h"
#include "support/models.h"

namespace odis::learn {
namespace {

constexpr int kPaths = 1 << 15;

std::optional<Inspection> look(const render::Scene& scene, const InspectSettings& settings,
                               render::RenderOptions options = {}) {
  render::Progress quiet;
  return inspect(scene, options, settings, quiet);
}

InspectSettings atPixel(int x, int y) {
  InspectSettings settings;
  settings.pixel = render::Vec2i(x, y);
  settings.paths = kPaths;
  return settings;
}

// The message of the OptionError that this ends with.
std::string complaint(const render::Scene& scene, const InspectSettings& settings) {
  try {
    look(scene, settings);
  } catch (const render::OptionError& error) {
    return error.what();
  }
  return "none";
}

Float3 directionOf(const SquareMap& map, size_t texel) {
  const auto x = float(texel % size_t(map.side)), y = float(texel / size_t(map.side));
  return squareToDirection(Float2{(x + 0.5f) / float(map.side), (y + 0.5f) / float(map.side)});
}

// A floor below a small ball of light that next-event estimation reaches, and a bounce off nothing: only what
// MIS leaves of the light arrives.
std::string floorAndLamp(float radius) {
  return test::sensor("origin=\"0,2,3\" target=\"0,0,0\" up=\"0,1,0\"", 40, 24, 24) +
         "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"4\"/><rotate x=\"1\" "
         "angle=\"-90\"/></transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf>"
         "</shape><shape type=\"sphere\"><point name=\"center\" x=\"2\" y=\"3\" z=\"-1\"/><float "
         "name=\"radius\" value=\"" +
         std::to_string(radius) +
         "\"/><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf><emitter "
         "type=\"area\"><rgb "
         "name=\"radiance\" value=\"5\"/></emitter></shape>";
}

TEST(Inspect, MapsPointAtTheLamp) {
  const auto scene = test::loadScene(floorAndLamp(0.7f));
  const auto seen = look(*scene, atPixel(12, 12));
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->vertex.depth, 1);
  EXPECT_NEAR(seen->vertex.normal.y, 1, 1e-4);
  EXPECT_EQ(seen->guidable, 1);
  const Float3 offset = Float3{2, 3, -1} - seen->vertex.position;
  const Float3 towards = offset * (1 / std::sqrt(dot(offset, offset)));
  // The converged map is dark but for the lamp, whose sine is 0.7 over its distance of 3.7.
  const SquareMap& radiance = seen->converged.radiance;
  ASSERT_EQ(radiance.side, kTargetSize);
  double sum = 0, near = 0;
  for (size_t t = 0; t < radiance.values.size(); ++t) {
    if (std::isnan(radiance.values[t])) {
      EXPECT_LT(directionOf(radiance, t).y, 0.1f);
      continue;
    }
    sum += radiance.values[t];
    if (dot(directionOf(radiance, t), towards) > std::cos(0.35f)) near += radiance.values[t];
  }
  EXPECT_NEAR(sum / kTargetTexels, 1, 1e-3);
  EXPECT_GT(near / sum, 0.99);
  // So do the pilot's samples and the formula's map.
  for (const SampleDot& dot_ : seen->samples)
    if (dot_.value > 0) EXPECT_GT(dot(squareToDirection(dot_.at), towards), std::cos(0.4f));
  const SquareMap& formula = seen->maps.at(0).density;
  const auto brightest =
      size_t(std::max_element(formula.values.begin(), formula.values.end()) - formula.values.begin());
  EXPECT_GT(dot(directionOf(formula, brightest), towards), std::cos(0.4f));
  // Next-event estimation does it all: there is nothing to gain, which the numbers know.
  EXPECT_NEAR(seen->bsdfAlone.moment, 1, 0.02);
  EXPECT_EQ(seen->converged.judgement.bestBsdfFraction, 1);
  // No other map is nearer to the converged one than itself.
  EXPECT_NEAR(seen->converged.judgement.divergence, 0, 1e-5);
  EXPECT_GT(seen->maps[0].judgement.divergence, 0.01);
  EXPECT_LT(seen->noise, 0.05);
}

// Inside of the furnace the same radiance arrives from everywhere: with the BSDF alone a vertex scatters one
// value, but for what the light and MIS add.
TEST(Inspect, FurnaceIsEven) {
  const auto scene = test::loadScene(
      test::furnace("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf>"));
  render::RenderOptions options;
  options.spp = 64;
  options.set("pilot-spp=32");
  const auto seen = look(*scene, atPixel(4, 4), options);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->outgoing.y, 1, 0.05);  // 0.5 * 2
  EXPECT_LT(std::abs(seen->bsdf.values.at(0)), 4.1f);
  // f cos = 0.5 cos / pi: over its mean on the sphere, 4 cos.
  for (size_t t = 0; t < seen->bsdf.values.size(); ++t) {
    const float cosine = std::max(dot(directionOf(seen->bsdf, t), seen->vertex.normal), 0.0f);
    EXPECT_NEAR(seen->bsdf.values[t], 4 * cosine, 0.12);
  }
  EXPECT_GT(seen->converged.judgement.entropy,
            6.5f);  // even over the half sphere: 7 bits, the floor adds a little
  EXPECT_GE(seen->bsdfAlone.moment, 1);
  EXPECT_LT(seen->bsdfAlone.moment, 2.5f);
}

TEST(Inspect, LevelsAreTheGuides) {
  // Pixels are much smaller than cells, so that all of their samples look into one.
  const std::string room = test::indirectRoom();
  const auto scene =
      test::loadScene(test::sensor("origin=\"0,0,3.4\" target=\"-0.7,0.3,-1\" up=\"0,1,0\"", 1, 24, 24) +
                      room.substr(room.find("</sensor>") + 9));
  const auto seen = look(*scene, atPixel(4, 20));
  ASSERT_TRUE(seen);
  EXPECT_LT(seen->converged.judgement.bestMoment, 0.95f * seen->bsdfAlone.moment);
  ASSERT_EQ(seen->levels.size(), size_t(kCellLevels));
  for (size_t i = 0; i < seen->levels.size(); ++i) {
    const LevelView& level = seen->levels[i];
    EXPECT_EQ(level.statistics.level, int(i));
    if (i > 0) {
      EXPECT_NEAR(level.edge, 2 * seen->levels[i - 1].edge, 1e-5f);
      EXPECT_GE(level.statistics.count, seen->levels[i - 1].statistics.count);
      EXPECT_EQ(seen->levels[i - 1].statistics.parent, level.cell);
    }
    EXPECT_LE(level.effective, level.statistics.count * 1.0001);
  }
  EXPECT_EQ(double(seen->samples.size()), seen->levels[0].statistics.count);
  // The guide that renders is the pilot's if nothing refines it.
  render::RenderOptions options;
  options.features = options.guideFeatures = true;
  options.set("refine=0");
  const render::RenderResult image = test::renderScene(*scene, options);
  EXPECT_EQ(image.image.guideCell[20 * 24 + 4], float(seen->levels[0].cell));
  EXPECT_NEAR(image.image.guideBsdfFraction[20 * 24 + 4], seen->bsdfFraction, 1e-6);
  EXPECT_NEAR(image.image.guideSurvival[20 * 24 + 4], seen->survival, 1e-6);
  double learned = 0, unlearned = 0;
  for (const GroupView& group : seen->groups) {
    learned += group.learned;
    unlearned += group.unlearned;
  }
  EXPECT_NEAR(unlearned, 1, 1e-3);
  EXPECT_NEAR(learned, 1, 1e-3);
}

// A diffuse vertex, and light that is 1 from directions of x > 0 and nothing from others: of the BSDF's draws
// one half brings twice the mean, so that the second moment is 2 over the squared mean. A map of that half
// draws there 1.85 times as often at the BSDF sampling fraction 0.15: 2 / 1.85, but for cosines that are
// those of texels. Paths whose root mean square is k times their mean have k^2 times as much of it.
TEST(Inspect, MomentsOfHalfASky) {
  const auto scene = test::loadScene(floorAndLamp(0.2f));
  const render::LightSampler lights(scene->emitters());
  const InspectedPlace place = placeOfPixel(*scene, lights, {}, {12, 12});
  for (const float noise : {1.0f, 3.0f}) {
    Target target;
    for (int t = 0; t < kTargetTexels; ++t)
      target.indirect.push_back(t % kTargetSize >= kTargetSize / 2 ? 1.0f : 0.0f);
    for (const float value : target.indirect) target.indirectRms.push_back(noise * value);
    target.emission = target.emissionRms = target.lightPdf = std::vector<float>(kTargetTexels, 0.0f);
    target.samples.assign(kTargetTexels, 1);
    Converged arriving;
    arriving.add(target);
    const VertexIntegral integral(place.start, arriving);
    core::Histogram halfOfTheSky, allOfTheSky;
    for (int t = 0; t < kMapTexels; ++t)
      halfOfTheSky[size_t(t)] = core::texelDirections().x[t] > 0 ? 1.0f : 0.0f;
    allOfTheSky.fill(1);
    // Without a floor, what is dark has the least share that there is.
    const core::PackedMap ofHalf = integral.mapOf(halfOfTheSky, 0), ofAll = integral.mapOf(allOfTheSky, 0);
    const SamplingMap<float> half = ofHalf.view(), even = ofAll.view();
    EXPECT_NEAR(integral.moment(half, 1), 2 * noise * noise, 0.005f * noise * noise);
    EXPECT_NEAR(integral.moment(half, 0.15f), 2 / 1.85f * noise * noise, 0.03f * noise * noise);
    const Judgement judged = integral.judge(half, half, 1);
    EXPECT_EQ(judged.bestBsdfFraction, 0.15f);
    EXPECT_NEAR(judged.entropy, 5.75, 0.01);  // half of the cosine's 6.75 bits
    EXPECT_EQ(judged.divergence, 0);
    // Half of the even map's draws come from there: one bit.
    EXPECT_NEAR(integral.judge(even, half, 1).divergence, 1, 0.01);
  }
}

// Light from one direction only.
class OneTexel : public core::DirectionModel {
 public:
  core::DirectionDistribution predict(const core::CellChain&,
                                      const core::DirectionDistribution*) const override {
    core::DirectionDistribution result;
    result.probability.fill(0);
    result.inverseCosine.fill(1);
    result.probability[size_t(texelOf(Float3{0, 1, 0}))] = 1;
    return result;
  }
};

TEST(Inspect, ShowsAnotherModelBesideTheFormula) {
  const auto scene = test::loadScene(test::indirectRoom());
  render::RenderOptions options;
  options.model = test::makeModel(std::make_shared<OneTexel>(), core::Model::builtIn().lights);
  const auto seen = look(*scene, atPixel(12, 22), options);
  ASSERT_TRUE(seen);
  ASSERT_EQ(seen->maps.size(), 2u);
  const SquareMap &formula = seen->maps[0].radiance, &model = seen->maps[1].radiance;
  EXPECT_GT(*std::max_element(model.values.begin(), model.values.end()), 200);
  EXPECT_LT(*std::max_element(formula.values.begin(), formula.values.end()), 100);
  EXPECT_LT(seen->maps[1].judgement.entropy, seen->maps[0].judgement.entropy);
  EXPECT_GT(seen->maps[1].judgement.divergence, seen->maps[0].judgement.divergence);
}

TEST(Inspect, TheSameForAnyNumberOfThreads) {
  const auto scene = test::loadScene(test::indirectRoom(16));
  render::RenderOptions one, many;
  one.threads = 1;
  many.threads = 3;
  EXPECT_EQ(toJson(*look(*scene, atPixel(8, 8), one)).dump(),
            toJson(*look(*scene, atPixel(8, 8), many)).dump());
}

TEST(Inspect, APointIsTheCellThere) {
  const auto scene = test::loadScene(floorAndLamp(0.2f));
  InspectSettings settings;
  settings.paths = 1;
  settings.point = Float3{-0.5f, 0, 0.5f};
  const auto seen = look(*scene, settings);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->vertex.normal.y, 1, 1e-4);
  EXPECT_LE(std::abs(seen->vertex.position.x + 0.5f), seen->levels[0].edge);
  EXPECT_LE(std::abs(seen->vertex.position.z - 0.5f), seen->levels[0].edge);
  // The floor does not face downwards, and there is nothing far away.
  settings.normal = Float3{0, -1, 0};
  EXPECT_NE(complaint(*scene, settings).find("the pilot saw nothing that faces this way"), std::string::npos);
  settings.normal.reset();
  settings.point = Float3{100, 0, 0};
  EXPECT_NE(complaint(*scene, settings).find("the nearest place that it saw"), std::string::npos);
}

TEST(Inspect, SaysWhatIsWrongWithAPixel) {
  const auto scene = test::loadScene(floorAndLamp(0.2f));
  EXPECT_NE(complaint(*scene, atPixel(24, 0)).find("24,0 is outside"), std::string::npos);
  EXPECT_NE(complaint(*scene, atPixel(0, -1)).find("0,-1 is outside"), std::string::npos);
  const auto sky =
      test::loadScene(test::sensor("origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"", 60, 16, 16) +
                      "<shape type=\"sphere\"/><emitter type=\"constant\"/>");
  EXPECT_NE(complaint(*sky, atPixel(0, 0)).find("meets nothing that may be guided"), std::string::npos);
}

TEST(Inspect, PictureHoldsEverything) {
  const auto scene = test::loadScene(test::indirectRoom());
  const auto seen = look(*scene, atPixel(4, 20));
  ASSERT_TRUE(seen);
  ASSERT_EQ(seen->maps.size(), 2u);
  EXPECT_EQ(seen->maps[1].name, "network");
  for (const MapColors colors : {MapColors::stops, MapColors::values}) {
    const Canvas canvas = drawInspection(*seen, "room", colors);
    EXPECT_EQ(canvas.width, 7 * 200 + 8);  // seven panels of 192
    EXPECT_EQ(canvas.height, 8 + 22 + 8 + 4 * 211 + 22);
    std::set<std::array<float, 3>> different;
    for (const render::Rgb& c : canvas.pixels) different.insert({c.x, c.y, c.z});
    EXPECT_GT(different.size(), 500u);
  }
  const std::string text = inspectionText(*seen, "room");
  for (const char* word : {"vertex 1 of pixel 4,20", "level", "effective", "BSDF fraction", "survival",
                           "formula", "network", "converged", "divergence", "group"})
    EXPECT_NE(text.find(word), std::string::npos) << word;
  const nlohmann::ordered_json json = toJson(*seen);
  EXPECT_EQ(json["maps"][0]["radiance"]["values"].size(), size_t(kMapTexels));
  EXPECT_EQ(json["converged"]["radiance"]["values"].size(), size_t(kTargetTexels));
  EXPECT_EQ(json["levels"].size(), size_t(kCellLevels));
}

}  // namespace
}  // namespace odis::learn
