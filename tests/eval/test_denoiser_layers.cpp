// That the layers a denoiser takes are found in files of several renderers.
#include "eval/denoiser_layers.h"

#include <gtest/gtest.h>

using namespace odis::eval;

namespace {

// A file with these layers of three channels.
LayeredImage fileOf(std::initializer_list<const char*> layers) {
  LayeredImage image;
  image.window = {1, 1, 0, 0, 1, 1};
  for (const std::string layer : layers) {
    const bool direction = layer.find("ormal") != std::string::npos || layer.ends_with("N") ||
                           layer.ends_with("Ns") || layer.ends_with("nn");
    for (const char component : std::string(direction ? "XYZ" : "RGB"))
      image.channels[(layer.empty() ? "" : layer + ".") + component] = {1};
  }
  return image;
}

void expectLayers(const LayeredImage& image, const char* color, const char* albedo, const char* normal) {
  EXPECT_EQ(findColorLayer(image), color);
  EXPECT_EQ(findAlbedoLayer(image), albedo);
  EXPECT_EQ(findNormalLayer(image), normal);
}

TEST(DenoiserLayers, OfSeveralRenderers) {
  expectLayers(fileOf({"", "albedo", "N", "P"}), "", "albedo", "N");
  expectLayers(fileOf({"", "noisy", "variance", "albedo", "N"}), "noisy", "albedo", "N");
  expectLayers(fileOf({"", "Albedo", "N", "Ns", "P", "Variance"}), "", "Albedo", "Ns");  // pbrt-v4
  expectLayers(fileOf({"", "albedo", "nn"}), "", "albedo", "nn");                        // Mitsuba 3
  expectLayers(fileOf({"", "albedo", "sh_normal", "N"}), "", "albedo", "sh_normal");
  expectLayers(fileOf({"ViewLayer.Combined", "ViewLayer.Denoising Albedo", "ViewLayer.Denoising Normal",
                       "ViewLayer.Normal", "ViewLayer.DiffCol", "ViewLayer.Noisy Image"}),
               "ViewLayer.Noisy Image", "ViewLayer.Denoising Albedo", "ViewLayer.Denoising Normal");
}

TEST(DenoiserLayers, NoneWhereThereIsNone) {
  const LayeredImage image = fileOf({"beauty", "Diffuse"});
  EXPECT_FALSE(findColorLayer(image));
  EXPECT_FALSE(findAlbedoLayer(image));
  EXPECT_FALSE(findNormalLayer(image));
  LayeredImage incomplete = fileOf({""});
  incomplete.channels["albedo.R"] = incomplete.channels["albedo.G"] = {1};
  EXPECT_FALSE(findAlbedoLayer(incomplete));
}

}  // namespace
