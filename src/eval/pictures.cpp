#include "eval/pictures.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "eval/image_file.h"
#include "eval/montage.h"
#include "render/image/write.h"

namespace odis::eval {

static void writePicture(const std::string& path, const ColorImage& image, float exposure) {
  render::writePng(path, image.width, image.height, image.pixels.data(), exposure);
}

void writePictures(const Comparison& comparison, const std::vector<ComparisonRow>& rows,
                   const std::string& folder, float exposure) {
  for (const SceneRecord& scene : comparison.scenes) {
    std::map<std::string, std::vector<ColorImage>> byName;
    for (const ComparisonRow& row : rows) {
      if (row.scene != scene.name || row.image.empty()) continue;
      const std::string path = folder + "/" + row.image;
      const ColorImage image = readColor(path);
      writePicture(std::filesystem::path(path).replace_extension(".png").string(), image, exposure);
      if (!row.equalTime)
        byName[fmt::format("{}-{}{}", scene.name, row.spp, row.denoised ? "-denoised" : "")].push_back(image);
    }
    for (auto& [name, images] : byName) {
      images.push_back(readColor(scene.reference));
      writePicture(fmt::format("{}/images/{}.png", folder, name), montage(images), exposure);
    }
  }
}

}  // namespace odis::eval
