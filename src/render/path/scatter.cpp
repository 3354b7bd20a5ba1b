// Where paths go on, and whether.
#include <odis/instruction_sets.h>

#include "render/bsdf/parameter.h"
#include "render/path/media.h"
#include "render/scene/spawn.h"

namespace odis::render {

void keepScattered(Bounces& bounces) {
  size_t left = 0;
  for (size_t i = 0, count = bounces.count; i < count; ++i) {  // without a branch: it would be mispredicted
    const bool scatters = bounces.arrivals[i].scatters;
    bounces.arrivals[left] = bounces.arrivals[i];
    left += scatters;
  }
  bounces.count = left;
}

namespace {

ODIS_WIDE void findFacingNormals(Bounces& bounces) {
  Vertices& at = bounces.at;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i)
    at.facing.set(i, at.n[i] * (at.wo.z[i] < 0 ? -1.0f : 1.0f));
}

}  // namespace

void readVertices(Bounces& bounces) {
  Vertices& at = bounces.at;
  const Vertex* vertices[kLanes];
  for (size_t i = 0; i < kLanes; ++i) vertices[i] = bounces.arrivals[std::min(i, bounces.count - 1)].vertex;
  at.read(vertices, bounces.count);
  findFacingNormals(bounces);
  at.facetedLanes.count = 0;
  for (size_t i = 0; i < bounces.count; ++i) {
    const Arrival& arrival = bounces.arrivals[i];
    const Vertex& vertex = *arrival.vertex;
    bounces.throughput.set(i, arrival.path->throughput);
    const Bsdf& bsdf = *vertex.bsdf;
    at.bsdfs[i] = &bsdf;
    if (vertex.inMedium()) at.facing.set(i, Vec3(0, 0, 0));
    const BsdfSide& side = bsdf.side(vertex.wo);
    at.isDiffuse[i] = side.reflectance != nullptr;
    // Facets that are seen from behind can't be sampled: virtual calls say that those are black.
    at.isFaceted[i] = side.faceted && side.scatters(vertex.wo);
    at.side[i] = side.scatters(vertex.wo) ? side.side : 0.0f;
    if (side.reflectance) {
      at.reflectance.set(i, (*side.reflectance)(vertex.at));
    } else if (at.isFaceted[i]) {
      at.faceted.set(i, side.faceted->surface(vertex.at, side.side * vertex.wo.z));
      at.facetedLanes.addIf(true, i);
    }
  }
}

void drawNumbers(const PathSettings& settings, Batch& batch, Bounces& bounces) {
  batch.samplers.clear();
  bool choosesLobes = false;
  for (const Arrival& arrival : bounces.arriving()) batch.samplers.add(arrival.path->sampler);
  for (size_t i = 0; i < bounces.count; ++i) choosesLobes |= bounces.at.bsdfs[i]->traits().choosesLobes;
  VertexNumbers& numbers = bounces.numbers;
  const auto draw1D = [&](VertexNumber number, Column& x) {
    batch.samplers.draw1D(dimensionOf(bounces.place, number), x);
  };
  const auto draw2D = [&](VertexNumber number, Column& x, Column& y) {
    batch.samplers.draw2D(dimensionOf(bounces.place, number), x, y);
  };
  draw1D(kLightChoiceNumber, numbers.lightChoice);
  draw2D(kLightPointNumber, numbers.lightU, numbers.lightV);
  if (choosesLobes) draw1D(kLobeNumber, numbers.lobe);
  draw2D(kDirectionNumber, numbers.directionU, numbers.directionV);
  if (settings.learnedRoulette || bounces.place >= settings.rrDepth)
    draw1D(kSurvivalNumber, numbers.survival);
  if (settings.shadowRoulette) draw1D(kShadowRayNumber, numbers.shadowRay);
}

namespace {

ODIS_WIDE void keepWeights(Bounces& bounces) {
  const NextDirections& next = bounces.next;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const Vec3 weight = next.weight[i];
    bounces.survival[i] = 1;
    bounces.survives[i] = next.lobe[i] != int32_t(Lobe::none) && !isBlack(Rgb(weight));
    bounces.weight.set(i, bounces.survives[i] ? weight : Vec3(0, 0, 0));
  }
}

void playByThroughput(const PathSettings& settings, Bounces& bounces, size_t i) {
  Path& path = *bounces.arrivals[i].path;
  Rgb weight(bounces.weight[i]);
  float survival = std::min(maxComponent(path.throughput * weight) * sqr(path.eta), 0.95f);
  // Where roulette is learned no path should weigh more for it than there.
  if (settings.learnedRoulette) survival = std::max(survival, settings.guide->rules.leastSurvival);
  bounces.survival[i] = survival;
  bounces.survives[i] = path.uSurvival < survival;
  path.uSurvival /= survival;  // as good as new, should the path survive
  bounces.weight.set(i, bounces.survives[i] ? weight / survival : Rgb(0, 0, 0));
}

}  // namespace

void playRouletteOnDeparture(const PathSettings& settings, Bounces& bounces) {
  keepWeights(bounces);
  for (size_t i = 0; i < bounces.count; ++i) {
    const Arrival& arrival = bounces.arrivals[i];
    arrival.path->eta *= bounces.next.eta[i];
    // Read where roulette is played: here or, where it was learned, where the path arrives.
    arrival.path->uSurvival = bounces.numbers.survival[i];
    const bool learned = settings.learnedRoulette && arrival.cell != kNoCell;
    if (arrival.path->depth >= settings.rrDepth && bounces.survives[i] && !learned)
      playByThroughput(settings, bounces, i);
  }
}

namespace {

ODIS_WIDE void spawnRays(const Bounces& bounces, Columns3& origins, Columns3& directions) {
  const Vertices& at = bounces.at;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const Vec3 direction = CoordinateFrame(at.s[i], at.t[i], at.n[i]).toWorld(bounces.next.wi[i]);
    const Ray ray = spawnRay(at.p[i], at.ng[i], at.pError[i], direction, kInfinity, 0);
    origins.set(i, ray.origin);
    directions.set(i, ray.direction);
  }
}

}  // namespace

void departRays(const PathSettings& settings, Bounces& bounces) {
  Columns3 origins, directions;
  spawnRays(bounces, origins, directions);
  const bool volumetric = settings.scene->volumetric();
  for (size_t i = 0; i < bounces.count; ++i) {
    if (!bounces.survives[i]) continue;
    const Arrival& arrival = bounces.arrivals[i];
    Path& path = *arrival.path;
    const BsdfTraits& traits = bounces.at.bsdfs[i]->traits();
    const Lobe lobe = bounces.next.lobeAt(i);
    path.throughput *= Rgb(bounces.weight[i]);
    if (!path.visible) path.visibleWeight /= bounces.survival[i];
    path.ray = {origins[i], directions[i], kInfinity, bounces.at.time[i]};
    path.travelled = 0;
    if (volumetric) {
      path.medium = mediumBeyond(arrival, path.ray.direction);
      // Next-event estimation at the vertex before still competes with what goes straight on.
      if (lobe == Lobe::null && traits.passesStraight) continue;
    }
    ++path.depth;
    path.hidesEnvironment &= lobe == Lobe::null;
    path.bySampling = !isDiscrete(lobe) && traits.evaluable;
    path.directionPdf = bounces.next.pdf[i];
    path.previous = bounces.references[i];
  }
}

}  // namespace odis::render
