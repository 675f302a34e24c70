#include "encoder/codec/kinds/inter/first_frame.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/bits/fixed_point.h"
#include "common/codec/bits/int_math.h"
#include "encoder/codec/kinds/inter/closed_loop.h"
#include "encoder/codec/kinds/inter/on_grid.h"
#include "encoder/codec/kinds/inter/point_units.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

std::vector<std::int32_t> points(std::span<const double> xyz, int position_bits, bool exact) {
  const double limit = exact_exp2(rest_bits(position_bits) - 1);
  std::vector<std::int32_t> points;
  points.reserve(xyz.size());
  for (const double x : xyz) {
    const double point = exact ? kPointUnits * on_grid(x) : kPointUnits * x;
    points.push_back(
        static_cast<std::int32_t>(round_to_int(std::clamp(point, -limit, limit - 1.0))));
  }
  return points;
}

// Returns D + lambda R, in squared grid units; only bits if positions are exact.
double cost_of(std::span<const double> xyz, std::span<const std::int32_t> positions,
               const InterSettings& settings, double bits) {
  if (settings.exact_flag) return bits;
  double square = 0.0;
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const double d = positions[i] - xyz[i];
    square += d * d;
  }
  return square + lambda(settings.first_step / kPointUnits) * bits;
}

double cost_in_layers(const OrderedMesh& mesh, const InterSettings& settings,
                      const SequenceHeader& header, std::span<const double> xyz) {
  InterSettings alone = settings;
  alone.rest = {};
  alone.num_patches = 0;
  ClosedLoop coding(mesh, alone, header, 1);
  std::vector<std::int32_t> positions(xyz.size());
  const auto units = coding.code(xyz, positions);
  return cost_of(xyz, positions, settings, bits_of(units));
}

}  // namespace

std::shared_ptr<const RestEncoding> code_first_frame(const OrderedMesh& mesh,
                                                     const InterSettings& frame_settings,
                                                     const SequenceHeader& header,
                                                     const EncoderSettings& settings,
                                                     std::span<const double> xyz) {
  const RestTools tools = settings.inter.rest.value_or(RestTools::kCounterparts);
  if (tools == RestTools::kPrediction) return {};
  const bool exact = frame_settings.exact_flag;
  const RestChoices choices{.few = settings.preset == Preset::kFast,
                            .counterparts = tools == RestTools::kCounterparts,
                            .exact = exact};
  RestEncoding coded =
      code_rest_in_order(mesh, points(xyz, header.position_bits, exact),
                         frame_settings.first_step, header.position_bits, choices);
  std::vector<std::int32_t> positions(coded.values.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] =
        clip_signed(header.position_bits, round2(coded.values[i], kPointFractionBits));
  }
  const double cost = cost_of(xyz, positions, frame_settings, coded.bits);
  if (!(cost < cost_in_layers(mesh, frame_settings, header, xyz))) return {};
  return std::make_shared<const RestEncoding>(std::move(coded));
}

}  // namespace rlpc
