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
#include "evaluation/uncertainty/internal/statement.h"
#include "evaluation/uncertainty/internal/whole_surface.h"

namespace rondure::evaluation {

/// Splits 0..count among threads: work(first, last). The calling thread does the work of threads
/// that cannot be started.
void in_parallel(int threads, std::size_t count,
                 const std::function<void(std::size_t, std::size_t)>& work);

/// The surface that a statement about the whole surface covers.
struct WholeExtent {
  double low_mm = 0.0;  ///< Lower end along the axis, in the heights of the cloud.
  double high_mm = 0.0;
  bool declared = false;  ///< Its form is a declared spectrum.
};

/// Results of the draws of one chain.
struct ChainValues {
  std::vector<double> sampled_mm;  ///< (a)
  std::vector<double> whole_mm;    ///< (b); empty where it was not asked for.
  /// Change of the value of a drawn form by each influence alone; one list per influence, empty for
  /// those without effect.
  std::vector<std::vector<double>> changes_mm;
  std::vector<double> of_errors_mm;  ///< Value of the errors alone, on a perfect form.
  std::vector<double> read_mm;       ///< Value of simulated inspections of the drawn forms.
  DrawTally tally;
};

/// For KeptDraws.
template <class Chain, class Use>
requires std::same_as<std::remove_const_t<Chain>, ChainValues>
bool members_of(Chain& c, const Use& use) {
  return use(c.sampled_mm, c.whole_mm, c.changes_mm, c.of_errors_mm, c.read_mm, c.tally);
}

/// The draws of one measurement, as chains. A chain is a pure function of the seed and its number,
/// so that the number of threads changes nothing.
class FormChains {
 public:
  /// Takes inputs that measurement_uncertainty() has checked; they must outlive the chains.
  FormChains(const FormCloud& cloud, const ErrorModel& errors, const FormModel& model,
             const std::optional<WholeExtent>& whole, std::uint64_t seed, int chains, int threads);
  ~FormChains();

  /// Adds `each` draws to every chain; for the first `budget` draws of a chain also the change by
  /// every influence alone.
  void run(std::size_t each, std::size_t budget);

  [[nodiscard]] const std::vector<ChainValues>& values() const { return values_; }
  [[nodiscard]] std::vector<ChainValues>& values() { return values_; }

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
