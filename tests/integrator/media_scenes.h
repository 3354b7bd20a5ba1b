// Scenes with participating media: those of data/media, and the grids that they name.
#pragma once

#include <fstream>
#include <memory>
#include <string>

#include "render/scene/scene.h"
#include "support/temporary_folder.h"

namespace odis::test {

// Writes a volume (docs/media.md) of `size`^3 voxels; value(x, y, z, channel) is called for each number.
template <class Value>
void writeVolume(const std::string& path, int size, int channels, const Value& value) {
  std::ofstream file(path, std::ios::binary);
  const auto write = [&](const auto& number) {
    file.write(reinterpret_cast<const char*>(&number), sizeof(number));
  };
  file << "VOL\x03";
  for (const int32_t number : {1, size, size, size, channels}) write(number);
  for (const float corner : {0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f}) write(corner);
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        for (int channel = 0; channel < channels; ++channel) write(float(value(x, y, z, channel)));
}

// A ball of blocks of 8 voxels within 64^3, each of another density; in [0, 1]. bench/media_references.py has
// the same.
inline double blockDensity(int x, int y, int z, int salt) {
  const auto square = [](int i) { return double((2 * i - 63) * (2 * i - 63)); };
  const double r2 = (square(x) + square(y) + square(z)) / (63.0 * 63.0);
  const int block = (((x / 8) * 73) ^ ((y / 8) * 151) ^ ((z / 8) * 283) ^ salt) & 15;
  return std::max(1 - r2, 0.0) * (block / 15.0);
}

// Loads a scene of data/media.
inline std::unique_ptr<render::Scene> loadMediaScene(const std::string& name) {
  const TemporaryFolder folder;
  const std::string grid = folder.path("grid.vol"), colors = folder.path("color_grid.vol");
  writeVolume(grid, 64, 1, [](int x, int y, int z, int) { return blockDensity(x, y, z, 5); });
  writeVolume(colors, 16, 3, [](int x, int y, int z, int channel) {
    const int salts[] = {5, 9, 14};
    return blockDensity(4 * x, 4 * y, 4 * z, salts[channel]);
  });
  const std::string flakes = folder.path("flake_grid.vol");
  writeVolume(flakes, 4, 6, [](int, int, int, int channel) {
    const double fibresAlongX[] = {0.0625, 1, 1, 0, 0, 0};
    return fibresAlongX[channel];
  });
  render::LoadOptions options;
  std::ifstream file(ODIS_TEST_DATA "/media/" + name + ".xml");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  if (text.find("$grid") != std::string::npos) options.defines["grid"] = grid;
  if (text.find("$color_grid") != std::string::npos) options.defines["color_grid"] = colors;
  if (text.find("$flake_grid") != std::string::npos) options.defines["flake_grid"] = flakes;
  render::Warnings warnings;
  return render::Scene::load(ODIS_TEST_DATA "/media/" + name + ".xml", options, warnings);
}

}  // namespace odis::test
