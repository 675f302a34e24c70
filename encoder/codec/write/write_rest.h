// 6.12.4: positions in an order of their own, writing side.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/rest_order.h"
#include "common/codec/rest/counterparts.h"
#include "common/codec/rest/rest_contexts.h"
#include "common/codec/rest/rest_shape.h"

namespace rlpc {

// 6.11 rest_order( exact )
inline void write_rest_settings(BitWriter& w, const RestSettings& rest) {
  w.flag(rest.order_flag);
  if (!rest.order_flag) return;
  w.u(kRestWeightBits, static_cast<std::uint32_t>(rest.edge_weight));
  w.u(kRestWeightBits, static_cast<std::uint32_t>(rest.ring_weight));
  w.flag(rest.axes_flag);
  w.flag(rest.counterparts_flag);
}

// Writes vertex by vertex, in the order: start(), counterpart() if there are counterparts,
// finish(). Section: a SectionWriter, or a class that counts bits.
class RestWriter {
 public:
  // The order must outlive it.
  explicit RestWriter(const RestOrder& order)
      : order_(order), counterparts_(order), contexts_(order) {}

  void start(std::uint32_t v) {
    v_ = v;
    used_ = false;
    counterparts_.start(v);
  }

  template <class Section>
  void counterpart(Section& section, const Counterpart& choice) {
    write_counterpart(section, choice);
    used_ = choice.flag || choice.new_flag;
    if (choice.new_flag) counterparts_.set_new(choice);
  }

  template <class Section>
  void finish(Section& section, const Vec3i& residual) {
    counterparts_.finish(used_);
    write_residual(section, counterparts_.class_of(v_), residual, contexts_);
  }

  // Replace counterpart() and finish() for a section that only estimates.
  template <class Section>
  void estimate_counterpart(Section& section, const Counterpart& choice) {
    write_counterpart(section, choice);
  }
  template <class Section>
  void estimate_residual(Section& section, bool used, const Vec3i& residual) {
    const RestClass without =
        order_.hinges(v_).empty() ? RestClass::kNoHinge : RestClass::kHinges;
    const RestContexts::Means before = contexts_.means();
    write_residual(section, used ? RestClass::kCounterpart : without, residual, contexts_);
    contexts_.set_means(before);
  }

  const Counterparts& counterparts() const { return counterparts_; }

 private:
  template <class Section>
  void write_counterpart(Section& section, const Counterpart& choice) {
    const std::size_t num_hinges = order_.hinges(v_).size();
    const bool inherited = counterparts_.is_inherited();
    if (inherited) {
      section.bin(flags_.counterpart_flag[counterparts_.context()], choice.flag);
    }
    if (choice.flag || num_hinges == 0 || counterparts_.num_listed() == 0) return;
    section.bin(flags_.new_counterpart_flag[inherited ? 1 : 0], choice.new_flag);
    if (!choice.new_flag) return;
    section.bypass(ceil_log2(num_hinges), choice.hinge);
    section.bypass(ceil_log2(counterparts_.num_listed()), choice.idx);
    section.bypass(1, choice.mirrored ? 1U : 0U);
  }
  template <class Section>
  void write_residual(Section& section, RestClass rest_class, const Vec3i& residual,
                      RestContexts& contexts) {
    contexts.start(v_, rest_class, counterparts_);
    for (std::size_t c = 0; c < kRestFactors; ++c) {
      section.residual(models_[static_cast<std::size_t>(rest_class)], contexts.expected(c),
                       residual[c]);
      contexts.update(c, residual[c]);
    }
  }

  const RestOrder& order_;
  RestModels models_;
  Counterparts counterparts_;
  CounterpartModels flags_;
  RestContexts contexts_;
  std::uint32_t v_ = 0;
  bool used_ = false;
};

}  // namespace rlpc
