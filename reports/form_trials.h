#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "reports/error_modes.h"
#include "reports/form_draw.h"
#include "reports/form_value.h"

namespace rondure::reports {

/// Splits 0..count among threads: work(thread, first, last). Threads that cannot be had are done by
/// the calling one.
void in_parallel(int threads, std::size_t count,
                 const std::function<void(std::size_t, std::size_t, std::size_t)>& work);

/// The trials of one measurement. Trial t is a pure function of (seed, t), so that neither the
/// number of threads nor that of the trials changes it.
class FormTrials {
 public:
  /// Inputs as measurement_uncertainty() has checked them; they must outlive the trials.
  FormTrials(const FormCloud& cloud, const ErrorModel& errors,
             const std::optional<FormSpectrum>& spectrum, std::uint64_t seed, int threads);

  /// Does `count` more trials.
  void run(std::size_t count);

  /// Values of (a) and of (b) so far [mm]; of (b) none without a spectrum.
  [[nodiscard]] const std::vector<double>& sampled() const { return sampled_; }
  [[nodiscard]] const std::vector<double>& whole() const { return whole_; }

  /// By how much each influence alone changes the value of a form that may stand behind the data,
  /// in the first `count` trials [mm]: one list an influence, as ErrorModel::names(); empty for
  /// those that do not act.
  [[nodiscard]] std::vector<std::vector<double>> changes(std::size_t count);

  /// The value of the deviations as measured [mm].
  [[nodiscard]] double uncorrected_mm() const { return uncorrected_; }

 private:
  /// What one thread works on.
  struct Desk {
    FormValue sampled;
    std::optional<FormValue> whole;
    Eigen::VectorXd errors = {};
    Eigen::VectorXd form = {};
    Eigen::VectorXd changed = {};
  };

  void change(std::size_t trial, Desk& desk, std::vector<std::vector<double>>& changes) const;
  void sampled_form(std::size_t trial, Desk& desk) const;
  void whole_form(std::size_t trial, Desk& desk) const;

  const ErrorModel& errors_;
  SampledForm sampled_form_;
  std::optional<WholeForm> whole_form_;
  std::uint64_t seed_;
  std::vector<double> sampled_;
  std::vector<double> whole_;
  double uncorrected_ = 0.0;

  std::vector<Desk> desks_;
};

}  // namespace rondure::reports
