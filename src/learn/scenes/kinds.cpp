#include "learn/scenes/kinds.h"

namespace odis::learn {

std::span<const Kind> kinds() {
  static constexpr Kind kKinds[] = {
      {"room", "a furnished room by lamp light", 14, buildRoom},
      {"window", "a room by daylight, through windows", 15, buildWindow},
      {"doors", "several rooms, doors ajar, light in some", 8, buildDoors},
      {"corridor", "a corridor, light around corners and from doors", 5, buildCorridor},
      {"cove", "light from behind ledges and boards", 5, buildCove},
      {"hidden", "light out of slits, boxes and niches", 4, buildHidden},
      {"lamps", "lampshades, some with little else", 5, buildLamps},
      {"lights", "a hall with up to 5,000 lights", 7, buildLights},
      {"mirrors", "mirrors and polished floors", 4, buildMirrors},
      {"glass", "caustics: glass, water, lights behind glass", 5, buildGlass},
      {"gloss", "glossy things in a studio", 10, buildGloss},
      {"outdoor", "streets, courts, gardens, by day and night", 8, buildOutdoor},
      {"adversarial", "where guiding has nothing to gain", 10, buildAdversarial},
  };
  return kKinds;
}

const Kind* findKind(const std::string& name) {
  for (const Kind& kind : kinds())
    if (name == kind.name) return &kind;
  return nullptr;
}

}  // namespace odis::learn
