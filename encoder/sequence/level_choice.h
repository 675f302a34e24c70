// The level of a sequence (Annex B): the lowest one that allows its mesh and its GOFs.
#pragma once

#include <cstdint>
#include <optional>

#include "common/syntax/sequence_header.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// Sets level_idc to the lowest level, not below least_level, that allows the mesh of the
// header and GOFs of `longest` frames. Error: there is none.
std::optional<InputError> choose_level(SequenceHeader& header, std::uint32_t longest,
                                       std::uint32_t least_level = 1);

// What coded GOFs need that choose_level cannot foresee.
struct LevelNeeds {
  std::uint64_t factors = 0;
  std::uint64_t unit_bytes = 0;  // of the largest unit
  std::uint32_t clusters = 0;
  std::uint32_t components = 0;

  explicit LevelNeeds(const EncodedGof& encoded);
  // Of the clusters, bones and components that are asked for; a GOF can have fewer.
  explicit LevelNeeds(const EncoderSettings& settings);
  // Twice as much of everything, where some level has it.
  LevelNeeds with_reserve() const;
  // The lowest level from level_idc on that has all of it; none if there is no such level.
  std::optional<std::uint32_t> level_from(std::uint32_t level_idc) const;
};

// Raises level_idc to a level that has what a GOF of num_frames needs. Error: there is none.
std::optional<InputError> raise_level(std::uint32_t& level_idc, const LevelNeeds& needs,
                                      std::uint32_t num_frames);

}  // namespace rlpc
