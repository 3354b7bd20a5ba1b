// Progress of long work.
#pragma once

#include <cstdint>
#include <string>

namespace odis::render {

// Told of progress from the rendering threads; asked whether to stop. Stopping ends after the current pass of
// tiles, with what there is.
class Progress {
 public:
  virtual ~Progress() = default;
  // `done` of the stage's samples were taken by an earlier run.
  virtual void begin(const std::string& /*stage*/, uint64_t /*totalSamples*/, uint64_t /*done*/ = 0) {}
  virtual void advance(uint64_t /*samples*/) {}
  virtual void end() {}
  // Something that was asked for can't be done, but the work goes on.
  virtual void warn(const std::string& /*message*/) {}
  virtual bool cancelled() const { return false; }
};

}  // namespace odis::render
