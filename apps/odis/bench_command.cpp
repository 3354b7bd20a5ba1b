// odis bench
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "console.h"
#include "eval/benchmark.h"
#include "eval/compare.h"
#include "eval/vertex_costs.h"
#include "scene_warnings.h"
#include "validators.h"

namespace odis::app {

namespace {

struct BenchArguments {
  std::vector<std::string> scenes;
  eval::BenchmarkSettings settings;
  std::string sampler = "independent";
  int pixels = 57600;
  bool vertex = false, json = false, quiet = false;
};

struct Row {
  std::string scene;
  double secondsLoad = 0;
  eval::BenchmarkResult result;
  eval::VertexCosts vertex;
};

// What a ray of `path` takes, in nanoseconds of a core.
double ofRay(const eval::BenchmarkResult& r) {
  return 1e9 / (r.samplesPerCpuSecond * r.raysPerSecond / r.samplesPerSecond);
}

nlohmann::ordered_json toJson(const Row& row, bool vertex) {
  const eval::BenchmarkResult& r = row.result;
  nlohmann::ordered_json json = {{"scene", row.scene},
                                 {"pixels", r.pixels},
                                 {"secondsLoad", row.secondsLoad},
                                 {"samplesPerSecond", r.samplesPerSecond},
                                 {"samplesPerCpuSecond", r.samplesPerCpuSecond},
                                 {"raysPerSecond", r.raysPerSecond},
                                 {"guidedCost", r.guidedCost},
                                 {"guidingShare", r.guidingShare},
                                 {"frameCost", r.frameCost},
                                 {"bytesPerVertex", r.bytesPerVertex},
                                 {"bytesMaps", r.bytesMaps},
                                 {"guidedRayCost", r.costs.guidedRay},
                                 {"builtCellCost", r.costs.builtCell},
                                 {"recordedRayCost", r.costs.recordedRay}};
  const eval::VertexCosts& v = row.vertex;
  if (vertex)
    json["vertex"] = {{"lookUp", v.lookUp},       {"prepare", v.prepare}, {"pdf", v.pdf},
                      {"direction", v.direction}, {"guided", v.guided},   {"ray", ofRay(r)}};
  return json;
}

void printVertexCosts(const std::vector<Row>& rows) {
  fmt::print(
      "\n| scene | cell, ns | prepare | density | direction | guided vertices | ray of path |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    const eval::VertexCosts& v = row.vertex;
    fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} % | {:.0f} |\n", row.scene, v.lookUp,
               v.prepare, v.pdf, v.direction, 100 * v.guided, ofRay(row.result));
  }
}

void printRow(const Row& row) {
  const eval::BenchmarkResult& r = row.result;
  fmt::print(
      "| {} | {:.2f} | {:.3f} | {:.2f} | {:.2f} | {:.1f} % | {:.2f} | {:.0f} | {} | {:.2f} | {:.0f} | {:.2f} "
      "|\n",
      row.scene, row.secondsLoad, r.samplesPerSecond * 1e-6, r.raysPerSecond * 1e-6, r.guidedCost,
      100 * r.guidingShare, r.frameCost, r.bytesPerVertex, bytesText(double(r.bytesMaps)), r.costs.guidedRay,
      r.costs.builtCell, r.costs.recordedRay);
  std::fflush(stdout);
}

// The means over the scenes of what operations cost, as a frame can be told of them.
void printCosts(const std::vector<Row>& rows) {
  double guidedRay = 0, builtCell = 0, recordedRay = 0;
  for (const Row& row : rows) {
    const eval::OperationCosts& costs = row.result.costs;
    guidedRay += costs.guidedRay / double(rows.size());
    builtCell += costs.builtCell / double(rows.size());
    recordedRay += costs.recordedRay / double(rows.size());
  }
  fmt::print(
      "\nMeans of the last three columns: {:.2f}, --set built-cell-cost={:.0f}, --set "
      "recorded-ray-cost={:.2f}\n",
      guidedRay, builtCell, std::max(recordedRay, 0.0));
}

}  // namespace

static eval::VertexCosts measureVertex(const render::Scene& scene, const eval::BenchmarkSettings& settings,
                                       render::Progress& progress) {
  const render::RenderOptions options = eval::optionsOf(settings, render::IntegratorKind::odis);
  return eval::vertexCosts(render::renderPilot(scene, options, progress), settings.rounds);
}

static int runBench(BenchArguments& a) {
  a.settings.sampler = a.sampler == "sobol" ? render::SamplerKind::sobol : render::SamplerKind::independent;
  const InterruptScope interruptible;
  ConsoleProgress progress(a.quiet);
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  std::vector<Row> rows;
  const auto printHead = [&] {
    fmt::print(
        "| scene | load, s | path, M samples/s | M rays/s | guided sample | guiding of a frame | frame | "
        "B a vertex | maps | guided ray | built cell | recorded ray |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  };
  for (const std::string& path : a.scenes) {
    Row row{eval::sceneName(path), 0, {}, {}};
    progress.setTitle(row.scene);
    render::Warnings warnings;
    const auto start = std::chrono::steady_clock::now();
    render::LoadOptions load;
    load.pixels = a.pixels;
    const std::unique_ptr<render::Scene> scene = render::Scene::load(path, load, warnings);
    tellWarnings(path, warnings, {.quiet = a.quiet});
    row.secondsLoad = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    row.result = eval::benchmark(*scene, a.settings, progress);
    if (a.vertex && !InterruptScope::interrupted()) row.vertex = measureVertex(*scene, a.settings, progress);
    if (InterruptScope::interrupted()) return InterruptScope::exitCode();
    if (!a.json && rows.empty()) printHead();
    rows.push_back(row);
    if (a.json)
      all.push_back(toJson(row, a.vertex));
    else
      printRow(row);
  }
  if (a.json)
    fmt::print("{}\n", all.dump(2));
  else if (rows.size() > 1)
    printCosts(rows);
  if (a.vertex && !a.json) printVertexCosts(rows);
  return kOk;
}

Command addBenchCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("bench", "Measure how fast rendering is and what guiding adds");
  app->footer(
      "`path` and `odis` take turns at the same number of samples; medians over the rounds. \"Guided "
      "sample\" and\n"
      "\"frame\" are times in those of `path`, \"guiding of a frame\" is the share of recording the pilot "
      "and of\n"
      "building cells, maps and selection probabilities. The last three columns are times in that of a ray\n"
      "of `path`: `--set built-cell-cost` and `recorded-ray-cost` take them.\n"
      "--vertex says, in nanoseconds of a core, what a host pays that traces one path at a time: for finding "
      "the\n"
      "cell of a vertex, for preparing its map, for the density of a direction and for drawing one.");
  const auto a = std::make_shared<BenchArguments>();
  app->add_option("SCENE", a->scenes, "Mitsuba scene files")->required();
  app->add_option("--spp", a->settings.spp, "Samples per pixel, of which one is the pilot")
      ->check(within(2, 1 << 20))
      ->capture_default_str();
  app->add_option("--rounds", a->settings.rounds, "How often each renders")
      ->check(within(1, 1 << 24))
      ->capture_default_str();
  app->add_option("--pixels", a->pixels, "Render images of about this many pixels")
      ->check(within(kPixelCount))
      ->capture_default_str();
  app->add_option("--sampler", a->sampler, "Where random numbers come from")
      ->check(CLI::IsMember({"sobol", "independent"}))
      ->capture_default_str();
  app->add_option("--max-depth", a->settings.maxDepth, "In place of the scenes'")
      ->check(within(kMaxDepth))
      ->capture_default_str();
  app->add_option("--rr-depth", a->settings.rrDepth, "In place of the scenes'")
      ->check(within(kRouletteDepth))
      ->capture_default_str();
  app->add_option("--threads", a->settings.threads, "0: one a core")
      ->check(within(kThreadCount))
      ->capture_default_str();
  app->add_flag("--vertex", a->vertex, "Measure look-ups at single vertices, too");
  app->add_flag("--json", a->json, "Print JSON");
  app->add_flag("-q,--quiet", a->quiet, "No progress, of warnings only those of a picture that changes");
  return {app, [a] { return runBench(*a); }};
}

}  // namespace odis::app
