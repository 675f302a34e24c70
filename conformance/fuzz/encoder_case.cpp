#include "conformance/fuzz/encoder_case.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <utility>

#include "common/codec/syntax/sequence_header.h"
#include "common/testing/fuzz_input.h"
#include "encoder/codec/sequence/check_settings.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kMaxVertices = 40;
constexpr std::uint32_t kMaxTriangles = 80;
constexpr std::uint32_t kMaxCaseFrames = 16;
constexpr float kMaxCoordinate = 0x1p100F;

float to_float(double x) {
  constexpr double kMax = std::numeric_limits<float>::max();
  if (std::abs(x) <= kMax) return static_cast<float>(x);
  return std::copysign(std::numeric_limits<float>::infinity(),
                       static_cast<float>(x > 0) - 0.5F);
}

class CaseMaker {
 public:
  explicit CaseMaker(std::span<const std::uint8_t> bytes)
      : input_(bytes.data(), bytes.size()) {}

  EncoderCase make() {
    flags_ = byte();
    read_options();
    const EncoderSettings settings = read_settings();
    if (has(kWholeSequence)) case_.settings = settings;
    read_mesh();
    read_frames();
    read_box();
    if (has(kWholeSequence)) keep_to_source();
    return std::move(case_);
  }

 private:
  enum Flag : std::uint32_t {
    kWholeSequence = 1,
    kKeepOrder = 2,
    kMetadata = 4,
    kPlaced = 8,
    kOwnBox = 16,
    kTwice = 32,
    kAnyIndices = 64,
    kOtherCount = 128,  // announces another number of frames
  };

  bool has(Flag flag) const { return (flags_ & flag) != 0; }
  std::uint32_t byte() { return input_.number(1); }
  double signed_byte() { return static_cast<std::int8_t>(byte()); }
  float any_float() {
    const std::uint32_t bits = input_.number(4);
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  // Returns one of `count` legal values, rarely another one.
  std::uint32_t choice(std::uint32_t count, std::uint32_t first = 0) {
    const std::uint32_t b = byte();
    return b < 250 ? first + b % count : b - 250 + first + count;
  }
  double random() { return static_cast<double>(random_()) / 1073741824.0 - 1.0; }  // -1 to 1

  double target_value();
  void read_options();
  EncoderSettings read_settings();
  void read_mesh();
  void read_triangles();
  std::vector<double> read_shape();
  void read_frames();
  void read_box();
  void keep_to_source();

  FuzzInput input_;
  std::uint32_t flags_ = 0;
  std::minstd_rand random_;
  EncoderCase case_;
};

double CaseMaker::target_value() {
  constexpr double kSpecial[] = {0.0,
                                 -1.0,
                                 std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::max(),
                                 std::numeric_limits<double>::denorm_min()};
  const std::uint32_t v = input_.number(2);
  if (v < std::size(kSpecial)) return kSpecial[v];
  return std::exp2((static_cast<double>(v) - 32768.0) / 1024.0);
}

void CaseMaker::read_options() {
  rlpc_encode_options& o = case_.options;
  rlpc_encode_options_init(&o, sizeof o);
  o.profile = choice(3);
  o.preset = choice(3);
  o.target = choice(3, RLPC_TARGET_KG);
  o.target_value = target_value();
  const std::uint32_t gof = byte();
  o.gof_frames = gof == 255 ? std::numeric_limits<std::uint32_t>::max() : gof % 24;
  const std::uint32_t components = byte();
  o.components = components < 250 ? components % 8 : 1020 + (components - 250);
  o.hash_mode = choice(3);
  o.least_level = choice(4, 1);
  o.keep_order = has(kKeepOrder) ? 1 : 0;
  if (has(kMetadata)) case_.metadata = R"({"title":"case"})";
  case_.placed = has(kPlaced);
  const std::uint32_t failing = byte();
  case_.failing_write = failing < 16 ? failing : 0;
  case_.twice = has(kTwice);
  o.max_held_frames = byte();
  case_.frame_rate = {byte() + 1, byte()};
}

// Settings that the options have, and those that only rlpc_encoder.h has.
EncoderSettings CaseMaker::read_settings() {
  const rlpc_encode_options& o = case_.options;
  EncoderSettings s;
  s.profile = static_cast<Profile>(o.profile % 3);
  s.preset = static_cast<Preset>(o.preset % 3);
  s.target = {static_cast<Target::Kind>(o.target % 4), o.target_value};
  s.gof_frames = o.gof_frames;
  s.components = o.components;
  s.keep_order = o.keep_order != 0;
  s.hash_mode = static_cast<HashMode>(o.hash_mode % 3);
  s.metadata = case_.metadata;

  const auto bytes = input_.take(14);
  FuzzInput tools(bytes.data(), bytes.size());
  const auto number = [&](std::uint32_t below) { return tools.number(1) % below; };
  BaselineTools b;
  b.clusters = number(8);
  const std::uint32_t switches = tools.number(1);
  b.rdo = (switches & 1) == 0;
  b.rate_in_vectors = (switches & 2) != 0;
  b.qu = static_cast<int>(number(23));
  b.qc = static_cast<int>(number(23));
  b.qdelta = static_cast<int>(number(27));
  // Given quantisers exclude a target, which would search them.
  if ((switches & 12) == 4) s.target = {Target::kNone, 0.0};
  if ((switches & 12) == 0) b.qu = b.qc = 0;
  b.frame_mode = static_cast<FrameMode>(number(3));
  const std::uint32_t clustering = tools.number(1);
  b.seed_mode = static_cast<SeedMode>(clustering % 4);
  b.partition = static_cast<PartitionMethod>(clustering / 4 % 5);
  // Refused with other partitions, as is SeedMode::kFirst.
  if (b.partition == PartitionMethod::kSeeds) {
    b.motion = static_cast<MotionMeasure>(clustering / 20 % 3);
  }
  MainTools m;
  m.bones = number(8);
  const std::uint32_t prediction = number(4);
  if (prediction > 0) m.prediction = static_cast<Prediction>(prediction - 1);
  m.influences = number(6);
  const std::uint32_t more = tools.number(1);
  m.geometry_weights = (more & 1) == 0;
  m.outer_ring = (more & 2) == 0;
  m.layer_steps = (more & 4) == 0;
  m.temporal_weights = (more & 8) == 0;
  m.cobra_steps = (more & 16) != 0;
  m.clusters = (more & 32) == 0;
  if ((more & 64) != 0) m.rest = static_cast<RestTools>(tools.number(1) % 3);
  if ((more & 128) != 0 && s.profile == Profile::kHigh) m.temporal_layers = 2 + more % 3;
  m.component_groups = number(6);
  m.layer_groups = number(6);
  // The tools of the other profile are refused, so most cases do not set them.
  if (s.profile == Profile::kBaseline || (switches & 192) == 192) s.baseline = b;
  if (s.profile != Profile::kBaseline || (switches & 192) == 192) s.main = m;
  return s;
}

void CaseMaker::read_mesh() {
  const std::uint32_t n = byte();
  case_.num_vertices = n == 255 ? 0 : n % kMaxVertices + 1;
  random_.seed(byte() + 1);
  read_triangles();
}

void CaseMaker::read_triangles() {
  const std::uint32_t kind = byte() % 4;
  const std::uint32_t count = byte() % (kMaxTriangles + 1);
  const std::uint32_t n = std::max(case_.num_vertices, 1U);
  for (std::uint32_t t = 0; t < count; ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::uint32_t v = 0;
      if (kind == 0) v = byte();
      if (kind == 1) v = t + (k == 0 ? 0 : t % 2 == k % 2 ? 2 : 1);  // a strip
      if (kind == 2) v = static_cast<std::uint32_t>(random_());
      if (kind == 3) v = (t * (k + 1)) % (n / 2 + 1) + k;  // fans, edges of many triangles
      case_.indices.push_back(has(kAnyIndices) ? v : v % n);
    }
  }
}

// [num_vertices][3], about 1 in size.
std::vector<double> CaseMaker::read_shape() {
  const std::uint32_t kind = byte() % 5;
  std::vector<double> shape(3 * std::size_t{case_.num_vertices});
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const std::size_t vertex = i / 3;
    const auto v = static_cast<double>(vertex);
    switch (kind) {
      case 0:  // a strip
        shape[i] = i % 3 == 0 ? 0.1 * v : i % 3 == 1 ? std::fmod(v, 2.0) : 0.0;
        break;
      case 1:  // noise
        shape[i] = random();
        break;
      case 2:  // a line
        shape[i] = 0.1 * v;
        break;
      case 3:
        shape[i] = signed_byte() / 64.0;
        break;
      default:  // one point
        shape[i] = 0.5;
        break;
    }
  }
  return shape;
}

void CaseMaker::read_frames() {
  const std::vector<double> shape = read_shape();
  const double scale = std::exp2(signed_byte());
  const std::uint32_t far = byte();
  const double offset =
      far < 128 ? 0.0 : std::exp2((far - 128.0) / 4.0);  // in sizes of the shape
  const std::uint32_t count = byte() % (kMaxCaseFrames + 1);
  std::vector<double> now = shape;
  for (std::uint32_t f = 0; f < count; ++f) {
    const std::uint32_t b = byte();
    const std::uint32_t kind = b < 240 ? b % 8 : b < 252 ? 8 : 9;
    const double a = signed_byte() / 40.0;
    std::vector<float> xyz;
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const double x = shape[i - i % 3];
      switch (kind) {
        case 0:  // unchanged
          break;
        case 1:  // bent
          now[i] = shape[i] + (i % 3 == 2 ? std::sin(a + 2.0 * x) : 0.0);
          break;
        case 2:  // turned about z
          now[i] = i % 3 == 0   ? std::cos(a) * x - std::sin(a) * shape[i + 1]
                   : i % 3 == 1 ? std::sin(a) * shape[i - 1] + std::cos(a) * shape[i]
                                : shape[i];
          break;
        case 3:  // two parts that move
          now[i] = shape[i] + (i < shape.size() / 2 ? a : -a * x);
          break;
        case 4:  // noise
          now[i] = shape[i] + a * random();
          break;
        case 5:
          now[i] += signed_byte() / 256.0;
          break;
        case 6:  // numbers of any size
          now[i] = shape[i] * std::exp2(20.0 * a);
          break;
        case 7:  // an outlier
          if (i == 0) now[i] = a * 1000.0;
          break;
        default:
          break;
      }
      xyz.push_back(to_float((now[i] + offset) * scale));
    }
    if (kind == 8 && !xyz.empty())
      xyz[static_cast<std::size_t>(40.0 * std::abs(a)) % xyz.size()] = any_float();
    if (kind == 9) std::generate(xyz.begin(), xyz.end(), [&] { return any_float(); });
    case_.frames.push_back(std::move(xyz));
  }
  case_.num_frames = has(kOtherCount) ? byte() % (kMaxCaseFrames + 1) : count;
}

// The box of all finite coordinates, or another one.
void CaseMaker::read_box() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (std::size_t c = 0; c < 3; ++c) {
    float low = kInfinity;
    float high = -kInfinity;
    for (const auto& frame : case_.frames) {
      for (std::size_t i = c; i < frame.size(); i += 3) {
        if (!std::isfinite(frame[i])) continue;
        low = std::min(low, frame[i]);
        high = std::max(high, frame[i]);
      }
    }
    if (low <= high) {
      case_.box_min[c] = low;
      case_.box_max[c] = high;
    }
  }
  if (!has(kOwnBox)) return;
  const double widen = signed_byte();
  for (std::size_t c = 0; c < 3; ++c) {
    if (widen == 0.0) {
      case_.box_min[c] = any_float();
      case_.box_max[c] = any_float();
      continue;
    }
    const double more = (static_cast<double>(case_.box_max[c]) - case_.box_min[c]) *
                        std::copysign(std::exp2(std::abs(widen) / 8.0), widen);
    case_.box_min[c] = to_float(case_.box_min[c] - more);
    case_.box_max[c] = to_float(case_.box_max[c] + more);
  }
}

// The contract of FrameSource.
void CaseMaker::keep_to_source() {
  case_.num_vertices = std::max(case_.num_vertices, 1U);
  for (std::uint32_t& v : case_.indices) v %= case_.num_vertices;
  if (case_.frames.empty()) case_.frames.emplace_back();
  for (auto& frame : case_.frames) {
    frame.resize(3 * std::size_t{case_.num_vertices});
    for (float& x : frame) {
      if (!std::isfinite(x)) x = 0.0F;
    }
  }
  case_.num_frames = static_cast<std::uint32_t>(case_.frames.size());
  case_.frame_rate.denominator = std::max(case_.frame_rate.denominator, 1U);
}

}  // namespace

bool EncoderCase::has_known_options() const {
  return options.profile <= RLPC_PROFILE_HIGH && options.preset <= RLPC_PRESET_SLOW &&
         options.target >= RLPC_TARGET_KG && options.target <= RLPC_TARGET_LOSSLESS &&
         options.hash_mode <= RLPC_HASH_MODE_FRAME;
}

bool EncoderCase::has_legal_target() const {
  const double value = options.target_value;
  if (options.target == RLPC_TARGET_LOSSLESS) {
    return options.profile == RLPC_PROFILE_HIGH && options.components == 0 && value >= 2.0 &&
           value <= 24.0 && value == std::floor(value);
  }
  return value > 0.0 && std::isfinite(value);
}

bool EncoderCase::is_legal() const {
  if (settings) return !check_settings(*settings);
  if (!has_known_options() || num_vertices == 0) return false;
  if (num_frames == 0 && options.profile != RLPC_PROFILE_HIGH) return false;
  if (frame_rate.numerator == 0 || frame_rate.denominator == 0) return false;
  for (const std::uint32_t v : indices) {
    if (v >= num_vertices) return false;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(box_min[c] <= box_max[c] && box_min[c] >= -kMaxCoordinate &&
          box_max[c] <= kMaxCoordinate)) {
      return false;
    }
  }
  return has_legal_target() && options.components <= 1024 && options.least_level >= 1 &&
         options.least_level <= 4;
}

bool EncoderCase::is_legal_frame(std::size_t frame) const {
  const auto& xyz = frames[frame];
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const bool within = settings ? std::abs(xyz[i]) <= kMaxCoordinate
                                 : xyz[i] >= box_min[i % 3] && xyz[i] <= box_max[i % 3];
    if (!within) return false;
  }
  return settings || num_frames == 0 || frame < num_frames;
}

EncoderCase make_encoder_case(std::span<const std::uint8_t> bytes) {
  return CaseMaker(bytes).make();
}

}  // namespace rlpc
