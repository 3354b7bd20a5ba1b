// From a seed to a folder with a scene.
#pragma once

#include <functional>
#include <string>

#include "learn/scenes/kinds.h"

namespace odis::learn {

// A folder that holds what was made with other options than what is to be made.
class GenerateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The kind of the scene of this seed, by the kinds' shares.
const Kind& kindOf(uint64_t seed);
// "000123-window": the folder of a scene.
std::string sceneName(uint64_t seed, const Kind& kind);

// Writes the scene into `folder`/sceneName(), a function of seed, kind and assets alone: scene.xml and
// scene-b.xml (its two views), content.xml, scene.json (what was drawn), meshes and textures. Made under a
// temporary name; what is there already stays as it is, if it was made of the same assets, else
// GenerateError. Returns whether it was made. Throws WriteError, std::filesystem::filesystem_error.
bool generateScene(uint64_t seed, const Kind& kind, const Assets& assets, const std::string& folder);
// Throws the GenerateError that generateScene would; makes nothing.
void checkScene(uint64_t seed, const Kind& kind, const Assets& assets, const std::string& folder);

}  // namespace odis::learn
