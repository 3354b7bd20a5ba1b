#include "counter.h"

#include <fmt/format.h>

#include "command.h"

namespace odis::app {

Counter::Counter(size_t total, bool quiet) : m_total(total), m_quiet(quiet), m_terminal(onTerminal()) {}

void Counter::done(const std::string& what) {
  ++m_done;
  show(what);
}

void Counter::skipped(const std::string& what) {
  ++m_skipped;
  show(what);
}

void Counter::show(const std::string& what) {
  if (m_quiet) return;
  const size_t gone = m_done + m_skipped;
  if (!m_terminal && gone < m_total && !m_pace.isDue()) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
  const std::string left =
      m_done > 0 ? ", " + durationText(seconds / double(m_done) * double(m_total - gone)) + " left" : "";
  const char *start = m_terminal ? "\r\033[K" : "", *end = m_terminal && gone < m_total ? "" : "\n";
  say(fmt::format("{}[{}/{}{}] {}{}", start, gone, m_total, left, what, end));
}

}  // namespace odis::app
