// Phase functions: samples against densities, integrals, and numbers of Mitsuba 3.9.1 (scalar_rgb).
#include "medium/support.h"
#include "support/chi2.h"
#include "support/random.h"

namespace odis::test {
namespace {

using render::dot;
using render::length;
using render::MediumPoint;
using render::normalize;
using render::PhaseFunction;
using render::PhaseFunctionPtr;
using render::Vec2;
using render::Vec3;

constexpr float kSggx[6] = {1, 0.5f, 0.3f, 0.1f, -0.2f, 0.15f}, kFibre[6] = {1, 0.9f, 0.02f, 0.05f, 0, 0.01f};

std::string sggxText(const std::string& file) {
  return "<phase type='sggx'><volume name='S' type='gridvolume'><string name='filename' value='" + file +
         "'/></volume></phase>";
}

struct PhaseCase {
  std::string name, text;
  // phase.eval_pdf() of Mitsuba for mi.wi along (1, 2, 3) and wo along the vectors of kOutgoing.
  std::array<float, 5> mitsuba;
  float roughness;
};
const Vec3 kOutgoing[5] = {{1, 2, 3}, {-1, -2, -3}, {-1, -2, -2.5f}, {2, -1, 0.5f}, {-1, 1, 0.2f}};

std::string hgText(const std::string& g) {
  return "<phase type='hg'><float name='g' value='" + g + "'/></phase>";
}

const PhaseCase kPhaseCases[] = {
    {"isotropic",
     "<phase type='isotropic'/>",
     {0.07957747f, 0.07957747f, 0.07957747f, 0.07957747f, 0.07957747f},
     1},
    {"hg of -0.7", hgText("-0.7"), {1.503129f, 0.008260638f, 0.008284561f, 0.02921323f, 0.03662411f}, 0.3f},
    {"hg of 0", hgText("0"), {0.07957747f, 0.07957747f, 0.07957747f, 0.07957747f, 0.07957747f}, 1},
    {"hg of 0.3", hgText("0.3"), {0.03296108f, 0.2111239f, 0.2095913f, 0.05543596f, 0.05061892f}, 0.7f},
    {"hg", "<phase type='hg'/>", {0.004912189f, 3.580991f, 2.869801f, 0.01076863f, 0.009287258f}, 0.2f},
    {"rayleigh",
     "<phase type='rayleigh'/>",
     {0.1193662f, 0.1193662f, 0.1188925f, 0.06151013f, 0.06503285f},
     1},
    {"tabphase",
     "<phase type='tabphase'><string name='values' value='0.5, 1, 0, 2.5'/></phase>",
     {0.04774648f, 0.2387324f, 0.2373085f, 0.07280818f, 0.09063129f},
     // The integral of cosine times table is 8 / 27 (exact by parts), that of the table 5 / 3.
     1 - 8.0f / 45},
    {"blendphase",
     "<phase type='blendphase'><float name='weight' value='0.3'/><phase type='hg'><float name='g' "
     "value='0.6'/></phase><phase type='rayleigh'/></phase>",
     {0.04451365f, 0.5928523f, 0.5686903f, 0.03657632f, 0.03532421f},
     0.58f},
    // Mitsuba has no number for the direction that goes straight on.
    {"sggx", sggxText("grid.vol"), {0.04383549f, 0, 0.02157049f, 0.02434747f, 0.1299649f}, 1}};

class PhaseFunctions : public ::testing::Test {
 protected:
  PhaseFunctions() {
    m_parts.write({.channels = 6, .value = [](int, int, int, int c) { return kSggx[c]; }});
    m_parts.write({.channels = 6, .value = [](int, int, int, int c) { return kFibre[c]; }}, "fibre.vol");
  }
  // By quadrature over the sphere, in n^2 parts of equal solid angle.
  static double integral(const PhaseFunction& phase, const Vec3& wo, int n) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        sum += phase.pdf(
            {{}, wo}, render::squareToSphere({(float(i) + 0.5f) / float(n), (float(j) + 0.5f) / float(n)}));
    return sum * 4 * std::numbers::pi / n / n;
  }

  MediumParts m_parts;
};

TEST_F(PhaseFunctions, AreThoseOfMitsuba) {
  for (const PhaseCase& test : kPhaseCases) {
    const PhaseFunctionPtr phase = m_parts.phase(test.text);
    const MediumPoint at{{0.3f, 0.6f, 0.4f}, normalize(Vec3(1, 2, 3))};
    for (size_t i = 0; i < 5; ++i)
      EXPECT_NEAR(phase->pdf(at, normalize(kOutgoing[i])), test.mitsuba[i], 2e-5f * (1 + test.mitsuba[i]))
          << test.name << i;
    EXPECT_NEAR(phase->roughness(), test.roughness, 1e-6f) << test.name;
    if (test.name != "sggx") EXPECT_EQ(phase->projectedArea(at), 1) << test.name;
  }
  const PhaseFunctionPtr sggx = m_parts.phase(sggxText("grid.vol"));
  EXPECT_NEAR(sggx->projectedArea({{}, normalize(Vec3(1, 2, 3))}), 0.6917886f, 1e-6f);
  EXPECT_TRUE(m_parts.isQuiet());
}

TEST_F(PhaseFunctions, IntegrateToOne) {
  std::vector<std::string> texts = {hgText("0.9"), hgText("-0.9"), hgText("1e-7"), sggxText("fibre.vol")};
  for (const PhaseCase& test : kPhaseCases) texts.push_back(test.text);
  for (const std::string& text : texts)
    EXPECT_NEAR(integral(*m_parts.phase(text), normalize(Vec3(0.3f, -0.2f, 0.9f)), 600), 1, 2e-3) << text;
}

TEST_F(PhaseFunctions, SampleWhatTheySay) {
  std::vector<std::string> texts = {hgText("0.9"), hgText("1e-7"), hgText("-1e-3"), sggxText("fibre.vol")};
  for (const PhaseCase& test : kPhaseCases) texts.push_back(test.text);
  const Vec3 directions[] = {normalize(Vec3(0.3f, -0.2f, 0.9f)), normalize(Vec3(-1, 0.1f, -0.4f))};
  Chi2Options options;
  options.testCount = int(texts.size()) * 2;
  for (const std::string& text : texts) {
    const PhaseFunctionPtr phase = m_parts.phase(text);
    for (const Vec3& wo : directions) {
      const MediumPoint at{{0.2f, 0.2f, 0.2f}, wo};
      EXPECT_TRUE(chi2Test(
          [&](float u0, float u1, float u2) -> std::optional<Vec3> {
            const PhaseFunction::Sample sample = phase->sample(at, u0, {u1, u2});
            if (!(sample.pdf > 0)) return {};
            return sample.wi;
          },
          [&](const Vec3& wi) { return phase->pdf(at, wi); }, options))
          << text;
    }
  }
}

TEST_F(PhaseFunctions, SamplesComeWithTheirDensity) {
  std::vector<std::string> texts = {hgText("0.99"), hgText("-0.99"), hgText("0.9999"), sggxText("fibre.vol")};
  for (const PhaseCase& test : kPhaseCases) texts.push_back(test.text);
  Random random(11);
  for (const std::string& text : texts) {
    const PhaseFunctionPtr phase = m_parts.phase(text);
    for (int i = 0; i < 2000; ++i) {
      const MediumPoint at{random.inCube(1), random.direction()};
      // The ends of the range as well.
      const Vec2 u = i == 0 ? Vec2(0, 0) : i == 1 ? Vec2(kOneMinusEpsilon, kOneMinusEpsilon) : random.pair();
      const PhaseFunction::Sample sample = phase->sample(at, random(), u);
      ASSERT_NEAR(length(sample.wi), 1, 1e-5f) << text;
      // Directions straight on have no half vector, those of g = 0.9999 are narrower than a float is exact.
      const float tolerance = text == hgText("0.9999") ? 0.02f : 2e-3f;
      if (text.find("sggx") != std::string::npos && dot(sample.wi, at.wo) < -0.9999f) continue;
      ASSERT_NEAR(phase->pdf(at, sample.wi) / sample.pdf, 1, tolerance) << text << i;
    }
  }
}

TEST_F(PhaseFunctions, MeanCosinesAreG) {
  Random random(13);
  for (const float g : {-0.99f, -0.5f, 0.0f, 0.2f, 0.9f, 0.99f}) {
    const PhaseFunctionPtr phase = m_parts.phase(hgText(std::to_string(g)));
    const MediumPoint at{{}, random.direction()};
    double sum = 0;
    constexpr int kStrata = 4096;
    for (int i = 0; i < kStrata; ++i)
      sum -= dot(at.wo, phase->sample(at, 0, {(float(i) + 0.5f) / kStrata, random()}).wi);
    EXPECT_NEAR(sum / kStrata, g, 1e-4) << g;
  }
}

TEST_F(PhaseFunctions, HgIsExactNearItsPeak) {
  // Against double precision, at angles from the peak that are far narrower than it is, and at wider ones.
  Random random(17);
  for (const float g : {-0.99f, 0.99f, 0.999f, 0.9f, 1e-6f}) {
    const PhaseFunctionPtr phase = m_parts.phase(hgText(fmt::format("{}", g)));
    for (int i = 0; i < 200; ++i) {
      const float angle = 0.3f * std::pow(0.95f, float(i));
      const Vec3 wo = random.direction(), axis = g < 0 ? wo : -wo;
      const Vec3 wi = normalize(axis + render::CoordinateFrame(axis).s * angle);
      const Imath::V3d exactWo = Imath::V3d(wo).normalized(), exactWi = Imath::V3d(wi).normalized();
      const double away = (exactWi + exactWo).length(), square = double(g) * g;
      // 1 + g^2 - 2 g cos, where cos = 1 - away^2 / 2 is that of the deflection.
      const double t = (1 - double(g)) * (1 - double(g)) + g * away * away;
      const double expected = (1 - square) / (4 * std::numbers::pi * t * std::sqrt(t));
      ASSERT_NEAR(phase->pdf({{}, wo}, wi) / expected, 1, 5e-5) << g << " " << angle;
    }
  }
}

TEST_F(PhaseFunctions, ATablesRoughnessIsOfItsMeanCosine) {
  // The density (1 + cos) / 2 has the mean cosine 1 / 3.
  EXPECT_NEAR(
      m_parts.phase("<phase type='tabphase'><string name='values' value='0 2'/></phase>")->roughness(),
      2.0f / 3, 1e-6f);
  EXPECT_NEAR(
      m_parts.phase("<phase type='tabphase'><string name='values' value='1 0 1'/></phase>")->roughness(), 1,
      1e-6f);
}

TEST_F(PhaseFunctions, AreBlendedByAVolume) {
  m_parts.write({.size = {2, 1, 1}, .value = [](int x, int, int, int) { return float(x); }}, "weight.vol");
  const PhaseFunctionPtr phase = m_parts.phase(
      "<phase type='blendphase'><volume name='weight' type='gridvolume'><string name='filename' "
      "value='weight.vol'/></volume><phase type='hg'/><phase type='isotropic'/></phase>");
  const PhaseFunctionPtr hg = m_parts.phase("<phase type='hg'/>");
  const Vec3 wo(0, 0, 1), wi = normalize(Vec3(1, 2, -3));
  EXPECT_FLOAT_EQ(phase->pdf({{0, 0, 0}, wo}, wi), hg->pdf({{}, wo}, wi));
  EXPECT_FLOAT_EQ(phase->pdf({{1, 0, 0}, wo}, wi), render::kInvPi / 4);
  EXPECT_FLOAT_EQ(phase->pdf({{0.5f, 0, 0}, wo}, wi), (hg->pdf({{}, wo}, wi) + render::kInvPi / 4) / 2);
  EXPECT_FLOAT_EQ(phase->roughness(), 0.6f);
  EXPECT_TRUE(m_parts.isQuiet());
}

TEST_F(PhaseFunctions, MicroflakesThatAreNoneScatterNothing) {
  // No flakes, flat ones, a matrix that is not definite.
  const std::array<float, 6> matrices[] = {{0, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0}, {1, 1, 1, 2, 0, 0}};
  const Vec3 wo = normalize(Vec3(0.1f, 0.2f, 0.9f));
  for (const auto& s : matrices) {
    m_parts.write({.channels = 6, .value = [&](int, int, int, int c) { return s[size_t(c)]; }});
    const PhaseFunctionPtr phase = m_parts.phase(sggxText("grid.vol"));
    EXPECT_EQ(phase->sample({{}, wo}, 0.5f, {0.3f, 0.6f}).pdf, 0);
    EXPECT_EQ(phase->pdf({{}, wo}, Vec3(1, 0, 0)), 0);
    EXPECT_TRUE(std::isfinite(phase->projectedArea({{}, wo})));
    EXPECT_LE(phase->projectedArea({{}, wo}), phase->greatestProjectedArea());
  }
}

TEST_F(PhaseFunctions, SayWhatIsWrong) {
  const auto complains = [&](const std::string& text, const std::string& message) {
    const std::string complaint = complaintOf([&] { m_parts.phase(text); });
    EXPECT_NE(complaint.find(message), std::string::npos) << complaint;
  };
  complains(hgText("1"), "found 1 for 'g', expected more than -1 and less than 1");
  complains("<phase type='tabphase'/>", "has no parameter 'values'");
  const auto table = [](const std::string& values) {
    return "<phase type='tabphase'><string name='values' value='" + values + "'/></phase>";
  };
  complains(table("1"), "found '1' for 'values', expected two numbers or more that are not all 0");
  complains(table("0, 0"), "expected two numbers or more that are not all 0");
  complains(table("1, -2"), "found -2 for 'values', expected no number below 0");
  complains(table("1, x"), "'values'");
  complains("<phase type='blendphase'/>", "blendphase has no \"weight\", expected a number or a volume");
  complains("<phase type='blendphase'><float name='weight' value='0.5'/><phase type='hg'/></phase>",
            "found 1 nested phase functions in the blendphase, expected 2");
  complains("<phase type='sggx'/>", "sggx has no volume 'S', expected one of 6 channels");
  complains("<phase type='sggx'><volume name='S' type='constvolume'/></phase>",
            "found 1 channels in the volume 'S' of sggx, expected 6");
  EXPECT_TRUE(m_parts.isQuiet());
  EXPECT_EQ(m_parts.phase("<phase type='hgg'><float name='g' value='0.5'/></phase>")->roughness(), 1);
  EXPECT_TRUE(m_parts.warnsOf("the phase 'hgg' is unknown (did you mean 'hg'?), an isotropic one is used"));
  EXPECT_EQ(m_parts.builder().nestedPhaseFunction(m_parts.parsed("<medium type='m'/>"))->roughness(), 1);
  EXPECT_NEAR(m_parts.builder()
                  .nestedPhaseFunction(m_parts.parsed("<medium type='m'><phase type='hg'/></medium>"))
                  ->roughness(),
              0.2f, 1e-6f);
}

}  // namespace
}  // namespace odis::test
