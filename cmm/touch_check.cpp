#include "cmm/touch_check.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "cmm/scan_path.h"
#include "core/units.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;

constexpr double kAtStart_mm = 1e-6;

// Controllers stay on the line of a search and in the plane of a scan to some hundredths of a
// millimetre; probes that report their deflection across the search show a few tenths on steep
// surfaces.
constexpr double kBeside_mm = 1.0;
// Over-travel, and the tip radius that the machine subtracts and adds at either end of a search.
constexpr double kEnds_mm = 0.1;
// A result equal to the last digit cannot come from a search displaced by this much.
constexpr double kElsewhere_mm = 0.01;

// For scans: servers promise an average step, and probes lose points.
constexpr double kLeastShare = 0.8;
constexpr double kMostShare = 2.0;
constexpr double kGapSteps = 3.5;       // two neighbours missing, where points are sparse
constexpr double kDenseGapSteps = 5.5;  // four, where they are dense:
constexpr double kDenseGap_rad = 10.0 * core::kDegree;

constexpr double kUnit = 0.01;  // two decimals
// heads that lock every 15 deg are off by up to 7.5
constexpr double kTurn_rad = 8.0 * core::kDegree;

constexpr double kColdest_degC = 5.0;  // the widest range for which machines are built
constexpr double kWarmest_degC = 45.0;

constexpr double kLeastNormal = 0.5;
constexpr double kMostNormal = 2.0;

constexpr std::string_view kThenResume =
    "look at machine and server (frame, active tool, report), then resume";

core::Result<void> answers_otherwise(std::string what) {
  return core::machine_fault("{}; {}", what, kThenResume);
}

/// Largest angle between two neighbours of a scan [rad].
double greatest_gap(double step_rad) {
  return std::max(kGapSteps * step_rad, std::min(kDenseGapSteps * step_rad, kDenseGap_rad));
}

/// Checks that each point lies on the circle.
core::Result<void> check_places(const ScanCircleCommand& command,
                                std::span<const Vector3d> tips_W_mm) {
  const double radius_mm = (command.start_tip_W_mm - command.center_W_mm).norm();
  const double outer_mm = (command.inside ? command.search_mm : command.approach_mm) + kEnds_mm;
  const double inner_mm = (command.inside ? command.approach_mm : command.search_mm) + kEnds_mm;
  for (std::size_t i = 0; i < tips_W_mm.size(); ++i) {
    const Vector3d p = tips_W_mm[i] - command.center_W_mm;
    const double beside_mm = p.dot(command.axis_W);
    const double off_mm = (p - beside_mm * command.axis_W).norm() - radius_mm;
    const bool finite = p.allFinite();
    const bool in_plane = std::abs(beside_mm) <= kBeside_mm;
    if (finite && in_plane && off_mm <= outer_mm && off_mm >= -inner_mm) continue;
    std::string why = "is not finite";
    if (finite && !in_plane) {
      why = fmt::format("lies {:.3f} mm off its plane, at most {:g} mm are possible",
                        std::abs(beside_mm), kBeside_mm);
    } else if (finite) {
      why = fmt::format(
          "lies {:.3f} mm {} the circle of {:.3f} mm radius that was asked for, at most {:.3f} mm "
          "are possible",
          std::abs(off_mm), off_mm > 0.0 ? "outside" : "inside", radius_mm,
          off_mm > 0.0 ? outer_mm : inner_mm);
    }
    if (i == 0) why += ": the columns of the scan report are not X, Y, Z, or it is another circle";
    return answers_otherwise(fmt::format("point {} of the scan about {}, {}, {}", i + 1,
                                         in_words(command.center_W_mm), in_words(tips_W_mm[i]),
                                         why));
  }
  return {};
}

/// Checks that the points cover the commanded sweep in the commanded sense.
core::Result<void> check_sweep(const ScanCircleCommand& command,
                               std::span<const Vector3d> tips_W_mm) {
  const double sweep_rad = std::abs(command.sweep_rad);
  const double step_rad = sweep_rad / command.points;
  const double limit_rad = greatest_gap(step_rad);
  const double sense = command.sweep_rad < 0.0 ? -1.0 : 1.0;
  const auto refuse = [&](const std::string& why) {
    return answers_otherwise(
        fmt::format("the scan about {} {}", in_words(command.center_W_mm), why));
  };
  const auto deg = [](double angle_rad) { return angle_rad / core::kDegree; };
  const double begin_rad = sense * scan_angle(command, tips_W_mm.front());
  double now_rad = begin_rad;
  double least_rad = 0.0;
  double most_rad = 0.0;
  std::size_t widest = 0;
  for (std::size_t i = 1; i < tips_W_mm.size(); ++i) {
    const double on_rad =
        std::remainder(sense * scan_angle(command, tips_W_mm[i]) - now_rad, core::kTwoPi);
    now_rad += on_rad;
    least_rad = std::min(least_rad, on_rad);
    if (on_rad > most_rad) widest = i;
    most_rad = std::max(most_rad, on_rad);
  }
  if (now_rad < begin_rad) {
    return refuse(fmt::format("went {:.1f} deg the other way round than was asked for",
                              deg(begin_rad - now_rad)));
  }
  if (std::abs(begin_rad) > limit_rad) {
    return refuse(fmt::format("begins {:.2f} deg beside its start, at most {:.2f} deg are possible",
                              deg(begin_rad), deg(limit_rad)));
  }
  if (least_rad < -step_rad) {
    return refuse(fmt::format("goes back by {:.2f} deg on its way, by more than a step of {:.2f}",
                              deg(-least_rad), deg(step_rad)));
  }
  if (most_rad > limit_rad) {
    return refuse(
        fmt::format("has a gap of {:.2f} deg before point {}, at most {:.2f} deg are "
                    "possible with steps of {:.2f} deg",
                    deg(most_rad), widest + 1, deg(limit_rad), deg(step_rad)));
  }
  if (std::abs(now_rad - sweep_rad) <= limit_rad) return {};
  return refuse(
      fmt::format("ends after {:.2f} deg, {:.2f} deg were asked for and at most {:.2f} "
                  "deg less or more are possible",
                  deg(now_rad), deg(sweep_rad), deg(limit_rad)));
}

}  // namespace

Eigen::Vector3d start_of(const TouchCommand& command) {
  return command.expected_tip_W_mm - command.approach_mm * command.direction_W;
}

core::Result<void> check_touch(const TouchCommand& command, const Eigen::Vector3d& position_W_mm) {
  const auto refuse = [](const std::string& why) { return core::machine_fault(why); };
  const bool finite = command.expected_tip_W_mm.allFinite() && command.direction_W.allFinite() &&
                      std::isfinite(command.approach_mm) && std::isfinite(command.search_mm);
  if (!finite) return refuse(fmt::format("touch {} is not finite; no motion", command.id));
  if (std::abs(command.direction_W.norm() - 1.0) > 1e-9) {
    return refuse(fmt::format("the direction of touch {} has the length {:.9g}, not 1; no motion",
                              command.id, command.direction_W.norm()));
  }
  if (command.approach_mm + command.search_mm < 0.0) {
    return refuse(
        fmt::format("the search of touch {} ends before it starts; no motion", command.id));
  }
  const Eigen::Vector3d start = start_of(command);
  if ((start - position_W_mm).norm() <= kAtStart_mm) return {};
  return refuse(fmt::format("touch {} starts at {}, but the tip stands at {}; move there first",
                            command.id, in_words(start), in_words(position_W_mm)));
}

core::Result<void> check_contact(const TouchCommand& command, const Vector3d& tip_W_mm) {
  const auto refuse = [&](const std::string& why) {
    return answers_otherwise(fmt::format("the touch at {} was answered with {}, {}",
                                         in_words(command.expected_tip_W_mm), in_words(tip_W_mm),
                                         why));
  };
  if (!tip_W_mm.allFinite()) return refuse("which is not finite");
  const Vector3d apart = tip_W_mm - command.expected_tip_W_mm;
  const double along_mm = apart.dot(command.direction_W);
  const double beside_mm = (apart - along_mm * command.direction_W).norm();
  if (along_mm < -command.approach_mm - kEnds_mm || along_mm > command.search_mm + kEnds_mm) {
    return refuse(
        fmt::format("{:.3f} mm {} the expected contact: the search went from {:.3f} mm "
                    "before it to {:.3f} mm behind it",
                    std::abs(along_mm), along_mm < 0.0 ? "before" : "behind", command.approach_mm,
                    command.search_mm));
  }
  if (beside_mm <= kBeside_mm) return {};
  return refuse(fmt::format("{:.3f} mm beside the line of the search, at most {:g} mm are possible",
                            beside_mm, kBeside_mm));
}

core::Result<void> check_fresh(const TouchCommand& command, const Vector3d& tip_W_mm,
                               const TouchCommand& before, const Vector3d& tip_before_W_mm) {
  if (tip_W_mm != tip_before_W_mm) return {};
  const double elsewhere_mm = (command.expected_tip_W_mm - before.expected_tip_W_mm).norm();
  if (elsewhere_mm <= kElsewhere_mm) return {};  // a repeated touch may read the same digits
  return answers_otherwise(
      fmt::format("the touch at {} was answered with {}, the answer of the touch before once more, "
                  "which was {:.3f} mm away",
                  in_words(command.expected_tip_W_mm), in_words(tip_W_mm), elsewhere_mm));
}

core::Result<void> check_scanned(const ScanCircleCommand& command,
                                 std::span<const Vector3d> tips_W_mm) {
  const auto least =
      std::max(std::size_t{3}, static_cast<std::size_t>(kLeastShare * command.points));
  const auto most = static_cast<std::size_t>(kMostShare * command.points) + 1;
  if (tips_W_mm.size() < least || tips_W_mm.size() > most) {
    return answers_otherwise(
        fmt::format("the scan about {} gave {} points, {} were asked for and {} to {} are possible",
                    in_words(command.center_W_mm), tips_W_mm.size(), command.points, least, most));
  }
  if (auto on_circle = check_places(command, tips_W_mm); !on_circle) return on_circle;
  return check_sweep(command, tips_W_mm);
}

core::Result<void> check_turned(const Directions& asked_W, const Directions& reached_W) {
  const auto text = [](const Vector3d& v) {
    return fmt::format("({:.4f}, {:.4f}, {:.4f})", v.x(), v.y(), v.z());
  };
  const auto refuse = [&](const std::string& why) {
    return answers_otherwise(fmt::format(
        "turning the part: z and y were to point along {} and {}, the machine answered "
        "{} and {}: {}",
        text(asked_W[0]), text(asked_W[1]), text(reached_W[0]), text(reached_W[1]), why));
  };
  for (const Vector3d& v : reached_W) {
    if (v.allFinite() && std::abs(v.norm() - 1.0) <= kUnit) continue;
    return refuse(fmt::format("a direction has the length {:.4g}, not 1 to {:g}", v.norm(), kUnit));
  }
  const double cosine = reached_W[0].dot(reached_W[1]);
  if (std::abs(cosine) > kUnit) {
    return refuse(
        fmt::format("they are {:.2f} deg apart, not 90 deg to {:.2f}",
                    std::acos(cosine / reached_W[0].norm() / reached_W[1].norm()) / core::kDegree,
                    kUnit / core::kDegree));
  }
  for (std::size_t i = 0; i < reached_W.size(); ++i) {
    const double off_rad =
        std::atan2(reached_W[i].cross(asked_W[i]).norm(), reached_W[i].dot(asked_W[i]));
    if (off_rad <= kTurn_rad) continue;
    return refuse(fmt::format("{:.2f} deg off, at most {:g} deg are possible",
                              off_rad / core::kDegree, kTurn_rad / core::kDegree));
  }
  return {};
}

core::Result<void> check_stands(std::string_view doing, const Vector3d& target_W_mm,
                                const Vector3d& position_W_mm, double limit_mm) {
  const double off_mm = (position_W_mm - target_W_mm).norm();
  if (off_mm <= limit_mm) return {};
  return answers_otherwise(
      fmt::format("after {} to {} the machine says that the tip stands at {}, "
                  "{:.3f} mm away, at most {:g} mm are possible",
                  doing, in_words(target_W_mm), in_words(position_W_mm), off_mm, limit_mm));
}

core::Result<void> check_temperature(std::string_view name, double temperature_degC) {
  if (temperature_degC >= kColdest_degC && temperature_degC <= kWarmest_degC) return {};
  return core::machine_fault(
      "the machine gives {} as {:.7g} degC, outside {:g}..{:g} degC where one measures: kelvin, "
      "degrees Fahrenheit, or no sensor; set the machine to degC, then resume",
      name, temperature_degC, kColdest_degC, kWarmest_degC);
}

core::Result<void> check_tip_radius(double radius_mm, double known_mm, double limit_mm) {
  if (std::abs(radius_mm - known_mm) <= limit_mm) return {};
  return answers_otherwise(
      fmt::format("the machine gives the effective radius of the tip (ER) as {:.4f} mm, it was "
                  "{:.4f} mm up to here, at most {:g} mm less or more are possible: another tool, "
                  "or a ball that came off",
                  radius_mm, known_mm, limit_mm));
}

core::Result<void> check_normal(const Vector3d& normal_W) {
  const double length = normal_W.norm();
  if (length >= kLeastNormal && length <= kMostNormal) return {};
  return answers_otherwise(
      fmt::format("the machine gives the normal of a touched surface as ({:.4g}, {:.4g}, {:.4g}), "
                  "of length {:.4g}: no direction, {:g}..{:g} are possible",
                  normal_W.x(), normal_W.y(), normal_W.z(), length, kLeastNormal, kMostNormal));
}

}  // namespace rondure::cmm
