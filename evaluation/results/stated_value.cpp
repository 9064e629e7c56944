#include "evaluation/results/stated_value.h"

#include <utility>

#include "core/numbers.h"

namespace rondure::evaluation {

using core::um;

namespace {

/// A symbol ("CYLt", "d LP SX", "COAX \u00d8") is the same in every language; a name ("Run-out",
/// with three small letters in a row) has its word in a catalogue.
core::Phrase symbol_words(const std::string& symbol) {
  int small = 0;
  for (const char c : symbol) {
    small = c >= 'a' && c <= 'z' ? small + 1 : 0;
    if (small == 3) return core::Phrase(symbol);
  }
  return core::as_it_is(symbol);
}

}  // namespace

ValueOperator::ValueOperator(ReferenceTerm reference, FilterTerm filter, SamplingTerm sampling,
                             TipTerm tip, TemperatureTerm temperature)
    : words_(core::phrase("{}; {}; {}; {}; {}", reference.words(), filter.words(), sampling.words(),
                          tip.words(), temperature.words())) {}

UncertaintyStatus UncertaintyStatus::none(core::Phrase why) {
  UncertaintyStatus out;
  out.why_ = std::move(why);
  return out;
}

UncertaintyStatus UncertaintyStatus::stated(UncertaintyResult result, double coverage_1) {
  UncertaintyStatus out;
  out.result_ = std::move(result);
  out.coverage_1_ = coverage_1;
  return out;
}

UncertaintyStatus UncertaintyStatus::moved(double by_mm) const {
  UncertaintyStatus out = *this;
  if (!out.result_) return out;
  const auto move = [&](UncertaintyStatement& statement) {
    statement.estimate_mm += by_mm;
    statement.low_mm += by_mm;
    statement.high_mm += by_mm;
    for (double& value_mm : statement.values_mm) value_mm += by_mm;
  };
  out.result_->uncorrected_mm += by_mm;
  move(out.result_->sampled);
  if (out.result_->whole) move(*out.result_->whole);
  return out;
}

const UncertaintyStatement* UncertaintyStatus::about(Measurand measurand) const {
  if (!result_) return nullptr;
  if (measurand == Measurand::kSampledPoints) return &result_->sampled;
  return result_->whole ? &*result_->whole : nullptr;
}

StatedValue::StatedValue(std::string symbol, double value_mm, ValueOperator value_operator,
                         UncertaintyStatus uncertainty, Measurand measurand, core::ValueUnit unit,
                         Quoting quoting)
    : symbol_(std::move(symbol)),
      value_mm_(value_mm),
      operator_(std::move(value_operator)),
      uncertainty_(std::move(uncertainty)),
      measurand_(measurand),
      unit_(unit),
      quoting_(quoting) {}

double StatedValue::quoted_mm() const {
  const UncertaintyStatement* known = statement();
  if (known == nullptr || quoting_.as_read) return value_mm_;
  if (quoting_.at_least) return known->low_mm;
  return known->at_most ? known->high_mm : known->estimate_mm;
}

StatedValue::Bound StatedValue::bound() const {
  if (quoting_.at_least) return Bound::kLower;
  const UncertaintyStatement* known = statement();
  return known != nullptr && known->at_most && !quoting_.as_read ? Bound::kUpper : Bound::kNone;
}

StatedValue StatedValue::moved_to(double value_mm) const {
  StatedValue out = *this;
  out.value_mm_ = value_mm;
  out.uncertainty_ = uncertainty_.moved(value_mm - value_mm_);
  return out;
}

std::string StatedValue::in_digits(double length_mm) const {
  const UncertaintyStatement* known = statement();
  constexpr int kWithoutInterval = 3;
  if (known != nullptr)
    return core::length_in(unit_, length_mm, decimals_for(known->expanded_mm()));
  return unit_ == core::ValueUnit::kMm ? core::length_in(unit_, length_mm, kWithoutInterval)
                                       : um(length_mm);
}

core::Phrase StatedValue::value_text() const {
  const UncertaintyStatement* known = statement();
  const std::string quoted = in_digits(quoted_mm());
  const auto unit = name_of(unit_);
  if (bound() == Bound::kLower) return core::phrase("at least {} {}", quoted, unit);
  if (bound() == Bound::kUpper) return core::phrase("at most {} {}", quoted, unit);
  if (known == nullptr) return core::phrase("{} {}", quoted, unit);
  const std::string low = in_digits(known->low_mm);
  const std::string high = in_digits(known->high_mm);
  if (!quoting_.as_read) return core::phrase("{} {} [{}, {}]", quoted, unit, low, high);
  if (known->at_most) return core::phrase("{} {}, corrected at most {}", quoted, unit, high);
  return core::phrase("{} {}, corrected {} [{}, {}]", quoted, unit, in_digits(known->estimate_mm),
                      low, high);
}

core::Phrase StatedValue::operator_text() const {
  // Without an interval a value says nothing but what was found at the points.
  if (statement() == nullptr) {
    return core::phrase("{}; {}; no uncertainty stated", operator_.words(),
                        core::Phrase(name_of(Measurand::kSampledPoints)));
  }
  return core::phrase("{}; {}", operator_.words(), core::Phrase(name_of(measurand_)));
}

core::Phrase StatedValue::sentence() const {
  const UncertaintyStatement* known = statement();
  const core::Phrase symbol = symbol_words(symbol_);
  if (known == nullptr || (quoting_.as_read && quoting_.at_least)) {
    return bound() == Bound::kLower
               ? core::phrase("{} is {} ({})", symbol, value_text(), operator_text())
               : core::phrase("{} = {} ({})", symbol, value_text(), operator_text());
  }
  const auto unit = name_of(unit_);
  const double percent = 100.0 * uncertainty_.coverage_1();
  const std::string read = in_digits(value_mm_);
  const std::string low = in_digits(known->low_mm);
  const std::string high = in_digits(known->high_mm);
  if (quoting_.as_read && known->at_most) {
    return core::phrase("{} = {} {} as read; corrected at most {} {} ({:g} %) ({})", symbol, read,
                        unit, high, unit, percent, operator_text());
  }
  if (bound() != Bound::kNone) {
    return core::phrase("{} is {} ({:g} %); as read {} {} ({})", symbol, value_text(), percent,
                        read, unit, operator_text());
  }
  const std::string estimate = in_digits(known->estimate_mm);
  return quoting_.as_read
             ? core::phrase("{} = {} {} as read; corrected {} {}, {:g} % [{}, {}] ({})", symbol,
                            read, unit, estimate, unit, percent, low, high, operator_text())
             : core::phrase("{} = {} {}, {:g} % [{}, {}]; as read {} {} ({})", symbol, estimate,
                            unit, percent, low, high, read, unit, operator_text());
}

}  // namespace rondure::evaluation
