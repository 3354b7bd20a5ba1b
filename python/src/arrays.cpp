#include <odis/types.h>

#include "arrays.h"

namespace odis::python {

namespace {

std::string shapeText(size_t dimensions, const int64_t* shape) {
  std::string text = "(";
  for (size_t i = 0; i < dimensions; ++i)
    text += std::to_string(shape[i]) + (dimensions == 1 ? "," : i + 1 < dimensions ? ", " : "");
  return text + ")";
}

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

}  // namespace

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

}  // namespace odis::python
