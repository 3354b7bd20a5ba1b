// What a file of a test holds, described in JSON: text, or pieces that follow each other. The pieces are
// listed in tests/app/bad_inputs/README.md.
#pragma once

#include <zlib.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace odis::test {

inline std::string bytesOfHex(const std::string& hex) {
  std::string bytes, digits;
  for (const char c : hex) {
    if (c == ' ') continue;
    digits += c;
    if (digits.size() < 2) continue;
    bytes += char(std::stoi(digits, nullptr, 16));
    digits.clear();
  }
  return bytes;
}

// Numbers as they lie in memory, which is little-endian wherever the renderer is built.
template <class T>
std::string bytesOfNumbers(const nlohmann::json& numbers) {
  std::string bytes;
  for (const nlohmann::json& number : numbers) {
    const T value = number.get<T>();
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return bytes;
}

inline void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

inline std::string repeated(const std::string& text, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) {
    std::string one = text;
    replaceAll(one, "{i}", std::to_string(i));
    replaceAll(one, "{i+1}", std::to_string(i + 1));
    result += one;
  }
  return result;
}

inline std::string deflated(const std::string& bytes) {
  std::string result(compressBound(bytes.size()), '\0');
  uLongf size = result.size();
  const auto* source = reinterpret_cast<const Bytef*>(bytes.data());
  if (compress(reinterpret_cast<Bytef*>(result.data()), &size, source, bytes.size()) != Z_OK)
    throw std::runtime_error("zlib can't compress");
  result.resize(size);
  return result;
}

inline std::string startOfFile(const std::string& path, size_t count) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + path);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  return bytes.substr(0, count);
}

inline std::string contentOf(const nlohmann::json& content) {
  if (content.is_string()) return content.get<std::string>();
  if (content.is_array()) {
    std::string bytes;
    for (const nlohmann::json& piece : content) bytes += contentOf(piece);
    return bytes;
  }
  if (content.contains("hex")) return bytesOfHex(content.at("hex"));
  if (content.contains("u16")) return bytesOfNumbers<uint16_t>(content.at("u16"));
  if (content.contains("u32")) return bytesOfNumbers<uint32_t>(content.at("u32"));
  if (content.contains("u64")) return bytesOfNumbers<uint64_t>(content.at("u64"));
  if (content.contains("f32")) return bytesOfNumbers<float>(content.at("f32"));
  if (content.contains("repeat")) return repeated(content.at("repeat"), content.at("count"));
  if (content.contains("deflate")) return deflated(contentOf(content.at("deflate")));
  if (content.contains("copy"))
    return startOfFile(ODIS_SOURCE "/" + content.at("copy").get<std::string>(), content.at("bytes"));
  throw std::runtime_error("unknown content of a file: " + content.dump());
}

}  // namespace odis::test
