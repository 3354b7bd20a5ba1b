// Plain types of the public interface: no dependency on any vector library.
#pragma once

#include <cmath>
#include <cstdint>

namespace odis {

struct Float3 {
  float x = 0, y = 0, z = 0;
};

inline Float3 operator+(const Float3& a, const Float3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Float3 operator-(const Float3& a, const Float3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Float3 operator*(const Float3& a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline float dot(const Float3& a, const Float3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace odis
