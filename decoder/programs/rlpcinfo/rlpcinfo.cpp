// rlpcinfo: shows the contents of an .rlpc stream.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/cli/command_line.h"
#include "common/codec/mesh/coarse_mesh.h"
#include "common/files/interrupts.h"
#include "common/files/messages.h"
#include "common/files/output_file.h"
#include "common/files/standard_output.h"
#include "decoder/codec/units/stream_reader.h"
#include "decoder/codec/units/stream_summary.h"
#include "decoder/programs/borrowed_source.h"
#include "decoder/programs/exit_code.h"
#include "decoder/programs/rlpcinfo/extract_verb.h"
#include "decoder/programs/rlpcinfo/rlpcinfo_pictures.h"
#include "decoder/programs/rlpcinfo/rlpcinfo_report.h"
#include "decoder/programs/setting_options.h"
#include "decoder/programs/stream_message.h"
#include "decoder/report/bit_counter.h"
#include "decoder/report/vertex_groups.h"
#include "decoder/rlpc_decoder.h"

namespace {

constexpr const char* kExamples = R"(Examples
  rlpcinfo walk.rlpc              contents, and bits per part
  rlpcinfo walk.rlpc --gofs       also for each GOF and slice
  rlpcinfo walk.rlpc --html walk.html
  rlpcinfo walk.rlpc --pictures walk --frame 40
  rlpcinfo walk.rlpc --coarse     also the coarse meshes of rlpcdec --coarse
  rlpcinfo walk.rlpc --extract components=12,layers=5 -o small.rlpc)";

constexpr const char* kDetails =
    R"(--extract writes the stream without the slices of finer detail (not Baseline),
without re-encoding. It keeps the leading component groups of each skinned GOF
and shared rig, with at most K trajectories in total (0: only bones and rest
shape), the coarsest layer groups, with at most L vertex layers in total (always
at least the first), and the first N temporal layers of each GOF; all frames
remain. Cluster GOFs have no slices: they are kept whole. --gofs shows possible
cuts.

Pictures show the mesh from two sides, coloured by the cluster, bone or patch of
each vertex, and by its vertex layer. Above 10000 triangles (2000 in a page),
they show a coarse mesh.

--trace prints bit position, name and value of every syntax element.

Exit code: 0 the whole stream was read; 1 not a conforming stream; 2 not
supported, or a stream that cannot be cut; 3 beyond the limits; 4 input or
output failed; 64 wrong usage.)";

struct Options {
  std::string input;
  bool json = false;
  bool gofs = false;
  bool coarse = false;
  bool trace = false;
  std::string html;
  std::string pictures;
  std::uint32_t frame = 0;
  std::string extract;
  std::string output;
  std::uint64_t max_memory_bytes = rlpc::DecodeLimits().max_memory_bytes;
};

int complain(const std::string& message, int code) {
  rlpc::print_message("rlpcinfo", rlpc::with_decoder_options(message));
  return code;
}

int complain(const Options& o, const rlpc::Error& error) {
  rlpc::DecodeLimits limits;
  limits.max_memory_bytes = o.max_memory_bytes;
  return complain(rlpc::stream_message(o.input, error, limits), rlpc::exit_code(error.code));
}

int complain(const rlpc::OutputError& error) {
  return complain(error.message, rlpc::exit_code(error));
}

// Outputs besides standard output.
struct Outputs {
  std::optional<rlpc::OutputFile> page;
  std::optional<rlpc::PictureFolder> folder;

  bool have_pictures() const { return page || folder; }
};

rlpc::OutputResult<Outputs> open_outputs(const Options& o) {
  Outputs outputs;
  if (!o.html.empty()) {
    auto file = rlpc::OutputFile::create(o.html);
    if (!file) return file.error();
    outputs.page.emplace(std::move(*file));
  }
  if (!o.pictures.empty()) {
    auto folder = rlpc::PictureFolder::create(o.pictures, o.input);
    if (!folder) return folder.error();
    outputs.folder.emplace(std::move(*folder));
  }
  return outputs;
}

std::optional<rlpc::OutputError> write_outputs(Outputs& outputs, const rlpc::StreamInfo& info) {
  if (outputs.folder) {
    const auto pictures = rlpc::gof_pictures(*info.pictured, rlpc::kMaxFileTriangles);
    if (auto error = outputs.folder->write(pictures)) return error;
  }
  if (outputs.page) return rlpc::write_and_commit(*outputs.page, rlpc::page_text(info));
  return std::nullopt;
}

// Decodes the frame of the pictures: all vertices in decoded order, grid units.
rlpc::Result<std::vector<float>> decoded_frame(const Options& o, rlpc::ByteSource& source,
                                               std::span<const std::uint32_t> vertex_order) {
  rlpc::DecoderOptions options;
  options.limits.max_memory_bytes = o.max_memory_bytes;
  options.verify_hashes = false;
  auto decoder = rlpc::Decoder::open(std::make_unique<rlpc::BorrowedSource>(source), options);
  if (!decoder) return decoder.error();
  if (o.frame > 0) {  // a seek reads the GOF index, which may be wrong
    if (const auto found = decoder->seek(o.frame); !found) return found.error();
  }
  std::vector<std::int32_t> positions(3 * std::size_t{decoder->num_vertices()});
  if (const auto more = decoder->next_frame(positions); !more) return more.error();
  std::vector<float> xyz(positions.size());
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const std::size_t v = vertex_order.empty() ? i / 3 : vertex_order[i / 3];
    xyz[i] = static_cast<float>(positions[3 * v + i % 3]);
  }
  return xyz;
}

// Summarises the stream, and sets pictured.groups if pictures are requested.
rlpc::Result<rlpc::StreamSummary> summarise(const Options& o, bool with_pictures,
                                            rlpc::StreamReader& stream,
                                            rlpc::PicturedFrame& pictured) {
  pictured.frame = o.frame;
  return rlpc::summarise_all(
      stream, [&](const rlpc::AccessUnit& gof) -> std::optional<rlpc::Error> {
        const rlpc::GofHeader& header = gof.header();
        const bool has_frame =
            header.first_frame <= o.frame && o.frame < header.first_frame + header.num_frames;
        if (with_pictures && has_frame)
          pictured.groups = rlpc::vertex_groups(gof, stream.context());
        return std::nullopt;
      });
}

int inform(const Options& o) {
  auto outputs = open_outputs(o);
  if (!outputs) return complain(outputs.error());
  const bool with_pictures = outputs->have_pictures();
  rlpc::BitCounter counter(o.trace);
  const auto source = rlpc::file_or_standard_input(o.input, o.max_memory_bytes);
  if (!source) return complain(o, source.error());
  const std::uint64_t bytes = (*source)->size();
  rlpc::DecoderOptions options;
  options.limits.max_memory_bytes = o.max_memory_bytes;
  options.trace = &counter;
  // Drops nothing, but counts the memory of coarse meshes.
  if (o.coarse || with_pictures) options.coarse_layers = rlpc::kMaxLayers;
  rlpc::StreamReader stream(std::make_unique<rlpc::BorrowedSource>(**source), options);
  if (const auto opened = stream.open(); !opened) return complain(o, opened.error());
  const std::uint32_t num_frames = stream.find_num_frames();
  if (o.frame >= num_frames) {
    return complain("--frame: expected 0 to " + std::to_string(num_frames - 1) + ", got " +
                        std::to_string(o.frame),
                    rlpc::kExitUsage);
  }
  rlpc::PicturedFrame pictured;
  const auto summary = summarise(o, with_pictures, stream, pictured);
  if (!summary) return complain(o, summary.error());
  counter.finish(8 * bytes);
  if (o.trace) return rlpc::kExitDone;
  rlpc::SequenceHeader header = stream.header();
  header.num_frames = summary->num_frames();  // an open-ended stream does not declare it
  rlpc::StreamInfo info{o.input,           header,         counter, bytes, *summary,
                        stream.metadata(), stream.clips(), {}};
  info.max_json_bytes =
      o.max_memory_bytes - std::min(o.max_memory_bytes, stream.bytes_in_use());
  if (stream.attribute_unit() || stream.asset_unit()) {
    info.attributes = rlpc::ListedAttributes::of(**source, o.max_memory_bytes);
  }
  std::optional<rlpc::CoarseMeshes> meshes;
  if (o.coarse || with_pictures) {
    meshes = rlpc::CoarseMeshes::from_output(stream.header().num_vertices, stream.triangles(),
                                             stream.vertex_order());
    if (o.coarse) info.coarse = &*meshes;
  }
  if (with_pictures) {
    auto xyz = decoded_frame(o, **source, stream.vertex_order());
    if (!xyz) return complain(o, xyz.error());
    pictured.xyz = std::move(*xyz);
    pictured.meshes = &*meshes;
    info.pictured = &pictured;
  }
  if (const auto error = write_outputs(*outputs, info)) return complain(*error);
  if (o.json) {
    rlpc::print_json(info);
  } else if (o.html != "-") {
    rlpc::print_table(info, o.gofs);
  }
  return rlpc::kExitDone;
}

// Returns --extract.
CLI::Option* add_options(CLI::App& app, Options& o) {
  const std::string report = "Report";
  const std::string cut = "Smaller stream";
  app.add_option("STREAM", o.input, "Stream to inspect; - for standard input")->required();
  auto* json = app.add_flag("--json", o.json, "JSON on standard output")->group(report);
  auto* gofs = app.add_flag("--gofs", o.gofs, "Also list each GOF and slice")->group(report);
  auto* coarse = app.add_flag("--coarse", o.coarse,
                              "Also list the coarse meshes of rlpcdec --coarse; --html adds "
                              "pictures")
                     ->group(report);
  auto* html = app.add_option("--html", o.html, "Also write a page with charts and pictures")
                   ->option_text("FILE")
                   ->group(report);
  auto* pictures = app.add_option("--pictures", o.pictures,
                                  "Also write SVG pictures of clusters, bones or patches, and "
                                  "of vertex layers, to this folder")
                       ->option_text("FOLDER")
                       ->group(report);
  auto* frame = app.add_option("--frame", o.frame,
                               "Frame that pictures show, with its GOF, from 0 (default: 0)")
                    ->option_text("F")
                    ->group(report);
  auto* trace =
      app.add_flag("--trace", o.trace, "List every syntax element instead")->group(report);
  app.add_option(
         "--max-memory", o.max_memory_bytes,
         "Refuse streams that need more to decode, for example 500MB (1 MB: 1000 * 1000 "
         "bytes; 1 MiB: 1024 * 1024; default: 4GiB)")
      ->transform(CLI::AsSizeValue(true))
      ->option_text("SIZE")
      ->group(report);
  auto* extract = app.add_option("--extract", o.extract, "Write a stream without fine slices")
                      ->option_text("components=K,layers=L,temporal=N")
                      ->group(cut);
  auto* output = app.add_option("-o,--output", o.output,
                                "With --extract: stream to write; - for standard output")
                     ->option_text("FILE")
                     ->group(cut);
  trace->excludes(json)->excludes(html)->excludes(coarse)->excludes(pictures);
  extract->needs(output)->excludes(gofs)->excludes(trace)->excludes(html)->excludes(coarse);
  extract->excludes(pictures)->excludes(frame);
  output->needs(extract);
  rlpc::add_help(app, {"STREAM [OPTIONS]", {report, cut}, kExamples, kDetails}, RLPC_VERSION);
  return extract;
}

}  // namespace

int main(int argc, char** argv) try {
  rlpc::handle_interrupts();
  CLI::App app("Shows what an .rlpc stream contains.", "rlpcinfo");
  Options options;
  auto* extract = add_options(app, options);
  if (const auto code = rlpc::parse_command_line(app, argc, argv)) return *code;
  if (rlpc::OutputFile::is_same_file(options.html, options.input)) {
    return complain(options.html + ": is also an input; choose another name for the output",
                    rlpc::kExitUsage);
  }
  if (app.count("--frame") > 0 && options.html.empty() && options.pictures.empty()) {
    return complain("--frame is for pictures; add --html FILE or --pictures FOLDER",
                    rlpc::kExitUsage);
  }
  if (options.json && (options.html == "-" || options.output == "-")) {
    return complain("--json and another output cannot both go to standard output",
                    rlpc::kExitUsage);
  }
  if (extract->count() == 0)
    return rlpc::after_standard_output("rlpcinfo", inform(options), rlpc::kExitIo);
  const auto cut = rlpc::parse_slice_cut(options.extract);
  if (!cut) {
    return complain(
        "--extract: expected components=K, layers=L, temporal=N, or several of them; K is at "
        "least 0, L and N at least 1, at most 4294967294; got `" +
            options.extract + "`",
        rlpc::kExitUsage);
  }
  rlpc::DecodeLimits limits;
  limits.max_memory_bytes = options.max_memory_bytes;
  return rlpc::after_standard_output(
      "rlpcinfo", rlpc::extract({options.input, options.output, *cut, limits, options.json}),
      rlpc::kExitIo);
} catch (const std::bad_alloc&) {
  std::fprintf(stderr, "rlpcinfo: out of memory\n");
  return rlpc::kExitLimit;
} catch (const std::exception& error) {
  rlpc::print_message("rlpcinfo", error.what());
  return rlpc::kExitLimit;
}
