#include <zlib.h>

#include <cstring>

#include "render/shape/mesh_files.h"
#include "shape/support.h"

namespace odis::test {
namespace {

constexpr uint32_t kHasNormals = 1, kHasUvs = 2, kHasColors = 8, kFaceNormals = 16, kSingle = 0x1000,
                   kDouble = 0x2000;

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string result(size, '\0');
  compress(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
           bytes.size());
  result.resize(size);
  return result;
}

// One triangle whose first vertex lies at `x`.
std::string body(uint16_t version, uint32_t flags, double x, uint64_t vertexCount = 3,
                 uint64_t triangleCount = 1) {
  std::string bytes;
  append(bytes, flags);
  if (version == 4) bytes += std::string("name") + '\0';
  append(bytes, vertexCount);
  append(bytes, triangleCount);
  const auto numbers = [&](std::initializer_list<double> values) {
    for (const double value : values) {
      if (flags & kDouble)
        append(bytes, value);
      else
        append(bytes, float(value));
    }
  };
  numbers({x, 0, 0, 1, 0, 0, 0, 1, 0});
  if (flags & kHasNormals) numbers({0, 0, 1, 0, 0, 1, 0, 1, 0});
  if (flags & kHasUvs) numbers({0, 0, 1, 0, 0, 1});
  if (flags & kHasColors) numbers({1, 1, 1, 1, 1, 1, 1, 1, 1});
  for (const uint32_t index : {0, 1, 2}) append(bytes, index);
  return bytes;
}

std::string fileOf(uint16_t version, const std::vector<std::string>& bodies) {
  std::string bytes;
  std::vector<uint64_t> offsets;
  for (const std::string& one : bodies) {
    offsets.push_back(bytes.size());
    append(bytes, uint16_t(0x041C));
    append(bytes, version);
    bytes += deflated(one);
  }
  for (const uint64_t offset : offsets) {
    if (version == 4)
      append(bytes, offset);
    else
      append(bytes, uint32_t(offset));
  }
  append(bytes, uint32_t(offsets.size()));
  return bytes;
}

MeshData parseSerialized(const std::string& bytes, int64_t index = 0) {
  const TemporaryFile file("mesh.serialized", bytes);
  return readSerialized(file.path(), index, {});
}

TEST(Serialized, ReadsBothVersionsAndPrecisions) {
  for (const uint16_t version : {3, 4})
    for (const uint32_t precision : {kSingle, kDouble}) {
      const uint32_t flags = precision | kHasNormals | kHasUvs | kHasColors;
      const std::string bytes = fileOf(
          version,
          {body(version, precision, 5), body(version, flags | kFaceNormals, 7), body(version, flags, 9)});
      const MeshData first = parseSerialized(bytes, 0), second = parseSerialized(bytes, 1),
                     third = parseSerialized(bytes, 2);
      EXPECT_EQ(first.positions[0], Vec3(5, 0, 0));
      EXPECT_TRUE(first.normals.empty() && first.uvs.empty());
      EXPECT_EQ(second.positions[0], Vec3(7, 0, 0));
      EXPECT_TRUE(second.faceNormals);
      EXPECT_FALSE(third.faceNormals);
      EXPECT_EQ(third.positions[0], Vec3(9, 0, 0));
      EXPECT_EQ(third.normals[2], Vec3(0, 1, 0));
      EXPECT_EQ(third.uvs[1], Vec2(1, 0));
      ASSERT_EQ(third.attributes.size(), 1u);
      EXPECT_EQ(third.attributes[0].name, "vertex_color");
      EXPECT_EQ(third.attributes[0].values, std::vector<float>(9, 1.0f));
      EXPECT_EQ(third.triangles[0], (Triangle{0, 1, 2}));
      EXPECT_THROW(parseSerialized(bytes, 3), SceneError);
      EXPECT_THROW(parseSerialized(bytes, -1), SceneError);
    }
}

TEST(Serialized, RefusesDamage) {
  const std::string good = fileOf(4, {body(4, kSingle | kHasNormals, 1)});
  EXPECT_NO_THROW(parseSerialized(good));
  for (size_t size = 0; size < good.size(); ++size)
    EXPECT_THROW(parseSerialized(good.substr(0, size)), SceneError) << size;
  EXPECT_THROW(parseSerialized(fileOf(5, {body(4, kSingle, 1)})), SceneError);
  // Counts that no file of this size can hold must not be allocated.
  EXPECT_THROW(parseSerialized(fileOf(4, {body(4, kSingle, 1, 1ull << 40, 1)})), SceneError);
  EXPECT_THROW(parseSerialized(fileOf(4, {body(4, kSingle, 1, 3, 1ull << 60)})), SceneError);
  EXPECT_THROW(parseSerialized(fileOf(4, {body(4, kSingle, 1, 3, 2)})), SceneError);
  // An offset behind the end.
  std::string wild = good;
  wild[wild.size() - 6] = 127;
  EXPECT_THROW(parseSerialized(wild), SceneError);
}

// What unpacks to much more than the file has is no mesh: zeros shrink by a thousand to one.
TEST(Serialized, RefusesWhatUnpacksToTooMuch) {
  std::string zeros = body(4, kSingle, 0, 3, 2'000'000);
  zeros.resize(zeros.size() + 24'000'000);
  std::string bytes;
  append(bytes, uint16_t(0x041C));
  append(bytes, uint16_t(4));
  bytes += deflated(zeros);
  append(bytes, uint64_t(0));
  append(bytes, uint32_t(1));
  const TemporaryFile file("mesh.serialized", bytes);
  try {
    readSerialized(file.path(), 0, {});
    FAIL() << "read";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("more than the file can hold"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace odis::test
