// Implements encode() of encoder/rlpc_encoder.h: runs searches and writes the smallest result.
#include "encoder/rlpc_encoder.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/codec/sequence/check_settings.h"
#include "encoder/codec/sequence/normals_target.h"
#include "encoder/codec/sequence/search_list.h"
#include "encoder/codec/sequence/sequence_encoder.h"
#include "encoder/codec/sequence/stream_verifier.h"
#include "encoder/complete_settings.h"

namespace rlpc {
namespace {

// A result, and the encoder that writes it.
struct Found {
  std::unique_ptr<SequenceEncoder> encoder;
  TargetResult result;

  std::uint64_t bytes() const { return encoder->bytes_of(result); }
};

// Whether a result is at least as good as another.
bool is_as_good(const Found& found, const Found& other, Target::Kind kind) {
  if (found.result.met != other.result.met) return found.result.met;
  // The lowest of rates that are too high is the closest.
  if (kind != Target::kBpvf || !found.result.met) return found.bytes() <= other.bytes();
  return found.result.trial.metrics.kg_error_percent <=
         other.result.trial.metrics.kg_error_percent;
}

// Runs one search after the other, and keeps the best result, the earliest in a tie.
InputResult<Found> best_of(FrameSource& source, const EncoderSettings& settings,
                           const std::vector<Search>& searches, const Progress& progress) {
  double all = 0.0;
  for (const Search& search : searches) all += search.duration;
  double before = 0.0;
  double part = 0.0;
  const Progress search_progress = [&](double done) { progress((before + part * done) / all); };
  const Progress& shown = searches.size() > 1 && progress ? search_progress : progress;
  std::optional<Found> best;
  for (const Search& search : searches) {
    before += part;
    part = search.duration;
    std::optional<Rival> rival;
    if (best && search.may_be_given_up) {
      rival.emplace(settings.target, best->result.trial, best->result.contested);
    }
    auto encoder =
        std::make_unique<SequenceEncoder>(source, search.settings, settings.profile, shown);
    auto result = encoder->find(rival ? &*rival : nullptr);
    if (!result) {
      // The search of a contained profile may fail alone, for example at the limits of a level.
      if (best && search.may_be_given_up) continue;
      return result.error();
    }
    if (result->given_up) continue;
    Found found{std::move(encoder), std::move(*result)};
    if (!best || !is_as_good(*best, found, settings.target.kind)) best = std::move(found);
  }
  return std::move(*best);
}

}  // namespace

InputResult<EncodeReport> encode(FrameSource& source, const EncoderSettings& settings,
                                 const ByteSink& sink, const Progress& progress) {
  EncoderSettings complete = complete_settings(settings, source.clips(), source.asset());
  if (auto error = check_settings(complete)) return *error;
  if (auto error = check_clips(complete.clips, source.num_frames())) return *error;
  if (auto error = check_attributes(complete.attributes, source.attributes())) return *error;
  if (complete.target.kind == Target::kMaxError) {
    const auto rounding = check_rounding(source, complete.target.value);
    if (!rounding) return rounding.error();
  }
  if (complete.target.max_normals > 0.0) {
    const auto kg = expected_kg(source, source.triangles(), complete.target);
    if (!kg) return kg.error();
    complete.target.expected_kg = *kg;
  }
  // The encoders refer to their settings.
  const std::vector<Search> searches =
      list_searches(complete, source.num_vertices(), source.num_frames());
  auto best = best_of(source, complete, searches, progress);
  if (!best) return best.error();
  InputResult<EncodeReport> report = best->encoder->write(std::move(best->result), sink);
  if (report && progress) progress(1.0);
  return report;
}

}  // namespace rlpc
