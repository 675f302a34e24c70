// 8.6.1 Output order, and 8.9.8 Coarse meshes: which decoded vertices are output, and in which
// order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"
#include "decoder/codec/gofs/coarse_output.h"
#include "decoder/codec/units/stream_reader.h"

namespace rlpc {

class OutputOrder {
 public:
  // Uses the mesh of the stream, which must be open and outlive the object.
  explicit OutputOrder(const StreamReader& stream) : stream_(stream) {}

  // From now on, outputs the coarse mesh of so many vertex layers.
  void use_coarse_mesh(std::uint32_t layers) {
    coarse_.emplace(stream_.header().num_vertices, stream_.triangles(), stream_.vertex_order(),
                    layers);
  }

  // The coarse mesh; none: the whole mesh is output.
  const std::optional<CoarseOutput>& coarse() const { return coarse_; }
  std::uint32_t num_vertices() const {
    return coarse_ ? static_cast<std::uint32_t>(coarse_->vertices().size())
                   : stream_.header().num_vertices;
  }
  std::span<const Triangle> triangles() const {
    return coarse_ ? coarse_->triangles() : stream_.triangles();
  }

  // Copies values of all decoded vertices, n of each, to those that are output.
  template <class T>
  void to_output(std::span<const T> decoded, std::span<T> output, std::size_t n) const {
    const std::span<const std::uint32_t> order = stream_.vertex_order();
    if (coarse_) {
      const std::span<const std::uint32_t> picked = coarse_->decoded();
      for (std::size_t i = 0; i < picked.size(); ++i) {
        std::copy_n(&decoded[n * picked[i]], n, &output[n * i]);
      }
    } else if (order.empty()) {
      std::copy(decoded.begin(), decoded.end(), output.begin());
    } else {
      for (std::size_t v = 0; v < order.size(); ++v) {
        std::copy_n(&decoded[n * v], n, &output[n * order[v]]);
      }
    }
  }

  // Returns the decoded index of each vertex of the output.
  Vector<std::uint32_t> decoded_indices() const {
    Vector<std::uint32_t> decoded(stream_.header().num_vertices);
    std::iota(decoded.begin(), decoded.end(), 0U);
    Vector<std::uint32_t> output(num_vertices());
    to_output<std::uint32_t>(decoded, output, 1);
    return output;
  }

 private:
  const StreamReader& stream_;
  std::optional<CoarseOutput> coarse_;
};

}  // namespace rlpc
