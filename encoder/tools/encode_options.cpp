#include "encoder/tools/encode_options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/io/bounded_input.h"
#include "common/io/messages.h"
#include "common/io/output_file.h"
#include "encoder/sequence/check_settings.h"
#include "encoder/sequence/quality.h"

namespace rlpc {
namespace {

constexpr const char* kExamples = R"(
INPUT is one of
  mesh.obj --points cache.pc2   triangles from the mesh, positions from the point cache (PC2, MDD)
  folder/                       every .obj in it (or .ply, .off), in numeric order
  walk_%04d.obj, 'walk_*.obj'   the files that match, in numeric order
  mesh.obj                      a single frame (also .ply, .off)
  walk.glb, walk.gltf           a glTF 2.0 scene, moved by skins, morph targets and nodes
  clip.rlpd                     decoded positions
  -                             any such file from standard input
Formats are told by the extension; where it says nothing, by how the file begins.

Examples
  rlpcenc cow.obj --points cow.pc2 -o cow.rlpc             good quality (KG error 0.1 %)
  rlpcenc frames/ -o walk.rlpc --quality fine              for close looks
  rlpcenc frames/ --kg 0.3 --dry-run                       how large would it be?
  rlpcenc 'walk_*.obj' --fps 25 -o walk.rlpc --bpvf 1.5    1.5 bits per vertex and frame
  rlpcenc fox.glb --animation Run -o run.rlpc              one animation of a glTF file
  rlpcenc cow.obj --points cow.pc2 -o c.rlpc --max-error 0.001   a bound for every vertex
  rlpcenc cow.obj --points cow.pc2 -o c.rlpc --profile baseline --gof all --clusters 30 \
      --components 20 --qu 12 --qc 12 --qdelta 12 --no-rdo --frame lcf
                                                           the RLPCA paper's settings

--quality is a KG error in a word. What the mean triangle turns by, on animations of all kinds:
  preview            1 %     2 to 9 degrees: dents are seen, motion is right
  good               0.1 %   0.2 to 1.3 degrees: hardly seen; the default
  fine               0.03 %  below 0.4 degrees
  visually-lossless  0.01 %  below 0.13 degrees: half a step of a display of 8 bits
A warning tells if the RMS error is above 3 % of the median length of edges (about one degree).

--dry-run encodes up to 1024 frames (or eight times --gof, if that is more) to tell the exact size.
Of longer animations, it encodes eight stretches, and says `about`.

Exit code: 0 done; 1 input or output failed; 2 written, but the target was out of reach; 64 usage.)";

struct CommandLine {
  explicit CommandLine(EncodeOptions& to) : options(to) {}

  EncodeOptions& options;
  std::string fps;
  std::string gof = "128";
  std::string metadata_path;
  std::optional<double> kg;
  std::optional<double> bpvf;
  std::optional<double> max_error;
};

// Not so CLI11's own check, which lets NaN through.
const CLI::Validator kAboveZero(
    [](const std::string& word) {
      double value = 0.0;
      const bool number = CLI::detail::lexical_cast(word, value);
      return number && std::isfinite(value) && value > 0.0
                 ? ""
                 : "expected a number above 0, found `" + word + "`";
    },
    "NUMBER");

// An option that takes one of a few words; `first` is its default.
template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& name, T& value,
                        const std::string& first, const std::map<std::string, T>& words,
                        const std::string& what) {
  const auto set = [&value, words](const std::string& word) { value = words.at(word); };
  std::string list = first;
  for (const auto& [word, meaning] : words) {
    if (word != first) list += "|" + word;
  }
  return app.add_option_function<std::string>(name, set, what)
      ->check(CLI::IsMember(words).description(""))
      ->type_name(list)
      ->default_str(first);
}

// A flag that turns off what is on without it.
CLI::Option* add_off_switch(CLI::App& app, const std::string& name, bool& value,
                            const std::string& what) {
  return app.add_flag_callback(
      name, [&value] { value = false; }, what);
}

void add_quality_options(CLI::App& app, CommandLine& line) {
  const std::string quality = "Quality (one of; default --quality good)";
  std::vector<std::string> words;
  words.reserve(kQualities.size());
  for (const NamedQuality& q : kQualities) words.emplace_back(q.word);
  auto* word =
      app.add_option("--quality", line.options.quality, "In words, by KG error: see below")
          ->check(CLI::IsMember(words).description(""))
          ->type_name(CLI::detail::join(words, "|"))
          ->group(quality);
  auto* kg = app.add_option("--kg", line.kg, "KG error in per cent")->group(quality);
  auto* bpvf = app.add_option("--bpvf", line.bpvf, "Bits per vertex and frame")->group(quality);
  auto* max_error = app.add_option("--max-error", line.max_error,
                                   "Largest error of a vertex, in units of INPUT")
                        ->group(quality);
  for (auto* option : {kg, bpvf, max_error}) option->check(kAboveZero);
  kg->excludes(bpvf)->excludes(max_error);
  bpvf->excludes(max_error);
  word->excludes(kg)->excludes(bpvf)->excludes(max_error);
  add_choice<Preset>(
      app, "--preset", line.options.settings.preset, "medium",
      {{"fast", Preset::kFast}, {"medium", Preset::kMedium}, {"slow", Preset::kSlow}},
      "How hard to search: fast, medium, slow")
      ->group(quality);
}

void add_method_options(CLI::App& app, CommandLine& line) {
  const std::string method = "Parameters of both profiles";
  add_choice<Profile>(app, "--profile", line.options.settings.profile, "main",
                      {{"main", Profile::kMain}, {"baseline", Profile::kBaseline}},
                      "Profile of the stream: main, baseline")
      ->group(method);
  app.add_option(
         "--components", line.options.settings.components,
         "At most so many components per GOF; Baseline: as many per cluster, in the mean (L; "
         "default: by rate and distortion)")
      ->check(CLI::Range(1, 1024))
      ->group(method);
  app.add_option(
         "--gof", line.gof,
         "Longest group of frames. `all`: one group; long animations take a quarter fewer "
         "bits so, but every seek decodes the group, and both sides need more memory")
      ->group(method)
      ->capture_default_str();
}

void add_baseline_options(CLI::App& app, CommandLine& line) {
  const std::string baseline = "Baseline profile alone: parameters of the RLPCA paper";
  BaselineTools& t = line.options.settings.baseline;
  app.add_option("--clusters", t.clusters, "Clusters per GOF (N; default: chosen)")
      ->check(CLI::Range(1, 1024))
      ->group(baseline);
  app.add_option("--qu", t.qu, "Bits of eigenshapes; with --qc, in place of a quality")
      ->check(CLI::Range(2, 20))
      ->group(baseline);
  app.add_option("--qc", t.qc, "Bits of coefficients")
      ->check(CLI::Range(2, 20))
      ->group(baseline);
  app.add_option("--qdelta", t.qdelta, "Bits of seed positions (default: from the quality)")
      ->check(CLI::Range(2, 24))
      ->group(baseline);
  add_off_switch(app, "--no-rdo", t.rdo, "The same number of components in every cluster")
      ->group(baseline);
  add_choice<bool>(
      app, "--rdo-rate", t.rate_in_vectors, "bits", {{"bits", false}, {"vectors", true}},
      "With --components, what the clusters share: bits, or vectors as in the paper")
      ->group(baseline);
  add_choice<FrameMode>(
      app, "--frame", t.frame_mode, "auto",
      {{"auto", FrameMode::kAuto}, {"lcf", FrameMode::kLcf}, {"world", FrameMode::kWorld}},
      "Coordinates of clusters: auto, lcf (local frames), world")
      ->group(baseline);
  add_choice<SeedMode>(app, "--seeds", t.seed_mode, "auto",
                       {{"auto", SeedMode::kAuto},
                        {"triangle", SeedMode::kTriangle},
                        {"spread", SeedMode::kSpread}},
                       "Vertices that carry local frames: auto, triangle, spread")
      ->group(baseline);
}

void add_main_options(CLI::App& app, CommandLine& line) {
  const std::string tools = "Main profile alone: its tools; with any of these, no clusters";
  MainTools& t = line.options.settings.main;
  app.add_option("--bones", t.bones, "At most so many bones per GOF (default: chosen)")
      ->check(CLI::Range(1, 1024))
      ->group(tools);
  app.add_option("--influences", t.influences, "Most bones of a vertex (default: chosen)")
      ->check(CLI::Range(1, kMaxExtraBones))
      ->group(tools);
  static const std::map<std::string, std::optional<Prediction>> kPredictions{
      {"auto", std::nullopt},
      {"none", Prediction::kNone},
      {"parallelogram", Prediction::kParallelogram},
      {"parallelograms", Prediction::kParallelograms},
      {"layers", Prediction::kLayers}};
  app.add_option_function<std::string>(
         "--prediction",
         [&t](const std::string& word) { t.prediction = kPredictions.at(word); },
         "Of spatial factors: auto, none, parallelogram, parallelograms (all), layers")
      ->check(CLI::IsMember(kPredictions).description(""))
      ->type_name("auto|none|parallelogram|parallelograms|layers")
      ->default_str("auto")
      ->group(tools);
  add_choice<bool>(app, "--basis-steps", t.cobra_steps, "equal",
                   {{"equal", false}, {"cobra", true}},
                   "Of temporal factors: equal distortion, or as in COBRA")
      ->group(tools);
  add_off_switch(app, "--no-geometry-weights", t.geometry_weights, "Plain means of rings")
      ->group(tools);
  add_off_switch(app, "--no-outer-ring", t.outer_ring, "Predict from the inner ring only")
      ->group(tools);
  add_off_switch(app, "--no-layer-steps", t.layer_steps, "The same steps in all layers")
      ->group(tools);
  add_off_switch(app, "--no-temporal-weights", t.temporal_weights,
                 "Only the fixed predictors of temporal factors")
      ->group(tools);
  add_off_switch(app, "--no-clusters", t.clusters,
                 "Bones in all GOFs, where clusters cost less")
      ->group(tools);
  app.add_option(
         "--component-groups", t.component_groups,
         "Groups of trajectories that a stream can be cut at, one for each if there are "
         "fewer (default: by size)")
      ->check(CLI::Range(1, 255))
      ->group(tools);
  app.add_option(
         "--layer-groups", t.layer_groups,
         "Groups of layers that a stream can be cut at, one for each if there are fewer "
         "(default: by size)")
      ->check(CLI::Range(1, 255))
      ->group(tools);
}

void add_extra_options(CLI::App& app, CommandLine& line) {
  const std::string extras = "What else goes in or out";
  app.add_flag("--keep-order", line.options.settings.keep_order,
               "Restore the vertex order of INPUT")
      ->group(extras);
  app.add_option(
         "--order-map", line.options.order_map,
         "Write, per decoded vertex, its index in INPUT (of a glTF file: as it is welded)")
      ->excludes("--dry-run")
      ->excludes("--keep-order")
      ->group(extras);
  add_choice<HashMode>(
      app, "--hash", line.options.settings.hash_mode, "gof",
      {{"gof", HashMode::kGof}, {"frame", HashMode::kFrame}, {"none", HashMode::kNone}},
      "Hashes of decoded positions: gof, frame, none")
      ->group(extras);
  app.add_option("--metadata", line.metadata_path, "JSON file to carry along")
      ->check(CLI::ExistingFile)
      ->group(extras);
  app.add_option("--max-memory", line.options.settings.max_memory_bytes,
                 "Give up on input that may need more, for example 500MB (default: 32GB)")
      ->transform(CLI::AsSizeValue(false))
      ->group(extras);
  app.add_flag("--json", line.options.json, "Report as JSON on standard output")->group(extras);
  app.add_flag("-q,--quiet", line.options.quiet, "No report, no progress")->group(extras);
}

void add_options(CLI::App& app, CommandLine& line) {
  app.add_option("input", line.options.input.path, "Animation to encode; - for standard input")
      ->required();
  auto* output = app.add_option("-o,--output", line.options.output,
                                "Stream to write; - for standard output");
  app.add_flag("--dry-run", line.options.dry_run,
               "Tell the expected size and error; write nothing")
      ->excludes(output);
  app.add_option("--points", line.options.input.points,
                 "Point cache (.pc2, .mdd) with the frames of INPUT; - for standard input");
  app.add_option("--fps", line.fps,
                 "Frame rate: 25, 29.97 or 30000/1001 (default: as in the input; else 30)");
  app.add_option("--animation", line.options.input.animation,
                 "Of a glTF file: a name, else an index from 0, or `all`, one after another "
                 "(default: the first)");
  add_off_switch(app, "--no-weld", line.options.input.weld,
                 "Of a glTF file: keep vertices apart that coincide in every frame");
  add_quality_options(app, line);
  add_method_options(app, line);
  add_main_options(app, line);
  add_baseline_options(app, line);
  add_extra_options(app, line);
  app.footer(kExamples);
}

// Settings that take more than CLI11's own conversions; what is wrong with them.
std::optional<std::string> finish_settings(const CommandLine& line) {
  EncodeOptions& o = line.options;
  EncoderSettings& s = o.settings;
  if (!line.fps.empty()) {
    const auto rate = parse_frame_rate(line.fps);
    if (!rate) return "--fps: " + rate.error().message;
    o.input.frame_rate = *rate;
  }
  o.input.max_memory_bytes = s.max_memory_bytes;
  if (line.gof == "all") {
    s.gof_frames = EncoderSettings::kWholeSequence;
  } else {
    const char* const end = line.gof.data() + line.gof.size();
    const auto [rest, error] = std::from_chars(line.gof.data(), end, s.gof_frames);
    if (error != std::errc() || rest != end || s.gof_frames == 0) {
      return "--gof: expected a number of frames or `all`, found `" + line.gof + "`";
    }
  }
  for (const NamedQuality& q : kQualities) {
    if (o.quality == q.word) s.target = {Target::kKg, q.kg_error_percent};
  }
  if (line.kg) s.target = {Target::kKg, *line.kg};
  if (line.bpvf) s.target = {Target::kBpvf, *line.bpvf};
  if (line.max_error) s.target = {Target::kMaxError, *line.max_error};
  const bool asked = !o.quality.empty() || line.kg || line.bpvf || line.max_error;
  if (s.baseline.qu > 0 && !asked) s.target = {Target::kNone, 0.0};
  if (const auto error = check_settings(s)) return error->message;
  return std::nullopt;
}

// What would be written over something else that is read or written; nothing is, so far.
std::optional<std::string> check_places(const CommandLine& line) {
  const EncodeOptions& o = line.options;
  if (o.output.empty() && !o.dry_run) return "--output is required (or --dry-run)";
  const std::string standard = " cannot both go to standard output";
  if (o.output == "-" && o.json) return "--json and the stream" + standard;
  if (o.order_map == "-" && o.json) return "--json and --order-map" + standard;
  if (o.order_map == "-" && o.output == "-") return "--order-map and the stream" + standard;

  const std::array<std::string, 3> read{o.input.path, o.input.points, line.metadata_path};
  for (const std::string& written : {o.output, o.order_map}) {
    for (const std::string& other : read) {
      if (!OutputFile::is_same_file(written, other)) continue;
      return written + ": is read, too, and would be written over; give another name";
    }
  }
  if (OutputFile::is_same_file(o.output, o.order_map)) {
    return o.output + ": is given for the stream and for --order-map; give two names";
  }
  return std::nullopt;
}

std::optional<InputError> read_metadata(const CommandLine& line) {
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
  // The library takes a zero byte for the end.
  if (metadata.find('\0') != std::string::npos || !nlohmann::json::accept(metadata)) {
    return InputError{line.metadata_path + ": not valid JSON in UTF-8"};
  }
  return std::nullopt;
}

}  // namespace

int complain(const std::string& message, EncodeExitCode code) {
  print_message("rlpcenc", message);
  return code;
}

std::optional<int> read_encode_options(int argc, char** argv, EncodeOptions& options) {
  CLI::App app("Encodes an animated triangle mesh as an .rlpc stream.", "rlpcenc");
  app.set_version_flag("--version", "rlpcenc " RLPC_VERSION);
  CommandLine line(options);
  add_options(app, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    complain("more than one input, or an unknown option: " +
             CLI::detail::join(app.remaining(), " "));
    std::cerr << "Put patterns in quotes, as in 'walk_*.obj'; see rlpcenc --help\n";
    return kUsage;
  } catch (const CLI::ParseError& error) {
    return exit_of_parse(app, error) == 0 ? kEncoded : kUsage;
  }
  if (const auto wrong = check_places(line)) return complain(*wrong, kUsage);
  if (const auto wrong = finish_settings(line)) return complain(*wrong, kUsage);
  if (const auto error = read_metadata(line)) return complain(error->message);
  return std::nullopt;
}

}  // namespace rlpc
