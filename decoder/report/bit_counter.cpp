#include "decoder/report/bit_counter.h"

#include <cinttypes>
#include <cstdio>

#include "common/codec/syntax/stream_format.h"

namespace rlpc {
namespace {

struct Part {
  std::string_view name;
  std::vector<std::string_view> elements;
};
const std::array<Part, kNumStreamParts>& parts() {
  static const std::array<Part, kNumStreamParts> kParts{{
      {"unit headers and CRCs",
       {"version_major", "version_minor", "ancillary_flag", "unit_type", "unit_size",
        "unit_crc"}},
      {"sequence header", {"sequence_header"}},
      {"connectivity", {"connectivity"}},
      {"vertex order", {"vertex_order"}},
      {"GOF headers", {"gof"}},  // and those of shared rigs
      {"bones",
       {"bone_parent_plus1", "bone_pivot", "rotation_flag", "origin_flag", "rotation_step_idx",
        "rotation_order_minus1", "rotation_residual", "origin_step_idx", "origin_order",
        "rotation_between", "origin_between", "origin_residual", "stretch_idc", "stretch_axes",
        "stretch_step_idx", "stretch_order", "stretch_between", "stretch_residual"}},
      {"influences",
       {"extra_bone_flag", "extra_bone", "extra_bone_weight_minus1", "weight_residual"}},
      {"rest positions",
       {"counterpart_flag", "new_counterpart_flag", "counterpart_hinge", "counterpart_idx",
        "counterpart_mirrored_flag", "vertex_residual"}},
      {"clusters", {"lcf_flag", "seed_vertex", "cluster_predicted_flag", "cluster_idx"}},
      {"seed tracks", {"seed_residual"}},
      {"component headers",
       {"num_components_delta", "num_group_components_minus1", "scale_idx_delta",
        "spatial_bits_delta", "temporal_bits_delta", "trajectory_flag", "temporal_predictor",
        "temporal_weight", "temporal_between", "spatial_predictor"}},
      {"temporal factors", {"temporal_residual", "trajectory_residual"}},
      {"spatial factors", {"spatial_residual"}},
      {"frames", {"frame_residual"}},
      {"attributes", {"attributes"}},
      {"materials and textures", {"asset"}},
      {"hashes, index, metadata", {"other"}},
  }};
  return kParts;
}

constexpr std::size_t kRestPart = 7;
constexpr std::size_t kSpatialPart = 12;
constexpr std::size_t kAttributePart = 14;
constexpr std::size_t kAssetPart = 15;
constexpr std::size_t kAncillaryPart = 16;
constexpr std::uint64_t kUnitSizeBits = 32;

// Returns the part of all other bits of a unit.
std::size_t part_of_unit(UnitType type) {
  switch (type) {
    case UnitType::kSequenceHeader:
      return 1;
    case UnitType::kConnectivity:
      return 2;
    case UnitType::kVertexOrder:
      return 3;
    case UnitType::kGof:
    case UnitType::kRig:
    case UnitType::kSlice:
    case UnitType::kFrame:
      return 4;
    case UnitType::kAttributes:
      return kAttributePart;
    case UnitType::kAsset:
      return kAssetPart;
    default:
      return kAncillaryPart;
  }
}

}  // namespace

const std::array<std::string_view, kNumStreamParts>& stream_part_names() {
  static const std::array<std::string_view, kNumStreamParts> kNames = [] {
    std::array<std::string_view, kNumStreamParts> names;
    for (std::size_t p = 0; p < names.size(); ++p) names[p] = parts()[p].name;
    return names;
  }();
  return kNames;
}

BitCounter::BitCounter(bool print) : print_(print) {
  for (std::size_t p = 0; p < parts().size(); ++p) {
    for (const std::string_view name : parts()[p].elements) part_of_[name] = p;
  }
}

void BitCounter::begin(const char* structure, std::uint64_t bit_pos) {
  close(bit_pos);
  if (print_) std::printf("%10" PRIu64 "  %s( )\n", bit_pos, structure);
  if (std::string_view(structure) != "unit") return;
  close_unit();
  ++num_units_;
}

void BitCounter::element(const char* name, std::int64_t value, std::uint64_t bit_pos) {
  close(bit_pos);
  if (print_) std::printf("%10" PRIu64 "    %s = %" PRId64 "\n", bit_pos, name, value);
  const std::string_view word(name);
  if (word == "ancillary_flag") ancillary_bit_ = value != 0 ? kAncillaryFlag : 0;
  if (word == "unit_type") {
    unit_type_ = static_cast<std::uint8_t>(ancillary_bit_ | value);
    unit_part_ = part_of_unit(UnitType{unit_type_});
  }
  is_unit_size_ = word == "unit_size";
  if (word == "component_group_idx") rest_positions_ = value == 0;
  const auto part = part_of_.find(word);
  open_part_ = part == part_of_.end() ? unit_part_ : part->second;
  if (open_part_ == kRestPart && !rest_positions_) open_part_ = kSpatialPart;
}

void BitCounter::finish(std::uint64_t bit_pos) {
  close(bit_pos);
  close_unit();
}

void BitCounter::close(std::uint64_t bit_pos) {
  if (bit_pos <= last_) return;
  std::uint64_t bits = bit_pos - last_;
  if (is_unit_size_ && bits > kUnitSizeBits) {  // the payload has not been parsed
    count(unit_part_, bits - kUnitSizeBits);
    bits = kUnitSizeBits;
  }
  is_unit_size_ = false;
  count(open_part_, bits);
  last_ = bit_pos;
}

void BitCounter::count(std::size_t part, std::uint64_t bits) {
  bits_[part] += bits;
  unit_bits_[part] += bits;
}

void BitCounter::close_unit() {
  const UnitType type{unit_type_};
  if (type == UnitType::kGof || type == UnitType::kRig) {
    in_rig_ = type == UnitType::kRig;
    (in_rig_ ? model_bits_ : gof_bits_).emplace_back();
  }
  // Slices belong to the GOF or shared rig before them, hashes to the GOF.
  const bool is_slice = type == UnitType::kSlice && in_rig_;
  std::vector<PartSizes>& list = type == UnitType::kRig || is_slice ? model_bits_ : gof_bits_;
  if (type == UnitType::kGof || type == UnitType::kRig || is_slice_type(type) ||
      type == UnitType::kGofHash) {
    for (std::size_t p = 0; p < kNumStreamParts && !list.empty(); ++p) {
      list.back()[p] += unit_bits_[p];
    }
  }
  unit_bits_ = {};
}

}  // namespace rlpc
