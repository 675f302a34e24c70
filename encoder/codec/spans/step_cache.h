// A cache of one value, keyed by the quantiser step that it was computed for.
#pragma once

#include <optional>
#include <utility>

namespace rlpc {

// Values are large: the old one is released before a new one is computed.
template <class T>
class StepCache {
 public:
  // Returns the value for the step, calling make() if it is not cached.
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
  double step() const { return held_->first; }  // a value must be cached
  // Returns the cached value; null if there is none.
  const T* last() const { return held_ ? &held_->second : nullptr; }

 private:
  std::optional<std::pair<double, T>> held_;
};

}  // namespace rlpc
