// Reads Mitsuba's volumes, version 3: "VOL", the version (uint8), the type of values (int32; 1: float32, and
// of Mitsuba 0.6 2: float16, 3: uint8), the size along x, y and z and the number of channels (int32), a box
// (six float32) and the values. All is little-endian.
#include "render/medium/volume_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "render/shape/file_bytes.h"

namespace odis::render {
namespace {

constexpr size_t kHeaderBytes = 48;

template <class T>
std::vector<T> readValues(std::string_view bytes, const VolumeFile& file, const SourceLocation& here) {
  const uint64_t room = bytes.size() / sizeof(T);
  uint64_t count = uint64_t(file.channels);
  for (const int size : file.size) {
    if (size < 1 || count > room / uint64_t(size))
      throw SceneError(here,
                       fmt::format("found a grid of {} x {} x {} values of {} channels, expected at "
                                   "least 1 along each axis and no more than the {} numbers in the file",
                                   file.size[0], file.size[1], file.size[2], file.channels, room));
    count *= uint64_t(size);
  }
  std::vector<T> values(count);
  std::memcpy(static_cast<void*>(values.data()), bytes.data(), count * sizeof(T));
  for (const T value : values)
    if (!std::isfinite(volumeNumber(value)))
      throw SceneError(here, "the volume holds values that aren't finite");
  return values;
}

}  // namespace

VolumeFile readVolumeFile(const std::string& path, const SourceLocation& at) {
  const FileBytes content(path, at);
  const std::string_view bytes = content.view();
  const SourceLocation here{path, 0, 0};
  if (bytes.substr(0, 3) != "VOL")
    throw SceneError(here, "found no volume, expected one, which begins with \"VOL\"");
  if (bytes.size() < kHeaderBytes) throw SceneError(here, "the volume ends too early, in its header");
  const int version = static_cast<uint8_t>(bytes[3]);
  if (version != 3) throw SceneError(here, fmt::format("found a volume of version {}, expected 3", version));
  int32_t header[5];  // type, sizes, channels
  float box[6];
  std::memcpy(header, bytes.data() + 4, sizeof(header));
  std::memcpy(box, bytes.data() + 24, sizeof(box));

  VolumeFile file;
  file.size = {header[1], header[2], header[3]};
  file.channels = header[4];
  file.boxMin = {box[0], box[1], box[2]};
  file.boxMax = {box[3], box[4], box[5]};
  if (file.channels != 1 && file.channels != 3 && file.channels != 6)
    throw SceneError(here, fmt::format("found {} channels, expected 1, 3 or 6", file.channels));
  const std::string_view values = bytes.substr(kHeaderBytes);
  if (header[0] == 1)
    file.values = readValues<float>(values, file, here);
  else if (header[0] == 2)
    file.values = readValues<half>(values, file, here);
  else if (header[0] == 3)
    file.values = readValues<uint8_t>(values, file, here);
  else
    throw SceneError(here, fmt::format("found values of type {}, expected 1 (float32), 2 (float16) or 3 "
                                       "(uint8)",
                                       header[0]));
  return file;
}

}  // namespace odis::render
