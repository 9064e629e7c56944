#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "plans/checks/internal/plan_checks.h"

namespace rondure::plans {
namespace {

using core::Code;

constexpr double kLeastRoom_mm = 0.5;

void check_hole(const Plan& plan, std::size_t index, Findings& findings) {
  const DatumPlan& datum = *plan.fixture->datum;
  const DatumHolePlan& hole = datum.holes[index];
  const std::string where = fmt::format("/fixture/datum/holes/{}", index);
  const double tip_mm = 0.5 * plan.probe->tip_diameter_mm;
  const bool inside = hole.side == record::Side::kInside;
  const double beside_mm = 0.5 * hole.diameter_mm - tip_mm - datum.uncertainty_mm;
  if (inside && beside_mm < kLeastRoom_mm) {
    findings.meaning(
        Code::kMeaning, where + "/diameter_mm",
        fmt::format(
            "a hole of {:g} mm that may stand {:g} mm off (uncertainty_mm) leaves {:.3g} mm "
            "beside a ball of {:g} mm, at least {:g} mm are needed; take a smaller ball or "
            "a wider hole",
            hole.diameter_mm, datum.uncertainty_mm, beside_mm, 2.0 * tip_mm, kLeastRoom_mm));
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
    const double apart_mm =
        std::hypot(hole.center_mm[0] - of.center_mm[0], hole.center_mm[1] - of.center_mm[1]);
    if (apart_mm > 0.5 * (hole.diameter_mm + of.diameter_mm)) continue;
    findings.meaning(Code::kMeaning, where + "/center_mm",
                     fmt::format("holes {} and {} overlap: their centres are {:g} mm apart",
                                 other + 1, index + 1, apart_mm));
  }
}

void check_seat(const DatumPlan& datum, Findings& findings) {
  const std::string where = "/fixture/datum/seat";
  if (datum.seat.size() < 3) {
    return findings.meaning(
        Code::kTooFewPoints, where,
        fmt::format("at least 3 places are needed to tell how the seat lies, there are {}",
                    datum.seat.size()));
  }
  const auto n = static_cast<double>(datum.seat.size());
  double x = 0.0, y = 0.0;
  for (const DatumSeatPlan& at : datum.seat) {
    if (at.point_mm[2] != datum.seat.front().point_mm[2]) {
      return findings.meaning(Code::kMeaning, where,
                              fmt::format("the seat is one plane of the base: its places have z "
                                          "{:g} and {:g} mm; give them one",
                                          datum.seat.front().point_mm[2], at.point_mm[2]));
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
  if (4.0 * (xx * yy - xy * xy) > 0.0396 * (xx + yy) * (xx + yy)) return;
  findings.meaning(Code::kCollinear, where,
                   "its places are close to one line; spread them over the seat");
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
  check_seat(datum, findings);
  if (!plan.probe || !plan.machine) return;
  for (std::size_t i = 0; i < datum.holes.size(); ++i) check_hole(plan, i, findings);
}

}  // namespace rondure::plans
