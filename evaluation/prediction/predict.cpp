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
#include "evaluation/interval/internal/part_intervals.h"
#include "evaluation/part/find.h"
#include "evaluation/part/trials.h"
#include "evaluation/prediction/internal/rehearsal.h"
#include "evaluation/results/evaluation.h"
#include "fit/rotary/ball_center.h"
#include "record/tasks/rotary_axes.h"
#include "record/tasks/settings.h"
#include "record/tasks/uncertainty.h"

namespace rondure::evaluation {
namespace {

constexpr double kWork = 4e6;     // points times trials of a prediction: about one second
constexpr int kFewestOfPart = 3;  // of dense clouds, whose intervals differ little
// cost of a circumscribed or inscribed cylinder, relative to a zone
constexpr double kOneSidedCost = 10.0;
constexpr int kLeastInspections = 8;
constexpr int kLeastTrials = 200;

core::Result<void> check(const PredictionOptions& options) {
  const auto in = [](const char* name, double value, double least,
                     double most) -> core::Result<void> {
    if (value >= least && value <= most) return {};
    return core::fail_with(core::Code::kBadOption, "{} {} is not in {}..{}", name, value, least,
                           most);
  };
  TRY_DO(in("most_inspections", options.most_inspections, kLeastInspections, 10'000));
  TRY_DO(in("least_inspections", options.least_inspections, kLeastInspections,
            options.most_inspections));
  TRY_DO(in("tolerance_1", options.tolerance_1, 0.0, 1e9));
  TRY_DO(in("trials", options.trials, kLeastTrials, 100'000));
  if (options.budget_trials != 0) {
    TRY_DO(in("budget_trials", options.budget_trials, 2, options.trials));
  }
  return in("threads", options.threads, 0, 256);
}

using Results = std::vector<UncertaintyResult>;  ///< Of one value, by inspection.

const UncertaintyStatement* about(const UncertaintyResult& of, Measurand measurand) {
  if (measurand == Measurand::kSampledPoints) return &of.sampled;
  return of.whole ? &*of.whole : nullptr;
}

/// The mean statement about a measurand; none where the inspections state nothing about it.
std::optional<PredictedStatement> mean_statement(const Results& found, Measurand measurand) {
  const auto count = static_cast<double>(found.size());
  PredictedStatement out;
  out.measurand = measurand;
  std::vector<double> widths;
  for (const UncertaintyResult& one : found) {
    const UncertaintyStatement* said = about(one, measurand);
    if (said == nullptr) return std::nullopt;
    out.expected_mm += said->estimate_mm / count;
    out.below_mm += (said->estimate_mm - said->low_mm) / count;
    out.above_mm += (said->high_mm - said->estimate_mm) / count;
    widths.push_back(said->high_mm - said->low_mm);
  }
  std::ranges::sort(widths);
  const std::size_t beyond = widths.size() / 10;
  out.one_of_ten_width_mm = widths[beyond];
  out.nine_of_ten_width_mm = widths[widths.size() - 1 - beyond];
  return out;
}

/// Whether the mean width is known to a given fraction of itself.
bool is_settled(const Results& found, Measurand measurand, double share) {
  std::vector<double> widths;
  for (const UncertaintyResult& one : found) {
    if (const auto* said = about(one, measurand)) widths.push_back(said->high_mm - said->low_mm);
  }
  if (widths.size() < 2) return widths.empty();
  const double mean = core::mean(widths);
  return core::standard_deviation(widths, mean) <=
         share * mean * std::sqrt(static_cast<double>(widths.size()));
}

/// Budget of many inspections: root mean squares of the spreads, means of shifts and shares.
std::vector<BudgetLine> mean_budget(const Results& found) {
  const auto count = static_cast<double>(found.size());
  std::map<std::string, BudgetLine> sums;
  for (const UncertaintyResult& one : found) {
    for (const BudgetLine& line : one.budget) {
      BudgetLine& sum =
          sums.try_emplace(line.name, BudgetLine{line.name, line.measurand}).first->second;
      sum.standard_uncertainty_mm =
          std::hypot(sum.standard_uncertainty_mm, line.standard_uncertainty_mm / std::sqrt(count));
      sum.shift_mm += line.shift_mm / count;
      sum.share_1 += line.share_1 / count;
    }
  }
  std::vector<BudgetLine> out;
  for (const auto& [name, sum] : sums) out.push_back(sum);
  std::ranges::stable_sort(out, std::ranges::greater(), &BudgetLine::standard_uncertainty_mm);
  return out;
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

using Judged = std::vector<UncertaintyStatus>;  ///< Of each judged value.

Judged refused(core::Phrase why) { return {UncertaintyStatus::none(std::move(why))}; }

/// What the inspections of parts state about one characteristic.
class Forecast {
 public:
  void take(const Judged& judged) {
    ++asked_;
    for (const UncertaintyStatus& value : judged) {
      if (value.result()) continue;
      ++refused_;
      why_ = value.why().english();
      return;
    }
    of_value_.resize(judged.size());
    for (std::size_t v = 0; v < judged.size(); ++v) of_value_[v].push_back(*judged[v].result());
  }

  /// A few parts in a hundred have no interval in a run either, e.g. where points scatter little.
  [[nodiscard]] bool is_refused() const { return refused_ > 2 && 10 * refused_ > asked_; }
  [[nodiscard]] bool is_settled(double share) const {
    return std::ranges::all_of(of_value_, [&](const Results& found) {
      return evaluation::is_settled(found, Measurand::kSampledPoints, share) &&
             evaluation::is_settled(found, Measurand::kWholeSurface, share);
    });
  }

  /// The means, of the value with the widest interval.
  [[nodiscard]] Prediction mean(double coverage_1) const {
    if (is_refused() || of_value_.empty()) return none(why_);
    Prediction out;
    for (const Results& found : of_value_) {
      auto sampled = mean_statement(found, Measurand::kSampledPoints);
      if (out.sampled && out.sampled->width_mm() >= sampled->width_mm()) continue;
      out.sampled = std::move(sampled);
      out.whole = mean_statement(found, Measurand::kWholeSurface);
      out.budget = mean_budget(found);
    }
    out.coverage_1 = coverage_1;
    return out;
  }

 private:
  std::vector<Results> of_value_;
  int asked_ = 0;
  int refused_ = 0;
  std::string why_;
};

/// The sections of a simulated cloud about the requested reference, without proofs.
std::vector<LayerResult> sections_of(const FeatureResult& surface, record::Reference reference) {
  const fit::Axis axis = surface.ls_cylinder ? surface.ls_cylinder->axis : surface.section_axis;
  const auto frame = fit::across(axis.direction);
  std::map<int, std::vector<std::size_t>> rows;
  for (std::size_t i = 0; i < surface.cloud.size(); ++i) rows[surface.cloud[i].layer].push_back(i);
  std::vector<LayerResult> out;
  for (auto& [layer, of_layer] : rows) {
    std::vector<Eigen::Vector2d> points;
    for (const std::size_t i : of_layer) {
      points.emplace_back(frame.transpose() * (surface.cloud[i].tip_mm - axis.point_mm));
    }
    LayerResult result{layer, 0.0, std::move(of_layer), fit::min_zone_circle(points),
                       fit::ls_circle(points)};
    if (reference == record::Reference::kMinimumCircumscribed) {
      result.mc = fit::min_circumscribed_circle(points);
    }
    if (reference == record::Reference::kMaximumInscribed)
      result.mi = fit::max_inscribed_circle(points, {.global = false, .search = {}});
    out.push_back(std::move(result));
  }
  return out;
}

/// A characteristic of a record, by its place.
struct Asked {
  std::size_t feature = 0;
  const record::Characteristic* asked = nullptr;
  Prediction* out = nullptr;
};

using Part = std::vector<std::optional<AssumedSurface>>;

/// Simulated inspections and the intervals that a run would state of them, with fewer trials.
class Inspections {
 public:
  Inspections(const record::RunRecord& record, const PredictionOptions& options)
      : record_(record), options_(options), rehearsal_(record) {}

  [[nodiscard]] const Rehearsal& rehearsal() const { return rehearsal_; }

  /// A plain CYLt or RONt, of parts of its own: most parts where trials are quick.
  void foretell_form(const Asked& of) const {
    const auto form = rehearsal_.assumed(of.feature, *of.asked);
    if (!form) {
      *of.out = none(form.error().what);
      return;
    }
    Part part(record_.features.size());
    part[of.feature] = *form;
    inspect({&of, 1}, part, kWork / cost_of(of, form->form), kLeastInspections,
            [&](std::vector<FeatureResult>& features, int k) {
              return std::vector<Judged>{form_status(features[of.feature], of, k)};
            });
  }

  /// All that find() computes, of common parts and with common trials: about as many as in a run.
  void foretell_part(std::span<const Asked> all) const {
    if (all.empty()) return;
    const Part part = rehearsal_.assumed_part();
    const double most = static_cast<double>(surface(all.front()).declared.options.most_trials);
    inspect(all, part, std::min(kWorkOfPart / cost_of(all, part), most), kFewestOfPart,
            [&](const std::vector<FeatureResult>& features, int k) {
              return part_statuses(features, all, k);
            });
  }

 private:
  [[nodiscard]] const RehearsedSurface& surface(const Asked& of) const {
    return rehearsal_.surfaces()[of.feature];
  }

  /// Points that a trial of a plain form takes.
  [[nodiscard]] double cost_of(const Asked& of, const FormSpectrum& form) const {
    auto cost = static_cast<double>(surface(of).rows.size());
    if (options_.whole_surface && surface(of).declared.spectrum) {
      const double coefficients = 2.0 * static_cast<double>(form.terms.size());
      cost += static_cast<double>(grid_places(form, surface(of).chart->cloud.kind)) *
              (1.0 + coefficients / 40);
    }
    const bool one_sided = of.asked->reference == record::Reference::kMinimumCircumscribed ||
                           of.asked->reference == record::Reference::kMaximumInscribed;
    return one_sided && of.asked->form == record::Form::kCylindricity ? cost * kOneSidedCost : cost;
  }

  /// Points that a trial of a part takes.
  [[nodiscard]] double cost_of(std::span<const Asked> all, const Part& part) const {
    double cost = 0.0;
    for (const Asked& of : all) {
      cost += kPointsOfCall + static_cast<double>(surface(of).rows.size());
    }
    const auto features = rehearsal_.inspected(part, options_.seed + 1);
    if (!features) return cost;
    const std::vector<MeasuredSurface> surfaces = surfaces_of(*features);
    const PartState read(surfaces);
    for (const Asked& of : all) (void)find(read, of.feature, *of.asked, Proof::kNone);
    return cost + kPointsOfPivot * read.pivots();
  }

  /// Inspects simulated parts and combines what is stated of them.
  /// @param trials  Of all parts together.
  /// @param fewest  Inspections in any case.
  template <class States>
  void inspect(std::span<const Asked> all, const Part& part, double trials, int fewest,
               const States& states) const {
    const core::Working work(fmt::format(
        "predicting U: {}, {}", record_.features[all.front().feature].id, all.front().asked->id));
    const int affordable = std::max(fewest, static_cast<int>(trials / options_.trials));
    const int most = std::min(options_.most_inspections, affordable);
    const int least = std::min(options_.least_inspections, affordable);
    std::vector<Forecast> forecasts(all.size());
    const auto all_are = [&](const auto& what) { return std::ranges::all_of(forecasts, what); };
    for (int k = 1; k <= most && !all_are(&Forecast::is_refused); ++k) {
      if (k > least && all_are([&](const Forecast& of) {
            return of.is_refused() || of.is_settled(options_.tolerance_1);
          })) {
        break;
      }
      auto features = rehearsal_.inspected(part, options_.seed + static_cast<std::uint64_t>(k));
      const auto stated = features ? states(*features, k)
                                   : std::vector(all.size(), refused(features.error().said()));
      for (std::size_t i = 0; i < all.size(); ++i) forecasts[i].take(stated[i]);
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      Prediction& out = *all[i].out = forecasts[i].mean(surface(all[i]).declared.options.coverage);
      if (!out.why.empty()) continue;
      if (const auto& assumed = part[all[i].feature]) out.form = assumed->form.source.english();
      out.repeatability = surface(all[i]).repeatability;
    }
  }

  [[nodiscard]] Judged form_status(FeatureResult& read, const Asked& of, int k) const {
    if (of.asked->form == record::Form::kRoundness) {
      read.layers = sections_of(read, of.asked->reference);
    }
    auto question = uncertainty_question(record_, read, std::nullopt, *of.asked);
    if (!question) return refused(question.error());
    if (!options_.whole_surface) question->spectrum.reset();
    auto found = measurement_uncertainty(question->cloud, question->influences, question->spectrum,
                                         trials_of(question->options, options_, k));
    if (!found) return refused(found.error().said());
    return {UncertaintyStatus::stated(*std::move(found), question->options.coverage)};
  }

  [[nodiscard]] std::vector<Judged> part_statuses(const std::vector<FeatureResult>& features,
                                                  std::span<const Asked> all, int k) const {
    const std::vector<MeasuredSurface> surfaces = surfaces_of(features);
    const PartState part(surfaces);
    std::vector<Judged> out(all.size());
    std::vector<core::Result<Finding>> findings;
    for (const Asked& of : all) {
      findings.push_back(find(part, of.feature, *of.asked, Proof::kNone));
    }
    std::vector<PartQuestion> questions;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!findings[i]) {
        out[i] = refused(findings[i].error().said());
        continue;
      }
      questions.push_back({all[i].feature, all[i].asked, &*findings[i]});
      places.push_back(i);
    }
    auto found = intervals_of(record_, features, rehearsal_.probe(), questions,
                              trials_of(surface(all.front()).declared.options, options_, k));
    for (std::size_t q = 0; q < found.size(); ++q) out[places[q]] = std::move(found[q].judged);
    return out;
  }

  const record::RunRecord& record_;
  const PredictionOptions& options_;
  Rehearsal rehearsal_;
};

/// Why no interval of a feature is predicted, whatever is asked of it.
std::optional<std::string> why_none(const record::RunRecord& expected,
                                    const record::Feature& feature) {
  if (record::is_analysis(feature.shape)) {
    return fmt::format("intervals are stated of touched surfaces; this is one of type {}",
                       record::name_of(feature.shape));
  }
  if (feature.strategy == record::Strategy::kPointsFile) {
    return "its points come from a file: a run states the interval at once";
  }
  if (auto why = why_no_interval(expected, feature)) return why->english();
  return std::nullopt;
}

}  // namespace

std::vector<std::string> undeclared_influences(const record::UncertaintyTask& said,
                                               const std::optional<double>& expansion_per_K,
                                               bool repeated) {
  record::RunRecord run;
  run.settings = record::settings_of_uncertainty(said, expansion_per_K);
  FeatureResult feature;
  record::ExpansionSettings expansion;
  expansion.part_expansion_per_K = expansion_per_K;
  if (expansion_per_K) expansion.temperature_uncertainty_K = 0.0;  // stated, if only by default
  feature.feature.settings = record::settings_of_task(expansion);
  if (repeated) feature.repeat_sigma_mm = 0.0;
  std::vector<std::string> out;
  const auto declared = declared_for(run, feature, std::nullopt);
  if (!declared) return out;
  for (const InfluenceStatement& line : influence_statements(declared->influences)) {
    // Declared without the expansion that they need.
    const bool idle = line.name.starts_with("temperature") && said.thermal;
    if (!line.covered && (idle || line.text == core::phrase("not declared"))) {
      out.push_back(line.name);
    }
  }
  return out;
}

core::Result<std::vector<std::vector<Prediction>>> predict(const record::RunRecord& expected,
                                                           std::span<const int> features,
                                                           const PredictionOptions& options) {
  TRY_DO(check(options));
  std::vector<std::vector<Prediction>> out;
  for (const int f : features) {
    if (f < 0 || static_cast<std::size_t>(f) >= expected.features.size()) {
      return core::fail_with(core::Code::kBadOption, "feature {} is outside 0..{}", f,
                             static_cast<int>(expected.features.size()) - 1);
    }
    out.emplace_back(expected.features[static_cast<std::size_t>(f)].characteristics.size());
  }
  const Inspections inspections(expected, options);
  std::vector<Asked> of_part;
  for (std::size_t k = 0; k < features.size(); ++k) {
    const auto f = static_cast<std::size_t>(features[k]);
    const record::Feature& feature = expected.features[f];
    auto why = why_none(expected, feature);
    const auto& chart = inspections.rehearsal().surfaces()[f].chart;
    if (!why && !chart) why = chart.error().what;
    for (std::size_t c = 0; c < out[k].size(); ++c) {
      const Asked of{f, &feature.characteristics[c], &out[k][c]};
      if (why || of.asked->form == record::Form::kHarmonicLimits) {
        out[k][c] = none(why.value_or("a run states no interval of it"));
      } else if (!is_found(feature, *of.asked)) {
        inspections.foretell_form(of);
      } else if (!options.plain_forms_only) {
        of_part.push_back(of);
      } else {
        out[k][c] = none(
            "a sampling is searched for CYLt and RONt without filter, portion or window alone");
      }
    }
  }
  inspections.foretell_part(of_part);
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
  const double sigma_mm = expected.artefact.form_limit_mm / kRangeOf25Touches;
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
