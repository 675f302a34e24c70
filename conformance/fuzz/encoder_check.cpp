#include "conformance/fuzz/encoder_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "conformance/rlpcval/validator.h"
#include "conformance/testing/small_animation.h"
#include "decoder/c_api/rlpc_c_decoder.h"

namespace rlpc {
namespace {

struct Complaint {
  std::string text;
};

void require(bool holds, const std::string& text) {
  if (!holds) throw Complaint{text};
}

template <class A, class B>
void require_equal(const A& found, const B& wanted, const std::string& of) {
  if (found == wanted) return;
  throw Complaint{of + " is " + std::to_string(found) + ", not " + std::to_string(wanted)};
}

// Whether two sums are equal up to the order of summation.
bool nearly(double a, double b) {
  return a == b || std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

// The distortion of a sequence, by its definition.
struct Distortion {
  long double squared_error = 0;
  long double spread = 0;
  double max_error = 0;
  std::size_t num_points = 0;

  void add_frame(const std::vector<float>& original, const std::vector<float>& decoded) {
    const std::size_t n = original.size() / 3;
    for (std::size_t v = 0; v < n; ++v) {
      long double squared = 0;
      for (std::size_t i = 3 * v; i < 3 * v + 3; ++i) {
        const long double d = static_cast<long double>(original[i]) - decoded[i];
        squared += d * d;
      }
      squared_error += squared;
      max_error = std::max(max_error, static_cast<double>(std::sqrt(squared)));
    }
    for (std::size_t c = 0; c < 3; ++c) {
      long double mean = 0;  // relative to the first vertex
      for (std::size_t v = 0; v < n; ++v) {
        mean += static_cast<long double>(original[3 * v + c]) - original[c];
      }
      mean /= static_cast<long double>(n);
      for (std::size_t v = 0; v < n; ++v) {
        const long double d =
            static_cast<long double>(original[3 * v + c]) - original[c] - mean;
        spread += d * d;
      }
    }
    num_points += n;
  }
  double kg_error_percent() const {
    if (squared_error == 0) return 0;
    if (spread == 0) return std::numeric_limits<double>::infinity();
    return static_cast<double>(100 * std::sqrt(squared_error / spread));
  }
  double rms_error() const {
    return static_cast<double>(std::sqrt(squared_error / static_cast<long double>(num_points)));
  }
};

class OpenDecoder {
 public:
  explicit OpenDecoder(const std::vector<std::uint8_t>& bytes) {
    const rlpc_status status =
        rlpc_decoder_open_memory(bytes.data(), bytes.size(), nullptr, &handle_);
    require(status == RLPC_OK, std::string("does not open: ") + error_text());
  }
  OpenDecoder(const OpenDecoder&) = delete;
  OpenDecoder& operator=(const OpenDecoder&) = delete;
  ~OpenDecoder() { rlpc_decoder_close(handle_); }
  rlpc_decoder* get() const { return handle_; }
  const char* error_text() const { return rlpc_decoder_error_text(handle_); }

 private:
  rlpc_decoder* handle_ = nullptr;
};

void check_conforming(const EncoderCase& c, const EncodedCase& encoded) {
  const auto source = memory_source(encoded.bytes);
  const ValidationReport report = validate(*source);
  for (const Finding& f : report.findings) {
    require(f.severity == Severity::kWarning,
            std::string("breaks ") + f.id + " (" + f.element + "): " + f.detail);
  }
  require(report.complete && !report.stopped && report.header.has_value(),
          "the validator did not check everything");
  require_equal(report.bytes, encoded.bytes.size(), "the validator's count of bytes");
  require_equal(report.gofs, encoded.report.num_gofs, "num_gofs");
  require_equal(report.header->level_idc, encoded.report.level, "level");
  require_equal(report.frames, c.expected_frames(), "the validator's count of frames");
}

// The rotation that starts with the smallest index.
Triangle canonical(const Triangle& t) {
  return std::min({t, Triangle{t[1], t[2], t[0]}, Triangle{t[2], t[0], t[1]}});
}

std::vector<Triangle> canonical_triangles(const std::vector<std::uint32_t>& indices,
                                          const std::vector<std::uint32_t>& order) {
  std::vector<Triangle> result;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    result.push_back(
        canonical({order[indices[i]], order[indices[i + 1]], order[indices[i + 2]]}));
  }
  std::sort(result.begin(), result.end());
  return result;
}

void check_mesh(const EncoderCase& c, rlpc_decoder* decoder,
                const std::vector<std::uint32_t>& order) {
  rlpc_stream_info info;
  require(rlpc_decoder_info(decoder, &info, sizeof info) == RLPC_OK, "no information");
  require_equal(info.num_vertices, c.num_vertices, "num_vertices");
  require_equal(3 * info.num_triangles, c.indices.size(), "the number of indices");
  require_equal(info.num_frames, c.expected_frames(), "num_frames");
  require_equal(info.frame_rate_numerator, c.frame_rate.numerator, "the frame rate");
  require_equal(info.frame_rate_denominator, c.frame_rate.denominator, "the frame rate");
  require(c.metadata == rlpc_decoder_metadata(decoder), "other metadata");
  std::vector<std::uint32_t> indices(c.indices.size());
  require(rlpc_decoder_triangles(decoder, indices.data(), indices.size()) == RLPC_OK,
          "no triangles");
  std::vector<std::uint32_t> same(c.num_vertices);
  std::iota(same.begin(), same.end(), 0U);
  require(canonical_triangles(indices, order) == canonical_triangles(c.indices, same),
          "other triangles");
}

Distortion decode_frames(const EncoderCase& c, const OpenDecoder& decoder,
                         const std::vector<std::uint32_t>& order) {
  const std::size_t values = 3 * std::size_t{c.num_vertices};
  std::vector<float> xyz(values);
  std::vector<float> decoded(values);
  Distortion distortion;
  for (std::uint32_t f = 0; f < c.expected_frames(); ++f) {
    const rlpc_status status = rlpc_decoder_next_floats(decoder.get(), xyz.data(), values);
    require(status == RLPC_OK, "frame " + std::to_string(f) + ": " + decoder.error_text());
    for (std::size_t i = 0; i < values; ++i) {
      decoded[3 * std::size_t{order[i / 3]} + i % 3] = xyz[i];
    }
    distortion.add_frame(c.frames[f], decoded);
  }
  std::vector<float> again(values);
  require(rlpc_decoder_next_floats(decoder.get(), again.data(), values) == RLPC_END,
          "frames after the last one");
  require(rlpc_decoder_seek(decoder.get(), c.expected_frames() - 1) == RLPC_OK &&
              rlpc_decoder_next_floats(decoder.get(), again.data(), values) == RLPC_OK &&
              again == xyz,
          "the last frame is another one after a seek");
  return distortion;
}

void check_report(const EncoderCase& c, const EncodedCase& encoded,
                  const Distortion& distortion) {
  const rlpc_encode_report& report = encoded.report;
  require_equal(report.num_bytes, encoded.bytes.size(), "num_bytes");
  const double bpvf = 8.0 * static_cast<double>(encoded.bytes.size()) /
                      (1.0 * c.num_vertices * c.expected_frames());
  require(nearly(report.bpvf, bpvf), "bpvf");
  for (const auto& [name, reported, measured] :
       {std::tuple{"kg_error_percent", report.kg_error_percent, distortion.kg_error_percent()},
        std::tuple{"rms_error", report.rms_error, distortion.rms_error()},
        std::tuple{"max_error", report.max_error, distortion.max_error}}) {
    require(nearly(reported, measured), std::string(name) + " is reported as " +
                                            std::to_string(reported) + ", but is " +
                                            std::to_string(measured));
  }
  if (report.target_met == 0) return;
  const Target target =
      c.settings ? c.settings->target
                 : Target{static_cast<Target::Kind>(c.options.target), c.options.target_value};
  const double reached = target.kind == Target::kKg         ? distortion.kg_error_percent()
                         : target.kind == Target::kBpvf     ? bpvf
                         : target.kind == Target::kMaxError ? distortion.max_error
                                                            : 0.0;
  require(target.kind == Target::kNone || reached <= target.value * (1.0 + 1e-9),
          "a target is reported as met, but is not: " + std::to_string(reached));
}

}  // namespace

std::string check_encoded(const EncoderCase& c, const EncodedCase& encoded) {
  try {
    std::vector<std::uint32_t> order = encoded.input_vertex;
    std::vector<std::uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(c.num_vertices);
    std::iota(all.begin(), all.end(), 0U);
    require(sorted == all, "input_vertex is not a permutation");
    if (c.settings ? c.settings->keep_order : c.options.keep_order != 0) order = all;
    check_conforming(c, encoded);
    const OpenDecoder decoder(encoded.bytes);
    check_mesh(c, decoder.get(), order);
    check_report(c, encoded, decode_frames(c, decoder, order));
  } catch (const Complaint& complaint) {
    return complaint.text;
  }
  return "";
}

namespace {

// An encoder behind its C interface, and the calls of its sink.
class CaseEncoder {
 public:
  explicit CaseEncoder(const EncoderCase& c) : case_(c) {}
  CaseEncoder(const CaseEncoder&) = delete;
  CaseEncoder& operator=(const CaseEncoder&) = delete;
  ~CaseEncoder() { rlpc_encoder_close(handle_); }

  // Returns the stream; none if an error was expected.
  std::optional<EncodedCase> run() {
    const rlpc_status created = create();
    require(created == due_of_create(), describe("create", created));
    if (created != RLPC_OK) return stay_broken(created);
    for (std::size_t f = 0; f < case_.frames.size(); ++f) {
      const rlpc_status status = add(f);
      if (!is_due(status, case_.is_legal_frame(f))) {
        throw Complaint{describe("frame " + std::to_string(f), status)};
      }
      if (status != RLPC_OK) return stay_broken(status);
    }
    std::uint32_t unfinished = 0;
    require(rlpc_encoder_vertex_order(handle_, &unfinished, 1) == RLPC_BAD_ARGUMENT,
            "a vertex order before the end");
    const rlpc_status status =
        rlpc_encoder_finish(handle_, &encoded_.report, sizeof encoded_.report);
    const bool whole = case_.frames.size() == case_.expected_frames() && !case_.frames.empty();
    if (!is_due(status, whole)) throw Complaint{describe("finish", status)};
    if (status != RLPC_OK) return stay_broken(status);
    require(!write_failed_, "a failed write was not reported");
    encoded_.input_vertex.resize(case_.num_vertices);
    require(rlpc_encoder_vertex_order(handle_, encoded_.input_vertex.data(),
                                      case_.num_vertices) == RLPC_OK,
            "no vertex order");
    return std::move(encoded_);
  }

 private:
  static int write(void* user, const void* bytes, std::size_t num_bytes) {
    auto& self = *static_cast<CaseEncoder*>(user);
    if (++self.writes_ == self.case_.failing_write) self.write_failed_ = true;
    if (self.write_failed_) return 1;
    const auto* begin = static_cast<const std::uint8_t*>(bytes);
    self.encoded_.bytes.insert(self.encoded_.bytes.end(), begin, begin + num_bytes);
    return 0;
  }

  rlpc_status create() {
    rlpc_frame_format format;
    rlpc_frame_format_init(&format, sizeof format);
    format.num_vertices = case_.num_vertices;
    format.num_triangles = static_cast<std::uint32_t>(case_.indices.size() / 3);
    format.indices = case_.indices.data();
    format.num_frames = case_.num_frames;
    format.frame_rate_numerator = case_.frame_rate.numerator;
    format.frame_rate_denominator = case_.frame_rate.denominator;
    std::copy_n(case_.box_min.begin(), 3, format.box_min);
    std::copy_n(case_.box_max.begin(), 3, format.box_max);
    rlpc_encode_options options = case_.options;
    if (!case_.metadata.empty()) options.metadata = case_.metadata.c_str();
    if (case_.placed) {
      place_.resize(rlpc_encoder_bytes() / sizeof(std::max_align_t) + 1);
      options.place = place_.data();
      options.place_bytes = rlpc_encoder_bytes();
    }
    return rlpc_encoder_create(&format, &options, write, this, &handle_);
  }
  rlpc_status add(std::size_t frame) {
    const auto& xyz = case_.frames[frame];
    return rlpc_encoder_add_frame(handle_, xyz.data(), xyz.size());
  }

  rlpc_status due_of_create() const {
    if (!case_.has_known_options()) return RLPC_BAD_ARGUMENT;
    return case_.is_legal() ? RLPC_OK : RLPC_BAD_INPUT;
  }
  // A write can fail in any case, and a later GOF may need a higher level.
  bool is_due(rlpc_status status, bool legal) const {
    if (write_failed_) return status == RLPC_IO_FAILED;
    const bool level = std::string_view(rlpc_encoder_error_text(handle_)).find("need level") !=
                       std::string_view::npos;
    return status == (legal && !level ? RLPC_OK : RLPC_BAD_INPUT);
  }
  std::string describe(const std::string& call, rlpc_status status) const {
    return call + ": " + rlpc_status_text(status) + ": " + rlpc_encoder_error_text(handle_);
  }
  std::nullopt_t stay_broken(rlpc_status status) {
    require(handle_ != nullptr && rlpc_encoder_error_text(handle_)[0] != '\0', "no error text");
    const std::size_t written = encoded_.bytes.size();
    const std::vector<float> xyz(3 * std::size_t{case_.num_vertices});
    std::uint32_t order = 0;
    require(rlpc_encoder_add_frame(handle_, xyz.data(), xyz.size()) == status &&
                rlpc_encoder_finish(handle_, nullptr, 0) == status &&
                rlpc_encoder_vertex_order(handle_, &order, 1) == status &&
                encoded_.bytes.size() == written,
            "an error is not sticky");
    return std::nullopt;
  }

  const EncoderCase& case_;
  rlpc_encoder* handle_ = nullptr;
  std::vector<std::max_align_t> place_;
  EncodedCase encoded_;
  std::uint32_t writes_ = 0;
  bool write_failed_ = false;
};

std::optional<EncodedCase> encode_sequence(const EncoderCase& c) {
  FrameSource::Shape shape;
  shape.frame_rate = c.frame_rate;
  for (std::size_t i = 0; i < c.indices.size(); i += 3) {
    shape.triangles.push_back({c.indices[i], c.indices[i + 1], c.indices[i + 2]});
  }
  MemoryFrames source(std::move(shape), c.frames);
  EncodedCase encoded;
  const auto report = encode(source, *c.settings, [&](std::span<const std::uint8_t> more) {
    encoded.bytes.insert(encoded.bytes.end(), more.begin(), more.end());
    return true;
  });
  bool legal = c.is_legal();
  for (std::size_t f = 0; f < c.frames.size(); ++f) legal = legal && c.is_legal_frame(f);
  if (!report) {
    require(!legal, "refused: " + report.error().message);
    return std::nullopt;
  }
  require(legal, "encoded, but not legal");
  encoded.report.num_bytes = report->bytes;
  encoded.report.bpvf = report->bpvf;
  encoded.report.kg_error_percent = report->metrics.kg_error_percent;
  encoded.report.rms_error = report->metrics.rms_error;
  encoded.report.max_error = report->metrics.max_error;
  encoded.report.num_gofs = report->num_gofs;
  encoded.report.level = report->header.level_idc;
  encoded.report.target_met = report->target_met ? 1 : 0;
  encoded.input_vertex = report->input_vertex;
  return encoded;
}

std::optional<EncodedCase> encode_case(const EncoderCase& c) {
  return c.settings ? encode_sequence(c) : CaseEncoder(c).run();
}

}  // namespace

std::string check_encoder(const EncoderCase& c, std::optional<EncodedCase>* result) {
  try {
    const auto encoded = encode_case(c);
    if (result != nullptr) *result = encoded;
    if (!encoded) return "";
    if (c.twice) {
      const auto again = encode_case(c);
      require(again && again->bytes == encoded->bytes, "other bytes the second time");
    }
    return check_encoded(c, *encoded);
  } catch (const Complaint& complaint) {
    return complaint.text;
  }
}

}  // namespace rlpc
