#include "evaluation/factors/study.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "core/watch.h"
#include "evaluation/analysis_result.h"
#include "evaluation/part/find.h"
#include "evaluation/part/outliers.h"
#include "evaluation/results/feature_values.h"
#include "record/tasks/form_facts.h"

namespace rondure::evaluation {
namespace {

using core::signed_um;
using Indication = record::Indication;
using record::Reference;
using Rows = std::vector<std::size_t>;  // of the cloud of a feature

constexpr std::array kStudiedReferences = {Reference::kLeastSquares, Reference::kMinimumZone,
                                           Reference::kMinimumCircumscribed,
                                           Reference::kMaximumInscribed};
constexpr double kRoundOffMm = 1e-9;  ///< Smaller changes count as none.

/// The section of an analysis as a circle: of a wheel all points as given, with those that a robust
/// centre leaves out; of a spindle the recovered profile before its filter, on a circle so large
/// that fitted circles are those of the limacon model.
core::Result<FeatureResult> circle_of(const AnalysisResult& analysis) {
  std::vector<Eigen::Vector2d> points;
  if (const auto* wheel = std::get_if<WheelResult>(&analysis.found)) {
    for (const Eigen::Vector2d& p : wheel->points_mm)
      points.push_back(p - wheel->evaluation.wheel.center_mm);
  } else if (const auto* spindle = std::get_if<SpindleResult>(&analysis.found)) {
    // A shift e of the centre changes the deviations by e^2 / 2R: below 1e-6 um for e = 1 um.
    constexpr double kRadius_mm = 1000.0;
    const fit::UniformProfile& profile = spindle->separation.profile;
    for (std::size_t i = 0; i < profile.r_mm.size(); ++i) {
      const double angle = profile.angle_rad(i);
      points.push_back((kRadius_mm + profile.r_mm[i]) *
                       Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
  } else {
    return core::fail(core::Code::kNoPoints, "the readings of this analysis form no section");
  }
  FeatureResult out;
  out.feature.shape = record::Shape::kCircle;
  out.feature.strategy = record::Strategy::kPointsFile;
  for (const Eigen::Vector2d& p : points) {
    CloudPoint& point = out.cloud.emplace_back();
    point.tip_mm.head<2>() = p;
    point.angle_rad = std::atan2(p.y(), p.x());
  }
  return out;
}

/// What the report answers, as find() is asked; outliers are left out as rows. The filter of a
/// spindle stands in its result.
Indication reported_indication(const FeatureResult& feature, const Indication& asked) {
  Indication out = asked;
  out.outliers = Indication::Outliers::kNone;
  out.filter = out.filter.value_or(Indication::Filter::kNone);
  const auto* spindle =
      feature.analysis ? std::get_if<SpindleResult>(&feature.analysis->found) : nullptr;
  if (spindle != nullptr && spindle->roundness.filter.filter != fit::ProfileFilter::kNone) {
    out.filter = Indication::Filter::kGaussian;
    out.cutoff_upr = spindle->roundness.filter.cutoff_upr;
  }
  if (out.filter == Indication::Filter::kNone) out.cutoff_upr = out.cutoff_mm = std::nullopt;
  return out;
}

bool same_filter(const Indication& a, const Indication& b) {
  return a.filter == b.filter && a.cutoff_upr == b.cutoff_upr && a.cutoff_mm == b.cutoff_mm;
}

/// The filters that are tried, by cut-off; that of the report is among them.
std::vector<Indication> filters_of(const Indication& reported) {
  std::vector<Indication> out;
  for (const double cutoff_upr : {0.0, 15.0, 50.0, 150.0}) {
    const bool none = cutoff_upr == 0.0;
    Indication& one = out.emplace_back(reported);
    one.filter = none ? Indication::Filter::kNone : Indication::Filter::kGaussian;
    one.cutoff_upr = none ? std::nullopt : std::optional(cutoff_upr);
    one.cutoff_mm.reset();
  }
  const auto is_reported = [&](const Indication& one) { return same_filter(one, reported); };
  if (std::ranges::none_of(out, is_reported)) {
    out.insert(std::ranges::upper_bound(out, reported.cutoff_upr, {}, &Indication::cutoff_upr),
               reported);
  }
  return out;
}

/// @param finding  Of the report; null where find() did not compute the value.
std::string name_of_filter(const Indication& one, const Finding* finding) {
  if (one.filter == Indication::Filter::kNone) return "unfiltered";
  if (finding != nullptr && (one.filter != Indication::Filter::kGaussian || one.cutoff_mm))
    return finding->filter.english();
  return fmt::format("Gaussian {:g} UPR", *one.cutoff_upr);
}

/// The points of a feature outside its windows by layer, in the order in which they are thinned:
/// by angle, half a step before the first point, so that its neighbour is not the last. One list in
/// the order of the data where the layers are not known.
std::vector<Rows> rows_by_layer(const FeatureResult& feature, bool layers_known) {
  const auto& cloud = feature.cloud;
  std::map<int, Rows> layers;
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    if (!cloud[row].left_out) layers[layers_known ? cloud[row].layer : 0].push_back(row);
  }
  std::vector<Rows> out;
  for (auto& [number, rows] : layers) {
    const double from =
        cloud[rows.front()].angle_rad - 0.5 * core::kTwoPi / static_cast<double>(rows.size());
    const auto angle = [&](std::size_t row) {
      const double turned = std::fmod(cloud[row].angle_rad - from, core::kTwoPi);
      return turned < 0.0 ? turned + core::kTwoPi : turned;
    };
    if (layers_known) std::ranges::stable_sort(rows, {}, angle);
    out.push_back(std::move(rows));
  }
  return out;
}

/// Points that another sampling plan would not have touched.
struct Sampling {
  std::string name;
  Rows left_out;
};

/// The samplings that make sense: leaving out layers needs at least two.
std::vector<Sampling> samplings_of(const std::vector<Rows>& layers) {
  std::vector<Sampling> out = {{"all points", {}},          {"points 1, 3, 5, ...", {}},
                               {"points 2, 4, 6, ...", {}}, {"layers 1, 3, 5, ...", {}},
                               {"layers 2, 4, 6, ...", {}}, {"first layer left out", {}},
                               {"last layer left out", {}}};
  if (layers.size() < 2) out.resize(3);
  for (std::size_t l = 0; l < layers.size(); ++l) {
    for (std::size_t i = 0; i < layers[l].size(); ++i) {
      const std::array gone = {
          false, i % 2 == 1, i % 2 == 0, l % 2 == 1, l % 2 == 0, l == 0, l + 1 == layers.size()};
      for (std::size_t s = 0; s < out.size(); ++s) {
        if (gone[s]) out[s].left_out.push_back(layers[l][i]);
      }
    }
  }
  return out;
}

/// Marks what lies beyond three standard deviations, s^2 = sum d^2 / (n - p).
std::vector<bool> beyond_three_sigma(const std::vector<double>& off_mm, record::Shape shape) {
  const double parameters = shape == record::Shape::kCylinder ? 5.0 : 3.0;
  const double freedoms = static_cast<double>(off_mm.size()) - parameters;
  const double mean_mm = core::mean(off_mm);
  double squares = 0.0;
  for (const double off : off_mm) squares += (off - mean_mm) * (off - mean_mm);
  const double limit_mm = freedoms > 0.0 ? 3.0 * std::sqrt(squares / freedoms) : HUGE_VAL;
  std::vector<bool> out;
  for (const double off : off_mm) out.push_back(std::abs(off - mean_mm) > limit_mm);
  return out;
}

/// The rows that a rule leaves out, about the least-squares feature of the points that take part.
core::Result<Rows> outliers_of(const core::Result<PreparedSurface>& sampled, bool medians) {
  if (!sampled) return core::fail(sampled.error());
  std::vector<double> off_mm;
  for (const Eigen::Vector3d& p : sampled->points_mm)
    off_mm.push_back(fit::distance_mm(sampled->axis, p));
  const auto beyond =
      medians ? beyond_five_scales(off_mm) : beyond_three_sigma(off_mm, sampled->of->feature.shape);
  TRY_DO(count_of_outliers(beyond));
  Rows out;
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    if (beyond[i]) out.push_back(sampled->rows[i]);
  }
  return out;
}

/// Why a plan could not have the rule of medians: what lies off is form.
std::optional<core::Error> no_medians(const MeasuredSurface& surface) {
  Indication rule;
  rule.outliers = Indication::Outliers::kFiveScales;
  const auto points = prepared(surface, rule);
  return points ? std::optional<core::Error>() : points.error();
}

/// Why there is no value, without what follows from it and what to plan instead.
std::string cause_of(const core::Error& error) {
  const std::string& what = error.what;
  const std::size_t from = what.starts_with("layer ") ? what.find(": ") + 1 : 0;
  return what.substr(0, std::min(what.find("; "), what.find(": ", from)));
}

/// The points of a study and the questions that are asked of them.
struct Studied {
  MeasuredSurface surface;
  std::size_t points = 0;  ///< Number outside windows.
  record::Characteristic asked;
  std::vector<Indication> filters;
  std::vector<Sampling> samplings;
  std::optional<core::Error> no_medians;  ///< Why a plan could not have the rule of medians.
};

/// Names all levels, and says which are those of the report.
void name_levels(const Studied& of, const Indication& reported, const Finding* finding,
                 FactorStudy& study) {
  const record::Shape about = *record::facts_of(of.asked.form).about;
  for (std::size_t r = 0; r < kStudiedReferences.size(); ++r) {
    study.levels[at(Factor::kReference)].push_back(reference_of(kStudiedReferences[r], about));
    if (kStudiedReferences[r] == of.asked.reference) study.reported[at(Factor::kReference)] = r;
  }
  for (std::size_t f = 0; f < of.filters.size(); ++f) {
    study.levels[at(Factor::kFilter)].push_back(name_of_filter(of.filters[f], finding));
    if (same_filter(of.filters[f], reported)) study.reported[at(Factor::kFilter)] = f;
  }
  study.levels[at(Factor::kOutliers)] = {"none", "3 sigma", "5 medians"};
  const bool by_rule = of.asked.indication.outliers == Indication::Outliers::kFiveScales;
  study.reported[at(Factor::kOutliers)] = by_rule ? 2 : 0;
  for (const Sampling& sampling : of.samplings)
    study.levels[at(Factor::kSampling)].push_back(sampling.name);
}

/// Fills the cells of some points: every filter and reference.
void fill_points(const Studied& of, const MeasuredSurface& points, std::size_t o, std::size_t s,
                 FactorStudy& study) {
  const PartState part({&points, 1});
  record::Characteristic asked = of.asked;
  for (std::size_t f = 0; f < of.filters.size(); ++f) {
    asked.indication = of.filters[f];
    for (std::size_t r = 0; r < kStudiedReferences.size(); ++r) {
      asked.reference = kStudiedReferences[r];
      const auto found = find(part, 0, asked, Proof::kNone);
      FactorCell& cell = study.cells[study.index({r, f, o, s})];
      if (found) cell.value_mm = found->judged.front().value_mm;
      if (!found) cell.why = cause_of(found.error());
    }
  }
}

/// Fills the cells of a sampling. An outlier rule that leaves out nothing has the cells of none.
void fill_sampling(const Studied& of, std::size_t s, FactorStudy& study) {
  MeasuredSurface sampled = without_rows(of.surface, of.samplings[s].left_out);
  fill_points(of, sampled, 0, s, study);
  sampled.across.reset();
  const auto about_ls = prepared(sampled, {});
  sampled.across = of.surface.across;
  for (std::size_t o = 0; o < study.levels[at(Factor::kOutliers)].size(); ++o) {
    core::Result<Rows> outliers;
    if (o == 1 || (o == 2 && !of.no_medians)) outliers = outliers_of(about_ls, o == 2);
    if (o == 2 && of.no_medians) outliers = core::fail(*of.no_medians);
    const std::size_t gone = outliers ? outliers->size() : 0;
    if (gone > 0) fill_points(of, without_rows(sampled, *outliers), o, s, study);
    for (std::size_t f = 0; f < of.filters.size(); ++f) {
      for (std::size_t r = 0; r < kStudiedReferences.size(); ++r) {
        FactorCell& cell = study.cells[study.index({r, f, o, s})];
        if (outliers && gone == 0) cell = study.cells[study.index({r, f, 0, s})];
        if (!outliers) cell.why = cause_of(outliers.error());
        cell.points = of.points - of.samplings[s].left_out.size() - gone;
        cell.left_out = gone;
      }
    }
  }
}

/// Puts the certified value in the place of the one that was found again, also under outlier rules
/// that change nothing of it.
void keep_certified(FactorStudy& study) {
  const auto again = study.cell(study.reported).value_mm;
  auto combination = study.reported;
  for (std::size_t o = 0; o < study.levels[at(Factor::kOutliers)].size(); ++o) {
    combination[at(Factor::kOutliers)] = o;
    FactorCell& cell = study.cells[study.index(combination)];
    if (combination != study.reported && !(again && cell.value_mm == again)) continue;
    cell.value_mm = study.reported_mm;
    cell.why.clear();
  }
}

FactorEffect effect_of(const FactorStudy& study, Factor factor) {
  FactorEffect out;
  out.strongest = study.reported[at(factor)];
  double farthest_mm = 0.0;
  for (std::size_t level = 0; level < study.levels[at(factor)].size(); ++level) {
    const FactorCell& cell = study.changed(factor, level);
    if (!cell.value_mm) continue;
    ++out.levels;
    const double change_mm = *cell.value_mm - study.reported_mm;
    out.least_change_mm = std::min(out.least_change_mm, change_mm);
    out.greatest_change_mm = std::max(out.greatest_change_mm, change_mm);
    if (std::abs(change_mm) <= std::max(farthest_mm, kRoundOffMm)) continue;
    farthest_mm = std::abs(change_mm);
    out.strongest = level;
  }
  return out;
}

FactorTable table_of(const FactorStudy& study) {
  FactorTable out;
  for (const auto& levels : study.levels) out.levels.push_back(levels.size());
  for (const FactorCell& cell : study.cells) out.values.push_back(cell.value_mm);
  return out;
}

/// Words for the change where it is the largest of its factor.
std::string change_words(const FactorStudy& study, Factor factor) {
  const FactorEffect& effect = study.effects[at(factor)];
  const FactorCell& cell = study.changed(factor, effect.strongest);
  const double change_mm = *cell.value_mm - study.reported_mm;
  return fmt::format("{} um ({})", signed_um(change_mm),
                     study.levels[at(factor)][effect.strongest]);
}

/// Why the first other level of a factor has no value.
const std::string& why_not(const FactorStudy& study, Factor factor) {
  return study.changed(factor, study.reported[at(factor)] == 0 ? 1 : 0).why;
}

/// "the reference changes it by up to +1.200 um (LSCY)".
std::string factor_words(const FactorStudy& study, Factor factor) {
  constexpr std::array<std::string_view, 4> kNames = {"the reference", "the filter",
                                                      "leaving out outliers", "the sampling"};
  const std::string_view name = kNames[at(factor)];
  const FactorEffect& effect = study.effects[at(factor)];
  if (effect.levels < 2)
    return fmt::format("{} cannot be tried ({})", name, why_not(study, factor));
  if (effect.strongest == study.reported[at(factor)])
    return fmt::format("{} changes nothing", name);
  return fmt::format("{} changes it by up to {}", name, change_words(study, factor));
}

/// Why the factors do not apply to a characteristic of an analysis; empty where they do.
std::string_view why_no_factors(record::Form form) {
  using record::Form;
  switch (form) {
    case Form::kRoundnessRms:
      return "RONq is about the least-squares circle by definition; what changes the profile is "
             "compared for RONt, where the plan asks for it";
    case Form::kHarmonicLimits:
      return "amplitudes of harmonics have no reference to exchange";
    case Form::kMotionTotal:
    case Form::kMotionSynchronous:
    case Form::kMotionAsynchronous:
      return "ISO 230-7 fixes the centre of a motion (the least-squares centre of its mean "
             "revolution), and it takes neither filter nor outlier rule";
    case Form::kRadius:
      return "the radius is a mean distance, not the width of a zone; report.json has it by least "
             "squares and by quadruples";
    case Form::kRunOut:
      return "run-out is about the axis of the spindle, which is no choice of the evaluation; it "
             "is unfiltered, and a proud point is part of it";
    case Form::kContourDeviation:
    case Form::kContourSpread:
    case Form::kFollowingDeviation:
      return "the contour is held against the ground contour about the base circle that the plan "
             "fixes; a reference circle of its own would be another quantity";
    case Form::kFixtureResidual:
    case Form::kFixtureResidualRms:
    case Form::kAxisError:
    case Form::kLeftRms:
    case Form::kLeftLargest:
    case Form::kLocation:
      return "the balls are held against the places that the calibration predicts, not against a "
             "reference that is fitted to them";
    default:
      return {};
  }
}

}  // namespace

std::size_t FactorStudy::index(const std::array<std::size_t, 4>& levels_of) const {
  std::size_t out = 0;
  for (std::size_t f = 0; f < levels.size(); ++f) out = out * levels[f].size() + levels_of[f];
  return out;
}

const FactorCell& FactorStudy::cell(const std::array<std::size_t, 4>& levels_of) const {
  return cells[index(levels_of)];
}

const FactorCell& FactorStudy::changed(Factor factor, std::size_t level) const {
  auto combination = reported;
  combination[at(factor)] = level;
  return cell(combination);
}

core::Result<FactorStudy> study_factors(const FeatureResult& feature,
                                        const CharacteristicResult& characteristic) {
  const record::Characteristic& asked = characteristic.characteristic;
  const auto& about = record::facts_of(asked.form).about;
  if (record::is_analysis(feature.feature.shape) && !about) {
    return core::fail(core::Code::kMeaning, std::string(why_no_factors(asked.form)));
  }
  if (!about) {
    return core::fail_with(core::Code::kMeaning, "{} has no reference to exchange",
                           record::name_of(asked.form));
  }
  if (feature.failure) return core::fail(*feature.failure);
  if (!characteristic.value) return core::fail(core::Code::kReferenceAbsent, characteristic.reason);
  FeatureResult of = feature;
  record::Characteristic question = asked;
  if (feature.analysis) {
    TRY(of, circle_of(*feature.analysis));
    question.indication = {};
  } else if (!characteristic.finding) {  // needs no sections that are flat across the axis
    of.feature.settings.push_back({kPlaneSetting, {}, "nominal"});
  }
  // The optimum of all points is no start for the searches of some, or of filtered ones.
  of.mc_cylinder = of.mi_cylinder = not_fitted();
  FactorStudy out;
  out.feature = feature.feature.id;
  out.characteristic = asked;
  out.symbol = symbol_of(asked);
  out.value = characteristic.value->value_text();
  out.operator_words = characteristic.value->operator_text();
  out.reported_mm = characteristic.value->value_mm();
  const auto layers = rows_by_layer(of, feature.analysis || !feature.layers.empty());
  const Indication reported = reported_indication(feature, question.indication);
  Studied studied{.surface = surfaces_of({&of, 1}).front(),
                  .points = 0,
                  .asked = question,
                  .filters = filters_of(reported),
                  .samplings = samplings_of(layers),
                  .no_medians = {}};
  studied.no_medians = no_medians(studied.surface);
  for (const Rows& layer : layers) studied.points += layer.size();
  // Unless find() computed the value, its sections stand across the axis of the minimum zone.
  if (!characteristic.finding && of.mz_cylinder) studied.surface.across = of.mz_cylinder->axis;
  name_levels(studied, reported, characteristic.finding.get(), out);
  out.cells.resize(kStudiedReferences.size() * studied.filters.size() *
                   out.levels[at(Factor::kOutliers)].size() * studied.samplings.size());
  for (std::size_t s = 0; s < studied.samplings.size(); ++s) fill_sampling(studied, s, out);
  keep_certified(out);
  for (const Factor factor : kFactors) out.effects[at(factor)] = effect_of(out, factor);
  out.shares = factor_shares(table_of(out), out.reported);
  return out;
}

core::Result<RunComparison> compare_run(const Evaluation& evaluation) {
  RunComparison out;
  for (const FeatureResult& feature : evaluation.features) {
    const std::string& id = feature.feature.id;
    for (const CharacteristicResult& characteristic : feature.characteristics) {
      const std::string place = fmt::format("{} / {}", id, characteristic.characteristic.id);
      const core::Working work(fmt::format("comparing {}", place));
      auto study = study_factors(feature, characteristic);
      if (study) out.studies.push_back(*std::move(study));
      if (!study) out.without.push_back(study.error().at(place));
    }
  }
  if (!out.studies.empty()) return out;
  std::string what = "this run has no cylindricity and no roundness with a value to compare";
  for (const core::Error& error : out.without)
    what += fmt::format("; {}: {}", error.where, error.what);
  return core::fail(core::Code::kNoPoints, what);
}

std::string answer_of(const FactorStudy& study) {
  std::string out = fmt::format("{} is {} as reported", study.symbol, study.value);
  for (const Factor factor : kFactors) {
    const bool first = factor == kFactors.front();
    const bool last = factor == kFactors.back();
    out += fmt::format("{}{}", first ? "; " : last ? ", and " : ", ", factor_words(study, factor));
  }
  if (!study.shares) return out + ".";
  const auto& shares = study.shares->share_1;
  const auto most = std::max_element(shares.begin(), shares.end());
  return out + fmt::format(
                   "; the greatest share of the spread of all combinations is that of the {}, "
                   "{:.0f} %.",
                   name_of(static_cast<Factor>(most - shares.begin())), 100.0 * *most);
}

}  // namespace rondure::evaluation
