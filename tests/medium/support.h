// Volumes as files, and volumes, phase functions and textures from the text of an element.
#pragma once

#include <half.h>

#include <array>
#include <cstring>
#include <functional>
#include <string>

#include "render/scene/builder.h"
#include "scene/scene_text.h"

namespace odis::test {

// The value of a channel at (x, y, z), as in the numbers of Mitsuba that tests hold.
inline float patternAt(int x, int y, int z, int channel) {
  return float((x * 7 + y * 5 + z * 3 + channel * 2) % 11) / 4;
}

struct VolumeText {
  std::array<int32_t, 3> size{4, 3, 2};
  int32_t channels = 1;
  int32_t type = 1;  // 1: float32, 2: float16, 3: uint8
  std::array<float, 6> box{0, 0, 0, 1, 1, 1};
  std::function<float(int x, int y, int z, int channel)> value = patternAt;

  // The bytes of the file.
  std::string text() const {
    std::string bytes = "VOL\3";
    append(bytes, type);
    for (const int32_t n : size) append(bytes, n);
    append(bytes, channels);
    for (const float x : box) append(bytes, x);
    for (int z = 0; z < size[2]; ++z)
      for (int y = 0; y < size[1]; ++y)
        for (int x = 0; x < size[0]; ++x)
          for (int channel = 0; channel < channels; ++channel) {
            const float number = value(x, y, z, channel);
            if (type == 1) append(bytes, number);
            if (type == 2) append(bytes, half(number).bits());
            if (type == 3) append(bytes, uint8_t(std::lround(number * 255)));
          }
    return bytes;
  }

 private:
  template <class T>
  static void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
};

// What the first element of a scene is made into, and what was said about it.
class MediumParts {
 public:
  std::string write(const VolumeText& volume, const std::string& name = "grid.vol") const {
    return m_folder.write(name, volume.text());
  }
  void write(const std::string& name, const std::string& bytes) const { m_folder.write(name, bytes); }

  render::VolumePtr volume(const std::string& element, const std::string& version = "3.0.0") {
    return m_builder.volume(parsed(element, version));
  }
  render::PhaseFunctionPtr phase(const std::string& element) {
    return m_builder.phaseFunction(parsed(element));
  }
  render::TexturePtr texture(const std::string& element) { return m_builder.texture(parsed(element)); }
  // A grid of the file "grid.vol" with further parameters.
  render::VolumePtr grid(const std::string& parameters = "", const std::string& version = "3.0.0") {
    return volume(
        "<volume type='gridvolume'><string name='filename' value='grid.vol'/>" + parameters + "</volume>",
        version);
  }
  const Properties& parsed(const std::string& element, const std::string& version = "3.0.0") {
    m_roots.push_back(render::parseSceneText("<scene version='" + version + "'>" + element + "</scene>",
                                             m_folder.write("scene.xml", ""), {}, m_warnings)
                          .root);
    return *m_roots.back()->children[0].node;
  }
  bool warnsOf(const std::string& words) const {
    for (const std::string& text : m_warnings.texts())
      if (text.find(words) != std::string::npos) return true;
    return false;
  }
  bool isQuiet() const { return m_warnings.texts().empty(); }
  render::Builder& builder() { return m_builder; }

 private:
  TemporaryFolder m_folder;
  render::Warnings m_warnings;
  std::vector<std::shared_ptr<const Properties>> m_roots;
  render::Builder m_builder{m_warnings};
};

// What an error says; "" if there is none.
template <class Action>
std::string complaintOf(Action&& action) {
  try {
    action();
  } catch (const render::SceneError& error) {
    return error.what();
  }
  return "";
}

}  // namespace odis::test
