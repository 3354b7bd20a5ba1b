// A scene in the making, and pieces to put into it.
#pragma once

#include "learn/scenes/description.h"
#include "learn/scenes/materials.h"
#include "learn/scenes/random.h"

namespace odis::learn {

// A thing that stands somewhere: about the vertical through its origin, on z = 0, its front towards +y.
struct Piece {
  std::vector<Part> parts;
  std::vector<Ball> balls;
  Vec3 size;  // of the box that it fills
  // Where small things can be put: the middle of a top, and its half size.
  struct Top {
    Vec3 center;
    Vec2 half;
    float clearance;  // how high a thing may be
  };
  std::vector<Top> tops;

  void add(MeshData mesh, MaterialId material, const Rgb& radiance = Rgb(0.0f)) {
    parts.push_back({std::move(mesh), material, radiance});
  }
  void addBox(const Vec3& min, const Vec3& max, MaterialId material) {
    MeshData mesh;
    learn::addBox(mesh, min, max);
    add(std::move(mesh), material);
  }
};

struct Draft {
  Description scene;
  const Assets& assets;
  Random random;
  Materials materials;

  Draft(const std::string& kind, uint64_t key, const Assets& assets_)
      : assets(assets_), random(Random(key).fork(kind)), materials(scene, assets_, random.fork("materials")) {
    scene.kind = kind;
  }
  Draft(const Draft&) = delete;

  void add(MeshData mesh, MaterialId material, const Rgb& radiance = Rgb(0.0f)) {
    scene.parts.push_back({std::move(mesh), material, radiance});
  }
  void addBox(const Vec3& min, const Vec3& max, MaterialId material) {
    MeshData mesh;
    learn::addBox(mesh, min, max);
    add(std::move(mesh), material);
  }
  void add(const Piece& piece, const Vec3& position, float angle);
  void tag(const std::string& tag) { scene.tags.push_back(tag); }
};

}  // namespace odis::learn
