// Loops on several threads. A result must not depend on which thread runs which pass, nor on
// how many threads there are: passes write to places of their own, and sums over them are made
// afterwards, in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace rlpc {

// While it exists, for_each() on the thread that made it shares its passes with other threads.
class Threads {
 public:
  // count: threads in all, at least 1. Where the system grants fewer, there are fewer.
  explicit Threads(std::uint32_t count);
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  class Pool;
  friend void for_each(std::size_t count, const std::function<void(std::size_t)>& pass);

  std::unique_ptr<Pool> pool_;
};

// Calls pass(i) for all i < count, in any order, and returns once all are done. A pass may
// itself contain such loops; at any time, a thread is within at most one pass of each depth. If
// a pass throws, no further ones begin, and the exception is rethrown here.
void for_each(std::size_t count, const std::function<void(std::size_t)>& pass);

// The same for ranges of `together` numbers below `count`: range(first, end).
void for_ranges(std::size_t count, std::size_t together,
                const std::function<void(std::size_t first, std::size_t end)>& range);

}  // namespace rlpc
