// Reads the fixed-length and Exp-Golomb codes of clause 9.2, most significant bit first.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/bits/rule_listener.h"
#include "common/codec/bits/trace.h"
#include "common/result.h"

namespace rlpc {

// An element that has been read.
struct ReadElement {
  const char* name = "";
  std::int64_t value = 0;
  std::uint64_t bit_pos = 0;  // its first bit
};

// Whether elements can be read after one that breaks a rule. Matters only to a RuleListener.
enum class AfterBroken : std::uint8_t {
  kGoOn,
  kStop,  // its value says which elements follow, or which values they can have
};

// Reads the bits of one unit; does not own the bytes. Errors are sticky: after the first one,
// every read returns the lowest legal value, so that loops end and indices stay in range.
//
// With a listener, values that break a rule do not stop it: it returns them as they are, so
// that a parse function that uses one as a size or an index checks error() before, or reads it
// with kStop.
class BitReader {
 public:
  // first_bit: position of bytes[0] in the stream, for error positions and traces.
  explicit BitReader(std::span<const std::uint8_t> bytes, std::uint64_t first_bit = 0,
                     Trace* trace = nullptr, RuleListener* listener = nullptr)
      : bytes_(bytes), first_bit_(first_bit), trace_(trace), listener_(listener) {}

  // u(n), 1 <= n <= 32. rule: id of the rule that states the range.
  std::uint32_t u(int n, const char* element, Range range, const char* rule,
                  AfterBroken after = AfterBroken::kGoOn);
  std::uint32_t u(int n, const char* element);
  bool flag(const char* element) { return u(1, element) != 0; }
  // ue(): at most 32 bits of value; se(): the signed mapping of clause 9.2.
  std::uint32_t ue(const char* element, Range range, const char* rule,
                   AfterBroken after = AfterBroken::kGoOn);
  std::int32_t se(const char* element, Range range, const char* rule);
  // Reads zero bits up to the next byte boundary (rule R-BIT-02).
  void byte_alignment();
  // Returns the bytes from the current position on, which must be byte-aligned.
  std::span<const std::uint8_t> remaining_bytes() const;
  // Fails unless every byte has been read (rule R-BIT-03).
  void expect_end();

  // Check an element against another range or condition, unless it has broken a rule. Return
  // false if it breaks this one, or if reading has stopped.
  bool require(const ReadElement& element, Range range, const char* rule);
  bool require(const ReadElement& element, bool holds, const char* rule);
  // Stops reading, at an error or after a broken rule.
  void fail(Errc code, const char* rule, const char* element, std::uint64_t bit_pos,
            std::uint64_t needed_bytes = 0);
  void stop() { stopped_ = true; }
  // Returns whether reading has stopped: without a listener, whether there is an error.
  bool stopped() const { return stopped_; }
  // Returns the first error or broken rule.
  const std::optional<Error>& error() const { return error_; }
  std::uint64_t bit_pos() const { return first_bit_ + pos_; }
  Trace* trace() const { return trace_; }

 private:
  std::uint32_t take(int n, const char* element, std::uint64_t at);
  std::uint64_t take_exp_golomb(const char* element);
  // Returns the value, or the lowest legal one if reading has stopped.
  std::int64_t check(const ReadElement& element, Range range, const char* rule,
                     AfterBroken after);
  void break_rule(const ReadElement& element, Range range, const char* rule,
                  AfterBroken after = AfterBroken::kGoOn);

  std::span<const std::uint8_t> bytes_;
  std::uint64_t pos_ = 0;
  std::uint64_t first_bit_ = 0;
  Trace* trace_ = nullptr;
  RuleListener* listener_ = nullptr;
  std::optional<Error> error_;
  std::uint64_t broken_at_ = 0;  // place of the last element that broke a rule, if any did
  bool stopped_ = false;
};

}  // namespace rlpc
