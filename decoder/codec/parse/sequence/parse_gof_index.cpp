#include "decoder/codec/parse/sequence/parse_gof_index.h"

#include <limits>

#include "common/memory/owned.h"

namespace rlpc {

namespace {

constexpr std::int64_t kAny = 0xFFFFFFFE;

class GofIndexParser {
 public:
  GofIndexParser(BitReader& r, std::uint32_t num_frames, std::uint64_t max_bytes)
      : r_(r), first_bit_(r.bit_pos()), num_frames_(num_frames), max_bytes_(max_bytes) {}

  Vector<GofLocation> gofs();
  Vector<RigLocation> rigs();
  std::uint64_t end() const { return end_; }

 private:
  template <class T>
  void add(Vector<T>& list, const T& item) {
    if (list.size() * sizeof(T) > max_bytes_) {
      r_.fail(Errc::kLimitExceeded, "", "num_index_gofs_minus1", first_bit_);
    }
    if (!r_.stopped()) list.push_back(item);
  }

  BitReader& r_;
  std::uint64_t first_bit_;
  std::uint32_t num_frames_;
  std::uint64_t max_bytes_;
  std::uint64_t end_ = 0;
};

// 6.9 gof_index( ): the GOFs
Vector<GofLocation> GofIndexParser::gofs() {
  Vector<GofLocation> gofs;
  const std::uint32_t num_gofs =
      r_.ue("num_index_gofs_minus1", {0, std::int64_t{num_frames_} - 1}, "R-IDX-01") + 1;
  GofLocation next{r_.ue("first_gof_offset", {0, kAny}, "R-IDX-02"), 0};
  ReadElement last;
  std::uint32_t g = 0;
  for (; g < num_gofs && next.first_frame < num_frames_ && !r_.stopped(); ++g) {
    add(gofs, next);
    const std::int64_t left = std::int64_t{num_frames_} - next.first_frame;
    next.first_frame +=
        r_.ue("index_gof_frames_minus1", {0, left - 1}, "R-IDX-01", AfterBroken::kStop) + 1;
    last = {"index_gof_bytes", 0, r_.bit_pos()};
    last.value = r_.ue("index_gof_bytes", {0, kAny}, "R-IDX-02");
    next.offset += static_cast<std::uint64_t>(last.value);
  }
  // Wrong numbers of GOFs and of bytes are reported by themselves.
  const bool is_whole = g == num_gofs && next.first_frame == num_frames_;
  if (!r_.error()) r_.require(last, is_whole, "R-IDX-01");
  if (g < num_gofs) r_.stop();
  end_ = next.offset;
  return gofs;
}

// 6.9 index_of_rigs( )
Vector<RigLocation> GofIndexParser::rigs() {
  Vector<RigLocation> rigs;
  const std::uint32_t count = r_.ue("num_index_rigs", {0, num_frames_}, "R-IDX-05");
  std::uint64_t offset = 0;
  for (std::uint32_t m = 0; m < count && !r_.stopped(); ++m) {
    const std::uint32_t rig_idx = r_.u(3, "index_rig_idx");
    offset += r_.ue("index_rig_distance", {0, kAny}, "R-IDX-02");
    add(rigs, {offset, rig_idx});
  }
  return rigs;
}

}  // namespace

GofIndex parse_index_lists(BitReader& r, const SequenceHeader& header,
                           std::uint64_t max_bytes) {
  GofIndexParser parser(r, header.num_frames, max_bytes);
  GofIndex index;
  index.gofs = parser.gofs();
  index.end = parser.end();
  if (header.profile_idc >= kProfileHigh) index.rigs = parser.rigs();
  return index;
}

// 6.9 gof_index( )
Result<GofIndex> parse_gof_index(BitReader& r, const SequenceHeader& header) {
  GofIndex index = parse_index_lists(r, header, std::numeric_limits<std::uint64_t>::max());
  r.byte_alignment();
  r.expect_end();
  if (r.error()) return *r.error();
  return index;
}

}  // namespace rlpc
