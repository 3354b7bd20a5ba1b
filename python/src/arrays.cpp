#include <odis/types.h>

#include <cmath>
#include <limits>

#include "numbers.h"

namespace odis::python {

namespace {

std::string shapeText(size_t dimensions, const int64_t* shape) {
  std::string text = "(";
  for (size_t i = 0; i < dimensions; ++i)
    text += std::to_string(shape[i]) + (dimensions == 1 ? "," : i + 1 < dimensions ? ", " : "");
  return text + ")";
}

}  // namespace

std::string typeName(nb::dlpack::dtype type) {
  using Code = nb::dlpack::dtype_code;
  const std::string bits = std::to_string(type.bits);
  switch (Code(type.code)) {
    case Code::Int:
      return "int" + bits;
    case Code::UInt:
      return "uint" + bits;
    case Code::Float:
      return "float" + bits;
    case Code::Bfloat:
      return "bfloat" + bits;
    case Code::Complex:
      return "complex" + bits;
    case Code::Bool:
      return "bool";
    default:
      return "another type";
  }
}

std::string describe(const Array& array) {
  return typeName(array.dtype()) + " of shape " + shapeText(array.ndim(), array.shape_ptr());
}

void refuseArray(const char* name, const std::string& expected, const std::string& found) {
  throw nb::value_error((std::string(name) + ": expected " + expected + ", found " + found).c_str());
}

void requireArray(const Array& array, const char* name, nb::dlpack::dtype type, size_t columns,
                  size_t count) {
  const int device = array.device_type();
  if (device != nb::device::cpu::value && device != nb::device::cuda_host::value)
    refuseArray(name, "an array in the CPU's memory", "one on another device");
  const bool fits = array.dtype() == type && array.ndim() == (columns > 0 ? 2 : 1) &&
                    (count == kAnyCount || array.shape(0) == count) &&
                    (columns == 0 || array.shape(1) == columns);
  if (fits) return;
  std::string shape = count == kAnyCount ? "count" : std::to_string(count);
  shape += ',';
  if (columns > 0) shape.append(1, ' ').append(std::to_string(columns));
  refuseArray(name, typeName(type) + " of shape (" + shape + ")", describe(array));
}

namespace {

template <class Stored>
double storedIn(const Array& array) {
  Stored value;
  std::memcpy(&value, array.data(), sizeof value);
  return double(value);
}

// The number in an array without dimensions, or nothing where it is of another type than these.
std::optional<double> anyNumberIn(const Array& array) {
  const nb::dlpack::dtype type = array.dtype();
  if (type == nb::dtype<float>()) return storedIn<float>(array);
  if (type == nb::dtype<double>()) return storedIn<double>(array);
  if (type == nb::dtype<int32_t>()) return storedIn<int32_t>(array);
  if (type == nb::dtype<int64_t>()) return storedIn<int64_t>(array);
  if (type == nb::dtype<uint8_t>()) return storedIn<uint8_t>(array);
  if (type == nb::dtype<uint16_t>()) return storedIn<uint16_t>(array);
  if (type == nb::dtype<uint32_t>()) return storedIn<uint32_t>(array);
  if (type == nb::dtype<uint64_t>()) return storedIn<uint64_t>(array);
  return {};
}

}  // namespace

template <class T>
T numberIn(const Array& array, const char* name) {
  if constexpr (std::is_same_v<T, bool>) {
    if (array.dtype() == nb::dtype<T>()) return storedIn<uint8_t>(array) != 0;
  }
  const std::optional<double> number = std::is_same_v<T, bool> ? std::nullopt : anyNumberIn(array);
  const bool fits =
      number && (std::is_floating_point_v<T> || (*number == std::floor(*number) && *number >= 0 &&
                                                 *number <= double(std::numeric_limits<T>::max())));
  if (!fits) refuseArray(name, typeName(nb::dtype<T>()), describe(array));
  return T(*number);
}
template bool numberIn<bool>(const Array&, const char*);
template float numberIn<float>(const Array&, const char*);
template uint16_t numberIn<uint16_t>(const Array&, const char*);
template uint32_t numberIn<uint32_t>(const Array&, const char*);

}  // namespace odis::python
