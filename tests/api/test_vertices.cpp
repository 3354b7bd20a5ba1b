// Vertices wherever a host keeps them: arrays of structs, arrays of numbers, half floats.
#include "api/api_scene.h"

namespace odis::test {
namespace {

Guide guideOf(const OdisPathVertices& vertices) {
  GuideBuilder builder;
  builder.add(vertices);
  EXPECT_GT(builder.vertexCounts().accepted, 0u);
  return builder.build();
}

// A host's own vertex: other fields, another order, not aligned.
#pragma pack(push, 1)
struct HostVertex {
  char tag;
  double unused;
  uint32_t pixel;
  Float3 wi, position;
  bool twoSided;
  Float3 normal, radiance;
  float pdf;
  uint16_t depth;
};
#pragma pack(pop)

std::vector<HostVertex> hostVertices() {
  std::vector<HostVertex> vertices;
  for (const OdisPathVertex& v : apiVertices())
    vertices.push_back({'v', 0, v.pixel, v.wi, v.position, true, v.normal, v.radiance, v.pdf, v.depth});
  return vertices;
}

OdisPathVertices describeHost(const std::vector<HostVertex>& vertices) {
  OdisPathVertices described;
  const HostVertex* first = vertices.data();
  const auto field = [](const void* data) { return OdisVertexField{data, sizeof(HostVertex), {}}; };
  described.count = vertices.size();
  described.position = field(&first->position);
  described.normal = field(&first->normal);
  described.wi = field(&first->wi);
  described.radiance = field(&first->radiance);
  described.pdf = field(&first->pdf);
  described.pixel = field(&first->pixel);
  described.depth = field(&first->depth);
  described.scattersBothSides = field(&first->twoSided);
  return described;
}

// The same vertices as the library's struct, all other fields at their defaults.
std::vector<OdisPathVertex> plainVertices() {
  std::vector<OdisPathVertex> vertices;
  for (const OdisPathVertex& v : apiVertices()) {
    OdisPathVertex plain;
    plain.position = v.position;
    plain.normal = v.normal;
    plain.wi = v.wi;
    plain.radiance = v.radiance;
    plain.pdf = v.pdf;
    plain.pixel = v.pixel;
    plain.depth = v.depth;
    plain.scattersBothSides = true;
    vertices.push_back(plain);
  }
  return vertices;
}

TEST(ApiVertices, StructsOfTheHostGiveTheSameGuide) {
  const std::vector<OdisPathVertex> plain = plainVertices();
  const std::vector<HostVertex> own = hostVertices();
  EXPECT_TRUE(sameBits(guideOf(describe(plain)).view(), guideOf(describeHost(own)).view()));
}

TEST(ApiVertices, ArraysOfNumbersGiveTheSameGuide) {
  const std::vector<OdisPathVertex> plain = plainVertices();
  std::vector<Float3> position, normal, wi, radiance;
  std::vector<float> pdf;
  std::vector<uint32_t> pixel;
  std::vector<uint16_t> depth;
  const std::vector<char> twoSided(plain.size(), 1);
  for (const OdisPathVertex& v : plain) {
    position.push_back(v.position);
    normal.push_back(v.normal);
    wi.push_back(v.wi);
    radiance.push_back(v.radiance);
    pdf.push_back(v.pdf);
    pixel.push_back(v.pixel);
    depth.push_back(v.depth);
  }
  OdisPathVertices described;
  described.count = plain.size();
  described.position.data = position.data();
  described.normal.data = normal.data();
  described.wi.data = wi.data();
  described.radiance.data = radiance.data();
  described.pdf.data = pdf.data();
  described.pixel.data = pixel.data();
  described.depth.data = depth.data();
  described.scattersBothSides.data = twoSided.data();
  EXPECT_TRUE(sameBits(guideOf(describe(plain)).view(), guideOf(described).view()));
}

// Halves that floats of the same value are compared with: normals, subnormal numbers, infinity.
TEST(ApiVertices, HalfFloatsAreTheFloatsThatTheyStandFor) {
  const uint16_t halves[] = {0x3c00, 0x3800, 0xbc00, 0x4248, 0x0001, 0x03ff, 0x7bff, 0x0400, 0x0000};
  const float floats[] = {1, 0.5f, -1, 3.140625f, 0x1p-24f, 0x1.ff8p-15f, 65504, 0x1p-14f, 0};
  std::vector<OdisPathVertex> plain;
  std::vector<uint16_t> radiance;
  for (size_t i = 0; i < std::size(halves); ++i)
    for (int copy = 0; copy < 40; ++copy) {
      plain.push_back(plainVertices()[plain.size()]);
      plain.back().radiance = {floats[i], floats[i], floats[i]};
      for (int c = 0; c < 3; ++c) radiance.push_back(halves[i]);
    }
  OdisPathVertices described = describe(plain);
  described.radiance = {radiance.data(), 0, ODIS_FORMAT_HALF};
  EXPECT_TRUE(sameBits(guideOf(describe(plain)).view(), guideOf(described).view()));
}

TEST(ApiVertices, WhatCannotBeIsRefusedByName) {
  const std::vector<OdisPathVertex> plain = plainVertices();
  GuideBuilder builder;
  const auto expectRefused = [&](const OdisPathVertices& described, const std::string& part) {
    EXPECT_FALSE(odisAddVertices(builder.get(), &described, false));
    std::string message;
    EXPECT_EQ(takeError(&message), ODIS_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  OdisPathVertices bad = describe(plain);
  bad.normal.stride = 11;
  expectRefused(bad, "normal: expected a stride of at least 12");
  bad = describe(plain);
  bad.pdf.format = 7;
  expectRefused(bad, "pdf: expected a format");
  bad = describe(plain);
  bad.pixel.format = ODIS_FORMAT_HALF;
  expectRefused(bad, "pixel: expected no half floats");
  bad = describe(plain);
  bad.position.data = nullptr;
  expectRefused(bad, "position: found NULL");
  bad = describe(plain);
  bad.size = 3;
  expectRefused(bad, "found a size of 3");
  bad = describe(plain);
  bad.size = sizeof bad + 8;
  expectRefused(bad, "found a size of");
  bad = describe(plain);
  bad.count = SIZE_MAX / 2;
  bad.position.stride = 16;
  EXPECT_FALSE(odisAddVertices(builder.get(), &bad, false));
  EXPECT_NE(takeError(), ODIS_ERROR_NONE);
  EXPECT_EQ(builder.vertexCounts().accepted, 0u);
}

// A host that was compiled when structs had fewer fields: those that it does not know have their defaults.
TEST(ApiVertices, ShorterStructsAreThoseOfOlderHosts) {
  OdisFrameOptions options;
  options.width = 7;
  options.samplesPerPixel = 0;  // beyond what the host knows
  options.height = 5;
  options.size = offsetof(OdisFrameOptions, samplesPerPixel);
  const OdisFrame frame = odisNewFrame(Context::shared().get(), &options);
  EXPECT_NE(frame, nullptr) << "samplesPerPixel was read";
  OdisFrameStatistics statistics;
  statistics.size = offsetof(OdisFrameStatistics, cells);
  statistics.cells = 77;
  EXPECT_TRUE(odisGetFrameStatistics(frame, &statistics));
  EXPECT_EQ(statistics.cells, 77u) << "a field was written that the host does not know";
  odisReleaseFrame(frame);
}

}  // namespace
}  // namespace odis::test
