// Reports as JSON, with the same names in all programs.
#pragma once

#include <nlohmann/json.hpp>
#include <utility>

#include "encoder/codec/kinds/inter/frame_pattern_text.h"
#include "encoder/codec/metrics/metrics.h"
#include "encoder/codec/metrics/surface_metrics.h"
#include "encoder/codec/sequence/target/quality.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// Returns metrics for rlpcenc and rlpccmp. Infinite values become null.
inline nlohmann::ordered_json metrics_json(const Metrics& m) {
  nlohmann::ordered_json json = {{"kg_error_percent", m.kg_error_percent},
                                 {"kg_sequence_error_percent", m.kg_sequence_error_percent},
                                 {"rms_spread", m.rms_spread},
                                 {"rms_sequence_spread", m.rms_sequence_spread},
                                 {"rms_error", m.rms_error},
                                 {"rms_error_percent", m.rms_error_percent},
                                 {"max_error", m.max_error},
                                 {"max_error_percent", m.max_error_percent},
                                 {"max_error_frame", m.max_error_frame},
                                 {"max_error_vertex", m.max_error_vertex},
                                 {"diagonal", m.diagonal},
                                 {"diagonal_psnr_db", m.diagonal_psnr_db},
                                 {"ramanathan_psnr_db", m.ramanathan_psnr_db}};
  if (m.vertex_normals) json["vertex_normal_rms_degrees"] = *m.vertex_normals;
  return json;
}

inline nlohmann::ordered_json surface_json(const SurfaceMetrics& m) {
  using Json = nlohmann::ordered_json;
  return {{"sted", m.has_sted ? Json(m.sted) : Json(nullptr)},
          {"sted_spatial", m.sted_spatial},
          {"sted_temporal", m.sted_temporal},
          {"sted_dt", StedTemporal::kDt},
          {"sted_c", kStedTemporalWeight},
          {"ring_edge_difference", m.ring_difference},
          {"ring_edge_difference_spatial", m.ring_spatial},
          {"ring_edge_difference_temporal", m.ring_temporal},
          {"ring_edge_difference_dt", RingEdgeDifference::kDt},
          {"vertex_normal_rms_degrees", m.vertex_normals},
          {"normal_flicker_rms_degrees", m.normal_flicker},
          {"mean_normal_angle_degrees", m.mean_normal_angle},
          {"max_normal_angle_degrees", m.max_normal_angle},
          {"max_normal_angle_frame", m.max_normal_frame},
          {"max_normal_angle_triangle", m.max_normal_triangle}};
}

inline nlohmann::ordered_json visibility_json(const Visibility& v) {
  return {{"median_edge_length", v.median_edge},
          {"rms_error_percent_of_edge", v.error_percent},
          {"visible", v.visible()}};
}

inline nlohmann::ordered_json report_json(const EncodeReport& r) {
  nlohmann::ordered_json json = {
      {"num_vertices", r.header.num_vertices},
      {"num_triangles", r.header.num_triangles},
      {"num_frames", r.header.num_frames},
      {"frame_rate", {r.header.frame_rate.numerator, r.header.frame_rate.denominator}},
      {"profile_idc", r.header.profile_idc},
      {"level_idc", r.header.level_idc},
      {"grid_log2_step", r.header.grid.log2_step},
      {"position_bits", r.header.position_bits},
      {"bytes", r.bytes},
      {"bpvf", r.bpvf},
      {"metrics", metrics_json(r.metrics)},
      {"largest_rounding", r.largest_rounding},
      {"bits",
       {{"headers", r.bits.headers},
        {"connectivity", r.bits.connectivity},
        {"vertex_order", r.bits.vertex_order},
        {"gofs", r.bits.gofs},
        {"hashes", r.bits.hashes},
        {"metadata", r.bits.metadata},
        {"attributes", r.bits.attributes},
        {"asset", r.bits.asset}}},
      {"num_gofs", r.num_gofs},
      {"clusters", r.clusters},
      {"components", r.components},
      {"step", r.step},
      {"trials", r.trials},
      {"target_met", r.target_met}};
  for (const PatternCount& count : r.patterns) {
    json["frame_patterns"].push_back({{"frame_pattern", frame_pattern_text(count.pattern)},
                                      {"num_patches", count.patches},
                                      {"gofs", count.gofs}});
  }
  for (const AttributeReport& a : r.attributes) {
    nlohmann::ordered_json set = {{"name", a.name}, {"values", a.values}, {"bits", a.bits}};
    set[a.is_normal ? "largest_error_degrees" : "largest_error"] = a.largest_error;
    if (a.is_normal) {
      set["rms_error_degrees"] = a.rms_error;
      set["smoothing"] = a.is_smoothing;
      set["following"] = a.num_following;
      for (const NormalError& error : a.normal_errors) {
        set["normal_errors"].push_back({{"frame", error.frame},
                                        {"mean_degrees", error.mean},
                                        {"rms_degrees", error.rms},
                                        {"largest_degrees", error.largest}});
      }
    }
    json["attributes"].push_back(std::move(set));
  }
  for (const TemporalCut& cut : r.temporal_cuts) {
    json["temporal_cuts"].push_back({{"temporal_layers", cut.layers},
                                     {"bytes", cut.bytes},
                                     {"kg_error_percent", cut.kg_error_percent}});
  }
  return json;
}

}  // namespace rlpc
