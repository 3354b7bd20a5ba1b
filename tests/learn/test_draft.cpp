// Drafts of scenes, before they become files: geometry, and the statistics of what is drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "learn/scenes/furniture.h"
#include "learn/scenes/generate.h"
#include "learn/scenes/lamps.h"
#include "render/image/write.h"
#include "support/temporary_folder.h"

namespace odis::learn {
namespace {

Box boxOf(const std::vector<Part>& parts, const std::vector<Ball>& balls) {
  Box box{Vec3(1e9f), Vec3(-1e9f)};
  const auto add = [&](const Vec3& p, float margin) {
    for (int c = 0; c < 3; ++c) {
      box.min[c] = std::min(box.min[c], p[c] - margin);
      box.max[c] = std::max(box.max[c], p[c] + margin);
    }
  };
  for (const Part& part : parts)
    for (const Vec3& p : part.mesh.positions) add(p, 0);
  for (const Ball& ball : balls) add(ball.center, ball.radius);
  return box;
}

// Indices, unit normals that agree with the winding, finite coordinates.
void expectSound(const MeshData& mesh, const std::string& what) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size()) << what;
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size()) << what;
  size_t wrong = 0;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    ASSERT_TRUE(render::isFinite(mesh.positions[i])) << what;
    ASSERT_NEAR(render::length(mesh.normals[i]), 1, 1e-3f) << what;
  }
  for (const render::Triangle& t : mesh.triangles) {
    ASSERT_LT(std::max({t[0], t[1], t[2]}), mesh.positions.size()) << what;
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Vec3 n = render::cross(b - a, c - a);
    wrong += render::dot(n, mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]]) < 0;
  }
  EXPECT_EQ(wrong, 0u) << what;
}

// The least distance between a point and a mesh, sampled on each triangle.
float distanceTo(const MeshData& mesh, const Vec3& p) {
  constexpr int kSteps = 12;
  float least = 1e9f;
  for (const render::Triangle& t : mesh.triangles)
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; i + j <= kSteps; ++j) {
        const Vec3 q = mesh.positions[t[0]] +
                       (mesh.positions[t[1]] - mesh.positions[t[0]]) * (float(i) / kSteps) +
                       (mesh.positions[t[2]] - mesh.positions[t[0]]) * (float(j) / kSteps);
        least = std::min(least, render::length(q - p));
      }
  return least;
}

TEST(Solids, NormalsAgreeWithTheWinding) {
  MeshData mesh;
  addBox(mesh, {0, 0, 0}, {1, 2, 3});
  expectSound(mesh, "box");
  addBall(mesh, {0, 0, 0}, 2, 16);
  expectSound(mesh, "ball");
  addCylinder(mesh, {0, 0, 0}, 1, 2, 12);
  addShade(mesh, {0, 0, 0}, {1, 0.5f, 1, 0.01f}, 12);
  addCushion(mesh, {0, 0, 0}, {1, 2, 0.5f}, 0.3f);
  addBar(mesh, {0, 0, 0}, {1, 1, 1}, 0.1f, 8);
  const Vec2 triangle[] = {{0, 0}, {1, 0}, {0, 1}};
  addPrism(mesh, triangle, 0, 1);
  const Hole hole{0.2f, 0.4f, 0.3f, 0.8f};
  addPanel(mesh, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0, 1, 0, 1, 0.1f}, std::span(&hole, 1));
  expectSound(mesh, "all");
}

TEST(Solids, PanelHasItsHoles) {
  const Hole holes[] = {{0.2f, 0.4f, 0.3f, 0.8f}, {0.6f, 0.7f, 0.0f, 0.5f}};
  MeshData mesh;
  addPanel(mesh, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0, 1, 0, 1, 0.1f}, holes);
  double front = 0, all = 0;
  for (const render::Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const double area = render::length(render::cross(b - a, c - a)) / 2;
    all += area;
    if (a.y == 0 && b.y == 0 && c.y == 0) front += area;
  }
  EXPECT_NEAR(front, 1 - 0.2 * 0.5 - 0.1 * 0.5, 1e-5);
  // Rims: around the panel but for the hole's foot, around the first hole, three sides of the second.
  EXPECT_NEAR(all, 2 * front + 0.1 * (4 - 0.1 + 2 * (0.2 + 0.5) + 0.1 + 2 * 0.5), 1e-5);
}

TEST(Furniture, StandsOnItsFloorAndKeepsItsSize) {
  const Assets none;
  for (uint64_t key = 0; key < 40; ++key) {
    Draft draft("room", key, none);
    const std::pair<const char*, Piece> pieces[] = {{"table", makeTable(draft, 1.2f, 0.7f, 0.75f)},
                                                    {"round table", makeRoundTable(draft, 0.5f, 0.75f)},
                                                    {"chair", makeChair(draft)},
                                                    {"stool", makeStool(draft)},
                                                    {"shelf", makeShelf(draft, 1, 1.8f)},
                                                    {"cabinet", makeCabinet(draft, 1, 0.9f)},
                                                    {"sofa", makeSofa(draft, 2)},
                                                    {"bed", makeBed(draft, 1.4f)},
                                                    {"plant", makePlant(draft, 1)},
                                                    {"crates", makeCrates(draft)},
                                                    {"ornament", makeOrnament(draft, 0.2f)},
                                                    {"table lamp", makeTableLamp(draft, 1)},
                                                    {"floor lamp", makeFloorLamp(draft, 1)}};
    for (const auto& [name, piece] : pieces) {
      const Box box = boxOf(piece.parts, piece.balls);
      EXPECT_NEAR(box.min.z, 0, 0.09f) << name;
      // A leaf or a handle may stand out a little.
      EXPECT_LE(box.max.x - box.min.x, piece.size.x * 1.3f + 0.06f) << name;
      EXPECT_LE(box.max.y - box.min.y, piece.size.y * 1.3f + 0.06f) << name;
      for (const Part& part : piece.parts) expectSound(part.mesh, name);
    }
  }
}

// A room's things stay within its walls.
TEST(Kinds, NothingIsOutsideOfTheRoom) {
  const Assets none;
  for (const char* name : {"room", "cove", "hidden", "lamps", "lights", "mirrors", "gloss"})
    for (uint64_t key = 0; key < 25; ++key) {
      Draft draft(name, key, none);
      findKind(name)->build(draft);
      if (!draft.scene.indoors) continue;  // a stage
      const Space& space = draft.scene.standing.front();
      Box room = boxAround(space.polygon, space.bottom, space.top);
      if (draft.scene.kind == "hidden") room.min.x = -0.2f;  // whose views are of a part only
      const Box box = boxOf(draft.scene.parts, draft.scene.balls);
      constexpr float kWall = 0.29f;  // at a corner, the diagonal of a wall's thickness
      for (int c = 0; c < 3; ++c) {
        EXPECT_GE(box.min[c], room.min[c] - kWall) << name << " " << key << " axis " << c;
        EXPECT_LE(box.max[c], room.max[c] + kWall) << name << " " << key << " axis " << c;
      }
      if (draft.scene.kind == "hidden") continue;
      for (const Ball& ball : draft.scene.balls)
        EXPECT_TRUE(contains(space.polygon, {ball.center.x, ball.center.y}, 0)) << name << " " << key;
      for (const Vec3& at : draft.scene.interests)
        EXPECT_TRUE(contains(space.polygon, {at.x, at.y}, 0)) << name << " " << key;
    }
}

TEST(Kinds, MeshesAreSoundAndOfSaneSize) {
  const Assets none;
  for (const Kind& kind : kinds())
    for (uint64_t key = 0; key < 6; ++key) {
      Draft draft(kind.name, key, none);
      kind.build(draft);
      size_t triangles = 0;
      bool light =
          draft.scene.environment.kind != Environment::Kind::none || !draft.scene.pointLights.empty();
      for (const Part& part : draft.scene.parts) {
        expectSound(part.mesh, kind.name);
        triangles += part.mesh.triangles.size();
        light = light || !render::isBlack(part.radiance);
        EXPECT_LT(part.material, int(draft.scene.materials.size()));
      }
      for (const Ball& ball : draft.scene.balls) light = light || !render::isBlack(ball.radiance);
      EXPECT_TRUE(light) << kind.name << " " << key;
      EXPECT_LT(triangles, 200'000u) << kind.name;
      EXPECT_FALSE(draft.scene.standing.empty()) << kind.name;
    }
}

// Drawn as u^2: below x with probability sqrt(x). Kolmogorov's test at significance 0.01.
TEST(Statistics, RoughnessIsASquare) {
  const Assets none;
  std::vector<float> drawn;
  for (uint64_t key = 0; key < 400; ++key) {
    Description scene;
    Materials materials(scene, none, Random(key));
    for (int i = 0; i < 5; ++i) materials.roughness();
    drawn.insert(drawn.end(), scene.roughness.begin(), scene.roughness.end());
  }
  std::sort(drawn.begin(), drawn.end());
  double distance = 0;
  const double n = double(drawn.size());
  for (size_t i = 0; i < drawn.size(); ++i)
    distance = std::max({distance, std::abs(std::sqrt(drawn[i]) - double(i) / n),
                         std::abs(std::sqrt(drawn[i]) - double(i + 1) / n)});
  EXPECT_LT(distance, 1.63 / std::sqrt(n));
}

// Of a red and a grey image of the user's, floors take the grey one.
TEST(Statistics, FloorsAreNotVivid) {
  const odis::test::TemporaryFolder folder;
  const auto write = [&](const char* name, std::initializer_list<uint8_t> rgb) {
    const std::string path = folder.path(name);
    std::ofstream(path, std::ios::binary) << render::encodePng(1, 1, 3, rgb.begin());
    return path;
  };
  const std::string red = write("red.png", {240, 4, 58}), grey = write("grey.png", {120, 110, 90});
  const Assets assets("", folder.path(""), "");
  EXPECT_TRUE(assets.isVivid(red));
  EXPECT_FALSE(assets.isVivid(grey));
  size_t reds = 0, greys = 0;
  for (uint64_t key = 0; key < 200; ++key) {
    Draft draft("room", key, assets);
    draft.materials.setStyle(0, 0.7);
    draft.materials.floor();
    for (const Description::File& file : draft.scene.files) {
      reds += file.bytes == assets.texture(red);
      greys += file.bytes == assets.texture(grey);
    }
  }
  EXPECT_GT(greys, 60u);  // 91 are expected, with a standard deviation of 7
  EXPECT_EQ(reds, 0u);    // one of 4096 such floors has twelve attempts that fail
}

// Each kind's count within 4 standard deviations (13 kinds: significance 0.001); guiding has nothing to do in
// 10 to 20 % of the scenes.
TEST(Statistics, KindsHaveTheirShares) {
  constexpr int kScenes = 20000;
  double all = 0;
  std::map<std::string, int> counts;
  for (const Kind& kind : kinds()) all += kind.share;
  for (uint64_t seed = 0; seed < kScenes; ++seed) ++counts[kindOf(seed).name];
  for (const Kind& kind : kinds()) {
    const double p = kind.share / all;
    EXPECT_NEAR(counts[kind.name], kScenes * p, 4 * std::sqrt(kScenes * p * (1 - p))) << kind.name;
  }
  EXPECT_GE(findKind("adversarial")->share / all, 0.1);
  EXPECT_LE(findKind("adversarial")->share / all, 0.2);
}

// From a few lights to thousands.
TEST(Statistics, HallsHaveFewToManyLights) {
  const Assets none;
  size_t few = 0, many = 0;
  for (uint64_t key = 0; key < 60; ++key) {
    Draft draft("lights", key, none);
    buildLights(draft);
    size_t lights = 0;
    for (const Part& part : draft.scene.parts)
      if (!render::isBlack(part.radiance)) lights += part.mesh.triangles.size() / 8;
    for (const Ball& ball : draft.scene.balls) lights += !render::isBlack(ball.radiance);
    few += lights < 20;
    many += lights > 800;
  }
  EXPECT_GE(few, 5u);
  EXPECT_GE(many, 5u);
}

TEST(Random, StreamsAreIndependentOfEachOther) {
  const Random random(5);
  Random a = random.fork("a"), b = random.fork("b"), again = random.fork("a");
  double product = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = a.unit();
    EXPECT_EQ(x, again.unit());
    product += (x - 0.5) * (b.unit() - 0.5);
  }
  EXPECT_LT(std::abs(product / kDraws), 4.0 / 12 / std::sqrt(double(kDraws)));
}

TEST(Lamps, BulbsAndTheirGlassTouchNothing) {
  const Assets none;
  for (uint64_t key = 0; key < 60; ++key) {
    Draft draft("lamps", key, none);
    for (const Piece& lamp :
         {makeTableLamp(draft, 10), makeFloorLamp(draft, 10), makePendant(draft, 0.5f, 10)})
      for (const Ball& ball : lamp.balls) {
        const float room = ball.material == kNoMaterial ? ball.radius + 0.001f : ball.radius * 0.999f;
        for (const Part& part : lamp.parts)
          EXPECT_GT(distanceTo(part.mesh, ball.center), room) << "seed " << key;
      }
  }
}

}  // namespace
}  // namespace odis::learn
