#include "record/run_record.h"

#include <algorithm>

namespace rondure::record {

std::string_view name_of(Shape shape) {
  switch (shape) {
    case Shape::kCylinder:
      return "cylinder";
    case Shape::kCircle:
      return "circle";
    case Shape::kSpindle:
      return "spindle";
    case Shape::kWheel:
      return "wheel";
    case Shape::kContour:
      return "contour";
    case Shape::kRotaryAxes:
      return "rotary_axes";
  }
  return "";
}

bool is_analysis(Shape shape) {
  return shape == Shape::kSpindle || shape == Shape::kWheel || shape == Shape::kContour ||
         shape == Shape::kRotaryAxes;
}

std::string_view name_of(Side side) {
  switch (side) {
    case Side::kOutside:
      return "outside";
    case Side::kInside:
      return "inside";
  }
  return "";
}

std::string_view name_of(Form form) {
  switch (form) {
    case Form::kCylindricity:
      return "cylindricity";
    case Form::kRoundness:
      return "roundness";
    case Form::kRoundnessRms:
      return "roundness-rms";
    case Form::kHarmonicLimits:
      return "harmonic-limits";
    case Form::kMotionTotal:
      return "motion-total";
    case Form::kMotionSynchronous:
      return "motion-synchronous";
    case Form::kMotionAsynchronous:
      return "motion-asynchronous";
    case Form::kRadius:
      return "radius";
    case Form::kRunOut:
      return "run-out";
    case Form::kContourDeviation:
      return "contour-deviation";
    case Form::kContourSpread:
      return "contour-spread";
    case Form::kFixtureResidual:
      return "fixture-residual";
    case Form::kFixtureResidualRms:
      return "fixture-residual-rms";
  }
  return "";
}

std::string_view name_of(Reference reference) {
  switch (reference) {
    case Reference::kLeastSquares:
      return "ls";
    case Reference::kMinimumZone:
      return "mz";
    case Reference::kMinimumCircumscribed:
      return "mc";
    case Reference::kMaximumInscribed:
      return "mi";
  }
  return "";
}

std::string_view name_of(Strategy strategy) {
  switch (strategy) {
    case Strategy::kGuided:
      return "guided";
    case Strategy::kRefined:
      return "refined";
    case Strategy::kAsPublished:
      return "as-published";
    case Strategy::kMerged:
      return "merged";
    case Strategy::kVirtual:
      return "virtual";
    case Strategy::kPointsFile:
      return "points-file";
    case Strategy::kSeries:
      return "series";
    case Strategy::kStations:
      return "stations";
  }
  return "";
}

std::string_view name_of(Touch::Purpose purpose) {
  switch (purpose) {
    case Touch::Purpose::kQualification:
      return "qualification";
    case Touch::Purpose::kLocate:
      return "locate";
    case Touch::Purpose::kMeasure:
      return "measure";
    case Touch::Purpose::kCheck:
      return "check";
  }
  return "measure";
}

std::string_view name_of(Series::Role role) {
  return role == Series::Role::kTruth ? "truth" : "data";
}

std::optional<double> number_in(std::span<const Setting> settings, std::string_view name) {
  for (const Setting& setting : settings) {
    if (setting.name == name && setting.number) return setting.number;
  }
  return std::nullopt;
}

std::optional<std::string> word_in(std::span<const Setting> settings, std::string_view name) {
  for (const Setting& setting : settings) {
    if (setting.name == name && !setting.number) return setting.text;
  }
  return std::nullopt;
}

std::vector<double> numbers_in(std::span<const Setting> settings, std::string_view name) {
  std::vector<double> out;
  for (const Setting& setting : settings) {
    if (setting.name == name && setting.number) out.push_back(*setting.number);
  }
  return out;
}

std::optional<double> Feature::number(std::string_view name) const {
  return number_in(settings, name);
}

std::optional<std::string> Feature::word(std::string_view name) const {
  return word_in(settings, name);
}

std::vector<double> Feature::numbers(std::string_view name) const {
  return numbers_in(settings, name);
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

const Series* RunRecord::data_of(int feature, std::string_view name) const {
  return find_series(series, feature, name, Series::Role::kData);
}

const Series* RunRecord::truth_series_of(int feature, std::string_view name) const {
  return find_series(series, feature, name, Series::Role::kTruth);
}

}  // namespace rondure::record
