#include "odis/api/vertices.h"

#include <bit>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "odis/api/guard.h"
#include "odis/record/vertex_fields.h"

namespace odis::core {

namespace {

// One field of a vertex, in both ways of describing vertices.
struct FieldPair {
  const char* name;
  OdisVertexField OdisPathVertices::*described;
  size_t offset, bytes;  // within OdisPathVertex
  bool isFloat;
};

template <class Type>
constexpr bool kIsFloat = std::is_same_v<Type, float> || std::is_same_v<Type, Float3>;

#define ODIS_FIELD(NAME)                                                                         \
  {#NAME, &OdisPathVertices::NAME, offsetof(OdisPathVertex, NAME), sizeof(OdisPathVertex::NAME), \
   kIsFloat<decltype(OdisPathVertex::NAME)>},
constexpr FieldPair kFields[] = {ODIS_VERTEX_FIELDS(ODIS_FIELD)};
#undef ODIS_FIELD

float halfToFloat(uint16_t half) {
  const uint32_t sign = uint32_t(half & 0x8000u) << 16, exponent = (half >> 10) & 31u,
                 mantissa = half & 0x3ffu;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000u | mantissa << 13);
  const float value = exponent == 0 ? float(mantissa) * 0x1p-24f
                                    : std::bit_cast<float>((exponent + 112) << 23 | mantissa << 13);
  return std::bit_cast<float>(std::bit_cast<uint32_t>(value) | sign);
}

// The field of a vertex that is made of numbers of 16 bits.
void copyHalves(void* to, const void* from, size_t floats) {
  for (size_t i = 0; i < floats; ++i) {
    uint16_t half;
    std::memcpy(&half, static_cast<const char*>(from) + i * sizeof half, sizeof half);
    const float value = halfToFloat(half);
    std::memcpy(static_cast<char*>(to) + i * sizeof value, &value, sizeof value);
  }
}

// The distance in bytes of a field's numbers for neighbouring vertices.
size_t checkedStride(const FieldPair& pair, const OdisVertexField& field, size_t count) {
  const bool half = field.format == ODIS_FORMAT_HALF;
  const size_t bytes = half ? pair.bytes / 2 : pair.bytes;
  const size_t stride = field.stride == 0 ? bytes : field.stride;
  const auto refuse = [&](const std::string& expected) {
    throw std::invalid_argument("OdisPathVertices." + std::string(pair.name) + ": expected " + expected);
  };
  if (!half && field.format != ODIS_FORMAT_DEFAULT) refuse("a format of OdisFormat");
  if (half && !pair.isFloat) refuse("no half floats for whole numbers");
  if (stride < bytes) refuse("a stride of at least " + std::to_string(bytes) + " bytes");
  if (count > PTRDIFF_MAX / stride) refuse("an array that memory can hold");
  return stride;
}

// The array of OdisPathVertex that is described; null if it is something else.
const PathVertex* asArray(const OdisPathVertices& described) {
  const char* begin = static_cast<const char*>(described.position.data);
  if (reinterpret_cast<uintptr_t>(begin) % alignof(PathVertex) != 0) return nullptr;
  for (const FieldPair& pair : kFields) {
    const OdisVertexField& field = described.*pair.described;
    if (field.data != begin + pair.offset || field.stride != sizeof(PathVertex) ||
        field.format != ODIS_FORMAT_DEFAULT)
      return nullptr;
  }
  return reinterpret_cast<const PathVertex*>(begin);
}

}  // namespace

HostVertices::HostVertices(const OdisPathVertices* given) {
  if (!given) return;
  const OdisPathVertices described = adopt(*given, "OdisPathVertices");
  if (described.count == 0) return;
  requireArgument(described.position.data, "OdisPathVertices.position");
  m_size = described.count;
  if (const PathVertex* array = asArray(described)) {
    m_array = {array, m_size};
    return;
  }
  for (const FieldPair& pair : kFields) {
    const OdisVertexField& field = described.*pair.described;
    if (!field.data) continue;
    const Run run{static_cast<const char*>(field.data), checkedStride(pair, field, described.count),
                  pair.offset, pair.bytes, field.format == ODIS_FORMAT_HALF};
    addRun(run);
    if (pair.offset == offsetof(PathVertex, pixel)) m_pixel = run;
    if (pair.offset == offsetof(PathVertex, sample)) m_sample = run;
    if (pair.offset == offsetof(PathVertex, depth)) m_depth = run;
  }
}

// Adds a field, as a part of the last run where it lies behind that.
void HostVertices::addRun(const Run& run) {
  if (!m_runs.empty()) {
    Run& last = m_runs.back();
    if (last.data + last.bytes == run.data && last.offset + last.bytes == run.offset &&
        last.stride == run.stride && !last.half && !run.half) {
      last.bytes += run.bytes;
      return;
    }
  }
  m_runs.push_back(run);
}

VertexIdentity HostVertices::identity(size_t i) const {
  if (!m_array.empty()) return identityOf(m_array[i]);
  VertexIdentity identity = identityOf(PathVertex());
  if (m_pixel.data) std::memcpy(&identity.pixel, m_pixel.at(i), sizeof identity.pixel);
  if (m_sample.data) std::memcpy(&identity.sample, m_sample.at(i), sizeof identity.sample);
  if (m_depth.data) std::memcpy(&identity.depth, m_depth.at(i), sizeof identity.depth);
  return identity;
}

void HostVertices::copy(size_t i, PathVertex& vertex) const {
  if (!m_array.empty()) {
    vertex = m_array[i];
    return;
  }
  for (const Run& run : m_runs) {
    char* to = reinterpret_cast<char*>(&vertex) + run.offset;
    // Most fields are a number or a vector, which is quick where the compiler knows the size.
    if (run.half)
      copyHalves(to, run.at(i), run.bytes / sizeof(float));
    else if (run.bytes == sizeof(float))
      std::memcpy(to, run.at(i), sizeof(float));
    else if (run.bytes == sizeof(Float3))
      std::memcpy(to, run.at(i), sizeof(Float3));
    else
      std::memcpy(to, run.at(i), run.bytes);
  }
}

ArrayView<const PathVertex> HostVertices::view() {
  if (m_array.size() == m_size) return m_array;
  if (m_copies.empty()) {
    std::vector<PathVertex> copies(m_size);
    for (size_t i = 0; i < m_size; ++i) copy(i, copies[i]);
    m_copies = std::move(copies);
  }
  return m_copies;
}

}  // namespace odis::core

void odisInitPathVertex(OdisPathVertex* vertex, size_t size) {
  odis::core::initialize(vertex, size, "OdisPathVertex");
}
void odisInitPathVertices(OdisPathVertices* vertices, size_t size) {
  odis::core::initialize(vertices, size, "OdisPathVertices");
}
void odisDescribeVertices(OdisPathVertices* vertices, const OdisPathVertex* array, size_t count) {
  odis::core::guarded(nullptr, false, [&] {
    odis::core::requireArgument(vertices, "odisDescribeVertices: vertices");
    if (count > 0) odis::core::requireArgument(array, "odisDescribeVertices: array");
    OdisPathVertices described;
    described.count = count;
    for (const odis::core::FieldPair& pair : odis::core::kFields)
      described.*pair.described = {reinterpret_cast<const char*>(array) + pair.offset, sizeof(OdisPathVertex),
                                   ODIS_FORMAT_DEFAULT};
    odis::core::fillIn(*vertices, described, "OdisPathVertices");
    return true;
  });
}
