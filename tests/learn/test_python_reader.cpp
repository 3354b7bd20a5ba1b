// A shard with known numbers for python/odis/dataset.py to read.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "learn/data/make_shard.h"
#include "support/temporary_folder.h"

namespace odis::learn {
namespace {

nlohmann::ordered_json toJson(const Float3& v) {
  return {v.x, v.y, v.z};
}

TEST(PythonReader, ReadsWhatIsWritten) {
#ifndef ODIS_PYTHON
  GTEST_SKIP() << "there is no Python with numpy and zstandard";
#else
  const ViewFrame frame{{-1, 2, 0.5f}, 0.25f, 3};
  ShardWriter writer;
  nlohmann::ordered_json arrays = nlohmann::ordered_json::object();
  const auto add = [&]<class T>(const std::string& name, const Shape& shape, const std::vector<T>& values) {
    writer.add(name, shape, std::span<const T>(values));
    arrays[name] = nlohmann::ordered_json::array();
    for (const T value : values) arrays[name].push_back(double(value));
  };
  add("u1", {2, 3}, std::vector<uint8_t>{0, 1, 2, 127, 128, 255});
  add("u2", {4}, std::vector<uint16_t>{0, 258, 32768, 65535});
  add("u4", {1, 3}, std::vector<uint32_t>{0, 16909060, 4294967295u});
  add("i4", {2, 1, 2}, std::vector<int32_t>{-2147483647, -1, 0, 66051});
  add("f2", {5}, std::vector<Half>{Half(0.1f), Half(-65504.0f), Half(6e-8f), Half(0.0f), Half(1.0f)});
  add("empty", {3, 0}, std::vector<Half>());

  // Three paths: of no vertex, of two, of one.
  Pilot pilot;
  pilot.lengths = {0, 2, 1};
  pilot.sampleWeight = {1, 1, 1};
  pilot.image.assign(3, render::Rgb(3));
  pilot.vertices.resize(3);
  const Float3 wi[] = {{0.6f, 0, 0.8f}, {0, -0.6f, -0.8f}, {-0.48f, 0.64f, 0.6f}};
  const Float3 wo[] = {{0, 0, 1}, {-0.6f, 0, -0.8f}, {0.64f, -0.48f, -0.6f}};
  for (size_t i = 0; i < 3; ++i) {
    PathVertex& v = pilot.vertices[i];
    v.position = {float(i) - 1.37f, 0.11f * float(i), -12.3f};
    v.normal = wi[(i + 1) % 3];
    v.wi = wi[i];
    v.wo = wo[i];
  }
  addColumns(writer, pilotPrefix(0, 0), pilot, frame);
  nlohmann::ordered_json expected = {{"arrays", arrays}};
  for (const char* name : {"position", "normal", "wi", "wo"})
    expected[name] = nlohmann::ordered_json::array();
  for (const PathVertex& v : pilot.vertices) {
    expected["position"].push_back(toJson(v.position));
    expected["normal"].push_back(toJson(v.normal));
    expected["wi"].push_back(toJson(v.wi));
    expected["wo"].push_back(toJson(v.wo));
  }
  const nlohmann::ordered_json view = {
      {"origin", toJson(frame.origin)}, {"edge", frame.edge}, {"unit", frame.unit}};
  const odis::test::TemporaryFolder folder;
  writer.write(folder.path("golden.shard"), {{"expected", expected}, {"views", {view}}});
  EXPECT_EQ(std::system(fmt::format("'{}' '{}' --golden '{}'", ODIS_PYTHON, ODIS_PYTHON_TEST,
                                    folder.path("golden.shard"))
                            .c_str()),
            0);
#endif
}

}  // namespace
}  // namespace odis::learn
