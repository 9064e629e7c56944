#include "evaluation/prediction/predict.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/statistics.h"
#include "core/units.h"
#include "core/watch.h"
#include "evaluation/analysis.h"
#include "evaluation/analysis_result.h"
#include "evaluation/interval/internal/declared.h"
#include "evaluation/interval/internal/form_interval.h"
#include "evaluation/prediction/internal/expected_form.h"
#include "evaluation/results/evaluation.h"
#include "fit/rotary/ball_center.h"
#include "record/tasks/rotary_axes.h"
#include "record/tasks/settings.h"
#include "record/tasks/uncertainty.h"

namespace rondure::evaluation {
namespace {

/// Mean range of 25 normal values: the touches of the qualification sphere (influences.h).
constexpr double kRangeOf25 = 3.93;
constexpr double kWork = 4e6;  // points times trials of a prediction: about one second
// cost of a circumscribed or inscribed cylinder, relative to a zone
constexpr double kOneSidedCost = 10.0;
constexpr int kLeastInspections = 8;
constexpr int kLeastTrials = 200;

core::Result<void> check(const PredictionOptions& options) {
  const auto bad = [](const char* name, auto value, const char* limit) {
    return core::fail_with(core::Code::kBadOption, "{} {} is not {}", name, value, limit);
  };
  if (options.least_inspections < kLeastInspections) {
    return bad("least_inspections", options.least_inspections, ">= 8");
  }
  if (options.most_inspections < options.least_inspections || options.most_inspections > 10'000) {
    return bad("most_inspections", options.most_inspections, "in least_inspections..10000");
  }
  if (!(options.tolerance_1 >= 0.0 && std::isfinite(options.tolerance_1))) {
    return bad("tolerance_1", options.tolerance_1, ">= 0");
  }
  if (options.trials < kLeastTrials || options.trials > 100'000) {
    return bad("trials", options.trials, "in 200..100000");
  }
  if (options.budget_trials < 0 || options.budget_trials == 1 ||
      options.budget_trials > options.trials) {
    return bad("budget_trials", options.budget_trials, "0 or in 2..trials");
  }
  if (options.threads < 0 || options.threads > 256) {
    return bad("threads", options.threads, "in 0..256");
  }
  return {};
}

/// Uses fewer parts for clouds and spectra whose trials take long.
PredictionOptions affordable(const FormCloud& cloud, const FormSpectrum& form, bool whole,
                             const record::Characteristic& asked, PredictionOptions options) {
  auto cost = static_cast<double>(cloud.points.size());
  if (whole) {
    const double coefficients = 2.0 * static_cast<double>(form.terms.size());
    cost += static_cast<double>(grid_places(form, cloud.kind)) * (1.0 + coefficients / 40);
  }
  const bool one_sided = asked.reference == record::Reference::kMinimumCircumscribed ||
                         asked.reference == record::Reference::kMaximumInscribed;
  if (one_sided && asked.form == record::Form::kCylindricity) cost *= kOneSidedCost;
  const int most = std::max(kLeastInspections, static_cast<int>(kWork / cost / options.trials));
  options.most_inspections = std::min(options.most_inspections, most);
  options.least_inspections = std::min(options.least_inspections, most);
  return options;
}

/// The statements of all inspections about one measurand.
class Statements {
 public:
  void take(const UncertaintyStatement& said) {
    sum_.expected_mm += said.estimate_mm;
    sum_.below_mm += said.estimate_mm - said.low_mm;
    sum_.above_mm += said.high_mm - said.estimate_mm;
    widths_.push_back(said.high_mm - said.low_mm);
  }

  /// Whether the mean width is known to a given fraction of itself.
  [[nodiscard]] bool settled(double share) const {
    const auto count = static_cast<double>(widths_.size());
    if (count < 2.0) return widths_.empty();
    const double mean = core::mean(widths_);
    return core::standard_deviation(widths_, mean) <= share * mean * std::sqrt(count);
  }

  [[nodiscard]] std::optional<PredictedStatement> mean(Measurand measurand) {
    if (widths_.empty()) return std::nullopt;
    const auto count = static_cast<double>(widths_.size());
    PredictedStatement out = sum_;
    out.measurand = measurand;
    out.expected_mm /= count;
    out.below_mm /= count;
    out.above_mm /= count;
    std::sort(widths_.begin(), widths_.end());
    const std::size_t beyond = widths_.size() / 10;
    out.one_of_ten_width_mm = widths_[beyond];
    out.nine_of_ten_width_mm = widths_[widths_.size() - 1 - beyond];
    return out;
  }

 private:
  PredictedStatement sum_;
  std::vector<double> widths_;
};

/// Combines the budgets of many inspections: root mean squares of spreads and shares.
class Budgets {
 public:
  void take(const std::vector<BudgetLine>& lines) {
    ++count_;
    for (const BudgetLine& line : lines) {
      BudgetLine& sum =
          sums_.try_emplace(line.name, BudgetLine{line.name, line.measurand}).first->second;
      sum.standard_uncertainty_mm += line.standard_uncertainty_mm * line.standard_uncertainty_mm;
      sum.shift_mm += line.shift_mm;
      sum.share_1 += line.share_1;
    }
  }

  [[nodiscard]] std::vector<BudgetLine> mean() const {
    std::vector<BudgetLine> out;
    for (const auto& [name, sum] : sums_) {
      BudgetLine line = sum;
      line.standard_uncertainty_mm = std::sqrt(sum.standard_uncertainty_mm / count_);
      line.shift_mm /= count_;
      line.share_1 /= count_;
      out.push_back(line);
    }
    std::stable_sort(out.begin(), out.end(), [](const BudgetLine& a, const BudgetLine& b) {
      return a.standard_uncertainty_mm > b.standard_uncertainty_mm;
    });
    return out;
  }

 private:
  std::map<std::string, BudgetLine> sums_;
  double count_ = 0.0;
};

/// The repeatability that the run would determine itself; also describes the assumption in words.
std::string assume_repeatability(const record::RunRecord& record, TrialInspection& rehearsal) {
  const auto declared = declared_for(record, rehearsal.result(), std::nullopt);
  if (!declared || !declared->influences.probe) return {};
  const auto recorded = record::recorded_uncertainty(record.settings);
  if (recorded && *recorded && (*recorded)->task.probe &&
      (*recorded)->task.probe->repeatability_um) {
    return {};
  }
  if (declared->influences.probe->form_limit_mm > 0.0) return "within the declared probing form";
  const auto& cloud = rehearsal.result().cloud;
  const bool repeats = std::any_of(cloud.begin(), cloud.end(),
                                   [](const CloudPoint& point) { return point.repeats > 1; });
  if (!repeats) return {};
  const double sigma_mm = record.artefact.form_limit_mm / kRangeOf25;
  rehearsal.assume_repeatability(sigma_mm);
  return fmt::format("{:.2g} um, the most that the qualification lets pass",
                     sigma_mm / core::kMicrometre);
}

Prediction none(std::string why) {
  Prediction out;
  out.why = std::move(why);
  return out;
}

UncertaintyOptions trials_of(const UncertaintyOptions& declared, const PredictionOptions& options,
                             int inspection) {
  UncertaintyOptions out = declared;
  out.tolerance_mm = 0.0;
  out.chains = 2;
  out.least_trials = options.trials;
  out.most_trials = options.trials;
  out.budget_trials = options.budget_trials;
  out.seed = options.seed + static_cast<std::uint64_t>(inspection);
  out.threads = options.threads;
  return out;
}

/// Inspects simulated parts and combines their statements.
Prediction rehearsed(const record::RunRecord& record, const TrialInspection& rehearsal,
                     const Declared& declared, const FormSpectrum& form,
                     const record::Characteristic& asked, const PredictionOptions& options) {
  Statements sampled;
  Statements whole;
  Budgets budgets;
  Prediction out;
  for (int k = 1; k <= options.most_inspections; ++k) {
    const bool known = sampled.settled(options.tolerance_1) && whole.settled(options.tolerance_1);
    if (k > options.least_inspections && known) break;
    const auto part = simulated_cloud(rehearsal.nominal(), declared.influences, form,
                                      options.seed + static_cast<std::uint64_t>(k));
    if (!part) return none(part.error().what);
    auto question =
        uncertainty_question(record, rehearsal.result_of(*part, asked), std::nullopt, asked);
    if (!question) return none(question.error());
    if (!options.whole_surface) question->spectrum.reset();
    const auto found =
        measurement_uncertainty(question->cloud, question->influences, question->spectrum,
                                trials_of(question->options, options, k));
    if (!found) return none(found.error().what);
    sampled.take(found->sampled);
    if (found->whole) whole.take(*found->whole);
    budgets.take(found->budget);
  }
  out.coverage_1 = declared.options.coverage;
  out.sampled = sampled.mean(Measurand::kSampledPoints);
  out.whole = whole.mean(Measurand::kWholeSurface);
  out.form = form.source;
  out.budget = budgets.mean();
  return out;
}

}  // namespace

std::vector<std::string> undeclared_influences(const record::UncertaintyTask& said,
                                               const std::optional<double>& expansion_per_K,
                                               bool repeated) {
  record::RunRecord run;
  run.settings = record::settings_of_uncertainty(said, expansion_per_K);
  FeatureResult feature;
  if (repeated) feature.repeat_sigma_mm = 0.0;
  std::vector<std::string> out;
  const auto declared = declared_for(run, feature, std::nullopt);
  if (!declared) return out;
  for (const InfluenceStatement& line : influence_statements(declared->influences)) {
    if (!line.covered && line.text == core::phrase("not declared")) out.push_back(line.name);
  }
  return out;
}

core::Result<Prediction> predict(const record::RunRecord& expected, int feature,
                                 const record::Characteristic& asked,
                                 const PredictionOptions& options) {
  TRY_DO(check(options));
  if (feature < 0 || static_cast<std::size_t>(feature) >= expected.features.size()) {
    return core::fail_with(core::Code::kBadOption, "feature {} is outside 0..{}", feature,
                           static_cast<int>(expected.features.size()) - 1);
  }
  const record::Feature& of = expected.features[static_cast<std::size_t>(feature)];
  if (record::is_analysis(of.shape)) {
    return none(fmt::format("intervals are stated of cylinders and circles; this is one of type {}",
                            record::name_of(of.shape)));
  }
  if (of.strategy == record::Strategy::kPointsFile) {
    return none("its points come from a file: a run states the interval at once");
  }
  if (asked.form != record::Form::kCylindricity && asked.form != record::Form::kRoundness) {
    return none(
        "only intervals of CYLt and RONt are predicted; the run computes those of the others");
  }
  if (auto why = why_no_interval(expected, of)) return none(*std::move(why));
  const core::Working work(fmt::format("predicting U: {}, {}", of.id, asked.id));
  auto rehearsal = TrialInspection::of(expected, feature);
  if (!rehearsal) return none(rehearsal.error().what);
  std::string repeatability = assume_repeatability(expected, *rehearsal);
  const auto declared = declared_for(expected, rehearsal->result(), std::nullopt);
  const auto form = expected_form(*rehearsal, *declared, asked);
  if (!form) return none(form.error().what);
  const bool about_whole = declared->spectrum.has_value() && options.whole_surface;
  Prediction out = rehearsed(expected, *rehearsal, *declared, *form, asked,
                             affordable(rehearsal->nominal(), *form, about_whole, asked, options));
  if (out.why.empty()) out.repeatability = std::move(repeatability);
  return out;
}

namespace {

AnalysisPrediction nothing(std::string why) {
  AnalysisPrediction out;
  out.why = std::move(why);
  return out;
}

AnalysisPrediction foretold(const AnalysisResult& result, const record::Characteristic& asked,
                            const UncertaintyStatus& interval) {
  if (auto why = why_not_foretold(asked.form)) return nothing(*std::move(why));
  const auto value = value_of(result, asked);
  if (!value) return nothing(value.error().what);
  if (value->void_because) {
    return nothing(fmt::format("the simulated data give no value that proves anything: {}",
                               value->void_because->english()));
  }
  const UncertaintyStatement* said = interval.about(Measurand::kSampledPoints);
  if (said == nullptr) return nothing(interval.why().english());
  AnalysisPrediction out;
  out.coverage_1 = interval.coverage_1();
  out.as_read_mm = value->value_mm;
  out.at_most = said->at_most;
  out.expected_mm = said->at_most ? said->high_mm : said->estimate_mm;
  out.below_mm = out.expected_mm - said->low_mm;
  out.above_mm = said->high_mm - out.expected_mm;
  out.budget = interval.result()->budget;
  double variance_mm2 = 0.0;
  for (const BudgetLine& line : out.budget) {
    variance_mm2 += line.standard_uncertainty_mm * line.standard_uncertainty_mm;
  }
  out.linear_u_mm = std::sqrt(variance_mm2);
  return out;
}

}  // namespace

std::optional<std::string> why_not_foretold(record::Form form) {
  switch (form) {
    case record::Form::kMotionAsynchronous:
      return "it is what differs from turn to turn, and only readings show that";
    case record::Form::kContourSpread:
      return "it is what differs from part to part, and only measured parts show that";
    case record::Form::kFixtureResidual:
    case record::Form::kFixtureResidualRms:
      return "it is what the axes do together beyond their calibration, and only the fixture shows "
             "that";
    case record::Form::kLeftRms:
    case record::Form::kLeftLargest:
      return "it is what the axes do together beyond their errors, and only readings show that";
    case record::Form::kAxisError:
      return "it is an error of the axis itself, and only measured balls show that";
    default:
      return std::nullopt;
  }
}

core::Result<std::vector<AnalysisPrediction>> predict_analysis(const record::RunRecord& simulated,
                                                               int feature) {
  const bool exists = feature >= 0 && static_cast<std::size_t>(feature) < simulated.features.size();
  const record::Feature* of =
      exists ? &simulated.features[static_cast<std::size_t>(feature)] : nullptr;
  if (of == nullptr || !record::is_analysis(of->shape) || of->shape == record::Shape::kRotaryAxes) {
    return core::fail_with(core::Code::kBadOption, "feature {} is no analysis of series", feature);
  }
  std::vector<FeatureResult> wheels;  // and heads: no other feature gives a value to a later one
  for (int i = 0; i < feature; ++i) {
    const record::Shape shape = simulated.features[static_cast<std::size_t>(i)].shape;
    if (shape != record::Shape::kWheel && shape != record::Shape::kFiveAxis) continue;
    wheels.push_back(evaluate_analysis(simulated, i, std::nullopt, wheels));
  }
  const FeatureResult result = evaluate_analysis(simulated, feature, std::nullopt, wheels);
  if (!result.analysis) {
    const std::string why =
        result.failure ? result.failure->what : std::string("there is no result");
    return std::vector<AnalysisPrediction>(of->characteristics.size(), nothing(why));
  }
  const auto intervals =
      intervals_of(*result.analysis, of->characteristics, uncertainty_options(simulated));
  std::vector<AnalysisPrediction> out;
  for (std::size_t c = 0; c < of->characteristics.size(); ++c) {
    out.push_back(foretold(*result.analysis, of->characteristics[c], intervals[c]));
  }
  return out;
}

namespace {

constexpr double kMeanRangeOf25 = 3.93;  // of normal values: the touches of the qualification

ResidualPrediction no_residual(std::string why) {
  ResidualPrediction out;
  out.why = std::move(why);
  return out;
}

/// Standard deviation of a touch, with its source in words.
std::pair<double, std::string> touch_scatter(const record::RunRecord& expected) {
  const auto recorded = record::recorded_uncertainty(expected.settings);
  if (recorded && *recorded && (*recorded)->task.probe &&
      (*recorded)->task.probe->repeatability_um) {
    const double sigma_um = *(*recorded)->task.probe->repeatability_um;
    return {sigma_um * core::kMicrometre, fmt::format("{:.2g} um, as declared", sigma_um)};
  }
  const double sigma_mm = expected.artefact.form_limit_mm / kMeanRangeOf25;
  return {sigma_mm, fmt::format("{:.2g} um, the most that the qualification lets pass",
                                sigma_mm / core::kMicrometre)};
}

}  // namespace

core::Result<ResidualPrediction> predict_residual(const record::RunRecord& expected, int feature,
                                                  std::span<const BallTouches> combined) {
  const bool exists = feature >= 0 && static_cast<std::size_t>(feature) < expected.features.size();
  if (!exists ||
      expected.features[static_cast<std::size_t>(feature)].shape != record::Shape::kRotaryAxes) {
    return core::fail_with(core::Code::kBadOption, "feature {} is no calibration of a fixture",
                           feature);
  }
  const core::Working work("predicting U of the calibration");
  TRY(const auto task, record::task_of<record::RotaryTask>(
                           expected.features[static_cast<std::size_t>(feature)].settings));
  if (!task.uncertainty) {
    return no_residual(
        "no influence is declared: state `uncertainty` of `rotary_axes`, with `ball_um`, "
        "`repeat_urad` and `reading_urad`");
  }
  if (combined.empty()) return no_residual("no combined pose is planned");
  const auto [sigma_mm, words] = touch_scatter(expected);
  const double radius_mm = 0.5 * task.ball_diameter_mm + expected.artefact.nominal_tip_radius_mm;
  double cofactors = 0.0;
  for (const BallTouches& tips : combined) {
    const auto center = fit::ball_center(tips, radius_mm);
    if (!center) return no_residual(center.error().what);
    cofactors += center->cofactor.trace() / 3.0;
  }
  ResidualPrediction out;
  out.centers = combined.size();
  const auto count = static_cast<double>(combined.size());
  out.center_u_mm = std::hypot(sigma_mm * std::sqrt(cofactors / count),
                               record::u_of(task.uncertainty->ball_um) * core::kMicrometre);
  out.rms_u_mm = out.center_u_mm / std::sqrt(count);
  out.largest_u_mm = out.center_u_mm;
  out.repeatability = words;
  return out;
}

}  // namespace rondure::evaluation
