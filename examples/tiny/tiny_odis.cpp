// The path tracer of tiny.cpp, guided by ODIS: diffuse surfaces and rough metal, next-event estimation with
// multiple importance sampling, Russian roulette; nothing but the standard library beside.
// README.md shows both.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <thread>

#include <odis/odis.hpp>

#include "numbers.h"
#include "scene.h"

// Diffuse reflection, or that of rough metal: GGX with the visible normals sampled (Dupuy and Benyoub 2023).
class Bsdf {
 public:
  // `wo` is the direction towards where the path came from.
  Bsdf(const Hit& hit, const Vec3& wo) : m_hit(hit), m_frame(hit.n), m_wo(m_frame.toLocal(wo)) {}

  // Samples a direction from u, v uniform in [0, 1).
  Vec3 sample(float u, float v) const {
    const float phi = 2 * kPi * v, a = m_hit.roughness;
    if (a == 1) {
      const float r = std::sqrt(u);
      return m_frame.toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)});
    }
    const Vec3 w = normalize({a * m_wo.x, a * m_wo.y, m_wo.z});
    const float z = (1 - u) * (1 + w.z) - w.z, r = std::sqrt(std::max(1 - z * z, 0.0f));
    const Vec3 cap = Vec3{r * std::cos(phi), r * std::sin(phi), z} + w;
    const Vec3 h = normalize({a * cap.x, a * cap.y, cap.z});
    return m_frame.toWorld(h * (2 * dot(m_wo, h)) - m_wo);
  }

  struct Value {
    Vec3 value;     // of the BSDF, times the cosine
    float pdf = 0;  // with respect to solid angle
  };
  Value evaluate(const Vec3& direction) const {
    const Vec3 wi = m_frame.toLocal(direction);
    if (!(wi.z > 0) || !(m_wo.z > 0)) return {};
    if (m_hit.roughness == 1) return {m_hit.color * (wi.z / kPi), wi.z / kPi};
    const Vec3 h = normalize(wi + m_wo);
    const float a2 = m_hit.roughness * m_hit.roughness, d = 1 + h.z * h.z * (a2 - 1);
    const float normals = a2 / (kPi * d * d) / (4 * m_wo.z), out = lambda(m_wo, a2);
    const Vec3 white{1, 1, 1},
        fresnel = m_hit.color + (white - m_hit.color) * std::pow(1 - std::min(dot(wi, h), 1.0f), 5.0f);
    return {fresnel * (normals / (1 + out + lambda(wi, a2))), normals / (1 + out)};
  }

 private:
  // Smith's function of shadowing.
  static float lambda(const Vec3& w, float a2) {
    return (std::sqrt(1 + a2 * (w.x * w.x + w.y * w.y) / (w.z * w.z)) - 1) / 2;
  }
  const Hit& m_hit;
  Frame m_frame;
  Vec3 m_wo;
};

// ---- paths ----

constexpr uint32_t kMaxDepth = 16, kRouletteDepth = 4;

struct Settings {
  std::string scene = "door", output = "image.ppm";
  uint32_t width = 640, height = 360, spp = 16, threads = std::max(std::thread::hardware_concurrency(), 1u);
  uint64_t seed = 0;
};

struct Traced {
  Vec3 radiance;
  uint32_t rays = 0;  // shadow rays included
};

// One sample of one pixel.
struct Sample {
  uint32_t pixel, sample;
  uint64_t seed;
  const odis::FramePass& pass;
  bool recorded;
};
// Gathers what the paths of this thread met, for the guide to learn from.
thread_local odis::PathRecorder recorder;

// Traces the path of a sample.
Traced trace(const Scene& scene, const Settings& settings, const Sample& of) {
  Random random(of.seed, of.pixel, of.sample);
  const float x = float(of.pixel % settings.width) + random.next() - 0.5f * float(settings.width);
  const float y = float(of.pixel / settings.width) + random.next() - 0.5f * float(settings.height);
  Ray ray = scene.cameraRay(2 * x / float(settings.width), -2 * y / float(settings.width));
  Traced traced;
  Vec3 throughput{1, 1, 1};
  float rayPdf = 0;                                                              // of the ray's direction
  std::vector<float> lights(scene.lightCount(), 1 / float(scene.lightCount()));  // the probability of each
  odis::GuidedVertex vertex;
  const uint32_t path = of.recorded ? recorder.begin({of.pixel, of.sample}) : odis::kNoPath;
  for (uint32_t depth = 1;; ++depth) {
    const Hit hit = scene.intersect(ray);
    const Vec3 wo = ray.direction * -1;
    ++traced.rays;
    if (!hit.shape) break;
    recorder.surface(path, odis::surfaceEvent(hit.p, hit.n, wo, hit.distance));

    // Emission counts in full where the camera sees it, later by its weight against next-event estimation.
    if (maxComponent(hit.emission) > 0) {
      const float lightPdf = hit.shape->directionPdf(ray.origin, ray.direction, hit.distance) *
                             lights[scene.lightIndex(hit.shape)];
      const float weight = depth > 1 ? powerHeuristic(rayPdf, lightPdf) : 1;
      traced.radiance = traced.radiance + throughput * hit.emission * weight;
      recorder.emission(path, odis::emissionEvent(hit.emission, weight, lightPdf));
    }
    if (depth == kMaxDepth) break;

    // Russian roulette ends paths that have lost most of their throughput; under a guide those that it
    // expects little of.
    float survival = depth >= kRouletteDepth ? std::min(maxComponent(throughput), 0.95f) : 1;
    vertex = odis::GuidedVertex(of.pass, {hit.p, hit.n, of.pixel, of.sample, false, depth});
    survival = vertex.survivalProbability(luminance(throughput), survival);
    const bool survives = random.next() < survival;
    traced.radiance = traced.radiance + throughput * vertex.standIn(survival, survives);
    if (!survives) break;
    throughput = throughput / survival;
    recorder.survived(path, survival);

    // Next-event estimation: a shadow ray towards a light.
    const Bsdf bsdf(hit, wo);
    vertex.prepare(hit.roughness);
    for (uint32_t i = 0; i < lights.size(); ++i)
      lights[i] = vertex.lightProbability(i, 1 / float(lights.size()));
    size_t chosen = 0;
    for (float u = random.next(); chosen + 1 < lights.size() && u >= lights[chosen]; ++chosen)
      u -= lights[chosen];
    const float u1 = random.next(), u2 = random.next();
    LightSample light = scene.sampleLight(chosen, lights[chosen], hit.p, u1, u2);
    const Bsdf::Value toLight = bsdf.evaluate(light.wi);
    if (maxComponent(toLight.value) > 0) {
      ++traced.rays;
      if (scene.isHidden({hit.p, light.wi}, light.distance)) light.pdf = 0;
      const Vec3 unweighted = light.pdf > 0 ? toLight.value * light.radiance / light.pdf : Vec3();
      // The density with which the path might go on in this direction.
      const float other = light.pdf > 0 ? vertex.pdf(light.wi, toLight.pdf, toLight.pdf) : 0;
      const Vec3 direct = unweighted * powerHeuristic(light.pdf, other);
      traced.radiance = traced.radiance + throughput * direct;
      const odis::LightDraw draw{light.pdf, toLight.pdf, toLight.pdf, uint32_t(chosen), lights[chosen]};
      recorder.light(path, odis::lightEvent(unweighted, direct, light.wi, draw));
    }

    // The path goes on in a direction of the BSDF, or of the map.
    float v1 = random.next(), v2 = random.next();
    const Vec3 wi = vertex.drawsFromMap(v1) ? Vec3(vertex.sampleMap(v1, v2).wi) : bsdf.sample(v1, v2);
    Bsdf::Value next = bsdf.evaluate(wi);
    next.pdf = vertex.pdf(wi, next.pdf, next.pdf);
    const Vec3 weight = next.pdf > 0 ? next.value / next.pdf : Vec3();
    recorder.bounce(path, odis::bounceEvent(wi, weight, next.pdf, hit.roughness));
    throughput = throughput * weight;
    rayPdf = next.pdf;
    ray = {hit.p, wi};
    if (maxComponent(throughput) == 0) break;
  }
  return traced;
}

// ---- images ----

struct Image {
  std::vector<Vec3> pixels;
  std::atomic<uint64_t> rays{0};
};

// Calls `render` with the pixels of each tile of 16 x 16, on all threads.
void forEachTile(const Settings& settings, const std::function<void(const std::vector<uint32_t>&)>& render) {
  constexpr uint32_t kTile = 16;
  const uint32_t columns = (settings.width + kTile - 1) / kTile, rows = (settings.height + kTile - 1) / kTile;
  std::atomic<uint32_t> next{0};
  const auto work = [&] {
    for (uint32_t tile = next++; tile < columns * rows; tile = next++) {
      std::vector<uint32_t> pixels;
      for (uint32_t i = 0; i < kTile * kTile; ++i) {
        const uint32_t x = tile % columns * kTile + i % kTile, y = tile / columns * kTile + i / kTile;
        if (x < settings.width && y < settings.height) pixels.push_back(y * settings.width + x);
      }
      render(pixels);
    }
  };
  std::vector<std::thread> threads;
  for (uint32_t i = 0; i < settings.threads; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
}

// Renders the image.
void render(const Scene& scene, const Settings& settings, Image& image) {
  odis::FrameOptions options;
  options.width = settings.width, options.height = settings.height, options.seed = settings.seed;
  options.samplesPerPixel = settings.spp, options.guide.lightGroups = uint32_t(scene.lightCount());
  odis::Frame frame(options, odis::Context({sizeof(odis::ContextOptions), settings.threads}));
  const odis::FramePass* pass;
  const auto renderTile = [&](const std::vector<uint32_t>& pixels) {
    std::vector<odis::FrameSample> samples;
    for (const uint32_t pixel : pixels) {
      for (odis::SampleRange left = frame.samples(pixel); left.count > 0; ++left.first, --left.count) {
        const Sample of{pixel, left.first, pass->seed, *pass, frame.wantsVertices(pixel)};
        const Traced traced = trace(scene, settings, of);
        samples.push_back({pixel, left.first, traced.radiance, traced.rays});
        image.rays += traced.rays;
      }
    }
    frame.add(samples, recorder.finish());
  };
  for (; (pass = frame.beginPass()); frame.endPass()) forEachTile(settings, renderTile);
  for (uint32_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = frame.mean(i).color;
}

// Writes PFM (linear 32-bit floats, bottom row first), or PPM (8 bits, sRGB) for any other ending.
void writeImage(const Settings& settings, const Image& image) {
  const std::string& path = settings.output;
  const bool linear = path.size() > 4 && path.compare(path.size() - 4, 4, ".pfm") == 0;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) throw std::runtime_error("can't write '" + path + "'");
  std::fprintf(file, linear ? "PF\n%u %u\n-1.0\n" : "P6\n%u %u\n255\n", settings.width, settings.height);
  const auto display = [](float v) {
    const float s = v < 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
    return static_cast<unsigned char>(std::clamp(s, 0.0f, 1.0f) * 255 + 0.5f);
  };
  for (uint32_t i = 0; i < settings.height; ++i) {
    const uint32_t row = linear ? settings.height - 1 - i : i;
    for (uint32_t x = 0; x < settings.width; ++x) {
      const Vec3& c = image.pixels[row * settings.width + x];
      const unsigned char bytes[3] = {display(c.x), display(c.y), display(c.z)};
      std::fwrite(linear ? static_cast<const void*>(&c) : bytes, linear ? sizeof c : sizeof bytes, 1, file);
    }
  }
  if (std::fclose(file) != 0) throw std::runtime_error("can't write '" + path + "'");
}

// ---- the command line ----

uint64_t parseNumber(const std::string& name, const std::string& text, uint64_t least, uint64_t most) {
  const bool digits = !text.empty() && text.size() < 20 && text.find_first_not_of("0123456789") == text.npos;
  const uint64_t number = digits ? std::strtoull(text.c_str(), nullptr, 10) : 0;
  if (!digits || number < least || number > most)
    throw std::invalid_argument(name + " needs a whole number from " + std::to_string(least) + " to " +
                                std::to_string(most) + ", not '" + text + "'");
  return number;
}

Settings parseSettings(int count, char** arguments) {
  Settings settings;
  for (int i = 1; i < count; i += 2) {
    const std::string name = arguments[i], value = i + 1 < count ? arguments[i + 1] : "";
    if (name == "--scene")
      settings.scene = value;
    else if (name == "--spp")
      settings.spp = uint32_t(parseNumber(name, value, 1, 1u << 20));
    else if (name == "--seed")
      settings.seed = parseNumber(name, value, 0, UINT64_MAX);
    else if (name == "--width")
      settings.width = uint32_t(parseNumber(name, value, 1, 1u << 14));
    else if (name == "--height")
      settings.height = uint32_t(parseNumber(name, value, 1, 1u << 14));
    else if (name == "--threads")
      settings.threads = uint32_t(parseNumber(name, value, 1, 1024));
    else if (name == "-o")
      settings.output = value;
    else
      throw std::invalid_argument("unknown argument '" + name +
                                  "'; there are --scene door|lamp|sun, --spp, --seed, --width, --height, "
                                  "--threads and -o FILE.ppm|FILE.pfm");
  }
  return settings;
}

int main(int count, char** arguments) try {
  const Settings settings = parseSettings(count, arguments);
  const Scene scene = makeScene(settings.scene);
  Image image;
  image.pixels.resize(size_t(settings.width) * settings.height);
  const auto begin = std::chrono::steady_clock::now();
  render(scene, settings, image);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  writeImage(settings, image);
  std::printf("%s: %u samples per pixel, %.2f million rays, %.3f s\n", settings.scene.c_str(), settings.spp,
              double(image.rays) * 1e-6, seconds.count());
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
