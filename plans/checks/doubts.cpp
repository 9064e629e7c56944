#include "plans/checks/doubts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "plans/analyses/features.h"
#include "plans/path/solid_mesh.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

/// No machine that touches surfaces judges less [um]. An air-bearing spindle may be held to 10 nm,
/// so analyses are not doubted.
constexpr double kLeastLimit_um = 0.05;
constexpr double kLeastDeviation_um = 0.5;  // tolerance classes of sizes begin at IT01, 0.3 um wide

/// A limit that reads like mm; none: the limit is plausible.
std::optional<core::Error> doubt(std::string where, std::optional<double> limit_um,
                                 double least_um) {
  if (!limit_um || *limit_um == 0.0 || std::abs(*limit_um) >= least_um) return {};
  return core::Error{core::Code::kMeaning,
                     fmt::format("{} um is {:g} nm; was {} um ({} mm) meant?", plain(*limit_um),
                                 1e3 * *limit_um, plain(1e3 * *limit_um), plain(*limit_um)),
                     std::move(where)};
}

/// Limits of a size that are the size, in mm or um, and no deviations from the nominal one.
std::optional<core::Error> doubt(const record::CharacteristicTask& asked, double nominal_mm,
                                 const std::string& where) {
  constexpr double kNear = 0.02;  // of the nominal diameter
  if (!(nominal_mm > 0.0) || !asked.lower_um || !asked.upper_um) return {};
  for (const double in_mm : {1e3, 1.0}) {
    const auto deviation_um = [&](double limit) { return in_mm * limit - 1e3 * nominal_mm; };
    const double lower_um = deviation_um(*asked.lower_um);
    const double upper_um = deviation_um(*asked.upper_um);
    if (std::max(std::abs(lower_um), std::abs(upper_um)) > kNear * 1e3 * nominal_mm) continue;
    return core::Error{
        core::Code::kMeaning,
        fmt::format("{} and {} read like the size itself; limits are deviations from the nominal "
                    "diameter of {} mm: were {:.6g} and {:.6g} um meant?",
                    plain(*asked.lower_um), plain(*asked.upper_um), plain(nominal_mm), lower_um,
                    upper_um),
        where + "/lower_um"};
  }
  return {};
}

/// The features of the plan that a datum names, where all of them are touched cylinders or circles:
/// their nominal axis is part z.
bool is_axis_of_part(const Plan& plan, std::string_view datum) {
  const auto named = [&](std::string_view name) {
    return std::ranges::any_of(plan.features, [&](const FeaturePlan& feature) {
      const bool round =
          feature.type == record::Shape::kCylinder || feature.type == record::Shape::kCircle;
      return round && is_touched(feature) && (feature.letter == name || feature.id == name);
    });
  };
  if (named(datum)) return true;
  const std::size_t hyphen = datum.find('-');
  return hyphen != std::string_view::npos && named(datum.substr(0, hyphen)) &&
         named(datum.substr(hyphen + 1));
}

/// A second datum axis that lies on the first one.
std::optional<core::Error> doubt(const Plan& plan, const std::vector<std::string>& datums,
                                 const std::string& where) {
  const auto axis = [&](const std::string& datum) { return is_axis_of_part(plan, datum); };
  const auto first = std::ranges::find_if(datums, axis);
  if (first == datums.end()) return {};
  const auto second = std::find_if(first + 1, datums.end(), axis);
  if (second == datums.end()) return {};
  return core::Error{
      core::Code::kMeaning,
      fmt::format("the axis of {1} lies on that of {0}, so {1} locks nothing that {0} leaves free; "
                  "was the common datum \"{2}-{3}\" meant?",
                  in_quotes(*first), in_quotes(*second), *first, *second),
      item_pointer(where, static_cast<std::size_t>(second - datums.begin()))};
}

/// A surface of a file in an unlikely unit: paths would pass through the real one.
std::optional<core::Error> doubt(const BodyPlan& body, const std::string& where) {
  constexpr double kSmallest_mm = 15.0;
  constexpr double kGreatest_mm = 1000.0;
  if (body.file.empty()) return std::nullopt;
  Eigen::AlignedBox3d all;
  for (const Eigen::Vector3d& point : body.mesh->points_mm()) all.extend(point);
  const double size_mm = all.sizes().maxCoeff();
  const bool in_inches = body.unit == record::LengthUnit::kInch;
  if (in_inches ? size_mm <= kGreatest_mm : size_mm >= kSmallest_mm) return std::nullopt;
  const double other_mm = in_inches ? size_mm / 25.4 : size_mm * 25.4;
  return core::Error{
      core::Code::kUnits,
      fmt::format("{} is {:.4g} mm across; were {} meant? Then it is {:.4g} mm", body.file, size_mm,
                  in_inches ? "millimetres" : "inches", other_mm),
      where};
}

}  // namespace

std::vector<core::Error> doubts_of(const Plan& plan) {
  std::vector<core::Error> out;
  const auto add = [&](std::optional<core::Error> found) {
    if (found) out.push_back(*std::move(found));
  };
  const bool writes_corrections =
      std::ranges::find(plan.reports.formats, name_of(record::Format::kCorrections)) !=
      plan.reports.formats.end();
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const FeaturePlan& feature = plan.features[i];
    if (feature.wheel && feature.wheel->program && !writes_corrections) {
      add(core::Error{
          core::Code::kMeaning,
          "the program is written only with --format corrections: reports.formats has no "
          "\"corrections\"; was it meant to be there?",
          feature_pointer(i) + "/wheel/program"});
    }
    if (record::is_analysis(feature.type)) continue;
    for (std::size_t k = 0; k < feature.characteristics.size(); ++k) {
      const record::CharacteristicTask& asked = feature.characteristics[k];
      const std::string where = item_pointer(feature_pointer(i) + "/characteristics", k);
      add(doubt(where + "/tolerance_um", asked.tolerance_um, kLeastLimit_um));
      add(doubt(where + "/lower_um", asked.lower_um, kLeastDeviation_um));
      add(doubt(where + "/upper_um", asked.upper_um, kLeastDeviation_um));
      add(doubt(asked, feature.nominal.diameter_mm, where));
      add(doubt(plan, asked.indication.datum, where + "/datum"));
    }
  }
  constexpr std::size_t kPlacesOfAPlane = 3;
  if (plan.fixture && plan.fixture->datum && plan.fixture->datum->seat.size() == kPlacesOfAPlane) {
    add(core::Error{core::Code::kMeaning,
                    "three places always lie in a plane: dirt under one of them tilts the base, "
                    "and nothing shows it; was a fourth place meant?",
                    "/fixture/datum/seat"});
  }
  const std::size_t bodies = plan.fixture ? plan.fixture->bodies.size() : 0;
  for (std::size_t i = 0; i < bodies; ++i) {
    const BodyPlan& body = plan.fixture->bodies[i];
    if (!body.mesh) continue;
    add(doubt(body, item_pointer("/fixture/bodies", i) + "/unit"));
    if (body.mesh->is_closed()) continue;
    out.push_back({core::Code::kMeaning,
                   fmt::format("{} has gaps: paths keep away from its surface, but a tool that is "
                               "inside is not seen; was a closed solid meant?",
                               body.file),
                   item_pointer("/fixture/bodies", i) + "/file"});
  }
  return out;
}

}  // namespace rondure::plans
