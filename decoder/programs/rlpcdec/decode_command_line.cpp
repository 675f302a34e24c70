#include "decoder/programs/rlpcdec/decode_command_line.h"

#include <cstdint>
#include <map>

#include "common/cli/command_line.h"
#include "common/files/output_file.h"

namespace rlpc {
namespace {

constexpr const char* kExamples = R"(OUT is one of
  clip.pc2, clip.mdd      point cache, and clip.obj for the triangles
  clip.glb                glTF: bones, or a morph target for each frame (--as)
  out/frame_%04d.obj      one OBJ (or PLY) file per frame; also ####, out/
  clip.rlpd               exact integer positions, for conformance

Examples
  rlpcdec walk.rlpc -o walk.pc2
  rlpcdec walk.rlpc -o frames/walk_%04d.obj --frames 40-59
  rlpcdec hero.rlpc -o run.glb --clip Run
  rlpcdec walk.rlpc -o far.glb --coarse 4
  rlpcdec walk.rlpc --verify
  rlpcdec walk.rlpc --html walk.html)";

constexpr const char* kDetails =
    R"(A folder OUT receives OBJ files, or PLY files with --format ply. With -o -, the
format is required: rlpd or glb; for a single frame also obj or ply. From an
open-ended stream (rlpcenc --low-delay), each frame is written as soon as it has
arrived; --format pc2 -o - then writes no mesh, and a frame count of 0.

OBJ files contain texture coordinates, normals, colours of vertices, materials
and parts; the materials are in a .mtl file and images next to them. PLY files
contain texture coordinates, normals and colours of vertices only: a vertex is
split into one for each distinct combination of these. Normals are computed for
each frame. With --coarse, none of these are written.

--html writes a page that contains the stream and plays it in a browser, without
a network. It needs the player that scripts/player builds.

Fewer components or layers are faster to decode (not Baseline). The result is
the same as after rlpcinfo --extract components=K,layers=L,temporal=N. Cluster
GOFs have no slices: they are decoded whole.

In a .glb file, each clip is an animation. --as skin writes the bones of the
stream, or its clusters, as joints of a skin, and the residual as morph targets:
enough for the file to differ from the stream by at most the stream's own error,
which rlpcdec estimates from its quantiser steps; more are added, down to half
that error, while each one reduces size * error (the stream's error included).
rlpcdec reports the difference. A vertex keeps its four largest influences. If
GOFs have different bones, the bones that serve most frames are fitted to the
other frames. Streams of inter GOFs have no bones.
--as auto writes bones, with two exceptions. It writes a morph target for each
frame if there are no bones; or if these are at most 2,000, as many as viewers
hold, and either take fewer bytes or bones leave a larger error than the
stream's own: an error N times larger justifies up to 4 * N times the bytes. The
decoded frames are exact with --as morph only; all frames of a skin are held in
memory.

With --coarse, vertex layers are removed from the mesh, the finest first: each
vertex leaves a hole, which larger triangles fill. The other vertices keep their
positions. Slices that these do not need are not decoded (Main and High
profiles). rlpcinfo --coarse lists the coarse meshes of a stream.

For the conformance judge (conformance/VALIDATE.md)
  rlpcdec --rlpc-conformance
  rlpcdec decode IN.rlpc OUT.rlpd [--max-mem BYTES]

Exit code: 0 decoded; 1 not a conforming stream; 2 not supported; 3 beyond the
limits; 4 input or output failed; 64 wrong usage.)";

// Option groups of the help page.
constexpr const char* kOutput = "Output (one of -o, --html, --verify)";
constexpr const char* kGltf = "glTF (.glb)";
constexpr const char* kPage = "Page";
constexpr const char* kLess = "Less detail (Main and High profiles)";
constexpr const char* kCoarse = "Coarse mesh";
constexpr const char* kLimits = "Limits and threads";
constexpr const char* kReport = "Report";

struct Outputs {
  CLI::Option* file;
  CLI::Option* page;
  CLI::Option* verify;
};

Outputs add_outputs(CLI::App& app, DecodeCommand& o) {
  app.add_option("STREAM", o.input, "Stream to decode; - for standard input")->required();
  auto* file = app.add_option("-o,--output", o.output, "Animation to write (see below)")
                   ->option_text("OUT")
                   ->group(kOutput);
  auto* page = app.add_option("--html", o.html.output, "Page to write that plays the stream")
                   ->option_text("FILE")
                   ->excludes(file)
                   ->group(kOutput);
  auto* verify =
      app.add_flag("--verify", o.verify_only, "Decode and verify the hashes; write nothing")
          ->excludes(file)
          ->excludes(page)
          ->group(kOutput);
  return {file, page, verify};
}

void add_format_options(CLI::App& app, DecodeCommand& o, const Outputs& outputs) {
  static const std::map<std::string, SinkFormat> kFormats{
      {"rlpd", SinkFormat::kRlpd}, {"pc2", SinkFormat::kPc2}, {"mdd", SinkFormat::kMdd},
      {"glb", SinkFormat::kGlb},   {"obj", SinkFormat::kObj}, {"ply", SinkFormat::kPly}};
  app.add_option_function<std::string>(
         "--format", [&o](const std::string& word) { o.format = kFormats.at(word); },
         "rlpd, pc2, mdd, glb, obj or ply (default: by the name of OUT)")
      ->check(CLI::IsMember(kFormats).description(""))
      ->option_text("WORD")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kOutput);
  app.add_option("--frames", o.frames, "Frames A to B only, counted from 0: A-B, A- or A")
      ->option_text("A-B")
      ->excludes(outputs.page)
      ->group(kOutput);
  app.add_option("--clip", o.clip, "This clip only; rlpcinfo lists clips")
      ->check([](const std::string& name) {
        return name.empty() ? std::string("the name is empty; rlpcinfo lists the clips") : "";
      })
      ->option_text("NAME")
      ->excludes("--frames")
      ->excludes(outputs.page)
      ->group(kOutput);
  app.add_flag("--no-attributes", o.no_attributes,
               "Positions and triangles only, without texture coordinates, normals, colours, "
               "materials")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kOutput);
  app.add_flag("--ascii", o.ascii, "PLY files as text")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kOutput);
  app.add_flag("--conceal", o.conceals,
               "After damage, continue with the next intact group of frames, and leave out "
               "damaged attributes; lost frames repeat the last good one")
      ->excludes(outputs.page)
      ->group(kOutput);
  app.add_flag("--no-hashes", o.no_hashes, "Do not verify the hashes of the stream")
      ->excludes(outputs.verify)
      ->group(kOutput);

  app.add_option("--reference", o.html.reference,
                 "With --html: a finer stream of the same animation in the same vertex order "
                 "(both with --keep-order, or neither); the page colours the mesh by the "
                 "distance between the two")
      ->option_text("STREAM")
      ->needs(outputs.page)
      ->group(kPage);
  app.add_option("--player", o.html.player,
                 "With --html: page of the player (default: the one installed or built)")
      ->option_text("PAGE")
      ->needs(outputs.page)
      ->group(kPage);
}

void add_gltf_options(CLI::App& app, DecodeCommand& o, const Outputs& outputs) {
  static const std::map<std::string, GltfMotion> kMotions{
      {"auto", GltfMotion::kAuto}, {"skin", GltfMotion::kSkin}, {"morph", GltfMotion::kMorph}};
  app.add_option_function<std::string>(
         "--as", [&o](const std::string& word) { o.motion = kMotions.at(word); },
         "skin: bones, and morph targets for the residual; morph: each frame exactly, as a "
         "morph target; auto (default): bones, unless frames are smaller or bones too "
         "inexact")
      ->check(CLI::IsMember(kMotions).description(""))
      ->option_text("WORD")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kGltf);
  app.add_option("--max-targets", o.max_targets,
                 "Maximum morph targets in addition to bones (default: 256); 0: bones alone")
      ->check(CLI::Range(0U, 65535U))
      ->option_text("N")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kGltf);
}

void add_limit_options(CLI::App& app, DecodeCommand& o, const Outputs& outputs) {
  app.add_option("--max-components", o.decoder.cut.max_components,
                 "Only the leading component groups of each skinned GOF, with at most K "
                 "trajectories in total")
      ->check(CLI::Range(0U, SliceCut::kAll - 1))
      ->option_text("K")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kLess);
  app.add_option("--max-layers", o.decoder.cut.max_layers,
                 "Only the coarsest layer groups, with at most L vertex layers in total")
      ->check(CLI::Range(1U, SliceCut::kAll - 1))
      ->option_text("L")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kLess);
  app.add_option("--max-temporal-layers", o.decoder.cut.max_temporal_layers,
                 "Only the first N temporal layers; other frames are interpolated")
      ->check(CLI::Range(1U, SliceCut::kAll - 1))
      ->option_text("N")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kLess);

  app.add_option("--coarse", o.decoder.coarse_layers,
                 "Decode a mesh of only the coarsest L vertex layers (1: the fewest vertices), "
                 "or the whole mesh if it has at most L")
      ->check(CLI::Range(1U, SliceCut::kAll - 1))
      ->option_text("L")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kCoarse);

  app.add_option(
         "--max-memory", o.decoder.limits.max_memory_bytes,
         "Refuse streams that need more, for example 500MB (1 MB: 1000 * 1000 bytes; 1 MiB: "
         "1024 * 1024; default: 4GiB)")
      ->transform(CLI::AsSizeValue(true))
      ->option_text("SIZE")
      ->group(kLimits);
  app.add_option("--max-vertices", o.decoder.limits.max_vertices,
                 "Refuse streams with more vertices")
      ->option_text("N")
      ->group(kLimits);
  app.add_option("--max-frames", o.decoder.limits.max_frames, "Refuse streams with more frames")
      ->option_text("N")
      ->group(kLimits);
  app.add_option_function<std::uint64_t>(
         "--max-output",
         [&o](std::uint64_t bytes) { o.limit = std::make_shared<OutputLimit>(bytes); },
         "Refuse to write more, for example 2GB (units as above; default: no limit)")
      ->transform(CLI::AsSizeValue(true))
      ->option_text("SIZE")
      ->excludes(outputs.verify)
      ->group(kLimits);
  app.add_option("--threads", o.decoder.threads,
                 "Number of threads, 1 to 256, each with memory for a GOF and four frames "
                 "(default: one per processor)")
      ->check(CLI::Range(1, 256))
      ->option_text("N")
      ->group(kLimits);
}

}  // namespace

void add_decode_options(CLI::App& app, DecodeCommand& command) {
  DecodeCommand& o = command;
  const Outputs outputs = add_outputs(app, o);
  add_format_options(app, o, outputs);
  add_gltf_options(app, o, outputs);
  add_limit_options(app, o, outputs);
  app.add_flag("--json", o.json, "Report as JSON on standard output")
      ->excludes(outputs.page)
      ->group(kReport);
  app.add_flag("-q,--quiet", o.quiet, "No report, no progress")->group(kReport);
  add_help(app, {"STREAM -o OUT [OPTIONS]", {kOutput, kReport}, kExamples, kDetails},
           RLPC_VERSION);
}

std::string find_usage_error(const CLI::App& app, const DecodeCommand& command) {
  if (command.output.empty() && command.html.output.empty() && !command.verify_only) {
    return "choose an output: -o OUT, --html OUT, or --verify to write nothing";
  }
  if (command.output == "-") {
    if (command.format == SinkFormat::kByName) {
      return "-o - needs --format, as in --format glb";
    }
    if (command.json) {
      return "--json and the output cannot both go to standard output";
    }
  }
  constexpr const char* kWrittenOver = ": is also an input; choose another name for the output";
  for (const std::string& read : {command.input, command.html.reference, command.html.player}) {
    const std::string& page = command.html.output;
    if (OutputFile::is_same_file(page, read)) return page + kWrittenOver;
    const auto written = find_written_input(command.output, command.format, read);
    if (written) return *written + kWrittenOver;
  }
  if (command.ascii && sink_format(command.output, command.format) != SinkFormat::kPly) {
    return "--ascii is for PLY files only, and " + command.output + " is not one";
  }
  for (const char* const option : {"--as", "--max-targets"}) {
    if (app.get_option(option)->count() == 0 ||
        sink_format(command.output, command.format) == SinkFormat::kGlb) {
      continue;
    }
    return std::string(option) + " is for .glb files only, and " + command.output +
           " is not one";
  }
  return "";
}

}  // namespace rlpc
