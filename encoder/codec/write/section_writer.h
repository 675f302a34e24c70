// Writes a section of a unit (9.3); the counterpart of decoder/codec/parse/section_reader.h.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/bits/bit_model.h"
#include "common/codec/bits/range_encoder.h"
#include "common/codec/bits/residual_models.h"
#include "encoder/codec/write/write_residual.h"
#include "encoder/codec/write/write_track.h"

namespace rlpc {

class SectionWriter {
 public:
  void bin(BitModel& model, bool value) { re_.bin(model, value); }
  void bypass(int n, std::uint32_t value) { re_.bypass(n, value); }
  void residual(ResidualModels& models, std::uint32_t expected, std::int32_t value) {
    write_residual(re_, models, expected, value);
  }
  void track(std::span<ResidualModels> models, std::span<std::uint32_t> frame_mean,
             std::span<const TrackPlace> order, std::span<const Vec3i> residuals) {
    write_track(re_, models, frame_mean, order, residuals);
  }
  // 9.5.4 ae_header( field )
  void header_value(ResidualModels& models, std::uint32_t& mean, int value, int previous) {
    write_residual(re_, models, mean >> 4, value - previous);
    mean = update_mean(mean, magnitude_of(value - previous), 2);
  }
  // 9.5.5 ae_unary( models )
  template <std::size_t N>
  void truncated_unary(std::array<BitModel, N>& models, int value) {
    assert(value >= 0 && value <= static_cast<int>(N));
    for (std::size_t i = 0; i < N; ++i) {
      const bool more = static_cast<int>(i) < value;
      re_.bin(models[i], more);
      if (!more) break;
    }
  }
  // 9.5.6 ae_tree( models, depth ): models of the inner nodes, root at index 1.
  template <class Models>
  void tree(Models& models, std::uint32_t leaf) {
    std::size_t node = 1;
    for (std::size_t half = models.size() / 2; half > 0; half /= 2) {
      const bool bit = (leaf & half) != 0;
      re_.bin(models[node], bit);
      node = 2 * node + (bit ? 1U : 0U);
    }
  }
  // Returns the number of bytes so far.
  std::size_t size() const { return re_.size(); }
  // Ends the section and returns its bytes; the writer cannot be used afterwards.
  std::vector<std::uint8_t> finish() { return re_.finish(); }

 private:
  RangeEncoder re_;
};

}  // namespace rlpc
