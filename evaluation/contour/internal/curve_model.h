#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/contour/internal/curves.h"
#include "evaluation/results/stated_value.h"
#include "evaluation/uncertainty/influences.h"

// How the curves of all parts are drawn, and the intervals of numbers read from the draws.

namespace rondure::evaluation::contour_trials {

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

}  // namespace rondure::evaluation::contour_trials
