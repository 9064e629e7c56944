#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "record/run_record.h"

namespace rondure::reports {

/// How exactly this program can repeat what the run's program computed.
struct Exactness {
  bool same_processor = true;
  bool same_version = true;

  /// Numbers of another kind of processor or of another version may differ by this: mm, um, deg
  /// alike.
  [[nodiscard]] double tolerance() const { return same_processor && same_version ? 0.0 : 1e-9; }
};

/// What comparing stored results found.
struct ResultComparison {
  std::optional<std::string> difference;  ///< The first in words, and how many others.
  std::size_t results = 0;                ///< Compared: stored and computed now.
};

/// Compares the results that a run stored with those that its touches give now, by name. A result
/// of one side only is a difference unless another version measured: versions may give more or
/// fewer numbers.
[[nodiscard]] ResultComparison compare_results(const std::vector<record::StoredResult>& stored,
                                               const std::vector<record::StoredResult>& now,
                                               const Exactness& exactness);

}  // namespace rondure::reports
