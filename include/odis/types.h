// Plain types of the public interface, which depends on no library of vectors.
#pragma once

#include <cstddef>
#include <utility>

#include "odis/number.h"

namespace odis {

// A vector or a colour of numbers.
template <class Real>
struct Vector3 {
  Real x{}, y{}, z{};
};
using Float3 = Vector3<float>;

template <class Real>
ODIS_HOST_DEVICE inline Vector3<Real> operator+(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
ODIS_HOST_DEVICE inline Vector3<Real> operator-(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
ODIS_HOST_DEVICE inline Vector3<Real> operator*(const Vector3<Real>& a, Real s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class Real>
ODIS_HOST_DEVICE inline Vector3<Real> operator*(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class Real>
ODIS_HOST_DEVICE inline Vector3<Real> operator/(const Vector3<Real>& a, Real s) {
  return {a.x / s, a.y / s, a.z / s};
}
template <class Real>
ODIS_HOST_DEVICE inline Real dot(const Vector3<Real>& a, const Vector3<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Whether a vector is zero, as the normals of vertices in media are.
ODIS_HOST_DEVICE inline bool isZero(const Float3& v) {
  return v.x == 0 && v.y == 0 && v.z == 0;
}

// The luminance of a linear colour with the primaries of sRGB.
ODIS_HOST_DEVICE inline float luminance(const Float3& color) {
  return 0.212671f * color.x + 0.715160f * color.y + 0.072169f * color.z;
}

// Elements that lie side by side in somebody else's memory.
template <class T>
class ArrayView {
 public:
  ArrayView() = default;
  ArrayView(T* data, size_t size) : m_data(data), m_size(size) {}
  // From anything that has data() and size(): vectors, arrays, spans.
  template <class Container, class = decltype(static_cast<T*>(std::declval<Container&>().data()))>
  ArrayView(Container&& container) : m_data(container.data()), m_size(container.size()) {}  // NOLINT

  T* data() const { return m_data; }
  size_t size() const { return m_size; }
  bool empty() const { return m_size == 0; }
  T* begin() const { return m_data; }
  T* end() const { return m_data + m_size; }
  T& operator[](size_t i) const { return m_data[i]; }
  ArrayView subview(size_t first, size_t count) const { return {m_data + first, count}; }

 private:
  T* m_data = nullptr;
  size_t m_size = 0;
};

}  // namespace odis
