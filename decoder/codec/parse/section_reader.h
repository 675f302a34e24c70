// Reader of a section of a unit (9.3): decodes its syntax elements, with trace and errors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/codec/bits/bit_model.h"
#include "common/codec/bits/bit_reader.h"
#include "common/codec/bits/range_decoder.h"
#include "common/codec/bits/residual_models.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/parse/parse_residual.h"

namespace rlpc {

// Reads the rest of a payload as one section. Errors are sticky and left in the BitReader; the
// caller stops when failed().
class SectionReader {
 public:
  // name: the syntax structure, for errors at its start and end.
  SectionReader(BitReader& r, const char* name)
      : reader_(r),
        name_(name),
        first_bit_(r.bit_pos()),
        num_bytes_(r.remaining_bytes().size()),
        rd_(r.remaining_bytes()) {
    if (!rd_.starts_legally()) fail("R-RNG-02", name_);
  }

  bool failed() const { return reader_.error().has_value(); }
  std::uint64_t num_bytes() const { return num_bytes_; }  // bytes of the section
  void fail(const char* rule, const char* element) {
    reader_.fail(Errc::kInvalid, rule, element, bit_pos());
  }
  // Fails if the limit does not allow `bytes` in addition to the section itself.
  void check_memory(const MemoryLimit& memory, std::uint64_t bytes, const char* element) {
    const std::uint64_t needed_bytes = memory.bytes_in_use + num_bytes_ + bytes;
    if (failed() || needed_bytes <= memory.max_bytes) return;
    reader_.fail(Errc::kLimitExceeded, "", element, bit_pos(), needed_bytes);
  }
  // Fails if the section ran out of bytes, so that it is not decoded any further.
  void check_overrun(const char* element) {
    if (rd_.overrun()) fail("R-RNG-01", element);
  }
  // EndSection( )
  void finish() {
    if (!failed() && !rd_.at_exact_end()) fail("R-RNG-01", name_);
  }

  // 9.3.3 ae( model )
  bool bin(BitModel& model, const char* element) {
    const std::uint64_t at = mark();
    const bool value = rd_.bin(model);
    trace(element, value ? 1 : 0, at);
    return value;
  }
  // 9.3.4 bypass( n )
  std::uint32_t bypass(int n, const char* element) {
    const std::uint64_t at = mark();
    const std::uint32_t value = rd_.bypass(n);
    trace(element, value, at);
    return value;
  }
  // 9.5.1 ae_residual( models, expected )
  std::int32_t residual(ResidualModels& models, std::uint32_t expected, const char* element) {
    const std::uint64_t at = mark();
    const std::int32_t value = parse_residual(rd_, models, expected);
    trace(element, value, at);
    return value;
  }
  // Parses each of `values` in the same way: context.models() returns the models of the next
  // value, context.expected() its expected magnitude, and context.update() takes the value. The
  // state of the range decoder stays in registers unless there is a trace.
  template <class Context>
  void residuals(Context context, std::span<std::int32_t> values, const char* element) {
    if (reader_.trace() != nullptr) {
      for (std::int32_t& value : values) {
        value = residual(context.models(), context.expected(), element);
        context.update(value);
      }
      return;
    }
    RangeDecoder rd = rd_;
    for (std::int32_t& value : values) {
      value = parse_residual(rd, context.models(), context.expected());
      context.update(value);
    }
    rd_ = rd;
  }
  // 9.5.4 ae_header( field ): the previous value plus a difference, or range.min and an error.
  int header_value(ResidualModels& models, std::uint32_t& mean, int previous, Range range,
                   const char* element, const char* rule) {
    const std::int32_t delta = residual(models, mean >> 4, element);
    mean = update_mean(mean, magnitude_of(delta), 2);
    const std::int64_t value = std::int64_t{previous} + delta;
    if (value >= range.min && value <= range.max) return static_cast<int>(value);
    fail(rule, element);
    return static_cast<int>(range.min);
  }
  // 9.5.5 ae_unary( models )
  template <std::size_t N>
  int truncated_unary(std::array<BitModel, N>& models, const char* element) {
    const std::uint64_t at = mark();
    std::size_t value = 0;
    while (value < N && rd_.bin(models[value])) ++value;
    trace(element, static_cast<std::int64_t>(value), at);
    return static_cast<int>(value);
  }
  // 9.5.6 ae_tree( models, depth ): models of the inner nodes, root at index 1.
  template <class Models>
  std::uint32_t tree(Models& models, const char* element) {
    const std::uint64_t at = mark();
    std::size_t node = 1;
    while (node < models.size()) node = 2 * node + (rd_.bin(models[node]) ? 1U : 0U);
    const auto leaf = static_cast<std::uint32_t>(node - models.size());
    trace(element, leaf, at);
    return leaf;
  }

 private:
  std::uint64_t bit_pos() const { return first_bit_ + rd_.bits_spent(); }
  // Position of the next element; 0 unless tracing.
  std::uint64_t mark() const { return reader_.trace() != nullptr ? bit_pos() : 0; }
  void trace(const char* element, std::int64_t value, std::uint64_t at) {
    if (reader_.trace() != nullptr) reader_.trace()->element(element, value, at);
  }

  BitReader& reader_;
  const char* name_;
  std::uint64_t first_bit_;
  std::uint64_t num_bytes_;
  RangeDecoder rd_;
};

}  // namespace rlpc
