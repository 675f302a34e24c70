#include "encoder/codec/attributes/encode_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/codec/attributes/recon/attribute_prediction.h"
#include "common/codec/attributes/sectors.h"
#include "common/codec/bits/crc32.h"
#include "common/codec/mesh/corners.h"
#include "encoder/codec/attributes/normal_choice.h"
#include "encoder/codec/attributes/quantise_attribute.h"
#include "encoder/codec/attributes/smoothing_search.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/write/write_attributes.h"

namespace rlpc {
namespace {

constexpr std::array kWithoutPositions{AttributePrediction::kMean,
                                       AttributePrediction::kParallelogram};

class AttributeEncoder {
 public:
  AttributeEncoder(const AttributeInput& input, const AttributeSettings& settings)
      : input_(input),
        settings_(settings),
        corner_map_(input.corner_map),
        num_vertices_(static_cast<std::uint32_t>(input.connectivity.input_vertex.size())),
        edge_mates_(find_edge_mates(num_vertices_, input.connectivity.triangles)),
        geometry_(input.connectivity.triangles, input.first_frame) {}

  EncodedAttributes encode();

 private:
  // A set of vertices or corners while it is coded.
  struct Draft {
    const SourceAttribute& source;
    QuantisedAttribute quantised;
    std::vector<std::uint32_t> value_of_corner;  // [decoded corner]
    std::vector<bool> seams;
    Sectors sectors;
    std::vector<std::uint32_t> value_of_sector;  // index of the value, or kNoSector
    // [sector], whether its value must not be the predicted one (NormalPlan); empty: none.
    std::vector<bool> must_turn;
  };

  CodedAttributeSet code(const SourceAttribute& source, AttributeReport& report);
  CodedAttributeSet code_triangles(const SourceAttribute& source, AttributeReport& report);
  Draft make_draft(const SourceAttribute& source) const;
  bool are_equal(const Draft& draft, std::uint32_t c, std::uint32_t d) const;
  void find_seams(Draft& draft) const;
  void find_sectors(Draft& draft) const;
  CodedAttributeSet code_normals(Draft draft, AttributeReport& report);
  CodedAttributeSet code_values(const Draft& draft, AttributeReport& report);
  CodedAttributeSet best_of(const Draft& draft,
                            std::span<const AttributePrediction> predictions) const;
  CodedAttributeSet code_with(const Draft& draft, AttributePrediction prediction,
                              const FaceView& faces) const;
  std::uint64_t bits_of(const CodedAttributeSet& set) const;
  void set_diagonals(const Smoothing& smoothing, CodedAttributeSet& set) const;

  const AttributeInput& input_;
  const AttributeSettings& settings_;
  std::span<const std::uint32_t> corner_map_;
  std::uint32_t num_vertices_;
  std::vector<std::uint32_t> edge_mates_;
  CornerGeometry geometry_;
};

double number_of(const AttributeHeader& header, std::uint32_t value, std::uint32_t c) {
  switch (header.scale) {
    case ValueScale::kNone:
      break;
    case ValueScale::kGrid:
      return (static_cast<double>(value) + header.origin[c]) * exact_exp2(header.log2_step);
    case ValueScale::kNormalised:
      return static_cast<double>(value) / static_cast<double>(header.max_value());
  }
  return static_cast<double>(value);
}

double largest_error(const SourceAttribute& source, const QuantisedAttribute& quantised) {
  if (quantised.header.kind != ValueKind::kIntegers) return 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < source.values.size(); ++i) {
    const auto c = static_cast<std::uint32_t>(i % source.num_components);
    double wanted = source.values[i];
    if (source.max_value != 0) wanted /= source.max_value;
    const double off = std::abs(number_of(quantised.header, quantised.values[i], c) - wanted);
    largest = std::max(largest, off);
  }
  return largest;
}

CodedAttributeSet AttributeEncoder::code_triangles(const SourceAttribute& source,
                                                   AttributeReport& report) {
  QuantisedAttribute quantised = quantise_attribute(source, settings_);
  CodedAttributeSet set{
      .header = quantised.header, .seams = {}, .diagonal_flags = {}, .residuals = {}};
  const std::uint32_t n = quantised.header.num_components;
  for (std::size_t t = 0; t < geometry_.triangles().size(); ++t) {
    const std::size_t first = std::size_t{corner_map_[3 * t] / 3} * n;
    for (std::size_t c = 0; c < n; ++c) set.residuals.push_back(quantised.values[first + c]);
  }
  report.values = geometry_.triangles().size();
  report.largest_error = largest_error(source, quantised);
  return set;
}

AttributeEncoder::Draft AttributeEncoder::make_draft(const SourceAttribute& source) const {
  Draft draft{.source = source,
              .quantised = quantise_attribute(source, settings_),
              .value_of_corner = {},
              .seams = {},
              .sectors = {},
              .value_of_sector = {},
              .must_turn = {}};
  draft.value_of_corner.resize(corner_map_.size());
  const auto triangles = geometry_.triangles();
  for (std::uint32_t c = 0; c < corner_map_.size(); ++c) {
    draft.value_of_corner[c] =
        source.domain == AttributeDomain::kCorner
            ? source.value_of_corner[corner_map_[c]]
            : input_.connectivity.input_vertex[vertex_of_corner(triangles, c)];
  }
  if (source.domain == AttributeDomain::kCorner) find_seams(draft);
  find_sectors(draft);
  return draft;
}

// Whether the values of two corners count as one.
bool AttributeEncoder::are_equal(const Draft& draft, std::uint32_t c, std::uint32_t d) const {
  const std::uint32_t a = draft.value_of_corner[c];
  const std::uint32_t b = draft.value_of_corner[d];
  if (a == b) return true;
  const std::uint32_t n = draft.quantised.header.num_components;
  const auto value = [&](std::uint32_t i) {
    return std::span(draft.quantised.values).subspan(std::size_t{i} * n, n);
  };
  if (std::ranges::equal(value(a), value(b))) return true;
  if (draft.source.kind != SourceAttribute::Kind::kNormals || settings_.exact) return false;
  // Rounding may have separated normals that are nearly the same.
  constexpr float kNear = 0.001F;  // fixed: some 0.06 degrees
  for (std::size_t k = 0; k < 3; ++k) {
    const float x = draft.source.values[3 * std::size_t{a} + k];
    const float y = draft.source.values[3 * std::size_t{b} + k];
    if (x - y > kNear || y - x > kNear) return false;
  }
  return true;
}

void AttributeEncoder::find_seams(Draft& draft) const {
  bool has_seams = false;
  draft.seams.assign(edge_mates_.size(), false);
  for (std::uint32_t c = 0; c < edge_mates_.size(); ++c) {
    const std::uint32_t mate = edge_mates_[c];
    if (mate >= c) continue;
    if (are_equal(draft, c, next_corner(mate)) && are_equal(draft, next_corner(c), mate)) {
      continue;
    }
    draft.seams[c] = draft.seams[mate] = true;
    has_seams = true;
  }
  if (has_seams) return;
  // Check whether each vertex has one value.
  std::vector<std::uint32_t> corner_of(num_vertices_, kNoCorner);
  for (std::uint32_t c = 0; c < edge_mates_.size(); ++c) {
    std::uint32_t& first = corner_of[vertex_of_corner(geometry_.triangles(), c)];
    if (first == kNoCorner) first = c;
    if (!are_equal(draft, first, c)) return;
  }
  draft.quantised.header.domain = AttributeDomain::kVertex;
  draft.seams.clear();
}

void AttributeEncoder::find_sectors(Draft& draft) const {
  const bool is_corner = draft.quantised.header.domain == AttributeDomain::kCorner;
  draft.sectors = is_corner ? sectors_of_corners(edge_mates_, draft.seams)
                            : sectors_of_vertices(num_vertices_, geometry_.triangles());
  draft.value_of_sector.assign(draft.sectors.count(), kNoSector);
  for (std::uint32_t x = 0; x < draft.sectors.count(); ++x) {
    const auto corners = draft.sectors.corners[x];
    if (!corners.empty()) {
      draft.value_of_sector[x] = draft.value_of_corner[corners[0]];
    } else if (draft.source.domain == AttributeDomain::kVertex) {
      draft.value_of_sector[x] = input_.connectivity.input_vertex[x];
    }
  }
}

std::uint64_t AttributeEncoder::bits_of(const CodedAttributeSet& set) const {
  return std::uint64_t{8} *
         write_attributes({0, {set}}, num_vertices_, geometry_.triangles()).size();
}

CodedAttributeSet AttributeEncoder::code_with(const Draft& draft,
                                              AttributePrediction prediction,
                                              const FaceView& faces) const {
  CodedAttributeSet set{.header = draft.quantised.header,
                        .seams = draft.seams,
                        .diagonal_flags = {},
                        .residuals = {}};
  set.header.prediction = prediction;
  const SectorOrder order(draft.sectors);
  AttributePredictor predictor(
      {set.header, edge_mates_, set.seams, draft.sectors, order, &geometry_, &faces});
  const std::uint32_t n = set.header.num_components;
  set.residuals.assign(std::size_t{n} * draft.sectors.count(), 0);
  for (const std::uint32_t x : order.order) {
    const AttributeValue expected = predictor.predict(x);
    AttributeValue value = expected;  // a sector without a value
    const std::uint32_t i = draft.value_of_sector[x];
    for (std::size_t c = 0; c < n && i != kNoSector; ++c) {
      value[c] = draft.quantised.values[std::size_t{i} * n + c];
    }
    if (!draft.must_turn.empty() && draft.must_turn[x] && value == expected) {
      value[0] += value[0] > 0 ? -1 : 1;  // the next point
    }
    for (std::size_t c = 0; c < n && i != kNoSector; ++c) {
      set.residuals[std::size_t{x} * n + c] =
          static_cast<std::uint32_t>(value[c] - expected[c]);
    }
    predictor.learn(x, value);
  }
  return set;
}

CodedAttributeSet AttributeEncoder::best_of(
    const Draft& draft, std::span<const AttributePrediction> predictions) const {
  std::optional<CodedAttributeSet> best;
  std::uint64_t best_bits = 0;
  for (const AttributePrediction prediction : predictions) {
    CodedAttributeSet set = code_with(draft, prediction, {});
    const std::uint64_t bits = bits_of(set);
    if (best && bits >= best_bits) continue;
    best = std::move(set);
    best_bits = bits;
  }
  return *best;
}

CodedAttributeSet AttributeEncoder::code_values(const Draft& draft, AttributeReport& report) {
  report.values = draft.sectors.count();
  report.largest_error = largest_error(draft.source, draft.quantised);
  std::vector<AttributePrediction> predictions(kWithoutPositions.begin(),
                                               kWithoutPositions.end());
  const AttributeHeader& header = draft.quantised.header;
  if (settings_.from_positions && header.kind == ValueKind::kIntegers &&
      header.num_components == 2) {
    predictions.push_back(AttributePrediction::kPositions);
  }
  return best_of(draft, predictions);
}

// Sets the diagonals of a smoothing as flags: those that are not likely in the first frame, or
// all.
void AttributeEncoder::set_diagonals(const Smoothing& smoothing, CodedAttributeSet& set) const {
  set.header.weight = smoothing.weight;
  std::vector<bool> unlikely(edge_mates_.size(), false);
  std::size_t num_diagonals = 0;
  std::size_t num_unlikely = 0;
  for (std::uint32_t c = 0; c < edge_mates_.size(); ++c) {
    const std::uint32_t mate = edge_mates_[c];
    if (mate >= c || (!set.seams.empty() && set.seams[c])) continue;
    const bool is_diagonal = smoothing.is_diagonal[c];
    unlikely[c] = unlikely[mate] = is_diagonal != geometry_.is_likely_diagonal(c, mate);
    if (is_diagonal) ++num_diagonals;
    if (unlikely[c]) ++num_unlikely;
  }
  if (num_diagonals == 0) return;
  const bool is_likely = settings_.from_positions && num_unlikely < num_diagonals;
  set.header.diagonals = is_likely ? Diagonals::kLikely : Diagonals::kFlagged;
  if (is_likely) {
    set.diagonal_flags = std::move(unlikely);
  } else {
    set.diagonal_flags = smoothing.is_diagonal;
  }
}

CodedAttributeSet AttributeEncoder::code_normals(Draft draft, AttributeReport& report) {
  const std::uint32_t bits = draft.quantised.header.value_bits;
  NormalPlan plan =
      plan_normals({input_.source, draft.source.values, geometry_.triangles(), num_vertices_,
                    corner_map_, edge_mates_, draft.seams, draft.sectors, draft.value_of_sector,
                    input_.first_frame, input_.later_frames, input_.is_animated, bits},
                   settings_);
  report.values = draft.sectors.count();
  report.is_normal = true;
  report.is_smoothing = plan.is_smoothing;
  report.rms_error = plan.rms_error;
  for (const NormalError& error : plan.errors) {
    report.largest_error = std::max(report.largest_error, error.largest);
  }
  report.normal_errors = std::move(plan.errors);
  report.num_following = static_cast<std::uint64_t>(std::ranges::count(plan.follows, true));
  CodedAttributeSet set{
      .header = draft.quantised.header, .seams = {}, .diagonal_flags = {}, .residuals = {}};
  set.seams = draft.seams;
  set_diagonals(plan.smoothing, set);
  if (report.is_smoothing) {
    set.header.kind = ValueKind::kSmoothing;
    set.header.num_components = 0;
    set.header.value_bits = 32;
    return set;
  }
  draft.quantised.values.clear();
  for (std::uint32_t x = 0; x < draft.sectors.count(); ++x) {
    draft.quantised.values.insert(draft.quantised.values.end(), plan.points[x].begin(),
                                  plan.points[x].end());
    // Predicted normals are those that follow.
    draft.value_of_sector[x] = settings_.from_positions && plan.follows[x] ? kNoSector : x;
  }
  if (!settings_.from_positions) return best_of(draft, kWithoutPositions);
  draft.must_turn = std::move(plan.must_turn);
  draft.quantised.header = set.header;
  const Faces faces(geometry_, set.header.diagonals, edge_mates_, set.seams, set.diagonal_flags,
                    true);
  CodedAttributeSet coded = code_with(draft, AttributePrediction::kPositions, faces.view());
  coded.diagonal_flags = std::move(set.diagonal_flags);
  return coded;
}

CodedAttributeSet AttributeEncoder::code(const SourceAttribute& source,
                                         AttributeReport& report) {
  if (source.domain == AttributeDomain::kTriangle) return code_triangles(source, report);
  Draft draft = make_draft(source);
  if (draft.quantised.header.kind == ValueKind::kUnitVectors) {
    return code_normals(std::move(draft), report);
  }
  return code_values(draft, report);
}

EncodedAttributes AttributeEncoder::encode() {
  EncodedAttributes encoded;
  CodedAttributes coded;
  std::vector<const SourceAttribute*> sources;
  for (const SourceAttribute& source : input_.source.sets) sources.push_back(&source);
  // Sets of triangles first: seams often lie where these change.
  std::stable_partition(sources.begin(), sources.end(), [](const SourceAttribute* source) {
    return source->domain == AttributeDomain::kTriangle;
  });
  for (const SourceAttribute* source : sources) {
    AttributeReport& report = encoded.sets.emplace_back();
    report.name = source->name;
    coded.sets.push_back(code(*source, report));
    report.bits = bits_of(coded.sets.back());
  }
  if (coded.uses_positions()) coded.first_frame_crc = crc32_of_positions(input_.first_frame);
  encoded.payload = write_attributes(coded, num_vertices_, geometry_.triangles());
  return encoded;
}

}  // namespace

EncodedAttributes encode_attributes(const AttributeInput& input,
                                    const AttributeSettings& settings) {
  return AttributeEncoder(input, settings).encode();
}

}  // namespace rlpc
