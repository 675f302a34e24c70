// Kinds of GOF that callers can choose.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "common/codec/syntax/gof_header.h"

namespace rlpc {

// Whether the encoder can be told to use a kind alone. It shares rigs between skinned GOFs
// where that costs less.
constexpr bool can_be_chosen(GofKind kind) { return !properties_of(kind).has_rig; }

inline constexpr std::size_t kNumKindChoices = static_cast<std::size_t>(
    std::count_if(kGofKinds.begin(), kGofKinds.end(),
                  [](const KindProperties& k) { return can_be_chosen(k.kind); }));

// In the order of their codes; rlpc_gof_kind of the C interface counts them from 1.
inline constexpr std::array<GofKind, kNumKindChoices> kKindChoices = [] {
  std::array<GofKind, kNumKindChoices> choices{};
  std::size_t count = 0;
  for (const KindProperties& k : kGofKinds) {
    if (can_be_chosen(k.kind)) choices[count++] = k.kind;
  }
  return choices;
}();

}  // namespace rlpc
