#include "eval/schedule.h"

#include <algorithm>

namespace odis::eval {

void Schedule::plan(const std::string& scene, const std::string& method, double samples) {
  m_pending[{scene, method}] += samples;
  ++m_total;
}

void Schedule::finish(const std::string& scene, const std::string& method, double samples, double seconds) {
  double& pending = m_pending[{scene, method}];
  pending = std::max(0.0, pending - samples);
  ++m_done;
  if (!(seconds > 0)) return;
  const std::string any;
  for (const auto& [s, m] : {std::pair(scene, method), {scene, any}, {any, method}, {any, any}}) {
    Work& work = m_measured[{s, m}];
    work.samples += samples;
    work.seconds += seconds;
  }
}

void Schedule::learn(const std::string& scene, double seconds) {
  for (const std::string& known : {scene, std::string()}) {
    Work& work = m_measured[{known, ""}];
    work.samples += 1;
    work.seconds += seconds;
  }
}

bool Schedule::isPending(const std::string& scene) const {
  for (const auto& [job, samples] : m_pending)
    if (job.first == scene && samples > 0) return true;
  return false;
}

Outlook Schedule::outlook() const {
  Outlook outlook{m_done, m_total, 0};
  for (const auto& [job, samples] : m_pending) {
    if (samples == 0) continue;
    // The nearest kind of work of which something was measured tells the time of a sample.
    const std::string any;
    for (const auto& kind : {job, {job.first, any}, {any, job.second}, {any, any}}) {
      const auto found = m_measured.find(kind);
      if (found == m_measured.end()) continue;
      outlook.secondsLeft += samples * found->second.seconds / found->second.samples;
      break;
    }
  }
  return outlook;
}

}  // namespace odis::eval
