#include "decoder/codec/parse/sequence/parse_vertex_order.h"

#include "common/codec/bits/residual_models.h"
#include "common/memory/owned.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {

// 6.6 vertex_order( )
Result<Vector<std::uint32_t>> parse_vertex_order(BitReader& r, std::uint32_t num_vertices) {
  SectionReader section(r, "vertex_order");
  ResidualModels models;
  std::uint32_t mean = 0;
  std::int64_t index = 0;
  Vector<std::uint32_t> order;
  Vector<bool> taken(num_vertices, false);
  for (std::uint32_t v = 0; v < num_vertices && !section.failed(); ++v) {
    const std::int32_t delta = section.residual(models, mean >> 4, "vertex_order_delta");
    mean = update_mean(mean, magnitude_of(delta), 3);
    index += delta;
    if (index < 0 || index >= num_vertices) {
      section.fail("R-VOR-01", "vertex_order_delta");
      break;
    }
    if (taken[static_cast<std::size_t>(index)]) section.fail("R-VOR-02", "vertex_order_delta");
    taken[static_cast<std::size_t>(index)] = true;
    order.push_back(static_cast<std::uint32_t>(index));
  }
  section.finish();
  if (r.error()) return *r.error();
  return order;
}

}  // namespace rlpc
