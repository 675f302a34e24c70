#include "decoder/codec/units/stream_summary.h"

#include <array>
#include <utility>
#include <variant>

#include "decoder/codec/kinds/kinds.h"
#include "decoder/codec/kinds/skinned/rig_figures.h"

namespace rlpc {
namespace {

GofSummary summary_of(const AccessUnit& access_unit) {
  const GofHeader& header = access_unit.header();
  GofSummary summary;
  summary.kind = header.kind;
  summary.first_frame = header.first_frame;
  summary.num_frames = header.num_frames;
  summary.bytes = access_unit.gof_bytes;
  summary.slices = access_unit.slices;
  visit_gof(access_unit.gof,
            [&](auto decoder, const auto& gof) { decoder.add_figures(gof, summary); });
  return summary;
}

// Collects summaries, and tracks the shared rigs alive.
class Summariser {
 public:
  void add(const ParsedRig& parsed) {
    const auto rig = make_shared_owned<RigSummary>();
    rig->number = summary_.rigs.size();
    rig->rig_idx = parsed.rig_idx;
    rig->num_component_groups = parsed.rig->num_component_groups;
    rig->bytes = parsed.bytes;
    rig->slices = parsed.slices;
    add_rig_figures(*parsed.rig, *rig);
    rigs_by_idx_[parsed.rig_idx] = rig;
    summary_.rigs.push_back(rig);
  }
  void add(const AccessUnit& access_unit) {
    GofSummary gof = summary_of(access_unit);
    const auto* skinned = std::get_if<SkinnedGof>(&access_unit.gof);
    if (skinned != nullptr && skinned->rig) {
      const auto& rig = rigs_by_idx_[skinned->rig_idx];
      ++rig->num_gofs;
      gof.rig = rig;
    }
    summary_.gofs.push_back(std::move(gof));
  }
  StreamSummary finish() { return std::move(summary_); }

 private:
  StreamSummary summary_;
  std::array<std::shared_ptr<RigSummary>, kMaxRigs> rigs_by_idx_;
};

}  // namespace

Result<StreamSummary> summarise_all(StreamReader& stream, const CheckAccessUnit& check) {
  Summariser summariser;
  stream.rigs().watch([&](const ParsedRig& rig) { summariser.add(rig); });
  for (;;) {
    const auto access_unit = stream.next();
    if (!access_unit || !*access_unit) stream.rigs().watch({});
    if (!access_unit) return access_unit.error();
    if (!*access_unit) return summariser.finish();
    summariser.add(**access_unit);
    if (!check) continue;
    if (const auto error = check(**access_unit)) {
      stream.rigs().watch({});
      return *error;
    }
  }
}

}  // namespace rlpc
