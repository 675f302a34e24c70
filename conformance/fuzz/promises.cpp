// promises [COUNT [FIRST_SEED]]: tries random animations and settings, and prints each case in
// which the encoder breaks a promise. Exit code 1 if there is one.

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "conformance/fuzz/promise_check.h"

int main(int argc, char** argv) {
  const std::uint64_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1000;
  const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 0;
  // [target][outcome]
  std::array<std::array<std::uint64_t, 4>, 5> counts{};
  std::uint64_t wrong = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const rlpc::PromiseCase c = rlpc::make_promise_case(seed);
    const rlpc::PromiseResult result = rlpc::check_promises(c);
    ++counts[c.settings.target.kind][static_cast<std::size_t>(result.outcome)];
    if (result.outcome != rlpc::Outcome::kWrong) continue;
    ++wrong;
    std::printf("seed %llu (%s): %s\n", static_cast<unsigned long long>(seed), c.kind.c_str(),
                result.what.c_str());
    std::fflush(stdout);
  }
  constexpr std::array<const char*, 5> kTargets{"none", "kg", "bpvf", "max-error", "lossless"};
  std::printf("%-10s %8s %8s %8s %8s\n", "target", "kept", "missed", "refused", "wrong");
  for (std::size_t target = 1; target < kTargets.size(); ++target) {
    std::printf("%-10s", kTargets[target]);
    for (const std::uint64_t cases : counts[target]) {
      std::printf(" %8llu", static_cast<unsigned long long>(cases));
    }
    std::printf("\n");
  }
  return wrong > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}
