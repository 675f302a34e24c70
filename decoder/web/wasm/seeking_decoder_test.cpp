#include "decoder/web/wasm/seeking_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<std::uint8_t>;
using Positions = std::vector<std::int32_t>;

// Bytes that must be loaded in blocks before they can be read.
struct Loaded {
  static constexpr std::uint64_t kBlock = 64;

  Bytes bytes;
  std::set<std::uint64_t> blocks;
  std::uint64_t missing_begin = 0;
  std::uint64_t missing_end = 0;

  void load_missing() {
    for (std::uint64_t b = missing_begin / kBlock; b * kBlock < missing_end; ++b) {
      blocks.insert(b);
    }
  }
};

class LoadedSource final : public ByteSource {
 public:
  explicit LoadedSource(Loaded& loaded) : loaded_(loaded) {}
  std::uint64_t size() const override { return loaded_.bytes.size(); }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > size() || out.size() > size() - offset) return false;
    const std::uint64_t end = offset + out.size();
    for (std::uint64_t b = offset / Loaded::kBlock; b * Loaded::kBlock < end; ++b) {
      if (loaded_.blocks.contains(b)) continue;
      loaded_.missing_begin = offset;
      loaded_.missing_end = end;
      return false;
    }
    std::copy_n(loaded_.bytes.begin() + static_cast<std::ptrdiff_t>(offset), out.size(),
                out.begin());
    return true;
  }

 private:
  Loaded& loaded_;
};

// Repeats a call whenever bytes were missing.
template <class Call>
bool completed(Loaded& loaded, const SeekingDecoder& decoder, const Call& call) {
  while (!call()) {
    if (decoder.error().code != Errc::kIo) return false;
    loaded.load_missing();
  }
  return true;
}

Bytes contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

std::vector<Positions> decoded_in_order(const Bytes& bytes) {
  auto decoder = Decoder::open(memory_source(bytes));
  std::vector<Positions> frames;
  if (!decoder) return frames;
  Positions positions(3 * std::size_t{decoder->num_vertices()});
  for (auto more = decoder->next_frame(positions); more && *more;
       more = decoder->next_frame(positions)) {
    frames.push_back(positions);
  }
  return frames;
}

std::vector<fs::path> accepted_streams() {
  std::vector<fs::path> paths;
  for (const char* version : {"v1.0", "v1.1", "v1.2"}) {
    const fs::path folder = fs::path(RLPC_SOURCE_DIR) / "streams" / version / "accept";
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() == ".rlpc" && entry.file_size() < 20000) {
        paths.push_back(entry.path());
      }
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

TEST(SeekingDecoder, DecodesFramesInAnyOrderWhileTheStreamIsBeingLoaded) {
  std::mt19937 random(1);
  const auto paths = accepted_streams();
  ASSERT_GT(paths.size(), 50U);
  for (const fs::path& path : paths) {
    SCOPED_TRACE(path);
    Loaded loaded{contents(path), {}, 0, 0};
    const auto frames = decoded_in_order(loaded.bytes);
    ASSERT_FALSE(frames.empty());
    SeekingDecoder decoder([&] { return std::make_unique<LoadedSource>(loaded); }, {});
    ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.open(); }));
    ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.find_index(); }));
    EXPECT_TRUE(std::is_sorted(decoder.landmarks().begin(), decoder.landmarks().end()));
    for (int i = 0; i < 12; ++i) {
      const auto f = static_cast<std::uint32_t>(random() % frames.size());
      ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.decode(f); })) << f;
      EXPECT_FALSE(decoder.hash_differs());
      const Positions positions(decoder.positions().begin(), decoder.positions().end());
      EXPECT_EQ(positions, frames[f]) << f;
    }
    // What a frame leaves behind may depend on both, so all pairs of the first frames follow.
    const auto few = static_cast<std::uint32_t>(std::min<std::size_t>(frames.size(), 6));
    for (std::uint32_t i = 0; i < 2 * few * few; ++i) {
      const std::uint32_t f = i % 2 == 0 ? i / 2 / few : i / 2 % few;
      ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.decode(f); })) << f;
      const Positions positions(decoder.positions().begin(), decoder.positions().end());
      ASSERT_EQ(positions, frames[f]) << i;
    }
    const auto last = static_cast<std::uint32_t>(frames.size() - 1);
    ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.decode(last); }));
    EXPECT_TRUE(completed(loaded, decoder, [&] { return decoder.finish(); }));
  }
}

bool same_sets(const Vector<AttributeSet>& a, const Vector<AttributeSet>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.header == y.header && x.values == y.values &&
           x.value_of_corner == y.value_of_corner && x.face_of_triangle == y.face_of_triangle;
  });
}

TEST(SeekingDecoder, DecodesAttributesBetweenFramesWhileTheStreamIsBeingLoaded) {
  std::size_t num_sets = 0;
  for (const fs::path& path : accepted_streams()) {
    const Bytes bytes = contents(path);
    auto whole = Decoder::open(memory_source(bytes));
    ASSERT_TRUE(whole) << path;
    if (!whole->has_attributes()) continue;
    SCOPED_TRACE(path);
    const auto wanted = whole->attributes();
    ASSERT_TRUE(wanted);
    num_sets += wanted->size();
    const auto frames = decoded_in_order(bytes);
    const auto last = static_cast<std::uint32_t>(frames.size() - 1);
    for (const bool comes_first : {true, false}) {
      Loaded loaded{bytes, {}, 0, 0};
      SeekingDecoder decoder([&] { return std::make_unique<LoadedSource>(loaded); }, {});
      ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.open(); }));
      const auto decode_last = [&] {
        return completed(loaded, decoder, [&] { return decoder.decode(last); });
      };
      ASSERT_TRUE(comes_first || decode_last());
      ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.decode_attributes(); }));
      EXPECT_TRUE(same_sets(decoder.sets(), *wanted));
      EXPECT_EQ(decoder.drawn().vertices().triangles.size(), whole->triangles().size());
      ASSERT_TRUE(!comes_first || decode_last());
      EXPECT_EQ(Positions(decoder.positions().begin(), decoder.positions().end()),
                frames[last]);
      EXPECT_TRUE(completed(loaded, decoder, [&] { return decoder.finish(); }));
    }
  }
  EXPECT_GT(num_sets, 50U);
}

TEST(SeekingDecoder, ReadsAnAssetWhileTheStreamIsBeingLoaded) {
  const Bytes bytes = contents(fs::path(RLPC_SOURCE_DIR) / "streams" / "v1.2" / "accept" /
                               "AST" / "AST-0001a.rlpc");
  Loaded loaded{bytes, {}, 0, 0};
  SeekingDecoder decoder([&] { return std::make_unique<LoadedSource>(loaded); }, {});
  ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.open(); }));
  ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.read_asset(); }));
  auto whole = Decoder::open(memory_source(bytes));
  ASSERT_TRUE(whole);
  EXPECT_EQ(decoder.asset(), *whole->asset());
  EXPECT_FALSE(decoder.asset().empty());
}

TEST(SeekingDecoder, FramesAreDecodedAfterAnErrorOfAttributes) {
  const fs::path folder = fs::path(RLPC_SOURCE_DIR) / "streams" / "v1.2" / "either";
  std::size_t num_errors = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".rlpc") continue;
    SCOPED_TRACE(entry.path());
    Loaded loaded{contents(entry.path()), {}, 0, 0};
    const auto frames = decoded_in_order(loaded.bytes);
    if (frames.empty()) continue;
    SeekingDecoder decoder([&] { return std::make_unique<LoadedSource>(loaded); }, {});
    ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.open(); }));
    if (completed(loaded, decoder, [&] { return decoder.decode_attributes(); })) continue;
    ++num_errors;
    for (std::uint32_t f = 0; f < frames.size(); ++f) {
      ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.decode(f); })) << f;
      EXPECT_EQ(Positions(decoder.positions().begin(), decoder.positions().end()), frames[f]);
    }
  }
  EXPECT_GT(num_errors, 0U);
}

TEST(SeekingDecoder, OfAnotherFrameLoadsNoMoreThanItsGof) {
  const Bytes bytes = contents(fs::path(RLPC_SOURCE_DIR) / "streams" / "v1.0" / "accept" /
                               "IDX" / "IDX-0001a.rlpc");
  Loaded loaded{bytes, {}, 0, 0};
  const auto frames = decoded_in_order(bytes);
  ASSERT_GT(frames.size(), 1U);
  SeekingDecoder decoder([&] { return std::make_unique<LoadedSource>(loaded); }, {});
  ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.open(); }));
  ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.find_index(); }));
  const auto last = static_cast<std::uint32_t>(frames.size() - 1);
  ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.decode(last); }));
  EXPECT_LT(loaded.blocks.size() * Loaded::kBlock, bytes.size());
}

TEST(SeekingDecoder, CountsTheFramesOfAStreamThatWasCutOff) {
  const Bytes whole = contents(fs::path(RLPC_SOURCE_DIR) / "streams" / "v1.2" / "accept" /
                               "FRM" / "FRM-0030a.rlpc");
  const auto count = [&](std::size_t size) {
    const Bytes bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    SeekingDecoder decoder([&] { return memory_source(bytes); }, {});
    return decoder.open() ? decoder.num_frames() : 0;
  };
  EXPECT_EQ(count(whole.size()), 5U);  // in GOFs of 3 and 2
  EXPECT_EQ(count(whole.size() - 1), 3U);
  EXPECT_EQ(count(whole.size() / 3), 1U);
}

TEST(SeekingDecoder, DeliversAFrameThatDoesNotMatchItsHash) {
  const fs::path folder = fs::path(RLPC_SOURCE_DIR) / "streams" / "v1.0";
  Loaded loaded{contents(folder / "reject" / "HSH" / "HSH-0001x1.rlpc"), {}, 0, 0};
  const auto right = decoded_in_order(contents(folder / "accept" / "HSH" / "HSH-0001a.rlpc"));
  SeekingDecoder decoder([&] { return std::make_unique<LoadedSource>(loaded); }, {});
  ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.open(); }));
  ASSERT_TRUE(completed(loaded, decoder, [&] { return decoder.decode(0); }));
  EXPECT_TRUE(decoder.hash_differs());
  EXPECT_EQ(decoder.error().rule, std::string("R-HSH-02"));
  EXPECT_EQ(Positions(decoder.positions().begin(), decoder.positions().end()), right[0]);
}

}  // namespace
}  // namespace rlpc
