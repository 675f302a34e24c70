#include "conformance/rlpcval/validator_checks.h"

#include "common/codec/rest/rest_shape.h"

namespace rlpc {

std::string at_most(std::uint64_t limit) { return "at most " + std::to_string(limit); }
std::string between(std::int64_t low, std::int64_t high) {
  return std::to_string(low) + " to " + std::to_string(high) + " are allowed";
}
std::string level_allows(std::uint32_t level_idc, std::uint64_t limit, const char* what) {
  return "level " + std::to_string(level_idc) + " allows " + std::to_string(limit) + what;
}

bool check_alignment(ElementReader& r) {
  const std::uint64_t failures = r.failures();
  r.byte_alignment();
  return r.readable() && r.failures() == failures;
}

// 6.11 rest_order( exact )
void read_rest_order(ElementReader& r) {
  if (r.u(1, "rest_order_flag") == 0) return;
  (void)r.u(kRestWeightBits, "rest_edge_weight");
  (void)r.u(kRestWeightBits, "rest_ring_weight");
  (void)r.u(1, "rest_axes_flag");
  (void)r.u(1, "rest_counterparts_flag");
}

// 6.11 layer_groups( ). Returns false if its end is not known.
bool check_layer_groups(ElementReader& r, std::uint32_t num_layers,
                        std::uint32_t& layer_groups) {
  const std::int64_t groups = r.ue("num_layer_groups_minus1") + 1;
  if (num_layers == 0) return false;
  const std::string has = "the mesh has " + std::to_string(num_layers) + " layers";
  if (!r.require(groups <= num_layers, "R-BON-03", has)) return false;
  std::int64_t left = num_layers;
  for (std::int64_t after = groups - 1; after > 0; --after) {
    left -= r.ue("layer_group_layers_minus1") + 1;
    const std::string due = has + "; " + std::to_string(after) + " of " +
                            std::to_string(groups) + " layer groups are to follow";
    if (!r.require(left >= after, "R-BON-03", due)) return false;
  }
  layer_groups = static_cast<std::uint32_t>(groups);
  return r.readable();
}

}  // namespace rlpc
