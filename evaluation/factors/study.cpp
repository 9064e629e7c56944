#include "evaluation/factors/study.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/watch.h"
#include "evaluation/factors/internal/outliers.h"
#include "evaluation/results/feature_values.h"
#include "record/tasks/form_facts.h"

namespace rondure::evaluation {
namespace {

using Levels = std::vector<std::vector<std::size_t>>;

bool in_block(const std::vector<std::size_t>& combination, const Levels& used) {
  for (std::size_t f = 0; f < used.size(); ++f) {
    if (!std::binary_search(used[f].begin(), used[f].end(), combination[f])) return false;
  }
  return true;
}

/// A level with missing values, and their fraction.
struct Lacking {
  std::size_t factor = 0;
  std::size_t level = 0;
  double missing_1 = 0.0;
  std::size_t levels = 0;  ///< Number of levels of its factor.
};

/// Counts of values and of missing values for each level of each factor within the block.
struct Census {
  std::vector<std::vector<std::size_t>> values;
  std::vector<std::vector<std::size_t>> missing;
};

Census census_of(const FactorTable& table, const Levels& used) {
  Census out;
  for (const std::size_t levels : table.levels) {
    out.values.emplace_back(levels, 0);
    out.missing.emplace_back(levels, 0);
  }
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    const auto combination = table.combination(i);
    if (!in_block(combination, used)) continue;
    for (std::size_t f = 0; f < combination.size(); ++f) {
      ++out.values[f][combination[f]];
      if (!table.values[i]) ++out.missing[f][combination[f]];
    }
  }
  return out;
}

/// The level to leave out next, or nothing when the block is full.
std::optional<Lacking> worst_level(const FactorTable& table, const Levels& used,
                                   std::span<const std::size_t> reported) {
  const Census census = census_of(table, used);
  std::optional<Lacking> worst;
  for (std::size_t f = 0; f < used.size(); ++f) {
    for (const std::size_t level : used[f]) {
      if (level == reported[f] || census.missing[f][level] == 0) continue;
      const Lacking one{f, level,
                        static_cast<double>(census.missing[f][level]) /
                            static_cast<double>(census.values[f][level]),
                        used[f].size()};
      const bool worse = !worst || one.missing_1 > worst->missing_1 ||
                         (one.missing_1 == worst->missing_1 && one.levels > worst->levels);
      if (worse) worst = one;
    }
  }
  return worst;
}

Levels full_block(const FactorTable& table, std::span<const std::size_t> reported) {
  Levels used;
  for (const std::size_t levels : table.levels) {
    used.emplace_back(levels);
    std::iota(used.back().begin(), used.back().end(), std::size_t{0});
  }
  while (const auto worst = worst_level(table, used, reported))
    std::erase(used[worst->factor], worst->level);
  return used;
}

}  // namespace

std::size_t FactorTable::index(std::span<const std::size_t> combination) const {
  std::size_t out = 0;
  for (std::size_t f = 0; f < levels.size(); ++f) out = out * levels[f] + combination[f];
  return out;
}

std::vector<std::size_t> FactorTable::combination(std::size_t index) const {
  std::vector<std::size_t> out(levels.size(), 0);
  for (std::size_t f = levels.size(); f-- > 0; index /= levels[f]) out[f] = index % levels[f];
  return out;
}

std::optional<FactorShares> factor_shares(const FactorTable& table,
                                          std::span<const std::size_t> reported) {
  assert(table.values[table.index(reported)]);
  FactorShares out;
  out.used = full_block(table, reported);
  std::vector<std::vector<double>> sums;
  for (const std::size_t levels : table.levels) sums.emplace_back(levels, 0.0);
  std::vector<std::vector<std::size_t>> rows;
  std::vector<double> values;
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    auto combination = table.combination(i);
    if (!in_block(combination, out.used)) continue;
    values.push_back(*table.values[i]);
    rows.push_back(std::move(combination));
  }
  out.values = values.size();
  const auto n = static_cast<double>(values.size());
  for (const double value : values) out.mean += value / n;
  double squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double apart = values[i] - out.mean;
    squares += apart * apart;
    for (std::size_t f = 0; f < sums.size(); ++f) sums[f][rows[i][f]] += apart;
  }
  out.variance = squares / n;
  if (std::sqrt(out.variance) <= 1e-12 * std::max(1.0, std::abs(out.mean))) return std::nullopt;
  double main_1 = 0.0;
  for (std::size_t f = 0; f < sums.size(); ++f) {
    const double of_level = n / static_cast<double>(out.used[f].size());
    double share = 0.0;
    for (const std::size_t level : out.used[f])
      share += sums[f][level] * sums[f][level] / (of_level * squares);
    out.share_1.push_back(share);
    main_1 += share;
  }
  out.together_1 = std::max(0.0, 1.0 - main_1);
  return out;
}

namespace {

using core::signed_um;

using record::Reference;

constexpr std::array kStudiedReferences = {Reference::kLeastSquares, Reference::kMinimumZone,
                                           Reference::kMinimumCircumscribed,
                                           Reference::kMaximumInscribed};

constexpr double kRoundOffMm = 1e-9;  ///< Smaller changes count as none.

/// Fills the cells of a study: loops over subset, outlier rule and filter, so that each is made
/// once.
class Cells {
 public:
  Cells(const FactorPoints& points, FactorStudy& study)
      : points_(points),
        subsets_(subsets_of(points)),
        cutoffs_upr_(cutoffs_of(points)),
        study_(study) {}

  void fill() {
    study_.cells.resize(kStudiedReferences.size() * cutoffs_upr_.size() * kOutlierRules.size() *
                        subsets_.size());
    for (std::size_t s = 0; s < subsets_.size(); ++s) {
      const FactorPoints subset = chosen(points_, subsets_[s]);
      for (std::size_t o = 0; o < kOutlierRules.size(); ++o) fill_rule(subset, o, s);
    }
  }

 private:
  [[nodiscard]] bool is_reported(std::size_t r, std::size_t f, std::size_t o, std::size_t s) const {
    return study_.reported == std::array{r, f, o, s};
  }
  FactorCell& cell(std::size_t reference, std::size_t filter, std::size_t rule,
                   std::size_t subset) {
    return study_.cells[((reference * cutoffs_upr_.size() + filter) * kOutlierRules.size() + rule) *
                            subsets_.size() +
                        subset];
  }

  void fill_rule(const FactorPoints& subset, std::size_t o, std::size_t s) {
    const auto kept = without_outliers(subset, kOutlierRules[o]);
    const bool same = kept && o > 0 && kept->left_out == 0;
    for (std::size_t f = 0; f < cutoffs_upr_.size(); ++f) {
      if (same) {  // nothing was left out: same values as without a rule
        for (std::size_t r = 0; r < kStudiedReferences.size(); ++r)
          cell(r, f, o, s) = cell(r, f, 0, s);
        continue;
      }
      const auto points = !kept ? core::Result<FactorPoints>(core::fail(kept.error()))
                          : cutoffs_upr_[f] > 0.0 ? filtered(kept->points, cutoffs_upr_[f])
                                                  : kept->points;
      for (std::size_t r = 0; r < kStudiedReferences.size(); ++r) {
        FactorCell& out = cell(r, f, o, s);
        const auto value = points ? deviation_mm(*points, kStudiedReferences[r])
                                  : core::Result<double>(core::fail(points.error()));
        if (value) out.value_mm = *value;
        if (!value) out.why = value.error().what;
        // keep the certified value
        if (is_reported(r, f, o, s)) out = {study_.reported_mm, {}, 0, 0};
        out.points = kept ? kept->points.count() : subset.count();
        out.left_out = kept ? kept->left_out : 0;
      }
    }
  }

  const FactorPoints& points_;
  std::vector<PointSubset> subsets_;
  std::vector<double> cutoffs_upr_;
  FactorStudy& study_;
};

void name_levels(const FactorPoints& points, record::Shape shape, FactorStudy& study) {
  for (const Reference reference : kStudiedReferences)
    study.levels[at(Factor::kReference)].push_back(reference_of(reference, shape));
  const auto cutoffs = cutoffs_of(points);
  for (const double cutoff : cutoffs) {
    study.levels[at(Factor::kFilter)].push_back(
        cutoff > 0.0 ? fmt::format("Gaussian {:g} UPR", cutoff) : "unfiltered");
  }
  study.reported[at(Factor::kFilter)] =
      static_cast<std::size_t>(std::ranges::find(cutoffs, points.reported_upr) - cutoffs.begin());
  for (const OutlierRule rule : kOutlierRules)
    study.levels[at(Factor::kOutliers)].emplace_back(name_of(rule));
  for (const PointSubset subset : subsets_of(points))
    study.levels[at(Factor::kSampling)].emplace_back(name_of(subset));
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

/// Why the first other level of a factor has no value, without the text after a colon.
std::string why_not(const FactorStudy& study, Factor factor) {
  const std::size_t level = study.reported[at(factor)] == 0 ? 1 : 0;
  const std::string& why = study.changed(factor, level).why;
  return why.substr(0, why.find(": "));
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

const FactorCell& FactorStudy::cell(const std::array<std::size_t, 4>& levels_of) const {
  std::size_t index = 0;
  for (std::size_t f = 0; f < levels.size(); ++f) index = index * levels[f].size() + levels_of[f];
  return cells[index];
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
  if (characteristic.finding) {
    return core::fail_with(core::Code::kMeaning,
                           "{} ({}) is not the peak-to-valley value of all points as read, which "
                           "the study exchanges references and filters of",
                           record::name_of(asked.form), symbol_of(asked));
  }
  TRY(const auto points, factor_points(feature, asked.form));
  if (!characteristic.value) return core::fail(core::Code::kReferenceAbsent, characteristic.reason);
  FactorStudy out;
  out.feature = feature.feature.id;
  out.characteristic = asked;
  out.symbol = symbol_of(asked);
  out.value = characteristic.value->value_text();
  out.operator_words = characteristic.value->operator_text();
  out.reported_mm = characteristic.value->value_mm();
  name_levels(points, *about, out);
  for (std::size_t r = 0; r < kStudiedReferences.size(); ++r) {
    if (kStudiedReferences[r] == asked.reference) out.reported[at(Factor::kReference)] = r;
  }
  Cells(points, out).fill();
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
