// What the generator may use besides its own: environment maps, textures and furniture of the user's.
#pragma once

#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/math/vec.h"

namespace odis::learn {

// A folder that can't be used.
class AssetError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A model, and what its folder's catalog.tsv says of it: sizes in metres, 0 where nothing is known.
struct FurnitureModel {
  std::string path, name, category, credit;
  float width = 0, depth = 0, height = 0, elevation = 0;
};

// Lists of files, found recursively and sorted by name, so that they depend on nothing else than the folder's
// content. What is read is kept small and in memory. Thread-safe.
class Assets {
 public:
  Assets() = default;
  // Folders; "" for none. Throws AssetError if a folder is missing or holds nothing of use.
  Assets(const std::string& hdri, const std::string& textures, const std::string& furniture);

  const std::vector<std::string>& hdris() const { return m_hdris; }
  const std::vector<std::string>& textures() const { return m_textures; }
  const std::vector<FurnitureModel>& furniture() const { return m_furniture; }
  // Tells sets of files apart: a hash of names and sizes, "" for none.
  const std::string& fingerprint() const { return m_fingerprint; }

  // A texture as the bytes of a PNG, an environment as those of an EXR, both made smaller if they are large.
  std::string texture(const std::string& path) const;
  std::string environment(const std::string& path) const;
  // Whether a texture is of a stronger colour than walls and floors are.
  bool isVivid(const std::string& path) const;

 private:
  std::string cached(const std::string& path, std::string (*read)(const std::string&)) const;

  std::vector<std::string> m_hdris, m_textures;
  std::vector<FurnitureModel> m_furniture;
  std::string m_fingerprint;
  mutable std::map<std::string, std::string> m_cache;
  mutable std::map<std::string, bool> m_vivid;
  mutable std::mutex m_mutex;
};

}  // namespace odis::learn
