// Directions of several vertices side by side: drawn and weighed as each would be by itself.
#include <gtest/gtest.h>

#include "integrator/test_scenes.h"
#include "odis/maps/pack.h"
#include "render/path/bounce.h"
#include "support/random.h"

namespace odis::test {
namespace {

using namespace render;

// Maps of several cells: random ones, some of them with little else than one texel.
class Maps {
 public:
  explicit Maps(Random& random) {
    for (int cell = 0; cell < kCells; ++cell) {
      uint16_t* texels = m_texels.data() + cell * kMapTexels;
      for (int t = 0; t < kMapTexels; ++t) texels[t] = uint16_t(1 + (cell % 3 == 0 ? 0 : random() * 60000));
      texels[int(random() * kMapTexels)] = 65535;
      core::sumBlocks(texels, m_sums.data() + cell * kSumsPerMap);
    }
    m_arrays = m_first.arrays();  // for the directions of texels
    m_arrays.texels = m_texels.data();
    m_arrays.sums = m_sums.data();
  }
  const MapArrays& arrays() const { return m_arrays; }

  static constexpr int kCells = 20;

 private:
  core::PackedMap m_first{};
  std::vector<uint16_t> m_texels = std::vector<uint16_t>(kCells * kMapTexels);
  std::vector<float> m_sums = std::vector<float>(kCells * kSumsPerMap);
  MapArrays m_arrays;
};

// The number of vertices leaves lanes unused.
constexpr size_t kCount = 13;

TEST(MapLanes, AnswerAsMapsDo) {
  Random random(1);
  const Maps maps(random);
  for (int round = 0; round < 500; ++round) {
    MapPreparations preparations;
    MapSamples samples;
    MapLookUps lookUps;
    std::array<VertexMap<float>, kCount> prepared, expected;
    for (size_t i = 0; i < kCount; ++i) {
      const int32_t cell = int32_t(random() * Maps::kCells);
      const Vec3 normal = random.direction();
      const float below = random() < 0.5f ? 0.0f : -1.0f;
      expected[i].prepare(maps.arrays(), cell, toOdis(normal), below);
      preparations.add(prepared[i], cell, normal, below);
    }
    prepareMaps(maps.arrays(), preparations);
    std::array<Vec2, kCount> numbers;
    std::array<Vec3, kCount> directions;
    for (size_t i = 0; i < kCount; ++i) {
      samples.add(prepared[i], numbers[i] = random.pair());
      lookUps.add(prepared[i], directions[i] = random.direction());
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
  const VertexMap<float>& map;
  VertexMap<float>::Sample sample(float u, float v) const { return map.sample(u, v); }
  float pdf(const Float3& wi) const { return map.pdf(wi); }
};

bool same(const BsdfSample& a, const BsdfSample& b) {
  return a.wi == b.wi && a.weight == b.weight && a.pdf == b.pdf && a.guidablePdf == b.guidablePdf &&
         a.eta == b.eta && a.lobe == b.lobe;
}

// Vertices on one surface, some of whose cells guide and some not: the steps of a bounce sample the very
// mixture that Mixture::sample() is the definition of.
void expectDirectionsOfTheMixture(const std::string& bsdf, Random& random) {
  const auto scene = loadScene(sensor("origin=\"0,0,5\" target=\"0,0,0\" up=\"0,1,0\"", 40, 8, 8) +
                               "<shape type=\"rectangle\">" + bsdf + "</shape>");
  const Maps maps(random);
  std::vector<OdisCellDecisions> decisions(Maps::kCells);
  for (OdisCellDecisions& cell : decisions)
    for (float& fraction : cell.bsdfFraction) fraction = random() < 0.25f ? 1.0f : 0.1f + 0.8f * random();
  OdisGuideView view;
  view.maps = maps.arrays();
  view.decisions = decisions.data();
  PathSettings settings;
  settings.scene = scene.get();
  settings.guide = &view;
  int guided = 0, fromMaps = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Path> paths;
    std::vector<Vertex> vertices(kCount);
    std::array<Bounce, kCount> bounces;
    for (size_t i = 0; i < kCount; ++i) {
      const Vec3 target(2 * random() - 1, 2 * random() - 1, 0), origin = random.inCube(1) + Vec3(0, 0, 3);
      const Ray ray{origin, normalize(target - origin)};
      Hit hit;
      scene->intersect({&ray, 1}, {&hit, 1});
      ASSERT_TRUE(hit.shape);
      vertices[i].at = hit.surfacePoint(ray);
      vertices[i].wo = vertices[i].at.shading.toLocal(-ray.direction);
      paths.emplace_back(ray, Sampler(SamplerKind::independent, 1, uint32_t(i), 0));
    }
    for (size_t i = 0; i < kCount; ++i) {
      Bounce& bounce = bounces[i];
      bounce.path = &paths[i];
      bounce.vertex = &vertices[i];
      bounce.cell = random() < 0.2f ? kNoCell : uint32_t(random() * Maps::kCells);
      bounce.guidable = vertices[i].at.shape->bsdf().guidableProbability(vertices[i].at, vertices[i].wo);
      bounce.numbers.lobe = random();
      bounce.numbers.direction = random.pair();
    }
    prepareDirections(settings, bounces);
    chooseBlocks(bounces);
    sampleDirections(bounces);
    for (const Bounce& bounce : bounces) {
      const BsdfHost host{*bounce.vertex, bounce.numbers.lobe};
      const auto [u, v] = bounce.numbers.direction;
      const VertexMap<float>* map = bounce.bsdf.map();
      BsdfSample expected =
          map ? bounce.bsdf.mixture().sample(OneMap{*map}, u, v, host) : host.sampleBsdf(u, v);
      if (!isFinite(expected.weight)) expected = {};
      EXPECT_TRUE(same(bounce.next, expected)) << bsdf;
      guided += map != nullptr;
      fromMaps += map && bounce.draw.fromMap;
    }
  }
  EXPECT_GT(guided, 500) << bsdf;
  EXPECT_GT(fromMaps, 200) << bsdf;
}

TEST(Directions, AreThoseOfTheMixture) {
  Random random(2);
  for (const char* bsdf : {"<bsdf type=\"diffuse\"/>",  //
                           "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.3\"/></bsdf>",
                           // Lobes that are too sharp to be guided, and delta lobes, beside one that may be.
                           "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.01\"/></bsdf>",
                           "<bsdf type=\"plastic\"/>",
                           "<bsdf type=\"roughdielectric\"><float name=\"alpha\" value=\"0.4\"/></bsdf>"})
    expectDirectionsOfTheMixture(bsdf, random);
}

}  // namespace
}  // namespace odis::test
