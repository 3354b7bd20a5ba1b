// Directions of many paths, sampled from their BSDFs and from what guides them.
#include <odis/instruction_sets.h>

#include "render/math/warp.h"
#include "render/path/bounce.h"

namespace odis::render {

void findGuidableLobes(const PathSettings& settings, const Batch& batch, Bounces& bounces) {
  Vertices& at = bounces.at;
  at.guidable = {};
  if (!settings.guide && !settings.rival && !batch.recording) return;
  // Where only directions ask for it, cells that leave them to the BSDF save the call.
  const bool onlyDirections =
      !settings.rival && !batch.recording && settings.guideBounces < 0 && !settings.guide->pixels.cells;
  const auto guides = [&](uint32_t cell) {
    return cell != kNoCell && guidesDirections(settings.guide->decisions[cell]);
  };
  for (size_t i = 0; i < bounces.count; ++i) {
    if (at.isDiffuse[i]) {
      at.guidable[i] = at.side[i] != 0 ? 1.0f : 0.0f;
    } else if (at.isFaceted[i]) {
      at.guidable[i] = at.faceted[i].guidable();
    } else if (!onlyDirections || guides(bounces.arrivals[i].cell)) {
      const Vertex& vertex = *bounces.arrivals[i].vertex;
      at.guidable[i] = at.bsdfs[i]->guidableProbability(vertex.at, vertex.wo);
    }
  }
}

namespace {

// The BSDF sampling fraction in a cell; 1 where nothing is guided.
float fractionAt(const GuideView& guide, const Bounces& bounces, size_t lane) {
  const uint32_t cell = bounces.arrivals[lane].cell;
  if (cell == kNoCell) return 1;
  if (bounces.at.isDiffuse[lane]) return bsdfFraction(guide, int32_t(cell), 1.0f);
  if (!guidesDirections(guide.decisions[cell])) return 1;
  const Vertex& vertex = *bounces.arrivals[lane].vertex;
  return bsdfFraction(guide, int32_t(cell), vertex.bsdf->roughness(vertex.at, vertex.wo));
}

// What a rival knows of a vertex; null where that is nothing.
const DirectionSampler* askRival(const DirectionGuide& rival, const Bounces& bounces, size_t lane) {
  const Vertices& at = bounces.at;
  if (!bounces.arrivals[lane].vertex->inMedium())
    return rival.at(at.p[lane], at.facing[lane], at.bsdfs[lane]->traits().transmissive);
  return rival.inMedium(at.p[lane], at.wo[lane], bounces.arrivals[lane].path->medium->phase().meanCosine());
}

// Finds out what guides a vertex.
void beginGuided(const PathSettings& settings, Bounces& bounces, size_t lane) {
  const Vertices& at = bounces.at;
  GuidedBsdfs& bsdfs = bounces.bsdfs;
  if (!(at.guidable[lane] > 0) || !guidesAt(settings, *bounces.arrivals[lane].path)) return;
  float fraction = 1;
  if (settings.rival) {
    bsdfs.rivals[lane] = askRival(*settings.rival, bounces, lane);
    if (!bsdfs.rivals[lane]) return;
    fraction = bsdfs.rivals[lane]->bsdfFraction();
  } else {
    fraction = fractionAt(*settings.guide, bounces, lane);
    if (fraction >= 1) return;
    bsdfs.hasMap[lane] = bsdfs.anyMap = true;
    bsdfs.maps[lane] = SamplingMap<float>(settings.guide->maps, int32_t(bounces.arrivals[lane].cell));
  }
  bsdfs.bsdfFraction[lane] = fraction;
  bsdfs.guidable[lane] = at.guidable[lane];
}

}  // namespace

void prepareDirections(const PathSettings& settings, Bounces& bounces) {
  GuidedBsdfs& bsdfs = bounces.bsdfs;
  bsdfs.clear();
  if (!settings.guide && !settings.rival) return;
  for (size_t i = 0; i < bounces.count; ++i) beginGuided(settings, bounces, i);
}

void countGuidable(Bounces& bounces) {
  for (size_t i = 0, count = bounces.count; i < count; ++i)
    bounces.arrivals[i].path->guidable += bounces.at.guidable[i] > 0;
}

namespace {

ODIS_WIDE void chooseSources(Bounces& bounces) {
  DirectionDraws& draws = bounces.draws;
  const size_t end = endOfLanes(bounces.count);
  const Column& u = bounces.numbers.directionU;
  for (size_t i = 0; i < end; ++i)
    draws.fromMap[i] = bounces.bsdfs.hasMap[i] & int32_t(bounces.bsdfs.mixture(i).choosesMap(u[i]));
  for (size_t i = 0; i < end; ++i)
    draws.u[i] = bounces.bsdfs.mixture(i).stretched(u[i], draws.fromMap[i] != 0);
  for (size_t i = 0; i < end; ++i) {
    const float unguided = u[i], guided = draws.u[i];
    draws.u[i] = bounces.bsdfs.hasMap[i] ? guided : unguided;
  }
}

}  // namespace

void chooseBlocks(Bounces& bounces) {
  DirectionDraws& draws = bounces.draws;
  draws.u = bounces.numbers.directionU;
  draws.fromMap = {};
  if (!bounces.bsdfs.anyMap) return;
  chooseSources(bounces);
  MapSamples samples;
  LaneList drawing;
  for (size_t i = 0; i < bounces.count; ++i) {
    const bool fromMap = draws.fromMap[i];
    samples.addIf(fromMap, bounces.bsdfs.maps[i], {draws.u[i], bounces.numbers.directionV[i]});
    drawing.addIf(fromMap, i);
  }
  chooseBlocks(samples);
  for (size_t k = 0; k < samples.count; ++k) {
    const size_t i = drawing.lanes[k];
    draws.block[i] = samples.blocks[k];
    draws.withinBlockU[i] = samples.u[k];
    draws.withinBlockV[i] = samples.v[k];
  }
}

namespace {

// Where a direction comes from: the steps of Mixture::sample(). `plain` has no map to be mixed with.
enum class Source : int32_t { plain, bsdf, map };

// Samples what Lambertian surfaces scatter: all lanes, as if they were. `drawn` is whether there is anything.
ODIS_WIDE void sampleDiffuse(Bounces& bounces, IntColumn& drawn) {
  NextDirections& next = bounces.next;
  const Vertices& at = bounces.at;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const Vec3 wi = squareToCosineHemisphere({bounces.draws.u[i], bounces.numbers.directionV[i]});
    const float side = at.side[i], pdf = cosineHemispherePdf(wi.z) * (side * side);
    next.wi.set(i, {wi.x, wi.y, side * wi.z});
    next.weight.set(i, at.reflectance[i]);
    next.pdf[i] = pdf;
    next.guidablePdf[i] = pdf;
    next.eta[i] = 1;
    next.lobe[i] = int32_t(Lobe::smooth);
    drawn[i] = pdf > 0;
  }
}

// Keeps what surfaces with facets have sampled.
ODIS_WIDE void keepFaceted(const Columns3& wi, const BsdfValues& values, const IntColumn& fromFacets,
                           Bounces& bounces, IntColumn& drawn) {
  NextDirections& next = bounces.next;
  const Vertices& at = bounces.at;
  const size_t end = endOfLanes(bounces.count);
  Columns3 weights;
  IntColumn isDrawn, lobes;
  for (size_t i = 0; i < end; ++i) {
    const Vec3 value = values.value[i];
    const float pdf = values.pdf[i];
    const int32_t ofFacets =
        at.faceted[i].lobe() == Lobe::nearDelta ? int32_t(Lobe::nearDelta) : int32_t(Lobe::smooth);
    weights.set(i, value / pdf);
    isDrawn[i] = (pdf > 0) & isFinite(value);
    lobes[i] = fromFacets[i] != 0 ? ofFacets : int32_t(Lobe::smooth);
  }
  for (size_t i = 0; i < end; ++i) {
    const bool is = at.isFaceted[i];
    const Vec3 weight = weights[i], direction = wi[i], ofDiffuse = next.weight[i], wiOfDiffuse = next.wi[i];
    const float pdf = values.pdf[i], guidablePdf = values.guidablePdf[i];
    const int32_t lobe = lobes[i], wasDrawn = isDrawn[i];
    next.wi.set(i, select(is, direction, wiOfDiffuse));
    next.weight.set(i, select(is, weight, ofDiffuse));
    next.pdf[i] = is ? pdf : next.pdf[i];
    next.guidablePdf[i] = is ? guidablePdf : next.guidablePdf[i];
    next.lobe[i] = is ? lobe : next.lobe[i];
    drawn[i] = is ? wasDrawn : drawn[i];
  }
}

// Samples what surfaces with facets scatter.
void sampleFaceted(Bounces& bounces, IntColumn& drawn) {
  const Vertices& at = bounces.at;
  if (at.facetedLanes.empty()) return;
  FacetedDirections directions(at.wo, at.side);
  IntColumn fromFacets;
  BsdfValues values;
  sampleFaceted(at.faceted, at.facetedLanes,
                {bounces.numbers.lobe, bounces.draws.u, bounces.numbers.directionV}, directions, fromFacets);
  evaluateFaceted(at.faceted, at.facetedLanes, directions, values);
  keepFaceted(directions.wi, values, fromFacets, bounces, drawn);
}

// The same for other BSDFs, one by one.
Source sampleOther(Bounces& bounces, size_t lane) {
  const BsdfHost host{*bounces.arrivals[lane].vertex, bounces.numbers.lobe[lane]};
  const float u = bounces.draws.u[lane], v = bounces.numbers.directionV[lane];
  if (!bounces.bsdfs.hasMap[lane]) {
    bounces.next.set(lane, sampleWithoutMap(bounces.bsdfs, lane, host, {u, v}));
    return Source::plain;
  }
  const bool fromMap = bounces.draws.fromMap[lane];
  const float guidable = bounces.bsdfs.guidable[lane];
  BsdfSample drawn;
  if (!fromMap || guidable < 1) {
    drawn = host.sampleBsdf(u, v);
    bounces.next.set(lane, drawn);
    if (host.isDiscrete(drawn)) return Source::plain;
  }
  if (fromMap && (guidable >= 1 || !host.isSharp(drawn))) return Source::map;
  return host.failed(drawn) ? Source::plain : Source::bsdf;
}

// Finds the sources of all lanes, as if each had been sampled in lanes.
ODIS_WIDE void findSources(const IntColumn& drawn, const Bounces& bounces, IntColumn& sources) {
  const GuidedBsdfs& bsdfs = bounces.bsdfs;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const int32_t lobe = bounces.next.lobe[i], wasDrawn = drawn[i], hasMap = bsdfs.hasMap[i],
                  choseMap = bounces.draws.fromMap[i];
    const float guidable = bsdfs.guidable[i];
    const bool isSharp = lobe == int32_t(Lobe::nearDelta), staysSharp = isSharp & (guidable < 1);
    const bool isMixed = (wasDrawn != 0) & (hasMap != 0), isFromMap = (choseMap != 0) & !staysSharp;
    const int32_t fromBsdf = isMixed ? int32_t(Source::bsdf) : int32_t(Source::plain);
    sources[i] = isFromMap ? int32_t(Source::map) : fromBsdf;
  }
}

ODIS_WIDE void turnToWorld(const Bounces& bounces, Columns3& world) {
  const Vertices& at = bounces.at;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i)
    world.set(i, CoordinateFrame(at.s[i], at.t[i], at.n[i]).toWorld(bounces.next.wi[i]));
}

// Evaluates the BSDFs in the directions that maps have drawn, as if they were Lambertian. Values take the
// place of weights.
ODIS_WIDE void evaluateDiffuse(const IntColumn& sources, const Columns3& world, Bounces& bounces) {
  NextDirections& next = bounces.next;
  const Vertices& at = bounces.at;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const bool fromMap = sources[i] == int32_t(Source::map);
    const Vec3 local = CoordinateFrame(at.s[i], at.t[i], at.n[i]).toLocal(world[i]), old = next.wi[i];
    const float pdf = cosineHemispherePdf(at.side[i] * local.z);
    const Vec3 value = at.reflectance[i] * pdf, weight = next.weight[i];
    next.wi.set(i, select(fromMap, local, old));
    next.weight.set(i, select(fromMap, value, weight));
    next.pdf[i] = fromMap ? pdf : next.pdf[i];
    next.guidablePdf[i] = fromMap ? pdf : next.guidablePdf[i];
  }
}

// Keeps the values of surfaces with facets.
ODIS_WIDE void keepFaceted(const IntColumn& sources, const BsdfValues& values, Bounces& bounces) {
  NextDirections& next = bounces.next;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const bool is = bounces.at.isFaceted[i] && sources[i] == int32_t(Source::map);
    const Vec3 value = values.value[i], weight = next.weight[i];
    next.weight.set(i, select(is, value, weight));
    next.pdf[i] = is ? values.pdf[i] : next.pdf[i];
    next.guidablePdf[i] = is ? values.guidablePdf[i] : next.guidablePdf[i];
  }
}

// The same at surfaces with facets.
void evaluateFaceted(const IntColumn& sources, Bounces& bounces) {
  const Vertices& at = bounces.at;
  LaneList lanes;
  for (const size_t i : at.facetedLanes) lanes.addIf(sources[i] == int32_t(Source::map), i);
  if (lanes.empty()) return;
  BsdfValues values;
  evaluateFaceted(at.faceted, lanes, {at.wo, at.side, bounces.next.wi}, values);
  keepFaceted(sources, values, bounces);
}

void evaluateOther(Bounces& bounces, size_t lane) {
  const Vertex& vertex = *bounces.arrivals[lane].vertex;
  const BsdfValue value = vertex.bsdf->evaluate(vertex.at, vertex.wo, bounces.next.wi[lane]);
  bounces.next.weight.set(lane, value.value);
  bounces.next.pdf[lane] = value.pdf;
  bounces.next.guidablePdf[lane] = value.guidablePdf;
}

// Weighs directions by the densities of the mixtures.
ODIS_WIDE void mix(const IntColumn& sources, const Column& mapPdf, Bounces& bounces) {
  NextDirections& next = bounces.next;
  for (size_t i = 0, end = endOfLanes(bounces.count); i < end; ++i) {
    const float mixed = bounces.bsdfs.mixture(i).pdf(next.pdf[i], next.guidablePdf[i], mapPdf[i]);
    const bool fromMap = sources[i] == int32_t(Source::map), fromBsdf = sources[i] == int32_t(Source::bsdf);
    const Rgb weight(next.weight[i]);
    const Rgb ofMap = weight / mixed, ofBsdf = weight * (next.pdf[i] / mixed);
    const int32_t lobe = isBlack(weight) ? int32_t(Lobe::none) : int32_t(Lobe::smooth);
    next.weight.set(i, select(fromMap, ofMap, select(fromBsdf, ofBsdf, weight)));
    next.pdf[i] = (fromMap | fromBsdf) ? mixed : next.pdf[i];
    next.eta[i] = fromMap ? 1.0f : next.eta[i];
    next.lobe[i] = fromMap ? lobe : next.lobe[i];
  }
}

// Mixes directions with the densities of the maps that guide them, and draws those that come from maps.
void mixWithMaps(const IntColumn& sources, Bounces& bounces) {
  Columns3 world;
  turnToWorld(bounces, world);
  LaneList fromMaps, fromBsdfs;
  for (size_t i = 0; i < bounces.count; ++i) {
    fromMaps.addIf(sources[i] == int32_t(Source::map), i);
    fromBsdfs.addIf(sources[i] == int32_t(Source::bsdf), i);
  }
  MapSamples samples;
  MapLookUps lookUps;
  const DirectionDraws& draws = bounces.draws;
  for (const size_t i : fromMaps)
    samples.add(bounces.bsdfs.maps[i], {draws.withinBlockU[i], draws.withinBlockV[i]}, draws.block[i]);
  for (const size_t i : fromBsdfs) lookUps.add(bounces.bsdfs.maps[i], world[i]);
  findTexels(lookUps);
  sampleWithinBlocks(samples);
  findPdfs(lookUps);
  Column mapPdf{};
  for (size_t k = 0; k < samples.count; ++k) {
    world.set(fromMaps.lanes[k], samples.wi[k]);
    mapPdf[fromMaps.lanes[k]] = samples.pdf[k];
  }
  for (size_t k = 0; k < lookUps.count; ++k) mapPdf[fromBsdfs.lanes[k]] = lookUps.pdf[k];
  evaluateDiffuse(sources, world, bounces);
  evaluateFaceted(sources, bounces);
  for (const size_t i : fromMaps)
    if (!bounces.at.isDiffuse[i] && !bounces.at.isFaceted[i]) evaluateOther(bounces, i);
  mix(sources, mapPdf, bounces);
}

}  // namespace

void sampleDirections(Bounces& bounces) {
  IntColumn drawn, sources;
  sampleDiffuse(bounces, drawn);
  sampleFaceted(bounces, drawn);
  LaneList others;
  for (size_t i = 0; i < bounces.count; ++i) {
    // What rivals guide is sampled one by one.
    const bool inLane = (bounces.at.isDiffuse[i] || bounces.at.isFaceted[i]) && !bounces.bsdfs.rivals[i];
    others.addIf(!inLane, i);
    if (inLane && !drawn[i]) bounces.next.set(i, {});
  }
  findSources(drawn, bounces, sources);
  for (const size_t i : others) sources[i] = int32_t(sampleOther(bounces, i));
  bool anyMap = false;
  for (size_t i = 0; i < bounces.count; ++i) anyMap |= sources[i] != int32_t(Source::plain);
  if (anyMap) mixWithMaps(sources, bounces);
  for (size_t i = 0; i < bounces.count; ++i)
    if (!isFinite(Rgb(bounces.next.weight[i]))) bounces.next.set(i, {});
}

}  // namespace odis::render
