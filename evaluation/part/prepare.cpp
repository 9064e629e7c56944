#include <algorithm>
#include <cassert>
#include <utility>

#include "core/phrase.h"
#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/part/internal/filtering.h"
#include "evaluation/part/internal/layout.h"
#include "evaluation/part/surface.h"

namespace rondure::evaluation {
namespace {

using Indication = record::Indication;

/// The layers of a portion are those whose planned height lies in it. Touches miss it by less.
constexpr double kPortionEndMm = 0.1;
constexpr std::size_t kMostNamed = 7;

bool is_as_measured(const MeasuredSurface& surface) {
  return std::equal(
      surface.tips_mm.begin(), surface.tips_mm.end(), surface.of->cloud.begin(),
      [](const Eigen::Vector3d& tip, const CloudPoint& p) { return tip == p.tip_mm; });
}

bool leaves_out_outliers(const Indication& indication) {
  return indication.outliers == Indication::Outliers::kFiveScales;
}

/// The rows that take part before the portion; lists the others.
core::Result<std::vector<bool>> rows_without_outliers(const SurfaceLayout& layout,
                                                      const Indication& indication,
                                                      PreparedSurface& out) {
  out.left_out = layout.windows;
  std::vector<bool> rows = layout.kept;
  if (!leaves_out_outliers(indication)) return rows;
  if (layout.too_many) return core::fail(*layout.too_many);
  if (layout.form) return core::fail(*layout.form);
  for (const std::size_t row : layout.outlying) {
    rows[row] = false;
    out.left_out.push_back({row, {}});
  }
  std::sort(out.left_out.begin(), out.left_out.end(),
            [](const LeftOut& a, const LeftOut& b) { return a.row < b.row; });
  return rows;
}

/// Takes the rows outside the portion away.
core::Result<void> restrict_rows(const SurfaceLayout& layout, const Indication& indication,
                                 std::vector<bool>& rows) {
  if (!indication.from_mm && !indication.to_mm) return {};
  if (layout.no_heights) return core::fail(*layout.no_heights);
  const double from = indication.from_mm.value_or(-1e9) - kPortionEndMm;
  const double to = indication.to_mm.value_or(1e9) + kPortionEndMm;
  bool any = false;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    rows[row] = rows[row] && from <= layout.part_z_mm[row] && layout.part_z_mm[row] <= to;
    any = any || rows[row];
  }
  if (any) return {};
  return core::fail(
      error_of(core::Code::kRank, core::phrase("no layer lies in the portion from {:g} to {:g} mm; "
                                               "widen it, or plan layers there",
                                               from + kPortionEndMm, to - kPortionEndMm)));
}

void fill_sections(const SurfaceLayout& layout, const std::vector<bool>& taken,
                   PreparedSurface& out) {
  std::vector<std::size_t> index(taken.size(), 0);
  for (std::size_t i = 0; i < out.rows.size(); ++i) index[out.rows[i]] = i;
  const bool plane = out.of->feature.shape == record::Shape::kPlane;
  for (const SectionRows& of_layout : layout.sections) {
    SurfaceSection section{
        .layer = of_layout.layer, .points = {}, .dense = of_layout.dense, .gap = of_layout.gap};
    double sum = 0.0;
    for (const std::size_t row : of_layout.rows) {
      if (!taken[row]) continue;
      section.points.push_back(index[row]);
      const Eigen::Vector3d v = out.points_mm[index[row]] - out.axis.point_mm;
      sum += v.dot(out.axis.direction);
    }
    if (section.points.empty()) continue;
    section.height_mm =
        plane ? of_layout.part_z_mm : sum / static_cast<double>(section.points.size());
    out.sections.push_back(std::move(section));
  }
}

/// Names the points far off that take part.
void name_outlying(const SurfaceLayout& layout, const Indication& indication,
                   const std::vector<bool>& taken, PreparedSurface& out) {
  if (leaves_out_outliers(indication) || layout.too_many) return;
  std::size_t named = 0;
  std::size_t more = 0;
  for (std::size_t i = 0; i < layout.outlying.size(); ++i) {
    if (!taken[layout.outlying[i]]) continue;
    if (++named > kMostNamed) {
      ++more;
      continue;
    }
    out.warnings.push_back(error_of(
        core::Code::kOutliers,
        core::phrase("point {} lies {:+.3f} um off the least-squares feature, more than five "
                     "robust scales; it takes part",
                     layout.outlying[i], layout.off_mm[i] / core::kMicrometre)));
  }
  if (more == 0) return;
  out.warnings.push_back(
      error_of(core::Code::kOutliers,
               core::phrase("{} more points lie that far off the least-squares feature", more)));
}

/// Dense points without a filter read more than touched ones.
void warn_of_no_filter(PreparedSurface& out) {
  std::size_t most = 0;
  for (const SurfaceSection& section : out.sections) {
    if (section.dense) most = std::max(most, section.points.size());
  }
  if (most == 0) return;
  out.warnings.push_back(
      error_of(core::Code::kUnfiltered,
               core::phrase("unfiltered: a scan of {} points a layer reads more than 7 touched "
                            "ones; plan filter and cutoff_upr",
                            most)));
}

/// A tip that leaves the surface no radius is wrong, and so is what is computed of its points.
core::Result<void> check_tip(const PreparedSurface& surface) {
  const record::Shape shape = surface.of->feature.shape;
  if (shape != record::Shape::kCylinder && shape != record::Shape::kCircle) return {};
  std::vector<double> distances_mm;
  for (const Eigen::Vector3d& p : surface.points_mm) {
    distances_mm.push_back(fit::distance_mm(surface.axis, p));
  }
  return fit::check_material(surface.material, core::mean(distances_mm));
}

}  // namespace

core::Result<PreparedSurface> prepared(const MeasuredSurface& surface,
                                       const Indication& indication) {
  assert(surface.tips_mm.size() == surface.of->cloud.size());
  auto layout = surface.layout;
  if (!layout) layout = std::make_shared<const SurfaceLayout>(layout_of(*surface.of));
  if (layout->failure) return core::fail(*layout->failure);
  PreparedSurface out;
  out.of = surface.of;
  out.no_sections = layout->no_sections;
  const bool filtered =
      indication.filter.value_or(Indication::Filter::kNone) != Indication::Filter::kNone;
  if (out.no_sections && filtered) return core::fail(*out.no_sections);
  out.material = {surface.of->feature.side == record::Side::kInside,
                  surface.tip_radius_mm.value_or(0.0)};
  out.tip_known = surface.tip_radius_mm.has_value();
  TRY(auto taken, rows_without_outliers(*layout, indication, out));
  const auto take = [&] {
    out.rows.clear();
    out.points_mm.clear();
    for (std::size_t row = 0; row < taken.size(); ++row) {
      if (!taken[row]) continue;
      out.rows.push_back(row);
      out.points_mm.push_back(surface.tips_mm[row]);
    }
  };
  take();
  // Square to the axis of the feature, not of the portion, which may be a single layer.
  if (surface.across) {
    out.axis = *surface.across;
  } else {
    TRY(const auto fit,
        fitted(*surface.of, out.points_mm, layout->axis.direction, Deviations::kSkip));
    out.axis = fit.axis;
  }
  TRY_DO(check_tip(out));
  TRY_DO(restrict_rows(*layout, indication, taken));
  if (indication.from_mm || indication.to_mm) take();
  fill_sections(*layout, taken, out);
  out.as_measured = layout->as_measured && is_as_measured(surface);
  const Warnings warnings = out.as_measured ? Warnings::kFind : Warnings::kSkip;
  if (warnings == Warnings::kFind) {
    out.warnings = layout->warnings;
    name_outlying(*layout, indication, taken, out);
  }
  TRY_DO(filter(out, indication, warnings));
  if (warnings == Warnings::kFind && !filtered) warn_of_no_filter(out);
  return out;
}

}  // namespace rondure::evaluation
