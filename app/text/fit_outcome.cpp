#include "app/text/fit_outcome.h"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "core/numbers.h"
#include "core/units.h"

namespace rondure::app {
namespace {

using Json = nlohmann::ordered_json;

Json three_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json place_json(const FitPlace& place) {
  if (place.axis) {
    return {{"axis",
             {{"point_mm", three_json(place.axis->point_mm)},
              {"direction", three_json(place.axis->direction)}}}};
  }
  if (place.plane) {
    return {{"plane",
             {{"point_mm", three_json(place.plane->point_mm)},
              {"normal", three_json(place.plane->normal)}}}};
  }
  Json center = three_json(place.center_mm);
  if (place.coordinates == 2) center.erase(2);
  Json out = {{"center_mm", center}};
  if (place.normal) out["normal"] = three_json(*place.normal);
  return out;
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
  put("full_angle_deg", found.full_angle_deg);
  put("diameter_mm", found.diameter_mm);
  out["deviation_mm"] = found.deviation_mm;
  if (found.range) out["deviation_range_mm"] = {found.range->low_mm, found.range->high_mm};
  put("peak_mm", found.peak_mm);
  put("valley_mm", found.valley_mm);
  put("rms_mm", found.rms_mm);
  if (!found.certificate) return out;
  out["contacts"] = Json::object();
  if (!found.outer.empty() || found.two_sided) {
    out["contacts"]["outer"] = rows_json(found.outer);
  }
  if (!found.inner.empty() || found.two_sided) {
    out["contacts"]["inner"] = rows_json(found.inner);
  }
  out["certificate"] = certificate_json(*found.certificate);
  return out;
}

/// The statistics of two-point sizes by name.
std::array<std::pair<std::string_view, double>, 7> ranks_by_name(const fit::RankSizes& sizes) {
  return {{{"SX", sizes.sx_mm},
           {"SN", sizes.sn_mm},
           {"SA", sizes.sa_mm},
           {"SM", sizes.sm_mm},
           {"SD", sizes.sd_mm},
           {"SR", sizes.sr_mm},
           {"SQ", sizes.sq_mm}}};
}

Json sizes_json(const FitSizes& sizes) {
  Json out = {{"inside", sizes.material.inside},
              {"tip_diameter_mm", 2.0 * sizes.material.tip_radius_mm}};
  for (const FitSizes::Global& size : sizes.global) {
    out[size.name + "_mm"] = size.value_mm ? Json(*size.value_mm) : Json(nullptr);
  }
  if (!sizes.local_wanted) return out;
  out["LP"] = nullptr;
  if (!sizes.local) return out;
  out["LP"] = {{"pairs", sizes.local->count}};
  for (const auto& [name, value] : ranks_by_name(*sizes.local)) {
    out["LP"][std::string(name) + "_mm"] = value;
  }
  return out;
}

/// "(1.000000, 0.000000, 2.000000)", no zero with a minus sign.
std::string in_parentheses(const Eigen::Vector3d& v, int decimals) {
  return fmt::format("({}, {}, {})", core::fixed(v.x(), decimals), core::fixed(v.y(), decimals),
                     core::fixed(v.z(), decimals));
}

std::string place_lines(const FitReference& found) {
  if (const auto& axis = found.place.axis) {
    return fmt::format("    axis through {} mm along {}\n", in_parentheses(axis->point_mm, 6),
                       in_parentheses(axis->direction, 9));
  }
  if (const auto& plane = found.place.plane) {
    return fmt::format("    {} through {} mm, normal {}\n",
                       found.two_sided ? "outer (one-sided) plane" : "plane",
                       in_parentheses(plane->point_mm, 6), in_parentheses(plane->normal, 9));
  }
  const Eigen::Vector3d& c = found.place.center_mm;
  if (found.place.coordinates == 2) {
    return fmt::format("    centre ({}, {}) mm\n", core::fixed(c.x(), 6), core::fixed(c.y(), 6));
  }
  return fmt::format(
      "    centre {} mm{}\n", in_parentheses(c, 6),
      found.place.normal ? ", normal " + in_parentheses(*found.place.normal, 9) : "");
}

std::string radii_line(const FitReference& found) {
  if (found.inner_radius_mm) {
    return fmt::format("    inner radius {:.6f} mm, outer radius {:.6f} mm\n",
                       *found.inner_radius_mm, *found.outer_radius_mm);
  }
  if (found.full_angle_deg) {
    return fmt::format("    full angle {:.6f} deg, diameter {:.6f} mm at the point of the axis\n",
                       *found.full_angle_deg, *found.diameter_mm);
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
  if (found.peak_mm) {
    out += fmt::format(", peak {:.4f} um, valley {:.4f} um", core::micrometres(*found.peak_mm),
                       core::micrometres(*found.valley_mm));
  }
  if (found.rms_mm) out += fmt::format(", rms {:.4f} um", core::micrometres(*found.rms_mm));
  return out + "\n" + place_lines(found) + radii_line(found) + proof_lines(found);
}

std::string sizes_lines(const FitSizes& sizes) {
  constexpr const char* kFelt = ", as felt by the tip";
  std::string out = fmt::format("  sizes of {}, tip diameter {:g} mm\n",
                                sizes.material.inside ? "an inner surface" : "an outer surface",
                                2.0 * sizes.material.tip_radius_mm);
  for (const FitSizes::Global& size : sizes.global) {
    out += size.value_mm ? fmt::format("    {} {:.6f} mm{}\n", size.name, *size.value_mm,
                                       size.felt ? kFelt : "")
                         : fmt::format("    {} does not exist for these points\n", size.name);
  }
  if (!sizes.local_wanted) return out;
  if (!sizes.local) return out + "    LP does not exist for these points\n";
  out += fmt::format("    LP of {} pairs{}\n     ", sizes.local->count, kFelt);
  for (const auto& [name, value] : ranks_by_name(*sizes.local)) {
    out += fmt::format(" {} {:.6f}", name, value);
  }
  return out + " mm\n";
}

}  // namespace

nlohmann::ordered_json fit_json(const FitOutcome& outcome) {
  Json out = {{"shape", outcome.shape}};
  if (!outcome.feature.empty()) out["feature"] = outcome.feature;
  out["points"] = outcome.points;
  out["read"] = outcome.read;
  for (const FitOutcome::Entry& entry : outcome.references) {
    out[entry.name] = entry.found ? reference_json(*entry.found) : Json(nullptr);
  }
  if (outcome.sizes) out["sizes"] = sizes_json(*outcome.sizes);
  out["warnings"] = warnings_json(outcome.warnings);
  return out;
}

std::string fit_table(const FitOutcome& outcome) {
  std::string out =
      fmt::format("{}{}, {} points\n", outcome.shape,
                  outcome.feature.empty() ? std::string() : " " + outcome.feature, outcome.points) +
      wrapped(outcome.read, "  read as ", "    ") + "\n";
  for (const FitOutcome::Entry& entry : outcome.references) out += reference_lines(entry);
  if (outcome.sizes) out += sizes_lines(*outcome.sizes);
  return out + warnings_text(outcome.warnings);
}

}  // namespace rondure::app
