#include "cmm/simulated.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cmm/contact.h"
#include "core/noise.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kTouchStream = 0x746f756368;  // keeps the noise apart from other devices
constexpr double kGraze_mm = 1e-6;                    // a move may overlap a surface by this much
constexpr double kSettle_s = 0.2;

std::string in_words(const Vector3d& p) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", p.x(), p.y(), p.z());
}

Vector3d start_of(const TouchCommand& command) {
  return command.expected_tip_W_mm - command.approach_mm * command.direction_W;
}

tl::unexpected<core::Error> fault(std::string what) {
  return core::fail(core::Code::kMachine, std::move(what));
}

}  // namespace

SimulatedMachine::SimulatedMachine(const SimulatedMachineOptions& options)
    : options_(options), position_W_mm_(options.park_W_mm) {}

void SimulatedMachine::place_part(const PartSurface& surface, const Eigen::Isometry3d& X_WP) {
  part_ = surface;
  X_WP_ = X_WP;
}

void SimulatedMachine::remove_part() { part_.reset(); }

void SimulatedMachine::place_sphere(const ReferenceSphere& sphere) { sphere_ = sphere; }

std::string SimulatedMachine::description() const {
  return fmt::format("simulated machine, tip diameter {:.7g} mm, touch speed {:.7g} mm/s",
                     2.0 * options_.nominal_tip_radius_mm, options_.touch_speed_mm_s);
}

double SimulatedMachine::tip_radius_mm() const {
  return options_.nominal_tip_radius_mm + options_.errors.tip_radius_error_mm;
}

core::Result<void> SimulatedMachine::home() {
  if (auto line = check_line(); !line) return line;
  const double height_mm = std::max(position_W_mm_.z(), options_.park_W_mm.z());
  const Vector3d above(position_W_mm_.x(), position_W_mm_.y(), height_mm);
  if (auto up = move_to(above); !up) return up;
  return move_to(options_.park_W_mm);
}

core::Result<SimulatedMachine::Obstacle> SimulatedMachine::first_obstacle(
    const Vector3d& start_W_mm, const Vector3d& direction_W, double tip_radius_mm,
    double max_travel_mm) const {
  auto first = core::Result<Obstacle>(
      core::fail(core::Code::kNoTouch, fmt::format("nothing within {:.3f} mm", max_travel_mm)));
  if (part_) {
    const Eigen::Isometry3d X_PW = X_WP_.inverse();
    const auto contact = first_contact(*part_, X_PW * start_W_mm, X_PW.linear() * direction_W,
                                       tip_radius_mm, max_travel_mm);
    if (contact) {
      first = Obstacle{contact->travel_mm, false, X_WP_ * contact->point_P_mm};
    } else if (contact.error().code != core::Code::kNoTouch) {
      return core::fail(contact.error());
    }
  }
  if (sphere_) {
    const auto contact =
        first_contact_with_sphere(sphere_->center_W_mm, sphere_->radius_mm, start_W_mm, direction_W,
                                  tip_radius_mm, max_travel_mm);
    if (contact && (!first || contact->travel_mm < first->travel_mm)) {
      first = Obstacle{contact->travel_mm, true, contact->point_P_mm};
    } else if (!contact && contact.error().code != core::Code::kNoTouch) {
      return core::fail(contact.error());
    }
  }
  return first;
}

core::Result<void> SimulatedMachine::move_to(const Vector3d& tip_W_mm) {
  if (auto line = check_line(); !line) return line;
  if (!tip_W_mm.allFinite()) return fault("the target of a move is not a finite point; no motion");
  const Vector3d way = tip_W_mm - position_W_mm_;
  const double length_mm = way.norm();
  const Vector3d direction = length_mm > 0.0 ? Vector3d(way / length_mm) : Vector3d::UnitZ();
  const auto obstacle =
      first_obstacle(position_W_mm_, direction, tip_radius_mm() - kGraze_mm, length_mm);
  if (obstacle) return core::fail(stop_before(*obstacle, direction, tip_W_mm));
  if (obstacle.error().code == core::Code::kCollision) {
    return core::fail(core::Code::kCollision,
                      fmt::format("the tip is in contact at {} before the move to {} starts; the "
                                  "machine did not move",
                                  in_words(position_W_mm_), in_words(tip_W_mm)));
  }
  if (obstacle.error().code != core::Code::kNoTouch) return core::fail(obstacle.error());
  position_W_mm_ = tip_W_mm;
  time_s_ += length_mm / options_.travel_speed_mm_s;
  return {};
}

core::Error SimulatedMachine::stop_before(const Obstacle& obstacle, const Vector3d& direction,
                                          const Vector3d& target_W_mm) {
  // One graze short of the contact, so that the tip is free to go back.
  const double travel_mm = std::max(0.0, obstacle.travel_mm - kGraze_mm);
  position_W_mm_ += travel_mm * direction;
  time_s_ += travel_mm / options_.travel_speed_mm_s;
  return {
      core::Code::kCollision,
      fmt::format("the tip met the {} at {} on the move to {}; the machine stopped at {}",
                  obstacle.is_sphere ? "reference sphere" : "part", in_words(obstacle.point_W_mm),
                  in_words(target_W_mm), in_words(position_W_mm_)),
      {}};
}

core::Result<void> SimulatedMachine::check_line() const {
  if (!lost_) return {};
  return fault("the machine does not answer: the connection is lost; check cable and controller");
}

core::Result<void> SimulatedMachine::check_command(const TouchCommand& command) const {
  const bool finite = command.expected_tip_W_mm.allFinite() && command.direction_W.allFinite() &&
                      std::isfinite(command.approach_mm) && std::isfinite(command.search_mm);
  if (!finite) return fault(fmt::format("touch {} is not finite; no motion", command.id));
  if (std::abs(command.direction_W.norm() - 1.0) > 1e-9) {
    return fault(fmt::format("the direction of touch {} has the length {:.9g}, not 1; no motion",
                             command.id, command.direction_W.norm()));
  }
  if (command.approach_mm + command.search_mm < 0.0) {
    return fault(
        fmt::format("the search of touch {} ends before it starts; no motion", command.id));
  }
  const Vector3d start = start_of(command);
  if ((start - position_W_mm_).norm() > kGraze_mm) {
    return fault(fmt::format("touch {} starts at {}, but the tip stands at {}; move there first",
                             command.id, in_words(start), in_words(position_W_mm_)));
  }
  return {};
}

core::Result<TouchReading> SimulatedMachine::touch(const TouchCommand& command) {
  lost_ = lost_ || (options_.lost_at_touch > 0 && command.id + 1 == options_.lost_at_touch);
  if (auto line = check_line(); !line) return core::fail(line.error());
  if (auto checked = check_command(command); !checked) return core::fail(checked.error());
  const auto contact = true_contact(command);
  if (!contact) return core::fail(touch_failed(contact.error(), command));
  true_tip_W_mm_ = *contact;
  core::KeyedNoise noise(options_.seed, {kTouchStream, static_cast<std::uint64_t>(command.id)});
  const double deviation_mm = options_.errors.repeatability_mm * noise.normal();
  time_s_ += (true_tip_W_mm_ - start_of(command)).norm() / options_.touch_speed_mm_s;
  const TouchReading reading = {true_tip_W_mm_ + deviation_mm * command.direction_W,
                                options_.temperature_degC, time_s_};
  settle(command, reading);
  return reading;
}

core::Result<Vector3d> SimulatedMachine::true_contact(const TouchCommand& command) const {
  const Vector3d start = start_of(command);
  const auto contact = first_obstacle(start, command.direction_W, tip_radius_mm(),
                                      command.approach_mm + command.search_mm);
  if (!contact) return core::fail(contact.error());
  return start + contact->travel_mm * command.direction_W;
}

// From the reading, not from the hidden truth: a journal can give it again.
void SimulatedMachine::settle(const TouchCommand& command, const TouchReading& reading) {
  const double back_mm = (reading.tip_W_mm - start_of(command)).norm();
  time_s_ = reading.time_s + back_mm / options_.travel_speed_mm_s + kSettle_s;
}

core::Result<void> SimulatedMachine::continue_after(const TouchCommand& command,
                                                    const TouchReading& reading) {
  const auto contact = true_contact(command);
  if (!contact) return core::fail(contact.error());
  true_tip_W_mm_ = *contact;
  settle(command, reading);
  return {};
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
  time_s_ += search_mm / options_.touch_speed_mm_s + search_mm / options_.travel_speed_mm_s;
  return {
      core::Code::kNoTouch,
      fmt::format("no contact within {:.3f} mm beyond the expected surface (search from {} to "
                  "{})",
                  command.search_mm, in_words(position_W_mm_),
                  in_words(command.expected_tip_W_mm + command.search_mm * command.direction_W)),
      {}};
}

}  // namespace rondure::cmm
