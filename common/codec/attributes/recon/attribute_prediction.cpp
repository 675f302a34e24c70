#include "common/codec/attributes/recon/attribute_prediction.h"

#include <algorithm>

namespace rlpc {
namespace {

constexpr std::size_t kConformal = 0;
constexpr std::size_t kUnfolded = 1;
constexpr std::size_t kParallelogram = 2;
constexpr int kUvFractionBits = 4;

// Doubled( a, b, c ): twice the area, positive for a left turn.
std::int64_t doubled_area(const AttributeValue& a, const AttributeValue& b,
                          const AttributeValue& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

}  // namespace

AttributePredictor::AttributePredictor(const AttributeMesh& mesh)
    : mesh_(mesh),
      values_(mesh.sectors.count()),
      is_known_(mesh.sectors.count(), false),
      squared_error_{1024, 1024, 1024} {}

AttributeValue AttributePredictor::predict(std::uint32_t x) {
  const AttributeHeader& header = mesh_.header;
  uv_predictions_.clear();
  if (header.has_faces()) {
    const Vec3l normal =
        sector_normal(*mesh_.geometry, *mesh_.faces, header.weight, mesh_.sectors.corners[x]);
    const OctahedronPoint point = octahedral_of(normal, header.value_bits);
    return {point[0], point[1]};
  }
  if (!mesh_.order.triangles[x].empty()) {
    return header.predicts_texture_coordinates() ? texture_coordinates(x) : from_neighbours(x);
  }
  if (mesh_.order.neighbour[x] != kNoSector) return value(mesh_.order.neighbour[x]);
  AttributeValue middle;
  middle.fill((std::int64_t{1} << header.value_bits) >> 1);
  return middle;
}

void AttributePredictor::learn(std::uint32_t x, const AttributeValue& value) {
  values_[x] = value;
  if (mesh_.header.predicts_texture_coordinates()) learn_uv(x, value);
  is_known_[x] = true;
}

AttributeValue AttributePredictor::value_of(const AttributeValue& prediction,
                                            std::span<const std::uint32_t> residual) const {
  AttributeValue value{};
  for (std::size_t c = 0; c < residual.size(); ++c) {
    if (mesh_.header.kind == ValueKind::kFloats) {
      value[c] = static_cast<std::uint32_t>(prediction[c]) + residual[c];
      value[c] &= 0xFFFFFFFF;
    } else {
      value[c] = clip3(0, mesh_.header.max_value(),
                       prediction[c] + static_cast<std::int32_t>(residual[c]));
    }
  }
  return value;
}

// CornerAcross( ), if its value is known
std::optional<std::uint32_t> AttributePredictor::corner_across(std::uint32_t e) const {
  const std::uint32_t edge = next_corner(e);
  if (mesh_.edge_mates[edge] == kNoCorner) return std::nullopt;
  if (!mesh_.seams.empty() && mesh_.seams[edge]) return std::nullopt;
  const std::uint32_t c = previous_corner(mesh_.edge_mates[edge]);
  if (!is_known_[sector_of(c)]) return std::nullopt;
  return c;
}

// F.7.2 PredictFromNeighbours( )
AttributeValue AttributePredictor::from_neighbours(std::uint32_t x) const {
  AttributeValue prediction{};
  const auto triangles = mesh_.order.triangles[x];
  const bool is_parallelogram = mesh_.header.prediction == AttributePrediction::kParallelogram;
  for (const std::uint32_t e : triangles) {
    const AttributeValue& a = value(sector_of(next_corner(e)));
    const AttributeValue& b = value(sector_of(previous_corner(e)));
    const auto across = is_parallelogram ? corner_across(e) : std::nullopt;
    for (std::size_t c = 0; c < mesh_.header.num_components; ++c) {
      prediction[c] += across ? 2 * (a[c] + b[c] - value(sector_of(*across))[c]) : a[c] + b[c];
    }
  }
  const auto count = static_cast<std::int64_t>(triangles.size());
  for (std::int64_t& p : prediction) {
    p = clip3(0, mesh_.header.max_value(), div_round(p, 2 * count));
  }
  return prediction;
}

// F.7.3 PredictTextureCoordinates( )
AttributeValue AttributePredictor::texture_coordinates(std::uint32_t x) {
  for (const std::uint32_t e : mesh_.order.triangles[x]) add_uv_predictions(e);
  std::int64_t total = 0;
  Point sums{};
  for (const UvPrediction& p : uv_predictions_) {
    const std::int64_t error = squared_error_[p.kind] + 1;
    const std::int64_t weight = (std::int64_t{1} << 32) / (error * error) + 1;
    total += weight;
    for (std::size_t c = 0; c < 2; ++c) sums[c] += weight * p.point[c];
  }
  AttributeValue prediction{};
  for (std::size_t c = 0; c < 2; ++c) {
    prediction[c] =
        clip3(0, mesh_.header.max_value(), round2(div_round(sums[c], total), kUvFractionBits));
  }
  return prediction;
}

void AttributePredictor::add_uv_prediction(std::size_t kind, std::int64_t u, std::int64_t v) {
  constexpr std::int64_t kMax = std::int64_t{1} << 24;
  uv_predictions_.push_back({kind, {clip3(-kMax, kMax, u), clip3(-kMax, kMax, v)}});
}

void AttributePredictor::add_uv_predictions(std::uint32_t e) {
  constexpr std::int64_t kOne = std::int64_t{1} << kCornerFractionBits;
  const std::uint32_t from = next_corner(e);
  const std::uint32_t to = previous_corner(e);
  const AttributeValue& a = value(sector_of(from));
  const AttributeValue& b = value(sector_of(to));
  const auto across = corner_across(e);
  const auto sides = mesh_.geometry->differences<3>(from, {to, e, across.value_or(e)});
  const Vec3l& edge = sides[0];
  const std::int64_t length = dot(edge, edge);
  if (length == 0) {
    add_uv_prediction(kConformal, 8 * (a[0] + b[0]), 8 * (a[1] + b[1]));
    return;
  }
  const std::int64_t place = place_along(sides[1], edge, length);
  const std::int64_t height = height_above(sides[1], edge, length);
  const std::int64_t h = clip3(0, 64 * kOne, div_round(height * kOne, length));
  const Point d{b[0] - a[0], b[1] - a[1]};
  const Point foot{kOne * a[0] + place * d[0], kOne * a[1] + place * d[1]};
  std::int64_t side = turn_ < 0 ? -1 : 1;
  if (across) side = doubled_area(a, b, value(sector_of(*across))) > 0 ? -1 : 1;
  constexpr int kToUv = kCornerFractionBits - kUvFractionBits;
  add_uv_prediction(kConformal, round2(foot[0] - side * h * d[1], kToUv),
                    round2(foot[1] + side * h * d[0], kToUv));
  if (!across) return;
  const AttributeValue& o = value(sector_of(*across));
  add_uv_prediction(kParallelogram, 16 * (a[0] + b[0] - o[0]), 16 * (a[1] + b[1] - o[1]));
  const std::int64_t place_across = place_along(sides[2], edge, length);
  const std::int64_t height_across = height_above(sides[2], edge, length);
  if (height_across == 0) return;
  const std::int64_t ratio = clip3(0, 8 * kOne, div_round(height * kOne, height_across));
  Point unfolded{};
  for (std::size_t c = 0; c < 2; ++c) {
    const std::int64_t off = (o[c] - a[c]) * kOne - place_across * d[c];
    unfolded[c] =
        round2(kOne * foot[c] - ratio * off, 2 * kCornerFractionBits - kUvFractionBits);
  }
  add_uv_prediction(kUnfolded, unfolded[0], unfolded[1]);
}

// F.7.3 LearnFromValue( )
void AttributePredictor::learn_uv(std::uint32_t x, const AttributeValue& value) {
  for (const UvPrediction& p : uv_predictions_) {
    std::int64_t squared = 0;
    for (std::size_t c = 0; c < 2; ++c) {
      const std::int64_t error = value[c] - round2(p.point[c], kUvFractionBits);
      const std::int64_t clipped = clip3(-255, 255, error);
      squared += 16 * clipped * clipped;
    }
    std::int64_t& mean = squared_error_[p.kind];
    mean += squared >= mean ? (squared - mean) >> 5 : -((mean - squared) >> 5);
  }
  for (const std::uint32_t e : mesh_.order.triangles[x]) {
    const std::int64_t turn = doubled_area(this->value(sector_of(next_corner(e))),
                                           this->value(sector_of(previous_corner(e))), value);
    if (turn > 0) ++turn_;
    if (turn < 0) --turn_;
  }
}

}  // namespace rlpc
