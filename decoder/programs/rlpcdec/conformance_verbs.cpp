#include "decoder/programs/rlpcdec/conformance_verbs.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <iostream>
#include <limits>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/cli/command_line.h"
#include "common/codec/syntax/stream_format.h"
#include "common/files/binary_numbers.h"
#include "common/files/messages.h"
#include "common/files/output_file.h"
#include "common/json/json.h"
#include "decoder/describe_error.h"
#include "decoder/meshes/frame_sink.h"
#include "decoder/meshes/rlpa_file.h"
#include "decoder/programs/exit_code.h"
#include "decoder/programs/setting_options.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kContract = 1;

struct Request {
  std::string input;
  std::string output;
  DecoderOptions decoder;
};

// 7.3: writes binary32 coordinates, x y z of each vertex of each frame, little-endian, without
// a header.
class F32Sink : public FrameSink {
 public:
  F32Sink(const Grid& grid, OutputFile file) : grid_(grid), file_(std::move(file)) {}

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) override {
    bytes_.clear();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      append_f32(bytes_, float_position(grid_, i % 3, positions[i]));
    }
    return file_.write(bytes_);
  }

  std::optional<OutputError> finish() override {
    if (auto error = file_.close()) return error;
    return file_.commit();
  }

 private:
  Grid grid_;
  OutputFile file_;
  std::string bytes_;
};

OutputResult<std::unique_ptr<FrameSink>> open_sink(const std::string& path,
                                                   const Decoder& decoder) {
  const SequenceHeader& header = decoder.header();
  if (std::string_view(path).ends_with(".f32")) {
    auto file = OutputFile::create(path);
    if (!file) return file.error();
    return std::unique_ptr<FrameSink>(std::make_unique<F32Sink>(header.grid, std::move(*file)));
  }
  SinkOptions options{header.num_vertices,
                      header.num_frames,
                      header.frame_rate,
                      header.grid,
                      {decoder.triangles().begin(), decoder.triangles().end()}};
  options.keep_partial = true;
  return open_rlpd_sink(path, std::move(options));
}

// Result of decoding: an error of the stream, an error of the output, or none.
struct Outcome {
  std::optional<Error> error;
  std::optional<OutputError> output_error;
  std::uint32_t frames = 0;  // number in the output
};

Outcome decode_frames(const Request& request) {
  Outcome outcome;
  // The sink outlives exceptions: frames decoded before memory ran out are kept.
  std::unique_ptr<FrameSink> sink;
  try {
    auto source = file_source(request.input, request.decoder.limits.max_memory_bytes);
    if (!source) return {source.error(), {}, 0};
    auto decoder = Decoder::open(std::move(*source), request.decoder);
    if (!decoder) return {decoder.error(), {}, 0};
    auto opened = open_sink(request.output, *decoder);
    if (!opened) return {{}, opened.error(), 0};
    sink = std::move(*opened);
    std::vector<std::int32_t> positions(3 * std::size_t{decoder->header().num_vertices});
    for (;;) {
      const auto more = decoder->next_frame(positions);
      if (!more) outcome.error = more.error();
      if (!more || !*more) break;
      if (auto error = sink->write_frame(positions)) return {{}, error, outcome.frames};
      ++outcome.frames;
    }
  } catch (const std::bad_alloc&) {
    outcome.error = Error{Errc::kLimitExceeded, "", "memory", 0};
  }
  if (sink) outcome.output_error = sink->finish();
  return outcome;
}

// Decodes all frames, without output, and then writes the attributes. As in the specification,
// their syntax is checked before the first frame, and their predictions after the last one.
Outcome decode_attributes(const Request& request) {
  Outcome outcome;
  try {
    auto source = file_source(request.input, request.decoder.limits.max_memory_bytes);
    if (!source) return {source.error(), {}, 0};
    auto decoder = Decoder::open(std::move(*source), request.decoder);
    if (!decoder) return {decoder.error(), {}, 0};
    if (const auto asset = decoder->asset(); !asset) return {asset.error(), {}, 0};
    const auto sets = decoder->attributes();
    const bool is_late = !sets && std::string_view(sets.error().rule) == "R-ATT-08";
    if (!sets && !is_late) return {sets.error(), {}, 0};
    std::vector<std::int32_t> positions(3 * std::size_t{decoder->header().num_vertices});
    for (;; ++outcome.frames) {
      const auto more = decoder->next_frame(positions);
      if (!more) return {more.error(), {}, outcome.frames};
      if (!*more) break;
    }
    if (!sets) return {sets.error(), {}, outcome.frames};
    if (decoder->has_attributes()) {
      outcome.output_error =
          write_rlpa(request.output, decoder->header().num_vertices,
                     static_cast<std::uint32_t>(decoder->triangles().size()), *sets);
    }
  } catch (const std::bad_alloc&) {
    outcome.error = Error{Errc::kLimitExceeded, "", "memory", 0};
  }
  return outcome;
}

void print_verdict(const Error& error, std::uint32_t frames) {
  Json verdict;
  if (error.rule[0] != '\0') verdict["rule"] = error.rule;
  verdict["bit"] = error.bit_pos;
  verdict["frame"] = frames;
  std::cerr << "rlpc-verdict " << json_text(verdict) << "\n";
}

int decode(const Request& request) {
  const bool wants_attributes = std::string_view(request.output).ends_with(".rlpa");
  const Outcome outcome =
      wants_attributes ? decode_attributes(request) : decode_frames(request);
  if (outcome.output_error) {
    print_message("rlpcdec", with_decoder_options(outcome.output_error->message));
    return kExitIo;
  }
  if (!outcome.error) return kExitDone;
  print_message("rlpcdec", request.input + ": " + describe_error(*outcome.error));
  const ExitCode code = exit_code(outcome.error->code);
  if (code != kExitIo) print_verdict(*outcome.error, outcome.frames);
  return code;
}

int describe() {
  Json versions = Json::array();
  for (std::uint32_t minor = 0; minor <= kVersionMinor; ++minor) {
    versions.push_back(std::to_string(kVersionMajor) + "." + std::to_string(minor));
  }
  Json levels = Json::array();
  for (std::size_t level = 1; level <= kLevels.size(); ++level) levels.push_back(level);
  const Json answer = {{"contract", kContract},
                       {"name", "rlpcdec"},
                       {"version", RLPC_VERSION},
                       {"spec", versions},
                       {"profiles", Json::array({"baseline", "main", "high"})},
                       {"levels", levels},
                       {"outputs", Json::array({"rlpd", "f32", "rlpa"})}};
  std::cout << json_text(answer) << "\n";
  return kExitDone;
}

}  // namespace

std::optional<int> run_conformance_verb(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  if (arguments.size() == 2 && std::string_view(arguments[1]) == "--rlpc-conformance") {
    return describe();
  }
  if (arguments.size() < 2 || std::string_view(arguments[1]) != "decode") return std::nullopt;
  CLI::App app("Decodes a stream for the conformance judge.", "rlpcdec decode");
  Request request;
  // Levels bound the memory of a stream; without --max-mem there is no other limit.
  request.decoder.limits.max_memory_bytes = std::numeric_limits<std::uint64_t>::max();
  app.add_option("input", request.input, "Stream to decode")->required();
  app.add_option("output", request.output,
                 "OUT.rlpd (Annex A), OUT.f32 (7.3) or OUT.rlpa (F.9)")
      ->required();
  app.add_option("--max-mem", request.decoder.limits.max_memory_bytes,
                 "Refuse streams that need more bytes of memory")
      ->option_text("BYTES");
  add_help(app,
           {"IN.rlpc OUT [OPTIONS]",
            {"Options"},
            "Example\n  rlpcdec decode a.rlpc a.rlpd",
            "conformance/VALIDATE.md describes this interface."},
           RLPC_VERSION);
  if (const auto code = parse_command_line(app, argc - 1, argv + 1)) return *code;
  return decode(request);
}

}  // namespace rlpc
