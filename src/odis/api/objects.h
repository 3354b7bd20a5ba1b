// What stands behind the handles of the C interface.
#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>

#include "odis/api/reports.h"
#include "odis/frame.h"
#include "odis/guide.h"
#include "odis/models/model.h"
#include "odis/odis.h"
#include "odis/record/recorder.h"
#include "odis/work/object.h"
#include "odis/work/tasks.h"

namespace odis::core {

// Holds a reference.
template <class T>
class Ref {
 public:
  Ref() = default;
  explicit Ref(T* object) : m_object(object) {
    if (object) object->retain();
  }
  Ref(const Ref& other) : Ref(other.m_object) {}
  Ref(Ref&& other) noexcept : m_object(std::exchange(other.m_object, nullptr)) {}
  Ref& operator=(Ref other) noexcept {
    std::swap(m_object, other.m_object);
    return *this;
  }
  ~Ref() {
    if (m_object) m_object->release();
  }
  T* get() const { return m_object; }
  T* operator->() const { return m_object; }
  explicit operator bool() const { return m_object; }

 private:
  T* m_object = nullptr;
};

}  // namespace odis::core

struct OdisContextImpl : odis::core::Object {
  explicit OdisContextImpl(const OdisContextOptions& given);

  bool hears(OdisLogLevel level) const { return options.logFunction && level <= options.logLevel; }
  void log(OdisLogLevel level, const std::string& message);
  // Counts bytes that are held now (change > 0) or no longer.
  void countMemory(int64_t change);
  // Bytes that may still be held; all there are without a limit.
  uint64_t memoryLeft() const;

  const OdisContextOptions options;
  const std::shared_ptr<const odis::core::Tasks> tasks;
  std::atomic<int64_t> memory{0};

 private:
  std::mutex m_logMutex;
};

namespace odis::core {

// Counts what one object holds.
class MemoryUse {
 public:
  explicit MemoryUse(OdisContext context) : m_context(context) {}
  ~MemoryUse() { set(0); }
  MemoryUse(const MemoryUse&) = delete;
  MemoryUse& operator=(const MemoryUse&) = delete;

  OdisContextImpl& context() const { return *m_context.get(); }
  void set(uint64_t bytes) {
    const int64_t change = int64_t(bytes) - m_bytes.exchange(int64_t(bytes));
    if (change != 0) m_context->countMemory(change);
  }

 private:
  Ref<OdisContextImpl> m_context;
  std::atomic<int64_t> m_bytes{0};
};

}  // namespace odis::core

struct OdisModelImpl : odis::core::Object {
  OdisModelImpl(OdisContext owner, odis::core::Model content) : context(owner), model(std::move(content)) {}

  odis::core::Ref<OdisContextImpl> context;
  odis::core::Model model;
};

namespace odis::core {

// Nothing for NULL.
inline std::optional<Model> modelBehind(OdisModel handle) {
  return handle ? std::optional(handle->model) : std::nullopt;
}

}  // namespace odis::core

struct OdisRecorderImpl : odis::core::Object {
  explicit OdisRecorderImpl(OdisContext context) : memory(context) {}

  odis::core::MemoryUse memory;
  odis::core::PathRecorder recorder;
  // The thread that has paths open; none in between.
  std::atomic<std::thread::id> owner{std::thread::id()};
};

struct OdisGuideImpl : odis::core::Object {
  OdisGuideImpl(OdisContext owner, odis::core::Guide content);

  odis::core::MemoryUse memory;
  odis::core::Guide guide;
};

namespace odis::core {

// What a builder or a frame had to do to keep the memory's limit, told to the log once each.
class MemoryWarnings {
 public:
  void report(OdisContextImpl& context, int coarsening, uint64_t samplesLeftOut);

 private:
  int m_coarsening = 1;
  bool m_leftOut = false;
};

}  // namespace odis::core

struct OdisGuideBuilderImpl : odis::core::Object {
  OdisGuideBuilderImpl(OdisContext owner, odis::core::GuideBuilder content);

  // Notes what the builder holds after it has learned.
  void takeStock();
  // Complains where a frame other than `of` learns into the builder and has not ended.
  void requireFree(const char* function, const OdisFrameImpl* of = nullptr) const;

  odis::core::MemoryUse memory;
  odis::core::GuideBuilder builder;
  odis::core::MemoryWarnings warnings;
  odis::core::RefusalWarnings refusals;
  const OdisFrameImpl* frame = nullptr;  // that has begun to learn into it last, if there still is one
};

struct OdisFrameImpl : odis::core::Object {
  OdisFrameImpl(OdisContext owner, odis::core::Frame content, OdisGuideBuilder learnsInto = nullptr);
  ~OdisFrameImpl() override;

  void claimBuilder(const char* function);
  void endPass(bool interrupted);
  void requireNotEnding(const char* function) const;
  bool hasRoomFor(size_t vertices);

  odis::core::MemoryUse memory;
  odis::core::Ref<OdisGuideBuilderImpl> builder;  // the host's
  odis::core::Frame frame;
  odis::core::MemoryWarnings warnings;
  odis::core::RefusalWarnings refusals;
  odis::core::FrameReport report;
  std::atomic<bool> verticesLeftOut{false};
  std::thread ending;  // of the pass; joinable from odisStartEndPass to odisWaitForPass
  std::exception_ptr failure;
};
