#include "decoder/codec/parse/access_unit_parser.h"

#include <optional>
#include <utility>

#include "common/memory/owned.h"
#include "decoder/codec/parse/memory_estimate.h"
#include "decoder/codec/parse/parse_cluster_gof.h"
#include "decoder/codec/parse/parse_gof_hash.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "decoder/codec/parse/parse_inter_gof.h"
#include "decoder/codec/parse/parse_skinned_gof.h"

namespace rlpc {

class GofParser : public Owned {
 public:
  virtual ~GofParser() = default;
  // Parses the GOF unit after its header.
  virtual Result<bool> gof(BitReader& r, const GofHeader& header, const RigSlots& rigs) = 0;
  // Parses a slice or frame unit, and adds its entry, without bytes, unless the cut drops it.
  virtual Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos,
                             Vector<SliceEntry>& slices);
  virtual bool drops(BitReader& /*r*/) { return false; }
  virtual bool is_cut() const { return false; }
  virtual std::uint64_t memory_bytes() const { return 0; }  // 0: no slices follow
  virtual AnyGof finish() = 0;
};

Result<bool> GofParser::slice(BitReader& r, std::uint64_t unit_bit_pos, Vector<SliceEntry>&) {
  r.fail(Errc::kInvalid, "R-UNT-05", "slice_unit", unit_bit_pos);
  return *r.error();
}

namespace {

class ClusterParser final : public GofParser {
 public:
  ClusterParser(const StreamContext& context, const MemoryLimit& memory)
      : context_(context), memory_(memory) {}

  Result<bool> gof(BitReader& r, const GofHeader& header, const RigSlots& rigs) override {
    memory_.bytes_in_use += memory_of_rigs(rigs);
    auto gof = parse_clusters(r, context_.header, context_.topology, header, memory_);
    if (!gof) return gof.error();
    gof_ = std::move(*gof);
    return true;
  }
  AnyGof finish() override { return std::move(gof_); }

 private:
  const StreamContext& context_;
  MemoryLimit memory_;
  ClusterGof gof_;
};

class SkinnedParser final : public GofParser {
 public:
  SkinnedParser(const StreamContext& context, const MemoryLimit& memory, const SliceCut& cut)
      : parser_(context.header, *context.meshes, memory, cut) {}

  Result<bool> gof(BitReader& r, const GofHeader& header, const RigSlots& rigs) override {
    return header.kind == GofKind::kSharedRig ? parser_.tracks(r, header, rigs)
                                              : parser_.bones(r, header, rigs);
  }
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos,
                     Vector<SliceEntry>& slices) override {
    if (auto ok = parser_.slice(r, unit_bit_pos); !ok) return ok;
    if (parser_.last_slice()) slices.push_back(*parser_.last_slice());
    return true;
  }
  bool drops(BitReader& r) override { return parser_.drops(r); }
  bool is_cut() const override { return parser_.is_cut(); }
  std::uint64_t memory_bytes() const override { return parser_.memory_bytes(); }
  AnyGof finish() override { return parser_.finish(); }

 private:
  SkinnedGofParser parser_;
};

class FramesParser final : public GofParser {
 public:
  FramesParser(const StreamContext& context, const MemoryLimit& memory, const SliceCut& cut)
      : context_(context), memory_(memory), cut_(cut) {}

  Result<bool> gof(BitReader& r, const GofHeader& header, const RigSlots& rigs) override {
    memory_.bytes_in_use += memory_of_rigs(rigs);
    parser_.emplace(context_.header, (*context_.meshes)[Prediction::kLayers], memory_, cut_);
    return parser_->gof(r, header);
  }
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos,
                     Vector<SliceEntry>& slices) override {
    if (auto ok = parser_->frame(r, unit_bit_pos); !ok) return ok;
    if (parser_->last_unit()) slices.push_back(*parser_->last_unit());
    return true;
  }
  bool is_cut() const override { return parser_->is_cut(); }
  std::uint64_t memory_bytes() const override { return parser_->memory_bytes(); }
  AnyGof finish() override { return parser_->finish(); }

 private:
  const StreamContext& context_;
  MemoryLimit memory_;
  SliceCut cut_;
  std::optional<InterGofParser> parser_;
};

}  // namespace

AccessUnitParser::AccessUnitParser(const StreamContext& context, const MemoryLimit& memory,
                                   const SliceCut& cut)
    : context_(context), memory_(memory), cut_(cut) {}

AccessUnitParser::~AccessUnitParser() = default;

std::unique_ptr<GofParser> AccessUnitParser::make_parser() const {
  switch (kind_) {
    case GofKind::kCluster:
      return std::make_unique<ClusterParser>(context_, memory_);
    case GofKind::kSkinned:
    case GofKind::kSharedRig:
      return std::make_unique<SkinnedParser>(context_, memory_, cut_);
    case GofKind::kInter:
      return std::make_unique<FramesParser>(context_, memory_, cut_);
  }
  return nullptr;
}

Result<bool> AccessUnitParser::gof(BitReader& r, std::uint32_t first_frame,
                                   const RigSlots& rigs, std::uint64_t unit_bytes) {
  const GofHeader header = parse_gof_header(r, context_.header, first_frame);
  if (r.error()) return *r.error();
  kind_ = header.kind;
  num_frames_ = header.num_frames;
  access_unit_.gof_bytes = unit_bytes;
  parser_ = make_parser();
  return parser_->gof(r, header, rigs);
}

bool AccessUnitParser::drops(BitReader& r) { return parser_->drops(r); }

Result<bool> AccessUnitParser::slice(BitReader& r, std::uint64_t unit_bit_pos,
                                     std::uint64_t unit_bytes) {
  const std::size_t before = access_unit_.slices.size();
  if (auto ok = parser_->slice(r, unit_bit_pos, access_unit_.slices); !ok) return ok;
  if (access_unit_.slices.size() > before) access_unit_.slices.back().bytes = unit_bytes;
  return true;
}

Result<bool> AccessUnitParser::hash(BitReader& r) {
  auto hash = parse_gof_hash(r, num_frames_);
  if (!hash) return hash.error();
  access_unit_.hash = std::move(*hash);
  return true;
}

std::uint64_t AccessUnitParser::memory_bytes() const {
  return parser_ ? parser_->memory_bytes() : 0;
}

AccessUnit AccessUnitParser::finish() {
  access_unit_.is_cut = parser_->is_cut();
  access_unit_.gof = parser_->finish();
  return std::move(access_unit_);
}

}  // namespace rlpc
