#include "app/text/fit.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "core/units.h"

namespace rondure::app {
namespace {

using Json = nlohmann::ordered_json;

Json place_json(const FitPlace& place) {
  const auto three = [](const Eigen::Vector3d& v) -> Json { return {v.x(), v.y(), v.z()}; };
  if (place.axis) {
    return {
        {"axis",
         {{"point_mm", three(place.axis->point_mm)}, {"direction", three(place.axis->direction)}}}};
  }
  Json center = three(place.center_mm);
  if (place.coordinates == 2) center.erase(2);
  return {{"center_mm", center}};
}

Json rows_json(const std::vector<fit::Contact>& contacts) {
  Json out = Json::array();
  for (const fit::Contact& c : contacts) out.push_back(c.index);
  return out;
}

Json reference_json(const FitReference& found) {
  Json out = place_json(found.place);
  const auto put = [&](const char* key, const std::optional<double>& value) {
    if (value) out[key] = *value;
  };
  put("radius_mm", found.radius_mm);
  put("inner_radius_mm", found.inner_radius_mm);
  put("outer_radius_mm", found.outer_radius_mm);
  put("diameter_mm", found.diameter_mm);
  out["deviation_mm"] = found.deviation_mm;
  if (found.range) out["deviation_range_mm"] = {found.range->low_mm, found.range->high_mm};
  put("rms_mm", found.rms_mm);
  if (!found.certificate) return out;
  out["contacts"] = Json::object();
  if (!found.outer.empty() || found.inner_radius_mm) {
    out["contacts"]["outer"] = rows_json(found.outer);
  }
  if (!found.inner.empty() || found.inner_radius_mm) {
    out["contacts"]["inner"] = rows_json(found.inner);
  }
  out["certificate"] = certificate_json(*found.certificate);
  return out;
}

std::string place_line(const FitPlace& place) {
  if (place.axis) {
    const Eigen::Vector3d& p = place.axis->point_mm;
    const Eigen::Vector3d& d = place.axis->direction;
    return fmt::format(
        "    axis through ({:.6f}, {:.6f}, {:.6f}) mm along ({:.9f}, {:.9f}, {:.9f})\n", p.x(),
        p.y(), p.z(), d.x(), d.y(), d.z());
  }
  const Eigen::Vector3d& c = place.center_mm;
  if (place.coordinates == 2) return fmt::format("    centre ({:.6f}, {:.6f}) mm\n", c.x(), c.y());
  return fmt::format("    centre ({:.6f}, {:.6f}, {:.6f}) mm\n", c.x(), c.y(), c.z());
}

std::string radii_line(const FitReference& found) {
  if (found.inner_radius_mm) {
    return fmt::format("    inner radius {:.6f} mm, outer radius {:.6f} mm\n",
                       *found.inner_radius_mm, *found.outer_radius_mm);
  }
  if (found.radius_mm) return fmt::format("    radius {:.6f} mm\n", *found.radius_mm);
  return {};
}

std::string proof_lines(const FitReference& found) {
  if (!found.certificate) return {};
  std::string out = "    contacts";
  for (const auto& c : found.outer) out += fmt::format(" +{}", c.index);
  for (const auto& c : found.inner) out += fmt::format(" -{}", c.index);
  out += " (+ outer, - inner, rows from 0)\n    " + certificate_text(*found.certificate);
  return out + "\n";
}

std::string reference_lines(const FitOutcome::Entry& entry) {
  if (!entry.found) return fmt::format("  {}  does not exist for these points\n", entry.title);
  const FitReference& found = *entry.found;
  std::string out =
      fmt::format("  {}  deviation {:.4f} um", entry.title, core::micrometres(found.deviation_mm));
  if (found.range) {
    out += fmt::format(", not unique: {:.4f} to {:.4f} um", core::micrometres(found.range->low_mm),
                       core::micrometres(found.range->high_mm));
  }
  if (found.rms_mm) out += fmt::format(", rms {:.4f} um", core::micrometres(*found.rms_mm));
  return out + "\n" + place_line(found.place) + radii_line(found) + proof_lines(found);
}

}  // namespace

Json certificate_json(const fit::Certificate& certificate) {
  const bool proven = certificate.kind != fit::Certificate::Kind::kNone;
  return {{"kind", fit::name_of(certificate.kind)},
          {"scope", certificate.scope},
          {"gap_mm", proven ? Json(certificate.gap_mm) : Json(nullptr)},
          {"reason", certificate.reason}};
}

std::string certificate_text(const fit::Certificate& certificate) {
  std::string out = fmt::format("certificate {}, {}", fit::name_of(certificate.kind),
                                certificate.scope.english());
  if (certificate.kind != fit::Certificate::Kind::kNone) {
    out += fmt::format(", gap {:.1e} mm", certificate.gap_mm);
  }
  return certificate.reason.empty() ? out : out + "; " + certificate.reason.english();
}

nlohmann::ordered_json fit_json(const FitOutcome& outcome) {
  Json out = {{"shape", outcome.shape}, {"points", outcome.points}};
  for (const FitOutcome::Entry& entry : outcome.references) {
    out[entry.name] = entry.found ? reference_json(*entry.found) : Json(nullptr);
  }
  out["warnings"] = warnings_json(outcome.warnings);
  return out;
}

std::string fit_table(const FitOutcome& outcome) {
  std::string out = fmt::format("{}, {} points\n", outcome.shape, outcome.points);
  for (const FitOutcome::Entry& entry : outcome.references) out += reference_lines(entry);
  return out + warnings_text(outcome.warnings);
}

}  // namespace rondure::app
