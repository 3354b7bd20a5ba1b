// What a host brings to the library: tasks, progress that cancels, memory that is limited or ends, messages.
#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

#include "api/api_scene.h"
#include "api/listening.h"

namespace odis::test {
namespace {

// Counts down to an allocation that fails, on this thread; negative: none fails.
thread_local int allocationsLeft = -1;

// Calls tasks one after another, the last one first.
void runBackwards(void* user, size_t count, void (*task)(void* data, size_t index), void* data) {
  ++*static_cast<std::atomic<int>*>(user);
  while (count-- > 0) task(data, count);
}

// Calls each task by a thread of its own.
void runByThreads(void*, size_t count, void (*task)(void* data, size_t index), void* data) {
  std::atomic<size_t> next{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      for (size_t at; (at = next++) < count;) task(data, at);
    });
  for (std::thread& thread : threads) thread.join();
}

Guide guideIn(const Context& context) {
  GuideBuilder builder({}, context);
  builder.add(apiVertices());
  return builder.build();
}

TEST(ApiContext, TasksOfTheHostGiveTheSameGuide) {
  std::atomic<int> calls{0};
  ContextOptions backwards, threads, one, several;
  backwards.taskFunction = runBackwards;
  backwards.user = &calls;
  threads.taskFunction = runByThreads;
  one.threads = 1;
  several.threads = 3;
  const Guide expected = guideIn(Context());
  for (const ContextOptions& options : {backwards, threads, one, several})
    EXPECT_TRUE(sameBits(expected.view(), guideIn(Context(options)).view()));
  EXPECT_GT(calls, 3);
}

struct Patience {
  int left = 0;
  double last = -1;
};
bool lastsALittle(void* user, double fraction) {
  Patience& patience = *static_cast<Patience*>(user);
  EXPECT_GE(fraction, 0);
  EXPECT_LE(fraction, 1);
  patience.last = fraction;
  return patience.left-- > 0;
}

TEST(ApiContext, CancellingLeavesABuilderThatGoesOn) {
  Patience patience;
  GuideOptions options;
  options.progressFunction = lastsALittle;
  options.progressUser = &patience;
  GuideBuilder builder(options);
  builder.add(apiVertices());
  int stages = 0;
  OdisGuide guide = nullptr;
  while (!guide && stages < 100) {
    patience.left = stages++;
    guide = odisBuildGuide(builder.get(), nullptr, 0);
    if (!guide) {
      EXPECT_EQ(takeError(), ODIS_ERROR_CANCELLED);
    }
  }
  EXPECT_GT(stages, 3);
  EXPECT_LT(stages, 100);
  EXPECT_EQ(patience.last, 1);
  EXPECT_TRUE(sameBits(Guide(guide).view(), guideIn(Context()).view()));
}

TEST(ApiContext, CancellingEndsAFrame) {
  for (const bool inBackground : {false, true})
    for (int stages = 0; stages < 8; ++stages) {
      Patience patience{stages};
      FrameOptions options;
      options.width = options.height = 32;
      options.guide.progressFunction = lastsALittle;
      options.guide.progressUser = &patience;
      Frame frame(options);
      ASSERT_TRUE(frame.beginPass());
      const FrameSample sample{5, 0, {1, 1, 1}, 1};
      OdisPathVertex vertex = apiVertices()[0];
      vertex.pixel = 5;
      frame.add({&sample, 1}, {&vertex, 1});
      const bool ended = inBackground ? odisStartEndPass(frame.get(), false) && odisWaitForPass(frame.get())
                                      : odisEndPass(frame.get(), false);
      if (!ended) {
        EXPECT_EQ(takeError(), ODIS_ERROR_CANCELLED);
      }
      EXPECT_EQ(frame.beginPass() != nullptr, ended);
      EXPECT_EQ(frame.mean(5).color.x, 1);
    }
}

// A frame and a guide for which the n-th allocation fails, for all n: an error each time, and no crash.
TEST(ApiContext, MemoryThatEndsIsAnError) {
  std::atomic<int> calls{0};
  ContextOptions serial;
  serial.taskFunction = runBackwards;
  serial.user = &calls;
  const Context context(serial);
  FrameOptions options;
  options.width = options.height = 16;
  const OdisGuideOptions guide = options.guide.flat();
  const OdisFrameOptions flat = options.flat(guide);
  const OdisPathVertex* vertices = apiVertices().data();  // made before memory ends
  int failures = 0;
  for (int n = 0;; n += 1 + n / 40) {
    allocationsLeft = n;
    const OdisFrame frame = odisNewFrame(context.get(), &flat);
    OdisFramePass pass;
    if (frame && odisBeginPass(frame, &pass)) {
      const OdisFrameSample sample{5, 0, {1, 1, 1}, 2};
      OdisPathVertices described;
      odisDescribeVertices(&described, vertices, 500);
      if (odisAddSamples(frame, &sample, 1, &described)) odisEndPass(frame, false);
    }
    const bool allMade = allocationsLeft >= 0;
    allocationsLeft = -1;
    const OdisError error = takeError();
    odisReleaseFrame(frame);
    if (allMade) {
      EXPECT_EQ(error, ODIS_ERROR_NONE);
      break;
    }
    EXPECT_EQ(error, ODIS_ERROR_OUT_OF_MEMORY) << "allocation " << n;
    ++failures;
  }
  EXPECT_GT(failures, 50);
}

TEST(ApiContext, MemoryIsCounted) {
  Heard heard;
  {
    const Context context(heardBy(heard));
    {
      const Guide guide = guideIn(context);
      EXPECT_EQ(context.memoryUse(), guide.bytes());
      EXPECT_EQ(heard.held, int64_t(guide.bytes()));
      EXPECT_GT(heard.most, int64_t(guide.bytes()));
    }
    EXPECT_EQ(context.memoryUse(), 0u);
    FrameOptions options;
    options.width = options.height = 64;
    const Frame frame(options, context);
    EXPECT_GE(context.memoryUse(), 64u * 64 * 112);
  }
  EXPECT_EQ(heard.held, 0);
  EXPECT_TRUE(heard.messages.empty());
}

TEST(ApiContext, TheLogTellsWhatWasBuilt) {
  Heard heard;
  ContextOptions options = heardBy(heard);
  options.logLevel = ODIS_LOG_INFO;
  const Guide guide = guideIn(Context(options));
  ASSERT_EQ(heard.messages.size(), 1u);
  EXPECT_NE(heard.messages[0].find(std::to_string(guide.view().cellCount) + " cells"), std::string::npos);
}

TEST(ApiContext, AMemoryLimitMakesGuidesCoarser) {
  const uint32_t cells = guideIn(Context()).view().cellCount;
  for (const uint64_t limit : {uint64_t(4) << 20, uint64_t(1) << 20}) {
    Heard heard;
    ContextOptions options = heardBy(heard);
    options.memoryLimit = limit;
    const Context context(options);
    const Guide guide = guideIn(context);
    EXPECT_GT(guide.view().cellCount, 0u);
    EXPECT_LT(guide.view().cellCount, cells);
    EXPECT_LE(uint64_t(heard.most), limit);
    ASSERT_FALSE(heard.messages.empty());
    EXPECT_NE(heard.messages[0].find("memory's limit"), std::string::npos);
  }
}

TEST(ApiContext, AMemoryLimitHoldsForFrames) {
  for (const uint64_t limit : {uint64_t(6) << 20, uint64_t(2) << 20}) {
    Heard heard;
    ContextOptions options = heardBy(heard);
    options.memoryLimit = limit;
    const Context context(options);
    FrameOptions frameOptions;
    frameOptions.width = frameOptions.height = 64;
    frameOptions.set("guided-cost=0");  // refined in any case
    Frame frame(frameOptions, context);
    EXPECT_TRUE(runFrame(frame.get(), 64 * 64));
    EXPECT_LE(uint64_t(heard.most), limit);
    EXPECT_FALSE(heard.messages.empty());
    EXPECT_EQ(frame.mean(77).color.x, 1);
  }
  Heard heard;
  ContextOptions options = heardBy(heard);
  options.memoryLimit = 1000;
  OdisFrameOptions frame;
  frame.width = frame.height = 64;
  const Context context(options);
  EXPECT_EQ(odisNewFrame(context.get(), &frame), nullptr);
  EXPECT_EQ(takeError(), ODIS_ERROR_OUT_OF_MEMORY);
  EXPECT_EQ(heard.errors.size(), 1u);
}

TEST(ApiContext, ErrorsAreKeptForEachThread) {
  const OdisContext context = Context::shared().get();
  std::string message;
  EXPECT_EQ(odisNewModel(nullptr), nullptr);
  EXPECT_EQ(odisNewModelFromFile(context, "no/such.weights"), nullptr);
  std::thread([] { EXPECT_EQ(takeError(), ODIS_ERROR_NONE); }).join();
  EXPECT_EQ(takeError(&message), ODIS_ERROR_INVALID_ARGUMENT) << "the first one is kept";
  EXPECT_NE(message.find("odisNewModel"), std::string::npos);
  EXPECT_EQ(takeError(&message), ODIS_ERROR_NONE);
  EXPECT_EQ(message, "");
  EXPECT_EQ(odisNewModelFromFile(Context::shared().get(), "no/such.weights"), nullptr);
  EXPECT_EQ(takeError(&message), ODIS_ERROR_FILE);
  EXPECT_NE(message.find("no/such.weights"), std::string::npos);
  EXPECT_EQ(odisNewModelFromMemory(Context::shared().get(), "nonsense", 8), nullptr);
  EXPECT_EQ(takeError(), ODIS_ERROR_FILE);
}

TEST(ApiContext, ObjectsKeepTheirContext) {
  Heard heard;
  OdisFrame frame = nullptr;
  {
    const Context context(heardBy(heard));
    OdisFrameOptions options;
    options.width = options.height = 4;
    frame = odisNewFrame(context.get(), &options);
  }
  EXPECT_FALSE(odisEndPass(frame, false));
  EXPECT_EQ(heard.errors.size(), 1u);
  takeError();
  odisReleaseFrame(frame);
}

TEST(ApiContext, EveryErrorHasAName) {
  for (int code = 0; code <= ODIS_ERROR_FILE; ++code) {
    const std::string name = odisGetErrorName(OdisError(code));
    EXPECT_EQ(name == "unknown error", code == ODIS_ERROR_UNKNOWN) << code;
  }
  EXPECT_STREQ(odisGetErrorName(OdisError(7)), "unknown error");
  EXPECT_EQ(odisGetVersion(), uint32_t(ODIS_VERSION));
  EXPECT_EQ(std::string(odisGetVersionText()).find("0.1.0"), 0u);
}

}  // namespace

// Lets an allocation of this thread fail.
bool allocationFails() {
  return allocationsLeft >= 0 && allocationsLeft-- == 0;
}

}  // namespace odis::test

void* operator new(size_t size) {
  void* memory = odis::test::allocationFails() ? nullptr : std::malloc(size > 0 ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  return odis::test::allocationFails() ? nullptr : std::malloc(size > 0 ? size : 1);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
  std::free(memory);
}
