// Directions of many paths, sampled from their BSDFs and from what guides them.
#include "render/path/bounce.h"

namespace odis::render {

void prepareDirections(const PathSettings& settings, Bounces bounces) {
  MapPreparations maps;
  for (Bounce& bounce : bounces)
    bounce.bsdf.begin(settings, *bounce.path, *bounce.vertex, bounce.cell, bounce.guidable, maps);
  if (maps.count == 0) return;
  prepareMaps(settings.guide->maps, maps);
  for (Bounce& bounce : bounces) bounce.bsdf.finish();
}

void countGuidable(Bounces bounces) {
  for (Bounce& bounce : bounces) bounce.path->guidable += bounce.guidable > 0;
}

void chooseBlocks(Bounces bounces) {
  MapSamples samples;
  std::array<Bounce*, kBounceBlock> drawing;
  for (Bounce& bounce : bounces) {
    const VertexMap<float>* map = bounce.bsdf.map();
    if (!map) continue;
    const auto choice = bounce.bsdf.mixture().choose(bounce.numbers.direction.x);
    bounce.draw = {choice.fromMap, choice.u, 0, {}};
    drawing[samples.count] = &bounce;
    samples.addIf(choice.fromMap, *map, {choice.u, bounce.numbers.direction.y});
  }
  chooseBlocks(samples);
  for (size_t i = 0; i < samples.count; ++i) {
    drawing[i]->draw.block = samples.blocks[i];
    drawing[i]->draw.withinBlock = {samples.u[i], samples.v[i]};
    samples.maps[i]->prefetch(samples.blocks[i]);
  }
}

namespace {

BsdfHost hostOf(const Bounce& bounce) {
  return {*bounce.vertex, bounce.numbers.lobe};
}

// Where a direction that is sampled at a vertex with a map comes from: the steps of Mixture::sample().
enum class Source { bsdf, map, neither };
Source sampleBsdf(Bounce& bounce) {
  const BsdfHost host = hostOf(bounce);
  const float guidable = bounce.bsdf.mixture().guidableProbability();
  if (!bounce.draw.fromMap || guidable < 1) {
    bounce.next = host.sampleBsdf(bounce.draw.u, bounce.numbers.direction.y);
    if (host.isDiscrete(bounce.next)) return Source::neither;
  }
  if (bounce.draw.fromMap && (guidable >= 1 || !host.isSharp(bounce.next))) return Source::map;
  return host.failed(bounce.next) ? Source::neither : Source::bsdf;
}

}  // namespace

void sampleDirections(Bounces bounces) {
  MapSamples samples;
  MapLookUps lookUps;
  std::array<Bounce*, kBounceBlock> fromMaps, fromBsdfs;
  for (Bounce& bounce : bounces) {
    const VertexMap<float>* map = bounce.bsdf.map();
    if (!map) {
      bounce.next = bounce.bsdf.sample(*bounce.vertex, bounce.numbers);
      continue;
    }
    const Source source = sampleBsdf(bounce);
    if (source == Source::map) {
      fromMaps[samples.count] = &bounce;
      samples.add(*map, bounce.draw.withinBlock, bounce.draw.block);
    } else if (source == Source::bsdf) {
      fromBsdfs[lookUps.count] = &bounce;
      lookUps.add(*map, bounce.vertex->at.shading.toWorld(bounce.next.wi));
    }
  }
  findTexels(lookUps);
  sampleWithinBlocks(samples);
  findPdfs(lookUps);
  for (size_t i = 0; i < samples.count; ++i) {
    Bounce& bounce = *fromMaps[i];
    bounce.next = hostOf(bounce).evaluate(toOdis(samples.wi[i]), [&](float bsdfPdf, float guidablePdf) {
      return bounce.bsdf.mixture().pdf(bsdfPdf, guidablePdf, samples.pdf[i]);
    });
  }
  for (size_t i = 0; i < lookUps.count; ++i) {
    Bounce& bounce = *fromBsdfs[i];
    hostOf(bounce).reweigh(bounce.next, [&](float bsdfPdf, float guidablePdf, const Float3&) {
      return bounce.bsdf.mixture().pdf(bsdfPdf, guidablePdf, lookUps.pdf[i]);
    });
  }
  for (Bounce& bounce : bounces)
    if (!isFinite(bounce.next.weight)) bounce.next = {};
}

}  // namespace odis::render
