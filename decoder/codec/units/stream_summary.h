// Summarises all GOFs and shared rigs of a stream.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "common/codec/kinds/access_unit.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/summary/gof_summary.h"
#include "decoder/codec/units/stream_reader.h"

namespace rlpc {

struct StreamSummary {
  Vector<std::shared_ptr<const RigSummary>> rigs;  // in the order of the stream
  Vector<GofSummary> gofs;

  std::uint32_t num_frames() const {
    return gofs.empty() ? 0 : gofs.back().first_frame + gofs.back().num_frames;
  }
};

// Summarises all GOFs and shared rigs of a stream, which is read to its end. Calls `check` with
// each access unit; an error that it returns ends the reading.
using CheckAccessUnit = std::function<std::optional<Error>(const AccessUnit&)>;
Result<StreamSummary> summarise_all(StreamReader& stream, const CheckAccessUnit& check = {});

}  // namespace rlpc
