#include "odis/paper_method.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

#include "odis/files/archive.h"
#include "odis/guide_data.h"
#include "odis/maps/pack.h"
#include "odis/maps/texel_directions.h"

namespace odis::core {

namespace {

// Makes the seed of the oracle's passes, which are no part of the image.
constexpr uint64_t kOracleSeed = 0x6f7261636c65ull;
// The oracle's BSDF sampling fractions come from this many of its passes.
constexpr uint32_t kFractionPasses = 2;

// Which light maps tell of that are no network's.
IncidentRadiance radianceOf(const GuideOptions& options) {
  return options.pixelDirectLight ? IncidentRadiance::full : IncidentRadiance::withoutDirect;
}

// What cells leave of a guide's maps.
constexpr size_t kMostPixelMaps = kMostMaps - kMostCells;

// The density of a pixel's map: its radiance, of whatever scale, times the cosine where the map was made, or
// alone.
Histogram densityOf(const Histogram& radiance, const Float3& normal, const GuideOptions& options) {
  Histogram cosines;
  cosines.fill(1);
  if (options.cosineProduct) cosines = meanCosines(normal, 0);
  Histogram density = product(radiance, options.floor, cosines);
  float sum = 0;
  for (const float value : density) sum += value;
  for (float& value : density) value /= sum;
  return density;
}

// The finest cell around a place; kNoCell where there is none.
uint32_t cellAt(const GuideView& view, const PixelMaps::Place& place) {
  return findCell(view, {place.position, place.normal});
}

}  // namespace

void PaperMethod::check(const GuideOptions& options, const Model& model) {
  if (options.pixelMaps == PixelMapKind::network && !model.pixels)
    throw std::invalid_argument("OdisGuideOptions.model: expected one with a network for maps at pixels");
}

std::unique_ptr<PaperMethod> PaperMethod::of(const FrameOptions& options,
                                             std::shared_ptr<const GuideBuilder> builder,
                                             std::shared_ptr<const Tasks> tasks) {
  std::unique_ptr<PaperMethod> method(new PaperMethod(options, std::move(builder), std::move(tasks)));
  return method->hasMaps() || method->hasOracle() ? std::move(method) : nullptr;
}

PaperMethod::PaperMethod(const FrameOptions& options, std::shared_ptr<const GuideBuilder> builder,
                         std::shared_ptr<const Tasks> tasks)
    : m_pixels(size_t(options.width) * options.height),
      m_passes(options.oracleSamples()),
      m_guide(builder->options()),
      m_builder(std::move(builder)),
      m_tasks(std::move(tasks)) {
  const auto width = int(options.width), height = int(options.height);
  const int tile = m_guide.pixelMaps == PixelMapKind::oracle ? 1 : int(m_guide.pixelTile);
  const auto tiles = [&](int pixels) { return size_t((pixels + tile - 1) / tile); };
  if (m_guide.pixelMaps != PixelMapKind::none && tiles(width) * tiles(height) > kMostPixelMaps)
    throw std::invalid_argument("OdisFrameOptions.width, height: expected at most " +
                                std::to_string(kMostPixelMaps) + " maps at pixels (see pixel-tile)");
  switch (m_guide.pixelMaps) {
    case PixelMapKind::histogram:
      m_model = pixelHistogram(radianceOf(m_guide));
      break;
    case PixelMapKind::network:
      m_model = m_builder->m_data->pixelNetwork;
      break;
    case PixelMapKind::oracle:
      m_oracle = std::make_unique<PixelOracle>(width, height, radianceOf(m_guide));
      break;
    case PixelMapKind::none:
      break;
  }
  if (m_model) m_pilot = std::make_unique<FirstVertices>(width, height);
}

void PaperMethod::describeOraclePass(FramePass& pass) const {
  pass.seed ^= kOracleSeed;
  pass.stageSamples = m_pixels * m_passes;
  pass.wantsVertices = true;
  pass.partOfImage = false;
}

bool PaperMethod::passIsForFractions() const {
  return m_passesDone < kFractionPasses;
}

void PaperMethod::take(OdisPassKind pass, ArrayView<const PathVertex> vertices) {
  if (pass == ODIS_PASS_PILOT && m_pilot) m_pilot->add(vertices, m_model->radiance());
  if (pass == ODIS_PASS_ORACLE && m_oracle) m_oracle->add(vertices);
}

void PaperMethod::makeMaps() {
  if (m_pilot)
    m_maps = makePixelMaps(*m_pilot, int(m_guide.pixelTile), *m_model, *m_tasks, m_builder->m_data->progress);
  if (m_oracle) m_maps = m_oracle->maps(*m_tasks);
  m_pilot.reset();
  m_oracle.reset();
}

Guide PaperMethod::over(const Guide& cells) {
  makeMaps();
  return m_maps.empty() ? cells : over(cells, m_maps, m_guide, *m_tasks);
}

Guide PaperMethod::over(const Guide& cells, const PixelMaps& maps, const GuideOptions& options,
                        const Tasks& tasks) {
  static const Guide::Data kNothing(0);
  const Guide::Data& known = cells.m_data ? *cells.m_data : kNothing;
  const GuideView view = cells.view();
  const size_t count = known.index.size(), columns = known.lightTables.empty() ? 0 : known.lightGroups + 1;
  Guide guide;
  guide.m_data = copyOf(known, maps.size());
  Guide::Data& result = *guide.m_data;

  const float fixed = options.fixedBsdfFraction > 0 ? options.fixedBsdfFraction : kFallbackBsdfFraction;
  constexpr size_t kPortion = 1024;
  tasks.forEach((maps.size() + kPortion - 1) / kPortion, [&](size_t portion) {
    for (size_t m = portion * kPortion; m < std::min(maps.size(), (portion + 1) * kPortion); ++m) {
      const size_t to = count + m;
      const uint32_t from = cellAt(view, maps.places[m]);
      Histogram density = densityOf(maps.radiance(m), maps.places[m].normal, options);
      result.keys[to] = known.grid.key(maps.places[m].position, maps.places[m].normal, 0);
      if (from == kNoCell) {
        std::fill_n(result.decisions[to].bsdfFraction, kRoughnessClasses, fixed);
      } else {
        const Histogram ofCell = probabilitiesOf(SamplingMap<float>(view.maps, int32_t(from)));
        for (size_t t = 0; t < kMapTexels; ++t)
          density[t] = options.pixelShare * density[t] + (1 - options.pixelShare) * ofCell[t];
        result.decisions[to] = known.decisions[from];
        result.keys[to] = known.keys[from];  // of its level
        std::copy_n(known.lightTables.begin() + std::ptrdiff_t(from * columns), columns,
                    result.lightTables.begin() + std::ptrdiff_t(to * columns));
        if (!result.cached.empty()) std::copy_n(&known.cached[2 * size_t(from)], 2, &result.cached[2 * to]);
      }
      packMap(density, result.mapAt(to));
    }
  });
  result.pixelCells.reserve(maps.ofPixel.size());
  for (const uint32_t map : maps.ofPixel)
    result.pixelCells.push_back(map == kNoMap ? kNoCell : uint32_t(count) + map);
  return guide;
}

// The cells of the grid alone, and room for `more` behind them.
std::shared_ptr<Guide::Data> PaperMethod::copyOf(const Guide::Data& from, size_t more) {
  const size_t count = from.index.size(), columns = from.lightTables.empty() ? 0 : from.lightGroups + 1;
  const auto result = std::make_shared<Guide::Data>(count + more);
  result->grid = from.grid;
  result->index = from.index;
  result->cachedError = from.cachedError;
  result->maxDepth = from.maxDepth;
  result->cachedShares = from.cachedShares;
  result->lightGroups = from.lightGroups;
  result->prediction = from.prediction;
  std::copy_n(from.maps.data(), count * kMapShares, result->mapAt(0));
  std::copy_n(from.decisions.begin(), count, result->decisions.begin());
  const auto copy = [&](const auto& source, auto& to, size_t each) {
    to.assign(source.begin(), source.begin() + std::ptrdiff_t(count * each));
    to.resize((count + more) * each);
  };
  copy(from.keys, result->keys, 1);
  copy(from.lightTables, result->lightTables, columns);
  copy(from.cached, result->cached, from.cached.empty() ? 0 : 2);
  return result;
}

Guide PaperMethod::cellsOf(const Guide& guide) {
  Guide cells = guide;
  if (guide.m_data && !guide.m_data->pixelCells.empty()) cells.m_data = copyOf(*guide.m_data, 0);
  return cells;
}

uint64_t PaperMethod::bytes() const {
  return (m_pilot ? m_pilot->bytes() : 0) + (m_oracle ? m_oracle->bytes() : 0) + m_maps.bytes();
}

void PaperMethod::save(ArchiveWriter& file) const {
  file.addValue("paper.passesDone", m_passesDone);
  file.add("paper.pilot", m_pilot ? m_pilot->pixels() : std::vector<FirstVertex>());
  file.add("paper.oracle", m_oracle ? m_oracle->pixels() : std::vector<PixelOracle::Pixel>());
  file.add("paper.places", m_maps.places);
  file.add("paper.texels", m_maps.texels);
  file.add("paper.ofPixel", m_maps.ofPixel);
}

Guide PaperMethod::load(const Archive& file, const Guide& guide) {
  m_passesDone = file.value<uint32_t>("paper.passesDone");
  // What has become maps is not there any more.
  const auto restore = [&]<class T>(std::unique_ptr<T>& pixels, const std::string& name, auto all) {
    if (all.empty()) return pixels.reset();
    file.require(pixels && all.size() == pixels->pixels().size(), name + ": are damaged");
    pixels->restore(std::move(all));
  };
  for (const auto& bytes : file.get<std::array<unsigned char, sizeof(FirstVertex)>>("paper.pilot"))
    file.require(bytes[offsetof(FirstVertex, there)] <= 1, "paper.pilot: are damaged");
  restore(m_pilot, "paper.pilot", file.get<FirstVertex>("paper.pilot"));
  restore(m_oracle, "paper.oracle", file.get<PixelOracle::Pixel>("paper.oracle"));
  m_maps.places = file.get<PixelMaps::Place>("paper.places");
  m_maps.texels = file.get<uint16_t>("paper.texels", m_maps.size() * kMapTexels);
  m_maps.ofPixel = file.get<uint32_t>("paper.ofPixel", m_maps.empty() ? 0 : m_pixels);
  for (const uint16_t texel : m_maps.texels)
    file.require(texel > 0, "paper.texels: a direction is impossible");
  for (const uint32_t map : m_maps.ofPixel)
    file.require(map == kNoMap || map < m_maps.size(), "paper.ofPixel: are damaged");
  return cellsOf(guide);
}

}  // namespace odis::core
