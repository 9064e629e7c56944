#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "fit/geometry/axis.h"
#include "reports/drawings/internal/svg.h"
#include "reports/html/internal/plot_curve.h"
#include "reports/html/plots.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using evaluation::Finding;
using evaluation::LocalValue;

std::string place_title(LocalValue::Place place) {
  switch (place) {
    case LocalValue::Place::kLayer:
      return tr("height / mm");
    case LocalValue::Place::kAngle:
      return tr("angle about the axis / °");
    case LocalValue::Place::kRadius:
      return tr("radius / mm");
  }
  return {};
}

/// All sections, generatrices or circles with the limits. Sizes are drawn as departures from the
/// nominal one: they differ by a few micrometres.
std::string local_chart(const evaluation::CharacteristicResult& result, double nominal_mm) {
  const Finding& finding = *result.finding;
  if (finding.local.size() < 2) return {};
  const bool size = evaluation::unit_of(result.characteristic) == core::ValueUnit::kMm;
  const double zero_mm = !size              ? 0.0
                         : nominal_mm > 0.0 ? nominal_mm
                                            : finding.local.front().value_mm;
  const auto um_of = [&](double length_mm) { return (length_mm - zero_mm) / core::kMicrometre; };
  std::vector<Span> spans;
  for (std::size_t i = 0; i < finding.local.size(); ++i) {
    const LocalValue& local = finding.local[i];
    const double x =
        local.place == LocalValue::Place::kAngle ? core::degrees(local.position) : local.position;
    if (local.none) {
      spans.push_back({.x = x, .absent = true});
      continue;
    }
    const double value = um_of(local.value_mm);
    const double low = local.least_mm ? um_of(*local.least_mm) : size ? value : 0.0;
    spans.push_back({x, low, value, i == finding.worst});
  }
  std::vector<double> limits;
  for (const evaluation::JudgedValue& value : finding.judged) {
    if (value.limits.lower_mm) limits.push_back(um_of(*value.limits.lower_mm));
    if (value.limits.upper_mm) limits.push_back(um_of(*value.limits.upper_mm));
  }
  return scrolling(span_chart(limits.empty()
                                  ? tr("Local values; the worst is marked.")
                                  : tr("Local values; the worst is marked. Dashed: the limits."),
                              place_title(finding.local.front().place),
                              !size              ? tr("value / µm")
                              : nominal_mm > 0.0 ? trf("size minus {:.10g} mm / µm", nominal_mm)
                                                 : tr("size minus that of the first section / µm"),
                              spans, limits));
}

/// Deviations along the generatrices. The worst, or the two opposite ones, are drawn in full.
std::string generatrix_chart(const Finding& finding) {
  if (finding.lines.empty()) return {};
  const bool one_of_all = finding.lines.size() == finding.local.size();
  std::vector<Curve> curves;
  std::vector<Curve> last;
  for (std::size_t i = 0; i < finding.lines.size(); ++i) {
    const evaluation::ProfileLine& line = finding.lines[i];
    Curve curve{
        trf("generatrix at {}°", core::deg(line.angle_rad, 1)), "profile", line.position_mm, {}};
    for (const double deviation_mm : line.deviation_mm)
      curve.y.push_back(deviation_mm / core::kMicrometre);
    if (!one_of_all || i == finding.worst) {
      if (!one_of_all && i > 0) curve.css_class = "zone-inner";
      last.push_back(std::move(curve));
    } else {
      curve.name.clear();
      curve.css_class = "trail";
      curves.push_back(std::move(curve));
    }
  }
  curves.insert(curves.end(), last.begin(), last.end());
  const bool others = curves.size() > last.size();
  return scrolling(line_chart(
      others ? tr("Generatrices about their least-squares lines, out of the material; grey: the "
                  "others.")
             : tr("Generatrices about their least-squares lines, out of the material."),
      tr("height / mm"), tr("deviation / µm"), curves));
}

/// The axis about which the median line is drawn: its datum, or the line through its ends.
fit::Axis median_axis(const Finding& finding) {
  if (!finding.datums.empty()) return finding.datums.front().place;
  const Eigen::Vector3d& first = finding.centers_mm.front();
  const Eigen::Vector3d span = finding.centers_mm.back() - first;
  return {first, span.norm() > 0.0 ? Eigen::Vector3d(span.normalized()) : Eigen::Vector3d::UnitZ()};
}

/// One side view of the median line.
/// @param reach_um  The greatest offset in either view: both have one scale.
std::string side_view(const evaluation::CharacteristicResult& result, const fit::Axis& axis,
                      const Eigen::Vector3d& across, std::string_view seen, double reach_um) {
  const Finding& finding = *result.finding;
  Curve line{tr("median line"), "profile", {}, {}};
  for (const Eigen::Vector3d& center : finding.centers_mm) {
    line.x.push_back((center - axis.point_mm).dot(axis.direction));
    line.y.push_back((center - axis.point_mm).dot(across) / core::kMicrometre);
  }
  const bool datum = !finding.datums.empty();
  const auto [low, high] = std::minmax_element(line.x.begin(), line.x.end());
  const std::vector<double> ends = {*low, *high};
  std::vector<Curve> curves = {
      {datum ? trf("datum {}", finding.datums.front().name) : tr("line through the ends"),
       "mean",
       ends,
       {0.0, 0.0}}};
  const record::Form form = result.characteristic.form;
  const auto& limit_mm = finding.judged.front().limits.upper_mm;
  const bool about_datum =
      datum && (form == record::Form::kCoaxiality || form == record::Form::kConcentricity);
  if (about_datum && limit_mm) {
    const double half_um = 0.5 * *limit_mm / core::kMicrometre;
    curves.push_back({tr("limits of the zone"), "zone-outer", ends, {half_um, half_um}});
    curves.push_back({"", "zone-outer", ends, {-half_um, -half_um}});
  }
  Curve marks = line;
  marks.name.clear();
  marks.marks_only = true;
  curves.push_back(std::move(line));
  curves.push_back(std::move(marks));
  return scrolling(line_chart(
      seen, datum ? tr("height along the datum / mm") : tr("height above the first section / mm"),
      tr("offset / µm"), curves, reach_um));
}

/// The median line seen from two sides, along the two machine axes that lie across it, its offsets
/// enlarged.
std::string median_chart(const evaluation::CharacteristicResult& result) {
  const Finding& finding = *result.finding;
  if (finding.centers_mm.size() < 2) return {};
  if (!finding.datums.empty() && finding.datums.front().plane) return {};
  const fit::Axis axis = median_axis(finding);
  Eigen::Index along = 0;
  axis.direction.cwiseAbs().maxCoeff(&along);
  std::vector<std::pair<Eigen::Index, Eigen::Vector3d>> views;
  double reach_um = 0.0;
  for (const Eigen::Index c : {0, 1, 2}) {
    if (c == along) continue;
    const Eigen::Vector3d across = Eigen::Vector3d::Unit(c) - axis.direction * axis.direction(c);
    views.emplace_back(c, across.normalized());
    for (const Eigen::Vector3d& center : finding.centers_mm) {
      const double offset_mm = (center - axis.point_mm).dot(views.back().second);
      reach_um = std::max(reach_um, std::abs(offset_mm) / core::kMicrometre);
    }
  }
  std::string html;
  for (const auto& [c, across] : views) {
    html += side_view(result, axis, across, trf("Side view: offset along {}", "xyz"[c]), reach_um);
  }
  return html;
}

}  // namespace

std::string line_plots(const evaluation::CharacteristicResult& result) {
  if (!result.finding) return {};
  return generatrix_chart(*result.finding) + median_chart(result);
}

std::string finding_plots(const evaluation::CharacteristicResult& result, double nominal_mm) {
  if (!result.finding) return {};
  return local_chart(result, nominal_mm) + line_plots(result);
}

namespace {

constexpr double kFaceWidth = 520.0;
constexpr double kFaceHeight = 400.0;
constexpr double kFaceCentre = 200.0;         ///< x and y.
constexpr double kFaceEdge = 160.0;           ///< Where the axes begin, outside all points.
constexpr double kFacePoints = 148.0;         ///< Radius of the outermost point.
constexpr std::size_t kMostFaceDiscs = 1500;  ///< More points are averaged in squares.
constexpr double kSquare = 6.0;

void draw_radii(Svg& svg, double px_per_mm, double greatest_mm) {
  const double step_mm = core::round_below(0.5 * greatest_mm);
  for (double radius_mm = step_mm; radius_mm * px_per_mm <= kFacePoints; radius_mm += step_mm) {
    const double r = radius_mm * px_per_mm;
    svg.circle(kFaceCentre, kFaceCentre, r, "guide");
    const double aside = r * std::sqrt(0.5);
    svg.text(kFaceCentre + aside + 3.0, kFaceCentre + aside + 11.0, "start", "label",
             fmt::format("{} mm", tick_label(radius_mm)));
  }
}

/// Mean heights in squares, for the points of a scan.
void draw_squares(Svg& svg, const evaluation::FeatureResult& feature, double px_per_mm,
                  double half_zone_mm) {
  std::map<std::pair<int, int>, std::pair<double, int>> squares;
  for (const evaluation::CloudPoint& point : feature.cloud) {
    const double r = point.height_mm * px_per_mm;
    auto& [sum, number] =
        squares[{static_cast<int>(std::floor(r * std::cos(point.angle_rad) / kSquare)),
                 static_cast<int>(std::floor(-r * std::sin(point.angle_rad) / kSquare))}];
    sum += point.deviation_mm;
    ++number;
  }
  for (const auto& [place, content] : squares) {
    svg.rect(kFaceCentre + kSquare * place.first, kFaceCentre + kSquare * place.second,
             kSquare + 0.2, kSquare + 0.2, "swatch",
             diverging_colour(content.first / content.second / half_zone_mm));
  }
}

}  // namespace

std::string face_map(const evaluation::FeatureResult& feature) {
  if (!feature.mz_plane || feature.cloud.empty()) return {};
  const double greatest_mm =
      std::ranges::max_element(feature.cloud, {}, &evaluation::CloudPoint::height_mm)->height_mm;
  if (!(greatest_mm > 0.0)) return {};
  const double px_per_mm = kFacePoints / greatest_mm;
  const double half_zone_mm = std::max(0.5 * feature.mz_plane->width_mm, 1e-5);
  const bool squares = feature.cloud.size() > kMostFaceDiscs;
  Svg svg(kFaceWidth, kFaceHeight, "wide face", tr("Heights over the face"));
  draw_polar_axes(svg, {kFaceCentre, kFaceEdge, 4.0, 7.0, 170.0, 172.0});
  if (squares) draw_squares(svg, feature, px_per_mm, half_zone_mm);
  const double disc =
      std::clamp(60.0 / std::sqrt(static_cast<double>(feature.cloud.size())), 2.5, 9.0);
  for (const evaluation::CloudPoint& point : feature.cloud) {
    const double x = kFaceCentre + px_per_mm * point.height_mm * std::cos(point.angle_rad);
    const double y = kFaceCentre - px_per_mm * point.height_mm * std::sin(point.angle_rad);
    if (!squares)
      svg.circle(x, y, disc, "disc", diverging_colour(point.deviation_mm / half_zone_mm));
    const double mark = squares ? 5.0 : std::max(0.55 * disc, 3.5);
    if (point.outer_contact) svg.triangle(x, y, mark, "outer");
    if (point.inner_contact) svg.square(x, y, mark, "inner");
  }
  draw_radii(svg, px_per_mm, greatest_mm);
  deviation_scale(svg, 420.0, 50.0, 350.0, half_zone_mm);
  return fmt::format(
      R"(<h3>{}</h3><figure><div class="scroll">{}</div><figcaption>{} {}</figcaption></figure>)",
      tr("Map of the face"), svg.str(),
      squares ? tr("Mean height over the middle of the zone, seen against the normal.")
              : tr("Height of each point over the middle of the zone, seen against the normal."),
      tr("Orange: out of the material; blue: into it. Triangles touch the upper, squares the lower "
         "plane of the zone."));
}

}  // namespace rondure::reports
