#include <array>

#include "encoder/meshes/gltf/source.h"
#include "encoder/meshes/input_format.h"
#include "encoder/meshes/obj/obj_reader.h"
#include "encoder/meshes/off/off_reader.h"
#include "encoder/meshes/ply/ply_reader.h"
#include "encoder/meshes/point_cache/point_cache.h"
#include "encoder/meshes/rlpd/rlpd_reader.h"

namespace rlpc {

std::span<const InputFormat* const> input_formats() {
  static constexpr std::array kFormats{&kGltfFormat, &kRlpdFormat, &kPc2Format, &kMddFormat,
                                       &kPlyFormat,  &kOffFormat,  &kObjFormat};
  return kFormats;
}

}  // namespace rlpc
