// Runs work on other threads.
#pragma once

#include <functional>
#include <future>

namespace rlpc {

// Runs `work` on another thread. The future yields false if no thread could be started or
// memory ran out: `work` was then not done, or only partly. Its destructor waits.
std::future<bool> run_async(std::function<void()> work);

}  // namespace rlpc
