#include "common/codec/kinds/skinned/recon/skinned_recon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/mesh_prediction/rest_recon.h"
#include "common/parallel/for_each.h"
#include "common/testing/filter_of_text.h"
#include "common/testing/random_skinned_gof.h"

namespace rlpc {
namespace {

using Plane = std::vector<std::int64_t>;  // [vertex] values of one factor

// 8.10 and 8.14 literally, factor by factor, without optimisation.
class TextRecon {
 public:
  explicit TextRecon(const RandomSkinnedGof& from)
      : from_(from),
        gof_(from.gof),
        mesh_(from.coded_mesh()),
        bones_(recon_bones(gof_.bones, gof_.num_frames, gof_.track_levels)) {
    if (gof_.rest.order_flag) take_rest();
    for (std::size_t l = factors.size(); l < kRestFactors + gof_.trajectories.size(); ++l) {
      if (l == kRestFactors && gof_.prediction == Prediction::kLayers) make_weights();
      if (gof_.weights.num_adaptive_factors > 0) start_factor(l);
      factors.push_back(reconstruct(l));
    }
  }

  std::vector<Plane> factors;

  std::int64_t position(std::uint32_t f, std::uint32_t v, std::size_t c) const {
    const Vec3l rest{factors[0][v], factors[1][v], factors[2][v]};
    std::int64_t sum = 0;
    for (const Influence& i : gof_.influences[v]) {
      const BoneMotion& bone = bones_[i.bone];
      sum += i.weight * moved_point(bone.poses[f], bone.pivot, rest)[c];
    }
    std::int64_t displacement = 0;
    for (std::size_t l = 0; l < gof_.trajectories.size(); ++l) {
      const Trajectory& t = gof_.trajectories[l];
      const std::int64_t spatial = factors[kRestFactors + l][v]
                                   << std::max(kSpatialNormBits - t.spatial_bits, 0);
      displacement += spatial * scale_temporal(recon_trajectory(t, gof_.track_levels)[f][c],
                                               t.scale_idx, t.temporal_bits);
    }
    const std::int64_t place = round2(sum, gof_.weight_bits) +
                               clip_signed(31, round2(displacement, gof_.fraction_bits));
    return clip_signed(from_.header.position_bits, round2(place, 4));
  }

 private:
  // 8.18: takes rest positions; specdec compares them with the text on the same streams.
  void take_rest() {
    const RestRecon recon(mesh_.rest_order(), gof_.rest, gof_.rest_step,
                          from_.header.position_bits);
    const auto values =
        recon_rest(recon, mesh_.rest_order(), gof_.vertex_residual[0], gof_.counterparts);
    factors.resize(kRestFactors);
    for (std::size_t i = 0; i < values.size(); ++i) {
      factors[i % kRestFactors].push_back(values[i]);
    }
  }

  void make_weights() {
    std::array<std::vector<std::int32_t>, 3> rest;
    for (std::size_t c = 0; c < 3; ++c) rest[c].assign(factors[c].begin(), factors[c].end());
    weights_.emplace(mesh_, gof_.weights,
                     std::array<std::span<const std::int32_t>, 3>{rest[0], rest[1], rest[2]});
  }

  FilterOfText::List neighbour_offsets(std::uint32_t v, const Plane& values,
                                       std::int64_t& mean) const {
    const auto ring = mesh_.ring(v);
    std::int64_t sum = 0;
    for (const std::uint32_t u : ring) sum += values[u];
    mean = div_round(sum, static_cast<std::int64_t>(ring.size()));
    FilterOfText::List offsets;
    for (const std::uint32_t u : ring) offsets.push_back(values[u] - mean);
    for (const std::uint32_t u : mesh_.outer_ring(v)) offsets.push_back(values[u] - mean);
    return offsets;
  }

  // 8.15.1 StartFactor( l )
  void start_factor(std::size_t l) {
    for (std::uint32_t v = 0; v < mesh_.num_vertices(); ++v) {
      if (l == kRestFactors) {
        filters_.emplace_back();
        filters_[v].ring = mesh_.ring(v).size();
        for (const std::int64_t w : (*weights_)[v]) {
          filters_[v].weight.push_back(
              clip3(-FilterOfText::kMaxWeight, FilterOfText::kMaxWeight, w * 4));
        }
        filters_[v].start_spread(12);
        if (gof_.weights.damping_log2 > 0 && filters_[v].ring > 1) adapt_to_rest(v);
      } else if (std::find(gof_.group_end.begin() + 1, gof_.group_end.end(), l) !=
                 gof_.group_end.end()) {
        filters_[v].start_spread(9);
      }
    }
  }

  void adapt_to_rest(std::uint32_t v) {
    std::array<FilterOfText::List, 3> offsets;
    Vec3l gap{};
    std::int64_t largest = 1;
    for (std::size_t c = 0; c < 3; ++c) {
      std::int64_t mean = 0;
      offsets[c] = neighbour_offsets(v, factors[c], mean);
      gap[c] = factors[c][v] - mean;
      largest = std::max({largest, std::abs(gap[c]), FilterOfText::max_magnitude(offsets[c])});
    }
    const int shift = floor_log2(static_cast<std::uint64_t>(largest)) - 9;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::int64_t& x : offsets[c]) x = shift_by(x, shift);
      filters_[v].adapt(offsets[c],
                        shift_by(gap[c], shift) - filters_[v].predict_offset(offsets[c]));
    }
  }

  std::int64_t residual_of(std::size_t l, std::uint32_t v) const {
    std::size_t group = 0;
    while (gof_.group_end[group] <= l) ++group;
    const std::size_t first = group == 0 ? 0 : gof_.group_end[group - 1];
    return gof_.vertex_residual[group][v * (gof_.group_end[group] - first) + l - first];
  }

  Plane reconstruct(std::size_t l) {
    Plane values(mesh_.num_vertices());
    const int bits =
        l < 3 ? from_.header.position_bits + 5 : gof_.trajectories[l - 3].spatial_bits;
    for (const std::uint32_t v : mesh_.order()) {
      std::int64_t difference = residual_of(l, v) * gof_.layer_step[mesh_.layer_of(v)];
      if (l < 3) difference = round2(difference * gof_.rest_step, 4);
      if (l > 2 && gof_.weights.num_adaptive_factors > 0 && mesh_.ring(v).size() > 1) {
        std::int64_t mean = 0;
        const FilterOfText::List offsets = neighbour_offsets(v, values, mean);
        const std::int64_t prediction = mean + filters_[v].predict_offset(offsets);
        values[v] = clip_signed(bits, prediction + difference);
        if (l - 3 < gof_.weights.num_adaptive_factors) {
          filters_[v].adapt(offsets, values[v] - prediction);
        }
      } else {
        values[v] = clip_signed(bits, predicted(l, v, values) + difference);
      }
    }
    return values;
  }

  std::int64_t predicted(std::size_t l, std::uint32_t v, const Plane& values) const {
    const auto ring = mesh_.ring(v);
    if (gof_.prediction == Prediction::kLayers && l > 2) {
      std::int64_t sum = 0;
      for (std::size_t k = 0; k < (*weights_)[v].size(); ++k) {
        const std::uint32_t u =
            k < ring.size() ? ring[k] : mesh_.outer_ring(v)[k - ring.size()];
        sum += (*weights_)[v][k] * values[u];
      }
      return round2(sum, 14);
    }
    if (gof_.prediction == Prediction::kNone && l > 2) return 0;
    const auto list = from_.topology.parallelograms[v];
    std::int64_t sum = 0;
    if (gof_.prediction != Prediction::kLayers && !list.empty()) {
      Parallelogram latest = list[0];
      for (const Parallelogram& p : list) {
        sum += values[p.a] + values[p.b] - values[p.c];
        if (p.b > latest.b || (p.b == latest.b && p.a > latest.a)) latest = p;
      }
      if (gof_.prediction == Prediction::kParallelogram) {
        return values[latest.a] + values[latest.b] - values[latest.c];
      }
      return div_round(sum, static_cast<std::int64_t>(list.size()));
    }
    for (const std::uint32_t u : ring) sum += values[u];
    return ring.empty() ? 0 : div_round(sum, static_cast<std::int64_t>(ring.size()));
  }

  const RandomSkinnedGof& from_;
  const SkinnedGof& gof_;
  OrderedMesh mesh_;
  std::vector<BoneMotion> bones_;
  std::optional<GeometryWeights> weights_;
  std::vector<FilterOfText> filters_;  // [vertex]
};

// Includes GOFs that lack slices of all kinds.
TEST(RandomSkinnedGofs, ReconstructAsSpecified) {
  std::array<int, 4> predictions{};
  int absent = 0;
  int in_order = 0;
  for (unsigned seed = 1; seed <= 600; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSkinnedGof from(seed, {});
    ++predictions[static_cast<std::size_t>(from.gof.prediction)];
    if (from.gof.rest.order_flag) ++in_order;
    if (from.gof.slice_layers.back() < from.gof.layer_group_size.size()) ++absent;
    const TextRecon text(from);
    const OrderedMesh mesh = from.coded_mesh();
    const SkinnedRecon recon(mesh, from.gof, from.header.position_bits);
    ASSERT_EQ(recon.num_frames(), from.gof.num_frames);
    std::vector<std::int32_t> positions(3 * std::size_t{from.header.num_vertices});
    for (std::uint32_t f = 0; f < recon.num_frames(); ++f) {
      recon.frame(f, positions);
      for (std::uint32_t v = 0; v < from.header.num_vertices; ++v) {
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_EQ(positions[3 * v + c], text.position(f, v, c)) << f << " " << v << " " << c;
        }
      }
    }
  }
  for (const int count : predictions) EXPECT_GT(count, 50);
  EXPECT_GT(absent, 100);
  EXPECT_GT(in_order, 100);
}

TEST(SkinnedRecon, HandsOverItsBones) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSkinnedGof from(seed, {});
    const OrderedMesh mesh = from.coded_mesh();
    const SkinnedRecon recon(mesh, from.gof, from.header.position_bits);
    const Skeleton skeleton = recon.skeleton();
    const std::vector<Influences> influences = complete_influences(mesh, from.gof);
    ASSERT_EQ(skeleton.influences.size(), influences.size());
    for (std::size_t v = 0; v < influences.size(); ++v) {
      std::vector<SkeletonInfluence> expected;
      for (const auto& [bone, weight] : influences[v]) expected.push_back({bone, weight});
      std::ranges::sort(expected, {}, &SkeletonInfluence::bone);
      ASSERT_EQ(skeleton.influences[v], expected) << v;
    }
    const auto bones = recon_bones(from.gof.bones, from.gof.num_frames, from.gof.track_levels);
    const std::uint32_t last = from.gof.num_frames - 1;
    const std::vector<BonePlace> places = recon.places(last);
    ASSERT_EQ(places.size(), bones.size());
    for (std::size_t b = 0; b < bones.size(); ++b) {
      EXPECT_EQ(skeleton.bones[b].parent, from.gof.bones[b].parent);
      EXPECT_EQ(skeleton.bones[b].bind.origin, bones[b].pivot);
      EXPECT_EQ(places[b].origin, bones[b].poses[last].origin);
      EXPECT_EQ(skeleton.bones[b].bind.axes, stretch_axes(from.gof.bones[b]));
      // The places of the axes along which a bone stretches.
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
          double image = 0.0;
          for (std::size_t i = 0; i < 3; ++i) {
            image += static_cast<double>(bones[b].poses[last].axes[i][c]) *
                     static_cast<double>(bones[b].along[k][i]);
          }
          EXPECT_NEAR(static_cast<double>(places[b].axes[k][c]), std::ldexp(image, -30),
                      bones[b].is_stretched ? 33.0 : 0.5);
        }
      }
    }
    EXPECT_EQ(skeleton.step, from.gof.rest_step);
  }
}

// Threads share the vertices of a layer.
TEST(SkinnedRecon, DoesNotDependOnThreads) {
  int shared = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSkinnedGof from(seed, {.max_vertices = 500, .max_frames = 1});
    const OrderedMesh mesh = from.coded_mesh();
    const bool adapts = from.gof.weights.num_adaptive_factors > 0;
    for (std::uint32_t layer = 0; layer < mesh.num_layers() && adapts; ++layer) {
      if (mesh.vertices_of_layers(layer, layer + 1).size() > 32) ++shared;
    }
    const auto positions = [&] {
      std::vector<std::int32_t> frame(3 * std::size_t{from.header.num_vertices});
      SkinnedRecon(mesh, from.gof, from.header.position_bits).frame(0, frame);
      return frame;
    };
    const std::vector<std::int32_t> alone = positions();
    const Threads threads(3);
    ASSERT_EQ(positions(), alone);
  }
  EXPECT_GT(shared, 10);
}

TEST(RecoveredValues, OfRestPositionsAreAsSpecified) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSkinnedGof from(seed,
                                {.max_vertices = 120, .max_frames = 1, .rest_order = false});
    const TextRecon text(from);
    const OrderedMesh mesh = from.coded_mesh();
    const auto values =
        recon_values(mesh, from.gof, 0, from.header.position_bits, {mesh, true, nullptr});
    for (std::uint32_t v = 0; v < from.header.num_vertices; ++v) {
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(values[3 * v + c], text.factors[c][v]);
    }
  }
}

// 8.10.3: of the edges 1 9, 5 6 and 3 9, the last is the latest.
TEST(ValuePredictions, UseTheLatestParallelogramOrTheMeanOfAll) {
  const std::vector<Triangle> triangles{{10, 1, 9}, {1, 0, 9},  {10, 5, 6},
                                        {5, 2, 6},  {3, 10, 9}, {3, 9, 4}};
  const Topology topology = make_topology(11, triangles);
  const VertexLayers layers = make_layers(11, triangles);
  const std::vector<std::int32_t> values{1, 20, 300, -7, 5000, 11, 60, 0, 0, 900, 0};
  const auto predicted = [&](Prediction p, bool is_rest) {
    const OrderedMesh mesh(p, topology, layers);
    std::array<std::int64_t, 1> prediction{};
    ValuePrediction(mesh, is_rest, nullptr).predict(10, values, prediction);
    return prediction[0];
  };
  // 20 + 900 - 1, 11 + 60 - 300, -7 + 900 - 5000
  const std::int64_t mean = -1139;  // (919 - 229 - 4107) / 3
  EXPECT_EQ(predicted(Prediction::kParallelogram, true), -4107);
  EXPECT_EQ(predicted(Prediction::kParallelogram, false), -4107);
  EXPECT_EQ(predicted(Prediction::kParallelograms, false), mean);
  EXPECT_EQ(predicted(Prediction::kNone, true), mean);
  EXPECT_EQ(predicted(Prediction::kNone, false), 0);
}

// Returns a mesh at rest with one bone that does not move.
RandomSkinnedGof still(unsigned seed) {
  RandomSkinnedGof from(
      seed, {.max_vertices = 60, .max_bones = 1, .max_groups = 0, .rest_order = false});
  from.header.position_bits = 16;
  from.gof.bones[0] = Bone{};
  return from;
}

TEST(SkinnedRecon, RepeatsTheRestShapeWithoutMotion) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const RandomSkinnedGof from = still(seed);
    const OrderedMesh mesh = from.coded_mesh();
    const auto rest = recon_values(mesh, from.gof, 0, 16, {mesh, true, nullptr});
    const SkinnedRecon recon(mesh, from.gof, 16);
    std::vector<std::int32_t> positions(rest.size());
    for (std::uint32_t f = 0; f < recon.num_frames(); ++f) {
      recon.frame(f, positions);
      for (std::size_t i = 0; i < rest.size(); ++i) {
        ASSERT_EQ(positions[i], clip_signed(16, round2(rest[i], kPointFractionBits)));
      }
    }
  }
}

// 8.14.1: vertices of absent layers are at the mean of their rings.
TEST(SkinnedRecon, PredictsVerticesOfAbsentLayers) {
  int absent = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const RandomSkinnedGof from = still(seed);
    if (from.gof.prediction != Prediction::kLayers) continue;
    const OrderedMesh mesh = from.coded_mesh();
    std::uint32_t present = 0;
    for (std::uint32_t j = 0; j < from.gof.slice_layers[0]; ++j)
      present += from.gof.layer_group_size[j];
    const auto rest = recon_values(mesh, from.gof, 0, 16, {mesh, true, nullptr});
    for (const std::uint32_t v : mesh.vertices_of_layers(present, mesh.num_layers())) {
      if (mesh.ring(v).empty()) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        std::int64_t sum = 0;
        for (const std::uint32_t u : mesh.ring(v)) sum += rest[3 * u + c];
        ASSERT_EQ(rest[3 * v + c],
                  div_round(sum, static_cast<std::int64_t>(mesh.ring(v).size())));
      }
      ++absent;
    }
  }
  EXPECT_GT(absent, 100);
}

// Returns the prediction of the value after `values`.
Vec3l predicted(const Trajectory& t, std::span<const Vec3i> values) {
  Vec3l prediction{};
  for (std::size_t c = 0; c < 3; ++c) {
    prediction[c] =
        predict_trajectory(t, [&](std::uint32_t f) { return std::int64_t{values[f][c]}; },
                           {.frame = static_cast<std::uint32_t>(values.size())});
  }
  return prediction;
}

TEST(Trajectories, FollowTheOrdersOfSeries) {
  Trajectory t;
  const std::vector<Vec3i> values{{1, 10, -5}, {4, 20, -7}, {9, 10, 0}, {16, 40, 3}};
  t.temporal_predictor = 0;
  EXPECT_EQ(predicted(t, values), (Vec3l{0, 0, 0}));
  t.temporal_predictor = 1;
  EXPECT_EQ(predicted(t, values), (Vec3l{16, 40, 3}));
  t.temporal_predictor = 2;
  EXPECT_EQ(predicted(t, values), (Vec3l{23, 70, 6}));
  t.temporal_predictor = 3;  // 25 continues the squares
  EXPECT_EQ(predicted(t, values), (Vec3l{25, 110, 2}));
  t.temporal_predictor = 4;  // 4 * 40 - 6 * 10 + 4 * 20 - 10
  EXPECT_EQ(predicted(t, values), (Vec3l{25, 170, -11}));
}

TEST(Trajectories, FollowTheirWeights) {
  Trajectory t;
  t.temporal_weight = {96, -40, 16};  // 3/2, -5/8, 1/4
  const std::vector<Vec3i> values{{100, 0, 3}, {-7, 3, 1}, {11, -1, 2}};
  t.temporal_predictor = 5;
  EXPECT_EQ(predicted(t, values), (Vec3l{17, -1, 3}));  // 16.5, -1.5, 3
  t.temporal_predictor = 6;
  EXPECT_EQ(predicted(t, values), (Vec3l{21, -3, 2}));  // 20.875, -3.375, 2.375
  t.temporal_predictor = 7;
  EXPECT_EQ(predicted(t, values), (Vec3l{46, -3, 3}));  // 45.875, -3.375, 3.125
  // With too few predecessors, the previous value is the prediction.
  EXPECT_EQ(predicted(t, std::span(values).first(2)), (Vec3l{-7, 3, 1}));
  EXPECT_EQ(predicted(t, {}), (Vec3l{0, 0, 0}));
}

// Level 0 has every fourth frame, predicted with stride 4; the frames between are predicted
// from both sides, where frames exist.
TEST(Trajectories, AreReconstructedLevelByLevel) {
  Trajectory t;
  t.temporal_predictor = 5;
  t.temporal_weight = {128, 0, 0};  // twice
  t.temporal_between = 1;
  t.residual.assign(11, {});
  t.residual[0] = {10, -10, 1};
  t.residual[2] = {1, 0, 0};
  const std::vector<Vec3i> two = recon_trajectory(t, 2);
  const std::vector<std::int32_t> x{10, 13, 16, 18, 20, 25, 30, 35, 40, 60, 80};
  for (std::size_t f = 0; f < x.size(); ++f) EXPECT_EQ(two[f][0], x[f]) << f;
  EXPECT_EQ(two[8], (Vec3i{40, -40, 4}));
  t.temporal_between = 2;
  const std::vector<Vec3i> four = recon_trajectory(t, 2);
  EXPECT_EQ(four[1], two[1]);                                 // too near the beginning
  EXPECT_EQ(four[3][0], (9 * (16 + 20) - 10 - 30 + 8) / 16);  // 17.75
  EXPECT_EQ(four[7][0], (9 * (30 + 40) - 20 - 80 + 8) / 16);
  t.temporal_between = 0;  // sequential, with the stride 1
  EXPECT_EQ(recon_trajectory(t, 2)[3][0], 82);
}

TEST(Trajectories, AreClippedToTheirRange) {
  constexpr std::int32_t kHalf = 1 << (kTemporalIndexBits - 1);
  Trajectory t;
  t.temporal_predictor = 7;
  t.temporal_weight = {255, 255, -256};
  t.residual.assign(12, {(1 << 28) - 1, -(1 << 28) + 1, 0});
  for (const Vec3i& value : recon_trajectory(t, 0))
    EXPECT_EQ(value, (Vec3i{kHalf - 1, -kHalf, 0}));
  t.temporal_predictor = 1;
  t.residual = {{5, 0, -kHalf}, {-3, 7, -1}, {0, 0, 2}};
  EXPECT_EQ(recon_trajectory(t, 0),
            (std::vector<Vec3i>{{5, 0, -kHalf}, {2, 7, -kHalf}, {2, 7, 2 - kHalf}}));
}

TEST(SkinnedPoint, IsTheWeightedMeanOfItsBones) {
  std::vector<BoneMotion> bones(3);
  for (std::size_t b = 0; b < 3; ++b) {
    BonePose pose;
    pose.axes = axes_of(kNoRotation);
    pose.origin = {static_cast<std::int64_t>(b) * 100, 0, b == 1 ? -3 : 0};
    bones[b].poses = {BonePose{}, pose};
  }
  Influences one;
  one.size = 1;
  one.list[0] = {2, 128};
  EXPECT_EQ(skinned_point(one, 7, bones, 1, {7, 8, 9}), (Vec3l{207, 8, 9}));
  Influences two;
  two.size = 2;
  two.list[0] = {0, 1};
  two.list[1] = {1, 3};
  // (7 + 3 * 107) / 4 = 82; (9 + 3 * 6) / 4 = 6.75
  EXPECT_EQ(skinned_point(two, 2, bones, 1, {7, 8, 9}), (Vec3l{82, 8, 7}));
}

TEST(FactorGroups, AreConsecutive) {
  SkinnedGof gof;
  gof.group_end = {3, 5, 9};
  EXPECT_EQ(factor_group(gof, 0).first, 0U);
  EXPECT_EQ(factor_group(gof, 0).size(), 3U);
  EXPECT_EQ(factor_group(gof, 2).first, 5U);
  EXPECT_EQ(factor_group(gof, 2).size(), 4U);
}

}  // namespace
}  // namespace rlpc
