// 8.2 Seed track process: positions of the seed vertices in all frames of a GOF.
#pragma once

#include "common/codec/components/series_predictor.h"
#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

using Track = Vector<Vec3i>;  // [num_gof_frames], grid units

// 8.2.1 Prediction of a seed position: one coordinate of track `index` in frame f, from
// previous frames, from the anchor track and, in frame 0, from the previous track. `tracks`
// holds the positions known so far.
std::int64_t predict_seed(const ClusterGof& gof, const Vector<Track>& tracks, std::size_t index,
                          std::uint32_t f, std::size_t c);

// Reconstructs all tracks. Cannot fail: positions are clipped to position_bits.
Vector<Track> recon_seed_tracks(const ClusterGof& gof, int position_bits);

}  // namespace rlpc
