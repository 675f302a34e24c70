#include "decoder/programs/rlpcdec/html_verb.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

#include "common/files/messages.h"
#include "decoder/describe_error.h"
#include "decoder/programs/borrowed_source.h"
#include "decoder/programs/exit_code.h"
#include "decoder/programs/setting_options.h"
#include "decoder/web/player/player_page.h"

namespace rlpc {
namespace {

int complain(const std::string& message, int code) {
  print_message("rlpcdec", with_decoder_options(message));
  return code;
}

int complain(const std::string& input, const Error& error) {
  return complain(input + ": " + describe_error(error), exit_code(error.code));
}

Result<Decoder> look_at(ByteSource& source, const DecoderOptions& options) {
  return Decoder::open(std::make_unique<BorrowedSource>(source), options);
}

// Decodes the whole stream to report damage after the first GOF. The page is still written, and
// shows the damage.
int check_whole(const std::string& input, Decoder& decoder) {
  std::vector<std::int32_t> positions(3 * std::size_t{decoder.header().num_vertices});
  for (;;) {
    const auto more = decoder.next_frame(positions);
    if (!more) return complain(input + " (the page marks the damaged frames)", more.error());
    if (!*more) return kExitDone;
  }
}

bool same_mesh(const Decoder& a, const Decoder& b) {
  const auto triangles = a.triangles();
  return a.header().num_vertices == b.header().num_vertices &&
         a.num_frames() == b.num_frames() &&
         std::equal(triangles.begin(), triangles.end(), b.triangles().begin(),
                    b.triangles().end());
}

std::string title(const std::string& input) {
  if (input == "-") return "animation";
  return std::filesystem::path(input).filename().string();
}

}  // namespace

int write_html(const HtmlRequest& request, ByteSource& stream) {
  const auto player = read_player(request.player);
  if (!player) return complain(player.error().message, kExitIo);
  auto decoder = look_at(stream, request.decoder);
  if (!decoder) return complain(request.input, decoder.error());
  std::unique_ptr<ByteSource> reference;
  if (!request.reference.empty()) {
    auto opened = file_source(request.reference, request.decoder.limits.max_memory_bytes);
    if (!opened) return complain(request.reference, opened.error());
    reference = std::move(*opened);
    const auto other = look_at(*reference, request.decoder);
    if (!other) return complain(request.reference, other.error());
    if (!same_mesh(*decoder, *other)) {
      return complain(request.reference + ": differs from " + request.input +
                          " in its frames, vertices or triangles, or in their order; encode " +
                          "both from the same mesh, both with --keep-order or both without",
                      kExitUsage);
    }
  }
  const PageStreams streams{title(request.input), &stream, reference.get()};
  if (const auto error = write_player_page(request.output, *player, streams, request.limit)) {
    return complain(error->message, exit_code(*error));
  }
  if (!request.quiet) {
    std::fprintf(stderr, "%s: plays %u frames of %u vertices; open it in a browser\n",
                 printable(request.output).c_str(), decoder->num_frames().value_or(0),
                 decoder->header().num_vertices);
  }
  return check_whole(request.input, *decoder);
}

}  // namespace rlpc
