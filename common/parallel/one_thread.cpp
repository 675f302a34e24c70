// Implements for_each.h without threads (pages in browsers).
#include "common/parallel/for_each.h"

namespace rlpc {

class ThreadPool::Impl : public Owned {};

ThreadPool::ThreadPool(std::uint32_t /*count*/) {}
ThreadPool::~ThreadPool() = default;

ThreadPool::Use::Use(ThreadPool& /*pool*/) : before_(nullptr) {}
ThreadPool::Use::~Use() { static_cast<void>(before_); }

void for_each(std::size_t count, const Pass& pass) {
  for (std::size_t i = 0; i < count; ++i) pass(i);
}

}  // namespace rlpc
