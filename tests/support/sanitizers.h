// Which sanitizer the tests are built with. GCC tells by macros, Clang by a question.
#pragma once

namespace odis::test {

#if defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true, kThreadSanitized = true;
#elif defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true, kThreadSanitized = false;
#elif defined(__has_feature)
inline constexpr bool kThreadSanitized = __has_feature(thread_sanitizer);
inline constexpr bool kSanitized = __has_feature(address_sanitizer) || kThreadSanitized;
#else
inline constexpr bool kSanitized = false, kThreadSanitized = false;
#endif

// How many images a comparison of expectations renders. A few of them show races as well as many, and under
// the thread sanitizer each takes ten times as long; too few are left there to compare.
inline constexpr int imagesToCompare(int images) {
  return kThreadSanitized ? 2 : images;
}

}  // namespace odis::test
