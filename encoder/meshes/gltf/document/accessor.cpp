#include "encoder/meshes/gltf/document/accessor.h"

#include <map>

namespace rlpc {

namespace {

using std::to_string;

struct View {
  GltfRange range;  // stride 0: tightly packed
  std::uint64_t size = 0;
};

View read_view(const GltfValue& value, const std::vector<GltfBuffer>& buffers) {
  View view;
  view.range.buffer = value["buffer"].index(buffers.size(), "buffers");
  view.range.offset = value["byteOffset"].integer({0, GltfValue::kMaxInteger}, 0);
  view.size = value["byteLength"].integer({1, GltfValue::kMaxInteger});
  view.range.stride = value["byteStride"].integer({0, 252}, 0);
  if (view.range.buffer >= buffers.size()) return view;  // has failed above
  const std::uint64_t size = buffers[view.range.buffer].size;
  if (view.range.offset > size) {
    value["byteOffset"].fail("at most the " + to_string(size) + " bytes of buffers[" +
                             to_string(view.range.buffer) + "]");
  } else if (view.size > size - view.range.offset) {
    value["byteLength"].fail("at most " + to_string(size - view.range.offset) +
                             ", what buffers[" + to_string(view.range.buffer) + "] has from " +
                             to_string(view.range.offset) + " on");
  }
  return view;
}

class AccessorReader {
 public:
  AccessorReader(const GltfValue& root, const std::vector<GltfBuffer>& buffers,
                 GltfErrors& errors)
      : errors_(errors) {
    const GltfValue views = root["bufferViews"];
    for (std::size_t i = 0; i < views.size(); ++i) {
      views_.push_back(read_view(views[i], buffers));
    }
  }

  GltfAccessor read(const GltfValue& value) const {
    static const std::map<std::string, std::uint32_t> kWidths{
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
        {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    GltfAccessor accessor;
    accessor.type = value["type"].text();
    const auto width = kWidths.find(accessor.type);
    if (width == kWidths.end()) {
      value["type"].fail("SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
      return accessor;
    }
    accessor.width = width->second;
    accessor.component = component_of(value["componentType"]);
    accessor.normalized = value["normalized"].boolean(false);
    accessor.count = value["count"].integer({1, GltfValue::kMaxInteger});
    const std::uint64_t size = std::uint64_t{accessor.width} * bytes_of(accessor.component);
    if (value["bufferView"].exists()) accessor.base = range(value, value, accessor.count, size);
    if (value["sparse"].exists())
      accessor.sparse = read_sparse(value["sparse"], accessor, size);
    return accessor;
  }

 private:
  static GltfComponent component_of(const GltfValue& value) {
    const std::uint64_t number = value.integer({5120, 5126});
    if (number == 5124) value.fail("5120 to 5123, 5125 or 5126");
    return static_cast<GltfComponent>(number);
  }

  GltfAccessor::Sparse read_sparse(const GltfValue& value, const GltfAccessor& accessor,
                                   std::uint64_t size) const {
    GltfAccessor::Sparse sparse;
    sparse.count = value["count"].integer({1, accessor.count});
    const GltfValue indices = value["indices"];
    const GltfValue component = indices["componentType"];
    sparse.index_component = component_of(component);
    if (sparse.index_component != GltfComponent::kU8 &&
        sparse.index_component != GltfComponent::kU16 &&
        sparse.index_component != GltfComponent::kU32) {
      component.fail("5121, 5123 or 5125");
    }
    sparse.indices = range(indices, value, sparse.count, bytes_of(sparse.index_component));
    sparse.values = range(value["values"], value, sparse.count, size);
    return sparse;
  }

  // Returns the range of `count` elements of `size` bytes. counted: the JSON value of the
  // count.
  GltfRange range(const GltfValue& value, const GltfValue& counted, std::uint64_t count,
                  std::uint64_t size) const {
    const std::uint32_t number = value["bufferView"].index(views_.size(), "bufferViews");
    const std::uint64_t offset = value["byteOffset"].integer({0, GltfValue::kMaxInteger}, 0);
    if (errors_) return {};
    const View& view = views_[number];
    GltfRange range = view.range;
    if (range.stride == 0) range.stride = size;
    const std::string there =
        to_string(view.size) + " bytes of bufferViews[" + to_string(number) + "]";
    if (range.stride < size) {
      value["bufferView"].fail("a byteStride of " + to_string(size) +
                               ", the bytes of an element, or more");
    } else if (offset > view.size || size > view.size - offset) {
      value["byteOffset"].fail("one that leaves room for " + to_string(size) + " of the " +
                               there);
    } else if (count - 1 > (view.size - offset - size) / range.stride) {
      counted["count"].fail("at most " +
                            to_string((view.size - offset - size) / range.stride + 1) +
                            ", as many as fit the " + there);
    }
    range.offset += offset;
    return range;
  }

  std::vector<View> views_;
  GltfErrors& errors_;
};

}  // namespace

std::vector<GltfAccessor> read_gltf_accessors(const GltfValue& root,
                                              const std::vector<GltfBuffer>& buffers,
                                              GltfErrors& errors) {
  const AccessorReader reader(root, buffers, errors);
  std::vector<GltfAccessor> accessors;
  const GltfValue values = root["accessors"];
  for (std::size_t i = 0; i < values.size(); ++i) accessors.push_back(reader.read(values[i]));
  return accessors;
}

}  // namespace rlpc
