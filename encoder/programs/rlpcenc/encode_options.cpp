#include "encoder/programs/rlpcenc/encode_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/cli/command_line.h"
#include "common/cli/frame_span.h"
#include "common/files/bounded_input.h"
#include "common/files/messages.h"
#include "common/files/output_file.h"
#include "common/json/json.h"
#include "encoder/codec/kinds/inter/frame_pattern_text.h"
#include "encoder/codec/sequence/check_settings.h"
#include "encoder/codec/sequence/target/quality.h"
#include "encoder/meshes/axes.h"
#include "encoder/meshes/input_format.h"
#include "encoder/meshes/open/open_source.h"
#include "encoder/programs/rlpcenc/encode_command_line.h"
#include "encoder/programs/setting_options.h"

namespace rlpc {
namespace {

// Parses "NAME:A-B" or "NAME:A"; none if it is something else.
std::optional<Clip> parse_clip(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return std::nullopt;
  const auto span = parse_frame_span(text.substr(colon + 1), kMaxFrames);
  if (!span || text.back() == '-' || text.back() == ':') return std::nullopt;
  return Clip{text.substr(0, colon), span->first, span->last - span->first + 1};
}

std::optional<std::string> read_clips(const EncodeCommandLine& line) {
  for (const std::string& text : line.clips) {
    auto clip = parse_clip(text);
    if (!clip) return "--clip: expected NAME:A-B, such as Run:0-29, got `" + text + "`";
    line.options.settings.clips.push_back(std::move(*clip));
  }
  return std::nullopt;
}

// Finds values of --box that are no bounds: smallest x, y, z, then largest.
std::optional<std::string> problem_of_box(const std::vector<float>& box) {
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    if (!std::isfinite(box[c]) || !std::isfinite(box[3 + c])) {
      return "--box: the bounds of " + axis + " are not finite numbers";
    }
    if (box[c] > box[3 + c]) {
      return "--box: the smallest " + axis +
             " is above the largest; give the smallest x,y,z, "
             "then the largest";
    }
  }
  return std::nullopt;
}

// Completes the settings that CLI11 cannot convert; returns the error, if any.
std::optional<std::string> finish_settings(const EncodeCommandLine& line) {
  EncodeOptions& o = line.options;
  EncoderSettings& s = o.settings;
  if (!line.fps.empty()) {
    const auto rate = parse_frame_rate(line.fps);
    if (!rate) return "--fps: " + rate.error().message;
    o.input.frame_rate = *rate;
  }
  if (!line.axes.empty()) {
    const auto axes = parse_axes(line.axes);
    if (!axes) return "--axes: " + axes.error().message;
    o.input.axes = *axes;
  }
  o.input.max_memory_bytes = s.max_memory_bytes;
  if (line.gof == "all") {
    s.gof_frames = EncoderSettings::kWholeSequence;
  } else if (line.gof) {
    const char* const end = line.gof->data() + line.gof->size();
    const auto [rest, error] = std::from_chars(line.gof->data(), end, s.gof_frames);
    if (error != std::errc() || rest != end || s.gof_frames == 0) {
      return "--gof: expected a number of frames or `all`, found `" + *line.gof + "`";
    }
  }
  if (!line.box.empty()) {
    if (!s.low_delay) return "--box needs --low-delay";
    if (auto wrong = problem_of_box(line.box)) return wrong;
    std::copy_n(line.box.begin(), 6, o.box.emplace().begin());
  }
  if (!line.frame_pattern.empty() && line.frame_pattern != "auto") {
    const auto pattern = parse_frame_pattern_text(line.frame_pattern);
    if (!pattern) {
      return "--frame-pattern: expected auto, previous, first, dyadic:16 or entries such "
             "as 2<0,1<0+2@1, found `" +
             line.frame_pattern + "`";
    }
    s.inter.pattern = *pattern;
  }
  if (line.partition && s.profile == Profile::kHigh) {
    if (*line.partition == PartitionMethod::kSeeds) {
      return "--partition: patches are not made from seeds: use motion, kway, lloyd or "
             "spectral";
    }
    s.inter.partition = *line.partition;
  } else if (line.partition) {
    s.baseline.partition = *line.partition;
  }
  s.target = kDefaultQuality.target(s.low_delay);
  for (const NamedQuality& q : kQualities) {
    if (o.quality == q.word) s.target = q.target(s.low_delay);
  }
  if (line.kg) s.target = {Target::kKg, *line.kg};
  if (line.normals) {
    const double kg = line.kg.value_or(kQualities.front().kg_error_percent);
    s.target = {Target::kKg, kg, *line.normals};
  }
  if (line.bpvf) s.target = {Target::kBpvf, *line.bpvf};
  if (line.max_error) s.target = {Target::kMaxError, *line.max_error};
  if (line.lossless) s.target = {Target::kLossless, static_cast<double>(*line.lossless)};
  if (s.usable_kind() == GofKind::kInter) {
    s.inter.temporal_layers = std::exchange(s.main.temporal_layers, 1);
    s.inter.layer_groups = std::max(std::exchange(s.main.layer_groups, 0), 1U);
    s.inter.layer_cuts = std::exchange(s.main.layer_cuts, {});
    s.inter.rest = std::exchange(s.main.rest, std::nullopt);
  }
  const bool asked = !o.quality.empty() || line.kg || line.normals || line.bpvf ||
                     line.max_error || line.lossless;
  if (s.baseline.qu > 0 && !asked) s.target = {Target::kNone, 0.0};
  if (auto wrong = read_clips(line)) return wrong;
  if (const auto error = check_settings(s)) return error->message;
  return std::nullopt;
}

// Rejects outputs that would overwrite an input or each other, before anything is written.
std::optional<std::string> check_places(const EncodeCommandLine& line) {
  const EncodeOptions& o = line.options;
  if (o.output.empty() && !o.dry_run) return "--output is required (or --dry-run)";
  if (line.inputs.size() > 1 &&
      (!o.input.points.empty() ||
       std::find(line.inputs.begin(), line.inputs.end(), "-") != line.inputs.end())) {
    return "several INPUTs are the mesh files of one sequence; they cannot be combined with "
           "--points or -";
  }
  const std::string standard = " cannot both go to standard output";
  if (o.output == "-" && o.json) return "--json and the stream" + standard;
  if (o.order_map == "-" && o.json) return "--json and --order-map" + standard;
  if (o.order_map == "-" && o.output == "-") return "--order-map and the stream" + standard;

  std::vector<std::string> read = line.inputs;
  read.insert(read.end(), {o.input.points, line.metadata_path});
  for (const std::string& written : {o.output, o.order_map}) {
    for (const std::string& other : read) {
      if (!OutputFile::is_same_file(written, other)) continue;
      return written + ": is also an input; choose another name for the output";
    }
  }
  if (OutputFile::is_same_file(o.output, o.order_map)) {
    return o.output + ": is both the stream and --order-map; choose two names";
  }
  if (format_of_extension(o.output) != nullptr) {
    return o.output + ": the output is an RLPC stream; choose a name such as " +
           std::filesystem::path(o.output).replace_extension(".rlpc").string();
  }
  return std::nullopt;
}

std::optional<InputError> read_metadata(const EncodeCommandLine& line) {
  if (line.metadata_path.empty()) return std::nullopt;
  auto text = read_small_file(line.metadata_path, kMaxMetadataBytes);
  if (!text || text->empty()) {
    return InputError{line.metadata_path +
                      ": cannot be read, is empty, or has more than 1 MiB; expected JSON"};
  }
  std::string& metadata = line.options.settings.metadata;
  metadata = std::move(*text);
  if (metadata.starts_with("\xEF\xBB\xBF")) {
    return InputError{line.metadata_path + ": begins with a byte order mark; JSON has none"};
  }
  if (const auto problem = find_json_problem(metadata, UINT64_MAX, false)) {
    return InputError{line.metadata_path + ": not valid metadata: " + problem->message};
  }
  return std::nullopt;
}

// Adds axes and unit to the metadata, with the names that USD has for them.
std::optional<InputError> note_units(const EncodeCommandLine& line) {
  const EncodeOptions& o = line.options;
  const bool is_given = !line.up_axis.empty() || line.metres_per_unit.has_value();
  // glTF is always in metres, with Y up. (A pipe must not be read to find out what it is.)
  const bool is_known = o.input.path != "-" && has_clips(o.input) && !o.input.axes &&
                        !o.settings.attributes.dropped;
  if (!is_given && !is_known) return std::nullopt;
  std::string& metadata = line.options.settings.metadata;
  JsonProblem problem;
  auto json = read_json<nlohmann::ordered_json>(metadata.empty() ? "{}" : metadata,
                                                o.settings.max_memory_bytes, problem);
  if (!json) return InputError{line.metadata_path + ": " + problem.message};
  if (!json->is_object()) {
    if (!is_given) return std::nullopt;
    return InputError{
        line.metadata_path +
        ": expected a JSON object, to which --up-axis and --metres-per-unit can add"};
  }
  if (is_known && !json->contains("upAxis")) (*json)["upAxis"] = "Y";
  if (is_known && !json->contains("metersPerUnit")) (*json)["metersPerUnit"] = 1;
  if (!line.up_axis.empty()) (*json)["upAxis"] = line.up_axis == "y" ? "Y" : "Z";
  if (line.metres_per_unit) (*json)["metersPerUnit"] = *line.metres_per_unit;
  metadata = json_text(*json);
  return std::nullopt;
}

}  // namespace

int complain(const std::string& message, EncodeExitCode code) {
  print_message("rlpcenc", with_encoder_options(message));
  return code;
}

std::optional<int> read_encode_options(int argc, char** argv, EncodeOptions& options) {
  CLI::App app("Encodes an animated triangle mesh as an .rlpc stream.", "rlpcenc");
  EncodeCommandLine line(options);
  add_encode_options(app, line);
  if (const auto code = parse_command_line(app, argc, argv)) return code;
  if (const std::string advice = point_cache_advice(app); !advice.empty()) {
    return complain(advice, kUsage);
  }
  options.input.path = line.inputs[0];
  options.input.more_paths.assign(line.inputs.begin() + 1, line.inputs.end());
  if (const auto wrong = check_places(line)) return complain(*wrong, kUsage);
  if (const auto wrong = finish_settings(line)) return complain(*wrong, kUsage);
  if (const auto error = read_metadata(line)) return complain(error->message);
  if (const auto error = note_units(line)) return complain(error->message);
  return std::nullopt;
}

}  // namespace rlpc
