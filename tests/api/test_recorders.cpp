// Recorders: what they refuse, and two threads at one of them.
#include <atomic>
#include <thread>

#include "api/api_scene.h"
#include "odis/events.h"

namespace odis::test {
namespace {

constexpr Float3 kUp{0, 0, 1};

// An open path that has met a surface.
uint32_t beginAtSurface(PathRecorder& recorder) {
  const uint32_t path = recorder.begin({});
  recorder.surface(path, surfaceEvent({}, kUp, kUp, 1));
  return path;
}

void playBounce(PathRecorder& recorder, uint32_t path) {
  recorder.bounce(path, bounceEvent(kUp, {1, 1, 1}, 1));
}
void playLight(PathRecorder& recorder, uint32_t path) {
  recorder.light(path, lightEvent({}, {}, kUp, {}));
}

template <class Call>
OdisError errorOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.code();
  }
  return ODIS_ERROR_NONE;
}

TEST(ApiRecorders, SurvivalIsAProbability) {
  PathRecorder recorder;
  const uint32_t path = beginAtSurface(recorder);
  for (const float probability : {0.0f, -0.5f, 1.5f, NAN, INFINITY})
    EXPECT_EQ(errorOf([&] { recorder.survived(path, probability); }), ODIS_ERROR_INVALID_ARGUMENT);
  recorder.survived(path, 0.5f);
  playBounce(recorder, path);
  const ArrayView<const PathVertex> vertices = recorder.finish();
  ASSERT_EQ(vertices.size(), 1u);
  EXPECT_EQ(vertices[0].survival, 1);
}

TEST(ApiRecorders, SurvivalIsToldOnArrival) {
  PathRecorder recorder;
  const auto refuses = [&](uint32_t path) {
    EXPECT_EQ(errorOf([&] { recorder.survived(path, 0.5f); }), ODIS_ERROR_INVALID_OPERATION);
  };
  refuses(recorder.begin({}));  // before the first surface
  uint32_t path = beginAtSurface(recorder);
  recorder.survived(path, 0.5f);
  refuses(path);  // twice
  playBounce(recorder, path);
  refuses(path);  // after the bounce
  path = beginAtSurface(recorder);
  playLight(recorder, path);
  refuses(path);  // after the shadow ray
  recorder.escape(recorder.begin({}));
  refuses(path + 1);
}

TEST(ApiRecorders, EachSurfaceHasOneLightEvent) {
  PathRecorder recorder;
  const uint32_t path = beginAtSurface(recorder);
  playLight(recorder, path);
  EXPECT_EQ(errorOf([&] { playLight(recorder, path); }), ODIS_ERROR_INVALID_OPERATION);
  playBounce(recorder, path);
  recorder.surface(path, surfaceEvent({}, kUp, kUp, 1));
  playLight(recorder, path);
}

TEST(ApiRecorders, NothingFollowsTheEnd) {
  PathRecorder recorder;
  for (const bool escapes : {true, false}) {
    const uint32_t path = beginAtSurface(recorder);
    if (escapes) {
      playBounce(recorder, path);
      recorder.escape(path);
    } else {
      recorder.cached(path, {1, 1, 1});
    }
    const auto refuses = [&](const auto& call) { EXPECT_EQ(errorOf(call), ODIS_ERROR_INVALID_OPERATION); };
    refuses([&] { recorder.escape(path); });
    refuses([&] { recorder.surface(path, {}); });
    refuses([&] { recorder.cached(path, {}); });
    refuses([&] { recorder.survived(path, 1); });
    refuses([&] { playLight(recorder, path); });
    refuses([&] { playBounce(recorder, path); });
    recorder.emission(path, emissionEvent({1, 1, 1}, 1, 0));
  }
  EXPECT_EQ(recorder.finish().size(), 1u);
}

TEST(ApiRecorders, CachedRadianceComesFirst) {
  PathRecorder recorder;
  uint32_t path = beginAtSurface(recorder);
  recorder.survived(path, 0.5f);
  EXPECT_EQ(errorOf([&] { recorder.cached(path, {}); }), ODIS_ERROR_INVALID_OPERATION);
  path = beginAtSurface(recorder);
  playLight(recorder, path);
  EXPECT_EQ(errorOf([&] { recorder.cached(path, {}); }), ODIS_ERROR_INVALID_OPERATION);
}

TEST(ApiRecorders, WeightsOfMisAreProbabilities) {
  PathRecorder recorder;
  const uint32_t path = beginAtSurface(recorder);
  for (const float weight : {-0.1f, 1.5f, INFINITY})
    EXPECT_EQ(errorOf([&] {
                recorder.emission(path, emissionEvent({1, 1, 1}, weight, 1));
              }),
              ODIS_ERROR_INVALID_ARGUMENT);
  recorder.emission(path, emissionEvent({1, 1, 1}, 1, 1));
}

TEST(ApiRecorders, DistancesAreNotNegative) {
  PathRecorder recorder;
  const uint32_t path = recorder.begin({});
  EXPECT_EQ(errorOf([&] { recorder.surface(path, surfaceEvent({}, kUp, kUp, -1)); }),
            ODIS_ERROR_INVALID_ARGUMENT);
  recorder.surface(path, surfaceEvent({}, kUp, kUp, 0));
}

TEST(ApiRecorders, BelongToTheThreadThatHasPathsOpen) {
  PathRecorder recorder;
  const uint32_t path = beginAtSurface(recorder);
  std::thread([&] {
    const auto refuses = [&](const auto& call) { EXPECT_EQ(errorOf(call), ODIS_ERROR_INVALID_OPERATION); };
    refuses([&] { recorder.begin({}); });
    refuses([&] { recorder.surface(path, {}); });
    refuses([&] { recorder.escape(path); });
    refuses([&] { recorder.emission(path, {}); });
    refuses([&] { recorder.cached(path, {}); });
    refuses([&] { recorder.survived(path, 1); });
    refuses([&] { playLight(recorder, path); });
    refuses([&] { recorder.lightHidden(path); });
    refuses([&] { playBounce(recorder, path); });
    refuses([&] { recorder.finish(); });
  }).join();
  playBounce(recorder, path);
  EXPECT_EQ(recorder.finish().size(), 1u);
  // The next paths may be another thread's.
  std::thread([&] {
    playBounce(recorder, beginAtSurface(recorder));
    EXPECT_EQ(recorder.finish().size(), 1u);
  }).join();
}

// Threads that use one recorder all the same: calls fail, nothing breaks, and no path has another's vertices.
TEST(ApiRecorders, TwoThreadsAtOnceGetErrors) {
  PathRecorder shared;
  std::atomic<int> refused{0}, finished{0};
  const auto trace = [&](uint32_t thread) {
    for (uint32_t i = 0; i < 20000; ++i) {
      try {
        const uint32_t path = shared.begin({thread, i});
        for (int bounce = 0; bounce < 3; ++bounce) {
          shared.surface(path, surfaceEvent({}, kUp, kUp, 1));
          playBounce(shared, path);
        }
        shared.finish();
        ++finished;
      } catch (const Error& error) {
        ASSERT_EQ(error.code(), ODIS_ERROR_INVALID_OPERATION) << error.what();
        ++refused;
      }
    }
  };
  std::thread other([&] { trace(1); });
  trace(0);
  other.join();
  EXPECT_EQ(refused + finished, 40000);
  EXPECT_GT(finished, 0);
}

}  // namespace
}  // namespace odis::test
