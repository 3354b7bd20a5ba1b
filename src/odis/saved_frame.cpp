// Frames written to a file and read again.
#include "odis/saved_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <stdexcept>

#include "odis/guide_data.h"
#include "odis/options/settings.h"
#include "odis/saved_vertices.h"

namespace odis::core {

namespace {

// Arrays of each tile one after another, and their sizes.
void saveTiles(ArchiveWriter& file, const std::string& name, const VertexTiles& tiles) {
  std::vector<uint64_t> sizes;
  std::vector<PathVertex> all;
  for (const std::vector<PathVertex>& tile : tiles) {
    sizes.push_back(tile.size());
    all.insert(all.end(), tile.begin(), tile.end());
  }
  file.add(name + ".sizes", sizes);
  saveVertices(file, name, all);
}

// The parts of an array that have these sizes. `take` is called with the first and the one after the last.
template <class T, class Take>
void forEachPart(const Archive& file, const std::string& name, const std::vector<T>& all,
                 const std::vector<uint64_t>& sizes, const Take& take) {
  size_t begin = 0;
  for (const uint64_t size : sizes) {
    file.require(size <= all.size() - begin, name + ": is cut off");
    take(all.begin() + std::ptrdiff_t(begin), all.begin() + std::ptrdiff_t(begin + size));
    begin += size;
  }
  file.require(begin == all.size(), name + ": is too long");
}

VertexTiles loadTiles(const Archive& file, const std::string& name, size_t pixels) {
  const std::vector<uint64_t> sizes = file.get<uint64_t>(name + ".sizes");
  const std::vector<PathVertex> all = loadVertices(file, name);
  for (const PathVertex& v : all) file.require(v.pixel < pixels, name + ": are damaged");
  VertexTiles tiles;
  forEachPart(file, name, all, sizes, [&](auto begin, auto end) { tiles.emplace_back(begin, end); });
  return tiles;
}

}  // namespace

// What was taken from vertices, tile by tile. What BSDF sampling fractions are chosen by is saved as far as
// the number of vertices asks for it, which doesn't depend on the order in which tiles came.
struct SavedVertexSamples {
  static void save(ArchiveWriter& file, const std::string& name, const std::vector<VertexSamples>& tiles) {
    std::vector<uint64_t> sizes, cellSizes, fractionSizes;
    std::vector<CellSample> samples;
    std::vector<uint32_t> cellOf;
    std::vector<BatchSamples::Cell> cells;
    std::vector<FractionSample> fractions;
    std::vector<VertexCounts> counts;
    const uint32_t stride = fractionStride(vertexCount(tiles));
    const VertexSamples::Data none;
    for (const VertexSamples& tile : tiles) {
      const VertexSamples::Data& data = tile.m_data ? *tile.m_data : none;
      const BatchSamples& batch = data.cells;
      sizes.push_back(batch.samples.size());
      cellSizes.push_back(batch.cells.size());
      samples.insert(samples.end(), batch.samples.begin(), batch.samples.end());
      cellOf.insert(cellOf.end(), batch.cellOf.begin(), batch.cellOf.end());
      cells.insert(cells.end(), batch.cells.begin(), batch.cells.end());
      counts.push_back(batch.counts);
      const size_t before = fractions.size();
      std::copy_if(data.fractions.begin(), data.fractions.end(), std::back_inserter(fractions),
                   [stride](const FractionSample& v) { return isForFractions(v.pixel, stride); });
      fractionSizes.push_back(fractions.size() - before);
    }
    file.add(name + ".samples.sizes", sizes);
    saveFields(file, name + ".samples", samples);
    file.add(name + ".samples.cellOf", cellOf);
    file.add(name + ".cells.sizes", cellSizes);
    saveFields(file, name + ".cells", cells);
    file.add(name + ".fractions.sizes", fractionSizes);
    saveFields(file, name + ".fractions", fractions);
    saveFields(file, name + ".counts", counts);
  }

  // Splits an array of all tiles that was saved with its sizes; `arrayOf(t)` is where that of tile t goes.
  template <class T, class ArrayOf>
  static void split(const Archive& file, const std::string& name, const std::vector<T>& all,
                    const std::vector<uint64_t>& sizes, const ArrayOf& arrayOf) {
    size_t next = 0;
    forEachPart(file, name, all, sizes, [&](auto begin, auto end) { arrayOf(next++).assign(begin, end); });
  }

  static std::vector<VertexSamples> load(const Archive& file, const std::string& name, size_t pixels) {
    const std::vector<uint64_t> sizes = file.get<uint64_t>(name + ".samples.sizes");
    const auto sizesOf = [&](const std::string& array) {
      return file.get<uint64_t>(name + array + ".sizes", sizes.size());
    };
    std::vector<VertexSamples::Data> tiles(sizes.size());
    split(
        file, name + ".samples", loadFields<CellSample>(file, name + ".samples"),
        sizes, [&](size_t t) -> auto& { return tiles[t].cells.samples; });
    // Those that were taken before there was a grid have no cells yet.
    const std::vector<uint32_t> cellOf = file.get<uint32_t>(name + ".samples.cellOf");
    if (!cellOf.empty())
      split(
          file, name + ".samples.cellOf", cellOf,
          sizes, [&](size_t t) -> auto& { return tiles[t].cells.cellOf; });
    split(
        file, name + ".cells", loadFields<BatchSamples::Cell>(file, name + ".cells"),
        sizesOf(".cells"), [&](size_t t) -> auto& { return tiles[t].cells.cells; });
    split(
        file, name + ".fractions", loadFields<FractionSample>(file, name + ".fractions"),
        sizesOf(".fractions"), [&](size_t t) -> auto& { return tiles[t].fractions; });
    const std::vector<VertexCounts> counts = loadFields<VertexCounts>(file, name + ".counts", sizes.size());
    std::vector<VertexSamples> result(sizes.size());
    for (size_t t = 0; t < tiles.size(); ++t) {
      tiles[t].cells.counts = counts[t];
      requireSound(file, name, tiles[t], pixels);
      result[t].m_data = std::make_unique<VertexSamples::Data>(std::move(tiles[t]));
    }
    return result;
  }

  static void requireSound(const Archive& file, const std::string& name, const VertexSamples::Data& tile,
                           size_t pixels) {
    for (const uint32_t cell : tile.cells.cellOf)
      file.require(cell < tile.cells.cells.size(), name + ".samples.cellOf: is damaged");
    const auto isFinite = [](const Float3& v) {
      return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    for (const CellSample& sample : tile.cells.samples)
      file.require(isFinite(sample.position) && isFinite(sample.normal) &&
                       sample.lightGroup < kMaxLightGroups &&
                       sample.flags <= (CellSample::kHalf | CellSample::kBothSides),
                   name + ".samples: are damaged");
    for (const BatchSamples::Cell& cell : tile.cells.cells)
      file.require(CellGrid::levelOf(cell.key) == 0, name + ".cells: are damaged");
    for (const FractionSample& sample : tile.fractions)
      file.require(sample.pixel < pixels, name + ".fractions: are damaged");
  }
};

namespace {

// What is not set by name, and a text of all that is.
void saveOptions(ArchiveWriter& file, const FrameOptions& options) {
  file.addValue("frame.width", options.width);
  file.addValue("frame.height", options.height);
  file.addValue("frame.samplesPerPixel", options.samplesPerPixel);
  file.addValue("frame.mostSamplesPerPixel", options.mostSamplesPerPixel);
  file.addValue("frame.seed", options.seed);
  file.addValue("frame.keepPixelMeans", uint8_t(options.keepPixelMeans));
  file.addValue("frame.tileOffsetX", options.tileOffsetX);
  file.addValue("frame.tileOffsetY", options.tileOffsetY);
  file.addValue("frame.lightGroups", options.guide.lightGroups);
  file.add("frame.lightParts", options.guide.lightParts);
  file.addText("frame.settings", settingsText(options));
}

}  // namespace

FrameOptions loadOptions(const Archive& file) {
  FrameOptions options;
  options.width = file.value<uint32_t>("frame.width");
  options.height = file.value<uint32_t>("frame.height");
  options.samplesPerPixel = file.value<uint32_t>("frame.samplesPerPixel");
  options.mostSamplesPerPixel = file.value<uint32_t>("frame.mostSamplesPerPixel");
  options.seed = file.value<uint64_t>("frame.seed");
  options.keepPixelMeans = file.value<uint8_t>("frame.keepPixelMeans") != 0;
  options.tileOffsetX = file.value<uint32_t>("frame.tileOffsetX");
  options.tileOffsetY = file.value<uint32_t>("frame.tileOffsetY");
  options.guide.lightGroups = file.value<uint32_t>("frame.lightGroups");
  options.guide.lightParts = file.get<OdisLightParts>("frame.lightParts");
  try {
    applySettings(options, file.text("frame.settings"));
    checkedOptions(options);
  } catch (const std::invalid_argument& error) {
    file.require(false, std::string("frame.settings: ") + error.what());
  }
  return options;
}

void Frame::save(ArchiveWriter& file) const {
  const Data& d = *m_data;
  FrameOptions options = d.options;
  options.guide = d.guideOptions;
  saveOptions(file, options);
  file.addValue("frame.model", d.modelId);
  file.add("frame.hostData", d.hostData);
  file.addValue("frame.position", d.position());
  saveFields(file, "frame.vertexCounts", d.vertexCounts);
  file.add("frame.counts", d.schedule.counts());
  file.add("frame.before", d.schedule.before().done);
  file.add("frame.pilot", d.pilot.sums());
  file.add("frame.later", d.later.sums());
  if (!d.options.keepPixelMeans) {
    file.add("frame.pilot.kept", d.pilot.kept());
    file.add("frame.later.kept", d.later.kept());
    file.add("frame.tiles", std::vector<uint8_t>(d.tiles.tileCount()));
  }
  file.add("frame.pixelValues", d.pixelValues);
  saveTiles(file, "frame.pilotVertices", d.pilotVertices);
  // A pass that was loaded and has not begun again is what it was.
  if (d.inPass || d.resumed) {
    file.add("pass.tilesDone", d.resumed ? d.resumed->tilesDone : d.tiles.done());
    SavedVertexSamples::save(file, "pass", d.resumed ? d.resumed->samples : d.passSamples);
  }
  if (d.builder) d.builder->save(file);
  d.guide.save(file);
  if (d.paper) d.paper->save(file);
}

namespace {

// The number of pixels. A damaged size must not cost much more memory than the file has: where there may be
// nothing of each pixel, a byte of each tile proves it.
size_t readSize(const Archive& file, const FrameOptions& options) {
  const uint64_t pixels = uint64_t(options.width) * options.height;
  const bool isSound = options.keepPixelMeans
                           ? pixels == file.count<PixelSums>("frame.pilot")
                           : tilesOf(options).tileCount() == file.count<uint8_t>("frame.tiles");
  file.require(isSound, "frame.options: are damaged");
  return pixels;
}

}  // namespace

SavedFrame::SavedFrame(const Archive& file)
    : options(loadOptions(file)),
      pixelCount(readSize(file, options)),
      modelId(file.value<uint64_t>("frame.model")),
      hostData(file.get<uint8_t>("frame.hostData")),
      pixelValues(file.get<float>("frame.pixelValues")),
      schedule(options),
      vertexCounts(loadFieldsOfOne<VertexCounts>(file, "frame.vertexCounts")),
      pilotVertices(loadTiles(file, "frame.pilotVertices", pixelCount)),
      guide(Guide::load(file)) {
  const auto isFull = [this](size_t size) { return size == 0 || size == pixelCount; };
  file.require(isFull(guide.view().pixels.count), "guide.pixelCells: are damaged");
  file.require(isFull(pixelValues.size()), "frame.pixelValues: are damaged");
  const std::vector<uint32_t> counts = file.get<uint32_t>("frame.counts");
  file.require(isFull(counts.size()) && schedule.restore(counts), "frame.counts: are damaged");
  readPosition(file);
  readPixels(file);
  if (file.contains("pass.tilesDone")) readPass(file);
}

void SavedFrame::readPosition(const Archive& file) {
  position = file.value<FramePosition>("frame.position");
  const std::vector<uint32_t> before = file.get<uint32_t>("frame.before");
  file.require((before.empty() || before.size() == pixelCount) &&
                   schedule.restore(position.samplesPerPixel, {position.samplesBefore, before}),
               "frame.before: is damaged");
  if (position.next == ODIS_PASS_GUIDED && !position.builder) schedule.endRefinement();
  if (schedule.lastRefinement() == 0 && position.spreadAfter != schedule.spreadAfter())
    schedule.spreadLater();
  // Who learns needs a builder.
  const bool learns = position.next != ODIS_PASS_GUIDED || position.done < schedule.lastRefinement();
  file.require(position.next <= ODIS_PASS_GUIDED && position.done <= schedule.end() &&
                   (position.builder ? options.guided : !learns),
               "frame.position: is damaged");
  file.require(
      position.passEnd == schedule.passEnd(position.done) && position.spreadAfter == schedule.spreadAfter() &&
          position.pilotSamples == schedule.pilotSamples(),
      "was saved by a version of ODIS that takes samples in another order; expected one by this version");
  // A guide is there as soon as something is guided.
  file.require(!learns || position.next != ODIS_PASS_GUIDED || file.value<uint8_t>("guide.built"),
               "guide.built: is damaged");
}

// What is kept of pixels' samples; nothing where means are the host's and all is decided.
void SavedFrame::readPixels(const Archive& file) {
  const bool hasMeans = options.keepPixelMeans;
  if (hasMeans || position.next != ODIS_PASS_GUIDED || position.done == 0 ||
      position.done < schedule.spreadAfter()) {
    pilot = keptOfPilot(options, schedule);
    later = keptOfLater(options, schedule);
  }
  const auto read = [&](PixelSamples& samples, const std::string& name) {
    std::vector<KeptSample> kept;
    if (!hasMeans) kept = file.get<KeptSample>(name + ".kept");
    file.require(samples.restore(file.get<PixelSums>(name), std::move(kept)), name + ": is damaged");
  };
  read(pilot, "frame.pilot");
  read(later, "frame.later");
}

// What the pass under way has already.
void SavedFrame::readPass(const Archive& file) {
  const size_t tiles = tilesOf(options).tileCount();
  pass = std::make_unique<ResumedPass>();
  pass->tilesDone = file.get<uint8_t>("pass.tilesDone", tiles);
  pass->samples = SavedVertexSamples::load(file, "pass", pixelCount);
  const auto fits = [tiles](size_t size) { return size == 0 || size == tiles; };
  file.require(fits(pass->samples.size()) && fits(pilotVertices.size()), "pass.samples: are damaged");
}

FramePosition Frame::Data::position() const {
  return {guidesBuilt,
          notFinite,
          outsideFrame,
          twice,
          buildingBytes,
          pilotVertexCount,
          pilotSamplesTaken,
          laterSamplesTaken,
          missingSamples,
          passesWithoutVertices,
          measuredCostRatio,
          schedule.pilotSamples(),
          schedule.passEnd(done),
          schedule.spreadAfter(),
          schedule.samplesPerPixel(),
          schedule.before().samplesPerPixel,
          uint32_t(next),
          done,
          finished,
          builder != nullptr,
          guidingGivenUp};
}

// Goes to the place between the first sample and the last where the frame was.
void Frame::Data::moveTo(const FramePosition& at) {
  guidesBuilt = at.guidesBuilt;
  notFinite = at.notFinite;
  pilotSamplesTaken = at.pilotSamplesTaken;
  laterSamplesTaken = at.laterSamplesTaken;
  outsideFrame = at.outsideFrame;
  twice = at.twice;
  missingSamples = at.missingSamples;
  passesWithoutVertices = at.passesWithoutVertices;
  measuredCostRatio = at.measuredCostRatio;
  guidingGivenUp = at.guidingGivenUp != 0;
  buildingBytes = at.buildingBytes;
  pilotVertexCount = at.pilotVertices;
  next = OdisPassKind(at.next);
  done = at.done;
  finished = at.finished != 0;
}

Frame Frame::load(const Archive& file, std::optional<Model> model, std::shared_ptr<const Tasks> tasks) {
  file.requireKind("frame");
  SavedFrame saved(file);
  saved.options.guide.model = std::move(model);
  std::unique_ptr<Frame> frame;
  try {
    frame = std::make_unique<Frame>(saved.options, std::move(tasks));
  } catch (const std::invalid_argument& error) {
    file.require(false, error.what());
  }
  Data& d = *frame->m_data;
  file.require(saved.modelId == d.modelId, "was saved with another model");
  d.hostData = std::move(saved.hostData);
  d.pilot = std::move(saved.pilot);
  d.later = std::move(saved.later);
  d.pixelValues = std::move(saved.pixelValues);
  d.schedule = std::move(saved.schedule);
  d.vertexCounts = saved.vertexCounts;
  d.pilotVertices = std::move(saved.pilotVertices);
  d.guide = std::move(saved.guide);
  d.resumed = std::move(saved.pass);
  d.moveTo(saved.position);
  if (saved.position.builder) {
    d.cells = d.paper ? d.paper->load(file, d.guide) : d.guide;
    d.builder->load(file);
    file.require(saved.position.next != ODIS_PASS_GUIDED || d.builder->canRebuild(d.cells),
                 "guide.grid: is not that of the builder");
  } else {
    d.builder.reset();
    d.paper.reset();
  }
  file.require(d.next != ODIS_PASS_ORACLE || (d.paper && d.paper->hasOraclePass()),
               "frame.position: is damaged");
  d.countKept();
  return std::move(*frame);
}

}  // namespace odis::core
