// Benchmarks of the time that a player waits for single frames.
#pragma once

#include "conformance/studies/bench/bench_animation.h"

namespace rlpc::bench {

void register_latency(const BenchAnimation& animation);

}  // namespace rlpc::bench
