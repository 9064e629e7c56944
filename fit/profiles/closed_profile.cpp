#include "fit/profiles/closed_profile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/numbers.h"
#include "core/units.h"
#include "fit/profiles/periodic_spline.h"

namespace rondure::fit {
namespace {

constexpr double kUniformShare = 1e-6;
constexpr double kArcGap = std::numbers::pi / 2.0;
constexpr std::size_t kLeastResampled = 1024;
/// Least factor between the errors of the splines through every other point and through all points.
constexpr double kHalvingGain = 4.0;

/// Reduces an angle to [0, 2 pi).
double within_turn(double theta) {
  const double turned = theta - core::kTwoPi * std::floor(theta / core::kTwoPi);
  return turned < core::kTwoPi ? turned : 0.0;
}

core::Result<void> check_values(std::span<const double> theta, std::span<const double> r) {
  if (theta.empty() || theta.size() != r.size()) {
    return core::fail_with(
        core::Code::kNoPoints,
        "a profile needs as many angles as radii, at least 4; there are {} and {}", theta.size(),
        r.size());
  }
  for (std::size_t i = 0; i < theta.size(); ++i) {
    if (core::is_measurable(theta[i]) && core::is_measurable(r[i])) continue;
    return core::fail_with(
        core::Code::kNotFinite,
        "row {} is (angle {} rad, radius {} mm); both must be finite numbers up to {:g}", i,
        theta[i], r[i], core::kGreatestNumber);
  }
  return {};
}

/// Counts the steps between successive inputs, each in the shorter direction.
void count_steps(std::span<const double> theta, AngularProfile& out) {
  std::size_t forward = 0;
  std::size_t backward = 0;
  double sum = 0.0;
  for (std::size_t i = 1; i < theta.size(); ++i) {
    const double step = std::remainder(theta[i] - theta[i - 1], core::kTwoPi);
    sum += step;
    if (step > core::kSameAngle) ++forward;
    if (step < -core::kSameAngle) ++backward;
  }
  out.reversals = std::min(forward, backward);
  out.turns = std::abs(sum) / core::kTwoPi;
}

/// Merges the rows of equal angle, given in order of angle, into one value.
class Merger {
 public:
  explicit Merger(AngularProfile& out) : out_(out) {}

  void add(double theta, double r, std::size_t row) {
    if (count_ > 0 && theta - out_.theta_rad.back() < core::kSameAngle) {
      sum_ += r;
      ++count_;
      ++out_.merged;
      out_.r_mm.back() = sum_ / static_cast<double>(count_);
      return;
    }
    out_.theta_rad.push_back(theta);
    out_.r_mm.push_back(r);
    out_.rows.push_back(row);
    sum_ = r;
    count_ = 1;
  }

 private:
  AngularProfile& out_;
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

std::size_t next_of(std::size_t i, std::size_t n) { return i + 1 < n ? i + 1 : 0; }

/// Gap from point i to the next one; the last point is followed by the first.
double gap_after(std::span<const double> theta, std::size_t i) {
  const std::size_t next = next_of(i, theta.size());
  return theta[next] - theta[i] + (next == 0 ? core::kTwoPi : 0.0);
}

AngularProfile every_other(const AngularProfile& profile) {
  AngularProfile half;
  for (std::size_t i = 0; i + 1 < profile.theta_rad.size(); i += 2) {
    half.theta_rad.push_back(profile.theta_rad[i]);
    half.r_mm.push_back(profile.r_mm[i]);
  }
  return half;
}

}  // namespace

double UniformProfile::angle_rad(std::size_t i) const {
  return within_turn(start_rad +
                     core::kTwoPi * static_cast<double>(i) / static_cast<double>(r_mm.size()));
}

bool AngularProfile::uniform() const {
  const auto n = static_cast<double>(theta_rad.size());
  for (std::size_t i = 0; i < theta_rad.size(); ++i) {
    const double expected = core::kTwoPi * static_cast<double>(i) / n;
    if (std::abs(theta_rad[i] - theta_rad[0] - expected) > kUniformShare * core::kTwoPi / n) {
      return false;
    }
  }
  return true;
}

core::Result<AngularProfile> ordered_profile(std::span<const double> theta_rad,
                                             std::span<const double> r_mm) {
  TRY_DO(check_values(theta_rad, r_mm));
  AngularProfile out;
  count_steps(theta_rad, out);
  std::vector<double> turned(theta_rad.size());
  std::ranges::transform(theta_rad, turned.begin(), within_turn);
  // An angle just below a full turn because of rounding belongs to the beginning of the turn.
  for (double& theta : turned) {
    if (core::kTwoPi - theta < core::kSameAngle) theta = 0.0;
  }
  std::vector<std::size_t> order(turned.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t row) { return turned[row]; });
  Merger merger(out);
  for (const std::size_t row : order) merger.add(turned[row], r_mm[row], row);
  if (out.theta_rad.size() < 4) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} different angles; a profile needs at least 4", out.theta_rad.size());
  }
  for (std::size_t i = 0; i < out.theta_rad.size(); ++i) {
    out.largest_gap_rad = std::max(out.largest_gap_rad, gap_after(out.theta_rad, i));
  }
  return out;
}

core::Result<void> check_gaps(const AngularProfile& profile, double cutoff_upr) {
  if (profile.uniform()) return {};
  const double gap_deg = profile.largest_gap_rad / core::kDegree;
  const double limit_deg = 90.0 / cutoff_upr;
  if (gap_deg < limit_deg) return {};
  return core::fail_with(core::Code::kSampling,
                         "the largest gap between angles is {:.4g} deg, {} UPR allow {:.4g} deg (a "
                         "quarter undulation): measure the missing angles, or take a lower "
                         "cut-off; the check can be overridden",
                         gap_deg, cutoff_upr, limit_deg);
}

std::vector<double> angular_cells(std::span<const double> theta_rad) {
  const std::size_t n = theta_rad.size();
  std::vector<double> cells(n);
  for (std::size_t i = 0; i < n; ++i) {
    double before = gap_after(theta_rad, i > 0 ? i - 1 : n - 1);
    double after = gap_after(theta_rad, i);
    if (before >= kArcGap && after < kArcGap) before = after;
    if (after >= kArcGap && before < kArcGap) after = before;
    cells[i] = 0.5 * (before + after);
  }
  return cells;
}

core::Result<ResampledProfile> resampled(const AngularProfile& profile) {
  ResampledProfile out;
  if (profile.uniform()) {
    out.profile = {profile.theta_rad[0], profile.r_mm};
    return out;
  }
  if (profile.largest_gap_rad >= kArcGap) {
    return core::fail_with(
        core::Code::kNotFullSection,
        "the profile has a gap of {:.1f} deg; a closed profile is filtered only where every gap is "
        "below 90 deg: evaluate it without a filter, or measure the missing angles",
        profile.largest_gap_rad / core::kDegree);
  }
  out.interpolated = true;
  const std::size_t samples = std::max(kLeastResampled, std::bit_ceil(2 * profile.r_mm.size()));
  out.profile.r_mm.resize(samples);
  const PeriodicSpline all(profile.theta_rad, profile.r_mm);
  std::optional<PeriodicSpline> rough;
  if (const auto half = every_other(profile); half.r_mm.size() >= 4) {
    rough.emplace(half.theta_rad, half.r_mm);
  }
  for (std::size_t i = 0; i < samples; ++i) {
    const double theta = out.profile.angle_rad(i);
    out.profile.r_mm[i] = all(theta);
    if (!rough) continue;
    out.error_mm =
        std::max(out.error_mm, std::abs(out.profile.r_mm[i] - (*rough)(theta)) / kHalvingGain);
  }
  return out;
}

}  // namespace rondure::fit
