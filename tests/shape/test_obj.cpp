#include "render/shape/mesh_files.h"
#include "shape/support.h"

namespace odis::test {
namespace {

MeshData parseObj(const std::string& text, Warnings* warnings = nullptr) {
  const TemporaryFile file("mesh.obj", text);
  Warnings own;
  return readObj(file.path(), {}, warnings ? *warnings : own);
}

std::string objFailure(const std::string& text) {
  try {
    parseObj(text);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(Obj, ReadsPositionsCoordinatesAndNormals) {
  const MeshData mesh = parseObj(
      "# a comment\r\nmtllib nothing.mtl\r\nv 0 0 0\r\nv +1.5 0 0\r\nv 0 -2e-1 .5\r\n"
      "vt 0 0.25\r\nvt 1 0.5\r\nvn 0 0 1\r\ng group\r\nusemtl m\r\ns 1\r\nf 1/1/1 2/2/1 3/1/1\r\n");
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2}));
  ASSERT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.positions[1], Vec3(1.5f, 0, 0));
  EXPECT_EQ(mesh.positions[2], Vec3(0, -0.2f, 0.5f));
  EXPECT_EQ(mesh.uvs[1], Vec2(1, 0.5f));
  EXPECT_EQ(mesh.normals[2], Vec3(0, 0, 1));
}

TEST(Obj, SharesEqualCornersOnly) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 1\n";
  EXPECT_EQ(parseObj(vertices + "f 1/1 2/1 3/1\nf 3/1 2/1 4/1\n").positions.size(), 4u);
  EXPECT_EQ(parseObj(vertices + "f 1/1 2/1 3/1\nf 3/1 2/2 4/1\n").positions.size(), 5u);
}

// However many corners meet in one position, those that are equal share a vertex.
TEST(Obj, SharesCornersOfACrowdedPosition) {
  constexpr size_t kCount = 100;
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", faces;
  for (size_t i = 0; i < kCount; ++i) {
    text += "vt " + std::to_string(i) + " 0\n";
    faces += "f 1/" + std::to_string(i + 1) + " 2/1 3/1\n";
  }
  const MeshData mesh = parseObj(text + faces + faces);
  EXPECT_EQ(mesh.triangles.size(), 2 * kCount);
  ASSERT_EQ(mesh.positions.size(), kCount + 2);
  for (size_t i = 0; i < kCount; ++i) {
    EXPECT_EQ(mesh.uvs[mesh.triangles[i][0]].x, float(i));
    EXPECT_EQ(mesh.triangles[kCount + i], mesh.triangles[i]) << i;
  }
}

TEST(Obj, ReadsNegativeIndicesAndPolygons) {
  const MeshData mesh = parseObj(
      "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 1 0\nvn 0 0 1\nf -5//-1 -4//-1 -3//-1 -2//-1 "
      "-1//-1");
  ASSERT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.positions.size(), 5u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.positions[mesh.triangles[i][0]], Vec3(0, 0, 0));
    EXPECT_EQ(mesh.triangles[i][2], i + 2);
  }
  EXPECT_TRUE(mesh.uvs.empty());
  EXPECT_EQ(mesh.normals.size(), 5u);
}

TEST(Obj, ContinuesLinesAndFillsWhatIsMissing) {
  const MeshData mesh =
      parseObj("v 0 0 0\nv 1 0 0\nv 0 1 \\\n0\nv 5 5 5\nvn 0 1 0\nf 1//1 2//1 \\\r\n 3//1 # tail\nf 1 2 4\n");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_EQ(mesh.normals[mesh.triangles[1][2]], Vec3(0, 0, 0));
}

TEST(Obj, ReadsColoursOfVertices) {
  const MeshData mesh = parseObj(
      "v 0 0 0 0.1 0.2 0.3\nv 1 0 0\nv 0 1 0 0.4 0.5 0.6 1\nv 1 1 0 1 # homogeneous\nvt 0 0\nvt 1 1\n"
      "f 3/1 2/1 1/1\nf 3/2 2/2 4/2\n");
  ASSERT_EQ(mesh.attributes.size(), 1u);
  EXPECT_EQ(mesh.attributes[0].name, "vertex_color");
  EXPECT_EQ(mesh.attributes[0].channels, 3u);
  EXPECT_EQ(mesh.attributes[0].values, (std::vector<float>{0.4f, 0.5f, 0.6f, 1, 1, 1, 0.1f, 0.2f, 0.3f, 0.4f,
                                                           0.5f, 0.6f, 1, 1, 1, 1, 1, 1}));
  EXPECT_TRUE(parseObj("v 0 0 0 1\nv 1 0 0 1 # 2 3\nv 0 1 0 1 2\nf 1 2 3\n").attributes.empty());
}

TEST(Obj, NamesTheLineOfAnError) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_NE(objFailure(vertices + "f 1 2 4\n").find("mesh.obj:4: the face refers to vertex 4"),
            std::string::npos);
  EXPECT_NE(objFailure(vertices + "\nf 1 2 -4\n").find("mesh.obj:5"), std::string::npos);
  EXPECT_NE(objFailure(vertices + "f 0 1 2\n").find("mesh.obj:4"), std::string::npos);
  EXPECT_NE(objFailure(vertices + "f 1/1 2/1 3/1\n").find("texture coordinate 1"), std::string::npos);
  EXPECT_NE(objFailure(vertices + "f 1//2 2//1 3//1\n").find("normal 2"), std::string::npos);
  EXPECT_NE(objFailure("v 0 zero 0\n").find("mesh.obj:1: found \"zero\", expected a number"),
            std::string::npos);
  EXPECT_NE(objFailure(vertices + "f 1 2 99999999999999999999\n").find("mesh.obj:4"), std::string::npos);
  EXPECT_NE(objFailure(vertices + "f a b c\n").find("mesh.obj:4"), std::string::npos);
}

TEST(Obj, WarnsOfFacesThatAreLines) {
  Warnings warnings;
  EXPECT_TRUE(parseObj("v 0 0 0\nv 1 0 0\nf 1 2\n", &warnings).triangles.empty());
  EXPECT_EQ(warnings.texts().size(), 1u);
}

TEST(Obj, ReadsNumbersBeyondTheRangeOfFloats) {
  const MeshData mesh = parseObj("v 1e-60 -1e60 nan\nv 0 0 0\nv 1 0 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions[0].x, 0.0f);
  EXPECT_TRUE(std::isinf(mesh.positions[0].y));
  EXPECT_TRUE(std::isnan(mesh.positions[0].z));
}

TEST(Obj, EmptyFileAndMissingFile) {
  EXPECT_TRUE(parseObj("").triangles.empty());
  Warnings warnings;
  EXPECT_THROW(readObj("/nowhere/at/all.obj", {"scene.xml", 3, 7}, warnings), SceneError);
  EXPECT_THROW(readObj(std::filesystem::temp_directory_path().string(), {}, warnings), SceneError);
}

}  // namespace
}  // namespace odis::test
