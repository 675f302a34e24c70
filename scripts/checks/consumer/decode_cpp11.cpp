// Decodes a stream with the library in C, in C++11:  decode_cpp11 walk.rlpc frames.f32
// To frames.f32 go x, y and z of each vertex as floats, one frame after another.
#include <rlpcdec.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <vector>

struct Close {
  void operator()(rlpc_decoder* decoder) const { rlpc_decoder_close(decoder); }
};

int main(int argc, char** argv) {
  if (argc != 3) return 64;
  std::ofstream out(argv[2], std::ios::binary);
  rlpc_decoder* opened = nullptr;
  rlpc_status status = rlpc_decoder_open_file(argv[1], nullptr, &opened);
  const std::unique_ptr<rlpc_decoder, Close> decoder(opened);

  rlpc_stream_info info = {};
  if (status == RLPC_OK) status = rlpc_decoder_info(decoder.get(), &info, sizeof info);
  std::vector<float> xyz(3 * static_cast<std::size_t>(info.num_vertices));
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = xyz.data();
  output.positions.num_bytes = xyz.size() * sizeof(float);
  output.positions.format = RLPC_FORMAT_FLOAT;
  while (status == RLPC_OK) {
    status = rlpc_decoder_next(decoder.get(), &output);
    if (status != RLPC_OK) break;
    out.write(reinterpret_cast<const char*>(xyz.data()),
              static_cast<std::streamsize>(xyz.size() * sizeof(float)));
  }
  if (status != RLPC_END) std::fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder.get()));
  return out.flush() && status == RLPC_END ? 0 : 1;
}
