#include "app/fit_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/units.h"

namespace rondure::app {
namespace {

using Json = nlohmann::ordered_json;

Json axis_json(const fit::Axis& axis) {
  return {{"point_mm", {axis.point_mm.x(), axis.point_mm.y(), axis.point_mm.z()}},
          {"direction", {axis.direction.x(), axis.direction.y(), axis.direction.z()}}};
}

Json center_json(const Eigen::Vector2d& center) { return {center.x(), center.y()}; }

Json rows_json(const std::vector<fit::Contact>& contacts) {
  Json out = Json::array();
  for (const fit::Contact& c : contacts) out.push_back(c.index);
  return out;
}

Json certificate_json(const fit::Certificate& certificate) {
  return {{"kind", fit::name_of(certificate.kind)},
          {"scope", certificate.scope},
          {"gap_mm", certificate.gap_mm},
          {"reason", certificate.reason}};
}

template <class Zone>
void put_zone(Json& out, const Zone& zone) {
  out["inner_radius_mm"] = zone.inner_radius_mm;
  out["outer_radius_mm"] = zone.outer_radius_mm;
  out["deviation_mm"] = zone.width_mm();
  out["contacts"] = {{"outer", rows_json(zone.outer)}, {"inner", rows_json(zone.inner)}};
  out["certificate"] = certificate_json(zone.certificate);
}

template <class Fit>
void put_ls(Json& out, const Fit& fit) {
  out["radius_mm"] = fit.radius_mm;
  out["deviation_mm"] = fit.deviation_mm;
  out["rms_mm"] = fit.rms_mm;
}

double um(double mm) { return mm / core::kMicrometre; }

template <class Zone>
std::string zone_lines(const Zone& zone) {
  std::string out = fmt::format("    inner radius {:.6f} mm, outer radius {:.6f} mm\n    contacts",
                                zone.inner_radius_mm, zone.outer_radius_mm);
  for (const auto& c : zone.outer) out += fmt::format(" +{}", c.index);
  for (const auto& c : zone.inner) out += fmt::format(" -{}", c.index);
  out += fmt::format(" (+ outer, - inner, rows from 0)\n    certificate {}, {}, gap {:.1e} mm",
                     fit::name_of(zone.certificate.kind), zone.certificate.scope,
                     zone.certificate.gap_mm);
  if (!zone.certificate.reason.empty()) out += "; " + zone.certificate.reason;
  return out + "\n";
}

std::string axis_line(const fit::Axis& axis) {
  return fmt::format(
      "    axis through ({:.6f}, {:.6f}, {:.6f}) mm along ({:.9f}, {:.9f}, {:.9f})\n",
      axis.point_mm.x(), axis.point_mm.y(), axis.point_mm.z(), axis.direction.x(),
      axis.direction.y(), axis.direction.z());
}

std::string center_line(const Eigen::Vector2d& center) {
  return fmt::format("    centre ({:.6f}, {:.6f}) mm\n", center.x(), center.y());
}

template <class Fit>
std::string ls_line(const char* name, const Fit& fit) {
  return fmt::format("  {}  deviation {:.4f} um, rms {:.4f} um\n    radius {:.6f} mm\n", name,
                     um(fit.deviation_mm), um(fit.rms_mm), fit.radius_mm);
}

}  // namespace

std::string fit_json(const FitOutcome& outcome) {
  Json out = {{"shape", outcome.shape}, {"points", outcome.points}};
  if (outcome.ls_circle) {
    out["ls"] = {{"center_mm", center_json(outcome.ls_circle->center_mm)}};
    put_ls(out["ls"], *outcome.ls_circle);
  }
  if (outcome.ls_cylinder) {
    out["ls"] = {{"axis", axis_json(outcome.ls_cylinder->axis)}};
    put_ls(out["ls"], *outcome.ls_cylinder);
  }
  if (outcome.mz_circle) {
    out["mz"] = {{"center_mm", center_json(outcome.mz_circle->center_mm)}};
    put_zone(out["mz"], *outcome.mz_circle);
  }
  if (outcome.mz_cylinder) {
    out["mz"] = {{"axis", axis_json(outcome.mz_cylinder->axis)}};
    put_zone(out["mz"], *outcome.mz_cylinder);
  }
  if (outcome.all_references) out["mc"] = out["mi"] = nullptr;
  out["warnings"] = Json::array();
  for (const core::Error& w : outcome.warnings) {
    out["warnings"].push_back({{"code", core::code_name(w.code)}, {"what", w.what}});
  }
  return out.dump(1) + "\n";
}

std::string fit_table(const FitOutcome& outcome) {
  std::string out = fmt::format("{}, {} points\n", outcome.shape, outcome.points);
  if (outcome.ls_circle)
    out += ls_line("LSCI", *outcome.ls_circle) + center_line(outcome.ls_circle->center_mm);
  if (outcome.ls_cylinder)
    out += ls_line("LSCY", *outcome.ls_cylinder) + axis_line(outcome.ls_cylinder->axis);
  if (outcome.mz_circle) {
    out += fmt::format("  MZCI  deviation {:.4f} um (RONt)\n", um(outcome.mz_circle->width_mm())) +
           center_line(outcome.mz_circle->center_mm) + zone_lines(*outcome.mz_circle);
  }
  if (outcome.mz_cylinder) {
    out +=
        fmt::format("  MZCY  deviation {:.4f} um (CYLt)\n", um(outcome.mz_cylinder->width_mm())) +
        axis_line(outcome.mz_cylinder->axis) + zone_lines(*outcome.mz_cylinder);
  }
  for (const core::Error& w : outcome.warnings)
    out += fmt::format("  warning: {} [{}]\n", w.what, core::code_name(w.code));
  return out;
}

}  // namespace rondure::app
