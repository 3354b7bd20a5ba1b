// A scene as the generator thinks of it, before it becomes files: in metres, +z up.
#pragma once

#include <string>
#include <vector>

#include "learn/scenes/solids.h"

namespace odis::learn {

// An index into Description::materials; lights that reflect nothing have none.
using MaterialId = int;
constexpr MaterialId kNoMaterial = -1;

// A mesh; what has a radiance is a light of its own.
struct Part {
  MeshData mesh;
  MaterialId material = kNoMaterial;
  Rgb radiance{0, 0, 0};
};

// A sphere that stays one in the file.
struct Ball {
  Vec3 center;
  float radius = 1;
  MaterialId material = kNoMaterial;
  Rgb radiance{0, 0, 0};
};

// A light without a size: a spot if its cutoff is above zero, else a point.
struct PointLight {
  Vec3 position;
  Vec3 direction{0, 0, -1};
  Rgb intensity;
  float cutoff = 0;  // degrees
};

struct Environment {
  enum class Kind { none, constant, daylight, map };
  Kind kind = Kind::none;
  float scale = 1;
  Rgb radiance{1, 1, 1};  // constant
  // daylight: the sun's size in degrees; 0 leaves it out. sunScale is relative to the true sun's power.
  Vec3 sunDirection{0, 0, 1};
  float turbidity = 3, sunAperture = 0.5358f, sunScale = 1;
  // map: a file of the scene and how far it is turned about +z
  std::string file;
  float turn = 0;
};

struct View {
  Vec3 origin{0, 0, 0}, target{1, 0, 0};
  float fov = 60;  // degrees, of the longer side
  Vec2i resolution{640, 360};
};

// A polygon (counter-clockwise) between two heights.
struct Space {
  std::vector<Vec2> polygon;
  float bottom = 0, top = 0;
};
// Whether a place is in the polygon, at least `margin` from its edges.
bool contains(std::span<const Vec2> polygon, const Vec2& p, float margin);

struct Box {
  Vec3 min, max;
};
Box boxAround(std::span<const Vec2> polygon, float bottom, float top);

struct Description {
  std::string kind;
  std::vector<Part> parts;
  std::vector<Ball> balls;
  std::vector<PointLight> pointLights;
  Environment environment;

  std::vector<std::string> materials;  // each as an XML element, with an id
  struct File {
    std::string name, bytes;
  };
  std::vector<File> files;        // textures and maps
  std::vector<float> roughness;   // of every material that has one, as drawn
  std::vector<std::string> tags;  // what is special about it: "blinds", "mirror", ...
  std::vector<std::string> credits;

  std::vector<Space> standing;  // where a camera may be
  std::vector<Vec3> interests;  // what it may look at
  std::vector<View> views;
  float closest = 0.35f;  // metres that a camera keeps from surfaces
  bool indoors = true;

  // What turns it into the world of the file: first turned about +z, then scaled.
  float turn = 0, scale = 1;
  // What every light is multiplied by.
  float exposure = 1;
};

}  // namespace odis::learn
