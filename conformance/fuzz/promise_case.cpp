#include "conformance/fuzz/promise_case.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <utility>

#include "encoder/codec/kind_choices.h"

namespace rlpc {
namespace {

using Point = std::array<double, 3>;

class CaseMaker {
 public:
  explicit CaseMaker(std::uint64_t seed) : random_(seed) {}

  PromiseCase make() {
    make_shape();
    make_frames();
    make_settings();
    if (chance(4)) add_attributes();
    return std::move(case_);
  }

 private:
  enum Kind : std::uint32_t {
    kRigid,
    kDrifting,
    kHinged,
    kNoise,
    kDegenerate,
    kManyParts,
    kFarAway,
    kStatic,
    kRepeated,
    kBending,
    kKinds
  };
  static constexpr const char* kNames[kKinds] = {
      "rigid",      "drifting", "hinged", "noise",    "degenerate",
      "many parts", "far away", "static", "repeated", "bending"};

  // std::uniform_int_distribution differs from library to library.
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(random_() % count);
  }
  bool chance(std::uint32_t one_in) { return below(one_in) == 0; }
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }  // 0 to 1
  double sign() { return 2.0 * unit() - 1.0; }

  void make_shape();
  void make_triangles(std::uint32_t columns, std::uint32_t rows, std::uint32_t first);
  void make_frames();
  Point moved(const Point& p, std::uint32_t vertex, double time) const;
  void place_on_grid();
  void make_settings();
  void make_target();
  void make_high();
  void add_attributes();

  std::mt19937_64 random_;
  PromiseCase case_;
  Kind kind_ = kRigid;
  std::vector<Point> rest_;
  std::uint32_t hinge_ = 0;  // vertices from here on turn
  std::uint32_t part_size_ = 1;
  Point axis_{};
  Point velocity_{};
  double spin_ = 0.0;
  double extent_ = 1.0;  // approximate size of the animation
  bool on_grid_ = false;
};

void CaseMaker::make_triangles(std::uint32_t columns, std::uint32_t rows, std::uint32_t first) {
  for (std::uint32_t y = 0; y + 1 < rows; ++y) {
    for (std::uint32_t x = 0; x + 1 < columns; ++x) {
      const std::uint32_t a = first + y * columns + x;
      const std::uint32_t b = a + columns;
      case_.shape.triangles.push_back({a, a + 1, b});
      case_.shape.triangles.push_back({a + 1, b + 1, b});
    }
  }
}

void CaseMaker::make_shape() {
  kind_ = static_cast<Kind>(below(kKinds));
  case_.kind = kNames[kind_];
  const std::uint32_t parts = kind_ == kManyParts ? 2 + below(12) : 1;
  const std::uint32_t columns = kind_ == kManyParts ? 1 + below(4) : 1 + below(12);
  const std::uint32_t rows = 1 + below(kind_ == kManyParts ? 3 : 10);
  part_size_ = columns * rows;
  for (std::uint32_t part = 0; part < parts; ++part) {
    make_triangles(columns, rows, part * part_size_);
    const Point at{3.0 * sign(), 3.0 * sign(), 3.0 * sign()};
    for (std::uint32_t v = 0; v < part_size_; ++v) {
      const double x = v % columns;
      const std::uint32_t row = v / columns;
      const double y = row;
      Point p{0.1 * x, 0.1 * y, 0.05 * std::sin(x + 0.7 * y)};
      if (kind_ == kManyParts) {
        for (std::size_t c = 0; c < 3; ++c) p[c] += at[c];
      }
      rest_.push_back(p);
    }
  }
  if (kind_ == kDegenerate) {
    const std::uint32_t n = static_cast<std::uint32_t>(rest_.size());
    for (std::uint32_t i = 0; i < 4; ++i) {
      case_.shape.triangles.push_back({below(n), below(n), below(n)});
    }
    const bool is_point = chance(3);
    for (Point& p : rest_) p[chance(2) ? 0 : 2] = is_point ? 0.25 : p[1];
  }
  if (chance(10)) case_.shape.triangles.clear();
}

Point CaseMaker::moved(const Point& p, std::uint32_t vertex, double time) const {
  Point out = p;
  const bool turns = kind_ == kRigid || kind_ == kFarAway || kind_ == kDegenerate ||
                     kind_ == kRepeated || kind_ == kManyParts ||
                     (kind_ == kHinged && vertex >= hinge_);
  if (turns) {
    const std::uint32_t number = vertex / part_size_;
    const double part = kind_ == kManyParts ? 1.0 + number : 1.0;
    const double angle = spin_ * time * part;
    out[0] = std::cos(angle) * (p[0] - axis_[0]) - std::sin(angle) * (p[1] - axis_[1]);
    out[1] = std::sin(angle) * (p[0] - axis_[0]) + std::cos(angle) * (p[1] - axis_[1]);
    out[0] += axis_[0];
    out[1] += axis_[1];
  }
  if (kind_ == kDrifting || kind_ == kFarAway) {
    for (std::size_t c = 0; c < 3; ++c) out[c] += velocity_[c] * time;
  }
  if (kind_ == kBending) out[2] += 0.3 * std::sin(time + 2.0 * p[0]) * p[1];
  return out;
}

// Moves all frames to a grid of few bits, as lossless coding without a number of bits needs.
void CaseMaker::place_on_grid() {
  const double step = std::exp2(static_cast<double>(below(12)) - 16.0);
  on_grid_ = true;
  for (auto& frame : case_.frames) {
    for (double& x : frame) x = std::floor(x / step + 0.5) * step;
  }
}

void CaseMaker::make_frames() {
  const auto n = static_cast<std::uint32_t>(rest_.size());
  hinge_ = below(n + 1);
  for (std::size_t c = 0; c < 3; ++c) {
    axis_[c] = sign();
    velocity_[c] = 0.2 * sign();
  }
  spin_ = 0.4 * sign();
  const std::uint32_t count = 1 + below(chance(6) ? 40 : 14);
  const std::uint32_t period = 1 + below(4);
  const double scale = chance(3) ? std::exp2(20.0 * sign()) : 1.0;
  Point offset{};
  if (kind_ == kFarAway) {
    const double far = std::exp2(4.0 + 22.0 * unit());
    offset = {far * sign(), far * sign(), far * sign()};
  }
  for (std::uint32_t f = 0; f < count; ++f) {
    const double time = kind_ == kStatic ? 0.0 : kind_ == kRepeated ? f % period : f;
    std::vector<double> xyz;
    for (std::uint32_t v = 0; v < n; ++v) {
      const Point p = moved(rest_[v], v, time);
      for (std::size_t c = 0; c < 3; ++c) {
        double x = p[c] + offset[c];
        if (kind_ == kNoise) x += 0.2 * sign();
        xyz.push_back(x * scale);
      }
    }
    case_.frames.push_back(std::move(xyz));
  }
  extent_ = scale;
  if (chance(3)) place_on_grid();
  if (chance(2) || on_grid_) {  // rounded to floats, as in a point cache
    for (auto& frame : case_.frames) {
      for (double& x : frame) x = static_cast<double>(static_cast<float>(x));
    }
  }
  case_.shape.num_vertices = n;
  case_.shape.num_frames = count;
  case_.shape.frame_rate = {25, 1};
}

void CaseMaker::make_target() {
  Target& target = case_.settings.target;
  switch (below(8)) {
    case 0:
    case 1:
      target = {Target::kLossless, on_grid_ ? 0.0 : 2.0 + below(23)};
      break;
    case 2:
    case 3:
      target = {Target::kLossless, 2.0 + below(23)};
      break;
    case 4:
    case 5:
      target = {Target::kMaxError, extent_ * std::exp2(-14.0 * unit())};
      break;
    case 6:
      target = {Target::kKg, std::exp2(-6.0 + 8.0 * unit())};
      if (chance(2)) target.max_normals = std::exp2(-4.0 + 8.0 * unit());
      break;
    default:
      target = {Target::kBpvf, std::exp2(7.0 * unit())};
      break;
  }
}

void CaseMaker::make_high() {
  EncoderSettings& s = case_.settings;
  const bool exact = s.target.kind == Target::kLossless;
  if (case_.way == PromiseCase::kLowDelay) {
    s.low_delay = true;
    if (chance(2)) s.inter.pattern.emplace().kind = FramePattern::kFirst;
  } else if (!exact && chance(2)) {
    s.gof_kind = kKindChoices[below(kNumKindChoices)];
  }
  if (s.usable_kind() == GofKind::kInter) {
    if (chance(2)) s.inter.patches = below(9);
    if (chance(3)) s.inter.weights = static_cast<InterWeights>(below(3));
    if (chance(3)) s.inter.rest = static_cast<RestTools>(below(3));
    if (chance(4)) s.inter.frames_per_unit = 1 + below(4);
    if (chance(4) && !s.low_delay) s.inter.temporal_layers = 2;
    if (chance(4)) s.inter.layer_groups = 1 + below(3);
    constexpr PartitionMethod kPartitions[] = {PartitionMethod::kMotion, PartitionMethod::kKway,
                                               PartitionMethod::kLloyd};
    s.inter.partition = kPartitions[below(3)];
  }
}

void CaseMaker::make_settings() {
  EncoderSettings& s = case_.settings;
  make_target();
  case_.way = static_cast<PromiseCase::Way>(chance(3) ? 1 + below(2) : 0);
  const bool is_searched = s.target.kind == Target::kBpvf || s.target.max_normals > 0.0;
  if (is_searched && case_.way == PromiseCase::kLowDelay) {
    case_.way = PromiseCase::kSpans;
  }
  if (s.target.kind == Target::kLossless && s.target.value == 0.0)
    case_.way = PromiseCase::kWhole;
  const bool high =
      s.target.kind == Target::kLossless || case_.way == PromiseCase::kLowDelay || chance(3);
  s.profile = high ? Profile::kHigh : chance(2) ? Profile::kMain : Profile::kBaseline;
  s.preset = chance(8) ? Preset::kSlow : chance(2) ? Preset::kFast : Preset::kMedium;
  if (high) make_high();
  if (high && case_.way != PromiseCase::kWhole) case_.open_ended = chance(2);
  case_.max_held_frames = below(20);
  if (chance(2)) s.gof_frames = 1 + below(20);
  s.keep_order = chance(2);
  s.hash_mode = static_cast<HashMode>(below(3));
  s.threads = 1 + below(3);
  if (chance(6)) s.metadata = R"({"title":"case"})";
}

void CaseMaker::add_attributes() {
  if (case_.shape.triangles.empty()) return;
  SourceAttribute& uv = case_.shape.attributes.sets.emplace_back();
  uv.name = "texcoord_0";
  uv.domain = AttributeDomain::kVertex;
  uv.num_components = 2;
  for (std::uint32_t v = 0; v < 2 * case_.shape.num_vertices; ++v) {
    uv.values.push_back(static_cast<float>(unit()));
  }
  if (chance(2)) return;
  SourceAttribute& normal = case_.shape.attributes.sets.emplace_back();
  normal.name = "normal";
  normal.domain = AttributeDomain::kVertex;
  normal.kind = SourceAttribute::Kind::kNormals;
  normal.num_components = 3;
  for (std::uint32_t v = 0; v < case_.shape.num_vertices; ++v) {
    const double turn = 6.28 * unit();
    normal.values.push_back(0.0F);
    normal.values.push_back(static_cast<float>(std::cos(turn)));
    normal.values.push_back(static_cast<float>(std::sin(turn)));
  }
}

}  // namespace

ExactFrames::ExactFrames(Shape shape, std::vector<std::vector<double>> frames)
    : FrameSource(std::move(shape)), frames_(std::move(frames)) {
  for (const auto& frame : frames_) {
    for (const double x : frame) {
      is_finer_ = is_finer_ || static_cast<double>(static_cast<float>(x)) != x;
    }
  }
}

std::optional<InputError> ExactFrames::read_frame(std::uint32_t frame, std::span<float> xyz) {
  std::transform(frames_[frame].begin(), frames_[frame].end(), xyz.begin(),
                 [](double x) { return static_cast<float>(x); });
  return std::nullopt;
}

std::optional<InputError> ExactFrames::read_exact(std::uint32_t frame, std::span<double> xyz) {
  std::copy(frames_[frame].begin(), frames_[frame].end(), xyz.begin());
  return std::nullopt;
}

PromiseCase make_promise_case(std::uint64_t seed) { return CaseMaker(seed).make(); }

}  // namespace rlpc
