// Progress of long work.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// Told of progress from the rendering threads; asked whether to stop. Stopping ends after the current pass of
// tiles, with what there is.
class Progress {
 public:
  virtual ~Progress() = default;
  // `done` of the stage's samples, or whatever `unit` names, were taken by an earlier run.
  virtual void begin(const std::string& /*stage*/, uint64_t /*total*/, uint64_t /*done*/ = 0,
                     const char* /*unit*/ = "samples") {}
  // The stage turns out to have another number of samples than it began with.
  virtual void changeTotal(uint64_t /*total*/) {}
  virtual void advance(uint64_t /*more*/) {}
  virtual void end() {}
  // Something that was asked for can't be done, but the work goes on.
  virtual void warn(const std::string& /*message*/) {}
  virtual bool cancelled() const { return false; }
  // Whether a picture of the unfinished image should be shown. Asked by the rendering threads before each
  // tile; all of them wait for the picture.
  virtual bool wantsPicture() const { return false; }
  // Shows linear colours, width * height of them, row 0 at the top.
  virtual void showPicture(int /*width*/, int /*height*/, std::vector<Rgb> /*colors*/) {}
};

}  // namespace odis::render
