#include "encoder/codec/kinds/inter/closed_loop.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "common/codec/bits/crc32.h"
#include "common/codec/bits/fixed_point.h"
#include "common/codec/bits/int_math.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/inter/on_grid.h"
#include "encoder/codec/kinds/inter/point_units.h"
#include "encoder/codec/spans/residual_choice.h"

namespace rlpc {
namespace {

constexpr std::size_t kTogether = 32;  // fixed: vertices of a pass, some 10 us

// A vertex is predicted from its ring, and carries the errors of the ring. To correct them
// would cost bits for noise of others, and again in the next frame: a part of their mean error
// is left where the residual is expected to be small.

// tuned (off: 0): The part of the mean error of the ring that a vertex follows.
constexpr double kRingError = 0.85;
// tuned (off: 0): The decrease of that part with the squared residual expected, in steps.
constexpr double kLessRingError = 3.0;

}  // namespace

ClosedLoop::ClosedLoop(const OrderedMesh& mesh, const InterSettings& settings,
                       const SequenceHeader& header, std::uint32_t num_frames,
                       const UnitLimits& limits, ResidualRule rule)
    : mesh_(mesh),
      settings_(settings),
      limits_(limits),
      is_open_ended_(header.open_end_flag),
      rule_(rule),
      order_(settings.pattern, num_frames),
      recon_(mesh, settings, header.position_bits),
      writer_(mesh, settings, header.open_end_flag) {
  if (settings.num_patches > 0)
    patch_search_.emplace(mesh, settings, rule == ResidualRule::kNearest);
  if (rule == ResidualRule::kFollowRing) errors_.resize(3 * std::size_t{mesh.num_vertices()});
}

void ClosedLoop::set(std::uint32_t v, VertexMotion& motion, const Vec3i& position,
                     const double* original) {
  for (std::size_t c = 0; !errors_.empty() && c < 3; ++c) {
    errors_[3 * std::size_t{v} + c] =
        static_cast<double>(position[c]) / kPointUnits - original[c];
  }
  recon_.set(v, motion, position);
}

double ClosedLoop::feedback(std::uint32_t v, std::size_t coordinate,
                            std::uint32_t expected) const {
  const auto ring = mesh_.ring(v);
  if (errors_.empty() || ring.empty()) return 0.0;
  double sum = 0.0;
  for (const std::uint32_t u : ring) sum += errors_[3 * std::size_t{u} + coordinate];
  constexpr double kStep = 16.0;  // fixed: format
  const double steps = static_cast<double>(expected) / kStep;
  return kRingError / (1.0 + kLessRingError * steps * steps) * sum /
         static_cast<double>(ring.size());
}

// Vertices of the base depend on each other: they are predicted when they are coded.
void ClosedLoop::predict(Layer& layer, std::uint32_t index) {
  layer.vertices = mesh_.vertices_of_layers(index, index + 1);
  layer.motions.resize(layer.vertices.size());
  layer.expected.resize(layer.vertices.size());
  if (index == 0) return;
  for_ranges(layer.vertices.size(), kTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      recon_.predict(layer.vertices[i], layer.motions[i]);
    }
  });
}

void ClosedLoop::choose(Layer& layer, std::span<const double> xyz, InterFrame* coded) {
  InterContexts& contexts = writer_.contexts();
  const bool is_base = !layer.vertices.empty() && mesh_.layer_of(layer.vertices[0]) == 0;
  for (std::size_t i = 0; i < layer.vertices.size(); ++i) {
    const std::uint32_t v = layer.vertices[i];
    VertexMotion& motion = layer.motions[i];
    if (is_base) recon_.predict(v, motion);
    if (mode_of(patches_, settings_.patch_of_vertex, v) == PatchMode::kAlone) {
      layer.expected[i] = 0;
      set(v, motion, recon_.position(v, motion, {}), &xyz[3 * std::size_t{v}]);
      if (is_base) recon_.adapt(v, motion, true, 0);
      continue;
    }
    writer_.start(v);
    layer.expected[i] = contexts.frame_expected();
    const double step = static_cast<double>(recon_.step(v)) * kStepUnits;
    Vec3i residual{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = xyz[3 * std::size_t{v} + c];
      const double start = recon_.start_of(v, motion, c);
      if (rule_ == ResidualRule::kNearest) {
        residual[c] = rounded_residual((value * kPointUnits - start) / step, 0.5);
      } else if (settings_.exact_flag) {
        residual[c] = rounded_residual((on_grid(value) * kPointUnits - start) / step, 0.5);
      } else {
        const double wanted = value + feedback(v, c, layer.expected[i]);
        residual[c] = cheaper_residual(contexts.models(), contexts.expected(),
                                       (wanted * kPointUnits - start) / step);
      }
      writer_.write(residual[c]);
      if (coded != nullptr && residual[c] != 0) {
        coded->residual.set(3 * std::size_t{v} + c, residual[c]);
      }
    }
    if (coded != nullptr) coded->expected[v] = layer.expected[i];
    set(v, motion, recon_.position(v, motion, residual), &xyz[3 * std::size_t{v}]);
    if (is_base) recon_.adapt(v, motion, true, layer.expected[i]);
  }
}

void ClosedLoop::adapt(Layer& layer, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    recon_.adapt(layer.vertices[i], layer.motions[i], true, layer.expected[i]);
  }
}

std::vector<EncodedSpan::Unit> ClosedLoop::end_units(std::uint32_t number) {
  std::vector<EncodedSpan::Unit> units;
  const auto temporal_layer = [&](std::uint32_t place) {
    return settings_.pattern.temporal_layer(order_[place].depth);
  };
  const std::uint32_t layer = temporal_layer(number);
  const std::uint32_t next = number + 1;
  const bool is_last = next == order_.num_frames();
  const bool may_go_on =
      number > 0 && !is_last && (!is_open_ended_ || temporal_layer(next) == layer);
  if (may_go_on && writer_.unit_frames(layer) < limits_.frames &&
      writer_.unit_bytes(layer) < limits_.bytes) {
    return units;
  }
  // Units of lower temporal layers, which its frames may need, end before it.
  const std::uint32_t end = is_last ? settings_.pattern.temporal_layers : layer + 1;
  for (std::uint32_t t = 0; t < end; ++t) {
    if (writer_.unit_frames(t) == 0) continue;
    for (std::vector<std::uint8_t>& unit : writer_.finish_units(t)) {
      units.push_back({UnitType::kFrame, std::move(unit), t});
    }
  }
  return units;
}

std::size_t ClosedLoop::unit_bytes() const {
  std::size_t bytes = 0;
  for (std::uint32_t t = 0; t < settings_.pattern.temporal_layers; ++t) {
    bytes += writer_.unit_bytes(t);
  }
  return bytes;
}

std::vector<EncodedSpan::Unit> ClosedLoop::repeat(std::uint32_t distance,
                                                  std::span<std::int32_t> positions,
                                                  InterFrame* coded) {
  const std::uint32_t number = recon_.place();
  const FramePlace& place = order_[number];
  InterFrame frame;
  frame.repeated = order_[number - distance].frame;
  frame.layer_groups = static_cast<std::uint32_t>(settings_.layer_group_size.size());
  recon_.decode(place, order_.last_use(place.frame), frame);
  recon_.positions(positions);
  if (coded != nullptr) *coded = frame;
  writer_.repeat(place, distance);
  return end_units(number);
}

std::vector<EncodedSpan::Unit> ClosedLoop::code_in_order(const RestEncoding& first,
                                                         std::span<std::int32_t> positions,
                                                         InterFrame* coded) {
  const FramePlace& place = order_[0];
  recon_.start_frame(place, order_.last_use(place.frame));
  recon_.set_positions(first.values);
  recon_.end_frame();
  recon_.positions(positions);
  writer_.start_frame(0, place);
  writer_.start_group(0);
  writer_.write_positions(mesh_.rest_order(), first.residual, first.counterparts);
  writer_.end_group(settings_.frame_hash_flag ? crc32_of_positions(positions) : 0);
  if (coded == nullptr) return end_units(0);
  coded->layer_groups = static_cast<std::uint32_t>(settings_.layer_group_size.size());
  coded->residual = CompactResiduals(first.residual.size());
  coded->expected.assign(mesh_.num_vertices(), 0);
  for (std::size_t i = 0; i < first.residual.size(); ++i) {
    if (first.residual[i] != 0) coded->residual.set(i, first.residual[i]);
  }
  coded->residual.sort();
  coded->counterparts = first.counterparts;
  return end_units(0);
}

std::vector<EncodedSpan::Unit> ClosedLoop::code(std::span<const double> xyz,
                                                std::span<std::int32_t> positions,
                                                InterFrame* coded, std::uint32_t distance) {
  const std::uint32_t number = recon_.place();
  FramePlace place = order_[number];
  if (distance > 0) place = place.from(order_[number - distance].frame);
  const std::int32_t step_delta = number > 0 ? step_delta_ : 0;
  recon_.start_frame(place, order_.last_use(place.frame), step_delta);
  writer_.start_frame(number, place, step_delta);
  writer_.set_reference(distance);
  patches_.clear();
  if (patch_search_ && number > 0) {
    patches_ = patch_search_->choose(xyz, place.depth, writer_.patch_contexts(), recon_);
    recon_.move_patches(patches_);
    writer_.set_patches(patches_);
  }
  if (coded != nullptr) {
    coded->layer_groups = static_cast<std::uint32_t>(settings_.layer_group_size.size());
    coded->residual = CompactResiduals(3 * std::size_t{mesh_.num_vertices()});
    coded->expected.assign(mesh_.num_vertices(), 0);
    coded->patches = patches_;
    coded->step_delta = step_delta;
    if (distance > 0) coded->reference = place.first;
  }
  Layer* current = &layers_[0];
  Layer* before = &layers_[1];
  before->vertices = {};
  std::uint32_t index = 0;
  for (std::uint32_t j = 0; j < settings_.layer_group_size.size(); ++j) {
    writer_.start_group(j);
    for (const std::uint32_t end = index + settings_.layer_group_size[j]; index < end;
         ++index) {
      predict(*current, index);
      // The first pass chooses residuals, one after the other; the others adapt the layer
      // before. The base has adapted already.
      const std::size_t passes =
          index == 1 ? 0 : (before->vertices.size() + kTogether - 1) / kTogether;
      for_each(1 + passes, [&](std::size_t pass) {
        if (pass == 0) return choose(*current, xyz, coded);
        adapt(*before, (pass - 1) * kTogether,
              std::min(pass * kTogether, before->vertices.size()));
      });
      std::swap(current, before);
    }
    if (j + 1 == settings_.layer_group_size.size()) {
      if (index > 1) {
        for_ranges(before->vertices.size(), kTogether,
                   [&](std::size_t first, std::size_t end) { adapt(*before, first, end); });
      }
      recon_.end_frame();
      recon_.positions(positions);
      if (coded != nullptr) coded->residual.sort();
    }
    const std::uint32_t crc = settings_.frame_hash_flag ? crc32_of_positions(positions) : 0;
    writer_.end_group(crc);
  }
  return end_units(number);
}

}  // namespace rlpc
