// Files of weights: as they are, and with a checksum that is made right, so that damage gets behind it.
#include <cstring>

#include "learn/data/shard_file.h"
#include "odis/models/direction_network.h"
#include "odis/models/light_network.h"

namespace {

using namespace odis;

void readAll(std::string_view bytes) {
  try {
    const core::Weights weights = core::Weights::parse("fuzz.weights", bytes);
    const core::DirectionNetwork network(weights);
    const core::CellStatistics cell;
    network.predict({&cell}, nullptr);
    core::LightNetwork(weights).predict({&cell}, nullptr, core::kFewGroups);
  } catch (const core::WeightsError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  readAll(bytes);
  if (size < 4) return 0;
  const uint32_t crc = learn::crc32(std::string_view(bytes).substr(0, size - 4));
  std::memcpy(bytes.data() + size - 4, &crc, 4);
  readAll(bytes);
  return 0;
}
