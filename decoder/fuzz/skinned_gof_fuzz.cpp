// Fuzzes the parser and the reconstruction of skinned GOFs, shared rigs and their slices,
// without CRCs.
// Input: first frame, 4 bytes; then pieces, each preceded by its size, 2 bytes: the payloads of
// sequence header, connectivity, GOF and slices. The highest bit of the first frame selects the
// High profile, with GOFs, shared rigs and slices in any order, each after a byte with its
// type.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "common/codec/kinds/skinned/recon/rig_recon.h"
#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/codec/syntax/stream_format.h"
#include "common/testing/fuzz_input.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "decoder/codec/parse/sequence/parse_connectivity.h"
#include "decoder/codec/parse/sequence/parse_sequence_header.h"
#include "decoder/fuzz/recon_fuzz.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                        std::size_t max_size);

namespace {

using Piece = std::vector<std::uint8_t>;

constexpr std::size_t kMaxPieceBytes = 0xFFFF;
constexpr std::size_t kGofPiece = 2;
// A GOF of this size takes well under a second, even with sanitizers.
constexpr std::uint32_t kMaxVertices = 1000;
constexpr std::uint32_t kMaxFrames = 100;
constexpr std::uint64_t kMaxMemoryBytes = 8 << 20;

std::vector<Piece> pieces_of(rlpc::FuzzInput& input) {
  std::vector<Piece> pieces;
  while (!input.rest().empty()) {
    const std::uint32_t size = input.number(2);
    const auto bytes = input.take(size);
    pieces.emplace_back(bytes.begin(), bytes.end());
  }
  return pieces;
}

void check_influences(const rlpc::SharedRig& gof,
                      std::span<const rlpc::Influences> vertex_influences) {
  for (const rlpc::Influences& influences : vertex_influences) {
    int sum = 0;
    for (const rlpc::Influence& influence : influences) {
      rlpc::fuzz_check(influence.bone < gof.bones.size() && influence.weight > 0);
      sum += influence.weight;
    }
    rlpc::fuzz_check(sum == 1 << gof.weight_bits);
  }
}

struct Unit {
  rlpc::UnitType type;
  std::span<const std::uint8_t> payload;
};

// Units of one stream, in order.
class Units {
 public:
  Units(const rlpc::SequenceHeader& header, const rlpc::OrderedMeshes& meshes)
      : header_(header), meshes_(meshes), parser_(header, meshes, {kMaxMemoryBytes, 0}) {}

  // Adds a unit. Returns false after an error.
  bool add(const Unit& unit, std::uint32_t first_frame) {
    rlpc::BitReader bits(unit.payload);
    if (unit.type == rlpc::UnitType::kSlice) {
      return open_ != rlpc::UnitType::kSlice && parser_.slice(bits, 0);
    }
    finish();
    open_ = unit.type;
    if (unit.type == rlpc::UnitType::kRig) {
      return header_.profile_idc >= rlpc::kProfileHigh &&
             static_cast<bool>(parser_.rig(bits, rigs_));
    }
    const rlpc::GofHeader gof = rlpc::parse_gof_header(bits, header_, first_frame);
    if (bits.error()) return false;
    if (gof.kind == rlpc::GofKind::kSharedRig) {
      return static_cast<bool>(parser_.tracks(bits, gof, rigs_));
    }
    return gof.kind == rlpc::GofKind::kSkinned &&
           static_cast<bool>(parser_.bones(bits, gof, rigs_));
  }
  // Finishes the GOF or shared rig, without the slices that could follow.
  void finish() {
    if (open_ == rlpc::UnitType::kRig) finish_rig();
    if (open_ == rlpc::UnitType::kGof) finish_gof();
    open_ = rlpc::UnitType::kSlice;
  }

 private:
  void finish_rig() {
    const std::uint32_t idx = parser_.rig_idx();
    const auto rig = parser_.finish_rig();
    const rlpc::OrderedMesh& mesh = meshes_[rig->prediction];
    check_influences(*rig, rlpc::complete_influences(mesh, *rig));
    rigs_.slots[idx] = rig;
    recons_[idx] = std::make_shared<rlpc::RigRecon>(mesh, *rig, header_.position_bits, true);
  }
  void finish_gof() {
    const rlpc::SkinnedGof gof = parser_.finish();
    if (gof.rig) return decode(rlpc::SkinnedRecon(recons_[gof.rig_idx], gof));
    const rlpc::OrderedMesh& mesh = meshes_[gof.prediction];
    check_influences(gof, rlpc::complete_influences(mesh, gof));
    decode(rlpc::SkinnedRecon(mesh, gof, header_.position_bits));
  }
  void decode(const rlpc::SkinnedRecon& recon) const {
    rlpc::fuzz_check(recon.num_frames() <= header_.num_frames);
    std::vector<std::int32_t> positions(3 * std::size_t{header_.num_vertices});
    const std::int32_t bound = std::int32_t{1} << (header_.position_bits - 1);
    for (std::uint32_t f = 0; f < recon.num_frames(); ++f) {
      recon.frame(f, positions);
      for (const std::int32_t p : positions) rlpc::fuzz_check(p >= -bound && p < bound);
    }
  }

  const rlpc::SequenceHeader& header_;
  const rlpc::OrderedMeshes& meshes_;
  rlpc::SkinnedGofParser parser_;
  rlpc::UnitType open_ = rlpc::UnitType::kSlice;  // kSlice: neither GOF nor shared rig
  rlpc::RigSlots rigs_;
  std::array<std::shared_ptr<const rlpc::RigRecon>, rlpc::kMaxRigs> recons_;
};

// Decodes pieces. In the Main profile, the first piece is a GOF, and the others are its slices.
void decode(const rlpc::SequenceHeader& header, const rlpc::OrderedMeshes& meshes,
            std::uint32_t first_frame, std::span<const Piece> pieces) {
  Units units(header, meshes);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Unit unit{i == 0 ? rlpc::UnitType::kGof : rlpc::UnitType::kSlice, pieces[i]};
    if (header.profile_idc >= rlpc::kProfileHigh) {
      if (pieces[i].empty()) return;
      unit = {rlpc::UnitType{pieces[i][0]}, unit.payload.subspan(1)};
      if (unit.type < rlpc::UnitType::kGof || unit.type > rlpc::UnitType::kRig ||
          unit.type == rlpc::UnitType::kEndOfSequence) {
        return;
      }
    }
    if (!units.add(unit, first_frame)) return;
  }
  units.finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rlpc::FuzzInput input(data, size);
  constexpr std::uint32_t kHigh = 1U << 31;
  const std::uint32_t number = input.number(4);
  const std::uint32_t first_frame = number & ~kHigh;
  const std::vector<Piece> pieces = pieces_of(input);
  if (pieces.size() <= kGofPiece) return 0;
  rlpc::BitReader header_bits(pieces[0]);
  const auto header = rlpc::parse_sequence_header(
      header_bits, (number & kHigh) != 0 ? rlpc::kProfileHigh : rlpc::kProfileMain);
  if (!header || header->num_vertices > kMaxVertices || header->num_frames > kMaxFrames ||
      first_frame >= header->num_frames) {
    return 0;
  }
  rlpc::BitReader connectivity_bits(pieces[1]);
  const auto triangles =
      rlpc::parse_connectivity(connectivity_bits, header->num_vertices, header->num_triangles);
  if (!triangles) return 0;
  const rlpc::Topology topology = rlpc::make_topology(header->num_vertices, *triangles);
  rlpc::OrderedMeshes meshes(topology, *triangles);
  decode(*header, meshes, first_frame, std::span(pieces).subspan(kGofPiece));
  return 0;
}

// Mutates, removes, repeats or moves one piece, usually the GOF or a slice: the units before
// the GOF have their own targets.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  std::minstd_rand random(seed);
  rlpc::FuzzInput input(data, size);
  const auto prefix = input.take(4);
  Piece bytes(prefix.begin(), prefix.end());
  std::vector<Piece> pieces = pieces_of(input);
  if (pieces.size() <= kGofPiece || random() % 16 == 0) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
  const auto any = [&] { return kGofPiece + random() % (pieces.size() - kGofPiece); };
  const std::size_t i = any();
  const auto place = pieces.begin() + static_cast<std::ptrdiff_t>(i);
  switch (random() % 12) {
    case 0:
      pieces.erase(place);
      break;
    case 1:
      pieces.insert(place, Piece(pieces[any()]));
      break;
    case 2:
      std::swap(pieces[i], pieces[any()]);
      break;
    default: {
      const std::size_t old = pieces[i].size();
      pieces[i].resize(std::min(kMaxPieceBytes, old + 1 + random() % 64));
      pieces[i].resize(LLVMFuzzerMutate(pieces[i].data(), old, pieces[i].size()));
      break;
    }
  }
  for (const Piece& piece : pieces) {
    bytes.push_back(static_cast<std::uint8_t>(piece.size()));
    bytes.push_back(static_cast<std::uint8_t>(piece.size() >> 8));
    bytes.insert(bytes.end(), piece.begin(), piece.end());
  }
  if (bytes.size() > max_size) return size;
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}
