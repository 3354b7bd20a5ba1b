// A host in C++17 that knows nothing of ODIS but what is installed: exceptions and objects pass the border.
#include <odis/odis.hpp>

#include <cstdio>
#include <vector>

namespace {

std::vector<odis::PathVertex> someVertices() {
  std::vector<odis::PathVertex> vertices(1000);
  for (size_t i = 0; i < vertices.size(); ++i) {
    odis::PathVertex& v = vertices[i];
    v.position = {float(i % 10), float(i / 10 % 10), 0};
    v.normal = {0, 0, 1};
    v.wi = i % 2 == 0 ? odis::Float3{0.6f, 0, 0.8f} : odis::Float3{-0.6f, 0, 0.8f};
    v.radiance = i % 2 == 0 ? odis::Float3{5, 5, 5} : odis::Float3{1, 1, 1};
    v.pdf = 0.8f / 3.14159265f;
    v.sample = uint32_t(i);
    v.depth = 1;
  }
  return vertices;
}

// Whether what the library refuses arrives here as an exception, with its message.
bool throwsErrors() {
  try {
    const odis::Model model = odis::Model::load("/no/such/file");
    return false;
  } catch (const odis::Error& e) {
    std::printf("as expected: %s\n", e.what());
    return e.code() == ODIS_ERROR_FILE;
  }
}

}  // namespace

int main() {
  const std::vector<odis::PathVertex> vertices = someVertices();
  odis::GuideBuilder builder;
  builder.add(vertices);
  const odis::Guide guide = builder.build();
  const odis::GuideView view = guide.view();
  const odis::Place place{{5, 5, 0}, {0, 0, 1}, 0, 0};
  odis::GuidedVertex vertex(view, place, 1);
  if (!vertex.isKnown()) return 1;

  // The look-ups in the headers and those in the library answer the same.
  vertex.prepare(1);
  OdisGuidedVertex words;
  odisLookUp(&view, &place, 1, &words);
  odisPrepareVertex(&words, 1, 1);
  const odis::Float3 wi{0.6f, 0, 0.8f};
  const float inHeaders = vertex.mapPdf(wi), inLibrary = odisGetMapPdf(&words, &wi);
  std::printf("ODIS %s: %u cells, density %g and %g\n", odisGetVersionText(), view.cellCount,
              double(inHeaders), double(inLibrary));
  return inHeaders > 0 && inHeaders == inLibrary && odisGetVersion() == ODIS_VERSION && throwsErrors() ? 0
                                                                                                       : 1;
}
