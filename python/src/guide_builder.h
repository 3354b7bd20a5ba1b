// GuideBuilder as Python has it.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "calls.h"
#include "context.h"
#include "saved_bytes.h"
#include "vertices.h"

namespace odis::python {

class Builder {
 public:
  Builder(const std::optional<GuideOptions>& given, const LoggingContext* context)
      : m_builder(interruptible(given), contextOrShared(context)),
        m_model(given ? given->model : std::nullopt),
        m_context(contextOrShared(context)) {}

  static std::unique_ptr<Builder> load(const std::filesystem::path& path, const std::optional<Model>& model,
                                       const LoggingContext* context) {
    return std::unique_ptr<Builder>(new Builder(path.string(), model, contextOrShared(context)));
  }
  // For pickle: as bytes of a file, without the model.
  nb::bytes state() {
    const TemporaryFile file;
    save(file.path());
    return file.read();
  }
  static void setState(Builder& builder, const nb::bytes& bytes) {
    const TemporaryFile file;
    file.write(bytes);
    new (&builder) Builder(file.path(), std::nullopt, contextOrShared(nullptr));
  }
  // Another builder with the same content, model and context.
  std::unique_ptr<Builder> copy() {
    const TemporaryFile file;
    save(file.path());
    return std::unique_ptr<Builder>(new Builder(file.path(), m_model, m_context));
  }
  std::string text() {
    try {
      const uint64_t accepted = vertexCounts().accepted;
      return "<odis.GuideBuilder: " + std::to_string(accepted) +
             " vertices, bytes=" + std::to_string(bytes()) + ">";
    } catch (const Error& error) {
      return "<odis.GuideBuilder: " + std::string(error.what()) + ">";
    }
  }
  void save(const std::filesystem::path& path) {
    callAlone(m_calls, [&] { m_builder.save(path.string()); });
  }
  void setPartId(uint64_t id) {
    callAlone(m_calls, [&] { m_builder.setPartId(id); });
  }
  void merge(const std::vector<Builder*>& others) {
    std::vector<GuideBuilder> builders;
    std::vector<std::unique_ptr<Calls::Single>> calls;
    for (Builder* other : others) {
      if (!other) throw nb::type_error("expected builders, found None");
      if (other != this) calls.push_back(std::make_unique<Calls::Single>(other->m_calls));
      builders.push_back(other->m_builder);
    }
    callAlone(m_calls, [&] { m_builder.merge(builders); });
  }

  void add(const VerticesArgument& given, bool guided) {
    const VertexArrays vertices = vertexArrays(given);
    callAlone(m_calls, [&] {
      guided ? m_builder.addGuided(vertices.described()) : m_builder.add(vertices.described());
    });
  }
  Guide build(const std::optional<Array>& pixelValues) {
    std::vector<float> values;
    if (pixelValues) {
      const Rows<float> rows(*pixelValues, "pixel_values");
      for (size_t i = 0; i < rows.size(); ++i) values.push_back(rows(i));
    }
    return callAlone(m_calls, [&] { return m_builder.build(values); });
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
  Builder(const std::string& path, const std::optional<Model>& model, const Context& context)
      : m_builder(withoutLock([&] { return GuideBuilder::load(path, model, context); })),
        m_model(model),
        m_context(context) {}
  static GuideOptions interruptible(const std::optional<GuideOptions>& given) {
    GuideOptions options = given ? *given : GuideOptions();
    options.progressFunction = goOn;
    return options;
  }

  GuideBuilder m_builder;
  std::optional<Model> m_model;
  Context m_context;
  Calls m_calls;
};

}  // namespace odis::python
