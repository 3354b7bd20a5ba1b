#include "odis/weights/weights.h"

#include <cstring>
#include <filesystem>
#include <fstream>

#include "odis/files/crc32.h"
#include "odis/files/regular_file.h"

namespace odis::core {

// In a source that the build makes of weights/odis.weights.
std::string_view builtInWeights();

namespace {

constexpr std::string_view kMagic = "ODISNETW";
constexpr uint32_t kFormat = 1;
constexpr size_t kMostDimensions = 4;
constexpr uint64_t kMostElements = 1u << 24;
constexpr uintmax_t kMostBytes = 1u << 28;  // of a file; those of today have 10 kB

void put(std::string& bytes, uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes.push_back(char(uint8_t(value >> (8 * i))));
}

uint32_t wordAt(std::string_view bytes, size_t at) {
  uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value |= uint32_t(uint8_t(bytes[at + size_t(i)])) << (8 * i);
  return value;
}

std::string shapeText(const std::vector<uint32_t>& shape) {
  std::string text = "(";
  for (size_t i = 0; i < shape.size(); ++i) text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
  return text + ")";
}

// Reads from the front of what is left, never beyond its end.
class Reader {
 public:
  Reader(const std::string& path, std::string_view bytes) : m_path(path), m_bytes(bytes) {}
  uint32_t word() { return wordAt(take(4), 0); }
  std::string_view take(size_t count) {
    if (count > m_bytes.size() - m_at) fail("is cut off");
    m_at += count;
    return m_bytes.substr(m_at - count, count);
  }
  bool atEnd() const { return m_at == m_bytes.size(); }
  [[noreturn]] void fail(const std::string& why) const { throw WeightsError(m_path + ": " + why); }

 private:
  const std::string& m_path;
  std::string_view m_bytes;
  size_t m_at = 0;
};

Tensor readTensor(Reader& reader) {
  Tensor tensor;
  tensor.name = reader.take(reader.word());
  const uint32_t dimensions = reader.word();
  if (dimensions > kMostDimensions)
    reader.fail("tensor " + tensor.name + " has " + std::to_string(dimensions) +
                " dimensions, expected at most " + std::to_string(kMostDimensions));
  uint64_t elements = 1;
  for (uint32_t i = 0; i < dimensions; ++i) {
    tensor.shape.push_back(reader.word());
    elements *= tensor.shape.back();
    if (elements > kMostElements) reader.fail("tensor " + tensor.name + " is too large");
  }
  const std::string_view bytes = reader.take(4 * elements);
  tensor.values.resize(elements);
  for (size_t i = 0; i < elements; ++i) {
    const uint32_t word = wordAt(bytes, 4 * i);
    std::memcpy(&tensor.values[i], &word, 4);
  }
  return tensor;
}

}  // namespace

Weights Weights::parse(const std::string& path, std::string_view bytes) {
  if (bytes.size() < kMagic.size() + 4 || bytes.substr(0, kMagic.size()) != kMagic)
    throw WeightsError(path + ": is no file of weights, expected it to begin with ODISNETW");
  const std::string_view body = bytes.substr(0, bytes.size() - 4);
  Reader reader(path, body);
  reader.take(kMagic.size());
  if (const uint32_t format = reader.word(); format != kFormat)
    reader.fail("found format " + std::to_string(format) + ", expected " + std::to_string(kFormat));
  if (crc32(body) != wordAt(bytes, body.size())) reader.fail("is damaged or cut off");
  if (const uint32_t version = reader.word(); version != kFeatureVersion)
    reader.fail("was trained on features of version " + std::to_string(version) + ", expected " +
                std::to_string(kFeatureVersion));
  Weights weights;
  weights.m_path = path;
  weights.m_about = reader.take(reader.word());
  const uint32_t count = reader.word();
  for (uint32_t i = 0; i < count; ++i) weights.m_tensors.push_back(readTensor(reader));
  if (!reader.atEnd()) reader.fail("has bytes after its last tensor");
  return weights;
}

Weights Weights::load(const std::string& path) {
  if (const std::string why = whyUnreadable(path); !why.empty()) throw WeightsError(path + why);
  std::error_code error;
  std::ifstream stream(path, std::ios::binary);
  const uintmax_t size = stream ? std::filesystem::file_size(path, error) : 0;
  if (size > kMostBytes)
    throw WeightsError(path + ": has " + std::to_string(size) + " bytes, expected at most " +
                       std::to_string(kMostBytes));
  std::string bytes(size, '\0');
  if (!stream.read(bytes.data(), std::streamsize(size))) throw WeightsError(path + ": cannot be read");
  return parse(path, bytes);
}

const Weights& Weights::builtIn() {
  static const Weights weights = parse("built-in weights", builtInWeights());
  return weights;
}

std::string Weights::bytes() const {
  std::string result(kMagic);
  put(result, kFormat);
  put(result, kFeatureVersion);
  const auto putText = [&](const std::string& text) {
    put(result, uint32_t(text.size()));
    result += text;
  };
  putText(m_about);
  put(result, uint32_t(m_tensors.size()));
  for (const Tensor& tensor : m_tensors) {
    putText(tensor.name);
    put(result, uint32_t(tensor.shape.size()));
    for (const uint32_t size : tensor.shape) put(result, size);
    for (const float value : tensor.values) {
      uint32_t word;
      std::memcpy(&word, &value, 4);
      put(result, word);
    }
  }
  put(result, crc32(result));
  return result;
}

const Tensor* Weights::find(std::string_view name) const {
  for (const Tensor& tensor : m_tensors)
    if (tensor.name == name) return &tensor;
  return nullptr;
}

const Tensor& Weights::need(std::string_view name) const {
  const Tensor* tensor = find(name);
  if (!tensor) throw WeightsError(m_path + ": has no tensor " + std::string(name));
  return *tensor;
}

const std::vector<float>& Weights::get(std::string_view name, const std::vector<uint32_t>& shape) const {
  const Tensor& tensor = need(name);
  if (tensor.shape != shape)
    throw WeightsError(m_path + ": tensor " + tensor.name + " has the shape " + shapeText(tensor.shape) +
                       ", expected " + shapeText(shape));
  return tensor.values;
}

uint32_t Weights::rows(std::string_view name, size_t dimensions) const {
  const Tensor& tensor = need(name);
  if (tensor.shape.size() != dimensions || tensor.shape[0] == 0)
    throw WeightsError(m_path + ": tensor " + tensor.name + " has the shape " + shapeText(tensor.shape) +
                       ", expected " + std::to_string(dimensions) + " dimensions");
  return tensor.shape[0];
}

}  // namespace odis::core
