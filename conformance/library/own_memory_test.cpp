// librlpcdec with the caller's allocator: all memory of a decoder comes from it, and goes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "decoder/c_api/rlpc_c_decoder.h"

namespace {

// Whether a decoder with one thread is running.
bool is_decoding = false;
std::size_t num_news = 0;  // calls of operator new in that time

void* take(std::size_t size) {
  if (is_decoding) ++num_news;
  void* const place = std::malloc(size);
  if (place == nullptr) std::abort();
  return place;
}

}  // namespace

void* operator new(std::size_t size) { return take(size); }
void* operator new[](std::size_t size) { return take(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return take(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return take(size); }
void* operator new(std::size_t size, std::align_val_t) { return take(size); }
void operator delete(void* place) noexcept { std::free(place); }
void operator delete[](void* place) noexcept { std::free(place); }
void operator delete(void* place, std::size_t) noexcept { std::free(place); }
void operator delete[](void* place, std::size_t) noexcept { std::free(place); }
void operator delete(void* place, std::align_val_t) noexcept { std::free(place); }
void operator delete(void* place, std::size_t, std::align_val_t) noexcept { std::free(place); }

namespace {

namespace fs = std::filesystem;

// Checks that blocks come back as they went.
class Heap {
 public:
  rlpc_allocator allocator() { return {this, allocate, release}; }

  std::size_t calls_left = std::numeric_limits<std::size_t>::max();
  std::size_t calls = 0;
  std::size_t now = 0;  // bytes
  std::size_t peak = 0;
  std::size_t wrong = 0;

 private:
  // Excludes the bookkeeping of the heap from the decoder's memory.
  class Apart {
   public:
    Apart() : before_(std::exchange(is_decoding, false)) {}
    ~Apart() { is_decoding = before_; }
    Apart(const Apart&) = delete;
    Apart& operator=(const Apart&) = delete;

   private:
    bool before_;
  };

  static void* allocate(void* user, std::size_t size, std::size_t alignment) {
    auto& heap = *static_cast<Heap*>(user);
    const std::lock_guard lock(heap.mutex_);
    if (heap.calls_left == 0) return nullptr;
    --heap.calls_left;
    ++heap.calls;
    const Apart apart;
    void* const place =
        std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    heap.blocks_[place] = {size, alignment};
    heap.now += size;
    heap.peak = std::max(heap.peak, heap.now);
    return place;
  }
  static void release(void* user, void* place, std::size_t size, std::size_t alignment) {
    auto& heap = *static_cast<Heap*>(user);
    const std::lock_guard lock(heap.mutex_);
    const Apart apart;
    const auto found = heap.blocks_.find(place);
    if (found == heap.blocks_.end() || found->second != std::pair{size, alignment}) {
      ++heap.wrong;
      return;
    }
    heap.now -= size;
    heap.blocks_.erase(found);
    std::free(place);
  }

  std::mutex mutex_;
  std::map<void*, std::pair<std::size_t, std::size_t>> blocks_;
};

using Bytes = std::vector<unsigned char>;

Bytes read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Returns small streams of all versions and kinds of GOF.
std::vector<fs::path> streams() {
  constexpr std::uintmax_t kMaxBytes = 20000;
  std::vector<fs::path> found;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(RLPC_SOURCE_DIR) / "streams")) {
    const bool is_accepted = entry.path().string().find("accept") != std::string::npos;
    if (entry.path().extension() == ".rlpc" && is_accepted && entry.file_size() <= kMaxBytes) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Decodes all frames forward, then some backward with normals.
rlpc_status decode(const Bytes& stream, Heap* heap, std::uint32_t threads) {
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.threads = threads;
  if (heap != nullptr) options.allocator = heap->allocator();
  std::vector<float> xyz;
  std::vector<float> normals;
  is_decoding = threads == 1;
  rlpc_decoder* decoder = nullptr;
  rlpc_status status =
      rlpc_decoder_open_memory(stream.data(), stream.size(), &options, &decoder);
  rlpc_stream_info info{};
  if (status == RLPC_OK) status = rlpc_decoder_info(decoder, &info, sizeof info);
  is_decoding = false;
  xyz.resize(3 * std::size_t{info.num_vertices});
  normals.resize(xyz.size());
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.positions = {xyz.data(), xyz.size() * sizeof(float), 0, RLPC_FORMAT_FLOAT};
  is_decoding = threads == 1;
  while (status == RLPC_OK) status = rlpc_decoder_next(decoder, &output);
  output.normals = {normals.data(), normals.size() * sizeof(float), 0, RLPC_FORMAT_FLOAT};
  if (status == RLPC_END) status = RLPC_OK;
  for (std::uint32_t f = info.num_frames; status == RLPC_OK && f-- > 0;) {
    status = rlpc_decoder_frame(decoder, f, &output);
  }
  rlpc_decoder_close(decoder);
  is_decoding = false;
  return status;
}

TEST(OwnMemory, AllOfItComesFromTheCallerAndGoesBack) {
  std::size_t decoded = 0;
  for (const fs::path& path : streams()) {
    const Bytes stream = read(path);
    Heap heap;
    num_news = 0;
    if (decode(stream, &heap, 1) != RLPC_OK) continue;
    ++decoded;
    EXPECT_EQ(num_news, 0U) << path;
    EXPECT_GT(heap.calls, 10U) << path;
    EXPECT_GT(heap.peak, 1000U) << path;
    EXPECT_EQ(heap.now, 0U) << path;
    EXPECT_EQ(heap.wrong, 0U) << path;
  }
  EXPECT_GT(decoded, 100U);
}

TEST(OwnMemory, WithoutItMemoryComesFromOperatorNew) {
  num_news = 0;
  ASSERT_EQ(decode(read(streams().front()), nullptr, 1), RLPC_OK);
  EXPECT_GT(num_news, 10U);
}

TEST(OwnMemory, SeveralThreadsUseItToo) {
  std::size_t decoded = 0;
  for (const fs::path& path : streams()) {
    const Bytes stream = read(path);
    Heap heap;
    if (decode(stream, &heap, 3) != RLPC_OK) continue;
    ++decoded;
    EXPECT_EQ(heap.now, 0U) << path;
    EXPECT_EQ(heap.wrong, 0U) << path;
    if (decoded == 40) break;
  }
  EXPECT_EQ(decoded, 40U);
}

TEST(OwnMemory, WithoutItDecodingEndsAndAllGoesBack) {
  std::size_t ended = 0;
  std::size_t tried = 0;
  for (const fs::path& path : streams()) {
    const Bytes stream = read(path);
    Heap whole;
    if (decode(stream, &whole, 1) != RLPC_OK) continue;
    for (std::size_t calls = 0; calls < whole.calls; calls += 1 + calls / 3) {
      Heap heap;
      heap.calls_left = calls;
      const rlpc_status status = decode(stream, &heap, 1);
      EXPECT_EQ(status, RLPC_OUT_OF_MEMORY) << path << " after " << calls;
      EXPECT_EQ(heap.now, 0U) << path << " after " << calls;
      EXPECT_EQ(heap.wrong, 0U) << path << " after " << calls;
      if (status == RLPC_OUT_OF_MEMORY) ++ended;
    }
    if (++tried == 30) break;
  }
  EXPECT_GT(ended, 300U);
}

TEST(OwnMemory, HalfAnAllocatorIsRefused) {
  Heap heap;
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.allocator = heap.allocator();
  options.allocator.release = nullptr;
  rlpc_decoder* decoder = nullptr;
  EXPECT_EQ(rlpc_decoder_open_memory("", 0, &options, &decoder), RLPC_BAD_ARGUMENT);
  EXPECT_EQ(decoder, nullptr);
}

}  // namespace
