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
  virtual void begin(const std::string& /*stage*/, uint64_t /*totalSamples*/) {}
  virtual void advance(uint64_t /*samples*/) {}
  virtual void end() {}
  virtual bool cancelled() const { return false; }
};

}  // namespace odis::render
