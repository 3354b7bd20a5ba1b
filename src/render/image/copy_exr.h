// Copies of EXR files in which some channels are others.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace odis::render {

// A channel that joins a part of a file, or takes the place of the one with its name there.
struct NewChannel {
  std::string name;
  std::vector<float> pixels;
  std::string like;  // the channel of the part whose type it has, 16 or 32 bits
};

// What differs between a file and its copy.
struct ExrChanges {
  size_t part = 0;  // that the channels are of
  std::vector<NewChannel> channels;
  std::vector<std::string> removed;             // names of channels
  std::map<std::string, std::string> metadata;  // text attributes of the first part
};

// Everything else stays: parts, channels with their types, attributes, compression. Of tiles with smaller
// versions of the image only the image itself. Throws std::runtime_error with path and reason where the file
// can't be read, WriteError where the copy can't be written.
void copyExr(const std::string& from, const std::string& to, const ExrChanges& changes);

}  // namespace odis::render
