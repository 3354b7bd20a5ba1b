#include "learn/inspect/inspect.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <set>

#include "learn/inspect/place.h"
#include "learn/inspect/vertex_integral.h"
#include "odis/api/objects.h"
#include "odis/cells/shrinkage.h"
#include "odis/maps/pack.h"
#include "odis/maps/texel_directions.h"
#include "odis/options/settings.h"
#include "render/integrators/pilot_pass.h"

namespace odis::learn {

using render::PilotPass;
using render::Rgb;

namespace {

// At how many of a cell's vertices converged samples start, at most.
constexpr size_t kMostStarts = 256;

// What arrived in a cell, radiance times cosine, over the cosine to its mean normal.
core::Histogram radianceOf(const core::CellStatistics& cell, const core::Histogram& arrived) {
  const core::Histogram cosines = core::cosinesOf(cell);
  core::Histogram radiance;
  for (size_t t = 0; t < kMapTexels; ++t) radiance[t] = arrived[t] * core::inverseCosine(cosines[t]);
  return radiance;
}

// Means of the pilot's samples; pixels without one have the mean of those around them.
std::vector<Rgb> imageOf(const PilotPass& pilot, const render::Crop& crop) {
  std::vector<Rgb> image(pilot.image.size(), Rgb(0, 0, 0));
  for (int y = 0; y < crop.height; ++y)
    for (int x = 0; x < crop.width; ++x) {
      render::Rgbd sum(0, 0, 0);
      double count = 0;
      for (int reach = 0; reach <= 8 && count == 0; ++reach)
        for (int py = std::max(y - reach, 0); py <= std::min(y + reach, crop.height - 1); ++py)
          for (int px = std::max(x - reach, 0); px <= std::min(x + reach, crop.width - 1); ++px) {
            const PixelSums& pixel = pilot.image[size_t(py) * size_t(crop.width) + size_t(px)];
            sum += render::Rgbd(pixel.sum[0], pixel.sum[1], pixel.sum[2]);
            count += pixel.count;
          }
      if (count > 0)
        image[size_t(y) * size_t(crop.width) + size_t(x)] =
            Rgb(float(sum.x / count), float(sum.y / count), float(sum.z / count));
    }
  return image;
}

core::GuideOptions guideOptionsOf(const render::RenderOptions& options) {
  core::FrameOptions result;
  core::applySettings(result, options.settings);
  return result.guide;
}

class Inspector {
 public:
  Inspector(const render::Scene& scene, const render::RenderOptions& options, const InspectSettings& settings,
            render::Progress& progress)
      : m_scene(scene),
        m_options(options),
        m_settings(settings),
        m_progress(progress),
        m_lights(scene.emitters()),
        m_guide(guideOptionsOf(options)),
        m_store(m_guide.clamp) {}

  std::optional<Inspection> run() {
    // The truth at a place is traced from there, and nothing says which medium it lies in.
    if (!m_scene.media().empty())
      throw render::OptionError("odis inspect: does not know participating media, which the scene has");
    // What is wrong with the pixel is found out before time is spent.
    if (m_settings.pixel) m_place = placeOfPixel(m_scene, m_lights, m_options, *m_settings.pixel);
    m_pilot = renderPilot(m_scene, m_options, m_progress);
    if (m_pilot.interrupted) return std::nullopt;
    m_vertices = m_pilot.vertices;
    buildGuides();
    findCell();
    traceTruth();
    if (m_progress.cancelled()) return std::nullopt;
    describeVertex();
    describeLevels();
    describeSamples();
    describeMaps();
    describeLights();
    return std::move(m_result);
  }

 private:
  struct NamedGuide {
    std::string name;
    Guide guide;
  };

  // The formula's guide and, if another model is chosen, that one's; the last one decides.
  void buildGuides() {
    const auto build = [&](const std::string& name, const std::string& more) {
      GuideBuilder builder(GuideOptions(m_pilot.guideOptions).set("cached=off maps=always" + more));
      builder.add(m_pilot.vertices);
      m_guides.push_back({name, builder.build(m_pilot.pixelValues)});
    };
    build("formula", " guide=histogram");
    const std::optional<Model>& model = m_options.model;
    if (m_guide.guide == core::GuideKind::network && (!model || model->get()->model.directions))
      build("network", "");
    // The statistics that they were made from: the builder's own, with the same numbers.
    const ArrayView<const PathVertex> vertices = m_pilot.vertices;
    m_store.add(VertexParts(&vertices, 1), m_guide.cellsPerDiagonal);
    m_cells = m_store.rollUp();
  }

  void findCell() {
    if (!m_settings.pixel) {
      if (!m_settings.point) throw render::OptionError("expected a pixel or a point to inspect");
      m_place = placeAtPoint(m_scene, m_vertices, m_store, m_cells, *m_settings.point, m_settings.normal);
    }
    m_cell = finestCell(m_store, m_place.position, m_place.normal);
    if (m_cell == kNoCell)
      throw render::OptionError(
          fmt::format("--pixel: the pilot saw nothing around the vertex at {:.4g},{:.4g},{:.4g}",
                      m_place.position.x, m_place.position.y, m_place.position.z));
    const int level = m_cells[m_cell].level;
    m_members = membersOf(m_vertices, m_store.grid(),
                          m_store.grid().key(m_place.position, m_place.normal, level), level);
  }

  // From vertices spread evenly over those of the cell.
  void traceTruth() {
    std::vector<Start> starts;
    const size_t count = std::min(m_members.size(), kMostStarts);
    for (size_t i = 0; i < count; ++i)
      if (const auto start = findStart(m_scene, m_vertices, m_members[i * m_members.size() / count]))
        starts.push_back(*start);
    if (starts.empty()) starts.push_back(m_place.start);
    const int depth = m_options.maxDepth < 0 ? kDeepestPath : m_options.maxDepth - int(m_place.vertex.depth);
    m_halves =
        traceConverged(m_scene, m_lights, starts,
                       {m_settings.paths, std::clamp(depth, 1, kDeepestPath), m_options.seed}, m_progress);
    m_truth = m_halves[0];
    m_truth.add(m_halves[1]);
    m_result.starts = uint32_t(starts.size());
    m_result.paths = m_truth.paths();
    m_result.outgoing = m_truth.outgoing();
    m_result.outgoingRms = m_truth.outgoingRms();
    m_result.outgoingRays = m_truth.outgoingRays();
  }

  const Guide& guide() const { return m_guides.back().guide; }
  uint32_t cellOf(const Guide& guide) const {
    return odis::findCell(guide.view(), {m_place.position, m_place.normal, 0, 0});
  }

  void describeVertex() {
    const PathVertex& v = m_result.vertex = m_place.vertex;
    const render::Crop& crop = m_result.crop = m_scene.film().crop;
    m_result.pixel = render::Vec2i(crop.x + int(v.pixel) % crop.width, crop.y + int(v.pixel) / crop.width);
    m_result.image = imageOf(m_pilot, crop);
    std::set<uint32_t> pixels;
    for (const size_t i : m_members)
      if (m_vertices[i].depth == 1) pixels.insert(m_vertices[i].pixel);
    m_result.cellPixels.assign(pixels.begin(), pixels.end());
    m_result.guidable = v.guidableProbability;
    m_result.cell = guide().view().decisions[cellOf(guide())];
    m_result.bsdfFraction =
        v.guidableProbability > 0
            ? m_result.cell.bsdfFraction[roughnessClass(guide().view().rules, v.roughness)]
            : 1;
    m_result.pixelValue = m_pilot.pixelValues[v.pixel];
    m_result.survival =
        m_options.setting("roulette") != "throughput"
            ? survivalProbability(guide().view().rules, m_result.cell.survivalFactor, 1 / m_result.pixelValue)
            : 1;
  }

  void describeLevels() {
    const VertexIntegral integral(m_place.start, m_truth);
    const float floor = m_guide.floor;
    const core::PackedMap converged = integral.mapOf(integral.texels(), floor);
    for (uint32_t c = m_cell; c != kNoCell; c = m_cells[c].parent) {
      const core::CellStatistics& cell = m_cells[c];
      LevelView& level = m_result.levels.emplace_back();
      level.cell = c;
      const CellGrid& grid = m_store.grid();
      level.edge = grid.edge(grid.key(m_place.position, m_place.normal, cell.level));
      level.effective = core::effectiveSamples(cell.sum, cell.sumSquares);
      level.own = core::ownWeight(level.effective, m_guide.priorSamples[size_t(cell.level)]);
      level.statistics = cell;
      level.histogram = squareOf(cell.histogram);
      level.judgement = integral.judge(integral.mapOf(radianceOf(cell, cell.histogram), floor).view(),
                                       converged.view(), m_result.bsdfFraction);
      level.judgement.entropy = entropyOf(cell.histogram);
    }
  }

  void describeSamples() {
    const core::CellStatistics& cell = m_cells[m_cell];
    double sum = 0;
    for (const size_t i : m_members) sum += core::sampleValue(m_vertices[i]);
    const double scale = sum > 0 ? double(m_members.size()) / sum : 0;
    for (const size_t i : m_members) {
      const PathVertex& v = m_vertices[i];
      m_result.samples.push_back({directionToSquare(core::reaim(v.position, v.wi, v.distance, cell.centroid)),
                                  float(core::sampleValue(v) * scale)});
    }
  }

  void describeMaps() {
    const float floor = m_guide.floor, bsdfFraction = m_result.bsdfFraction;
    const VertexIntegral integral(m_place.start, m_truth);
    const core::PackedMap truth = integral.mapOf(integral.texels(), floor);
    const auto fill = [&](MapView& view, const SamplingMap<float>& map) {
      view.density = squareOf(map);
      view.mixture = integral.mixture(map, bsdfFraction);
      view.judgement = integral.judge(map, truth.view(), bsdfFraction);
    };
    for (const NamedGuide& g : m_guides) {
      const uint32_t cell = cellOf(g.guide);
      const SamplingMap<float> map(g.guide.view().maps, int32_t(cell));
      MapView& view = m_result.maps.emplace_back();
      view.name = g.name;
      view.radiance = squareOf(radianceOf(m_cells[m_cell], core::probabilitiesOf(map)));
      std::copy_n(g.guide.view().decisions[cell].bsdfFraction, kRoughnessClasses, view.bsdfFraction);
      fill(view, map);
    }
    m_result.converged.name = "converged";
    m_result.converged.radiance = integral.radiance();
    fill(m_result.converged, truth.view());
    m_result.bsdf = integral.bsdf();
    m_result.best = integral.best();
    m_result.bsdfAlone.moment = m_result.bsdfAlone.bestMoment = integral.moment(truth.view(), 1);

    core::PackedMap halves[2];
    for (size_t i = 0; i < 2; ++i)
      halves[i] = integral.mapOf(VertexIntegral(m_place.start, m_halves[i]).texels(), floor);
    m_result.noise = divergence(halves[0].view(), halves[1].view());
  }

  void describeLights() {
    m_result.lightShare = m_result.cell.learnedLightFraction;
    render::LightReference reference = m_place.start.reference;
    for (uint32_t group = 0; group < m_lights.groupCount(); ++group) {
      GroupView& view = m_result.groups.emplace_back();
      view.lights = m_lights.describe(group);
      reference.learned = {};
      view.unlearned = m_lights.groupProbability(reference, group);
      if (m_options.setting("lights") != "hierarchy")
        reference.learned = learnedLights(guide().view(), cellOf(guide()));
      view.learned = m_lights.groupProbability(reference, group);
      view.converged = m_truth.lights(group);
    }
  }

  const render::Scene& m_scene;
  const render::RenderOptions& m_options;
  const InspectSettings& m_settings;
  render::Progress& m_progress;
  render::LightSampler m_lights;
  PilotPass m_pilot;
  std::span<const PathVertex> m_vertices;  // the pilot's
  std::vector<NamedGuide> m_guides;
  core::GuideOptions m_guide;
  core::CellStore m_store;
  std::vector<core::CellStatistics> m_cells;
  InspectedPlace m_place;
  uint32_t m_cell = kNoCell;
  std::vector<size_t> m_members;  // of the cell
  std::array<Converged, 2> m_halves;
  Converged m_truth;
  Inspection m_result;
};

}  // namespace

std::optional<Inspection> inspect(const render::Scene& scene, const render::RenderOptions& options,
                                  const InspectSettings& settings, render::Progress& progress) {
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
  return Inspector(scene, options, settings, progress).run();
}

}  // namespace odis::learn
