#include "learn/train/example_pool.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <utility>

#include "learn/scenes/random.h"
#include "odis/maps/texel_directions.h"
#include "odis/weights/weights.h"
#include "render/files/read_json.h"

namespace odis::learn {

namespace fs = std::filesystem;

namespace {

// The format of files of examples: counts up whenever the arrays of ViewExamples change. Version 1 wrote no
// number.
constexpr uint32_t kExampleFormat = 2;

std::string viewPrefix(size_t view) {
  return fmt::format("view{}/", view);
}

}  // namespace

std::vector<ViewExamples> ExamplePool::load(const std::string& shardFile, std::string& originText) const {
  const fs::path source(shardFile), kept = fs::path(m_folder) / (source.stem().string() + ".examples");
  // What was kept is of use if it was made of this very shard: its header has the length of every array.
  const nlohmann::ordered_json origin = {{"bytes", fs::file_size(source)},
                                         {"header", crc32(ShardHeader(shardFile).header().dump())}};
  originText = origin.dump();
  std::vector<ViewExamples> views;
  if (fs::exists(kept)) {
    const ShardReader reader(kept.string());
    if (reader.header().value("origin", nlohmann::json()) == nlohmann::json(origin) &&
        reader.header().value("format", nlohmann::json(1)) == kExampleFormat &&
        reader.header().value("features", nlohmann::json()) == core::kFeatureVersion) {
      for (size_t v = 0; v < render::wholeNumber(reader.header().at("views")); ++v)
        views.push_back(readExamples(reader, viewPrefix(v)));
      return views;
    }
  }
  views = makeExamples(ShardReader(shardFile));
  ShardWriter writer;
  for (size_t v = 0; v < views.size(); ++v) addColumns(writer, viewPrefix(v), views[v]);
  writer.write(kept.string(), {{"origin", origin},
                               {"format", kExampleFormat},
                               {"features", core::kFeatureVersion},
                               {"views", views.size()}});
  return views;
}

void ExamplePool::add(const std::vector<std::string>& shardFiles) {
  fs::create_directories(m_folder);
  std::vector<std::vector<ViewExamples>> added(shardFiles.size());
  std::vector<std::string> origins(shardFiles.size());
  tbb::parallel_for(size_t(0), shardFiles.size(),
                    [&](size_t i) { added[i] = load(shardFiles[i], origins[i]); });
  for (const std::string& origin : origins) m_origins += origin;
  for (std::vector<ViewExamples>& views : added)
    for (ViewExamples& view : views) {
      for (size_t i = 0; i < view.count; ++i) {
        float mass = 0;
        for (size_t t = 0; t < kMapTexels; ++t) mass += float(view.mass[i * kMapTexels + t]);
        // The smallest pilot knows something of a place, and some light arrives there.
        const Place place(uint32_t(m_views.size()), uint32_t(i));
        const bool known = view.statistics[i * kCellLevels].count > 0;
        if (known && mass > 0.5f) m_usable.push_back(place);
        const float* rms = &view.lightRms[i * view.groups];
        if (known && view.groups > 1 && std::accumulate(rms, rms + view.groups, 0.0f) > 0)
          m_lit.push_back(place);
      }
      m_views.push_back(std::move(view));
    }
}

void ExamplePool::draw(uint64_t seed, uint64_t step, size_t count, double shiftProbability,
                       DirectionBatch& batch) const {
  batch.count = count;
  batch.scalars.resize(count * core::kCellScalars);
  batch.basis.resize(count * core::kBasisMaps * kMapTexels);
  batch.there.resize(count * core::kBasisMaps);
  for (std::vector<float>* maps : {&batch.inverseCosine, &batch.diffuse, &batch.mass, &batch.square})
    maps->resize(count * kMapTexels);
  const Random stream = Random(seed).fork(fmt::format("step {}", step));
  tbb::parallel_for(size_t(0), count, [&](size_t row) {
    Random random = stream.fork(fmt::format("{}", row));
    const auto [viewIndex, example] = random.pick(std::span(m_usable));
    const ViewExamples& view = m_views[viewIndex];
    const int variant = random.integer(0, kInputVariants - 1);
    const bool shift = random.chance(shiftProbability);
    ViewExamples::Storage storage;
    core::CellFeatures features;
    core::computeFeatures(view.chain(variant, example, shift, storage), features);
    std::copy(features.scalars.begin(), features.scalars.end(), &batch.scalars[row * core::kCellScalars]);
    for (size_t m = 0; m < core::kBasisMaps; ++m) {
      const core::Histogram map = core::basisMap(features, int(m));
      std::copy(map.begin(), map.end(), &batch.basis[(row * core::kBasisMaps + m) * kMapTexels]);
      batch.there[row * core::kBasisMaps + m] = features.there[m];
    }
    float cosines = 0;
    for (const float cosine : features.cosines) cosines += std::max(cosine, 0.0f) + 1e-4f;
    for (size_t t = 0; t < kMapTexels; ++t) {
      const size_t at = row * kMapTexels + t;
      batch.inverseCosine[at] = core::inverseCosine(features.cosines[t]);
      batch.diffuse[at] = (std::max(features.cosines[t], 0.0f) + 1e-4f) / cosines;
      batch.mass[at] = view.mass[example * kMapTexels + t];
      batch.square[at] = view.square[example * kMapTexels + t];
    }
  });
}

void ExamplePool::draw(uint64_t seed, uint64_t step, size_t count, LightBatch& batch) const {
  batch.count = count;
  batch.pairs.assign(count * core::kFewGroups * core::kPairFeatures, 0);
  for (std::vector<float>* values : {&batch.formula, &batch.rms, &batch.probability})
    values->assign(count * core::kFewGroups, 0);
  const Random stream = Random(seed).fork(fmt::format("lights of step {}", step));
  tbb::parallel_for(size_t(0), count, [&](size_t row) {
    Random random = stream.fork(fmt::format("{}", row));
    const auto [viewIndex, example] = random.pick(std::span(m_lit));
    const ViewExamples& view = m_views[viewIndex];
    ViewExamples::Storage storage;
    core::LightFeatures features;
    core::computeFeatures(view.chain(random.integer(0, kInputVariants - 1), example, false, storage),
                          uint32_t(view.groups), features);
    const float* rms = &view.lightRms[example * view.groups];
    const float sum = std::accumulate(rms, rms + view.groups, 0.0f);
    for (size_t g = 0; g < view.groups; ++g) {
      const size_t at = row * core::kFewGroups + g;
      for (size_t f = 0; f < core::kPairFeatures; ++f)
        batch.pairs[at * core::kPairFeatures + f] = features.pairs[f][g];
      batch.formula[at] = std::max(features.formula[g], 1e-6f);
      batch.rms[at] = rms[g] / sum;
      batch.probability[at] = view.lightProbability[example * view.groups + g];
    }
  });
}

}  // namespace odis::learn
