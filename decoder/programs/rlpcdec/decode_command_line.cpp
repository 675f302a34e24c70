#include "decoder/programs/rlpcdec/decode_command_line.h"

#include <cstdint>
#include <map>

#include "common/cli/command_line.h"
#include "common/files/output_file.h"

namespace rlpc {
namespace {

constexpr const char* kExamples = R"(OUT is one of
  clip.pc2, clip.mdd      point cache; clip.obj next to it has the triangles
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
    R"(A folder OUT gets OBJ files or, with --format ply, PLY files. -o - needs a
format: rlpd or glb or, for a single frame, obj or ply. Frames of an open-ended
stream (rlpcenc --low-delay) are written as soon as they arrive; --format pc2
-o - then writes no mesh, and a frame count of 0.

OBJ files hold texture coordinates, normals, colours of vertices, materials and
parts; a .mtl file and images next to them hold the materials. PLY files hold
texture coordinates, normals and colours per vertex: vertices are repeated for
each distinct combination of these. Normals are those of each frame. Coarse
meshes (--coarse) have no attributes.

--html writes a page that contains the stream and plays it in a browser, without
a network. It needs the player that scripts/player builds.

Fewer components or layers are faster to decode (not Baseline). The result
equals decoding after rlpcinfo --extract components=K,layers=L,temporal=N.
Cluster GOFs have no slices: they are decoded whole.

In a .glb file, each clip is an animation. --as skin turns the bones of the
stream, or its clusters, into joints of a skin, and the residual into morph
targets: enough that the file differs from the stream by at most the error of
the stream, which rlpcdec estimates from its quantiser steps; more are added,
down to half that error, while each one reduces file size * total error. rlpcdec
reports the difference. A vertex keeps its four largest influences. If groups of
frames have different bones, the bones of most frames are fitted to the others.
Streams of inter GOFs have no bones.
--as auto writes a morph target for each frame instead if the stream has no
bones; or, up to the 2,000 targets that viewers support, if they take fewer
bytes, or if bones would leave more than the error of the stream: an error N
times larger justifies up to 4 * N times the bytes. Only --as morph writes the
decoded frames exactly. All frames of a skin are held in memory.

--coarse removes vertex layers from the mesh, the finest first: larger triangles
fill the hole of each vertex. The other vertices keep their positions. Slices
that these do not need are not decoded (Main and High profiles). rlpcinfo
--coarse lists the coarse meshes of a stream.

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
  app.add_option("--clip", o.clip, "This part only; rlpcinfo lists them")
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
  app.add_flag(
         "--conceal", o.conceals,
         "After damage, resume with the next intact group of frames, and leave out damaged "
         "attributes; lost frames repeat the last good one")
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
                 "With --html: page of the player (default: as installed, or as built)")
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
         "inaccurate")
      ->check(CLI::IsMember(kMotions).description(""))
      ->option_text("WORD")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kGltf);
  app.add_option("--max-targets", o.max_targets,
                 "Maximum number of morph targets with bones (default: 256); 0: bones alone")
      ->check(CLI::Range(0U, 65535U))
      ->option_text("N")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kGltf);
}

void add_limit_options(CLI::App& app, DecodeCommand& o, const Outputs& outputs) {
  app.add_option("--max-components", o.decoder.cut.max_components,
                 "Only the leading component groups of each skinned GOF with at "
                 "most K trajectories in total")
      ->check(CLI::Range(0U, SliceCut::kAll - 1))
      ->option_text("K")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kLess);
  app.add_option("--max-layers", o.decoder.cut.max_layers,
                 "Only the coarsest layer groups with at most L vertex layers in "
                 "total")
      ->check(CLI::Range(1U, SliceCut::kAll - 1))
      ->option_text("L")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kLess);
  app.add_option("--max-temporal-layers", o.decoder.cut.max_temporal_layers,
                 "Only the first N temporal layers; the frames between are interpolated")
      ->check(CLI::Range(1U, SliceCut::kAll - 1))
      ->option_text("N")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kLess);

  app.add_option(
         "--coarse", o.decoder.coarse_layers,
         "Decode a mesh of only the coarsest L vertex layers and triangles between them: "
         "1 for the fewest vertices; the whole mesh if it has no more layers")
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
                 "1 to 256, each with memory for a GOF and four frames (default: one per "
                 "processor)")
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
    return "--ascii is for PLY files, which " + command.output + " is not";
  }
  for (const char* const option : {"--as", "--max-targets"}) {
    if (app.get_option(option)->count() == 0 ||
        sink_format(command.output, command.format) == SinkFormat::kGlb) {
      continue;
    }
    return std::string(option) + " is for .glb files, which " + command.output + " is not";
  }
  return "";
}

}  // namespace rlpc
