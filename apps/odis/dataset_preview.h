// odis dataset preview
#pragma once

#include "command.h"

namespace odis::app {

Command addDatasetPreview(CLI::App& parent);

}  // namespace odis::app
