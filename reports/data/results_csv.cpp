#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/feature_values.h"
#include "reports/data/csv_field.h"
#include "reports/data/csv_files.h"

namespace rondure::reports {
namespace {

std::string um_field(const std::optional<double>& length_mm) {
  if (!length_mm || !std::isfinite(*length_mm)) return {};
  return core::shortest(*length_mm / core::kMicrometre);
}

}  // namespace

std::string write_results_csv(const record::RunRecord& record,
                              const evaluation::Evaluation& evaluation) {
  const record::Header& header = record.header;
  const std::string head =
      fmt::format("{},{},{},{}", csv_field(header.run_id), csv_field(header.started_utc),
                  csv_field(header.part_id), csv_field(header.serial));
  std::string text =
      "run,started_utc,part,serial,feature,characteristic,symbol,reference,value_um,tolerance_um,"
      "verdict,reason,verification_operator,quoted_um,low_um,high_um\n";
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    for (const evaluation::CharacteristicResult& result : feature.characteristics) {
      const record::Characteristic& asked = result.characteristic;
      const evaluation::UncertaintyStatement* known =
          result.value ? result.value->statement() : nullptr;
      const std::string interval = known == nullptr ? ",,"
                                                    : um_field(known->estimate_mm) + "," +
                                                          um_field(known->low_mm) + "," +
                                                          um_field(known->high_mm);
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", head, csv_field(feature.feature.id),
                          csv_field(asked.id), evaluation::symbol_of(asked),
                          evaluation::reference_of(asked), um_field(result.value_mm()),
                          um_field(asked.tolerance_mm), name_of(result.verdict),
                          csv_field(result.reason),
                          csv_field(result.value ? result.value->operator_text() : ""), interval);
    }
  }
  return text;
}

}  // namespace rondure::reports
