// The files that a rendering leaves.
#pragma once

#include <map>
#include <string>

#include "render/integrators/render.h"

namespace odis::app {

struct Layers {
  bool albedo = false, normal = false, position = false, depth = false, roughness = false, guide = false;
  bool any() const { return albedo || normal || position || depth || roughness || guide; }
};

// "albedo,depth" or "all"; throws UsageError.
Layers parseLayers(const std::string& text);

// Throws WriteError, before any time is spent, if a file can't be made there or if its ending is not one of
// `endings`.
void checkWritable(const std::string& path, std::initializer_list<const char*> endings);
bool endsWith(const std::string& path, const std::string& ending);

// One EXR: R, G, B; variance.R G B if there is a variance; the layers asked for: albedo.R G B, N.X Y Z, P.X Y
// Z, depth.Z, roughness.Y, guide.alpha, guide.entropy, guide.survival, guide.cell, guide.samples. Throws
// WriteError.
void writeLayers(const std::string& path, const render::RenderedImage& frame,
                 const render::FilmSettings& film, const Layers& layers,
                 const std::map<std::string, std::string>& metadata);
// Each throws WriteError.
void writePreview(const std::string& path, const render::RenderedImage& frame, float exposure);
void writeText(const std::string& path, const std::string& text);

}  // namespace odis::app
