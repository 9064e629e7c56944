#include "reports/words/callouts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/part/place.h"
#include "evaluation/results/feature_values.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/messages.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;
using core::ValueUnit;
using evaluation::CharacteristicResult;
using evaluation::FeatureResult;
using evaluation::JudgedValue;
using evaluation::PlaceOnPart;

std::string limit_number(ValueUnit unit, double limit_mm) {
  return core::decimal(*limit_in(unit, limit_mm));
}

std::string with_sign(std::string number) {
  return number.front() == '-' ? number : number.insert(0, 1, '+');
}

/// Which of the judged values decides.
std::size_t deciding(const CharacteristicResult& result) {
  const auto found = std::ranges::find(result.judged, result.value->value_mm(),
                                       [](const auto& value) { return value.value_mm(); });
  return found == result.judged.end() ? 0 : static_cast<std::size_t>(found - result.judged.begin());
}

/// The judged values as they are quoted; of a value without a finding, itself with the limits of
/// its characteristic.
std::vector<JudgedValue> judged_values(const CharacteristicResult& result) {
  const record::Characteristic& asked = result.characteristic;
  std::vector<JudgedValue> judged;
  if (result.finding) judged = result.finding->judged;
  if (judged.empty()) {
    const double value_mm = result.value->value_mm();
    judged = {{evaluation::symbol_of(asked), value_mm, {asked.lower_mm, asked.tolerance_mm}}};
  }
  if (judged.size() == 1) judged.front().value_mm = result.value->quoted_mm();
  for (std::size_t i = 0; judged.size() > 1 && i < result.judged.size(); ++i)
    judged[i].value_mm = result.judged[i].quoted_mm();
  return judged;
}

int decimals_of(const CharacteristicResult& result, const std::vector<JudgedValue>& judged,
                ValueUnit unit) {
  constexpr int kMost = 3;
  const record::Characteristic& asked = result.characteristic;
  int decimals = kMost;
  if (const evaluation::UncertaintyStatement* known = result.value->statement()) {
    decimals = evaluation::decimals_for(known->expanded_mm());
  } else if (asked.tolerance_mm && (asked.lower_mm || unit != ValueUnit::kMm)) {
    const double tolerance_um =
        core::micrometres(*asked.tolerance_mm - asked.lower_mm.value_or(0.0));
    if (tolerance_um > 0.0) {
      const double hundredth = std::ceil(2.0 - std::log10(tolerance_um) - 1e-9);
      decimals = static_cast<int>(std::clamp(hundredth, 0.0, double{kMost}));
    }
  }
  const auto hidden = [&](const JudgedValue& value) {
    const auto alike = [&](const std::optional<double>& limit_mm) {
      return limit_mm && core::length_in(unit, value.value_mm, decimals) ==
                             core::length_in(unit, *limit_mm, decimals);
    };
    return !value.limits.hold(value.value_mm) &&
           (alike(value.limits.lower_mm) || alike(value.limits.upper_mm));
  };
  while (decimals < kMost && std::ranges::any_of(judged, hidden)) ++decimals;
  return decimals;
}

std::optional<double> share_of(const record::Characteristic& asked, double value_mm) {
  const auto& upper_mm = asked.tolerance_mm;
  if (upper_mm && asked.lower_mm) {
    const double half_mm = 0.5 * (*upper_mm - *asked.lower_mm);
    if (!(half_mm > 0.0)) return std::nullopt;
    return std::abs(value_mm - *upper_mm + half_mm) / half_mm;
  }
  if (!upper_mm || evaluation::unit_of(asked) == ValueUnit::kMm || !(*upper_mm > 0.0))
    return std::nullopt;
  return std::max(value_mm, 0.0) / *upper_mm;
}

/// Row that carries the value: of a run-out the greatest reading, of a zone the outer contact that
/// holds it most, of sections the point farthest out in the worst of them.
std::optional<std::size_t> worst_row(const FeatureResult& feature,
                                     const CharacteristicResult& result) {
  if (feature.cloud.empty()) return std::nullopt;
  if (result.finding) {
    const auto& rows = result.finding->rows;
    if (rows.empty()) return std::nullopt;
    const std::size_t row = deciding(result) == 0 ? rows.front() : rows.back();  // of a least size
    return row >= feature.cloud.size() ? std::nullopt : std::optional(row);
  }
  const record::Form form = result.characteristic.form;
  if (form == record::Form::kCylindricity && feature.mz_cylinder) {
    const auto& outer = feature.mz_cylinder->outer;
    if (outer.empty()) return std::nullopt;
    return std::ranges::max_element(outer, {}, &fit::Contact::multiplier)->index;
  }
  if (form != record::Form::kRoundness || feature.layers.empty()) return std::nullopt;
  const bool ls = result.characteristic.reference == record::Reference::kLeastSquares;
  const auto width = [&](const evaluation::LayerResult& layer) {
    if (ls) return layer.ls ? layer.ls->deviation_mm : -1.0;
    return layer.mz ? layer.mz->width_mm() : -1.0;
  };
  const auto& rows = std::ranges::max_element(feature.layers, {}, width)->rows;
  if (rows.empty()) return std::nullopt;
  return *std::ranges::max_element(
      rows, {}, [&](std::size_t row) { return feature.cloud[row].deviation_mm; });
}

std::string degrees_of(double angle_rad) {
  const double deg = std::fmod(core::degrees(angle_rad) + 720.0, 360.0);
  return fixed(deg >= 359.5 ? 0.0 : deg, 0) + "°";
}

std::string place_of(const FeatureResult& feature, const CharacteristicResult& result,
                     const std::optional<std::size_t>& row,
                     const std::vector<PlaceOnPart>& places) {
  using Place = evaluation::LocalValue::Place;
  if (places.empty()) return {};
  const bool plane = feature.feature.shape == record::Shape::kPlane;
  const auto height = [&](double z_mm) {
    return fmt::format("{}{} mm", plane ? "r " : "", fixed(z_mm, 1));
  };
  if (row) {
    const PlaceOnPart& at = places[*row];
    return (at.z_mm ? height(*at.z_mm) + ", " : "") + degrees_of(at.angle_rad);
  }
  if (!result.finding || result.finding->worst >= result.finding->local.size()) return {};
  const evaluation::LocalValue& local = result.finding->local[result.finding->worst];
  if (local.place == Place::kRadius) return fmt::format("r {} mm", fixed(local.position, 1));
  if (local.place == Place::kAngle) {
    return degrees_of(local.position + places.front().angle_rad - feature.cloud.front().angle_rad);
  }
  double sum_mm = 0.0;
  int number = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (feature.cloud[i].layer != local.layer || feature.cloud[i].left_out || !places[i].z_mm)
      continue;
    sum_mm += *places[i].z_mm;
    ++number;
  }
  return number == 0 ? std::string() : height(sum_mm / number);
}

/// What follows from the value and its limits.
void add_value(Callout& out) {
  const CharacteristicResult& result = *out.result;
  const record::Characteristic& asked = result.characteristic;
  const evaluation::StatedValue& stated = *result.value;
  const std::vector<JudgedValue> judged = judged_values(result);
  const int decimals = decimals_of(result, judged, out.unit);
  const auto number = [&](double mm) { return core::length_in(out.unit, mm, decimals); };
  if (judged.size() > 1) out.symbol.clear();
  double most_mm = 0.0;
  for (const JudgedValue& value : judged) {
    const std::string_view between = out.value.empty() ? "" : " / ";
    if (judged.size() > 1) out.symbol += fmt::format("{}{}", between, tr(value.symbol));
    out.value +=
        fmt::format("{}{}{}", between, bound_sign(stated, "≤ ", "≥ "), number(value.value_mm));
    const auto passes = [&](double by_mm, double limit_mm, bool below) {
      if (!(by_mm > most_mm)) return;
      most_mm = by_mm;
      const ValueUnit small = core::unit_of_difference(out.unit);
      out.beyond =
          fmt::format("{} {}", fixed(core::micrometres(by_mm), decimals), core::sign_of(small));
      out.passed = fmt::format("{} {}", limit_number(out.unit, limit_mm), core::sign_of(out.unit));
      out.below = below;
    };
    const evaluation::Limits& limits = value.limits;
    if (limits.upper_mm) passes(value.value_mm - *limits.upper_mm, *limits.upper_mm, false);
    if (limits.lower_mm) passes(*limits.lower_mm - value.value_mm, *limits.lower_mm, true);
    if (const auto share = share_of(asked, value.value_mm))
      out.share_1 = std::max(out.share_1.value_or(0.0), *share);
  }
  const double quoted_mm = judged.at(deciding(result)).value_mm;
  const double nominal_mm = out.feature->feature.nominal_diameter_mm;
  if (asked.form == record::Form::kDiameter) {
    if (nominal_mm > 0.0) out.deviation = with_sign(number(quoted_mm - nominal_mm));
  } else if (!out.beyond.empty()) {
    out.deviation = with_sign(number(out.below ? -most_mm : most_mm));
  }
  const evaluation::UncertaintyStatement* known = stated.statement();
  if (known == nullptr || known->at_most || is_bound(stated)) return;
  out.expanded = number(known->expanded_mm());
}

/// "CYLt of journal B is 0.31 µm over its limit of 4 µm".
std::string failing_in_words(const Callout& callout, const std::string& name) {
  const evaluation::Verdict verdict = callout.result->verdict;
  if (verdict != evaluation::Verdict::kDoesNotConform || callout.beyond.empty())
    return trf("{}: {}", name, tr(name_of(verdict)));
  return callout.below ? trf("{} is {} below its limit of {}", name, callout.beyond, callout.passed)
                       : trf("{} is {} over its limit of {}", name, callout.beyond, callout.passed);
}

}  // namespace

std::string limits_in_words(const record::Characteristic& asked, std::string_view between) {
  const ValueUnit unit = evaluation::unit_of(asked);
  const auto one = [&](std::string_view sign, double limit_mm) {
    return fmt::format("{} {} {}", sign, limit_number(unit, limit_mm), core::sign_of(unit));
  };
  std::string out;
  if (asked.tolerance_mm) out += one("≤", *asked.tolerance_mm);
  if (asked.tolerance_mm && asked.lower_mm) out += between;
  if (asked.lower_mm) out += one("≥", *asked.lower_mm);
  return out;
}

std::vector<Callout> callouts_of(const evaluation::Evaluation& evaluation) {
  std::vector<Callout> out;
  for (const FeatureResult& feature : evaluation.features) {
    std::vector<PlaceOnPart> places;
    if (!feature.cloud.empty() && !record::is_analysis(feature.feature.shape))
      places = evaluation::places_on_part(feature);
    for (const CharacteristicResult& result : feature.characteristics) {
      const record::Characteristic& asked = result.characteristic;
      Callout made;
      made.feature = &feature;
      made.result = &result;
      made.unit = result.value ? result.value->unit() : evaluation::unit_of(asked);
      made.symbol = tr(evaluation::symbol_of(asked));
      if (asked.tolerance_mm && asked.lower_mm) {
        made.limit = fmt::format("{} … {}", limit_number(made.unit, *asked.lower_mm),
                                 limit_number(made.unit, *asked.tolerance_mm));
      } else if (asked.toleranced()) {
        made.limit = asked.tolerance_mm ? limit_number(made.unit, *asked.tolerance_mm)
                                        : "≥ " + limit_number(made.unit, *asked.lower_mm);
      }
      if (result.value) {
        add_value(made);
        made.worst_row = worst_row(feature, result);
        made.place = place_of(feature, result, made.worst_row, places);
      }
      out.push_back(std::move(made));
    }
  }
  std::ranges::stable_sort(out, [](const Callout& a, const Callout& b) {
    const int one = severity(a.result->verdict);
    const int other = severity(b.result->verdict);
    return one != other ? one > other : a.share_1.value_or(0.0) > b.share_1.value_or(0.0);
  });
  return out;
}

std::string answer_in_words(const std::vector<Callout>& callouts,
                            std::string (*name)(const Callout&)) {
  constexpr std::size_t kMostNamed = 2;
  std::size_t toleranced = 0;
  std::size_t conforming = 0;
  std::string failing;
  for (const Callout& callout : callouts) {
    if (!callout.result->characteristic.toleranced()) continue;
    ++toleranced;
    if (callout.result->verdict == evaluation::Verdict::kConforms) {
      ++conforming;
    } else if (toleranced - conforming <= kMostNamed) {
      failing += tr("; ") + failing_in_words(callout, name(callout));
    }
  }
  if (toleranced == 0) return tr("No characteristic has a tolerance.");
  if (const std::size_t more = toleranced - conforming; more > kMostNamed)
    failing += tr("; ") + trf("{} more", more - kMostNamed);
  const std::string number = conforming == 1 ? trf("{} of {} conforms", conforming, toleranced)
                                             : trf("{} of {} conform", conforming, toleranced);
  const Callout& nearest = callouts.front();
  if (!failing.empty() || !nearest.share_1) return trf("{}.", number + failing);
  return trf("{}; nearest: {}, {} %.", number, name(nearest), fixed(100.0 * *nearest.share_1, 0));
}

std::vector<std::pair<std::string, std::string>> remarks_on(const record::RunRecord& record,
                                                            const std::vector<Callout>& callouts) {
  std::vector<std::pair<std::string, std::string>> out;
  if (record.header.simulated) out.emplace_back(tr("Simulated:"), tr("no real part was measured."));
  if (std::ranges::any_of(callouts, [](const Callout& callout) {
        return callout.result->value && is_bound(*callout.result->value);
      })) {
    out.emplace_back(tr("Bounds:"),
                     tr("of a value with ≤ or ≥ only one end of its interval is known: an upper "
                        "or a lower bound, no estimate."));
  }
  return out;
}

std::string uncertainty_in_words(const std::vector<Callout>& callouts,
                                 std::string (*say)(const core::Phrase&)) {
  std::vector<std::string> in;
  std::vector<std::string> zero;
  std::vector<std::string> out;
  std::string why;
  bool all = true;
  const auto add = [](std::vector<std::string>& to, const std::string& name) {
    if (std::ranges::find(to, name) == to.end()) to.push_back(name);
  };
  for (const Callout& callout : callouts) {
    if (!callout.result->value) continue;
    const evaluation::UncertaintyStatus& status = callout.result->value->uncertainty();
    if (!status.result()) {
      all = false;
      if (why.empty() && !status.why().empty()) why = say(status.why());
      continue;
    }
    for (const evaluation::InfluenceStatement& one : status.result()->declaration)
      add(evaluation::is_taken_as_zero(one) ? zero
          : one.covered                     ? in
                                            : out,
          say(core::Phrase(one.name)));
  }
  const auto leave_out = [](std::vector<std::string>& from, const std::vector<std::string>& those) {
    std::erase_if(from, [&](const std::string& name) {
      return std::ranges::find(those, name) != those.end();
    });
  };
  leave_out(in, out);
  leave_out(zero, out);
  leave_out(zero, in);
  const auto listed = [](const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : tr(", ")) + name;
    return text;
  };
  std::string text;
  if (!in.empty()) text += trf("In U: {}.", listed(in)) + " ";
  if (!zero.empty()) text += trf("Taken as zero: {}.", listed(zero)) + " ";
  if (!out.empty()) text += trf("Not in U: {}.", listed(out)) + " ";
  if (all && !text.empty()) return text;
  return text + (why.empty() ? tr("Without U: no uncertainty is stated.")
                             : trf("Without U: no uncertainty is stated ({}).", why));
}

}  // namespace rondure::reports
