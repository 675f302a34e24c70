#include "decoder/codec/gofs/live_gof.h"

#include <utility>

#include "decoder/codec/parse/parse_gof_header.h"

namespace rlpc {

LiveGof::LiveGof(StreamReader& stream, const SliceCut& cut)
    : stream_(stream),
      parser_(stream.context().header, (*stream.context().meshes)[Prediction::kLayers],
              stream.access_units().memory_limit(), cut) {}

Result<bool> LiveGof::begin(const UnitHeader& gof_unit) {
  gof_unit_ = gof_unit;
  first_frame_ = stream_.next_first_frame();
  cursor_.emplace(stream_.units(), gof_unit);
  const auto payload = stream_.units().payload(gof_unit);
  if (!payload) return payload.error();
  BitReader r = stream_.units().bits(gof_unit, *payload);
  const GofHeader header = parse_gof_header(r, stream_.context().header, first_frame_);
  if (r.error()) return *r.error();
  if (auto ok = parser_.gof(r, header); !ok) return ok;
  recon_.emplace((*stream_.context().meshes)[Prediction::kLayers], parser_.settings(),
                 stream_.context().header.position_bits);
  return true;
}

// 6.1 access_unit( ): reads the next frame unit; the GOF ends with the last one.
Result<bool> LiveGof::read_unit() {
  const auto more = cursor_->advance({.slice = UnitType::kFrame, .must_go_on = true});
  if (!more) return more;
  ended_ = !*more;
  if (ended_) return true;
  UnitReader& units = stream_.units();
  const auto payload = units.payload(cursor_->unit());
  if (!payload) return payload.error();
  BitReader r = units.bits(cursor_->unit(), *payload);
  if (auto ok = parser_.frame(r, cursor_->unit().offset * 8); !ok) return ok;
  units.forget(cursor_->end());
  return true;
}

void LiveGof::decode_place() {
  const FrameOrder& order = parser_.order();
  const FramePlace& place = order[recon_->place()];
  const InterFrame coded = parser_.take_frame(place.frame);
  recon_->decode(place, order.last_use(place.frame), coded);
  Decoded& decoded = waiting_[place.frame];
  decoded.crc = coded.frame_crc;
  decoded.positions.resize(3 * std::size_t{stream_.context().header.num_vertices});
  recon_->positions(decoded.positions);
}

// 8.19.1 DecodeCompleteFrames( ), DecodeFrames( )
Result<bool> LiveGof::next() {
  for (;;) {
    if (const auto found = waiting_.find(next_output_); found != waiting_.end()) {
      frame_ = std::move(found->second);
      waiting_.erase(found);
      ++next_output_;
      return true;
    }
    const std::uint32_t num_frames = parser_.order().num_frames();
    if (recon_->place() < (ended_ ? num_frames : parser_.complete_places())) {
      decode_place();
    } else if (ended_) {
      stream_.go_past(gof_unit_, num_frames, cursor_->end());
      return false;
    } else if (auto ok = read_unit(); !ok) {
      return ok;
    }
  }
}

}  // namespace rlpc
