#include "cmm/simulated/machine.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "cmm/grid.h"

#include "cmm/scan_path.h"
#include "cmm/simulated/internal/contact.h"
#include "cmm/simulated/internal/machine_map.h"
#include "cmm/touch_check.h"
#include "core/noise.h"
#include "core/shortest_turn.h"
#include "core/units.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;

// separates the noise from that of other devices
constexpr std::uint64_t kTouchStream = 0x746f756368;
constexpr std::uint64_t kDustStream = 0x64757374;
constexpr std::uint64_t kScanStream = 0x7363616e;
constexpr std::size_t kLeastScanned = 3;
constexpr double kGraze_mm = 1e-6;  // a move may overlap a surface by this much
constexpr double kSettle_s = 0.2;
constexpr double kHalfVolume_mm = 10'000.0;  // the grid of 1e-10 mm represents it with 15 digits
constexpr Speeds kSlowest = {0.001, 0.001, 0.001};
constexpr Speeds kFastest = {1000.0, 50.0, 500.0};

}  // namespace

SimulatedMachine::SimulatedMachine(const SimulatedMachineOptions& options)
    : options_(options), position_W_mm_(options.park_W_mm) {}

void SimulatedMachine::place_part(const SimulatedPart& part, const Eigen::Isometry3d& X_WP) {
  part_ = part;
  warm_part_ =
      part.scaled(1.0 + options_.part_errors.expansion_1_K * (options_.temperature_degC - 20.0));
  X_WP_ = X_WP;
}

void SimulatedMachine::remove_part() {
  part_.reset();
  warm_part_.reset();
}

void SimulatedMachine::place_references(std::vector<ReferenceBody> bodies) {
  references_ = std::move(bodies);
}

std::string SimulatedMachine::description() const {
  return fmt::format("simulated machine, tip diameter {:.7g} mm, touch speed {:.7g} mm/s",
                     2.0 * options_.nominal_tip_radius_mm, options_.speeds.touch_mm_s);
}

Capabilities SimulatedMachine::capabilities() const {
  Capabilities out;
  out.name = "simulated machine";
  out.scans_circles = true;
  out.least = kSlowest;
  out.greatest = kFastest;
  out.tools = {options_.tool};
  out.volume_min_W_mm.setConstant(-kHalfVolume_mm);
  out.volume_max_W_mm.setConstant(kHalfVolume_mm);
  return out;
}

core::Result<MachineStatus> SimulatedMachine::status() {
  return MachineStatus{homed_, stopped_, options_.tool, lost_ ? "the connection is lost" : ""};
}

core::Result<void> SimulatedMachine::select_tool(const std::string& name) {
  if (name == options_.tool) return {};
  return core::machine_fault("there is no tool \"{}\"; the machine has \"{}\"", name,
                             options_.tool);
}

core::Result<void> SimulatedMachine::set_speeds(const Speeds& speeds) {
  const auto check = [](const char* what, double value, double least, double greatest) {
    if (value >= least && value <= greatest) return core::Result<void>{};
    return core::Result<void>(core::fail_with(
        core::Code::kOutOfRange,
        "a {} speed of {:.7g} mm/s is outside {:.7g}..{:.7g} mm/s; no speed was changed", what,
        value, least, greatest));
  };
  auto fits = check("travel", speeds.travel_mm_s, kSlowest.travel_mm_s, kFastest.travel_mm_s);
  if (fits) fits = check("touch", speeds.touch_mm_s, kSlowest.touch_mm_s, kFastest.touch_mm_s);
  if (fits) fits = check("scan", speeds.scan_mm_s, kSlowest.scan_mm_s, kFastest.scan_mm_s);
  if (fits) options_.speeds = speeds;
  return fits;
}

core::Result<void> SimulatedMachine::recover() {
  if (lost_) return check_ready();
  stopped_ = false;
  return {};
}

double SimulatedMachine::tip_radius_mm() const {
  return options_.nominal_tip_radius_mm + options_.errors.tip_radius_error_mm;
}

core::Result<void> SimulatedMachine::home() {
  const bool was_homed = std::exchange(homed_, true);
  const double height_mm = std::max(position_W_mm_.z(), options_.park_W_mm.z());
  const Vector3d above(position_W_mm_.x(), position_W_mm_.y(), height_mm);
  auto moved = move_to(above);
  if (moved) moved = move_to(options_.park_W_mm);
  if (!moved) homed_ = was_homed;
  return moved;
}

namespace {

const char* name_of(ReferenceBody::Shape shape) {
  switch (shape) {
    case ReferenceBody::Shape::kSphere:
      return "reference sphere";
    case ReferenceBody::Shape::kColumn:
      return "reference column or dowel";
    case ReferenceBody::Shape::kHole:
      return "block of a hole";
    case ReferenceBody::Shape::kSpot:
      return "seat";
  }
  return "";
}

/// First contact with a reference body, machine frame.
core::Result<Contact> contact_with(const ReferenceBody& body, const Vector3d& start_W_mm,
                                   const Vector3d& direction_W, double tip_radius_mm,
                                   double max_travel_mm) {
  using Shape = ReferenceBody::Shape;
  if (body.shape == Shape::kSphere) {
    return first_contact_with_sphere(body.center_W_mm, body.radius_mm, start_W_mm, direction_W,
                                     tip_radius_mm, max_travel_mm);
  }
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  X_WC.translation() = body.center_W_mm;
  X_WC.linear() = core::shortest_turn(Vector3d::UnitZ(), body.axis);
  const Eigen::Isometry3d X_CW = X_WC.inverse();
  const auto meet = [&](const auto& surface) {
    return first_contact(surface, X_CW * start_W_mm, X_CW.linear() * direction_W, tip_radius_mm,
                         max_travel_mm);
  };
  auto contact = body.shape == Shape::kSpot
                     ? meet(FaceSurface{.outer_mm = body.radius_mm})
                     : meet(PartSurface{.radius_mm = body.radius_mm,
                                        .half_length_mm = body.half_length_mm,
                                        .inside = body.shape == Shape::kHole,
                                        .form = {},
                                        .wall_mm = body.wall_mm});
  if (contact) contact->point_P_mm = X_WC * contact->point_P_mm;
  return contact;
}

}  // namespace

core::Result<SimulatedMachine::Obstacle> SimulatedMachine::first_obstacle(
    const SimulatedPart* part, const Vector3d& start_W_mm, const Vector3d& direction_W,
    double tip_radius_mm, double max_travel_mm) const {
  auto first = core::Result<Obstacle>(
      core::fail_with(core::Code::kNoTouch, "nothing within {:.3f} mm", max_travel_mm));
  const std::size_t surfaces = part != nullptr ? part->surfaces.size() : 0;
  for (std::size_t i = 0; i < surfaces; ++i) {
    const Eigen::Isometry3d X_WS = X_WP_ * part->surfaces[i].X_PS;
    const Eigen::Isometry3d X_SW = X_WS.inverse();
    const auto contact = std::visit(
        [&](const auto& surface) {
          return first_contact(surface, X_SW * start_W_mm, X_SW.linear() * direction_W,
                               tip_radius_mm, max_travel_mm);
        },
        part->surfaces[i].surface);
    if (contact && (!first || contact->travel_mm < first->travel_mm)) {
      first = Obstacle{contact->travel_mm, std::nullopt, X_WS * contact->point_P_mm};
    } else if (!contact && contact.error().code != core::Code::kNoTouch) {
      return core::fail(contact.error());
    }
  }
  for (const ReferenceBody& body : references_) {
    const auto contact = contact_with(body, start_W_mm, direction_W, tip_radius_mm, max_travel_mm);
    if (contact && (!first || contact->travel_mm < first->travel_mm)) {
      first = Obstacle{contact->travel_mm, body.shape, contact->point_P_mm};
    } else if (!contact && contact.error().code != core::Code::kNoTouch) {
      return core::fail(contact.error());
    }
  }
  return first;
}

core::Result<void> SimulatedMachine::move_to(const Vector3d& target_W_mm) {
  if (auto ready = check_ready(); !ready) return ready;
  const Vector3d tip_W_mm = on_grid_mm(target_W_mm);
  if (!tip_W_mm.allFinite())
    return core::machine_fault("the target of a move is not a finite point; no motion");
  if (auto within = check_volume(tip_W_mm); !within) return within;
  const Vector3d way = tip_W_mm - position_W_mm_;
  const double length_mm = way.norm();
  const Vector3d direction = length_mm > 0.0 ? Vector3d(way / length_mm) : Vector3d::UnitZ();
  const auto obstacle = first_obstacle(warm_part(), position_W_mm_, direction,
                                       tip_radius_mm() - kGraze_mm, length_mm);
  if (obstacle) return core::fail(stop_before(*obstacle, direction, tip_W_mm));
  if (obstacle.error().code == core::Code::kCollision) {
    return core::fail_with(
        core::Code::kCollision,
        "the tip is in contact at {} before the move to {} starts; the machine did not move",
        in_words(position_W_mm_), in_words(tip_W_mm));
  }
  if (obstacle.error().code != core::Code::kNoTouch) return core::fail(obstacle.error());
  position_W_mm_ = tip_W_mm;
  time_s_ += length_mm / options_.speeds.travel_mm_s;
  return {};
}

core::Error SimulatedMachine::stop_before(const Obstacle& obstacle, const Vector3d& direction,
                                          const Vector3d& target_W_mm) {
  // Stops 1e-6 mm before the contact, so that the tip can move back.
  const double travel_mm = std::max(0.0, obstacle.travel_mm - kGraze_mm);
  position_W_mm_ = on_grid_mm(position_W_mm_ + travel_mm * direction);
  time_s_ += travel_mm / options_.speeds.travel_mm_s;
  return {
      core::Code::kCollision,
      fmt::format("the tip met the {} at {} on the move to {}; the machine stopped at {}",
                  obstacle.reference ? name_of(*obstacle.reference) : "part",
                  in_words(obstacle.point_W_mm), in_words(target_W_mm), in_words(position_W_mm_)),
      {}};
}

core::Result<void> SimulatedMachine::check_ready() const {
  if (lost_) {
    return core::machine_fault(
        "the machine does not answer: the connection is lost; check cable and controller");
  }
  if (stopped_) {
    return core::fail(core::Code::kStopped,
                      "the machine was stopped; it moves again once the stop "
                      "is taken back");
  }
  if (!homed_) return core::machine_fault("the machine is not homed; home it first, no motion");
  return {};
}

core::Result<void> SimulatedMachine::check_volume(const Vector3d& tip_W_mm) const {
  if (tip_W_mm.cwiseAbs().maxCoeff() <= kHalfVolume_mm) return {};
  return core::fail_with(core::Code::kUnreachable,
                         "{} is outside the volume of the machine, {:.7g}..{:.7g} mm; no motion",
                         in_words(tip_W_mm), -kHalfVolume_mm, kHalfVolume_mm);
}

core::Result<void> SimulatedMachine::check_command(const TouchCommand& command) const {
  if (auto valid = check_touch(command, position_W_mm_); !valid) return valid;
  return check_volume(command.expected_tip_W_mm + command.search_mm * command.direction_W);
}

core::Result<TouchReading> SimulatedMachine::touch(const TouchCommand& given) {
  lost_ = lost_ || (options_.lost_at_touch > 0 && given.id + 1 == options_.lost_at_touch);
  TRY_DO(check_ready());
  TRY_DO(check_command(given));
  const TouchCommand command = on_grid(given);
  const auto found = find_contact(command, time_s_);
  if (!found) return core::fail(touch_failed(found.error(), command));
  true_tips_W_mm_ = {truth_of(command, *found)};
  const double search_mm = (found->reading_W_mm - start_of(command)).norm();
  const auto reading =
      reading_at(*found, command, time_s_ + search_mm / options_.speeds.touch_mm_s);
  settle(command, reading);
  return reading;
}

TouchReading SimulatedMachine::reading_at(const Found& found, const TouchCommand& touch,
                                          double time_s) const {
  const auto id = static_cast<std::uint64_t>(touch.id);
  core::KeyedNoise noise(options_.seed, {kTouchStream, id});
  double along_mm = options_.errors.repeatability_mm * noise.normal() +
                    trigger_delay_mm(options_.errors, touch.direction_W);
  core::KeyedNoise dust(options_.seed, {kDustStream, id});
  if (found.on_part && dust.uniform() < options_.part_errors.dust_share) {
    along_mm -= options_.part_errors.dust_mm * dust.uniform();
  }
  TouchReading out;
  out.tip_W_mm = found.reading_W_mm + along_mm * touch.direction_W +
                 backlash_shift_mm(options_.errors, touch.direction_W);
  out.temperature_degC = options_.temperature_degC;
  out.time_s = time_s;
  out.tip_radius_mm = options_.nominal_tip_radius_mm;
  out.scale_temperature_degC = options_.errors.scale_temperature_degC;
  return on_grid(out);
}

const SimulatedPart* SimulatedMachine::warm_part() const {
  return warm_part_ ? &*warm_part_ : nullptr;
}

core::Result<Vector3d> SimulatedMachine::true_contact(const TouchCommand& command) const {
  const Vector3d start = start_of(command);
  TRY(const auto contact, first_obstacle(part_ ? &*part_ : nullptr, start, command.direction_W,
                                         tip_radius_mm(), command.approach_mm + command.search_mm));
  return start + contact.travel_mm * command.direction_W;
}

core::Result<SimulatedMachine::Found> SimulatedMachine::find_contact(const TouchCommand& command,
                                                                     double time_s) const {
  const Vector3d start = start_of(command);
  const double reach_mm = command.approach_mm + command.search_mm;
  if (!has_map(options_.errors) || reach_mm == 0.0) {
    TRY(const auto contact,
        first_obstacle(warm_part(), start, command.direction_W, tip_radius_mm(), reach_mm));
    return Found{start + contact.travel_mm * command.direction_W, !contact.reference};
  }
  // The errors bend a path of a few mm by less than 1e-9 mm: it is treated as a straight line.
  const Vector3d from = true_position(options_.errors, start, time_s);
  const Vector3d way =
      true_position(options_.errors, start + reach_mm * command.direction_W, time_s) - from;
  const Vector3d direction = way.normalized();
  TRY(const auto contact,
      first_obstacle(warm_part(), from, direction, tip_radius_mm(), way.norm()));
  return Found{reading_of(options_.errors, from + contact.travel_mm * direction, time_s),
               !contact.reference};
}

Vector3d SimulatedMachine::truth_of(const TouchCommand& command, const Found& found) const {
  const bool same_part =
      options_.part_errors.expansion_1_K == 0.0 || options_.temperature_degC == 20.0;
  if (same_part && !has_map(options_.errors)) return found.reading_W_mm;
  return true_contact(command).value_or(found.reading_W_mm);
}

std::vector<TouchCommand> SimulatedMachine::points_of(const ScanCircleCommand& command) const {
  std::vector<TouchCommand> out;
  out.reserve(static_cast<std::size_t>(command.points));
  const ScanScatter& scatter = options_.scan_scatter;
  if (scatter.even()) {
    for (int i = 0; i < command.points; ++i) out.push_back(scan_point(command, i));
    return out;
  }
  core::KeyedNoise noise(options_.seed,
                         {kScanStream, static_cast<std::uint64_t>(command.first_id)});
  const auto about_zero = [&noise](double limit) { return limit * (2.0 * noise.uniform() - 1.0); };
  const double step_rad = command.sweep_rad / command.points;
  double angle_rad = about_zero(scatter.start_rad);
  for (int i = 0; i < command.points; ++i) {
    const bool last_chance =
        out.size() + static_cast<std::size_t>(command.points - i) <= kLeastScanned;
    if (noise.uniform() >= scatter.dropped_share || last_chance) {
      out.push_back(scan_point_at(command, angle_rad, static_cast<int>(out.size())));
    }
    angle_rad += step_rad * (1.0 + about_zero(scatter.step_1));
  }
  return out;
}

core::Result<std::vector<SimulatedMachine::Found>> SimulatedMachine::find_circle(
    const ScanCircleCommand& command, const std::vector<TouchCommand>& points) const {
  std::vector<Found> out;
  out.reserve(points.size());
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    if (stopped_) {
      return core::fail_with(core::Code::kStopped, "the machine was stopped at point {} of a scan",
                             i + 1);
    }
    const auto found = find_contact(points[static_cast<std::size_t>(i)], scan_time_s(command, i));
    if (!found) return core::fail(scan_failed(found.error(), command, i));
    out.push_back(*found);
  }
  return out;
}

core::Result<std::vector<TouchReading>> SimulatedMachine::scan_circle(
    const ScanCircleCommand& given) {
  const std::int64_t lost = options_.lost_at_touch;
  lost_ = lost_ || (lost > given.first_id && lost <= given.first_id + given.points);
  TRY_DO(check_ready());
  TRY_DO(check_scan(given));
  const ScanCircleCommand command = on_grid(given);
  TRY_DO(check_command(scan_point(command, 0)));
  const std::vector<TouchCommand> points = points_of(command);
  TRY(const auto circle, find_circle(command, points));
  std::vector<TouchReading> readings;
  readings.reserve(circle.size());
  true_tips_W_mm_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Found& found = circle[i];
    true_tips_W_mm_.push_back(truth_of(points[i], found));
    readings.push_back(reading_at(found, points[i], scan_time_s(command, static_cast<int>(i))));
  }
  settle(command, readings.back());
  // Full revolutions end at their start, to the last bit.
  const bool full_turns = std::abs(std::remainder(command.sweep_rad, core::kTwoPi)) < 1e-9;
  if (!full_turns) position_W_mm_ = on_grid_mm(start_of(scan_point(command, command.points)));
  return readings;
}

// Uses the nominal path to the surface: the measured surface does not change the clock.
double SimulatedMachine::scan_time_s(const ScanCircleCommand& command, int index) const {
  return time_s_ + command.approach_mm / options_.speeds.touch_mm_s + index * scan_step_s(command);
}

double SimulatedMachine::scan_step_s(const ScanCircleCommand& command) const {
  return scan_length_mm(command) / command.points / options_.speeds.scan_mm_s;
}

// Uses the reading, not the hidden truth, so that a journal can reproduce it.
void SimulatedMachine::settle(const TouchCommand& command, const TouchReading& reading) {
  const double back_mm = (reading.tip_W_mm - start_of(command)).norm();
  time_s_ = reading.time_s + back_mm / options_.speeds.travel_mm_s + kSettle_s;
}

void SimulatedMachine::settle(const ScanCircleCommand& command, const TouchReading& last) {
  time_s_ = last.time_s + scan_step_s(command) + command.approach_mm / options_.speeds.travel_mm_s +
            kSettle_s;
}

core::Result<void> SimulatedMachine::continue_after(const TouchCommand& given,
                                                    const TouchReading& reading) {
  const TouchCommand command = on_grid(given);
  TRY(const auto contact, true_contact(command));
  true_tips_W_mm_ = {contact};
  settle(command, reading);
  return {};
}

core::Result<void> SimulatedMachine::continue_after(const ScanCircleCommand& given,
                                                    const TouchReading& last) {
  if (auto valid = check_scan(given); !valid) return valid;
  const ScanCircleCommand command = on_grid(given);
  const std::vector<TouchCommand> points = points_of(command);
  std::vector<Vector3d> tips;
  tips.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto contact = true_contact(points[i]);
    if (!contact) return core::fail(scan_failed(contact.error(), command, static_cast<int>(i)));
    tips.push_back(*contact);
  }
  true_tips_W_mm_ = std::move(tips);
  settle(command, last);
  return {};
}

core::Error SimulatedMachine::scan_failed(const core::Error& cause,
                                          const ScanCircleCommand& command, int index) {
  if (cause.code != core::Code::kNoTouch) return cause;
  return {core::Code::kNoTouch,
          fmt::format("the scan lost the surface at point {} of {}: no contact within {:.3f} mm "
                      "beyond the circle at {}",
                      index + 1, command.points, command.search_mm,
                      in_words(scan_point(command, index).expected_tip_W_mm)),
          {}};
}

core::Error SimulatedMachine::touch_failed(const core::Error& cause, const TouchCommand& command) {
  if (cause.code == core::Code::kCollision) {
    return {core::Code::kCollision,
            fmt::format("the tip is in contact at {} before the search starts; the machine did not "
                        "move",
                        in_words(position_W_mm_)),
            {}};
  }
  if (cause.code != core::Code::kNoTouch) return cause;
  const double search_mm = command.approach_mm + command.search_mm;
  time_s_ += search_mm / options_.speeds.touch_mm_s + search_mm / options_.speeds.travel_mm_s;
  return {
      core::Code::kNoTouch,
      fmt::format("no contact within {:.3f} mm beyond the expected surface (search from {} to "
                  "{})",
                  command.search_mm, in_words(position_W_mm_),
                  in_words(command.expected_tip_W_mm + command.search_mm * command.direction_W)),
      {}};
}

}  // namespace rondure::cmm
