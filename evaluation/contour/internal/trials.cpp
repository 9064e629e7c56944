#include "evaluation/contour/internal/trials.h"

#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/contour/internal/contour_trials.h"
#include "evaluation/contour/internal/curves.h"
#include "evaluation/contour/internal/mask_trials.h"

namespace rondure::evaluation::contour_trials {

namespace {

using core::kMicrometre;
using record::Form;

/// The number that a characteristic reads from t.
Asked asked_of(const record::Characteristic& asked, const ContourResult& facts,
               const ContourTrials& trials) {
  Asked out;
  if (asked.form == Form::kContourSpread) {
    out.value = [](const Curves& curves) { return std::sqrt(spread_of(curves).spread2); };
  } else if (asked.form == Form::kHarmonicLimits) {
    // In units of the line that binds, so that a trial below it has every amplitude below its own.
    const double limit_mm = worst_share(trials.total(), asked.harmonic_limits).limit_mm;
    out.value = [&mask = asked.harmonic_limits, limit_mm](const Curves& curves) {
      return worst_share(curves, mask).share * limit_mm;
    };
  } else {
    out.value = [&basis = trials.basis()](const Curves& curves) {
      return greatest_range(basis, curves);
    };
  }
  const auto measured = value_of(facts, asked);
  out.as_measured = measured ? measured->value_mm : out.value(trials.total());
  return out;
}

/// s is the standard deviation of these parts; of the process behind them it says less.
core::Phrase process_note(double spread_mm, std::size_t parts) {
  const auto freedom = static_cast<double>(parts - 1);
  const auto bound = [&](double p) {
    return spread_mm / kMicrometre * std::sqrt(freedom / core::chi_square_quantile(p, freedom));
  };
  return core::phrase(
      "s is that of these {} parts; if one shape dominates, s of the process lies between {:.3g} "
      "and "
      "{:.3g} um (95 %)",
      parts, bound(0.975), bound(0.025));
}

UncertaintyStatus with_note(const UncertaintyStatus& status, core::Phrase note) {
  if (!status.result()) return status;
  UncertaintyResult result = *status.result();
  result.notes.push_back(std::move(note));
  return UncertaintyStatus::stated(std::move(result), status.coverage_1());
}

}  // namespace

}  // namespace rondure::evaluation::contour_trials

namespace rondure::evaluation {

std::vector<UncertaintyStatus> total_intervals(const ContourResult& facts,
                                               std::span<const record::Characteristic> asked,
                                               const UncertaintyOptions& options) {
  using contour_trials::Asked;
  using contour_trials::asked_of;
  using contour_trials::ContourTrials;
  using contour_trials::is_nearest;
  using contour_trials::kHighestOrder;
  using contour_trials::mask_lines;
  using contour_trials::MaskShare;
  using contour_trials::nothing_declared;
  using contour_trials::of_mask_lines;
  using contour_trials::process_note;
  using contour_trials::states;
  using contour_trials::with_note;
  using contour_trials::worst_share;
  const auto none = [&](const core::Phrase& why) {
    return std::vector<UncertaintyStatus>(asked.size(), UncertaintyStatus::none(why));
  };
  if (!facts.influences) return none(nothing_declared());
  if (facts.total_void) return none(*facts.total_void);
  const ContourTrials trials(facts, options);
  if (const auto missing = trials.no_gauge()) return none(*missing);
  std::vector<Asked> numbers;
  std::vector<std::size_t> rows;
  std::vector<UncertaintyStatus> out = none({});
  for (std::size_t a = 0; a < asked.size(); ++a) {
    if (asked[a].form == record::Form::kFollowingDeviation) continue;
    if (asked[a].form == record::Form::kContourSpread && !facts.study.total) {
      out[a] = UncertaintyStatus::none(core::phrase("one part shows no spread"));
      continue;
    }
    if (asked[a].form == record::Form::kHarmonicLimits) {
      const MaskShare worst = worst_share(trials.total(), asked[a].harmonic_limits);
      if (worst.limit_mm == 0.0 || !is_nearest(worst, value_of(facts, asked[a]))) {
        out[a] = UncertaintyStatus::none(
            worst.limit_mm == 0.0
                ? core::phrase("the mask names no harmonic that the filter passes")
                : core::phrase("the harmonic nearest to its limit is one that the filter does not "
                               "pass, or above order {}: the trials do not hold it",
                               kHighestOrder));
        continue;
      }
    }
    numbers.push_back(asked_of(asked[a], facts, trials));
    rows.push_back(a);
  }
  // After the numbers, the lines of their masks.
  std::vector<std::pair<std::size_t, std::size_t>> of_mask;  // first and count
  for (const std::size_t row : rows) {
    std::vector<Asked> lines;
    if (asked[row].form == record::Form::kHarmonicLimits) lines = mask_lines(asked[row], trials);
    of_mask.emplace_back(numbers.size(), lines.size());
    std::ranges::move(lines, std::back_inserter(numbers));
  }
  if (numbers.empty()) return out;
  const auto found = states(trials.gauge_model(trials.total(), "total"), numbers, options);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out[rows[i]] =
        asked[rows[i]].form == record::Form::kContourSpread
            ? with_note(found[i], process_note(facts.study.total->spread, facts.names.size()))
            : of_mask_lines(found[i],
                            std::span(found).subspan(of_mask[i].first, of_mask[i].second));
  }
  return out;
}

UncertaintyStatus following_interval(const ContourResult& facts,
                                     const UncertaintyOptions& options) {
  using contour_trials::Curves;
  if (!facts.influences) return UncertaintyStatus::none(contour_trials::nothing_declared());
  if (facts.following_void) return UncertaintyStatus::none(*facts.following_void);
  const contour_trials::ContourTrials trials(facts, options);
  const auto missing =
      facts.study.traced() || !trials.no_gauge() ? trials.no_axes() : trials.no_gauge();
  if (missing) return UncertaintyStatus::none(*missing);
  contour_trials::Asked one;
  one.value = [&trials](const Curves& curves) {
    return trials.basis().range(contour_trials::mean_curve(curves));
  };
  one.as_measured = fit::peak_to_valley(fit::mean_following(facts.study));
  return contour_trials::states(trials.model_of_f(), {one}, options).front();
}

UncertaintyStatus gain_interval(const ContourResult& facts,
                                std::span<const std::vector<double>> change_mm,
                                const UncertaintyOptions& options) {
  using contour_trials::Curves;
  if (!facts.influences) return UncertaintyStatus::none(contour_trials::nothing_declared());
  if (facts.total_void) return UncertaintyStatus::none(*facts.total_void);
  const contour_trials::ContourTrials trials(facts, options);
  if (const auto missing = trials.no_gauge()) return UncertaintyStatus::none(*missing);
  Curves change;
  for (const auto& curve : change_mm) change.push_back(trials.basis().of(curve));
  contour_trials::Asked gain;
  gain.value = [&basis = trials.basis(), &change](const Curves& curves) {
    Curves after = curves;
    for (std::size_t i = 0; i < after.size(); ++i) {
      for (std::size_t j = 0; j < after[i].size(); ++j) after[i][j] += change[i][j];
    }
    return contour_trials::greatest_range(basis, curves) -
           contour_trials::greatest_range(basis, after);
  };
  gain.as_measured = gain.value(trials.total());
  gain.convex = false;
  gain.is_signed = true;
  gain.has_budget = false;
  return contour_trials::states(trials.gain_model(), {gain}, options).front();
}

core::Result<std::vector<double>> mean_following_u(const ContourResult& facts,
                                                   const UncertaintyOptions& options) {
  if (!facts.influences) {
    return core::fail(core::Code::kMissingKey, contour_trials::nothing_declared());
  }
  const contour_trials::ContourTrials trials(facts, options);
  if (const auto missing = trials.no_axes()) return core::fail(core::Code::kMissingKey, *missing);
  return trials.mean_following_u();
}

}  // namespace rondure::evaluation
