// Fuzzes the encoder: animations and settings derived from arbitrary bytes are encoded,
// validated, decoded and measured.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "common/testing/fuzz_input.h"
#include "conformance/fuzz/encoder_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string wrong = rlpc::check_encoder(rlpc::make_encoder_case({data, size}));
  if (!wrong.empty()) std::fprintf(stderr, "encoder: %s\n", wrong.c_str());
  rlpc::fuzz_check(wrong.empty());
  return 0;
}
