// Places bones in the rest shape, one joint after the other.
#pragma once

#include "encoder/codec/kinds/skinned/recover/bone_chains.h"
#include "encoder/codec/kinds/skinned/recover/bone_space.h"
#include "encoder/codec/kinds/skinned/recover/placed_bones.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"

namespace rlpc {

// The first frame may be far from the rest shape, and steps that move all bones from there end
// in local minima. The vertices between two bones tell how the rest shape of one continues that
// of the other, with six unknowns, for which several starts can be tried: bones that fit
// exactly are joined and from then on move together, those with most vertices between them
// first.
//
//   space  has the anchored bones; the others are hung from those to which they are joined, or
//          from their parents in the chains. All bones that chains.order lists have a place
//          then
//   bones  those of the space; moved
void place_bones(const Trajectories& trajectories, const BoneChains& chains, BoneSpace& space,
                 PlacedBones& bones);

}  // namespace rlpc
