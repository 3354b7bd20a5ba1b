#include "odis/api/guard.h"

using odis::core::adopt;
using odis::core::guarded;

OdisContextImpl::OdisContextImpl(const OdisContextOptions& given)
    : options(given),
      tasks(given.taskFunction ? odis::core::hostTasks(given.taskFunction, given.user)
                               : odis::core::libraryTasks(given.threads)) {}

void OdisContextImpl::log(OdisLogLevel level, const std::string& message) {
  if (!hears(level)) return;
  const std::lock_guard lock(m_logMutex);
  options.logFunction(options.user, level, message.c_str());
}

void OdisContextImpl::countMemory(int64_t change) {
  memory += change;
  if (options.memoryFunction) options.memoryFunction(options.user, change);
}

uint64_t OdisContextImpl::memoryLeft() const {
  if (options.memoryLimit == 0) return UINT64_MAX;
  const int64_t left = int64_t(std::min<uint64_t>(options.memoryLimit, INT64_MAX)) - memory;
  return left > 0 ? uint64_t(left) : 0;
}

namespace odis::core {

void MemoryWarnings::report(OdisContextImpl& context, int coarsening, uint64_t samplesLeftOut) {
  if (coarsening > m_coarsening)
    context.log(ODIS_LOG_WARNING,
                "the memory's limit makes the cells' edges " + std::to_string(coarsening) + " times as long");
  if (samplesLeftOut > 0 && !m_leftOut)
    context.log(
        ODIS_LOG_WARNING,
        "the limit of the memory or that of the number of cells leaves no room for new ones: the guide "
        "learns nothing there");
  m_coarsening = coarsening;
  m_leftOut = samplesLeftOut > 0;
}

}  // namespace odis::core

void odisInitContextOptions(OdisContextOptions* options, size_t size) {
  odis::core::initialize(options, size, "OdisContextOptions");
}

OdisContext odisNewContext(const OdisContextOptions* options) {
  return guarded(nullptr, OdisContext(nullptr), [&] {
    return new OdisContextImpl(options ? adopt(*options, "OdisContextOptions") : OdisContextOptions());
  });
}
void odisRetainContext(OdisContext context) {
  if (context) context->retain();
}
void odisReleaseContext(OdisContext context) {
  if (context) context->release();
}
uint64_t odisGetMemoryUse(OdisContext context) {
  return context ? uint64_t(context->memory) : 0;
}

namespace odis::core {

namespace {

template <class MakeModel>
OdisModel newModel(OdisContext context, const char* function, const MakeModel& make) {
  return guardedFor(context, function, OdisModel(nullptr),
                    [&] { return new OdisModelImpl(context, make()); });
}

}  // namespace

}  // namespace odis::core

OdisModel odisNewModel(OdisContext context) {
  return odis::core::newModel(context, "odisNewModel", odis::core::Model::builtIn);
}
OdisModel odisNewModelFromFile(OdisContext context, const char* path) {
  return odis::core::newModel(context, "odisNewModelFromFile", [&] {
    odis::core::requireArgument(path, "odisNewModelFromFile: path");
    return odis::core::Model::load(path);
  });
}
OdisModel odisNewModelFromMemory(OdisContext context, const void* bytes, size_t size) {
  return odis::core::newModel(context, "odisNewModelFromMemory", [&] {
    odis::core::requireArgument(bytes, "odisNewModelFromMemory: bytes");
    return odis::core::Model::parse("weights in memory", {static_cast<const char*>(bytes), size});
  });
}
void odisRetainModel(OdisModel model) {
  if (model) model->retain();
}
void odisReleaseModel(OdisModel model) {
  if (model) model->release();
}
