#include "evaluation/uncertainty/internal/statement.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "core/statistics.h"

namespace rondure::evaluation {
namespace {

using core::Code;

constexpr double kMostFlagged = 0.2;   // fraction of the points of a cloud
constexpr double kReadLimit = 4.0;     // standard deviations of the readings of the model
constexpr double kScatterLimit = 4.0;  // the same, of the residual scatter
constexpr double kRoundOff_mm = 1e-6;  // a simulation without errors reads less
// below this number, noise declared too large cannot be detected
constexpr double kFewResiduals = 40.0;

}  // namespace

void DrawTally::add(const FormDraw& draw) {
  draws += 1.0;
  for (const std::size_t row : draw.spots) ++spot_counts[row];
  unresolved_mm += std::sqrt(draw.unresolved_mm2);
  noise_mm += std::sqrt(draw.noise_mm2);
  groups += draw.groups;
  spots += static_cast<double>(draw.spots.size());
  if (draw.unresolved_mm2 == 0.0) {
    scatter_1 += draw.scatter_1;
    ++resolved;
  }
}

UncertaintyStatement statement_of(std::vector<double> trials, double coverage) {
  UncertaintyStatement out;
  out.estimate_mm = core::mean(trials);
  out.standard_uncertainty_mm = core::standard_deviation(trials, out.estimate_mm);
  std::sort(trials.begin(), trials.end());
  const auto count = static_cast<double>(trials.size());
  const double rank = std::round(0.5 * (1.0 - coverage) * (count + 1.0));
  const auto beyond = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
  out.low_mm = trials[beyond];
  out.high_mm = trials[trials.size() - 1 - beyond];
  if (out.estimate_mm < out.low_mm || out.estimate_mm > out.high_mm) {  // a few extreme trials
    out.estimate_mm = trials[trials.size() / 2];
  }
  out.values_mm = std::move(trials);
  return out;
}

double numerical_tolerance_mm(std::span<const std::span<const double>> chains, double coverage) {
  if (chains.size() < 2 || chains.front().empty()) return 0.0;
  std::vector<std::vector<double>> numbers(4);
  for (const std::span<const double> chain : chains) {
    const auto one = statement_of({chain.begin(), chain.end()}, coverage);
    numbers[0].push_back(one.estimate_mm);
    numbers[1].push_back(one.standard_uncertainty_mm);
    numbers[2].push_back(one.low_mm);
    numbers[3].push_back(one.high_mm);
  }
  double worst = 0.0;
  for (const auto& of_chains : numbers) {
    const double spread = core::standard_deviation(of_chains, core::mean(of_chains));
    worst = std::max(worst, 2.0 * spread / std::sqrt(static_cast<double>(of_chains.size())));
  }
  return worst;
}

void share_out(std::vector<BudgetLine>& budget) {
  double sampled = 0.0;
  double all = 0.0;
  for (const BudgetLine& line : budget) {
    const double square = line.standard_uncertainty_mm * line.standard_uncertainty_mm;
    all += square;
    if (line.measurand == Measurand::kSampledPoints) sampled += square;
  }
  for (BudgetLine& line : budget) {
    const double square = line.standard_uncertainty_mm * line.standard_uncertainty_mm;
    const double sum = line.measurand == Measurand::kSampledPoints ? sampled : all;
    line.share_1 = sum > 0.0 ? square / sum : 0.0;
  }
  std::stable_sort(budget.begin(), budget.end(), [](const BudgetLine& a, const BudgetLine& b) {
    return a.standard_uncertainty_mm > b.standard_uncertainty_mm;
  });
}

core::Result<void> check_cloud(const FormCloud& cloud) {
  if (!(cloud.radius_mm > 0.0 && std::isfinite(cloud.radius_mm))) {
    return core::fail_with(Code::kBadOption, "radius {} mm is not > 0", cloud.radius_mm);
  }
  const Eigen::MatrixXd motions = rigid_motions(cloud);
  const auto least = static_cast<std::size_t>(motions.cols() + 1);
  if (cloud.points.size() < least) {
    return core::fail_with(Code::kTooFewPoints, "{} points; {} at least have an uncertainty",
                           cloud.points.size(), least);
  }
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const FormPoint& p = cloud.points[i];
    if (!std::isfinite(p.angle_rad + p.height_mm + p.deviation_mm)) {
      return core::fail_with(Code::kNotFinite, "point {} is not finite", i);
    }
    if (p.repeats < 1) {
      return core::fail_with(Code::kBadOption, "point {} is the mean of {} touches; 1 at least", i,
                             p.repeats);
    }
    if (!cloud.frames.empty() &&
        (p.pose < 0 || static_cast<std::size_t>(p.pose) >= cloud.frames.size())) {
      return core::fail_with(Code::kBadOption, "pose {} of point {} is none of {} frames", p.pose,
                             i, cloud.frames.size());
    }
    if (!(p.time_1 >= 0.0 && p.time_1 <= 1.0)) {
      return core::fail_with(Code::kBadOption, "time {} of point {} is outside 0..1", p.time_1, i);
    }
  }
  if (rigid_basis(cloud).cols() < motions.cols()) {
    return core::fail(Code::kRank, "the points do not determine the axis");
  }
  return {};
}

core::Result<void> check_options(const UncertaintyOptions& options) {
  const auto bad = [](const char* name, auto value, const char* limit) {
    return core::fail_with(Code::kBadOption, "{} {} is not {}", name, value, limit);
  };
  if (!(options.tolerance_mm >= 0.0 && std::isfinite(options.tolerance_mm))) {
    return bad("tolerance_mm", options.tolerance_mm, ">= 0");
  }
  if (options.chains < 1 || options.chains > 64) return bad("chains", options.chains, "in 1..64");
  if (options.least_trials < 100) return bad("least_trials", options.least_trials, ">= 100");
  if (!(options.expected_spots >= 0.01 && options.expected_spots <= 10.0)) {
    return bad("expected_spots", options.expected_spots, "in 0.01..10");
  }
  if (options.most_trials < options.least_trials || options.most_trials > 10'000'000) {
    return bad("most_trials", options.most_trials, "in least_trials..10000000");
  }
  if (options.budget_trials < 0 || options.budget_trials == 1) {
    return bad("budget_trials", options.budget_trials, "0 or >= 2");
  }
  if (!(options.coverage >= 0.5 && options.coverage <= 0.999)) {
    return bad("coverage", options.coverage, "in 0.5..0.999");
  }
  if (options.threads < 0 || options.threads > 256) {
    return bad("threads", options.threads, "in 0..256");
  }
  return {};
}

core::Result<void> check_values(std::span<const double> values) {
  const auto lost =
      std::count_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
  if (lost == 0) return {};
  return core::fail(
      Code::kReferenceAbsent,
      core::phrase("in {} of {} trials the points have no such reference", lost, values.size()));
}

int threads_of(const UncertaintyOptions& options) {
  if (options.threads > 0) return options.threads;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 256);
}

bool noise_is_unknown(const ErrorModel& errors, const Influences& influences) {
  if (!errors.point_variance_mm2().isZero(0.0)) return false;
  return !influences.probe || !influences.probe->repeatability_known;
}

FormFinding finding_of(std::span<const DrawTally> chains, std::size_t points) {
  FormFinding out;
  std::vector<int> counts(points, 0);
  double draws = 0.0;
  for (const DrawTally& chain : chains) {
    draws += chain.draws;
    out.noise_mm += chain.noise_mm;
    out.unresolved_mm += chain.unresolved_mm;
    out.groups += chain.groups;
    out.spots += chain.spots;
    for (std::size_t i = 0; i < points; ++i) counts[i] += chain.spot_counts[i];
  }
  for (double* sum : {&out.noise_mm, &out.unresolved_mm, &out.groups, &out.spots}) *sum /= draws;
  for (std::size_t i = 0; i < points; ++i) {
    if (counts[i] > 0.5 * draws) out.spot_rows.push_back(i);
  }
  return out;
}

core::Result<void> guard_outliers(const FormModel& model) {
  if (model.flagged_share() <= kMostFlagged) return {};
  return core::fail(Code::kOutliers,
                    core::phrase("{:.0f} % of the points stand out: no smooth form stands "
                                 "behind these points; no interval is stated",
                                 100.0 * model.flagged_share()));
}

core::Result<void> guard_scatter(std::span<const DrawTally> chains, const FormCloud& cloud,
                                 const FormFinding& finding, std::vector<core::Phrase>& notes) {
  double scatter = 0.0;
  double draws = 0.0;
  for (const DrawTally& chain : chains) {
    scatter += chain.scatter_1;
    draws += chain.resolved;
  }
  const double count = static_cast<double>(cloud.points.size()) - finding.spots;
  if (count - 2.0 * finding.groups < kFewResiduals) {
    notes.push_back(core::phrase(
        "too few points to show whether the declared noise is larger than the real one"));
  }
  const bool none = std::all_of(
      cloud.points.begin(), cloud.points.end(),
      [](const FormPoint& point) { return std::abs(point.deviation_mm) <= kRoundOff_mm; });
  if (draws == 0.0 || none) return {};
  scatter /= draws;
  if (scatter >= 1.0 - kScatterLimit * std::sqrt(2.0 / count)) return {};
  return core::fail(
      Code::kInconsistent,
      core::phrase("the residual scatter is {:.3g} um, declared were {:.3g} um: declare what the "
                   "touches show; no interval is stated",
                   1e3 * std::sqrt(scatter) * finding.noise_mm, 1e3 * finding.noise_mm));
}

core::Result<void> guard_reading(std::vector<double> read_mm, double uncorrected_mm) {
  std::erase_if(read_mm, [](double value) { return !std::isfinite(value); });
  if (read_mm.size() < 8 || std::abs(uncorrected_mm) <= kRoundOff_mm) return {};
  const double mean = core::mean(read_mm);
  const double spread = core::standard_deviation(read_mm, mean);
  if (std::abs(uncorrected_mm - mean) <= kReadLimit * spread + kRoundOff_mm) return {};
  return core::fail(
      Code::kInconsistent,
      core::phrase("the form model does not explain the value as read: it would read {:.3f} +- "
                   "{:.3f} um, {:.3f} um were read; no interval is stated",
                   1e3 * mean, 1e3 * spread, 1e3 * uncorrected_mm));
}

}  // namespace rondure::evaluation
