// Integrators whose images are the library's frames: the library says what to trace, this traces it.
#pragma once

#include <odis/odis.hpp>

#include "render/integrators/frame_saver.h"
#include "render/integrators/integrator.h"

namespace odis::render {

class FrameIntegrator : public Integrator {
 public:
  FrameIntegrator(RenderJob& job, const FrameOptions& options)
      : m_job(job), m_film(job.newColorFilm()), m_saver(job, m_film.get()), m_frame(m_saver.begin(options)) {}

  void render() override;
  Pass passBefore(uint32_t pixel, uint32_t sample) override;
  void finish(RenderResult& result) override;

  // Traces the pilot, and nothing after it.
  void tracePilot();
  const odis::Frame& frame() const { return m_frame; }

 private:
  void trace(const FramePass& framePass);
  void showPicture();
  void addKept(bool interrupted);
  void run(const FramePass& framePass);
  Pass passOf(const FramePass& framePass);
  void beginStage(const FramePass& framePass);

  RenderJob& m_job;
  std::unique_ptr<SplatFilm> m_film;  // null unless it splats
  FrameSaver m_saver;
  odis::Frame m_frame;
  const char* m_stage = nullptr;  // that progress tells of
  bool m_guideIsNew = false;      // that the next pass has
};

// What a frame of the job's image is asked for, without the scene's lights.
FrameOptions frameOptions(const RenderJob& job);

}  // namespace odis::render
