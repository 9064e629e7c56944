#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/rotary/result.h"
#include "reports/escaping.h"
#include "reports/html/internal/axis_parts.h"
#include "reports/html/internal/plot_curve.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::deg;
using core::fixed;
using core::kDegree;
using core::kMicrometre;
using core::kMicroradian;
using core::um;

constexpr double kCoverage = 2.0;  // Coverage factor of the bands.
constexpr int kCurvePoints = 121;

/// One of the six errors: index in (t; w), title of its chart, column of the hidden truth.
struct ErrorName {
  Eigen::Index index = 0;
  const char* title = "";
  const char* truth = "";
};

constexpr std::array<ErrorName, 6> kErrorNames = {
    {{0, translatable("shift along x"), "shift_x_um"},
     {1, translatable("shift along y"), "shift_y_um"},
     {2, translatable("shift along z"), "shift_z_um"},
     {3, translatable("tilt about x"), "tilt_x_urad"},
     {4, translatable("tilt about y"), "tilt_y_urad"},
     {5, translatable("tilt about z"), "tilt_z_urad"}}};

double unit_of(Eigen::Index index) { return index < 3 ? kMicrometre : kMicroradian; }

double value_of(const fixture::AxisErrors& errors, Eigen::Index index) {
  return (index < 3 ? errors.shift_mm(index) : errors.tilt_rad(index - 3)) / unit_of(index);
}

double sigma_of(const fixture::ErrorCovariance& covariance, Eigen::Index index) {
  return std::sqrt(std::max(0.0, covariance(index, index))) / unit_of(index);
}

/// The smooth model with its band.
Curve model_curve(const fixture::StationMotion& motion, Eigen::Index index) {
  Curve out;
  out.name = tr("spline, band ±2 u");
  out.css_class = "zone-inner";
  for (int i = 0; i < kCurvePoints; ++i) {
    const double angle =
        motion.min_rad() + (motion.max_rad() - motion.min_rad()) * i / (kCurvePoints - 1);
    out.x.push_back(angle / kDegree);
    out.y.push_back(value_of(motion.at(angle), index));
    out.band.push_back(kCoverage * sigma_of(motion.covariance_at(angle), index));
  }
  return out;
}

Curve station_marks(const fixture::StationMotion& motion, Eigen::Index index) {
  Curve out;
  out.name = tr("stations");
  out.marks_only = true;
  for (const fixture::AxisStation& station : motion.stations()) {
    out.x.push_back(station.angle_rad / kDegree);
    out.y.push_back(value_of(station.errors, index));
  }
  return out;
}

std::string with_u(double value, double u, int decimals) {
  return fmt::format("{} ± {}", fixed(value, decimals), fixed(kCoverage * u, decimals));
}

/// Location and orientation of both axes: the errors that do not depend on the angle.
std::string location_table(const evaluation::RotaryResult& facts) {
  TableRows rows;
  for (const evaluation::AxisFacts& axis : axes_of(facts)) {
    std::vector<std::string> cells = {axis.key};
    if (!axis.study->offset) cells.push_back(tr("the stations span less than 45°: not separated"));
    for (Eigen::Index i = 0; axis.study->offset && i < 6; ++i) {
      const fit::AxisOffset& o = *axis.study->offset;
      cells.push_back(
          i < 3 ? with_u(o.d_mm(i) / kMicrometre, o.d_u_mm(i) / kMicrometre, 2)
                : with_u(o.e_rad(i - 3) / kMicroradian, o.e_u_rad(i - 3) / kMicroradian, 1));
    }
    rows.push_back(cells);
  }
  return scrolling(table(
      "", "lllllll", spoken_caption(tr("Location and orientation of the axes")),
      {tr("Axis"), "d x / µm", "d y / µm", "d z / µm", "e x / µrad", "e y / µrad", "e z / µrad"},
      rows));
}

std::string key_numbers(const evaluation::RotaryResult& facts) {
  const fixture::Calibration& c = facts.calibration;
  const fixture::Verification& v = c.verification;
  std::string html = R"(<dl class="keys">)";
  html += entry(tr("Left at combined poses"),
                with_note(trf("{} µm rms", um(v.rms_mm)),
                          trf("{} µm at most, {} µrad; {} µm rms expected", um(v.max_mm),
                              fixed(v.max_tilt_rad / kMicroradian, 1), um(v.expected_mm))),
                "lead");
  html += entry(tr("Before compensation"), with_note(trf("{} µm rms", um(v.before_rms_mm)),
                                                     trf("{} µm at most", um(v.before_max_mm))));
  html += entry(tr("Fixture"),
                with_note(isolated(c.fixture_id),
                          trf("{} to {}", escaped(c.measured_utc), escaped(c.expires_utc))));
  html += entry(tr("Touches"), with_note(trf("{} of {} balls in {} poses", facts.touches,
                                             facts.balls.size(), facts.poses),
                                         trf("scatter {} µm; u of a centre coordinate {} µm",
                                             um(facts.touch_sigma_mm), um(facts.center_u_mm))));
  html += entry(tr("Condition of the balls"),
                with_note(fixed(facts.condition, 2), tr("1 is best, above 10 is poor")));
  html += entry(tr("Drift of the zero pose"),
                with_note(um(facts.alpha.drift_mm) + " µm", tr("largest, of a ball")));
  return html + "</dl>";
}

}  // namespace

std::string axis_charts(const evaluation::AxisFacts& axis, const record::Series* truth) {
  std::string html = R"(<div class="scroll">)";
  for (const ErrorName& error : kErrorNames) {
    std::vector<Curve> curves = {model_curve(*axis.motion, error.index),
                                 station_marks(*axis.motion, error.index)};
    if (truth != nullptr) {
      const auto x = truth->column("angle_deg");
      const auto y = truth->column(error.truth);
      if (x && y) curves.push_back({tr("hidden truth"), "mean", *x, *y});
    }
    html += line_chart(trf("Axis {}: {}", axis.key, tr(error.title)),
                       fmt::format("phi {} / °", axis.key),
                       error.index < 3 ? tr("error / µm") : tr("error / µrad"), curves);
  }
  return html + "</div>";
}

std::string combined_table(std::span<const evaluation::CombinedPose> poses, const char* first,
                           const char* second) {
  TableRows rows;
  for (const evaluation::CombinedPose& pose : poses) {
    rows.push_back({deg(pose.pose.alpha_rad, 2) + "°", deg(pose.pose.beta_rad, 2) + "°",
                    std::to_string(pose.points), um(pose.before_rms_mm), um(pose.rms_mm),
                    um(pose.max_mm), fixed(pose.tilt_rad / kMicroradian, 1)});
  }
  return scrolling(table("", "lllllll", spoken_caption(tr("Combined poses")),
                         {first, second, tr("balls"), tr("before, rms / µm"), tr("left, rms / µm"),
                          tr("largest / µm"), tr("tilt / µrad")},
                         rows));
}

std::string residual_chart(std::span<const evaluation::CombinedPose> poses) {
  if (poses.empty()) return {};
  Curve before{tr("before compensation, rms"), "zone-outer", {}, {}};
  Curve left{tr("left, rms"), "profile", {}, {}};
  Curve largest{tr("left, largest ball"), "guide", {}, {}};
  for (const evaluation::CombinedPose& pose : poses) {
    const auto number = static_cast<double>(left.x.size() + 1);
    for (Curve* const curve : {&before, &left, &largest}) curve->x.push_back(number);
    before.y.push_back(pose.before_rms_mm / kMicrometre);
    left.y.push_back(pose.rms_mm / kMicrometre);
    largest.y.push_back(pose.max_mm / kMicrometre);
  }
  return fmt::format(
      "<h3>{}</h3>{}{}", tr("What is left at poses that were not used"),
      note(tr("Distance of the balls from their predicted places, pose by pose; the lines guide "
              "the eye only.")),
      scrolling(line_chart(tr("Residuals of the combined poses"),
                           tr("number of the pose, as in the table below"), tr("distance / µm"),
                           {before, left, largest})));
}

std::string words_of_rotary() {
  return explained(
             tr("Combined poses"),
             tr("Poses with both axes turned, which the identification did not use: they show "
                "whether the errors found hold elsewhere.")) +
         explained(tr("Left at combined poses"),
                   tr("Distance of a ball centre from its predicted place after compensation; "
                      "expected: what noise and the uncertainty of the errors explain.")) +
         explained(
             tr("Condition of the balls"),
             tr("How evenly the balls determine the six errors of a pose: 1 when all are known "
                "equally well, large when some of them are hardly seen."));
}

std::string analysis_part(const evaluation::RotaryResult& facts, const record::RunRecord& record,
                          int feature) {
  std::string html =
      residual_chart(facts.combined) + as_read_note() + key_numbers(facts) + words_of_rotary();
  html += fmt::format("<h3>{}</h3>{}", tr("Combined poses"),
                      combined_table(facts.combined, "alpha", "beta"));
  html += fmt::format("<h3>{}</h3>{}", tr("Location and orientation of the axes"),
                      location_table(facts));
  html += note(
      tr("Displacement d and tilt e of the real axis against the stated one, ± 2 u, as far as an "
         "axis beside its place explains the errors below. Compensation uses the whole errors."));
  const std::vector<evaluation::AxisFacts> axes = axes_of(facts);
  for (const evaluation::AxisFacts& axis : axes) {
    html +=
        fmt::format("<h3>{}</h3>", &axis == &axes.front() ? tr("Axis alpha (base-fixed, about x)")
                                                          : tr("Axis beta (carried, about y)"));
    html += axis_charts(axis, record.truth_series_of(feature, axis.key));
  }
  return html +
         note(tr("Errors relative to the zero pose, at the axis. A dashed line, where there "
                 "is one, is the hidden truth of the simulation: evaluation never reads it."));
}

}  // namespace rondure::reports
