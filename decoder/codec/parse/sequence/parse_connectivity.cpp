#include "decoder/codec/parse/sequence/parse_connectivity.h"

#include <cassert>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/codec/mesh/connectivity_models.h"
#include "common/codec/mesh/cut_border.h"
#include "common/memory/owned.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {
namespace {

// Parses the range-coder section of the connectivity unit. Errors are sticky: nothing is
// decoded after the first.
class ConnectivityParser {
 public:
  ConnectivityParser(BitReader& r, std::uint32_t num_vertices, std::uint32_t urgent_degree,
                     bool vertex_reuse)
      : section_(r, "connectivity_section"),
        num_vertices_(num_vertices),
        vertex_reuse_(vertex_reuse),
        border_(urgent_degree) {}

  Vector<Triangle> parse(std::uint32_t num_regular, std::uint32_t num_degenerate);

 private:
  bool failed() const { return section_.failed(); }
  void component_start();
  void gate();
  bool can_add_vertex() const { return vertex_reuse_ || num_coded_vertices_ < num_vertices_; }
  std::uint32_t vertex_instance();
  std::uint32_t join_target();
  Triangle degenerate_triangle();

  SectionReader section_;
  std::uint32_t num_vertices_;
  bool vertex_reuse_;
  CutBorder border_;
  ConnectivityModels models_;
  std::uint32_t num_coded_vertices_ = 0;
  Vector<Triangle> triangles_;
};

// 6.4.2 connectivity_section( )
Vector<Triangle> ConnectivityParser::parse(std::uint32_t num_regular,
                                           std::uint32_t num_degenerate) {
  triangles_.reserve(std::size_t{num_regular} + num_degenerate);
  border_.reserve(num_regular);
  while (!failed() && triangles_.size() < num_regular) {
    if (border_.select_gate()) {
      gate();
    } else {
      component_start();
    }
    section_.check_overrun("connectivity_section");
  }
  for (std::uint32_t i = 0; !failed() && i < num_degenerate; ++i) {
    triangles_.push_back(degenerate_triangle());
    section_.check_overrun("connectivity_section");
  }
  section_.finish();
  return std::move(triangles_);
}

// 6.4.3 component_start( )
void ConnectivityParser::component_start() {
  Triangle corners{};
  for (std::uint32_t& v : corners) {
    if (!can_add_vertex()) return section_.fail("R-CON-02", "component_start");
    v = vertex_instance();
    if (failed()) return;
  }
  triangles_.push_back(border_.start_component(corners[0], corners[1], corners[2]));
}

// 6.4.4 gate( )
void ConnectivityParser::gate() {
  const GateContexts ctx = gate_contexts(border_);
  if (section_.bin(models_.boundary_flag[ctx.boundary_flag], "boundary_flag")) {
    return border_.mark_boundary();
  }
  if (border_.can_close() && section_.bin(models_.close_flag[ctx.close_flag], "close_flag")) {
    return triangles_.push_back(border_.close_loop());
  }
  if (can_add_vertex() &&
      section_.bin(models_.new_vertex_flag[ctx.new_vertex_flag], "new_vertex_flag")) {
    const std::uint32_t v = vertex_instance();
    if (!failed()) triangles_.push_back(border_.add_vertex(v));
    return;
  }
  if (border_.can_glue_previous() &&
      section_.bin(models_.glue_previous_flag[ctx.glue_previous_flag], "glue_previous_flag")) {
    return triangles_.push_back(border_.glue_previous());
  }
  if (border_.can_glue_next() &&
      section_.bin(models_.glue_next_flag[ctx.glue_next_flag], "glue_next_flag")) {
    return triangles_.push_back(border_.glue_next());
  }
  const std::uint32_t target = join_target();
  if (!border_.is_join_target(target)) return section_.fail("R-CON-04", "join_target");
  triangles_.push_back(border_.join(target));
}

// 6.4.5 vertex_instance( )
std::uint32_t ConnectivityParser::vertex_instance() {
  bool reused = false;
  if (vertex_reuse_) {
    reused = num_coded_vertices_ == num_vertices_;
    if (num_coded_vertices_ > 0 && num_coded_vertices_ < num_vertices_) {
      reused = section_.bin(models_.vertex_reused_flag, "vertex_reused_flag");
    }
  }
  if (!reused) return num_coded_vertices_++;
  const std::uint32_t v = section_.bypass(ceil_log2(num_coded_vertices_), "reused_vertex");
  if (v >= num_coded_vertices_) {
    section_.fail("R-CON-03", "reused_vertex");
    return 0;
  }
  return v;
}

// 6.4.6 join_target( )
std::uint32_t ConnectivityParser::join_target() {
  if (section_.bin(models_.far_join_flag, "far_join_flag")) {
    return section_.bypass(ceil_log2(border_.num_nodes()), "join_node");
  }
  const bool forward = section_.bin(models_.forward_join_flag, "forward_join_flag");
  auto& prefix_models = models_.join_prefix_flag[forward ? 1 : 0];
  std::uint32_t prefix = 0;
  while (prefix < kMaxJoinPrefix && section_.bin(prefix_models[prefix], "join_prefix_flag"))
    ++prefix;
  std::uint32_t distance = 1;
  if (prefix > 0) {
    distance = 2 + (section_.bin(models_.join_top_bit[prefix], "join_top_bit") ? 1 : 0);
    const int rest = static_cast<int>(prefix) - 1;
    distance = (distance << rest) | section_.bypass(rest, "join_low_bits");
  }
  return border_.walk(forward, distance);
}

// 6.4.7 degenerate_triangle( )
Triangle ConnectivityParser::degenerate_triangle() {
  Triangle triangle{};
  for (std::uint32_t& v : triangle) {
    v = section_.bypass(ceil_log2(num_vertices_), "degenerate_vertex");
    if (v >= num_vertices_) {
      section_.fail("R-CON-05", "degenerate_vertex");
      v = 0;
    }
  }
  return triangle;
}

}  // namespace

// 6.4.1 connectivity( )
Result<Vector<Triangle>> parse_connectivity(BitReader& r, std::uint32_t num_vertices,
                                            std::uint32_t num_triangles) {
  const std::uint32_t num_degenerate =
      r.ue("num_degenerate_triangles", {0, num_triangles}, "R-CON-01");
  const std::uint32_t urgent_degree = r.u(4, "urgent_degree");
  const bool vertex_reuse = r.flag("vertex_reuse_flag");
  r.byte_alignment();
  if (r.error()) return *r.error();
  ConnectivityParser parser(r, num_vertices, urgent_degree, vertex_reuse);
  Vector<Triangle> triangles = parser.parse(num_triangles - num_degenerate, num_degenerate);
  if (r.error()) return *r.error();
  return triangles;
}

}  // namespace rlpc
