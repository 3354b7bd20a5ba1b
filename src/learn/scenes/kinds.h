// The kinds of scenes. Each has a file of its own in kinds/.
#pragma once

#include <span>

#include "learn/scenes/draft.h"

namespace odis::learn {

struct Kind {
  const char* name;
  const char* what;
  double share;  // per cent of the scenes
  void (*build)(Draft& draft);
};

std::span<const Kind> kinds();
// Null if there is none of that name.
const Kind* findKind(const std::string& name);

void buildRoom(Draft& draft);
void buildWindow(Draft& draft);
void buildDoors(Draft& draft);
void buildCorridor(Draft& draft);
void buildCove(Draft& draft);
void buildHidden(Draft& draft);
void buildLamps(Draft& draft);
void buildLights(Draft& draft);
void buildMirrors(Draft& draft);
void buildGlass(Draft& draft);
void buildGloss(Draft& draft);
void buildOutdoor(Draft& draft);
void buildAdversarial(Draft& draft);

}  // namespace odis::learn
