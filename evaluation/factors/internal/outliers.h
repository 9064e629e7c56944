#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/result.h"
#include "core/words.h"
#include "evaluation/factors/points.h"

namespace rondure::evaluation {

/// Rules that find outliers. Each is applied once, to the distances d from the least-squares
/// reference (of each section for RONt) with p parameters.
enum class OutlierRule {
  kNone,
  kThreeSigma,   ///< |d| > 3 s, s^2 = sum d^2 / (n - p).
  kFiveMedians,  ///< beyond_five_scales().
};
inline constexpr std::array kOutlierRules = {OutlierRule::kNone, OutlierRule::kThreeSigma,
                                             OutlierRule::kFiveMedians};

RONDURE_WORDS(OutlierRule, {kNone, "none"}, {kThreeSigma, "3 sigma"}, {kFiveMedians, "5 medians"});

/// The points that remain after a rule was applied.
struct WithoutOutliers {
  FactorPoints points;
  std::size_t left_out = 0;
};
/// @return kOutliers when more than a quarter of the points (of a section) would be removed, since
///         that is form; or the errors of the least-squares fit.
[[nodiscard]] core::Result<WithoutOutliers> without_outliers(const FactorPoints& points,
                                                             OutlierRule rule);

}  // namespace rondure::evaluation
