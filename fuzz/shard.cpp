// Shards of data sets: as they are, and with a header whose CRC-32 is made right, so that damage gets
// behind it.
#include <cstring>

#include "learn/data/dataset_info.h"
#include "learn/data/make_shard.h"

namespace {

using namespace odis::learn;

// More than a target of small inputs needs to unpack.
constexpr uint64_t kMostElements = 1 << 20;

bool isSmall(const ShardReader& shard) {
  for (const auto& [name, bytes] : shard.arrays()) {
    uint64_t count = 1;
    for (const uint64_t n : shard.shape(name)) count *= n;
    if (count > kMostElements) return false;
  }
  return true;
}

void readAll(const std::string& bytes) {
  try {
    const ShardReader shard("fuzz.shard", bytes);
    shardText(shard);
    if (!isSmall(shard)) return;
    shard.verify();
    const ViewFrame frame{{0, 0, 0}, 1, 1};
    const Pilot pilot = readColumns(shard, pilotPrefix(0, 0), frame);
    if (pilot.image.size() != pilot.lengths.size()) std::abort();
    for (const Target& target : readTargets(shard, targetPrefix(0), frame))
      if (target.rays.size() != size_t(kTargetTexels)) std::abort();
  } catch (const ShardError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  readAll(bytes);
  uint32_t length;
  if (size < 20) return 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  if (length > size - 20) return 0;
  const uint32_t crc = crc32(std::string_view(bytes).substr(20, length));
  std::memcpy(bytes.data() + 16, &crc, 4);
  readAll(bytes);
  return 0;
}
