#include "viewer.h"

#include <algorithm>
#include <utility>

#include "console.h"

namespace odis::app {

using namespace std::chrono_literals;

static constexpr auto kFirst = 100ms;
static constexpr auto kMostBetween = 2s;

Viewer::Viewer(const render::TevAddress& address, std::string name)
    : m_address(address), m_name(std::move(name)), m_due(m_start + kFirst) {
  m_sender = std::thread([this] { send(); });
}

Viewer::~Viewer() {
  {
    const std::lock_guard lock(m_mutex);
    m_ending = true;
  }
  m_changed.notify_one();
  m_sender.join();
}

bool Viewer::isDue() const {
  return !m_failed && Clock::now() >= m_due.load(std::memory_order_relaxed);
}

void Viewer::show(int width, int height, std::vector<render::Rgb> colors) {
  {
    const std::lock_guard lock(m_mutex);
    m_waiting = Picture{width, height, std::move(colors)};
  }
  m_changed.notify_one();
  const Clock::time_point now = Clock::now();
  m_due = now + std::min<Clock::duration>((now - m_start) / 2, kMostBetween);
}

// The next picture; none when all is sent.
std::optional<Viewer::Picture> Viewer::nextPicture() {
  std::unique_lock lock(m_mutex);
  m_changed.wait(lock, [this] { return m_waiting || m_ending; });
  return std::exchange(m_waiting, std::nullopt);
}

void Viewer::send() {
  try {
    render::TevClient tev(m_address);
    while (const std::optional<Picture> picture = nextPicture())
      tev.send(m_name, picture->width, picture->height, picture->colors.data());
  } catch (const std::exception& error) {  // the image is written all the same
    m_failed = true;
    sayWarning(error.what());
  }
}

}  // namespace odis::app
