// Progress of work that is done piece by piece.
#pragma once

#include <chrono>
#include <string>

#include "console.h"

namespace odis::app {

// "[3/10, 4.2 s left] what": one line that changes if stderr is a terminal, otherwise one every ten seconds,
// and one for the last piece.
class Counter {
 public:
  Counter(size_t total, bool quiet);
  void done(const std::string& what);
  // What need not be done does not tell how long the rest takes.
  void skipped(const std::string& what);

 private:
  void show(const std::string& what);

  size_t m_total, m_done = 0, m_skipped = 0;
  bool m_quiet, m_terminal;
  LinePace m_pace;
  std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

}  // namespace odis::app
