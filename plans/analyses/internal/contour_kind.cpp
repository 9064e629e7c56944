#include "plans/analyses/internal/kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "fit/contour/crank_motion.h"
#include "fit/profiles/profile_filter.h"
#include "plans/analyses/contour_columns.h"
#include "plans/contour_plan.h"
#include "plans/schema/internal/setting_list.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;

constexpr std::array kContourForms = {record::Form::kContourDeviation, record::Form::kContourSpread,
                                      record::Form::kHarmonicLimits,
                                      record::Form::kFollowingDeviation};
constexpr std::array<record::WantedColumn, 2> kTable = {{{"c_deg"}, {"x_um"}}};

core::Result<record::Series> trace_of(const record::ContourTask& task, std::string_view text,
                                      const std::string& name) {
  TRY(auto trace, read_trace(text, name, task.columns));
  if (trace.positions && task.error != record::ContourTask::Error::kActualMinusCommand) {
    return core::fail_with(Code::kMeaning,
                           "{}: commanded and actual positions give actual minus command: say "
                           "error actual-minus-command",
                           name);
  }
  return std::move(trace.series);
}

std::vector<SeriesFile> contour_files(const FeaturePlan& feature) {
  std::vector<SeriesFile> out;
  if (!feature.contour) return out;
  const auto add = [&](std::size_t part, std::string_view key, const std::string& file) {
    SeriesFile one;
    one.series = fmt::format("{} {}", key, part + 1);
    one.file = file;
    one.where = fmt::format("/contour/parts/{}/{}", part, key);
    one.read = [task = *feature.contour, kind = std::string(key)](
                   std::string_view text, const std::string& name) -> core::Result<record::Series> {
      if (kind == "axes") return trace_of(task, text, name);
      return read_gauge(text, name, kind == "main", task.columns);
    };
    out.push_back(std::move(one));
  };
  for (std::size_t i = 0; i < feature.contour->parts.size(); ++i) {
    const record::ContourPartTask& part = feature.contour->parts[i];
    if (!part.axes.empty()) add(i, "axes", part.axes);
    add(i, "pin", part.pin);
    if (!part.main.empty()) add(i, "main", part.main);
  }
  if (const auto& repeat = feature.contour->repeat; repeat && !repeat->table.empty()) {
    SeriesFile table;
    table.series = "table";
    table.file = repeat->table;
    table.where = "/contour/repeat/table";
    table.wanted.assign(kTable.begin(), kTable.end());
    out.push_back(std::move(table));
  }
  return out;
}

/// f needs the traces of a part, or its main journal.
void check_separation(const record::ContourTask& plan, const std::string& where,
                      Findings& findings) {
  using Separation = record::ContourTask::Separation;
  const auto traced = [](const record::ContourPartTask& part) { return !part.axes.empty(); };
  const bool indirect =
      plan.separation == Separation::kIndirect ||
      (plan.separation == Separation::kAuto && std::ranges::none_of(plan.parts, traced));
  const bool from_files = !plan.parts.empty();
  for (std::size_t i = 0; i < plan.parts.size(); ++i) {
    const record::ContourPartTask& part = plan.parts[i];
    const std::string place = fmt::format("{}/parts/{}/", where, i);
    if (indirect && part.main.empty()) {
      findings.meaning(Code::kMissingKey, place + "main",
                       "without traces f is t less the main journal: give the file of the main "
                       "journal, or of the traces (axes)");
    } else if (!indirect && part.axes.empty()) {
      findings.meaning(Code::kMissingKey, place + "axes",
                       "f is read from traces of the axes, of every part: give the file, or say "
                       "separation indirect");
    } else if (plan.separation == Separation::kIndirect && traced(part)) {
      findings.meaning(Code::kMeaning, place + "axes",
                       "has no effect: separation is indirect; remove one of them");
    }
  }
  if ((from_files ? indirect : plan.separation == Separation::kIndirect) &&
      plan.method == record::ContourTask::Method::kAsPublished) {
    findings.meaning(Code::kMeaning, where + "/method",
                     "as-published turns what traces give, and there are none; take corrected");
  }
}

void check_columns(const record::ContourTask& plan, const std::string& where, Findings& findings) {
  for (std::size_t i = 0; i < plan.columns.size(); ++i) {
    const record::ContourColumnTask& column = plan.columns[i];
    const std::string place = item_pointer(where + "/columns", i);
    if (const auto checked = check_column(column); !checked) {
      findings.meaning(Code::kMeaning, place, checked.error().what);
    }
    const auto first =
        std::ranges::find(plan.columns, column.quantity, &record::ContourColumnTask::quantity);
    if (static_cast<std::size_t>(first - plan.columns.begin()) != i) {
      findings.meaning(Code::kMeaning, place + "/quantity",
                       "names this quantity a second time; remove one");
    }
  }
  if (!plan.columns.empty() && plan.parts.empty()) {
    findings.meaning(Code::kMeaning, where + "/columns",
                     "has no effect: simulated parts have no files; remove it");
  }
}

void check_correction(const record::ContourCorrectionTask& plan, const std::string& where,
                      Findings& findings) {
  if (std::abs(plan.rows() * plan.step_deg - 360.0) > 1e-6) {
    findings.meaning(Code::kMeaning, where + "/step_deg",
                     "a turn is no whole number of steps: take a divisor of 360 deg");
  } else if (2 * plan.highest_order >= plan.rows()) {
    findings.meaning(
        Code::kSampling, where + "/highest_order",
        fmt::format("{} rows hold orders up to {}: take a lower one, or a smaller step",
                    plan.rows(), (plan.rows() - 1) / 2));
  }
}

void check_contour(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  const record::ContourTask& plan = *feature.contour;
  if (plan.correction) check_correction(*plan.correction, where + "/correction", findings);
  check_separation(plan, where, findings);
  check_columns(plan, where, findings);
  if (plan.repeat && plan.repeat->table.empty() != plan.parts.empty()) {
    findings.meaning(plan.parts.empty() ? Code::kMeaning : Code::kMissingKey,
                     where + "/repeat/table",
                     plan.parts.empty()
                         ? "has no effect: simulated parts are ground with the correction that the "
                           "simulated feature gave; remove it"
                         : "this key is missing: the correction as the control had it loaded");
  }
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
  } else if (findings.is_given(where + "/cutoff_upr")) {
    findings.meaning(Code::kMeaning, where + "/cutoff_upr",
                     "has no effect: the filter is \"none\"; remove it");
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
