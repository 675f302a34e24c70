// The choice of clusters for one GOF, by Lagrangian cost on coded bits.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "encoder/gof_encoder.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// One encoding of a GOF, whole.
struct GofTrial {
  Gof gof;
  std::vector<std::uint8_t> payload;
  double squared_error = 0.0;  // grid steps squared, over all coordinates and frames
};

GofTrial try_gof(const EncodingContext& context, const GofFrames& frames,
                 const GofAnalysis& analysis, const CodingSettings& coding);

// Encodes one GOF at varying steps. Analyses are kept: those for nearby steps serve again.
class GofSearch {
 public:
  // context and frames are kept by reference.
  GofSearch(const EncodingContext& context, const GofFrames& frames, std::uint32_t first_frame,
            const EncoderSettings& settings);

  // The GOF at the settings' own quantisers (qu, qc, qdelta) or, without them, with the
  // quantiser step that is given, in grid steps.
  GofTrial encode(double step);

 private:
  struct Choice {
    std::uint32_t clusters;
    bool world;
  };
  struct Cached {
    int scale;  // of the step that it was made for
    Choice choice;
    GofAnalysis analysis;
  };

  AnalysisSettings analysis_settings(double step, const Choice& choice) const;
  CodingSettings coding_settings(double step) const;
  GofAnalysis analyse(double step, const Choice& choice);
  double cost(double step, const Choice& choice);
  Choice choose(double step);
  std::uint32_t choose_count(double step, bool world);

  const EncodingContext& context_;
  const GofFrames& frames_;
  std::uint32_t first_frame_;
  const EncoderSettings& settings_;
  MotionClusters motion_;
  std::optional<Choice> choice_;
  std::optional<Cached> cached_;
};

}  // namespace rlpc
