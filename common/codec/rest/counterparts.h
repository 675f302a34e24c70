// 8.18.4 Counterparts: vertices whose surroundings have nearly the shape of earlier
// surroundings, possibly mirrored. They follow from connectivity and coded elements, not from
// positions.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "common/codec/mesh/rest_order.h"
#include "common/codec/rest/rest_shape.h"
#include "common/memory/owned.h"

namespace rlpc {

// Prediction of a vertex; 9.8.5 has models for each class.
enum class RestClass : std::uint8_t { kHinges, kCounterpart, kNoHinge };
inline constexpr std::size_t kRestClasses = 3;

// Hinge of a vertex, and the hinge of its counterpart; mirrored: a corresponds to b.
struct HingePair {
  Hinge own;
  Hinge other;
  bool mirrored;
};

struct HingePairs {
  std::array<HingePair, kMaxRestHinges> list{};
  std::size_t size = 0;
  std::uint32_t counterpart = 0;
};

// 8.18.4 Counterparts: InheritCounterpart( v ). passed_on( u ): the counterpart that u passes
// on.
template <class PassedOn>
HingePairs inherited_pairs(const RestOrder& order, std::uint32_t v, PassedOn passed_on) {
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  HingePairs pairs;
  for (const Hinge& own : order.hinges(v)) {
    Hinge other{passed_on(own.a), passed_on(own.b), passed_on(own.c)};
    if (other.a == kNone || other.b == kNone || other.c == kNone) continue;
    const auto found = order.across(other);
    if (!found || order.place(found->vertex) >= order.place(v)) continue;
    if (pairs.size > 0 && found->vertex != pairs.counterpart) continue;
    if (found->mirrored) std::swap(other.a, other.b);
    pairs.counterpart = found->vertex;
    pairs.list[pairs.size++] = {own, other, found->mirrored};
  }
  return pairs;
}

class Counterparts {
 public:
  explicit Counterparts(const RestOrder& order);

  // 8.18.4 Counterparts: InheritCounterpart( v ), for the vertices in their order.
  void start(std::uint32_t v);
  bool is_inherited() const { return pairs_.size > 0; }
  // Returns the context of counterpart_flag: the number of vertices of the first pair that have
  // counterparts.
  std::size_t context() const;
  std::size_t num_listed() const { return listed_.size(); }
  HingePairs new_pairs(const Counterpart& choice) const;
  // 8.18.4 Counterparts: NewCounterpart( v ), in place of the inherited one. choice.idx <
  // num_listed( ).
  void set_new(const Counterpart& choice);
  // 8.18.4 Counterparts: EndCounterpart( v, used )
  void finish(bool used);

  // Returns the pairs, after start() or set_new().
  const HingePairs& pairs() const { return pairs_; }
  // Counterpart that a vertex passes on; kNone: none.
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::uint32_t passed_on(std::uint32_t v) const { return counterpart_of_vertex_[v]; }
  // Returns the class of one of the vertices so far.
  RestClass class_of(std::uint32_t v) const { return class_of_vertex_[v]; }

 private:
  struct Listed {
    std::uint32_t vertex;
    std::uint8_t hinge;
  };

  const RestOrder& order_;
  Vector<std::uint32_t> counterpart_of_vertex_;  // [num_vertices]
  Vector<RestClass> class_of_vertex_;            // [num_vertices]
  Vector<Listed> listed_;                        // HingeList
  // State of the current vertex.
  std::uint32_t v_ = 0;
  HingePairs pairs_;
};

}  // namespace rlpc
