// Tests range encoder and decoder against each other (clause 9.3).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "common/codec/bits/range_decoder.h"
#include "common/codec/bits/range_encoder.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Bin with one of a few models, or bypass bits.
struct Symbol {
  int model = 0;  // index; -1: bypass
  int bits = 1;
  std::uint32_t value = 0;
};
using Symbols = std::vector<Symbol>;

constexpr std::size_t kModels = 4;

Bytes encode(const Symbols& symbols) {
  RangeEncoder re;
  std::vector<BitModel> models(kModels);
  for (const Symbol& s : symbols) {
    if (s.model < 0) {
      re.bypass(s.bits, s.value);
    } else {
      re.bin(models[static_cast<std::size_t>(s.model)], s.value != 0);
    }
  }
  return re.finish();
}

// Values of the same symbols, decoded from the section.
struct Decoded {
  std::vector<std::uint32_t> values;
  bool starts_legally = false;
  bool at_exact_end = false;
  bool overrun = false;
};

Decoded decode(const Bytes& section, const Symbols& symbols) {
  RangeDecoder rd(section);
  std::vector<BitModel> models(kModels);
  Decoded decoded;
  for (const Symbol& s : symbols) {
    decoded.values.push_back(s.model < 0 ? rd.bypass(s.bits)
                             : rd.bin(models[static_cast<std::size_t>(s.model)]) ? 1U
                                                                                 : 0U);
  }
  decoded.starts_legally = rd.starts_legally();
  decoded.at_exact_end = rd.at_exact_end();
  decoded.overrun = rd.overrun();
  return decoded;
}

Bytes expect_round_trip(const Symbols& symbols) {
  Bytes section = encode(symbols);
  const Decoded decoded = decode(section, symbols);
  EXPECT_TRUE(decoded.starts_legally);
  EXPECT_TRUE(decoded.at_exact_end);
  EXPECT_FALSE(decoded.overrun);
  std::vector<std::uint32_t> expected;
  for (const Symbol& s : symbols) expected.push_back(s.value);
  EXPECT_EQ(decoded.values, expected);

  Bytes longer = section;
  longer.push_back(0);
  EXPECT_FALSE(decode(longer, symbols).at_exact_end);
  const Bytes shorter(section.begin(), section.end() - 1);  // exact size on the heap
  const Decoded cut = decode(shorter, symbols);
  // The remaining bytes may be a complete section of other symbols, but not of these.
  EXPECT_FALSE(cut.at_exact_end && cut.values == expected);
  EXPECT_TRUE(cut.overrun || cut.values != expected);
  return section;
}

std::uint32_t random_bits(std::mt19937& random, int n) {
  return n == 0 ? 0 : static_cast<std::uint32_t>(random()) >> (32 - n);
}

Symbols random_symbols(std::mt19937& random, std::size_t count, unsigned ones_per_mille,
                       unsigned bypass_per_mille) {
  Symbols symbols;
  for (std::size_t i = 0; i < count; ++i) {
    if (random() % 1000 < bypass_per_mille) {
      const int bits = static_cast<int>(random() % 33);
      symbols.push_back({-1, bits, random_bits(random, bits)});
    } else {
      symbols.push_back({static_cast<int>(random() % kModels), 1,
                         random() % 1000 < ones_per_mille ? 1U : 0U});
    }
  }
  return symbols;
}

TEST(RangeCoder, RandomSymbolsRoundTripAndUseAllBytesOfTheSection) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    constexpr std::array<unsigned, 5> kOnes{3, 100, 500, 930, 998};
    constexpr std::array<unsigned, 4> kBypass{0, 20, 400, 1000};
    expect_round_trip(random_symbols(random, seed % 7 == 0 ? 5000 : seed % 60, kOnes[seed % 5],
                                     kBypass[seed % 4]));
  }
}

TEST(RangeCoder, SymbolsOfOneValueTakeAlmostNoSpace) {
  for (const std::uint32_t value : {0U, 1U}) {
    const Bytes section = expect_round_trip(Symbols(100000, Symbol{0, 1, value}));
    EXPECT_LT(section.size(), 100000 * 0.0017 / 8 + 20);  // -log2(65465 / 65536) bits each
  }
}

TEST(RangeCoder, BypassSupportsEveryWidth) {
  for (int bits = 0; bits <= 32; ++bits) {
    const std::uint32_t all = bits == 0 ? 0 : 0xFFFFFFFFU >> (32 - bits);
    Symbols symbols;
    for (const std::uint32_t value : {all, 0U, all / 3, all - all / 3}) {
      for (int i = 0; i < 20; ++i) symbols.push_back({-1, bits, value});
    }
    EXPECT_LE(expect_round_trip(symbols).size(), static_cast<std::size_t>(10 * bits + 2));
  }
}

TEST(RangeCoder, AnEmptySectionIsOneByte) {
  EXPECT_EQ(expect_round_trip({}), Bytes{0});
  RangeDecoder empty{std::span<const std::uint8_t>{}};
  EXPECT_TRUE(empty.starts_legally());
  EXPECT_FALSE(empty.at_exact_end());
  EXPECT_TRUE(empty.overrun());
}

// Returns the symbols that a decoder reads from arbitrary bytes.
Symbols symbols_of(const Bytes& bytes, std::size_t count, bool with_rigs) {
  RangeDecoder rd(bytes);
  std::vector<BitModel> models(kModels);
  Symbols symbols;
  for (std::size_t i = 0; i < count; ++i) {
    const int model = with_rigs && i % 3 != 0 ? static_cast<int>(i % kModels) : -1;
    symbols.push_back({model, 1, 0});
    symbols.back().value = model < 0                                         ? rd.bypass(1)
                           : rd.bin(models[static_cast<std::size_t>(model)]) ? 1U
                                                                             : 0U;
  }
  return symbols;
}

// Symbols that describe a number close to a round one keep `low` just below it, so that many
// 0xFF bytes are held back. The following symbols propagate a carry through all of them, or
// none.
TEST(RangeCoder, CarriesPropagateThroughManyBytes) {
  std::size_t longest_ones = 0;
  std::size_t longest_zeros = 0;
  for (const int first : {0x01, 0x7F, 0x80, 0xC3}) {
    for (const bool below : {false, true}) {
      for (const bool with_rigs : {false, true}) {
        SCOPED_TRACE(testing::Message() << first << below << with_rigs);
        Bytes target(60, below ? 0xFF : 0x00);
        target[0] = static_cast<std::uint8_t>(first);
        target[1] = static_cast<std::uint8_t>(below ? 0x37 : 0x38);
        for (std::size_t cut = 1; cut < 8 * target.size(); ++cut) {
          Symbols symbols = symbols_of(target, cut, with_rigs);
          for (const std::uint32_t last : {0U, 1U}) {
            symbols.push_back({-1, 1, last});
            const Bytes section = expect_round_trip(symbols);
            symbols.pop_back();
            for (const int fill : {0x00, 0xFF}) {
              std::size_t run = 0;
              std::size_t& longest = fill == 0 ? longest_zeros : longest_ones;
              for (const std::uint8_t byte : section) {
                run = byte == fill ? run + 1 : 0;
                longest = std::max(longest, run);
              }
            }
          }
        }
      }
    }
  }
  EXPECT_GT(longest_ones, 50U);
  EXPECT_GT(longest_zeros, 50U);
}

TEST(RangeCoder, SymbolsReadFromRandomBytesRoundTrip) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Bytes bytes(random() % 40 + 4);
    for (std::uint8_t& b : bytes)
      b = static_cast<std::uint8_t>(random() % 3 == 0 ? 0xFF : random());
    bytes[0] &= 0x7F;
    expect_round_trip(symbols_of(bytes, 4 * bytes.size(), seed % 2 == 0));
  }
}

TEST(RangeCoder, SectionsThatStartWithFourTimes255AreIllegal) {
  EXPECT_FALSE(RangeDecoder(Bytes{0xFF, 0xFF, 0xFF, 0xFF}).starts_legally());
  EXPECT_FALSE(RangeDecoder(Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0x00}).starts_legally());
  EXPECT_TRUE(RangeDecoder(Bytes{0xFF, 0xFF, 0xFF, 0xFE}).starts_legally());
  EXPECT_TRUE(RangeDecoder(Bytes{0xFF, 0xFF, 0xFF}).starts_legally());
  EXPECT_TRUE(RangeDecoder(Bytes{0x00, 0xFF, 0xFF, 0xFF}).starts_legally());
  // The largest section that an encoder can write: bypass bits that are all 1.
  const Bytes section = expect_round_trip(Symbols(40, Symbol{-1, 32, 0xFFFFFFFF}));
  EXPECT_EQ(section[0], 0xFF);
  EXPECT_NE((Bytes{section[0], section[1], section[2], section[3]}), Bytes(4, 0xFF));
}

// After an illegal start, the decoder still keeps its invariants.
TEST(RangeCoder, DecodingContinuesAfterAnIllegalStart) {
  const Bytes section(10, 0xFF);
  RangeDecoder rd(section);
  EXPECT_EQ(rd.bypass(8), 0xFFU);
  BitModel model;
  for (int i = 0; i < 100; ++i) {
    rd.bin(model);
    rd.bypass(3);
  }
  EXPECT_TRUE(rd.overrun());
}

TEST(RangeCoder, BitsSpentGrowWithTheInformation) {
  const Bytes section(1000, 0x5A);
  RangeDecoder rd(section);
  EXPECT_EQ(rd.bits_spent(), 0U);
  for (std::uint64_t n = 1; n <= 500; ++n) {
    rd.bypass(7);
    ASSERT_LE(rd.bits_spent(), 7 * n);  // half of an odd range is a little more
    ASSERT_GE(rd.bits_spent() + 1, 7 * n);
  }
  BitModel model;
  std::uint64_t before = rd.bits_spent();
  for (int i = 0; i < 2000; ++i) {
    rd.bin(model);
    ASSERT_GE(rd.bits_spent(), before);
    before = rd.bits_spent();
  }
}

TEST(RangeCoder, SectionsAreAsLongAsTheirEntropy) {
  for (const unsigned ones_per_mille : {30U, 300U, 900U}) {
    constexpr unsigned kSeed = 5;
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", " << ones_per_mille);
    std::mt19937 random(kSeed);
    const Symbols symbols = random_symbols(random, 50000, ones_per_mille, 10);
    std::vector<BitModel> models(kModels);
    double bits = 0.0;
    for (const Symbol& s : symbols) {
      if (s.model < 0) {
        bits += s.bits;
        continue;
      }
      BitModel& model = models[static_cast<std::size_t>(s.model)];
      const double one = model.probability() / 65536.0;
      bits -= std::log2(s.value != 0 ? one : 1.0 - one);
      model.update(s.value != 0);
    }
    const double bytes = static_cast<double>(encode(symbols).size());
    EXPECT_GT(bytes, bits / 8);
    EXPECT_LT(bytes, bits / 8 * 1.0005 + 2);
  }
}

// Two models and bypass bits, as traced in Annex C.
TEST(RangeCoder, WritesAndReadsTheSectionOfTheTrace) {
  const Symbols symbols{{0, 1, 1},       {0, 1, 1},   {0, 1, 0}, {1, 1, 0},
                        {0, 1, 1},       {-1, 5, 19}, {1, 1, 0}, {1, 1, 0},
                        {-1, 12, 0xABC}, {0, 1, 1},   {1, 1, 1}, {-1, 1, 0},
                        {0, 1, 0},       {0, 1, 1},   {1, 1, 0}, {-1, 3, 6}};
  const Bytes section{0x5A, 0x64, 0xB3, 0x86, 0xB4};
  EXPECT_EQ(encode(symbols), section);
  expect_round_trip(symbols);
}

}  // namespace
}  // namespace rlpc
