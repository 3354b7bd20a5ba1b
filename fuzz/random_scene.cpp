// Random scenes of everything that a scene can hold, rendered in every way: the input says what is drawn.
// With ODIS_RANDOM_SCENE=FILE the last scene is left in that file.
#include <cstdlib>
#include <iostream>

#include "support/random_scene_check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace odis;
  static const test::SceneFiles files(ODIS_SOURCE);
  static const char* const kept = std::getenv("ODIS_RANDOM_SCENE");
  test::Draws draws(bytes, size);
  const std::string text = test::RandomScene(draws, files).text();
  if (kept) std::ofstream(kept) << text;
  try {
    const std::string failure = test::failureOfScene(files.scene(text));
    if (failure.empty()) return 0;
    std::cerr << failure << '\n' << text << '\n';
    std::abort();
  } catch (const render::SceneError&) {
    return -1;
  }
}
