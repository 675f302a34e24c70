#include "encoder/programs/rlpcenc/method_options.h"

#include <map>
#include <optional>
#include <string>

#include "common/codec/syntax/gof_header.h"
#include "encoder/codec/kind_choices.h"

namespace rlpc {
namespace {

void add_attribute_options(CLI::App& app, EncodeCommandLine& line) {
  const std::string group = "Texture coordinates, normals, colours, materials";
  AttributeSettings& a = line.options.settings.attributes;
  app.add_flag("--no-attributes", a.dropped, "Positions and triangles only")->group(group);
  Images& images = line.options.input.images;
  auto* const no_textures = app.add_flag_callback(
      "--no-textures", [&images] { images = Images::kNone; },
      "Leave images out of the materials");
  no_textures->group(group);
  app.add_flag_callback(
         "--exact-images", [&images] { images = Images::kExact; },
         "Keep image files as they are (default: PNG images are deflated again where that "
         "saves bytes; their pixels stay)")
      ->excludes(no_textures)
      ->group(group);
  auto* const uv_bits =
      app.add_option("--uv-bits", a.uv_bits,
                     "Texture coordinates in steps of 1/2^N of an image (default: 12); coarser "
                     "where they repeat a small image");
  uv_bits->check(CLI::Range(1, 16))->option_text("N")->group(group);
  add_choice<NormalChoice>(
      app, "--stored-normals", a.normals,
      {{"auto", NormalChoice::kAuto},
       {"smoothing", NormalChoice::kSmoothing},
       {"exact", NormalChoice::kExact}},
      "Normals of INPUT: smoothing (which faces share them; computed for every frame), exact "
      "(as in the first frame; turn with the surface), auto (default: for each, whichever is "
      "nearer to INPUT in decoded frames)")
      ->group(group);
  auto* const normal_bits = app.add_option(
      "--normal-bits", a.normal_bits,
      "Bits of each of the two coordinates of exact normals (default: 8, up to 0.6 degrees "
      "off)");
  normal_bits->check(CLI::Range(2, 16))->option_text("N")->group(group);
  app.add_flag("--exact-attributes", a.exact,
               "Store numbers as 32-bit floats (texture coordinates as 1 - v, colours linear, "
               "as in glTF), normals with 16 bits per coordinate")
      ->excludes(uv_bits)
      ->excludes(normal_bits)
      ->group(group);
}

// Returns ", cluster, skinned (Main profile and above), inter (High profile)".
std::string names_of_kinds() {
  std::string names;
  for (const GofKind kind : kKindChoices) {
    names += std::string(", ") + kind_name(kind);
    const std::uint32_t lowest = properties_of(kind).profile_idc;
    if (lowest > kProfileBaseline) {
      names += std::string(" (") + kProfileNames[lowest] + " profile" +
               (lowest + 1 < kProfileNames.size() ? " and above)" : ")");
    }
  }
  return names;
}

void add_profile_options(CLI::App& app, EncodeCommandLine& line) {
  const std::string method = "All profiles";
  add_choice<Profile>(
      app, "--profile", line.options.settings.profile,
      {{"high", Profile::kHigh}, {"main", Profile::kMain}, {"baseline", Profile::kBaseline}},
      "Profile of the stream: main (default), baseline, or high (version 1.2, in preparation)")
      ->group(method);
  std::map<std::string, std::optional<GofKind>> kinds{{"auto", std::nullopt}};
  for (const GofKind kind : kKindChoices) kinds[kind_name(kind)] = kind;
  add_choice<std::optional<GofKind>>(
      app, "--gof-kind", line.options.settings.gof_kind, kinds,
      "Kind of GOFs: auto (default: the cheapest for each)" + names_of_kinds())
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
      "Method that makes clusters of the Baseline profile and patches of the High profile: "
      "seeds (motion relative to seeds; default of Baseline), kway (few edges between equal "
      "parts), lloyd (near vertices), spectral (concave creases), motion (affine; default of "
      "High)")
      ->group(method);
}

void add_frame_options(CLI::App& app, EncodeCommandLine& line) {
  const std::string frames = "Inter GOFs, High profile";
  InterTools& t = line.options.settings.inter;
  app.add_option(
         "--frame-pattern", line.frame_pattern,
         "References of frames: previous (frame), first (of the GOF), dyadic (the frames "
         "around, in periods of 2, 4, ... 64: dyadic:16), entries (see below), or auto "
         "(default: the cheapest of previous, first, dyadic:16 and dyadic:64 for each GOF)")
      ->option_text("WORD")
      ->group(frames);
  add_choice<InterWeights>(
      app, "--frame-weights", t.weights,
      {{"learned", InterWeights::kLearned},
       {"geometry", InterWeights::kGeometry},
       {"plain", InterWeights::kPlain}},
      "Prediction weights: learned (default, from the frames before), geometry (from the "
      "first frame; larger, faster), plain (equal, as in the SSLPC paper)")
      ->group(frames);
  app.add_option(
         "--patches", t.patches,
         "Number of parts of the mesh that can be predicted by one affine motion per frame; "
         "0: none (default: the cheapest of 0, 16 and 48 for each GOF)")
      ->check(CLI::Range(0, 1024))
      ->option_text("N")
      ->group(frames);
  app.add_option("--frames-per-unit", t.frames_per_unit,
                 "Maximum frames that share a unit of the stream (default: about 4 kB; always "
                 "one with --low-delay)")
      ->check(CLI::Range(1, 65536))
      ->option_text("N")
      ->group(frames);
}

void add_baseline_options(CLI::App& app, EncodeCommandLine& line) {
  const std::string baseline = "Baseline profile only: parameters of the RLPCA paper";
  BaselineTools& t = line.options.settings.baseline;
  const auto add_number = [&](const char* name, auto& value, int min, int max,
                              const char* what) {
    app.add_option(name, value, what)
        ->check(CLI::Range(min, max))
        ->option_text("N")
        ->group(baseline);
  };
  add_number("--clusters", t.clusters, 1, 1024,
             "Clusters per GOF, N of the paper (default: chosen)");
  add_number("--qu", t.qu, 2, 20, "Bits of eigenshapes; with --qc, replaces a quality");
  add_number("--qc", t.qc, 2, 20, "Bits of coefficients");
  add_number(
      "--qdelta", t.qdelta, 2, 24,
      "Bits of seed positions, over the mean bounding box of the frames (default: from the "
      "quality)");
  add_off_switch(app, "--no-rdo", t.rdo, "Use the same number of components in every cluster")
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
                       "Vertices that define local coordinate frames: first or triangle (the "
                       "first or the most stable triangle at a vertex), spread (distant "
                       "vertices of the cluster), auto (default: spread; with --qu, the "
                       "cheapest)")
      ->group(baseline);
  add_choice<MotionMeasure>(
      app, "--motion", t.motion,
      {{"auto", MotionMeasure::kAuto},
       {"squared", MotionMeasure::kSquared},
       {"plain", MotionMeasure::kPlain}},
      "Measure of motion relative to seeds: sum of squared or plain distances "
      "(default: squared; with --qu, the cheaper)")
      ->group(baseline);
}

constexpr const char* kTools =
    "Main and High profiles only; any of these disables cluster GOFs";

void add_number(CLI::App& app, const char* name, std::uint32_t& value, std::uint32_t max,
                const char* what) {
  app.add_option(name, value, what)
      ->check(CLI::Range(std::uint32_t{1}, max))
      ->option_text("N")
      ->group(kTools);
}

void add_main_tools(CLI::App& app, MainTools& t) {
  add_number(app, "--bones", t.bones, 1024, "Maximum bones per GOF (default: chosen)");
  add_number(app, "--influences", t.influences, kMaxExtraBones,
             "Maximum bones per vertex (default: chosen)");
  add_choice<std::optional<Prediction>>(
      app, "--prediction", t.prediction,
      {{"auto", std::nullopt},
       {"none", Prediction::kNone},
       {"parallelogram", Prediction::kParallelogram},
       {"parallelograms", Prediction::kParallelograms},
       {"layers", Prediction::kLayers}},
      "Prediction of spatial factors: auto (default), none, parallelogram, parallelograms "
      "(all), layers")
      ->group(kTools);
  add_choice<bool>(
      app, "--basis-steps", t.cobra_steps, {{"equal", false}, {"cobra", true}},
      "Quantiser steps of temporal factors: equal (default: equal distortion), cobra")
      ->group(kTools);
  add_off_switch(app, "--no-geometry-weights", t.geometry_weights,
                 "Predict with plain weights, which do not depend on the rest shape")
      ->group(kTools);
  add_off_switch(app, "--no-outer-ring", t.outer_ring, "Predict from the inner ring only")
      ->group(kTools);
  add_off_switch(app, "--no-layer-steps", t.layer_steps,
                 "Use the same quantiser steps in all layers")
      ->group(kTools);
  add_off_switch(app, "--no-temporal-weights", t.temporal_weights,
                 "Use only the fixed predictors of temporal factors")
      ->group(kTools);
  add_off_switch(app, "--no-clusters", t.clusters, "No cluster GOFs, even where they cost less")
      ->group(kTools);
}

void add_high_tools(CLI::App& app, MainTools& t) {
  app.add_option("--adaptive-factors", t.adaptive_factors,
                 "Trajectories that adapt prediction weights, High profile (default: all)")
      ->check(CLI::Range(std::uint32_t{0}, kLevels.back().max_components))
      ->option_text("N")
      ->group(kTools);
  add_choice<std::optional<RestTools>>(
      app, "--rest", t.rest,
      {{"auto", std::nullopt},
       {"prediction", RestTools::kPrediction},
       {"order", RestTools::kOrder},
       {"counterparts", RestTools::kCounterparts}},
      "Coding of rest positions and first frames, High profile: auto (default: all of these), "
      "prediction (like other values), order (also in an order of their own), counterparts "
      "(also from parts of the same shape)")
      ->group(kTools);
  app.add_option("--track-levels", t.track_levels,
                 "Levels of hierarchical tracks, High profile; 0: none (default: 1)")
      ->check(CLI::Range(0, kMaxTrackLevels))
      ->option_text("N")
      ->group(kTools);
  app.add_option("--temporal-layers", t.temporal_layers,
                 "Temporal layers that a stream can be cut to, High profile (default: 1)")
      ->check(CLI::Range(1, kMaxTrackLevels + 1))
      ->option_text("N")
      ->group(kTools);
}

void add_cut_points(CLI::App& app, MainTools& t) {
  add_number(app, "--component-groups", t.component_groups, 255,
             "Cut points among trajectories, at most one each (default: by size)");
  add_number(app, "--layer-groups", t.layer_groups, 255,
             "Cut points among vertex layers, at most one each (default: by size)");
  app.add_option_function<std::vector<std::uint32_t>>(
         "--layer-cuts",
         [&t](const std::vector<std::uint32_t>& cuts) {
           t.layer_cuts = cuts;
           t.layer_groups = static_cast<std::uint32_t>(cuts.size()) + 1;
         },
         "Instead: numbers of vertices up to the cuts, for example 500,1000,2000; the nearest "
         "ends of layers are taken")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->option_text("V,...")
      ->group(kTools)
      ->excludes("--layer-groups");
}

}  // namespace

void add_method_options(CLI::App& app, EncodeCommandLine& line) {
  add_attribute_options(app, line);
  add_profile_options(app, line);
  MainTools& tools = line.options.settings.main;
  add_main_tools(app, tools);
  add_high_tools(app, tools);
  add_cut_points(app, tools);
  add_frame_options(app, line);
  add_baseline_options(app, line);
}

}  // namespace rlpc
