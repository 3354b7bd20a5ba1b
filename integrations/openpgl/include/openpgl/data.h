// The structs of Open PGL's C interface, as its versions 0.4 to 0.8 lay them out in memory. World space, unit
// directions, densities with respect to solid angle.
#pragma once

#include <cstddef>
#include <cstdint>

#include "version.h"

struct pgl_vec3f {
  float x, y, z;
};
using pgl_point3f = pgl_vec3f;
struct pgl_vec2f {
  float x, y;
};
using pgl_point2f = pgl_vec2f;
struct pgl_vec2i {
  int32_t x, y;
};
using pgl_point2i = pgl_vec2i;
struct pgl_box3f {
  pgl_vec3f lower, upper;
};
using pgl_direction = pgl_vec3f;
using pgl_spectrum = pgl_vec3f;

inline void pglVec3f(pgl_vec3f& v, float x, float y, float z) {
  v = {x, y, z};
}
inline void pglVec3fAdd(pgl_vec3f& sum, const pgl_vec3f& v) {
  sum = {sum.x + v.x, sum.y + v.y, sum.z + v.z};
}

// Radiance that arrived at a place from a direction.
struct PGLSampleData {
  // Numbers of version 0.8, whose first two are those of 0.7; in 0.4 the flag of volumes is 2.
  enum Flags { EInsideVolume = 1 << 0, EDirectLight = 1 << 1, ENextEventVolume = 1 << 2 };

  pgl_point3f position;
  pgl_direction direction;  // where the radiance comes from
  float weight;             // the radiance, over pdf
  float pdf;                // of the direction
  float distance;           // to where it comes from
  uint32_t flags;
};

// The same where nothing arrived.
struct PGLZeroValueSampleData {
  pgl_point3f position;
  pgl_direction direction;
#ifdef ODIS_OPENPGL_8
  uint32_t flags;  // the first byte is what `volume` was, but for flags of 0.8
#else
  bool volume;
#endif
};

// A vertex of a path, and the ray from there to the next one.
struct PGLPathSegmentData {
  pgl_point3f position{0, 0, 0};
  pgl_vec3f directionIn{0, 1, 0};   // towards the next vertex
  pgl_vec3f directionOut{1, 0, 0};  // towards the vertex before
  pgl_vec3f normal{0, 0, 1};
  bool volumeScatter{false};
  float pdfDirectionIn{1};
  bool isDelta{false};
  pgl_vec3f scatteringWeight{1, 1, 1};       // f |cos| / pdfDirectionIn
  pgl_vec3f transmittanceWeight{1, 1, 1};    // on the way to the next vertex
  pgl_vec3f directContribution{0, 0, 0};     // emission towards the vertex before
  float miWeight{1};                         // its MIS weight
  pgl_vec3f scatteredContribution{0, 0, 0};  // next-event estimate, MIS-weighted
  float russianRouletteSurvivalProbability{1};
  float eta{1};
  float roughness{1};  // square root of a microfacet distribution's alpha
  const void* regionPtr{nullptr};
};

#ifdef ODIS_OPENPGL_8
// What a path brought to its pixel.
struct PGLImageSpaceSample {
  enum Flags { EVolumeEvent = 1 << 0 };

  pgl_vec3f contribution{0, 0, 0};
  pgl_vec3f albedo{0, 0, 0};  // of the first hit; not read, nor is the normal
  pgl_vec3f normal{0, 0, -1};
  uint32_t flags{0};

  void SetSurfaceEvent(bool onSurface) {
    flags = onSurface ? flags & ~uint32_t(EVolumeEvent) : flags | uint32_t(EVolumeEvent);
  }
  bool IsSurfaceEvent() const { return !(flags & EVolumeEvent); }
};

// Estimates of contributions are those of either type: of their mean.
enum PGLContributionTypes { EContribContribution = 0, EContribVariance };
enum PGLVSPTypes : uint8_t { EVSPContribution = 0, EVSPVariance };
struct PGLImageSpaceGuidingBufferConfig {
  pgl_point2i resolution{0, 0};
  bool contributionEstimate{true};
  // Whether to estimate probabilities to scatter in volumes. These two lie where hosts of an Open PGL that was built
  // without them have padding, so any value is possible; such hosts never ask for the estimate.
  uint8_t vspEstimate{0};
  PGLVSPTypes vspType{EVSPContribution};
  PGLContributionTypes contributionType{EContribContribution};
};
static_assert(sizeof(PGLImageSpaceGuidingBufferConfig) == 16, "as without estimates for volumes");
#endif

struct PGLString {
  char* m_str;
  size_t m_size;
};
