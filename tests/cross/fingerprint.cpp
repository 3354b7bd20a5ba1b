// Prints a number for each array of a guide that is built from made-up vertices: equal numbers mean equal
// bits. scripts/cross compares what it prints on different machines. The vertices are made without a
// mathematical library, so that they are equal everywhere.
#include <odis/odis.hpp>

#include <cinttypes>
#include <cstdio>
#include <random>
#include <vector>

namespace {

// FNV-1a.
template <class T>
void print(const char* model, const char* name, const T* data, size_t count) {
  uint64_t hash = 14695981039346656037u;
  const auto* bytes = reinterpret_cast<const unsigned char*>(data);
  for (size_t i = 0; i < count * sizeof(T); ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
  std::printf("%s, %s: %016" PRIx64 "\n", model, name, hash);
}

// A number in [0, 1).
float draw(std::mt19937& engine) {
  return float(engine() >> 8) / 16777216.0f;
}

// A floor under a sky that is bright on one side, and two lights.
std::vector<odis::PathVertex> makeVertices() {
  std::mt19937 engine(1);
  std::vector<odis::PathVertex> vertices(30000);
  for (size_t i = 0; i < vertices.size(); ++i) {
    odis::PathVertex& v = vertices[i];
    v.position = {draw(engine), draw(engine), 0};
    v.normal = {0, 0, 1};
    // A point of the disk, projected onto the upper hemisphere from the pole below.
    float s = 1, t = 1;
    while (s * s + t * t >= 0.99f) s = 2 * draw(engine) - 1, t = 2 * draw(engine) - 1;
    const float d = 1 + s * s + t * t;
    v.wi = {2 * s / d, 2 * t / d, (2 - d) / d};
    v.pdf = v.guidablePdf = d * d / 12.566371f;
    v.guidableProbability = 1;
    const float radiance = v.wi.x > 0.5f ? 4 + draw(engine) : 0.1f;
    v.radiance = {radiance, radiance, radiance};
    v.weight = {0.5f, 0.5f, 0.5f};
    v.distance = 0.5f + draw(engine);
    v.indirect = 0.5f * radiance;
    v.emission = 0;
    v.lightGroup = engine() % 2;
    v.lightGroupProbability = 0.5f;
    v.light = v.lightGroup == 0 ? draw(engine) : 0;
    v.direct = {v.light, v.light, v.light};
    v.lightDirection = {0, 0, 1};
    v.raysAfter = 2;
    v.pixel = uint32_t(i);
    v.depth = 1;
  }
  return vertices;
}

void printGuide(const char* name, const char* settings) {
  const std::vector<odis::PathVertex> vertices = makeVertices();
  odis::GuideOptions options;
  options.settings = settings;
  options.lightGroups = 2;
  odis::GuideBuilder builder(options);
  builder.add(vertices);
  const odis::Guide guide = builder.build();
  const odis::GuideView view = guide.view();
  print(name, "cells", view.keys, view.cellCount);
  print(name, "maps", view.maps, size_t(view.cellCount) * odis::kMapShares);
  print(name, "decisions", view.decisions, view.cellCount);
  print(name, "lights", view.lightTables, size_t(view.cellCount) * (view.lightGroups + 1));
}

}  // namespace

int main() {
  printGuide("networks", "");
  printGuide("formulas", "guide=histogram lights=formula");
}
