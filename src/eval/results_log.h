// The results of a comparison as JSON lines, so that one that was interrupted goes on where it stopped.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "eval/measurement.h"

namespace odis::eval {

// Every figure of a rendering; infinity becomes null.
nlohmann::ordered_json measurementJson(const Measurement& measurement);

class ResultsLog {
 public:
  // Reads the file if it exists; `fresh` removes it. A line that was cut off is ignored.
  ResultsLog(std::string path, bool fresh);
  const Measurement* find(const std::string& key) const;
  // Throws std::runtime_error if the file can't be written.
  void add(const Measurement& measurement);

 private:
  std::string m_path;
  std::map<std::string, Measurement> m_byKey;
};

}  // namespace odis::eval
