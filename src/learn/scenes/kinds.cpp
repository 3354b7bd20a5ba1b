#include "learn/scenes/kinds.h"

namespace odis::learn {

std::span<const Kind> kinds() {
  static constexpr Kind kKinds[] = {
      {"room", "a furnished room by lamp light", 11, buildRoom},
      {"window", "a room by daylight, through windows", 15, buildWindow},
      {"doors", "several rooms, doors ajar, light in some", 11, buildDoors},
      {"corridor", "a corridor, light around corners and from doors", 6, buildCorridor},
      {"cove", "light from behind ledges and boards", 7, buildCove},
      {"hidden", "light out of slits, boxes and niches", 6, buildHidden},
      {"lamps", "lampshades, some with little else", 6, buildLamps},
      {"lights", "a hall with up to 5,000 lights", 6, buildLights},
      {"mirrors", "mirrors and polished floors", 4, buildMirrors},
      {"glass", "caustics: glass, water, lights behind glass", 5, buildGlass},
      {"gloss", "glossy things in a studio", 4, buildGloss},
      {"outdoor", "streets, courts, gardens, by day and night", 6, buildOutdoor},
      {"adversarial", "where guiding has nothing to gain", 13, buildAdversarial},
  };
  return kKinds;
}

const Kind* findKind(const std::string& name) {
  for (const Kind& kind : kinds())
    if (name == kind.name) return &kind;
  return nullptr;
}

}  // namespace odis::learn
