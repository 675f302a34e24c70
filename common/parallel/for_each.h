// Loops on several threads. A result must not depend on the thread that runs a pass or on the
// number of threads: passes write to separate places, and are summed afterwards, in order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/memory/owned.h"

namespace rlpc {

// Reference to a function that is called while the caller of for_each() waits.
template <class... Args>
class FunctionRef {
 public:
  template <class F>
  FunctionRef(const F& f)  // NOLINT(google-explicit-constructor): takes any function
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
  // count: number of threads including the user's, at least 1. The system may grant fewer.
  explicit ThreadPool(std::uint32_t count);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  // Shares the passes of for_each() on the thread that made it with the threads of the pool,
  // during its lifetime. Several threads may use a pool at a time. Uses on a thread end in
  // reverse order.
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

// Pool that the thread that makes it uses during its lifetime.
class Threads {
 public:
  explicit Threads(std::uint32_t count) : pool_(count), use_(pool_) {}

 private:
  ThreadPool pool_;
  ThreadPool::Use use_;
};

// Calls pass(i) for all i < count, in any order, and returns once all are done. A pass may
// contain such loops; at any time, a thread is within at most one pass of each depth. If a pass
// throws, no further passes begin, and the exception is rethrown here.
void for_each(std::size_t count, const Pass& pass);

// Calls range(first, end) for ranges of up to `together` numbers below `count`.
inline void for_ranges(std::size_t count, std::size_t together,
                       const FunctionRef<std::size_t, std::size_t>& range) {
  for_each((count + together - 1) / together,
           [&](std::size_t i) { range(i * together, std::min((i + 1) * together, count)); });
}

}  // namespace rlpc
