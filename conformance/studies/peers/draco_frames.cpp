#include <draco/compression/decode.h>
#include <draco/compression/encode.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "conformance/studies/peers/byte_stream.h"
#include "conformance/studies/peers/peer_codecs.h"

namespace rlpc::peers {
namespace {

constexpr int kNoQuantisation = 0;

std::unique_ptr<draco::Mesh> make_mesh(const std::vector<Triangle>& triangles,
                                       const std::vector<float>& xyz) {
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(static_cast<std::uint32_t>(xyz.size() / 3));
  for (const Triangle& t : triangles) {
    mesh->AddFace({draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  }
  draco::GeometryAttribute positions;
  positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false,
                 3 * sizeof(float), 0);
  const int id = mesh->AddAttribute(positions, true, mesh->num_points());
  for (std::uint32_t v = 0; v < mesh->num_points(); ++v) {
    mesh->attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v),
                                           &xyz[3 * std::size_t{v}]);
  }
  return mesh;
}

std::string encode(const draco::Mesh& mesh, int method, int bits) {
  draco::Encoder encoder;
  encoder.SetSpeedOptions(0, 0);
  encoder.SetEncodingMethod(method);
  if (bits != kNoQuantisation) {
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  }
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
  if (!status.ok()) throw std::runtime_error("draco: " + status.error_msg_string());
  return {buffer.data(), buffer.size()};
}

std::unique_ptr<draco::Mesh> decode(std::string_view bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) throw std::runtime_error("draco: " + mesh.status().error_msg_string());
  return std::move(mesh).value();
}

std::vector<float> positions_of(const draco::Mesh& mesh) {
  const auto* attribute = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  std::vector<float> xyz(3 * std::size_t{mesh.num_points()});
  for (std::uint32_t v = 0; v < mesh.num_points(); ++v) {
    attribute->GetMappedValue(draco::PointIndex(v), &xyz[3 * std::size_t{v}]);
  }
  return xyz;
}

// Returns the index of every decoded vertex, which is coded as its x. The order follows from
// the triangles.
std::vector<std::uint32_t> decoded_order(const Animation& animation, int method,
                                         std::size_t& num_triangles) {
  std::vector<float> xyz(3 * std::size_t{animation.num_vertices});
  for (std::uint32_t v = 0; v < animation.num_vertices; ++v) {
    xyz[3 * std::size_t{v}] = static_cast<float>(v);
  }
  const auto decoded =
      decode(encode(*make_mesh(animation.triangles, xyz), method, kNoQuantisation));
  num_triangles = decoded->num_faces();
  xyz = positions_of(*decoded);
  std::vector<std::uint32_t> order(decoded->num_points());
  for (std::size_t v = 0; v < order.size(); ++v) {
    order[v] = static_cast<std::uint32_t>(xyz[3 * v]);
  }
  return order;
}

// Edgebreaker drops vertices without a triangle, and triangles that are degenerate.
bool keeps_everything(const Animation& animation) {
  std::size_t num_triangles = 0;
  std::vector<bool> there(animation.num_vertices);
  for (const auto v :
       decoded_order(animation, draco::MESH_EDGEBREAKER_ENCODING, num_triangles)) {
    there[v] = true;
  }
  return num_triangles == animation.triangles.size() &&
         std::find(there.begin(), there.end(), false) == there.end();
}

int method_for(const Animation& animation) {
  return keeps_everything(animation) ? draco::MESH_EDGEBREAKER_ENCODING
                                     : draco::MESH_SEQUENTIAL_ENCODING;
}

}  // namespace

std::vector<std::uint32_t> draco_order(const Animation& animation) {
  std::size_t num_triangles = 0;
  return decoded_order(animation, method_for(animation), num_triangles);
}

Bytes write_draco(const Animation& animation, int bits) {
  const int method = method_for(animation);
  ByteWriter out;
  out.u32(static_cast<std::uint32_t>(animation.frames.size()));
  for (const auto& frame : animation.frames) {
    out.piece(encode(*make_mesh(animation.triangles, frame), method, bits));
  }
  return out.take();
}

Animation read_draco(const Bytes& bytes) {
  ByteReader in(bytes);
  Animation out;
  out.frames.resize(in.u32());
  for (auto& frame : out.frames) {
    const auto mesh = decode(in.piece());
    out.num_vertices = mesh->num_points();
    frame = positions_of(*mesh);
    if (!out.triangles.empty()) continue;
    for (std::uint32_t t = 0; t < mesh->num_faces(); ++t) {
      const auto& face = mesh->face(draco::FaceIndex(t));
      out.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
    }
  }
  return out;
}

}  // namespace rlpc::peers
