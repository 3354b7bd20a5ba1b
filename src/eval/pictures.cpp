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
    std::map<int, std::vector<ColorImage>> bySpp;
    for (const ComparisonRow& row : rows) {
      if (row.scene != scene.name || row.image.empty()) continue;
      const std::string path = folder + "/" + row.image;
      const ColorImage image = readColor(path);
      writePicture(std::filesystem::path(path).replace_extension(".png").string(), image, exposure);
      if (!row.equalTime) bySpp[row.spp].push_back(image);
    }
    for (auto& [spp, images] : bySpp) {
      images.push_back(readColor(scene.reference));
      writePicture(fmt::format("{}/images/{}-{}.png", folder, scene.name, spp), montage(images), exposure);
    }
  }
}

}  // namespace odis::eval
