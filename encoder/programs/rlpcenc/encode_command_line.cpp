#include "encoder/programs/rlpcenc/encode_command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <thread>
#include <vector>

#include "common/cli/command_line.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/sequence/target/quality.h"
#include "encoder/meshes/input_format.h"
#include "encoder/programs/rlpcenc/method_options.h"

namespace rlpc {
namespace {

constexpr const char* kExamples = R"(Examples
  rlpcenc cow.obj --points cow.pc2 -o cow.rlpc
  rlpcenc frames/ -o walk.rlpc --quality fine
  rlpcenc 'walk_*.obj' --fps 25 -o walk.rlpc --bpvf 1.5
  rlpcenc fox.glb --animation Run -o run.rlpc)";

constexpr const char* kInputs = R"(More examples
  rlpcenc frames/ --kg 0.3 --dry-run                     how large would it be?
  rlpcenc cow.obj --points cow.pc2 -o c.rlpc --max-error 0.01
  rlpcenc cow.obj --points cow.pc2 -o c.rlpc --profile high --lossless 14
  capture | rlpcenc cow.obj --points - -o - --profile high --low-delay | send
  rlpcenc cow.obj --points cow.pc2 -o c.rlpc --profile baseline --gof all \
      --clusters 30 --components 20 --qu 12 --qc 12 --qdelta 12 --no-rdo \
      --frame lcf                         the settings of the RLPCA paper

INPUT is one of
  mesh.obj --points cache.pc2   triangles from the mesh, frames from the point
                                cache
  folder/                       all meshes in it, of one format
  walk_%04d.obj, walk_####.obj, 'walk_*.obj'
                                the matching files; walk_%g.obj: also walk_1.25,
                                walk_-7 and walk_007
  a_1.obj a_2.obj ...           these files
  mesh.obj                      a single frame
  walk.glb, walk.gltf           a glTF 2.0 scene: skins, morph targets, animated
                                nodes
  clip.rlpd                     decoded positions
  -                             any single file, from standard input
)";

// After the list of formats.
constexpr const char* kDetails = R"(
Files are ordered by the one number in which their names differ: -5 before -4,
1.25 between 1 and 2, 9 before 10. Digits after a point are a fraction
(t=0.041667) or a counter (v003.0995), whichever gives equal steps. Names that
can be read in two orders are an error, and so are names that do not fit, such
as the name of a rest pose; a pattern resolves both. A hyphen after a word is a
separator before whole numbers and times from 0 on (walk-1, walk-0.04). Polygons
are split into triangles as in the first frame.

The format is determined by the extension, or by the contents if that fails.

Texture coordinates, normals, colours and materials of OBJ and PLY files are
kept: from the first file of a sequence, or from the mesh of a point cache. PNG
and JPEG images of .mtl files (map_Kd, map_Ke, norm) are kept if they are in the
folder of the mesh or below. Vertices are not split at seams.

Qualities
  word               KG error  normals
  preview            1 %       4 degrees     dents are visible
  good (default)     0.2 %     0.8 degrees   no ripples in close-ups
  fine               0.06 %    0.25 degrees  about one step of an 8-bit display
  visually-lossless  0.02 %    0.08 degrees  less than half a step
Both are bounds, and the result comes near one of them. --low-delay bounds half
the KG error alone.

The KG error (Karni and Gotsman) is the RMS distance between original and
decoded vertices, divided by the RMS distance of the vertices from the centre of
their frame. Normals are what smooth shading shows: the angle between the
original and the decoded normal of a vertex, which is the sum of the normals of
its triangles, weighted by area; RMS over vertices and frames, weighted by area.
--normals bounds them, and the KG error by 1 % unless --kg says otherwise:
normals do not tell where a part is.

Where no normals are bounded, rlpcenc warns if the RMS error exceeds 3 % of the
median edge length, which is a mean normal deviation of about one degree.

--lossless restores every coordinate as a 32-bit float (-0 as 0), exactly or as
the float nearest to the number in INPUT: rlpcenc reports the largest distance.
--lossless BITS first rounds coordinates to the finest grid, with a step that is
a power of two, on which the box needs at most BITS bits. The order of vertices
and triangles is not kept (--keep-order keeps that of vertices), nor is anything
else in INPUT. Sampled glTF is kept as sampled.

Errors are measured from the numbers in INPUT to decoded positions, which are
32-bit floats: far from the origin, these may be too coarse for --max-error.
rlpcenc decodes its output and compares it with INPUT before OUT appears: if
they do not agree, it fails and leaves no OUT.

--dry-run encodes animations of up to 1024 frames (or eight GOFs, if that is
more) and reports the exact size. For longer ones it encodes eight sections and
reports an estimate ("about").

--low-delay reads RLPD from INPUT -, or PC2 from --points -, to its end,
whatever frame count it declares, and writes each frame before it waits for the
next. The stream is then open-ended: rlpcdec writes its frames as they arrive.
If the input fails, OUT ends with the frame before. Quality is --kg, --max-error
or --lossless BITS; the KG error is that of all frames together, and is met
approximately.

--frame-pattern FRAME<REFERENCES, ... lists the frames of a period in coding
order, counted from 1, with one or two references each, and @DEPTH for a frame
deeper than its references; 0 is the last frame of the period before. dyadic:4
is 4<0,2<0+4@1,1<0+2@2,3<2+4@2. --temporal-layers N makes layers of the N - 1
greatest depths, --layer-groups N makes groups of vertex layers: frames and
details that rlpcinfo --extract can remove.

--up-axis and --metres-per-unit become upAxis and metersPerUnit of the metadata,
their USD names; for glTF, Y and 1 are recorded by default. They describe the
positions of OUT; --axes turns these.

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

// CLI11's check accepts NaN.
const CLI::Validator kAboveZero(
    [](const std::string& word) {
      double value = 0.0;
      const bool number = CLI::detail::lexical_cast(word, value);
      return number && std::isfinite(value) && value > 0.0
                 ? ""
                 : "expected a number above 0, found `" + word + "`";
    },
    "NUMBER");

// Returns the bits of --lossless: 0 for an empty text; none if it is neither empty nor a
// number.
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
      return parse_bits(word)
                 ? ""
                 : "expected nothing, or a number of bits from 2 to 24, found `" + word + "`";
    },
    "");

void add_input_options(CLI::App& app, EncodeCommandLine& line) {
  app.add_option(
         "INPUT", line.inputs,
         "Mesh, meshes, folder or pattern of meshes, or glTF file; - for standard input")
      ->required();
  app.add_option("--points", line.options.input.points,
                 "Point cache (" + extensions_text({InputFormat::Holds::kPoints}) +
                     ") with the frames of INPUT")
      ->option_text("FILE")
      ->group(kInput);
  app.add_option(
         "--fps", line.fps,
         "Frame rate: 25, 29.97 or 30000/1001 (default: from INPUT, for glTF from its keys; "
         "otherwise 30)")
      ->option_text("RATE")
      ->group(kInput);
  app.add_option("--axes", line.axes,
                 "New x, y and z in axes of INPUT: x,z,-y turns Z-up to Y-up, x,-z,y back")
      ->option_text("X,Y,Z")
      ->group(kMoreInput);
  app.add_option("--animation", line.options.input.animations,
                 "glTF: name, index from 0, or `all`; may be repeated (default: first)")
      ->option_text("NAME")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(kInput);
  add_off_switch(app, "--no-weld", line.options.input.weld,
                 "glTF: keep vertices that coincide in every frame apart")
      ->group(kMoreInput);
  add_off_switch(app, "--no-input-rig", line.options.input.rig,
                 "glTF: look for bones as in a point cache, without those of the file")
      ->group(kMoreInput);
}

void add_quality_options(CLI::App& app, EncodeCommandLine& line) {
  auto* word = app.add_option("--quality", line.options.quality,
                              CLI::detail::join(quality_words(), ", "))
                   ->check(CLI::IsMember(quality_words()).description(""))
                   ->option_text("WORD")
                   ->group(kQuality);
  auto* kg = app.add_option("--kg", line.kg, "KG error in per cent")->option_text("PERCENT");
  auto* normals = app.add_option("--normals", line.normals,
                                 "RMS deviation of normals, with --kg 1 unless given");
  normals->option_text("DEGREES")->check(kAboveZero)->group(kQuality);
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
    if (*a != kg) normals->excludes(*a);
  }
}

// Options that other options exclude.
struct OutputOptions {
  CLI::Option* dry_run;
  CLI::Option* keep_order;
};

OutputOptions add_output_options(CLI::App& app, EncodeCommandLine& line) {
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
                 "Maximum frames per group, or `all` (default: 128; Main: up to 4096, by "
                 "cost; High: 256)")
      ->option_text("FRAMES")
      ->group(kOutput);
  auto* keep_order =
      app.add_flag("--keep-order", o.settings.keep_order, "Store the vertex order of INPUT")
          ->group(kOutput);
  app.add_flag("--json", o.json, "Report as JSON on standard output")->group(kOutput);
  app.add_flag("-v,--verbose", o.verbose, "Also report choices, and times of stages")
      ->group(kOutput);
  app.add_flag("-q,--quiet", o.quiet, "No report, no progress")->group(kOutput);
  return {dry_run, keep_order};
}

void add_more_options(CLI::App& app, EncodeCommandLine& line, const OutputOptions& output) {
  EncodeOptions& o = line.options;
  app.add_flag("--low-delay", o.settings.low_delay,
               "Encode each frame as it arrives, also from standard input; larger files "
               "(High profile)")
      ->excludes(output.dry_run)
      ->group(kMore);
  app.add_option(
         "--box", line.box,
         "With --low-delay: bounds of all frames, smallest x,y,z, then largest (default: "
         "from INPUT; from a pipe, 8 times the size of the first frame)")
      ->delimiter(',')
      ->expected(6)
      ->option_text("X,Y,Z,X,Y,Z")
      ->group(kMore);
  app.add_option("--order-map", o.order_map,
                 "Write the index in INPUT of each decoded vertex (glTF: after welding)")
      ->option_text("FILE")
      ->excludes(output.dry_run)
      ->excludes(output.keep_order)
      ->group(kMore);
  add_choice<HashMode>(
      app, "--hash", o.settings.hash_mode,
      {{"gof", HashMode::kGof}, {"frame", HashMode::kFrame}, {"none", HashMode::kNone}},
      "Hashes of decoded positions, one per: gof (default), frame, none")
      ->group(kMore);
  app.add_flag("--verify", o.settings.check_rules,
               "Also check OUT against all rules of the specification, as rlpcval does")
      ->group(kMore);
  app.add_option("--metadata", line.metadata_path, "JSON file to store in the stream")
      ->check(CLI::ExistingFile)
      ->option_text("FILE")
      ->group(kMore);
  app.add_option("--up-axis", line.up_axis, "Record in the metadata which axis is up: y or z")
      ->check(CLI::IsMember({"y", "z"}).description(""))
      ->option_text("WORD")
      ->group(kMore);
  app.add_option("--metres-per-unit", line.metres_per_unit,
                 "Record in the metadata the length of a unit: 0.01 for centimetres")
      ->check(kAboveZero)
      ->option_text("METRES")
      ->group(kMore);
  app.add_option("--clip", line.clips,
                 "Name a part of the animation, frames A to B counted from 0; may be repeated "
                 "(default: the animations of glTF)")
      ->option_text("NAME:A-B")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(kMore);
  app.add_option(
         "--max-memory", o.settings.max_memory_bytes,
         "Refuse input that may need more, for example 500MB (1 MB: 1000 * 1000 bytes; 1 MiB: "
         "1024 * 1024; default: 32GiB)")
      ->transform(CLI::AsSizeValue(true))
      ->option_text("SIZE")
      ->group(kMore);
  o.settings.threads = std::clamp(std::thread::hardware_concurrency(), 1U, kMaxEncoderThreads);
  app.add_option("--threads", o.settings.threads,
                 "Threads, 1 to 256, fewer if memory is short; they do not affect the stream "
                 "(default: one per processor)")
      ->check(CLI::Range(std::uint32_t{1}, kMaxEncoderThreads))
      ->option_text("N")
      ->group(kMore);
}

}  // namespace

void add_encode_options(CLI::App& app, EncodeCommandLine& line) {
  add_input_options(app, line);
  add_quality_options(app, line);
  const OutputOptions output = add_output_options(app, line);
  add_more_options(app, line, output);
  add_method_options(app, line);
  add_help(app,
           {"INPUT [--points CACHE] -o OUT.rlpc [OPTIONS]",
            {kInput, kQuality, kOutput},
            kExamples,
            kInputs + formats_text() + kDetails},
           RLPC_VERSION);
}

}  // namespace rlpc
