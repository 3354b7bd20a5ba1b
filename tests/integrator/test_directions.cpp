// Directions and lights of several vertices side by side: drawn and weighed as each would be by itself.
#include <gtest/gtest.h>

#include <deque>

#include "integrator/test_scenes.h"
#include "odis/maps/pack.h"
#include "render/path/media.h"
#include "support/random.h"

namespace odis::test {
namespace {

using namespace render;

// Maps of several cells: random ones, some of them with little else than one texel.
class Maps {
 public:
  explicit Maps(Random& random) {
    for (size_t cell = 0; cell < kCells; ++cell) {
      core::Histogram weights;
      for (float& weight : weights) weight = cell % 3 == 0 ? 0 : random();
      weights[size_t(random() * kMapTexels)] = 1;
      core::packMap(weights, &m_shares[cell * kMapShares]);
    }
  }
  const uint16_t* data() const { return m_shares.data(); }

  static constexpr int kCells = 20;

 private:
  std::vector<uint16_t> m_shares = std::vector<uint16_t>(kCells * kMapShares);
};

// The number of vertices leaves lanes unused.
constexpr size_t kCount = 13;

TEST(MapLanes, AnswerAsMapsDo) {
  Random random(1);
  const Maps maps(random);
  for (int round = 0; round < 500; ++round) {
    MapSamples samples;
    MapLookUps lookUps;
    std::array<SamplingMap<float>, kCount> expected;
    for (SamplingMap<float>& map : expected)
      map = SamplingMap<float>(maps.data(), int32_t(random() * Maps::kCells));
    std::array<Vec2, kCount> numbers;
    std::array<Vec3, kCount> directions;
    for (size_t i = 0; i < kCount; ++i) {
      samples.add(expected[i], numbers[i] = random.pair());
      lookUps.add(expected[i], directions[i] = random.direction());
    }
    chooseBlocks(samples);
    sampleWithinBlocks(samples);
    findTexels(lookUps);
    findPdfs(lookUps);
    for (size_t i = 0; i < kCount; ++i) {
      const auto sample = expected[i].sample(numbers[i].x, numbers[i].y);
      EXPECT_EQ(samples.wi[i], fromOdis(sample.wi));
      EXPECT_EQ(samples.pdf[i], sample.pdf);
      EXPECT_EQ(lookUps.texels[i], texelOf(toOdis(directions[i])));
      EXPECT_EQ(lookUps.pdf[i], expected[i].pdf(toOdis(directions[i])));
    }
  }
}

// A map by itself, as the mixture asks for it.
struct OneMap {
  const SamplingMap<float>& map;
  SamplingMap<float>::Sample sample(float u, float v) const { return map.sample(u, v); }
  float pdf(const Float3& wi) const { return map.pdf(wi); }
};

bool same(const BsdfSample& a, const BsdfSample& b) {
  return a.wi == b.wi && a.weight == b.weight && a.pdf == b.pdf && a.guidablePdf == b.guidablePdf &&
         a.eta == b.eta && a.lobe == b.lobe;
}

// Paths that arrive at one surface in [-1, 1]^2, from both sides of it.
class Arrivals {
 public:
  explicit Arrivals(const Scene& scene) : m_scene(scene) {}

  // Puts new ones into all but the last lanes, and random numbers. With a medium around the camera every
  // other path is scattered in it.
  void fill(Bounces& bounces, Random& random) {
    m_paths.clear();
    bounces.place = 1;
    bounces.count = kCount;
    for (size_t i = 0; i < kCount; ++i) {
      const Vec3 target(2 * random() - 1, 2 * random() - 1, 0);
      const Vec3 origin = random.inCube(1) + Vec3(0, 0, random() < 0.5f ? 3 : -3);
      const Ray ray{origin, normalize(target - origin)};
      Hit hit;
      m_scene.intersect({&ray, 1}, {&hit, 1});
      ASSERT_TRUE(hit.shape);
      Vertex& vertex = m_vertices[i];
      vertex.at = hit.surfacePoint(ray);
      vertex.wo = vertex.at.shading.toLocal(-ray.direction);
      vertex.bsdf = &vertex.at.shape->bsdf();
      Path& path = m_paths.emplace_back(ray, Sampler(SamplerKind::independent, 1, uint32_t(i), 0));
      path.medium = m_scene.sensor().medium();
      if (path.medium && i % 2 == 0) vertex = vertexInMedium(path, 1);
      bounces.arrivals[i] = {&path, uint32_t(i), &vertex, kNoCell, true};
      VertexNumbers& numbers = bounces.numbers;
      for (Column* column : {&numbers.lightChoice, &numbers.lightU, &numbers.lightV, &numbers.lobe,
                             &numbers.directionU, &numbers.directionV})
        (*column)[i] = random();
    }
  }

 private:
  const Scene& m_scene;
  std::deque<Path> m_paths;
  std::array<Vertex, kCount> m_vertices;
};

constexpr const char* kSurfaces[] = {
    "<bsdf type=\"diffuse\"/>",  //
    "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
    "value=\"0.1,0.5,0.9\"/></bsdf></bsdf>",
    "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.3\"/></bsdf>",
    "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.3\"/><string name=\"distribution\" "
    "value=\"ggx\"/><boolean name=\"nonlinear\" value=\"true\"/></bsdf>",
    "<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><string name=\"distribution\" "
    "value=\"ggx\"/><float "
    "name=\"alpha_u\" value=\"0.5\"/><float name=\"alpha_v\" value=\"0.2\"/></bsdf></bsdf>",
    "<bsdf type=\"roughconductor\"><float name=\"alpha_u\" value=\"0.2\"/><float name=\"alpha_v\" "
    "value=\"0.4\"/></bsdf>",
    // Metal on one side, plastic on the other, with different distributions.
    "<bsdf type=\"twosided\"><bsdf type=\"roughplastic\"><string name=\"distribution\" value=\"ggx\"/></bsdf>"
    "<bsdf type=\"roughconductor\"><string name=\"material\" value=\"Cu\"/></bsdf></bsdf>",
    // Lobes that are too sharp to be guided, and delta lobes, beside one that may be.
    "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.01\"/></bsdf>",
    "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.01\"/><string name=\"distribution\" "
    "value=\"ggx\"/></bsdf>",
    "<bsdf type=\"plastic\"/>",
    "<bsdf type=\"roughdielectric\"><float name=\"alpha\" value=\"0.4\"/></bsdf>"};

std::string rectangle(const std::string& bsdf) {
  return "<shape type=\"rectangle\">" + bsdf + "</shape>";
}

constexpr const char* kPhases[] = {
    "<phase type=\"isotropic\"/>",
    "<phase type=\"hg\"><float name=\"g\" value=\"0.6\"/></phase>",
    "<phase type=\"blendphase\"><float name=\"weight\" value=\"0.3\"/><phase type=\"rayleigh\"/>"
    "<phase type=\"hg\"/></phase>",
};

// With a medium around it if there is a phase function.
std::string cameraWithin(const std::string& phase = {}) {
  const std::string medium = phase.empty() ? phase : "<medium type=\"homogeneous\">" + phase + "</medium>";
  return sensor("origin=\"0,0,5\" target=\"0,0,0\" up=\"0,1,0\"", 40, 8, 8, medium);
}

// Vertices on one surface, some of whose cells guide and some not: the steps of a bounce sample the very
// mixture that Mixture::sample() is the definition of.
void expectDirectionsOfTheMixture(const std::string& bsdf, const std::string& phase, Random& random) {
  const auto scene = loadScene(cameraWithin(phase) + rectangle(bsdf));
  const Maps maps(random);
  std::vector<OdisCellDecisions> decisions(Maps::kCells);
  for (OdisCellDecisions& cell : decisions)
    for (float& fraction : cell.bsdfFraction) fraction = random() < 0.25f ? 1.0f : 0.1f + 0.8f * random();
  OdisGuideView view;
  view.cellCount = Maps::kCells;
  view.maps = maps.data();
  view.decisions = decisions.data();
  PathSettings settings;
  settings.scene = scene.get();
  settings.guide = &view;
  int guided = 0, fromMaps = 0;
  Arrivals arrivals(*scene);
  const auto batch = std::make_unique<Batch>();
  const auto bounces = std::make_unique<Bounces>();
  for (int round = 0; round < 300; ++round) {
    arrivals.fill(*bounces, random);
    for (Arrival& arrival : bounces->arriving())
      arrival.cell = random() < 0.2f ? kNoCell : uint32_t(random() * Maps::kCells);
    readVertices(*bounces);
    findGuidableLobes(settings, *batch, *bounces);
    for (size_t i = 0; i < kCount; ++i) {
      const auto& [at, wo, kind, scattering] = *bounces->arrivals[i].vertex;
      const uint32_t cell = bounces->arrivals[i].cell;
      // BSDFs of other cells are not asked.
      if (cell != kNoCell && guidesDirections(decisions[cell]))
        EXPECT_EQ(bounces->at.guidable[i], scattering->guidableProbability(at, wo)) << bsdf;
    }
    prepareDirections(settings, *bounces);
    chooseBlocks(*bounces);
    sampleDirections(*bounces);
    for (size_t i = 0; i < kCount; ++i) {
      const BsdfHost host{*bounces->arrivals[i].vertex, bounces->numbers.lobe[i]};
      const float u = bounces->numbers.directionU[i], v = bounces->numbers.directionV[i];
      const bool hasMap = bounces->bsdfs.hasMap[i];
      BsdfSample expected = hasMap
                                ? bounces->bsdfs.mixture(i).sample(OneMap{bounces->bsdfs.maps[i]}, u, v, host)
                                : host.sampleBsdf(u, v);
      if (!isFinite(expected.weight)) expected = {};
      EXPECT_TRUE(same(bounces->next[i], expected)) << bsdf;
      guided += hasMap;
      fromMaps += bounces->draws.fromMap[i];
    }
  }
  EXPECT_GT(guided, 500) << bsdf;
  EXPECT_GT(fromMaps, 200) << bsdf;
}

TEST(Directions, AreThoseOfTheMixture) {
  Random random(2);
  for (const char* bsdf : kSurfaces) expectDirectionsOfTheMixture(bsdf, "", random);
  for (const char* phase : kPhases) expectDirectionsOfTheMixture(kSurfaces[0], phase, random);
}

// Next-event estimation side by side is what the choice of a light, its sample and the BSDF say one by one.
void expectLightOfEachPath(const std::string& phase, const std::string& bsdf, const std::string& lights,
                           Random& random) {
  const auto scene = loadScene(cameraWithin(phase) + rectangle(bsdf) + lights);
  const LightSampler sampler(scene->emitters());
  PathSettings settings;
  settings.scene = scene.get();
  settings.lights = &sampler;
  Arrivals arrivals(*scene);
  const auto bounces = std::make_unique<Bounces>();
  size_t expectedLit = 0, foundLit = 0;
  for (int round = 0; round < 100; ++round) {
    arrivals.fill(*bounces, random);
    readVertices(*bounces);
    prepareDirections(settings, *bounces);
    const LaneList lit = sampleLights(settings, *bounces);
    weighLights(*bounces, lit);
    foundLit += lit.count;
    std::array<bool, kLanes> isLit{};
    for (const size_t i : lit) isLit[i] = true;
    for (size_t i = 0; i < kCount; ++i) {
      const auto& [at, wo, kind, scattering] = *bounces->arrivals[i].vertex;
      const VertexNumbers& numbers = bounces->numbers;
      const LightReference reference =
          kind == VertexKind::medium ? LightReference{at.p, Vec3(0, 0, 0), true} : lightReference(at, wo);
      const LightSampler::Choice choice =
          sampler.sample(reference, numbers.lightChoice[i], Vec2(numbers.lightU[i], numbers.lightV[i]));
      if (!choice.emitter) continue;
      const EmitterSample sample = choice.emitter->sample(choice.part, at.p, choice.u);
      const BsdfValue value = scattering->evaluate(at, wo, at.shading.toLocal(sample.wi));
      const bool expected = sample.pdf > 0 && !isBlack(sample.radiance) && !isBlack(value.value);
      EXPECT_EQ(isLit[i], expected) << bsdf << lights;
      expectedLit += expected;
      if (!expected || !isLit[i]) continue;
      const LightEstimates& light = bounces->light;
      const float pdf = sample.pdf * choice.probability;
      const float weight = sample.delta ? 1.0f : powerHeuristic(pdf, value.pdf);
      EXPECT_EQ(light.wi[i], sample.wi);
      EXPECT_EQ(light.distance[i], sample.distance);
      EXPECT_EQ(light.pdf[i], sample.delta ? 0 : pdf);
      EXPECT_EQ(light.bsdfPdf[i], value.pdf);
      EXPECT_EQ(light.guidablePdf[i], value.guidablePdf);
      EXPECT_EQ(Rgb(light.radiance[i]), value.value * sample.radiance / pdf);
      EXPECT_EQ(Rgb(light.direct[i]), value.value * sample.radiance / pdf * weight);
    }
  }
  EXPECT_EQ(foundLit, expectedLit);
  EXPECT_GT(foundLit, 300u) << bsdf << lights;
}

TEST(Lights, AreThoseOfEachPath) {
  Random random(3);
  const std::string square =
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.5\"/>"
      "<rotate x=\"1\" angle=\"180\"/><translate z=\"4.5\"/></transform><emitter type=\"area\"/></shape>";
  const std::string ball =
      "<shape type=\"sphere\"><point name=\"center\" x=\"3\" y=\"0\" z=\"5\"/><emitter "
      "type=\"area\"/></shape>";
  const std::string point =
      "<emitter type=\"point\"><point name=\"position\" x=\"-3\" y=\"0\" z=\"5\"/></emitter>";
  const std::string sky = "<emitter type=\"constant\"/>";
  for (const std::string& lights : {square, square + ball + point, sky, square + ball + point + sky}) {
    for (const char* bsdf : kSurfaces) expectLightOfEachPath("", bsdf, lights, random);
    for (const char* phase : kPhases) expectLightOfEachPath(phase, kSurfaces[2], lights, random);
  }
}

}  // namespace
}  // namespace odis::test
