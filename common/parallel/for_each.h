// Loops on several threads. A result must not depend on which thread runs which pass, nor on
// how many threads there are: passes write to places of their own, and sums over them are made
// afterwards, in order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/memory/owned.h"

namespace rlpc {

// A function that is called while the caller of for_each() waits: it is not copied.
template <class... Args>
class FunctionRef {
 public:
  template <class F>
  FunctionRef(const F& f)  // NOLINT(google-explicit-constructor): any function will do
      : function_(&f), call_([](const void* function, Args... args) {
          (*static_cast<const F*>(function))(args...);
        }) {}
  void operator()(Args... args) const { call_(function_, args...); }

 private:
  const void* function_;
  void (*call_)(const void* function, Args... args);
};
using Pass = FunctionRef<std::size_t>;

// Threads that share the passes of loops.
class ThreadPool {
  class Impl;

 public:
  // count: threads in all, at least 1, one of them the user's. Where the system grants fewer,
  // there are fewer.
  explicit ThreadPool(std::uint32_t count);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  // While it exists, for_each() on the thread that made it shares its passes with the threads
  // of the pool. Several threads may use a pool at a time. Uses on a thread end in reverse
  // order.
  class Use {
   public:
    explicit Use(ThreadPool& pool);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    Impl* before_;
  };

 private:
  friend void for_each(std::size_t count, const Pass& pass);

  std::unique_ptr<Impl> impl_;
};

// A pool that is used by the thread that makes it, as long as it exists.
class Threads {
 public:
  explicit Threads(std::uint32_t count) : pool_(count), use_(pool_) {}

 private:
  ThreadPool pool_;
  ThreadPool::Use use_;
};

// Calls pass(i) for all i < count, in any order, and returns once all are done. A pass may
// itself contain such loops; at any time, a thread is within at most one pass of each depth. If
// a pass throws, no further ones begin, and the exception is rethrown here.
void for_each(std::size_t count, const Pass& pass);

// The same for ranges of `together` numbers below `count`: range(first, end).
inline void for_ranges(std::size_t count, std::size_t together,
                       const FunctionRef<std::size_t, std::size_t>& range) {
  for_each((count + together - 1) / together,
           [&](std::size_t i) { range(i * together, std::min((i + 1) * together, count)); });
}

}  // namespace rlpc
