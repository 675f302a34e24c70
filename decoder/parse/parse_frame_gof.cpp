#include "decoder/parse/parse_frame_gof.h"

#include <array>
#include <memory>
#include <span>

#include "decoder/parse/memory_estimate.h"
#include "decoder/parse/parse_layers.h"
#include "decoder/parse/section_reader.h"

namespace rlpc {

bool FrameGofParser::has_memory(BitReader& r, std::uint64_t more, const char* element) {
  const std::uint64_t needed_bytes = memory_.bytes_in_use + memory_bytes_ + more;
  if (needed_bytes <= memory_.max_bytes) return true;
  r.fail(Errc::kLimitExceeded, "", element, r.bit_pos(), needed_bytes);
  return false;
}

// 6.14 frames_of_gof( ), the settings of its weights
void FrameGofParser::weights(BitReader& r) {
  gof_.weights.damping_log2 = static_cast<int>(r.u(4, "damping_log2"));
  gof_.weights.outer_weight = static_cast<int>(r.u(4, "outer_weight"));
  gof_.weights.outer_scale = static_cast<int>(r.u(4, "outer_scale"));
  const std::uint64_t at = r.bit_pos();
  gof_.learning_flag = r.flag("learning_flag");
  if (!gof_.learning_flag) return;
  if (!r.error() && header_.num_vertices > header_.level().max_learning_vertices) {
    r.fail(Errc::kInvalid, "R-LVL-10", "learning_flag", at);
  }
  gof_.prime_log2 = static_cast<int>(r.u(4, "prime_log2"));
}

// 6.14 frames_of_gof( )
Result<bool> FrameGofParser::gof(BitReader& r, const GofHeader& gof_header) {
  static_cast<GofHeader&>(gof_) = gof_header;
  gof_.reference = static_cast<FrameReference>(r.u(1, "frame_reference_idc"));
  gof_.exact_flag = r.flag("exact_flag");
  if (!gof_.exact_flag) {
    gof_.step = r.ue("frame_step_minus1", {0, std::int64_t{kMaxFrameStep} - 1}, "R-FRM-01") + 1;
  }
  weights(r);
  gof_.frame_hash_flag = r.flag("frame_hash_flag");
  const auto groups = parse_layer_groups(r, mesh_.num_layers());
  if (!groups.empty()) gof_.layer_group_size = groups;
  gof_.layer_step.assign(mesh_.num_layers(), kMaxLayerStep);
  if (!gof_.exact_flag) parse_layer_steps(r, gof_.layer_step);
  r.byte_alignment();
  r.expect_end();
  if (r.error()) return *r.error();
  memory_bytes_ = memory_of_frames(header_.num_vertices, gof_.num_frames,
                                   gof_.layer_group_size.size(), gof_.learning_flag);
  if (!has_memory(r, 0, "frames_of_gof")) return *r.error();
  frames_.resize(gof_.num_frames);
  contexts_.emplace(mesh_, gof_.layer_group_size.size());
  frames_of_group_.assign(gof_.layer_group_size.size(), 0);
  end_layer_group_ = layer_groups_that_stay(gof_.layer_group_size, cut_);
  return true;
}

// 6.14.1 frame_unit( ), to its section
SliceEntry FrameGofParser::frame_header(BitReader& r) const {
  SliceEntry unit;
  unit.frame_idx = r.ue("frame_idx", {0, std::int64_t{gof_.num_frames} - 1}, "R-FRM-02");
  const auto num_groups = static_cast<std::int64_t>(gof_.layer_group_size.size());
  unit.layer_group_idx = r.ue("layer_group_idx", {0, num_groups - 1}, "R-FRM-02");
  return unit;
}

// 6.14.1 frame_unit( )
Result<bool> FrameGofParser::frame(BitReader& r, std::uint64_t unit_bit_pos) {
  SliceEntry unit = frame_header(r);
  if (r.error()) return *r.error();
  last_unit_.reset();
  const std::uint32_t group = unit.layer_group_idx;
  if (group >= end_layer_group_) {
    is_cut_ = true;
    return true;
  }
  // 8.19.1 FrameMayFollow( frame, group )
  const bool may_follow = unit.frame_idx + 1 >= next_frame_ &&
                          unit.frame_idx == frames_of_group_[group] &&
                          (group == 0 || frames_of_group_[group - 1] > unit.frame_idx);
  if (!may_follow) r.fail(Errc::kInvalid, "R-FRM-03", "frame_unit", unit_bit_pos);
  r.byte_alignment();
  if (gof_.frame_hash_flag && group + 1 == gof_.layer_group_size.size()) {
    const std::uint64_t at = r.bit_pos();
    frames_[unit.frame_idx].frame_crc = FrameCrc{r.u(32, "frame_crc"), at};
  }
  if (r.error()) return *r.error();
  frame_section(r, unit);
  if (r.error()) return *r.error();
  frames_of_group_[group] = unit.frame_idx + 1;
  last_unit_ = unit;
  return true;
}

namespace {

// One vertex, for SectionReader::residuals().
struct OfVertex {
  FrameContexts& contexts;
  std::uint32_t expected() const { return contexts.expected(); }
  ResidualModels& models() const { return contexts.models(); }
  void update(std::int32_t residual) const { contexts.update(residual); }
};

}  // namespace

// 6.14.1 frame_section( )
void FrameGofParser::frame_section(BitReader& r, const SliceEntry& unit) {
  CodedFrame& frame = frames_[unit.frame_idx];
  const std::uint64_t num_vertices = header_.num_vertices;
  if (unit.layer_group_idx == 0) {
    const std::uint64_t most = memory_of_frame(num_vertices, 3 * num_vertices);
    if (!has_memory(r, most + r.remaining_bytes().size(), "frame_unit")) return;
    frame.residual = CompactResiduals(3 * std::size_t{header_.num_vertices});
    frame.expected.assign(header_.num_vertices, 0);
    contexts_->start_frame(unit.frame_idx);
    next_frame_ = unit.frame_idx + 1;
    memory_bytes_ += memory_of_frame(num_vertices, 0);
  }
  const std::uint64_t large_before = frame.residual.num_large();
  SectionReader section(r, "frame_section");
  contexts_->start_group(unit.layer_group_idx);
  std::uint32_t first = 0;
  for (std::uint32_t j = 0; j < unit.layer_group_idx; ++j) first += gof_.layer_group_size[j];
  const std::uint32_t end = first + gof_.layer_group_size[unit.layer_group_idx];
  for (const std::uint32_t v : mesh_.vertices_of_layers(first, end)) {
    contexts_->start(v);
    frame.expected[v] = contexts_->frame_expected();
    std::array<std::int32_t, 3> residuals{};
    section.residuals(OfVertex{*contexts_}, residuals, "frame_residual");
    for (std::size_t c = 0; c < 3; ++c) {
      if (residuals[c] != 0) frame.residual.set(3 * std::size_t{v} + c, residuals[c]);
    }
    section.check_overrun("frame_residual");
    if (section.failed()) return;
  }
  section.finish();
  frame.residual.sort();
  frame.layer_groups = unit.layer_group_idx + 1;
  memory_bytes_ += memory_of_frame(0, frame.residual.num_large() - large_before);
}

FrameGof FrameGofParser::finish() {
  gof_.frames = std::make_shared<const std::vector<CodedFrame>>(std::move(frames_));
  return std::move(gof_);
}

}  // namespace rlpc
