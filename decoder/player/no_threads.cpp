// Replaces decoder/recon/async.cpp in the player, which has a single decoding thread and no
// exceptions.
#include <future>

#include "decoder/recon/async.h"

namespace rlpc {

std::future<bool> run_async(std::function<void()> /*work*/) {
  std::promise<bool> none;
  none.set_value(false);
  return none.get_future();
}

ForEach on_threads(std::uint32_t /*threads*/) { return in_order; }

}  // namespace rlpc
