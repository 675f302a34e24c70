#include "common/files/bounded_input.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace rlpc {
namespace {

using State = PipedInput::State;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

constexpr std::uint64_t kNoBound = std::numeric_limits<std::uint64_t>::max();

std::vector<std::uint8_t> some_bytes(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  std::uint32_t state = 1;
  for (std::uint8_t& byte : bytes) {
    state = state * 1664525 + 1013904223;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  return bytes;
}

File file_with(const std::vector<std::uint8_t>& bytes) {
  File file(std::tmpfile(), &std::fclose);
  std::fwrite(bytes.data(), 1, bytes.size(), file.get());
  std::rewind(file.get());
  return file;
}

TEST(PipedInput, ReturnsWhatItRead) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{65},
        kBlock, kBlock + 64, kBlock + 65, 3 * kBlock + 7}) {
    const auto bytes = some_bytes(size);
    const File file = file_with(bytes);
    PipedInput input(file.get());
    EXPECT_EQ(input.beginning().size(), std::min<std::size_t>(size, 64));
    ASSERT_EQ(input.read_rest(kNoBound), State::kWhole);
    ASSERT_EQ(input.size(), size);
    std::vector<std::uint8_t> all(size);
    input.copy(0, all);
    EXPECT_EQ(all, bytes);
    for (std::size_t at = 0; at + 3 < size; at += size / 17 + 1) {  // across blocks, too
      std::vector<std::uint8_t> part(std::min(size - at, kBlock + 2));
      input.copy(at, part);
      EXPECT_TRUE(
          std::equal(part.begin(), part.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at)))
          << size << " " << at;
    }
  }
}

TEST(PipedInput, StopsBeyondItsLimit) {
  const auto bytes = some_bytes((std::size_t{3} << 20) + 100);
  for (const std::uint64_t bound : {std::uint64_t{0}, std::uint64_t{10}, std::uint64_t{64},
                                    std::uint64_t{1000}, std::uint64_t{bytes.size() - 1}}) {
    const File file = file_with(bytes);
    PipedInput input(file.get());
    EXPECT_EQ(input.read_rest(bound), State::kTooLarge) << bound;
    EXPECT_LE(input.size(), 64);
  }
  const File file = file_with(bytes);
  PipedInput input(file.get());
  EXPECT_EQ(input.read_rest(bytes.size()), State::kWhole);
}

TEST(PipedInput, ReadsNoMoreThanNecessary) {
  const File file(std::fopen("/dev/zero", "rb"), &std::fclose);
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  PipedInput input(file.get());
  EXPECT_EQ(input.beginning().size(), 64);
  EXPECT_EQ(input.read_rest(5000000), State::kTooLarge);
}

TEST(PipedInput, ReportsThatReadingFailed) {
  const File folder(std::fopen("/", "rb"), &std::fclose);  // opens, but cannot be read
  PipedInput input(folder.get());
  EXPECT_EQ(input.read_rest(kNoBound), State::kFailed);
}

TEST(SmallFile, HasALimit) {
  const std::string path = testing::TempDir() + "/bounded_input_small_file";
  const File file(std::fopen(path.c_str(), "wb"), &std::fclose);
  std::fputs("12345", file.get());
  std::fflush(file.get());
  EXPECT_EQ(read_small_file(path, 5), "12345");
  EXPECT_FALSE(read_small_file(path, 4));
  EXPECT_FALSE(read_small_file("/dev/zero", 1000000));
  std::filesystem::remove(path);
  EXPECT_FALSE(read_small_file(path, 5));
}

}  // namespace
}  // namespace rlpc
