#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "plans/checks/internal/plan_checks.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/scene.h"

namespace rondure::plans {
namespace {

using core::Code;

constexpr double kLeastRoom_mm = 0.5;
/// Of the distance from the seat to the axes, which seat and holes have to span at least.
constexpr double kLeastSpan = 0.2;

/// @param lean_rad  Most by which the base may lean.
void check_hole(const Plan& plan, std::size_t index, double lean_rad, Findings& findings) {
  const DatumPlan& datum = *plan.fixture->datum;
  const DatumHolePlan& hole = datum.holes[index];
  const std::string where = fmt::format("/fixture/datum/holes/{}", index);
  const double tip_mm = 0.5 * plan.probe->tip_diameter_mm;
  const bool inside = hole.side == record::Side::kInside;
  const double lean_mm = lean_rad * hole.depth_mm;
  const double beside_mm = 0.5 * hole.diameter_mm - tip_mm - datum.uncertainty_mm - lean_mm;
  if (inside && beside_mm < kLeastRoom_mm) {
    findings.meaning(
        Code::kMeaning, where + "/diameter_mm",
        fmt::format(
            "a hole of {:g} mm that may stand {:g} mm off (uncertainty_mm) and lean {:.3g} mm over "
            "its depth leaves {:.3g} mm beside a ball of {:g} mm, at least {:g} mm are needed; "
            "take a smaller ball, a wider hole, or a smaller uncertainty_mm",
            hole.diameter_mm, datum.uncertainty_mm, lean_mm, beside_mm, 2.0 * tip_mm,
            kLeastRoom_mm));
  }
  if (!inside && plan.machine->approach_mm - lean_mm < kLeastRoom_mm) {
    findings.meaning(
        Code::kMeaning, where + "/depth_mm",
        fmt::format("it may lean {:.3g} mm over its height (uncertainty_mm, width of the seat), of "
                    "{:g} mm before the touch (machine.approach_mm) at least {:g} mm must remain; "
                    "take a wider seat or a greater approach_mm",
                    lean_mm, plan.machine->approach_mm, kLeastRoom_mm));
  }
  const double shaft_mm = tip_mm - 0.5 * plan.probe->stylus_diameter_mm - lean_mm;
  if (plan.probe->stylus_length_mm > 0.0 && shaft_mm < kTouchGap_mm) {
    findings.meaning(
        Code::kMeaning, where + "/depth_mm",
        fmt::format(
            "beside what may lean {:.3g} mm over {:g} mm a shaft of {:g} mm above a ball of "
            "{:g} mm keeps {:.3g} mm, at least {:g} mm are needed; take a thinner shaft, a "
            "wider seat, or a smaller depth",
            lean_mm, hole.depth_mm, plan.probe->stylus_diameter_mm, 2.0 * tip_mm, shaft_mm,
            kTouchGap_mm));
  }
  const double end_mm = 0.5 * hole.depth_mm / datum.heights;
  const double needed_mm = datum.uncertainty_mm + kLeastRoom_mm + (inside ? 0.0 : tip_mm);
  if (end_mm < needed_mm) {
    findings.meaning(
        Code::kMeaning, where + "/depth_mm",
        fmt::format(
            "{} heights over {:g} mm begin {:g} mm from the seat, at least {:g} mm are needed "
            "(uncertainty_mm, {:g} mm{}); take fewer heights or a greater depth",
            datum.heights, hole.depth_mm, end_mm, needed_mm, kLeastRoom_mm,
            inside ? "" : " and the radius of the ball"));
  }
  const double stylus_mm = plan.probe->stylus_length_mm;
  const double room_mm = plan.machine->clearance_mm + datum.uncertainty_mm;
  if (stylus_mm > 0.0 && stylus_mm < hole.depth_mm + room_mm) {
    findings.meaning(
        Code::kMeaning, where + "/depth_mm",
        fmt::format("a stylus of {:g} mm does not reach {:g} mm below the {} with {:g} mm of room "
                    "for what holds it (machine.clearance_mm, uncertainty_mm)",
                    stylus_mm, hole.depth_mm, inside ? "mouth" : "top", room_mm));
  }
  for (std::size_t other = 0; other < index; ++other) {
    const DatumHolePlan& of = datum.holes[other];
    if (between_mm(hole, of) > 0.0) continue;
    findings.meaning(Code::kMeaning, where + "/center_mm",
                     fmt::format("holes {} and {} overlap: their centres are {:g} mm apart",
                                 other + 1, index + 1, apart_mm(hole.center_mm, of.center_mm)));
  }
}

/// A place of the seat lies on metal.
void check_place(const Plan& plan, std::size_t place, Findings& findings) {
  const DatumPlan& datum = *plan.fixture->datum;
  for (std::size_t i = 0; i < datum.holes.size(); ++i) {
    const DatumHolePlan& hole = datum.holes[i];
    if (hole.side == record::Side::kOutside) continue;  // an obstacle of the path
    const double off_mm = apart_mm(datum.seat[place].point_mm, hole.center_mm);
    const double needed_mm =
        0.5 * (hole.diameter_mm + plan.probe->tip_diameter_mm) + datum.uncertainty_mm;
    if (off_mm >= needed_mm) continue;
    findings.meaning(
        Code::kMeaning, fmt::format("/fixture/datum/seat/{}/point_mm", place),
        fmt::format("it is {:.3g} mm from the centre of hole {}, at least {:.3g} mm are needed for "
                    "the ball to meet the seat beside it (uncertainty_mm); move it away",
                    off_mm, i + 1, needed_mm));
  }
}

/// Seat and holes tell where the axes are only as well as they are wide.
void check_spans(const Plan& plan, Findings& findings) {
  const DatumPlan& datum = *plan.fixture->datum;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const DatumSeatPlan& at : datum.seat)
    middle += vector3(at.point_mm) / static_cast<double>(datum.seat.size());
  const double lever_mm = (vector3(plan.fixture->axis_point_mm) - middle).norm();
  double span_mm = 0.0;
  for (const DatumHolePlan& a : datum.holes) {
    for (const DatumHolePlan& b : datum.holes)
      span_mm = std::max(span_mm, apart_mm(a.center_mm, b.center_mm));
  }
  const auto require = [&](const char* key, const char* what, double wide_mm) {
    if (wide_mm >= kLeastSpan * lever_mm) return;
    findings.meaning(
        Code::kCollinear, key,
        fmt::format("{} {:.3g} mm, and the axes are {:.3g} mm away, where an error of a touch is "
                    "{:.3g} times as large; at least {:.3g} mm are needed; spread them",
                    what, wide_mm, lever_mm, lever_mm / wide_mm, kLeastSpan * lever_mm));
  };
  require("/fixture/datum/seat", "its places are as narrow as", seat_width_mm(datum));
  if (datum.holes.size() > 1) require("/fixture/datum/holes", "they span only", span_mm);
}

/// Whether the places of the seat tell how it lies.
bool check_seat(const DatumPlan& datum, Findings& findings) {
  const std::string where = "/fixture/datum/seat";
  if (datum.seat.size() < 3) {
    findings.meaning(
        Code::kTooFewPoints, where,
        fmt::format("at least 3 places are needed to tell how the seat lies, there are {}",
                    datum.seat.size()));
    return false;
  }
  const auto n = static_cast<double>(datum.seat.size());
  double x = 0.0, y = 0.0;
  for (const DatumSeatPlan& at : datum.seat) {
    if (at.point_mm[2] != datum.seat.front().point_mm[2]) {
      findings.meaning(Code::kMeaning, where,
                       fmt::format("the seat is one plane of the base: its places have z "
                                   "{:.10g} and {:.10g} mm; give them one",
                                   datum.seat.front().point_mm[2], at.point_mm[2]));
      return false;
    }
    x += at.point_mm[0] / n;
    y += at.point_mm[1] / n;
  }
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const DatumSeatPlan& at : datum.seat) {
    xx += (at.point_mm[0] - x) * (at.point_mm[0] - x);
    xy += (at.point_mm[0] - x) * (at.point_mm[1] - y);
    yy += (at.point_mm[1] - y) * (at.point_mm[1] - y);
  }
  // Standard deviation across a tenth of that along, or less.
  if (4.0 * (xx * yy - xy * xy) > 0.0396 * (xx + yy) * (xx + yy)) return true;
  findings.meaning(Code::kCollinear, where,
                   "its places are close to one line; spread them over the seat");
  return false;
}

}  // namespace

void check_datum_holes(const Plan& plan, Findings& findings) {
  const DatumPlan& datum = *plan.fixture->datum;
  if (!datum.spheres.empty()) {
    findings.meaning(Code::kMeaning, "/fixture/datum/spheres",
                     "spheres and holes each tell where the base is; leave one of them out");
  }
  if (datum.holes.size() < 2) {
    findings.meaning(
        Code::kTooFewPoints, "/fixture/datum/holes",
        fmt::format("at least 2 holes are needed to tell how the base is turned, there are {}",
                    datum.holes.size()));
  }
  const bool lies = check_seat(datum, findings);
  if (lies) check_spans(plan, findings);
  if (!plan.probe || !plan.machine) return;
  const double lean_rad = lies ? most_lean_rad(datum) : 0.0;
  for (std::size_t i = 0; i < datum.holes.size(); ++i) check_hole(plan, i, lean_rad, findings);
  for (std::size_t i = 0; lies && i < datum.seat.size(); ++i) check_place(plan, i, findings);
}

}  // namespace rondure::plans
