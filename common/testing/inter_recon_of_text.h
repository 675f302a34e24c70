// 8.19 Inter GOF: the positions of its frames, written as the pseudo-code is, for tests.
// Weights of 8.11 and rest positions of 8.18 are those of the reconstruction.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh_prediction/geometry_weights.h"
#include "common/codec/mesh_prediction/rest_recon.h"
#include "common/testing/filter_of_text.h"
#include "common/testing/patches_of_text.h"

namespace rlpc {

class InterReconOfText {
 public:
  using List = std::vector<std::int64_t>;

  // Outputs of 8.19.3 for a vertex of the last frame.
  struct Vertex {
    Vec3l predicted{};  // PredictedValue
    Vec3l plain{};      // PlainMotion
    Vec3l mean{};       // MotionMean
    std::array<List, 3> offsets;
  };

  InterReconOfText(const OrderedMesh& mesh, const InterGof& gof, int position_bits)
      : mesh_(mesh),
        gof_(gof),
        position_bits_(position_bits),
        order_(gof.pattern, gof.num_frames),
        decoded(gof.num_frames),
        vertices(mesh.num_vertices()) {}

  // DecodeFrame( f ), where f is the frame of the next place.
  void decode_next() {
    f_ = order_[place_].frame;
    const InterFrame& frame = (*gof_.frames)[f_];
    if (place_ == 1) start_motion();
    reference.assign(size(), 0);
    if (f_ > 0) make_reference(frame);
    if (f_ > 0 && gof_.num_patches > 0) {
      patches_.move(reference, order_[place_].depth, step_of_frame(), frame.patches);
    }
    values_.assign(size(), 0);
    std::uint32_t present = 0;
    for (std::uint32_t j = 0; j < frame.layer_groups; ++j) present += gof_.layer_group_size[j];
    if (f_ == 0 && gof_.rest.order_flag) {
      decode_positions_in_order(frame);
    } else {
      for (const std::uint32_t v : mesh_.order()) {
        is_present_ = mesh_.layer_of(v) < present;
        decode_vertex(frame, v);
        if (f_ > 0 && gof_.learning_flag) learn(frame, v);
      }
    }
    if (f_ > 0 && gof_.learning_flag) end_errors();
    decoded[f_] = values_;
    ++place_;
  }

  // RoundFrame( f )
  std::vector<std::int32_t> positions(std::uint32_t f) const {
    std::vector<std::int32_t> rounded;
    for (const std::int64_t x : decoded[f]) {
      rounded.push_back(clip_signed(position_bits_, round2(x, 4)));
    }
    return rounded;
  }

  std::uint32_t frame() const { return f_; }

 private:
  const OrderedMesh& mesh_;
  const InterGof& gof_;
  int position_bits_;
  FrameOrder order_;

 public:
  std::vector<List> decoded;     // DecodedFrames
  std::vector<Vertex> vertices;  // of the last frame
  List reference;                // of the last frame

 private:
  struct Learned {
    List plain_before;      // PlainErrorBefore
    List plain_two_before;  // PlainErrorTwoBefore
    List error;             // ValueError
    List before;            // ValueErrorBefore
    List older;             // OlderError
    std::vector<FilterOfText> filters;
  };

  std::size_t size() const { return 3 * std::size_t{mesh_.num_vertices()}; }
  static std::size_t at(std::uint32_t v, std::size_t c) { return 3 * std::size_t{v} + c; }
  std::uint32_t temporal_layer() const {
    const std::int64_t deeper =
        std::int64_t{gof_.pattern.num_depths()} - gof_.pattern.temporal_layers;
    return static_cast<std::uint32_t>(std::max<std::int64_t>(0, order_[place_].depth - deeper));
  }

  void decode_positions_in_order(const InterFrame& frame) {
    std::vector<std::int32_t> residuals(size(), 0);
    for (std::size_t i = 0; i < frame.residual.size(); ++i) residuals[i] = frame.residual[i];
    const RestRecon recon(mesh_.rest_order(), gof_.rest, gof_.first_step, position_bits_);
    const auto rest = recon_rest(recon, mesh_.rest_order(), residuals, frame.counterparts);
    values_.assign(rest.begin(), rest.end());
  }

  // FindNearVertices( v )
  std::vector<std::uint32_t> near_vertices_of(std::uint32_t v) const {
    const auto ring = mesh_.ring(v);
    std::vector<std::pair<std::int64_t, std::uint32_t>> near;  // distance, vertex
    const auto add = [&](std::uint32_t u) {
      if (std::find(ring.begin(), ring.end(), u) != ring.end()) return;
      std::int64_t distance = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::int64_t difference = decoded[0][at(u, c)] - decoded[0][at(v, c)];
        distance += difference * difference;
      }
      const std::pair own(distance, u);
      if (std::find(near.begin(), near.end(), own) == near.end()) near.push_back(own);
    };
    for (const std::uint32_t u : mesh_.outer_ring(v)) add(u);
    for (const std::uint32_t r : ring) {
      for (const std::uint32_t u : mesh_.ring(r)) add(u);
      for (const std::uint32_t u : mesh_.outer_ring(r)) add(u);
    }
    std::vector<std::uint32_t> base;
    for (const std::uint32_t u : mesh_.order()) {
      if (mesh_.layer_of(u) == 0) base.push_back(u);
    }
    std::int64_t first = 0;
    const auto before = std::count_if(base.begin(), base.end(), [&](auto u) { return u < v; });
    std::int64_t end = before;
    if (mesh_.layer_of(v) == 0) {
      first = std::max<std::int64_t>(0, before - 256);
    } else {
      const auto count = static_cast<std::int64_t>(base.size());
      first = std::max<std::int64_t>(0, std::min<std::int64_t>(before - 128, count - 256));
      end = near.size() > 3 ? first : std::min<std::int64_t>(first + 256, count);
    }
    for (std::int64_t i = first; i < end; ++i) add(base[static_cast<std::size_t>(i)]);
    std::sort(near.begin(), near.end());
    std::vector<std::uint32_t> nearest;
    for (std::size_t i = 0; i < near.size() && i < 12; ++i) nearest.push_back(near[i].second);
    return nearest;
  }

  void start_motion() {
    VertexLists lists(mesh_.num_vertices());
    std::array<std::vector<std::int32_t>, 3> rest;
    for (std::uint32_t v = 0; v < mesh_.num_vertices(); ++v) {
      near_.push_back(near_vertices_of(v));
      lists.set(v, near_.back());
      for (std::size_t c = 0; c < 3; ++c) {
        rest[c].push_back(static_cast<std::int32_t>(decoded[0][at(v, c)]));
      }
    }
    const std::array<std::span<const std::int32_t>, 3> planes{rest[0], rest[1], rest[2]};
    weights_.emplace(mesh_, gof_.weights, planes, &lists);
    patches_.num_patches = gof_.num_patches;
    patches_.patch_of_vertex = gof_.patch_of_vertex;
    patches_.position_bits = position_bits_;
    if (gof_.num_patches > 0) {
      patches_.start(mesh_.vertices_of_layers(0, gof_.layer_group_size[0]), decoded[0],
                     gof_.pattern.num_depths());
    }
    if (gof_.learning_flag) start_learning();
  }

  void start_learning() {
    plain_error_.assign(size(), 0);
    for (std::uint32_t t = 0; t < gof_.pattern.temporal_layers; ++t) {
      Learned& learned = learned_.emplace_back();
      learned.plain_before = learned.plain_two_before = learned.error = learned.before =
          learned.older = List(size(), 0);
      for (std::uint32_t v = 0; v < mesh_.num_vertices(); ++v) {
        FilterOfText& filter = learned.filters.emplace_back();
        filter.is_of_frames = true;
        filter.ring = mesh_.ring(v).size();
        filter.neighbours = filter.ring + near_[v].size();
        for (const std::int64_t w : (*weights_)[v]) {
          filter.weight.push_back(
              clip3(-FilterOfText::kMaxWeight, FilterOfText::kMaxWeight, 4 * w));
        }
        filter.weight.resize(filter.neighbours + 5, 0);
        filter.start_spread_of_frames();
        if (gof_.prime_log2 > 0 && filter.ring > 1) prime(filter, v);
      }
    }
  }

  void prime(FilterOfText& filter, std::uint32_t v) const {
    std::array<List, 3> offsets;
    Vec3l own{};
    std::int64_t largest = 1;
    for (std::size_t c = 0; c < 3; ++c) {
      std::int64_t sum = 0;
      for (const std::uint32_t u : mesh_.ring(v)) sum += decoded[0][at(u, c)];
      const std::int64_t mean = div_round(sum, static_cast<std::int64_t>(filter.ring));
      own[c] = decoded[0][at(v, c)] - mean;
      for (const std::uint32_t u : mesh_.ring(v))
        offsets[c].push_back(decoded[0][at(u, c)] - mean);
      for (const std::uint32_t u : near_[v]) offsets[c].push_back(decoded[0][at(u, c)] - mean);
      largest = std::max({largest, std::abs(own[c]), FilterOfText::max_magnitude(offsets[c])});
    }
    const int shift = floor_log2(static_cast<std::uint64_t>(largest)) - 9;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::int64_t& x : offsets[c]) x = shift_by(x, shift);
      offsets[c].resize(filter.neighbours + 5, 0);
      const std::int64_t error = shift_by(own[c], shift) - filter.predict_offset(offsets[c]);
      filter.adapt(offsets[c], error, std::int64_t{1} << (16 + gof_.prime_log2));
    }
  }

  void make_reference(const InterFrame& frame) {
    std::int64_t a = order_[place_].first;
    std::int64_t b = order_[place_].second;
    if (frame.reference) a = b = *frame.reference;
    const List& values_a = decoded[static_cast<std::size_t>(a)];
    const List& values_b = decoded[static_cast<std::size_t>(b)];
    for (std::size_t i = 0; i < size(); ++i) {
      reference[i] = values_a[i];
      if (a == b) continue;
      reference[i] = div_round((b - f_) * values_a[i] + (f_ - a) * values_b[i], b - a);
    }
  }

  std::int64_t mean_in_frame(std::uint32_t v, std::size_t c, bool moving) const {
    const auto ring = mesh_.ring(v);
    std::int64_t sum = 0;
    for (const std::uint32_t u : ring) {
      sum += values_[at(u, c)] - (moving ? reference[at(u, c)] : 0);
    }
    return ring.empty() ? 0 : div_round(sum, static_cast<std::int64_t>(ring.size()));
  }
  std::int64_t motion_of(std::uint32_t v, std::size_t c) const {
    return values_[at(v, c)] - reference[at(v, c)];
  }

  void predict_motion(std::uint32_t layer, std::uint32_t v, std::size_t c) {
    Vertex& vertex = vertices[v];
    const std::int64_t mean = mean_in_frame(v, c, true);
    List offsets;
    for (const std::uint32_t u : mesh_.ring(v)) offsets.push_back(motion_of(u, c) - mean);
    for (const std::uint32_t u : near_[v]) offsets.push_back(motion_of(u, c) - mean);
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i) sum += (*weights_)[v][i] * offsets[i];
    vertex.plain[c] = clip3(-(1 << 29), 1 << 29, mean + round2(sum, 14));
    std::int64_t motion = vertex.plain[c];
    if (gof_.learning_flag) {
      add_earlier_errors(learned_[layer], v, c, offsets);
      motion = mean + learned_[layer].filters[v].predict_offset(offsets);
    }
    vertex.mean[c] = mean;
    vertex.offsets[c] = offsets;
    vertex.predicted[c] = clip_signed(position_bits_ + 5, reference[at(v, c)] + motion);
  }

  void add_earlier_errors(const Learned& learned, std::uint32_t v, std::size_t c,
                          List& offsets) const {
    const auto ring = mesh_.ring(v);
    std::int64_t sum = 0;
    for (const std::uint32_t u : ring) sum += plain_error_[at(u, c)];
    const std::int64_t mean =
        ring.empty() ? 0 : div_round(sum, static_cast<std::int64_t>(ring.size()));
    for (const std::int64_t error :
         {learned.plain_before[at(v, c)], learned.plain_two_before[at(v, c)], mean,
          learned.before[at(v, c)], learned.older[at(v, c)]}) {
      offsets.push_back(is_present_ ? error : 0);
    }
  }

  void decode_vertex(const InterFrame& frame, std::uint32_t v) {
    const std::int64_t step = frame_step(v);
    for (std::size_t c = 0; c < 3; ++c) {
      if (f_ == 0) {
        vertices[v].predicted[c] = mean_in_frame(v, c, false);
      } else {
        predict_motion(temporal_layer(), v, c);
      }
      std::int64_t start = vertices[v].predicted[c];
      const bool follows = f_ > 0 && gof_.num_patches > 0 &&
                           patches_.mode_of_vertex(v) != PatchMode::kNeighbours;
      if (follows) start = patches_.moved(v, c);
      if (gof_.exact_flag) start = round2(start, 4) * 16;
      const std::int64_t residual =
          is_present_ && !frame.repeated ? std::int64_t{frame.residual[at(v, c)]} : 0;
      const std::int64_t difference = round2(residual * step, 4);
      values_[at(v, c)] = clip_signed(position_bits_ + 5, start + difference);
      if (frame.repeated) values_[at(v, c)] = decoded[*frame.repeated][at(v, c)];
    }
  }
  std::uint32_t step_of_frame() const {
    if (f_ == 0) return gof_.first_step;
    const std::int64_t step = gof_.step[order_[place_].depth];
    const std::int64_t changed = (step * (16 + (*gof_.frames)[f_].step_delta)) >> 4;
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(changed, 1, 65536));
  }
  std::int64_t frame_step(std::uint32_t v) const {
    return std::int64_t{step_of_frame()} * gof_.layer_step[mesh_.layer_of(v)];
  }

  void learn(const InterFrame& frame, std::uint32_t v) {
    const Vertex own = vertices[v];
    for (std::uint32_t t = temporal_layer(); t < gof_.pattern.temporal_layers; ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (t > temporal_layer()) predict_motion(t, v, c);
      }
      Learned& learned = learned_[t];
      for (std::size_t c = 0; c < 3; ++c) {
        plain_error_[at(v, c)] = is_present_ ? motion_of(v, c) - vertices[v].plain[c] : 0;
        learned.error[at(v, c)] =
            is_present_ ? values_[at(v, c)] - vertices[v].predicted[c] : 0;
      }
      if (!is_present_) continue;
      const std::int64_t noise = frame.repeated ? 0 : frame.expected[v];
      const std::int64_t variance = frame_step(v) * frame_step(v) * (128 + noise * noise);
      FilterOfText& filter = learned.filters[v];
      for (std::size_t c = 0; c < 3; ++c) {
        const List& offsets = vertices[v].offsets[c];
        const std::int64_t error =
            motion_of(v, c) - vertices[v].mean[c] - filter.predict_offset(offsets);
        filter.adapt(offsets, error, variance);
      }
    }
    vertices[v] = own;
  }

  void end_errors() {
    for (std::uint32_t t = temporal_layer(); t < gof_.pattern.temporal_layers; ++t) {
      Learned& learned = learned_[t];
      for (std::size_t i = 0; i < size(); ++i) {
        learned.older[i] =
            clip3(-(1 << 30), 1 << 30, round2(3 * (learned.older[i] + learned.before[i]), 2));
      }
      learned.plain_two_before = learned.plain_before;
      learned.plain_before = plain_error_;
      learned.before = learned.error;
      learned.error.assign(size(), 0);
    }
    plain_error_.assign(size(), 0);
  }

  std::uint32_t place_ = 0;
  std::uint32_t f_ = 0;
  bool is_present_ = false;
  List values_;  // FrameValues
  std::vector<std::vector<std::uint32_t>> near_;
  std::optional<GeometryWeights> weights_;
  PatchesOfText patches_;
  List plain_error_;
  std::vector<Learned> learned_;  // [temporal layer]
};

}  // namespace rlpc
