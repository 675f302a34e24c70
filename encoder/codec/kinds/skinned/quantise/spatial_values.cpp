#include "encoder/codec/kinds/skinned/quantise/spatial_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/math/matrix_products.h"
#include "encoder/codec/math/symmetric_system.h"
#include "encoder/codec/spans/residual_choice.h"

namespace rlpc {
namespace {

// Wanted values up to this limit fit their width, however they are rounded.
constexpr double kMaxSpatial =
    (1 << (kMaxSpatialBits - 1)) - 2.0 * kMaxLayerStep;  // fixed: format

// Spatial factors in grid units: the least-squares fit to the decoded temporal vectors. The
// matrix is approximated by pc.spatial * pc.temporal, since the dropped components are almost
// orthogonal to the decoded vectors. So the factors are pc.spatial * mixing.
class FittedFactors {
 public:
  FittedFactors(const ComponentsByRow& pc, const TemporalValues& temporal)
      : pc_(pc),
        count_(temporal.size()),
        num_tried_(temporal.num_tried),
        mixing_(find_mixing(temporal)) {}

  // [vertex][trajectory]
  std::vector<double> of(std::span<const std::uint32_t> vertices) const {
    std::vector<double> components;
    components.reserve(vertices.size() * num_tried_);
    for (const std::uint32_t v : vertices) {
      const auto from =
          pc_.spatial.begin() + static_cast<std::ptrdiff_t>(v * pc_.temporal.size());
      components.insert(components.end(), from, from + static_cast<std::ptrdiff_t>(num_tried_));
    }
    return matrix_product(components, num_tried_, mixing_, count_);
  }

 private:
  // Returns [component][trajectory]. Temporal vectors quantised to zero get no factor.
  std::vector<double> find_mixing(const TemporalValues& temporal) const {
    constexpr double kVanished = 1e-9;  // fixed: rounding
    const std::size_t width = temporal.decoded.front().size();
    const auto products = [&](std::span<const std::vector<double>> vectors) {
      const std::vector<double> columns = as_columns(vectors, width);
      std::vector<double> rows;  // [trajectory][vector]
      for (const auto& vector : temporal.decoded) {
        const std::vector<double> row = ordered_product(vector, columns, vectors.size());
        rows.insert(rows.end(), row.begin(), row.end());
      }
      return rows;
    };
    const SymmetricSystem gram(products(temporal.decoded), count_, kVanished);
    std::vector<double> mixing = products(std::span(pc_.temporal).first(num_tried_));
    gram.solve(mixing, num_tried_);
    std::vector<double> transposed(mixing.size());
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t k = 0; k < num_tried_; ++k) {
        transposed[k * count_ + i] = mixing[i * num_tried_ + k];
      }
    }
    return transposed;
  }

  const ComponentsByRow& pc_;
  std::size_t count_;
  std::size_t num_tried_;
  std::vector<double> mixing_;
};

// Returns the adaptive weights before the first trajectory; none if there are none.
std::optional<AdaptiveWeights> start_weights(const OrderedMesh& mesh, const SharedRig& rig,
                                             const SkinnedAnalysis& analysis,
                                             const std::optional<GeometryWeights>& weights,
                                             const RigRecon* shared) {
  if (shared != nullptr) {
    const AdaptiveWeights* before = shared->adaptive_weights();
    return before != nullptr ? std::optional(*before) : std::nullopt;
  }
  if (rig.weights.num_adaptive_factors == 0) return std::nullopt;
  const auto& rest = analysis.rest;
  return AdaptiveWeights(
      mesh, *weights, rig.weights,
      std::array<std::span<const std::int32_t>, 3>{rest[0], rest[1], rest[2]});
}

// Vertices that are coded one after the other.
struct Pass {
  std::optional<VertexResidualChoice> choice;
  bool keeps_chosen = false;
  std::vector<VertexResidualChoice::Chosen> chosen;  // [vertex][trajectory]
  std::vector<std::int32_t> largest;                 // [trajectory], magnitude of a value
  double max = 0.0;                                  // magnitude of a wanted value
};

class SpatialCoder {
 public:
  SpatialCoder(const OrderedMesh& mesh, const SharedRig& rig, FittedFactors factors,
               const ValuePrediction& prediction, AdaptiveWeights* adaptive, std::size_t count,
               Rounding rounding, double step)
      : mesh_(mesh),
        rig_(rig),
        factors_(std::move(factors)),
        prediction_(prediction),
        adaptive_(adaptive),
        count_(count),
        rounding_(rounding),
        per_step_(kMaxLayerStep / step) {
    result_.residual.resize(mesh.num_vertices() * count);
    result_.values.resize(result_.residual.size());
  }

  SpatialValues code() {
    Pass all{{}, false, {}, std::vector<std::int32_t>(count_)};
    if (rounding_ == Rounding::kCheapest) all.choice.emplace(mesh_, count_);
    // Vertices of the base, or of a mesh without layers, are predicted from each other.
    code(mesh_.vertices_of_layers(0, 1), all);
    num_coded_ = mesh_.vertices_of_layers(0, 1).size();
    for (std::uint32_t layer = 1; layer < mesh_.num_layers(); ++layer) {
      code_layer(mesh_.vertices_of_layers(layer, layer + 1), all);
    }
    result_.largest = std::move(all.largest);
    result_.excess = all.max / kMaxSpatial;
    return std::move(result_);
  }

 private:
  // Shares passes of a few vertices among threads. Each pass continues from the rates before
  // them, so that few vertices are coded at a time while rates are not settled.
  void code_layer(std::span<const std::uint32_t> list, Pass& all) {
    constexpr std::size_t kPassVertices = 16;  // fixed: vertices
    constexpr std::size_t kMax = 256;          // fixed: vertices at a time, for as many threads
    // tuned (off: 1000000): Vertices at a time are at most one in this many of those that are
    // coded, so that rates are not much older than they would be on one thread.
    constexpr std::size_t kPart = 8;
    std::size_t together = 0;
    for (std::size_t first = 0; first < list.size(); first += together) {
      together = std::clamp(num_coded_ / kPart, kPassVertices, kMax);
      const auto some = list.subspan(first, std::min(together, list.size() - first));
      num_coded_ += some.size();
      std::vector<Pass> passes((some.size() + kPassVertices - 1) / kPassVertices);
      for_ranges(some.size(), kPassVertices, [&](std::size_t begin, std::size_t end) {
        Pass& pass = passes[begin / kPassVertices];
        pass = {all.choice, true, {}, all.largest, all.max};
        code(some.subspan(begin, end - begin), pass);
      });
      for (const Pass& pass : passes) {
        for (std::size_t i = 0; i < pass.chosen.size(); i += count_) {
          all.choice->follow(std::span(pass.chosen).subspan(i, count_));
        }
        all.max = std::max(all.max, pass.max);
        for (std::size_t l = 0; l < count_; ++l) {
          all.largest[l] = std::max(all.largest[l], pass.largest[l]);
        }
      }
    }
  }

  void code(std::span<const std::uint32_t> list, Pass& pass) {
    constexpr std::size_t kTogether = 16;  // fixed: vertices whose factors are found at a time
    std::optional<VertexAdaptation> adaptation;
    if (adaptive_ != nullptr) adaptation.emplace(*adaptive_);
    std::vector<std::int64_t> predicted(count_);
    for (std::size_t first = 0; first < list.size(); first += kTogether) {
      const auto some = list.subspan(first, std::min(kTogether, list.size() - first));
      const std::vector<double> factors = factors_.of(some);
      for (std::size_t i = 0; i < some.size(); ++i) {
        const bool adapts = adaptation && adaptation->start(some[i], result_.values);
        if (!adapts) prediction_.predict(some[i], result_.values, predicted);
        code(some[i], std::span(factors).subspan(i * count_, count_), predicted,
             adapts ? &*adaptation : nullptr, pass);
      }
    }
  }

  // Codes a vertex. predicted: used unless weights adapt.
  void code(std::uint32_t v, std::span<const double> factors,
            std::span<const std::int64_t> predicted, VertexAdaptation* adaptation, Pass& pass) {
    const int layer_step = rig_.layer_step[mesh_.layer_of(v)];
    if (pass.choice) pass.choice->start(v);
    for (std::size_t l = 0; l < count_; ++l) {
      const double wanted = factors[l] * per_step_;
      pass.max = std::max(pass.max, std::abs(wanted));
      const std::int64_t predicted_factor =
          adaptation != nullptr ? adaptation->predict() : predicted[l];
      const std::int32_t residual =
          rounded((wanted - static_cast<double>(predicted_factor)) / layer_step, pass);
      result_.residual[v * count_ + l] = residual;
      const std::int32_t value = clip_signed(
          kMaxSpatialBits, predicted_factor + factor_difference(residual, layer_step));
      if (adaptation != nullptr) adaptation->add(predicted_factor, value);
      result_.values[v * count_ + l] = value;
      pass.largest[l] = std::max(pass.largest[l], value < 0 ? ~value : value);
    }
  }

  // Returns the residual of the next trajectory. wanted: in steps.
  std::int32_t rounded(double wanted, Pass& pass) const {
    if (pass.choice) {
      const VertexResidualChoice::Chosen chosen = pass.choice->next(wanted);
      if (pass.keeps_chosen) pass.chosen.push_back(chosen);
      return chosen.residual;
    }
    return rounded_residual(wanted, rounding_ == Rounding::kNearest ? 0.5 : 0.5 - kDeadZone);
  }

  const OrderedMesh& mesh_;
  const SharedRig& rig_;
  FittedFactors factors_;
  const ValuePrediction& prediction_;
  AdaptiveWeights* adaptive_;
  std::size_t count_;
  Rounding rounding_;
  double per_step_;
  std::size_t num_coded_ = 0;  // number of vertices
  SpatialValues result_;
};

}  // namespace

SpatialValues code_spatial_values(const OrderedMesh& mesh, const SharedRig& rig,
                                  const SkinnedAnalysis& analysis,
                                  const TemporalValues& temporal,
                                  std::span<const std::size_t> group_end,
                                  const RigRecon* shared, Rounding rounding, double step) {
  const std::size_t count = temporal.size();
  std::optional<GeometryWeights> weights;
  if (rig.prediction == Prediction::kLayers) {
    const auto& rest = analysis.rest;
    weights.emplace(mesh, rig.weights,
                    std::array<std::span<const std::int32_t>, 3>{rest[0], rest[1], rest[2]});
  }
  const ValuePrediction prediction(mesh, false, weights ? &*weights : nullptr);
  std::optional<AdaptiveWeights> adaptive = start_weights(mesh, rig, analysis, weights, shared);
  if (adaptive) {
    const std::size_t before = shared != nullptr ? shared->factors()->num_components() : 0;
    adaptive->start(before, count, group_end);
  }
  return SpatialCoder(mesh, rig, {analysis.pc, temporal}, prediction,
                      adaptive ? &*adaptive : nullptr, count, rounding, step)
      .code();
}

}  // namespace rlpc
