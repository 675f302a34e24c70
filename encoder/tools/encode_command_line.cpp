#include "encoder/tools/encode_command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <thread>
#include <vector>

#include "common/syntax/sequence_header.h"
#include "common/tools/command_line.h"
#include "encoder/sequence/target/quality.h"

namespace rlpc {
namespace {

constexpr const char* kExamples = R"(Examples
  rlpcenc cow.obj --points cow.pc2 -o cow.rlpc
  rlpcenc frames/ -o walk.rlpc --quality fine
  rlpcenc 'walk_*.obj' --fps 25 -o walk.rlpc --bpvf 1.5
  rlpcenc fox.glb --animation Run -o run.rlpc)";

constexpr const char* kDetails = R"(More examples
  rlpcenc frames/ --kg 0.3 --dry-run                     how large would it be?
  rlpcenc cow.obj --points cow.pc2 -o c.rlpc --max-error 0.01
  rlpcenc cow.obj --points cow.pc2 -o c.rlpc --profile high --lossless 14
  capture | rlpcenc cow.obj --points - -o - --profile high --low-delay | send
  rlpcenc cow.obj --points cow.pc2 -o c.rlpc --profile baseline --gof all \
      --clusters 30 --components 20 --qu 12 --qc 12 --qdelta 12 --no-rdo \
      --frame lcf                         the settings of the RLPCA paper

INPUT is one of
  mesh.obj --points cache.pc2   triangles from the mesh (OBJ, PLY, OFF), frames
                                from the point cache (PC2, MDD)
  folder/                       every .obj in it (or .ply, .off), in numeric
                                order
  walk_%04d.obj, 'walk_*.obj'   the matching files, in numeric order
  mesh.obj                      a single frame (also .ply, .off)
  walk.glb, walk.gltf           a glTF 2.0 scene: skins, morph targets, animated
                                nodes
  clip.rlpd                     decoded positions
  -                             any single file, from standard input

The format is taken from the extension, otherwise detected from the contents.

Texture coordinates, normals and colours of OBJ and PLY files are kept, and the
number of the material of each triangle. A sequence has those of its first file,
a point cache those of its mesh. Vertices are not split along seams.

Qualities
  word               KG error   mean normal deviation
  preview            1 %        2 to 9 degrees: dents are visible
  good (default)     0.1 %      0.2 to 1.3 degrees: hardly visible
  fine               0.03 %     below 0.4 degrees
  visually-lossless  0.01 %     below 0.13 degrees: half a step of an 8-bit
                                display

The KG error (Karni and Gotsman) is the RMS distance between original and
decoded vertices, divided by the RMS distance of the vertices from the centre of
their frame. rlpcenc warns if the RMS error exceeds 3 % of the median edge
length, a mean normal deviation of about one degree.

--lossless restores every coordinate as the 32-bit float that it is (-0 as 0),
--lossless BITS as it is once rounded to the finest grid, of a step that is a
power of two, on which the box needs at most BITS bits. The order of vertices
and triangles is not kept (--keep-order keeps that of vertices), nor is
anything else in INPUT. Sampled glTF is kept as sampled.

--dry-run encodes animations of up to 1024 frames (or eight GOFs, if that is
more) and reports the exact size. Of longer ones it encodes eight sections and
reports an estimate ("about").

--low-delay reads RLPD from INPUT -, or PC2 from --points -, up to its end,
whatever its number of frames says, and writes each frame before it waits for
the next. The stream is then open-ended: rlpcdec writes its frames as they
arrive. If the input fails, OUT ends with the frame before. Quality is --kg,
--max-error or --lossless BITS; the KG error is that of the whole, and met
approximately.

--frame-pattern FRAME<REFERENCES, ... lists the frames of a period in the order
in which they are coded, counted from 1, with one or two references each, and
@DEPTH if they are deeper than these; 0 is the last frame of the period before.
dyadic:4 is 4<0,2<0+4@1,1<0+2@2,3<2+4@2. --temporal-layers N makes layers of the
N - 1 greatest depths, --layer-groups N of vertex layers: frames and details
that rlpcinfo --extract can remove.

--up-axis and --metres-per-unit become upAxis and metersPerUnit of the metadata,
as USD names them. They say what the positions of OUT are; --axes turns them.

Exit code: 0 done; 1 input or output failed; 2 written, but the target was not
reached; 64 wrong usage.)";

// Option groups of the help page.
constexpr const char* kInput = "Input";
constexpr const char* kQuality = "Quality (at most one; default: --quality good)";
constexpr const char* kOutput = "Output";
constexpr const char* kMoreInput = "More input";
constexpr const char* kMore = "More output";

std::vector<std::string> quality_words() {
  std::vector<std::string> words;
  words.reserve(kQualities.size());
  for (const NamedQuality& q : kQualities) words.emplace_back(q.word);
  return words;
}

// The check of CLI11 itself accepts NaN.
const CLI::Validator kAboveZero(
    [](const std::string& word) {
      double value = 0.0;
      const bool number = CLI::detail::lexical_cast(word, value);
      return number && std::isfinite(value) && value > 0.0
                 ? ""
                 : "expected a number above 0, found `" + word + "`";
    },
    "NUMBER");

// Of --lossless: 0 for an empty text; none if it is neither that nor a number of bits.
std::optional<int> parse_bits(const std::string& text) {
  if (text.empty()) return 0;
  int bits = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, bits);
  const bool valid = error == std::errc() && rest == end && bits >= kMinPositionBits &&
                     bits <= kMaxPositionBits;
  return valid ? std::optional(bits) : std::nullopt;
}

const CLI::Validator kBits(
    [](const std::string& word) {
      return parse_bits(word) ? ""
                              : "expected nothing, or a number of bits from 2 to 24, found `" +
                                    word + "`; give INPUT before --lossless";
    },
    "");

// Adds an option that takes one of a few words.
template <class T, class To>
CLI::Option* add_choice(CLI::App& app, const std::string& name, To& value,
                        const std::map<std::string, T>& words, const std::string& what) {
  const auto set = [&value, words](const std::string& word) { value = words.at(word); };
  return app.add_option_function<std::string>(name, set, what)
      ->check(CLI::IsMember(words).description(""))
      ->option_text("WORD");
}

// Adds a flag that turns off a default.
CLI::Option* add_off_switch(CLI::App& app, const std::string& name, bool& value,
                            const std::string& what) {
  return app.add_flag_callback(
      name, [&value] { value = false; }, what);
}

void add_input_options(CLI::App& app, EncodeCommandLine& line) {
  app.add_option("INPUT", line.options.input.path,
                 "Mesh, folder or pattern of meshes, or glTF file; - for standard input")
      ->required();
  app.add_option("--points", line.options.input.points,
                 "Point cache (.pc2, .mdd) with the frames of INPUT")
      ->option_text("FILE")
      ->group(kInput);
  app.add_option("--fps", line.fps,
                 "Frame rate: 25, 29.97 or 30000/1001 (default: from INPUT, otherwise 30)")
      ->option_text("RATE")
      ->group(kInput);
  app.add_option("--axes", line.axes,
                 "New x, y and z in axes of INPUT: x,z,-y turns Z-up to Y-up, x,-z,y back")
      ->option_text("X,Y,Z")
      ->group(kMoreInput);
  app.add_option("--animation", line.options.input.animation,
                 "glTF: name, index from 0, or `all` in sequence (default: first)")
      ->option_text("NAME")
      ->group(kInput);
  add_off_switch(app, "--no-weld", line.options.input.weld,
                 "glTF: keep vertices that coincide in every frame apart")
      ->group(kInput);
}

void add_quality_options(CLI::App& app, EncodeCommandLine& line) {
  auto* word = app.add_option("--quality", line.options.quality,
                              CLI::detail::join(quality_words(), ", "))
                   ->check(CLI::IsMember(quality_words()).description(""))
                   ->option_text("WORD")
                   ->group(kQuality);
  auto* kg = app.add_option("--kg", line.kg, "KG error in per cent")->option_text("PERCENT");
  auto* bpvf = app.add_option("--bpvf", line.bpvf, "Bits per vertex and frame");
  auto* max_error =
      app.add_option("--max-error", line.max_error, "Largest vertex error, in units of INPUT");
  bpvf->option_text("BITS");
  max_error->option_text("DISTANCE");
  for (auto* option : {kg, bpvf, max_error}) option->check(kAboveZero)->group(kQuality);
  auto* lossless =
      app.add_option_function<std::string>(
             "--lossless",
             [&line](const std::string& bits) { line.lossless = parse_bits(bits); },
             "Exact floats, or exact on a grid of at most BITS bits (High profile)")
          ->expected(0, 1)
          ->check(kBits)
          ->option_text("[BITS]")
          ->group(kQuality);
  const std::array<CLI::Option*, 5> options{word, kg, bpvf, max_error, lossless};
  for (auto a = options.begin(); a != options.end(); ++a) {
    for (auto b = a + 1; b != options.end(); ++b) (*a)->excludes(*b);
  }
}

void add_output_options(CLI::App& app, EncodeCommandLine& line) {
  EncodeOptions& o = line.options;
  auto* output =
      app.add_option("-o,--output", o.output, "Stream to write; - for standard output")
          ->option_text("FILE")
          ->group(kOutput);
  auto* dry_run =
      app.add_flag("--dry-run", o.dry_run, "Report the expected size and error; write nothing")
          ->excludes(output)
          ->group(kOutput);
  add_choice<Preset>(
      app, "--preset", o.settings.preset,
      {{"fast", Preset::kFast}, {"medium", Preset::kMedium}, {"slow", Preset::kSlow}},
      "Search effort: fast, medium (default), slow")
      ->group(kOutput);
  app.add_option("--gof", line.gof,
                 "Maximum frames per group (default: 128; 256 with --profile high), or `all`: "
                 "smallest file, slow seeking")
      ->option_text("FRAMES")
      ->group(kOutput);
  app.add_flag("--low-delay", o.settings.low_delay,
               "Encode each frame as it arrives, also from standard input; larger files "
               "(High profile)")
      ->excludes(dry_run)
      ->group(kMore);
  auto* keep_order =
      app.add_flag("--keep-order", o.settings.keep_order, "Store the vertex order of INPUT")
          ->group(kOutput);
  app.add_flag("--json", o.json, "Report as JSON on standard output")->group(kOutput);
  app.add_flag("-v,--verbose", o.verbose, "Also report the encoder's choices")->group(kOutput);
  app.add_flag("-q,--quiet", o.quiet, "No report, no progress")->group(kOutput);

  app.add_option("--box", line.box,
                 "With --low-delay: bounds of all frames, smallest x,y,z and largest (default: "
                 "from INPUT; 8 times the size of the first frame if it is a pipe)")
      ->delimiter(',')
      ->expected(6)
      ->option_text("X,Y,Z,X,Y,Z")
      ->group(kMore);
  app.add_option("--order-map", o.order_map,
                 "Write, per decoded vertex, its index in INPUT (glTF: after welding)")
      ->option_text("FILE")
      ->excludes(dry_run)
      ->excludes(keep_order)
      ->group(kMore);
  add_choice<HashMode>(
      app, "--hash", o.settings.hash_mode,
      {{"gof", HashMode::kGof}, {"frame", HashMode::kFrame}, {"none", HashMode::kNone}},
      "Hashes of decoded positions, one per: gof (default), frame, none")
      ->group(kMore);
  app.add_option("--metadata", line.metadata_path, "JSON file to carry along")
      ->check(CLI::ExistingFile)
      ->option_text("FILE")
      ->group(kMore);
  app.add_option("--up-axis", line.up_axis, "Note in the metadata which axis is up: y or z")
      ->check(CLI::IsMember({"y", "z"}).description(""))
      ->option_text("WORD")
      ->group(kMore);
  app.add_option("--metres-per-unit", line.metres_per_unit,
                 "Note in the metadata how long a unit is: 0.01 for centimetres")
      ->check(kAboveZero)
      ->option_text("METRES")
      ->group(kMore);
  app.add_option("--clip", line.clips,
                 "Name a part of the animation, frames A to B counted from 0; may be repeated "
                 "(default: those that --animation all joins)")
      ->option_text("NAME:A-B")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(kMore);
  app.add_option("--max-memory", o.settings.max_memory_bytes,
                 "Refuse input that may need more, for example 500MB (default: 32GB)")
      ->transform(CLI::AsSizeValue(false))
      ->option_text("SIZE")
      ->group(kMore);
  o.settings.threads = std::clamp(std::thread::hardware_concurrency(), 1U, kMaxEncoderThreads);
  app.add_option("--threads", o.settings.threads,
                 "1 to 256, fewer if memory is short; the stream does not depend on it "
                 "(default: one per processor)")
      ->check(CLI::Range(std::uint32_t{1}, kMaxEncoderThreads))
      ->option_text("N")
      ->group(kMore);
}

void add_attribute_options(CLI::App& app, EncodeCommandLine& line) {
  const std::string group = "Texture coordinates, normals, colours, materials";
  AttributeSettings& a = line.options.settings.attributes;
  app.add_flag("--no-attributes", a.dropped, "Positions and triangles alone")->group(group);
  add_off_switch(app, "--no-textures", line.options.input.textures,
                 "glTF: leave images out of the materials")
      ->group(group);
  app.add_option("--uv-bits", a.uv_bits,
                 "Texture coordinates in steps of 1/2^N of an image (default: 12)")
      ->check(CLI::Range(1, 16))
      ->option_text("N")
      ->group(group);
  add_choice<NormalChoice>(app, "--normals", a.normals,
                           {{"auto", NormalChoice::kAuto},
                            {"smoothing", NormalChoice::kSmoothing},
                            {"exact", NormalChoice::kExact}},
                           "Normals: smoothing (which faces share them: computed for every "
                           "frame), exact (those of the first frame), auto (smoothing if it "
                           "comes near those of INPUT, default)")
      ->group(group);
  app.add_option("--normal-bits", a.normal_bits,
                 "With exact normals: bits of each of their two coordinates (default: 10)")
      ->check(CLI::Range(2, 16))
      ->option_text("N")
      ->group(group);
  app.add_flag("--exact-attributes", a.exact, "32-bit floats, without loss")->group(group);
}

void add_method_options(CLI::App& app, EncodeCommandLine& line) {
  const std::string method = "All profiles";
  add_choice<Profile>(
      app, "--profile", line.options.settings.profile,
      {{"high", Profile::kHigh}, {"main", Profile::kMain}, {"baseline", Profile::kBaseline}},
      "Profile of the stream: main (default), baseline, or high (version 1.2, in preparation)")
      ->group(method);
  add_choice<KindChoice>(app, "--gof-kind", line.options.settings.kinds,
                         {{"auto", KindChoice::kAuto},
                          {"clusters", KindChoice::kClusters},
                          {"bones", KindChoice::kBones},
                          {"frames", KindChoice::kFrames}},
                         "Groups of frames: auto (the cheapest, default), clusters, bones, "
                         "frames (each from decoded ones, High profile)")
      ->group(method);
  app.add_option("--components", line.options.settings.components,
                 "Maximum per GOF; Baseline: average per cluster, L of the paper (default: by "
                 "rate and distortion)")
      ->check(CLI::Range(1, 1024))
      ->option_text("N")
      ->group(method);
  add_choice<PartitionMethod>(
      app, "--partition", line.partition,
      {{"seeds", PartitionMethod::kSeeds},
       {"kway", PartitionMethod::kKway},
       {"lloyd", PartitionMethod::kLloyd},
       {"spectral", PartitionMethod::kSpectral},
       {"motion", PartitionMethod::kMotion}},
      "What makes clusters of the Baseline profile and patches of the High profile: seeds "
      "(motion relative to them; default of Baseline), kway (few edges between equal parts), "
      "lloyd (near vertices), spectral (concave creases), motion (affine; default of High)")
      ->group(method);
}

void add_frame_options(CLI::App& app, EncodeCommandLine& line) {
  const std::string frames = "GOFs of frames, High profile";
  FrameTools& t = line.options.settings.frames;
  app.add_option(
         "--frame-pattern", line.frame_pattern,
         "What frames are predicted from: previous (the one before), first (of the GOF), "
         "dyadic (those around, in periods of 2, 4, ... 64: dyadic:16), entries (see below), "
         "or "
         "auto (default: the cheapest of previous, first, dyadic:16 and dyadic:64 for each "
         "GOF)")
      ->option_text("WORD")
      ->group(frames);
  add_choice<FrameWeights>(
      app, "--frame-weights", t.weights,
      {{"learned", FrameWeights::kLearned},
       {"geometry", FrameWeights::kGeometry},
       {"plain", FrameWeights::kPlain}},
      "Weights of prediction: learned (from the frames before, default), geometry (from the "
      "first; larger, faster), plain (equal ones, as in the SSLPC paper)")
      ->group(frames);
  app.add_option(
         "--patches", t.patches,
         "Parts of the mesh that can each follow one affine motion in a frame, in place "
         "of their neighbours; 0: none (default: the cheapest of 0, 16 and 48 for each "
         "GOF)")
      ->check(CLI::Range(0, 1024))
      ->option_text("N")
      ->group(frames);
  app.add_option("--frames-per-unit", t.frames_per_unit,
                 "Frames that share a unit of the stream, at most (default: some 4 kB of "
                 "them; always one with --low-delay or several --layer-groups)")
      ->check(CLI::Range(1, 65536))
      ->option_text("N")
      ->group(frames);
}

void add_baseline_options(CLI::App& app, EncodeCommandLine& line) {
  const std::string baseline = "Baseline profile only: parameters of the RLPCA paper";
  BaselineTools& t = line.options.settings.baseline;
  const auto add_number = [&](const char* name, auto& value, int least, int most,
                              const char* what) {
    app.add_option(name, value, what)
        ->check(CLI::Range(least, most))
        ->option_text("N")
        ->group(baseline);
  };
  add_number("--clusters", t.clusters, 1, 1024,
             "Clusters per GOF, N of the paper (default: chosen)");
  add_number("--qu", t.qu, 2, 20, "Bits of eigenshapes; with --qc, instead of a quality");
  add_number("--qc", t.qc, 2, 20, "Bits of coefficients");
  add_number(
      "--qdelta", t.qdelta, 2, 24,
      "Bits of seed positions, for the mean bounding box of the frames (default: from the "
      "quality)");
  add_off_switch(app, "--no-rdo", t.rdo, "The same number of components in every cluster")
      ->group(baseline);
  add_choice<bool>(app, "--rdo-rate", t.rate_in_vectors, {{"bits", false}, {"vectors", true}},
                   "With --components, the budget that clusters share: bits (default), or "
                   "vectors as in the paper")
      ->group(baseline);
  add_choice<FrameMode>(
      app, "--frame", t.frame_mode,
      {{"auto", FrameMode::kAuto}, {"lcf", FrameMode::kLcf}, {"world", FrameMode::kWorld}},
      "Coordinates of clusters: auto (default), lcf (local coordinate frames), world")
      ->group(baseline);
  add_choice<SeedMode>(app, "--seeds", t.seed_mode,
                       {{"auto", SeedMode::kAuto},
                        {"first", SeedMode::kFirst},
                        {"triangle", SeedMode::kTriangle},
                        {"spread", SeedMode::kSpread}},
                       "Vertices that carry local coordinate frames: auto (default), first or "
                       "triangle (the first or the most stable triangle at a vertex), spread")
      ->group(baseline);
  add_choice<MotionMeasure>(
      app, "--motion", t.motion,
      {{"auto", MotionMeasure::kAuto},
       {"squared", MotionMeasure::kSquared},
       {"plain", MotionMeasure::kPlain}},
      "Of motion relative to seeds, the sum of: squared or plain distances "
      "(default: squared; with --qu, the cheaper)")
      ->group(baseline);
}

void add_main_options(CLI::App& app, EncodeCommandLine& line) {
  const std::string tools = "Main and High profiles only; any of these disables cluster GOFs";
  MainTools& t = line.options.settings.main;
  const auto add_number = [&](const char* name, std::uint32_t& value, std::uint32_t most,
                              const char* what) {
    app.add_option(name, value, what)
        ->check(CLI::Range(std::uint32_t{1}, most))
        ->option_text("N")
        ->group(tools);
  };
  add_number("--bones", t.bones, 1024, "Maximum bones per GOF (default: chosen)");
  add_number("--influences", t.influences, kMaxExtraBones,
             "Maximum bones per vertex (default: chosen)");
  add_choice<std::optional<Prediction>>(
      app, "--prediction", t.prediction,
      {{"auto", std::nullopt},
       {"none", Prediction::kNone},
       {"parallelogram", Prediction::kParallelogram},
       {"parallelograms", Prediction::kParallelograms},
       {"layers", Prediction::kLayers}},
      "Of spatial factors: auto (default), none, parallelogram, parallelograms (all), layers")
      ->group(tools);
  add_choice<bool>(app, "--basis-steps", t.cobra_steps, {{"equal", false}, {"cobra", true}},
                   "Quantiser steps of temporal factors: equal (distortion, default), cobra")
      ->group(tools);
  add_off_switch(app, "--no-geometry-weights", t.geometry_weights,
                 "Predict with plain weights, which do not depend on the rest shape")
      ->group(tools);
  add_off_switch(app, "--no-outer-ring", t.outer_ring, "Predict from the inner ring only")
      ->group(tools);
  add_off_switch(app, "--no-layer-steps", t.layer_steps,
                 "The same quantiser steps in all layers")
      ->group(tools);
  add_off_switch(app, "--no-temporal-weights", t.temporal_weights,
                 "Only the fixed predictors of temporal factors")
      ->group(tools);
  add_off_switch(app, "--no-clusters", t.clusters,
                 "Bones in all GOFs, even where clusters cost less")
      ->group(tools);
  app.add_option("--adaptive-factors", t.adaptive_factors,
                 "Trajectories that adapt prediction weights, High profile (default: all)")
      ->check(CLI::Range(std::uint32_t{0}, kLevels.back().max_components))
      ->option_text("N")
      ->group(tools);
  add_choice<std::optional<RestTools>>(
      app, "--rest", t.rest,
      {{"auto", std::nullopt},
       {"prediction", RestTools::kPrediction},
       {"order", RestTools::kOrder},
       {"counterparts", RestTools::kCounterparts}},
      "Coding of rest positions and first frames, High profile: auto (default, all of these), "
      "prediction (as "
      "other values), order (also in an order of their own), counterparts (also from parts of "
      "the same shape)")
      ->group(tools);
  app.add_option("--track-levels", t.track_levels,
                 "Levels of hierarchical tracks, High profile; 0: none (default: 1)")
      ->check(CLI::Range(0, kMaxTrackLevels))
      ->option_text("N")
      ->group(tools);
  app.add_option("--temporal-layers", t.temporal_layers,
                 "Temporal layers that a stream can be cut to, High profile (default: 1)")
      ->check(CLI::Range(1, kMaxTrackLevels + 1))
      ->option_text("N")
      ->group(tools);
  add_number("--component-groups", t.component_groups, 255,
             "Cut points among trajectories, at most one each (default: by size)");
  add_number("--layer-groups", t.layer_groups, 255,
             "Cut points among vertex layers, at most one each (default: by size)");
}

}  // namespace

void add_encode_options(CLI::App& app, EncodeCommandLine& line) {
  add_input_options(app, line);
  add_quality_options(app, line);
  add_output_options(app, line);
  add_attribute_options(app, line);
  add_method_options(app, line);
  add_main_options(app, line);
  add_frame_options(app, line);
  add_baseline_options(app, line);
  add_help(app,
           {"INPUT [--points CACHE] -o OUT.rlpc [OPTIONS]",
            {kInput, kQuality, kOutput},
            kExamples,
            kDetails},
           RLPC_VERSION);
}

}  // namespace rlpc
