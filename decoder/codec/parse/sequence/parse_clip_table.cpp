#include "decoder/codec/parse/sequence/parse_clip_table.h"

#include <utility>

#include "common/memory/owned.h"

namespace rlpc {
namespace {

// 6.15 clip_name( )
String parse_clip_name(BitReader& r) {
  String name;
  const std::uint32_t size = r.u(8, "clip_name_size_minus1") + 1;
  for (std::uint32_t j = 0; j < size && !r.error(); ++j) {
    name += static_cast<char>(r.u(8, "clip_name_byte"));
  }
  return name;
}

}  // namespace

// 6.15 clip_table( )
Result<Vector<Clip>> parse_clip_table(BitReader& r, std::uint32_t num_frames,
                                      const MemoryLimit& memory) {
  constexpr std::uint64_t kBytesOfByte = 60;  // reached by a clip whose name has one letter
  const std::uint64_t needed = memory.bytes_in_use + kBytesOfByte * r.remaining_bytes().size();
  if (needed > memory.max_bytes) {
    r.fail(Errc::kLimitExceeded, "", "num_clips_minus1", r.bit_pos(), needed);
    return *r.error();
  }
  const std::int64_t frames = num_frames;
  Vector<Clip> clips;
  const std::uint32_t count =
      r.ue("num_clips_minus1", {0, std::int64_t{kMaxClips} - 1}, "R-CLP-01") + 1;
  std::int64_t end = 0;
  for (std::uint32_t i = 0; i < count && !r.error(); ++i) {
    Clip clip;
    const std::int64_t first = end + r.se("clip_gap", {-end, frames - 1 - end}, "R-CLP-02");
    const std::int64_t max_minus1 = frames - first - 1;
    clip.first_frame = static_cast<std::uint32_t>(first);
    clip.num_frames = r.ue("clip_num_frames_minus1", {0, max_minus1}, "R-CLP-02") + 1;
    clip.name = parse_clip_name(r);
    end = first + clip.num_frames;
    clips.push_back(std::move(clip));
  }
  r.byte_alignment();
  r.expect_end();
  if (r.error()) return *r.error();
  return clips;
}

}  // namespace rlpc
