// Functions that are compiled for several instruction sets; which of them runs is decided when the program
// starts.
#pragma once

// In front of a function whose loops gain by vectors of eight: it is compiled once more for processors with
// AVX2. Without FMA, so that results are the same on all; "arch=..." would ask for that very processor, not
// for what it can do. Resolved by the loader, which sanitizers don't get along with.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define ODIS_SANITIZED
#endif
#endif
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(ODIS_SANITIZED) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ODIS_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define ODIS_WIDE
#endif
