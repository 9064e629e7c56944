#include "app/text/rotary_axes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "core/units.h"

namespace rondure::app {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Vector3d;

double urad(double rad) { return rad * 1e6; }

Json list(const Vector3d& v, double factor = 1.0) {
  return {v.x() * factor, v.y() * factor, v.z() * factor};
}

Json um_list(const Vector3d& mm) { return list(mm, 1e3); }
Json urad_list(const Vector3d& rad) { return list(rad, 1e6); }

/// um^2, um urad, urad^2.
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

/// Standard uncertainty of a body point that stands at `place` in the reference pose.
Vector3d point_u_mm(const RotaryFacts& facts, const fit::Matrix6& covariance, double angle_rad) {
  const fit::RotaryAxis& axis = facts.study.table.axis;
  const Vector3d p =
      axis.turn(angle_rad - facts.study.reference_rad) * (facts.place_mm - axis.origin_mm);
  return fit::point_covariance_mm2(covariance, p).diagonal().cwiseMax(0.0).cwiseSqrt();
}

Json station_json(const RotaryFacts& facts, const fit::RotaryStation& s) {
  Json out = {{"station_deg", core::degrees(s.angle_rad)}, {"direction", name_of(s.approach)}};
  out["undetermined"] = s.undetermined;
  if (s.undetermined) return out;
  const fit::Vector6 u = s.errors.sigma();
  out["t_um"] = um_list(s.errors.t_mm);
  out["w_urad"] = urad_list(s.errors.w_rad);
  out["u_t_um"] = um_list(u.head<3>());
  out["u_w_urad"] = urad_list(u.tail<3>());
  out["u_point_um"] = um_list(point_u_mm(facts, s.errors.covariance, s.angle_rad));
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

/// Errors and their band over the stations.
Json curve_json(const RotaryFacts& facts) {
  Json out = Json::array();
  const bool circle = facts.study.table.full_circle;
  const double low = facts.model->lowest_rad();
  const double span = circle ? core::kTwoPi : facts.model->highest_rad() - low;
  constexpr int kSteps = 72;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = low + span * i / kSteps;
    const auto at = facts.model->at(angle);
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

Json axis_json(const RotaryFacts& facts) {
  const fit::RotaryStudy& study = facts.study;
  Json out;
  out["axis"] = facts.name;
  out["direction"] = list(study.table.axis.direction);
  out["origin_mm"] = list(study.table.axis.origin_mm);
  out["reference_deg"] = core::degrees(study.reference_rad);
  out["reference"] = Json::array();
  for (const fit::BallCentre& ball : study.reference) {
    out["reference"].push_back(
        {{"ball", ball.ball}, {"centre_mm", list(ball.centre_mm)}, {"u_um", um_list(ball.u_mm)}});
  }
  out["drift_um"] = core::micrometres(study.drift_mm);
  out["method"] = facts.method;
  out["s0"] = study.s0;
  out["dof"] = study.dof;
  out["full_circle"] = study.table.full_circle;
  out["periodicity_checked"] = study.periodicity_checked;
  out["hysteresis_um"] = um_list(study.table.hysteresis_rms.head<3>());
  out["hysteresis_urad"] = urad_list(study.table.hysteresis_rms.tail<3>());
  out["stations"] = Json::array();
  for (const fit::RotaryStation& s : study.stations) {
    out["stations"].push_back(station_json(facts, s));
  }
  out["offset"] = study.offset ? offset_json(*study.offset) : Json();
  out["place_mm"] = list(facts.place_mm);
  out["curve"] = name_of(study.table.curve);
  out["curve_points"] = facts.model ? curve_json(facts) : Json::array();
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

std::string station_lines(const RotaryFacts& facts) {
  std::string out = "   station       EX      EY      EZ      EA      EB      EC    chi2\n";
  out += "       deg       um      um      um    urad    urad    urad\n";
  fit::Vector6 largest = fit::Vector6::Zero();
  double point = 0.0;
  for (const fit::RotaryStation& s : facts.study.stations) {
    out += fmt::format("{:10.3f}{:1}", core::degrees(s.angle_rad), name_of(s.approach));
    if (s.undetermined) {
      out += " undetermined\n";
      continue;
    }
    out += fmt::format("{}{:8.1f}{}\n", six(s.errors.values()), s.chi2, marks_of(s));
    largest = largest.cwiseMax(s.errors.sigma());
    point = std::max(point, point_u_mm(facts, s.errors.covariance, s.angle_rad).maxCoeff());
  }
  out += fmt::format("  largest u{}\n", six(largest));
  const Vector3d& p = facts.place_mm;
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

/// A warning in lines of at most 78 columns, the later ones indented.
std::string warning_lines(const std::string& text) {
  std::string out;
  std::string line = "  warning     ";
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find(' ', start), text.size());
    const std::string word = text.substr(start, end - start);
    if (line.size() + 1 + word.size() > 78) {
      out += line + "\n";
      line = "              ";
    }
    line += (line.back() == ' ' ? "" : " ") + word;
    start = end + 1;
  }
  return out + line + "\n";
}

std::string axis_table(const RotaryFacts& facts) {
  const fit::RotaryStudy& study = facts.study;
  const Vector3d& a = study.table.axis.direction;
  std::string out =
      fmt::format("Axis {} along ({:g}, {:g}, {:g}): {} stations, {} balls, {}\n", facts.name,
                  a.x(), a.y(), a.z(), study.stations.size(), study.reference.size(),
                  study.table.full_circle ? "full circle" : "arc");
  out += fmt::format("  errors relative to {:g} deg, {}; s0 {:.3f} ({} degrees of freedom)\n",
                     core::degrees(study.reference_rad), facts.method, study.s0, study.dof);
  out += station_lines(facts);
  if (study.offset) out += offset_lines(*study.offset);
  if (study.table.hysteresis_rms.maxCoeff() > 0.0) {
    out += fmt::format(" hysteresis{}\n", six(study.table.hysteresis_rms));
  }
  for (const core::Error& w : study.warnings) out += warning_lines(core::to_line(w));
  return out;
}

}  // namespace

nlohmann::ordered_json rotary_axes_json(std::span<const RotaryFacts> axes) {
  Json out;
  out["axes"] = Json::array();
  for (const RotaryFacts& facts : axes) out["axes"].push_back(axis_json(facts));
  return out;
}

std::string rotary_axes_table(std::span<const RotaryFacts> axes) {
  std::string out;
  for (const RotaryFacts& facts : axes) {
    if (!out.empty()) out += '\n';
    out += axis_table(facts);
  }
  return out;
}

}  // namespace rondure::app
