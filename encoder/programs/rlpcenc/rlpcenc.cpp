// rlpcenc: encodes animations as .rlpc streams.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "common/files/interrupts.h"
#include "common/files/output_file.h"
#include "common/files/progress_bar.h"
#include "common/files/standard_output.h"
#include "common/json/json.h"
#include "encoder/codec/sequence/target/quality.h"
#include "encoder/codec/stage_clock.h"
#include "encoder/dry_run.h"
#include "encoder/meshes/axes.h"
#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/input_format.h"
#include "encoder/meshes/input_notes.h"
#include "encoder/meshes/open/open_source.h"
#include "encoder/programs/rlpcenc/encode_options.h"
#include "encoder/programs/rlpcenc/low_delay.h"
#include "encoder/programs/rlpcenc/normal_report.h"
#include "encoder/programs/rlpcenc/report_json.h"
#include "encoder/programs/rlpcenc/report_text.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {
namespace {

// Returns the corner of the grid that is farthest from the origin along an axis, in steps.
double farthest_origin(const EncodeReport& report) {
  double farthest = 0.0;
  for (const std::int32_t origin : report.header.grid.origin) {
    farthest = std::max(farthest, std::abs(static_cast<double>(origin)));
  }
  return farthest;
}

// Whether the spacing of floats at that place exceeds the error.
bool are_floats_coarse(const EncodeReport& report) {
  constexpr double kFloatSteps = 0x1p23;
  return std::ldexp(farthest_origin(report), report.header.grid.log2_step) >
         kFloatSteps * report.metrics.rms_error;
}

// Whether that place is farther away than the size of the animation, so that moving it helps.
bool is_far_away(const EncodeReport& report) {
  return farthest_origin(report) > std::ldexp(2.0, report.header.position_bits);
}

// Reports an error or rate that is far below the target.
void tell_if_far_below(const Target& target, const EncodeReport& report) {
  constexpr double kNear = 0.95;
  constexpr double kNoError = 0.002;  // KG error in per cent, about that of the finest grid
  const bool is_exact = report.metrics.kg_error_percent < kNoError;
  if (target.kind == Target::kBpvf && report.bpvf < kNear * target.value) {
    complain(std::string("fewer bits than --bpvf allows: ") +
             (is_exact ? "this is the highest precision"
                       : "no encoding closer to the target was found"));
  }
  const Metrics& m = report.metrics;
  const double error = target.kind == Target::kMaxError ? m.max_error : m.kg_error_percent;
  const bool is_near_normals =
      target.max_normals > 0.0 && m.vertex_normals.value_or(0.0) >= kNear * target.max_normals;
  const bool is_near = error >= kNear * target.value || is_near_normals;
  if (target.kind != Target::kBpvf && !is_exact && !is_near) {
    complain(
        "the error is smaller than requested: no smaller file closer to the target was found");
  }
}

// Returns a number at least 2 % above `value`, in two digits.
std::string a_little_above(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", std::ceil(1.02 * value / digit) * digit);
  return text;
}

// Returns the option and value that ask for the result reached.
std::string reachable_target(const Target& target, const EncodeReport& report) {
  switch (target.kind) {
    case Target::kBpvf:
      return "--bpvf " + a_little_above(report.bpvf);
    case Target::kMaxError:
      return "--max-error " + a_little_above(report.metrics.max_error);
    default:
      if (target.max_normals > 0.0 &&
          report.metrics.vertex_normals.value_or(0.0) > target.max_normals) {
        return "--normals " + a_little_above(*report.metrics.vertex_normals);
      }
      return "--kg " + a_little_above(report.metrics.kg_error_percent);
  }
}

std::string advice(const EncodeOptions& o, const EncodeReport& report) {
  const Target& target = o.settings.target;
  const std::string reachable = reachable_target(target, report);
  if (target.kind == Target::kBpvf) {
    return "Try " + reachable + (report.num_gofs > 1 ? ", or a longer --gof" : "");
  }
  if (are_floats_coarse(report) && is_far_away(report)) {
    return "The animation is so far from the origin that floats are coarser than the target: "
           "move it to the origin, or try a larger error";
  }
  return (o.settings.components > 0 ? "Try more --components, or " : "Try ") + reachable;
}

int report_target(const EncodeOptions& o, const EncodeReport& report) {
  if (report.target_met) {
    if (!o.quiet && o.settings.target.has_search() && !o.settings.low_delay) {
      tell_if_far_below(o.settings.target, report);
    }
    return kEncoded;
  }
  if (o.settings.low_delay && o.settings.target.kind == Target::kMaxError) {
    char error[32];
    std::snprintf(error, sizeof error, "%.3g", report.metrics.max_error);
    return complain("the largest error is " + std::string(error) +
                        ", above the target: the grid or 32-bit floats are too coarse. "
                        "Try a larger --max-error, or move the animation to the origin",
                    kTargetMissed);
  }
  if (o.settings.low_delay) {
    char error[32];
    std::snprintf(error, sizeof error, "%.3g", report.metrics.kg_error_percent);
    return complain("the KG error is " + std::string(error) +
                        " %, above the target; low-delay mode meets it only approximately",
                    kTargetMissed);
  }
  return complain(
      "the target is out of reach; this is the closest found. " + advice(o, report) + ".",
      kTargetMissed);
}

// Suggests a target whose error should not be visible.
std::string finer(const EncodeOptions& o, const EncodeReport& report, const Visibility& v) {
  const Target& target = o.settings.target;
  if (target.kind == Target::kNone) {
    // Quantiser steps, 2^-bits of the range, explain only errors of about their size.
    const int bits = std::min(o.settings.baseline.qu, o.settings.baseline.qc);
    const double explained = 1000.0 * std::ldexp(1.0, -bits);  // per cent
    return report.metrics.kg_error_percent > explained && o.settings.components > 0
               ? "more --components"
               : "larger --qu and --qc";
  }
  if (target.kind == Target::kLossless) return "more bits";
  if (target.kind == Target::kBpvf) return "a higher --bpvf";
  const bool is_kg = target.kind == Target::kKg;
  // In low-delay mode, words do not bound normals.
  if (is_kg && !o.settings.low_delay) return std::string("--quality ") + kDefaultQuality.word;
  // RMS errors are roughly proportional to KG errors and to the largest ones.
  const double value = target.value * Visibility::kVisiblePercent / v.error_percent;
  char text[32];
  std::snprintf(text, sizeof text, "%.1g", 0.9 * value);
  return (is_kg ? "--kg " : "--max-error ") + std::string(text);
}

// Does not warn if normals are bounded, which says how visible errors are, or if they are
// expected: in a preview, or where the target was missed.
void warn_if_visible(const EncodeOptions& o, const EncodeReport& report, const Visibility& v) {
  if (!v.visible() || o.quiet || !report.target_met) return;
  if (o.settings.target.max_normals > 0.0 || o.quality == kQualities.front().word) return;
  std::fprintf(
      stderr,
      "rlpcenc: the error may be visible: RMS %.3g %% of the median edge length (above "
      "%.3g %%). Try %s.\n",
      v.error_percent, Visibility::kVisiblePercent, finer(o, report, v).c_str());
}

nlohmann::ordered_json stages_json(const std::vector<StageTime>& stages) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const StageTime& time : stages) json[std::string(time.stage)] = time.seconds;
  return json;
}

int tell(const EncodeOptions& o, FrameSource& source, const Expectation& e,
         const StageClock& clock) {
  const std::vector<StageTime> stages = clock.times();
  const auto visibility = measure_visibility(source, e.report.metrics);
  if (!visibility) return complain(visibility.error().message);
  if (o.json) {
    auto json = report_json(e.report);
    if (*visibility) json["visibility"] = visibility_json(**visibility);
    if (o.dry_run) {
      json["dry_run"] = {{"exact", e.exact()}, {"frames_encoded", e.frames_encoded}};
    }
    if (o.verbose) json["stage_seconds"] = stages_json(stages);
    std::cout << json_text(json, 2) << "\n";
  } else if (!o.quiet && o.output != "-" && o.order_map != "-") {
    print_report(o, e);
    if (o.verbose) print_stages(o, stages);
  }
  if (*visibility) warn_if_visible(o, e.report, **visibility);
  for (const AttributeReport& a : e.report.attributes) {
    const auto warning = a.is_normal ? normal_warning(a) : std::nullopt;
    if (warning) complain(*warning);  // a loss, which --quiet does not hide
  }
  return report_target(o, e.report);
}

int run_dry(const EncodeOptions& o, FrameSource& source, const StageClock& clock) {
  InputResult<Expectation> expected = InputError{};
  {
    ProgressBar bar("encoding", !o.quiet);
    expected =
        expect_encoding(source, o.settings, [&](double fraction) { bar.show(fraction); });
  }
  if (!expected) return complain(expected.error().message);
  return tell(o, source, *expected, clock);
}

std::optional<OutputError> write_order(OutputFile& map, const EncodeReport& report) {
  for (const std::uint32_t v : report.input_vertex) {
    if (auto error = map.write(std::to_string(v) + "\n")) return error;
  }
  return map.close();
}

InputResult<EncodeReport> encode_source(FrameSource& source, const EncodeOptions& o,
                                        const ByteSink& sink, const Progress& progress) {
  if (!o.settings.low_delay) return encode(source, o.settings, sink, progress);
  auto encoded = encode_low_delay(source, o, sink, progress);
  if (!encoded) return encoded.error();
  return std::move(encoded->report);
}

// Prints a note; notes of losses appear even with --quiet.
void tell_note(const EncodeOptions& o, const std::string& name, const std::string& note) {
  if (!o.quiet || tells_loss(note)) complain(name + ": " + note);
}

// Encodes frames as they arrive. If the input fails, the frames written so far remain as a
// stream.
int run_live(const EncodeOptions& o) {
  const std::string mesh = o.input.points.empty() ? std::string() : o.input.path;
  if (!mesh.empty()) {
    if (const auto wrong = check_gltf_options(o.input)) return complain(wrong->message);
  }
  auto frames = open_frame_stream(stdin, mesh, o.input.frame_rate, o.input.max_memory_bytes);
  if (!frames) return complain(frames.error().message);
  const std::string input = o.input.points.empty() ? o.input.path : mesh;
  for (const std::string& note : (*frames)->shape().notes) {
    tell_note(o, name_of_input(input), note);
  }
  if (o.input.axes) *frames = turn_stream(std::move(*frames), *o.input.axes);
  auto stream = OutputFile::create(o.output);
  if (!stream) return complain(stream.error().message);
  std::optional<OutputError> failure;
  const ByteSink sink = [&](std::span<const std::uint8_t> bytes) {
    failure = stream->write(bytes);
    return !failure;
  };
  const auto encoded = encode_live(**frames, o, sink, [&] {
    failure = stream->flush();
    return !failure;
  });
  if (failure) return complain(failure->message);
  if (!encoded) return complain(encoded.error().message);
  const HoldInterrupts hold;
  failure = stream->close();
  if (!failure) failure = stream->commit();
  if (failure) return complain(failure->message);
  const EncodeReport& report = encoded->report;
  if (o.json) {
    std::cout << json_text(report_json(report), 2) << "\n";
  } else if (!o.quiet && o.output != "-") {
    print_report(o, {report, report.header.num_frames});
  }
  if (encoded->stopped) {
    return complain(encoded->stopped->message + ". The stream ends with the " +
                    std::to_string(report.header.num_frames) + " frame" +
                    (report.header.num_frames == 1 ? "" : "s") + " before");
  }
  return report_target(o, report);
}

// Encodes to the file, and writes the vertex order if asked for.
InputResult<EncodeReport> encode_to_files(const EncodeOptions& o, FrameSource& source) {
  auto stream = OutputFile::create(o.output);
  if (!stream) return InputError{stream.error().message};
  std::optional<OutputFile> map;
  if (!o.order_map.empty()) {
    auto created = OutputFile::create(o.order_map);
    if (!created) return InputError{created.error().message};
    map.emplace(std::move(*created));
  }
  std::optional<OutputError> failure;
  InputResult<EncodeReport> report = InputError{};
  {
    ProgressBar bar("encoding", !o.quiet);
    const ByteSink sink = [&](std::span<const std::uint8_t> bytes) {
      failure = stream->write(bytes);
      return !failure;
    };
    const Progress progress = [&](double fraction) { bar.show(fraction); };
    report = encode_source(source, o, sink, progress);
  }
  if (!failure && !report) return report;
  if (!failure) failure = stream->close();
  if (!failure && map) failure = write_order(*map, *report);
  const HoldInterrupts hold;  // both files appear, or none
  if (!failure) failure = stream->commit();
  if (!failure && map) failure = map->commit();
  if (failure) return InputError{failure->message};
  return report;
}

// Returns notes if INPUT is probably not what the user meant.
std::vector<std::string> doubts(const EncodeOptions& o, const FrameSource& source) {
  const InputOptions& input = o.input;
  std::vector<std::string> notes;
  if (o.settings.low_delay && !source.attributes().later_normals.empty()) {
    notes.emplace_back(
        "--low-delay compares only the normals of the first frame: those of other frames may "
        "differ");
  }
  if (source.triangles().empty())
    notes.emplace_back("has no triangles; encoded as a point cloud");
  if (const auto& axes = source.axes_of_mesh()) {
    notes.push_back(name_of_input(input.points) + " has other axes than this mesh" +
                    (is_mirror(*axes) ? ", and is mirrored" : "") + "; --axes " +
                    axes_text(*axes) + " turns it to the axes of the mesh");
  }
  if (source.num_frames() > 1 || input.path == "-") return notes;
  const std::string cache = sibling_of(input.path, InputFormat::Holds::kPoints);
  if (!cache.empty() && is_mesh_extension(input.path)) {
    notes.push_back("is a single frame; did you mean --points " + cache + "?");
  }
  return notes;
}

// Returns an output that would overwrite an input file, including files that the input refers
// to.
std::optional<std::string> written_over(const EncodeOptions& o, const FrameSource& source) {
  for (const std::string& written : {o.output, o.order_map}) {
    for (const std::string& read : source.files()) {
      if (OutputFile::is_same_file(written, read)) return written;
    }
  }
  return std::nullopt;
}

InputResult<std::unique_ptr<FrameSource>> open_source(const InputOptions& input) {
  const Stage stage("reading");
  return open_frame_source(input);
}

int run(EncodeOptions& o) {
  if (o.is_live()) return run_live(o);
  const StageClock clock;
  auto source = open_source(o.input);
  if (!source) return complain(source.error().message);
  if (const auto written = written_over(o, **source)) {
    return complain(*written + ": is also an input; choose another name for the output",
                    kUsage);
  }
  const std::string name = o.input.more_paths.empty()
                               ? name_of_input(o.input.path)
                               : std::to_string(1 + o.input.more_paths.size()) + " files";
  std::vector<std::string> notes = (*source)->notes();
  for (std::string& doubt : doubts(o, **source)) notes.push_back(std::move(doubt));
  for (const std::string& note : notes) tell_note(o, name, note);
  if (o.dry_run) return run_dry(o, **source, clock);
  const std::size_t told = (*source)->notes().size();
  auto report = encode_to_files(o, **source);
  if (!report) return complain(report.error().message);
  for (std::size_t i = told; i < (*source)->notes().size(); ++i) {
    tell_note(o, name, (*source)->notes()[i]);
  }
  const std::uint32_t frames = report->header.num_frames;
  return tell(o, **source, {std::move(*report), frames}, clock);
}

// Makes glibc return large blocks, such as those of a GOF, to the system when they are freed.
void return_large_blocks() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

}  // namespace
}  // namespace rlpc

int main(int argc, char** argv) try {
  rlpc::handle_interrupts();
  rlpc::return_large_blocks();
  rlpc::EncodeOptions options;
  if (const auto code = rlpc::read_encode_options(argc, argv, options)) return *code;
  return rlpc::after_standard_output("rlpcenc", rlpc::run(options), rlpc::kFailed);
} catch (const std::bad_alloc&) {
  std::fprintf(stderr, "rlpcenc: out of memory; a smaller --gof needs less\n");
  return rlpc::kFailed;
} catch (const std::exception& error) {
  rlpc::print_message("rlpcenc", error.what());
  return rlpc::kFailed;
}
