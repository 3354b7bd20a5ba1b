#include "learn/scenes/generate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "learn/scenes/cameras.h"
#include "learn/scenes/write_scene.h"
#include "render/files/read_json.h"
#include "render/files/replace_file.h"

namespace odis::learn {

namespace fs = std::filesystem;

namespace {

// Raised when the same seed gives another scene than before.
constexpr int kVersion = 2;
// A draft that no camera sees anything of is thrown away.
constexpr int kDrafts = 30, kViewings = 3;

// Removed when it goes out of scope, unless it was renamed.
struct TemporaryFolder {
  std::string path;
  explicit TemporaryFolder(std::string path_) : path(std::move(path_)) {}
  ~TemporaryFolder() { remove(); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  void remove() const {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

uint64_t streamOf(uint64_t seed) {
  return Random(seed).fork("odis scenes").bits();
}

nlohmann::json summary(const Description& scene, uint64_t seed, int draft, const Assets& assets) {
  size_t lights = scene.balls.size() + scene.pointLights.size(), triangles = 0;
  for (const Ball& ball : scene.balls) lights -= render::isBlack(ball.radiance);
  for (const Part& part : scene.parts) {
    lights += !render::isBlack(part.radiance);
    triangles += part.mesh.triangles.size();
  }
  return {{"version", kVersion},
          {"kind", scene.kind},
          {"seed", seed},
          {"draft", draft},
          {"assets", assets.fingerprint()},
          {"scale", scene.scale},
          {"turn", scene.turn},
          {"exposure", scene.exposure},
          {"lights", lights},
          {"triangles", triangles},
          {"tags", scene.tags},
          {"roughness", scene.roughness},
          {"credits", scene.credits},
          {"views", scene.views.size()}};
}

// Brings a draft to paper: true if its views show something.
bool finish(Draft& draft, const std::string& folder) {
  Description& scene = draft.scene;
  Random random = draft.random.fork("finish");
  scene.turn = random.chance(0.6) ? 0 : float(random.range(0, 2 * M_PI));
  scene.scale = float(random.logRange(0.01, 1000));
  const auto target = float(random.logRange(0.06, 0.35));
  // Any camera will do to load the scene.
  scene.views = {View{}};
  writeContent(scene, folder);
  writeViews(scene, folder);
  render::Warnings warnings;
  const auto loaded = render::Scene::load(folder + "/scene.xml", {}, warnings);
  for (int viewing = 0; viewing < kViewings; ++viewing) {
    scene.exposure = 1;
    if (!chooseViews(scene, *loaded, random.fork(fmt::format("views {}", viewing)))) return false;
    if (!expose(scene, *loaded, target)) continue;
    writeContent(scene, folder, true);
    writeViews(scene, folder);
    return true;
  }
  return false;
}

void checkSame(const fs::path& folder, const Assets& assets) {
  const fs::path path = folder / "scene.json";
  nlohmann::json json;
  try {
    json = render::readJson<nlohmann::json>(path.string());
  } catch (const render::ReadError&) {
    // Refused below: a scene that was not made by the generator has no such file.
  }
  if (!json.is_object() || json.value("version", nlohmann::json()) != kVersion ||
      json.value("assets", "?") != assets.fingerprint())
    throw GenerateError(
        fmt::format("\"{}\" was made with other --hdri, --textures or --furniture, or by another "
                    "version; expected an empty folder or scenes made the same way",
                    folder.string()));
}

}  // namespace

const Kind& kindOf(uint64_t seed) {
  std::vector<double> shares;
  for (const Kind& kind : kinds()) shares.push_back(kind.share);
  return kinds()[Random(streamOf(seed)).fork("kind").weighted(shares)];
}

std::string sceneName(uint64_t seed, const Kind& kind) {
  return fmt::format("{:06}-{}", seed, kind.name);
}

void checkScene(uint64_t seed, const Kind& kind, const Assets& assets, const std::string& folder) {
  const fs::path final = fs::path(folder) / sceneName(seed, kind);
  if (fs::exists(final)) checkSame(final, assets);
}

bool generateScene(uint64_t seed, const Kind& kind, const Assets& assets, const std::string& folder) {
  const fs::path final = fs::path(folder) / sceneName(seed, kind);
  if (fs::exists(final)) {
    checkSame(final, assets);
    return false;
  }
  const TemporaryFolder temporary(fmt::format("{}.part-{}", final.string(), getpid()));
  for (int attempt = 0;; ++attempt) {
    if (attempt == kDrafts)
      throw std::runtime_error(fmt::format("no draft of {} shows anything", sceneName(seed, kind)));
    temporary.remove();
    Draft draft(kind.name, streamOf(seed) + uint64_t(attempt), assets);
    kind.build(draft);
    if (!finish(draft, temporary.path)) continue;
    writeFile(temporary.path + "/scene.json",
              summary(draft.scene, seed, attempt, assets)
                      .dump(1, ' ', false, nlohmann::json::error_handler_t::replace) +
                  "\n");
    break;
  }
  std::error_code error;
  fs::rename(temporary.path, final, error);
  if (!error) return true;
  if (fs::exists(final / "scene.json")) return false;  // another process was faster
  throw render::WriteError(fmt::format("cannot write \"{}\": {}", final.string(), error.message()));
}

}  // namespace odis::learn
