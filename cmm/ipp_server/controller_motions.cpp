#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "cmm/grid.h"
#include "cmm/ipp/internal/reader.h"
#include "cmm/ipp_server/controller.h"
#include "cmm/ipp_server/internal/arguments.h"
#include "cmm/scan_path.h"
#include "cmm/touch_check.h"
#include "core/units.h"

// Commands with motion, which become phases of a motion.

namespace rondure::cmm::ipp {
namespace {

using Eigen::Vector3d;

constexpr double kThere_mm = 1e-6;  // the tip is at its target

/// All arguments as numbers.
std::optional<std::vector<double>> numbers(const Arguments& arguments) {
  return numbers_of(call_item("", arguments));
}

Vector3d three(const std::vector<double>& n, std::size_t first) {
  return {n[first], n[first + 1], n[first + 2]};
}

/// A straight move, made at the end of its time.
Phase move_phase(const Vector3d& target_W_mm) {
  return {[target_W_mm] { return target_W_mm; }, {}};
}

bool has_direction(const Vector3d& v) { return v.norm() > 1e-12 && std::isfinite(v.norm()); }

bool differs(const Vector3d& a, const Vector3d& b) { return (a - b).norm() > kThere_mm; }

}  // namespace

Failure Controller::failure_of(const core::Error& error, std::string_view method) {
  switch (error.code) {
    case core::Code::kNoTouch:
      return {kSurfaceNotFound, error.what};
    case core::Code::kCollision:
      return {kCollision, error.what};
    case core::Code::kUnreachable:
      return {method == "GoTo" ? kMoveOutOfLimits : kOutOfVolume, error.what};
    case core::Code::kPoseRange:
      return {kAngleOutOfRange, error.what};
    case core::Code::kStopped:
      return {kAborted, error.what};
    default:
      return {method == "Home" ? kAtHome : kProcessing, error.what};
  }
}

tl::expected<void, Failure> Controller::ready_to_move() {
  if (!is_homed()) return refusal(kUnableToMove, "the machine is not homed; send Home() first");
  user_enabled_ = false;
  return {};
}

tl::expected<Vector3d, Failure> Controller::position_argument(const Arguments& arguments,
                                                              bool direction_allowed) {
  Vector3d p_mm = X_CW_ * machine().position_W_mm();
  std::array<bool, 3> named{};
  for (const Item& item : arguments) {
    if (direction_allowed && item.kind == Item::Kind::kCall && item.text == "IJK") continue;
    const auto value = item.kind == Item::Kind::kCall ? single_number(item) : std::nullopt;
    const bool axis = item.text == "X" || item.text == "Y" || item.text == "Z";
    if (!value || !axis) {
      return refusal(kIncorrectArguments,
                     fmt::format("{} names no axis with a number", to_text(item)));
    }
    const auto index = static_cast<std::size_t>(item.text[0] - 'X');
    if (named[index]) return refusal(kIncorrectArguments, item.text + " is there twice");
    named[index] = true;
    p_mm[static_cast<Eigen::Index>(index)] = *value;
  }
  if (!named[0] && !named[1] && !named[2]) return refusal(kIncorrectArguments, "no axis is named");
  return Vector3d(X_CW_.inverse() * p_mm);
}

tl::expected<Motion, Failure> Controller::plan_motion(const Command& command) {
  if (command.method == "Home") return plan_home(command.arguments);
  TRY_DO(ready_to_move());
  if (command.method == "GoTo") return plan_go_to(command.arguments);
  if (command.method == "PtMeas") return plan_touch(command.arguments);
  if (command.method == "ScanOnCircle") return plan_scan(command.arguments);
  return plan_align(command.arguments);
}

tl::expected<Motion, Failure> Controller::plan_home(const Arguments& arguments) {
  if (!arguments.empty()) return wrong_arguments("()");
  user_enabled_ = false;
  Motion out;
  out.phases.push_back({{}, [this]() -> core::Result<std::vector<Vector3d>> {
                          const Vector3d from = machine().position_W_mm();
                          TRY_DO(machine().home());
                          TRY_DO(backend_.home_table());
                          return std::vector<Vector3d>{from, machine().position_W_mm()};
                        }});
  out.reply = [] { return Reply{}; };
  return out;
}

tl::expected<Motion, Failure> Controller::plan_go_to(const Arguments& arguments) {
  TRY(auto target, position_argument(arguments, false));
  Motion out;
  out.phases.push_back(move_phase(target));
  out.reply = [] { return Reply{}; };
  return out;
}

tl::expected<Motion, Failure> Controller::plan_touch(const Arguments& arguments) {
  if (tool_.empty()) return refusal(kToolNotDefined, "no tool is active; send ChangeTool first");
  TRY(auto nominal, position_argument(arguments, true));
  Vector3d outward_W = machine().position_W_mm() - nominal;
  if (const Item* ijk = find_call(arguments, "IJK")) {
    const auto direction = vector_of(*ijk);
    if (!direction) return refusal(kIncorrectArguments, "IJK has not three numbers");
    outward_W = X_CW_.linear().transpose() * *direction;
  }
  if (!has_direction(outward_W)) {
    return refusal(kNoNorm, "the direction of the touch has no length");
  }
  TouchCommand touch;
  touch.direction_W = direction_on_grid(-outward_W);
  touch.expected_tip_W_mm = tip_at(nominal, touch.direction_W);
  touch.approach_mm = parameters_.act("PtMeasPar.Approach");
  touch.search_mm = parameters_.act("PtMeasPar.Search");
  return touch_motion(touch);
}

Vector3d Controller::tip_at(const Vector3d& named_W_mm, const Vector3d& direction_W) const {
  if (options_.point == NamedPoint::kCenter) return named_W_mm;
  // On the grid, so that a client that started from a tip centre on the grid gets the same bits
  // back.
  return on_grid_mm(named_W_mm - options_.tip_radius_mm * direction_W);
}

Motion Controller::touch_motion(const TouchCommand& touch) {
  const Vector3d start = start_of(touch);
  const auto reading = std::make_shared<TouchReading>();
  Motion out;
  if (differs(start, machine().position_W_mm())) out.phases.push_back(move_phase(start));
  out.phases.push_back({{}, [this, touch, start, reading]() -> core::Result<std::vector<Vector3d>> {
                          TouchCommand numbered = touch;
                          numbered.id = next_touch_;
                          TRY(auto touched, machine().touch(numbered));
                          ++next_touch_;
                          *reading = touched;
                          last_reading_ = touched;
                          return std::vector<Vector3d>{start, reading->tip_W_mm, start};
                        }});
  if (const double retract_mm = parameters_.act("PtMeasPar.Retract"); retract_mm >= 0.0) {
    out.phases.push_back({[reading, retract_mm, outward = Vector3d(-touch.direction_W)] {
                            return Vector3d(reading->tip_W_mm + retract_mm * outward);
                          },
                          {}});
  }
  out.reply = [this, reading, outward = Vector3d(-touch.direction_W)] {
    return touch_reply(*reading, outward);
  };
  return out;
}

tl::expected<Motion, Failure> Controller::plan_scan(const Arguments& arguments) {
  if (tool_.empty()) return refusal(kToolNotDefined, "no tool is active; send ChangeTool first");
  const auto n = numbers(arguments);
  if (!n || n->size() != 12) return wrong_arguments("12 numbers");
  const double delta_deg = (*n)[9];
  const double surface_deg = (*n)[10];
  const double step_deg = (*n)[11];
  const Vector3d normal = three(*n, 6);
  if (!has_direction(normal)) return refusal(kNoNorm, "the normal of the circle has no length");
  if (surface_deg != 0.0 && surface_deg != 180.0) {
    return refusal(kNotSupported, "only the surface angles 0 (outside) and 180 (inside) are there");
  }
  const double count = std::round(std::abs(delta_deg) / step_deg);
  if (!(step_deg > 0.0) || !(count >= 1.0) || count > kMaxScanPoints) {
    return refusal(kBadArgument, fmt::format("{} deg in steps of {} deg are not 1..{} points",
                                             delta_deg, step_deg, kMaxScanPoints));
  }
  const Eigen::Isometry3d X_WC = X_CW_.inverse();
  ScanCircleCommand scan;
  scan.center_W_mm = X_WC * three(*n, 0);
  scan.axis_W = direction_on_grid(X_WC.linear() * normal);
  scan.inside = surface_deg == 180.0;
  const Vector3d start_W_mm = X_WC * three(*n, 3);
  Vector3d outward_W = (scan.inside ? -1.0 : 1.0) * (start_W_mm - scan.center_W_mm);
  outward_W -= scan.axis_W * scan.axis_W.dot(outward_W);
  const bool fits = !scan.inside || options_.point == NamedPoint::kCenter ||
                    outward_W.norm() > options_.tip_radius_mm;
  if (!has_direction(outward_W) || !fits) {
    return refusal(kBadArgument, fmt::format("a tip of radius {:g} mm does not fit into a circle "
                                             "of radius {:g} mm",
                                             options_.tip_radius_mm, outward_W.norm()));
  }
  scan.start_tip_W_mm = tip_at(start_W_mm, -outward_W.normalized());
  scan.sweep_rad = delta_deg * core::kDegree;
  scan.points = static_cast<int>(count);
  scan.approach_mm = parameters_.act("PtMeasPar.Approach");
  scan.search_mm = parameters_.act("PtMeasPar.Search");
  if (scan.points >= 3) {
    if (auto valid = check_scan(scan); !valid) return refusal(kBadArgument, valid.error().what);
  }
  return scan_motion(scan);
}

Motion Controller::scan_motion(const ScanCircleCommand& scan) {
  const TouchCommand first = scan_point(scan, 0);
  const Vector3d start = start_of(first);
  const auto readings = std::make_shared<std::vector<TouchReading>>();
  Motion out;
  if (differs(start, machine().position_W_mm())) out.phases.push_back(move_phase(start));
  out.phases.push_back({{}, [this, scan, readings]() -> core::Result<std::vector<Vector3d>> {
                          ScanCircleCommand numbered = scan;
                          numbered.first_id = next_touch_;
                          TRY(auto scanned, machine().scan_circle(numbered));
                          next_touch_ += static_cast<std::int64_t>(scanned.size());
                          *readings = std::move(scanned);
                          if (!readings->empty()) last_reading_ = readings->back();
                          std::vector<Vector3d> way;
                          way.reserve(readings->size());
                          for (const TouchReading& r : *readings) way.push_back(r.tip_W_mm);
                          return way;
                        }});
  out.reply = [this, readings] { return scan_reply(*readings); };
  return out;
}

tl::expected<Motion, Failure> Controller::plan_align(const Arguments& arguments) {
  const auto n = numbers(arguments);
  if (!n || (n->size() != 7 && n->size() != 14)) {
    return wrong_arguments("7 or 14 numbers");
  }
  const std::size_t pairs = n->size() / 7;
  std::vector<Alignment> wanted;
  for (std::size_t i = 0; i < pairs; ++i) {
    wanted.push_back({three(*n, 6 * i), three(*n, 6 * i + 3)});
    if (!has_direction(wanted[i].part) || !has_direction(wanted[i].machine)) {
      return refusal(kNoNorm, "a vector of the alignment has no length");
    }
    wanted[i].part = direction_on_grid(wanted[i].part);
    wanted[i].machine = direction_on_grid(wanted[i].machine);
  }
  const std::vector<double> limits_deg(n->begin() + static_cast<std::ptrdiff_t>(6 * pairs),
                                       n->end());
  if (backend_.table_angles_deg().empty()) {
    return refusal(kUnsupportedCommand, "the machine has no rotary table");
  }
  const auto reached = std::make_shared<std::vector<Vector3d>>();
  Motion out;
  out.phases.push_back(
      {{}, [this, wanted, limits_deg, reached]() -> core::Result<std::vector<Vector3d>> {
         TRY(auto aligned, backend_.align_part(wanted));
         *reached = std::move(aligned);
         return std::vector<Vector3d>{};
       }});
  out.reply = [this, wanted, limits_deg, reached] {
    return align_reply(wanted, limits_deg, *reached);
  };
  return out;
}

}  // namespace rondure::cmm::ipp
