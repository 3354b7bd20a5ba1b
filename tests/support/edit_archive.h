// Saved files with other arrays than this version of ODIS writes.
#pragma once

#include <cstring>
#include <functional>
#include <sstream>
#include <string>

#include "odis/files/archive.h"
#include "odis/files/crc32.h"

namespace odis::test {

inline std::string bytesOf(const core::ArchiveWriter& file) {
  std::ostringstream stream;
  file.write(stream);
  return stream.str();
}

// The file without the arrays whose names `drops` chooses, and with one more that nobody knows.
inline std::string withOtherArrays(const std::string& saved,
                                   const std::function<bool(const std::string&)>& drops) {
  size_t at = core::kArchiveMagic.size() + sizeof(uint32_t);
  const auto read = [&]<class Integer>(Integer value) {
    std::memcpy(&value, &saved[at], sizeof value);
    at += sizeof value;
    return value;
  };
  const auto readText = [&] {
    const uint32_t length = read(uint32_t());
    at += length;
    return saved.substr(at - length, length);
  };
  readText();
  const size_t countAt = at;
  std::string kept = saved.substr(0, at), arrays;
  uint32_t count = 0;
  for (uint32_t left = read(uint32_t()); left > 0; --left) {
    const size_t begin = at;
    const std::string name = readText();
    const uint32_t bytes = read(uint32_t());
    at += read(uint64_t()) * bytes;
    if (drops(name)) continue;
    arrays += saved.substr(begin, at - begin);
    ++count;
  }
  const auto append = [](std::string& text, const auto& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const std::string name = "guide.decisions.ofTomorrow";
  append(arrays, uint32_t(name.size()));
  arrays += name;
  append(arrays, uint32_t(1));
  append(arrays, uint64_t(3));
  arrays += "abc";
  kept.resize(countAt);
  append(kept, count + 1);
  kept += arrays;
  append(kept, core::crc32(kept));
  return kept;
}

}  // namespace odis::test
