#include "encoder/codec/sequence/search_list.h"

#include <algorithm>

#include "encoder/codec/sequence/memory_need.h"

namespace rlpc {
namespace {

// Returns the searches with the profile of the settings. With preset slow, one GOF may also be
// worse than several.
std::vector<EncoderSettings> searches_of_profile(const EncoderSettings& settings,
                                                 std::uint32_t num_vertices,
                                                 std::uint32_t num_frames) {
  std::vector<EncoderSettings> searches{settings};
  if (settings.preset != Preset::kSlow || !settings.target.has_search()) return searches;
  if (settings.gof_frames >= num_frames && num_frames > 1) {
    EncoderSettings& several = searches.emplace_back(settings);
    several.gof_frames = 0;
    several.gof_frames =
        std::min(longest_gof(several, num_vertices), num_frames - num_frames / 2);
  }
  std::vector<EncoderSettings> usual = searches;
  for (EncoderSettings& search : usual) search.preset = Preset::kMedium;
  searches.insert(searches.end(), usual.begin(), usual.end());
  return searches;
}

// Whether those of contained profiles are searched: all tools are left to the encoder, and it
// takes little time. On long sequences, kinds are compared by samples of the mesh.
bool searches_contained(const EncoderSettings& settings, std::uint64_t num_positions) {
  constexpr std::uint64_t kMaxPositions = std::uint64_t{1} << 18;  // fixed: a second or two
  if (num_positions > kMaxPositions) return false;
  return settings.target.has_search() && !settings.gof_kind && settings.components == 0 &&
         settings.main == MainTools{} && settings.inter == InterTools{};
}

}  // namespace

std::vector<Search> list_searches(const EncoderSettings& settings, std::uint32_t num_vertices,
                                  std::uint32_t num_frames) {
  // fixed: relative time of usual searches, about; most others are not begun.
  constexpr double kSlowPart = 3.0;
  std::vector<Search> list;
  EncoderSettings profile_settings = settings;
  const auto add = [&] {
    const bool is_own = profile_settings.profile == settings.profile;
    for (const EncoderSettings& search :
         searches_of_profile(profile_settings, num_vertices, num_frames)) {
      const double part = search.preset == Preset::kSlow ? kSlowPart : 1.0;
      list.push_back({search, !is_own, is_own ? part : 0.0});
    }
  };
  add();
  const bool is_free = searches_contained(settings, std::uint64_t{num_vertices} * num_frames);
  while (is_free && profile_settings.profile != Profile::kBaseline) {
    profile_settings.profile =
        profile_settings.profile == Profile::kHigh ? Profile::kMain : Profile::kBaseline;
    add();
  }
  return list;
}

}  // namespace rlpc
