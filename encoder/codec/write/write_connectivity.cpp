#include "encoder/codec/write/write_connectivity.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/bits/range_encoder.h"
#include "common/codec/mesh/connectivity_models.h"
#include "common/codec/mesh/cut_border.h"
#include "encoder/codec/write/half_edges.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kNone = HalfEdges::kNone;

// Values that are all tried. Small ones suit irregular meshes, large ones grids and subdivided
// meshes.
constexpr std::array<std::uint32_t, 4> kUrgentDegrees{3, 4, 5, 6};

bool is_degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

struct Input {
  std::uint32_t num_vertices = 0;
  std::vector<Triangle> regular;
  std::vector<Triangle> degenerate;
  HalfEdges half_edges;       // made from the triangles in `regular`
  bool vertex_reuse = false;  // whether any vertex has several instances
};

Input analyse_input(std::uint32_t num_vertices, std::span<const Triangle> triangles) {
  Input input;
  input.num_vertices = num_vertices;
  std::vector<bool> used(num_vertices);
  for (const Triangle& t : triangles) {
    assert(std::max({t[0], t[1], t[2]}) < num_vertices);
    (is_degenerate(t) ? input.degenerate : input.regular).push_back(t);
    if (!is_degenerate(t)) used[t[0]] = used[t[1]] = used[t[2]] = true;
  }
  input.half_edges = build_half_edges(num_vertices, input.regular);
  const auto num_used = std::count(used.begin(), used.end(), true);
  input.vertex_reuse = input.half_edges.num_instances > static_cast<std::uint64_t>(num_used);
  return input;
}

class ConnectivityWriter {
 public:
  ConnectivityWriter(const Input& input, std::uint32_t urgent_degree);
  ConnectivityCode write();

 private:
  void write_header();
  void component_start();
  void gate();
  bool can_add_vertex() const {
    return input_.vertex_reuse || code_.input_vertex.size() < input_.num_vertices;
  }
  std::uint32_t vertex_instance(std::uint32_t corner);
  void join_target(std::uint32_t target);
  void degenerate_triangle(const Triangle& triangle);

  std::uint32_t find_target(std::uint32_t third) const;
  void cover(std::uint32_t node, std::uint32_t decoded_half_edge);
  void number_leftover_vertices();

  const Input& input_;
  const HalfEdges& mesh_;
  std::uint32_t urgent_degree_;
  RangeEncoder re_;
  CutBorder border_;
  ConnectivityModels models_;
  ConnectivityCode code_;
  std::vector<std::uint32_t> decoded_vertex_;  // [input vertex]
  std::vector<bool> instance_decoded_;         // [vertex instance]
  std::vector<bool> triangle_decoded_;         // [regular triangle]
  std::vector<std::uint32_t> half_edge_of_;    // [node], the half-edge on its edge
  std::vector<std::uint32_t> node_of_;         // [half-edge], the inverse where known
  std::uint32_t first_open_triangle_ = 0;
};

ConnectivityWriter::ConnectivityWriter(const Input& input, std::uint32_t urgent_degree)
    : input_(input),
      mesh_(input.half_edges),
      urgent_degree_(urgent_degree),
      border_(urgent_degree),
      decoded_vertex_(input.num_vertices, kNone),
      instance_decoded_(input.half_edges.num_instances),
      triangle_decoded_(input.regular.size()),
      node_of_(3 * input.regular.size(), kNone) {}

// 6.4.1 connectivity( )
void ConnectivityWriter::write_header() {
  BitWriter w;
  w.ue(static_cast<std::uint32_t>(input_.degenerate.size()));
  w.u(4, urgent_degree_);
  w.u(1, input_.vertex_reuse ? 1 : 0);
  w.byte_alignment();
  code_.payload = w.take();
}

// 6.4.2 connectivity_section( )
ConnectivityCode ConnectivityWriter::write() {
  write_header();
  while (code_.triangles.size() < input_.regular.size()) {
    if (border_.select_gate()) {
      gate();
    } else {
      component_start();
    }
  }
  number_leftover_vertices();
  for (const Triangle& triangle : input_.degenerate) degenerate_triangle(triangle);
  const std::vector<std::uint8_t> section = re_.finish();
  code_.payload.insert(code_.payload.end(), section.begin(), section.end());
  return std::move(code_);
}

// 6.4.3 component_start( )
void ConnectivityWriter::component_start() {
  while (triangle_decoded_[first_open_triangle_]) ++first_open_triangle_;
  const std::uint32_t h = 3 * first_open_triangle_;
  const std::uint32_t v0 = vertex_instance(h);
  const std::uint32_t v1 = vertex_instance(h + 1);
  const std::uint32_t v2 = vertex_instance(h + 2);
  const std::uint32_t first_node = border_.num_nodes();
  code_.triangles.push_back(border_.start_component(v0, v1, v2));
  triangle_decoded_[first_open_triangle_] = true;
  cover(first_node, h + 2);
  cover(first_node + 1, h + 1);
  cover(first_node + 2, h);
}

// 6.4.4 gate( )
void ConnectivityWriter::gate() {
  const GateContexts ctx = gate_contexts(border_);
  const std::uint32_t gate = border_.gate();
  const std::uint32_t before = border_.previous(gate);
  const std::uint32_t h = half_edge_of_[gate];
  re_.bin(models_.boundary_flag[ctx.boundary_flag], h == kNone);
  if (h == kNone) return border_.mark_boundary();

  const std::uint32_t h_next = next_corner(h);
  const std::uint32_t h_third = previous_corner(h);  // starts at the third corner
  const bool glue_next = border_.can_glue_next() && half_edge_of_[border_.next(gate)] == h_next;
  const bool glue_previous = border_.can_glue_previous() && half_edge_of_[before] == h_third;
  const bool close = glue_next && glue_previous;
  const bool new_vertex = !instance_decoded_[mesh_.instance[h_third]];
  triangle_decoded_[h / 3] = true;
  if (border_.can_close()) {
    re_.bin(models_.close_flag[ctx.close_flag], close);
    if (close) return code_.triangles.push_back(border_.close_loop());
  }
  assert(!close);
  if (can_add_vertex()) {
    re_.bin(models_.new_vertex_flag[ctx.new_vertex_flag], new_vertex);
    if (new_vertex) {
      code_.triangles.push_back(border_.add_vertex(vertex_instance(h_third)));
      cover(gate, h_third);
      return cover(border_.num_nodes() - 1, h_next);
    }
  }
  assert(!new_vertex);
  if (border_.can_glue_previous()) {
    re_.bin(models_.glue_previous_flag[ctx.glue_previous_flag], glue_previous);
    if (glue_previous) {
      code_.triangles.push_back(border_.glue_previous());
      return cover(before, h_next);
    }
  }
  if (border_.can_glue_next()) {
    re_.bin(models_.glue_next_flag[ctx.glue_next_flag], glue_next);
    if (glue_next) {
      code_.triangles.push_back(border_.glue_next());
      return cover(gate, h_third);
    }
  }
  const std::uint32_t target = find_target(h_third);
  join_target(target);
  code_.triangles.push_back(border_.join(target));
  cover(gate, h_third);
  cover(border_.num_nodes() - 1, h_next);
}

// 6.4.5 vertex_instance( )
std::uint32_t ConnectivityWriter::vertex_instance(std::uint32_t corner) {
  const std::uint32_t input_index = input_.regular[corner / 3][corner % 3];
  const auto num_coded_vertices = static_cast<std::uint32_t>(code_.input_vertex.size());
  std::uint32_t& v = decoded_vertex_[input_index];
  const bool reused = v != kNone;
  instance_decoded_[mesh_.instance[corner]] = true;
  if (input_.vertex_reuse && num_coded_vertices > 0 &&
      num_coded_vertices < input_.num_vertices) {
    re_.bin(models_.vertex_reused_flag, reused);
  }
  if (reused) {
    re_.bypass(ceil_log2(num_coded_vertices), v);
  } else {
    v = num_coded_vertices;
    code_.input_vertex.push_back(input_index);
  }
  return v;
}

// 6.4.6 join_target( )
void ConnectivityWriter::join_target(std::uint32_t target) {
  std::uint32_t distance = 1;
  std::uint32_t ahead = border_.walk(true, distance);
  std::uint32_t behind = border_.walk(false, distance);
  while (distance < kMaxJoinDistance && ahead != target && behind != target) {
    ahead = border_.next(ahead);
    behind = border_.previous(behind);
    ++distance;
  }
  const bool forward = ahead == target;
  const bool far = !forward && behind != target;
  re_.bin(models_.far_join_flag, far);
  if (far) return re_.bypass(ceil_log2(border_.num_nodes()), target);
  re_.bin(models_.forward_join_flag, forward);
  const int prefix = floor_log2(distance);
  auto& prefix_models = models_.join_prefix_flag[forward ? 1 : 0];
  for (int i = 0; i < prefix; ++i) re_.bin(prefix_models[static_cast<std::size_t>(i)], true);
  if (prefix < kMaxJoinPrefix) {
    re_.bin(prefix_models[static_cast<std::size_t>(prefix)], false);
  }
  if (prefix == 0) return;
  const int rest = prefix - 1;
  re_.bin(models_.join_top_bit[static_cast<std::size_t>(prefix)],
          ((distance >> rest) & 1) != 0);
  re_.bypass(rest, distance & ((std::uint32_t{1} << rest) - 1));
}

// 6.4.7 degenerate_triangle( )
void ConnectivityWriter::degenerate_triangle(const Triangle& triangle) {
  Triangle decoded{};
  for (std::size_t i = 0; i < 3; ++i) {
    decoded[i] = decoded_vertex_[triangle[i]];
    re_.bypass(ceil_log2(input_.num_vertices), decoded[i]);
  }
  code_.triangles.push_back(decoded);
}

// Returns the border node at the vertex where half-edge `third` starts, in the part of the
// border that the triangle of `third` touches. Walks around that vertex in both directions in
// lockstep, through triangles not yet decoded.
std::uint32_t ConnectivityWriter::find_target(std::uint32_t third) const {
  std::uint32_t left = third;
  std::uint32_t right = third;
  for (;;) {
    assert(left != kNone || right != kNone);
    if (left != kNone) {
      const std::uint32_t incoming = previous_corner(left);
      if (node_of_[incoming] != kNone) return border_.next(node_of_[incoming]);
      left = mesh_.opposite[incoming];
    }
    if (right != kNone) {
      if (node_of_[right] != kNone) return node_of_[right];
      right = turn_right(mesh_, right);
    }
  }
}

// Sets the edge of a node: the one opposite to a half-edge just decoded.
void ConnectivityWriter::cover(std::uint32_t node, std::uint32_t decoded_half_edge) {
  if (half_edge_of_.size() <= node) half_edge_of_.resize(std::size_t{node} + 1, kNone);
  const std::uint32_t h = mesh_.opposite[decoded_half_edge];
  half_edge_of_[node] = h;
  if (h != kNone) node_of_[h] = node;
}

// Numbers the vertices without a regular triangle last, in input order.
void ConnectivityWriter::number_leftover_vertices() {
  for (std::uint32_t i = 0; i < input_.num_vertices; ++i) {
    if (decoded_vertex_[i] != kNone) continue;
    decoded_vertex_[i] = static_cast<std::uint32_t>(code_.input_vertex.size());
    code_.input_vertex.push_back(i);
  }
}

}  // namespace

ConnectivityCode write_connectivity(std::uint32_t num_vertices,
                                    std::span<const Triangle> triangles) {
  const Input input = analyse_input(num_vertices, triangles);
  ConnectivityCode best;
  for (const std::uint32_t urgent_degree : kUrgentDegrees) {
    ConnectivityCode code = ConnectivityWriter(input, urgent_degree).write();
    if (best.payload.empty() || code.payload.size() < best.payload.size()) {
      best = std::move(code);
    }
  }
  return best;
}

}  // namespace rlpc
