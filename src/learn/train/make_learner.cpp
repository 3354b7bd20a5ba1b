#include <dlfcn.h>

#include <cstdlib>

#include "learn/train/learner.h"
#include "render/files/library_error.h"

namespace odis::learn {

namespace {

int numberOfEnvironment(const char* name, int missing) {
  const char* text = std::getenv(name);
  if (!text || !*text) return missing;
  char* end = nullptr;
  const long value = std::strtol(text, &end, 10);
  if (*end || value < 0 || value > 1 << 20)
    throw TrainError(std::string(name) + " is \"" + text + "\", expected a number");
  return int(value);
}

// What the library on libtorch makes. It stays loaded: libtorch does not like to be let go.
template <class Made>
std::unique_ptr<Made> make(const char* function, const TrainConfig& config, const Processes& processes) {
  void* library = dlopen("libodis_learner.so", RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw render::LibraryError(
        render::missingText("libtorch", "`odis train`",
                            "`scripts/setup --train` installs it, then build ODIS again (") +
        dlerror() + ")");
  using Make = Made* (*)(const TrainConfig&, const Processes&);
  const auto maker = reinterpret_cast<Make>(dlsym(library, function));
  if (!maker) throw TrainError("libodis_learner.so is of another version");
  return std::unique_ptr<Made>(maker(config, processes));
}

}  // namespace

Processes processesOfEnvironment() {
  const Processes processes{numberOfEnvironment("RANK", 0), numberOfEnvironment("WORLD_SIZE", 1)};
  if (processes.count < 1 || processes.rank >= processes.count)
    throw TrainError("RANK is " + std::to_string(processes.rank) + ", expected less than WORLD_SIZE, " +
                     std::to_string(processes.count));
  return processes;
}

std::unique_ptr<Learner> makeLearner(const TrainConfig& config, const Processes& processes) {
  return make<Learner>("odisMakeLearner", config, processes);
}

std::unique_ptr<PixelLearner> makePixelLearner(const TrainConfig& config, const Processes& processes) {
  return make<PixelLearner>("odisMakePixelLearner", config, processes);
}

}  // namespace odis::learn
