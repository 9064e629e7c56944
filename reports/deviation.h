#pragma once

#include "core/result.h"
#include "record/run_record.h"
#include "reports/evaluation.h"

namespace rondure::reports {

/// A form deviation of an evaluated feature, and what stands behind it.
struct Deviation {
  double value_mm = 0.0;
  bool certified = true;   ///< A certificate stands behind the reference; least squares needs none.
  bool exact_fit = false;  ///< 0 by construction.
  const LayerResult* layer = nullptr;  ///< RONt: the section it is of.
  /// Widest part of the turn without a point, where it is too wide for a value: above 90 deg, and
  /// above one and a half steps of evenly spread points. Else 0.
  double unseen_rad = 0.0;
};

/// CYLt about a reference. Without that reference: why there is none.
[[nodiscard]] core::Result<Deviation> cylinder_deviation(const FeatureResult& result,
                                                         record::Reference reference);

/// RONt about a reference, the largest of the sections; one that lacks the reference leaves none.
[[nodiscard]] core::Result<Deviation> worst_section(const FeatureResult& result,
                                                    record::Reference reference);

}  // namespace rondure::reports
