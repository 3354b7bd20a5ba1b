// Errors and warnings that speak to the user: file:line:column, what was expected, what to do.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <vector>

namespace odis::render {

// Where in an input file; line and column count from 1, 0 means unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;

  std::string text() const {
    std::string result = file;
    for (const int number : {line, column}) {
      if (number <= 0) break;
      result += ':';
      result += std::to_string(number);
    }
    return result;
  }
};

// Texts hold what files hold: control characters would break the line or command the terminal, and a name may
// be megabytes long.
std::string onOneLine(std::string text);

// Input that cannot be drawn. what() is "file:line:column: message".
class SceneError : public std::runtime_error {
 public:
  SceneError(const SourceLocation& at, const std::string& message)
      : std::runtime_error(onOneLine(at.file.empty() ? message : at.text() + ": " + message)) {}
};

// A size or crop that the caller asks for and no image of the scene can have.
class OptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What becomes of the picture where a scene isn't read as it is written.
enum class Effect {
  none,        // nothing: a hint to another program or to the method
  same,        // it is made in another way
  difference,  // it is another picture than the scene describes
};

// Input that can still be drawn. Kept in the order of the file, each text once.
class Warnings {
 public:
  void add(const SourceLocation& at, const std::string& message, Effect effect = Effect::difference) {
    keep(onOneLine(at.file.empty() ? message : at.text() + ": " + message), effect);
  }
  void add(const Warnings& others) {
    for (size_t effect = 0; effect < m_texts.size(); ++effect)
      for (const std::string& text : others.m_texts[effect]) keep(text, Effect(effect));
  }
  const std::vector<std::string>& texts(Effect effect = Effect::difference) const {
    return m_texts[size_t(effect)];
  }

 private:
  void keep(std::string text, Effect effect) {
    if (m_known.insert(text).second) m_texts[size_t(effect)].push_back(std::move(text));
  }

  std::array<std::vector<std::string>, 3> m_texts;  // by effect
  std::unordered_set<std::string> m_known;
};

}  // namespace odis::render
