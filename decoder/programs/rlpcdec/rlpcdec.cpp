// rlpcdec: decodes .rlpc streams to animations.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "common/cli/command_line.h"
#include "common/cli/frame_span.h"
#include "common/files/interrupts.h"
#include "common/files/messages.h"
#include "common/files/output_file.h"
#include "common/files/progress_bar.h"
#include "common/files/standard_output.h"
#include "common/json/json.h"
#include "decoder/meshes/frame_sink.h"
#include "decoder/meshes/stream_asset.h"
#include "decoder/programs/exit_code.h"
#include "decoder/programs/rlpcdec/chosen_frames.h"
#include "decoder/programs/rlpcdec/concealed_frames.h"
#include "decoder/programs/rlpcdec/conformance_verbs.h"
#include "decoder/programs/rlpcdec/decode_command_line.h"
#include "decoder/programs/rlpcdec/html_verb.h"
#include "decoder/programs/setting_options.h"
#include "decoder/programs/stream_message.h"
#include "decoder/rlpc_decoder.h"

namespace {

using Options = rlpc::DecodeCommand;

int complain(const std::string& message, int code) {
  rlpc::print_message("rlpcdec", rlpc::with_decoder_options(message));
  return code;
}

int complain(const Options& o, const rlpc::Error& error) {
  return complain(rlpc::stream_message(o.input, error, o.decoder.limits),
                  rlpc::exit_code(error.code));
}

// Returns whether frames are decoded as they arrive, because their number is unknown.
bool is_live(const Options& o, const rlpc::SequenceHeader& header) {
  if (!header.open_end_flag || o.is_part()) return false;
  const rlpc::SinkFormat format = rlpc::sink_format(o.output, o.format);
  const bool needs_count = format == rlpc::SinkFormat::kGlb ||
                           format == rlpc::SinkFormat::kMdd ||
                           (format == rlpc::SinkFormat::kPc2 && o.output != "-");
  return o.verify_only || !needs_count;
}

// Reports lost frames. end: the frame with which decoding resumes; none if it does not.
int complain_of_loss(const Options& o, const rlpc::Error& error, std::uint32_t first,
                     std::optional<std::uint32_t> end) {
  std::string lost = "; frames from " + std::to_string(first) + " on are lost";
  if (end && *end == first) {
    lost = "; no frame is lost";
  } else if (end && *end == first + 1) {
    lost = "; frame " + std::to_string(first) + " is lost, and repeats the one before";
  } else if (end) {
    lost = "; frames " + std::to_string(first) + " to " + std::to_string(*end - 1) +
           " are lost, and repeat the one before";
  }
  return complain(rlpc::stream_message(o.input, error, o.decoder.limits) + lost,
                  rlpc::exit_code(error.code));
}

// Numbers of frames decoded, verified against a hash, and lost to damage.
struct FrameCounts {
  std::uint32_t decoded = 0;
  std::uint32_t compared = 0;
  std::uint32_t lost = 0;
  int loss_code = rlpc::kExitDone;  // exit code of the last damage
};

std::string hashes_text(const Options& o, const rlpc::Decoder& decoder,
                        const FrameCounts& frames) {
  if (decoder.was_cut()) return ", cut; hashes of GOFs that lack slices were not verified";
  if (!o.decoder.verify_hashes) return "";
  if (frames.compared == frames.decoded) return ", hashes agree";
  if (frames.compared > 0) {
    return ", hashes of " + std::to_string(frames.compared) +
           " of them agree; the others have none";
  }
  return o.is_part() ? ", not verified: no hash covers only these frames (rlpcenc --hash frame)"
                     : ", without hashes";
}

bool is_coarse(const Options& o) { return o.decoder.coarse_layers != rlpc::SliceCut::kAll; }

std::string coarse_text(const Options& o, const rlpc::Decoder& decoder) {
  if (!is_coarse(o)) return "";
  const std::uint32_t layers = std::min(o.decoder.coarse_layers, decoder.num_layers());
  return " (" + std::to_string(layers) + " of " + std::to_string(decoder.num_layers()) +
         " vertex layers)";
}

// Reports what was decoded. sink: null if nothing was written.
void report(const Options& o, const rlpc::Decoder& decoder, const FrameCounts& frames,
            const rlpc::FrameSink* sink) {
  auto remarks = sink != nullptr ? sink->remarks() : std::vector<std::string>();
  for (std::string& remark : remarks) remark = rlpc::with_decoder_options(remark);
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
    std::cout << rlpc::json_text(json, 2) << "\n";
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

// Writes the frames. Returns the exit code of an error; none if all frames have been written.
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
  // Also checks the stream after the last frame.
  if (!o.is_part() && !live && frames.loss_code == rlpc::kExitDone) {
    if (const auto more = decoder.next_frame(positions); !more)
      return complain(o, more.error());
  }
  return std::nullopt;
}

// Returns the exit code of an asset that takes more memory in the output than is left.
int check_asset_memory(const Options& o, const rlpc::Decoder& decoder, std::string_view asset) {
  const rlpc::DecoderMemory memory = decoder.memory();
  const std::uint64_t needed = memory.stream_bytes + memory.gof_bytes + memory.cached_bytes +
                               rlpc::asset_memory_bytes(asset);
  if (needed <= o.decoder.limits.max_memory_bytes) return rlpc::kExitDone;
  rlpc::Error error{rlpc::Errc::kLimitExceeded, "", "asset_size"};
  error.needed_bytes = needed;
  return complain(rlpc::stream_message(o.input, error, o.decoder.limits) +
                      "; frames are written without materials",
                  rlpc::kExitLimit);
}

// Reads the attributes that the output can hold. Returns the exit code of an error; frames are
// still written.
int read_attributes(const Options& o, rlpc::Decoder& decoder, bool live,
                    rlpc::SinkOptions& options) {
  const rlpc::SinkFormat format = rlpc::sink_format(o.output, o.format);
  const bool has_mesh = !(live && format == rlpc::SinkFormat::kPc2);
  if (o.no_attributes || is_coarse(o) || !has_mesh || !rlpc::holds_attributes(format) ||
      !(decoder.has_attributes() || decoder.has_asset())) {
    return rlpc::kExitDone;
  }
  if (format != rlpc::SinkFormat::kPly) {
    auto asset = decoder.asset();
    if (!asset) {
      return complain(rlpc::stream_message(o.input, asset.error(), o.decoder.limits) +
                          "; frames are written without materials",
                      rlpc::exit_code(asset.error().code));
    }
    if (const int code = check_asset_memory(o, decoder, *asset); code != rlpc::kExitDone) {
      return code;
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
            ": an open-ended stream that has been cut off, so its number of frames is "
            "unknown. Write .rlpd, OBJ or PLY files, and all frames",
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
    options.threads = o.decoder.threads;
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
  for (const rlpc::Error& damage : decoder->damaged_units()) {
    frames.loss_code = complain(rlpc::stream_message(o.input, damage, o.decoder.limits) +
                                    "; the unit is skipped, no frame needs it",
                                rlpc::exit_code(damage.code));
  }
  return frames.loss_code != rlpc::kExitDone ? frames.loss_code : attributes_code;
}

}  // namespace

int main(int argc, char** argv) try {
  rlpc::handle_interrupts();
  if (const auto code = rlpc::run_conformance_verb(argc, argv)) return *code;
  CLI::App app("Decodes an .rlpc stream.", "rlpcdec");
  Options options;
  options.decoder.threads = std::max(1U, std::thread::hardware_concurrency());
  rlpc::add_decode_options(app, options);
  if (const auto code = rlpc::parse_command_line(app, argc, argv)) return *code;
  if (const std::string wrong = rlpc::find_usage_error(app, options); !wrong.empty()) {
    return complain(wrong, rlpc::kExitUsage);
  }
  options.decoder.verify_hashes = !options.no_hashes;
  options.decoder.skip_damaged_units = options.conceals;
  options.decoder.forward_only = options.frames.empty() && options.html.output.empty();
  return rlpc::after_standard_output("rlpcdec", decode(options), rlpc::kExitIo);
} catch (const std::bad_alloc&) {
  std::fprintf(stderr, "rlpcdec: out of memory\n");
  return rlpc::kExitLimit;
} catch (const std::exception& error) {
  rlpc::print_message("rlpcdec", error.what());
  return rlpc::kExitLimit;
}
