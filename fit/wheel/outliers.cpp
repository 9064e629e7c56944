#include "fit/wheel/outliers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/statistics.h"
#include "core/units.h"
#include "fit/wheel/spread.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kLeastLeft = 8;
constexpr std::size_t kFormRun = 3;    ///< This many flagged neighbours are form.
constexpr std::size_t kRunBridge = 2;  ///< Points between two flagged ones of a run.

/// Places in angular order, run by run.
using Runs = std::vector<std::vector<std::size_t>>;

Runs runs_of(const std::vector<std::size_t>& flagged, std::size_t n, bool closed) {
  Runs runs;
  for (const std::size_t place : flagged) {
    if (runs.empty() || place - runs.back().back() > kRunBridge + 1) runs.emplace_back();
    runs.back().push_back(place);
  }
  if (!closed || runs.size() < 2) return runs;
  if (runs.front().front() + n - runs.back().back() > kRunBridge + 1) return runs;
  runs.back().insert(runs.back().end(), runs.front().begin(), runs.front().end());
  runs.erase(runs.begin());
  return runs;
}

core::Error local_form(const std::vector<std::size_t>& run, const AngularOrder& order,
                       const std::vector<double>& deviations_mm) {
  double deepest = 0.0;
  for (const std::size_t place : run) {
    const double deviation = deviations_mm[order.rows[place]];
    if (std::abs(deviation) > std::abs(deepest)) deepest = deviation;
  }
  const auto degrees = [&](std::size_t place) {
    return std::remainder(order.angles_rad[place], core::kTwoPi) / core::kDegree;
  };
  return {core::Code::kLocalForm,
          fmt::format(
              "{} neighbouring points from {:.1f} to {:.1f} deg differ by up to {:+.2f} um: "
              "form (wear, a flat), kept",
              run.size(), degrees(run.front()), degrees(run.back()), deepest / core::kMicrometre)};
}

void fill_deviations(PlanePoints points_mm, const OutlierOptions& options, Outliers& out) {
  for (const Eigen::Vector2d& p : points_mm)
    out.deviations_mm.push_back((p - out.center_mm).norm());
  const double middle = core::median(out.deviations_mm);
  std::vector<double> sizes;
  for (double& d : out.deviations_mm) {
    d -= middle;
    sizes.push_back(std::abs(d));
  }
  out.scale_mm = std::max(core::kSigmaPerMedianDeviation * core::median(std::move(sizes)),
                          options.least_scale_mm);
}

core::Result<void> check_count(const Outliers& out, std::size_t n) {
  const std::size_t dropped = out.dropped.size();
  if (dropped <= n / 4 && n - dropped >= kLeastLeft) return {};
  return core::fail_with(core::Code::kOutliers,
                         "{} of {} points lie more than 5 scales of {:.2f} um off; at most {} "
                         "could be dropped, and {} must stay: clean the wheel",
                         dropped, n, out.scale_mm / core::kMicrometre, n / 4, kLeastLeft);
}

}  // namespace

core::Result<Outliers> find_outliers(PlanePoints points_mm,
                                     std::span<const FourPointCenter> centers,
                                     const OutlierOptions& options) {
  if (!(options.scales >= 5.0) || !(options.least_scale_mm > 0.0)) {
    return core::fail_with(
        core::Code::kBadOption,
        "outliers beyond {} scales (at least 5: lobes are form), least scale {} mm (above 0)",
        options.scales, options.least_scale_mm);
  }
  std::vector<double> x;
  std::vector<double> z;
  for (const FourPointCenter& c : centers) {
    x.push_back(c.center_mm.x());
    z.push_back(c.center_mm.y());
  }
  Outliers out;
  out.center_mm = {core::median(std::move(x)), core::median(std::move(z))};
  fill_deviations(points_mm, options, out);
  const AngularOrder order = angular_order(points_mm, out.center_mm);
  std::vector<std::size_t> flagged;
  for (std::size_t place = 0; place < order.rows.size(); ++place) {
    const double deviation = out.deviations_mm[order.rows[place]];
    if (std::abs(deviation) > options.scales * out.scale_mm) flagged.push_back(place);
  }
  for (const auto& run : runs_of(flagged, points_mm.size(), order.closed())) {
    if (run.size() >= kFormRun) {
      out.warnings.push_back(local_form(run, order, out.deviations_mm));
      continue;
    }
    for (const std::size_t place : run) {
      out.dropped.push_back({order.rows[place], out.deviations_mm[order.rows[place]]});
    }
  }
  std::ranges::sort(out.dropped, {}, &DroppedPoint::row);
  TRY_DO(check_count(out, points_mm.size()));
  for (const DroppedPoint& point : out.dropped) {
    out.warnings.push_back(
        {core::Code::kOutliers, fmt::format("point {} (counted from 0) is {:+.2f} um off, {:.1f} "
                                            "scales: dropped",
                                            point.row, point.deviation_mm / core::kMicrometre,
                                            std::abs(point.deviation_mm) / out.scale_mm)});
  }
  return out;
}

}  // namespace rondure::fit
