#include "encoder/codec/sequence/choices/level_choice.h"

#include <algorithm>
#include <string>

namespace rlpc {

std::optional<InputError> choose_level(SequenceHeader& header, std::uint32_t longest,
                                       std::uint32_t least_level) {
  for (header.level_idc = least_level; header.level_idc <= kMaxLevelIdc; ++header.level_idc) {
    const Level& level = header.level();
    if (header.num_vertices <= level.max_vertices &&
        header.num_triangles <= level.max_triangles && longest <= level.max_gof_frames &&
        std::uint64_t{longest} * header.num_vertices <= level.max_gof_values) {
      return std::nullopt;
    }
  }
  return InputError{
      "no level allows " + std::to_string(header.num_vertices) + " vertices, " +
      std::to_string(header.num_triangles) + " triangles and GOFs of " +
      std::to_string(longest) +
      " frames (specification, Annex B); use a smaller 'gof_frames', or split the mesh"};
}

LevelNeeds::LevelNeeds(const EncodedSpan& encoded)
    : factors(encoded.num_factors),
      adaptive_values(encoded.adaptive_values),
      clusters(encoded.max_clusters),
      components(encoded.max_components) {
  for (const auto& unit : encoded.units) {
    unit_bytes = std::max<std::uint64_t>(unit_bytes, unit.payload.size());
  }
}

LevelNeeds::LevelNeeds(const EncoderSettings& settings)
    : clusters(std::max(settings.baseline.clusters, settings.main.bones)),
      components(settings.components) {}

LevelNeeds LevelNeeds::with_reserve() const {
  const Level& top = kLevels.back();
  // A value beyond all levels is kept, so that it is still rejected.
  const auto doubled = [](auto value, auto limit) {
    return std::max(value, std::min<decltype(value)>(2 * value, limit));
  };
  LevelNeeds needs = *this;
  needs.factors = doubled(factors, top.max_gof_factors);
  needs.unit_bytes = doubled(unit_bytes, top.max_unit_bytes);
  needs.adaptive_values = doubled(adaptive_values, top.max_adaptive_values);
  needs.clusters = doubled(clusters, top.max_clusters);
  needs.components = doubled(components, top.max_components);
  return needs;
}

std::optional<std::uint32_t> LevelNeeds::level_from(std::uint32_t level_idc) const {
  for (; level_idc <= kMaxLevelIdc; ++level_idc) {
    const Level& level = kLevels[level_idc - 1];
    if (factors <= level.max_gof_factors && unit_bytes <= level.max_unit_bytes &&
        adaptive_values <= level.max_adaptive_values && clusters <= level.max_clusters &&
        components <= level.max_components) {
      return level_idc;
    }
  }
  return std::nullopt;
}

std::optional<InputError> raise_level(std::uint32_t& level_idc, const LevelNeeds& needs,
                                      std::uint32_t num_frames) {
  const auto raised = needs.level_from(level_idc);
  if (!raised) {
    return InputError{"a GOF of " + std::to_string(num_frames) + " frames has " +
                      std::to_string(needs.factors) + " factors and units of " +
                      std::to_string(needs.unit_bytes) +
                      " bytes, more than any level allows (specification, Annex B); use a " +
                      "smaller 'gof_frames' or fewer 'components'"};
  }
  level_idc = *raised;
  return std::nullopt;
}

}  // namespace rlpc
