#include "encoder/meshes/source_images.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes += static_cast<char>(value >> shift & 0xFF);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string named = type + data;
  const uLong crc =
      crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + named +
         big_endian(static_cast<std::uint32_t>(crc));
}

std::string deflated(const std::string& raw, int level) {
  uLongf size = compressBound(static_cast<uLong>(raw.size()));
  std::string bytes(size, '\0');
  compress2(reinterpret_cast<Bytef*>(bytes.data()), &size,
            reinterpret_cast<const Bytef*>(raw.data()), static_cast<uLong>(raw.size()), level);
  bytes.resize(size);
  return bytes;
}

std::string inflated(const std::string& bytes, std::size_t size) {
  std::string raw(size + 1, '\0');
  uLongf count = raw.size();
  const int status = uncompress(reinterpret_cast<Bytef*>(raw.data()), &count,
                                reinterpret_cast<const Bytef*>(bytes.data()),
                                static_cast<uLong>(bytes.size()));
  EXPECT_EQ(status, Z_OK);
  raw.resize(count);
  return raw;
}

// Returns grey scanlines with a filter byte each, which the levels of zlib tell apart.
std::string scanlines(std::uint32_t width, std::uint32_t height) {
  std::string raw;
  std::uint32_t state = 1;
  for (std::uint32_t y = 0; y < height; ++y) {
    raw += '\0';
    for (std::uint32_t x = 0; x < width; ++x) {
      state = 1664525 * state + 1013904223;
      raw += static_cast<char>(state >> 24 < 40 ? state >> 28 : (x * x / 64 + y / 8) & 0x3F);
    }
  }
  return raw;
}

const std::string kSignature = "\x89PNG\r\n\x1A\n";

// The parts of a PNG file around its IDAT chunks.
std::string head(std::uint32_t width, std::uint32_t height) {
  return kSignature +
         chunk("IHDR",
               big_endian(width) + big_endian(height) + std::string("\x08\0\0\0\0", 5)) +
         chunk("gAMA", big_endian(45455)) + chunk("tEXt", std::string("Title\0image", 11));
}
std::string tail() {
  return chunk("tIME", std::string("\x07\xE0\1\1\0\0\0", 7)) + chunk("IEND", "");
}

// Cuts a zlib stream into IDAT chunks.
std::string data_chunks(const std::string& stream, std::size_t size) {
  std::string chunks;
  for (std::size_t at = 0; at < stream.size(); at += size) {
    chunks += chunk("IDAT", stream.substr(at, size));
  }
  return chunks;
}

struct Image {
  std::uint32_t width = 300;
  std::uint32_t height = 200;
  std::string raw = scanlines(width, height);

  std::string file(int level, std::size_t size = 1000) const {
    return head(width, height) + data_chunks(deflated(raw, level), size) + tail();
  }
};

TEST(SmallerPng, KeepsScanlinesAndOtherChunks) {
  const Image image;
  const std::string file = image.file(Z_BEST_SPEED);
  const std::string smaller = smaller_png(file);
  EXPECT_LT(smaller.size(), file.size());
  const std::string before = head(image.width, image.height);
  ASSERT_TRUE(smaller.starts_with(before));
  ASSERT_TRUE(smaller.ends_with(tail()));
  const std::string data =
      smaller.substr(before.size(), smaller.size() - before.size() - tail().size());
  ASSERT_GE(data.size(), 12U);
  const std::string stream = data.substr(8, data.size() - 12);
  EXPECT_EQ(data, chunk("IDAT", stream));
  EXPECT_EQ(inflated(stream, image.raw.size()), image.raw);
}

TEST(SmallerPng, SamplesTheMiddleOfLongImages) {
  Image image{.width = 2047, .height = 2000};
  EXPECT_LT(smaller_png(image.file(Z_BEST_SPEED)).size(), image.file(Z_BEST_SPEED).size());
  const std::string best = image.file(Z_BEST_COMPRESSION, std::size_t{1} << 20);
  EXPECT_EQ(smaller_png(best), best);
}

TEST(SmallerPng, KeepsWhatItCannotImprove) {
  const Image image;
  const std::string best = image.file(Z_BEST_COMPRESSION, std::size_t{1} << 20);
  EXPECT_EQ(smaller_png(best), best);
}

// The asset is deflated as a whole: stored scanlines take no more bytes there.
TEST(SmallerPng, CountsTheBytesInAStream) {
  const std::string raw(100000, '\0');
  const std::string file =
      head(99999, 1) + chunk("IDAT", deflated(raw, Z_NO_COMPRESSION)) + tail();
  const std::string smaller = smaller_png(file);
  EXPECT_LE(deflated(smaller, Z_BEST_COMPRESSION).size(),
            deflated(file, Z_BEST_COMPRESSION).size());
}

TEST(SmallerPng, ReturnsOtherBytesAsTheyAre) {
  const Image image;
  const std::string stream = deflated(image.raw, Z_BEST_SPEED);
  const std::string begin = head(image.width, image.height);
  std::string wrong_stream = stream;
  wrong_stream[stream.size() / 2] ^= 0x55;
  std::string wrong_adler = stream;
  wrong_adler.back() ^= 1;
  std::string wrong_crc = image.file(Z_BEST_SPEED);
  wrong_crc[wrong_crc.size() - tail().size() - 1] ^= 1;
  const std::vector<std::pair<std::string, std::string>> files{
      {"empty", ""},
      {"JPEG", "\xFF\xD8\xFF\xE0" + image.raw},
      {"signature alone", kSignature},
      {"no IDAT", begin + tail()},
      {"empty IDAT", begin + chunk("IDAT", "") + tail()},
      {"IDAT chunks apart", begin + chunk("IDAT", stream.substr(0, 500)) + chunk("tEXt", "a") +
                                chunk("IDAT", stream.substr(500)) + tail()},
      {"bytes after IEND", image.file(Z_BEST_SPEED) + "a"},
      {"bytes after the zlib stream", begin + chunk("IDAT", stream + "a") + tail()},
      {"a chunk after the zlib stream",
       begin + chunk("IDAT", stream) + chunk("IDAT", "a") + tail()},
      {"cut zlib stream", begin + chunk("IDAT", stream.substr(0, stream.size() - 5)) + tail()},
      {"wrong zlib stream", begin + chunk("IDAT", wrong_stream) + tail()},
      {"wrong Adler-32", begin + chunk("IDAT", wrong_adler) + tail()},
      {"wrong CRC", wrong_crc},
      {"no IEND", begin + chunk("IDAT", stream)},
      {"chunk longer than the file", begin + big_endian(0xFFFFFFFFU) + "IDAT" + stream},
  };
  for (const auto& [name, file] : files) EXPECT_EQ(smaller_png(file), file) << name;
}

TEST(SmallerPng, ReturnsEveryPrefixAsItIs) {
  const Image image{.width = 40, .height = 30};
  const std::string file = image.file(Z_NO_COMPRESSION, 100);
  ASSERT_LT(smaller_png(file).size(), file.size());
  for (std::size_t size = 0; size < file.size(); ++size) {
    const std::string part = file.substr(0, size);
    ASSERT_EQ(smaller_png(part), part) << size;
  }
}

}  // namespace
}  // namespace rlpc
