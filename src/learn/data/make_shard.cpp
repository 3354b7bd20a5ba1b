#include "learn/data/make_shard.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>

#include "learn/data/folder_settings.h"
#include "learn/scenes/generate.h"
#include "learn/scenes/random.h"
#include "odis/models/light_features.h"
#include "odis_version.h"
#include "render/files/read_json.h"
#include "render/files/replace_file.h"

namespace odis::learn {

namespace fs = std::filesystem;

namespace {

constexpr const char* kViewFiles[] = {"scene.xml", "scene-b.xml"};
constexpr double kValidationShare = 0.1;
constexpr const char* kScratchPrefix = "odis-scenes-";

// A folder for what is generated only to be looked at, gone at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    const std::string name = fmt::format("{}{}-{}-XXXXXX", kScratchPrefix, render::hostName(), getpid());
    std::string pattern = (fs::temp_directory_path() / name).string();
    if (!mkdtemp(pattern.data()))
      throw render::WriteError(
          fmt::format("cannot make the folder \"{}\": {}", pattern, std::strerror(errno)));
    m_path = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(m_path, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  const std::string& path() const { return m_path; }

 private:
  std::string m_path;
};

nlohmann::ordered_json toJson(const Vec3& v) {
  return {v.x, v.y, v.z};
}

nlohmann::ordered_json groupsJson(const render::LightSampler& lights) {
  nlohmann::ordered_json result = nlohmann::ordered_json::array();
  for (uint32_t group = 0; group < lights.groupCount(); ++group) {
    const render::LightGroup g = lights.describe(group);
    if (g.infinite)
      result.push_back({{"infinite", true},
                        {"lights", g.lights},
                        {"axis", toJson(g.bounds.axis)},
                        {"thetaO", g.bounds.thetaO},
                        {"irradiance", g.irradiance}});
    else
      result.push_back({{"infinite", false},
                        {"lights", g.lights},
                        {"min", toJson(g.bounds.min)},
                        {"max", toJson(g.bounds.max)},
                        {"axis", toJson(g.bounds.axis)},
                        {"thetaO", g.bounds.thetaO},
                        {"thetaE", g.bounds.thetaE},
                        {"phi", g.bounds.phi}});
  }
  return result;
}

// What the header says of every view; of lights nothing, yet.
nlohmann::ordered_json viewJson(const std::string& file, const render::Scene& scene, const ViewFrame& frame,
                                size_t pilots, size_t targets) {
  return {{"file", fs::path(file).filename().string()},
          {"width", scene.film().crop.width},
          {"height", scene.film().crop.height},
          {"origin", {frame.origin.x, frame.origin.y, frame.origin.z}},
          {"edge", frame.edge},
          {"unit", frame.unit},
          {"pilots", pilots},
          {"targets", targets},
          {"dividedLights", nlohmann::ordered_json::array()},
          {"lightGroups", nlohmann::ordered_json::array()}};
}

// How many pixels a view's image has: as many as the settings say, or, where windows are cut out of it, a
// number that is drawn, every size as likely as another.
int pixelsOf(const DataSettings& settings, Random& random) {
  const WindowSettings& windows = settings.windows;
  if (windows.count == 0) return settings.pixels;
  const double ratio = double(windows.mostPixels) / windows.leastPixels;
  return int(windows.leastPixels * std::pow(ratio, random.unit()));
}

// Adds a view's arrays, and returns what else there is to say of it.
nlohmann::ordered_json addView(ShardWriter& writer, const std::string& file, size_t view, uint64_t seed,
                               const DataSettings& settings) {
  Random random = Random(seed).fork(fmt::format("data of view {}", view));
  render::Warnings warnings;
  render::LoadOptions load;
  load.pixels = pixelsOf(settings, random);
  const auto scene = render::Scene::load(file, load, warnings);
  if (!scene->media().empty())
    throw render::SceneError({file}, "found participating media, expected none: data sets are of surfaces");
  const render::LightSampler lights(scene->emitters(), core::kFewGroups);
  if (settings.windows.count > 0) {
    const WindowView content =
        traceWindows(*scene, lights, settings.windows, settings.targets, settings.pilots, random.bits());
    addColumns(writer, view, content, settings.windows.size);
    return viewJson(file, *scene, content.frame, content.pilots.size(), content.targets.size());
  }
  std::vector<Pilot> pilots;
  for (int i = 0; i < settings.pilots; ++i) pilots.push_back(tracePilot(*scene, lights, random.bits()));
  const ViewFrame frame = frameOf(pilots);
  const std::vector<Target> targets =
      traceTargets(*scene, lights, pilots, frame, settings.targets, random.bits());
  for (size_t i = 0; i < pilots.size(); ++i) addColumns(writer, pilotPrefix(view, i), pilots[i], frame);
  addColumns(writer, targetPrefix(view), targets, lights.groupCount(), frame);

  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const LightParts& part : lights.dividedLights()) parts.push_back({part.first, part.count});
  nlohmann::ordered_json json = viewJson(file, *scene, frame, pilots.size(), targets.size());
  json["dividedLights"] = parts;
  json["lightGroups"] = groupsJson(lights);
  return json;
}

}  // namespace

nlohmann::ordered_json sceneJson(const std::string& folder) {
  try {
    auto json = render::readJson<nlohmann::ordered_json>(folder + "/scene.json");
    if (json.is_object()) return json;
  } catch (const render::ReadError&) {
    // A scene that was not generated has no such file.
  }
  return nlohmann::ordered_json::object();
}

DataSettings DataSettings::quick() {
  DataSettings settings;
  settings.pixels = 3072;
  settings.targets.cells = 48;
  settings.targets.pixels = 16;
  return settings;
}

DataSettings DataSettings::quality() {
  DataSettings settings;
  settings.pixels = 57600;
  settings.targets.cells = 768;
  settings.targets.pixels = 256;
  settings.targets.perTexel = 8;
  settings.targets.outgoing = 1024;
  settings.targets.lights = 4096;
  return settings;
}

DataSettings DataSettings::incidentRadiance() const {
  DataSettings settings = *this;
  settings.windows.count = std::max(1, targets.pixels / 4);
  // Half of the directions lie below most surfaces: 4,096 samples a map are traced, or twice as many.
  settings.targets.perTexel = std::min(4 * targets.perTexel, 16);
  settings.targets.cells = settings.targets.outgoing = settings.targets.lights = 0;
  return settings;
}

nlohmann::ordered_json toJson(const DataSettings& s) {
  if (s.windows.count > 0)
    return {{"kind", "incident-radiance"},
            {"leastPixels", s.windows.leastPixels},
            {"mostPixels", s.windows.mostPixels},
            {"windows", s.windows.count},
            {"windowSize", s.windows.size},
            {"middle", s.windows.middle},
            {"pilots", s.pilots},
            {"maxDepth", kDeepestPath},
            {"pixelTargets", s.targets.pixels},
            {"samplesPerTexel", s.targets.perTexel * kTargetTexels / kWindowMapTexels}};
  return {{"pixels", s.pixels},
          {"pilots", s.pilots},
          {"maxDepth", kDeepestPath},
          {"cellTargets", s.targets.cells},
          {"pixelTargets", s.targets.pixels},
          {"samplesPerTexel", s.targets.perTexel},
          {"outgoingSamples", s.targets.outgoing},
          {"lightSamples", s.targets.lights}};
}

Split splitOf(uint64_t seed) {
  return Random(seed).fork("split").unit() < kValidationShare ? Split::validation : Split::train;
}

const char* splitName(Split split) {
  return split == Split::train ? "train" : "validation";
}

uint64_t seedOfName(const std::string& name) {
  return Random(0).fork(name).bits();
}

std::string shardFile(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / (name + ".shard")).string();
}

std::string pilotPrefix(size_t view, size_t pilot) {
  return fmt::format("view{}/pilot{}/", view, pilot);
}

std::string targetPrefix(size_t view) {
  return fmt::format("view{}/target/", view);
}

ViewFrame viewFrame(const ShardReader& shard, size_t view) {
  const nlohmann::json& json = shard.header().at("views").at(view);
  const nlohmann::json& origin = json.at("origin");
  return {{origin.at(0), origin.at(1), origin.at(2)}, json.at("edge"), json.at("unit")};
}

std::vector<Pilot> readPilots(const ShardReader& shard, size_t view) {
  const uint64_t count = render::wholeNumber(shard.header().at("views").at(view).at("pilots"));
  const ViewFrame frame = viewFrame(shard, view);
  std::vector<Pilot> pilots;
  for (size_t i = 0; i < count; ++i) pilots.push_back(readColumns(shard, pilotPrefix(view, i), frame));
  return pilots;
}

void removeAbandoned(const std::string& folder) {
  const auto clear = [](const fs::path& from, const std::string& before) {
    const std::string mine = before + render::hostName() + "-";
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(from, ignored)) {
      const std::string name = entry.path().filename().string();
      const size_t at = name.find(mine);
      if (at == std::string::npos) continue;
      const int process = std::atoi(name.c_str() + at + mine.size());
      if (process > 0 && kill(process, 0) != 0 && errno == ESRCH) fs::remove_all(entry.path(), ignored);
    }
  };
  clear(folder, ".shard.part-");
  clear(fs::temp_directory_path(), kScratchPrefix);
}

bool makeShard(const ShardSource& source, const DataSettings& settings, const Assets& assets,
               const std::string& folder) {
  const std::string file = shardFile(folder, source.name);
  const nlohmann::ordered_json made = shardSettings(settings, assets, source.kind != nullptr);
  if (fs::exists(file)) {
    if (ShardHeader(file).header().value("settings", nlohmann::json()) != nlohmann::json(made))
      throw GenerateError(
          fmt::format("\"{}\" was made with other settings; expected an empty folder or "
                      "shards made the same way",
                      file));
    return false;
  }
  std::optional<ScratchFolder> scratch;
  std::string sceneFolder = source.folder;
  if (source.kind) {
    scratch.emplace();
    generateScene(source.seed, *source.kind, assets, scratch->path());
    sceneFolder = scratch->path() + "/" + sceneName(source.seed, *source.kind);
  }
  ShardWriter writer;
  nlohmann::ordered_json views = nlohmann::ordered_json::array();
  for (const char* view : kViewFiles)
    if (fs::exists(sceneFolder + "/" + view))
      views.push_back(addView(writer, sceneFolder + "/" + view, views.size(), source.seed, settings));
  const nlohmann::ordered_json header = {{"software", "ODIS " ODIS_VERSION_STRING},
                                         {"name", source.name},
                                         {"seed", source.seed},
                                         {"split", splitName(splitOf(source.seed))},
                                         {"settings", made},
                                         {"scene", sceneJson(sceneFolder)},
                                         {"views", views}};
  try {
    writer.write(file, header);
  } catch (const render::WriteError&) {
    // Another process made the same shard meanwhile, and may have removed this one's unfinished file as a
    // left-over.
    if (!fs::exists(file)) throw;
    return false;
  }
  return true;
}

}  // namespace odis::learn
