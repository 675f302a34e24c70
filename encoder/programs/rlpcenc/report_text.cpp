#include "encoder/programs/rlpcenc/report_text.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "common/codec/attributes/attribute_names.h"
#include "common/files/messages.h"
#include "encoder/codec/kinds/inter/frame_pattern_text.h"
#include "encoder/programs/rlpcenc/normal_report.h"

namespace rlpc {
namespace {

// Prints what was coded without loss, and what was not.
void print_lossless(const EncodeOptions& o, const EncodeReport& r) {
  std::printf("  lossless: all coordinates of all frames, %s a grid of 2^%d units (%d bits)",
              o.settings.target.value == 0.0 ? "which lie on" : "after rounding to",
              r.header.grid.log2_step, r.header.position_bits);
  if (r.largest_rounding > 0.0) {
    std::printf("; as 32-bit floats, up to %.3g from the numbers of INPUT", r.largest_rounding);
  }
  std::printf("%s\n", o.settings.keep_order
                          ? "; vertices keep their order, triangles do not"
                          : "; vertices and triangles are in another order (--keep-order)");
}

void print_attributes(const EncodeReport& r) {
  for (const AttributeReport& a : r.attributes) {
    std::printf("  %s: %llu bytes", a.name.c_str(),
                static_cast<unsigned long long>((a.bits + 7) / 8));
    if (a.is_normal) {
      std::printf(", %s", normal_text(a).c_str());
    } else if (a.largest_error > 0.0) {
      std::printf(", largest error %.3g%s", a.largest_error,
                  a.name.starts_with(kColourPrefix) ? " (of linear colours from 0 to 1)" : "");
    }
    std::printf("\n");
  }
  if (r.bits.asset > 0) {
    std::printf("  materials and textures: %llu bytes\n",
                static_cast<unsigned long long>(r.bits.asset / 8));
  }
}

}  // namespace

void print_report(const EncodeOptions& o, const Expectation& e) {
  const EncodeReport& r = e.report;
  const Metrics& m = r.metrics;
  const auto s = [](std::uint32_t n) { return n == 1 ? "" : "s"; };
  const std::string name = o.dry_run ? o.input.path + " (nothing is written)" : o.output;
  std::printf("%s: %u vert%s, %u triangle%s, %u frame%s, level %u\n", printable(name).c_str(),
              r.header.num_vertices, r.header.num_vertices == 1 ? "ex" : "ices",
              r.header.num_triangles, s(r.header.num_triangles), r.header.num_frames,
              s(r.header.num_frames), r.header.level_idc);
  std::printf("  %s%llu bytes, %.4f bits per vertex and frame\n", e.exact() ? "" : "about ",
              static_cast<unsigned long long>(r.bytes), r.bpvf);
  if (!e.exact()) {
    std::printf("  estimated from eight sections with %u frames in total:\n", e.frames_encoded);
  }
  std::printf("  KG error %.4g %%, RMS %.6g, largest %.6g (%.4f %% of the diagonal)\n",
              m.kg_error_percent, m.rms_error, m.max_error, m.max_error_percent);
  if (m.vertex_normals) {
    std::printf("  vertex normals: RMS deviation %.4g degrees\n", *m.vertex_normals);
  }
  if (o.settings.target.kind == Target::kLossless) print_lossless(o, r);
  print_attributes(r);
  for (const TemporalCut& cut : r.temporal_cuts) {
    std::printf("  cut to %u temporal layer%s: %llu bytes, KG error %.4g %%\n", cut.layers,
                s(cut.layers), static_cast<unsigned long long>(cut.bytes),
                cut.kg_error_percent);
  }
  if (!o.verbose) return;
  for (const PatternCount& pattern_count : r.patterns) {
    std::printf("  %u inter GOF%s with pattern %s", pattern_count.gofs, s(pattern_count.gofs),
                frame_pattern_text(pattern_count.pattern).c_str());
    if (pattern_count.patches > 0) {
      std::printf(" and %u patch%s", pattern_count.patches,
                  pattern_count.patches == 1 ? "" : "es");
    }
    std::printf("\n");
  }
  if (r.clusters == 0) {
    std::printf("  %u inter GOF%s, %u trial%s\n", r.num_gofs, s(r.num_gofs), r.trials,
                s(r.trials));
    return;
  }
  const char* const bones = o.settings.profile == Profile::kBaseline ? ""
                            : r.clusters == 1                        ? "bone or "
                                                                     : "bones or ";
  std::printf("  %u GOF%s, %u %scluster%s, %u component%s, %u trial%s\n", r.num_gofs,
              s(r.num_gofs), r.clusters, bones, s(r.clusters), r.components, s(r.components),
              r.trials, s(r.trials));
}

void print_stages(const EncodeOptions& o, std::vector<StageTime> stages) {
  constexpr double kShown = 0.005;  // seconds
  std::stable_sort(stages.begin(), stages.end(), [](const StageTime& a, const StageTime& b) {
    return a.seconds > b.seconds;
  });
  std::printf("  seconds%s:", o.settings.threads > 1 ? " of the first thread" : "");
  const char* before = " ";
  for (const StageTime& time : stages) {
    if (time.seconds < kShown) continue;
    std::printf("%s%.*s %.2f", before, static_cast<int>(time.stage.size()), time.stage.data(),
                time.seconds);
    before = ", ";
  }
  std::printf("\n");
}

}  // namespace rlpc
