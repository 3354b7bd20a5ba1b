// What the programs of this folder share: a small path tracer, guided by ODIS (diffuse surfaces, next-event
// estimation, roulette; ../tiny/tiny_odis.cpp says what each line is for), a command line and an image file.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <odis/tiles.h>
#include <odis/odis.hpp>

#include "../tiny/numbers.h"
#include "../tiny/scene.h"

struct Settings {
  std::string scene = "sun", output = "image", save;
  uint32_t width = 640, height = 360, spp = 16, threads = std::max(std::thread::hardware_concurrency(), 1u);
  uint32_t passes = UINT32_MAX;  // after which the program ends
  uint64_t seed = 0;
  bool guided = true;
};

// `--name value` for the names above; complains with std::invalid_argument.
inline Settings parseSettings(int count, char** arguments) {
  Settings settings;
  for (int i = 1; i < count; i += 2) {
    const std::string name = arguments[i], value = i + 1 < count ? arguments[i + 1] : "";
    const auto number = [&] {
      if (value.empty() || value.size() > 9 || value.find_first_not_of("0123456789") != std::string::npos)
        throw std::invalid_argument(name + " needs a whole number, not '" + value + "'");
      return uint32_t(std::atol(value.c_str()));
    };
    if (name == "--scene")
      settings.scene = value;
    else if (name == "-o")
      settings.output = value;
    else if (name == "--save")
      settings.save = value;
    else if (name == "--width")
      settings.width = number();
    else if (name == "--height")
      settings.height = number();
    else if (name == "--spp")
      settings.spp = number();
    else if (name == "--seed")
      settings.seed = number();
    else if (name == "--threads")
      settings.threads = number();
    else if (name == "--passes")
      settings.passes = number();
    else if (name == "--guided")
      settings.guided = number() != 0;
    else
      throw std::invalid_argument("unknown argument '" + name + "'");
  }
  return settings;
}

// A frame whose film is the host's.
inline odis::FrameOptions frameOptions(const Settings& settings, const Scene& scene) {
  odis::FrameOptions options;
  options.width = settings.width, options.height = settings.height;
  options.samplesPerPixel = settings.spp, options.seed = settings.seed;
  if (!settings.guided) options.set("guided=off");
  options.guide.lightGroups = uint32_t(scene.lightCount());
  options.keepPixelMeans = false;
  return options;
}

// Calls body(i) for each i below count, on this many threads.
inline void parallelFor(uint32_t count, uint32_t threads, const std::function<void(uint32_t)>& body) {
  std::atomic<uint32_t> next{0};
  std::vector<std::thread> workers;
  for (uint32_t t = 0; t < threads; ++t)
    workers.emplace_back([&] {
      for (uint32_t i = next++; i < count; i = next++) body(i);
    });
  for (std::thread& worker : workers) worker.join();
}

// ---- paths ----

inline constexpr size_t kMostLights = 2;

// What a path brings: to the frame its colour and its rays, to the film everything but the rays.
struct Traced {
  uint32_t pixel = 0, sample = 0;
  float x = 0, y = 0;  // its place in the image, in pixels
  Vec3 color, albedo, normal;
  std::array<Vec3, kMostLights> byLight;  // parts of the colour
  uint32_t rays = 0;                      // shadow rays included
  float weight = 0;                       // in the film, where it is known already

  odis::FrameSample forFrame() const { return {pixel, sample, color, rays}; }
};

// Traces a path of a pass; `path` is where the recorder keeps its events, kNoPath if they are not wanted.
inline Traced trace(const Scene& scene, const Settings& settings, const odis::FramePass& pass, uint32_t pixel,
                    uint32_t sample, odis::PathRecorder& recorder, uint32_t path) {
  Random random(pass.seed, pixel, sample);
  Traced traced;
  traced.pixel = pixel, traced.sample = sample;
  // Positions are uniform in the pixel, whatever the filter of the film is.
  traced.x = float(pixel % settings.width) + random.next();
  traced.y = float(pixel / settings.width) + random.next();
  const float scale = 2 / float(settings.width);
  Ray ray = scene.cameraRay(scale * traced.x - 1, 0.5f * scale * float(settings.height) - scale * traced.y);
  Vec3 throughput{1, 1, 1};
  float rayPdf = 0;           // of the ray's direction
  odis::GuidedVertex vertex;  // that the ray left
  const float evenly = 1 / float(scene.lightCount());
  const auto bring = [&](const Vec3& color, size_t light) {
    traced.color = traced.color + color;
    traced.byLight[light] = traced.byLight[light] + color;
  };
  for (uint32_t depth = 1;; ++depth) {
    const Hit hit = scene.intersect(ray);
    ++traced.rays;
    if (!hit.shape) break;
    if (depth == 1) traced.albedo = hit.color, traced.normal = hit.n;
    recorder.surface(path, odis::surfaceEvent(hit.p, hit.n, ray.direction * -1, hit.distance));
    if (maxComponent(hit.emission) > 0) {
      const size_t light = scene.lightIndex(hit.shape);
      const float lightPdf = hit.shape->directionPdf(ray.origin, ray.direction, hit.distance) *
                             vertex.lightProbability(uint32_t(light), evenly);
      const float misWeight = depth > 1 ? powerHeuristic(rayPdf, lightPdf) : 1;
      bring(throughput * hit.emission * misWeight, light);
      recorder.emission(path, odis::emissionEvent(hit.emission, misWeight, lightPdf));
    }
    if (depth == 16) break;

    // What the guide has learned here: whether the path goes on, which light is asked, where the path goes.
    vertex = odis::GuidedVertex(pass, {hit.p, hit.n, pixel, sample, false, depth});
    const float survival = vertex.survivalProbability(
        luminance(throughput), depth > 3 ? std::min(maxComponent(throughput), 0.95f) : 1);
    const bool survives = random.next() < survival;
    // The mean of this is zero, so the part of any light may have it.
    bring(throughput * vertex.standIn(survival, survives), 0);
    if (!survives) break;
    throughput = throughput / survival;
    recorder.survived(path, survival);
    vertex.prepare(1);

    // Next-event estimation.
    float u = random.next();
    uint32_t chosen = vertex.drawLightGroup(u);
    if (chosen == odis::kNoLightGroup) chosen = uint32_t(std::min(u / evenly, float(scene.lightCount() - 1)));
    const float probability = vertex.lightProbability(chosen, evenly);
    const float u1 = random.next(), u2 = random.next();
    LightSample light = scene.sampleLight(chosen, probability, hit.p, u1, u2);
    const float cosine = std::max(dot(light.wi, hit.n), 0.0f);
    if (cosine > 0) {
      ++traced.rays;
      if (scene.isHidden({hit.p, light.wi}, light.distance)) light.pdf = 0;
      const Vec3 unweighted =
          light.pdf > 0 ? hit.color * light.radiance * (cosine / kPi / light.pdf) : Vec3();
      const float other = light.pdf > 0 ? vertex.pdf(light.wi, cosine / kPi, cosine / kPi) : 0;
      const Vec3 weighted = unweighted * powerHeuristic(light.pdf, other);
      bring(throughput * weighted, chosen);
      recorder.light(path, odis::lightEvent(unweighted, weighted, light.wi,
                                            {light.pdf, cosine / kPi, cosine / kPi, chosen, probability}));
    }

    // The path goes on in a direction of the BSDF, or of the map.
    float v1 = random.next();
    const float v2 = random.next();
    const bool fromMap = vertex.drawsFromMap(v1);
    const float r = std::sqrt(v1), phi = 2 * kPi * v2;
    const Vec3 wi = fromMap ? Vec3(vertex.sampleMap(v1, v2).wi)
                            : Frame(hit.n).toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - v1)});
    const float bsdfPdf = std::max(dot(wi, hit.n), 0.0f) / kPi;
    rayPdf = vertex.pdf(wi, bsdfPdf, bsdfPdf);
    const Vec3 weight = rayPdf > 0 ? hit.color * (bsdfPdf / rayPdf) : Vec3();
    recorder.bounce(path, odis::bounceEvent(wi, weight, rayPdf));
    throughput = throughput * weight;
    ray = {hit.p, wi};
    if (maxComponent(throughput) == 0) break;
  }
  return traced;
}

// Traces the samples of a pass that a tile has, and hands them to the frame with their vertices: of a whole
// tile nothing has to wait.
inline std::vector<Traced> traceTile(const Scene& scene, const Settings& settings, odis::Frame& frame,
                                     const odis::FramePass& pass, const odis::TileGrid& tiles,
                                     uint32_t tile) {
  thread_local odis::PathRecorder recorder;
  std::vector<Traced> samples;
  std::vector<odis::FrameSample> forFrame;
  tiles.forEachPixel(tile, [&](uint32_t pixel) {
    const bool recorded = frame.wantsVertices(pixel);
    const odis::SampleRange range = frame.samples(pixel);
    for (uint32_t i = range.first; i < range.first + range.count; ++i) {
      const uint32_t path = recorded ? recorder.begin({pixel, i}) : odis::kNoPath;
      samples.push_back(trace(scene, settings, pass, pixel, i, recorder, path));
      samples.back().weight = range.weight;
      forFrame.push_back(samples.back().forFrame());
    }
  });
  frame.add(forFrame, recorder.finish());
  return samples;
}
