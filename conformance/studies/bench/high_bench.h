// Benchmarks of the High profile: adaptive factors, threads, and the time that one frame takes.
#pragma once

#include "conformance/studies/bench/bench_animation.h"

namespace rlpc::bench {

void register_high(const BenchAnimation& animation);

}  // namespace rlpc::bench
