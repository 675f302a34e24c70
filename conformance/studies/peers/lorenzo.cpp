#include <cstdlib>

#include "conformance/studies/peers/byte_stream.h"
#include "conformance/studies/peers/peer_codecs.h"

namespace rlpc::peers {
namespace {

using Neighbours = std::vector<std::vector<std::uint32_t>>;

// Returns, for each vertex, the neighbours with a smaller index, once per shared triangle.
Neighbours earlier_neighbours(const QuantisedAnimation& a) {
  Neighbours out(a.num_vertices);
  for (const Triangle& t : a.triangles) {
    for (const std::uint32_t v : t) {
      for (const std::uint32_t other : t) {
        if (other < v) out[v].push_back(other);
      }
    }
  }
  return out;
}

// Returns the change of value i in frame f: from the previous frame (order 1), or from the
// linear extrapolation of the two previous frames (order 2).
int change(const QuantisedAnimation& a, int order, std::size_t f, std::size_t i) {
  const int here = a.frames[f][i];
  if (f == 0) return here;
  const int before = a.frames[f - 1][i];
  if (order == 1 || f == 1) return here - before;
  return here - 2 * before + a.frames[f - 2][i];
}

// Predicts change() as the mean of the neighbours.
int predict(const QuantisedAnimation& a, const std::vector<std::uint32_t>& neighbours,
            int order, std::size_t f, std::size_t axis) {
  if (neighbours.empty()) return 0;
  int sum = 0;
  for (const std::uint32_t v : neighbours)
    sum += change(a, order, f, 3 * std::size_t{v} + axis);
  return sum / static_cast<int>(neighbours.size());
}

// Returns all residuals modulo 2^16, frame by frame and axis by axis.
std::vector<std::int16_t> residuals_of(const QuantisedAnimation& a,
                                       const Neighbours& neighbours, int order) {
  std::vector<std::int16_t> out;
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t v = 0; v < a.num_vertices; ++v) {
        out.push_back(static_cast<std::int16_t>(change(a, order, f, 3 * v + axis) -
                                                predict(a, neighbours[v], order, f, axis)));
      }
    }
  }
  return out;
}

std::uint64_t magnitude(const std::vector<std::int16_t>& residuals) {
  std::uint64_t sum = 0;
  for (const int r : residuals) sum += static_cast<std::uint64_t>(std::abs(r));
  return sum;
}

// Moves signs to the lowest bit, and all low bytes before all high bytes.
std::string byte_planes(const std::vector<std::int16_t>& residuals) {
  std::string out(2 * residuals.size(), '\0');
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const int r = residuals[i];
    const int code = r < 0 ? -2 * r - 1 : 2 * r;
    out[i] = static_cast<char>(code & 0xFF);
    out[residuals.size() + i] = static_cast<char>(code >> 8);
  }
  return out;
}

}  // namespace

Bytes write_lorenzo(const QuantisedAnimation& a) {
  ByteWriter out;
  write_head(out, a);
  write_triangles(out, a.triangles);
  const Neighbours neighbours = earlier_neighbours(a);
  const auto first = residuals_of(a, neighbours, 1);
  const auto second = residuals_of(a, neighbours, 2);
  const int order = magnitude(first) <= magnitude(second) ? 1 : 2;
  out.u32(static_cast<std::uint32_t>(order));
  out.raw(byte_planes(order == 1 ? first : second));
  return out.take();
}

QuantisedAnimation read_lorenzo(const Bytes& bytes) {
  ByteReader in(bytes);
  QuantisedAnimation a = read_head(in);
  a.triangles = read_triangles(in, a.triangles.size());
  const Neighbours neighbours = earlier_neighbours(a);
  const int order = static_cast<int>(in.u32());
  const std::size_t count = 3 * std::size_t{a.num_vertices} * a.frames.size();
  const std::string_view low = in.raw(count);
  const std::string_view high = in.raw(count);
  std::size_t at = 0;
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t v = 0; v < a.num_vertices; ++v, ++at) {
        const int code =
            static_cast<unsigned char>(low[at]) | static_cast<unsigned char>(high[at]) << 8;
        const int residual = (code & 1) != 0 ? -(code + 1) / 2 : code / 2;
        // The value itself is still zero, so -change() is its prediction from previous frames.
        const std::size_t i = 3 * v + axis;
        a.frames[f][i] = static_cast<std::uint16_t>(
            residual + predict(a, neighbours[v], order, f, axis) - change(a, order, f, i));
      }
    }
  }
  return a;
}

}  // namespace rlpc::peers
