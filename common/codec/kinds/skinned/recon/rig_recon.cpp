#include "common/codec/kinds/skinned/recon/rig_recon.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/skinned/influences.h"
#include "common/codec/mesh_prediction/rest_recon.h"
#include "common/memory/owned.h"
#include "common/parallel/for_each.h"

namespace rlpc {
namespace {

constexpr std::size_t kPadding = 3;  // kernels may read one vector past the end

// Reconstructs the values of the factors of a group.
struct ValueRecon {
  const SharedRig& rig;
  std::span<const int> bits;  // [factor]
  std::span<const std::int32_t> residuals;
  const ValuePrediction& prediction;
  AdaptiveWeights* weights;
  bool is_rest;
  std::span<std::int32_t> values;  // [num_vertices][factor]

  // Processes consecutive vertices in the order or, within a layer above the base, any
  // vertices.
  void vertices(const OrderedMesh& mesh, std::span<const std::uint32_t> list) const {
    Vector<std::int64_t> predicted(bits.size());
    std::optional<VertexAdaptation> adaptation;
    if (weights != nullptr) adaptation.emplace(*weights);
    for (const std::uint32_t v : list) {
      const int layer_step = rig.layer_step[mesh.layer_of(v)];
      if (adaptation && adaptation->start(v, values)) {
        adaptive_values(v, layer_step, *adaptation);
      } else {
        prediction.predict(v, values, predicted);
        predicted_values(v, layer_step, predicted);
      }
    }
  }

 private:
  void adaptive_values(std::uint32_t v, int layer_step, VertexAdaptation& adaptation) const {
    const std::size_t n = bits.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::int64_t predicted_value = adaptation.predict();
      values[v * n + k] = clip_signed(
          bits[k], predicted_value + factor_difference(residuals[v * n + k], layer_step));
      adaptation.add(predicted_value, values[v * n + k]);
    }
    adaptation.finish();
  }
  void predicted_values(std::uint32_t v, int layer_step,
                        std::span<const std::int64_t> predicted) const {
    const std::size_t n = bits.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::int32_t residual = residuals[v * n + k];
      const std::int64_t difference = is_rest ? rest_difference(rig, residual, layer_step)
                                              : factor_difference(residual, layer_step);
      values[v * n + k] = clip_signed(bits[k], predicted[k] + difference);
    }
  }
};

}  // namespace

// 8.10.2 Spatial values
Vector<std::int32_t> recon_values(const OrderedMesh& mesh, const SharedRig& rig,
                                  std::size_t group, int position_bits,
                                  const ValuePrediction& prediction, AdaptiveWeights* weights) {
  const FactorGroup factors = factor_group(rig, group);
  const Vector<std::int32_t>& residuals = rig.vertex_residual[group];
  Vector<int> bits(factors.size(), rest_bits(position_bits));
  for (std::size_t k = 0; k < bits.size() && group > 0; ++k) {
    bits[k] = rig.trajectories[factors.first + k - kRestFactors].spatial_bits;
  }
  Vector<std::int32_t> values(residuals.size());
  if (weights != nullptr) weights->start(factors.first - kRestFactors, bits.size());
  ValueRecon recon{rig, bits, residuals, prediction, weights, group == 0, values};
  // Vertices of the base, or of a mesh without layers, depend on each other.
  recon.vertices(mesh, mesh.vertices_of_layers(0, 1));
  constexpr std::size_t kTogether = 16;  // vertices of a pass
  for (std::uint32_t layer = 1; layer < mesh.num_layers(); ++layer) {
    const std::span<const std::uint32_t> list = mesh.vertices_of_layers(layer, layer + 1);
    for_ranges(list.size(), kTogether, [&](std::size_t first, std::size_t end) {
      recon.vertices(mesh, list.subspan(first, end - first));
    });
  }
  return values;
}

Vector<Influences> complete_influences(const OrderedMesh& mesh, const SharedRig& rig) {
  Vector<Influences> influences = rig.influences;
  InfluencePrediction prediction(influences, static_cast<std::uint32_t>(rig.bones.size()),
                                 rig.weight_bits);
  std::uint32_t first = 0;
  for (std::uint32_t j = 0; j < rig.slice_layers[0]; ++j) first += rig.layer_group_size[j];
  for (const std::uint32_t v : mesh.vertices_of_layers(first, mesh.num_layers())) {
    prediction.start(mesh.ring(v));
    for (std::size_t k = 1; k < prediction.num_candidates(); ++k)
      prediction.add_candidate(k, 0);
    influences[v] = prediction.finish();
  }
  return influences;
}

RigRecon::RigRecon(const OrderedMesh& mesh, const SharedRig& rig, int position_bits,
                   bool has_more_groups)
    : mesh_(mesh), position_bits_(position_bits) {
  const Vector<std::int32_t> rest = recon_rest(rig);
  add_influences(rig, rest);
  if (has_more_groups || !rig.trajectories.empty()) start_weights(rig, rest);
  factors_ = recon_factors(rig, adaptive_ ? &*adaptive_ : nullptr);
  if (has_more_groups) return;
  weights_.reset();
  adaptive_.reset();
  rest_ = {};
}

RigRecon::RigRecon(const OrderedMesh& mesh, const SharedRig& rig, int position_bits,
                   std::span<const std::int32_t> values)
    : mesh_(mesh), position_bits_(position_bits) {
  add_influences(rig, recon_rest(rig));
  auto factors = make_shared_owned<SpatialFactors>(num_vertices());
  const std::size_t count = rig.trajectories.size();
  for (std::size_t l = 0; l < count; ++l) {
    factors->add(values.subspan(l), rig.trajectories[l].spatial_bits, count);
  }
  factors_ = std::move(factors);
}

Vector<std::int32_t> RigRecon::recon_rest(const SharedRig& rig) const {
  if (!rig.rest.order_flag) {
    return recon_values(mesh_, rig, 0, position_bits_, {mesh_, true, nullptr});
  }
  const RestOrder& order = mesh_.rest_order();
  const RestRecon recon(order, rig.rest, rig.rest_step, position_bits_);
  return rlpc::recon_rest(recon, order, rig.vertex_residual[0], rig.counterparts);
}

void RigRecon::add_influences(const SharedRig& rig, std::span<const std::int32_t> rest) {
  const Vector<Influences> influences = complete_influences(mesh_, rig);
  // Exact, except for runs, which are usually fewer.
  const std::size_t count =
      std::accumulate(influences.begin(), influences.end(), std::size_t{0},
                      [](std::size_t sum, const Influences& list) { return sum + list.size; });
  for (auto& list : arm_) list.reserve(count + kPadding);
  weight_.reserve(count + kPadding);
  place_.reserve(count);
  runs_.reserve(count);
  struct Entry {
    Influence influence;
    std::size_t vertex;
  };
  Vector<Entry> tile_entries;
  for (std::size_t first = 0; first < num_vertices(); first += kTileValues) {
    tile_entries.clear();
    for (std::size_t v = first; v < std::min(first + kTileValues, num_vertices()); ++v) {
      for (const Influence& influence : influences[v]) tile_entries.push_back({influence, v});
    }
    std::sort(tile_entries.begin(), tile_entries.end(), [](const Entry& a, const Entry& b) {
      return std::tie(a.influence.bone, a.vertex) < std::tie(b.influence.bone, b.vertex);
    });
    first_run_.push_back(runs_.size());
    for (const auto& [influence, v] : tile_entries) {
      const auto next = static_cast<std::uint32_t>(weight_.size());
      if (first_run_.back() == runs_.size() || runs_.back().bone != influence.bone) {
        runs_.push_back({influence.bone, next, next});
      }
      ++runs_.back().end;
      const Vec3i& pivot = rig.bones[influence.bone].pivot;
      for (std::size_t c = 0; c < 3; ++c) {
        arm_[c].push_back(rest[3 * v + c] - pivot[c]);
      }
      weight_.push_back(influence.weight);
      place_.push_back(static_cast<std::uint8_t>(v - first));
    }
  }
  first_run_.push_back(runs_.size());
  for (auto& list : arm_) list.resize(count + kPadding);
  weight_.resize(count + kPadding);
}

void RigRecon::start_weights(const SharedRig& rig, std::span<const std::int32_t> rest) {
  if (rig.prediction != Prediction::kLayers) return;
  for (auto& plane : rest_) plane.reserve(num_vertices());
  for (std::size_t i = 0; i < rest.size(); ++i) rest_[i % 3].push_back(rest[i]);
  const std::array<std::span<const std::int32_t>, 3> planes{rest_[0], rest_[1], rest_[2]};
  weights_.emplace(mesh_, rig.weights, planes);
  if (rig.weights.num_adaptive_factors > 0) {
    adaptive_.emplace(mesh_, *weights_, rig.weights, planes);
  }
}

// Reconstructs the factors of the component groups from 1 on.
std::shared_ptr<const SpatialFactors> RigRecon::recon_factors(const SharedRig& rig,
                                                              AdaptiveWeights* adaptive) const {
  auto factors = make_shared_owned<SpatialFactors>(num_vertices());
  const ValuePrediction prediction(mesh_, false, weights_ ? &*weights_ : nullptr);
  for (std::size_t group = 1; group < rig.group_end.size(); ++group) {
    const FactorGroup group_factors = factor_group(rig, group);
    const auto values = recon_values(mesh_, rig, group, position_bits_, prediction, adaptive);
    for (std::size_t k = 0; k < group_factors.size(); ++k) {
      factors->add(std::span(values).subspan(k),
                   rig.trajectories[group_factors.first + k - kRestFactors].spatial_bits,
                   group_factors.size());
    }
  }
  return factors;
}

// 8.16.2 Skinned GOF with a shared rig: adaptive weights continue from those of the shared rig.
std::shared_ptr<const SpatialFactors> RigRecon::local_factors(const SkinnedGof& gof) const {
  std::optional<AdaptiveWeights> adaptive = adaptive_;
  return recon_factors(gof, adaptive ? &*adaptive : nullptr);
}

RigRecon::Run RigRecon::run(std::size_t tile, std::size_t i) const {
  const RunRange& range = runs_[first_run_[tile] + i];
  const std::size_t size = range.end - range.first;
  return {range.bone,
          {{&arm_[0][range.first], &arm_[1][range.first], &arm_[2][range.first]},
           &weight_[range.first],
           size},
          std::span(place_).subspan(range.first, size)};
}

}  // namespace rlpc
