// The meshes, images and grids of volumes that a scene names, read by all threads ahead of those who ask for
// them.
#pragma once

#include <tbb/task_group.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "render/image/image.h"
#include "render/medium/volume_file.h"
#include "render/shape/mesh.h"
#include "render/xml/properties.h"

namespace odis::render {

// Work that is done by the first thread to begin it: one that has nothing else to do, or the one that needs
// the result.
template <class Result>
class EarlyWork {
 public:
  explicit EarlyWork(std::function<Result()> work) : m_work(std::move(work)), m_result(m_work.get_future()) {}

  void begin() {
    if (!m_begun.exchange(true)) m_work();
  }
  // Once. Throws what the work has thrown.
  Result take() {
    begin();
    return m_result.get();
  }

 private:
  std::packaged_task<Result()> m_work;
  std::future<Result> m_result;
  std::atomic<bool> m_begun = false;
};

// Whoever asks gets what the reader gave, its warnings and errors included, as if the file were read only
// then. All members are called by one thread.
class FilesAhead {
 public:
  // How many bytes of mesh files may be read before their meshes are taken. A mesh is about as large as its
  // file.
  static constexpr uint64_t kMostBytesWaiting = 128 << 20;

  explicit FilesAhead(uint64_t mostBytesWaiting = kMostBytesWaiting) : m_mostBytesWaiting(mostBytesWaiting) {}
  ~FilesAhead();

  // Looks for files in the element and all that it holds, and begins to read them in that order. Files that
  // are not found are left to those who ask for them.
  void begin(const Properties& root, const std::vector<std::string>& folders);

  // What a file holds, each once; nothing if it was taken before, or if begin() has not found it.
  std::optional<MeshData> takeMesh(const Properties& shape, Warnings& warnings);
  std::shared_ptr<const Image> takeImage(const std::string& path, bool srgb);
  std::optional<VolumeFile> takeVolume(const Properties& volume);

 private:
  struct ReadMesh {
    MeshData data;
    Warnings warnings;
  };
  struct Mesh {
    Mesh(std::function<ReadMesh()> read, uint64_t fileBytes) : work(std::move(read)), bytes(fileBytes) {}

    EarlyWork<ReadMesh> work;
    uint64_t bytes;  // of the file
    bool begun = false, taken = false;
  };
  using Grid = EarlyWork<VolumeFile>;
  using Picture = EarlyWork<std::shared_ptr<const Image>>;

  void find(const Properties& node, const std::vector<std::string>& folders);
  void findMesh(const Properties& shape, const std::vector<std::string>& folders);
  void findImage(const Properties& node, const std::vector<std::string>& folders);
  void findVolume(const Properties& node, const std::vector<std::string>& folders);
  // Lets more meshes be read, unless there are many that nobody has taken yet.
  void readOn();

  std::unordered_set<const Properties*> m_seen;
  std::vector<std::shared_ptr<Mesh>> m_queue;  // in the order of the scene
  size_t m_next = 0;                           // the first of these that has not begun to be read
  uint64_t m_mostBytesWaiting, m_bytesWaiting = 0;
  std::unordered_map<const Properties*, std::shared_ptr<Mesh>> m_meshes;
  std::unordered_map<std::string, std::shared_ptr<Picture>> m_images;
  std::unordered_map<const Properties*, std::shared_ptr<Grid>> m_volumes;
  tbb::task_group m_tasks;
};

// The name under which an image is kept: it differs with how the file is decoded.
std::string imageKey(const std::string& path, bool srgb);

}  // namespace odis::render
