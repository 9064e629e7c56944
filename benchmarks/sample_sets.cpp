#include "benchmarks/sample_sets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/noise.h"

namespace rondure::benchmarks {
namespace {

constexpr std::array kOrders = {2, 3, 5, 7};
constexpr double kLargestLobe_mm = 0.003;
constexpr double kNoise_mm = 0.001;
constexpr double kSpike_mm = 0.012;

/// Streams of random numbers of one set, so that no choice moves another.
enum Stream : std::uint64_t { kForm, kNoise, kPlace, kOrder, kSpikes };

core::KeyedNoise stream(const SetKey& key, Stream which) {
  // The arc takes part in whole degrees. The variant does not: scan order and shuffled hold the
  // same points.
  const auto arc_deg = static_cast<std::uint64_t>(std::lround(key.arc_rad / core::kDegree));
  return {key.seed, {which, key.points, arc_deg}};
}

double between(core::KeyedNoise& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

struct Lobe {
  int order = 0;
  double amplitude_mm = 0.0;
  double phase_rad = 0.0;
  double twist_rad = 0.0;  ///< Phase gained from the middle to an end.
};

struct Form {
  std::array<Lobe, kOrders.size()> lobes;
  double taper_mm = 0.0;
  double barrel_mm = 0.0;

  /// z runs from -1 to 1.
  [[nodiscard]] double at(double theta_rad, double z) const {
    double sum = taper_mm * z + barrel_mm * (1.0 - z * z);
    for (const Lobe& lobe : lobes) {
      sum += lobe.amplitude_mm *
             std::cos(lobe.order * theta_rad + lobe.phase_rad + lobe.twist_rad * z);
    }
    return sum;
  }
};

Form random_form(const SetKey& key) {
  auto random = stream(key, kForm);
  Form form;
  for (std::size_t i = 0; i < kOrders.size(); ++i) {
    form.lobes[i] = {kOrders[i], between(random, 0.0, kLargestLobe_mm),
                     between(random, 0.0, core::kTwoPi), between(random, -1.0, 1.0)};
  }
  form.taper_mm = between(random, -0.003, 0.003);
  form.barrel_mm = between(random, -0.003, 0.003);
  return form;
}

/// Deviations from the ideal radius besides the form: noise, spikes.
class Roughness {
 public:
  explicit Roughness(const SetKey& key)
      : variant_(key.variant), noise_(stream(key, kNoise)), spikes_(stream(key, kSpikes)) {}

  double next() {
    double out = kNoise_mm * std::clamp(noise_.normal(), -4.0, 4.0);
    if (variant_ == Variant::kSpikes) {
      const double drawn = spikes_.uniform();
      if (drawn < 0.005) out += drawn < 0.0025 ? kSpike_mm : -kSpike_mm;
    }
    return out;
  }

 private:
  Variant variant_;
  core::KeyedNoise noise_;
  core::KeyedNoise spikes_;
};

double scale_of(Variant variant) { return variant == Variant::kSmallForm ? 0.05 : 1.0; }

/// Order and rounding of the finished points.
template <class Point>
void finish(std::vector<Point>& points_mm, const SetKey& key) {
  const double grid_mm = key.variant == Variant::kRounded100nm ? 1e-4
                         : key.variant == Variant::kRounded1um ? 1e-3
                                                               : 0.0;
  if (grid_mm > 0.0) {
    for (Point& p : points_mm) p = (p / grid_mm).array().round().matrix() * grid_mm;
  }
  if (key.variant != Variant::kShuffled) return;
  auto random = stream(key, kOrder);
  for (std::size_t i = points_mm.size(); i > 1; --i) {
    const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(i));
    std::swap(points_mm[i - 1], points_mm[other]);
  }
}

double start_off_rad(Variant variant) {
  switch (variant) {
    case Variant::kStart5:
      return 5.0 * core::kDegree;
    case Variant::kStart25:
      return 25.0 * core::kDegree;
    case Variant::kStart45:
      return 45.0 * core::kDegree;
    default:
      return 1.0 * core::kDegree;
  }
}

/// `direction` turned by exactly this angle, to a random side.
Eigen::Vector3d turned(const Eigen::Vector3d& direction, double angle_rad,
                       core::KeyedNoise& random) {
  const Eigen::AngleAxisd spin(between(random, 0.0, core::kTwoPi), direction);
  return Eigen::AngleAxisd(angle_rad, spin * direction.unitOrthogonal()) * direction;
}

}  // namespace

std::string_view name_of(Variant variant) {
  switch (variant) {
    case Variant::kScanOrder:
      return "scan";
    case Variant::kShuffled:
      return "shuffled";
    case Variant::kRounded100nm:
      return "rounded-0.1um";
    case Variant::kRounded1um:
      return "rounded-1um";
    case Variant::kSpikes:
      return "spikes";
    case Variant::kStart5:
      return "start-5deg";
    case Variant::kStart25:
      return "start-25deg";
    case Variant::kStart45:
      return "start-45deg";
    case Variant::kSmallForm:
      return "small-form";
  }
  return "";
}

CylinderSet make_cylinder(const SetKey& key) {
  auto place = stream(key, kPlace);
  CylinderSet out;
  out.axis_point_mm = {between(place, -0.5, 0.5), between(place, -0.5, 0.5), 40.0};
  out.axis_direction =
      turned(Eigen::Vector3d::UnitZ(), between(place, 0.0, 5.0 * core::kDegree), place);
  out.start_direction = turned(out.axis_direction, start_off_rad(key.variant), place);
  const Eigen::Vector3d u = out.axis_direction.unitOrthogonal();
  const Eigen::Vector3d v = out.axis_direction.cross(u);
  const Form form = random_form(key);
  Roughness roughness(key);
  const std::size_t sections = std::max<std::size_t>(
      3, static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(key.points)))));
  out.points_mm.reserve(key.points);
  for (std::size_t section = 0; section < sections; ++section) {
    const std::size_t first = section * key.points / sections;
    const std::size_t count = (section + 1) * key.points / sections - first;
    const double z = 2.0 * static_cast<double>(section) / static_cast<double>(sections - 1) - 1.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double step = static_cast<double>(i) + 0.8 * place.uniform();
      const double theta = key.arc_rad * step / static_cast<double>(count);
      const double r = kRadius_mm + scale_of(key.variant) * (form.at(theta, z) + roughness.next());
      out.points_mm.emplace_back(out.axis_point_mm + kHalfLength_mm * z * out.axis_direction +
                                 r * (std::cos(theta) * u + std::sin(theta) * v));
    }
  }
  finish(out.points_mm, key);
  return out;
}

CircleSet make_circle(const SetKey& key) {
  auto place = stream(key, kPlace);
  CircleSet out;
  out.center_mm = {between(place, -0.5, 0.5), between(place, -0.5, 0.5)};
  Form form = random_form(key);
  Roughness roughness(key);
  out.points_mm.reserve(key.points);
  for (std::size_t i = 0; i < key.points; ++i) {
    const double step = static_cast<double>(i) + 0.8 * place.uniform();
    const double theta = key.arc_rad * step / static_cast<double>(key.points);
    const double r = kRadius_mm + scale_of(key.variant) * (form.at(theta, 0.0) + roughness.next());
    out.points_mm.emplace_back(out.center_mm +
                               r * Eigen::Vector2d(std::cos(theta), std::sin(theta)));
  }
  finish(out.points_mm, key);
  return out;
}

}  // namespace rondure::benchmarks
