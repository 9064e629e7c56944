#include "evaluation/internal/file_digits.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rondure::evaluation {
namespace {

constexpr double kInch_mm = 25.4;
constexpr double kRoundOff_1 = 1e-12;  // of a coordinate that was read and brought to mm
constexpr double kWidest_mm = 0.05;
constexpr double kFinest_mm = 0.99e-4;
constexpr std::size_t kLeastNumbers = 12;  // fewer may be whole by chance

bool all_whole(const std::vector<double>& numbers_mm, double step_mm) {
  return std::ranges::all_of(numbers_mm, [&](double number_mm) {
    const double steps = number_mm / step_mm;
    return std::abs(steps - std::round(steps)) <= kRoundOff_1 * std::abs(steps) + 1e-9;
  });
}

}  // namespace

double step_of_file_mm(const record::RunRecord& record, const std::string& feature) {
  std::vector<bool> of_feature;
  for (const record::PoseVisit& visit : record.poses) {
    if (visit.id < 0) continue;
    const auto id = static_cast<std::size_t>(visit.id);
    if (of_feature.size() <= id) of_feature.resize(id + 1, false);
    of_feature[id] = record.features[static_cast<std::size_t>(visit.feature)].id == feature;
  }
  std::vector<double> numbers_mm;
  for (const record::Touch& touch : record.touches) {
    const auto id = static_cast<std::size_t>(touch.pose);
    if (touch.pose < 0 || id >= of_feature.size() || !of_feature[id]) continue;
    for (const double number : touch.tip_mm) {
      if (number != 0.0) numbers_mm.push_back(number);
    }
  }
  if (numbers_mm.size() < kLeastNumbers) return 0.0;
  double widest_mm = 0.0;
  for (const double unit_mm : {1.0, kInch_mm}) {
    for (double step_mm = unit_mm; step_mm >= std::max(kFinest_mm, widest_mm); step_mm *= 0.1) {
      if (all_whole(numbers_mm, step_mm)) widest_mm = step_mm;
    }
  }
  return widest_mm <= kWidest_mm ? widest_mm : 0.0;
}

}  // namespace rondure::evaluation
