// odis agreement
#include "eval/agreement.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "console.h"
#include "eval/image_file.h"
#include "output.h"
#include "render/film/filter.h"
#include "render/image/write.h"
#include "scene_warnings.h"
#include "validators.h"

namespace odis::app {

namespace {

struct AgreementArguments {
  std::string scene, reference, picture;
  int spp = 256, maxDepth = 13, rrDepth = 5, threads = 0;
  uint64_t seed = 0;
  bool json = false, quiet = false;
};

// What `path` makes of the scene under the conditions of the reference: its size, a box filter, independent
// samples, whose spread tells the standard error.
eval::Estimate renderEstimate(const AgreementArguments& a, const Outputs& outputs, int width, int height) {
  render::LoadOptions load;
  load.resolution = render::Vec2i(width, height);
  render::Warnings warnings;
  const std::unique_ptr<render::Scene> scene = render::Scene::load(a.scene, load, warnings);
  tellWarnings(a.scene, warnings, {.quiet = a.quiet});
  outputs.rejectInputs(scene->files());
  render::FilmSettings film = scene->film();
  film.filter = render::makeBoxFilter();
  scene->setFilm(film);

  render::RenderOptions options;
  options.integrator = render::IntegratorKind::path;
  options.sampler = render::SamplerKind::independent;
  options.spp = a.spp;
  options.seed = a.seed;
  options.threads = a.threads;
  options.maxDepth = a.maxDepth;
  options.rrDepth = a.rrDepth;
  options.variance = true;
  ConsoleProgress progress(a.quiet);
  const render::RenderResult result = render::render(*scene, options, progress);
  eval::Estimate estimate{width, height, result.image.color, result.image.variance};
  for (render::Rgb& v : estimate.standardError) v = {std::sqrt(v.x), std::sqrt(v.y), std::sqrt(v.z)};
  return estimate;
}

// Blocks that are too bright in red, too dark in blue, full colour where the difference is twice what is
// allowed; the grey is the reference.
void writePicture(const std::string& path, const eval::Agreement& found, const eval::Estimate& reference) {
  double mean = 0;
  for (const render::Rgb& c : reference.mean) mean += render::luminance(c);
  mean /= double(reference.mean.size());
  std::vector<render::Rgb> pixels;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      const float excess = found.excess[size_t(y / eval::kAgreementBlock) * size_t(found.blocksX) +
                                        size_t(x / eval::kAgreementBlock)];
      const float grey =
          0.3f *
          std::min(1.0f,
                   float(render::luminance(reference.mean[size_t(y) * size_t(reference.width) + size_t(x)]) /
                         (3 * mean)));
      const float strength = std::min(std::max(std::abs(excess) - 1, 0.0f), 1.0f);
      pixels.emplace_back(excess > 0 ? grey + strength : grey, grey, excess < 0 ? grey + strength : grey);
    }
  render::writePng(path, reference.width, reference.height, pixels.data(), 0, render::ToneMap::clamp);
}

}  // namespace

static int runAgreement(const AgreementArguments& a) {
  Outputs outputs;
  if (!a.picture.empty()) outputs.add(a.picture, {".png"});
  outputs.rejectInputs({a.scene, a.reference});
  const eval::Estimate reference = eval::readEstimate(a.reference);
  const InterruptScope interruptible;
  const eval::Estimate image = renderEstimate(a, outputs, reference.width, reference.height);
  if (InterruptScope::interrupted()) return InterruptScope::exitCode();
  const eval::Agreement found = eval::agreement(image, reference);
  const double share = double(found.agreeing) / found.blocks;
  if (!a.picture.empty()) writePicture(a.picture, found, reference);
  if (a.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"scene", a.scene},
                                              {"spp", a.spp},
                                              {"blocks", found.blocks},
                                              {"agreeing", share},
                                              {"meanRatio", found.meanRatio},
                                              {"meanRatioError", found.meanRatioError},
                                              {"pixelsBeyond", found.pixelsBeyond}}
                           .dump());
  else
    fmt::print(
        "blocks that agree      {:.2f} % of {}\nmean, ratio            {:.5f} +- {:.5f}\n"
        "pixels beyond {:.0f} s.e.  {:.3f} %\n",
        100 * share, found.blocks, found.meanRatio, found.meanRatioError, eval::kAgreementErrors,
        100 * found.pixelsBeyond);
  return kOk;
}

Command addAgreementCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("agreement", "Test path tracing against another renderer's image");
  app->footer(fmt::format(
      "Blocks of {0} x {0} pixels agree if the means of every channel differ by at most {1:.0f} standard "
      "errors\nplus {2} % of the reference.",
      eval::kAgreementBlock, eval::kAgreementErrors, 100 * eval::kAgreementShare));
  const auto a = std::make_shared<AgreementArguments>();
  app->add_option("SCENE", a->scene, "Mitsuba scene file")->required();
  app->add_option("REFERENCE", a->reference, "EXR file with R, G, B and their standard errors, stderr.R, ...")
      ->required();
  app->add_option("--picture", a->picture,
                  "PNG of the blocks that do not agree: red too bright, blue too dark");
  app->add_option("--spp", a->spp, "Samples per pixel")
      ->check(within(kSamplesPerPixel))
      ->capture_default_str();
  app->add_option("--seed", a->seed, "Another seed, another noise")
      ->check(within(kSeed))
      ->capture_default_str();
  app->add_option("--max-depth", a->maxDepth, "As the reference has it")
      ->check(within(kMaxDepth))
      ->capture_default_str();
  app->add_option("--rr-depth", a->rrDepth, "As the reference has it")
      ->check(within(kRouletteDepth))
      ->capture_default_str();
  app->add_option("--threads", a->threads, "0: one a core")
      ->check(within(kThreadCount))
      ->capture_default_str();
  app->add_flag("--json", a->json, "Print JSON");
  app->add_flag("-q,--quiet", a->quiet, "No progress, of warnings only those of a picture that changes");
  return {app, [a] { return runAgreement(*a); }};
}

}  // namespace odis::app
