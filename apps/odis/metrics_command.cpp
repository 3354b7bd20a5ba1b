// odis metrics
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "eval/image_file.h"
#include "eval/metrics.h"

namespace odis::app {

namespace {

struct MetricsArguments {
  std::string image, reference, layer, referenceLayer;
  bool json = false;
};

}  // namespace

static int runMetrics(const MetricsArguments& arguments) {
  const eval::ColorImage image = eval::readColor(arguments.image, arguments.layer),
                         reference = eval::readColor(arguments.reference, arguments.referenceLayer);
  if (image.width != reference.width || image.height != reference.height)
    throw eval::ImageError(fmt::format("{} is {} x {}, {} is {} x {}: they must be of one size",
                                       arguments.image, image.width, image.height, arguments.reference,
                                       reference.width, reference.height));
  eval::ErrorMetrics m;
  try {
    m = eval::compareImages(image, reference);
  } catch (const std::invalid_argument& error) {
    throw eval::ImageError(fmt::format("{}: {}", arguments.reference, error.what()));
  }
  if (arguments.json) {
    const nlohmann::ordered_json json = {{"relMse", m.relMse}, {"trimmedRelMse", m.trimmedRelMse},
                                         {"smape", m.smape},   {"flip", m.flip},
                                         {"ssim", m.ssim},     {"mse", m.mse},
                                         {"mean", m.mean},     {"nonFinitePixels", m.nonFinitePixels}};
    fmt::print("{}\n", json.dump(2));
    return kOk;
  }
  fmt::print(
      "relMSE          {:.6g}\ntrimmed relMSE  {:.6g}\nSMAPE           {:.6g}\nMSE             {:.6g}\n"
      "FLIP            {:.6g}\nSSIM            {:.6g}\nmean            {:.6g}\n",
      m.relMse, m.trimmedRelMse, m.smape, m.mse, m.flip, m.ssim, m.mean);
  if (m.nonFinitePixels > 0) fmt::print("not finite      {} pixels\n", m.nonFinitePixels);
  return kOk;
}

Command addMetricsCommand(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("metrics", "Measure the error of an image");
  app->footer(
      "Both images are divided by the mean luminance of REFERENCE. Averages over pixels and channels of\n"
      "  relMSE  (I - R)^2 / (R^2 + 0.01); trimmed: without the worst 0.1 % of the pixels\n"
      "  SMAPE   |I - R| / ((|I| + |R|) / 2 + 0.01)\n"
      "  MSE     (I - R)^2\n"
      "  mean    luminance of I; 1 for the REFERENCE itself\n"
      "FLIP is LDR-FLIP at 67 pixels per degree of both images as a screen shows them: exposed so that the\n"
      "log-average luminance of REFERENCE is 0.18, highlights rolled off as in the PNGs of `odis render`. "
      "SSIM\n"
      "is of the same two images, 1 for the REFERENCE itself.");
  const auto arguments = std::make_shared<MetricsArguments>();
  app->add_option("IMAGE", arguments->image, "EXR, PNG, JPEG, TGA, BMP or HDR file")->required();
  app->add_option("REFERENCE", arguments->reference, "The same")->required();
  app->add_option(
      "--layer", arguments->layer,
      "Which layer of IMAGE; default: the one without a name, Blender's Combined, or the only one "
      "with R, G and B");
  app->add_option("--reference-layer", arguments->referenceLayer,
                  "Which layer of REFERENCE; default: likewise");
  app->add_flag("--json", arguments->json, "Print JSON");
  return {app, [arguments] { return runMetrics(*arguments); }};
}

}  // namespace odis::app
