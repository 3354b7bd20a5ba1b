// Messages and progress on the terminal, and Ctrl-C.
#pragma once

#include <signal.h>

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <string>

#include "render/integrators/render.h"
#include "viewer.h"

namespace odis::app {

// Prints to stderr. Where that can't be printed to (a full disk, a terminal that is gone) work goes on in
// silence.
void say(const std::string& text);
// Says so on a line of its own, even where a bar shows progress.
void sayWarning(const std::string& message);
// Whether stderr is a terminal, where progress is one line that changes.
bool onTerminal();

// How fast work goes: "0.17 Msamples/s, 3.2 s left", or how long it took if it is over. Of all that is done,
// `before` was done by an earlier run.
struct Work {
  uint64_t total = 0, done = 0, before = 0;
  double seconds = 0;
};
std::string paceText(const Work& work, const std::string& unit, bool isOver);

// When the next line of progress may be written where lines stay, as in a log.
class LinePace {
 public:
  explicit LinePace(std::chrono::seconds interval = std::chrono::seconds(10)) : m_interval(interval) {}
  // Whether so much time has passed since the last line, or since the beginning; then one counts as written.
  bool isDue();

 private:
  std::chrono::seconds m_interval;
  std::chrono::steady_clock::time_point m_last = std::chrono::steady_clock::now();
};

// While one lives, the first Ctrl-C (SIGINT) or SIGTERM only sets a flag; the second ends the program at
// once. A signal that is ignored when the program begins, as `trap '' INT` in a shell asks for, stays
// ignored.
class InterruptScope {
 public:
  InterruptScope();
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;
  static bool interrupted();
  // kOk, or how a program ends that was interrupted.
  static int exitCode();

 private:
  static constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
  std::array<struct sigaction, kSignals.size()> m_before;
};

// A bar with rate and time left if stderr is a terminal, otherwise a line every ten seconds.
class ConsoleProgress : public render::Progress {
 public:
  explicit ConsoleProgress(bool quiet);
  void begin(const std::string& stage, uint64_t total, uint64_t done, const char* unit) override;
  void changeTotal(uint64_t total) override { m_total = total; }
  void advance(uint64_t more) override;
  void end() override;
  void warn(const std::string& message) override;
  bool cancelled() const override { return InterruptScope::interrupted(); }
  // Pictures are shown there from now on. It must outlive this.
  void setViewer(Viewer& viewer) { m_viewer = &viewer; }
  bool wantsPicture() const override { return m_viewer && m_viewer->isDue(); }
  void showPicture(int width, int height, std::vector<render::Rgb> colors) override {
    m_viewer->show(width, height, std::move(colors));
  }
  // Printed in front of the stage, on lines of its own if that is how progress is shown.
  void setTitle(const std::string& title) { m_title = title; }

 private:
  void show(uint64_t done, bool last);

  bool m_quiet, m_terminal;
  Viewer* m_viewer = nullptr;
  std::string m_title, m_stage, m_unit;
  uint64_t m_total = 0, m_before = 0;  // of the stage, and what of it an earlier run did
  std::atomic<uint64_t> m_done{0}, m_nextShow{0};
  std::chrono::steady_clock::time_point m_start, m_lastShow;
  LinePace m_pace;                   // of all stages
  std::set<std::string> m_warnings;  // said once each, however often something is rendered
  std::mutex m_mutex;
};

}  // namespace odis::app
