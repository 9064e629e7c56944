#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/result.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/finding.h"
#include "record/run_record.h"

namespace rondure::evaluation {

struct SharedLines;  // internal/families.h

/// The surfaces of a part in one state of their points, with what was computed of them so far: the
/// call-outs of a drawing have prepared surfaces, generatrices and datums in common. For one thread
/// at a time.
class PartState {
 public:
  /// @param surfaces  Must outlive it, unchanged.
  PartState(std::span<const MeasuredSurface> surfaces);  // NOLINT(google-explicit-constructor)

  operator std::span<const MeasuredSurface>() const {  // NOLINT(google-explicit-constructor)
    return surfaces_;
  }
  [[nodiscard]] std::span<const MeasuredSurface> surfaces() const { return surfaces_; }

  /// As prepared() of the surface.
  [[nodiscard]] const core::Result<PreparedSurface>& prepared(
      std::size_t feature, const record::Indication& indication) const;
  /// The generatrices of the surface that is prepared so.
  [[nodiscard]] SharedLines& lines(std::size_t feature, const record::Indication& indication) const;
  /// Pivots of the searches without proof behind the values found of it.
  void add_pivots(int pivots) const;
  [[nodiscard]] double pivots() const;
  /// As datums_of() of the surfaces.
  [[nodiscard]] const core::Result<std::vector<DatumResult>>& datums(
      std::size_t feature, const record::Characteristic& asked, Proof proof) const;

 private:
  struct Memory;
  std::span<const MeasuredSurface> surfaces_;
  std::shared_ptr<Memory> memory_;
};

}  // namespace rondure::evaluation
