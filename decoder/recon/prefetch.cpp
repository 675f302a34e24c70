#include "decoder/recon/prefetch.h"

#include <algorithm>
#include <utility>

#include "decoder/recon/async.h"

namespace rlpc {

PreparedGof prepare(AccessUnit access_unit, const StreamContext& context,
                    std::uint32_t threads) {
  auto recon = make_recon(access_unit, context, threads > 1 ? on_threads(threads) : in_order);
  return {access_unit.header(), std::move(access_unit.hash), access_unit.is_cut,
          std::move(recon)};
}

std::optional<Prefetch::Found> Prefetch::take(std::uint64_t offset, std::uint32_t first_frame) {
  std::optional<Found> found;
  if (!gofs_.empty()) {
    Ahead& ahead = gofs_.front();
    if (ahead.coded.units.front().header.offset == offset &&
        ahead.coded.gof.first_frame == first_frame && ahead.done.get() && ahead.gof) {
      found = Found{std::move(*ahead.gof), ahead.coded.end()};
      gofs_.pop_front();
    }
  }
  if (!found) gofs_.clear();
  return found;
}

void Prefetch::fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count) {
  while (!gofs_.empty() && gofs_.front().coded.gof.first_frame != first_frame)
    gofs_.pop_front();
  if (!gofs_.empty()) {
    offset = gofs_.back().coded.end();
    first_frame = gofs_.back().coded.end_frame();
  }
  const std::size_t before = gofs_.size();
  while (gofs_.size() < count && first_frame < stream_.header().num_frames) {
    auto coded = collect(offset, first_frame);
    if (!coded) break;
    offset = coded->end();
    first_frame = coded->end_frame();
    gofs_.push_back({std::move(*coded), std::nullopt, {}});
  }
  // Where there are fewer GOFs than threads, several threads share one.
  const auto num_gofs = std::max(1U, static_cast<std::uint32_t>(gofs_.size()));
  const std::uint32_t each = std::max(1U, threads_ / num_gofs);
  for (std::size_t i = before; i < gofs_.size(); ++i) {
    Ahead& ahead = gofs_[i];
    ahead.done = run_async([this, &ahead, each] { ahead.gof = parse(ahead.coded, each); });
  }
}

// Finds the next GOF, skipping ancillary units. Reads nothing beyond the end of the sequence.
std::optional<CodedAccessUnit> Prefetch::collect(std::uint64_t offset,
                                                 std::uint32_t first_frame) {
  UnitReader& units = stream_.units();
  while (offset < units.size()) {
    const auto unit = units.header_at(offset);
    if (!unit) return std::nullopt;
    if (unit->type() == UnitType::kGof) {
      return stream_.access_units().collect(*unit, first_frame, max_memory_bytes_);
    }
    if (!unit->ancillary()) return std::nullopt;
    offset = unit->end();
  }
  return std::nullopt;
}

std::optional<PreparedGof> Prefetch::parse(const CodedAccessUnit& coded,
                                           std::uint32_t threads) const {
  auto access_unit = stream_.access_units().parse(coded, max_memory_bytes_);
  if (!access_unit) return std::nullopt;
  return prepare(std::move(*access_unit), stream_.context(), threads);
}

}  // namespace rlpc
