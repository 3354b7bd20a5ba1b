#include <bit>
#include <cstring>
#include <map>

#include "render/shape/mesh_files.h"
#include "shape/support.h"

namespace odis::test {
namespace {

MeshData parsePly(const std::string& bytes) {
  const TemporaryFile file("mesh.ply", bytes);
  Warnings warnings;
  return readPly(file.path(), {}, warnings);
}

std::string plyFailure(const std::string& bytes) {
  try {
    parsePly(bytes);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

// Appends numbers in either byte order.
struct Bytes {
  bool big;
  std::string text;

  template <class T>
  Bytes& operator<<(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big != (std::endian::native == std::endian::big)) std::reverse(raw, raw + sizeof(T));
    text.append(raw, sizeof(T));
    return *this;
  }
};

void expectSquare(const MeshData& mesh) {
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.positions[2], Vec3(1, 1, 0.5f));
  ASSERT_EQ(mesh.uvs.size(), 4u);
  EXPECT_EQ(mesh.uvs[3], Vec2(0.25f, 1));
  EXPECT_TRUE(mesh.normals.empty());
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (Triangle{0, 2, 3}));
}

TEST(Ply, ReadsText) {
  expectSquare(parsePly(
      "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement vertex 4\r\nproperty float x\r\nproperty "
      "float y\r\n"
      "property float z\r\nproperty float s\r\nproperty float t\r\nelement face 1\r\n"
      "property list uchar int vertex_index\r\nend_header\r\n"
      "0 0 0 0 0\r\n1 0 0 1 0\r\n1 1 0.5 1 1\r\n0 1 0 0.25 1\r\n4 0 1 2 3\r\n"));
}

TEST(Ply, ReadsBinaryOfEitherOrderAndSkipsTheUnknown) {
  for (const bool big : {false, true}) {
    Bytes bytes{
        big, std::string("ply\nformat binary_") + (big ? "big" : "little") +
                 "_endian 1.0\nelement camera 1\nproperty list int double k\nproperty short id\n"
                 "element vertex 4\nproperty uchar red\nproperty double x\nproperty double y\n"
                 "property double z\nproperty list uchar ushort extra\nproperty float u\nproperty float v\n"
                 "element face 2\nproperty int flags\nproperty list uchar uint vertex_indices\nend_header\n"};
    bytes << int32_t(2) << 1.0 << 2.0 << int16_t(7);
    const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}};
    const float uv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0.25f, 1}};
    for (int i = 0; i < 4; ++i) {
      bytes << uint8_t(200) << xyz[i][0] << xyz[i][1] << xyz[i][2] << uint8_t(i);
      for (int k = 0; k < i; ++k) bytes << uint16_t(65535);
      bytes << uv[i][0] << uv[i][1];
    }
    bytes << int32_t(0) << uint8_t(3) << uint32_t(0) << uint32_t(1) << uint32_t(2);
    bytes << int32_t(0) << uint8_t(3) << uint32_t(0) << uint32_t(2) << uint32_t(3);
    expectSquare(parsePly(bytes.text));
    // Wherever the file is cut off, that is an error and not a crash.
    for (size_t size = 0; size < bytes.text.size(); size += 3)
      EXPECT_NE(plyFailure(bytes.text.substr(0, size)), "") << "cut at " << size;
  }
}

TEST(Ply, ReadsNormals) {
  const MeshData mesh = parsePly(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0 0 1 0\n1 0 0 0 1 0\n0 1 0 1 0 0\n3 0 1 2\n");
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_EQ(mesh.normals[2], Vec3(1, 0, 0));
}

// What Mitsuba 3.9 makes of these names.
TEST(Ply, ReadsAttributes) {
  const MeshData mesh = parsePly(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property float red\nproperty float green\nproperty float blue\nproperty float weight\n"
      "property float heat_0\nproperty float pair_0\nproperty float pair_1\nelement face 2\n"
      "property float color_0\nproperty list uchar int vertex_indices\nproperty float color_1\n"
      "property float color_2\nend_header\n"
      "0 0 0 1 2 3 9 0.5 9 9\n1 0 0 4 5 6 9 0.6 9 9\n1 1 0 7 8 9 9 0.7 9 9\n0 1 0 10 11 12 9 0.8 9 9\n"
      "0.1 4 0 1 2 3 0.2 0.3\n0.4 3 0 1 2 0.5 0.6\n");
  std::map<std::string, MeshAttribute> found;
  for (const MeshAttribute& attribute : mesh.attributes) found[attribute.name] = attribute;
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found["vertex_color"].values, (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_EQ(found["vertex_heat"].values, (std::vector<float>{0.5f, 0.6f, 0.7f, 0.8f}));
  EXPECT_EQ(found["vertex_heat"].channels, 1u);
  // A polygon gives its own to all triangles that it becomes.
  EXPECT_EQ(found["face_color"].values,
            (std::vector<float>{0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}));
}

MeshAttribute attributeOf(const MeshData& mesh, const std::string& name) {
  for (const MeshAttribute& attribute : mesh.attributes)
    if (attribute.name == name) return attribute;
  return {};
}

// A triangle whose vertices and face have these properties: colours as many programs write them.
template <class T>
std::string colored(const std::string& type, const std::string& encoding, const std::array<T, 3>& color) {
  const std::string channels =
      "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
  Bytes bytes{encoding == "binary_big_endian",
              "ply\nformat " + encoding +
                  " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
                  channels + "element face 1\n" + channels +
                  "property list uchar int vertex_indices\nend_header\n"};
  const auto put = [&](auto value) {
    if (encoding == "ascii")
      bytes.text += std::to_string(value) + " ";
    else
      bytes << value;
  };
  for (int vertex = 0; vertex < 3; ++vertex) {
    for (const float x : {float(vertex == 1), float(vertex == 2), 0.0f}) put(x);
    for (const T channel : color) put(channel);
  }
  for (const T channel : color) put(channel);
  put(uint8_t(3));
  for (const int index : {0, 1, 2}) put(index);
  return bytes.text;
}

template <class T>
void expectUnit(const std::string& type, const std::array<T, 3>& color,
                const std::array<double, 3>& expected) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const MeshData mesh = parsePly(colored(type, encoding, color));
    for (const char* name : {"vertex_color", "face_color"}) {
      const MeshAttribute attribute = attributeOf(mesh, name);
      ASSERT_EQ(attribute.values.size(), name[0] == 'v' ? 9u : 3u) << type << " " << encoding;
      for (size_t c = 0; c < attribute.values.size(); ++c)
        EXPECT_FLOAT_EQ(attribute.values[c], float(expected[c % 3]))
            << type << " " << encoding << " " << name;
    }
  }
}

// What MeshLab, Blender and CloudCompare mean by 51, 102, 204 of type uchar.
TEST(Ply, ScalesColoursOfIntegersByTheirLargest) {
  expectUnit<uint8_t>("uchar", {51, 102, 204}, {0.2, 0.4, 0.8});
  expectUnit<uint8_t>("uint8", {0, 255, 1}, {0, 1, 1 / 255.0});
  expectUnit<uint16_t>("ushort", {13107, 26214, 65535}, {0.2, 0.4, 1});
  expectUnit<uint32_t>("uint", {858993459, 1717986918, 4294967295}, {0.2, 0.4, 1});
  expectUnit<int8_t>("char", {127, 0, -127}, {1, 0, -1});
  expectUnit<int16_t>("short", {32767, 0, -1}, {1, 0, -1 / 32767.0});
  expectUnit<int32_t>("int", {2147483647, 0, 1073741824}, {1, 0, 1073741824 / 2147483647.0});
  expectUnit<float>("float", {0.25f, 51, -1}, {0.25, 51, -1});
  expectUnit<double>("double", {0.25, 51, -1}, {0.25, 51, -1});
}

TEST(Ply, KnowsColoursByTheirNames) {
  const auto read = [](const std::string& properties, const std::string& values) {
    std::string vertices;
    for (const char* xyz : {"0 0 0 ", "1 0 0 ", "0 1 0 "}) vertices += xyz + values + "\n";
    return parsePly(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
        properties + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + vertices +
        "3 0 1 2\n");
  };
  const auto first = [](const MeshData& mesh, const std::string& name) {
    const std::vector<float> values = attributeOf(mesh, name).values;
    return std::vector<float>(values.begin(), values.begin() + ptrdiff_t(values.size() / 3));
  };
  using Values = std::vector<float>;
  const auto properties = [](const std::string& type, std::initializer_list<const char*> names) {
    std::string text;
    for (const char* name : names) text += "property " + type + " " + name + "\n";
    return text;
  };
  // Whatever their order, and without their alpha.
  EXPECT_EQ(first(read(properties("uchar", {"alpha", "blue", "green", "red"}), "9 0 51 255"), "vertex_color"),
            (Values{1, 0.2f, 0}));
  EXPECT_EQ(first(read(properties("uchar", {"diffuse_red", "diffuse_green", "diffuse_blue"}), "255 51 0"),
                  "vertex_diffuse"),
            (Values{1, 0.2f, 0}));
  EXPECT_EQ(
      first(read(properties("ushort", {"color_2", "color_1", "color_0"}), "0 13107 65535"), "vertex_color"),
      (Values{1, 0.2f, 0}));
  EXPECT_EQ(first(read(properties("uchar", {"paint_r", "paint_g", "paint_b", "paint_a"}), "255 51 0 9"),
                  "vertex_paint"),
            (Values{1, 0.2f, 0}));
  EXPECT_EQ(first(read(properties("uchar", {"BaseColor_0"}), "51"), "vertex_BaseColor"), (Values{0.2f}));
  // Labels, counts and coordinates are what they are.
  EXPECT_EQ(first(read(properties("int", {"label_0"}), "51"), "vertex_label"), (Values{51}));
  EXPECT_EQ(first(read(properties("uchar", {"class_r"}), "51"), "vertex_class"), (Values{51}));
  EXPECT_EQ(first(read(properties("uchar", {"class_a"}), "51"), "vertex_class"), (Values{51}));
  EXPECT_EQ(first(read(properties("uchar", {"cell_x", "cell_y", "cell_z"}), "1 2 3"), "vertex_cell"),
            (Values{1, 2, 3}));
  EXPECT_EQ(read(properties("uchar", {"u", "v"}), "1 1").uvs[0], Vec2(1, 1));
  EXPECT_EQ(read(properties("char", {"nx", "ny", "nz"}), "0 0 -127").normals[0], Vec3(0, 0, -127));
  EXPECT_TRUE(read(properties("uchar", {"alpha"}), "1").attributes.empty());
}

TEST(Ply, RefusesWhatCannotBe) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n";
  const std::string z = "property float z\n";
  const auto faces = [](const std::string& count) {
    return "element face " + count + "\nproperty list uchar int vertex_indices\nend_header\n";
  };
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(plyFailure(head + z + faces("1") + vertices + "3 0 1 2\n"), "");
  EXPECT_NE(plyFailure(head + z + faces("1") + vertices + "3 0 1 3\n").find("face 0 refers to vertex 3"),
            std::string::npos);
  EXPECT_NE(plyFailure(head + z + faces("1") + vertices + "3 0 1 -1\n").find("vertex -1"), std::string::npos);
  EXPECT_NE(plyFailure(head + z + faces("1") + vertices + "3 0 1 nan\n"), "");
  EXPECT_NE(plyFailure(head + z + faces("18446744073709551615") + vertices).find("are announced"),
            std::string::npos);
  EXPECT_NE(plyFailure(head + z + faces("1") + vertices + "1e18 0 1 2\n").find("a list of"),
            std::string::npos);
  EXPECT_NE(plyFailure(head + faces("1") + "0 0\n1 0\n0 1\n3 0 1 2\n").find("no x, y and z"),
            std::string::npos);
  EXPECT_NE(plyFailure(head + z + faces("1") + "0 0 zero\n1 0 0\n0 1 0\n")
                .find("mesh.ply:10: found \"zero\", expected a number"),
            std::string::npos);
  EXPECT_NE(plyFailure("ply\nformat ascii 1.0\nelement vertex 3\n").find("end_header"), std::string::npos);
  EXPECT_NE(plyFailure("ply\nformat morse 1.0\nend_header\n").find("unknown format"), std::string::npos);
  EXPECT_NE(plyFailure("ply\nformat ascii 1.0\nproperty float x\nend_header\n"), "");
  // Vertices with normals and vertices without would not go together.
  EXPECT_NE(plyFailure(head + z + "property float nx\nproperty float ny\nproperty float nz\n" +
                       "element vertex 3\n" + "property float x\nproperty float y\n" + z + faces("1") +
                       "0 0 0 0 0 1\n1 0 0 0 0 1\n" + "0 1 0 0 0 1\n" + vertices + "3 3 4 5\n")
                .find("a second element \"vertex\""),
            std::string::npos);
  EXPECT_NE(plyFailure("solid stl\n").find("not a PLY file"), std::string::npos);
  EXPECT_NE(plyFailure("").find("not a PLY file"), std::string::npos);
}

}  // namespace
}  // namespace odis::test
