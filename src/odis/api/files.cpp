#include "odis/api/guard.h"
#include "odis/api/vertices.h"
#include "odis/files/archive.h"
#include "odis/saved_vertices.h"

using odis::core::Archive;
using odis::core::ArchiveWriter;
using odis::core::guarded;
using odis::core::guardedFor;
using odis::core::requireArgument;

bool odisSaveFrame(OdisFrame frame, const char* path) {
  return guardedFor(frame, "odisSaveFrame", false, [&] {
    requireArgument(path, "odisSaveFrame: path");
    frame->requireNotEnding("odisSaveFrame");
    ArchiveWriter file("frame");
    frame->frame.save(file);
    file.write(path);
    return true;
  });
}

OdisFrame odisLoadFrame(OdisContext context, const char* path, OdisModel model) {
  return guarded(context, OdisFrame(nullptr), [&] {
    requireArgument(context, "odisLoadFrame: context");
    requireArgument(path, "odisLoadFrame: path");
    return new OdisFrameImpl(
        context,
        odis::core::Frame::load(Archive::load(path), odis::core::modelBehind(model), context->tasks));
  });
}

bool odisSetFrameHostData(OdisFrame frame, const void* bytes, size_t size) {
  return guardedFor(frame, "odisSetFrameHostData", false, [&] {
    if (size > 0) requireArgument(bytes, "odisSetFrameHostData: bytes");
    frame->requireNotEnding("odisSetFrameHostData");
    frame->frame.setHostData({static_cast<const uint8_t*>(bytes), size});
    frame->memory.set(frame->frame.bytes());
    return true;
  });
}

const void* odisGetFrameHostData(OdisFrame frame, size_t* size) {
  return guardedFor(frame, "odisGetFrameHostData", static_cast<const void*>(nullptr), [&] {
    requireArgument(size, "odisGetFrameHostData: size");
    const odis::ArrayView<const uint8_t> bytes = frame->frame.hostData();
    *size = bytes.size();
    return static_cast<const void*>(bytes.empty() ? nullptr : bytes.data());
  });
}

bool odisSetFrameProgress(OdisFrame frame, OdisProgressFunction function, void* user) {
  return guardedFor(frame, "odisSetFrameProgress", false, [&] {
    frame->requireNotEnding("odisSetFrameProgress");
    frame->frame.setProgress(function, user);
    return true;
  });
}

bool odisSaveGuide(OdisGuide guide, const char* path) {
  return guardedFor(guide, "odisSaveGuide", false, [&] {
    requireArgument(path, "odisSaveGuide: path");
    ArchiveWriter file("guide");
    guide->guide.save(file);
    file.write(path);
    return true;
  });
}

OdisGuide odisLoadGuide(OdisContext context, const char* path) {
  return guarded(context, OdisGuide(nullptr), [&] {
    requireArgument(context, "odisLoadGuide: context");
    requireArgument(path, "odisLoadGuide: path");
    const Archive file = Archive::load(path);
    file.requireKind("guide");
    return new OdisGuideImpl(context, odis::core::Guide::load(file));
  });
}

bool odisSaveGuideBuilder(OdisGuideBuilder builder, const char* path) {
  return guardedFor(builder, "odisSaveGuideBuilder", false, [&] {
    requireArgument(path, "odisSaveGuideBuilder: path");
    builder->requireFree("odisSaveGuideBuilder");
    ArchiveWriter file("builder");
    builder->builder.save(file);
    file.write(path);
    return true;
  });
}

OdisGuideBuilder odisLoadGuideBuilder(OdisContext context, const char* path, OdisModel model) {
  return guarded(context, OdisGuideBuilder(nullptr), [&] {
    requireArgument(context, "odisLoadGuideBuilder: context");
    requireArgument(path, "odisLoadGuideBuilder: path");
    return new OdisGuideBuilderImpl(
        context,
        odis::core::GuideBuilder::load(Archive::load(path), odis::core::modelBehind(model), context->tasks));
  });
}

bool odisSaveVertices(const OdisPathVertices* vertices, const char* path) {
  return guarded(nullptr, false, [&] {
    requireArgument(vertices, "odisSaveVertices: vertices");
    requireArgument(path, "odisSaveVertices: path");
    ArchiveWriter file("vertices");
    odis::core::saveVertices(file, "vertices", odis::core::HostVertices(vertices).view());
    file.write(path);
    return true;
  });
}

size_t odisLoadVertices(const char* path, OdisPathVertex* vertices, size_t capacity) {
  return guarded(nullptr, size_t(0), [&] {
    requireArgument(path, "odisLoadVertices: path");
    const Archive file = Archive::load(path);
    file.requireKind("vertices");
    const std::vector<OdisPathVertex> all = odis::core::loadVertices(file, "vertices");
    if (vertices) std::copy_n(all.begin(), std::min(all.size(), capacity), vertices);
    return all.size();
  });
}
