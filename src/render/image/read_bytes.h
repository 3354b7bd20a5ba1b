// A whole image file in memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace odis::render {

// Throws ReadError if it is no regular file, empty, larger than 2 GiB or can't be read.
std::vector<uint8_t> readImageBytes(const std::string& path);

}  // namespace odis::render
