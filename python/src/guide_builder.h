// GuideBuilder as Python has it.
#pragma once

#include <array>
#include <optional>

#include "calls.h"
#include "context.h"
#include "vertices.h"

namespace odis::python {

class Builder {
 public:
  Builder(const std::optional<GuideOptions>& given, const LoggingContext* context)
      : m_builder(interruptible(given), contextOrShared(context)) {}

  void add(const VerticesArgument& given) {
    const VertexArrays vertices = vertexArrays(given);
    callAlone(m_calls, [&] { m_builder.add(vertices.described()); });
  }
  Guide build(const VerticesArgument& given, const std::optional<Array>& pixelValues) {
    const VertexArrays vertices = vertexArrays(given);
    std::vector<float> values;
    if (pixelValues) {
      const Rows<float> rows(*pixelValues, "pixel_values");
      for (size_t i = 0; i < rows.size(); ++i) values.push_back(rows(i));
    }
    return callAlone(m_calls, [&] { return m_builder.build(vertices.described(), values); });
  }
  Guide rebuild(const Guide& previous) {
    return callAlone(m_calls, [&] { return m_builder.rebuild(previous); });
  }
  void fade(float weight) {
    callAlone(m_calls, [&] { m_builder.fade(weight); });
  }
  void forget() {
    callAlone(m_calls, [&] { m_builder.forget(); });
  }
  void setBounds(const std::array<float, 3>& lower, const std::array<float, 3>& upper) {
    callAlone(m_calls, [&] {
      m_builder.setBounds({lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]});
    });
  }
  VertexCounts vertexCounts() {
    return callAlone(m_calls, [&] { return m_builder.vertexCounts(); });
  }
  uint64_t bytes() {
    return callAlone(m_calls, [&] { return m_builder.bytes(); });
  }
  // For a frame that learns into it.
  const GuideBuilder& handle() const { return m_builder; }

 private:
  static GuideOptions interruptible(const std::optional<GuideOptions>& given) {
    GuideOptions options = given ? *given : GuideOptions();
    options.progressFunction = goOn;
    return options;
  }

  GuideBuilder m_builder;
  Calls m_calls;
};

}  // namespace odis::python
