#include "console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "command.h"

namespace odis::app {

void say(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

bool onTerminal() {
  return isatty(STDERR_FILENO) == 1;
}

void sayWarning(const std::string& message) {
  say(fmt::format("{}warning: {}\n", onTerminal() ? "\r\033[K" : "", message));
}

std::string paceText(const Work& work, const std::string& unit, bool isOver) {
  const double rate = double(work.done - work.before) / std::max(1e-6, work.seconds);
  const double left = double(work.total - std::min(work.done, work.total));
  const std::string time = isOver     ? durationText(work.seconds)
                           : rate > 0 ? durationText(left / rate) + " left"
                                      : "time left unknown";
  return fmt::format("{:.2f} M{}/s, {}", rate * 1e-6, unit, time);
}

bool LinePace::isDue() {
  const auto now = std::chrono::steady_clock::now();
  if (now - m_last < m_interval) return false;
  m_last = now;
  return true;
}

// The first signal that came. Rendering threads look at it, so it is an atomic; one that a handler may write.
static std::atomic<int> g_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free);

static int codeOf(int signal) {
  return signal == SIGTERM ? kTerminated : kInterrupted;
}

static void onSignal(int signal) {
  if (g_signal != 0) _exit(codeOf(signal));
  g_signal = signal;
}

InterruptScope::InterruptScope() {
  g_signal = 0;
  struct sigaction ours = {};
  ours.sa_handler = onSignal;
  ours.sa_flags = SA_RESTART;
  for (size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &m_before[i]);
    if (m_before[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &ours, nullptr);
  }
}
InterruptScope::~InterruptScope() {
  for (size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &m_before[i], nullptr);
}
bool InterruptScope::interrupted() {
  return g_signal != 0;
}
int InterruptScope::exitCode() {
  return g_signal != 0 ? codeOf(g_signal) : kOk;
}

// How much is done between two looks at the clock.
static uint64_t stepOf(uint64_t total) {
  return std::max<uint64_t>(1, total / 200);
}

ConsoleProgress::ConsoleProgress(bool quiet) : m_quiet(quiet), m_terminal(onTerminal()) {}

void ConsoleProgress::begin(const std::string& stage, uint64_t total, uint64_t done, const char* unit) {
  m_stage = m_title.empty() ? stage : m_title + ": " + stage;
  m_unit = unit;
  m_total = total;
  m_done = m_before = done;
  m_nextShow = done + stepOf(m_total);
  m_start = m_lastShow = std::chrono::steady_clock::now();
}

// Called from all rendering threads: only who passes the next mark prints.
void ConsoleProgress::advance(uint64_t more) {
  const uint64_t done = m_done.fetch_add(more, std::memory_order_relaxed) + more;
  if (m_quiet || m_total == 0 || done < m_nextShow.load(std::memory_order_relaxed)) return;
  const std::lock_guard lock(m_mutex);
  if (done < m_nextShow || done >= m_total) return;
  const uint64_t step = stepOf(m_total);
  m_nextShow = (done / step + 1) * step;
  show(done, false);
}

void ConsoleProgress::end() {
  if (m_quiet || m_total == 0) return;
  const std::lock_guard lock(m_mutex);
  show(m_done, true);
  m_total = 0;
}

void ConsoleProgress::warn(const std::string& message) {
  if (m_quiet) return;
  const std::lock_guard lock(m_mutex);
  if (m_warnings.insert(message).second) sayWarning(message);
}

void ConsoleProgress::show(uint64_t done, bool last) {
  using namespace std::chrono;
  const auto now = steady_clock::now();
  if (m_terminal ? !last && now - m_lastShow < milliseconds(100) : !m_pace.isDue()) return;
  m_lastShow = now;
  const double share = std::min(1.0, double(done) / double(m_total));
  const std::string pace =
      paceText({m_total, done, m_before, duration<double>(now - m_start).count()}, m_unit, last);
  if (!m_terminal) {
    say(fmt::format("{} {:3.0f} %  {}\n", m_stage, 100 * share, pace));
    return;
  }
  constexpr int kWidth = 30;
  const int filled = int(share * kWidth);
  say(fmt::format("\r\033[K{} [{}{}] {:3.0f} %  {}{}", m_stage, std::string(filled, '='),
                  std::string(kWidth - filled, ' '), 100 * share, pace, last ? "\n" : ""));
}

}  // namespace odis::app
