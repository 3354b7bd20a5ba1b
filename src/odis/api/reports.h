// What the log is told of vertices, guides and frames.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "odis/frame.h"
#include "odis/odis.h"

namespace odis::core {

// Why vertices can't be learned from, as one of the reasons that VertexCounts has.
struct RefusalReason {
  uint64_t VertexCounts::*count;
  const char* words;
  bool isMistake;  // of the host's
};

// Warns once of each reason, the first time that vertices were refused for it by mistake.
class RefusalWarnings {
 public:
  void report(OdisContextImpl& context, const VertexCounts& counts);

 private:
  static constexpr size_t kReasons = 11;
  static const std::array<RefusalReason, kReasons>& reasons();
  friend std::string countsText(const VertexCounts& counts);

  std::array<bool, kReasons> m_told{};
};

// "120 vertices taken, 3 refused (1: ..., 2: ...)"
std::string countsText(const VertexCounts& counts);

// Tells how large a guide is and what it is predicted to gain.
void reportGuide(OdisContextImpl& context, const Guide& guide);

// Tells what becomes of a frame: of each guide when it is built, of what goes wrong when it does, and in the
// end how it fared.
class FrameReport {
 public:
  // What a frame knows that goes on where it was saved is told already.
  explicit FrameReport(const FrameStatistics& known) : m_told(known) {}
  // To be called when a pass has ended. `verticesLeftOut`: by the library itself, for want of memory.
  void report(OdisContextImpl& context, const Frame& frame, bool verticesLeftOut);

 private:
  FrameStatistics m_told;
};

}  // namespace odis::core
