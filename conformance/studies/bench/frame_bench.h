// Benchmarks of inter GOFs: encoding with low delay, and decoding.
#pragma once

#include "conformance/studies/bench/bench_animation.h"

namespace rlpc::bench {

void register_frames(const BenchAnimation& animation);

}  // namespace rlpc::bench
