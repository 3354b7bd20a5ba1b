#include <odis/instruction_sets.h>
#include <xmmintrin.h>

#include <array>
#include <numeric>

#include "render/path/bounce.h"
#include "render/path/media.h"
#include "render/path/veil.h"
#include "render/shape/mesh_points.h"

namespace odis::render {

namespace {

// Some bits of the address of a hit's BSDF, to sort by.
constexpr int kBucketBits = 6;
uint8_t bucketOf(const Vertex& vertex) {
  const uint64_t address = reinterpret_cast<uintptr_t>(vertex.bsdf);
  return uint8_t((address * 0x9e3779b97f4a7c15u) >> (64 - kBucketBits));  // Fibonacci hashing
}

// Sorts vertices by BSDF, those of one in their order, and puts rays that ended without one behind them.
void sortByBsdf(Batch& batch) {
  const size_t count = batch.active.size();
  batch.metCount = 0;
  size_t left = 0;
  for (size_t i = 0; i < count; ++i) {  // without a branch, which would often be mispredicted
    const bool met = batch.vertices[i].bsdf;
    batch.met[batch.metCount] = batch.order[count - 1 - left] = uint32_t(i);
    batch.metCount += met;
    left += !met;
  }
  std::array<uint32_t, 1 << kBucketBits> ends{};
  for (size_t k = 0; k < batch.metCount; ++k) {
    batch.buckets[k] = bucketOf(batch.vertices[batch.met[k]]);
    ++ends[batch.buckets[k]];
  }
  std::exclusive_scan(ends.begin(), ends.end(), ends.begin(), 0u);
  for (size_t k = 0; k < batch.metCount; ++k) batch.order[ends[batch.buckets[k]]++] = batch.met[k];
}

// In two vectors: Imath copies number by number.
void copyRay(const Ray& ray, Ray& to) {
  static_assert(sizeof(Ray) == 8 * sizeof(float));
  _mm_storeu_ps(&to.origin.x, _mm_loadu_ps(&ray.origin.x));
  _mm_storeu_ps(&to.origin.x + 4, _mm_loadu_ps(&ray.origin.x + 4));
}

// Traces the paths' rays and notes what kinds of vertices there are where they end.
void traceRays(const PathSettings& settings, std::span<const Path> paths, Batch& batch) {
  const size_t count = batch.active.size();
  batch.reserve(count);
  for (size_t i = 0; i < count; ++i) copyRay(paths[batch.active[i]].ray, batch.rays[i]);
  settings.scene->intersect({batch.rays.data(), count}, batch.hits);
  for (size_t i = 0; i < count; ++i) {
    const Shape* shape = batch.hits[i].shape;
    Vertex& vertex = batch.vertices[i];
    vertex.at.shape = shape;
    vertex.kind = shape ? VertexKind::surface : VertexKind::escaped;
    vertex.bsdf = shape ? &shape->bsdf() : nullptr;
  }
}

// Finds the places of the vertices on surfaces.
void findPlaces(Batch& batch) {
  sortByBsdf(batch);
  MeshPoints meshPoints;
  for (const uint32_t i : batch.withVertex()) {
    if (batch.vertices[i].inMedium()) continue;
    meshPoints.add(batch.hits[i], batch.rays[i], batch.vertices[i]);
    if (meshPoints.full()) meshPoints.find();
  }
  meshPoints.find();
}

// The keys of the cells of the finest level that vertices lie in, and where the search for them begins.
ODIS_WIDE void findKeys(const CellGrid& grid, const VertexColumns& at, size_t count, uint64_t* keys,
                        uint64_t* hashes) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const float side = at.wo.z[i] < 0 ? -1.0f : 1.0f;  // as facingNormal()
    const Float3 normal{at.n.x[i] * side, at.n.y[i] * side, at.n.z[i] * side};
    keys[i] = grid.key({at.p.x[i], at.p.y[i], at.p.z[i]}, normal, 0);
    hashes[i] = cellHash(keys[i]);
  }
}

// Adds vertices that may have cells, kLanes at most, to those whose cells are looked for.
void addLookUps(const PathSettings& settings, std::span<const Path> paths, std::span<const uint32_t> some,
                Batch& batch) {
  const Vertex* vertices[kLanes];
  for (size_t k = 0; k < kLanes; ++k) vertices[k] = &batch.vertices[some[std::min(k, some.size() - 1)]];
  VertexColumns& at = batch.lookUps.at;
  at.readPlaces(vertices, some.size());
  for (size_t k = 0; k < some.size(); ++k)
    if (vertices[k]->inMedium()) at.n.set(k, Vec3(0, 0, 0));
  uint64_t keys[kLanes], hashes[kLanes];
  findKeys(CellGrid(settings.guide->grid), at, some.size(), keys, hashes);
  for (size_t k = 0; k < some.size(); ++k) prefetchSlot(*settings.guide, hashes[k]);
  CellLookUps& lookUps = batch.lookUps;
  const std::span<uint64_t> keysTo(lookUps.keys), hashesTo(lookUps.hashes);
  const std::span<uint32_t> verticesTo(lookUps.vertices);
  size_t count = lookUps.count;
  for (size_t k = 0; k < some.size(); ++k) {
    keysTo[count] = keys[k];
    hashesTo[count] = hashes[k];
    verticesTo[count] = some[k];
    count += (vertices[k]->bsdf->traits().evaluable || vertices[k]->inMedium()) &&
             guidesAt(settings, paths[batch.active[some[k]]]);
  }
  lookUps.count = count;
}

// Finds the cells that guide the vertices. Those with delta lobes only, on mirrors and glass, have none: what
// they return depends on the one direction that the path came from, of which a cell knows nothing.
void findGuidingCells(const PathSettings& settings, std::span<const Path> paths, Batch& batch) {
  batch.cells.assign(batch.active.size(), kNoCell);
  if (!settings.guide) return;
  const std::span<const uint32_t> vertices = batch.withVertex();
  CellLookUps& lookUps = batch.lookUps;
  lookUps.count = 0;
  for (size_t begin = 0; begin < vertices.size(); begin += kLanes)
    addLookUps(settings, paths, vertices.subspan(begin, std::min(kLanes, vertices.size() - begin)), batch);
  findAround(*settings.guide, lookUps.keys.data(), lookUps.hashes.data(), lookUps.count,
             lookUps.cells.data());
  for (size_t k = 0; k < lookUps.count; ++k) batch.cells[lookUps.vertices[k]] = lookUps.cells[k];
  if (!settings.guide->pixels.cells) return;
  for (size_t k = 0; k < lookUps.count; ++k) {
    const uint32_t i = lookUps.vertices[k];
    const Path& path = paths[batch.active[i]];
    const uint32_t own =
        pixelCell(*settings.guide, {{}, {}, path.identity.pixel, path.identity.sample, path.guidable == 0});
    if (own != kNoCell) batch.cells[i] = own;
  }
}

// Takes some paths through all steps of a bounce; those that are scattered remain.
void takeSteps(const PathSettings& settings, Batch& batch, Bounces& bounces) {
  meetEmission(settings, batch, bounces);
  endInCache(settings, batch, bounces);
  playRouletteOnArrival(settings, batch, bounces);
  keepScattered(bounces);
  if (bounces.count == 0) return;
  readVertices(bounces);
  findGuidableLobes(settings, batch, bounces);
  drawNumbers(settings, batch, bounces);
  prepareDirections(settings, bounces);
  countGuidable(bounces);
  const LaneList lit = sampleLights(settings, bounces);
  chooseBlocks(bounces);
  weighLights(bounces, lit);
  sampleDirections(bounces);
  describeFirstHits(settings, bounces);
  playRouletteOnDeparture(settings, bounces);
  requestShadowRays(settings, batch, bounces, lit);
  recordBounces(batch, bounces);
  departRays(settings, bounces);
}

// Takes all active paths from their rays' ends to their next rays; those without one are active no more.
void bounceAll(const PathSettings& settings, std::span<Path> paths, int place, Batch& batch) {
  Bounces& bounces = batch.bounces;
  bounces.place = place;
  const std::span<uint32_t> active(batch.active);
  const std::span<uint8_t> survives(batch.survives);
  std::fill_n(survives.begin(), paths.size(), 0);
  for (size_t begin = 0; begin < active.size(); begin += kLanes) {
    const auto some = std::span(batch.order).subspan(begin, std::min(kLanes, active.size() - begin));
    bounces.count = some.size();
    for (size_t k = 0; k < some.size(); ++k) {
      const uint32_t i = some[k], index = active[i], cell = batch.cells[i];
      bounces.arrivals[k] = {&paths[index], index, &batch.vertices[i], cell, false};
      if (cell != kNoCell) prefetchCell(*settings.guide, cell);  // needed some steps later
    }
    takeSteps(settings, batch, bounces);
    const size_t left = bounces.count;
    for (size_t i = 0; i < left; ++i) survives[bounces.arrivals[i].index] = uint8_t(bounces.survives[i] != 0);
  }
  size_t left = 0;
  for (const uint32_t index : active) {
    active[left] = index;
    left += survives[index];
  }
  batch.active.resize(left);
}

void activateAll(std::span<const Path> paths, Batch& batch) {
  batch.active.resize(paths.size());
  std::iota(batch.active.begin(), batch.active.end(), 0u);
}

// Not inline, so that compilers do not look for a thread's batch again and again.
[[gnu::noinline]] Batch& batchOfThread() {
  thread_local Batch batch;
  return batch;
}

[[gnu::noinline]] void traceBatch(const PathSettings& settings, std::span<Path> paths, Batch& batch) {
  activateAll(paths, batch);
  const bool volumetric = settings.scene->volumetric();
  for (int place = 1; !batch.active.empty(); ++place) {
    traceRays(settings, paths, batch);
    if (volumetric) flyThroughMedia(settings, paths, place, batch);
    findPlaces(batch);
    findGuidingCells(settings, paths, batch);
    bounceAll(settings, paths, place, batch);
    traceShadowRays(*settings.scene, paths, batch);
  }
}

}  // namespace

void tracePaths(const PathSettings& settings, std::span<Path> paths, std::vector<PathVertex>* vertices) {
  Batch& batch = batchOfThread();
  batch.recording = vertices != nullptr;
  if (batch.recording)
    for (Path& path : paths) path.handle = batch.recorder.begin(path.identity);
  for (Path& path : paths) path.medium = settings.scene->sensor().medium();
  traceBatch(settings, paths, batch);
  if (!vertices) return;
  const ArrayView<const PathVertex> met = batch.recorder.finish();
  vertices->insert(vertices->end(), met.begin(), met.end());
}

void traceFirstHits(const PathSettings& settings, std::span<Path> paths) {
  Batch& batch = batchOfThread();
  activateAll(paths, batch);
  for (Path& path : paths) path.medium = settings.scene->sensor().medium();
  std::vector<Veil> veils(settings.scene->volumetric() ? paths.size() : 0);
  for (int place = 1; !batch.active.empty(); ++place) {
    traceRays(settings, paths, batch);
    findPlaces(batch);
    size_t left = 0;
    for (size_t i = 0; i < batch.active.size(); ++i) {
      const uint32_t index = batch.active[i];
      Path& path = paths[index];
      if (path.medium) veils[index].add(path, place, batch.hits[i].shape ? batch.hits[i].raw.t : kInfinity);
      if (passesMirror(path, batch.vertices[i], place) && place != settings.maxDepth)
        batch.active[left++] = index;
    }
    batch.active.resize(left);
  }
  for (size_t i = 0; i < veils.size(); ++i) veils[i].cover(paths[i]);
}

}  // namespace odis::render
