// Cut-border machine of clause 8.7: the border between the triangles decoded so far and the
// rest. Parser and writer drive the same machine, so that both see the same states and
// contexts.
//
// The border consists of closed loops of nodes. A node represents the directed edge from its
// vertex to the vertex of the next node, in the orientation of the triangle not yet decoded on
// that edge. Every operation takes constant time. Memory is a few words per node; there are at
// most three nodes per component plus one per new vertex or join.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

class CutBorder {
 public:
  explicit CutBorder(std::uint32_t urgent_degree) : urgent_degree_(urgent_degree) {}

  // Reserves memory for the nodes of triangles that are each a separate component.
  void reserve(std::uint32_t num_triangles) { nodes_.reserve(3 * std::size_t{num_triangles}); }

  // 8.7.3 SelectGate( ): returns false if no edge is left, so that a new component must start.
  bool select_gate();

  // 8.7.4 StartComponent( v0, v1, v2 ): three nodes, for the edges (v0, v2), (v2, v1), (v1,
  // v0).
  Triangle start_component(std::uint32_t v0, std::uint32_t v1, std::uint32_t v2);

  // 8.7.5 Operations on the gate; all but the first return the triangle that they decode.
  void mark_boundary() { nodes_[gate_].boundary = true; }
  Triangle add_vertex(std::uint32_t v);  // the last node is new, on the edge (v, to)
  Triangle close_loop();                 // requires can_close( )
  Triangle glue_previous();              // requires can_glue_previous( )
  Triangle glue_next();                  // requires can_glue_next( )
  Triangle join(std::uint32_t target);   // requires is_join_target( target ); as add_vertex( )

  // 8.7.6 Walk( forward, distance ): returns the node `distance` steps after the end of the
  // gate, or before the gate; distance >= 1.
  std::uint32_t walk(bool forward, std::uint32_t distance) const;
  bool is_join_target(std::uint32_t node) const {
    return node < num_nodes() && nodes_[node].alive && node != gate_ && node != next(gate_);
  }

  bool can_glue_previous() const { return !nodes_[previous(gate_)].boundary && !has_length(2); }
  bool can_glue_next() const { return !nodes_[next(gate_)].boundary && !has_length(2); }
  bool can_close() const { return has_length(3) && can_glue_previous() && can_glue_next(); }

  std::uint32_t gate() const { return gate_; }
  std::uint32_t num_nodes() const { return static_cast<std::uint32_t>(nodes_.size()); }
  std::uint32_t next(std::uint32_t node) const { return nodes_[node].next; }
  std::uint32_t previous(std::uint32_t node) const { return nodes_[node].previous; }
  std::uint32_t vertex(std::uint32_t node) const { return nodes_[node].vertex; }
  bool is_boundary(std::uint32_t node) const { return nodes_[node].boundary; }
  // Returns the number of triangles decoded so far at the vertex of a node.
  std::uint32_t degree(std::uint32_t node) const { return degree_[nodes_[node].vertex]; }

 private:
  struct Node {
    std::uint32_t vertex = 0;
    std::uint32_t next = 0;
    std::uint32_t previous = 0;
    bool alive = true;
    bool boundary = false;
    bool urgent = false;  // whether it has been added to urgent_
  };

  bool has_length(int n) const;
  bool is_gate(std::uint32_t node) const {
    return nodes_[node].alive && !nodes_[node].boundary;
  }
  std::uint32_t new_node(std::uint32_t v);
  void link(std::uint32_t node, std::uint32_t next_node);
  Triangle count_triangle(std::uint32_t v0, std::uint32_t v1, std::uint32_t v2);
  void touch(std::uint32_t node);

  Vector<Node> nodes_;  // in order of creation, including removed ones
  Vector<std::uint32_t> degree_;
  Vector<std::uint32_t> urgent_;
  std::size_t first_urgent_ = 0;
  std::uint32_t oldest_ = 0;
  std::uint32_t urgent_degree_;
  std::uint32_t gate_ = 0;
};

}  // namespace rlpc
