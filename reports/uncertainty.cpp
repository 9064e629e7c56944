#include "reports/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "reports/form_trials.h"

namespace rondure::reports {
namespace {

using core::Code;

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double spread_of(std::span<const double> values, double mean) {
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

/// Estimate, standard uncertainty and interval of trials: JCGM 101 sections 7.6 and 7.7.
UncertaintyStatement statement_of(std::span<const double> trials, double coverage) {
  UncertaintyStatement out;
  out.estimate_mm = mean_of(trials);
  out.standard_uncertainty_mm = spread_of(trials, out.estimate_mm);
  std::vector<double> sorted(trials.begin(), trials.end());
  std::sort(sorted.begin(), sorted.end());
  const auto inside =
      static_cast<std::size_t>(std::floor(coverage * static_cast<double>(sorted.size()) + 0.5));
  const std::size_t below = (sorted.size() - inside + 1) / 2;  // 1-based rank of the low end
  const std::size_t low = std::max<std::size_t>(below, 1) - 1;
  out.low_mm = sorted[low];
  out.high_mm = sorted[std::min(low + inside, sorted.size() - 1)];
  out.values_mm = std::move(sorted);
  return out;
}

/// JCGM 101 section 7.9.4: twice the standard deviation of the mean of the blocks, of the worst of
/// the four numbers.
double tolerance_reached(std::span<const double> trials, std::size_t block, double coverage) {
  std::vector<std::vector<double>> numbers(4);
  for (std::size_t first = 0; first + block <= trials.size(); first += block) {
    const auto one = statement_of(trials.subspan(first, block), coverage);
    numbers[0].push_back(one.estimate_mm);
    numbers[1].push_back(one.standard_uncertainty_mm);
    numbers[2].push_back(one.low_mm);
    numbers[3].push_back(one.high_mm);
  }
  double worst = 0.0;
  for (const auto& of_blocks : numbers) {
    const double spread = spread_of(of_blocks, mean_of(of_blocks));
    worst = std::max(worst, 2.0 * spread / std::sqrt(static_cast<double>(of_blocks.size())));
  }
  return worst;
}

core::Result<void> check_cloud(const FormCloud& cloud) {
  if (!(cloud.radius_mm > 0.0 && std::isfinite(cloud.radius_mm))) {
    return core::fail(Code::kBadOption, fmt::format("radius {} mm is not > 0", cloud.radius_mm));
  }
  const std::size_t least = cloud.kind == FormKind::kCylindricity ? 6 : 4;
  if (cloud.points.size() < least) {
    return core::fail(Code::kTooFewPoints, fmt::format("{} points; {} at least have an uncertainty",
                                                       cloud.points.size(), least));
  }
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const FormPoint& p = cloud.points[i];
    if (!std::isfinite(p.angle_rad + p.height_mm + p.deviation_mm)) {
      return core::fail(Code::kNotFinite, fmt::format("point {} is not finite", i));
    }
    if (p.repeats < 1) {
      return core::fail(
          Code::kBadOption,
          fmt::format("point {} is the mean of {} touches; 1 at least", i, p.repeats));
    }
    if (!(p.time_1 >= 0.0 && p.time_1 <= 1.0)) {
      return core::fail(Code::kBadOption,
                        fmt::format("time {} of point {} is outside 0..1", p.time_1, i));
    }
  }
  const Eigen::Index unknowns = cloud.kind == FormKind::kCylindricity ? 5 : 3;
  if (rigid_basis(cloud).cols() < unknowns) {
    return core::fail(Code::kRank, "the points do not determine the axis");
  }
  return {};
}

core::Result<void> check_options(const UncertaintyOptions& options) {
  const auto bad = [](const char* name, auto value, const char* limit) {
    return core::fail(Code::kBadOption, fmt::format("{} {} is not {}", name, value, limit));
  };
  if (!(options.tolerance_mm >= 0.0 && std::isfinite(options.tolerance_mm))) {
    return bad("tolerance_mm", options.tolerance_mm, ">= 0");
  }
  if (options.block_trials < 100) return bad("block_trials", options.block_trials, ">= 100");
  if (options.least_trials < 2 * options.block_trials) {
    return bad("least_trials", options.least_trials, ">= two blocks");
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

core::Result<void> check_all(const FormCloud& cloud, const Influences& influences,
                             const std::optional<FormSpectrum>& spectrum,
                             const UncertaintyOptions& options) {
  if (const auto good = check_cloud(cloud); !good) return good;
  if (const auto good = check_influences(influences); !good) return good;
  if (spectrum) {
    if (const auto good = check_spectrum(*spectrum, cloud.kind); !good) return good;
  }
  return check_options(options);
}

int threads_of(const UncertaintyOptions& options) {
  if (options.threads > 0) return options.threads;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 256);
}

/// A reference that exists for the points as measured may not exist for all that they may be.
core::Result<void> check_values(const std::vector<double>& values) {
  const auto lost =
      std::count_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
  if (lost == 0) return {};
  return core::fail(
      Code::kReferenceAbsent,
      fmt::format("in {} of {} trials the points have no such reference", lost, values.size()));
}

core::Result<void> check_values(const FormTrials& trials) {
  if (auto good = check_values(trials.sampled()); !good) return good;
  return check_values(trials.whole());
}

/// Runs blocks until the numbers stand still. Source: JCGM 101 section 7.9.
core::Result<UncertaintyResult> run_trials(FormTrials& trials, const UncertaintyOptions& options) {
  UncertaintyResult out;
  const auto block = static_cast<std::size_t>(options.block_trials);
  const auto least = static_cast<std::size_t>(options.least_trials);
  const auto most = static_cast<std::size_t>(options.most_trials);
  const auto open = [&](const std::vector<double>& values) {
    return tolerance_reached(values, block, options.coverage);
  };
  trials.run(options.tolerance_mm > 0.0 ? least : most);
  if (const auto good = check_values(trials); !good) return core::fail(good.error());
  while (options.tolerance_mm > 0.0) {
    const double worst =
        std::max(open(trials.sampled()), trials.whole().empty() ? 0.0 : open(trials.whole()));
    out.tolerance_reached = worst <= options.tolerance_mm;
    if (out.tolerance_reached || trials.sampled().size() >= most) break;
    trials.run(std::min(block, most - trials.sampled().size()));
    if (const auto good = check_values(trials); !good) return core::fail(good.error());
  }
  out.uncorrected_mm = trials.uncorrected_mm();
  out.sampled = statement_of(trials.sampled(), options.coverage);
  out.sampled.numerical_tolerance_mm = open(trials.sampled());
  out.noise_inflation_mm = out.uncorrected_mm - out.sampled.estimate_mm;
  if (!trials.whole().empty()) {
    out.whole = statement_of(trials.whole(), options.coverage);
    out.whole->measurand = Measurand::kWholeSurface;
    out.whole->numerical_tolerance_mm = open(trials.whole());
    out.sampling_loss_mm = out.sampled.estimate_mm - out.whole->estimate_mm;
  }
  out.trials = static_cast<int>(trials.sampled().size());
  return out;
}

/// What the form between the points leaves open, were there no other influence.
BudgetLine sampling_line(const FormCloud& cloud, const FormSpectrum& spectrum,
                         const UncertaintyOptions& options) {
  const ErrorModel nothing(cloud, Influences{});
  FormTrials trials(cloud, nothing, spectrum, options.seed, threads_of(options));
  trials.run(static_cast<std::size_t>(options.budget_trials));
  BudgetLine line;
  line.name = "sampling";
  line.measurand = Measurand::kWholeSurface;
  const double mean = mean_of(trials.whole());
  line.standard_uncertainty_mm = spread_of(trials.whole(), mean);
  line.shift_mm = trials.uncorrected_mm() - mean;
  return line;
}

/// Each line's share of the lines of (a); sampling's of all.
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

core::Result<std::vector<BudgetLine>> budget_of(FormTrials& trials, const ErrorModel& errors,
                                                const FormCloud& cloud,
                                                const std::optional<FormSpectrum>& spectrum,
                                                const UncertaintyOptions& options) {
  std::vector<BudgetLine> budget;
  if (options.budget_trials == 0) return budget;
  const auto changes = trials.changes(static_cast<std::size_t>(options.budget_trials));
  for (const std::vector<double>& values : changes) {
    if (auto good = check_values(values); !good) return core::fail(good.error());
  }
  for (std::size_t k = 0; k < changes.size(); ++k) {
    BudgetLine line;
    line.name = errors.names()[k];
    if (!changes[k].empty()) {
      line.shift_mm = mean_of(changes[k]);
      line.standard_uncertainty_mm = spread_of(changes[k], line.shift_mm);
    }
    budget.push_back(line);
  }
  if (spectrum) budget.push_back(sampling_line(cloud, *spectrum, options));
  share_out(budget);
  return budget;
}

}  // namespace

std::string_view name_of(Measurand measurand) {
  return measurand == Measurand::kSampledPoints ? "at the sampled points" : "of the whole surface";
}

core::Result<UncertaintyResult> measurement_uncertainty(const FormCloud& cloud,
                                                        const Influences& influences,
                                                        const std::optional<FormSpectrum>& spectrum,
                                                        const UncertaintyOptions& options) {
  if (const auto good = check_all(cloud, influences, spectrum, options); !good) {
    return core::fail(good.error());
  }
  const ErrorModel errors(cloud, influences);
  FormTrials trials(cloud, errors, spectrum, options.seed, threads_of(options));
  auto found = run_trials(trials, options);
  if (!found) return found;
  UncertaintyResult& out = *found;
  auto budget = budget_of(trials, errors, cloud, spectrum, options);
  if (!budget) return core::fail(budget.error());
  out.budget = *std::move(budget);
  out.declaration = influence_statements(influences);
  if (spectrum) out.spectrum_source = spectrum->source;
  return found;
}

core::Result<FormCloud> simulated_cloud(const FormCloud& nominal, const Influences& influences,
                                        const FormSpectrum& spectrum, std::uint64_t seed) {
  FormCloud cloud = nominal;
  for (FormPoint& point : cloud.points) point.deviation_mm = 0.0;
  if (const auto good = check_all(cloud, influences, spectrum, {}); !good) {
    return core::fail(good.error());
  }
  const Eigen::MatrixXd columns = spectrum_columns(spectrum, cloud.points);
  core::KeyedNoise noise(seed, {0});
  Eigen::VectorXd deviations;
  ErrorModel(cloud, influences).draw(noise, std::nullopt, deviations);
  for (Eigen::Index k = 0; k < columns.cols(); ++k) deviations += noise.normal() * columns.col(k);
  const Eigen::MatrixXd rigid = rigid_basis(cloud);
  deviations -= rigid * (rigid.transpose() * deviations);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    cloud.points[i].deviation_mm = deviations[static_cast<Eigen::Index>(i)];
  }
  return cloud;
}

}  // namespace rondure::reports
