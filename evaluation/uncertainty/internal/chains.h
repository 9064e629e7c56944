#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "evaluation/uncertainty/internal/error_modes.h"
#include "evaluation/uncertainty/internal/form_value.h"
#include "evaluation/uncertainty/internal/sampler.h"
#include "evaluation/uncertainty/internal/whole_surface.h"

namespace rondure::evaluation {

/// Splits 0..count among threads: work(first, last). Threads that cannot be had are done by the
/// calling one.
void in_parallel(int threads, std::size_t count,
                 const std::function<void(std::size_t, std::size_t)>& work);

/// The surface that a statement about the whole is made of.
struct WholeExtent {
  double low_mm = 0.0;  ///< Along the axis, in the heights of the cloud.
  double high_mm = 0.0;
  bool declared = false;  ///< Its form is a declared spectrum.
};

/// What the draws of one chain gave.
struct ChainValues {
  std::vector<double> sampled_mm;  ///< (a)
  std::vector<double> whole_mm;    ///< (b); none where nobody asked.
  /// By how much each influence alone changes the value of a drawn form; one list an influence,
  /// empty for those that do not act.
  std::vector<std::vector<double>> changes_mm;
  std::vector<double> of_errors_mm;  ///< Value of errors alone, on a perfect form.
  std::vector<double> read_mm;       ///< What an inspection of the drawn forms would read.
  double unresolved_mm = 0.0;        ///< Sums over the draws.
  double noise_mm = 0.0;
  double groups = 0.0;
  double spots = 0.0;
  double scatter_1 = 0.0;        ///< Over draws without unresolved form, which are
  int resolved = 0;              ///< so many.
  std::vector<int> spot_counts;  ///< Of each point, the draws in which it is a spot.
};

/// The draws of one measurement, as chains. A chain is a pure function of (seed, its number), so
/// that the number of threads changes nothing.
class FormChains {
 public:
  /// Inputs as measurement_uncertainty() has checked them; they must outlive the chains.
  FormChains(const FormCloud& cloud, const ErrorModel& errors, const FormModel& model,
             const std::optional<WholeExtent>& whole, std::uint64_t seed, int chains, int threads);
  ~FormChains();

  /// Draws `each` more in every chain; of each chain's first `budget` also what every influence
  /// alone changes.
  void run(std::size_t each, std::size_t budget);

  [[nodiscard]] const std::vector<ChainValues>& values() const { return values_; }

  /// The value of the deviations as measured [mm].
  [[nodiscard]] double uncorrected_mm() const { return uncorrected_; }

 private:
  struct Chain;

  void draw_one(Chain& chain, ChainValues& out, std::size_t budget) const;
  void change(Chain& chain, const FormDraw& draw, double value, ChainValues& out) const;

  const ErrorModel& errors_;
  int threads_;
  std::vector<std::unique_ptr<Chain>> chains_;
  std::vector<ChainValues> values_;
  double uncorrected_ = 0.0;
};

}  // namespace rondure::evaluation
