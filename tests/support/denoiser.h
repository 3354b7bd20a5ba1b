// Whether there is an Open Image Denoise to test with: `scripts/setup --denoise` installs one.
#pragma once

#include <gtest/gtest.h>

#include "render/denoise/oidn_library.h"

namespace odis::test {

inline bool hasDenoiser() {
  try {
    render::oidnLibrary();
    return true;
  } catch (const render::DenoiserError&) {
    return false;
  }
}

}  // namespace odis::test

// At the head of a test that needs one.
#define ODIS_NEEDS_DENOISER() \
  if (!odis::test::hasDenoiser()) GTEST_SKIP() << "Open Image Denoise was not found"
