// Reads Mitsuba's volumes, version 3: "VOL", the version (uint8), the type of values (int32, 1: float32), the
// size along x, y and z and the number of channels (int32), a box (six float32, which nothing here asks for)
// and the values, x fastest. All is little-endian.
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "render/shape/file_bytes.h"
#include "render/shape/sdf_grid.h"

namespace odis::render {

DistanceGrid readVolume(const std::string& path, const SourceLocation& at) {
  const FileBytes file(path, at);
  const std::string_view bytes = file.view();
  const SourceLocation here{path, 0, 0};
  constexpr size_t kHeader = 48;
  if (bytes.substr(0, 3) != "VOL")
    throw SceneError(here, "found no volume, expected one, which begins with \"VOL\"");
  if (bytes.size() < kHeader) throw SceneError(here, "the volume ends too early, in its header");
  const int version = static_cast<uint8_t>(bytes[3]);
  int32_t header[5];  // type, sizes, channels
  std::memcpy(header, bytes.data() + 4, sizeof(header));
  if (version != 3) throw SceneError(here, fmt::format("found a volume of version {}, expected 3", version));
  if (header[0] != 1)
    throw SceneError(here, fmt::format("found values of type {}, expected 1 (float32)", header[0]));
  if (header[4] != 1) throw SceneError(here, fmt::format("found {} channels, expected 1", header[4]));

  DistanceGrid grid;
  uint64_t room = (bytes.size() - kHeader) / sizeof(float), count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int32_t size = header[1 + axis];
    if (size < 2 || count > room / uint64_t(size))
      throw SceneError(here, fmt::format("found a grid of {} x {} x {} values, expected at least 2 along "
                                         "each axis and no more than the {} in the file",
                                         header[1], header[2], header[3], room));
    grid.size[axis] = uint32_t(size);
    count *= uint64_t(size);
  }
  grid.values.resize(count);
  std::memcpy(grid.values.data(), bytes.data() + kHeader, count * sizeof(float));
  for (const float value : grid.values)
    if (!std::isfinite(value)) throw SceneError(here, "the volume holds values that aren't finite");
  return grid;
}

}  // namespace odis::render
