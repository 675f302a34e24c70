// Runs work on other threads.
#pragma once

#include <cstdint>
#include <functional>
#include <future>

#include "common/for_each.h"

namespace rlpc {

// Runs `work` on another thread. The future yields false if no thread could be started or
// memory ran out: `work` was then not done, or only partly. Its destructor waits.
std::future<bool> run_async(std::function<void()> work);

// Loops that share their passes among up to `threads` threads, with the caller's. What a pass
// throws is thrown again by the caller, once no pass runs.
ForEach on_threads(std::uint32_t threads);

}  // namespace rlpc
