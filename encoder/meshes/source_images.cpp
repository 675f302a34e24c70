#include "encoder/meshes/source_images.h"

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1A\n";
constexpr std::size_t kAroundData = 12;                    // bytes of a chunk besides its data
constexpr std::size_t kBuffer = std::size_t{1} << 16;      // bytes
constexpr std::uint64_t kMaxRaw = std::uint64_t{1} << 28;  // fixed: time, some 17 s
constexpr std::uint64_t kSample = std::uint64_t{1} << 20;  // fixed: 32 windows of zlib

std::span<const std::uint8_t> octets(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Continues `crc` over more bytes; starts from 0.
std::uint32_t crc_of(std::string_view text, std::uint32_t crc = 0) {
  return static_cast<std::uint32_t>(crc32_z(crc, octets(text).data(), text.size()));
}

std::uint32_t u32_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (const std::uint8_t octet : octets(bytes.substr(at, 4))) value = value << 8 | octet;
  return value;
}

void append_u32(std::uint32_t value, std::string& bytes) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes += static_cast<char>(value >> shift & 0xFF);
}

// The places of the parts of a PNG file.
struct Png {
  std::size_t data_begin = 0;          // of the first IDAT chunk
  std::size_t data_end = 0;            // of the last
  std::vector<std::string_view> data;  // contents of the IDAT chunks, a zlib stream
};

// Returns nothing unless the file consists of chunks up to IEND with right checksums, of which
// IDAT chunks follow each other.
std::optional<Png> parse(std::string_view bytes) {
  if (!bytes.starts_with(kSignature)) return std::nullopt;
  Png png;
  std::size_t at = kSignature.size();
  for (std::string_view type; type != "IEND";) {
    if (bytes.size() - at < kAroundData) return std::nullopt;
    const std::size_t size = u32_at(bytes, at);
    if (size > bytes.size() - at - kAroundData) return std::nullopt;
    const std::string_view chunk = bytes.substr(at + 4, 4 + size);
    if (u32_at(bytes, at + 8 + size) != crc_of(chunk)) return std::nullopt;
    type = chunk.substr(0, 4);
    if (type == "IDAT") {
      if (png.data.empty()) png.data_begin = at;
      if (!png.data.empty() && at != png.data_end) return std::nullopt;
      png.data.push_back(chunk.substr(4));
      png.data_end = at + kAroundData + size;
    }
    at += kAroundData + size;
  }
  if (png.data.empty() || at != bytes.size()) return std::nullopt;
  return png;
}

// Inflates a zlib stream that lies in several pieces.
class Inflater {
 public:
  explicit Inflater(const std::vector<std::string_view>& pieces) : pieces_(pieces) {
    if (inflateInit(&state_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&state_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  std::uint64_t bytes_read() const { return state_.total_in; }
  // Returns the next bytes, at least one and at most as many as the buffer has; none at the end
  // of the stream, or where it is wrong.
  std::string_view next(std::span<char> buffer) {
    state_.next_out = reinterpret_cast<Bytef*>(buffer.data());
    state_.avail_out = static_cast<uInt>(buffer.size());
    while (state_.avail_out == buffer.size() && status_ == Z_OK) {
      if (state_.avail_in == 0 && piece_ < pieces_.size()) {
        const std::string_view piece = pieces_[piece_++];
        // zlib does not write to its input, but its member is not const.
        state_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
        state_.avail_in = static_cast<uInt>(piece.size());
        continue;
      }
      status_ = inflate(&state_, Z_NO_FLUSH);
    }
    return {buffer.data(), buffer.size() - state_.avail_out};
  }
  // Whether the stream has ended as it should, with the last of its bytes.
  bool is_complete() const {
    return status_ == Z_STREAM_END && state_.avail_in == 0 && piece_ == pieces_.size();
  }

 private:
  const std::vector<std::string_view>& pieces_;
  std::size_t piece_ = 0;  // the next
  z_stream state_{};
  int status_ = Z_OK;
};

// Deflates bytes at the best level.
class Deflater {
 public:
  Deflater() {
    if (deflateInit(&state_, Z_BEST_COMPRESSION) != Z_OK) throw std::bad_alloc();
  }
  ~Deflater() { deflateEnd(&state_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  // Appends to the zlib stream, if it is kept. bytes: fewer than 2^32.
  void add(std::string_view bytes, std::string* stream = nullptr) {
    run(bytes, Z_NO_FLUSH, stream);
  }
  // Ends the stream. Returns the number of its bytes. Call it once.
  std::uint64_t finish(std::string* stream = nullptr) {
    run({}, Z_FINISH, stream);
    return state_.total_out;
  }

 private:
  void run(std::string_view bytes, int flush, std::string* stream) {
    state_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    state_.avail_in = static_cast<uInt>(bytes.size());
    do {
      state_.next_out = reinterpret_cast<Bytef*>(buffer_.data());
      state_.avail_out = static_cast<uInt>(buffer_.size());
      deflate(&state_, flush);
      if (stream) stream->append(buffer_.data(), buffer_.size() - state_.avail_out);
    } while (state_.avail_out == 0);
  }

  z_stream state_{};
  std::vector<char> buffer_ = std::vector<char>(kBuffer);
};

std::uint64_t deflated_size(std::string_view bytes) {
  Deflater deflater;
  for (std::size_t at = 0; at < bytes.size(); at += kBuffer) {
    deflater.add(bytes.substr(at, kBuffer));
  }
  return deflater.finish();
}

// Whether the part in the middle of the stream becomes smaller; `size`: bytes of the stream.
bool is_worth_it(const Png& png, std::uint64_t size) {
  std::vector<char> buffer(kBuffer);
  Inflater inflater(png.data);
  std::uint64_t skipped = 0;
  while (inflater.bytes_read() < size / 2) {
    const std::string_view part = inflater.next(buffer);
    skipped += part.size();
    if (part.empty() || skipped > kMaxRaw) return false;
  }
  const std::uint64_t begin = inflater.bytes_read();
  Deflater deflater;
  for (std::uint64_t sampled = 0; sampled < kSample;) {
    const std::string_view part = inflater.next(buffer);
    if (part.empty()) break;
    deflater.add(part);
    sampled += part.size();
  }
  // fixed: An image that gains less was deflated well; all of it would take ten times as long.
  constexpr double kGain = 0.98;
  const auto before = static_cast<double>(inflater.bytes_read() - begin);
  return static_cast<double>(deflater.finish()) <= kGain * before;
}

// Appends the zlib stream of the image deflated again. Returns whether it is right and not too
// long.
bool deflate_again(const Png& png, std::string& stream) {
  std::vector<char> buffer(kBuffer);
  Inflater inflater(png.data);
  Deflater deflater;
  std::uint64_t raw = 0;
  for (;;) {
    const std::string_view part = inflater.next(buffer);
    if (part.empty()) break;
    raw += part.size();
    if (raw > kMaxRaw) return false;
    deflater.add(part, &stream);
  }
  deflater.finish(&stream);
  return inflater.is_complete();
}

}  // namespace

std::string smaller_png(std::string bytes) {
  const std::optional<Png> png = parse(bytes);
  if (!png) return bytes;
  std::uint64_t size = 0;
  for (const std::string_view piece : png->data) size += piece.size();
  if (!is_worth_it(*png, size)) return bytes;
  constexpr std::string_view kType = "IDAT";
  std::string deflated;
  if (!deflate_again(*png, deflated) || deflated.size() >= size) return bytes;
  std::string smaller = bytes.substr(0, png->data_begin);
  append_u32(static_cast<std::uint32_t>(deflated.size()), smaller);
  smaller += kType;
  smaller += deflated;
  append_u32(crc_of(deflated, crc_of(kType)), smaller);
  smaller += std::string_view(bytes).substr(png->data_end);
  return deflated_size(smaller) < deflated_size(bytes) ? smaller : bytes;
}

}  // namespace rlpc
