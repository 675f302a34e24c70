// Catches exceptions, which would end the program if they left the thread.
#include "decoder/codec/gofs/async.h"

#include <utility>

#include "common/memory/owned.h"

namespace rlpc {

std::future<bool> run_async(std::function<void()> work) {
  try {
    return std::async(std::launch::async, [work = std::move(work), owner = current_owner()] {
      const OwnerScope scope(owner);
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

}  // namespace rlpc
