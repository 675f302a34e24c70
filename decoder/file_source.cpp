#include "decoder/file_source.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <utility>
#include <vector>

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

Error cannot_open(int code) {
  const char* const why = code == ENOENT   ? "no such file"
                          : code == EACCES ? "no permission to read it"
                          : code == EISDIR ? "it is a folder"
                                           : "it cannot be opened";
  return Error{Errc::kIo, "", why, 0};
}

Result<std::unique_ptr<ByteSource>> read_whole(std::FILE* file) {
  std::vector<std::uint8_t> bytes;
  for (int byte = std::getc(file); byte != EOF; byte = std::getc(file)) {
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  if (std::ferror(file) != 0) return Error{Errc::kIo, "", "reading it failed", 0};
  return memory_source(std::move(bytes));
}

}  // namespace

Result<std::unique_ptr<ByteSource>> file_source(const std::string& path) {
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) return cannot_open(errno);
  struct stat about {};
  if (fstat(fileno(file.get()), &about) != 0) return cannot_open(errno);
  if (S_ISDIR(about.st_mode)) return cannot_open(EISDIR);
  if (!S_ISREG(about.st_mode)) return read_whole(file.get());
  std::unique_ptr<ByteSource> source =
      std::make_unique<FileSource>(std::move(file), static_cast<std::uint64_t>(about.st_size));
  return source;
}

Result<std::unique_ptr<ByteSource>> standard_input_source() { return read_whole(stdin); }

}  // namespace rlpc
