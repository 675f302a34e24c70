// Work on threads of its own.
#pragma once

#include <functional>
#include <future>

namespace rlpc {

// Runs `work` on another thread. The future gives false if there was no thread for it, or not
// enough memory: then `work` was not done, or only in part. Waits for it when it is destroyed.
std::future<bool> run_async(std::function<void()> work);

}  // namespace rlpc
