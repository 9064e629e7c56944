#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/numbers.h"
#include "core/result.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/rotary/axes.h"
#include "fit/rotary/errors.h"
#include "fit/rotary/model.h"
#include "record/csv/balls.h"
#include "record/files.h"

namespace rondure::app {
namespace {

/// Results of `rondure fit rotary-axes` for one axis.
struct RotaryAxisResult {
  std::string name;
  std::string method;
  fit::RotaryStudy study;
  std::optional<fit::RotaryModel> model;  ///< Absent with too few stations; a warning states this.
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();  ///< Point whose uncertainty is stated.
};

using Json = nlohmann::ordered_json;
using Eigen::Vector3d;

double urad(double rad) { return rad * 1e6; }

Json list(const Vector3d& v, double factor = 1.0) {
  return {v.x() * factor, v.y() * factor, v.z() * factor};
}

Json um_list(const Vector3d& mm) { return list(mm, 1e3); }
Json urad_list(const Vector3d& rad) { return list(rad, 1e6); }

/// Covariance in um^2, um urad, urad^2.
Json covariance_json(const fit::Matrix6& c) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < 6; ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < 6; ++j)
      row.push_back(c(i, j) * (i < 3 ? 1e3 : 1e6) * (j < 3 ? 1e3 : 1e6));
    out.push_back(std::move(row));
  }
  return out;
}

const char* name_of(fit::Approach approach) {
  if (approach == fit::Approach::kForward) return "+";
  return approach == fit::Approach::kBackward ? "-" : "";
}

const char* name_of(fit::RotaryCurve curve) {
  if (curve == fit::RotaryCurve::kFourier) return "fourier";
  return curve == fit::RotaryCurve::kPolynomial ? "polynomial" : "spline";
}

/// Standard uncertainty of a body point that is at `place` in the reference pose.
Vector3d point_u_mm(const RotaryAxisResult& result, const fit::Matrix6& covariance,
                    double angle_rad) {
  const fit::RotaryAxis& axis = result.study.table.axis;
  const Vector3d p =
      axis.turn(angle_rad - result.study.reference_rad) * (result.place_mm - axis.origin_mm);
  return fit::point_covariance_mm2(covariance, p).diagonal().cwiseMax(0.0).cwiseSqrt();
}

Json station_json(const RotaryAxisResult& result, const fit::RotaryStation& s) {
  Json out = {{"station_deg", core::degrees(s.angle_rad)}, {"direction", name_of(s.approach)}};
  out["undetermined"] = s.undetermined;
  if (s.undetermined) return out;
  const fit::Vector6 u = s.errors.sigma();
  out["t_um"] = um_list(s.errors.t_mm);
  out["w_urad"] = urad_list(s.errors.w_rad);
  out["u_t_um"] = um_list(u.head<3>());
  out["u_w_urad"] = urad_list(u.tail<3>());
  out["u_point_um"] = um_list(point_u_mm(result, s.errors.covariance, s.angle_rad));
  out["covariance"] = covariance_json(s.errors.covariance);
  out["chi2"] = s.chi2;
  out["dof"] = s.dof;
  out["chi2_limit"] = s.chi2_limit;
  out["flagged"] = s.flagged;
  out["removed"] = s.removed;
  out["condition"] = s.condition;
  out["balls"] = Json::array();
  for (std::size_t i = 0; i < s.balls.size(); ++i) {
    out["balls"].push_back({{"ball", s.balls[i]},
                            {"residual_um", um_list(s.residuals_mm[i])},
                            {"redundancy", list(s.redundancy[i])}});
  }
  return out;
}

Json offset_json(const fit::AxisOffset& o) {
  return {{"d_um", um_list(o.d_mm)},
          {"u_d_um", um_list(o.d_u_mm)},
          {"e_urad", urad_list(o.e_rad)},
          {"u_e_urad", urad_list(o.e_u_rad)},
          {"c_um", um_list(o.c_mm)},
          {"c_urad", urad_list(o.c_rad)},
          {"zero_point_urad", urad(o.zero_point_rad)},
          {"arc_deg", core::degrees(o.arc_rad)},
          {"arc_factor", o.arc_factor},
          {"point_mm", list(o.axis.origin_mm)},
          {"direction", list(o.axis.direction)}};
}

/// Errors over the stations, with their band.
Json curve_json(const RotaryAxisResult& result) {
  Json out = Json::array();
  const bool circle = result.study.table.full_circle;
  const double low = result.model->lowest_rad();
  const double span = circle ? core::kTwoPi : result.model->highest_rad() - low;
  constexpr int kSteps = 72;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = low + span * i / kSteps;
    const auto at = result.model->at(angle);
    if (!at) continue;
    const fit::Vector6 u = at->sigma();
    out.push_back({{"angle_deg", core::degrees(angle)},
                   {"t_um", um_list(at->t_mm)},
                   {"w_urad", urad_list(at->w_rad)},
                   {"u_t_um", um_list(u.head<3>())},
                   {"u_w_urad", urad_list(u.tail<3>())},
                   {"bridged", at->bridged}});
  }
  return out;
}

Json axis_json(const RotaryAxisResult& result) {
  const fit::RotaryStudy& study = result.study;
  Json out;
  out["axis"] = result.name;
  out["direction"] = list(study.table.axis.direction);
  out["origin_mm"] = list(study.table.axis.origin_mm);
  out["reference_deg"] = core::degrees(study.reference_rad);
  out["reference"] = Json::array();
  for (const fit::BallCentre& ball : study.reference) {
    out["reference"].push_back(
        {{"ball", ball.ball}, {"centre_mm", list(ball.centre_mm)}, {"u_um", um_list(ball.u_mm)}});
  }
  out["drift_um"] = core::micrometres(study.drift_mm);
  out["method"] = result.method;
  out["s0"] = study.s0;
  out["dof"] = study.dof;
  out["full_circle"] = study.table.full_circle;
  out["periodicity_checked"] = study.periodicity_checked;
  out["hysteresis_um"] = um_list(study.table.hysteresis_rms.head<3>());
  out["hysteresis_urad"] = urad_list(study.table.hysteresis_rms.tail<3>());
  out["stations"] = Json::array();
  for (const fit::RotaryStation& s : study.stations) {
    out["stations"].push_back(station_json(result, s));
  }
  out["offset"] = study.offset ? offset_json(*study.offset) : Json();
  out["place_mm"] = list(result.place_mm);
  out["curve"] = name_of(study.table.curve);
  out["curve_points"] = result.model ? curve_json(result) : Json::array();
  out["warnings"] = warnings_json(study.warnings);
  return out;
}

std::string marks_of(const fit::RotaryStation& s) {
  std::string out;
  if (s.flagged) out += " flagged";
  for (const std::string& ball : s.removed) out += fmt::format(" -{}", ball);
  return out;
}

/// Six numbers in 8 columns each.
std::string six(const fit::Vector6& v) {
  std::string out;
  for (Eigen::Index k = 0; k < 6; ++k) out += fmt::format("{:8.2f}", v(k) * (k < 3 ? 1e3 : 1e6));
  return out;
}

std::string station_lines(const RotaryAxisResult& result) {
  std::string out = "   station       EX      EY      EZ      EA      EB      EC    chi2\n";
  out += "       deg       um      um      um    urad    urad    urad\n";
  fit::Vector6 largest = fit::Vector6::Zero();
  double point = 0.0;
  for (const fit::RotaryStation& s : result.study.stations) {
    out += fmt::format("{:10.3f}{:1}", core::degrees(s.angle_rad), name_of(s.approach));
    if (s.undetermined) {
      out += " undetermined\n";
      continue;
    }
    out += fmt::format("{}{:8.1f}{}\n", six(s.errors.values()), s.chi2, marks_of(s));
    largest = largest.cwiseMax(s.errors.sigma());
    point = std::max(point, point_u_mm(result, s.errors.covariance, s.angle_rad).maxCoeff());
  }
  out += fmt::format("  largest u{}\n", six(largest));
  const Vector3d& p = result.place_mm;
  return out + fmt::format("  at ({:g}, {:g}, {:g}) mm a point is known to {:.2f} um or better\n",
                           p.x(), p.y(), p.z(), core::micrometres(point));
}

std::string offset_lines(const fit::AxisOffset& o) {
  const auto line = [](const char* what, const Vector3d& v, const Vector3d& u, double factor,
                       const char* unit) {
    return fmt::format("  {:<12} ({:.2f}, {:.2f}, {:.2f}) {}, u ({:.2f}, {:.2f}, {:.2f})\n", what,
                       v.x() * factor, v.y() * factor, v.z() * factor, unit, u.x() * factor,
                       u.y() * factor, u.z() * factor);
  };
  return line("axis off by", o.d_mm, o.d_u_mm, 1e3, "um") +
         line("tilted by", o.e_rad, o.e_u_rad, 1e6, "urad") +
         fmt::format("  zero point   {:.2f} urad; arc {:.0f} deg, noise of the split x {:.2f}\n",
                     urad(o.zero_point_rad), core::degrees(o.arc_rad), o.arc_factor);
}

std::string axis_table(const RotaryAxisResult& result) {
  const fit::RotaryStudy& study = result.study;
  const Vector3d& a = study.table.axis.direction;
  std::string out =
      fmt::format("Axis {} along ({:g}, {:g}, {:g}): {} stations, {} balls, {}\n", result.name,
                  a.x(), a.y(), a.z(), study.stations.size(), study.reference.size(),
                  study.table.full_circle ? "full circle" : "arc");
  out += fmt::format("  errors relative to {:g} deg, {}; s0 {:.3f} ({} degrees of freedom)\n",
                     core::degrees(study.reference_rad), result.method, study.s0, study.dof);
  out += station_lines(result);
  if (study.offset) out += offset_lines(*study.offset);
  if (study.table.hysteresis_rms.maxCoeff() > 0.0) {
    out += fmt::format(" hysteresis{}\n", six(study.table.hysteresis_rms));
  }
  for (const core::Error& w : study.warnings) {
    out += wrapped(core::to_line(w), "  warning     ", "              ");
  }
  return out;
}

constexpr const char* kNoInterval =
    "u are standard uncertainties from the u of the balls; an interval needs the influences that a "
    "plan declares: a feature of type rotary_axes with rotary_axes.uncertainty "
    "(docs/fixture-calibration.md)";

nlohmann::ordered_json rotary_axes_json(std::span<const RotaryAxisResult> axes) {
  Json out;
  out["axes"] = Json::array();
  for (const RotaryAxisResult& result : axes) out["axes"].push_back(axis_json(result));
  out["no_interval_because"] = kNoInterval;
  return out;
}

std::string rotary_axes_table(std::span<const RotaryAxisResult> axes) {
  std::string out;
  for (const RotaryAxisResult& result : axes) {
    if (!out.empty()) out += '\n';
    out += axis_table(result);
  }
  return out + wrapped(kNoInterval, "  no interval is stated: ", "    ");
}

/// One axis of the files.
struct NamedAxis {
  std::string name;
  fit::RotaryMeasurement measurement;
};

using core::Code;
using Eigen::Vector3d;

std::optional<Vector3d> direction_by_name(std::string_view name) {
  constexpr std::array<std::array<std::string_view, 4>, 3> kNames = {
      {{"x", "A", "a", "phi_alpha"}, {"y", "B", "b", "phi_beta"}, {"z", "C", "c", "z"}}};
  for (std::size_t axis = 0; axis < kNames.size(); ++axis) {
    const auto& names = kNames[axis];
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      return Vector3d::Unit(static_cast<Eigen::Index>(axis));
    }
  }
  return std::nullopt;
}

/// Parses "x" or "0,0.6,0.8".
core::Result<Vector3d> direction_of(std::string_view text) {
  if (const auto known = direction_by_name(text)) return *known;
  Vector3d out;
  std::string_view rest = text;
  for (int k = 0; k < 3; ++k) {
    const std::size_t comma = k < 2 ? rest.find(',') : rest.size();
    const auto number = core::parse_number(rest.substr(0, comma));
    if (!number || comma == std::string_view::npos) {
      return core::fail_with(Code::kBadOption,
                             "--axis {} is neither x, y, z nor three numbers a,b,c", text);
    }
    out(k) = *number;
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  if (!(out.norm() > 1e-9)) {
    return core::fail_with(Code::kBadOption, "--axis {} has no direction", text);
  }
  return Vector3d(out.normalized());
}

core::Result<fit::RotaryMeasurement> empty_axis(const std::string& name,
                                                const RotaryAxesArguments& a) {
  fit::RotaryMeasurement out;
  if (!a.axis.empty()) {
    TRY(out.axis.direction, direction_of(a.axis));
  } else if (const auto known = direction_by_name(name)) {
    out.axis.direction = *known;
  } else {
    return core::fail_with(Code::kBadOption,
                           "the direction of axis {} is not known by its name; give --axis", name);
  }
  if (!a.origin_mm.empty()) {
    if (a.origin_mm.size() != 3) {
      return core::fail(Code::kBadOption, "--origin needs three numbers: X,Y,Z");
    }
    out.axis.origin_mm = {a.origin_mm[0], a.origin_mm[1], a.origin_mm[2]};
  }
  if (!a.range_deg.empty()) {
    if (a.range_deg.size() != 2) {
      return core::fail(Code::kBadOption, "--range-deg needs two numbers: LO,HI");
    }
    out.lowest_rad = a.range_deg[0] * core::kDegree;
    out.highest_rad = a.range_deg[1] * core::kDegree;
  }
  out.reference_rad = a.reference_deg * core::kDegree;
  return out;
}

fit::Approach approach_of(int direction) {
  if (direction == 0) return fit::Approach::kUnknown;
  return direction > 0 ? fit::Approach::kForward : fit::Approach::kBackward;
}

/// Place of a row: the current pose, an earlier one, or a new one.
std::vector<fit::BallCentre>& place_of(const record::BallRow& row, fit::RotaryMeasurement& out) {
  if (!row.station_deg) {
    for (auto& reference : out.references) {
      const bool there =
          std::any_of(reference.begin(), reference.end(),
                      [&](const fit::BallCentre& ball) { return ball.ball == row.ball; });
      if (!there) return reference;
    }
    return out.references.emplace_back();
  }
  const double angle = *row.station_deg * core::kDegree;
  const fit::Approach approach = approach_of(row.direction);
  for (fit::RotaryPose& pose : out.stations) {
    if (pose.angle_rad == angle && pose.approach == approach) return pose.balls;
  }
  return out.stations.emplace_back(fit::RotaryPose{angle, approach, {}}).balls;
}

core::Result<void> add_row(const record::BallRow& row, const RotaryAxesArguments& arguments,
                           std::vector<NamedAxis>& axes) {
  auto at = std::find_if(axes.begin(), axes.end(),
                         [&](const NamedAxis& axis) { return axis.name == row.axis; });
  if (at == axes.end()) {
    if (!axes.empty() && !arguments.axis.empty()) {
      return core::fail_with(Code::kBadOption, "--axis is for one axis, the files hold {} and {}",
                             axes.front().name, row.axis);
    }
    TRY(auto measurement, empty_axis(row.axis, arguments));
    axes.push_back({row.axis, std::move(measurement)});
    at = axes.end() - 1;
  }
  place_of(row, at->measurement).push_back({row.ball, row.centre_mm, row.u_um * core::kMicrometre});
  return {};
}

/// Reads the files and sorts their rows by axis and station, in the order of measurement. A ball
/// that recurs in the reference pose starts its next measurement.
/// @return The errors of parse_ball_csv(); kBadOption when the direction of an axis is unknown, is
///         not three numbers, or is given for several axes.
core::Result<std::vector<NamedAxis>> read_rotary_axes(const RotaryAxesArguments& arguments) {
  std::vector<NamedAxis> out;
  for (const std::string& file : arguments.files) {
    TRY(const auto bytes, record::read_file(file, record::kMostPointsBytes));
    const std::string name = std::filesystem::path(file).filename().string();
    TRY(const auto rows, record::parse_ball_csv(bytes, name));
    for (const record::BallRow& row : rows) {
      if (auto added = add_row(row, arguments, out); !added) {
        return core::fail(added.error().at(fmt::format("{}:{}", name, row.line)));
      }
    }
  }
  return out;
}

/// Adds what is declared of the axis, and of the tools that hold the balls.
void declare(const RotaryAxesArguments& a, fit::RotaryMeasurement& m) {
  const double repeat_rad = a.repeat_urad * core::kMicroradian;
  if (m.references.empty() || (repeat_rad == 0.0 && !a.tool_um)) return;
  const fit::Matrix6 of_plate =
      fit::turn_covariance(m.axis.direction, Vector3d::Zero(), repeat_rad);
  std::map<std::string, Vector3d> places;
  for (const auto& reference : m.references) {
    for (const fit::BallCentre& ball : reference) {
      places.emplace(ball.ball, ball.centre_mm - m.axis.origin_mm);
    }
  }
  std::vector<Vector3d> balls;
  for (const auto& [name, place_mm] : places) balls.push_back(place_mm);
  for (fit::RotaryPose& pose : m.stations) {
    pose.placing_covariance =
        a.tool_um ? fit::setup_covariance(balls, m.axis, pose.angle_rad - m.reference_rad,
                                          repeat_rad, *a.tool_um * core::kMicrometre)
                  : of_plate;
  }
  if (!a.tool_um) m.reference_placing = of_plate / static_cast<double>(m.references.size());
}

fit::RotaryOptions options_of(const RotaryAxesArguments& a) {
  fit::RotaryOptions out;
  if (a.method == "linear") out.solver = fit::RotaryOptions::Solver::kLinear;
  if (a.method == "as-published") out.solver = fit::RotaryOptions::Solver::kAsPublished;
  if (a.curve == "fourier") out.curve = fit::RotaryCurve::kFourier;
  if (a.curve == "polynomial") out.curve = fit::RotaryCurve::kPolynomial;
  out.remove_outliers = !a.keep_outliers;
  return out;
}

core::Result<std::vector<RotaryAxisResult>> identify(const RotaryAxesArguments& arguments) {
  if (!arguments.place_mm.empty() && arguments.place_mm.size() != 3) {
    return core::fail(Code::kBadOption, "--at needs three numbers: X,Y,Z");
  }
  TRY(auto axes, read_rotary_axes(arguments));
  std::vector<RotaryAxisResult> out;
  for (NamedAxis& axis : axes) {
    declare(arguments, axis.measurement);
    auto study = fit::identify_rotary_axis(axis.measurement, options_of(arguments));
    if (!study) return core::fail(study.error().at(fmt::format("axis {}", axis.name)));
    const double chi2 = study->s0 * study->s0 * study->dof;
    if (study->dof > 0 && chi2 < core::chi_square_quantile(0.001, study->dof)) {
      study->warnings.push_back(
          {Code::kUnits, fmt::format("the balls agree better than their uncertainty allows (s0 "
                                     "{:.3f}, 1 is expected): are the centres in mm, and is the "
                                     "uncertainty of a centre right?",
                                     study->s0)});
    }
    RotaryAxisResult result;
    result.name = axis.name;
    result.method = arguments.method;
    result.place_mm = axis.measurement.axis.origin_mm;
    if (!arguments.place_mm.empty()) {
      result.place_mm = {arguments.place_mm[0], arguments.place_mm[1], arguments.place_mm[2]};
    }
    auto model = fit::RotaryModel::of(study->table);
    if (model) {
      result.model = *std::move(model);
    } else if (model.error().code == Code::kBadOption) {
      return core::fail(model.error().at(fmt::format("axis {}", axis.name)));
    } else {
      study->warnings.push_back(model.error());
    }
    result.study = *std::move(study);
    out.push_back(std::move(result));
  }
  return out;
}

}  // namespace

int rotary_axes(const RotaryAxesArguments& arguments) {
  const auto results = identify(arguments);
  if (!results) return refuse(results.error());
  return answer(rotary_axes_json(*results), arguments.json,
                [&] { return rotary_axes_table(*results); });
}

}  // namespace rondure::app
