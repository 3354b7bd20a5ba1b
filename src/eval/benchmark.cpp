#include "eval/benchmark.h"

#include <ctime>

#include "eval/median.h"

namespace odis::eval {

using namespace render;

namespace {

double cpuSeconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;  // of all threads
}

double seconds(const RenderStats& s) {
  return s.secondsPilot + s.secondsBuild + s.secondsGuided;
}

double rays(const RenderStats& s) {
  return double(s.rays + s.shadowRays);
}

double guidedSamples(const RenderStats& odis) {
  return double(odis.samples - odis.pilotSamples);
}

// Samples of the pilot trace as many rays as those of `path`.
OperationCosts operationCosts(const RenderStats& path, const RenderStats& odis) {
  const double perRay = seconds(path) / rays(path), raysPerSample = rays(path) / double(path.samples);
  const double pilotRays = double(odis.pilotSamples) * raysPerSample;
  OperationCosts costs;
  costs.guidedRay = float(odis.secondsGuided / (rays(odis) - pilotRays) / perRay);
  costs.builtCell = float(odis.secondsBuild / double(std::max<uint64_t>(odis.cellsBuilt, 1)) / perRay);
  costs.recordedRay = float(odis.secondsPilot / pilotRays / perRay - 1);
  return costs;
}

}  // namespace

RenderOptions optionsOf(const BenchmarkSettings& settings, IntegratorKind integrator) {
  RenderOptions options;
  options.integrator = integrator;
  options.sampler = settings.sampler;
  options.spp = settings.spp;
  options.maxDepth = settings.maxDepth;
  options.rrDepth = settings.rrDepth;
  options.threads = settings.threads;
  return options;
}

BenchmarkResult benchmark(const Scene& scene, const BenchmarkSettings& settings, Progress& progress) {
  RenderOptions path = optionsOf(settings, IntegratorKind::path),
                guided = optionsOf(settings, IntegratorKind::odis);

  BenchmarkResult result;
  std::vector<double> samples, cpuSamples, raysTraced, guidedCost, guidingShare, frameCost;
  std::vector<double> guidedRay, builtCell, recordedRay;
  for (int round = 0; round < settings.rounds && !progress.cancelled(); ++round) {
    path.seed = guided.seed = uint64_t(round);
    const double cpu = cpuSeconds();
    const RenderStats plain = render::render(scene, path, progress).stats;
    cpuSamples.push_back(double(plain.samples) / (cpuSeconds() - cpu));
    const RenderStats odis = render::render(scene, guided, progress).stats;
    if (plain.interrupted || odis.interrupted || odis.pilotSamples == odis.samples) break;

    const double perSample = seconds(plain) / double(plain.samples);
    samples.push_back(1 / perSample);
    raysTraced.push_back(rays(plain) / seconds(plain));
    guidedCost.push_back(odis.secondsGuided / guidedSamples(odis) / perSample);
    const double recording = odis.secondsPilot - double(odis.pilotSamples) * perSample;
    guidingShare.push_back((recording + odis.secondsBuild) / seconds(odis));
    frameCost.push_back(seconds(odis) / seconds(plain));
    const OperationCosts costs = operationCosts(plain, odis);
    guidedRay.push_back(costs.guidedRay);
    builtCell.push_back(costs.builtCell);
    recordedRay.push_back(costs.recordedRay);
    result.bytesPerVertex = double(odis.bytesBuild) / double(std::max<uint64_t>(odis.pilotVertices, 1));
    result.bytesMaps = odis.bytesMaps;
  }
  const Crop& crop = scene.film().crop;
  result.pixels = uint64_t(crop.width) * uint64_t(crop.height);
  result.samplesPerSecond = median(samples);
  result.samplesPerCpuSecond = median(cpuSamples);
  result.raysPerSecond = median(raysTraced);
  result.guidedCost = median(guidedCost);
  result.guidingShare = median(guidingShare);
  result.frameCost = median(frameCost);
  result.costs = {float(median(guidedRay)), float(median(builtCell)), float(median(recordedRay))};
  return result;
}

}  // namespace odis::eval
