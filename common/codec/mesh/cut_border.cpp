#include "common/codec/mesh/cut_border.h"

#include <algorithm>
#include <cassert>

namespace rlpc {

// 8.7.2 NewNode( v )
std::uint32_t CutBorder::new_node(std::uint32_t v) {
  nodes_.push_back({.vertex = v});
  return num_nodes() - 1;
}

// 8.7.2 Link( n, m )
void CutBorder::link(std::uint32_t node, std::uint32_t next_node) {
  nodes_[node].next = next_node;
  nodes_[next_node].previous = node;
}

// 8.7.2 CountTriangle( a, b, c )
Triangle CutBorder::count_triangle(std::uint32_t v0, std::uint32_t v1, std::uint32_t v2) {
  const std::size_t needed = std::size_t{std::max({v0, v1, v2})} + 1;
  if (degree_.size() < needed) degree_.resize(needed);
  for (const std::uint32_t v : {v0, v1, v2}) ++degree_[v];
  return {v0, v1, v2};
}

// 8.7.3 Touch( n )
void CutBorder::touch(std::uint32_t node) {
  if (nodes_[node].urgent || degree(node) < urgent_degree_) return;
  nodes_[node].urgent = true;
  urgent_.push_back(node);
}

// 8.7.3 SelectGate( )
bool CutBorder::select_gate() {
  while (first_urgent_ < urgent_.size()) {
    gate_ = urgent_[first_urgent_];
    if (is_gate(gate_)) return true;
    ++first_urgent_;
  }
  while (oldest_ < num_nodes()) {
    gate_ = oldest_;
    if (is_gate(gate_)) return true;
    ++oldest_;
  }
  return false;
}

// 8.7.4 StartComponent( v0, v1, v2 )
Triangle CutBorder::start_component(std::uint32_t v0, std::uint32_t v1, std::uint32_t v2) {
  const std::uint32_t n0 = new_node(v0);
  const std::uint32_t n2 = new_node(v2);
  const std::uint32_t n1 = new_node(v1);
  link(n0, n2);
  link(n2, n1);
  link(n1, n0);
  const Triangle triangle = count_triangle(v0, v1, v2);
  for (const std::uint32_t n : {n0, n2, n1}) touch(n);
  return triangle;
}

// 8.7.5 AddVertex( v )
Triangle CutBorder::add_vertex(std::uint32_t v) {
  const std::uint32_t to = next(gate_);
  const std::uint32_t added = new_node(v);
  link(gate_, added);
  link(added, to);
  const Triangle triangle = count_triangle(vertex(gate_), vertex(to), v);
  for (const std::uint32_t n : {gate_, added, to}) touch(n);
  return triangle;
}

// 8.7.5 CloseLoop( )
Triangle CutBorder::close_loop() {
  assert(can_close());
  const std::uint32_t to = next(gate_);
  const std::uint32_t third = next(to);
  for (const std::uint32_t n : {gate_, to, third}) nodes_[n].alive = false;
  return count_triangle(vertex(gate_), vertex(to), vertex(third));
}

// 8.7.5 GluePrevious( )
Triangle CutBorder::glue_previous() {
  assert(can_glue_previous());
  const std::uint32_t to = next(gate_);
  const std::uint32_t third = previous(gate_);
  nodes_[gate_].alive = false;
  link(third, to);
  const Triangle triangle = count_triangle(vertex(gate_), vertex(to), vertex(third));
  for (const std::uint32_t n : {third, to}) touch(n);
  return triangle;
}

// 8.7.5 GlueNext( )
Triangle CutBorder::glue_next() {
  assert(can_glue_next());
  const std::uint32_t to = next(gate_);
  const std::uint32_t third = next(to);
  nodes_[to].alive = false;
  link(gate_, third);
  const Triangle triangle = count_triangle(vertex(gate_), vertex(to), vertex(third));
  for (const std::uint32_t n : {gate_, third}) touch(n);
  return triangle;
}

// 8.7.5 Join( t )
Triangle CutBorder::join(std::uint32_t target) {
  assert(is_join_target(target));
  const std::uint32_t to = next(gate_);
  const std::uint32_t before = previous(target);
  const std::uint32_t added = new_node(vertex(target));
  link(gate_, target);
  link(before, added);
  link(added, to);
  const Triangle triangle = count_triangle(vertex(gate_), vertex(to), vertex(target));
  for (const std::uint32_t n : {gate_, target, added, to}) touch(n);
  return triangle;
}

// 8.7.6 Walk( forward, distance )
std::uint32_t CutBorder::walk(bool forward, std::uint32_t distance) const {
  std::uint32_t node = forward ? next(gate_) : gate_;
  for (; distance > 0; --distance) node = forward ? next(node) : previous(node);
  return node;
}

// 8.7.5 HasLength( n )
bool CutBorder::has_length(int n) const {
  std::uint32_t node = gate_;
  for (int i = 0; i < n; ++i) node = next(node);
  return node == gate_;
}

}  // namespace rlpc
