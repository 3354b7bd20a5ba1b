// Options of the core from those of a host.
#pragma once

#include "odis/options/options.h"

namespace odis::core {

// Throw std::invalid_argument.
FrameOptions optionsOf(const OdisFrameOptions& given);
GuideOptions optionsOf(const OdisGuideOptions& given);

}  // namespace odis::core
