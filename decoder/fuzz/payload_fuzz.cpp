// Fuzzes the parsers of small payloads. Input: selects the parser, 1 byte; the number of
// vertices or frames minus 1, 2 bytes; the payload.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/syntax/sequence_header.h"
#include "common/testing/fuzz_input.h"
#include "decoder/codec/parse/parse_gof_hash.h"
#include "decoder/codec/parse/sequence/parse_clip_table.h"
#include "decoder/codec/parse/sequence/parse_gof_index.h"
#include "decoder/codec/parse/sequence/parse_metadata.h"
#include "decoder/codec/parse/sequence/parse_vertex_order.h"

namespace {

using rlpc::BitReader;
using rlpc::fuzz_check;

void vertex_order(BitReader& r, std::uint32_t num_vertices) {
  const auto order = rlpc::parse_vertex_order(r, num_vertices);
  if (!order) return;
  fuzz_check(order->size() == num_vertices);
  std::vector<bool> taken(num_vertices);
  for (const std::uint32_t v : *order) {
    fuzz_check(v < num_vertices && !taken[v]);
    taken[v] = true;
  }
}

void gof_hash(BitReader& r, std::uint32_t num_frames) {
  const auto hash = rlpc::parse_gof_hash(r, num_frames);
  if (hash) fuzz_check(hash->position_crc.size() == (hash->per_frame_flag ? num_frames : 1));
}

void gof_index(BitReader& r, std::uint32_t num_frames) {
  rlpc::SequenceHeader header;
  header.num_frames = num_frames;
  header.profile_idc = num_frames % 2 == 0 ? rlpc::kProfileHigh : rlpc::kProfileMain;
  const auto index = rlpc::parse_gof_index(r, header);
  if (!index) return;
  const auto& gofs = index->gofs;
  fuzz_check(!gofs.empty() && gofs.front().first_frame == 0);
  for (std::size_t g = 1; g < gofs.size(); ++g) {
    fuzz_check(gofs[g].first_frame > gofs[g - 1].first_frame);
    fuzz_check(gofs[g].offset >= gofs[g - 1].offset);
  }
  fuzz_check(gofs.back().first_frame < num_frames);
  fuzz_check(index->rigs.size() <= num_frames);
}

void metadata(BitReader& r, std::uint32_t) {
  const auto json = rlpc::parse_metadata(r, {UINT64_MAX, 0});
  if (json) fuzz_check(json->size() <= rlpc::kMaxMetadataBytes);
}

void clip_table(BitReader& r, std::uint32_t num_frames) {
  const auto clips = rlpc::parse_clip_table(r, num_frames, {UINT64_MAX, 0});
  if (!clips) return;
  fuzz_check(!clips->empty() && clips->size() <= rlpc::kMaxClips);
  for (const rlpc::Clip& clip : *clips) {
    fuzz_check(clip.first_frame < num_frames);
    fuzz_check(clip.num_frames >= 1 && clip.num_frames <= num_frames - clip.first_frame);
    fuzz_check(!clip.name.empty() && clip.name.size() <= rlpc::kMaxClipNameBytes);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kParsers{vertex_order, gof_hash, gof_index, metadata, clip_table};
  rlpc::FuzzInput input(data, size);
  const std::uint32_t parser = input.number(1);
  const std::uint32_t count = input.number(2) + 1;
  BitReader r(input.rest());
  kParsers[parser % kParsers.size()](r, count);
  return 0;
}
