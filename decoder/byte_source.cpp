#include "decoder/byte_source.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace rlpc {
namespace {

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
  std::uint64_t size() const override { return bytes_.size(); }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > bytes_.size() || out.size() > bytes_.size() - offset) return false;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), out.size(), out.begin());
    return true;
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

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

}  // namespace

std::unique_ptr<ByteSource> memory_source(std::vector<std::uint8_t> bytes) {
  return std::make_unique<MemorySource>(std::move(bytes));
}

Result<std::unique_ptr<ByteSource>> file_source(const std::string& path) {
  const Error failure{Errc::kIo, "", path.empty() ? "" : "stream file", 0};
  File file(std::fopen(path.c_str(), "rb"));
  if (!file || fseeko(file.get(), 0, SEEK_END) != 0) return failure;
  const off_t size = ftello(file.get());
  if (size < 0) return failure;
  std::unique_ptr<ByteSource> source =
      std::make_unique<FileSource>(std::move(file), static_cast<std::uint64_t>(size));
  return source;
}

}  // namespace rlpc
