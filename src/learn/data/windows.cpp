#include "learn/data/windows.h"

#include <algorithm>
#include <cmath>

#include "learn/data/target_tracer.h"
#include "learn/scenes/random.h"

namespace odis::learn {

namespace {

// How often a place that overlaps another window is drawn anew.
constexpr int kTries = 16;

bool overlap(const Window& a, const Window& b, int size) {
  return std::abs(a.x - b.x) < size && std::abs(a.y - b.y) < size;
}

// Sums of squares of what FeatureSums sums up.
struct FeatureSquares {
  render::Rgb albedo{0, 0, 0};
  render::Vec3 normal{0, 0, 0};
  float depth = 0, roughness = 0;
};

// Adds what a pilot saw to the sums over all pilots.
void addFeatures(const std::vector<render::FeatureSums>& pilot, std::vector<render::FeatureSums>& sums,
                 std::vector<FeatureSquares>& squares) {
  for (size_t p = 0; p < pilot.size(); ++p) {
    const render::FeatureSums& f = pilot[p];
    if (f.hits == 0) continue;
    sums[p].albedo += f.albedo;
    sums[p].normal += f.normal;
    sums[p].depth += f.depth;
    sums[p].roughness += f.roughness;
    ++sums[p].hits;
    squares[p].albedo += f.albedo * f.albedo;
    squares[p].normal += f.normal * f.normal;
    squares[p].depth += f.depth * f.depth;
    squares[p].roughness += f.roughness * f.roughness;
  }
}

template <class T>
T variance(const T& sum, const T& squares, float count) {
  const T mean = sum * (1 / count);
  return squares * (1 / count) - mean * mean;
}

WindowView::Pixel describePixel(const render::FeatureSums& sums, const FeatureSquares& squares) {
  WindowView::Pixel pixel;
  pixel.hits = uint8_t(sums.hits);
  if (sums.hits == 0) return pixel;
  const auto count = float(sums.hits);
  pixel.albedo = sums.albedo * (1 / count);
  pixel.normal = sums.normal * (1 / count);
  pixel.depth = sums.depth / count;
  pixel.roughness = sums.roughness / count;
  pixel.albedoVariance = variance(sums.albedo, squares.albedo, count);
  pixel.normalVariance = variance(sums.normal, squares.normal, count);
  pixel.depthVariance = variance(sums.depth, squares.depth, count);
  pixel.roughnessVariance = variance(sums.roughness, squares.roughness, count);
  return pixel;
}

// For each pixel the number of the first usable vertex of one of its paths, through all pilots; -1: none.
std::vector<int64_t> usableVertices(std::span<const Pilot> pilots, size_t pixels, Random& random) {
  std::vector<int64_t> vertices(pixels, -1);
  int64_t index = 0;
  const size_t preferred = size_t(random.unit() * double(pilots.size()));
  for (size_t i = 0; i < pilots.size(); ++i)
    for (const PathVertex& v : pilots[i].vertices) {
      if (isUsable(v) && luminance(v.weight) > 0 && (vertices[v.pixel] < 0 || i == preferred))
        vertices[v.pixel] = index;
      ++index;
    }
  return vertices;
}

float noiseOf(const Target& target) {
  double errors = 0, squares = 0;
  for (int t = 0; t < kWindowMapTexels; ++t) {
    if (target.samples[t] == 0) continue;
    const double indirect = target.indirect[t], emission = target.emission[t];
    const double variance = double(target.indirectRms[t]) * target.indirectRms[t] - indirect * indirect +
                            double(target.emissionRms[t]) * target.emissionRms[t] - emission * emission;
    errors += std::max(variance, 0.0) / target.samples[t];
    squares += (indirect + emission) * (indirect + emission);
  }
  return squares > 0 ? float(std::sqrt(errors / squares)) : 0;
}

// The targets of a window: as many as are wanted, if there are so many pixels with a vertex in its middle.
class WindowTargets {
 public:
  WindowTargets(const render::Scene& scene, WindowView& view, const WindowSettings& settings,
                std::vector<int64_t> vertices)
      : m_scene(scene), m_view(view), m_settings(settings), m_vertices(std::move(vertices)) {}

  void trace(uint32_t window, size_t wanted, TargetTracer& tracer, Random& random) {
    std::vector<std::pair<double, uint32_t>> candidates;
    const int width = m_scene.film().crop.width, margin = (m_settings.size - m_settings.middle) / 2;
    for (int y = 0; y < m_settings.middle; ++y)
      for (int x = 0; x < m_settings.middle; ++x) {
        const Window& at = m_view.windows[window];
        const auto pixel = size_t(at.y + margin + y) * size_t(width) + size_t(at.x + margin + x);
        if (m_vertices[pixel] >= 0) candidates.emplace_back(random.unit(), uint32_t(m_vertices[pixel]));
      }
    std::sort(candidates.begin(), candidates.end());
    for (size_t i = 0, made = 0; i < candidates.size() && made < wanted; ++i)
      made += add(window, candidates[i].second, tracer);
  }

 private:
  bool add(uint32_t window, uint32_t vertex, TargetTracer& tracer) {
    size_t at = vertex, pilot = 0;
    while (at >= m_view.pilots[pilot].vertices.size()) at -= m_view.pilots[pilot++].vertices.size();
    const auto start = findStart(m_scene, m_view.pilots[pilot].vertices, at);
    if (!start) return false;
    Target& target = m_view.targets.emplace_back();
    target.pixel = true;
    target.vertex = vertex;
    target.cellVertices = 1;
    tracer.trace(std::span(&*start, 1), target);
    foldMaps(target);
    m_view.windowOf.push_back(uint16_t(window));
    m_view.noise.push_back(noiseOf(target));
    return true;
  }

  const render::Scene& m_scene;
  WindowView& m_view;
  const WindowSettings& m_settings;
  std::vector<int64_t> m_vertices;
};

}  // namespace

std::vector<Window> placeWindows(int width, int height, const WindowSettings& settings, uint64_t seed) {
  std::vector<Window> windows;
  if (width < settings.size || height < settings.size) return windows;
  Random random(seed);
  for (int i = 0; i < settings.count; ++i) {
    Window window;
    for (int attempt = 0; attempt < kTries; ++attempt) {
      window = {int(random.unit() * (width - settings.size + 1)),
                int(random.unit() * (height - settings.size + 1))};
      if (std::none_of(windows.begin(), windows.end(),
                       [&](const Window& other) { return overlap(window, other, settings.size); }))
        break;
    }
    windows.push_back(window);
  }
  return windows;
}

void foldMaps(Target& target) {
  constexpr int kRatio = kTargetSize / kWindowMapSize;
  std::vector<double> counts(kWindowMapTexels), found(kWindowMapTexels);
  const std::vector<uint8_t> samples = target.samples;
  const auto texel = [](int t) {
    const int x = t % kTargetSize / kRatio, y = t / kTargetSize / kRatio;
    return size_t(y) * kWindowMapSize + size_t(x);
  };
  for (int t = 0; t < kTargetTexels; ++t) counts[texel(t)] += samples[size_t(t)];
  const auto fold = [&](std::vector<float>& map, bool squared) {
    std::vector<double> sums(kWindowMapTexels);
    for (int t = 0; t < kTargetTexels; ++t) {
      const double value = map[size_t(t)];
      sums[texel(t)] += samples[size_t(t)] * (squared ? value * value : value);
    }
    map.assign(kWindowMapTexels, 0);
    for (size_t t = 0; t < sums.size(); ++t)
      if (counts[t] > 0) map[t] = float(squared ? std::sqrt(sums[t] / counts[t]) : sums[t] / counts[t]);
  };
  // The density is a mean over those texels alone where emission was met.
  std::vector<double> densities(kWindowMapTexels);
  for (int t = 0; t < kTargetTexels; ++t) {
    if (!(target.lightPdf[size_t(t)] > 0)) continue;
    densities[texel(t)] += target.lightPdf[size_t(t)];
    ++found[texel(t)];
  }
  fold(target.indirect, false);
  fold(target.indirectRms, true);
  fold(target.emission, false);
  fold(target.emissionRms, true);
  fold(target.rays, false);
  target.lightPdf.assign(kWindowMapTexels, 0);
  target.samples.assign(kWindowMapTexels, 0);
  for (size_t t = 0; t < counts.size(); ++t) {
    if (found[t] > 0) target.lightPdf[t] = float(densities[t] / found[t]);
    target.samples[t] = uint8_t(std::min(counts[t], 255.0));
  }
}

WindowView traceWindows(const render::Scene& scene, const render::LightSampler& lights,
                        const WindowSettings& windows, const TargetSettings& targets, int pilots,
                        uint64_t seed) {
  Random random(seed);
  const render::Crop& crop = scene.film().crop;
  const size_t pixels = size_t(crop.width) * size_t(crop.height);
  WindowView view;
  view.windows = placeWindows(crop.width, crop.height, windows, random.bits());
  std::vector<bool> wanted(pixels);
  const auto forEachPixel = [&](const auto& use) {
    for (const Window& window : view.windows)
      for (int y = window.y; y < window.y + windows.size; ++y)
        for (int x = window.x; x < window.x + windows.size; ++x)
          use(size_t(y) * size_t(crop.width) + size_t(x));
  };
  forEachPixel([&](size_t pixel) { wanted[pixel] = true; });

  std::vector<render::FeatureSums> sums(pixels);
  std::vector<FeatureSquares> squares(pixels);
  for (int i = 0; i < pilots; ++i) {
    std::vector<render::FeatureSums> features(pixels);
    view.pilots.push_back(tracePilot(scene, lights, random.bits(), wanted, features));
    addFeatures(features, sums, squares);
  }
  forEachPixel([&](size_t pixel) { view.pixels.push_back(describePixel(sums[pixel], squares[pixel])); });
  view.frame = frameOf(view.pilots);
  // Pixels outside of windows are black, and no part of the mean.
  const auto inside = double(std::count(wanted.begin(), wanted.end(), true));
  if (inside > 0) view.frame.unit *= float(double(pixels) / inside);

  TargetTracer tracer(scene, lights, targets, random.bits(), kDeepestPath);
  WindowTargets make(scene, view, windows, usableVertices(view.pilots, pixels, random));
  for (uint32_t window = 0; window < view.windows.size(); ++window)
    make.trace(window, size_t(targets.pixels) / size_t(windows.count), tracer, random);
  return view;
}

}  // namespace odis::learn
