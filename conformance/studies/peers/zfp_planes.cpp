#include <zfp.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "conformance/studies/peers/byte_stream.h"
#include "conformance/studies/peers/peer_codecs.h"

namespace rlpc::peers {
namespace {

// zfp opened on a buffer of bytes.
class Stream {
 public:
  Stream(void* bytes, std::size_t size) : bits_(stream_open(bytes, size)) {
    zfp_.reset(zfp_stream_open(bits_.get()));
    zfp_stream_rewind(zfp_.get());
  }
  zfp_stream* get() const { return zfp_.get(); }

 private:
  struct Close {
    void operator()(bitstream* bits) const { stream_close(bits); }
    void operator()(zfp_stream* zfp) const { zfp_stream_close(zfp); }
  };
  std::unique_ptr<bitstream, Close> bits_;
  std::unique_ptr<zfp_stream, Close> zfp_;
};

struct FreeField {
  void operator()(zfp_field* field) const { zfp_field_free(field); }
};
using Field = std::unique_ptr<zfp_field, FreeField>;

// Describes plane[f * num_vertices + v].
Field field_of(std::vector<float>& plane, std::size_t num_vertices) {
  return Field(
      zfp_field_2d(plane.data(), zfp_type_float, num_vertices, plane.size() / num_vertices));
}

std::string encode(std::vector<float> plane, std::size_t num_vertices, double tolerance) {
  const Field field = field_of(plane, num_vertices);
  Stream sizing(nullptr, 0);
  zfp_stream_set_accuracy(sizing.get(), tolerance);
  std::string out(zfp_stream_maximum_size(sizing.get(), field.get()), '\0');
  Stream stream(out.data(), out.size());
  zfp_stream_set_accuracy(stream.get(), tolerance);
  out.resize(zfp_compress(stream.get(), field.get()));
  if (out.empty()) throw std::runtime_error("zfp cannot encode this");
  return out;
}

}  // namespace

Bytes write_zfp(const Animation& animation, int bits) {
  ByteWriter out;
  write_sizes(out,
              {animation.num_vertices, animation.triangles.size(), animation.frames.size()});
  write_triangles(out, animation.triangles);
  const auto tolerance = static_cast<float>(std::ldexp(longest_side(animation), -bits));
  out.f32(tolerance);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<float> plane;
    for (const auto& frame : animation.frames) {
      for (std::size_t i = axis; i < frame.size(); i += 3) plane.push_back(frame[i]);
    }
    out.piece(encode(std::move(plane), animation.num_vertices, double{tolerance}));
  }
  return out.take();
}

Animation read_zfp(const Bytes& bytes) {
  ByteReader in(bytes);
  const Sizes sizes = read_sizes(in);
  Animation out{static_cast<std::uint32_t>(sizes.num_vertices), {}, {}};
  out.triangles = read_triangles(in, sizes.num_triangles);
  out.frames.assign(sizes.num_frames, std::vector<float>(3 * sizes.num_vertices));
  const float tolerance = in.f32();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::string coded(in.piece());
    coded.resize((coded.size() + 15) / 8 * 8);  // zfp reads whole words
    std::vector<float> plane(sizes.num_vertices * sizes.num_frames);
    const Field field = field_of(plane, sizes.num_vertices);
    Stream stream(coded.data(), coded.size());
    zfp_stream_set_accuracy(stream.get(), double{tolerance});
    if (zfp_decompress(stream.get(), field.get()) == 0) {
      throw std::runtime_error("zfp cannot read what it wrote");
    }
    for (std::size_t i = 0; i < plane.size(); ++i) {
      out.frames[i / sizes.num_vertices][3 * (i % sizes.num_vertices) + axis] = plane[i];
    }
  }
  return out;
}

}  // namespace rlpc::peers
