// Reconstructions of skinned models, shared by the GOFs that use them.
#pragma once

#include <memory>
#include <mutex>

#include "common/codec/kinds/skinned/recon/model_recon.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/syntax/stream_context.h"
#include "common/memory/owned.h"

namespace rlpc {

class ModelRecons {
 public:
  explicit ModelRecons(const StreamContext& context) : context_(context) {}

  // 8.16.1 Decoding a skinned model. Any number of threads may call it; the first makes the
  // reconstruction, the others wait.
  std::shared_ptr<const ModelRecon> of(const std::shared_ptr<const SkinnedModel>& model);
  // Drops those of models that nobody else keeps.
  void erase_unused();

 private:
  struct Entry {
    explicit Entry(std::shared_ptr<const SkinnedModel> of) : model(std::move(of)) {}
    std::shared_ptr<const SkinnedModel> model;
    std::mutex making;
    std::shared_ptr<const ModelRecon> recon;
  };

  std::shared_ptr<Entry> entry_of(const std::shared_ptr<const SkinnedModel>& model);

  const StreamContext& context_;
  std::mutex listing_;
  Vector<std::shared_ptr<Entry>> entries_;
};

}  // namespace rlpc
