// Pictures of an image on their way to the viewer tev, while it is rendered.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "render/image/tev.h"

namespace odis::app {

// Sends pictures from a thread of its own, so that rendering never waits for tev: of those that wait to be
// sent only the newest is kept. Where tev can't be reached or is gone, a warning says so once, and no more
// pictures are asked for.
class Viewer {
 public:
  // `name` is the image's in tev. The clock starts now.
  Viewer(const render::TevAddress& address, std::string name);
  // Waits until the last picture is sent.
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  // Whether it is time for a picture: a tenth of a second after the start, and then whenever half as much
  // time again has passed, but every two seconds at least. Thread-safe.
  bool isDue() const;
  // Linear colours, width * height of them, row 0 at the top.
  void show(int width, int height, std::vector<render::Rgb> colors);

 private:
  using Clock = std::chrono::steady_clock;
  struct Picture {
    int width, height;
    std::vector<render::Rgb> colors;
  };
  void send();
  std::optional<Picture> nextPicture();

  const render::TevAddress m_address;
  const std::string m_name;
  const Clock::time_point m_start = Clock::now();
  std::atomic<Clock::time_point> m_due;
  std::atomic<bool> m_failed{false};
  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::optional<Picture> m_waiting;
  bool m_ending = false;
  std::thread m_sender;
};

}  // namespace odis::app
