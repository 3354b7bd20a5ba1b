// Walks over text: numbers, words and lines, without copies.
#pragma once

#include <charconv>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace odis::render {

class TextCursor {
 public:
  explicit TextCursor(std::string_view text, int line = 1)
      : m_at(text.data()), m_end(text.data() + text.size()), m_line(line) {}

  bool atEnd() const { return m_at == m_end; }
  int line() const { return m_line; }
  char peek() const { return m_at < m_end ? *m_at : '\0'; }
  void advance() { ++m_at; }
  const char* position() const { return m_at; }

  // Skips blanks within the line; a backslash at its end continues it.
  void skipBlanks() {
    for (; m_at < m_end; ++m_at) {
      if (*m_at == '\\' && m_end - m_at > 1 && (m_at[1] == '\n' || m_at[1] == '\r')) {
        if (*++m_at == '\r' && m_end - m_at > 1 && m_at[1] == '\n') ++m_at;
        ++m_line;
      } else if (*m_at != ' ' && *m_at != '\t' && *m_at != '\r') {
        break;
      }
    }
  }
  void skipSpace() {
    for (skipBlanks(); peek() == '\n'; skipBlanks()) nextLine();
  }
  bool atLineEnd() {
    skipBlanks();
    return m_at == m_end || *m_at == '\n';
  }
  void nextLine() {
    while (m_at < m_end && *m_at != '\n') ++m_at;
    if (m_at < m_end) ++m_at, ++m_line;
  }
  // The rest of the line without its end, and on to the next.
  std::string_view takeLine() {
    const char* begin = m_at;
    nextLine();
    const char* end = m_at;
    while (end > begin && (end[-1] == '\n' || end[-1] == '\r')) --end;
    return {begin, size_t(end - begin)};
  }
  // The next word on the line; empty at its end.
  std::string_view word() {
    skipBlanks();
    const char* begin = m_at;
    while (m_at < m_end && *m_at != ' ' && *m_at != '\t' && *m_at != '\n' && *m_at != '\r') ++m_at;
    return {begin, size_t(m_at - begin)};
  }
  // What stands here, for messages; does not move.
  std::string found() const {
    constexpr size_t kLongest = 40;
    TextCursor ahead = *this;
    const std::string_view text = ahead.word();
    if (text.empty()) return ahead.atEnd() ? "the end of the file" : "the end of the line";
    return "\"" + std::string(text.substr(0, kLongest)) + (text.size() > kLongest ? "..." : "") + "\"";
  }
  // Reads a number here; false if there is none. What is too small for T is zero, what is too large infinite.
  template <class T>
  bool number(T& value) {
    if (peek() == '+') ++m_at;
    const auto [end, error] = std::from_chars(m_at, m_end, value);
    if (error == std::errc::invalid_argument) return false;
    if (error == std::errc::result_out_of_range && !outOfRange(end, value)) return false;
    m_at = end;
    return true;
  }

 private:
  template <class T>
  bool outOfRange(const char* end, T& value) const {
    if constexpr (std::is_integral_v<T>) {
      return false;
    } else {
      // from_chars does not say whether the number is too large or too small, but its exponent does.
      const std::string_view text(m_at, size_t(end - m_at));
      const size_t exponent = text.find_first_of("eE");
      const bool tiny = exponent != text.npos ? text.substr(exponent + 1, 1) == "-" : text.find("0.") <= 1;
      value = tiny ? T(0) : std::numeric_limits<T>::infinity();
      return true;
    }
  }

  const char* m_at;
  const char* m_end;
  int m_line;
};

}  // namespace odis::render
