// Decodes a stream, frame by frame:  decode walk.rlpc frames.f32
// To frames.f32 go x, y and z of each vertex as floats, one frame after another.
#include <rlpc/decoder/describe_error.h>
#include <rlpc/decoder/rlpc_decoder.h>

#include <cstdio>
#include <fstream>
#include <utility>
#include <vector>

int complain(const rlpc::Error& error) {
  std::fprintf(stderr, "%s\n", rlpc::describe_error(error).c_str());
  return 1;
}

int main(int argc, char** argv) {
  if (argc != 3) return 64;
  std::ofstream out(argv[2], std::ios::binary);
  auto source = rlpc::file_source(argv[1]);
  if (!source) return complain(source.error());
  auto decoder = rlpc::Decoder::open(std::move(*source));
  if (!decoder) return complain(decoder.error());

  const rlpc::SequenceHeader& header = decoder->header();
  std::vector<std::int32_t> positions(3 * std::size_t{header.num_vertices});
  std::vector<float> xyz(positions.size());
  for (;;) {
    const auto more = decoder->next_frame(positions);
    if (!more) return complain(more.error());
    if (!*more) break;
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      xyz[i] = rlpc::float_position(header.grid, i % 3, positions[i]);
    }
    out.write(reinterpret_cast<const char*>(xyz.data()),
              static_cast<std::streamsize>(xyz.size() * sizeof(float)));
  }
  std::printf("%u frames of %u vertices\n", decoder->position(), header.num_vertices);
  return out.flush() ? 0 : 1;
}
