// A guide that grows with what a host's paths bring.
#pragma once

#include <odis/odis.hpp>

#include <optional>

#include "openpgl/openpgl.h"
#include "samples.h"
#include "unguided.h"

// The type behind Open PGL's handle. Distributions may look up while nobody updates.
struct Field {
 public:
  void update(SampleStorage& samples);
  void reset();
  void save(const char* file) const;
  void load(const char* file);

  // Without cells where nothing was learned yet.
  const odis::GuideView& view() const { return m_view; }
  // Whether a host is given directions at a place.
  bool guidesAt(const odis::Float3& position, bool inVolume) const {
    return m_gains && m_view.cellCount > 0 && !m_unguided.contains(position, inVolume);
  }
  size_t iteration() const;
  std::string statistics() const;

  pgl_box3f bounds{{-1e30f, -1e30f, -1e30f}, {1e30f, 1e30f, 1e30f}};

 private:
  void show(odis::Guide guide);
  // Finds out by unguided vertices whether and where a host is given directions.
  void judge(odis::ArrayView<const odis::PathVertex> vertices);

  std::optional<odis::GuideBuilder> m_builder;
  std::optional<odis::Guide> m_guide;
  odis::GuideView m_view;
  bool m_gains = true;  // whether guiding is worth it at all
  odis::openpgl_interface::UnguidedPlaces m_unguided;
  size_t m_updates = 0;
  size_t m_vertices = 0, m_firstVertices = 0, m_builtFrom = 0;
};
