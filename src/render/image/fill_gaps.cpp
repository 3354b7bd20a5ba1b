#include "render/image/fill_gaps.h"

#include <algorithm>

namespace odis::render {

namespace {

// The image, or its sums over squares: of weighted colours and of weights.
struct Level {
  int width, height;
  std::vector<Rgb> sums;
  std::vector<float> weights;

  size_t at(int x, int y) const { return size_t(y) * size_t(width) + size_t(x); }
};

Level halved(const Level& fine) {
  Level half{(fine.width + 1) / 2, (fine.height + 1) / 2, {}, {}};
  half.sums.assign(size_t(half.width) * size_t(half.height), Rgb(0, 0, 0));
  half.weights.assign(half.sums.size(), 0);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      half.sums[half.at(x / 2, y / 2)] += fine.sums[fine.at(x, y)];
      half.weights[half.at(x / 2, y / 2)] += fine.weights[fine.at(x, y)];
    }
  return half;
}

void fillPixel(const std::vector<Level>& levels, int x, int y, Rgb& color) {
  for (size_t l = 1; l < levels.size(); ++l) {
    const size_t square = levels[l].at(x >> l, y >> l);
    if (levels[l].weights[square] == 0) continue;
    color = levels[l].sums[square] / levels[l].weights[square];
    return;
  }
}

}  // namespace

void fillGaps(int width, int height, const std::vector<float>& weights, std::vector<Rgb>& colors) {
  if (std::find(weights.begin(), weights.end(), 0) == weights.end()) return;
  std::vector<Rgb> sums = colors;
  for (size_t i = 0; i < sums.size(); ++i) sums[i] *= weights[i];
  std::vector<Level> levels{{width, height, std::move(sums), weights}};
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(halved(levels.back()));
  size_t pixel = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++pixel)
      if (weights[pixel] == 0) fillPixel(levels, x, y, colors[pixel]);
}

}  // namespace odis::render
