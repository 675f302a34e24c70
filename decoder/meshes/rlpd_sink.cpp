// Sink of .rlpd files (Annex A).
#include <cassert>
#include <utility>

#include "common/files/binary_numbers.h"
#include "common/files/output_file.h"
#include "decoder/meshes/frame_sink.h"

namespace rlpc {

namespace {

class RlpdSink : public FrameSink {
 public:
  RlpdSink(SinkOptions options, OutputFile file)
      : options_(std::move(options)), file_(std::move(file)) {}

  std::optional<OutputError> write_header() {
    std::string bytes = "RLPD";
    append_u32(bytes, 1);
    append_u32(bytes, options_.num_vertices);
    append_u32(bytes, static_cast<std::uint32_t>(options_.triangles.size()));
    append_u32(bytes, options_.num_frames);
    append_u32(bytes, options_.frame_rate.numerator);
    append_u32(bytes, options_.frame_rate.denominator);
    append_i32(bytes, options_.grid.log2_step);
    for (const std::int32_t origin : options_.grid.origin) append_i32(bytes, origin);
    for (const Triangle& t : options_.triangles) {
      for (const std::uint32_t v : t) append_u32(bytes, v);
    }
    return file_.write(bytes);
  }

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) override {
    assert(positions.size() == 3 * std::size_t{options_.num_vertices});
    assert(written_ < options_.num_frames);
    bytes_.clear();
    for (const std::int32_t p : positions) append_i32(bytes_, p);
    ++written_;
    if (auto error = file_.write(bytes_)) return error;
    return options_.live ? file_.flush() : std::nullopt;
  }

  std::optional<OutputError> finish() override {
    assert(written_ == options_.num_frames || options_.keep_partial || options_.live);
    if (auto error = file_.close()) return error;
    return file_.commit();
  }

 private:
  SinkOptions options_;
  OutputFile file_;
  std::string bytes_;
  std::uint32_t written_ = 0;
};

}  // namespace

OutputResult<std::unique_ptr<FrameSink>> open_rlpd_sink(const std::string& path,
                                                        SinkOptions options) {
  auto file = OutputFile::create(path, options.limit);
  if (!file) return file.error();
  auto sink = std::make_unique<RlpdSink>(std::move(options), std::move(*file));
  if (auto error = sink->write_header()) return *error;
  return std::unique_ptr<FrameSink>(std::move(sink));
}

}  // namespace rlpc
