// Chooses the level of a sequence (Annex B): the lowest that allows its mesh and its GOFs.
#pragma once

#include <cstdint>
#include <optional>

#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Sets level_idc to the lowest level, not below least_level, that allows the mesh of the header
// and GOFs of `longest` frames. Error: no level does.
std::optional<InputError> choose_level(SequenceHeader& header, std::uint32_t longest,
                                       std::uint32_t least_level = 1);

// Level requirements that are known only once GOFs are coded.
struct LevelNeeds {
  std::uint64_t factors = 0;
  std::uint64_t unit_bytes = 0;  // size of the largest unit
  std::uint64_t adaptive_values = 0;
  std::uint32_t clusters = 0;
  std::uint32_t components = 0;

  explicit LevelNeeds(const EncodedSpan& encoded);
  // Takes the clusters, bones and components that are set explicitly; a GOF may have fewer.
  explicit LevelNeeds(const EncoderSettings& settings);
  // Returns each requirement doubled, up to the limits of the highest level.
  LevelNeeds with_reserve() const;
  // Returns the lowest level, from level_idc on, that meets all requirements; none if no level
  // does.
  std::optional<std::uint32_t> level_from(std::uint32_t level_idc) const;
};

// Raises level_idc, if necessary, to the lowest level that meets the requirements of a GOF of
// num_frames frames. Error: no level does.
std::optional<InputError> raise_level(std::uint32_t& level_idc, const LevelNeeds& needs,
                                      std::uint32_t num_frames);

}  // namespace rlpc
