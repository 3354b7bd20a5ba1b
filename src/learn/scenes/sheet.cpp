#include "learn/scenes/sheet.h"

#include <algorithm>
#include <filesystem>

#include "render/scene/scene.h"

namespace odis::learn {

using render::Rgb;

namespace {

constexpr int kGap = 4, kTextHeight = 12;
const Rgb kBackground(0.02f), kInk(0.7f);

}  // namespace

std::vector<std::string> scenesIn(const std::string& folder) {
  if (!std::filesystem::is_directory(folder))
    throw render::SceneError({}, "there is no folder \"" + folder + "\", expected one with scenes in it");
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (std::filesystem::exists(entry.path() / "scene.xml") &&
        entry.path().filename().string().find(".part-") == std::string::npos)
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

SheetPainter::SheetPainter(const SheetOptions& options, size_t count) : m_options(options) {
  const int columns = int(std::min(count, size_t(options.columns))),
            rows = int((count + size_t(columns) - 1) / size_t(columns));
  m_cellHeight = options.width * 3 / 4 + kTextHeight + kGap;
  m_sheet = Canvas(columns * (options.width + kGap) + kGap, rows * m_cellHeight + kGap, kBackground);
}

bool SheetPainter::add(const std::string& folder, const std::string& name, render::Progress& progress) {
  const std::string path = folder + "/" + name + "/scene.xml";
  render::Warnings warnings;
  const render::FilmSettings film = render::Scene::load(path, {}, warnings)->film();
  const int height = std::clamp(m_options.width * film.height / film.width, 1, m_options.width * 3 / 4);
  render::LoadOptions load;
  load.resolution = render::Vec2i(std::max(1, height * film.width / film.height), height);
  const auto scene = render::Scene::load(path, load, warnings);
  render::RenderOptions options;
  options.integrator = render::IntegratorKind::path;
  options.spp = m_options.spp;
  options.maxDepth = scene->integrator().maxDepth;
  options.rrDepth = scene->integrator().rrDepth;
  const render::RenderResult result = render::render(*scene, options, progress);
  if (result.stats.interrupted) return false;

  const int column = int(m_next % size_t(m_options.columns)), row = int(m_next / size_t(m_options.columns));
  const int left = kGap + column * (m_options.width + kGap) + (m_options.width - result.image.width) / 2;
  const int top = kGap + row * m_cellHeight;
  for (int y = 0; y < result.image.height; ++y)
    std::copy_n(result.image.color.begin() + std::ptrdiff_t(y) * result.image.width, result.image.width,
                m_sheet.pixels.begin() + (std::ptrdiff_t(top) + y) * m_sheet.width + left);
  m_sheet.write(kGap + column * (m_options.width + kGap), top + m_options.width * 3 / 4 + 2, m_options.width,
                name, kInk);
  ++m_next;
  return true;
}

}  // namespace odis::learn
