#include "render/denoise/color_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace odis::render {

namespace {

constexpr float kLeastTypical = 0x1p-10f, kMostTypical = 0x1p60f;  // beyond them images are multiplied
constexpr float kBeyond = 0x1p17f;                                 // over the typical brightness
constexpr float kLamp = 16;                                        // over the mean, without outliers
constexpr int kNear = 8;                                           // pixels

Rgb clean(const Rgb& color) {
  return isFinite(color) ? Rgb(std::max(color.x, 0.0f), std::max(color.y, 0.0f), std::max(color.z, 0.0f))
                         : Rgb(0, 0, 0);
}

// Calls visit(pixel) for those at most `radius` pixels away in either direction, also for the one itself.
template <class Visit>
void forEachNear(size_t pixel, int radius, int width, int height, Visit&& visit) {
  const int x = int(pixel % size_t(width)), y = int(pixel / size_t(width));
  for (int v = std::max(y - radius, 0); v <= std::min(y + radius, height - 1); ++v)
    for (int u = std::max(x - radius, 0); u <= std::min(x + radius, width - 1); ++u)
      visit(size_t(v) * size_t(width) + size_t(u));
}

}  // namespace

ColorRange::ColorRange(std::span<const Rgb> colors, int width)
    : m_width(width), m_height(int(colors.size() / size_t(width))) {
  m_colors.reserve(colors.size());
  for (const Rgb& color : colors) m_colors.push_back(clean(color));
  m_grey =
      std::all_of(m_colors.begin(), m_colors.end(), [](const Rgb& c) { return c.x == c.y && c.y == c.z; });
  findTypical();
  if (black()) return;
  if (m_typical < kLeastTypical || m_typical > kMostTypical) multiply();
  tame();
  double sum = 0;
  for (const Rgb& color : m_colors) sum += std::min(maxComponent(color), kLamp * m_typical);
  m_lamp = kLamp * float(sum / double(m_colors.size()));
}

// A tenth of what isn't black is brighter: what few pixels hold, however much, does not count.
void ColorRange::findTypical() {
  std::vector<float> lit;
  lit.reserve(m_colors.size());
  for (const Rgb& color : m_colors)
    if (const float brightness = maxComponent(color); brightness > 0) lit.push_back(brightness);
  if (lit.empty()) return;
  const auto place = lit.begin() + ptrdiff_t((lit.size() - 1) * 9 / 10);
  std::nth_element(lit.begin(), place, lit.end());
  m_typical = *place;
}

void ColorRange::multiply() {
  m_factor = std::ldexp(1.0, -std::ilogb(m_typical));
  for (Rgb& color : m_colors)
    for (int c = 0; c < 3; ++c)
      color[c] = float(std::min(color[c] * m_factor, double(std::numeric_limits<float>::max())));
  m_typical = float(m_typical * m_factor);
}

void ColorRange::tame() {
  for (size_t i = 0; i < m_colors.size(); ++i)
    if (maxComponent(m_colors[i]) > kBeyond * m_typical) m_beyond.push_back({i, m_colors[i]});
  std::vector<Rgb> instead;
  for (const Beyond& beyond : m_beyond) instead.push_back(tamed(beyond.pixel));
  for (size_t i = 0; i < m_beyond.size(); ++i) m_colors[m_beyond[i].pixel] = instead[i];
}

// The brightest neighbour if none is as bright as this, else the hue at the highest brightness.
Rgb ColorRange::tamed(size_t pixel) const {
  const float most = kBeyond * m_typical;
  bool alone = true;
  Rgb brightest(0, 0, 0);
  forEachNear(pixel, 1, m_width, m_height, [&](size_t other) {
    if (other == pixel) return;
    if (maxComponent(m_colors[other]) > most) alone = false;
    if (maxComponent(m_colors[other]) > maxComponent(brightest)) brightest = m_colors[other];
  });
  const Rgb& color = m_colors[pixel];
  return alone ? brightest : color * (1 / maxComponent(color)) * most;
}

float ColorRange::brightestNear(size_t pixel, int channel) const {
  float brightest = 0;
  forEachNear(pixel, kNear, m_width, m_height,
              [&](size_t other) { brightest = std::max(brightest, m_colors[other][channel]); });
  return brightest;
}

void ColorRange::restore(std::vector<Rgb>& denoised) const {
  if (m_grey)
    for (Rgb& color : denoised) color = Rgb(average(color));
  for (size_t i = 0; i < denoised.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (float& value = denoised[i][c]; value > m_lamp)
        value = std::min(value, std::max(m_lamp, brightestNear(i, c)));
  // What the denoiser leaves bright is no noise: it is as bright as it was.
  for (const Beyond& beyond : m_beyond)
    if (maxComponent(denoised[beyond.pixel]) > kBeyond / 2 * m_typical) denoised[beyond.pixel] = beyond.color;
  if (m_factor == 1) return;
  for (Rgb& color : denoised)
    for (int c = 0; c < 3; ++c)
      color[c] = float(std::min(color[c] / m_factor, double(std::numeric_limits<float>::max())));
}

}  // namespace odis::render
