#pragma once

namespace odis::render {

// Where random numbers come from: Owen-scrambled Sobol' points, or independent numbers.
enum class SamplerKind { sobol, independent };

}  // namespace odis::render
