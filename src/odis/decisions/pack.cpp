#include "odis/decisions/pack.h"

#include "odis/instruction_sets.h"

namespace odis {

ODIS_WIDE SamplingMap pack(const DirectionDistribution& distribution, float floor) {
  Histogram radiance;
  float sum = 0;
  for (int t = 0; t < kMapTexels; ++t)
    sum += radiance[t] = distribution.probability[t] * distribution.perCosine[t];
  float brightest = 0;
  for (float& value : radiance) {
    value = (sum > 0 ? (1 - floor) * value / sum : 0) + floor / kMapTexels;
    brightest = std::max(brightest, value);
  }
  SamplingMap map;
  for (int t = 0; t < kMapTexels; ++t)
    map.texels[t] = uint16_t(std::max(1.0f, 65535 * (radiance[t] / brightest) + 0.5f));
  map.update();
  return map;
}

}  // namespace odis
