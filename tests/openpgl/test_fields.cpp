// A field that learns from paths, and the directions that it gives.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "openpgl/host.h"
#include "support/chi2.h"
#include "support/temporary_folder.h"

namespace odis::test {
namespace {

class PglFields : public ::testing::Test {
 protected:
  PglFields() {
    config.Init(PGL_SPATIAL_STRUCTURE_KDTREE, PGL_DIRECTIONAL_DISTRIBUTION_PARALLAX_AWARE_VMM);
    config.SetSpatialStructureArgMaxDepth(16);
    room.lampSize = 0.1f;
  }
  std::unique_ptr<pgl::Field> newField() { return std::make_unique<pgl::Field>(&device, config); }
  std::unique_ptr<pgl::Field> taughtField(uint64_t paths = 20000) {
    std::unique_ptr<pgl::Field> field = newField();
    pgl::SampleStorage samples;
    PglHost(room).traceAndAdd(nullptr, samples, 1, paths);
    field->Update(samples);
    return field;
  }
  // The mean of what paths bring, and the square of its standard error.
  std::pair<double, double> image(const pgl::Field* field, uint64_t firstSeed) const {
    const PglHost host(room);
    pgl::PathSegmentStorage path;
    double sum = 0, squares = 0;
    constexpr uint64_t kPaths = 100000;
    for (uint64_t i = 0; i < kPaths; ++i) {
      const double value = host.trace(field, path, numbersOf(firstSeed + i));
      sum += value;
      squares += value * value;
    }
    const double mean = sum / kPaths;
    return {mean, (squares / kPaths - mean * mean) / kPaths};
  }
  // The distribution on the floor.
  void prepare(pgl::SurfaceSamplingDistribution& distribution, const pgl::Field& field,
               const Float3& position = {0.3f, 0.4f, 1e-4f}) {
    float unused = 0;
    ASSERT_TRUE(distribution.Init(&field, toPgl(position), unused));
    distribution.ApplyCosineProduct({0, 0, 1});
  }

  pgl::Device device{PGL_DEVICE_TYPE_CPU_8};
  pgl::FieldConfig config;
  ToyRoom room;
};

TEST_F(PglFields, KnowNothingAtFirst) {
  const auto field = newField();
  pgl::SurfaceSamplingDistribution distribution(field.get());
  float unused = 0;
  EXPECT_FALSE(distribution.Init(field.get(), {0.5f, 0.5f, 0}, unused));
  EXPECT_EQ(field->GetIteration(), 0u);
  field->Update(pgl::SampleStorage());
  EXPECT_EQ(field->GetIteration(), 0u);
}

// Tests the samples of a distribution against its density. Returns for how many the two state densities that
// differ.
template <class Distribution>
int expectSamplesFollow(const Distribution& distribution, const Chi2Options& options) {
  int different = 0;
  EXPECT_TRUE(chi2Test(
      [&](float u, float v, float) {
        pgl_vec3f wi;
        const float pdf = distribution.SamplePDF({u, v}, wi);
        different += std::abs(pdf - distribution.PDF(wi)) > 1e-4f * pdf;
        return std::optional(fromPgl(wi));
      },
      [&](const Float3& wi) { return distribution.PDF(toPgl(wi)); }, options));
  return different;
}

TEST_F(PglFields, SamplesFollowTheDensity) {
  const auto field = taughtField();
  pgl::SurfaceSamplingDistribution distribution(field.get());
  Chi2Options options;
  options.testCount = 3;
  options.quadrature = 48;  // the density jumps at the borders of texels
  int different = 0;
  for (const Float3& position : {Float3{0.3f, 0.4f, 1e-4f}, {0.9f, 0.1f, 1e-4f}, {50, 50, 50}}) {
    prepare(distribution, *field, position);
    different += expectSamplesFollow(distribution, options);
  }
  EXPECT_LE(different, 5);  // of 600,000: directions on a border may be rounded across it
}

TEST_F(PglFields, ClearedDistributionsForgetTheField) {
  const auto field = taughtField(2000);
  pgl::SurfaceSamplingDistribution distribution(field.get());
  prepare(distribution, *field);
  distribution.Clear();
  EXPECT_NEAR(distribution.PDF({0, 0, 1}), 1 / kPi, 1e-6f);
}

// What Cycles resamples candidates by: that of radiance, but for a factor.
TEST_F(PglFields, RadianceDensityIsTheMapsOverTheCosine) {
  const auto field = taughtField();
  pgl::SurfaceSamplingDistribution distribution(field.get());
  prepare(distribution, *field);
  constexpr int kSteps = 40;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const float z = 2 * (float(i / kSteps) + 0.5f) / kSteps - 1,
                phi = 2 * kPi * (float(i % kSteps) + 0.5f) / kSteps;
    const float r = std::sqrt(1 - z * z);
    const pgl_vec3f wi{r * std::cos(phi), r * std::sin(phi), z};
    const float expected = distribution.PDF(wi) / std::max(std::abs(z), 0.1f) / 2;
    EXPECT_NEAR(distribution.IncomingRadiancePDF(wi), expected, 1e-5f * expected);
  }
}

TEST_F(PglFields, GuidedImagesAreRightAndLessNoisy) {
  const auto [path, ofPath] = image(nullptr, 1'000'000);
  const auto [guided, ofGuided] = image(taughtField(40000).get(), 2'000'000);
  EXPECT_LT(std::abs(path - guided), 4 * std::sqrt(ofPath + ofGuided)) << path << " and " << guided;
  EXPECT_LT(ofGuided, 0.7 * ofPath);
}

// One that learned while another lamp was on looks the wrong way.
TEST_F(PglFields, WrongFieldsMakeNoiseAndNoBias) {
  room.lampRadiance[0] = 0;
  room.lampRadiance[1] = 40;
  const auto field = taughtField(40000);
  room.lampRadiance[0] = 40;
  room.lampRadiance[1] = 0;
  const auto [path, ofPath] = image(nullptr, 1'000'000);
  const auto [guided, ofGuided] = image(field.get(), 2'000'000);
  EXPECT_LT(std::abs(path - guided), 4 * std::sqrt(ofPath + ofGuided)) << path << " and " << guided;
  EXPECT_GT(ofGuided, 1.2 * ofPath);
}

TEST_F(PglFields, DoNotDependOnThreadsNorOrder) {
  const PglHost host(room);
  const auto taughtBy = [&](int threads) {
    pgl::SampleStorage samples;
    std::vector<std::thread> workers;
    constexpr uint64_t kPaths = 8000;
    for (int t = threads - 1; t >= 0; --t)
      workers.emplace_back([&, t] {
        host.traceAndAdd(nullptr, samples, 1 + uint64_t(t) * kPaths / uint64_t(threads),
                         kPaths / uint64_t(threads));
      });
    for (std::thread& worker : workers) worker.join();
    std::unique_ptr<pgl::Field> field = newField();
    field->Update(samples);
    return field;
  };
  const auto one = taughtBy(1), four = taughtBy(4);
  EXPECT_TRUE(*one == *four);
  EXPECT_FALSE(*one == *taughtField(7000));
}

TEST_F(PglFields, StopAskingForSamplesWhenTheyHaveEnough) {
  const auto field = newField();
  pgl::SampleStorage samples;
  for (uint64_t update = 0; update < 7; ++update) {
    PglHost(room).traceAndAdd(nullptr, samples, 1 + 1000 * update, 1000);
    field->Update(samples);
    samples.Clear();
    EXPECT_EQ(field->GetIteration(), update + 1);
  }
  PglHost(room).traceAndAdd(nullptr, samples, 7001, 1200);
  field->Update(samples);
  EXPECT_GT(field->GetIteration(), 1000000u);
  field->Reset();
  EXPECT_EQ(field->GetIteration(), 0u);
}

TEST_F(PglFields, KeepNoMoreThanTwiceWhatTheyKnow) {
  const auto field = newField();
  const PglHost host(room);
  pgl::SampleStorage samples;
  host.traceAndAdd(nullptr, samples, 1, 20000);
  const size_t known = samples.GetSizeSurface();
  field->Update(samples);
  // Kept are the same paths, whichever came first: halves of them are left out until there are few enough.
  size_t kept[2];
  for (const bool backwards : {false, true}) {
    samples.Clear();
    for (uint64_t i = 0; i < 10; ++i)
      host.traceAndAdd(nullptr, samples, 100001 + 10000 * (backwards ? 9 - i : i), 10000);
    kept[backwards] = samples.GetSizeSurface();
    EXPECT_LE(kept[backwards], 2 * known);
    EXPECT_GT(kept[backwards], known / 2);
  }
  EXPECT_EQ(kept[0], kept[1]);
}

TEST_F(PglFields, AreStoredAndLoaded) {
  const TemporaryFolder folder;
  const std::string file = folder.path("field");
  EXPECT_FALSE(newField()->Store(file));
  const auto field = taughtField(5000);
  ASSERT_TRUE(field->Store(file));
  const pgl::Field loaded(&device, file);
  EXPECT_TRUE(*field == loaded);
  EXPECT_THROW(pgl::Field(&device, folder.path("none")), std::runtime_error);
  EXPECT_NE(loaded.GetSurfaceStatistics().ToString().find("cells"), std::string::npos);
}

// Two ends of a floor: over one (x < 1) the same light comes from everywhere, over the other one (x > 4)
// from a hole in a dark sky, or in one of this radiance.
void learnUnderTwoSkies(pgl::Field& field, int paths, float aroundHole = 0) {
  pgl::SampleStorage samples;
  pgl::PathSegmentStorage path;
  ToyNumbers numbers = numbersOf(1);
  for (int i = 0; i < paths; ++i) {
    const bool dark = i % 2;
    const Float3 position{numbers.next() + (dark ? 4.0f : 0.0f), numbers.next(), 0};
    const float phi = 2 * kPi * numbers.next(), r = std::sqrt(numbers.next());
    const Float3 wi{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)};
    path.Clear();
    pgl::PathSegment* vertex = path.NextSegment();
    pgl::SetPosition(vertex, toPgl(position));
    pgl::SetNormal(vertex, {0, 0, 1});
    pgl::SetDirectionOut(vertex, {0, 0, 1});
    pgl::SetDirectionIn(vertex, toPgl(wi));
    pgl::SetPDFDirectionIn(vertex, std::max(wi.z, 1e-3f) / kPi);
    pgl::SetScatteringWeight(vertex, {0.5f, 0.5f, 0.5f});
    const float sky = dark && dot(wi, {0.6f, 0, 0.8f}) < 0.95f ? aroundHole : 1.0f;
    pgl::SetDirectContribution(path.NextSegment(), {sky, sky, sky});
    handOver(path, samples);
  }
  field.Update(samples);
}

bool guidesAt(const pgl::Field& field, const pgl_point3f& position) {
  pgl::SurfaceSamplingDistribution distribution(&field);
  float unused = 0;
  return distribution.Init(&field, position, unused);
}

TEST_F(PglFields, LeavePlacesToTheBsdfWhereLittleVaries) {
  const auto field = newField();
  learnUnderTwoSkies(*field, 20000);
  EXPECT_FALSE(guidesAt(*field, {0.5f, 0.5f, 0}));
  EXPECT_TRUE(guidesAt(*field, {4.5f, 0.5f, 0}));
  // Where nothing is known a host is given the cosine, as there may be a guide later.
  EXPECT_TRUE(guidesAt(*field, {50, 0.5f, 0}));
}

TEST_F(PglFields, FewVerticesDontTellWhatVaries) {
  const auto field = newField();
  learnUnderTwoSkies(*field, 20);
  EXPECT_TRUE(guidesAt(*field, {0.5f, 0.5f, 0}));
}

TEST_F(PglFields, GuideNothingWhereThatGainsNothing) {
  const auto field = newField();
  learnUnderTwoSkies(*field, 20000, 1);
  EXPECT_FALSE(guidesAt(*field, {4.5f, 0.5f, 0}));
  EXPECT_FALSE(guidesAt(*field, {50, 0.5f, 0}));
  EXPECT_GT(field->GetIteration(), 1000000u) << "there is nothing to record for";
}

TEST_F(PglFields, LoadedFieldsGuideEverywhere) {
  const TemporaryFolder folder;
  const auto field = newField();
  learnUnderTwoSkies(*field, 20000);
  ASSERT_TRUE(field->Store(folder.path("field")));
  pgl::Field loaded(&device, folder.path("field"));
  EXPECT_TRUE(guidesAt(loaded, {0.5f, 0.5f, 0}));
  // What its paths bring by then was guided, and does not tell what the BSDF alone would bring.
  learnUnderTwoSkies(loaded, 20000);
  EXPECT_TRUE(guidesAt(loaded, {0.5f, 0.5f, 0}));
}

TEST_F(PglFields, TakeSamplesWithoutPaths) {
  const auto field = newField();
  pgl::SampleStorage samples;
  ToyNumbers numbers = numbersOf(1);
  for (int i = 0; i < 20000; ++i) {
    const float phi = 2 * kPi * numbers.next(), r = std::sqrt(numbers.next());
    const Float3 wi{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)};
    const bool bright = dot(wi, {0.6f, 0, 0.8f}) > 0.95f;
    const float pdf = std::max(wi.z, 1e-3f) / kPi;
    samples.AddSample(
        {{numbers.next(), numbers.next(), 0}, toPgl(wi), (bright ? 10 : 0.1f) / pdf, pdf, 1, 0});
  }
  EXPECT_EQ(samples.GetSizeSurface(), 20000u);
  field->Update(samples);
  pgl::SurfaceSamplingDistribution distribution(field.get());
  prepare(distribution, *field, {0.5f, 0.5f, 0});
  EXPECT_GT(distribution.PDF({0.6f, 0, 0.8f}), 3 * distribution.PDF({-0.6f, 0, 0.8f}));
}

TEST_F(PglFields, VolumesThatNothingIsKnownOfAreLeftToTheHost) {
  const auto field = taughtField(2000);
  pgl::VolumeSamplingDistribution distribution(field.get());
  float unused = 0;
  EXPECT_FALSE(distribution.Init(field.get(), {0, 0, 0}, unused));
  EXPECT_NEAR(distribution.PDF({0, 0, 1}), 1 / (4 * kPi), 1e-6f);
}

TEST_F(PglFields, GuideDirectionsInVolumes) {
  const auto field = newField();
  pgl::SampleStorage samples;
  ToyNumbers numbers = numbersOf(2);
  for (int i = 0; i < 40000; ++i) {
    const float z = 2 * numbers.next() - 1, phi = 2 * kPi * numbers.next(), r = std::sqrt(1 - z * z);
    const Float3 wi{r * std::cos(phi), r * std::sin(phi), z};
    const float pdf = 1 / (4 * kPi), radiance = dot(wi, {0.6f, 0, -0.8f}) > 0.95f ? 10.0f : 0.1f;
    samples.AddSample({{numbers.next(), numbers.next(), numbers.next()},
                       toPgl(wi),
                       radiance / pdf,
                       pdf,
                       1,
                       pgl::SampleData::EInsideVolume});
  }
  EXPECT_EQ(samples.GetSizeSurface(), 0u);
  EXPECT_EQ(samples.GetSizeVolume(), 40000u);
  field->Update(samples);
  pgl::VolumeSamplingDistribution distribution(field.get());
  float unused = 0;
  ASSERT_TRUE(distribution.Init(field.get(), {0.5f, 0.5f, 0.5f}, unused));
  distribution.ApplySingleLobeHenyeyGreensteinProduct({0, 0, 1}, 0.3f);
  EXPECT_GT(distribution.PDF({0.6f, 0, -0.8f}), 5 * distribution.PDF({-0.6f, 0, 0.8f}));
  Chi2Options options;
  options.quadrature = 48;  // the density jumps at the borders of texels
  EXPECT_LE(expectSamplesFollow(distribution, options), 5);
  distribution.Clear();
  EXPECT_NEAR(distribution.PDF({0, 0, 1}), 1 / (4 * kPi), 1e-6f);
}

// A volume of a narrow phase function, which the samples were drawn from. In its lower half light comes from
// one side, in its upper half now and then and from anywhere: there the phase function draws all directions,
// also those that the host asks for.
TEST_F(PglFields, LeaveDirectionsInVolumesToNarrowPhaseFunctions) {
  const auto field = newField();
  pgl::SampleStorage samples;
  ToyNumbers numbers = numbersOf(3);
  const float g = 0.6f;
  const auto phase = [&](float cosine) {
    return (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5f));
  };
  const Float3 forward{0.6f, 0, 0.8f};
  for (int i = 0; i < 20000; ++i) {
    const Float3 at{numbers.next(), numbers.next(), numbers.next()};
    const float turned = (1 - g * g) / (1 - g + 2 * g * numbers.next());
    const float cosine = (1 + g * g - turned * turned) / (2 * g), sine = std::sqrt(1 - cosine * cosine);
    const float phi = 2 * kPi * numbers.next();
    const Float3 wi = forward * cosine + Float3{0, 1, 0} * (sine * std::cos(phi)) +
                      Float3{0.8f, 0, -0.6f} * (sine * std::sin(phi));
    pgl::PathSegmentStorage path;
    pgl::PathSegment* first = path.NextSegment();
    pgl::SetPosition(first, toPgl(at));
    pgl::SetDirectionOut(first, toPgl(forward * -1.0f));
    pgl::SetVolumeScatter(first, true);
    pgl::SetRoughness(first, 1 - g);
    pgl::SetDirectionIn(first, toPgl(wi));
    pgl::SetPDFDirectionIn(first, phase(cosine));
    pgl::SetScatteringWeight(first, {1, 1, 1});
    pgl::PathSegment* sky = path.NextSegment();
    pgl::SetPosition(sky, toPgl(at + wi * 1e4f));
    pgl::SetDirectionOut(sky, toPgl(wi * -1.0f));
    pgl::SetNormal(sky, toPgl(wi * -1.0f));
    const bool now = numbers.next() < 0.05f;
    const float light = at.z < 0.5f ? (dot(wi, forward) < 0 ? 10.0f : 0.1f) : now ? 40.0f : 0.0f;
    pgl::SetDirectContribution(sky, {light, light, light});
    handOver(path, samples);
  }
  field->Update(samples);
  pgl::VolumeSamplingDistribution distribution(field.get());
  float unused = 0;
  float lowerShare = 0, upperShare = 0;
  for (const bool upper : {false, true}) {
    ASSERT_TRUE(distribution.Init(field.get(), {0.5f, 0.5f, upper ? 0.8f : 0.2f}, unused));
    const float ofMap = distribution.PDF(toPgl(forward));
    distribution.ApplySingleLobeHenyeyGreensteinProduct(toPgl(forward), g);
    const float share = (distribution.PDF(toPgl(forward)) - ofMap) / (phase(1) - ofMap);
    EXPECT_GE(share, 0);
    upper ? upperShare = share : lowerShare = share;
    Chi2Options options;
    options.quadrature = 48;
    EXPECT_LE(expectSamplesFollow(distribution, options), 5);
  }
  EXPECT_GT(upperShare, 0.9f);
  EXPECT_LT(lowerShare, 0.7f);
}

}  // namespace
}  // namespace odis::test
