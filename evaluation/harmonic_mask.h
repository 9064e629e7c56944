#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

/// The amplitude of one undulation in the section where it is largest.
struct SectionHarmonic {
  int number = 0;
  int layer = 0;
  double amplitude_mm = 0.0;
};

/// The harmonics of a feature's dense sections, each where it is largest, by number from 1; empty
/// when no section is dense enough for a filter (350 points).
[[nodiscard]] std::vector<SectionHarmonic> worst_harmonics(const FeatureResult& feature);

/// One harmonic against its limit.
struct MaskedHarmonic {
  SectionHarmonic harmonic;
  double limit_mm = 0.0;

  [[nodiscard]] bool exceeds() const { return harmonic.amplitude_mm > limit_mm; }
};

/// Every harmonic that the mask of a characteristic names, by number; where lines overlap, against
/// the least limit.
[[nodiscard]] std::vector<MaskedHarmonic> against_mask(const FeatureResult& feature,
                                                       const record::Characteristic& asked);

/// The harmonic that is nearest to its limit, or farthest beyond it.
/// @return kSampling when no section is dense, or when the mask reaches above the highest harmonic
///         that the points of every section resolve.
[[nodiscard]] core::Result<MaskedHarmonic> nearest_to_mask(const FeatureResult& feature,
                                                           const record::Characteristic& asked);

}  // namespace rondure::evaluation
