#include "encoder/codec/kinds/skinned/tracks/track_coding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/codec/components/track_order.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/tracks/residual_search.h"
#include "encoder/codec/kinds/skinned/tracks/track_series.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/small_system.h"
#include "encoder/codec/spans/residual_choice.h"
#include "encoder/codec/write/bit_cost.h"
#include "encoder/codec/write/write_residual.h"

namespace rlpc {
namespace {

constexpr double kWeightScale = 64.0;  // fixed: unit of temporal_weight
constexpr double kMaxWeight = 255.0;   // fixed: format
constexpr int kWeightBits = 9;         // fixed: format
// tuned (off: 100): Ways to code a track that are tried with each order of its frames: those
// with the fewest expected bits.
constexpr std::size_t kTried = 2;
// tuned (off: 1): Codings of a track that the search for residuals tries to improve, cheapest
// first. It changes their order of cost little.
constexpr std::size_t kSearched = 2;
// tuned (off: 1): Survivors of the search. More find little more, and take time in proportion.
constexpr std::size_t kSurvivors = 4;
// tuned (off: 1): Survivors with the fast preset, which has less time.
constexpr std::size_t kSurvivorsFast = 2;
// tuned (off: 1): Survivors are alike if this many latest values agree, for each level of the
// track. Older values barely affect what a choice costs later.
constexpr std::size_t kMemory = 3;

using Values = std::span<const std::array<double, 3>>;
// Fits least-squares weights that predict each value of level 0 from the `count` values before
// it there, which are `stride` frames apart. values: in steps.
bool fit_weights(Values values, std::size_t stride, int count,
                 std::array<std::int16_t, kMaxTemporalWeights>& weights) {
  SmallSystem<kMaxTemporalWeights> m;  // normal equations
  const auto n = static_cast<std::size_t>(count);
  for (std::size_t f = n * stride; f < values.size(); f += stride) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
          m.a[i][k] += values[f - (1 + i) * stride][c] * values[f - (1 + k) * stride][c];
        }
        m.b[i] += values[f - (1 + i) * stride][c] * values[f][c];
      }
    }
  }
  // Prediction is from decoded values, whose quantisation errors act as regularisation.
  const std::size_t num_places = values.size() / stride;
  for (std::size_t i = 0; i < n; ++i) {
    m.a[i][i] += 3.0 / 12.0 * static_cast<double>(num_places);
  }
  const auto solution = solve_small(m, n);
  if (!solution.is_unique) return false;
  for (std::size_t i = 0; i < n; ++i) {
    weights[i] = static_cast<std::int16_t>(
        round_to_int(std::clamp(solution.x[i] * kWeightScale, -kMaxWeight, kMaxWeight)));
  }
  return true;
}

int min_between(const TrackOptions& options) { return options.only_levels ? 1 : 0; }
int max_between(const TrackOptions& options) {
  return options.track_levels > 0 ? kMaxBetween : 0;
}

// A track with its residuals.
template <class Value>
struct CodedTrack {
  TrackResiduals residuals;
  std::array<std::vector<Value>, 3> values;  // [coordinate][frame]; coupled: only the first
  TrackCost cost;
  TrackState after;
};

// A way to code a track: its order, and the state before it.
struct TrackTask {
  std::vector<TrackPlace> order;
  const TrackState* before = nullptr;
  double header_bits = 0.0;
};

// Codes the track in closed loop; none, early, if it costs at least `limit`. choose(wanted,
// models, expected, at, c) returns a residual.
template <class Series, class Choose>
std::optional<CodedTrack<typename Series::Value>> code_track(const Series& series,
                                                             const TrackTask& task,
                                                             double limit,
                                                             const Choose& choose) {
  using Value = typename Series::Value;
  const std::size_t num_frames = task.order.size();
  CodedTrack<Value> coded{TrackResiduals(num_frames), {}, {}, *task.before};
  for (std::size_t c = 0; c < (Series::kCoupled ? 1 : 3); ++c) {
    coded.values[c].resize(num_frames);
  }
  BitCost bits;
  TrackContext context(coded.after.mean);
  for (const TrackPlace& at : task.order) {
    ResidualModels& models = coded.after.models[models_of_level(at.level)];
    Vec3i& residual = coded.residuals[at.frame];
    typename Series::Predicted predicted;
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<Value>& values = coded.values[Series::kCoupled ? 0 : c];
      if (c == 0 || !Series::kCoupled) {
        predicted =
            series.predict([&](std::uint32_t f) -> const Value& { return values[f]; }, at, c);
      }
      const double wanted = predicted.wanted[c];
      const std::uint32_t expected = context.expected(at, c);
      residual[c] = choose(wanted, models, expected, at, c);
      const double error = wanted - residual[c];
      coded.cost.error += error * error;
      write_residual(bits, models, expected, residual[c]);
      context.update(at, c, residual[c]);
      if (c == 2 || !Series::kCoupled) {
        values[at.frame] = series.value(predicted, residual, at, c);
      }
    }
    coded.cost.bits = task.header_bits + bits.bits();
    if (lagrangian_cost(coded.cost) >= limit) return std::nullopt;
  }
  return coded;
}

// Rounds each residual by itself.
template <class Series>
auto code_greedily(const Series& series, const TrackTask& task, double limit, bool nearest) {
  return code_track(series, task, limit,
                    [nearest](double wanted, ResidualModels& models, std::uint32_t expected,
                              const TrackPlace& /*at*/, std::size_t /*c*/) {
                      return nearest ? rounded_residual(wanted, 0.5)
                                     : cheaper_residual(models, expected, wanted);
                    });
}

// Replaces the residuals by those that a search finds, if they cost less.
template <class Series>
void search_residuals(const Series& series, const TrackTask& task, bool fast,
                      CodedTrack<typename Series::Value>& coded) {
  const auto levels = static_cast<std::size_t>(task.order.back().level) + 1;
  const std::vector<TrackPlace> order = search_order(task.order);
  ResidualSearch<Series> search(series, order, *task.before,
                                {fast ? kSurvivorsFast : kSurvivors, kMemory * levels});
  TrackResiduals residuals = coded.residuals;
  for (std::size_t c = 0; c < 3; ++c) search.improve(c, residuals);
  auto found = code_track(
      series, task, lagrangian_cost(coded.cost),
      [&residuals](double /*wanted*/, ResidualModels& /*models*/, std::uint32_t /*expected*/,
                   const TrackPlace& at, std::size_t c) { return residuals[at.frame][c]; });
  if (found) coded = std::move(*found);
}

// Returns the bits of residuals whose magnitudes have a geometric distribution with this mean.
double geometric_bits(double mean) {
  const double some =
      mean > 0.0 ? (1.0 + mean) * det_log2(1.0 + mean) - mean * det_log2(mean) : 0.0;
  return some + mean / (1.0 + mean);
}

// Returns the expected bits of the residuals, with rounding to nearest: values then barely
// depend on their predictor.
template <class Series>
double expected_bits(const Series& series, const TrackTask& task,
                     std::span<const std::vector<typename Series::Value>> ideal) {
  struct OfLevel {
    double sum = 0.0;
    double count = 0.0;
  };
  std::array<std::array<OfLevel, 3>, kMaxTrackLevels + 1> levels;
  for (const TrackPlace& at : task.order) {
    auto& level_tracks = levels[static_cast<std::size_t>(at.level)];
    typename Series::Predicted predicted;
    for (std::size_t c = 0; c < 3; ++c) {
      if (c == 0 || !Series::kCoupled) {
        const auto& values = ideal[Series::kCoupled ? 0 : c];
        predicted = series.predict(
            [&](std::uint32_t f) -> const auto& { return values[f]; }, at, c);
      }
      level_tracks[c].sum += std::floor(std::abs(predicted.wanted[c]) + 0.5);
      level_tracks[c].count += 1.0;
    }
  }
  double bits = task.header_bits;
  for (const auto& level_tracks : levels) {
    for (const OfLevel& of : level_tracks) {
      if (of.count > 0.0) bits += of.count * geometric_bits(of.sum / of.count);
    }
  }
  return bits;
}

// A way to code a track: a trajectory or bone with the elements that specify it.
template <class Header>
struct Way {
  Header header;
  int between;
  double bits;  // bits of those elements, except for `between`
};

// Codes the bins of `between`, if the GOF has hierarchical tracks.
template <class Coder, class Models>
void write_between(Coder& coder, Models& models, int between, int track_levels) {
  for (int i = 0; i < kMaxBetween && track_levels > 0; ++i) {
    coder.bin(models[static_cast<std::size_t>(i)], i < between);
    if (i == between) break;
  }
}

// Returns the tasks with the fewest expected bits, the fewest first. Expectations are less
// precise between orders of frames than between ways with the same order.
template <class Series, class Wanted, class Header>
std::vector<std::pair<const Way<Header>*, TrackTask>> likely_ways(
    Wanted wanted, std::span<const Way<Header>> ways, const TrackOptions& options,
    TrackState& state) {
  const auto num_frames = static_cast<std::uint32_t>(wanted.size());
  std::array<std::vector<typename Series::Value>, 3> ideal;
  const Series any(wanted, ways.front().header);
  for (std::size_t c = 0; c < (Series::kCoupled ? 1 : 3); ++c) {
    for (std::uint32_t f = 0; f < num_frames; ++f) ideal[c].push_back(any.ideal(f, c));
  }
  std::vector<std::pair<const Way<Header>*, TrackTask>> tasks(ways.size());
  std::vector<std::pair<double, std::size_t>> order(ways.size());
  for_each(ways.size(), [&](std::size_t i) {
    const Way<Header>& way = ways[i];
    BitEstimate between;
    write_between(between, state.between, way.between, options.track_levels);
    tasks[i] = {&way,
                {track_order(num_frames, options.track_levels, way.between), &state,
                 way.bits + between.bits()}};
    order[i] = {expected_bits(Series(wanted, way.header), tasks[i].second,
                              std::span<const std::vector<typename Series::Value>>(ideal)),
                i};
  });
  std::sort(order.begin(), order.end());
  std::vector<std::pair<const Way<Header>*, TrackTask>> likely;
  std::array<std::size_t, kMaxBetween + 1> tried{};
  for (const auto& [bits, i] : order) {
    if (options.draft && !likely.empty()) break;
    if (tried[static_cast<std::size_t>(ways[i].between)]++ >= kTried) continue;
    likely.push_back(std::move(tasks[i]));
  }
  return likely;
}

// Codes a track in the cheapest of several ways; sets `header` and advances the state.
//
//   wanted  [num_frames], as in Series
template <class Series, class Wanted, class Header>
CodedTrack<typename Series::Value> code_best(Wanted wanted, std::span<const Way<Header>> ways,
                                             const TrackOptions& options, TrackState& state,
                                             Header& header) {
  struct Candidate {
    const Way<Header>* way;
    TrackTask task;
    CodedTrack<typename Series::Value> coded;
    double cost() const { return lagrangian_cost(coded.cost); }
  };
  std::vector<Candidate> best;  // the cheapest first
  const std::size_t count = options.fast ? 1 : kSearched;
  auto likely = likely_ways<Series>(wanted, ways, options, state);
  const auto limit = [&] {
    return best.size() < count ? std::numeric_limits<double>::infinity() : best.back().cost();
  };
  for (std::size_t first = 0; first < likely.size(); first += count) {
    std::vector<std::optional<CodedTrack<typename Series::Value>>> coded(
        std::min(count, likely.size() - first));
    for_each(coded.size(), [&](std::size_t i) {
      const auto& [way, task] = likely[first + i];
      coded[i] = code_greedily(Series(wanted, way->header), task, limit(), options.nearest);
    });
    for (std::size_t i = 0; i < coded.size(); ++i) {
      if (!coded[i] || lagrangian_cost(coded[i]->cost) >= limit()) continue;
      if (best.size() == count) best.pop_back();
      auto& [way, task] = likely[first + i];
      Candidate candidate{way, std::move(task), std::move(*coded[i])};
      const auto place = std::find_if(best.begin(), best.end(), [&](const Candidate& other) {
        return candidate.cost() < other.cost();
      });
      best.insert(place, std::move(candidate));
    }
  }
  if (!options.nearest && !options.draft) {
    for_each(best.size(), [&](std::size_t i) {
      search_residuals(Series(wanted, best[i].way->header), best[i].task, options.fast,
                       best[i].coded);
    });
  }
  Candidate& chosen = *std::min_element(
      best.begin(), best.end(),
      [](const Candidate& a, const Candidate& b) { return a.cost() < b.cost(); });
  header = chosen.way->header;
  state = std::move(chosen.coded.after);
  BitCost unused;  // writing adapts the models
  write_between(unused, state.between, chosen.way->between, options.track_levels);
  return std::move(chosen.coded);
}

bool is_stretched(const Bone& bone, const BoneMotion* parent) {
  return bone.stretch != Stretch::kNone || (parent != nullptr && parent->is_stretched);
}

std::vector<Quaternion> code_rotations(std::span<const WantedPose> wanted,
                                       const BoneMotion* parent, const TrackOptions& options,
                                       TrackState& state, Bone& bone) {
  std::vector<QuaternionD> relative(wanted.size());
  for (std::size_t f = 0; f < wanted.size(); ++f) {
    relative[f] = wanted[f].rotation;
    if (parent == nullptr || is_stretched(bone, parent)) continue;
    relative[f] = product(inverse(parent->poses[f].rotation), relative[f]);
  }
  std::vector<Way<Bone>> ways;
  for (int between = min_between(options); between <= max_between(options); ++between) {
    for (int order = 1; order <= kMaxPredictorOrder; ++order) {
      Way<Bone>& way = ways.emplace_back(Way<Bone>{bone, between, 0.0});
      way.header.rotation_order = order;
      way.header.rotation_between = between;
    }
  }
  auto coded =
      code_best<RotationSeries>(std::span<const QuaternionD>(relative),
                                std::span<const Way<Bone>>(ways), options, state, bone);
  bone.rotation_residual = std::move(coded.residuals);
  return std::move(coded.values[0]);
}

// Codes a track of offsets; sets how it is coded. Returns the values as decoded.
std::vector<Vec3l> code_offsets(Values offsets, const TrackOptions& options, TrackState& state,
                                OffsetHeader& header, TrackResiduals& residuals) {
  std::vector<Way<OffsetHeader>> ways;
  for (int between = min_between(options); between <= max_between(options); ++between) {
    for (int order = 0; order <= kMaxPredictorOrder; ++order) {
      ways.push_back({{header.step_idx, order, between}, between, 0.0});
    }
  }
  auto coded = code_best<OffsetSeries>(offsets, std::span<const Way<OffsetHeader>>(ways),
                                       options, state, header);
  residuals = std::move(coded.residuals);
  std::vector<Vec3l> decoded(offsets.size());
  for (std::size_t f = 0; f < decoded.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) decoded[f][c] = coded.values[c][f];
  }
  return decoded;
}

std::vector<Vec3l> code_origins(std::span<const WantedPose> wanted, const BoneMotion* parent,
                                const TrackOptions& options, TrackState& state, Bone& bone) {
  std::vector<std::array<double, 3>> offsets(wanted.size());
  for (std::uint32_t f = 0; f < wanted.size(); ++f) {
    const Vec3l carried = carried_pivot(bone, parent, f);
    for (std::size_t c = 0; c < 3; ++c) {
      offsets[f][c] = wanted[f].origin[c] - static_cast<double>(carried[c]);
    }
  }
  OffsetHeader header{bone.origin_step_idx};
  auto decoded = code_offsets(offsets, options, state, header, bone.origin_residual);
  bone.origin_order = header.order;
  bone.origin_between = header.between;
  return decoded;
}

std::vector<Vec3l> code_stretches(std::span<const WantedPose> wanted,
                                  const TrackOptions& options, TrackState& state, Bone& bone) {
  const double one = exact_exp2(kStretchFractionBits);
  std::vector<std::array<double, 3>> differences(wanted.size());
  for (std::size_t f = 0; f < wanted.size(); ++f) {
    const auto& [first, second, third] = wanted[f].stretch;
    differences[f] = {one * (first - 1.0), one * (second - first), one * (third - first)};
  }
  OffsetHeader header{bone.stretch_step_idx};
  auto decoded = code_offsets(differences, options, state, header, bone.stretch_residual);
  bone.stretch_order = header.order;
  bone.stretch_between = header.between;
  return decoded;
}

}  // namespace

TrackCost code_trajectory(std::span<const std::array<double, 3>> values, double step,
                          const TrackOptions& options, TrackState& state,
                          Trajectory& trajectory) {
  std::vector<std::array<double, 3>> steps(values.begin(), values.end());
  for (auto& value : steps) {
    for (double& x : value) x /= step;
  }
  std::vector<Way<Trajectory>> ways;
  const int last = options.refine ? kMaxTemporalPredictor : kMaxPredictorOrder;
  for (int between = min_between(options); between <= max_between(options); ++between) {
    const std::size_t stride = between > 0 ? std::size_t{1} << options.track_levels : 1;
    for (int predictor = 1; predictor <= last; ++predictor) {
      Way<Trajectory> way{trajectory, between, 0.0};
      way.header.temporal_predictor = predictor;
      way.header.temporal_between = between;
      const int count = predictor - kMaxPredictorOrder;
      if (count > 0) {
        if (!fit_weights(steps, stride, count, way.header.temporal_weight)) continue;
        way.bits = kWeightBits * count;
      }
      ways.push_back(std::move(way));
    }
  }
  auto coded = code_best<TrajectorySeries>(
      Values(steps), std::span<const Way<Trajectory>>(ways), options, state, trajectory);
  trajectory.residual = std::move(coded.residuals);
  return coded.cost;
}

BoneMotion code_bone(std::span<const WantedPose> wanted, const BoneMotion* parent,
                     const TrackOptions& options, BoneTrackStates& states, Bone& bone) {
  RelativeMotion relative{std::vector<Quaternion>(wanted.size(), kNoRotation),
                          std::vector<Vec3l>(wanted.size()), std::vector<Vec3l>(wanted.size())};
  Bone shifted = bone;
  for_each(2, [&](std::size_t i) {
    if (i == 0 && bone.rotation_flag) {
      relative.rotations = code_rotations(wanted, parent, options, states.rotations, bone);
    }
    if (i == 1 && shifted.origin_flag) {
      relative.offsets = code_origins(wanted, parent, options, states.origins, shifted);
    }
  });
  bone.origin_order = shifted.origin_order;
  bone.origin_between = shifted.origin_between;
  bone.origin_residual = std::move(shifted.origin_residual);
  if (bone.stretch != Stretch::kNone) {
    relative.stretches = code_stretches(wanted, options, states.stretches, bone);
  }
  return move_bone(bone, parent, relative);
}

}  // namespace rlpc
