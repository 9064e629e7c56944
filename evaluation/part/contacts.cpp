#include "evaluation/part/contacts.h"

#include <algorithm>
#include <vector>

#include "core/phrase.h"
#include "core/units.h"
#include "evaluation/part/find.h"

namespace rondure::evaluation {
namespace {

constexpr std::size_t kMostShares = 7;

core::Phrase share_of(std::span<const std::size_t> rows, double share_um, double value_um,
                      bool size) {
  if (rows.size() > 1 && size) {
    return core::phrase("these {} points together carry {:.3f} um of the size", rows.size(),
                        share_um);
  }
  if (rows.size() > 1) {
    return core::phrase("these {} points together carry {:.3f} of {:.3f} um", rows.size(), share_um,
                        value_um);
  }
  if (size) return core::phrase("point {} carries {:.3f} um of the size", rows[0], share_um);
  return core::phrase("point {} carries {:.3f} of {:.3f} um", rows[0], share_um, value_um);
}

}  // namespace

void warn_of_shares(std::span<const MeasuredSurface> part, std::size_t feature,
                    const record::Characteristic& asked, Finding& found) {
  using Outliers = record::Indication::Outliers;
  if (asked.indication.outliers == Outliers::kFiveScales || found.judged.empty()) return;
  const std::vector<std::size_t> rows = outlying_rows(part[feature]);
  std::vector<MeasuredSurface> without(part.begin(), part.end());
  const auto say = [&](std::span<const std::size_t> some) {
    without[feature] = without_rows(part[feature], some);
    const auto other = find(without, feature, asked);
    if (!other || other->judged.empty()) return;
    const double value_mm = found.judged.front().value_mm;
    const double share_mm = value_mm - other->judged.front().value_mm;
    found.warnings.push_back(
        error_of(core::Code::kOutliers,
                 share_of(some, share_mm / core::kMicrometre, value_mm / core::kMicrometre,
                          asked.form == record::Form::kDiameter)));
  };
  for (std::size_t i = 0; i < std::min(rows.size(), kMostShares); ++i) say({&rows[i], 1});
  if (rows.size() > 1) say(rows);  // each may hide behind the others
}

void warn_of_shares(std::span<const MeasuredSurface> part, std::size_t index,
                    const record::Characteristic& asked, FeatureResult& feature) {
  if (feature.failure || outlying_rows(part[index]).empty()) return;
  const std::span<const MeasuredSurface> alone = part.subspan(index, 1);
  auto found = find(alone, 0, asked, Proof::kNone);
  if (!found) return;
  warn_of_shares(alone, 0, asked, *found);
  for (core::Error& warning : found->warnings) {
    const bool known = std::ranges::any_of(
        feature.warnings, [&](const core::Error& one) { return one.what == warning.what; });
    if (warning.code == core::Code::kOutliers && !known)
      feature.warnings.push_back(std::move(warning));
  }
}

}  // namespace rondure::evaluation
