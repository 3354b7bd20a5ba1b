// Maps at pixels as cells of a guide, behind those of the grid.
#include <algorithm>

#include "odis/guide_data.h"
#include "odis/maps/pack.h"

namespace odis::core {

namespace {

// The BSDF sampling fraction where nothing is known.
constexpr float kHalf = 0.5f;

// A map as shares of its sum.
Histogram sharesOf(const uint16_t* texels) {
  float sum = 0;
  for (int t = 0; t < kMapTexels; ++t) sum += texels[t];
  Histogram shares;
  for (int t = 0; t < kMapTexels; ++t) shares[size_t(t)] = texels[t] / sum;
  return shares;
}

// The finest cell around a place; kNoCell where there is none.
uint32_t cellAt(const GuideView& view, const PixelMaps::Place& place) {
  return findCell(view, {place.position, place.normal});
}

}  // namespace

// The cells of the grid alone, and room for `more` behind them.
std::shared_ptr<Guide::Data> Guide::Data::withRoom(size_t more) const {
  const size_t count = index.size(), columns = lightTables.empty() ? 0 : lightGroups + 1;
  const auto result = std::make_shared<Data>(count + more);
  result->builder = builder;
  result->numbering = numbering;
  result->grid = grid;
  result->index = index;
  result->rim = rim;
  result->cachedError = cachedError;
  result->maxDepth = maxDepth;
  result->cachedShares = cachedShares;
  result->lightGroups = lightGroups;
  result->prediction = prediction;
  std::copy_n(texels.data(), count * kMapTexels, result->texels.at(0));
  std::copy_n(sums.data(), count * kSumsPerMap, result->sums.at(0));
  std::copy_n(decisions.begin(), count, result->decisions.begin());
  const auto copy = [&](const auto& from, auto& to, size_t each) {
    to.assign(from.begin(), from.begin() + std::ptrdiff_t(count * each));
    to.resize((count + more) * each);
  };
  copy(keys, result->keys, 1);
  copy(lightTables, result->lightTables, columns);
  copy(cached, result->cached, cached.empty() ? 0 : 2);
  return result;
}

Guide Guide::withPixelMaps(const PixelMaps& maps, const GuideOptions& options, const Tasks& tasks) const {
  static const Data kNothing(0);
  const Data& cells = m_data ? *m_data : kNothing;
  const GuideView view = this->view();
  const size_t count = cells.index.size(), columns = cells.lightTables.empty() ? 0 : cells.lightGroups + 1;
  Guide guide;
  guide.m_data = cells.withRoom(maps.size());
  Data& result = *guide.m_data;
  result.setCosineProduct(options.cosineProduct);

  const float fixed = options.fixedBsdfFraction > 0 ? options.fixedBsdfFraction : kHalf;
  constexpr size_t kPortion = 1024;
  tasks.forEach((maps.size() + kPortion - 1) / kPortion, [&](size_t portion) {
    for (size_t m = portion * kPortion; m < std::min(maps.size(), (portion + 1) * kPortion); ++m) {
      const size_t to = count + m;
      const uint32_t from = cellAt(view, maps.places[m]);
      Histogram radiance = sharesOf(&maps.texels[m * kMapTexels]);
      result.keys[to] = cells.grid.key(maps.places[m].position, maps.places[m].normal, 0);
      if (from == kNoCell) {
        std::fill_n(result.decisions[to].bsdfFraction, kRoughnessClasses, fixed);
      } else {
        const Histogram ofCell = sharesOf(view.maps.texels + from * size_t(kMapTexels));
        for (size_t t = 0; t < kMapTexels; ++t)
          radiance[t] = options.pixelShare * radiance[t] + (1 - options.pixelShare) * ofCell[t];
        result.decisions[to] = cells.decisions[from];
        result.keys[to] = cells.keys[from];  // of its level
        std::copy_n(cells.lightTables.begin() + std::ptrdiff_t(from * columns), columns,
                    result.lightTables.begin() + std::ptrdiff_t(to * columns));
        if (!result.cached.empty()) std::copy_n(&cells.cached[2 * size_t(from)], 2, &result.cached[2 * to]);
      }
      packMap(radiance, options.floor, result.texels.at(to * kMapTexels), result.sums.at(to * kSumsPerMap));
    }
  });
  result.pixelCells.reserve(maps.ofPixel.size());
  for (const uint32_t map : maps.ofPixel)
    result.pixelCells.push_back(map == kNoMap ? kNoCell : uint32_t(count) + map);
  return guide;
}

PixelMaps GuideBuilder::makePixelMaps(VertexParts pilot, int width, int height) const {
  const PixelModel& model = *m_data->pixels;
  FirstVertices vertices(width, height);
  const Tasks& tasks = m_data->store.tasks();
  tasks.forEach(pilot.size(), [&](size_t part) { vertices.add(pilot[part], model.radiance()); });
  return core::makePixelMaps(vertices, int(m_data->options.pixelTile), model, tasks, m_data->progress);
}

Guide Guide::ofCellsAlone() const {
  Guide guide = *this;
  if (m_data && !m_data->pixelCells.empty()) guide.m_data = m_data->withRoom(0);
  return guide;
}

}  // namespace odis::core
