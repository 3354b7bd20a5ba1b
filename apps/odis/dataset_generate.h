// odis dataset generate
#pragma once

#include "command.h"

namespace odis::app {

Command addDatasetGenerate(CLI::App& parent);

}  // namespace odis::app
