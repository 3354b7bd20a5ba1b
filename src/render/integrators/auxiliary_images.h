// The images that tell a denoiser where the edges and textures of an image are.
#pragma once

#include <vector>

#include "render/path/progress.h"
#include "render/scene/scene.h"

namespace odis::render {

// Albedo and normals of the crop, as RenderedImage has them, at the first surface that is no mirror, glass or
// coat, with samples of their own.
struct AuxiliaryImages {
  std::vector<Rgb> albedo;
  std::vector<Vec3> normal;
};

// Renders them almost without noise: 8 samples per pixel, and up to 32 where a pixel's samples differ. Camera
// rays cost little beside paths, and what is jagged or noisy here would be so in the denoised image. Empty if
// progress was cancelled. The same bits for any number of threads.
AuxiliaryImages renderAuxiliaries(const Scene& scene, uint64_t seed, int threads, Progress& progress);

}  // namespace odis::render
