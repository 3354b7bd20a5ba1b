// constvolume: the same value everywhere.
//
//   value   1   number or colour
//
// A colour or a number in place of a volume means the same.
#include "render/medium/constant_volume.h"
#include "render/medium/volume_factories.h"

namespace odis::render {

VolumePtr makeConstantVolume(const Properties& node, Builder&) {
  return std::make_shared<ConstantVolume>(node.color("value", kAnyNumber, Rgb(1.0f)));
}

}  // namespace odis::render
