#include <fmt/format.h>

#include "core/numbers.h"
#include "core/utf8.h"
#include "reports/data/csv_field.h"
#include "reports/data/csv_files.h"

namespace rondure::reports {

using core::printable;

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

}  // namespace rondure::reports
