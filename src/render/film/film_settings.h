// The film: its size, the part of it that is rendered, and how samples become pixels.
#pragma once

#include <memory>

#include "render/film/filter.h"

namespace odis::render {

// A rectangle of pixels of the full image.
struct Crop {
  int x = 0, y = 0, width = 0, height = 0;

  size_t pixels() const { return size_t(width) * size_t(height); }
  bool operator==(const Crop&) const = default;
};

struct FilmSettings {
  int width = 768, height = 576;
  Crop crop;  // the whole image unless told otherwise
  std::shared_ptr<const Filter> filter;
  // Whether pixels at the film's border see as far beyond it as their filter reaches.
  bool sampleBorder = false;
};

// Samples count in one pixel or in several.
enum class FilmKind {
  pixels,  // in one: its place around it is drawn from the filter, so that pixels' noise is independent
  splat,   // in all that the filter reaches from its place, which is uniform in its pixel: less noise
};

inline const char* filmName(FilmKind kind) {
  return kind == FilmKind::splat ? "splat" : "pixels";
}

// The kind of film that a filter is used with where this one is asked for. Samples of a box of one pixel
// count in one pixel either way.
inline FilmKind filmKindFor(const Filter& filter, FilmKind asked) {
  return filter.reach() > 0 && filter.reach() <= kMostSplatReach ? asked : FilmKind::pixels;
}

// The pixels that samples are taken in for the film's crop: with a film that splats also those around it that
// its filter reaches from, which lie beyond the film's border only if that is sampled.
inline Crop sampledPixels(const FilmSettings& film, FilmKind kind) {
  if (kind == FilmKind::pixels) return film.crop;
  const int reach = film.filter->reach(), beyond = film.sampleBorder ? reach : 0;
  const Crop& crop = film.crop;
  const int x = std::max(crop.x - reach, -beyond), y = std::max(crop.y - reach, -beyond);
  return {x, y, std::min(crop.x + crop.width + reach, film.width + beyond) - x,
          std::min(crop.y + crop.height + reach, film.height + beyond) - y};
}

}  // namespace odis::render
