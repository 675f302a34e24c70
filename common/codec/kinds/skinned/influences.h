// 8.13 Influences of a vertex: predicts them from its ring. The parser and the writer drive it
// in the same way.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/memory/owned.h"

namespace rlpc {

// Processes from StartInfluences( ) to EndInfluences( ), for vertex after vertex.
class InfluencePrediction {
 public:
  // influences [num_vertices]: set for the preceding vertices; must outlive the object.
  InfluencePrediction(std::span<const Influences> influences, std::uint32_t num_bones,
                      int weight_bits)
      : influences_(influences), num_bones_(num_bones), total_(1 << weight_bits) {}

  void start(std::span<const std::uint32_t> ring);  // must stay valid until finish()

  // Extra bones are bones that are not candidates.
  bool can_add_bone() const {
    return num_extra_ < kMaxExtraBones && left_ > 0 &&
           static_cast<std::size_t>(num_extra_) + candidates_.size() < num_bones_;
  }
  bool is_new_bone(std::uint32_t bone) const;
  int num_extra_bones() const { return num_extra_; }
  int weight_left() const { return left_; }
  void add_extra_bone(std::uint32_t bone, int weight);  // 0 < weight <= weight_left()

  // Candidates 1 to num_candidates() - 1, in order; the first one gets the remaining weight.
  std::size_t num_candidates() const { return candidates_.size(); }
  std::uint16_t candidate(std::size_t k) const { return candidates_[k].bone; }
  bool has_residual() const { return left_ > 0 && found_.size < kMaxInfluences - 1; }
  // 9.8.3 Expected magnitude of a weight residual.
  std::uint32_t expected(std::size_t k) const;
  int candidate_mean(std::size_t k) const;
  void add_candidate(std::size_t k, std::int32_t residual);

  Influences finish();

 private:
  struct Candidate {
    std::uint16_t bone;
    std::int64_t sum;  // sum of its weights in the ring
  };

  void add_influence(std::uint32_t bone, std::int64_t weight);

  std::span<const Influences> influences_;
  std::size_t num_bones_;
  int total_;
  std::span<const std::uint32_t> ring_;
  Vector<Candidate> candidates_;
  Influences found_;
  int num_extra_ = 0;
  int left_ = 0;
  std::uint32_t magnitude_before_ = 0;  // magnitude of the previous residual, 8 fractional bits
};

}  // namespace rlpc
