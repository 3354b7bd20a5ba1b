#include "learn/train/validation.h"

#include <odis/pixel_sums.h>
#include <tbb/parallel_for.h>
#include "odis/guide.h"

#include <cmath>
#include <mutex>

#include "learn/data/make_shard.h"
#include "odis/models/model.h"
#include "render/files/read_json.h"

namespace odis::learn {

namespace {

// Judged by vertices that it has not seen: none of its samples is to be taken out again.
class Unseen : public core::DirectionModel {
 public:
  explicit Unseen(std::shared_ptr<const core::DirectionModel> model) : m_model(std::move(model)) {}
  core::DirectionDistribution predict(const core::CellChain& chain,
                                      const core::DirectionDistribution* parent) const override {
    core::DirectionDistribution result = m_model->predict(chain, parent);
    result.sensitivity = 0;
    return result;
  }
  bool looksAround() const override { return m_model->looksAround(); }

 private:
  std::shared_ptr<const core::DirectionModel> m_model;
};

// Each pixel's luminance, estimated from all pilots.
std::vector<float> pixelValues(const std::vector<Pilot>& pilots, uint32_t width) {
  std::vector<PixelSums> image(pilots.front().image.size());
  for (const Pilot& pilot : pilots)
    for (size_t i = 0; i < image.size(); ++i) {
      const render::Rgb& value = pilot.image[i];
      addSample(image[i], {value.x, value.y, value.z}, 0);
    }
  return estimatePixelValues(image, width);
}

double varianceOf(const ShardReader& shard, size_t view,
                  const std::shared_ptr<const core::DirectionModel>& model) {
  const nlohmann::json& header = shard.header().at("views").at(view);
  const std::vector<Pilot> pilots = readPilots(shard, view);
  if (pilots.size() < 2) return 1;
  const std::vector<float> values = pixelValues(pilots, int(render::wholeNumber(header.at("width"))));
  core::GuideOptions options;
  options.model = core::Model{model, nullptr, nullptr};
  core::GuideBuilder builder(options);
  std::vector<ArrayView<const PathVertex>> seen;
  for (size_t i = 0; i + 1 < pilots.size(); ++i) seen.emplace_back(pilots[i].vertices);
  builder.addGuided(seen);  // to the cells alone
  const std::vector<PathVertex>& last = pilots.back().vertices;
  core::VertexSamples judged = builder.takeUnguided(last, last.size());
  builder.addToFractions({&judged, 1});
  return builder.build(values).predictedVarianceRatio();
}

}  // namespace

double predictedVariance(const std::vector<std::string>& shardFiles,
                         const std::shared_ptr<const core::DirectionModel>& model) {
  const auto unseen = std::make_shared<Unseen>(model);
  std::vector<std::pair<double, size_t>> sums(shardFiles.size());  // of logarithms, and of how many
  tbb::parallel_for(size_t(0), shardFiles.size(), [&](size_t i) {
    const ShardReader shard(shardFiles[i]);
    for (size_t view = 0; view < shard.header().at("views").size(); ++view) {
      sums[i].first += std::log(varianceOf(shard, view, unseen));
      ++sums[i].second;
    }
  });
  double sum = 0, count = 0;
  for (const auto& [logarithms, views] : sums) {
    sum += logarithms;
    count += double(views);
  }
  return count > 0 ? std::exp(sum / count) : 1;
}

}  // namespace odis::learn
