// Between Open PGL's vectors and ODIS's.
#pragma once

#include <odis/odis.hpp>

#include "openpgl/openpgl.h"

namespace odis::openpgl_interface {

// The flags that version 0.4 or a later one gives samples in volumes.
inline constexpr uint32_t kVolumeFlags = 3;

inline Float3 toOdis(const pgl_vec3f& v) {
  return {v.x, v.y, v.z};
}
inline pgl_vec3f fromOdis(const Float3& v) {
  return {v.x, v.y, v.z};
}
inline uint32_t flagsOf(const PathVertex& vertex) {
  return isInMedium(vertex) ? PGLSampleData::EInsideVolume : 0;
}
inline float meanOf(const Float3& v) {
  return (v.x + v.y + v.z) / 3;
}

}  // namespace odis::openpgl_interface
