// A guide that grows with what a host's paths bring.
#pragma once

#include <odis/odis.hpp>

#include <optional>

#include "openpgl/openpgl.h"
#include "samples.h"

// The type behind Open PGL's handle. Distributions may look up while nobody updates.
struct Field {
 public:
  void update(SampleStorage& samples);
  void reset();
  void save(const char* file) const;
  void load(const char* file);

  // Without cells where nothing was learned yet.
  const odis::GuideView& view() const { return m_view; }
  size_t iteration() const;
  std::string statistics() const;

  pgl_box3f bounds{{-1e30f, -1e30f, -1e30f}, {1e30f, 1e30f, 1e30f}};

 private:
  void show(odis::Guide guide);

  std::optional<odis::GuideBuilder> m_builder;
  std::optional<odis::Guide> m_guide;
  odis::GuideView m_view;
  size_t m_updates = 0;
  size_t m_vertices = 0, m_firstVertices = 0, m_builtFrom = 0;
};
