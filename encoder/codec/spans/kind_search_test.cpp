#include "encoder/codec/spans/kind_search.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

// Counts the calls of a kind and its coders.
struct Calls {
  int questions = 0;
  int encodings = 0;
  int released = 0;
};

// Returns an encoding of a fixed size, without error.
class FakeCoder : public SpanCoder {
 public:
  FakeCoder(std::size_t bytes, Calls& calls) : bytes_(bytes), calls_(calls) {}
  std::uint32_t expected_components() const override { return 10; }
  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return false; }
  EncodedSpan encode(double /*step*/, double /*analysis_step*/) override {
    ++calls_.encodings;
    EncodedSpan encoded;
    encoded.units.push_back({UnitType::kGof, std::vector<std::uint8_t>(bytes_)});
    encoded.frame = [](std::uint32_t, std::span<std::int32_t>) {};
    return encoded;
  }
  void release_analysis() override { ++calls_.released; }

 private:
  std::size_t bytes_;
  Calls& calls_;
};

class FakeKind : public KindEncoder {
 public:
  // min: number of components of the likeliest kind from which this one may win.
  FakeKind(std::size_t bytes, std::uint32_t min, Calls& calls)
      : bytes_(bytes), min_(min), calls_(calls) {}
  std::unique_ptr<SpanCoder> make_coder(const SpanFrames& /*frames*/) const override {
    return std::make_unique<FakeCoder>(bytes_, calls_);
  }
  bool may_win(const SpanFrames& /*frames*/, std::uint32_t components) const override {
    ++calls_.questions;
    return components >= min_;
  }

 private:
  std::size_t bytes_;
  std::uint32_t min_;
  Calls& calls_;
};

struct Fixture {
  void add(std::size_t bytes, std::uint32_t min) {
    calls.push_back(std::make_unique<Calls>());
    kinds.push_back(std::make_unique<FakeKind>(bytes, min, *calls.back()));
  }
  static std::size_t bytes(SpanCoder& search, double step) {
    return search.encode(step, step).units.front().payload.size();
  }

  SpanFrames frames{.num_vertices = 1, .num_frames = 1, .xyz = {0.0, 0.0, 0.0}};
  KindEncoders kinds;
  std::vector<std::unique_ptr<Calls>> calls;
};

TEST(KindSearch, TakesTheCheapestKind) {
  Fixture f;
  f.add(100, 0);
  f.add(80, 10);
  f.add(90, 10);
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  EXPECT_EQ(Fixture::bytes(search, 10.0), 80U);
  // At a nearby step the choice is kept.
  EXPECT_EQ(Fixture::bytes(search, 11.0), 80U);
  EXPECT_EQ(f.calls[0]->encodings, 1);
  EXPECT_EQ(f.calls[1]->encodings, 2);
  EXPECT_EQ(f.calls[2]->encodings, 1);
}

TEST(KindSearch, EncodesOnlyKindsThatMayWin) {
  Fixture f;
  f.add(100, 0);
  f.add(50, 11);
  f.add(60, 10);
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  EXPECT_EQ(Fixture::bytes(search, 10.0), 60U);
  EXPECT_EQ(f.calls[1]->questions, 1);
  EXPECT_EQ(f.calls[1]->encodings, 0);
  EXPECT_EQ(f.calls[2]->questions, 1);
  EXPECT_EQ(f.calls[2]->encodings, 1);
}

TEST(KindSearch, SlowPresetEncodesAllKinds) {
  Fixture f;
  f.add(100, 0);
  f.add(50, 99);
  KindSearch search(f.kinds, f.frames, Preset::kSlow);
  EXPECT_EQ(Fixture::bytes(search, 10.0), 50U);
  EXPECT_EQ(f.calls[1]->questions, 0);
}

TEST(KindSearch, ComparesOnce) {
  Fixture f;
  f.add(100, 0);
  f.add(50, 9);
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  EXPECT_TRUE(search.needs_frames(10.0, 10.0));
  Fixture::bytes(search, 10.0);
  EXPECT_FALSE(search.needs_frames(20.0, 20.0));
  EXPECT_EQ(Fixture::bytes(search, 20.0), 50U);
  EXPECT_EQ(f.calls[0]->encodings, 1);
  EXPECT_EQ(f.calls[1]->questions, 1);
}

TEST(KindSearch, ReleasesTheAnalysesOfItsCoders) {
  Fixture f;
  f.add(100, 0);
  f.add(80, 10);
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  search.release_analysis();
  EXPECT_EQ(f.calls[0]->released, 1);
  Fixture::bytes(search, 10.0);
  search.release_analysis();
  EXPECT_EQ(f.calls[0]->released, 2);
  EXPECT_EQ(f.calls[1]->released, 1);
}

}  // namespace
}  // namespace rlpc
