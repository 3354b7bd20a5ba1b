// The file that holds what was learned: named tensors, and a text that says where they come from.
//
//   bytes  0-7    ODISNETW
//          8-11   format, 1
//          12-15  version of the features that the networks were trained on (src/odis/models)
//          16-19  length M of the text in bytes; then the text, JSON in UTF-8
//          then   number of tensors; for each: length of its name, the name, number of dimensions (at most
//                 4), the dimensions, and its elements, 32-bit floats, the last index fastest
//          last 4 CRC-32 of all before
// All numbers are little-endian and, but for the elements, unsigned integers of 32 bits.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace odis::core {

// Version of the features (src/odis/models). It counts up whenever a feature changes
// its meaning: weights that were made for other features are refused.
inline constexpr uint32_t kFeatureVersion = 3;

// What is no file of weights, a damaged one, or one for other networks than these. Names the file.
class WeightsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Tensor {
  std::string name;
  std::vector<uint32_t> shape;
  std::vector<float> values;
};

class Weights {
 public:
  Weights() = default;
  Weights(std::string about, std::vector<Tensor> tensors)
      : m_about(std::move(about)), m_tensors(std::move(tensors)) {}

  // Of a file in memory; `path` is what errors name. Throws WeightsError.
  static Weights parse(const std::string& path, std::string_view bytes);
  // Throws WeightsError.
  static Weights load(const std::string& path);
  // The weights that come with the library.
  static const Weights& builtIn();

  std::string bytes() const;

  // JSON: architecture, training, data.
  const std::string& about() const { return m_about; }
  const std::vector<Tensor>& tensors() const { return m_tensors; }
  bool contains(std::string_view name) const { return find(name) != nullptr; }
  // The values of a tensor that must have this shape. Throws WeightsError.
  const std::vector<float>& get(std::string_view name, const std::vector<uint32_t>& shape) const;
  // The first dimension of a tensor that must have so many. Throws WeightsError.
  uint32_t rows(std::string_view name, size_t dimensions) const;

 private:
  const Tensor* find(std::string_view name) const;
  const Tensor& need(std::string_view name) const;

  std::string m_path = "weights", m_about;
  std::vector<Tensor> m_tensors;
};

}  // namespace odis::core
