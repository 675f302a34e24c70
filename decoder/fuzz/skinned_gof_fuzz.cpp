// Fuzzes the parser and the reconstruction of skinned GOFs and their slices, without CRCs.
// Input: first frame, 4 bytes; then pieces, each preceded by its size, 2 bytes: the payloads of
// sequence header, connectivity, GOF and slices.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "common/skinned_gof/recon/skinned_recon.h"
#include "common/testing/fuzz_input.h"
#include "decoder/fuzz/recon_fuzz.h"
#include "decoder/parse/parse_gof_header.h"
#include "decoder/parse/parse_skinned_gof.h"
#include "decoder/parse/sequence/parse_connectivity.h"
#include "decoder/parse/sequence/parse_sequence_header.h"

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

void check_influences(const rlpc::SkinnedGof& gof,
                      std::span<const rlpc::Influences> of_vertices) {
  for (const rlpc::Influences& influences : of_vertices) {
    int sum = 0;
    for (const rlpc::Influence& influence : influences) {
      rlpc::fuzz_check(influence.bone < gof.bones.size() && influence.weight > 0);
      sum += influence.weight;
    }
    rlpc::fuzz_check(sum == 1 << gof.weight_bits);
  }
}

void decode_gof(const rlpc::SequenceHeader& header, const rlpc::CodedMeshes& meshes,
                std::uint32_t first_frame, std::span<const Piece> pieces) {
  rlpc::SkinnedGofParser parser(header, meshes, kMaxMemoryBytes);
  rlpc::BitReader gof_bits(pieces[0]);
  const rlpc::GofHeader gof_header = rlpc::parse_gof_header(gof_bits, header, first_frame);
  if (gof_header.kind != rlpc::GofKind::kSkinned || !parser.bones(gof_bits, gof_header)) return;
  for (const Piece& piece : pieces.subspan(1)) {
    rlpc::BitReader slice_bits(piece);
    if (!parser.slice(slice_bits, 0)) return;
  }
  const rlpc::SkinnedGof gof = parser.finish();
  const rlpc::CodedMesh& mesh = meshes[gof.prediction];
  check_influences(gof, rlpc::complete_influences(mesh, gof));
  const rlpc::SkinnedRecon recon(mesh, gof, header.position_bits);
  rlpc::fuzz_check_frames(recon, header, first_frame);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rlpc::FuzzInput input(data, size);
  const std::uint32_t first_frame = input.number(4);
  const std::vector<Piece> pieces = pieces_of(input);
  if (pieces.size() <= kGofPiece) return 0;
  rlpc::BitReader header_bits(pieces[0]);
  const auto header = rlpc::parse_sequence_header(header_bits, rlpc::kProfileMain);
  if (!header || header->num_vertices > kMaxVertices || header->num_frames > kMaxFrames ||
      first_frame >= header->num_frames) {
    return 0;
  }
  rlpc::BitReader connectivity_bits(pieces[1]);
  const auto triangles =
      rlpc::parse_connectivity(connectivity_bits, header->num_vertices, header->num_triangles);
  if (!triangles) return 0;
  const rlpc::Topology topology = rlpc::make_topology(header->num_vertices, *triangles);
  rlpc::CodedMeshes meshes(topology, *triangles);
  decode_gof(*header, meshes, first_frame, std::span(pieces).subspan(kGofPiece));
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
