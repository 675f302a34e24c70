#include "common/codec/rest/counterparts.h"

#include <cassert>

namespace rlpc {

Counterparts::Counterparts(const RestOrder& order)
    : order_(order),
      counterpart_of_vertex_(order.num_vertices(), kNone),
      class_of_vertex_(order.num_vertices(), RestClass::kHinges) {}

void Counterparts::start(std::uint32_t v) {
  v_ = v;
  pairs_ =
      inherited_pairs(order_, v, [this](std::uint32_t u) { return counterpart_of_vertex_[u]; });
}

std::size_t Counterparts::context() const {
  const Hinge& own = pairs_.list[0].own;
  std::size_t count = 0;
  for (const std::uint32_t u : {own.a, own.b, own.c}) {
    if (class_of_vertex_[u] == RestClass::kCounterpart) ++count;
  }
  return count;
}

HingePairs Counterparts::new_pairs(const Counterpart& choice) const {
  assert(choice.idx < listed_.size());
  const Listed& listed = listed_[choice.idx];
  HingePairs pairs;
  pairs.list[0] = {order_.hinges(v_)[choice.hinge], order_.hinges(listed.vertex)[listed.hinge],
                   choice.mirrored};
  pairs.size = 1;
  pairs.counterpart = listed.vertex;
  return pairs;
}

void Counterparts::set_new(const Counterpart& choice) {
  pairs_ = new_pairs(choice);
  const HingePair& pair = pairs_.list[0];
  counterpart_of_vertex_[pair.own.a] = pair.mirrored ? pair.other.b : pair.other.a;
  counterpart_of_vertex_[pair.own.b] = pair.mirrored ? pair.other.a : pair.other.b;
  counterpart_of_vertex_[pair.own.c] = pair.other.c;
}

void Counterparts::finish(bool used) {
  const std::size_t count = order_.hinges(v_).size();
  for (std::size_t k = 0; k < count; ++k) {
    listed_.push_back({v_, static_cast<std::uint8_t>(k)});
  }
  if (used) {
    counterpart_of_vertex_[v_] = pairs_.counterpart;
    class_of_vertex_[v_] = RestClass::kCounterpart;
  } else if (count == 0) {
    class_of_vertex_[v_] = RestClass::kNoHinge;
  }
}

}  // namespace rlpc
