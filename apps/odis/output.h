// The files that a rendering leaves.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "render/files/output_path.h"
#include "render/image/write.h"
#include "render/integrators/render.h"

namespace odis::app {

struct Layers {
  bool alpha = false, albedo = false, normal = false, position = false, depth = false, roughness = false,
       guide = false;
  bool any() const { return alpha || albedo || normal || position || depth || roughness || guide; }
};

// "albedo,depth" or "all"; throws UsageError.
Layers parseLayers(const std::string& text);

// The files that a command is going to write, checked before any time is spent.
class Outputs {
 public:
  // Throws UsageError if the ending is not one of `endings`, which may be none, or if the file is another
  // output, too; WriteError if it can't be written.
  void add(const std::string& path, std::initializer_list<const char*> endings);
  // Throws UsageError if an output would be written over one of the files that are read.
  void rejectInputs(const std::vector<std::string>& inputs) const;

 private:
  struct Output {
    std::string name;
    render::FileIdentity identity;
  };
  std::vector<Output> m_outputs;
};

// The files that a command writes, and which of them take the place of another.
class WrittenFiles {
 public:
  // To be made before the first is written. Empty names stand for files that nobody asked for.
  explicit WrittenFiles(const std::vector<std::string>& paths);
  // A line for each, "image.exr: written " with what there is to say of the first, "look.png: replaced".
  std::string text(const std::string& first) const;

 private:
  struct File {
    std::string path;
    bool replaces = false;
  };
  std::vector<File> m_files;
};

bool endsWith(const std::string& path, const std::string& ending);

// One EXR: R, G, B; noisy.R G B if those are denoised; variance.R G B if there is a variance; the layers
// asked for: A, albedo.R G B, N.X Y Z, P.X Y Z, depth.Z, roughness.Y, guide.alpha, guide.entropy,
// guide.survival, guide.cell, guide.samples. Throws WriteError.
void writeLayers(const std::string& path, const render::RenderedImage& frame,
                 const render::FilmSettings& film, const Layers& layers,
                 const std::map<std::string, std::string>& metadata);
// Each throws WriteError.
void writePreview(const std::string& path, const render::RenderedImage& frame, float exposure);
// Linear colours, row by row from the top: .png, or else .exr with values as they are.
void writeColors(const std::string& path, int width, int height, const std::vector<render::Rgb>& colors,
                 render::ToneMap toneMap);
void writeText(const std::string& path, const std::string& text);

}  // namespace odis::app
