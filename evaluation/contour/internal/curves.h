#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/results/stated_value.h"
#include "evaluation/uncertainty/curve_trials.h"
#include "evaluation/uncertainty/influences.h"
#include "fit/contour/study.h"
#include "record/tasks/analysis_influences.h"

namespace rondure::evaluation::contour_trials {

// Curves of a contour by their harmonics from 2 up to where the filter transmits 1 %, and the
// numbers read from them. What lies above moves no value by more than that share of the noise.

/// Highest order that a curve holds, whatever the filter transmits.
inline constexpr int kHighestOrder = 720;

/// Harmonics 2 .. highest of each part: a2, b2, a3, b3, ...
using Curves = std::vector<std::vector<double>>;

/// Where the curves are known: up to which order, and what the filter leaves of each.
struct Basis {
  explicit Basis(const fit::ContourStudyOptions& options);

  [[nodiscard]] std::vector<double> of(std::span<const double> error_mm) const {
    return fit::contour_coefficients(error_mm, highest);
  }
  [[nodiscard]] double range(const std::vector<double>& curve) const {
    return fit::peak_to_valley(fit::contour_of(curve, points));
  }
  [[nodiscard]] std::size_t size() const { return transmission.size(); }
  [[nodiscard]] static int order(std::size_t j) { return static_cast<int>(j / 2) + 2; }

  int highest = 1;
  std::size_t points = 0;
  std::vector<double> transmission;  ///< Of each coefficient.
};

/// Root mean square of a curve.
double rms_of(std::span<const double> curve);

/// Mean square of the mean curve, and of the parts about it.
struct Spread {
  double mean2 = 0.0;
  double spread2 = 0.0;
  double parts = 0.0;

  [[nodiscard]] double index() const {
    const double repeating = mean2 - spread2 / parts;
    return repeating + spread2 > 0.0 ? repeating / (repeating + spread2) : 0.0;
  }
};

Spread spread_of(const Curves& curves);

std::vector<double> mean_curve(const Curves& curves);

/// The greatest peak to valley of all curves.
double greatest_range(const Basis& basis, const Curves& curves);

// How the curves of all parts are drawn, and the intervals of numbers read from the draws.

/// An influence on the curves of all parts at once.
struct Effect {
  std::string name;
  /// Adds a draw.
  std::function<void(int, Curves&)> draw;
  /// Adds so many standard uncertainties; empty where more than one number is drawn.
  std::function<void(double, Curves&)> at = {};
  bool berkson = false;
  bool in_draws = false;  ///< The draws of the curves hold it: it stands in the budget alone.
};

/// How the curves of all parts are drawn.
struct CurveModel {
  Curves measured;
  std::function<Curves(int)> draw;
  std::function<Curves(int)> core_draw = {};  ///< Empty: a random field, which is not turned.
  Curves core_center = {};
  std::vector<Effect> effects = {};
  std::vector<InfluenceStatement> declaration = {};
  std::vector<core::Phrase> notes = {};
};

/// A number read from the curves.
struct Asked {
  std::function<double(const Curves&)> value;
  double as_measured = 0.0;
  bool convex = true;
  bool is_signed = false;
  bool has_budget = true;  ///< Of an index, which is no length, none is printed.
  std::size_t lines = 1;   ///< Of how many lines of a mask it is one, for its coverage.
};

/// The intervals of all numbers from the same trials, in their order.
std::vector<UncertaintyStatus> states(const CurveModel& model, const std::vector<Asked>& asked,
                                      const UncertaintyOptions& options);

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

// Declared influences that act on all parts alike.

/// A declared influence with its draws.
struct DrawnInfluence {
  const record::Influence* said = nullptr;
  double unit = 1.0;  ///< From the unit of the key to that of the calculation.
  std::string_view id;

  [[nodiscard]] double u() const { return unit * record::u_of(*said); }
  [[nodiscard]] double draw(std::uint64_t seed, std::uint64_t instance, int trial) const {
    if (u() == 0.0) return 0.0;
    const bool flat =
        *said && (*said)->distribution == record::DeclaredInfluence::Distribution::kRectangular;
    return u() * (flat ? uniform_draw(seed, id, instance, trial)
                       : normal_draw(seed, id, instance, trial));
  }
};

/// Random curves common to all parts: `columns` with one draw each.
struct CommonCurves {
  Curves columns;  ///< Change of a curve for one standard uncertainty, with sign.
  DrawnInfluence declared;

  void add(std::uint64_t seed, int trial, Curves& curves) const {
    const double u = declared.u();
    if (u == 0.0) return;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double z = declared.draw(seed, c, trial) / u;
      for (auto& curve : curves) {
        for (std::size_t j = 0; j < curve.size(); ++j) curve[j] += z * columns[c][j];
      }
    }
  }
  /// Adds the squares of the standard uncertainties of the coefficients.
  void add_squares(std::vector<double>& squares) const {
    for (const auto& column : columns) {
      for (std::size_t j = 0; j < column.size(); ++j) squares[j] += column[j] * column[j];
    }
  }
};

}  // namespace rondure::evaluation::contour_trials
