#include "fit/datums/datum.h"

#include <fmt/format.h>

#include "fit/geometry/column_extremes.h"

namespace rondure::fit {
namespace {

/// Greatest minus least value of a measure over the points.
template <class Measure>
core::Result<double> range_mm(SpacePoints points, const Measure& measure) {
  if (auto checked = check_points(points); !checked) return core::fail(checked.error());
  return extremes_of(points, measure).width();
}

}  // namespace

core::Result<double> coaxiality_mm(SpacePoints median_mm, const Axis& datum) {
  if (auto checked = check_points(median_mm); !checked) return core::fail(checked.error());
  return 2.0 * extremes_of(median_mm, [&](const auto& c) { return distance_mm(datum, c); }).high;
}

core::Result<double> total_radial_run_out_mm(SpacePoints points_mm, const Axis& datum) {
  return range_mm(points_mm, [&](const Eigen::Vector3d& p) { return distance_mm(datum, p); });
}

core::Result<double> axial_run_out_mm(SpacePoints points_mm, const Axis& datum) {
  return range_mm(points_mm, [&](const Eigen::Vector3d& p) {
    return (p - datum.point_mm).dot(datum.direction);
  });
}

core::Result<RunOut> radial_run_out(std::span<const std::vector<Eigen::Vector3d>> sections_mm,
                                    const Axis& datum) {
  if (sections_mm.empty()) {
    return core::fail(core::Code::kNoPoints, "there is no section; run-out needs at least one");
  }
  RunOut out;
  for (std::size_t i = 0; i < sections_mm.size(); ++i) {
    const auto section = total_radial_run_out_mm(sections_mm[i], datum);
    if (!section) {
      return core::fail(section.error().code,
                        fmt::format("section {}: {}", i, section.error().what));
    }
    out.sections_mm.push_back(*section);
    if (*section > out.sections_mm[out.greatest]) out.greatest = i;
  }
  return out;
}

}  // namespace rondure::fit
