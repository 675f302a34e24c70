// Finds counterparts (8.18.4) for the rest shape: earlier surroundings of nearly the same
// shape.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "common/codec/mesh/rest_order.h"
#include "common/codec/mesh/topology.h"
#include "common/codec/mesh_prediction/rest_prediction.h"
#include "common/codec/rest/counterparts.h"
#include "common/codec/rest/rest_shape.h"

namespace rlpc {

class CounterpartSearch {
 public:
  // wanted: [num_vertices][3]; both must outlive it. rest_step: 1/16 grid units.
  CounterpartSearch(const RestOrder& order, std::span<const std::int32_t> wanted,
                    std::uint32_t rest_step, int position_bits);

  struct Found {
    Counterpart choice;
    double gain = 0.0;  // estimate of the bits that it saves at later vertices
  };
  // Returns the best new counterpart of v, if there is one. Takes a bounded time on average,
  // and less where few vertices have counterparts: after a long search, none is found for some
  // vertices.
  std::optional<Found> find(std::uint32_t v, const Counterparts& counterparts);
  // Adds v, once it has been coded, after the search at v. used: it has a counterpart
  void add(std::uint32_t v, bool used);

 private:
  struct Entry {
    std::uint32_t vertex;
    std::uint8_t hinge;
    std::uint32_t idx;
  };
  // Lengths that are the same in mirrored shapes, in cells.
  struct Cell {
    std::int64_t edge;
    std::int64_t diagonal;
  };

  double distance(std::uint32_t u, std::uint32_t v) const;
  Cell cell_of(std::uint32_t v, const Hinge& hinge) const;
  static std::uint64_t key_of(const Cell& cell);
  bool has_shape_of(std::uint32_t v, const Hinge& own, const Entry& entry, bool mirrored) const;
  double error_of(std::uint32_t v, const HingePairs& pairs);
  double growth(std::uint32_t v, const HingePairs& pairs, const Counterparts& counterparts);

  const RestOrder& order_;
  std::span<const std::int32_t> wanted_;
  double step_;
  RestPrediction prediction_;
  ListOfLists<std::uint32_t> dependents_;  // [v]: vertices with v in a hinge
  std::unordered_map<std::uint64_t, std::vector<Entry>> cells_;
  std::uint32_t num_listed_ = 0;
  std::int64_t allowance_ = 0;  // number of predictions that may be made; may fall below 0
  double used_part_ = 1.0;      // part of the last vertices that have counterparts
  // Work space of growth(); kNone between calls.
  std::vector<std::uint32_t> assumed_;  // [num_vertices]
  std::vector<std::uint8_t> seen_;      // [num_vertices]
};

}  // namespace rlpc
