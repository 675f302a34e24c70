#include "common/files/bounded_input.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <memory>

#include "common/memory/owned.h"

namespace rlpc {
namespace {

constexpr std::size_t kBeginningBytes = 64;
constexpr std::size_t kBlockBytes = std::size_t{1} << 20;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

// Disables buffering, so that reading waits only for the requested bytes.
PipedInput::PipedInput(std::FILE* file) : file_(file) {
  std::setvbuf(file, nullptr, _IONBF, 0);
}

std::span<const std::uint8_t> PipedInput::beginning() {
  if (state_ == State::kReading && size_ == 0) {
    beginning_.resize(kBeginningBytes);
    beginning_.resize(std::fread(beginning_.data(), 1, kBeginningBytes, file_));
    size_ = beginning_.size();
    if (size_ < kBeginningBytes) {
      state_ = std::ferror(file_) != 0 ? State::kFailed : State::kWhole;
    }
  }
  return beginning_;
}

void PipedInput::read_more(std::uint64_t bytes) {
  if (blocks_.empty() || blocks_.back().size() == kBlockBytes) blocks_.emplace_back();
  Vector<std::uint8_t>& block = blocks_.back();
  const std::size_t before = block.size();
  const auto wanted =
      static_cast<std::size_t>(std::min<std::uint64_t>(bytes, kBlockBytes - before));
  block.resize(before + wanted);
  const std::size_t got = std::fread(&block[before], 1, wanted, file_);
  if (got < wanted) {
    state_ = std::ferror(file_) != 0 ? State::kFailed : State::kWhole;
    block.resize(before + got);
    block.shrink_to_fit();
  }
  size_ += got;
}

PipedInput::State PipedInput::read_to(std::uint64_t end, std::uint64_t max_bytes) {
  beginning();
  while (state_ == State::kReading && size_ < end && kept_bytes() <= max_bytes) {
    // One byte more than allowed, to detect excess.
    read_more(std::min(end - size_, max_bytes - kept_bytes() + 1));
  }
  if (kept_bytes() > max_bytes) {
    state_ = State::kTooLarge;
    blocks_ = {};
    size_ = beginning_.size();
    forgotten_ = 0;
  }
  return state_;
}

PipedInput::State PipedInput::read_rest(std::uint64_t max_bytes) {
  return read_to(std::numeric_limits<std::uint64_t>::max(), max_bytes);
}

void PipedInput::forget(std::uint64_t before) {
  const std::uint64_t behind = before - std::min<std::uint64_t>(before, beginning_.size());
  while (forgotten_ + kBlockBytes <= behind) {
    blocks_[static_cast<std::size_t>(forgotten_ / kBlockBytes)] = {};
    forgotten_ += kBlockBytes;
  }
}

void PipedInput::copy(std::uint64_t offset, std::span<std::uint8_t> out) const {
  assert(offset <= size_ && out.size() <= size_ - offset && keeps(offset));
  while (!out.empty()) {
    const bool first = offset < beginning_.size();
    const std::uint64_t behind = first ? 0 : offset - beginning_.size();
    const auto& block =
        first ? beginning_ : blocks_[static_cast<std::size_t>(behind / kBlockBytes)];
    const auto at = static_cast<std::size_t>(first ? offset : behind % kBlockBytes);
    const std::size_t count = std::min(out.size(), block.size() - at);
    std::copy_n(block.begin() + static_cast<std::ptrdiff_t>(at), count, out.begin());
    out = out.subspan(count);
    offset += count;
  }
}

std::optional<std::string> read_small_file(const std::string& path, std::size_t max_bytes) {
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) return std::nullopt;
  PipedInput input(file.get());
  if (input.read_rest(max_bytes) != PipedInput::State::kWhole) return std::nullopt;
  std::string text(static_cast<std::size_t>(input.size()), '\0');
  input.copy(0, {reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
  return text;
}

}  // namespace rlpc
