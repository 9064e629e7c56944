#include "evaluation/part/contacts.h"

#include <algorithm>
#include <vector>

#include "core/phrase.h"
#include "core/units.h"
#include "evaluation/part/find.h"

namespace rondure::evaluation {
namespace {

constexpr std::size_t kMostShares = 7;

core::Phrase share_of(std::size_t row, double share_um, double value_um, bool size) {
  if (size) return core::phrase("point {} carries {:.3f} um of the size", row, share_um);
  return core::phrase("point {} carries {:.3f} of {:.3f} um", row, share_um, value_um);
}

}  // namespace

void warn_of_shares(std::span<const MeasuredSurface> part, std::size_t feature,
                    const record::Characteristic& asked, Finding& found) {
  using Outliers = record::Indication::Outliers;
  if (asked.indication.outliers == Outliers::kFiveScales || found.judged.empty()) return;
  const std::vector<std::size_t> rows = outlying_rows(part[feature]);
  std::vector<MeasuredSurface> without(part.begin(), part.end());
  for (std::size_t i = 0; i < std::min(rows.size(), kMostShares); ++i) {
    without[feature] = without_row(part[feature], rows[i]);
    const auto other = find(without, feature, asked);
    if (!other || other->judged.empty()) continue;
    const double value_mm = found.judged.front().value_mm;
    const double share_mm = value_mm - other->judged.front().value_mm;
    found.warnings.push_back(
        error_of(core::Code::kOutliers,
                 share_of(rows[i], share_mm / core::kMicrometre, value_mm / core::kMicrometre,
                          asked.form == record::Form::kDiameter)));
  }
}

}  // namespace rondure::evaluation
