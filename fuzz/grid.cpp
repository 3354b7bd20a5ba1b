// Volumes on grids: bounds that hold, look-ups within and beyond the grid, microflakes.
#include "memory_file.h"
#include "render/medium/grid_volume.h"
#include "render/scene/builder.h"

namespace {

using namespace odis::render;

// Values may be as large as a float can be: what is between two of them need not be finite.
bool isModerate(const Volume& volume) {
  const Rgb most = volume.greatest(), least = volume.least();
  for (int channel = 0; channel < 3; ++channel)
    if (std::max(most[channel], -least[channel]) > 1e30f) return false;
  return true;
}

void lookUp(const Volume& volume, const VolumeMaxima& maxima, const Vec3& p) {
  const Rgb value = volume.rgb(p);
  volume.six(p);
  if (!std::isfinite(value.x + value.y + value.z) && isModerate(volume)) std::abort();
  if (std::min({p.x, p.y, p.z}) < 0 || std::max({p.x, p.y, p.z}) >= 1 || !isModerate(volume)) return;
  size_t box = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const uint32_t n = maxima.size[size_t(axis)];
    box = box * n + std::min(uint32_t(p[axis] * float(n)), n - 1);
  }
  if (maxComponent(value) > maxima.values.at(box)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const odis::fuzz::MemoryFile file(bytes, size);
  try {
    GridOptions options;
    options.nearest = size % 2 == 1;
    options.onBorder = size / 2 % 2 == 1;
    options.wrap = std::array{WrapMode::clamp, WrapMode::repeat, WrapMode::mirror}[size / 4 % 3];
    const VolumePtr volume = makeGrid(readVolumeFile(file.path(), {}), options);
    const VolumeMaxima maxima = volume->maxima();
    for (int i = 0; i < 64; ++i) {
      const Vec3 inside(float(i % 4) / 4 + 0.1f, float(i / 4 % 4) / 4, float(i / 16) / 4 + 0.2f);
      lookUp(*volume, maxima, inside);
      lookUp(*volume, maxima, (inside - Vec3(0.5f)) * 9.0f);
    }
    lookUp(*volume, maxima, Vec3(1e30f, NAN, -INFINITY));
  } catch (const SceneError&) {
  }
  return 0;
}
