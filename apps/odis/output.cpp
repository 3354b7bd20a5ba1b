#include "output.h"

#include <fmt/format.h>

#include <filesystem>
#include <list>
#include <sstream>

#include "command.h"
#include "render/files/replace_file.h"

namespace odis::app {

using namespace render;

Layers parseLayers(const std::string& text) {
  Layers layers;
  const std::pair<const char*, bool*> known[] = {{"alpha", &layers.alpha},   {"albedo", &layers.albedo},
                                                 {"normal", &layers.normal}, {"position", &layers.position},
                                                 {"depth", &layers.depth},   {"roughness", &layers.roughness},
                                                 {"guide", &layers.guide}};
  std::istringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');) {
    bool found = false;
    for (const auto& [layer, wanted] : known)
      if (name == "all" || name == layer) found = *wanted = true;
    if (!found)
      throw UsageError(fmt::format(
          "--aov: found \"{}\", expected alpha, albedo, normal, position, depth, roughness, guide or "
          "all",
          name));
  }
  return layers;
}

bool endsWith(const std::string& path, const std::string& ending) {
  return path.size() >= ending.size() &&
         path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

void Outputs::add(const std::string& path, std::initializer_list<const char*> endings) {
  std::string expected;
  bool known = endings.size() == 0;
  for (const char* ending : endings) {
    known = known || endsWith(path, ending);
    expected += expected.empty() ? ending : std::string(" or ") + ending;
  }
  const OutputPath output = checkOutput(path);
  // What is no file, such as /dev/stdout, has no ending that says a format.
  if (!known && output.isRegular)
    throw UsageError(fmt::format("{}: expected a name that ends in {}", path, expected));
  if (output.isCharacter) return;
  const FileIdentity identity = identityOf(output);
  for (const Output& other : m_outputs)
    if (other.identity == identity)
      throw UsageError(fmt::format("two outputs are one file: \"{}\" and \"{}\", expected another for each",
                                   other.name, path));
  m_outputs.push_back({path, identity});
}

void Outputs::rejectInputs(const std::vector<std::string>& inputs) const {
  for (const std::string& input : inputs) {
    const std::optional<FileIdentity> identity = identityOfFile(input);
    for (const Output& output : m_outputs)
      if (identity && output.identity == *identity)
        throw UsageError(
            fmt::format("the output \"{}\" would replace \"{}\", which is read; expected another name",
                        output.name, input));
  }
}

WrittenFiles::WrittenFiles(const std::vector<std::string>& paths) {
  std::error_code unknown;
  for (const std::string& path : paths)
    if (!path.empty()) m_files.push_back({path, std::filesystem::is_regular_file(path, unknown)});
}

std::string WrittenFiles::text(const std::string& first) const {
  std::string text;
  for (const File& file : m_files)
    text += fmt::format("{}: {}{}\n", file.path, file.replaces ? "replaced" : "written",
                        text.empty() ? " " + first : "");
  return text;
}

namespace {

// The channels of a file and the planes that they point to.
class Planes {
 public:
  template <typename Vector>
  void add(const std::string& prefix, const char* components, const std::vector<Vector>& pixels, bool half) {
    for (int i = 0; i < 3 && !pixels.empty(); ++i) {
      std::vector<float>& plane = m_planes.emplace_back();
      plane.reserve(pixels.size());
      for (const Vector& pixel : pixels) plane.push_back(pixel[i]);
      m_channels.push_back({prefix + components[i], plane.data(), half});
    }
  }
  void add(const std::string& name, const std::vector<float>& plane, bool half) {
    if (!plane.empty()) m_channels.push_back({name, plane.data(), half});
  }
  const std::vector<ImageChannel>& channels() const { return m_channels; }

 private:
  std::list<std::vector<float>> m_planes;  // a list: they must not move
  std::vector<ImageChannel> m_channels;
};

}  // namespace

void writeLayers(const std::string& path, const RenderedImage& frame, const FilmSettings& film,
                 const Layers& layers, const std::map<std::string, std::string>& metadata) {
  Planes planes;
  planes.add("", "RGB", frame.color, false);
  // Other programs take A together with R, G and B, and expect one type of all.
  if (layers.alpha) planes.add("A", frame.alpha, false);
  planes.add("noisy.", "RGB", frame.noisy, false);
  planes.add("variance.", "RGB", frame.variance, false);
  if (layers.albedo) planes.add("albedo.", "RGB", frame.albedo, true);
  if (layers.normal) planes.add("N.", "XYZ", frame.normal, true);
  if (layers.position) planes.add("P.", "XYZ", frame.position, false);
  if (layers.depth) planes.add("depth.Z", frame.depth, false);
  if (layers.roughness) planes.add("roughness.Y", frame.roughness, true);
  if (layers.guide) {
    planes.add("guide.alpha", frame.guideBsdfFraction, true);
    planes.add("guide.entropy", frame.guideEntropy, true);
    planes.add("guide.survival", frame.guideSurvival, true);
    planes.add("guide.cell", frame.guideCell, false);
    planes.add("guide.samples", frame.guideSamples, false);
  }
  writeExr(path, {film.width, film.height, frame.x, frame.y, frame.width, frame.height}, planes.channels(),
           metadata);
}

void writePreview(const std::string& path, const RenderedImage& frame, float exposure) {
  writePng(path, frame.width, frame.height, frame.color.data(), exposure);
}

void writeColors(const std::string& path, int width, int height, const std::vector<Rgb>& colors,
                 ToneMap toneMap) {
  if (endsWith(path, ".png")) return writePng(path, width, height, colors.data(), 0, toneMap);
  RenderedImage image;
  FilmSettings film;
  film.width = image.width = width;
  film.height = image.height = height;
  image.color = colors;
  writeLayers(path, image, film, {}, {});
}

void writeText(const std::string& path, const std::string& text) {
  writeFile(path, text);
}

}  // namespace odis::app
