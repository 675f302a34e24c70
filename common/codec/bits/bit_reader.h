// Reads the fixed-length and Exp-Golomb codes of clause 9.2, most significant bit first.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/bits/trace.h"
#include "common/result.h"

namespace rlpc {

struct Range {
  std::int64_t min = 0;
  std::int64_t max = 0;
};

// Reads the bits of one unit; does not own the bytes. Errors are sticky: after the first one,
// every read returns the lowest legal value, so that loops end and indices stay in range.
class BitReader {
 public:
  // first_bit: position of bytes[0] in the stream, for error positions and traces.
  explicit BitReader(std::span<const std::uint8_t> bytes, std::uint64_t first_bit = 0,
                     Trace* trace = nullptr)
      : bytes_(bytes), first_bit_(first_bit), trace_(trace) {}

  // u(n), 1 <= n <= 32. rule: id of the rule that states the range.
  std::uint32_t u(int n, const char* element, Range range, const char* rule);
  std::uint32_t u(int n, const char* element);
  bool flag(const char* element) { return u(1, element) != 0; }
  // ue(): at most 32 bits of value; se(): the signed mapping of clause 9.2.
  std::uint32_t ue(const char* element, Range range, const char* rule);
  std::int32_t se(const char* element, Range range, const char* rule);
  // Reads zero bits up to the next byte boundary (rule R-BIT-02).
  void byte_alignment();
  // Returns the bytes from the current position on, which must be byte-aligned.
  std::span<const std::uint8_t> remaining_bytes() const;
  // Fails unless every byte has been read (rule R-BIT-03).
  void expect_end();

  void fail(Errc code, const char* rule, const char* element, std::uint64_t bit_pos,
            std::uint64_t needed_bytes = 0);
  const std::optional<Error>& error() const { return error_; }
  std::uint64_t bit_pos() const { return first_bit_ + pos_; }
  Trace* trace() const { return trace_; }

 private:
  std::uint32_t take(int n, const char* element, std::uint64_t at);
  std::uint64_t take_exp_golomb(const char* element);
  std::int64_t check(std::int64_t value, const char* element, Range range, const char* rule,
                     std::uint64_t at);

  std::span<const std::uint8_t> bytes_;
  std::uint64_t pos_ = 0;
  std::uint64_t first_bit_ = 0;
  Trace* trace_ = nullptr;
  std::optional<Error> error_;
};

}  // namespace rlpc
