// Targets against what is known: a sky, a furnace, a lamp; and against the means of pilots, which estimate
// the same. z-tests have 4 as their bound: a true difference apart, one of 16,000 fails.
#include "learn/data/targets.h"

#include <gtest/gtest.h>
#include <odis/octahedral.h>

#include <cmath>
#include <map>

#include "integrator/test_scenes.h"
#include "odis/cells/samples.h"

namespace odis::learn {
namespace {

using render::LightSampler;
using render::Scene;

struct View {
  std::unique_ptr<Scene> scene;
  LightSampler lights;
  std::vector<Pilot> pilots;
  ViewFrame frame;

  View(const std::string& body, int pilotCount, uint64_t seed = 1)
      : scene(test::loadScene(body)), lights(scene->emitters()) {
    for (int i = 0; i < pilotCount; ++i) pilots.push_back(tracePilot(*scene, lights, seed + uint64_t(i)));
    frame = frameOf(pilots);
  }
  std::vector<Target> targets(const TargetSettings& settings, uint64_t seed = 9) const {
    return traceTargets(*scene, lights, pilots, frame, settings, seed);
  }
  std::vector<const PathVertex*> vertices() const {
    std::vector<const PathVertex*> result;
    for (const Pilot& pilot : pilots)
      for (const PathVertex& v : pilot.vertices) result.push_back(&v);
    return result;
  }
};

const std::string kGrey = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.4\"/></bsdf>";

// A ball under a white sky sees the sky alone: radiance 1 from above its horizon, and scatters 0.4 of it.
TEST(Targets, OfABallUnderAWhiteSky) {
  const View view(test::sensor("origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"", 30, 16, 16) +
                      "<shape type=\"sphere\">" + kGrey +
                      "</shape><emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>",
                  2);
  TargetSettings settings;
  settings.cells = 10;
  settings.pixels = 10;
  settings.outgoing = 4096;
  const std::vector<Target> targets = view.targets(settings);
  ASSERT_EQ(targets.size(), 20u);
  for (const Target& t : targets) {
    for (int texel = 0; texel < kTargetTexels; ++texel) {
      const float cosine = dot(directionInTexel(texel, {0.5f, 0.5f}), t.normal);
      const auto i = size_t(texel);
      EXPECT_EQ(t.indirect[i], 0);
      if (t.pixel && cosine > 0.2f) EXPECT_GE(t.samples[i], 2);
      if (t.pixel && cosine < -0.2f) EXPECT_EQ(t.samples[i], 0);
      if (t.samples[i] == 0) continue;
      EXPECT_NEAR(t.emission[i], 1, 1e-5f);
      EXPECT_NEAR(t.emissionRms[i], 1, 1e-5f);
      EXPECT_NEAR(t.lightPdf[i], 1 / (4 * M_PI), 1e-6);
      EXPECT_EQ(t.rays[i], 1);
    }
    // Next-event estimation from uniform directions, MIS-weighted, and one ray of the BSDF: noisy, the means
    // are not.
    EXPECT_NEAR(t.outgoing.y, 0.4, 0.02);
    EXPECT_GE(t.outgoingRms, t.outgoing.y);
    EXPECT_NEAR(t.outgoingRays, 1.5, 0.1) << "a shadow ray in half of the directions, and the path's";
    // All regions together give what is scattered, and are all there is to choose from.
    ASSERT_EQ(t.lights.size(), 16u);
    double sum = 0, misSum = 0, probability = 0;
    for (const LightMoments& m : t.lights) {
      sum += m.mean;
      misSum += m.misMean;
      probability += m.probability;
      EXPECT_GE(m.rms, m.mean * 0.999f);
    }
    EXPECT_NEAR(sum, 0.4, 0.02);
    EXPECT_LT(misSum, sum);
    EXPECT_NEAR(probability, 1, 1e-4);
  }
}

// Inside of the furnace 1 is emitted and 1 scattered towards everything.
TEST(Targets, OfTheFurnace) {
  const View view(test::furnace("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf>"),
                  1);
  TargetSettings settings;
  settings.cells = 8;
  settings.pixels = 0;
  for (const Target& t : view.targets(settings)) {
    double sum = 0, squares = 0;
    int samples = 0;
    for (size_t i = 0; i < kTargetTexels; ++i) {
      if (t.samples[i] == 0) continue;
      EXPECT_NEAR(t.emission[i], 1, 1e-5f);
      samples += t.samples[i];
      sum += double(t.indirect[i]) * t.samples[i];
      squares += double(t.indirectRms[i]) * t.indirectRms[i] * t.samples[i];
    }
    const double mean = sum / samples, variance = squares / samples - mean * mean;
    EXPECT_GE(samples, 1024);
    EXPECT_LT(std::abs(mean - 1) / std::sqrt(variance / samples), 4) << mean;
  }
}

// A lamp is seen in its direction, as large as it is.
TEST(Targets, ShowALampWhereItIs) {
  const View view(
      test::sensor("origin=\"0,2,3\" target=\"0,0,0\" up=\"0,1,0\"", 30, 16, 16) +
          "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"4\"/><rotate x=\"1\" "
          "angle=\"-90\"/></transform>" +
          kGrey +
          "</shape><shape type=\"sphere\"><point name=\"center\" x=\"2\" y=\"3\" z=\"-1\"/><float "
          "name=\"radius\" value=\"0.7\"/><bsdf type=\"diffuse\"/><emitter type=\"area\"><rgb "
          "name=\"radiance\" value=\"5\"/></emitter></shape>",
      1);
  TargetSettings settings;
  settings.cells = 0;
  settings.pixels = 30;
  settings.perTexel = 16;
  int seen = 0;
  for (const Target& t : view.targets(settings)) {
    if (t.normal.y < 0.9f) continue;  // the lamp itself, were it in view
    ++seen;
    const Float3 offset = Float3{2, 3, -1} - t.position;
    const float distance = std::sqrt(dot(offset, offset)), sine = 0.7f / distance;
    Float3 sum{0, 0, 0};
    double total = 0;
    for (int texel = 0; texel < kTargetTexels; ++texel) {
      sum = sum + directionInTexel(texel, {0.5f, 0.5f}) * t.emission[size_t(texel)];
      total += t.emission[size_t(texel)];
    }
    EXPECT_GT(dot(sum, offset) / distance / std::sqrt(dot(sum, sum)), 0.998f);
    const double solidAngle = 2 * M_PI * (1 - std::sqrt(1 - sine * sine));
    EXPECT_NEAR(total / 5 * 4 * M_PI / kTargetTexels / solidAngle, 1, 0.15);
  }
  EXPECT_GT(seen, 20);
}

double sqr(double x) {
  return x * x;
}

// Sums of independent numbers, for tests of their means.
struct Mean {
  double count = 0, sum = 0, squares = 0;
  void add(double x, double weight = 1) {
    count += weight;
    sum += x * weight;
    squares += x * x * weight;
  }
  double mean() const { return sum / count; }
  double varianceOfMean() const { return (squares / count - mean() * mean()) / count; }
};

// What the vertices of a cell scatter back, and what that costs, is what pilots estimate of the same
// vertices.
TEST(Targets, AgreeWithPilots) {
  // The camera sees little of the room, so that the few cells there have many vertices.
  const std::string room = test::indirectRoom();
  const View view(test::sensor("origin=\"0,0,3.4\" target=\"-0.7,0.3,-1\" up=\"0,1,0\"", 3, 64, 64) +
                      room.substr(room.find("</sensor>") + 9),
                  8);
  TargetSettings settings;
  settings.cells = 150;
  settings.pixels = 0;
  settings.perTexel = 1;
  settings.outgoing = 8192;
  settings.lights = 1;
  const std::vector<Target> targets = view.targets(settings);
  ASSERT_EQ(targets.size(), 150u);
  const CellGrid grid(view.frame.origin, view.frame.edge);
  const auto cellOf = [&](const PathVertex& v) {
    return grid.key(positionOf(stepsOf(v.position, view.frame), view.frame), unpacked(packed(v.normal)), 0);
  };
  const std::vector<const PathVertex*> vertices = view.vertices();
  std::map<uint64_t, std::vector<const PathVertex*>> cells;
  for (const PathVertex* v : vertices)
    if (isUsable(*v)) cells[cellOf(*v)].push_back(v);
  int tests = 0, dark = 0;
  for (const Target& t : targets) {
    const std::vector<const PathVertex*>& members = cells.at(cellOf(*vertices[t.vertex]));
    EXPECT_EQ(t.cellVertices, members.size());
    EXPECT_EQ(t.starts, std::min<size_t>(members.size(), 256));
    if (members.size() < 400) continue;
    ++tests;
    Mean scattered, arriving, rays, depths;
    for (const PathVertex* v : members) {
      scattered.add(luminance(core::returnedRadiance(*v)));
      arriving.add(core::sampleValue(*v));
      depths.add(v->depth);
      rays.add(v->raysAfter + float(v->lightGroup != kNoLightGroup));  // and a shadow ray
    }
    // Samples start at some of the vertices only: what these scatter back differs by a tenth or so across a
    // cell.
    const double ofStarts = scattered.mean() * 0.1 / std::sqrt(double(t.starts));
    const double z =
        (luminance(t.outgoing) - scattered.mean()) /
        std::sqrt(scattered.varianceOfMean() + double(t.outgoingRms) * t.outgoingRms / settings.outgoing +
                  ofStarts * ofStarts);
    EXPECT_LT(std::abs(z), 4) << luminance(t.outgoing) << " against " << scattered.mean();
    // Where the lamp is not seen, all that arrives is scattered light: its irradiance by the map and by the
    // pilots.
    if (*std::max_element(t.emission.begin(), t.emission.end()) == 0) {
      ++dark;
      double irradiance = 0, variance = sqr(0.1 * arriving.mean()) / t.starts + arriving.varianceOfMean();
      for (int texel = 0; texel < kTargetTexels; ++texel) {
        const auto i = size_t(texel);
        const double weight =
            std::max(dot(directionInTexel(texel, {0.5f, 0.5f}), t.normal), 0.0f) * 4 * M_PI / kTargetTexels;
        irradiance += weight * t.indirect[i];
        variance += sqr(weight * t.indirectRms[i]) / std::max<int>(t.samples[i], 1);
      }
      EXPECT_LT(std::abs(irradiance - arriving.mean()) / std::sqrt(variance), 4)
          << irradiance << " against " << arriving.mean();
    }
    // Vertices deep in their paths meet roulette sooner, which no target does.
    if (depths.mean() < 1.2) EXPECT_NEAR(t.outgoingRays, rays.mean(), 0.05 * rays.mean());
  }
  EXPECT_GE(tests, 4);
  EXPECT_GE(dark, 2);
}

TEST(Targets, AreTheSameForTheSameSeed) {
  const View view(test::indirectRoom(16), 2);
  TargetSettings settings;
  settings.cells = settings.pixels = 5;
  const std::vector<Target> first = view.targets(settings, 3), second = view.targets(settings, 3),
                            other = view.targets(settings, 4);
  ASSERT_EQ(first.size(), 10u);
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].vertex, second[i].vertex);
    EXPECT_EQ(first[i].indirect, second[i].indirect);
    EXPECT_EQ(first[i].outgoingRms, second[i].outgoingRms);
  }
  EXPECT_NE(first[0].indirect, other[0].indirect);
}

TEST(Pilots, LiePixelByPixel) {
  const View view(test::indirectRoom(20), 1);
  const Pilot& pilot = view.pilots[0];
  ASSERT_EQ(pilot.lengths.size(), 400u);
  size_t i = 0;
  for (uint32_t pixel = 0; pixel < 400; ++pixel)
    for (int depth = 1; depth <= pilot.lengths[pixel]; ++depth, ++i) {
      EXPECT_EQ(pilot.vertices[i].pixel, pixel);
      EXPECT_EQ(pilot.vertices[i].depth, depth);
      if (depth > 1) EXPECT_LT(dot(pilot.vertices[i].wo, pilot.vertices[i - 1].wi), -0.9999f);
    }
  EXPECT_EQ(i, pilot.vertices.size());
}

}  // namespace
}  // namespace odis::learn
