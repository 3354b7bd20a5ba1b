#include "odis/frame_data.h"

#include <bit>
#include <cmath>
#include <stdexcept>

#include "odis/models/model.h"
#include "odis/options/settings.h"
#include "odis/record/vertex_check.h"

namespace odis::core {

namespace {

// A sampler that stratifies draws all samples of a pixel from one set of points. Given the first of them the
// others are not uniform, and the guide is made from the first: it is not independent of the points that it
// guides. One pixel's share in what a cell knows makes this too small to measure, and maps at pixels leave it
// out; but in images of fewer pixels than these every guide has numbers of its own.
constexpr size_t kFewPixels = 16384;
constexpr uint64_t kGuideSeed = 0x9e3779b97f4a7c15ull;

// How many pixels there are for each one that the guide learns from, so that it learns from at most `most` of
// the samples of a pass.
uint32_t pixelsPerLearnedIn(uint64_t samples, uint64_t most) {
  return uint32_t((samples + most - 1) / most);
}

void requireOption(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("OdisFrameOptions.") + message);
}
void requireOrder(bool holds, const char* message) {
  if (!holds) throw std::logic_error(message);
}

Float3 finiteOrBlack(const Float3& value, std::atomic<uint64_t>& notFinite) {
  if (std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z)) return value;
  ++notFinite;
  return {};
}

// The options of a frame's own guide. A pixel's noise falls with the root of its number of samples, and so
// does how far off cached radiance may be.
GuideOptions ownGuideOptions(const FrameOptions& options) {
  constexpr float kErrorOfOneSample = 0.6f;
  GuideOptions guide = options.guide;
  if (options.guidedCost == 0) guide.alwaysMaps = true;
  if (guide.cachedError == 0) guide.cachedError = kErrorOfOneSample / std::sqrt(float(options.most()));
  return guide;
}

}  // namespace

VertexCounts countsOf(ArrayView<const VertexSamples> tiles) {
  VertexCounts counts;
  for (const VertexSamples& samples : tiles) addCounts(counts, samples.counts());
  return counts;
}
uint64_t vertexCount(ArrayView<const VertexSamples> tiles) {
  const VertexCounts counts = countsOf(tiles);
  return counts.accepted + refusedVertices(counts);
}
uint64_t bytesOf(ArrayView<const VertexSamples> tiles) {
  uint64_t bytes = 0;
  for (const VertexSamples& samples : tiles) bytes += samples.bytes();
  return bytes;
}
uint64_t bytesOf(const VertexTiles& tiles) {
  uint64_t bytes = 0;
  for (const std::vector<PathVertex>& tile : tiles) bytes += tile.size() * sizeof(PathVertex);
  return bytes;
}

TileGrid tilesOf(const FrameOptions& o) {
  return {o.width, o.height, o.tileOffsetX, o.tileOffsetY};
}

const FrameOptions& checkedOptions(const FrameOptions& o) {
  requireOption(o.width > 0 && o.height > 0, "width, height: expected at least one pixel");
  requireOption(uint64_t(o.width) * o.height < (uint64_t(1) << 31),
                "width, height: expected less than 2^31 pixels");
  requireOption(o.samplesPerPixel > 0, "samplesPerPixel: expected at least 1");
  requireOption(
      o.mostSamplesPerPixel == 0 || o.mostSamplesPerPixel == ODIS_UNLIMITED ||
          (o.mostSamplesPerPixel >= o.samplesPerPixel && o.mostSamplesPerPixel <= kMostSamplesPerPixel),
      "mostSamplesPerPixel: expected 0, samplesPerPixel to 2^28, or ODIS_UNLIMITED");
  requireOption(o.tileOffsetX < kTileSize && o.tileOffsetY < kTileSize,
                "tileOffsetX, tileOffsetY: expected 0 to 15");
  requireRanges(o);
  requireOption(
      !o.guided || o.most() == o.samplesPerPixel || std::round(o.pilotSamplesPerPixel) <= o.samplesPerPixel,
      "samplesPerPixel: expected at least those of the pilot (pilot-spp), since it may be extended");
  return o;
}

Frame::Data::Data(const FrameOptions& o, std::shared_ptr<const Tasks> shared,
                  std::shared_ptr<GuideBuilder> given)
    : options(checkedOptions(o)),
      ownsBuilder(!given),
      tasks(shared),
      builder(!o.guided ? nullptr
              : given   ? std::move(given)
                        : std::make_shared<GuideBuilder>(ownGuideOptions(o), shared)),
      guideOptions(builder ? builder->options() : GuideOptions()),
      modelId(builder ? builder->modelId() : 0),
      pixelCount(size_t(o.width) * o.height),
      schedule(o),
      pilot(keptOfPilot(o, schedule)),
      later(keptOfLater(o, schedule)),
      tiles(tilesOf(o), std::move(shared)),
      next(o.guided ? ODIS_PASS_PILOT : ODIS_PASS_GUIDED) {
  if (builder && needsGuide()) paper = PaperMethod::of(options, builder, tasks);
  countKept();
}

SampleRange Frame::Data::samples(uint32_t pixel) const {
  switch (next) {
    case ODIS_PASS_PILOT:
      return {0, schedule.pilotCount(pixel)};
    case ODIS_PASS_ORACLE:
      return paper->oracleSamples();
    case ODIS_PASS_GUIDED:
      break;
  }
  return schedule.remaining(pixel, done, end);
}

// What each sample of a pixel weighs that the pass asks for.
float Frame::Data::weightInPass(uint32_t pixel) const {
  if (!pass.partOfImage || pass.weightsLater) return 0;
  return schedule.sampleWeight(pixel, next == ODIS_PASS_PILOT, options.pilotWeight);
}

void Frame::Data::refusePixel(uint32_t pixel, const char* function) const {
  throw std::out_of_range(std::string(function) + ": expected a pixel of the frame, found " +
                          std::to_string(pixel) + " of " + std::to_string(pixelCount));
}

// Whether vertices were forgotten: a sample with more than the camera's ray has been at a surface. Hosts that
// do not count rays are taken to have been at one.
bool Frame::Data::lacksVertices() const {
  return pass.wantsVertices && passVerticesCame == 0 && passSamplesCame > 0 &&
         (passRaysCame == 0 || passRaysCame > passSamplesCame);
}

void Frame::Data::describePass() {
  const size_t pixels = pixelCount;
  pass = {};
  passVertexCount = passSamplesCame = passRaysCame = passVerticesCame = 0;
  pass.kind = next;
  pass.seed = options.seed;
  view = guide.view();
  pass.guide = &view;
  if (next == ODIS_PASS_GUIDED) {
    end = schedule.passEnd(done);
    pass.pixelValues = pixelValues.empty() ? nullptr : pixelValues.data();
    pass.stageSamples = schedule.remainingSamples();
    pass.wantsVertices = learns();
    pass.weightsLater = !schedule.countsAreKnown(done);
    if (pixels < kFewPixels) pass.seed ^= guidesBuilt * kGuideSeed;
    if (learns()) passSamples.resize(tiles.tileCount());
    pixelsPerLearned = pixelsPerLearnedIn(pixels * (end - done), kMostGuidedSamples);
    return;
  }
  pixelsPerLearned = 1;
  if (next == ODIS_PASS_ORACLE) {
    paper->describeOraclePass(pass);
    passSamples.resize(tiles.tileCount());
    return;
  }
  pass.stageSamples = schedule.pilotSamples();
  pass.wantsVertices = needsGuide() || options.keepPilotVertices;
  if (!options.keepPilotVertices && !(paper && paper->hasMaps()))
    pixelsPerLearned = pixelsPerLearnedIn(schedule.pilotSamples(), kMostPilotSamples);
  if (needsGuide() && !(paper && paper->hasOracle())) passSamples.resize(tiles.tileCount());
  if (options.keepPilotVertices) pilotVertices.resize(tiles.tileCount());
}

// Whether anything is guided: samples that follow the pilot, or what else learns from the builder.
bool Frame::Data::needsGuide() const {
  return !ownsBuilder || schedule.mostRemaining() > 0;
}

// Takes a tile's samples and vertices.
void Frame::Data::take(uint32_t tile, ArrayView<const FrameSample> samples, TileVertices& vertices) {
  if (pass.partOfImage) {
    const bool ofPilot = next == ODIS_PASS_PILOT;
    PixelSamples& kept = ofPilot ? pilot : later;
    for (const FrameSample& s : samples) kept.add(s.pixel, finiteOrBlack(s.value, notFinite), s.rays);
    (ofPilot ? pilotSamplesTaken : laterSamplesTaken) += samples.size();
  }
  if (!pass.wantsVertices) return;
  uint64_t rays = 0;
  for (const FrameSample& s : samples) rays += s.rays;
  passSamplesCame += samples.size();
  passRaysCame += rays;
  passVerticesCame += vertices.size();
  if (pixelsPerLearned > 1) vertices.filter([this](const PathVertex& v) { return wantsVertices(v.pixel); });
  const uint64_t seen = passVertexCount += vertices.size();
  if (!passSamples.empty()) {
    passSamples[tile] = next == ODIS_PASS_GUIDED ? builder->takeGuided(vertices.view())
                                                 : builder->takeUnguided(vertices.view(), seen);
    keptBytes += passSamples[tile].bytes();
  }
  if (paper) paper->take(next, vertices.view());
  if (next != ODIS_PASS_PILOT || !options.keepPilotVertices) return;
  keptBytes += vertices.size() * sizeof(PathVertex);
  pilotVertices[tile] = vertices.take();
}

// Pixel values come from the pilot's image.
void Frame::Data::endPilot() {
  pixelValues = pilot.kept().empty() ? estimatePixelValues(pilot.sums(), options.width)
                                     : estimatePixelValuesOf(pilot, options.width);
  pilotVertexCount = passVertexCount;
  buildingBytes = keptBytes;
  next = paper && paper->hasOraclePass() ? ODIS_PASS_ORACLE : ODIS_PASS_GUIDED;
}

// Adds what was taken from an unguided pass to the cells and, where it is asked for, to what BSDF sampling
// fractions are chosen by.
void Frame::Data::learnUnguided(bool forFractions) {
  tasks->forEach(passSamples.size(), [&](size_t tile) { passSamples[tile].narrow(passVertexCount); });
  builder->addToCells(passSamples);
  if (forFractions) builder->addToFractions(passSamples);
  passSamples.clear();
  countKept();
}

void Frame::Data::endOraclePass() {
  learnUnguided(paper->passIsForFractions());
  paper->endOraclePass();
  if (!paper->hasOraclePass()) next = ODIS_PASS_GUIDED;
}

// Builds the first guide from all that the builder was taught.
void Frame::Data::buildGuide() {
  cells = builder->build(pixelValues);
  useCells();
  if (guideSavesNothing()) return giveUpGuiding();
  settleRefinement();
  takeStock();
}

// Makes the guide of what the cells know.
void Frame::Data::useCells() {
  guide = paper ? paper->over(cells) : cells;
  ++guidesBuilt;
}

// Counts what is kept between passes.
void Frame::Data::countKept() {
  keptBytes = bytesOf(pilotVertices) + (paper ? paper->bytes() : 0);
}

// Notes what building needed, lets go of what was taken from vertices and, when the guide won't learn any
// more, of the builder.
void Frame::Data::takeStock() {
  if (builder) {
    buildingBytes = std::max<uint64_t>(buildingBytes, builder->bytes() + keptBytes);
    vertexCounts = builder->vertexCounts();
    if (ownsBuilder) builder->forgetFractions();
  }
  passSamples.clear();
  if (!learns()) {
    builder.reset();
    cells = {};
    paper.reset();
  }
  countKept();
}

// Learns from the vertices of a guided pass, and rebuilds the guide where it is time.
void Frame::Data::refineGuide() {
  builder->addToCells(passSamples);
  countKept();
  done = end;
  if (std::has_single_bit(done + 1)) {
    cells = builder->rebuild(cells);
    useCells();
    settleRefinement();
  }
  takeStock();
}

void Frame::Data::resume() {
  tiles.skip(resumed->tilesDone);
  if (!pass.wantsVertices) return resumed.reset();
  const size_t taken = passSamples.size();
  passSamples = std::move(resumed->samples);
  passSamples.resize(taken);
  passVertexCount = vertexCount(passSamples);
  keptBytes += bytesOf(passSamples);
  resumed.reset();
}

// Decides by the first samples, which are not needed any more once that is done.
void Frame::Data::endGuidedPass() {
  if (end == schedule.spreadAfter()) spreadSamples();
  const bool givesUp = guidingDoesNotPay();
  if (!options.keepPixelMeans && end >= schedule.spreadAfter()) {
    pilot = PixelSamples();
    later = PixelSamples();
  }
  if (!givesUp) return learnFromGuidedPass();
  giveUpGuiding();
  done = end;
}

void Frame::Data::learnFromGuidedPass() {
  if (learns())
    refineGuide();
  else
    done = end;
}

Frame::Frame(const FrameOptions& options, std::shared_ptr<const Tasks> tasks,
             std::shared_ptr<GuideBuilder> builder)
    : m_data(std::make_unique<Data>(options, std::move(tasks), std::move(builder))) {}
Frame::~Frame() = default;
Frame::Frame(Frame&&) noexcept = default;
Frame& Frame::operator=(Frame&&) noexcept = default;

const FramePass* Frame::beginPass() {
  Data& d = *m_data;
  requireOrder(!d.inPass, "odisBeginPass: expected odisEndPass before the next pass");
  if (isComplete()) return nullptr;
  d.describePass();
  d.tiles.beginPass([&d](uint32_t pixel) { return d.samples(pixel); },
                    [&d](uint32_t tile, ArrayView<const FrameSample> samples, TileVertices& vertices) {
                      d.take(tile, samples, vertices);
                    });
  if (d.resumed) d.resume();
  d.inPass = true;
  return &d.pass;
}

bool Frame::isComplete() const {
  const Data& d = *m_data;
  const bool isDone = d.next == ODIS_PASS_GUIDED && d.done >= d.schedule.end();
  return !d.inPass && (d.finished || isDone);
}

SampleRange Frame::samples(uint32_t pixel) const {
  requireOrder(m_data->inPass, "odisGetSamples: expected a pass under way");
  m_data->requirePixel(pixel, "odisGetSamples");
  if (m_data->tiles.isDone(pixel)) return {};
  SampleRange range = m_data->samples(pixel);
  range.weight = m_data->weightInPass(pixel);
  return range;
}

bool Frame::wantsVertices(uint32_t pixel) const {
  requireOrder(m_data->inPass, "odisWantsVertices: expected a pass under way");
  m_data->requirePixel(pixel, "odisWantsVertices");
  return m_data->wantsVertices(pixel);
}

ArrayView<const float> Frame::pixelValues() const {
  return m_data->pixelValues;
}

void Frame::add(ArrayView<const FrameSample> samples, const VertexSource& vertices) {
  requireOrder(m_data->inPass, "odisAddSamples: expected a pass under way");
  if (m_data->pass.wantsVertices)
    m_data->tiles.add(samples, vertices);
  else
    m_data->tiles.add(samples, VertexArray({}));
}

void Frame::add(ArrayView<const FrameSample> samples, ArrayView<const PathVertex> vertices) {
  add(samples, VertexArray(vertices));
}

void Frame::endPass(bool interrupted) {
  Data& d = *m_data;
  requireOrder(d.inPass, "odisEndPass: expected a pass under way");
  if (!interrupted) d.missingSamples += d.tiles.missing();
  const TileCollector::LeftOut leftOut = d.tiles.endPass();
  d.outsideFrame += leftOut.notDue;
  d.twice += leftOut.twice;
  if (!interrupted && d.lacksVertices()) ++d.passesWithoutVertices;
  d.inPass = false;
  d.finished = true;  // unless what follows succeeds
  const OdisPassKind kind = d.next;
  if (kind == ODIS_PASS_PILOT) d.endPilot();
  if (interrupted) return;
  if (kind == ODIS_PASS_PILOT && !d.needsGuide()) {
    d.builder.reset();
    d.finished = false;
    return;
  }
  // Pixels of earlier frames that learned into the builder are not this frame's.
  if (kind == ODIS_PASS_PILOT) d.builder->forgetFractions();
  if (kind == ODIS_PASS_PILOT && d.next == ODIS_PASS_GUIDED) d.learnUnguided(true);
  if (kind == ODIS_PASS_ORACLE) d.endOraclePass();
  if (kind == ODIS_PASS_GUIDED)
    d.endGuidedPass();
  else if (d.next == ODIS_PASS_GUIDED)
    d.buildGuide();
  d.finished = false;
}

void Frame::extend(uint32_t samplesPerPixel) {
  Data& d = *m_data;
  requireOrder(!d.inPass && !d.resumed, "odisExtendFrame: expected odisEndPass before");
  requireOrder(!d.finished, "odisExtendFrame: expected a frame none of whose passes was interrupted");
  if (samplesPerPixel <= d.schedule.samplesPerPixel() || samplesPerPixel > kMostSamplesPerPixel)
    throw std::invalid_argument("odisExtendFrame: expected more samples per pixel than the " +
                                std::to_string(d.schedule.samplesPerPixel()) +
                                " of the frame, and at most 2^28, found " + std::to_string(samplesPerPixel));
  const bool isRound = !d.options.keepPixelMeans;
  requireOrder(isComplete() || (d.schedule.isExtendedAnywhere() && !isRound),
               "odisExtendFrame: expected a frame whose passes are complete, since it keeps no means or was "
               "asked for mostSamplesPerPixel");
  d.done = d.schedule.extend(samplesPerPixel, d.done, isRound);
}

void Frame::setHostData(ArrayView<const uint8_t> bytes) {
  m_data->hostData.assign(bytes.begin(), bytes.end());
}

ArrayView<const uint8_t> Frame::hostData() const {
  return m_data->hostData;
}

void Frame::setProgress(OdisProgressFunction function, void* user) {
  if (m_data->builder) m_data->builder->setProgress(function, user);
}

void Frame::limitBytes(uint64_t most) {
  const Data& d = *m_data;
  // What is taken from vertices already is a part of what building needs.
  if (d.builder) d.builder->limitBytes(most + bytesOf(d.passSamples), d.passVertexCount);
}
int Frame::coarsening() const {
  return m_data->builder ? m_data->builder->coarsening() : 1;
}
uint64_t Frame::samplesLeftOut() const {
  return m_data->builder ? m_data->builder->samplesLeftOut() : 0;
}

uint64_t Frame::bytes() const {
  const Data& d = *m_data;
  const uint64_t ofPixels = d.pilot.bytes() + d.later.bytes() + d.pixelValues.size() * sizeof(float);
  return ofPixels + d.schedule.bytes() + d.tiles.bytes() + d.keptBytes + d.guide.bytes() + d.hostData.size() +
         (d.builder && d.ownsBuilder ? d.builder->heldBytes() : 0);
}

bool Frame::guideIsFinal() const {
  return m_data->next == ODIS_PASS_GUIDED && !m_data->learns();
}

}  // namespace odis::core
