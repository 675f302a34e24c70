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
// Returns the names of the parts, in the order of all tables.
const std::array<std::string_view, kNumStreamParts>& stream_part_names();

// Trace that attributes the bits from each element to the next.
class BitCounter final : public Trace {
 public:
  explicit BitCounter(bool print = false);  // print: writes every element to standard output

  void begin(const char* structure, std::uint64_t bit_pos) override;
  void element(const char* name, std::int64_t value, std::uint64_t bit_pos) override;
  // Ends the count. Must be called at the end of the stream.
  void finish(std::uint64_t bit_pos);

  const PartSizes& bits() const { return bits_; }
  std::uint64_t num_units() const { return num_units_; }
  // Returns the bits of each GOF with its slices and hashes; valid after finish().
  const std::vector<PartSizes>& gof_bits() const { return gof_bits_; }
  // Returns the bits of each shared rig with its slices; valid after finish().
  const std::vector<PartSizes>& model_bits() const { return model_bits_; }

 private:
  void close(std::uint64_t bit_pos);
  void close_unit();
  void count(std::size_t part, std::uint64_t bits);

  bool print_;
  std::map<std::string_view, std::size_t> part_of_;
  PartSizes bits_{};
  std::size_t open_part_ = 0;
  bool is_unit_size_ = false;  // whether the last element was unit_size
  std::uint8_t ancillary_bit_ = 0;
  std::uint8_t unit_type_ = 0;   // UnitType
  bool rest_positions_ = false;  // whether in a slice of rest positions
  std::size_t unit_part_ = 0;
  std::uint64_t last_ = 0;
  std::uint64_t num_units_ = 0;
  PartSizes unit_bits_{};  // bits of the current unit
  std::vector<PartSizes> gof_bits_;
  std::vector<PartSizes> model_bits_;
  bool in_rig_ = false;  // whether the last GOF or shared rig is a shared rig
};

}  // namespace rlpc
