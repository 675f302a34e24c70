#include "decoder/codec/parse/parse_rest_residuals.h"

#include <cstddef>
#include <cstdint>

#include "common/codec/bits/int_math.h"
#include "common/codec/rest/counterparts.h"
#include "common/codec/rest/rest_contexts.h"

namespace rlpc {
namespace {

// 6.12.4 Rest residuals of a vertex: counterpart( v ). Returns whether v has a counterpart;
// false after an error.
bool parse_counterpart(SectionReader& section, std::size_t num_hinges,
                       CounterpartModels& models, Counterparts& counterparts,
                       Counterpart& choice) {
  const bool inherited = counterparts.is_inherited();
  if (inherited) {
    choice.flag =
        section.bin(models.counterpart_flag[counterparts.context()], "counterpart_flag");
    if (choice.flag) return true;
  }
  if (counterparts.num_listed() == 0) return false;
  if (!section.bin(models.new_counterpart_flag[inherited ? 1 : 0], "new_counterpart_flag")) {
    return false;
  }
  const std::uint32_t hinge = section.bypass(ceil_log2(num_hinges), "counterpart_hinge");
  if (hinge >= num_hinges) section.fail("R-RST-01", "counterpart_hinge");
  if (section.failed()) return false;
  const std::uint32_t idx =
      section.bypass(ceil_log2(counterparts.num_listed()), "counterpart_idx");
  if (idx >= counterparts.num_listed()) section.fail("R-RST-01", "counterpart_idx");
  if (section.failed()) return false;
  choice.new_flag = true;
  choice.hinge = static_cast<std::uint8_t>(hinge);
  choice.idx = idx;
  choice.mirrored = section.bypass(1, "counterpart_mirrored_flag") != 0;
  counterparts.set_new(choice);
  return true;
}

}  // namespace

RestSettings parse_rest_settings(BitReader& r, bool exact) {
  RestSettings rest;
  rest.order_flag = r.flag("rest_order_flag");
  if (!rest.order_flag) return rest;
  rest.exact_flag = exact;
  rest.edge_weight = static_cast<int>(r.u(kRestWeightBits, "rest_edge_weight"));
  rest.ring_weight = static_cast<int>(r.u(kRestWeightBits, "rest_ring_weight"));
  rest.axes_flag = r.flag("rest_axes_flag");
  rest.counterparts_flag = r.flag("rest_counterparts_flag");
  return rest;
}

void parse_rest_residuals(SectionReader& section, const RestOrder& order,
                          std::span<std::int32_t> residuals, std::span<Counterpart> choices) {
  RestModels models;
  CounterpartModels flags;
  Counterparts counterparts(order);
  RestContexts contexts(order);
  for (const std::uint32_t v : order.order()) {
    counterparts.start(v);
    const std::size_t num_hinges = order.hinges(v).size();
    bool used = false;
    if (!choices.empty() && num_hinges > 0) {
      used = parse_counterpart(section, num_hinges, flags, counterparts, choices[v]);
    }
    if (section.failed()) return;
    counterparts.finish(used);
    const RestClass rest_class = counterparts.class_of(v);
    contexts.start(v, rest_class, counterparts);
    for (std::size_t c = 0; c < kRestFactors; ++c) {
      std::int32_t& residual = residuals[v * kRestFactors + c];
      residual = section.residual(models[static_cast<std::size_t>(rest_class)],
                                  contexts.expected(c), "vertex_residual");
      contexts.update(c, residual);
    }
    section.check_overrun("vertex_residual");
    if (section.failed()) return;
  }
}

}  // namespace rlpc
