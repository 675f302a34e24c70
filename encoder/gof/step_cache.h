// What is made for a step and serves again for the same one.
#pragma once

#include <optional>
#include <utility>

namespace rlpc {

// Holds one value, which is large: it goes before the next is made.
template <class T>
class StepCache {
 public:
  // The value for a step: what make() returns, unless it is there.
  template <class Make>
  const T& get(double step, const Make& make) {
    if (!has(step)) {
      release();
      put(step, make());
    }
    return *last();
  }
  void put(double step, T value) { held_.emplace(step, std::move(value)); }
  void release() { held_.reset(); }
  bool has(double step) const { return held_ && held_->first == step; }
  // Null: none.
  const T* last() const { return held_ ? &held_->second : nullptr; }

 private:
  std::optional<std::pair<double, T>> held_;
};

}  // namespace rlpc
