#include "common/io/bounded_input.h"

#include <algorithm>
#include <cassert>
#include <memory>

namespace rlpc {
namespace {

constexpr std::size_t kBeginningBytes = 64;
constexpr std::size_t kBlockBytes = std::size_t{1} << 20;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

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

void PipedInput::read_block(std::size_t bytes) {
  std::vector<std::uint8_t> block(bytes);
  block.resize(std::fread(block.data(), 1, bytes, file_));
  if (block.size() < bytes) {
    state_ = std::ferror(file_) != 0 ? State::kFailed : State::kWhole;
    block.shrink_to_fit();
  }
  size_ += block.size();
  blocks_.push_back(std::move(block));
}

PipedInput::State PipedInput::read_rest(std::uint64_t max_bytes) {
  beginning();
  while (state_ == State::kReading && size_ <= max_bytes) {
    // One byte more than allowed, to detect excess.
    read_block(
        static_cast<std::size_t>(std::min<std::uint64_t>(kBlockBytes, max_bytes - size_ + 1)));
  }
  if (size_ > max_bytes) {
    state_ = State::kTooLarge;
    blocks_ = {};
    size_ = beginning_.size();
  }
  return state_;
}

void PipedInput::copy(std::uint64_t offset, std::span<std::uint8_t> out) const {
  assert(offset <= size_ && out.size() <= size_ - offset);
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
