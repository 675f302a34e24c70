// rlpcdec: decodes .rlpc streams to animations.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "common/io/interrupts.h"
#include "common/io/messages.h"
#include "common/io/output_file.h"
#include "common/io/progress_bar.h"
#include "common/io/standard_output.h"
#include "common/tools/command_line.h"
#include "common/tools/frame_span.h"
#include "decoder/output/frame_sink.h"
#include "decoder/player/html_verb.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/tools/chosen_frames.h"
#include "decoder/tools/concealed_frames.h"
#include "decoder/tools/conformance_verbs.h"
#include "decoder/tools/exit_code.h"
#include "decoder/tools/stream_message.h"

namespace {

constexpr const char* kExamples = R"(OUT is one of
  clip.pc2, clip.mdd      point cache, with clip.obj beside it for the triangles
  clip.glb                glTF: bones, or a morph target for each frame (--as)
  out/frame_%04d.obj      one OBJ (or PLY) file per frame; out/: likewise
  clip.rlpd               exact integer positions, for conformance

Examples
  rlpcdec walk.rlpc -o walk.pc2
  rlpcdec walk.rlpc -o frames/walk_%04d.obj --frames 40-59
  rlpcdec hero.rlpc -o run.glb --clip Run
  rlpcdec walk.rlpc -o far.glb --coarse 4
  rlpcdec walk.rlpc --verify
  rlpcdec walk.rlpc --html walk.html)";

constexpr const char* kDetails =
    R"(A folder OUT gets OBJ files, with --format ply PLY files. With -o -, the format
is needed: rlpd or glb; of a single frame also obj or ply. From an open-ended
stream (rlpcenc --low-delay), each frame is written as soon as it has arrived;
with --format pc2 -o -, without a mesh and with a frame count of 0.

OBJ files hold texture coordinates, normals, colours of vertices, materials and
parts; a .mtl file beside them has plain materials, which are numbered. PLY
files hold texture coordinates, normals and colours, of vertices only: vertices
become several, one for each distinct combination of these. Normals are those of
each frame. With --coarse, there is none of this.

--html writes a page that contains the stream and plays it in a browser, without
a network. scripts/player builds the player that it needs.

Fewer components or layers are faster to decode (not Baseline). The result is
that of decoding after rlpcinfo --extract components=K,layers=L,temporal=N.
Cluster GOFs have no slices: they are decoded whole.

In a .glb file, each clip is an animation. --as skin makes the bones of the
stream, or its clusters, joints of a skin; what these leave becomes morph
targets, as many as it takes to differ from the stream by about a quarter of its
own error, which rlpcdec estimates from its quantiser steps. It reports the
difference. A vertex keeps its four largest influences. Where groups of frames
have bones of their own, those of most frames are fitted to the others. A stream
whose frames are predicted from frames has no bones.
--as auto falls back to a morph target for each frame where bones would leave
twice that error, would take more bytes, or where there are none. The decoded
frames are exact with --as morph only; all frames of a skin are held in memory.

With --coarse, vertex layers are removed from the mesh, the finest first: each
vertex leaves a hole, which larger triangles fill. The other vertices keep their
positions. Slices that are not needed for these are not decoded (Main and High
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

struct Options {
  std::string input;
  std::string output;
  std::string frames;
  std::string clip;
  rlpc::SinkFormat format = rlpc::SinkFormat::kByName;
  bool ascii = false;
  rlpc::GltfMotion motion = rlpc::GltfMotion::kAuto;
  std::uint32_t max_targets = rlpc::kUsualMaxTargets;
  bool no_attributes = false;
  bool verify_only = false;
  bool no_hashes = false;
  bool conceals = false;
  bool json = false;
  bool quiet = false;
  rlpc::HtmlRequest html;
  rlpc::DecoderOptions decoder;
  std::shared_ptr<rlpc::OutputLimit> limit;

  bool is_part() const { return !frames.empty() || !clip.empty(); }
};

int complain(const std::string& message, int code) {
  rlpc::print_message("rlpcdec", message);
  return code;
}

int complain(const Options& o, const rlpc::Error& error) {
  return complain(rlpc::stream_message(o.input, error, o.decoder.limits),
                  rlpc::exit_code(error.code));
}

// Whether the frames are decoded as they arrive, their number being unknown.
bool is_live(const Options& o, const rlpc::SequenceHeader& header) {
  if (!header.open_end_flag || o.is_part()) return false;
  const rlpc::SinkFormat format = rlpc::sink_format(o.output, o.format);
  const bool needs_count = format == rlpc::SinkFormat::kGlb ||
                           format == rlpc::SinkFormat::kMdd ||
                           (format == rlpc::SinkFormat::kPc2 && o.output != "-");
  return o.verify_only || !needs_count;
}

// end: the frame with which decoding goes on; none: it does not.
int complain_of_loss(const Options& o, const rlpc::Error& error, std::uint32_t first,
                     std::optional<std::uint32_t> end) {
  std::string lost = "; frames from " + std::to_string(first) + " on are lost";
  if (end && *end == first) {
    lost = "; no frame is lost";
  } else if (end && *end == first + 1) {
    lost = "; frame " + std::to_string(first) + " is lost, and shows the one before it";
  } else if (end) {
    lost = "; frames " + std::to_string(first) + " to " + std::to_string(*end - 1) +
           " are lost, and show the one before them";
  }
  return complain(rlpc::stream_message(o.input, error, o.decoder.limits) + lost,
                  rlpc::exit_code(error.code));
}

// Numbers of frames decoded, verified against a hash, and lost to damage.
struct FrameCounts {
  std::uint32_t decoded = 0;
  std::uint32_t compared = 0;
  std::uint32_t lost = 0;
  int loss_code = rlpc::kExitDone;  // of the last damage
};

std::string hashes_text(const Options& o, const rlpc::Decoder& decoder,
                        const FrameCounts& frames) {
  if (decoder.was_cut()) return ", cut; hashes of GOFs that lost slices were not verified";
  if (!o.decoder.verify_hashes) return "";
  if (frames.compared == frames.decoded) return ", hashes agree";
  if (frames.compared > 0) {
    return ", hashes of " + std::to_string(frames.compared) +
           " of them agree; the others have none";
  }
  return o.is_part() ? ", not verified: no hash covers these frames alone"
                     : ", which have no hashes";
}

bool is_coarse(const Options& o) { return o.decoder.coarse_layers != rlpc::SliceCut::kAll; }

std::string coarse_text(const Options& o, const rlpc::Decoder& decoder) {
  if (!is_coarse(o)) return "";
  const std::uint32_t layers = std::min(o.decoder.coarse_layers, decoder.num_layers());
  return " (" + std::to_string(layers) + " of " + std::to_string(decoder.num_layers()) +
         " vertex layers)";
}

// sink: null if nothing was written.
void report(const Options& o, const rlpc::Decoder& decoder, const FrameCounts& frames,
            const rlpc::FrameSink* sink) {
  const auto remarks = sink != nullptr ? sink->remarks() : std::vector<std::string>();
  const std::uint32_t num_vertices = decoder.num_vertices();
  const auto num_triangles = static_cast<std::uint32_t>(decoder.triangles().size());
  if (o.json) {
    nlohmann::ordered_json json = {
        {"num_vertices", num_vertices}, {"num_triangles", num_triangles},
        {"frames", frames.decoded},     {"frames_compared", frames.compared},
        {"frames_lost", frames.lost},   {"hashes_verified", frames.compared == frames.decoded},
        {"cut", decoder.was_cut()}};
    if (is_coarse(o)) {
      json["coarse"] = {{"layers", std::min(o.decoder.coarse_layers, decoder.num_layers())},
                        {"of_layers", decoder.num_layers()},
                        {"of_vertices", decoder.header().num_vertices},
                        {"of_triangles", decoder.header().num_triangles}};
    }
    if (!remarks.empty()) json["remarks"] = remarks;
    std::cout << json.dump(2) << "\n";
  } else if (!o.quiet) {
    const auto plural = [](std::uint32_t n) { return n == 1 ? "" : "s"; };
    const std::string lost =
        frames.lost > 0 ? ", " + std::to_string(frames.lost) + " lost" : std::string();
    std::fprintf(stderr, "%s: %u frame%s of %u vert%s and %u triangle%s decoded%s%s%s\n",
                 rlpc::printable(rlpc::name_of_input(o.input)).c_str(), frames.decoded,
                 plural(frames.decoded), num_vertices, num_vertices == 1 ? "ex" : "ices",
                 num_triangles, plural(num_triangles), coarse_text(o, decoder).c_str(),
                 hashes_text(o, decoder, frames).c_str(), lost.c_str());
    for (const std::string& remark : remarks) rlpc::print_message("rlpcdec", remark);
  }
}

int write_html(const Options& o, rlpc::ByteSource& source) {
  rlpc::HtmlRequest request = o.html;
  request.input = o.input;
  request.decoder = o.decoder;
  request.limit = o.limit;
  request.quiet = o.quiet;
  return rlpc::write_html(request, source);
}

// Returns the exit code of an error that ends it; none: all frames have been written.
std::optional<int> write_frames(const Options& o, rlpc::Decoder& decoder,
                                const rlpc::FrameSpan& span, bool live, rlpc::FrameSink* sink,
                                FrameCounts& frames) {
  const auto report_loss = [&](const rlpc::Error& error, std::uint32_t first,
                               std::optional<std::uint32_t> end) {
    frames.loss_code = complain_of_loss(o, error, first, end);
  };
  rlpc::ConcealedFrames shown(
      decoder, span.first, live ? std::nullopt : std::optional(span.last + 1),
      o.conceals ? rlpc::ConcealedFrames::Report(report_loss) : nullptr);
  std::vector<std::int32_t> positions(3 * std::size_t{decoder.num_vertices()});
  const std::uint32_t count = span.last - span.first + 1;
  rlpc::ProgressBar bar("decoding", !o.quiet);
  for (;;) {
    const auto more = shown.next(positions);
    if (!more) return complain(o, more.error());
    if (!*more) break;
    if (sink != nullptr) {
      if (sink->wants_poses() && !shown.is_lost()) sink->set_pose(decoder.pose());
      if (auto error = sink->write_frame(positions)) {
        return complain(error->message, rlpc::exit_code(*error));
      }
    }
    if (shown.is_lost()) {
      ++frames.lost;
    } else {
      ++frames.decoded;
      frames.compared += decoder.compared_frames();
    }
    if (!live) bar.show(static_cast<double>(frames.decoded + frames.lost) / count);
  }
  // What follows the last frame is checked, too.
  if (!o.is_part() && !live && frames.loss_code == rlpc::kExitDone) {
    if (const auto more = decoder.next_frame(positions); !more)
      return complain(o, more.error());
  }
  return std::nullopt;
}

// Those that the output holds. Returns the exit code of an error; frames are written all the
// same.
int read_attributes(const Options& o, rlpc::Decoder& decoder, bool live,
                    rlpc::SinkOptions& options) {
  const rlpc::SinkFormat format = rlpc::sink_format(o.output, o.format);
  const bool has_mesh = !(live && format == rlpc::SinkFormat::kPc2);
  if (o.no_attributes || is_coarse(o) || !has_mesh || !rlpc::holds_attributes(format) ||
      !(decoder.has_attributes() || decoder.has_asset())) {
    return rlpc::kExitDone;
  }
  if (format == rlpc::SinkFormat::kGlb) {
    auto asset = decoder.asset();
    if (!asset) {
      return complain(rlpc::stream_message(o.input, asset.error(), o.decoder.limits) +
                          "; frames are written without materials",
                      rlpc::exit_code(asset.error().code));
    }
    options.asset = std::move(*asset);
  }
  auto sets = decoder.attributes();
  if (!sets) {
    return complain(rlpc::stream_message(o.input, sets.error(), o.decoder.limits) +
                        "; frames are written without attributes",
                    rlpc::exit_code(sets.error().code));
  }
  options.attributes = std::move(*sets);
  return rlpc::kExitDone;
}

int decode(const Options& o) {
  auto source = rlpc::file_or_standard_input(o.input, o.decoder.limits.max_memory_bytes);
  if (!source) return complain(o, source.error());
  if (!o.html.output.empty()) return write_html(o, **source);
  auto decoder = rlpc::Decoder::open(std::move(*source), o.decoder);
  if (!decoder) return complain(o, decoder.error());
  const rlpc::SequenceHeader& header = decoder->header();
  if (o.decoder.cut.cuts() && !header.has_skinned_gofs()) {
    return complain(rlpc::name_of_input(o.input) + ": " + rlpc::SliceCut::kNoSlices,
                    rlpc::kExitUnsupported);
  }
  const bool live = is_live(o, header);
  const auto num_frames = live ? std::optional(header.num_frames) : decoder->num_frames();
  if (!num_frames) {
    return complain(
        rlpc::name_of_input(o.input) +
            ": an open-ended stream that has been cut off: the number of its frames is "
            "not known. Write .rlpd, OBJ or PLY files, and all frames",
        rlpc::kExitInvalid);
  }
  const auto span = rlpc::choose_frames(o.frames, o.clip, decoder->clips(), *num_frames);
  if (!span) return complain(span.error(), rlpc::kExitUsage);
  const std::uint32_t count = span->last - span->first + 1;
  std::unique_ptr<rlpc::FrameSink> sink;
  int attributes_code = rlpc::kExitDone;
  if (!o.verify_only) {
    rlpc::SinkOptions options{decoder->num_vertices(),
                              count,
                              header.frame_rate,
                              header.grid,
                              {decoder->triangles().begin(), decoder->triangles().end()}};
    options.first_number = span->first;
    options.live = live;
    options.format = o.format;
    options.ascii = o.ascii;
    options.clips = rlpc::clips_within(*span, decoder->clips());
    options.motion = o.motion;
    options.max_targets = o.max_targets;
    options.max_skin_bytes = o.decoder.limits.max_memory_bytes / 2;
    attributes_code = read_attributes(o, *decoder, live, options);
    options.limit = o.limit;
    auto opened = rlpc::open_frame_sink(o.output, std::move(options));
    if (!opened) {
      return complain(opened.error().message, rlpc::exit_code(opened.error()));
    }
    sink = std::move(*opened);
  }
  if (span->first > 0) {
    if (const auto ok = decoder->seek(span->first); !ok) return complain(o, ok.error());
  }
  FrameCounts frames;
  if (const auto code = write_frames(o, *decoder, *span, live, sink.get(), frames))
    return *code;
  if (sink) {
    if (auto error = sink->finish()) {
      return complain(error->message, rlpc::exit_code(*error));
    }
  }
  report(o, *decoder, frames, sink.get());
  return frames.loss_code != rlpc::kExitDone ? frames.loss_code : attributes_code;
}

struct Outputs {
  CLI::Option* file;
  CLI::Option* page;
  CLI::Option* verify;
};

Outputs add_outputs(CLI::App& app, Options& o) {
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

void add_format_options(CLI::App& app, Options& o, const Outputs& outputs) {
  static const std::map<std::string, rlpc::SinkFormat> kFormats{
      {"rlpd", rlpc::SinkFormat::kRlpd}, {"pc2", rlpc::SinkFormat::kPc2},
      {"mdd", rlpc::SinkFormat::kMdd},   {"glb", rlpc::SinkFormat::kGlb},
      {"obj", rlpc::SinkFormat::kObj},   {"ply", rlpc::SinkFormat::kPly}};
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
         "After damage, go on with the next intact group of frames; the last frame before "
         "stands for those that are lost")
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

void add_gltf_options(CLI::App& app, Options& o, const Outputs& outputs) {
  static const std::map<std::string, rlpc::GltfMotion> kMotions{
      {"auto", rlpc::GltfMotion::kAuto},
      {"skin", rlpc::GltfMotion::kSkin},
      {"morph", rlpc::GltfMotion::kMorph}};
  app.add_option_function<std::string>(
         "--as", [&o](const std::string& word) { o.motion = kMotions.at(word); },
         "skin: bones, and morph targets for what they leave; morph: each frame exactly, as a "
         "morph target; auto (default): whichever is smaller, where bones are near enough")
      ->check(CLI::IsMember(kMotions).description(""))
      ->option_text("WORD")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kGltf);
  app.add_option("--max-targets", o.max_targets,
                 "Morph targets beside bones, at most (default: 256); 0 for bones alone")
      ->check(CLI::Range(0U, 65535U))
      ->option_text("N")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kGltf);
}

void add_limit_options(CLI::App& app, Options& o, const Outputs& outputs) {
  app.add_option("--max-components", o.decoder.cut.max_components,
                 "Of each skinned GOF, only the leading component groups with at "
                 "most K trajectories in total")
      ->check(CLI::Range(0U, rlpc::SliceCut::kAll - 1))
      ->option_text("K")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kLess);
  app.add_option("--max-layers", o.decoder.cut.max_layers,
                 "Only the coarsest layer groups with at most L vertex layers in "
                 "total")
      ->check(CLI::Range(1U, rlpc::SliceCut::kAll - 1))
      ->option_text("L")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kLess);
  app.add_option("--max-temporal-layers", o.decoder.cut.max_temporal_layers,
                 "Only the first N temporal layers; the frames between are interpolated")
      ->check(CLI::Range(1U, rlpc::SliceCut::kAll - 1))
      ->option_text("N")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kLess);

  app.add_option("--coarse", o.decoder.coarse_layers,
                 "Decode a mesh with only the coarsest L vertex layers, and triangles between "
                 "them: 1 for the fewest vertices; the whole mesh if it has no more layers")
      ->check(CLI::Range(1U, rlpc::SliceCut::kAll - 1))
      ->option_text("L")
      ->excludes(outputs.verify)
      ->excludes(outputs.page)
      ->group(kCoarse);

  app.add_option("--max-memory", o.decoder.limits.max_memory_bytes,
                 "Refuse streams that need more, for example 500MB")
      ->transform(CLI::AsSizeValue(false))
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
         [&o](std::uint64_t bytes) { o.limit = std::make_shared<rlpc::OutputLimit>(bytes); },
         "Refuse to write more, for example 2GB (default: no limit)")
      ->transform(CLI::AsSizeValue(false))
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

void add_options(CLI::App& app, Options& o) {
  const Outputs outputs = add_outputs(app, o);
  add_format_options(app, o, outputs);
  add_gltf_options(app, o, outputs);
  add_limit_options(app, o, outputs);
  app.add_flag("--json", o.json, "Report as JSON on standard output")
      ->excludes(outputs.page)
      ->group(kReport);
  app.add_flag("-q,--quiet", o.quiet, "No report, no progress")->group(kReport);
  rlpc::add_help(app, {"STREAM -o OUT [OPTIONS]", {kOutput, kReport}, kExamples, kDetails},
                 RLPC_VERSION);
}

}  // namespace

int main(int argc, char** argv) try {
  rlpc::handle_interrupts();
  if (const auto code = rlpc::run_conformance_verb(argc, argv)) return *code;
  CLI::App app("Decodes an .rlpc stream.", "rlpcdec");
  Options options;
  options.decoder.threads = std::max(1U, std::thread::hardware_concurrency());
  add_options(app, options);
  if (const auto code = rlpc::parse_command_line(app, argc, argv)) return *code;
  if (options.output.empty() && options.html.output.empty() && !options.verify_only) {
    return complain("choose an output: -o OUT, --html OUT, or --verify to write nothing",
                    rlpc::kExitUsage);
  }
  if (options.output == "-") {
    if (options.format == rlpc::SinkFormat::kByName) {
      return complain("-o - needs --format, as in --format glb", rlpc::kExitUsage);
    }
    if (options.json) {
      return complain("--json and the output cannot both go to standard output",
                      rlpc::kExitUsage);
    }
  }
  for (const std::string& read : {options.input, options.html.reference, options.html.player}) {
    for (const std::string& written : {options.output, options.html.output}) {
      if (!rlpc::OutputFile::is_same_file(written, read)) continue;
      return complain(written + ": is also an input; choose another name for the output",
                      rlpc::kExitUsage);
    }
  }
  if (options.ascii &&
      rlpc::sink_format(options.output, options.format) != rlpc::SinkFormat::kPly) {
    return complain("--ascii is for PLY files, which " + options.output + " is not",
                    rlpc::kExitUsage);
  }
  for (const char* const option : {"--as", "--max-targets"}) {
    if (app.get_option(option)->count() == 0 ||
        rlpc::sink_format(options.output, options.format) == rlpc::SinkFormat::kGlb) {
      continue;
    }
    return complain(
        std::string(option) + " is for .glb files, which " + options.output + " is not",
        rlpc::kExitUsage);
  }
  options.decoder.verify_hashes = !options.no_hashes;
  options.decoder.forward_only = options.frames.empty() && options.html.output.empty();
  return rlpc::after_standard_output("rlpcdec", decode(options), rlpc::kExitIo);
} catch (const std::bad_alloc&) {
  std::fprintf(stderr, "rlpcdec: out of memory\n");
  return rlpc::kExitLimit;
} catch (const std::exception& error) {
  rlpc::print_message("rlpcdec", error.what());
  return rlpc::kExitLimit;
}
