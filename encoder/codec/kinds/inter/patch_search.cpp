#include "encoder/codec/kinds/inter/patch_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/codec/bits/fixed_point.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/inter/on_grid.h"
#include "encoder/codec/kinds/inter/point_units.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/small_system.h"
#include "encoder/codec/spans/residual_choice.h"
#include "encoder/codec/write/bit_cost.h"
#include "encoder/codec/write/write_residual.h"

namespace rlpc {
namespace {

constexpr std::size_t kVerticesTogether = 128;                // fixed: vertices of a pass
constexpr std::size_t kPatchesTogether = 16;                  // fixed: patches of a pass
constexpr double kMatrixOne = 1 << kMatrixFractionBits;       // fixed: format
constexpr double kMotionStep = 1.0 / (1 << kMotionStepLog2);  // fixed: format

// Returns the step of a vertex, in 1/16 grid units.
double step_of(const InterRecon& recon, std::uint32_t v) {
  return static_cast<double>(recon.step(v)) * kStepUnits;
}

// Returns the bits of a motion whose patch the contexts have started; leaves these unchanged.
double motion_bits(PatchContexts& contexts, const PatchMotion& motion) {
  BitEstimate bits;
  const PatchContexts::Means before = contexts.means();
  for (std::size_t i = 0; i < kMotionValues; ++i) {
    write_residual(bits, contexts.models(i), contexts.expected(i), motion.residual[i]);
    contexts.update(i, motion.residual[i]);
  }
  contexts.set_means(before);
  return bits.bits();
}

double mode_bits(PatchContexts& contexts, int mode) {
  BitEstimate bits;
  const auto& models = contexts.mode_models();
  for (int i = 0; i < std::min(mode + 1, kPatchModes - 1); ++i) {
    bits.bin(models[static_cast<std::size_t>(i)], i < mode);
  }
  return bits.bits();
}

// Adapts models and contexts to a patch as the writer does.
void adapt(PatchContexts& contexts, const PatchMotion& motion) {
  const int mode = static_cast<int>(motion.mode);
  for (int i = 0; i < std::min(mode + 1, kPatchModes - 1); ++i) {
    contexts.mode_models()[static_cast<std::size_t>(i)].update(i < mode);
  }
  contexts.set_mode(motion.mode);
  if (motion.mode == PatchMode::kNeighbours) return;
  BitCost bits;
  for (std::size_t i = 0; i < kMotionValues; ++i) {
    write_residual(bits, contexts.models(i), contexts.expected(i), motion.residual[i]);
    contexts.update(i, motion.residual[i]);
  }
}

// fixed: a guard. Pulls the matrix of a motion to the last one where a flat patch does not
// determine it; relative to the mean square of distances.
constexpr double kRidge = 1e-6;

}  // namespace

PatchSearch::PatchSearch(const OrderedMesh& mesh, const InterSettings& settings,
                         bool to_nearest)
    : mesh_(mesh),
      settings_(settings),
      max_alone_(settings.exact_flag ? 0.0
                 : to_nearest        ? 0.5
                                     : std::numeric_limits<double>::infinity()),
      vertices_(settings.num_patches),
      wanted_(3 * std::size_t{mesh.num_vertices()}),
      left_(wanted_.size()),
      neighbour_contexts_(mesh, settings.layer_group_size.size(),
                          settings.pattern.num_depths()),
      motion_contexts_(mesh, settings.layer_group_size.size(), settings.pattern.num_depths()) {
  for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
    vertices_[settings.patch_of_vertex[v]].push_back(v);
  }
}

FramePatches PatchSearch::choose(std::span<const double> xyz, std::uint32_t depth,
                                 const PatchContexts& contexts, InterRecon& recon) {
  FramePatches patches(vertices_.size());
  recon.move_patches(patches);
  predict_from_neighbours(xyz, recon);
  for_ranges(patches.size(), kPatchesTogether, [&](std::size_t first, std::size_t end) {
    PatchContexts own = contexts;
    for (std::size_t p = first; p < end; ++p) {
      if (vertices_[p].empty()) continue;
      own.start(p);
      patches[p] = cheapest_motion(p, xyz, depth, recon, own);
    }
  });
  std::array<Costs, 2> residual_costs;
  for_each(residual_costs.size(), [&](std::size_t i) {
    InterContexts& mode_contexts = i == 0 ? neighbour_contexts_ : motion_contexts_;
    residual_costs[i] = costs(mode_contexts, recon.place(), depth, i == 0 ? wanted_ : left_);
  });
  choose_modes(residual_costs[0], residual_costs[1], contexts, patches);
  return patches;
}

// Returns the cheapest of the whole motion, its offset alone, and the last motion: by residuals
// and bits.
PatchMotion PatchSearch::cheapest_motion(std::size_t patch, std::span<const double> xyz,
                                         std::uint32_t depth, const InterRecon& recon,
                                         PatchContexts& contexts) {
  const PatchMotion all = fit(patch, xyz, depth, recon);
  PatchMotion offset = all;
  std::fill(offset.residual.begin() + kOffsetValues, offset.residual.end(), 0);
  PatchMotion cheapest;
  double min = std::numeric_limits<double>::max();
  for (const PatchMotion& candidate : {all, offset, PatchMotion{}}) {
    const double cost = error(patch, xyz, depth, recon, candidate, nullptr) / kLambda +
                        motion_bits(contexts, candidate);
    if (cost >= min) continue;
    min = cost;
    cheapest = candidate;
  }
  error(patch, xyz, depth, recon, cheapest, &left_);
  return cheapest;
}

// Chooses the modes of patches. patches: has their motions; those that are not used are
// removed.
void PatchSearch::choose_modes(const Costs& neighbour_costs, const Costs& motion_costs,
                               PatchContexts contexts, FramePatches& patches) const {
  for (std::size_t p = 0; p < patches.size(); ++p) {
    contexts.start(p);
    std::array<double, kPatchModes> cost{neighbour_costs[p], motion_costs[p], cost_alone(p)};
    const double bits = motion_bits(contexts, patches[p]);
    for (int mode = 0; mode < kPatchModes; ++mode) {
      double& mode_cost = cost[static_cast<std::size_t>(mode)];
      mode_cost += mode_bits(contexts, mode) + (mode > 0 ? bits : 0.0);
    }
    const auto cheapest = std::min_element(cost.begin(), cost.end()) - cost.begin();
    patches[p].mode = static_cast<PatchMode>(cheapest);
    if (patches[p].mode == PatchMode::kNeighbours) patches[p].residual = {};
    adapt(contexts, patches[p]);
  }
}

// Returns the cost of a patch without residuals, in bits.
double PatchSearch::cost_alone(std::size_t patch) const {
  double error = 0.0;
  for (const std::uint32_t v : vertices_[patch]) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double left = left_[3 * std::size_t{v} + c];
      if (std::abs(left) > max_alone_) return std::numeric_limits<double>::max();
      error += left * left;
    }
  }
  return error / kLambda;
}

PatchSearch::Costs PatchSearch::costs(InterContexts& contexts, std::uint32_t place,
                                      std::uint32_t depth,
                                      const std::vector<double>& wanted) const {
  Costs costs(vertices_.size(), 0.0);
  std::uint32_t first = 0;
  for (std::size_t j = 0; j < settings_.layer_group_size.size(); ++j) {
    contexts.start_group(place, depth, j);
    const std::uint32_t end = first + settings_.layer_group_size[j];
    for (const std::uint32_t v : mesh_.vertices_of_layers(first, end)) {
      contexts.start(v);
      BitCost bits;
      double error = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double wanted_value = wanted[3 * std::size_t{v} + c];
        const std::int32_t residual =
            settings_.exact_flag
                ? rounded_residual(wanted_value, 0.5)
                : cheaper_residual(contexts.models(), contexts.expected(), wanted_value);
        write_residual(bits, contexts.models(), contexts.expected(), residual);
        contexts.update(residual);
        if (!settings_.exact_flag)
          error += (wanted_value - residual) * (wanted_value - residual);
      }
      costs[settings_.patch_of_vertex[v]] += bits.bits() + error / kLambda;
    }
    first = end;
  }
  return costs;
}

// Predicts in closed loop, with residuals rounded without models.
void PatchSearch::predict_from_neighbours(std::span<const double> xyz, InterRecon& recon) {
  const double round_up = settings_.exact_flag ? 0.5 : 0.5 - kDeadZone;
  for (std::uint32_t layer = 0; layer < mesh_.num_layers(); ++layer) {
    const auto vertices = mesh_.vertices_of_layers(layer, layer + 1);
    const auto predict = [&](std::size_t first, std::size_t end) {
      VertexMotion motion;
      for (std::size_t i = first; i < end; ++i) {
        const std::uint32_t v = vertices[i];
        recon.predict(v, motion);
        Vec3i residual{};
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t own = 3 * std::size_t{v} + c;
          const double value = settings_.exact_flag ? on_grid(xyz[own]) : xyz[own];
          wanted_[own] =
              (value * kPointUnits - recon.start_of(v, motion, c)) / step_of(recon, v);
          residual[c] = rounded_residual(wanted_[own], round_up);
        }
        recon.set(v, motion, recon.position(v, motion, residual));
      }
    };
    if (layer == 0) {
      predict(0, vertices.size());
    } else {
      for_ranges(vertices.size(), kVerticesTogether, predict);
    }
  }
}

// Fits the residual of the last motion of the patch by least squares.
PatchMotion PatchSearch::fit(std::size_t patch, std::span<const double> xyz,
                             std::uint32_t depth, const InterRecon& recon) const {
  const auto reference = recon.reference();
  const PatchRecon& patches = recon.patches();
  const Vec3i centre = patches.centre(patch);
  const auto reach = static_cast<double>(patches.reach(patch));
  const PatchRecon::Motion& last = patches.last_motion(depth, patch);
  std::array<SmallSystem<4>, 3> systems;
  for (const std::uint32_t v : vertices_[patch]) {
    std::array<double, 4> x{0.0, 0.0, 0.0, 1.0};
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = (static_cast<double>(reference[3 * std::size_t{v} + k]) - centre[k]) / reach;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t own = 3 * std::size_t{v} + c;
      double left = xyz[own] * kPointUnits - reference[own] - last[c];
      for (std::size_t k = 0; k < 3; ++k) {
        left -= last[kOffsetValues + 3 * c + k] / kMatrixOne * x[k] * reach;
      }
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) systems[c].a[i][j] += x[i] * x[j];
        systems[c].b[i] += x[i] * left;
      }
    }
  }
  const double step = recon.frame_step() * kMotionStep;
  PatchMotion motion;
  for (std::size_t c = 0; c < 3; ++c) {
    const double ridge = kRidge * static_cast<double>(vertices_[patch].size());
    for (std::size_t k = 0; k < 3; ++k) systems[c].a[k][k] += ridge;
    const auto solved = solve_small(systems[c]);
    motion.residual[c] = rounded_residual(solved.x[3] / step, 0.5);
    for (std::size_t k = 0; k < 3; ++k) {
      motion.residual[kOffsetValues + 3 * c + k] = rounded_residual(solved.x[k] / step, 0.5);
    }
  }
  return motion;
}

// Returns the squared error of a motion, in squared steps; `left`, if given, receives the
// residuals. They are computed from the decoder's integers: with other rounding, a patch
// without residuals would be taken for exact though some of its coordinates are one step off.
double PatchSearch::error(std::size_t patch, std::span<const double> xyz, std::uint32_t depth,
                          const InterRecon& recon, const PatchMotion& motion,
                          std::vector<double>* left) const {
  const auto moved = recon.patches().motion(patch, depth, recon.frame_step(), motion.residual);
  double sum = 0.0;
  for (const std::uint32_t v : vertices_[patch]) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t own = 3 * std::size_t{v} + c;
      std::int64_t at = recon.patches().moved(moved, v, c);
      double value = xyz[own] * kPointUnits;
      if (settings_.exact_flag) {
        value = on_grid(xyz[own]) * kPointUnits;
        at = to_grid(at);
      }
      const double wanted_value = (value - static_cast<double>(at)) / step_of(recon, v);
      if (left != nullptr) (*left)[own] = wanted_value;
      sum += wanted_value * wanted_value;
    }
  }
  return sum;
}

}  // namespace rlpc
