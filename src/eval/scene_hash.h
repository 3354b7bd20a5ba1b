// A number that changes when a scene does.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace odis::eval {

// 64-bit FNV-1a, continued from `hash`.
inline constexpr uint64_t kFnvBasis = 0xcbf29ce484222325u;
uint64_t hashBytes(const void* data, size_t size, uint64_t hash = kFnvBasis);
uint64_t hashText(const std::string& text, uint64_t hash = kFnvBasis);
std::string hexText(uint64_t hash);

// Hashes the scene file, all files that its attributes name (meshes, textures, included scenes) and the
// defines. Files that can't be read are left out: it is the loader that complains about them.
uint64_t hashScene(const std::string& path, const std::map<std::string, std::string>& defines);

}  // namespace odis::eval
