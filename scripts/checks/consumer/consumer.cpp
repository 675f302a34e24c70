// A user of the installed decoder library: counts the frames of a stream.
#include <rlpc/decoder/rlpc_decoder.h>

#include <cstdio>
#include <utility>
#include <vector>

int main(int argc, char** argv) {
  auto source = rlpc::file_source(argc > 1 ? argv[1] : "");
  if (!source) return 1;
  auto decoder = rlpc::Decoder::open(std::move(*source));
  if (!decoder) return 1;
  std::vector<std::int32_t> positions(3 * std::size_t{decoder->header().num_vertices});
  while (true) {
    const auto more = decoder->next_frame(positions);
    if (!more) return 1;
    if (!*more) break;
  }
  std::printf("%u frames\n", decoder->position());
}
