#include "record/run_record.h"

#include <algorithm>

namespace rondure::record {

bool is_analysis(Shape shape) {
  return shape == Shape::kSpindle || shape == Shape::kWheel || shape == Shape::kContour ||
         shape == Shape::kRotaryAxes || shape == Shape::kFiveAxis;
}

std::optional<std::vector<double>> Series::column(std::string_view wanted) const {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const SeriesColumn& column) {
    return column.name == wanted;
  });
  if (found == columns.end()) return std::nullopt;
  std::vector<double> out;
  out.reserve(rows());
  for (auto i = static_cast<std::size_t>(found - columns.begin()); i < values.size();
       i += columns.size()) {
    out.push_back(values[i]);
  }
  return out;
}

namespace {

const Series* find_series(const std::vector<Series>& all, int feature, std::string_view name,
                          Series::Role role) {
  for (const Series& series : all) {
    if (series.feature == feature && series.name == name && series.role == role) return &series;
  }
  return nullptr;
}

}  // namespace

void take(Decision decision, RunRecord& record) {
  if (decision.message.code == core::MessageCode::kCorrectionLoaded && decision.feature >= 0) {
    record.features[static_cast<std::size_t>(decision.feature)].points_sha256 =
        decision.message.text(1);
  }
  record.decisions.push_back(std::move(decision));
}

const Series* RunRecord::data_of(int feature, std::string_view name) const {
  return find_series(series, feature, name, Series::Role::kData);
}

const Series* RunRecord::truth_series_of(int feature, std::string_view name) const {
  return find_series(series, feature, name, Series::Role::kTruth);
}

}  // namespace rondure::record
