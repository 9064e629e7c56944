#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/contour/internal/curve_model.h"
#include "evaluation/contour/internal/curves.h"
#include "evaluation/uncertainty/curve_trials.h"

namespace rondure::evaluation::contour_trials {

/// Draws of curves whose noise is independent from part to part. The noise is known before the
/// filter, where all orders have the same: the filter acts on the draws.
class NoisyCurves {
 public:
  /// @param u_mm  Of a coefficient before the filter, one for each part; 0: known exactly.
  NoisyCurves(const Basis& basis, Curves measured, std::vector<double> u_mm, std::uint64_t seed,
              const std::string& id);

  /// 2-7, 8-15, 16-31, ...
  static int octave(int order) { return order < 8 ? 0 : std::ilogb(order) - 2; }

  [[nodiscard]] Curves draw(int trial) const {
    return each([&](const CurveDraws& draws) { return draws.draw(trial); });
  }
  [[nodiscard]] Curves core_draw(int trial) const {
    return each([&](const CurveDraws& draws) { return draws.core_draw(trial); });
  }
  [[nodiscard]] Curves center() const {
    return each([](const CurveDraws& draws) { return draws.core_mm(); });
  }
  /// The noise alone, for a budget.
  void add_noise(int trial, Curves& curves) const;

 private:
  template <class Of>
  [[nodiscard]] Curves each(const Of& of) const {
    Curves out = measured_;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!draws_[i]) continue;
      out[i] = of(*draws_[i]);
      for (std::size_t j = 0; j < basis_.size(); ++j) out[i][j] *= basis_.transmission[j];
    }
    return out;
  }

  Basis basis_;
  Curves measured_;
  std::vector<double> u_mm_;
  std::uint64_t seed_ = 0;
  std::string id_;
  std::vector<std::optional<CurveDraws>> draws_;
};

/// The model of measured curves with this noise alone; `name` is the row of the budget.
CurveModel model_of(Curves measured, std::shared_ptr<const NoisyCurves> noise, std::string name);

}  // namespace rondure::evaluation::contour_trials
