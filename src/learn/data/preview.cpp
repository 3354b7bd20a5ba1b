#include "learn/data/preview.h"

#include <fmt/format.h>
#include <odis/octahedral.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "odis/cells/samples.h"
#include "render/files/read_json.h"

namespace odis::learn {

using render::Rgb;

namespace {

constexpr int kGap = 6, kText = 11, kImageWidth = 160, kSide = 96, kBarWidth = 128, kWidestBar = 16;
constexpr int kBins = 16;  // a side of what the pilots' vertices say
constexpr int kMapColumns = 7;
constexpr int kRowHeight = kText + kSide + kGap;
const Rgb kBackground(0.02f), kInk(0.7f), kFrame(0.06f), kUnsampled(0.0f, 0.015f, 0.08f), kMark(1, 0, 0);

using Map = std::array<float, kTargetTexels>;

// Maps of fewer texels as if they had kTargetSize a side.
template <class T>
void enlarge(std::vector<T>& map) {
  constexpr int kRatio = kTargetSize / kWindowMapSize;
  std::vector<T> large(kTargetTexels);
  for (int t = 0; t < kTargetTexels; ++t) {
    const int x = t % kTargetSize / kRatio, y = t / kTargetSize / kRatio;
    large[size_t(t)] = map[size_t(y) * kWindowMapSize + size_t(x)];
  }
  map = std::move(large);
}

void enlargeMaps(Target& target) {
  if (target.samples.size() == kTargetTexels) return;
  enlarge(target.samples);
  for (std::vector<float>* map : {&target.indirect, &target.indirectRms, &target.emission,
                                  &target.emissionRms, &target.lightPdf, &target.rays})
    enlarge(*map);
}

// A view of a shard, unpacked.
struct ViewData {
  std::string name;
  ViewFrame frame;
  int width = 0, height = 0;
  std::vector<Pilot> pilots;
  std::vector<Target> targets;
  CellGrid grid;

  ViewData(const ShardReader& shard, size_t view) {
    try {
      const nlohmann::json& json = shard.header().at("views").at(view);
      name = fmt::format("{} {}", shard.header().at("name").get<std::string>(),
                         json.at("file").get<std::string>());
      frame = viewFrame(shard, view);
      width = int(render::wholeNumber(json.at("width")));
      height = int(render::wholeNumber(json.at("height")));
      pilots = readPilots(shard, view);
    } catch (const nlohmann::json::exception& e) {
      throw ShardError(
          fmt::format("{}: the header is not as expected: {}", shard.path(), render::jsonReason(e)));
    }
    if (width < 1 || height < 1 || pilots.empty() || pilots[0].image.size() != size_t(width) * size_t(height))
      throw ShardError(name + ": the image is not of the size that the header says");
    targets = readTargets(shard, targetPrefix(view), frame);
    for (Target& target : targets) enlargeMaps(target);
    grid = CellGrid(frame.origin, frame.edge);
  }
  uint64_t cellOf(const PathVertex& v) const { return grid.key(v.position, v.normal, 0); }
  const PathVertex& vertex(size_t index) const {
    for (const Pilot& pilot : pilots) {
      if (index < pilot.vertices.size()) return pilot.vertices[index];
      index -= pilot.vertices.size();
    }
    throw ShardError(name + ": a target's vertex is none of the pilots'");
  }
};

float percentile(std::vector<float> values, float share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + std::ptrdiff_t(share * float(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Draws one target's row.
class Row {
 public:
  Row(Canvas& canvas, const ViewData& view, const Target& target, int top)
      : m_canvas(canvas), m_view(view), m_target(target), m_top(top) {}

  void draw() {
    const PathVertex& middle = m_view.vertex(m_target.vertex);
    const uint64_t cell = m_view.cellOf(middle);
    Map histogram{}, reference{};
    std::set<uint32_t> pixels;
    size_t count = 0;
    for (const Pilot& pilot : m_view.pilots)
      for (const PathVertex& v : pilot.vertices) {
        if (!isUsable(v) || m_view.cellOf(v) != cell) continue;
        ++count;
        if (v.depth == 1) pixels.insert(v.pixel);
        addTo(histogram, v);
      }
    for (float& value : histogram)
      value *= float(kBins * kBins / (4 * M_PI)) / float(std::max<size_t>(count, 1));
    for (int texel = 0; texel < kTargetTexels; ++texel) {
      const Float3 wi = directionInTexel(texel, {0.5f, 0.5f});
      reference[size_t(texel)] = m_target.indirect[size_t(texel)] * std::abs(dot(wi, m_target.normal));
    }
    if (m_target.pixel) pixels = {middle.pixel};

    image(pixels, middle);
    // Radiance of the whole row at one exposure, that of the brighter directions.
    std::vector<float> lit;
    for (const float value : m_target.indirect)
      if (value > 0) lit.push_back(value);
    const float scale = 1 / std::max(percentile(lit, 0.95f), 1e-6f);
    map(fmt::format("{} vertices", count), histogram, scale, false);
    map("indirect x cos", reference, scale);
    map("indirect", m_target.indirect, scale);
    map("indirect rms", m_target.indirectRms, scale);
    map("emission", m_target.emission, scale);
    map("nee pdf", m_target.lightPdf, 1 / std::max(percentile(m_target.lightPdf, 1), 1e-6f));
    const float most = percentile(m_target.rays, 1);
    map(fmt::format("rays to {:.0f}", most), m_target.rays, 1 / std::max(most, 1.0f));
    lights();
  }

 private:
  // What one vertex says of the texel of its direction.
  static void addTo(Map& histogram, const PathVertex& v) {
    const Float2 at = directionToSquare(v.wi);
    const auto bin = [](float x) { return size_t(render::limited(x * kBins, 0.0f, float(kBins - 1))); };
    constexpr size_t kEach = kTargetSize / kBins;
    for (size_t y = 0; y < kEach; ++y)
      for (size_t x = 0; x < kEach; ++x)
        histogram[(bin(at.y) * kEach + y) * kTargetSize + bin(at.x) * kEach + x] += core::sampleValue(v);
  }
  void caption(int columns, const std::string& text) { m_canvas.write(m_left, m_top, columns, text, kInk); }

  // The first pilot's image, and over it, red, where paths met the cell first.
  void image(const std::set<uint32_t>& pixels, const PathVertex& middle) {
    const int width = std::min(kImageWidth, kSide * m_view.width / m_view.height),
              height = std::min(kSide, width * m_view.height / m_view.width);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const int from = (y * m_view.height / height) * m_view.width + x * m_view.width / width;
        m_canvas.set(m_left + x, m_top + kText + y,
                     m_view.pilots[0].image[size_t(from)] * (0.5f / m_view.frame.unit));
      }
    for (const uint32_t pixel : pixels) {
      const int x = (2 * (int(pixel) % m_view.width) + 1) * width / (2 * m_view.width),
                y = (2 * (int(pixel) / m_view.width) + 1) * height / (2 * m_view.height);
      const int size = m_target.pixel ? 4 : 2;
      m_canvas.fill(m_left + x - size / 2, m_top + kText + y - size / 2, size, size, kMark);
    }
    caption(kImageWidth + kGap,
            fmt::format("{} {}", m_target.pixel ? "pixel" : "cell",
                        pixels.empty() ? fmt::format("(met at bounce {})", middle.depth) : ""));
    m_left += kImageWidth + kGap;
  }

  template <class Values>
  void map(const std::string& name, const Values& values, float scale, bool onlySampled = true) {
    constexpr int kEach = kSide / kTargetSize;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const size_t texel = size_t(y / kEach) * kTargetSize + size_t(x / kEach);
        const bool sampled = !onlySampled || m_target.samples[texel] > 0;
        m_canvas.set(m_left + x, m_top + kText + y, sampled ? Rgb(values[texel] * scale) : kUnsampled);
      }
    caption(kSide + kGap, name);
    m_left += kSide + kGap;
  }

  // Bars: the root mean square of each group's next-event estimate, from the floor; grey behind it, without
  // its weight.
  void lights() {
    m_canvas.fill(m_left, m_top + kText, kBarWidth, kSide, kFrame);
    float most = 0;
    for (const LightMoments& m : m_target.lights) most = std::max(most, m.rms);
    const int groups = int(m_target.lights.size());
    for (int g = 0; g < groups && most > 0; ++g) {
      const int left = g * kBarWidth / groups,
                width = std::clamp((g + 1) * kBarWidth / groups - left - 1, 1, kWidestBar);
      const auto bar = [&](float value, const Rgb& color) {
        const int height = int(std::lround(render::limited(value / most, 0.0f, 1.0f) * kSide));
        m_canvas.fill(m_left + left, m_top + kText + kSide - height, width, height, color);
      };
      bar(m_target.lights[size_t(g)].rms, Rgb(0.15f));
      bar(m_target.lights[size_t(g)].misRms, Rgb(0.8f, 0.5f, 0.1f));
    }
    caption(kBarWidth, fmt::format("{} groups to {:.2g}", groups, most / m_view.frame.unit));
  }

  Canvas& m_canvas;
  const ViewData& m_view;
  const Target& m_target;
  int m_top, m_left = kGap;
};

}  // namespace

Canvas previewOf(const std::vector<std::string>& shards, int count) {
  const int width = kGap + kImageWidth + kGap + kMapColumns * (kSide + kGap) + kBarWidth + kGap;
  Canvas canvas(width, kGap + count * (kRowHeight + kText), kBackground);
  // As many rows of each shard as of the others, as far as that can be.
  int row = 0;
  for (size_t s = 0; s < shards.size(); ++s) {
    const int rows = int(size_t(count) * (s + 1) / shards.size()) - row;
    if (rows == 0) continue;
    const ShardReader shard(shards[s]);
    const size_t views = shard.header().value("views", nlohmann::json::array()).size();
    for (size_t v = 0, end = size_t(rows); v < views; ++v) {
      const size_t here = end * (v + 1) / views - end * v / views;
      if (here == 0) continue;
      const ViewData view(shard, v);
      // Others in each view than in the one before.
      const auto shift = size_t(0.618 * row * double(view.targets.size()));
      for (size_t i = 0; i < std::min(here, view.targets.size()); ++i, ++row) {
        const int top = kGap + row * (kRowHeight + kText);
        canvas.write(kGap, top, width, view.name, kInk);
        Row(canvas, view, view.targets[(i * view.targets.size() / here + shift) % view.targets.size()],
            top + kText)
            .draw();
      }
    }
  }
  if (row == 0) throw ShardError(shards.front() + ": there are no targets to draw");
  return canvas;
}

}  // namespace odis::learn
