#include "reports/words/internal/facts.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/results/finding.h"
#include "evaluation/results/measured_cloud.h"
#include "record/tasks/settings.h"
#include "reports/words/language.h"

namespace rondure::reports {

std::vector<HeldAgainstTruth> held_against_truth(const evaluation::CharacteristicResult& result) {
  std::vector<HeldAgainstTruth> out;
  for (std::size_t k = 0; result.value && k < result.truths_mm.size(); ++k) {
    HeldAgainstTruth one{result.characteristic.id, *result.value, result.truths_mm[k]};
    if (result.finding) {
      const auto& judged = result.finding->judged;
      if (judged.size() > 1) one.name += " " + judged[k].symbol;
      one.found = result.judged[k];
    }
    if (const auto* stated = one.found.statement()) one.u_mm = stated->standard_uncertainty_mm;
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<HeldAgainstTruth> held_against_truth(const evaluation::FeatureResult& feature) {
  std::vector<HeldAgainstTruth> out;
  for (const evaluation::CharacteristicResult& result : feature.characteristics) {
    for (HeldAgainstTruth& one : held_against_truth(result)) out.push_back(std::move(one));
  }
  return out;
}

namespace {

std::string formula(const evaluation::DecisionRule& rule) {
  switch (rule.kind) {
    case evaluation::DecisionRule::Kind::kSimpleAcceptance:
      return tr("simple acceptance: conforms where the measured value <= the limit; no guard band");
    case evaluation::DecisionRule::Kind::kIso14253:
      if (rule.guard_factor == 1.0) {
        return tr(
            "ISO 14253-1: conforms where the whole interval of the value is within the limit, "
            "does not conform where all of it is beyond, otherwise undecided");
      }
      return trf(
          "ISO 14253-1: conforms where y + f (hi - y) <= T, does not conform where y - f (y - lo) "
          "> T, otherwise undecided; f = {:g}; y: the value, lo to hi: its interval, T: the limit",
          rule.guard_factor);
    case evaluation::DecisionRule::Kind::kJcgm106:
      return trf(
          "JCGM 106: conforms where the probability of conformance P >= {:g} %, does not conform "
          "where P <= {:g} %, otherwise undecided",
          100.0 * (1.0 - rule.consumer_risk_1), 100.0 * rule.producer_risk_1);
    case evaluation::DecisionRule::Kind::kNToOne:
      return trf(
          "{0:g}:1 simple acceptance (ASME B89.7.3.1): where T >= {0:g} (hi - lo), conforms where "
          "y <= T, otherwise does not conform; void where the ratio is not met; y: the value, lo "
          "to hi: its interval, T: the limit",
          rule.ratio);
    case evaluation::DecisionRule::Kind::kGuardBand:
      return trf(
          "guard bands (ASME B89.7.3.1): conforms where y <= T - a U, does not conform where y > T "
          "+ r U, otherwise undecided; a = {:g} %, r = {:g} %; y: the value, U: half its interval, "
          "T: the limit",
          100.0 * rule.acceptance_guard_1, 100.0 * rule.rejection_guard_1);
  }
  return {};
}

std::string sentence_of(const evaluation::DecisionRule& rule) {
  if (!rule.needs_interval()) {
    return tr("simple acceptance; no measurement uncertainty taken into account");
  }
  return trf("{}; the value {} decides", in_words(rule), tr(name_of(rule.measurand)));
}

}  // namespace

using core::printable;

record::HeadSettings people_of(const record::RunRecord& record) {
  return record::task_of<record::HeadSettings>(record.settings, "head/")
      .value_or(record::HeadSettings());
}

std::string pattern_of(const evaluation::FeatureResult& feature) {
  const std::size_t points = feature.cloud.size();
  const auto layers = static_cast<std::size_t>(std::max(feature.feature.layers, 0));
  const auto each = static_cast<std::size_t>(std::max(feature.feature.points_per_layer, 0));
  if (layers > 0 && layers * each == points) return trf("{} x {} points", layers, each);
  return count(points, "point", "points");
}

std::string repeats_of(const evaluation::FeatureResult& feature) {
  if (feature.cloud.empty() || feature.feature.strategy == record::Strategy::kPointsFile) return {};
  if (const int passes = passes_of(feature.cloud); passes > 1) {
    return trf("{} passes at places of their own, not averaged", passes);
  }
  const auto [least, most] =
      std::minmax_element(feature.cloud.begin(), feature.cloud.end(),
                          [](const evaluation::CloudPoint& a, const evaluation::CloudPoint& b) {
                            return a.repeats < b.repeats;
                          });
  const auto high = static_cast<std::size_t>(most->repeats);
  const std::string text = count(high, "touch per point", "touches per point");
  return least->repeats == most->repeats ? text : trf("{} to {}", least->repeats, text);
}

std::string title_of(const evaluation::Section& section) {
  return section.projected ? tr("All points, seen along the axis")
                           : trf("Layer {}", section.layer + 1);
}

core::Phrase share_in_words(const evaluation::MergedPoses& merged) {
  if (!merged.solved) {
    return core::Phrase(fmt::format("what the fixture adds to CYLt is not known: {}",
                                    merged.refusal ? merged.refusal->what : std::string()));
  }
  const fit::PoseJoint& solved = *merged.solved;
  if (merged.joint && !solved.u_joint_mm) {
    return core::phrase(
        "the fixture by its kinematics alone would have given CYLt {:.3f} um: its errors would "
        "have added {:.3f} um; they were solved for, but too few targets were touched in several "
        "poses to know how uncertain what is left of them is",
        core::micrometres(solved.naive_mm), core::micrometres(solved.share_mm()));
  }
  if (merged.joint) {
    return core::phrase(
        "the fixture by its kinematics alone would have given CYLt {:.3f} um: its errors would "
        "have added {:.3f} um; they were solved for, and what is left of them is uncertain by "
        "{:.3f} um (standard uncertainty)",
        core::micrometres(solved.naive_mm), core::micrometres(solved.share_mm()),
        core::micrometres(*solved.u_joint_mm));
  }
  return core::phrase(
      "the poses were merged by the kinematics alone: their stated uncertainty changes CYLt by "
      "{:.3f} um (root mean square); solved together with the part it would be {:.3f} um, {:.3f} "
      "um less",
      core::micrometres(solved.u_naive_mm), core::micrometres(solved.joint_mm),
      core::micrometres(solved.share_mm()));
}

core::Phrase sentence_of(const fit::Certificate& certificate) {
  using Kind = fit::Certificate::Kind;
  switch (certificate.kind) {
    case Kind::kGlobal:
      return core::phrase("Global: no narrower zone exists; searched: {}.", certificate.scope);
    case Kind::kLocal:
      return core::phrase("Local: no narrower zone exists nearby (scope: {}).", certificate.scope);
    case Kind::kNone:
      return core::phrase("None: the minimum is not proven.");
  }
  return {};
}

std::optional<std::string> incomplete_headline(const record::RunRecord& record,
                                               const evaluation::Evaluation& evaluation) {
  using evaluation::Verdict;
  std::size_t asked = 0;
  std::size_t judged = 0;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    for (const evaluation::CharacteristicResult& result : feature.characteristics) {
      if (!result.characteristic.toleranced()) continue;
      ++asked;
      if (result.verdict != Verdict::kVoid) ++judged;
    }
  }
  if (record.ending == "finished") return std::nullopt;
  if (asked == 0) return tr("INCOMPLETE");
  std::string out = trf("INCOMPLETE: {} of {} judged", judged, asked);
  if (evaluation.verdict == Verdict::kDoesNotConform)
    out += tr(", ") + tr(name_of(evaluation.verdict));
  return out;
}

std::vector<std::string> missing_parts(const record::RunRecord& record,
                                       const evaluation::Evaluation& evaluation) {
  std::vector<std::string> parts;
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    const record::Feature& asked = feature.feature;
    const long planned = static_cast<long>(asked.layers) * asked.points_per_layer;
    if (feature.failure) {
      parts.push_back(trf("Feature {} has no result.", printable(asked.id)));
    } else if (planned > static_cast<long>(feature.cloud.size())) {
      parts.push_back(trf("Feature {} has {} of {} points.", printable(asked.id),
                          feature.cloud.size(), planned));
    }
  }
  for (std::size_t i = evaluation.features.size(); i < record.features.size(); ++i) {
    parts.push_back(trf("Feature {} was not evaluated.", printable(record.features[i].id)));
  }
  if (parts.empty()) parts.emplace_back(tr("Steps after the last touch on record were not done."));
  return parts;
}

std::optional<std::string> rule_sentence(const evaluation::Evaluation& evaluation) {
  if (!evaluation.rule) return in_words(evaluation.rule.error().said());
  return sentence_of(*evaluation.rule);
}

std::string own_rule_in_words(const record::Characteristic& asked) {
  const auto& own = asked.indication.decision_rule;
  return own ? sentence_of(evaluation::rule_of(*own)) : std::string();
}

std::vector<AbsentInterval> absent_intervals(const evaluation::FeatureResult& feature) {
  std::vector<AbsentInterval> out;
  if (!record::is_analysis(feature.feature.shape)) return out;
  for (const evaluation::CharacteristicResult& result : feature.characteristics) {
    if (!result.value || result.value->uncertainty().result()) continue;
    const core::Phrase& why = result.value->uncertainty().why();
    if (why.empty()) continue;
    auto known = std::ranges::find(out, why, &AbsentInterval::why);
    if (known == out.end()) known = out.insert(known, {why, {}});
    known->ids.push_back(result.characteristic.id);
  }
  return out;
}

std::string with_interval(const evaluation::ContourNumber& number, std::string_view at_most) {
  const bool length = number.kind != evaluation::ContourNumber::Kind::kIndex;
  const auto in_digits = [&](double value) {
    return length ? core::um(value) : core::fixed(value, 4);
  };
  const auto& found = number.uncertainty.result();
  if (!found) return in_digits(number.as_measured);
  const evaluation::UncertaintyStatement& s = found->sampled;
  if (s.at_most) return fmt::format("{} {}", at_most, in_digits(s.high_mm));
  return fmt::format("{} [{}, {}]", in_digits(s.estimate_mm), in_digits(s.low_mm),
                     in_digits(s.high_mm));
}

core::Phrase effective_radius_in_words(const evaluation::WheelResult& facts) {
  const evaluation::UncertaintyStatus& known = facts.effective_radius;
  if (!known.result()) {
    return known.why().empty() ? core::Phrase() : core::phrase("no interval: {}", known.why());
  }
  const evaluation::UncertaintyStatement& s = known.result()->sampled;
  const auto mm = [&](double radius_mm) {
    return core::length_in(core::ValueUnit::kMm, radius_mm,
                           evaluation::decimals_for(s.expanded_mm()));
  };
  const double percent = 100.0 * known.coverage_1();
  const auto& runout = facts.evaluation.wheel.runout;
  if (runout && !runout->bound_because.empty()) {
    return core::phrase("at least {} mm, the lower end of its {:g} % interval", mm(s.low_mm),
                        percent);
  }
  return core::phrase("{} mm, {:g} % within [{}, {}] mm", mm(s.estimate_mm), percent, mm(s.low_mm),
                      mm(s.high_mm));
}

std::string rule_in_words(const record::Header& header) {
  std::string words = tr(header.decision_rule.empty() ? "simple-acceptance" : header.decision_rule);
  if (language() != Language::kEnglish) return words;
  std::replace(words.begin(), words.end(), '-', ' ');
  return words;
}

std::string in_words(const evaluation::DecisionRule& rule) {
  std::string out = formula(rule);
  if (rule.needs_interval()) {
    out = rule.judge_corrected ? trf("{}; corrected values are judged, whatever was read", out)
                               : trf("{}; a value read beyond the limit never conforms", out);
  }
  if (!rule.prior) return out;
  return trf("{}; prior: {} with mean {:g} um and standard deviation {:g} um", out,
             tr(name_of(rule.prior->kind)), rule.prior->mean_mm / core::kMicrometre,
             rule.prior->standard_deviation_mm / core::kMicrometre);
}

}  // namespace rondure::reports
