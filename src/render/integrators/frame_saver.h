// Keeps a rendering that may be killed: from time to time its frame goes to a file, together with what the
// renderer sums up besides.
#pragma once

#include <odis/odis.hpp>

#include <atomic>
#include <chrono>

#include "render/integrators/job.h"

namespace odis::render {

class FrameSaver {
 public:
  // `film` is that of the colours, null unless it splats.
  FrameSaver(RenderJob& job, SplatFilm* film) : m_job(job), m_film(film), m_options(job.options().saving) {}

  // The job's frame: a new one, or the one of the file that the rendering goes on with. Throws OptionError
  // if that is of another rendering, odis::Error if it is no saved frame.
  odis::Frame begin(const FrameOptions& options);

  // Tells that there is more to save than before. Thread-safe.
  void noteNews() { m_news = true; }
  // Whether it is time to save. Thread-safe while nothing is saved.
  bool isDue() const;
  // Saves if a file is asked for and there is news; nothing of the job's may be under way. A file that can't
  // be written is told as a warning.
  void save(odis::Frame& frame);

 private:
  using Clock = std::chrono::steady_clock;

  RenderJob& m_job;
  SplatFilm* m_film;
  const SavingOptions& m_options;
  std::atomic<bool> m_news{false};
  Clock::time_point m_last = Clock::now();
};

}  // namespace odis::render
