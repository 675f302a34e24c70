#include "decoder/codec/units/byte_source.h"

#include <algorithm>
#include <utility>

#include "common/memory/owned.h"

namespace rlpc {
namespace {

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(Vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
  std::uint64_t size() const override { return bytes_.size(); }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > bytes_.size() || out.size() > bytes_.size() - offset) return false;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), out.size(), out.begin());
    return true;
  }

 private:
  Vector<std::uint8_t> bytes_;
};

}  // namespace

std::unique_ptr<ByteSource> memory_source(Vector<std::uint8_t> bytes) {
  return std::make_unique<MemorySource>(std::move(bytes));
}

}  // namespace rlpc
