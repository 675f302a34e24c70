// Reconstructions of shared rigs, shared by the GOFs that use them.
#pragma once

#include <memory>
#include <mutex>

#include "common/codec/kinds/skinned/recon/rig_recon.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/syntax/stream_context.h"
#include "common/memory/owned.h"

namespace rlpc {

class RigRecons {
 public:
  explicit RigRecons(const StreamContext& context) : context_(context) {}

  // 8.16.1 Decoding a shared rig. Any number of threads may call it; the first one makes the
  // reconstruction, the others wait.
  std::shared_ptr<const RigRecon> of(const std::shared_ptr<const SharedRig>& rig);
  // Drops the reconstructions of rigs that have no other owner.
  void erase_unused();

 private:
  struct Entry {
    explicit Entry(std::shared_ptr<const SharedRig> of) : rig(std::move(of)) {}
    std::shared_ptr<const SharedRig> rig;
    std::mutex making;
    std::shared_ptr<const RigRecon> recon;
  };

  std::shared_ptr<Entry> entry_of(const std::shared_ptr<const SharedRig>& rig);

  const StreamContext& context_;
  std::mutex listing_;
  Vector<std::shared_ptr<Entry>> entries_;
};

}  // namespace rlpc
