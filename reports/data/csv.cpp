#include "reports/data/writers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/decision/decision.h"
#include "evaluation/part/find.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "reports/escaping.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/messages.h"

namespace rondure::reports {
namespace {

using core::printable;

std::string um_field(const std::optional<double>& length_mm) {
  if (!length_mm || !std::isfinite(*length_mm)) return {};
  return core::shortest(*length_mm / core::kMicrometre);
}

std::string number(double value) { return std::isfinite(value) ? core::shortest(value) : ""; }

/// Whether value and limits are in urad, in columns of their own.
bool is_angle(const record::Characteristic& asked) {
  return evaluation::unit_of(asked) == core::ValueUnit::kUrad;
}

/// Whether a characteristic has two limits, in columns of their own: a size, or a length with a
/// sign.
bool has_two_limits(const record::Characteristic& asked) {
  if (is_angle(asked)) return false;
  return evaluation::unit_of(asked) == core::ValueUnit::kMm || asked.lower_mm;
}

bool any_of(const evaluation::Evaluation& evaluation,
            bool (*holds)(const record::Characteristic& asked)) {
  return std::ranges::any_of(evaluation.features, [&](const evaluation::FeatureResult& feature) {
    return std::ranges::any_of(feature.characteristics,
                               [&](const auto& result) { return holds(result.characteristic); });
  });
}

std::string limit_field(core::ValueUnit unit, const std::optional<double>& limit_mm) {
  const auto limit = limit_in(unit, limit_mm);
  return limit ? number(*limit) : "";
}

/// "tolerance_um": empty of a size, whose limits are in columns of their own.
std::string tolerance_field(const record::Feature& feature, const record::Characteristic& asked) {
  if (has_two_limits(asked) || is_angle(asked)) return {};
  // that of a form without filter and window keeps the digits of earlier versions
  return evaluation::is_found(feature, asked)
             ? limit_field(core::ValueUnit::kUm, asked.tolerance_mm)
             : um_field(asked.tolerance_mm);
}

/// ",lower_limit_mm,upper_limit_mm" of a run with sizes.
std::string size_fields(const record::Characteristic& asked) {
  if (!has_two_limits(asked)) return ",,";
  return "," + limit_field(core::ValueUnit::kMm, asked.lower_mm) + "," +
         limit_field(core::ValueUnit::kMm, asked.tolerance_mm);
}

/// ",quoted,low,high": the quoted value and the interval, of a bound its one end.
std::string interval_fields(const evaluation::CharacteristicResult& result) {
  const evaluation::UncertaintyStatement* known =
      result.value ? result.value->statement() : nullptr;
  if (known == nullptr) return ",,,";
  const bool at_least = result.value->bound() == evaluation::StatedValue::Bound::kLower;
  return "," + (is_bound(*result.value) ? "" : um_field(result.value->quoted_mm())) + "," +
         (known->at_most ? "" : um_field(known->low_mm)) + "," +
         (at_least ? "" : um_field(known->high_mm));
}

/// ",value_urad,quoted_urad,low_urad,high_urad,lower_limit_urad,upper_limit_urad" of a run with
/// angles.
std::string angle_fields(const evaluation::CharacteristicResult& result) {
  const record::Characteristic& asked = result.characteristic;
  if (!is_angle(asked)) return ",,,,,,";
  const auto unit = core::ValueUnit::kUrad;
  return "," + um_field(result.value_mm()) + interval_fields(result) + "," +
         limit_field(unit, asked.lower_mm) + "," + limit_field(unit, asked.tolerance_mm);
}

bool has_own_rule(const record::Characteristic& asked) {
  return asked.indication.decision_rule.has_value();
}

/// The rule that a characteristic was judged by, as a plan spells it.
std::string_view rule_field(const evaluation::Evaluation& evaluation,
                            const record::Characteristic& asked) {
  const auto& own = asked.indication.decision_rule;
  if (own) return name_of(evaluation::rule_of(*own).kind);
  return evaluation.rule ? name_of(evaluation.rule->kind) : std::string_view();
}

/// "layer,height_mm,angle_deg,radius_mm" of a local value; the three that it has not are empty.
std::string place_fields(const evaluation::LocalValue& local) {
  using Place = evaluation::LocalValue::Place;
  switch (local.place) {
    case Place::kLayer:
      return fmt::format("{},{},,", local.layer, number(local.position));
    case Place::kAngle:
      return ",," + number(core::degrees(local.position)) + ",";
    case Place::kRadius:
      return ",,," + number(local.position);
  }
  return ",,,";
}

std::string measured(const std::optional<double>& value) { return value ? number(*value) : ""; }

}  // namespace

std::string write_results_csv(const record::RunRecord& record,
                              const evaluation::Evaluation& evaluation) {
  const record::Header& header = record.header;
  const std::string head =
      fmt::format("{},{},{},{}", csv_field(header.run_id), csv_field(header.started_utc),
                  csv_field(header.part_id), csv_field(header.serial));
  std::string text =
      "run,started_utc,part,serial,feature,characteristic,symbol,reference,value_um,tolerance_um,"
      "verdict,reason,verification_operator,quoted_um,low_um,high_um";
  const bool sizes = any_of(evaluation, has_two_limits);
  const bool angles = any_of(evaluation, is_angle);
  const bool rules = any_of(evaluation, has_own_rule);
  if (sizes) text += ",lower_limit_mm,upper_limit_mm";
  if (angles)
    text += ",value_urad,quoted_urad,low_urad,high_urad,lower_limit_urad,upper_limit_urad";
  text += rules ? ",decision_rule\n" : "\n";
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    for (const evaluation::CharacteristicResult& result : feature.characteristics) {
      const record::Characteristic& asked = result.characteristic;
      const bool angle = is_angle(asked);
      text += fmt::format("{},{},{},{},{},{},{},{},{},{}{}", head, csv_field(feature.feature.id),
                          csv_field(asked.id), evaluation::symbol_of(asked),
                          evaluation::reference_of(asked), angle ? "" : um_field(result.value_mm()),
                          tolerance_field(feature.feature, asked), name_of(result.verdict),
                          csv_field(result.reason.english()),
                          csv_field(result.value ? result.value->operator_text().english() : ""),
                          angle ? ",,," : interval_fields(result));
      if (sizes) text += size_fields(asked);
      if (angles) text += angle_fields(result);
      if (rules) text += fmt::format(",{}", rule_field(evaluation, asked));
      text += "\n";
    }
  }
  return text;
}

std::string write_sections_csv(const record::RunRecord& record,
                               const evaluation::Evaluation& evaluation) {
  std::string text =
      "run,feature,characteristic,symbol,layer,height_mm,angle_deg,radius_mm,value_um,least_um,"
      "reason\n";
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    for (const evaluation::CharacteristicResult& result : feature.characteristics) {
      if (!result.finding) continue;
      const std::string head = fmt::format(
          "{},{},{},{}", csv_field(record.header.run_id), csv_field(feature.feature.id),
          csv_field(result.characteristic.id), evaluation::symbol_of(result.characteristic));
      for (const evaluation::LocalValue& local : result.finding->local) {
        text += fmt::format("{},{},{},{},{}\n", head, place_fields(local),
                            local.none ? "" : um_field(local.value_mm), um_field(local.least_mm),
                            local.none ? csv_field(local.none->what) : "");
      }
    }
  }
  return text;
}

std::string write_series_csv(const record::RunRecord& record) {
  std::string text = fmt::format("# rondure series, run {}\n", printable(record.header.run_id));
  text += "feature,series,row,column,value\n";
  for (const record::Series& series : record.series) {
    if (series.role == record::Series::Role::kTruth) continue;
    const std::string head =
        csv_field(record.features[static_cast<std::size_t>(series.feature)].id) + "," +
        csv_field(series.name);
    const std::size_t columns = series.columns.size();
    for (std::size_t i = 0; i < series.values.size(); ++i) {
      text += fmt::format("{},{},{},{}\n", head, i / columns,
                          csv_field(series.columns[i % columns].name),
                          core::shortest(series.values[i]));
    }
  }
  return text;
}

std::string write_touches_csv(const record::RunRecord& record) {
  std::map<int, std::string> feature_of_pose;
  for (const record::PoseVisit& pose : record.poses) {
    const auto index = static_cast<std::size_t>(pose.feature);
    if (pose.feature >= 0 && index < record.features.size()) {
      feature_of_pose[pose.id] = csv_field(record.features[index].id);
    }
  }
  std::string text = fmt::format("# rondure touches, run {}\n", printable(record.header.run_id));
  text +=
      "id,purpose,feature,pose,layer,point,repeat,x_mm,y_mm,z_mm,dir_x,dir_y,dir_z,"
      "temperature_degC,time_s,scale_temperature_degC\n";
  for (const record::Touch& touch : record.touches) {
    const auto feature = feature_of_pose.find(touch.pose);
    text += fmt::format("{},{},{},{},{},{},{}", touch.id, record::name_of(touch.purpose),
                        feature == feature_of_pose.end() ? "" : feature->second, touch.pose,
                        touch.layer, touch.point, touch.repeat);
    for (const double value : {touch.tip_mm.x(), touch.tip_mm.y(), touch.tip_mm.z(),
                               touch.approach.x(), touch.approach.y(), touch.approach.z()}) {
      text += ',';
      text += number(value);
    }
    text += fmt::format(",{},{},{}\n", measured(touch.temperature_degC), number(touch.time_s),
                        measured(touch.scale_temperature_degC));
  }
  return text;
}

}  // namespace rondure::reports
