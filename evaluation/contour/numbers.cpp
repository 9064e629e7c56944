#include <optional>
#include <utility>
#include <vector>

#include "evaluation/contour/internal/contour_trials.h"
#include "evaluation/contour/internal/curves.h"
#include "evaluation/contour/internal/trials.h"
#include "evaluation/contour/result.h"

namespace rondure::evaluation::contour_trials {

namespace {

/// Peak to valley and rms of every part, and the index; of the mains the index alone.
void add_numbers(ContourNumber::Curve curve, const Curves& measured,
                 const std::optional<CurveModel>& model, const core::Phrase& why,
                 const Basis* basis, const UncertaintyOptions& options,
                 std::vector<ContourNumber>& out) {
  std::vector<ContourNumber> numbers;
  std::vector<Asked> asked;
  const bool each_part = curve != ContourNumber::Curve::kMain;
  for (std::size_t i = 0; each_part && i < measured.size(); ++i) {
    for (const auto kind : {ContourNumber::Kind::kPeakToValley, ContourNumber::Kind::kRms}) {
      const bool range = kind == ContourNumber::Kind::kPeakToValley;
      Asked one;
      one.value = [basis, i, range](const Curves& c) {
        return range ? basis->range(c[i]) : rms_of(c[i]);
      };
      one.as_measured = one.value(measured);
      numbers.push_back({curve, kind, i, one.as_measured});
      asked.push_back(std::move(one));
    }
  }
  if (measured.size() >= 2) {
    Asked one;
    one.value = [](const Curves& c) { return spread_of(c).index(); };
    one.as_measured = one.value(measured);
    one.convex = false;
    one.is_signed = true;
    one.has_budget = false;
    numbers.push_back({curve, ContourNumber::Kind::kIndex, std::nullopt, one.as_measured});
    asked.push_back(std::move(one));
  }
  std::vector<UncertaintyStatus> found(numbers.size(), UncertaintyStatus::none(why));
  if (model) found = states(*model, asked, options);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i].uncertainty = found[i];
    out.push_back(std::move(numbers[i]));
  }
}

}  // namespace

}  // namespace rondure::evaluation::contour_trials

namespace rondure::evaluation {

std::vector<ContourNumber> contour_numbers(const ContourResult& facts,
                                           const UncertaintyOptions& options) {
  using Curve = ContourNumber::Curve;
  using contour_trials::add_numbers;
  using contour_trials::ContourTrials;
  using contour_trials::CurveModel;
  using contour_trials::Curves;
  using contour_trials::nothing_declared;
  std::vector<ContourNumber> out;
  // Without a declaration the numbers stand with the reason why they have no interval.
  static const record::ContourInfluencesTask kNothing;
  ContourResult complete = facts;
  if (!facts.influences) complete.influences = kNothing;
  const ContourTrials trials(complete, options);
  const auto reason = [&](const std::optional<core::Phrase>& voided,
                          std::optional<core::Phrase> missing) {
    if (voided) return voided;
    if (!facts.influences) return std::optional(nothing_declared());
    return missing;
  };
  const auto add = [&](Curve curve, const Curves& measured, const std::optional<core::Phrase>& why,
                       const auto& model) {
    const std::optional<CurveModel> made = why ? std::nullopt : std::optional<CurveModel>(model());
    add_numbers(curve, measured, made, why.value_or(core::Phrase()), &trials.basis(), options, out);
  };
  add(Curve::kTotal, trials.total(), reason(facts.total_void, trials.no_gauge()),
      [&] { return trials.gauge_model(trials.total(), "total"); });
  const bool traced = facts.study.traced();
  const auto no_gauge = trials.no_gauge();
  add(Curve::kFollowing, trials.following(),
      reason(facts.following_void, traced || !no_gauge ? trials.no_axes() : no_gauge),
      [&] { return trials.model_of_f(); });
  add(Curve::kRest, trials.rest(), reason(facts.rest_void, no_gauge ? no_gauge : trials.no_axes()),
      [&] { return traced ? trials.rest_model() : *trials.main_model(trials.rest()); });
  Curves mains;
  Curves indirect;
  for (const fit::ContourPartResult& part : facts.study.parts) {
    if (!part.main || !part.indirect) return out;
    mains.push_back(trials.basis().of(part.main->contour.error_mm));
    indirect.push_back(trials.basis().of(part.indirect->following_mm));
  }
  add(Curve::kMain, mains, reason(std::nullopt, trials.no_gauge()),
      [&] { return trials.gauge_model(mains, "main"); });
  auto model = trials.indirect_model(indirect);
  auto why = reason(facts.total_void, trials.no_gauge());
  if (!why && facts.indirect_is_bound) {
    why = core::phrase("pins and main journals differ: f from the main journal is only a bound");
  }
  if (!why && !model) {
    why =
        core::phrase("main_differs_um is not declared, and fewer than 4 parts have both journals");
  }
  add(Curve::kIndirect, indirect, why, [&] { return *std::move(model); });
  return out;
}

}  // namespace rondure::evaluation

namespace rondure::evaluation {

std::vector<UncertaintyStatus> intervals_of(const ContourResult& result,
                                            std::span<const record::Characteristic> characteristics,
                                            const UncertaintyOptions& options) {
  auto out = total_intervals(result, characteristics, options);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (characteristics[i].form == record::Form::kFollowingDeviation) {
      out[i] = following_interval(result, options);
    }
  }
  return out;
}

std::string ContourNumber::name() const {
  const auto of = [&]() -> std::string {
    switch (curve) {
      case Curve::kTotal:
        return "total";
      case Curve::kFollowing:
        return "following";
      case Curve::kRest:
        return "rest";
      case Curve::kIndirect:
        return "indirect";
      case Curve::kMain:
        return "main";
    }
    return {};
  };
  const std::string_view what = kind == Kind::kPeakToValley ? "-pv"
                                : kind == Kind::kRms        ? "-rms"
                                                            : "-index";
  return of().append(what);
}

}  // namespace rondure::evaluation
