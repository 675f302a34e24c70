// Exceptions must not leave the thread, which would end the program.
#include "decoder/recon/async.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

namespace rlpc {

std::future<bool> run_async(std::function<void()> work) {
  try {
    return std::async(std::launch::async, [work = std::move(work)] {
      try {
        work();
        return true;
      } catch (...) {
        return false;
      }
    });
  } catch (...) {
    std::promise<bool> none;
    none.set_value(false);
    return none.get_future();
  }
}

ForEach on_threads(std::uint32_t threads) {
  return [threads](std::size_t count, const std::function<void(std::size_t)>& pass) {
    std::atomic<std::size_t> next = 0;
    std::mutex failing;
    std::exception_ptr failure;
    const auto work = [&] {
      try {
        for (std::size_t i = next++; i < count; i = next++) pass(i);
      } catch (...) {
        const std::lock_guard lock(failing);
        failure = std::current_exception();
        next = count;
      }
    };
    std::vector<std::future<bool>> others;
    const std::size_t wanted = std::min<std::size_t>(threads, count);
    others.reserve(wanted);
    while (others.size() + 1 < wanted) others.push_back(run_async(work));
    work();
    for (auto& other : others) other.wait();
    if (failure) std::rethrow_exception(failure);
  };
}

}  // namespace rlpc
