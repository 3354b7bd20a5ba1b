// Which shards there are to make, and making them side by side.
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <climits>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <random>
#include <thread>

#include "learn/data/dataset.h"
#include "learn/data/make_shard.h"
#include "learn/scenes/generate.h"
#include "learn/scenes/sheet.h"
#include "render/files/replace_file.h"

namespace odis::learn {

namespace fs = std::filesystem;

std::vector<ShardSource> seedSources(uint64_t first, uint64_t last) {
  std::vector<ShardSource> sources;
  for (uint64_t seed = first;; ++seed) {
    const Kind& kind = kindOf(seed);
    sources.push_back({sceneName(seed, kind), seed, &kind, ""});
    if (seed == last) return sources;
  }
}

std::vector<ShardSource> folderSources(const std::string& folder) {
  std::vector<ShardSource> sources;
  constexpr size_t kLongestName = NAME_MAX - 6;  // with .shard
  for (const std::string& name : scenesIn(folder)) {
    if (name.size() > kLongestName)
      throw render::SceneError(
          {}, fmt::format("the scene \"{}\" gives its name to a shard, expected at most {} letters", name,
                          kLongestName));
    const std::string path = (fs::path(folder) / name).string();
    const nlohmann::ordered_json json = sceneJson(path);
    const bool generated = json.contains("seed") && json["seed"].is_number_unsigned();
    sources.push_back({name, generated ? json["seed"].get<uint64_t>() : seedOfName(name), nullptr, path});
  }
  if (sources.empty())
    throw render::SceneError(
        {}, fmt::format("the folder \"{}\" holds no scenes, expected folders with a scene.xml", folder));
  return sources;
}

std::vector<ShardSource> partOf(const std::vector<ShardSource>& sources, int first, int last, int count) {
  const auto begin = [&](int part) { return std::ptrdiff_t(sources.size() * size_t(part) / size_t(count)); };
  return {sources.begin() + begin(first - 1), sources.begin() + begin(last)};
}

void makeShards(const std::vector<ShardSource>& sources, const DataSettings& settings, const Assets& assets,
                const std::string& folder, int jobs, ShardObserver& observer) {
  removeAbandoned(folder);
  // In an order of its own: several processes with the same task hardly ever make the same shard at the
  // same time.
  std::vector<size_t> order(sources.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::shuffle(order.begin(), order.end(), std::mt19937_64(std::random_device()()));
  std::atomic<size_t> next{0};
  std::atomic<bool> full{false};
  std::mutex mutex;
  std::exception_ptr writeError;
  const auto work = [&] {
    // A scene is small: many threads on one would wait for each other more than they work.
    tbb::task_arena alone(1);
    for (size_t i = next++; i < sources.size() && !full && !observer.cancelled(); i = next++) {
      const ShardSource& source = sources[order[i]];
      try {
        const bool made = alone.execute([&] { return makeShard(source, settings, assets, folder); });
        const std::lock_guard lock(mutex);
        observer.done(source, made);
      } catch (const render::WriteError&) {
        const std::lock_guard lock(mutex);
        writeError = std::current_exception();
        full = true;
      } catch (const std::exception& e) {
        const std::lock_guard lock(mutex);
        observer.failed(source, e.what());
      }
    }
  };
  std::vector<std::jthread> workers;
  for (int i = 1; i < jobs; ++i) workers.emplace_back(work);
  work();
  workers.clear();
  if (writeError) std::rethrow_exception(writeError);
}

}  // namespace odis::learn
