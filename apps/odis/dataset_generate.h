// odis dataset generate
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace odis::app {

// Adds the sub-command; what is returned runs it.
struct Generator {
  CLI::App* app;
  std::function<int()> run;
};
Generator addDatasetGenerate(CLI::App& parent);

}  // namespace odis::app
