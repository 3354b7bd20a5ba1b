// A contact sheet: small pictures of many scenes, with names.
#pragma once

#include <string>
#include <vector>

#include "learn/scenes/canvas.h"
#include "render/integrators/render.h"

namespace odis::learn {

struct SheetOptions {
  int width = 160;  // of a picture; three quarters as high at most
  int spp = 32;
  int columns = 8;
};

// The scenes of a folder: its sub-folders that hold a scene.xml, by name. Throws
// std::filesystem::filesystem_error.
std::vector<std::string> scenesIn(const std::string& folder);

// Adds pictures one by one.
class SheetPainter {
 public:
  SheetPainter(const SheetOptions& options, size_t count);
  // Renders DIR/scene.xml by plain path tracing and puts it in the next place, with `name` below. False if
  // the rendering was stopped. Throws SceneError.
  bool add(const std::string& folder, const std::string& name, render::Progress& progress);
  const Canvas& sheet() const { return m_sheet; }

 private:
  SheetOptions m_options;
  int m_cellHeight;
  size_t m_next = 0;
  Canvas m_sheet;
};

}  // namespace odis::learn
