#include "learn/train/validation.h"

#include <odis/guide.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <mutex>

#include "learn/data/make_shard.h"

namespace odis::learn {

namespace {

// Judged by vertices that it has not seen: none of its samples is to be taken out again.
class Unseen : public DirectionModel {
 public:
  explicit Unseen(std::shared_ptr<const DirectionModel> model) : m_model(std::move(model)) {}
  DirectionDistribution predict(const CellChain& chain, const DirectionDistribution* parent) const override {
    DirectionDistribution result = m_model->predict(chain, parent);
    result.sensitivity = 0;
    return result;
  }
  bool looksAround() const override { return m_model->looksAround(); }

 private:
  std::shared_ptr<const DirectionModel> m_model;
};

// What contributions are divided by: the luminance of all pilots around each pixel, with a little of the whole image's.
std::vector<float> pixelValues(const std::vector<Pilot>& pilots, int width, int height) {
  constexpr int kReach = 2;
  constexpr float kShareOfImage = 0.05f;
  const size_t pixels = size_t(width) * size_t(height);
  std::vector<float> mean(pixels), values(pixels);
  double image = 0;
  for (const Pilot& pilot : pilots)
    for (size_t i = 0; i < pixels; ++i) {
      const render::Rgb& c = pilot.image[i];
      mean[i] += luminance(Float3{c.x, c.y, c.z}) / float(pilots.size());
    }
  for (const float value : mean) image += value;
  image /= double(pixels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float sum = 0, count = 0;
      for (int v = std::max(y - kReach, 0); v <= std::min(y + kReach, height - 1); ++v)
        for (int u = std::max(x - kReach, 0); u <= std::min(x + kReach, width - 1); ++u) {
          sum += mean[size_t(v) * size_t(width) + size_t(u)];
          ++count;
        }
      values[size_t(y) * size_t(width) + size_t(x)] = sum / count + kShareOfImage * float(image);
    }
  return values;
}

double varianceOf(const ShardReader& shard, size_t view, const std::shared_ptr<const DirectionModel>& model) {
  const nlohmann::json& header = shard.header().at("views").at(view);
  const ViewFrame frame = viewFrame(shard, view);
  std::vector<Pilot> pilots;
  for (size_t i = 0; i < header.at("pilots").get<size_t>(); ++i)
    pilots.push_back(readColumns(shard, pilotPrefix(view, i), frame));
  if (pilots.size() < 2) return 1;
  const std::vector<float> values = pixelValues(pilots, header.at("width"), header.at("height"));
  GuideOptions options;
  options.model = model;
  GuideBuilder builder(options);
  std::vector<std::span<const PilotVertex>> seen;
  for (size_t i = 0; i + 1 < pilots.size(); ++i) seen.emplace_back(pilots[i].vertices);
  builder.add(seen);
  return builder.build(pilots.back().vertices, values).predictedVarianceRatio();
}

}  // namespace

double predictedVariance(const std::vector<std::string>& shardFiles,
                         const std::shared_ptr<const DirectionModel>& model) {
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
