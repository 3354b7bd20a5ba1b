// What makes a map at a pixel from its neighbourhood: the histogram of its samples, or a network.
#pragma once

#include <memory>

#include "odis/pixels/neighbourhood.h"

namespace odis::core {

// A model is asked for so many maps at once, or fewer.
inline constexpr size_t kPixelBatch = 32;

class PixelModel {
 public:
  virtual ~PixelModel() = default;
  // Which light its maps tell of, and its neighbourhoods must.
  virtual IncidentRadiance radiance() const = 0;
  // The relative radiance of each texel at `count` places, at most kPixelBatch; need not be normalised.
  // Thread-safe.
  virtual void predict(size_t count, const Neighbourhood* seen, const PixelPlace* places,
                       Histogram* result) const = 0;
};

// histogramOf().
std::shared_ptr<const PixelModel> pixelHistogram(IncidentRadiance radiance);

}  // namespace odis::core
