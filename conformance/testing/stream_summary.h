// The summary of a stream, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "decoder/codec/units/stream_reader.h"
#include "decoder/codec/units/stream_summary.h"

namespace rlpc {

// Returns an empty summary if the stream cannot be read, which fails the test.
inline StreamSummary summary_of(const std::vector<std::uint8_t>& stream) {
  StreamReader reader(memory_source(stream), {});
  EXPECT_TRUE(reader.open());
  const auto summary = summarise_all(reader);
  EXPECT_TRUE(summary);
  return summary ? *summary : StreamSummary();
}

}  // namespace rlpc
