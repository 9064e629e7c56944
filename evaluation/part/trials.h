#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "evaluation/decision/decision.h"
#include "evaluation/part/part_state.h"
#include "evaluation/part/surface.h"
#include "evaluation/uncertainty/influences.h"
#include "evaluation/uncertainty/statement.h"

namespace rondure::evaluation {

/// Work that keeps the trials of a part to some seconds: points that all value functions read in
/// all trials, where a call, and a pivot of the searches for a reference, count as so many of them.
inline constexpr double kWorkOfPart = 4e7;
inline constexpr double kPointsOfCall = 300.0;
inline constexpr double kPointsOfPivot = 200.0;

/// One feature of a part with what acts on its points.
struct TrialSurface {
  MeasuredSurface measured;
  /// Rows of the cloud that take part, ascending. The others, as those in a window, stay where they
  /// are.
  std::vector<std::size_t> rows;
  /// As declared, with repeatability and tip qualification of the feature. The temperatures in it
  /// act through `growth_1` instead.
  Influences influences;
  double growth_1 = 0.0;  ///< Standard uncertainty of the factor that brings lengths to 20 degC.
  int pose = 0;           ///< Equal for features that were measured in one pose of the fixture.
};

/// The touches that qualified the tip.
struct ReferenceTouches {
  std::vector<Eigen::Vector3d> tips_mm = {};
  bool column = false;  ///< Of a column, not a sphere.
};

/// Values of a part, e.g. the judged values of find(); NaN where there is none. Pure: it is called
/// from several threads.
using ValueFunction = std::function<std::vector<double>(const PartState&)>;

/// What the trials are asked for.
struct TrialQuestion {
  /// Surfaces on which the values depend, without repetition: the toleranced one, then its datums.
  std::vector<std::size_t> surfaces;
  std::vector<double> read_mm;  ///< The values as read; NaN where there is none.
  ValueFunction values;
};

/// The distributions of the values of a question.
struct TrialAnswer {
  /// For each value, its uncertainty, or why there is no interval.
  std::vector<core::Result<UncertaintyResult>> values;
  /// One row for each trial, with all values of the question. Row t of every answer belongs to the
  /// same trial of the part.
  std::vector<std::vector<double>> rows_mm;
};

/// Share of the trials in which every value is within its limits: the probability that all
/// conditions of a requirement hold together. Values that are NaN are within none.
[[nodiscard]] double share_within(const TrialAnswer& answer, std::span<const Limits> limits);

/// Propagates the declared influences to the values of a part (Monte Carlo, JCGM 101).
///
/// A trial is one part that is compatible with the points: the noise-free form of each feature with
/// its place and size, drawn by the chains of the form values (uncertainty.h), less one draw of the
/// errors that all features share: scales, squareness, drift, lobes, pose, temperature, tip. These
/// act on the qualification of the tip as well: a scale error that grows the reference sphere with
/// the part changes no shaft of its size.
///
/// Values of a trial are free of the bias that noise gives extremes. Their mean is the estimate.
class PartTrials {
 public:
  /// @param surfaces      All features of the part.
  /// @param reference     Touches of the qualification; empty where the tip radius does not
  ///                      come from a qualification on this machine.
  PartTrials(std::vector<TrialSurface> surfaces, const ReferenceTouches& reference,
             const UncertaintyOptions& options);
  ~PartTrials();
  PartTrials(const PartTrials&) = delete;
  PartTrials& operator=(const PartTrials&) = delete;

  /// Answers all questions from the same trials. The number of trials is that of the options, or
  /// less where the values take long: see UncertaintyStatement::numerical_tolerance_mm. Same input,
  /// same bits, at any number of threads.
  [[nodiscard]] std::vector<TrialAnswer> answers(std::span<const TrialQuestion> questions) const;

 private:
  struct Part;
  std::unique_ptr<const Part> part_;
};

}  // namespace rondure::evaluation
