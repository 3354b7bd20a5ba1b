// What a renderer reports of its paths: one vertex for every place where a path was scattered. A recorder
// (odis/odis.h) makes them from the events of paths; a host that has the numbers itself describes where they
// lie in its memory. World space, unit directions, densities with respect to solid angle, radiance in the
// host's units.
#ifndef ODIS_VERTICES_H
#define ODIS_VERTICES_H

#include "odis/structs.h"

// 188 bytes. What is not said to be optional is required; vertices that lack it are refused and counted
// (OdisVertexCounts).
typedef struct OdisPathVertex {
  OdisFloat3 position;
  // Shading normal, on the side of wo. Zero: the path was scattered in a medium, not on a surface. There the
  // phase function takes the BSDF's place, its roughness is 1 - |mean cosine|, and cosines are 1.
  OdisFloat3 normal;
  // Optional: towards the previous vertex. Nothing that guides today depends on it; data sets keep it.
  OdisFloat3 wo;
  OdisFloat3 wi;  // the sampled direction
  // Estimate of the radiance that arrives from wi: emission weighted by its MIS weight, so that this is what
  // next-event estimation does not cover; divided by the survival probabilities of roulette further along.
  OdisFloat3 radiance;
  // f |cos| / pdf, divided by `survival`; required for roulette, as is `direct`: what the vertex scatters
  // back is direct + weight * radiance. Zero for both means that it scatters nothing back.
  OdisFloat3 weight;
  OdisFloat3 direct;  // next-event estimate: outgoing radiance, MIS-weighted; zero where the light is hidden
  float pdf ODIS_DEFAULT(0);  // > 0: density of wi; the probability for discrete lobes
  float survival
      ODIS_DEFAULT(1);  // optional, in (0, 1]: with which roulette let the path go on in direction wi
  // Optional: the part of pdf that comes from lobes that may be guided (where directions are not guided, at
  // most pdf), and how often the BSDF draws from such lobes, in [0, 1]. Unknown: all of the BSDF may be
  // guided.
  float guidablePdf ODIS_DEFAULT(ODIS_UNKNOWN);
  float guidableProbability ODIS_DEFAULT(ODIS_UNKNOWN);
  // Optional, >= 0: to the next vertex; infinity if the ray left the scene. Unknown is infinity: what is near
  // is then seen in the same direction from all of a cell.
  float distance ODIS_DEFAULT(INFINITY);
  // Optional, >= 0: alpha of the microfacet lobe that matters most, 1 for diffuse and for what is above.
  float roughness ODIS_DEFAULT(1);
  // Optional, in [0, 1]: |cos| between wi and the normal. Unknown: computed from the two. In media it
  // is 1, whatever is said here.
  float cosine ODIS_DEFAULT(ODIS_UNKNOWN);

  // Optional: what this vertex adds to its pixel, as luminances with all that the path was multiplied by, and
  // the densities that MIS was made from. Without them the BSDF sampling fraction is .5 everywhere, paths
  // always go on and nothing is predicted of variance.
  float indirect ODIS_DEFAULT(ODIS_UNKNOWN);  // through wi, without emission that wi meets directly
  float emission ODIS_DEFAULT(ODIS_UNKNOWN);  // emission that wi meets directly, without MIS weight
  float emissionLightPdf ODIS_DEFAULT(0);  // density with which next-event estimation gives wi; 0 if it can't
  float light ODIS_DEFAULT(ODIS_UNKNOWN);  // next-event estimate, without MIS weight
  OdisFloat3 lightDirection;               // towards the light that next-event estimation chose
  float lightPdf
      ODIS_DEFAULT(0);  // its density; 0 if next-event estimation gave nothing or MIS does not apply
  float lightBsdfPdf ODIS_DEFAULT(0);      // density of the BSDF in that direction
  float lightGuidablePdf ODIS_DEFAULT(0);  // the part of it that comes from lobes that may be guided

  // Optional: rays traced because of wi, shadow rays included. Without it the fallbacks are those of unknown
  // contributions.
  float raysAfter ODIS_DEFAULT(ODIS_UNKNOWN);

  // Optional: the group of lights that `direct` came from, and the probability with which next-event
  // estimation chose that group and traced the shadow ray. Without them nothing is learned about the choice
  // of lights.
  float lightGroupProbability ODIS_DEFAULT(0);
  uint32_t lightGroup ODIS_DEFAULT(ODIS_NO_LIGHT_GROUP);
  // Optional: bit g is set where lights of group g may light this vertex, bit 31 where all groups from 31 on
  // may. Vertices that some group may not light are left out of what is learned about the choice of lights,
  // which holds for all of a cell.
  uint32_t lightableGroups ODIS_DEFAULT(~(0u));

  // Optional: weight of the path in its pixel by the reconstruction filter; no radiance or contribution
  // includes it.
  float sampleWeight ODIS_DEFAULT(1);
  // Optional, in the units of the host: when the path was at the vertex. The guide of today learns over the
  // whole shutter time.
  float time ODIS_DEFAULT(0);

  // These three numbers identify the vertex, and sums are ordered by them: those of a frame whatever the
  // order of delivery, those of a builder within each call of odisAddVertices.
  uint32_t pixel ODIS_DEFAULT(0);   // index within the frame
  uint32_t sample ODIS_DEFAULT(0);  // of the pixel
  uint16_t depth ODIS_DEFAULT(0);   // 1 for the first vertex

  // Optional: `wi` is of a delta lobe. Where guidableProbability is above 0, as on a coat, the vertex tells
  // what its surface scatters back; else there is nothing to learn from it.
  bool discrete ODIS_DEFAULT(false);
  // Optional: the BSDF scatters to both sides of the surface. Without it nothing is guided below.
  bool scattersBothSides ODIS_DEFAULT(false);
} OdisPathVertex;

// The type of the numbers of an array.
typedef enum OdisFormat {
  ODIS_FORMAT_DEFAULT = 0,  // that of the field in OdisPathVertex
  ODIS_FORMAT_HALF = 1      // 16-bit floats in place of 32-bit ones
} OdisFormat;

// One field of many vertices: that of vertex i begins at `data` + i * `stride` bytes. NULL: all have the
// field's default. No alignment is asked for.
typedef struct OdisVertexField {
  const void* data ODIS_DEFAULT(NULL);
  size_t stride ODIS_DEFAULT(0);                     // 0: one after another, without gaps
  int32_t format ODIS_DEFAULT(ODIS_FORMAT_DEFAULT);  // an OdisFormat
} OdisVertexField;

// Many vertices as they lie in the host's memory, as arrays of structs or of numbers: fields of
// OdisPathVertex, by name. Three numbers one after another make a vector.
typedef struct OdisPathVertices {
  size_t size ODIS_DEFAULT(sizeof(OdisPathVertices));
  size_t count ODIS_DEFAULT(0);
  OdisVertexField position, normal, wo, wi, radiance, weight, direct;
  OdisVertexField pdf, survival, guidablePdf, guidableProbability, distance, roughness, cosine;
  OdisVertexField indirect, emission, emissionLightPdf, light;
  OdisVertexField lightDirection, lightPdf, lightBsdfPdf, lightGuidablePdf, raysAfter;
  OdisVertexField lightGroupProbability, lightGroup, lightableGroups, sampleWeight, time;
  OdisVertexField pixel, sample, depth, discrete, scattersBothSides;
} OdisPathVertices;

#endif
