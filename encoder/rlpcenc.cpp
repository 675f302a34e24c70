// rlpcenc: animations to .rlpc streams.

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "encoder/dry_run.h"
#include "encoder/input/frame_source.h"
#include "encoder/input/input_file.h"
#include "encoder/progress_bar.h"
#include "encoder/quality.h"
#include "encoder/report_json.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/stream_file.h"

namespace {

enum ExitCode : int { kDone = 0, kFailed = 1, kTargetMissed = 2, kUsage = 64 };

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

--dry-run encodes up to 1024 frames to tell the exact size. Of longer animations, it encodes eight
stretches, and says `about`.

Exit code: 0 done; 1 input or output failed; 2 written, but the target was out of reach; 64 usage.)";

struct Options {
  rlpc::InputOptions input;
  std::string output;
  std::string fps;
  std::string gof = "128";
  std::string metadata_path;
  std::string order_map;
  std::string quality;
  double kg = 0.0;
  double bpvf = 0.0;
  double max_error = 0.0;
  bool dry_run = false;
  bool json = false;
  bool quiet = false;
  rlpc::EncoderSettings settings;
};

// An option that takes one of a few words; `first` is its default.
template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& name, T& value,
                        const std::string& first, const std::map<std::string, T>& words,
                        const std::string& what) {
  std::string list = first;
  for (const auto& [word, meaning] : words) {
    if (word != first) list += "|" + word;
  }
  return app.add_option(name, value, what)
      ->transform(CLI::CheckedTransformer(words).description(""))
      ->type_name(list)
      ->default_str(first);
}

// A flag that turns off what is on without it.
CLI::Option* add_off_switch(CLI::App& app, const std::string& name, bool& value,
                            const std::string& what) {
  return app.add_flag_callback(
      name, [&value] { value = false; }, what);
}

void add_quality_options(CLI::App& app, Options& o) {
  using rlpc::Preset;
  const std::string quality = "Quality (one of; default --quality good)";
  std::vector<std::string> words;
  words.reserve(rlpc::kQualities.size());
  for (const rlpc::NamedQuality& q : rlpc::kQualities) words.emplace_back(q.word);
  auto* word = app.add_option("--quality", o.quality, "In words, by KG error: see below")
                   ->check(CLI::IsMember(words).description(""))
                   ->type_name(CLI::detail::join(words, "|"))
                   ->group(quality);
  auto* kg = app.add_option("--kg", o.kg, "KG error in per cent")->group(quality);
  auto* bpvf = app.add_option("--bpvf", o.bpvf, "Bits per vertex and frame")->group(quality);
  auto* max_error =
      app.add_option("--max-error", o.max_error, "Largest error of a vertex, in units of INPUT")
          ->group(quality);
  for (auto* option : {kg, bpvf, max_error}) option->check(CLI::PositiveNumber);
  kg->excludes(bpvf)->excludes(max_error);
  bpvf->excludes(max_error);
  word->excludes(kg)->excludes(bpvf)->excludes(max_error);
  add_choice<Preset>(
      app, "--preset", o.settings.preset, "medium",
      {{"fast", Preset::kFast}, {"medium", Preset::kMedium}, {"slow", Preset::kSlow}},
      "How hard to search: fast, medium, slow")
      ->group(quality);
}

void add_method_options(CLI::App& app, Options& o) {
  const std::string method = "Parameters of both profiles";
  add_choice<rlpc::Profile>(
      app, "--profile", o.settings.profile, "main",
      {{"main", rlpc::Profile::kMain}, {"baseline", rlpc::Profile::kBaseline}},
      "Profile of the stream: main, baseline")
      ->group(method);
  app.add_option(
         "--components", o.settings.components,
         "Components per GOF; Baseline: per cluster (L; default: by rate and distortion)")
      ->check(CLI::Range(1, 1024))
      ->group(method);
  app.add_option("--gof", o.gof, "Longest group of frames, or `all` for one group")
      ->group(method)
      ->capture_default_str();
}

void add_baseline_options(CLI::App& app, Options& o) {
  using rlpc::FrameMode;
  using rlpc::SeedMode;
  const std::string baseline = "Baseline profile alone: parameters of the RLPCA paper";
  rlpc::BaselineTools& t = o.settings.baseline;
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

void add_main_options(CLI::App& app, Options& o) {
  using rlpc::Prediction;
  const std::string tools = "Main profile alone: its tools";
  rlpc::MainTools& t = o.settings.main;
  app.add_option("--bones", t.bones, "Bones per GOF (default: chosen)")
      ->check(CLI::Range(1, 1024))
      ->group(tools);
  app.add_option("--influences", t.influences, "Most bones of a vertex (default: chosen)")
      ->check(CLI::Range(1, rlpc::kMaxExtraBones))
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
  app.add_option("--component-groups", t.component_groups,
                 "Groups of trajectories that a stream can be cut at (default: by size)")
      ->check(CLI::Range(1, 255))
      ->group(tools);
  app.add_option("--layer-groups", t.layer_groups,
                 "Groups of layers that a stream can be cut at (default: by size)")
      ->check(CLI::Range(1, 255))
      ->group(tools);
}

void add_extra_options(CLI::App& app, Options& o) {
  using rlpc::HashMode;
  const std::string extras = "What else goes in or out";
  app.add_flag("--keep-order", o.settings.keep_order, "Restore the vertex order of INPUT")
      ->group(extras);
  app.add_option("--order-map", o.order_map, "Write, per decoded vertex, its index in INPUT")
      ->excludes("--dry-run")
      ->group(extras);
  add_choice<HashMode>(
      app, "--hash", o.settings.hash_mode, "gof",
      {{"gof", HashMode::kGof}, {"frame", HashMode::kFrame}, {"none", HashMode::kNone}},
      "Hashes of decoded positions: gof, frame, none")
      ->group(extras);
  app.add_option("--metadata", o.metadata_path, "JSON file to carry along")
      ->check(CLI::ExistingFile)
      ->group(extras);
  app.add_flag("--json", o.json, "Report as JSON on standard output")->group(extras);
  app.add_flag("-q,--quiet", o.quiet, "No report, no progress")->group(extras);
}

void add_options(CLI::App& app, Options& o) {
  app.add_option("input", o.input.path, "Animation to encode; - for standard input")
      ->required();
  auto* output =
      app.add_option("-o,--output", o.output, "Stream to write; - for standard output");
  app.add_flag("--dry-run", o.dry_run, "Tell the expected size and error; write nothing")
      ->excludes(output);
  app.add_option("--points", o.input.points,
                 "Point cache (.pc2, .mdd) with the frames of INPUT; - for standard input");
  app.add_option("--fps", o.fps,
                 "Frame rate: 25, 29.97 or 30000/1001 (default: as in the input; else 30)");
  app.add_option("--animation", o.input.animation,
                 "Of a glTF file: a name, an index from 0, or `all`, one after another "
                 "(default: the first)");
  add_off_switch(app, "--no-weld", o.input.weld,
                 "Of a glTF file: keep vertices apart that coincide in every frame");
  add_quality_options(app, o);
  add_method_options(app, o);
  add_main_options(app, o);
  add_baseline_options(app, o);
  add_extra_options(app, o);
  app.footer(kExamples);
}

int complain(const std::string& message) {
  std::cerr << "rlpcenc: " << message << "\n";
  return kFailed;
}

// Settings that take more than CLI11's own conversions. False: usage.
bool finish_settings(Options& o) {
  rlpc::EncoderSettings& s = o.settings;
  if (o.output.empty() && !o.dry_run) {
    return complain("--output is required (or --dry-run)"), false;
  }
  if (o.json && o.output == "-") {
    return complain("--json and the stream cannot both go to standard output"), false;
  }
  if (!o.fps.empty()) {
    const auto rate = rlpc::parse_frame_rate(o.fps);
    if (!rate) return complain("--fps: " + rate.error().message), false;
    o.input.frame_rate = *rate;
  }
  if (o.gof == "all") {
    s.gof_frames = rlpc::EncoderSettings::kWholeSequence;
  } else {
    std::istringstream in(o.gof);
    if (!(in >> s.gof_frames) || !in.eof() || s.gof_frames == 0) {
      return complain("--gof: expected a number of frames or `all`, got `" + o.gof + "`"),
             false;
    }
  }
  for (const rlpc::NamedQuality& q : rlpc::kQualities) {
    if (o.quality == q.word) s.target = {rlpc::Target::kKg, q.kg_error_percent};
  }
  if (o.kg > 0.0) s.target = {rlpc::Target::kKg, o.kg};
  if (o.bpvf > 0.0) s.target = {rlpc::Target::kBpvf, o.bpvf};
  if (o.max_error > 0.0) s.target = {rlpc::Target::kMaxError, o.max_error};
  const bool asked = !o.quality.empty() || o.kg > 0.0 || o.bpvf > 0.0 || o.max_error > 0.0;
  if (s.baseline.qu > 0 && !asked) s.target = {rlpc::Target::kNone, 0.0};
  return true;
}

std::optional<rlpc::InputError> read_metadata(Options& o) {
  if (o.metadata_path.empty()) return std::nullopt;
  std::ifstream in(o.metadata_path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  o.settings.metadata = text.str();
  if (o.settings.metadata.size() > rlpc::kMaxMetadataBytes) {
    return rlpc::InputError{o.metadata_path + ": metadata may have at most 1 MiB"};
  }
  if (o.settings.metadata.starts_with("\xEF\xBB\xBF")) {
    return rlpc::InputError{o.metadata_path + ": begins with a byte order mark; JSON has none"};
  }
  // The library takes a zero byte for the end.
  if (o.settings.metadata.find('\0') != std::string::npos ||
      !nlohmann::json::accept(o.settings.metadata)) {
    return rlpc::InputError{o.metadata_path + ": not valid JSON in UTF-8"};
  }
  return std::nullopt;
}

std::optional<rlpc::InputError> write_order_map(const std::string& path,
                                                const rlpc::EncodeReport& report) {
  if (path.empty()) return std::nullopt;
  std::string text;
  for (const std::uint32_t v : report.input_vertex) text += std::to_string(v) + "\n";
  rlpc::StreamFile file(path);
  file.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return file.commit();
}

// `about`: the number of frames that a size is extrapolated from; 0: it is exact.
void print_report(const Options& o, const rlpc::EncodeReport& r, std::uint32_t about) {
  const rlpc::Metrics& m = r.metrics;
  const std::string name = o.dry_run ? o.input.path + " (nothing is written)" : o.output;
  std::printf("%s: %u vertices, %u triangles, %u frames, level %u\n", name.c_str(),
              r.header.num_vertices, r.header.num_triangles, r.header.num_frames,
              r.header.level_idc);
  std::printf("  %s%llu bytes, %.4f bits per vertex and frame\n", about > 0 ? "about " : "",
              static_cast<unsigned long long>(r.bytes), r.bpvf);
  if (about > 0) std::printf("  as encoded in eight stretches of %u frames in all:\n", about);
  std::printf("  KG error %.4f %%, RMS %.6g, largest %.6g (%.4f %% of the diagonal)\n",
              m.kg_error_percent, m.rms_error, m.max_error, m.max_error_percent);
  std::printf("  %u GOFs, %u clusters, %u components, %u trial%s\n", r.num_gofs, r.clusters,
              r.components, r.trials, r.trials == 1 ? "" : "s");
}

int report_target(const Options& o, const rlpc::EncodeReport& report) {
  if (report.target_met) return kDone;
  std::cerr << "rlpcenc: the target is out of reach; this is the closest. Try a "
            << (o.bpvf > 0.0 ? "higher --bpvf, or a longer --gof" : "larger error") << ".\n";
  return kTargetMissed;
}

// Who asks for a preview, or more than there is, knows.
void warn_if_visible(const Options& o, const rlpc::EncodeReport& report,
                     const rlpc::Visibility& v) {
  if (!v.visible() || o.quiet || o.quality == "preview" || !report.target_met) return;
  std::fprintf(stderr,
               "rlpcenc: the error may be seen: RMS %.3g %% of the median length of edges "
               "(above %.3g %%). Try %s.\n",
               v.error_percent, rlpc::Visibility::kVisiblePercent,
               o.bpvf > 0.0 ? "a higher --bpvf" : "a smaller error");
}

// `about`, of numbers: how many frames they were found with; 0: exact, of all.
int tell(const Options& o, rlpc::FrameSource& source, const rlpc::EncodeReport& report,
         std::uint32_t about) {
  const auto visibility = rlpc::measure_visibility(source, report.metrics);
  if (!visibility) return complain(visibility.error().message);
  if (o.json) {
    auto json = rlpc::report_json(report);
    if (*visibility) json["visibility"] = rlpc::visibility_json(**visibility);
    if (o.dry_run) {
      json["dry_run"] = {{"exact", about == 0},
                         {"frames_encoded", about == 0 ? report.header.num_frames : about}};
    }
    std::cout << json.dump(2) << "\n";
  } else if (!o.quiet && o.output != "-") {
    print_report(o, report, about);
  }
  if (*visibility) warn_if_visible(o, report, **visibility);
  return report_target(o, report);
}

int run_dry(const Options& o, rlpc::FrameSource& source) {
  rlpc::InputResult<rlpc::Expectation> expected = rlpc::InputError{};
  {
    rlpc::ProgressBar bar("encoding", !o.quiet);
    expected =
        rlpc::expect_encoding(source, o.settings, [&](double fraction) { bar.show(fraction); });
  }
  if (!expected) return complain(expected.error().message);
  return tell(o, source, expected->report, expected->exact() ? 0 : expected->frames_encoded);
}

int run(Options& o) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is an error of write(), as a full disk is
  if (!finish_settings(o)) return kUsage;
  if (auto error = read_metadata(o)) return complain(error->message);
  auto source = rlpc::open_frame_source(o.input);
  if (!source) return complain(source.error().message);
  const std::string name = rlpc::name_of_input(o.input.path);
  for (const std::string& note : (*source)->notes()) {
    if (!o.quiet) std::cerr << "rlpcenc: " << name << ": " << note << "\n";
  }
  if (o.dry_run) return run_dry(o, **source);
  rlpc::StreamFile file(o.output);
  if (!file.write({})) return complain(file.commit()->message);  // known before the work
  rlpc::InputResult<rlpc::EncodeReport> report = rlpc::InputError{};
  {
    rlpc::ProgressBar bar("encoding", !o.quiet);
    report = rlpc::encode(
        **source, o.settings,
        [&](std::span<const std::uint8_t> bytes) { return file.write(bytes); },
        [&](double fraction) { bar.show(fraction); });
  }
  const bool ended = report || !file.write({});
  if (const auto error = ended ? file.commit() : std::nullopt) return complain(error->message);
  if (!report) return complain(report.error().message);
  if (auto error = write_order_map(o.order_map, *report)) return complain(error->message);
  return tell(o, **source, *report, 0);
}

// Blocks as large as a GOF's go back to the system when they are freed. glibc would keep them,
// and a second one grow beside the first.
void return_large_blocks() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) try {
  return_large_blocks();
  CLI::App app("Encodes an animated triangle mesh as an .rlpc stream.", "rlpcenc");
  app.set_version_flag("--version", "rlpcenc " RLPC_VERSION);
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  }
  return run(options);
} catch (const std::exception& error) {
  std::fprintf(stderr, "rlpcenc: %s\n", error.what());  // out of memory, most likely
  return kFailed;
}
