// What OpenEXR takes on trust in a file's headers: it makes room for what they announce before it looks
// whether the file holds that much.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace odis::render {

// Throws std::runtime_error if a header announces attributes, tiles or scan lines that the file is too short
// for, or an image beyond our limits.
void checkExrHeaders(const std::vector<uint8_t>& file);

// Throws std::runtime_error for a channel that has fewer samples than pixels.
void requireFullResolution(const std::string& name, int xSampling, int ySampling);

}  // namespace odis::render
