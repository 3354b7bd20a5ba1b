// The mixture of BSDF and map: what is sampled has the density that is told, and weights go with it.
#include <odis/mixture.h>
#include <odis/sampling_map.h>

#include <numbers>
#include <ostream>
#include <random>

#include "odis/maps/pack.h"
#include "support/chi2.h"

namespace odis::core {
namespace {

// A map of sixteen bits of chance, or one that grows towards a direction.
PackedMap someMap(bool random) {
  Histogram weights;
  std::mt19937 engine(7);
  for (int t = 0; t < kMapTexels; ++t) {
    const Float3 w = texelDirection(t);
    const float towards = dot(w, Float3{0.8f, 0, 0.6f}), cosine = std::max(w.z, 0.0f);
    weights[size_t(t)] = cosine * (random ? float(1 + engine() % 65535) : 1 + 30000 * (1 + towards));
  }
  return PackedMap(weights);
}

// How often a BSDF draws from each of its lobes.
struct LobeProbabilities {
  float diffuse = 1, glossy = 0, mirror = 0;
};

// A BSDF about +z of three lobes, as a renderer would join it to the mixture: a diffuse one that may be
// guided, a glossy one around a tilted axis that may not, and a mirror. The lobe is chosen by a number of its
// own.
class ToyHost {
 public:
  enum class Lobe { none, diffuse, glossy, mirror };
  struct Sample {
    Float3 wi;
    float pdf = 0, weight = 0;
    Lobe lobe = Lobe::none;
    bool fromMap = false;
  };
  ToyHost(const LobeProbabilities& lobes, float uLobe) : m_lobes(lobes), m_uLobe(uLobe) {}

  Sample sampleBsdf(float u, float v) const {
    if (m_uLobe >= m_lobes.diffuse + m_lobes.glossy)
      return {{0, 0, 1}, m_lobes.mirror, 0.9f / m_lobes.mirror, Lobe::mirror};
    const bool diffuse = m_uLobe < m_lobes.diffuse;
    // Power lobes, of exponent one about the normal, and of exponent 30 about the tilted axis.
    const float cosine = std::pow(1 - u, diffuse ? 0.5f : 1 / (kExponent + 1)),
                phi = 2 * std::numbers::pi_v<float> * v;
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const Float3 local{sine * std::cos(phi), sine * std::sin(phi), cosine};
    const Float3 wi =
        diffuse ? local : Float3{0.8f * local.x + 0.6f * local.z, local.y, 0.8f * local.z - 0.6f * local.x};
    const float pdf = bsdfPdf(wi);
    return {wi, pdf, value(wi) / pdf, diffuse ? Lobe::diffuse : Lobe::glossy};
  }
  bool isDiscrete(const Sample& s) const { return s.lobe == Lobe::mirror; }
  bool isSharp(const Sample& s) const { return s.lobe == Lobe::glossy; }
  bool failed(const Sample& s) const { return s.lobe == Lobe::none; }
  template <class PdfOf>
  Sample evaluate(const Float3& wi, const PdfOf& pdfOf) const {
    const float pdf = pdfOf(bsdfPdf(wi), guidablePdf(wi));
    return {wi, pdf, value(wi) / pdf, Lobe::diffuse, true};
  }
  template <class PdfOf>
  void reweigh(Sample& s, const PdfOf& pdfOf) const {
    const float pdf = pdfOf(s.pdf, guidablePdf(s.wi), s.wi);
    s.weight *= s.pdf / pdf;
    s.pdf = pdf;
  }

  // What the BSDF scatters, times the cosine, mirror aside: other than what it samples.
  float value(const Float3& wi) const {
    return 0.5f * guidablePdf(wi) + (m_lobes.glossy > 0 ? glossyPdf(wi) : 0);
  }
  float guidablePdf(const Float3& wi) const {
    return m_lobes.diffuse * std::max(wi.z, 0.0f) * std::numbers::inv_pi_v<float>;
  }
  float bsdfPdf(const Float3& wi) const { return guidablePdf(wi) + m_lobes.glossy * glossyPdf(wi); }
  // The integral of value().
  double albedo() const { return 0.5 * m_lobes.diffuse + (m_lobes.glossy > 0); }

 private:
  static constexpr float kExponent = 30;
  // The glossy lobe reaches below the horizon, as real ones do.
  static float glossyPdf(const Float3& wi) {
    const float cosine = std::max(dot(wi, Float3{0.6f, 0, 0.8f}), 0.0f);
    return (kExponent + 1) / (2 * std::numbers::pi_v<float>)*std::pow(cosine, kExponent);
  }
  LobeProbabilities m_lobes;
  float m_uLobe;
};

struct MixtureCase {
  bool randomMap;
  LobeProbabilities lobes;
  float fraction;
  friend std::ostream& operator<<(std::ostream& out, const MixtureCase& c) {
    return out << (c.randomMap ? "random map, " : "smooth map, ") << c.lobes.diffuse << " diffuse, "
               << c.lobes.glossy << " glossy, fraction " << c.fraction;
  }
};

// The density of the mixture, mirror aside.
float densityOf(const MixtureCase& c, const SamplingMap<float>& map, const Float3& wi) {
  const ToyHost host(c.lobes, 0);
  return Mixture<float>(c.fraction, c.lobes.diffuse).pdf(host.bsdfPdf(wi), host.guidablePdf(wi), map.pdf(wi));
}

class MixtureTest : public ::testing::TestWithParam<MixtureCase> {};
constexpr int kMixtureCases = 9;

TEST_P(MixtureTest, SampleHasTheDensityOfPdf) {
  const MixtureCase& c = GetParam();
  const PackedMap packed = someMap(c.randomMap);
  const SamplingMap<float> map = packed.view();
  const Mixture<float> mixture(c.fraction, c.lobes.diffuse);
  test::Chi2Options options;
  options.quadrature = 48;
  options.testCount = kMixtureCases;
  EXPECT_TRUE(test::chi2Test(
      [&](float uLobe, float u, float v) -> std::optional<Float3> {
        const ToyHost host(c.lobes, uLobe);
        const ToyHost::Sample s = mixture.sample(map, u, v, host);
        if (host.isDiscrete(s)) return {};
        return s.wi;
      },
      [&](const Float3& w) { return densityOf(c, map, w); }, options));
}

TEST_P(MixtureTest, DensityIntegratesToOne) {
  const MixtureCase& c = GetParam();
  const PackedMap packed = someMap(c.randomMap);
  const SamplingMap<float> map = packed.view();
  double integral = 0;
  const int n = 1024;  // as many points in every texel
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      integral += densityOf(c, map, squareToDirection(Float2{(i + 0.5f) / n, (j + 0.5f) / n}));
  EXPECT_NEAR(integral * 4 * std::numbers::pi / (double(n) * n) + c.lobes.mirror, 1, 1e-3);
}

TEST_P(MixtureTest, SamplesCarryTheirDensityAndTheBsdfOverIt) {
  const MixtureCase& c = GetParam();
  const PackedMap packed = someMap(c.randomMap);
  const SamplingMap<float> map = packed.view();
  const Mixture<float> mixture(c.fraction, c.lobes.diffuse);
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  const auto draw = [&] { return std::min(uniform(engine), test::kOneMinusEpsilon); };
  constexpr int kSamples = 200000;
  int fromMap = 0, discrete = 0, different = 0;
  double sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const ToyHost host(c.lobes, draw());
    const float u = draw(), v = draw();
    const ToyHost::Sample s = mixture.sample(map, u, v, host);
    if (host.isDiscrete(s)) {
      ++discrete;
      ASSERT_EQ(s.weight, 0.9f / c.lobes.mirror);  // as ever
      continue;
    }
    const float expected = densityOf(c, map, s.wi);
    // A sample on the very border of a texel may be looked up next door.
    different += std::abs(s.pdf - expected) > 1e-3f * expected;
    ASSERT_NEAR(s.weight, host.value(s.wi) / s.pdf, 1e-3f * s.weight + 1e-6f);
    fromMap += s.fromMap;
    sum += s.weight;
    squares += double(s.weight) * s.weight;
  }
  EXPECT_LE(different, kSamples / 1000);
  // The mean of the weights is what the BSDF scatters, whatever is guided.
  const double mean = sum / kSamples, deviation = std::sqrt((squares / kSamples - mean * mean) / kSamples);
  EXPECT_NEAR(mean, ToyHost(c.lobes, 0).albedo(), 4 * deviation);
  // Draws that may be guided come from the map as often as the fraction says, others never do.
  const auto expectShare = [](int count, double probability) {
    EXPECT_NEAR(count / double(kSamples), probability,
                4 * std::sqrt(probability * (1 - probability) / kSamples) + 1e-9);
  };
  expectShare(fromMap, (1 - c.fraction) * c.lobes.diffuse);
  expectShare(discrete, c.lobes.mirror);
}

INSTANTIATE_TEST_SUITE_P(
    Hosts, MixtureTest,
    ::testing::Values(MixtureCase{true, {1, 0, 0}, 1}, MixtureCase{true, {1, 0, 0}, 0.5f},
                      MixtureCase{true, {1, 0, 0}, 0.15f}, MixtureCase{true, {0.7f, 0.3f, 0}, 0.8f},
                      MixtureCase{true, {0.7f, 0.3f, 0}, 0.15f}, MixtureCase{false, {0.7f, 0.3f, 0}, 0.4f},
                      MixtureCase{true, {0.5f, 0.25f, 0.25f}, 0.4f},
                      MixtureCase{false, {0.5f, 0, 0.5f}, 0.25f},
                      MixtureCase{false, {0, 0.75f, 0.25f}, 0.25f}));

TEST(Mixture, IntegratesToOneAndKeepsSharpLobes) {
  // A BSDF that draws 0.7 of the time from a cosine lobe that may be guided and 0.3 from another that may
  // not.
  const float guidable = 0.7f, fraction = 0.4f;
  const PackedMap packed = someMap(true);
  const SamplingMap<float> map = packed.view();
  double integral = 0;
  const int n = 1000;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Float3 w = squareToDirection(Float2{(i + 0.5f) / n, (j + 0.5f) / n});
      const float cosine = std::max(w.z, 0.0f) * std::numbers::inv_pi_v<float>;
      const float sharp = w.z > 0.9f ? 1 / (2 * std::numbers::pi_v<float> * 0.1f) : 0;
      const float mixed =
          mixturePdf(0.7f * cosine + 0.3f * sharp, 0.7f * cosine, guidable, fraction, map.pdf(w));
      EXPECT_GE(mixed, 0.3f * sharp * 0.999f);
      integral += mixed;
    }
  EXPECT_NEAR(integral * 4 * std::numbers::pi / (double(n) * n), 1, 2e-3);
}

TEST(Mixture, IsTheBsdfAloneByDefault) {
  const Mixture<float> mixture;
  EXPECT_FALSE(mixture.guides());
  EXPECT_EQ(mixture.bsdfFraction(), 1);
  EXPECT_EQ(mixture.pdf(0.25f, 0.125f, 3), 0.25f);
  EXPECT_FALSE(Mixture<float>(1, 1).guides());
  EXPECT_FALSE(Mixture<float>(0.5f, 0).guides());
  EXPECT_TRUE(Mixture<float>(0.5f, 0.1f).guides());
  // A map that there is nothing to sample of is not asked.
  const SamplingMap<float> none{};
  const ToyHost host({1, 0, 0}, 0.5f);
  const ToyHost::Sample guided = mixture.sample(none, 0.25f, 0.75f, host),
                        plain = host.sampleBsdf(0.25f, 0.75f);
  EXPECT_EQ(guided.wi.x, plain.wi.x);
  EXPECT_EQ(guided.weight, plain.weight);
}

TEST(Mixture, OneNumberChoosesAndIsStretchedAgain) {
  for (const float fraction : {0.15f, 0.25f, 0.4f, 0.6f, 0.8f, 0.999f}) {
    const Mixture<float> mixture(fraction, 1);
    const Mixture<float>::Choice first = mixture.choose(0), at = mixture.choose(fraction),
                                 last = mixture.choose(test::kOneMinusEpsilon);
    EXPECT_FALSE(first.fromMap);
    EXPECT_EQ(first.u, 0);
    EXPECT_TRUE(at.fromMap);
    EXPECT_EQ(at.u, 0);
    EXPECT_TRUE(last.fromMap);
    EXPECT_GT(last.u, 0.999f);
    EXPECT_LT(last.u, 1);
    const Mixture<float>::Choice below = mixture.choose(std::nextafter(fraction, 0.0f));
    EXPECT_FALSE(below.fromMap);
    EXPECT_LT(below.u, 1);
    // The middle of either part is in the middle of its numbers.
    EXPECT_NEAR(mixture.choose(fraction / 2).u, 0.5f, 1e-6f);
    EXPECT_NEAR(mixture.choose((1 + fraction) / 2).u, 0.5f, 1e-3f);
  }
}

TEST(PowerHeuristic, WeightsAddUpToOne) {
  for (const float a : {1e-3f, 0.5f, 1.0f, 1e6f})
    for (const float b : {1e-3f, 0.7f, 30.0f})
      EXPECT_NEAR(powerHeuristic(a, b) + powerHeuristic(b, a), 1, 1e-5);
  EXPECT_EQ(powerHeuristic(0.0f, 1.0f), 0);
  EXPECT_EQ(powerHeuristic(1.0f, 0.0f), 1);
}

}  // namespace
}  // namespace odis::core
