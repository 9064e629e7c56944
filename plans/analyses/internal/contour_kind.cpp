#include "plans/analyses/internal/contour_kind.h"

#include <array>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "fit/contour/crank_motion.h"
#include "fit/profiles/profile_filter.h"
#include "plans/schema/contour_table.h"
#include "plans/schema/internal/setting_list.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;

constexpr std::array kContourForms = {record::Form::kContourDeviation, record::Form::kContourSpread,
                                      record::Form::kHarmonicLimits};
constexpr std::array<record::WantedColumn, 4> kAxes = {
    {{"c_deg"}, {"c_error_deg"}, {"x_error_mm"}, {"d_cmd_mm", false}}};
constexpr std::array<record::WantedColumn, 2> kGauge = {{{"angle_deg"}, {"deviation_um"}}};

std::vector<SeriesFile> contour_files(const FeaturePlan& feature) {
  std::vector<SeriesFile> out;
  if (!feature.contour) return out;
  const auto add = [&](std::size_t part, std::string_view key, const std::string& file,
                       std::span<const record::WantedColumn> wanted) {
    SeriesFile one;
    one.series = fmt::format("{} {}", key, part + 1);
    one.file = file;
    one.where = fmt::format("/contour/parts/{}/{}", part, key);
    one.wanted.assign(wanted.begin(), wanted.end());
    out.push_back(std::move(one));
  };
  for (std::size_t i = 0; i < feature.contour->parts.size(); ++i) {
    const record::ContourPartTask& part = feature.contour->parts[i];
    add(i, "axes", part.axes, kAxes);
    add(i, "pin", part.pin, kGauge);
    if (!part.main.empty()) add(i, "main", part.main, kGauge);
  }
  return out;
}

void check_contour(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  const record::ContourTask& plan = *feature.contour;
  if (feature.source) {
    findings.meaning(Code::kMeaning, where.substr(0, where.rfind('/')) + "/source",
                     "has no effect: the files of a contour stand in contour/parts; remove it");
  }
  if (plan.wheel_radius_from && findings.is_given(where + "/wheel_radius_mm")) {
    findings.meaning(Code::kMeaning, where + "/wheel_radius_mm",
                     "the wheel radius is that of an earlier feature (wheel_radius_from); remove "
                     "one");
  }
  const fit::CrankGeometry geometry = {plan.crank_radius_mm, plan.wheel_radius_mm,
                                       plan.pin_radius_mm};
  // A measured radius is checked with the geometry once it is there.
  if (const auto checked = fit::check_geometry(geometry); !checked && !plan.wheel_radius_from) {
    findings.meaning(checked.error().code, where + "/crank_radius_mm", checked.error().what);
  }
  if (plan.filter != record::ContourTask::Filter::kNone) {
    fit::FilterOptions filter;
    filter.cutoff_upr = plan.cutoff_upr;
    const auto sampling = fit::check_sampling(static_cast<std::size_t>(plan.samples), filter);
    if (!sampling) {
      findings.meaning(sampling.error().code, where + "/cutoff_upr", sampling.error().what);
    }
  }
}

}  // namespace

const AnalysisKind& contour_kind() {
  static constexpr AnalysisKind kKind = {.type = "contour",
                                         .shape = record::Shape::kContour,
                                         .forms = kContourForms,
                                         .is_simulated = simulates<&SimulationPlan::contour>,
                                         .settings = settings_of_section<&FeaturePlan::contour>,
                                         .files = contour_files,
                                         .check = check_contour,
                                         .simulate = simulate_contour};
  return kKind;
}

}  // namespace rondure::plans
