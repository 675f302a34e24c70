#include <meshoptimizer.h>

#include <stdexcept>

#include "conformance/studies/peers/byte_stream.h"
#include "conformance/studies/peers/peer_codecs.h"

namespace rlpc::peers {
namespace {

using Vertex = std::array<std::uint16_t, 4>;  // the last is 0: sizes are multiples of 4 bytes

template <class T>
T* data_of(std::string_view bytes) {
  return reinterpret_cast<T*>(bytes.data());
}

std::string encode_triangles(const std::vector<Triangle>& triangles, std::size_t num_vertices) {
  const std::size_t corners = 3 * triangles.size();
  std::string out(meshopt_encodeIndexBufferBound(corners, num_vertices), '\0');
  out.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(),
                                       triangles.data()->data(), corners));
  return out;
}

std::string encode_vertices(const std::vector<Vertex>& vertices) {
  std::string out(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Vertex)), '\0');
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()),
                                        out.size(), vertices.data(), vertices.size(),
                                        sizeof(Vertex)));
  return out;
}

void require(bool good) {
  if (!good) throw std::runtime_error("meshoptimizer cannot read what it wrote");
}

}  // namespace

Bytes write_meshopt(const QuantisedAnimation& a) {
  ByteWriter out;
  write_head(out, a);
  if (!a.triangles.empty()) out.piece(encode_triangles(a.triangles, a.num_vertices));
  std::vector<Vertex> differences(a.num_vertices);
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    for (std::size_t i = 0; i < a.frames[f].size(); ++i) {
      const int before = f > 0 ? a.frames[f - 1][i] : 0;
      differences[i / 3][i % 3] = static_cast<std::uint16_t>(a.frames[f][i] - before);
    }
    out.piece(encode_vertices(differences));
  }
  return out.take();
}

QuantisedAnimation read_meshopt(const Bytes& bytes) {
  ByteReader in(bytes);
  QuantisedAnimation a = read_head(in);
  if (!a.triangles.empty()) {
    const std::string_view piece = in.piece();
    require(meshopt_decodeIndexBuffer(a.triangles.data(), 3 * a.triangles.size(),
                                      sizeof(std::uint32_t),
                                      data_of<const unsigned char>(piece), piece.size()) == 0);
  }
  std::vector<Vertex> differences(a.num_vertices);
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    const std::string_view piece = in.piece();
    require(meshopt_decodeVertexBuffer(differences.data(), differences.size(), sizeof(Vertex),
                                       data_of<const unsigned char>(piece), piece.size()) == 0);
    for (std::size_t i = 0; i < a.frames[f].size(); ++i) {
      const int before = f > 0 ? a.frames[f - 1][i] : 0;
      a.frames[f][i] = static_cast<std::uint16_t>(before + differences[i / 3][i % 3]);
    }
  }
  return a;
}

}  // namespace rlpc::peers
