#include "eval/report.h"

#include <fmt/format.h>

#include <set>

#include "eval/exposure.h"
#include "eval/image_file.h"
#include "eval/metrics.h"
#include "eval/report_pictures.h"

namespace odis::eval {

using Json = nlohmann::ordered_json;

namespace {

// A scene's pictures share a reference and its exposure.
struct SceneView {
  ColorImage reference;
  double exposure = 1;
};

// Collects the embedded pictures as elements of the page, each with an id of its own.
class PictureStore {
 public:
  std::string add(const std::string& encoded) {
    const std::string id = fmt::format("picture-{}", m_count++);
    m_html +=
        fmt::format("<script type=\"text/plain\" class=\"picture\" id=\"{}\">{}</script>\n", id, encoded);
    return id;
  }
  size_t bytes() const { return m_html.size(); }
  const std::string& html() const { return m_html; }

 private:
  std::string m_html;
  int m_count = 0;
};

// The mean luminance as the page sees it: what relative errors are relative to.
double meanShown(const SceneView& view) {
  double sum = 0;
  for (const render::Rgb& pixel : view.reference.pixels) sum += render::luminance(pixel);
  const double mean = view.exposure * sum / double(view.reference.pixels.size());
  return mean > 0 ? mean : 1;
}

Json addPicture(PictureStore& store, const ComparisonRow& row, const ColorImage& image,
                const SceneView& view) {
  return {{"method", row.method},
          {"spp", row.spp},
          {"equalTime", row.equalTime},
          {"denoised", row.denoised},
          {"id", store.add(encodePicture(image, view.exposure))},
          {"flip", store.add(encodeMap(displayedFlip(image, view.reference), image.width, image.height))}};
}

// Where pictures come from: their scenes, what was measured, and the folder of the images.
struct PictureSources {
  const std::vector<SceneView>& views;
  const std::vector<ComparisonRow>& rows;
  const std::string& folder;
};

// The pictures of all scenes with these samples, filed under their scenes. Returns false and leaves
// everything as it was if they would make the page larger than `most`.
bool addSamples(PictureStore& store, Json& scenes, const PictureSources& sources, int spp, size_t most) {
  const auto& [views, rows, folder] = sources;
  PictureStore grown = store;
  Json grownScenes = scenes;
  for (size_t i = 0; i < views.size(); ++i) {
    const auto scene = scenes[i]["name"].get<std::string>();
    for (const ComparisonRow& row : rows) {
      if (row.isMean() || row.spp != spp || row.scene != scene || row.image.empty()) continue;
      const ColorImage image = readColor(folder + "/" + row.image);
      grownScenes[i]["pictures"].push_back(addPicture(grown, row, image, views[i]));
      if (grown.bytes() > most) return false;
    }
  }
  store = std::move(grown);
  scenes = std::move(grownScenes);
  return true;
}

void replace(std::string& page, const std::string& mark, std::string_view text) {
  const std::string braced = "{{" + mark + "}}";
  page.replace(page.find(braced), braced.size(), text);
}

// JSON within an element of the page: no "<" that could end it.
std::string safeText(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

std::string script() {
  std::string text;
  for (const char* name :
       {"picture.js", "viewer.js", "insets.js", "chart.js", "table.js", "overview.js", "main.js"})
    text += reportFile(name);
  return text;
}

}  // namespace

std::string reportPage(const Comparison& comparison, const std::vector<ComparisonRow>& rows, Json json,
                       const std::string& folder, size_t pictureBytes) {
  PictureStore store;
  std::vector<SceneView> views;
  Json scenes = json["scenes"];
  for (size_t i = 0; i < comparison.scenes.size(); ++i) {
    SceneView& view = views.emplace_back();
    view.reference = readColor(comparison.scenes[i].reference);
    view.exposure = autoExposure(view.reference);
    scenes[i]["mean"] = meanShown(view);
    scenes[i]["referencePicture"] = store.add(encodePicture(view.reference, view.exposure));
    scenes[i]["pictures"] = Json::array();
  }
  json["encoding"] = {{"scale", kPictureScale}, {"most", kPictureMost}};
  json["leftOut"] = Json::array();
  std::set<int> counts;
  for (const ComparisonRow& row : rows) counts.insert(row.spp);
  bool full = false;
  for (const int spp : counts) {
    const bool least = spp == *counts.begin();
    full = full || !addSamples(store, scenes, {views, rows, folder}, spp, least ? SIZE_MAX : pictureBytes);
    if (full) json["leftOut"].push_back(spp);
  }

  json["scenes"] = std::move(scenes);

  // What is put in last is never searched for marks.
  std::string page(reportFile("page.html"));
  replace(page, "script", script());
  replace(page, "pictures", store.html());
  replace(page, "data", safeText(json));
  replace(page, "style", reportFile("style.css"));
  return page;
}

}  // namespace odis::eval
