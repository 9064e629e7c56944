#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/phrase.h"
#include "evaluation/contour/internal/curves.h"
#include "evaluation/contour/result.h"

namespace rondure::evaluation::contour_trials {

/// All curves of a study and what is declared of them.
class ContourTrials {
 public:
  ContourTrials(const ContourResult& facts, const UncertaintyOptions& options);

  [[nodiscard]] const Basis& basis() const { return basis_; }
  [[nodiscard]] const Curves& total() const { return total_; }
  [[nodiscard]] const Curves& following() const { return following_; }
  [[nodiscard]] const Curves& rest() const { return rest_; }
  [[nodiscard]] const UncertaintyOptions& options() const { return options_; }

  /// Why t has no interval; nothing where it can have one.
  [[nodiscard]] std::optional<core::Phrase> no_gauge() const;
  /// The same for f.
  [[nodiscard]] std::optional<core::Phrase> no_axes() const;

  /// Of t, or of the main journals.
  [[nodiscard]] CurveModel gauge_model(const Curves& measured, std::string_view what) const;

  [[nodiscard]] CurveModel following_model() const;
  /// The same, or by the main journals; no_axes() tells whether there is one.
  [[nodiscard]] CurveModel model_of_f() const;

  /// n: a random field. Its errors are drawn in the mean of the parts, which holds what is common
  /// to them, and in the contrasts between them, which hold what is not.
  [[nodiscard]] CurveModel rest_model() const;

  /// f by the main journal; nothing without a number for how far it differs from n.
  /// @param indirect  t minus the main journals.
  [[nodiscard]] std::optional<CurveModel> indirect_model(const Curves& indirect) const;
  /// n by the main journal; the same.
  [[nodiscard]] std::optional<CurveModel> main_model(const Curves& mains) const;

  /// Of t for the gain of a correction: the zero of the gauge turns t against the axes.
  [[nodiscard]] CurveModel gain_model() const;

  /// Standard uncertainty of the mean f at the angles of the contours.
  [[nodiscard]] std::vector<double> mean_following_u() const;

 private:
  static constexpr std::string_view kCEncoder = "control.c-encoder";
  static constexpr std::string_view kXEncoder = "control.x-encoder";
  static constexpr const char* kWheelRadius = "wheel-radius";

  [[nodiscard]] std::string id(std::string_view what) const;

  /// Turns curves: out(beta) = curve(beta - angle).
  static void turn(double angle, Curves& curves);

  /// The rows of an orthonormal set: the mean, then each part against those before it.
  static double contrast(std::size_t row, std::size_t part, std::size_t parts);

  /// Noise of the gauge in a coefficient, before the filter.
  [[nodiscard]] double gauge_u(std::size_t part, bool of_main) const;

  /// Noise of the traces in a coefficient of f, before the filter. White noise e of N samples over
  /// alpha becomes w(beta) e(alpha(beta)) with dbeta = (dbeta/dalpha) dalpha, hence the mean square
  /// of w dbeta/dalpha over alpha.
  [[nodiscard]] double trace_u(std::size_t part) const;

  /// Coefficients of f that errors of the axes give, to first order.
  [[nodiscard]] std::vector<double> effect(const std::function<double(double)>& x_mm,
                                           const std::function<double(double)>& c_rad) const;
  [[nodiscard]] std::vector<double> effect(const std::function<double(double)>& x_mm,
                                           const std::function<double(double)>& c_rad,
                                           const fit::CrankGeometry& crank) const;

  /// Errors of an encoder repeat from part to part. Their standard uncertainty at each position is
  /// spread evenly over the orders 1 to 10 of alpha.
  [[nodiscard]] CommonCurves encoder(bool of_x) const;

  /// Change of f of each part when X is late against C by one standard uncertainty; empty where the
  /// skew is not declared or its unit cannot be converted.
  [[nodiscard]] Curves skew_effects() const;

  /// Change of f of each part for a wheel radius greater by 1 mm; empty where the radius is a
  /// number of the plan.
  [[nodiscard]] Curves radius_effects() const;

  void say_radius(CurveModel& out) const;

  /// What all parts share of the error of n by the wheel radius, for one standard uncertainty.
  [[nodiscard]] std::vector<double> radius_in_rest() const;

  /// The gauge's spindle over its orders, the same in all parts.
  [[nodiscard]] CommonCurves gauge_form() const;

  void add_gauge(CurveModel& out) const;

  /// Coefficients of the mean of t, and of its derivative by the angle.
  [[nodiscard]] std::vector<double> mean_total(bool derivative) const;

  /// One column times one declared number.
  static CommonCurves scaled(std::vector<double> column, const DrawnInfluence& declared);

  /// What all parts share of the errors of n, by influence.
  [[nodiscard]] std::vector<std::pair<std::string, CommonCurves>> common_errors() const;

  [[nodiscard]] std::vector<double> common_squares() const;

  void add_rest_budget(CurveModel& out) const;

  /// What the two journals do not share is another curve for each part.
  void add_difference(double differs_mm, CurveModel& out) const;

  /// How far n and the main journal differ: as declared, or from the parts that have both.
  [[nodiscard]] std::optional<double> main_differs_mm() const;

  void say(CurveModel& out, std::initializer_list<std::string_view> keys) const;

  const ContourResult& facts_;
  const record::ContourInfluencesTask& said_;
  UncertaintyOptions options_;
  Basis basis_;
  Curves total_;
  Curves following_;
  Curves rest_;
  std::vector<CommonCurves> encoders_;
  Curves skew_;
  Curves radius_;  ///< As radius_effects().
};

/// The reason for no interval where the plan has no influences of the feature.
core::Phrase nothing_declared();

}  // namespace rondure::evaluation::contour_trials
