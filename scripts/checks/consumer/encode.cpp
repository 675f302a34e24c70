// Encodes a mesh and a point cache:  encode walk.obj walk.pc2 walk.rlpc
#include <rlpc/encoder/rlpc_encoder.h>

#include <cstdio>
#include <fstream>

int complain(const rlpc::InputError& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

int main(int argc, char** argv) {
  if (argc != 4) return 64;
  auto source = rlpc::open_frame_source({.path = argv[1], .points = argv[2], .frame_rate = {}});
  if (!source) return complain(source.error());

  std::ofstream out(argv[3], std::ios::binary);
  rlpc::EncoderSettings settings;
  settings.preset = rlpc::Preset::kFast;
  settings.target = {rlpc::Target::kKg, 0.2};  // per cent
  const auto report = rlpc::encode(**source, settings, [&](auto bytes) {
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    return out.good();
  });
  if (!report) return complain(report.error());

  std::printf("%.3f bits per vertex and frame, KG error %.3f %%\n", report->bpvf,
              report->metrics.kg_error_percent);
  return out.flush() ? 0 : 1;
}
