#include "learn/inspect/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "learn/inspect/words.h"

namespace odis::learn {

using render::Rgb;

namespace {

constexpr int kGap = 8, kText = 11, kSide = 6 * kTargetSize, kColumns = 7;
constexpr int kWidth = kGap + kColumns * (kSide + kGap);
constexpr int kRow = kText + kSide + kGap;
constexpr float kSignedStops = 4;  // likewise, of ratios
const Rgb kFrame(0.06f), kMark(0.0f, 0.8f, 1.0f), kCellMark(1.0f, 0.45f, 0.0f);

// Too little is blue, too much is red.
Rgb signedColor(float stops) {
  const float t = std::clamp(stops / kSignedStops, -1.0f, 1.0f);
  return t < 0 ? Rgb(0.06f * -t, 0.25f * -t, -t) : Rgb(t, 0.2f * t * t, 0.05f * t);
}

class Painter {
 public:
  Painter(const Inspection& inspection, MapColors colors)
      : m_in(inspection),
        m_colors(colors),
        m_canvas(kWidth, kGap + 2 * kText + kGap + int(2 + inspection.maps.size()) * kRow + 2 * kText,
                 kBackground) {}

  Canvas paint(const std::string& title) {
    m_canvas.write(kGap, kGap, kWidth - 2 * kGap, title + ": " + placeWords(m_in), kInk);
    m_canvas.write(kGap, kGap + kText, kWidth - 2 * kGap, cellWords(m_in), kInk);
    m_top = kGap + 2 * kText + kGap;
    pilotRow();
    nextRow();
    convergedRow();
    for (const MapView& map : m_in.maps) {
      nextRow();
      mapRow(map);
    }
    nextRow();
    scale();
    return std::move(m_canvas);
  }

 private:
  void nextRow() {
    m_left = kGap;
    m_top += kRow;
  }
  // Writes above the next panel, and moves on behind it.
  void caption(const std::string& text, int columns = 1) {
    const int width = columns * (kSide + kGap) - kGap;
    m_canvas.write(m_left, m_top, width, text, kInk);
    m_left += width + kGap;
  }
  void lines(const std::vector<std::string>& texts, int columns) {
    for (size_t i = 0; i < texts.size(); ++i)
      m_canvas.write(m_left, m_top + kText * int(i + 1), columns * (kSide + kGap) - kGap, texts[i], kInk);
    m_left += columns * (kSide + kGap);
  }

  // What the pilot saw: from where, the samples, histograms from the finest cell to the coarsest.
  void pilotRow() {
    image();
    samples();
    for (const LevelView& level : m_in.levels) {
      map(level.histogram);
      caption(fmt::format("level {}: {:.0f} samples", level.statistics.level, level.statistics.count));
    }
  }
  void convergedRow() {
    map(m_in.converged.radiance);
    caption("converged: radiance");
    map(m_in.converged.density);
    caption("converged, as a map");
    map(m_in.bsdf);
    caption("BSDF x cosine");
    map(m_in.best);
    caption("BSDF x cosine x radiance");
    lights();
    lines(decisionWords(m_in), 2);
  }
  void mapRow(const MapView& view) {
    map(view.radiance);
    caption(view.name + ": radiance");
    map(view.density);
    caption(view.name + ": map");
    map(view.mixture);
    caption(fmt::format("mixture, BSDF fraction {:.2g}{}", m_in.bsdfFraction,
                        m_in.bsdfFraction < 1 ? "" : ": the BSDF"));
    ratio(view.mixture, m_in.best);
    caption("mixture over BSDF x radiance");
    lines(mapWords(m_in, view), 3);
  }

  // The pilot's image, shrunk to its place; the cell's first vertices in orange, the vertex in a cross.
  void image() {
    constexpr int kMostWidth = 2 * kSide + kGap;
    const int fromWidth = m_in.crop.width, fromHeight = m_in.crop.height;
    const float scale = std::min(float(kMostWidth) / float(fromWidth), float(kSide) / float(fromHeight));
    const int width = std::max(1, int(float(fromWidth) * scale)),
              height = std::max(1, int(float(fromHeight) * scale));
    double sum = 0;
    for (const Rgb& color : m_in.image) sum += render::luminance(color);
    const float exposure = sum > 0 ? float(0.5 * double(m_in.image.size()) / sum) : 1;
    std::vector<uint8_t> inCell(m_in.image.size());
    for (const uint32_t pixel : m_in.cellPixels) inCell[pixel] = 1;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        Rgb mean(0, 0, 0);
        int count = 0;
        bool marked = false;
        const auto range = [](int at, int size, int from) {
          const int begin = at * from / size;
          return std::pair(begin, std::max(begin + 1, (at + 1) * from / size));
        };
        const auto [y0, y1] = range(y, height, fromHeight);
        const auto [x0, x1] = range(x, width, fromWidth);
        for (int py = y0; py < y1; ++py)
          for (int px = x0; px < x1; ++px, ++count) {
            const auto pixel = size_t(py * fromWidth + px);
            mean += m_in.image[pixel];
            marked |= inCell[pixel] != 0;
          }
        mean *= exposure / float(count);
        // Single samples are noisy: bright ones are held back.
        if (m_colors == MapColors::stops) mean /= 1 + render::luminance(mean);
        m_canvas.set(m_left + x, m_top + kText + y, marked ? mean * 0.3f + kCellMark * 0.7f : mean);
      }
    const int x = m_left + (m_in.pixel.x - m_in.crop.x) * width / fromWidth,
              y = m_top + kText + (m_in.pixel.y - m_in.crop.y) * height / fromHeight;
    for (const auto& [dx, dy, w, h] : {std::array{-9, 0, 6, 1}, {4, 0, 6, 1}, {0, -9, 1, 6}, {0, 4, 1, 6}})
      m_canvas.fill(x + dx, y + dy, w, h, kMark);
    caption(fmt::format("pilot, pixel {},{}", m_in.pixel.x, m_in.pixel.y), 2);
  }

  // Dots where samples came from, larger and brighter for more; those that brought nothing are faint points.
  void samples() {
    m_canvas.fill(m_left, m_top + kText, kSide, kSide, Rgb(0.0f));
    std::vector<SampleDot> dots = m_in.samples;
    std::stable_sort(dots.begin(), dots.end(),
                     [](const SampleDot& a, const SampleDot& b) { return a.value < b.value; });
    for (const SampleDot& dot : dots) {
      const int x = int(render::limited(dot.at.x * kSide, 0.0f, float(kSide - 1))),
                y = int(render::limited(dot.at.y * kSide, 0.0f, float(kSide - 1)));
      const float stops = dot.value > 0 ? std::log2(dot.value) : kLeastMapStops;
      const int size = int(std::lround(render::limited(3 + stops / 2, 1.0f, 7.0f)));
      const int px = std::clamp(x - size / 2, 0, kSide - size),
                py = std::clamp(y - size / 2, 0, kSide - size);
      m_canvas.fill(m_left + px, m_top + kText + py, size, size,
                    dot.value > 0 ? mapColor(dot.value, m_colors) + Rgb(0.03f) : Rgb(0.04f, 0.06f, 0.1f));
    }
    caption(fmt::format("{} samples of the cell", m_in.samples.size()));
  }

  void map(const SquareMap& values) { drawMap(m_canvas, {m_left, m_top + kText}, kSide, values, m_colors); }
  void ratio(const SquareMap& of, const SquareMap& to) {
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const int texel = y * of.side / kSide * of.side + x * of.side / kSide;
        m_canvas.set(m_left + x, m_top + kText + y,
                     ratioColor(of.values[size_t(texel)], to.values[size_t(texel)]));
      }
  }
  Rgb ratioColor(float of, float to) const {
    if (!(to > 0)) return of > 0 ? kFrame : Rgb(0.0f);
    return m_colors == MapColors::values ? Rgb(of / to) : signedColor(std::log2(std::max(of / to, 1e-6f)));
  }

  // Bars: the probability of each group of lights; grey: by the hierarchy, orange: as learned.
  void lights() {
    m_canvas.fill(m_left, m_top + kText, kSide, kSide, kFrame);
    const int groups = int(m_in.groups.size());
    float most = 0;
    for (const GroupView& g : m_in.groups) most = std::max({most, g.learned, g.unlearned});
    for (int i = 0; i < groups && most > 0; ++i) {
      const GroupView& g = m_in.groups[size_t(i)];
      const int left = m_left + i * kSide / groups,
                width = std::clamp((i + 1) * kSide / groups - i * kSide / groups - 2, 2, 32);
      const auto bar = [&](float value, int x, int columns, const Rgb& ink) {
        const int height = int(std::lround(value / most * (kSide - 1)));
        m_canvas.fill(x, m_top + kText + kSide - height, columns, height, ink);
      };
      bar(g.unlearned, left, width, Rgb(0.2f));
      bar(g.learned, left + width / 4, width / 2, Rgb(0.8f, 0.4f, 0.05f));
    }
    caption(fmt::format("{} group{} of lights, to {:.2f}", groups, groups == 1 ? "" : "s", most));
  }

  // What the colours mean.
  void scale() {
    if (m_colors == MapColors::values) return;
    drawScale(m_canvas, {m_left, m_top}, 2 * kSide, mapScale());
    drawScale(m_canvas, {m_left + 3 * kSide + kSide / 2 + 2 * kGap, m_top}, 2 * kSide,
              {-kSignedStops, kSignedStops, signedColor,
               fmt::format("too little, too much: {:+.0f} to {:+.0f} stops", -kSignedStops, kSignedStops)});
  }

  const Inspection& m_in;
  MapColors m_colors;
  Canvas m_canvas;
  int m_left = kGap, m_top = 0;
};

}  // namespace

Canvas drawInspection(const Inspection& inspection, const std::string& title, MapColors colors) {
  return Painter(inspection, colors).paint(title);
}

}  // namespace odis::learn
