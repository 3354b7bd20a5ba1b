// Writing a file so that its name shows either the old content or the new one, never a half.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "render/files/checked_stream.h"
#include "render/files/output_path.h"

namespace odis::render {

// Tells this machine from others that share a file system.
std::string hostName();

// Calls write(stream) for a temporary file beside `path` and renames that to `path`; removes it if anything
// fails. Symbolic links are followed, and the file keeps its permissions. What is there and no regular file,
// a pipe or a device, is written into. Throws WriteError with path and reason.
void replaceFile(const std::string& path, const std::function<void(CheckedStream&)>& write);
// The same of bytes.
void writeFile(const std::string& path, std::string_view bytes);

// Writes a file that is not there yet. False if it is there, also where another process was quicker; what is
// there is complete then. Throws WriteError.
bool writeNewFile(const std::string& path, std::string_view bytes);

// Makes a folder and those above it, where they aren't there yet. Throws WriteError with path and reason.
void makeFolder(const std::string& path);

// Throws WriteError, as far as can be told before anything is written, if replaceFile would.
OutputPath checkOutput(const std::string& path);

}  // namespace odis::render
