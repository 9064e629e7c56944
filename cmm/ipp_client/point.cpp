#include "cmm/ipp_client/client.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cmm/grid.h"
#include "cmm/touch_check.h"

// The point that PtMeas means: as stated in the plan, and as verified by the first touch of a
// connection.

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;
using ipp::NamedPoint;

constexpr double kOnLine_mm = 1e-3;  // off the line of a touch by less than this counts as on it
constexpr double kOfRadius = 0.25;   // fraction of the tip radius that distinguishes the readings
constexpr double kStillAtStart_mm = 0.1;  // positioning of a real machine

std::string_view in_plan(NamedPoint point) {
  return point == NamedPoint::kSurface ? "surface" : "center";
}

}  // namespace

Vector3d IppMachine::named_point(const Vector3d& tip_W_mm, const Vector3d& direction_W) const {
  if (options_.point == NamedPoint::kCenter) return tip_W_mm;
  return tip_W_mm + tool_radius_mm_ * direction_W;
}

double IppMachine::came_along_mm(const TouchCommand& command) const {
  const auto& [from, to] = last_move_W_mm_;
  if ((to - start_of(command)).norm() > kOnLine_mm) return 0.0;
  const Vector3d way = from - to;
  const double along_mm = -way.dot(command.direction_W);
  return (way + along_mm * command.direction_W).norm() <= kOnLine_mm ? along_mm : 0.0;
}

// Let A be the start of the planned search and -Q its end, measured outwards from the expected tip
// centre, and r the tip radius. A server that means the other point searches r deeper (surface
// meant, centre assumed) or r higher. If the tip has just moved in along this line, both searches
// may begin at A or A + r, so the approach grows by r where the surface is meant. Otherwise no
// space is known to be free: the tip moves to the other start at touch speed, at which a contact
// does no harm. Where the centre is meant the search grows by r, so that both readings reach -Q.
TouchCommand IppMachine::for_either_reading(const TouchCommand& command) const {
  TouchCommand out = command;
  if (!options_.returns_to_approach) return out;
  const bool free = is_cautious() && came_along_mm(command) >= tool_radius_mm_;
  if (options_.point == NamedPoint::kCenter) {
    out.search_mm += tool_radius_mm_;
  } else if (free) {
    out.approach_mm += tool_radius_mm_;
  }
  return out;
}

core::Result<void> IppMachine::slow_down(bool slow) {
  const double travel_mm_s = options_.speeds.travel_mm_s;
  const double touch_mm_s = std::max(options_.speeds.touch_mm_s, least_.travel_mm_s);
  const std::array<std::pair<std::string_view, double>, 1> speed = {
      {{"Tool.GoToPar.Speed", slow ? std::min(touch_mm_s, travel_mm_s) : travel_mm_s}}};
  return dialogue_->set(speed);
}

core::Result<void> IppMachine::check_point(const TouchCommand& command, const TouchCommand& sent) {
  const double radius_mm = tool_radius_mm_;
  if (radius_mm == 0.0) {  // both readings agree
    point_known_ = true;
    return {};
  }
  TRY(const auto stands, dialogue_->position_W_mm());
  const Vector3d start = position_W_mm_;
  position_W_mm_ = on_grid_mm(stands);
  const double back_mm = -(stands - command.expected_tip_W_mm).dot(command.direction_W);
  const bool surface_meant = options_.point == NamedPoint::kSurface;
  const double if_center_mm = sent.approach_mm - (surface_meant ? radius_mm : 0.0);
  const auto is_at = [&](double mm) { return std::abs(back_mm - mm) <= kOfRadius * radius_mm; };
  const bool center = is_at(if_center_mm);
  if (!center && !is_at(if_center_mm + radius_mm)) {
    return core::fail(
        core::Code::kMachine,
        fmt::format("after the first touch the tip stands {:.3f} mm before the expected contact; a "
                    "negative Retract brings it back to {:.3f} mm where PtMeas takes the centre of "
                    "the tip, to {:.3f} mm where it takes the surface: which it does cannot be "
                    "seen; see whether the server adds distances of its own (Part.Approach), and "
                    "set \"retract\": \"by-distance\" under machine if it ignores a negative "
                    "Retract",
                    back_mm, if_center_mm, if_center_mm + radius_mm),
        "/machine/retract");
  }
  const NamedPoint taken = center ? NamedPoint::kCenter : NamedPoint::kSurface;
  point_known_ = taken == options_.point;
  if (point_known_ && (position_W_mm_ - start).norm() <= kStillAtStart_mm) {
    position_W_mm_ = start;
    return {};
  }
  if (auto back = go_to(start); !back) return back;  // on the searched line
  if (point_known_) return {};
  return core::fail(
      core::Code::kMeaning,
      fmt::format("the server takes the point of PtMeas for {}, the plan says \"{}\": after the "
                  "first touch the tip stood {:.3f} mm before the expected contact, {:.3f} mm were "
                  "expected; set \"point\": \"{}\" under machine and start a new run",
                  center ? "the centre of the tip" : "a point of the surface",
                  in_plan(options_.point), back_mm,
                  surface_meant ? if_center_mm + radius_mm : if_center_mm, in_plan(taken)),
      "/machine/point");
}

core::Error IppMachine::with_point_advice(core::Error error) const {
  const bool touched_nothing = error.code == core::Code::kNoTouch;
  if (point_known_ || (!touched_nothing && error.code != core::Code::kCollision)) return error;
  error.what += fmt::format(
      "; it is not known yet which point PtMeas of this server means, the plan says \"{}\" "
      "(machine.point): see its manual",
      in_plan(options_.point));
  return error;
}

}  // namespace rondure::cmm
