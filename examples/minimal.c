// The smallest host there is: it makes up what paths saw on a floor under a bright spot of sky, lets ODIS
// learn from that, and asks for a direction. A renderer does the same with the vertices of its own first
// paths. examples/README.md says how it is compiled.
#include <math.h>
#include <odis/odis.h>
#include <stdio.h>
#include <stdlib.h>

enum { VERTEX_COUNT = 20000 };
static const float PI = 3.14159265f;
// The sky is bright where the cosine to this direction exceeds 0.95.
static const OdisFloat3 BRIGHT = {0.6f, 0, 0.8f};

// Ends the program with the library's message if a call has failed.
static void require(bool succeeded, const char* call) {
  const char* message;
  if (succeeded) return;
  const OdisError code = odisGetError(&message);
  fprintf(stderr, "minimal: %s failed: %s: %s\n", call, odisGetErrorName(code), message);
  exit(1);
}

// A number in [0, 1): Numerical Recipes' linear congruential generator, whose upper 24 bits are good enough
// here.
static float randomNumber(void) {
  static uint32_t state = 1;
  state = state * 1664525u + 1013904223u;
  return (float)(state >> 8) / 16777216.0f;
}

// What a path tracer would record where a path met the floor: where that was, the direction in which the path
// went on, the density with which the BSDF sampled it, and the radiance that came back from there.
static void makeVertex(OdisPathVertex* vertex, uint32_t sample) {
  const float radius = sqrtf(randomNumber()), phi = 2 * PI * randomNumber();
  const OdisFloat3 normal = {0, 0, 1};
  const OdisFloat3 wi = {radius * cosf(phi), radius * sinf(phi), sqrtf(fmaxf(0, 1 - radius * radius))};
  const bool bright = wi.x * BRIGHT.x + wi.y * BRIGHT.y + wi.z * BRIGHT.z > 0.95f;
  const float radiance = bright ? 10.0f : 0.1f;

  // All that is optional gets its default.
  odisInitPathVertex(vertex, sizeof *vertex);
  vertex->position.x = randomNumber();
  vertex->position.y = randomNumber();
  vertex->normal = normal;
  vertex->wi = wi;
  vertex->radiance.x = vertex->radiance.y = vertex->radiance.z = radiance;
  vertex->pdf = wi.z / PI;  // The BSDF is diffuse, which is sampled by the cosine.
  vertex->sample = sample;  // Tells vertices apart: no two have the same pixel, sample and depth.
  vertex->depth = 1;
}

// Learns from the vertices, which are not needed afterwards.
static OdisGuide buildGuide(OdisContext context, const OdisPathVertex* array) {
  OdisPathVertices vertices;
  OdisVertexCounts counts;

  // The vertices lie in an array of the library's own struct. Others may lie as they like: see
  // odis/vertices.h. The size tells a newer library which fields this program knows.
  odisInitPathVertices(&vertices, sizeof vertices);
  odisDescribeVertices(&vertices, array, VERTEX_COUNT);

  // A builder gathers statistics of the vertices in the cells where they lie. NULL: the default options.
  OdisGuideBuilder builder = odisNewGuideBuilder(context, NULL);
  require(builder != NULL, "odisNewGuideBuilder");
  require(odisAddVertices(builder, &vertices, false), "odisAddVertices");

  // Vertices that can't be learned from are counted by reason, so that mistakes of a host show.
  counts.size = sizeof counts;
  require(odisGetVertexCounts(builder, &counts), "odisGetVertexCounts");
  printf("%u vertices: %u accepted\n", (unsigned)VERTEX_COUNT, (unsigned)counts.accepted);

  // Makes a sampling map for each cell. There is no image here, so no pixel values.
  OdisGuide guide = odisBuildGuide(builder, NULL, 0);
  require(guide != NULL, "odisBuildGuide");
  odisReleaseGuideBuilder(builder);
  return guide;
}

// Looks the guide up at a place on the floor, as a renderer does wherever a path is scattered.
static void guidePath(const OdisGuideView* view) {
  const OdisPlace place = {{0.5f, 0.5f, 0}, {0, 0, 1}, 0, 0, false, 1, false};
  const float uv[2] = {0.3f, 0.7f};  // two random numbers
  OdisGuidedVertex vertex;
  OdisFloat3 wi;

  // Finds what is known about this place and normal. There are no pixels here, so no pixel's value.
  if (!odisLookUp(view, &place, 1, &vertex)) {
    printf("nothing is known here: the path goes on as the BSDF says\n");
    return;
  }

  // The surface is diffuse, which the roughness 1 stands for; all of it may be guided, and it scatters to one
  // side. A renderer draws a number u and samples the map if odisDrawsFromMap says so, else its BSDF.
  if (!odisPrepareVertex(&vertex, 1, 1) || !odisSampleMap(&vertex, uv, &wi)) {
    printf("directions are not guided here: the path goes on as the BSDF says\n");
    return;
  }

  // Whichever of the two the direction came from, its density is that of the mixture, which is what the
  // path's weight is divided by. The part of the BSDF that may be guided is all of it.
  const float bsdfPdf = wi.z / PI;
  const float pdf = odisGetDirectionPdf(&vertex, &wi, bsdfPdf, bsdfPdf);
  printf("direction (%.3f, %.3f, %.3f), cosine to the bright spot %.3f\n", wi.x, wi.y, wi.z,
         wi.x * BRIGHT.x + wi.y * BRIGHT.y + wi.z * BRIGHT.z);
  printf("density: BSDF %.3f, map %.3f, mixture %.3f\n", bsdfPdf, odisGetMapPdf(&vertex, &wi),
         pdf);

  // The density of any direction can be asked for, which multiple importance sampling needs.
  printf("density of the map towards the bright spot: %.3f\n", odisGetMapPdf(&vertex, &BRIGHT));
}

int main(void) {
  printf("ODIS %s\n", odisGetVersionText());

  // A context stands for threads, memory and messages. NULL: the default options.
  OdisContext context = odisNewContext(NULL);
  require(context != NULL, "odisNewContext");

  OdisPathVertex* vertices = (OdisPathVertex*)malloc(VERTEX_COUNT * sizeof(OdisPathVertex));
  if (!vertices) return 1;
  for (uint32_t i = 0; i < VERTEX_COUNT; ++i) makeVertex(&vertices[i], i);
  OdisGuide guide = buildGuide(context, vertices);
  free(vertices);

  // The guide as flat arrays: valid as long as the guide.
  OdisGuideView view;
  view.size = sizeof view;
  require(odisGetGuideView(guide, &view), "odisGetGuideView");
  guidePath(&view);

  // Each object is released once; the guide would keep what it needs alive.
  odisReleaseGuide(guide);
  odisReleaseContext(context);
  return 0;
}
