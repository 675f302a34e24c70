// Counts bits by purpose, for a stream and for each of its GOFs and shared rigs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "common/codec/bits/trace.h"

namespace rlpc {

inline constexpr std::size_t kNumStreamParts = 17;
using PartSizes = std::array<std::uint64_t, kNumStreamParts>;  // bits
// Bits of each part, in the order used in all tables.
const std::array<std::string_view, kNumStreamParts>& stream_part_names();

// A trace that attributes the bits from each element to the next.
class BitCounter final : public Trace {
 public:
  explicit BitCounter(bool print = false);  // print: every element, on standard output

  void begin(const char* structure, std::uint64_t bit_pos) override;
  void element(const char* name, std::int64_t value, std::uint64_t bit_pos) override;
  // To be called at the end of the stream.
  void finish(std::uint64_t bit_pos);

  const PartSizes& bits() const { return bits_; }
  std::uint64_t num_units() const { return num_units_; }
  // The bits of each GOF with its slices and hashes; valid after finish().
  const std::vector<PartSizes>& gof_bits() const { return gof_bits_; }
  // The same for each shared rig with its slices.
  const std::vector<PartSizes>& model_bits() const { return model_bits_; }

 private:
  void close(std::uint64_t bit_pos);
  void close_unit();
  void count(std::size_t part, std::uint64_t bits);

  bool print_;
  std::map<std::string_view, std::size_t> part_of_;
  PartSizes bits_{};
  std::size_t open_part_ = 0;
  bool is_unit_size_ = false;  // the last element
  std::uint8_t ancillary_bit_ = 0;
  std::uint8_t unit_type_ = 0;   // as in UnitType
  bool rest_positions_ = false;  // within a slice of rest positions
  std::size_t unit_part_ = 0;
  std::uint64_t last_ = 0;
  std::uint64_t num_units_ = 0;
  PartSizes unit_bits_{};  // of the current unit
  std::vector<PartSizes> gof_bits_;
  std::vector<PartSizes> model_bits_;
  bool of_rig_ = false;  // the last GOF or shared rig was one of the latter
};

}  // namespace rlpc
