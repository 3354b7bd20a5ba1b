// What a comparison still has to render, and how long that will take.
#pragma once

#include <map>
#include <string>

#include "eval/compare.h"

namespace odis::eval {

class Schedule {
 public:
  // A rendering that is to be done: so many samples per pixel.
  void plan(const std::string& scene, const std::string& method, double samples);
  // It is done, in so many seconds; 0: found, nothing to learn from.
  void finish(const std::string& scene, const std::string& method, double samples, double seconds);
  // A sample per pixel of the scene took so many seconds, by whatever method.
  void learn(const std::string& scene, double seconds);
  bool isPending(const std::string& scene) const;
  Outlook outlook() const;

 private:
  struct Work {
    double samples = 0, seconds = 0;
  };
  std::map<std::pair<std::string, std::string>, double> m_pending;  // samples of scene and method
  // What was measured: of scene and method, of a scene ("scene", ""), of a method, of all.
  std::map<std::pair<std::string, std::string>, Work> m_measured;
  int m_done = 0, m_total = 0;
};

}  // namespace odis::eval
