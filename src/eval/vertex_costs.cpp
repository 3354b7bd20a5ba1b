#include "eval/vertex_costs.h"

#include <odis/odis.hpp>

#include <algorithm>
#include <ctime>

namespace odis::eval {

using namespace render;

namespace {

// More would only say the same again.
constexpr size_t kMostVertices = 200000;

double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// A vertex as a host meets it, and two numbers that it draws a direction with.
struct Met {
  Place place;
  Float3 wi;
  float pixelValue, roughness, u, v;
};

std::vector<Met> metBy(const PilotPass& pilot) {
  std::vector<Met> all;
  for (const PathVertex& v : pilot.vertices) {
    if (v.discrete || all.size() == kMostVertices) continue;
    // Any numbers do, as long as they are spread.
    const float u = float(all.size() * 40503 % 65536) / 65536, w = float(all.size() * 30011 % 65536) / 65536;
    all.push_back({{v.position, v.normal, v.pixel, v.sample, false, v.depth},
                   v.wi,
                   pilot.pixelValues[v.pixel],
                   v.roughness,
                   u,
                   w});
  }
  return all;
}

// The least time of some rounds over all vertices, in nanoseconds a vertex.
template <class Work>
double nanoseconds(const std::vector<Met>& vertices, int rounds, const Work& work) {
  double least = INFINITY;
  volatile float kept = 0;  // so that nothing is left out
  for (int round = 0; round < rounds; ++round) {
    float sum = 0;
    const double begin = threadSeconds();
    for (const Met& met : vertices) sum += work(met);
    least = std::min(least, threadSeconds() - begin);
    kept = kept + sum;
  }
  return 1e9 * least / double(vertices.size());
}

}  // namespace

VertexCosts vertexCosts(const PilotPass& pilot, int rounds) {
  const std::vector<Met> vertices = metBy(pilot);
  if (vertices.empty()) return {};
  GuideBuilder builder(pilot.guideOptions);
  builder.add(pilot.vertices);
  const Guide guide = builder.build(pilot.pixelValues);
  const GuideView view = guide.view();
  const auto at = [&](const Met& met) { return GuidedVertex(view, met.place, met.pixelValue); };
  const auto prepared = [&](const Met& met) {
    GuidedVertex vertex = at(met);
    vertex.prepare(met.roughness);
    return vertex;
  };
  VertexCosts costs;
  costs.lookUp = nanoseconds(vertices, rounds, [&](const Met& met) { return float(at(met).cell()); });
  const double both =
      nanoseconds(vertices, rounds, [&](const Met& met) { return prepared(met).bsdfFraction(); });
  const double withPdf =
      nanoseconds(vertices, rounds, [&](const Met& met) { return prepared(met).pdf(met.wi, 1, 1); });
  const double withDirection = nanoseconds(vertices, rounds, [&](const Met& met) {
    const GuidedVertex vertex = prepared(met);
    float u = met.u;
    return vertex.drawsFromMap(u) ? vertex.pdfOf(vertex.sampleMap(u, met.v), 1, 1) : vertex.pdf(met.wi, 1, 1);
  });
  costs.prepare = both - costs.lookUp;
  costs.pdf = withPdf - both;
  costs.direction = withDirection - both;
  for (const Met& met : vertices) costs.guided += prepared(met).guides() / double(vertices.size());
  return costs;
}

}  // namespace odis::eval
