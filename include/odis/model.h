// What turns the statistics of cells into decisions: networks that were trained offline, or formulas.
#pragma once

#include <memory>
#include <string>

namespace odis {

// Copies share what they hold. Thread-safe.
class Model {
 public:
  // The networks that come with the library.
  Model() : Model(builtIn()) {}
  static Model builtIn();
  // Formulas alone.
  static Model formulas();
  // The networks of a file of weights. Throws std::runtime_error, which names the file and what is wrong
  // with it.
  static Model load(const std::string& path);

  // This model with a formula for directions, or for the choice of lights.
  Model withDirectionFormula() const;
  Model withLightFormula() const;

  // The inside, for the library itself (src/odis/models/model_parts.h).
  struct Parts;
  explicit Model(std::shared_ptr<const Parts> parts) : m_parts(std::move(parts)) {}
  const Parts& parts() const { return *m_parts; }

 private:
  std::shared_ptr<const Parts> m_parts;
};

}  // namespace odis
