#include "decoder/parse_vertex_order.h"

#include "common/range_decoder.h"
#include "common/residual_models.h"
#include "decoder/parse_residual.h"

namespace rlpc {

// 6.6 vertex_order( )
Result<std::vector<std::uint32_t>> parse_vertex_order(BitReader& r,
                                                      std::uint32_t num_vertices) {
  const std::uint64_t first_bit = r.bit_pos();
  RangeDecoder rd(r.remaining_bytes());
  const auto fail = [&](const char* rule, const char* element) {
    r.fail(Errc::kInvalid, rule, element, first_bit + rd.bits_spent());
    return *r.error();
  };
  if (!rd.starts_legally()) return fail("R-RNG-02", "vertex_order");
  ResidualModels models;
  std::uint32_t mean = 0;
  std::int64_t index = 0;
  std::vector<std::uint32_t> order;
  std::vector<bool> taken(num_vertices, false);
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    const std::uint64_t at = first_bit + rd.bits_spent();
    const std::int32_t delta = parse_residual(rd, models, mean >> 4);
    mean = update_mean(mean, magnitude_of(delta), 3);
    if (r.trace() != nullptr) r.trace()->element("vertex_order_delta", delta, at);
    index += delta;
    if (index < 0 || index >= num_vertices) return fail("R-VOR-01", "vertex_order_delta");
    if (taken[static_cast<std::size_t>(index)]) return fail("R-VOR-02", "vertex_order_delta");
    taken[static_cast<std::size_t>(index)] = true;
    order.push_back(static_cast<std::uint32_t>(index));
  }
  if (!rd.at_exact_end()) return fail("R-RNG-01", "vertex_order");
  return order;
}

}  // namespace rlpc
