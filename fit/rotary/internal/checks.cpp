#include "fit/rotary/internal/checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/geometry/points.h"
#include "fit/geometry/registration.h"

namespace rondure::fit {
namespace {

using core::Code;
using Eigen::Vector3d;

const BallCentre* find_ball(std::span<const BallCentre> balls, const std::string& name) {
  const auto at = std::ranges::find(balls, name, &BallCentre::ball);
  return at == balls.end() ? nullptr : &*at;
}

/// @param exact_allowed  Whether u = 0 is allowed, as for a reference.
core::Result<void> check_balls(std::span<const BallCentre> balls, const std::string& place,
                               bool exact_allowed) {
  std::set<std::string> seen;
  for (const BallCentre& ball : balls) {
    if (!check_points(std::span(&ball.centre_mm, 1)) || !check_points(std::span(&ball.u_mm, 1))) {
      return core::fail_with(Code::kNotFinite,
                             "ball {} {}: centre or u is not a finite number up to 1e7 mm",
                             ball.ball, place);
    }
    const double least = ball.u_mm.minCoeff();
    if (least < 0.0 || (least == 0.0 && !exact_allowed)) {
      return core::fail_with(Code::kBadOption, "ball {} {}: u is {:g} um, it must be above 0",
                             ball.ball, place, least / core::kMicrometre);
    }
    if (!seen.insert(ball.ball).second) {
      return core::fail_with(Code::kRepeatedKey, "ball {} stands twice {}", ball.ball, place);
    }
  }
  return {};
}

core::Result<void> check_axis(const RotaryMeasurement& m) {
  if (!m.axis.direction.allFinite() || !check_points(std::span(&m.axis.origin_mm, 1)) ||
      !core::is_measurable(m.reference_rad)) {
    return core::fail(Code::kNotFinite, "axis, origin or reference angle is not finite");
  }
  if (std::abs(m.axis.direction.norm() - 1.0) > 1e-6) {
    return core::fail_with(Code::kBadOption,
                           "the axis direction has length {:g}, a unit vector is needed",
                           m.axis.direction.norm());
  }
  if (m.references.empty()) {
    return core::fail(Code::kMissingKey,
                      "the reference pose is missing: measure all balls there, best at start, "
                      "middle and end");
  }
  if (m.stations.empty()) {
    return core::fail(Code::kTooFewPoints, "there are no stations");
  }
  return {};
}

bool repeats(const RotaryPose& a, const RotaryPose& b) {
  const bool two_directions = a.approach != b.approach && a.approach != Approach::kUnknown &&
                              b.approach != Approach::kUnknown;
  return !two_directions && std::abs(a.angle_rad - b.angle_rad) <= core::kSameAngle;
}

core::Result<void> check_station(const RotaryMeasurement& m, std::size_t index,
                                 const std::set<std::string>& known) {
  const RotaryPose& station = m.stations[index];
  if (!core::is_measurable(station.angle_rad)) {
    return core::fail_with(Code::kNotFinite, "the angle of station {} is not finite", index + 1);
  }
  const std::string place = fmt::format("at {:g} deg", core::degrees(station.angle_rad));
  if (station.angle_rad < m.lowest_rad - core::kSameAngle ||
      station.angle_rad > m.highest_rad + core::kSameAngle) {
    return core::fail_with(Code::kPoseRange,
                           "station {:g} deg is outside the range of the axis, {:g}..{:g} deg",
                           core::degrees(station.angle_rad), core::degrees(m.lowest_rad),
                           core::degrees(m.highest_rad));
  }
  for (std::size_t i = 0; i < index; ++i) {
    if (!repeats(m.stations[i], station)) continue;
    return core::fail_with(Code::kRepeatedKey,
                           "station {:g} deg stands twice; state the direction of approach where "
                           "it was measured forward and backward",
                           core::degrees(station.angle_rad));
  }
  if (auto fine = check_balls(station.balls, place, false); !fine) return fine;
  for (const BallCentre& ball : station.balls) {
    if (known.contains(ball.ball)) continue;
    return core::fail_with(Code::kUnknownKey, "ball {} {} was not measured in the reference pose",
                           ball.ball, place);
  }
  return {};
}

/// The mistake in units that the ratio of two lengths suggests, which should be equal.
std::string_view unit_hint(double ratio) {
  struct Unit {
    double factor;
    std::string_view text;
  };
  constexpr std::array<Unit, 4> kUnits = {{{25.4, "mm and inch are mixed"},
                                           {1000.0, "mm and um or m are mixed"},
                                           {10.0, "mm and cm are mixed"},
                                           {1e6, "um and m are mixed"}}};
  const double size = std::max(ratio, 1.0 / ratio);
  for (const Unit& unit : kUnits) {
    if (std::abs(size / unit.factor - 1.0) < 0.02) return unit.text;
  }
  return "balls are confused or units are mixed";
}

constexpr double kRotationLimit = 0.1;    // rad
constexpr double kNeighbourLimit = 1e-3;  // rad: more than any axis has at a single station
constexpr double kNeighbourDoubt = 1e-4;  // rad: a wrong label, or a local error of the axis

/// Measured turn of a station from the reference.
struct MeasuredTurn {
  double angle_rad = 0.0;
  Approach approach = Approach::kUnknown;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
};

/// Remaining rotation if the true angle of each station is hypothesis(angle from the reference).
template <class Hypothesis>
double rotation_left(const std::vector<MeasuredTurn>& turns, const RotaryMeasurement& m,
                     const Hypothesis& hypothesis) {
  double out = 0.0;
  for (const MeasuredTurn& one : turns) {
    const double angle = hypothesis(one.angle_rad - m.reference_rad);
    out = std::max(out, rotation_vector(one.turn * m.axis.turn(angle).transpose()).norm());
  }
  return out;
}

/// Measured turn from the reference at each station that shows one.
std::vector<MeasuredTurn> measured_turns(const RotaryMeasurement& m,
                                         std::span<const BallCentre> reference) {
  std::vector<MeasuredTurn> out;
  for (const RotaryPose& station : m.stations) {
    std::vector<Vector3d> from;
    std::vector<Vector3d> to;
    for (const BallCentre& ball : station.balls) {
      from.push_back(find_ball(reference, ball.ball)->centre_mm);
      to.push_back(ball.centre_mm);
    }
    const auto found = rigid_registration(from, to);
    if (found) out.push_back({station.angle_rad, station.approach, found->motion.linear()});
  }
  return out;
}

/// Residual rotation of a station about its own axis.
struct OwnTurn {
  double angle_rad = 0.0;
  Approach approach = Approach::kUnknown;
  double left_rad = 0.0;
  bool reference = false;
};

/// Deviation of a station from the line through its neighbours, without `skipped`; at an end, from
/// the nearest neighbour or the line through two, whichever is less.
/// @param turns  In order of angle.
double departure(const std::vector<OwnTurn>& turns, std::size_t i, std::size_t skipped) {
  std::vector<const OwnTurn*> below;
  std::vector<const OwnTurn*> above;
  for (std::size_t k = i; k-- > 0 && below.size() < 2;) {
    if (k != skipped) below.push_back(&turns[k]);
  }
  for (std::size_t k = i + 1; k < turns.size() && above.size() < 2; ++k) {
    if (k != skipped) above.push_back(&turns[k]);
  }
  const auto off_line = [&](const OwnTurn& a, const OwnTurn& b) {
    const double apart = b.angle_rad - a.angle_rad;
    const double share =
        std::abs(apart) > core::kSameAngle ? (turns[i].angle_rad - a.angle_rad) / apart : 0.5;
    return turns[i].left_rad - a.left_rad - share * (b.left_rad - a.left_rad);
  };
  if (!below.empty() && !above.empty()) return off_line(*below[0], *above[0]);
  const auto& side = below.empty() ? above : below;
  if (side.empty()) return 0.0;
  const double step = turns[i].left_rad - side[0]->left_rad;
  if (side.size() < 2) return step;
  const double line = off_line(*side[1], *side[0]);
  return std::abs(line) < std::abs(step) ? line : step;
}

/// Deviations of all stations except `skipped`.
std::vector<double> departures(const std::vector<OwnTurn>& turns, std::size_t skipped) {
  std::vector<double> out;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (i != skipped) out.push_back(std::abs(departure(turns, i, skipped)));
  }
  return out;
}

/// The station above a limit without which the others agree best.
std::optional<std::size_t> worst_fit(const std::vector<OwnTurn>& turns, double limit_rad) {
  std::optional<std::size_t> out;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (std::abs(departure(turns, i, turns.size())) <= limit_rad) continue;
    const auto others = departures(turns, i);
    const double squares = std::inner_product(others.begin(), others.end(), others.begin(), 0.0);
    if (squares >= least) continue;
    least = squares;
    out = i;
  }
  return out;
}

/// A station that does not fit its neighbours.
struct Misfit {
  OwnTurn turn;
  double off_rad = 0.0;
  double others_rad = 0.0;  ///< Greatest deviation of the stations that fit.
  double limit_rad = 0.0;
};

/// The stations, at most a third, that do not fit the others of their direction of approach: they
/// deviate by more than `least_rad` and by five times the others, because coarsely spaced stations
/// of an axis with large errors also deviate from each other.
std::vector<Misfit> misfits(const std::vector<OwnTurn>& all, double reference_rad,
                            double least_rad) {
  const auto by_angle = [](const OwnTurn& a, const OwnTurn& b) {
    return a.angle_rad < b.angle_rad;
  };
  std::vector<Misfit> out;
  for (const Approach approach : {Approach::kUnknown, Approach::kForward, Approach::kBackward}) {
    std::vector<OwnTurn> fitting;
    std::ranges::copy_if(all, std::back_inserter(fitting),
                         [&](const OwnTurn& one) { return one.approach == approach; });
    if (fitting.size() < 2) continue;
    fitting.push_back({reference_rad, approach, 0.0, true});
    std::ranges::stable_sort(fitting, by_angle);
    std::vector<OwnTurn> left_out;
    for (std::size_t most = fitting.size() / 3; most > 0; --most) {
      const auto worst = worst_fit(fitting, least_rad);
      if (!worst) break;
      left_out.push_back(fitting[*worst]);
      fitting.erase(fitting.begin() + static_cast<std::ptrdiff_t>(*worst));
    }
    const auto usual = departures(fitting, fitting.size());
    const double others = *std::ranges::max_element(usual);
    const double limit = std::max(least_rad, 5.0 * others);
    for (const OwnTurn& one : left_out) {
      const auto place = std::upper_bound(fitting.begin(), fitting.end(), one, by_angle);
      const auto index = static_cast<std::size_t>(place - fitting.begin());
      auto with = fitting;
      with.insert(with.begin() + static_cast<std::ptrdiff_t>(index), one);
      const double off = departure(with, index, with.size());
      if (std::abs(off) > limit) out.push_back({one, off, others, limit});
    }
  }
  return out;
}

core::Error misfit_error(const std::vector<Misfit>& found, double reference_rad) {
  std::string what;
  for (const Misfit& one : found) {
    if (!what.empty()) what += "; ";
    const std::string name =
        one.turn.reference
            ? fmt::format("the reference pose ({:g} deg)", core::degrees(reference_rad))
            : fmt::format("station {:g} deg", core::degrees(one.turn.angle_rad));
    what += fmt::format(
        "{} does not fit its neighbours: {:.0f} urad about the axis beside {:.0f} "
        "of the others, limit {:.0f}; a label of {:.4g} deg would fit",
        name, one.off_rad * 1e6, one.others_rad * 1e6, one.limit_rad * 1e6,
        core::degrees(one.turn.angle_rad + one.off_rad));
  }
  return {Code::kInconsistent, what + ". Correct the angle, or measure there again"};
}

/// Changes of one distance relative to the reference, in the order of measurement.
struct DistanceChanges {
  std::vector<double> change_mm;
  double u_mm = 0.0;  ///< Standard uncertainty of a distance at a station, rms.
  double reference_u_mm = 0.0;
};

DistanceChanges changes_of(const RotaryMeasurement& m, const BallCentre& a, const BallCentre& b) {
  DistanceChanges out;
  const Vector3d along = a.centre_mm - b.centre_mm;
  // Mean over all directions, because the body turns.
  out.reference_u_mm = std::sqrt((a.u_mm.squaredNorm() + b.u_mm.squaredNorm()) / 3.0);
  double squares = 0.0;
  for (const RotaryPose& station : m.stations) {
    const BallCentre* first = find_ball(station.balls, a.ball);
    const BallCentre* second = find_ball(station.balls, b.ball);
    if (first == nullptr || second == nullptr) continue;
    out.change_mm.push_back((first->centre_mm - second->centre_mm).norm() - along.norm());
    squares += (first->u_mm.squaredNorm() + second->u_mm.squaredNorm()) / 3.0;
  }
  out.u_mm = std::sqrt(squares / std::max<double>(1.0, static_cast<double>(out.change_mm.size())));
  return out;
}

core::Result<void> check_distance(const DistanceChanges& changes, const std::string& name) {
  const std::vector<double>& all = changes.change_mm;
  if (all.size() < 3) return {};
  const double limit = 4.0 * std::hypot(changes.u_mm, changes.reference_u_mm);
  const double change = core::upper_median(all);
  if (std::abs(change) > limit) {
    return core::fail_with(Code::kInconsistent,
                           "the distance of balls {} is {:.2f} um off that of the reference pose, "
                           "limit {:.2f} um: thermal growth, or a ball has moved",
                           name, change / core::kMicrometre, limit / core::kMicrometre);
  }
  const auto third = static_cast<std::ptrdiff_t>(all.size() / 3);
  if (third < 2) return {};
  const double drift = core::upper_median({all.end() - third, all.end()}) -
                       core::upper_median({all.begin(), all.begin() + third});
  const double drift_limit = 4.0 * std::sqrt(2.0) * changes.u_mm;
  if (std::abs(drift) <= drift_limit) return {};
  return core::fail_with(
      Code::kInconsistent,
      "the distance of balls {} drifts by {:.2f} um from the first to the last third of the "
      "stations, limit {:.2f} um: thermal growth or a failing clamp",
      name, drift / core::kMicrometre, drift_limit / core::kMicrometre);
}

}  // namespace

core::Result<void> check_measurement(const RotaryMeasurement& measurement) {
  if (auto fine = check_axis(measurement); !fine) return fine;
  std::set<std::string> known;
  for (const auto& reference : measurement.references) {
    if (auto fine = check_balls(reference, "in the reference pose", true); !fine) return fine;
    for (const BallCentre& ball : reference) known.insert(ball.ball);
  }
  for (std::size_t i = 0; i < measurement.stations.size(); ++i) {
    if (auto fine = check_station(measurement, i, known); !fine) return fine;
  }
  return {};
}

core::Result<void> check_sizes(const RotaryMeasurement& measurement,
                               std::span<const BallCentre> reference) {
  for (const RotaryPose& station : measurement.stations) {
    for (std::size_t i = 0; i < station.balls.size(); ++i) {
      for (std::size_t j = i + 1; j < station.balls.size(); ++j) {
        const BallCentre& a = station.balls[i];
        const BallCentre& b = station.balls[j];
        const double here = (a.centre_mm - b.centre_mm).norm();
        const double there =
            (find_ball(reference, a.ball)->centre_mm - find_ball(reference, b.ball)->centre_mm)
                .norm();
        if (std::abs(here - there) <= 0.1 * there) continue;
        return core::fail_with(
            Code::kUnits,
            "balls {} and {} are {:g} mm apart at {:g} deg and {:g} mm in the reference pose: {}",
            a.ball, b.ball, here, core::degrees(station.angle_rad), there, unit_hint(here / there));
      }
    }
  }
  return {};
}

core::Result<void> check_sense(const RotaryMeasurement& measurement,
                               std::span<const BallCentre> reference) {
  const auto turns = measured_turns(measurement, reference);
  const auto left = [&](const auto& hypothesis) {
    return rotation_left(turns, measurement, hypothesis);
  };
  const double stated = left([](double a) { return a; });
  const double opposite = left([](double a) { return -a; });
  const double from_degrees = left([](double a) { return a * core::kDegree; });
  const double from_radians = left([](double a) { return a / core::kDegree; });
  // Over a few degrees a wrong sense or unit leaves less than the limit, but far more than the
  // right sense and unit.
  const double best = std::min({opposite, from_degrees, from_radians});
  const bool other_fits = stated > kNeighbourLimit && 10.0 * best < stated;
  if (stated <= kRotationLimit && !other_fits) return {};
  if (!other_fits) {
    std::vector<OwnTurn> own;
    for (const MeasuredTurn& one : turns) {
      const double angle = one.angle_rad - measurement.reference_rad;
      const Vector3d rest = rotation_vector(one.turn * measurement.axis.turn(angle).transpose());
      own.push_back({one.angle_rad, one.approach, rest.dot(measurement.axis.direction)});
    }
    const auto found = misfits(own, measurement.reference_rad, kNeighbourLimit);
    if (!found.empty()) return core::fail(misfit_error(found, measurement.reference_rad));
  }
  const std::string_view cure = !other_fits            ? "no other reading fits"
                                : best == opposite     ? "turn the sign of the angles"
                                : best == from_radians ? "the angles are in radians: give degrees"
                                                       : "the angles are in degrees: give radians";
  return core::fail_with(
      Code::kSense,
      "the balls turned otherwise than stated: {:.3g} rad of rotation are left, limit {:g}, or ten "
      "times what another reading leaves. Hypotheses: angles in the opposite sense leave {:.3g} "
      "rad, degrees read for radians {:.3g} rad, radians read for degrees {:.3g} rad; {}",
      stated, kRotationLimit, opposite, from_degrees, from_radians, cure);
}

core::Result<void> check_distances(const RotaryMeasurement& measurement,
                                   std::span<const BallCentre> reference) {
  for (std::size_t i = 0; i < reference.size(); ++i) {
    for (std::size_t j = i + 1; j < reference.size(); ++j) {
      const auto changes = changes_of(measurement, reference[i], reference[j]);
      const std::string name = fmt::format("{} and {}", reference[i].ball, reference[j].ball);
      if (auto fine = check_distance(changes, name); !fine) return fine;
    }
  }
  return {};
}

core::Result<std::vector<core::Error>> check_neighbours(std::span<const RotaryStation> stations,
                                                        const RotaryAxis& axis,
                                                        double reference_rad) {
  std::vector<OwnTurn> own;
  for (const RotaryStation& station : stations) {
    if (station.undetermined) continue;
    own.push_back({station.angle_rad, station.approach, station.errors.w_rad.dot(axis.direction)});
  }
  const auto found = misfits(own, reference_rad, kNeighbourLimit);
  if (!found.empty()) return core::fail(misfit_error(found, reference_rad));
  auto doubted = misfits(own, reference_rad, kNeighbourDoubt);
  // The reference may have been approached from the other side.
  std::erase_if(doubted, [](const Misfit& one) { return one.turn.reference; });
  if (doubted.empty()) return std::vector<core::Error>();
  return std::vector<core::Error>{misfit_error(doubted, reference_rad)};
}

core::Result<bool> check_periodicity(std::span<const RotaryStation> stations) {
  constexpr std::array<std::string_view, 6> kNames = {"X", "Y", "Z", "A", "B", "C"};
  bool checked = false;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    for (std::size_t j = i + 1; j < stations.size(); ++j) {
      const RotaryStation& a = stations[i];
      const RotaryStation& b = stations[j];
      const double apart = std::abs(a.angle_rad - b.angle_rad);
      const bool turn_apart = apart > 1.0 && std::abs(std::remainder(apart, core::kTwoPi)) < 1e-9;
      if (!turn_apart || a.approach != b.approach || a.undetermined || b.undetermined) continue;
      checked = true;
      const Vector6 difference = a.errors.values() - b.errors.values();
      const Vector6 limit =
          4.0 * (a.measured_covariance + b.measured_covariance).diagonal().cwiseSqrt();
      for (Eigen::Index k = 0; k < 6; ++k) {
        if (std::abs(difference(k)) <= limit(k)) continue;
        return core::fail_with(Code::kInconsistent,
                               "{:g} and {:g} deg are one place, but error E{} differs by {:.2f} "
                               "{}, limit {:.2f}: drift or hysteresis",
                               core::degrees(a.angle_rad), core::degrees(b.angle_rad),
                               kNames[static_cast<std::size_t>(k)],
                               std::abs(difference(k)) * (k < 3 ? 1e3 : 1e6), k < 3 ? "um" : "urad",
                               limit(k) * (k < 3 ? 1e3 : 1e6));
      }
    }
  }
  return checked;
}

}  // namespace rondure::fit
