#include "learn/scenes/assets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "learn/scenes/shrink.h"
#include "render/files/input_file.h"

namespace odis::learn {

namespace fs = std::filesystem;

namespace {

// Larger models would make a scene's files large.
constexpr int kDeepest = 8;  // of folders within each other
constexpr uintmax_t kMostModelBytes = 400'000;

std::string lower(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// All files with one of the endings, sorted by their path within the folder.
std::vector<std::string> filesIn(const std::string& folder, const char* option,
                                 std::initializer_list<const char*> endings, uintmax_t most) {
  if (!fs::is_directory(folder))
    throw AssetError(fmt::format("{}: there is no folder \"{}\"", option, folder));
  std::vector<std::string> result;
  std::string expected;
  for (const char* ending : endings) expected += (expected.empty() ? "" : ", ") + std::string(ending);
  fs::recursive_directory_iterator all(folder, fs::directory_options::follow_directory_symlink);
  for (const fs::directory_entry& entry : all) {
    std::error_code ignored;
    // A folder that links lead back to has no end.
    if (all.depth() > kDeepest) all.disable_recursion_pending();
    if (!entry.is_regular_file(ignored) || entry.file_size(ignored) > most) continue;
    const std::string ending = lower(entry.path().extension().string());
    if (std::find(endings.begin(), endings.end(), ending) != endings.end())
      result.push_back(fs::relative(entry.path(), folder).generic_string());
  }
  if (result.empty())
    throw AssetError(
        fmt::format("{}: the folder \"{}\" holds none of what is expected: {}", option, folder, expected));
  std::sort(result.begin(), result.end());
  return result;
}

void addToHash(uint64_t& hash, const std::string& folder, const std::vector<std::string>& files) {
  for (const std::string& file : files)
    for (const char c : fmt::format("{} {}\n", file, fs::file_size(fs::path(folder) / file)))
      hash = (hash ^ uint8_t(c)) * 0x100000001b3ull;
}

// Maps of something else than a colour, as their names tell.
bool isNoColor(const std::string& file) {
  const std::string name = lower(file);
  for (const char* word : {"normal", "rough", "displace", "metalness", "height", "bump", "_ao", "opacity"})
    if (name.find(word) != std::string::npos) return true;
  return false;
}

// The lines of catalog.tsv by their file; see scripts/furniture.
std::map<std::string, FurnitureModel> readCatalog(const fs::path& path) {
  std::map<std::string, FurnitureModel> result;
  if (!fs::exists(path)) return result;
  std::istringstream stream;
  try {
    stream.str(render::readFile(path.string()));
  } catch (const render::ReadError& error) {
    throw AssetError(fmt::format("--furniture: cannot read \"{}\": {}", path.string(), error.what()));
  }
  for (std::string line; std::getline(stream, line);) {
    std::istringstream fields(line);
    FurnitureModel model;
    std::string file, numbers[4];
    std::getline(fields, file, '\t');
    for (std::string& number : numbers) std::getline(fields, number, '\t');
    std::getline(fields, model.category, '\t');
    std::getline(fields, model.name, '\t');
    std::getline(fields, model.credit, '\t');
    float* const values[4] = {&model.width, &model.depth, &model.height, &model.elevation};
    for (int i = 0; i < 4; ++i) *values[i] = std::strtof(numbers[i].c_str(), nullptr);
    if (!file.empty() && file[0] != '#') result[file] = model;
  }
  return result;
}

// What stands in no room: doors, stairs, roofs, vehicles.
bool isNoFurniture(const FurnitureModel& model) {
  const std::string text = lower(model.category + " " + model.name);
  for (const char* word :
       {"door", "window", "stair", "roof", "vehicle", "exterior", "light", "lamp", "people", "character"})
    if (text.find(word) != std::string::npos) return true;
  return false;
}

}  // namespace

Assets::Assets(const std::string& hdri, const std::string& textures, const std::string& furniture) {
  uint64_t hash = 0xcbf29ce484222325ull;
  const auto full = [](const std::string& folder, std::vector<std::string> files) {
    for (std::string& file : files) file = (fs::path(folder) / file).string();
    return files;
  };
  if (!hdri.empty()) {
    const std::vector<std::string> files = filesIn(hdri, "--hdri", {".hdr", ".exr"}, UINTMAX_MAX);
    addToHash(hash, hdri, files);
    m_hdris = full(hdri, files);
  }
  if (!textures.empty()) {
    std::vector<std::string> files = filesIn(textures, "--textures", {".png", ".jpg", ".jpeg"}, UINTMAX_MAX);
    std::erase_if(files, isNoColor);
    addToHash(hash, textures, files);
    m_textures = full(textures, files);
  }
  if (!furniture.empty()) {
    const std::vector<std::string> files = filesIn(furniture, "--furniture", {".obj"}, kMostModelBytes);
    const std::map<std::string, FurnitureModel> catalog = readCatalog(fs::path(furniture) / "catalog.tsv");
    addToHash(hash, furniture, files);
    for (const std::string& file : files) {
      const auto known = catalog.find(file);
      FurnitureModel model = known == catalog.end() ? FurnitureModel{} : known->second;
      if (model.name.empty()) model.name = fs::path(file).stem().string();
      model.path = (fs::path(furniture) / file).string();
      if (!isNoFurniture(model)) m_furniture.push_back(std::move(model));
    }
  }
  if (!hdri.empty() || !textures.empty() || !furniture.empty()) m_fingerprint = fmt::format("{:016x}", hash);
}

std::string Assets::cached(const std::string& path, std::string (*read)(const std::string&)) const {
  const std::lock_guard lock(m_mutex);
  const auto known = m_cache.find(path);
  if (known != m_cache.end()) return known->second;
  return m_cache[path] = read(path);
}

std::string Assets::texture(const std::string& path) const {
  return cached(path, shrunkTexture);
}

bool Assets::isVivid(const std::string& path) const {
  const std::lock_guard lock(m_mutex);
  const auto known = m_vivid.find(path);
  if (known != m_vivid.end()) return known->second;
  return m_vivid[path] = isVividTexture(path);
}

std::string Assets::environment(const std::string& path) const {
  return cached(path, shrunkEnvironment);
}

}  // namespace odis::learn
