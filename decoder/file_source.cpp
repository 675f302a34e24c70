#include "decoder/file_source.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <span>
#include <utility>

#include "common/codec/syntax/stream_format.h"
#include "common/files/bounded_input.h"

namespace rlpc {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

class FileSource final : public ByteSource {
 public:
  FileSource(File file, std::uint64_t size) : file_(std::move(file)), size_(size) {}
  std::uint64_t size() const override { return size_; }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > size_ || out.size() > size_ - offset) return false;
    if (fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) return false;
    return std::fread(out.data(), 1, out.size(), file_.get()) == out.size();
  }

 private:
  File file_;
  std::uint64_t size_;
};

class PipedSource final : public ByteSource {
 public:
  // file: null if it is not owned.
  PipedSource(PipedInput input, File file, std::uint64_t max_bytes)
      : file_(std::move(file)), input_(std::move(input)), max_bytes_(max_bytes) {}
  std::uint64_t size() const override {
    input_.read_rest(max_bytes_);
    return input_.size();
  }
  bool reaches(std::uint64_t end) override {
    if (end > input_.size()) input_.read_to(end, max_bytes_);
    return end <= input_.size();
  }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (!reaches(offset + out.size()) || !input_.keeps(offset)) return false;
    input_.copy(offset, out);
    return true;
  }
  void forget(std::uint64_t before) override { input_.forget(before); }
  std::uint64_t memory_bytes() const override { return input_.kept_bytes(); }

 private:
  File file_;
  mutable PipedInput input_;
  std::uint64_t max_bytes_;
};

Error cannot_open(int code) {
  const char* const why = code == ENOENT   ? "no such file"
                          : code == EACCES ? "no permission to read it"
                          : code == EISDIR ? "it is a folder"
                                           : "it cannot be opened";
  return Error{Errc::kIo, "", why, 0};
}

// Returns whether the bytes may begin a stream, perhaps damaged by a transfer: half of the
// signature matches.
bool begins_like_stream(std::span<const std::uint8_t> bytes) {
  std::size_t right = 0;
  for (std::size_t i = 0; i < std::min(bytes.size(), kSignature.size()); ++i) {
    right += bytes[i] == kSignature[i] ? 1U : 0U;
  }
  return 2 * right >= kSignature.size();
}

// Makes a source for a pipe. Streams of version 1.2, which can be open-ended, are read only as
// far as needed, when needed.
Result<std::unique_ptr<ByteSource>> piped_source(std::FILE* file, File owned,
                                                 std::uint64_t max_memory_bytes) {
  constexpr std::uint8_t kOpenEnded = 2;  // version_minor
  PipedInput input(file);
  const auto beginning = input.beginning();
  const bool may_be_live = beginning.size() > kSignature.size() + 1 &&
                           beginning[kSignature.size() + 1] >= kOpenEnded;
  if (begins_like_stream(beginning) && !may_be_live) input.read_rest(max_memory_bytes);
  if (input.state() == PipedInput::State::kFailed) {
    return Error{Errc::kIo, "", "reading it failed", 0};
  }
  if (input.state() == PipedInput::State::kTooLarge) {
    return Error{Errc::kLimitExceeded, "", "stream", 0};
  }
  // Stops reading input that is not a stream.
  const std::uint64_t max = begins_like_stream(input.beginning()) ? max_memory_bytes : 0;
  return {std::make_unique<PipedSource>(std::move(input), std::move(owned), max)};
}

}  // namespace

Result<std::unique_ptr<ByteSource>> file_source(const std::string& path,
                                                std::uint64_t max_memory_bytes) {
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) return cannot_open(errno);
  struct stat about {};
  if (fstat(fileno(file.get()), &about) != 0) return cannot_open(errno);
  if (S_ISDIR(about.st_mode)) return cannot_open(EISDIR);
  if (!S_ISREG(about.st_mode)) {
    std::FILE* const pipe = file.get();
    return piped_source(pipe, std::move(file), max_memory_bytes);
  }
  std::unique_ptr<ByteSource> source =
      std::make_unique<FileSource>(std::move(file), static_cast<std::uint64_t>(about.st_size));
  return source;
}

Result<std::unique_ptr<ByteSource>> standard_input_source(std::uint64_t max_memory_bytes) {
  return piped_source(stdin, nullptr, max_memory_bytes);
}

}  // namespace rlpc
