// Where paths go on, and whether.
#include "render/path/bounce.h"

namespace odis::render {

Bounces keepScattered(Bounces bounces) {
  size_t left = 0;
  for (const Bounce& bounce : bounces) {  // without a branch, which would often be mispredicted
    const Arrival arrival = bounce;
    static_cast<Arrival&>(bounces[left]) = arrival;
    left += arrival.scatters;
  }
  return bounces.first(left);
}

namespace {

bool choosesLobe(const Bounce& bounce) {
  return bounce.vertex->at.shape->bsdf().traits().choosesLobes;
}

}  // namespace

void drawNumbers(const PathSettings& settings, Batch& batch, Bounces bounces) {
  if (bounces.empty()) return;
  batch.samplers.clear();
  for (const Bounce& bounce : bounces) batch.samplers.add(bounce.path->sampler);
  Column x, y;
  const int depth = bounces.front().depth;
  const auto draw1D = [&](VertexNumber number, float VertexNumbers::*member) {
    batch.samplers.draw1D(dimensionOf(depth, number), x);
    for (size_t i = 0; i < bounces.size(); ++i) bounces[i].numbers.*member = x[i];
  };
  const auto draw2D = [&](VertexNumber number, Vec2 VertexNumbers::*member) {
    batch.samplers.draw2D(dimensionOf(depth, number), x, y);
    for (size_t i = 0; i < bounces.size(); ++i) bounces[i].numbers.*member = Vec2(x[i], y[i]);
  };
  draw1D(kLightChoiceNumber, &VertexNumbers::lightChoice);
  draw2D(kLightPointNumber, &VertexNumbers::lightPoint);
  if (std::any_of(bounces.begin(), bounces.end(), choosesLobe)) draw1D(kLobeNumber, &VertexNumbers::lobe);
  draw2D(kDirectionNumber, &VertexNumbers::direction);
  if (settings.learnedRoulette || depth >= settings.rrDepth)
    draw1D(kSurvivalNumber, &VertexNumbers::survival);
  if (settings.shadowRoulette) draw1D(kShadowRayNumber, &VertexNumbers::shadowRay);
}

void playRouletteOnDeparture(const PathSettings& settings, Bounces bounces) {
  for (Bounce& bounce : bounces) {
    bounce.survives = false;
    Path& path = *bounce.path;
    bounce.weight = bounce.next.weight;
    bounce.survival = 1;
    path.eta *= bounce.next.eta;
    // Read where roulette is played: here or, where it was learned, where the path arrives.
    path.uSurvival = bounce.numbers.survival;
    bounce.survives = bounce.next.lobe != Lobe::none && !isBlack(bounce.weight);
    const bool learned = settings.learnedRoulette && bounce.cell != kNoCell;
    if (bounce.survives && bounce.depth >= settings.rrDepth && !learned) {
      bounce.survival = std::min(maxComponent(path.throughput * bounce.weight) * sqr(path.eta), 0.95f);
      // Where roulette is learned no path should weigh more for it than there.
      if (settings.learnedRoulette)
        bounce.survival = std::max(bounce.survival, settings.guide->rules.leastSurvival);
      bounce.survives = path.uSurvival < bounce.survival;
      path.uSurvival /= bounce.survival;  // as good as new, should the path survive
      bounce.weight /= bounce.survival;
    }
    if (!bounce.survives) bounce.weight = Rgb(0, 0, 0);
  }
}

void departRays(Bounces bounces) {
  for (Bounce& bounce : bounces) {
    if (!bounce.survives) continue;
    Path& path = *bounce.path;
    const SurfacePoint& at = bounce.vertex->at;
    path.throughput *= bounce.weight;
    if (!path.visible) path.visibleWeight /= bounce.survival;
    path.hidesEnvironment &= bounce.next.lobe == Lobe::null;
    path.bySampling = !isDiscrete(bounce.next.lobe);
    path.directionPdf = bounce.next.pdf;
    path.previous = bounce.reference;
    path.ray = Scene::spawn(at, at.shading.toWorld(bounce.next.wi));
  }
}

}  // namespace odis::render
