#include "common/codec/kinds/cluster/recon/seed_tracks.h"

#include "common/codec/bits/int_math.h"
#include "common/memory/owned.h"

namespace rlpc {

// 8.2.1 Prediction of a seed position
std::int64_t predict_seed(const ClusterGof& gof, const Vector<Track>& tracks, std::size_t index,
                          std::uint32_t f, std::size_t c) {
  const std::size_t anchor = gof.seed_tracks[index].anchor;
  const auto series_of = [&](std::size_t track) {
    return [&tracks, track, c](std::uint32_t g) { return std::int64_t{tracks[track][g][c]}; };
  };
  if (f == 0) {
    if (anchor != index) return tracks[anchor][0][c];
    return index > 0 ? std::int64_t{tracks[index - 1][0][c]} : 0;
  }
  std::int64_t prediction = predict_series(series_of(index), f, gof.seed_predictor);
  if (gof.seed_coupling_flag && anchor != index) {
    prediction +=
        tracks[anchor][f][c] - predict_series(series_of(anchor), f, gof.seed_predictor);
  }
  return prediction;
}

// 8.2 Seed track process
Vector<Track> recon_seed_tracks(const ClusterGof& gof, int position_bits) {
  Vector<Track> tracks(gof.seed_tracks.size(), Track(gof.num_frames));
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::uint32_t f = 0; f < gof.num_frames; ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::int64_t residual = gof.seed_tracks[i].residual[f][c];
        tracks[i][f][c] = clip_signed(
            position_bits, predict_seed(gof, tracks, i, f, c) + residual * gof.seed_step);
      }
    }
  }
  return tracks;
}

}  // namespace rlpc
