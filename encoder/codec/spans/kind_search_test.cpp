#include "encoder/codec/spans/kind_search.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

// Counts the calls of a kind and its coders.
struct KindCalls {
  int encodings = 0;
  int released = 0;
  int keeps = 0;
  double last_step = 0.0;
};

// What a kind and its coders answer.
struct Answers {
  std::size_t bytes = 0;     // size of an encoding
  std::uint32_t min = 0;     // number of components of the likeliest kind from which it may win
  std::size_t expected = 0;  // size that its sample leads to; 0: it has no sample
  double squared_error = 0.0;
  double scale = 1.0;  // of the step at which its error is expected to be that of the rival
};

class FakeCoder : public SpanCoder {
 public:
  FakeCoder(const Answers& answers, KindCalls& calls) : answers_(answers), calls_(calls) {}
  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return false; }
  EncodedSpan encode(double step, double /*analysis_step*/) override {
    ++calls_.encodings;
    calls_.last_step = step;
    EncodedSpan encoded;
    encoded.units.push_back({UnitType::kGof, std::vector<std::uint8_t>(answers_.bytes)});
    encoded.squared_error = answers_.squared_error;
    return encoded;
  }
  void release_analysis() override { ++calls_.released; }
  void keep_num_components() override { ++calls_.keeps; }
  std::optional<double> step_in_reach(double step, const SpanCost& rival) override {
    if (8.0 * static_cast<double>(answers_.expected) > rival.bits) return std::nullopt;
    return answers_.scale * step;
  }

 private:
  Answers answers_;
  KindCalls& calls_;
};

class FakeKind : public KindEncoder {
 public:
  FakeKind(const Answers& answers, KindCalls& calls) : answers_(answers), calls_(calls) {}
  std::unique_ptr<SpanCoder> make_coder(const SpanFrames& /*frames*/) const override {
    return std::make_unique<FakeCoder>(answers_, calls_);
  }

 private:
  Answers answers_;
  KindCalls& calls_;
};

struct Fixture {
  void add(const Answers& answers) {
    calls.push_back(std::make_unique<KindCalls>());
    kinds.push_back(std::make_unique<FakeKind>(answers, *calls.back()));
  }
  static std::size_t bytes(SpanCoder& search, double step) {
    return search.encode(step, step).units.front().payload.size();
  }

  SpanFrames frames{.num_vertices = 1, .num_frames = 1, .xyz = {0.0, 0.0, 0.0}};
  KindEncoders kinds;
  std::vector<std::unique_ptr<KindCalls>> calls;
};

TEST(KindSearch, TakesTheCheapestKind) {
  Fixture f;
  f.add({.bytes = 100});
  f.add({.bytes = 80});
  f.add({.bytes = 90});
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  EXPECT_EQ(Fixture::bytes(search, 10.0), 80U);
  // At a nearby step the choice is kept.
  EXPECT_EQ(Fixture::bytes(search, 11.0), 80U);
  EXPECT_EQ(f.calls[0]->encodings, 1);
  EXPECT_EQ(f.calls[1]->encodings, 2);
  EXPECT_EQ(f.calls[2]->encodings, 1);
}

TEST(KindSearch, SkipsKindsWhoseSampleLosesToTheBest) {
  Fixture f;
  f.add({.bytes = 100});
  f.add({.bytes = 80, .expected = 99});
  f.add({.bytes = 70, .expected = 90});  // less than the first kind, more than the second
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  EXPECT_EQ(Fixture::bytes(search, 10.0), 80U);
  EXPECT_EQ(f.calls[1]->encodings, 1);
  EXPECT_EQ(f.calls[2]->encodings, 0);
  KindSearch slow(f.kinds, f.frames, Preset::kSlow);
  EXPECT_EQ(Fixture::bytes(slow, 10.0), 70U);
}

// At this step, the second has the lower Lagrangian cost.
TEST(KindSearch, ComparesAtEqualError) {
  Fixture f;
  f.add({.bytes = 100, .squared_error = 30000.0});
  f.add({.bytes = 175, .squared_error = 20000.0});
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  EXPECT_EQ(Fixture::bytes(search, 10.0), 100U);
}

TEST(KindSearch, TriesAKindAtTheStepOfTheSameErrorAndReturnsItAtItsOwn) {
  Fixture f;
  f.add({.bytes = 100});
  f.add({.bytes = 110, .scale = 0.5});
  f.add({.bytes = 80, .scale = 0.25});
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  EXPECT_EQ(Fixture::bytes(search, 10.0), 80U);
  EXPECT_EQ(f.calls[1]->encodings, 1);
  EXPECT_EQ(f.calls[1]->last_step, 5.0);
  EXPECT_EQ(f.calls[2]->encodings, 2);
  EXPECT_EQ(f.calls[2]->last_step, 10.0);
}

TEST(KindSearch, ComparesOnce) {
  Fixture f;
  f.add({.bytes = 100});
  f.add({.bytes = 50});
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  EXPECT_TRUE(search.needs_frames(10.0, 10.0));
  Fixture::bytes(search, 10.0);
  EXPECT_FALSE(search.needs_frames(20.0, 20.0));
  EXPECT_EQ(Fixture::bytes(search, 20.0), 50U);
  EXPECT_EQ(f.calls[0]->encodings, 1);
}

TEST(KindSearch, ReleasesTheAnalysesOfItsCoders) {
  Fixture f;
  f.add({.bytes = 100});
  f.add({.bytes = 80});
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  search.release_analysis();
  EXPECT_EQ(f.calls[0]->released, 1);
  Fixture::bytes(search, 10.0);
  search.release_analysis();
  EXPECT_EQ(f.calls[0]->released, 2);
  EXPECT_EQ(f.calls[1]->released, 1);
}

TEST(KindSearch, KeepsTheNumberOfComponentsOfTheChosenKind) {
  Fixture f;
  f.add({.bytes = 100});
  f.add({.bytes = 80});
  KindSearch search(f.kinds, f.frames, Preset::kMedium);
  Fixture::bytes(search, 10.0);
  search.keep_num_components();
  EXPECT_EQ(f.calls[0]->keeps, 0);
  EXPECT_EQ(f.calls[1]->keeps, 1);
}

}  // namespace
}  // namespace rlpc
