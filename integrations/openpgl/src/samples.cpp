#include "samples.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <thread>

#include "path.h"
#include "vectors.h"

using namespace odis::openpgl_interface;

namespace {

size_t countInVolumes(odis::ArrayView<const odis::PathVertex> vertices) {
  return size_t(std::count_if(vertices.begin(), vertices.end(), odis::isInMedium));
}

// A vertex of a sample that came without a path: on surfaces its normal is not known, so that its direction stands in.
odis::PathVertex vertexOf(const pgl_point3f& position, const pgl_vec3f& direction, bool inVolume) {
  odis::PathVertex vertex;
  vertex.position = toOdis(position);
  vertex.wi = toOdis(direction);
  if (!inVolume) vertex.normal = vertex.wi;
  vertex.depth = 1;
  vertex.pixel = std::bit_cast<uint32_t>(position.x) * 0x9e3779b9u ^ std::bit_cast<uint32_t>(position.y);
  vertex.sample = std::bit_cast<uint32_t>(position.z) * 0x85ebca6bu ^ std::bit_cast<uint32_t>(direction.x);
  return vertex;
}

}  // namespace

odis::PathVertex* SampleStorage::Paths::makeRoom(size_t vertices) {
  constexpr size_t kBlock = 4096;
  for (; m_current < m_blocks.size(); ++m_current) {
    Block& block = m_blocks[m_current];
    if (block.size + vertices > block.capacity) continue;
    block.size += vertices;
    return block.vertices.get() + block.size - vertices;
  }
  const size_t capacity = std::max(vertices, kBlock);
  m_blocks.push_back({std::make_unique_for_overwrite<odis::PathVertex[]>(capacity), vertices, capacity});
  return m_blocks.back().vertices.get();
}

void SampleStorage::Paths::add(uint64_t number, odis::ArrayView<const odis::PathVertex> vertices) {
  odis::PathVertex* room = makeRoom(vertices.size());
  std::copy(vertices.begin(), vertices.end(), room);
  m_paths.push_back({number, {room, vertices.size()}});
}

void SampleStorage::Paths::clear() {
  for (Block& block : m_blocks) block.size = 0;
  m_current = 0;
  m_paths.clear();
}

std::array<size_t, 2> SampleStorage::Paths::thinOut(const Thinning& thinning) {
  const std::vector<Path> before = std::move(m_paths);
  clear();
  std::array<size_t, 2> removed{};
  // What is kept never moves beyond where it was: it goes to the same blocks in the same order.
  for (const Path& path : before)
    if (thinning.keeps(path.number)) {
      add(path.number, path.vertices);
    } else {
      removed[0] += path.vertices.size();
      removed[1] += countInVolumes(path.vertices);
    }
  return removed;
}

SampleStorage::Shard& SampleStorage::ofThisThread() {
  return m_shards[std::hash<std::thread::id>()(std::this_thread::get_id()) % m_shards.size()];
}

void SampleStorage::add(odis::ArrayView<const odis::PathVertex> path) {
  if (path.empty()) return;
  const uint64_t number = uint64_t(path[0].pixel) << 32 | path[0].sample;
  Shard& shard = ofThisThread();
  {
    const std::lock_guard lock(shard.mutex);
    if (!m_thinning->keeps(number)) return;
    shard.paths.add(number, path);
    m_count += path.size();
    m_inVolumes += countInVolumes(path);
  }
  if (m_count > m_most) thinOut();
}

void SampleStorage::thinOut() {
  const std::lock_guard only(m_thinningMutex);
  while (m_count > m_most && !m_thinning->isOver()) {
    m_thinning->halve();
    for (Shard& shard : m_shards) {
      const std::lock_guard lock(shard.mutex);
      const auto [removed, inVolumes] = shard.paths.thinOut(*m_thinning);
      m_count -= removed;
      m_inVolumes -= inVolumes;
    }
  }
}

void SampleStorage::add(const PGLSampleData& sample) {
  const bool inVolume = sample.flags & PGLSampleData::EInsideVolume;
  if (!inVolume && sample.flags & kVolumeFlags) return;
  odis::PathVertex vertex = vertexOf(sample.position, sample.direction, inVolume);
  vertex.pdf = sample.pdf;
  const float radiance = sample.weight * sample.pdf;
  vertex.radiance = {radiance, radiance, radiance};
  vertex.distance = sample.distance;
  add({&vertex, 1});
}

void SampleStorage::add(const PGLZeroValueSampleData& sample) {
  // Hosts of 0.7 set the first byte only.
  odis::PathVertex vertex =
      vertexOf(sample.position, sample.direction, sample.flags & PGLSampleData::EInsideVolume);
  vertex.pdf = 1;
  add({&vertex, 1});
}

void SampleStorage::clear() {
  for (Shard& shard : m_shards) {
    const std::lock_guard lock(shard.mutex);
    shard.paths.clear();
  }
  m_count = m_inVolumes = 0;
  m_thinning->forget();
}

odis::ArrayView<const odis::PathVertex> SampleStorage::vertices() {
  std::vector<Paths::Path> paths;
  for (const Shard& shard : m_shards)
    paths.insert(paths.end(), shard.paths.all().begin(), shard.paths.all().end());
  std::sort(paths.begin(), paths.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  m_sorted.clear();
  m_sorted.reserve(m_count);
  for (const auto& [number, vertices] : paths)
    m_sorted.insert(m_sorted.end(), vertices.begin(), vertices.end());
  return m_sorted;
}

std::vector<PGLSampleData> SampleStorage::samples() {
  std::vector<PGLSampleData> result;
  for (const odis::PathVertex& v : vertices()) {
    if (!odis::isUsable(v)) continue;
    const float radiance = meanOf(v.radiance);
    result.push_back({fromOdis(v.position), fromOdis(v.wi), radiance / v.pdf, v.pdf, v.distance, flagsOf(v)});
  }
  return result;
}

namespace {

// One of the samples on surfaces, or of those in volumes.
PGLSampleData sampleAt(SampleStorage& storage, int index, bool inVolume) {
  std::vector<PGLSampleData> all = storage.samples();
  std::erase_if(all, [&](const PGLSampleData& s) {
    return ((s.flags & PGLSampleData::EInsideVolume) != 0) != inVolume;
  });
  return index >= 0 && size_t(index) < all.size() ? all[size_t(index)] : PGLSampleData{};
}

// Adds samples that a host got from a path: the path's vertices know more.
void addSamples(SampleStorage& storage, const PGLSampleData* data, size_t count) {
  PathSegmentStorage* path = preparedLast();
  if (path && data == path->samples().data() && count == path->samples().size()) {
    path->follow(storage.thinning());
    storage.add(path->vertices());
    return;
  }
  for (size_t i = 0; i < count; ++i) storage.add(data[i]);
}

}  // namespace

extern "C" {

PGLSampleStorage pglNewSampleStorage() {
  return new SampleStorage;
}
PGLSampleStorage pglNewSampleStorageFromFile(const char*) {
  return nullptr;  // only fields can be stored
}
bool pglSampleStorageStoreToFile(PGLSampleStorage, const char*) {
  return false;
}
void pglReleaseSampleStorage(PGLSampleStorage samples) {
  delete samples;
}
void pglPathSegmentStoragePropagateSamples(PGLPathSegmentStorage path, PGLSampleStorage samples, bool, bool,
                                           bool) {
  path->prepare();
  addSamples(*samples, path->samples().data(), path->samples().size());
}
void pglSampleStorageAddSample(PGLSampleStorage samples, const PGLSampleData& sample) {
  samples->add(sample);
}
void pglSampleStorageAddSamples(PGLSampleStorage samples, const PGLSampleData* data, size_t count) {
  addSamples(*samples, data, count);
}
void pglSampleStorageAddZeroValueSample(PGLSampleStorage samples, const PGLZeroValueSampleData& sample) {
  samples->add(sample);
}
void pglSampleStorageAddZeroValueSamples(PGLSampleStorage samples, const PGLZeroValueSampleData* data,
                                         size_t count) {
  // Those of a path came with it.
  const PathSegmentStorage* path = preparedLast();
  if (path && data == path->zeroSamples().data()) return;
  for (size_t i = 0; i < count; ++i) samples->add(data[i]);
}
void pglSampleStorageReserve(PGLSampleStorage, size_t, size_t) {}
void pglSampleStorageClear(PGLSampleStorage samples) {
  samples->clear();
}
void pglSampleStorageClearSurface(PGLSampleStorage samples) {
  samples->clear();
}
void pglSampleStorageClearVolume(PGLSampleStorage) {}
size_t pglSampleStorageGetSizeSurface(PGLSampleStorage samples) {
  return samples->size() - samples->inVolumes();
}
size_t pglSampleStorageGetSizeVolume(PGLSampleStorage samples) {
  return samples->inVolumes();
}
size_t pglSampleStorageGetSizeZeroValueSurface(PGLSampleStorage) {
  return 0;
}
size_t pglSampleStorageGetSizeZeroValueVolume(PGLSampleStorage) {
  return 0;
}
PGLSampleData pglSampleStorageGetSampleSurface(PGLSampleStorage samples, int index) {
  return sampleAt(*samples, index, false);
}
PGLSampleData pglSampleStorageGetSampleVolume(PGLSampleStorage samples, int index) {
  return sampleAt(*samples, index, true);
}
PGLZeroValueSampleData pglSampleStorageGetZeroValueSampleSurface(PGLSampleStorage, int) {
  return {};
}
PGLZeroValueSampleData pglSampleStorageGetZeroValueSampleVolume(PGLSampleStorage, int) {
  return {};
}
bool pglSampleStorageValidate(PGLSampleStorage) {
  return true;  // what is not finite was left out
}
void pglSampleStorageMerge(PGLSampleStorage samples, PGLSampleStorage others) {
  const odis::ArrayView<const odis::PathVertex> vertices = others->vertices();
  for (size_t begin = 0, end; begin < vertices.size(); begin = end) {
    for (end = begin + 1; end < vertices.size() && vertices[end].depth > vertices[end - 1].depth; ++end) {
    }
    samples->add({vertices.data() + begin, end - begin});
  }
}
bool pglSampleStorageCompare(PGLSampleStorage a, PGLSampleStorage b) {
  const std::vector<PGLSampleData> ofA = a->samples(), ofB = b->samples();
  return ofA.size() == ofB.size() && std::memcmp(ofA.data(), ofB.data(), ofA.size() * sizeof ofA[0]) == 0;
}

}  // extern "C"
