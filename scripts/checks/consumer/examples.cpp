// Examples in the comments of the public headers in C++, between marks that check_api.py
// compares with the headers. Run in a folder with dance.rlpc:
//   examples walk.obj walk.pc2
#include <rlpc/decoder/describe_error.h>
#include <rlpc/decoder/rlpc_decoder.h>
#include <rlpc/encoder/frame_encoder.h>
#include <rlpc/encoder/rlpc_encoder.h>

#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace {

std::size_t num_used = 0;
std::size_t num_written = 0;

int report(const rlpc::Error& error) {
  std::fprintf(stderr, "%s\n", rlpc::describe_error(error).c_str());
  return 1;
}

int complain(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return 1;
}

void use(std::span<const rlpc::Triangle>, const std::vector<std::int32_t>&) { ++num_used; }

bool write(std::span<const std::uint8_t> bytes) {
  num_written += bytes.size();
  return true;
}

int decode() {
  // Example of decoder/rlpc_decoder.h
  auto source = rlpc::file_source("dance.rlpc");
  if (!source) return report(source.error());
  auto decoder = rlpc::Decoder::open(std::move(*source));
  if (!decoder) return report(decoder.error());
  std::vector<std::int32_t> positions(3 * std::size_t{decoder->num_vertices()});
  for (;;) {
    const auto more = decoder->next_frame(positions);
    if (!more) return report(more.error());  // rule id, element and bit position
    if (!*more) break;                       // the stream is complete and has been checked
    use(decoder->triangles(), positions);
  }
  // End of the example
  return num_used == decoder->num_frames() ? 0 : complain("frames were not decoded");
}

int encode(rlpc::FrameSource& source) {
  // Example of encoder/rlpc_encoder.h
  rlpc::EncoderSettings settings;
  settings.target = {rlpc::Target::kKg, 0.1};
  const auto sink = [&](auto bytes) { return write(bytes); };
  const auto report = rlpc::encode(source, settings, sink);
  if (!report) return complain(report.error().message);
  // End of the example
  return num_written == report->bytes ? 0 : complain("not all bytes were written");
}

int encode_frames() {
  rlpc::FrameFormat format;
  format.num_vertices = 3;
  format.num_frames = 2;
  format.triangles = {{0, 1, 2}};
  format.box_min = {-10, -10, -10};
  format.box_max = {10, 10, 10};
  const rlpc::EncoderSettings settings;
  const auto sink = [](auto bytes) { return write(bytes); };
  const std::array<std::array<float, 9>, 2> frames{
      {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 1, 0, 0, 0, 1, 0}}};
  // Example of encoder/frame_encoder.h
  auto encoder = rlpc::FrameEncoder::create(format, settings, sink);
  if (!encoder) return complain(encoder.error().message);
  for (const auto& xyz : frames) {
    if (const auto error = encoder->add_frame(xyz)) return complain(error->message);
  }
  const auto report = encoder->finish();
  if (!report) return complain(report.error().message);
  // End of the example
  return report->num_gofs == 1 ? 0 : complain("there is more than one GOF");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 64;
  const auto source =
      rlpc::open_frame_source({.path = argv[1], .points = argv[2], .frame_rate = {}});
  if (!source) return complain(source.error().message);
  const int failed = decode() + encode(**source) + encode_frames();
  std::printf("%d examples failed\n", failed);
  return failed == 0 ? 0 : 1;
}
