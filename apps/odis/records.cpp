#include "records.h"

#include <fmt/format.h>

#include <cstddef>

#include "render/files/replace_file.h"

namespace odis::app {

using namespace render;

namespace {

struct Field {
  const char* name;
  const char* format;  // of NumPy
  size_t offset, bytes;
  bool triple = false;
};

#define ODIS_FIELD(name, format) \
  { #name, format, offsetof(PathVertex, name), sizeof(PathVertex::name) }
#define ODIS_TRIPLE(name) \
  { #name, "<f4", offsetof(PathVertex, name), sizeof(PathVertex::name), true }
constexpr Field kFields[] = {
    ODIS_TRIPLE(position),
    ODIS_TRIPLE(normal),
    ODIS_TRIPLE(wo),
    ODIS_TRIPLE(wi),
    ODIS_TRIPLE(radiance),
    ODIS_TRIPLE(weight),
    ODIS_TRIPLE(direct),
    ODIS_FIELD(pdf, "<f4"),
    ODIS_FIELD(survival, "<f4"),
    ODIS_FIELD(guidablePdf, "<f4"),
    ODIS_FIELD(guidableProbability, "<f4"),
    ODIS_FIELD(distance, "<f4"),
    ODIS_FIELD(roughness, "<f4"),
    ODIS_FIELD(cosine, "<f4"),
    ODIS_FIELD(indirect, "<f4"),
    ODIS_FIELD(emission, "<f4"),
    ODIS_FIELD(emissionLightPdf, "<f4"),
    ODIS_FIELD(light, "<f4"),
    ODIS_TRIPLE(lightDirection),
    ODIS_FIELD(lightPdf, "<f4"),
    ODIS_FIELD(lightBsdfPdf, "<f4"),
    ODIS_FIELD(lightGuidablePdf, "<f4"),
    ODIS_FIELD(raysAfter, "<f4"),
    ODIS_FIELD(lightGroupProbability, "<f4"),
    ODIS_FIELD(lightGroup, "<u4"),
    ODIS_FIELD(lightableGroups, "<u4"),
    ODIS_FIELD(sampleWeight, "<f4"),
    ODIS_FIELD(time, "<f4"),
    ODIS_FIELD(pixel, "<u4"),
    ODIS_FIELD(sample, "<u4"),
    ODIS_FIELD(depth, "<u2"),
    ODIS_FIELD(discrete, "|b1"),
    ODIS_FIELD(scattersBothSides, "|b1"),
};
#undef ODIS_FIELD
#undef ODIS_TRIPLE

// Whether the fields, in this order, are all that a PathVertex holds.
constexpr bool fieldsFillTheRecord() {
  size_t end = 0;
  for (const Field& field : kFields) {
    if (field.offset != end) return false;
    end += field.bytes;
  }
  return end == sizeof(PathVertex);
}
static_assert(fieldsFillTheRecord());

// The header's dictionary, padded so that the data starts at a multiple of 64 bytes.
std::string header(size_t count) {
  std::string fields;
  for (const Field& field : kFields)
    fields += fmt::format("('{}', '{}'{}), ", field.name, field.format, field.triple ? ", (3,)" : "");
  std::string text =
      fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}", fields, count);
  while ((10 + text.size() + 1) % 64 != 0) text += ' ';
  return text + '\n';
}

}  // namespace

void writeRecords(const std::string& path, const std::vector<PathVertex>& vertices) {
  replaceFile(path, [&](CheckedStream& file) {
    const std::string text = header(vertices.size());
    const char start[10] = {
        '\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0, char(text.size() & 0xff), char(text.size() >> 8)};
    file.write(start, sizeof start);
    file.write(text.data(), text.size());
    file.write(reinterpret_cast<const char*>(vertices.data()), vertices.size() * sizeof(PathVertex));
  });
}

}  // namespace odis::app
