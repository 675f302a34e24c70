#include "common/codec/kinds/inter/recon/inter_recon.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <utility>

#include "common/codec/bits/fixed_point.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/mesh_prediction/rest_recon.h"
#include "common/memory/owned.h"
#include "common/parallel/for_each.h"

namespace rlpc {
namespace {

// Vertices of a pass: they take some 20 us, much longer than distributing passes.
constexpr std::size_t kLearnTogether = 32;
constexpr std::size_t kTogether = 128;

constexpr std::int32_t kRingWalk = 64;
constexpr std::int32_t kNearWalk = 16;
constexpr std::int32_t kErrorWalk = 128;
// Shift of the first spread: a filter learns faster with a larger one. 19 takes 1 % more bytes
// where frames are predicted from the previous one, 3.5 % with dyadic patterns, up to 7 % with
// five temporal layers.
constexpr int kFirstSpreadShift = 21;
constexpr std::int64_t kMaxMotion = std::int64_t{1} << 29;
constexpr std::int64_t kMaxOlderError = std::int64_t{1} << 30;

// MotionWalk( v, i ) by the sizes of ring and near vertices.
using Walks =
    std::array<std::array<std::array<std::int32_t, kMaxMotions>, kMaxNear + 1>, kMaxRing + 1>;
Walks make_walks() {
  Walks walks{};
  for (std::size_t n = 0; n <= kMaxRing; ++n) {
    for (std::size_t m = 0; m <= kMaxNear; ++m) {
      for (std::size_t i = 0; i < n + m + kNumEarlierErrors; ++i) {
        walks[n][m][i] = i < n ? kRingWalk : i < n + m ? kNearWalk : kErrorWalk;
      }
    }
  }
  return walks;
}
// Returns the walks, made when they are first needed: a constant takes 10 kB.
const Walks& all_walks() {
  static const Walks kWalks = make_walks();
  return kWalks;
}

template <std::int64_t kCount>
std::int64_t mean_of(std::int64_t sum) {
  return div_round(sum, kCount);
}
// DivRound( sum, n ), n <= kMaxRing, without a division; 0 if n is 0.
std::int64_t mean_of(std::int64_t sum, std::size_t n) {
  switch (n) {
    case 0:
      return 0;
    case 1:
      return sum;
    case 2:
      return mean_of<2>(sum);
    case 3:
      return mean_of<3>(sum);
    case 4:
      return mean_of<4>(sum);
    case 5:
      return mean_of<5>(sum);
    case 6:
      return mean_of<6>(sum);
    default:
      return mean_of<7>(sum);
  }
}

constexpr std::size_t padded(std::size_t size) {
  return (size + kFilterVector - 1) / kFilterVector * kFilterVector;
}

}  // namespace

InterRecon::InterRecon(const OrderedMesh& mesh, const InterSettings& settings,
                       int position_bits)
    : mesh_(mesh),
      settings_(settings),
      kernels_(kernels().back()),
      bits_{position_bits + kPointFractionBits + 1, position_bits} {
  const std::size_t size = 3 * std::size_t{mesh.num_vertices()};
  frame_.values.resize(size);
  frame_.reference.resize(size);
  frame_.motion.resize(size);
}

// 8.19.1 DecodeFrame( f )
void InterRecon::decode(const FramePlace& place, std::uint32_t last_use,
                        const InterFrame& frame) {
  start_frame(frame.reference ? place.from(*frame.reference) : place, last_use,
              frame.step_delta);
  if (now_.number == 0 && settings_.rest.order_flag) {
    decode_positions_in_order(frame);
    return end_frame();
  }
  if (patches_) move_patches(frame.patches);
  const Vector<std::int32_t>* const repeated =
      frame.repeated ? &kept_.at(*frame.repeated).values : nullptr;
  std::uint32_t layer = 0;
  for (std::size_t j = 0; j < settings_.layer_group_size.size(); ++j) {
    const bool is_there = j < frame.layer_groups;
    for (const std::uint32_t end = layer + settings_.layer_group_size[j]; layer < end;
         ++layer) {
      const auto vertices = mesh_.vertices_of_layers(layer, layer + 1);
      const auto decode_range = [&](std::size_t first, std::size_t last) {
        VertexMotion motion;
        for (std::size_t i = first; i < last; ++i) {
          const std::uint32_t v = vertices[i];
          const std::size_t own = 3 * std::size_t{v};
          const bool is_predicted = repeated == nullptr && !follows_patch(v);
          if (is_predicted || settings_.learning_flag) predict(v, motion, is_there);
          Vec3i values{};
          if (repeated != nullptr) {
            values = {(*repeated)[own], (*repeated)[own + 1], (*repeated)[own + 2]};
          } else {
            Vec3i residual{};
            if (is_there) {
              residual = {frame.residual[own], frame.residual[own + 1],
                          frame.residual[own + 2]};
            }
            values = position(v, motion, residual);
          }
          set(v, motion, values, is_there);
          const bool has_noise = is_there && repeated == nullptr;
          adapt(v, motion, is_there, has_noise ? frame.expected[v] : 0U);
        }
      };
      const std::size_t together = settings_.learning_flag ? kLearnTogether : kTogether;
      if (layer == 0 || vertices.size() <= together) {
        decode_range(0, vertices.size());
      } else {
        for_ranges(vertices.size(), together, decode_range);
      }
    }
  }
  end_frame();
}

// 8.19.1 DecodePositionsInOrder( )
void InterRecon::decode_positions_in_order(const InterFrame& frame) {
  Vector<std::int32_t> residuals(frame_.values.size());
  for (std::size_t i = 0; i < frame.residual.size(); ++i) residuals[i] = frame.residual[i];
  const RestOrder& order = mesh_.rest_order();
  const RestRecon recon(order, settings_.rest, settings_.first_step, bits_.position);
  set_positions(recon_rest(recon, order, residuals, frame.counterparts));
}

void InterRecon::set_positions(std::span<const std::int32_t> positions) {
  frame_.values.assign(positions.begin(), positions.end());
}

void InterRecon::positions(std::span<std::int32_t> positions) const {
  for (std::size_t i = 0; i < frame_.values.size(); ++i) {
    positions[i] = clip_signed(bits_.position, round2(frame_.values[i], kPointFractionBits));
  }
}

void InterRecon::skip_to(std::uint32_t place) { now_.number = place; }

void InterRecon::start_frame(const FramePlace& place, std::uint32_t last_use,
                             std::int32_t step_delta) {
  if (now_.number > 0 && !weights_) start_motion();  // the last frame is still the first
  now_.place = place;
  now_.last_use = last_use;
  now_.step = now_.number == 0 ? settings_.first_step
                               : changed_step(settings_.step[place.depth], step_delta);
  now_.temporal_layer = settings_.pattern.temporal_layer(place.depth);
  if (now_.number > 0) make_reference();
}

void InterRecon::move_patches(const FramePatches& patches) {
  patches_->start_frame(frame_.reference, now_.place.depth, now_.step, patches);
}

// 8.19.3 MakeReference( f )
void InterRecon::make_reference() {
  const Vector<std::int32_t>& a = kept_.at(now_.place.first).values;
  if (now_.place.first == now_.place.second) {
    frame_.reference = a;
    return;
  }
  const Vector<std::int32_t>& b = kept_.at(now_.place.second).values;
  const std::int64_t weight_a = now_.place.second - now_.place.frame;
  const std::int64_t weight_b = now_.place.frame - now_.place.first;
  for (std::size_t i = 0; i < frame_.reference.size(); ++i) {
    frame_.reference[i] = static_cast<std::int32_t>(
        div_round(weight_a * a[i] + weight_b * b[i], weight_a + weight_b));
  }
}

// 8.19.2 StartMotion( )
void InterRecon::start_motion() {
  near_ = near_vertices(mesh_, frame_.values);
  std::array<Vector<std::int32_t>, 3> rest;
  for (std::size_t c = 0; c < 3; ++c) {
    rest[c].resize(mesh_.num_vertices());
    for (std::size_t v = 0; v < rest[c].size(); ++v) rest[c][v] = frame_.values[3 * v + c];
  }
  weights_.emplace(mesh_, settings_.weights,
                   std::array<std::span<const std::int32_t>, 3>{rest[0], rest[1], rest[2]},
                   &near_);
  if (settings_.learning_flag) start_learning();
  if (settings_.num_patches > 0) {
    patches_.emplace(settings_.num_patches, settings_.patch_of_vertex,
                     mesh_.vertices_of_layers(0, settings_.layer_group_size[0]), frame_.values,
                     settings_.pattern.num_depths(), bits_.value);
  }
}

// 8.19.4 StartLearning( )
void InterRecon::start_learning() {
  const std::uint32_t num_vertices = mesh_.num_vertices();
  frame_.plain_error.assign(frame_.values.size(), 0);
  first_.resize(num_vertices);
  std::size_t size = 0;
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    first_[v] = size;
    const std::size_t n = num_neighbours(v) + kNumEarlierErrors;
    size += padded(n) * (n + 1);
  }
  Learned learned;
  for (auto* const errors : {&learned.plain_error1, &learned.plain_error2, &learned.error,
                             &learned.error1, &learned.older_error}) {
    errors->assign(frame_.values.size(), 0);
  }
  learned.filters.assign(size, 0);
  const std::int64_t variance = std::int64_t{1}
                                << (kVarianceFractionBits + settings_.prime_log2);
  for_ranges(num_vertices, kLearnTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const auto v = static_cast<std::uint32_t>(i);
      const FilterState state = filter(learned, v);
      constexpr std::int64_t kFiner = 1 << (kAdaptiveFractionBits - kWeightFractionBits);
      const auto weights = (*weights_)[v];
      for (std::size_t k = 0; k < weights.size(); ++k) {
        state.weight[k] = static_cast<std::int32_t>(
            clip3(-kMaxAdaptiveWeight, kMaxAdaptiveWeight, weights[k] * kFiner));
      }
      for (std::size_t k = 0; k < state.size; ++k) {
        state.spread[k * state.stride + k] =
            std::min(kFrameFilter.max_spread, state.walk[k] << kFirstSpreadShift);
      }
      if (settings_.prime_log2 > 0 && mesh_.ring(v).size() > 1) prime(learned, v, variance);
    }
  });
  learned_.clear();
  learned_.reserve(settings_.pattern.temporal_layers);
  learned_.push_back(std::move(learned));
  while (learned_.size() < settings_.pattern.temporal_layers) {
    learned_.push_back(learned_.front());
  }
}

FilterState InterRecon::filter(const Learned& learned, std::uint32_t v) const {
  FilterState state;
  state.size = num_neighbours(v) + kNumEarlierErrors;
  state.stride = padded(state.size);
  state.weight = &learned.filters[first_[v]];
  state.spread = state.weight + state.stride;
  state.walk = all_walks()[mesh_.ring(v).size()][near_[v].size()].data();
  return state;
}

// 8.19.4 PrimeFilter( v )
void InterRecon::prime(Learned& learned, std::uint32_t v, std::int64_t variance) {
  const auto ring = mesh_.ring(v);
  const auto near = near_[v];
  const FilterState state = filter(learned, v);
  std::array<std::array<std::int64_t, kMaxMotions>, 3> offsets{};
  Vec3l own{};
  std::int64_t largest = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto at = [&](std::uint32_t u) -> std::int64_t {
      return frame_.values[3 * std::size_t{u} + c];
    };
    std::int64_t sum = 0;
    for (const std::uint32_t u : ring) sum += at(u);
    const std::int64_t mean = mean_of(sum, ring.size());
    std::size_t i = 0;
    for (const std::uint32_t u : ring) offsets[c][i++] = at(u) - mean;
    for (const std::uint32_t u : near) offsets[c][i++] = at(u) - mean;
    own[c] = at(v) - mean;
    largest = std::max(largest, std::abs(own[c]));
    for (const std::int64_t x : offsets[c]) largest = std::max(largest, std::abs(x));
  }
  const int shift = floor_log2(static_cast<std::uint64_t>(largest)) - kOffsetLog2;
  for (std::size_t c = 0; c < 3; ++c) {
    alignas(32) std::array<std::int32_t, kMaxMotions> shifted{};
    for (std::size_t i = 0; i < shifted.size(); ++i) {
      shifted[i] = static_cast<std::int32_t>(shift_by(offsets[c][i], shift));
    }
    const std::int64_t error =
        shift_by(own[c], shift) - kernels_.predict_offset(state, shifted.data());
    kernels_.adapt_to_frame(state, shifted.data(), error, variance);
  }
}

// 8.19.3 PredictMotion( v, c ), and in the first frame MeanInFrame( v, c, 0 )
void InterRecon::predict(std::uint32_t v, VertexMotion& motion, bool is_there) const {
  const auto ring = mesh_.ring(v);
  const std::size_t own = 3 * std::size_t{v};
  if (now_.number == 0) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::int64_t sum = 0;
      for (const std::uint32_t u : ring) sum += frame_.values[3 * std::size_t{u} + c];
      motion.prediction[c] = static_cast<std::int32_t>(mean_of(sum, ring.size()));
    }
    return;
  }
  gather_motion(v, motion);
  const auto weights = (*weights_)[v];
  for (std::size_t c = 0; c < 3; ++c) {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      sum += std::int64_t{weights[i]} * motion.offsets[c][i];
    }
    motion.plain[c] =
        clip3(-kMaxMotion, kMaxMotion, motion.mean[c] + round2(sum, kWeightFractionBits));
  }
  if (settings_.learning_flag)
    return predict(learned_[now_.temporal_layer], v, motion, is_there);
  for (std::size_t c = 0; c < 3; ++c) {
    motion.prediction[c] =
        clip_signed(bits_.value, frame_.reference[own + c] + motion.plain[c]);
  }
}

void InterRecon::predict(const Learned& learned, std::uint32_t v, VertexMotion& motion,
                         bool is_there) const {
  gather_errors(learned, v, motion, is_there);
  const FilterState state = filter(learned, v);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t moved =
        motion.mean[c] + kernels_.predict_offset(state, motion.offsets[c].data());
    motion.prediction[c] =
        clip_signed(bits_.value, frame_.reference[3 * std::size_t{v} + c] + moved);
  }
}

void InterRecon::gather_motion(std::uint32_t v, VertexMotion& motion) const {
  const auto ring = mesh_.ring(v);
  const auto near = near_[v];
  const std::size_t n = ring.size() + near.size();
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int32_t* const motions = &frame_.motion[c];
    std::int32_t* const offsets = motion.offsets[c].data();
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      offsets[i] = motions[3 * std::size_t{ring[i]}];
      sum += offsets[i];
    }
    for (std::size_t i = 0; i < near.size(); ++i) {
      offsets[ring.size() + i] = motions[3 * std::size_t{near[i]}];
    }
    motion.mean[c] = mean_of(sum, ring.size());
    const auto mean = static_cast<std::int32_t>(motion.mean[c]);
    for (std::size_t i = 0; i < n; ++i) offsets[i] -= mean;
  }
}

// 8.19.4 AddEarlierErrors( layer, v, c, offsets )
void InterRecon::gather_errors(const Learned& learned, std::uint32_t v, VertexMotion& motion,
                               bool is_there) const {
  const auto ring = mesh_.ring(v);
  const std::size_t first = num_neighbours(v);
  const std::size_t end = padded(first + kNumEarlierErrors);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t own = 3 * std::size_t{v} + c;
    std::int32_t* offsets = &motion.offsets[c][first];
    if (!is_there) {
      std::fill(offsets, &motion.offsets[c][0] + end, 0);
      continue;
    }
    std::int64_t sum = 0;
    for (const std::uint32_t u : ring) sum += frame_.plain_error[3 * std::size_t{u} + c];
    offsets[0] = learned.plain_error1[own];
    offsets[1] = learned.plain_error2[own];
    offsets[2] = static_cast<std::int32_t>(mean_of(sum, ring.size()));
    offsets[3] = learned.error1[own];
    offsets[4] = learned.older_error[own];
    std::fill(offsets + kNumEarlierErrors, &motion.offsets[c][0] + end, 0);
  }
}

std::int32_t InterRecon::start_of(std::uint32_t v, const VertexMotion& motion,
                                  std::size_t c) const {
  const std::int32_t start = follows_patch(v) ? patches_->moved(v, c) : motion.prediction[c];
  if (!settings_.exact_flag) return start;
  return static_cast<std::int32_t>(to_grid(start));
}

// 8.19.3 DecodeVertex( f, v )
Vec3i InterRecon::position(std::uint32_t v, const VertexMotion& motion,
                           const Vec3i& residual) const {
  const std::int64_t vertex_step = step(v);
  Vec3i values{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t difference = round2(residual[c] * vertex_step, kPointFractionBits);
    values[c] = clip_signed(bits_.value, start_of(v, motion, c) + difference);
  }
  return values;
}

void InterRecon::set(std::uint32_t v, const VertexMotion& motion, const Vec3i& position,
                     bool is_there) {
  Vector<std::int32_t>* const errors = now_.number > 0 && settings_.learning_flag
                                           ? &learned_[now_.temporal_layer].error
                                           : nullptr;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t own = 3 * std::size_t{v} + c;
    frame_.values[own] = position[c];
    if (now_.number == 0) continue;
    frame_.motion[own] = position[c] - frame_.reference[own];
    if (errors == nullptr) continue;
    frame_.plain_error[own] =
        is_there ? static_cast<std::int32_t>(frame_.motion[own] - motion.plain[c]) : 0;
    (*errors)[own] = is_there ? position[c] - motion.prediction[c] : 0;
  }
}

// 8.19.4 Learn( f, v, present )
void InterRecon::adapt(std::uint32_t v, VertexMotion& motion, bool is_there,
                       std::uint32_t expected) {
  if (now_.number == 0 || !settings_.learning_flag) return;
  const std::int64_t vertex_step = step(v);
  const std::int64_t variance =
      vertex_step * vertex_step * (128 + std::int64_t{expected} * std::int64_t{expected});
  const std::uint32_t own = now_.temporal_layer;
  for (std::uint32_t t = own; t < settings_.pattern.temporal_layers; ++t) {
    Learned& learned = learned_[t];
    if (t > own) {
      predict(learned, v, motion, is_there);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t i = 3 * std::size_t{v} + c;
        learned.error[i] = is_there ? frame_.values[i] - motion.prediction[c] : 0;
      }
    }
    if (is_there) adapt(learned, v, motion, variance);
  }
}

// 8.19.4 LearnFromVertex( layer, f, v )
void InterRecon::adapt(Learned& learned, std::uint32_t v, const VertexMotion& motion,
                       std::int64_t variance) {
  const FilterState state = filter(learned, v);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int32_t* const offsets = motion.offsets[c].data();
    const std::int64_t error = frame_.motion[3 * std::size_t{v} + c] - motion.mean[c] -
                               kernels_.predict_offset(state, offsets);
    kernels_.adapt_to_frame(state, offsets, error, variance);
  }
}

void InterRecon::end_frame() {
  if (now_.number > 0 && settings_.learning_flag) end_errors();
  // Reuses the memory of frames that are no longer needed.
  Vector<std::int32_t> free;
  for (auto it = kept_.begin(); it != kept_.end();) {
    if (it->second.last_use > now_.number) {
      ++it;
      continue;
    }
    free = std::move(it->second.values);
    it = kept_.erase(it);
  }
  // Keeps this frame for one more in any case: the rest of a period that turns out to be
  // shorter may be predicted from it.
  free = frame_.values;
  const std::uint32_t last_repeat = now_.number + std::max(1U, settings_.max_earlier_distance);
  kept_[now_.place.frame] = {std::move(free), std::max(now_.last_use, last_repeat)};
  ++now_.number;
}

// 8.19.4 EndErrors( f )
void InterRecon::end_errors() {
  for (std::uint32_t t = now_.temporal_layer; t < settings_.pattern.temporal_layers; ++t) {
    Learned& learned = learned_[t];
    for (std::size_t i = 0; i < learned.older_error.size(); ++i) {
      const std::int64_t sum = std::int64_t{learned.older_error[i]} + learned.error1[i];
      learned.older_error[i] =
          static_cast<std::int32_t>(clip3(-kMaxOlderError, kMaxOlderError, round2(3 * sum, 2)));
    }
    learned.error1.swap(learned.error);
    learned.plain_error2.swap(learned.plain_error1);
    learned.plain_error1 = frame_.plain_error;
  }
}

}  // namespace rlpc
