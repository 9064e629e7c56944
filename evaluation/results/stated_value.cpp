#include "evaluation/results/stated_value.h"

#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"

namespace rondure::evaluation {

using core::fixed;
using core::um;

ValueOperator::ValueOperator(ReferenceTerm reference, FilterTerm filter, SamplingTerm sampling,
                             TipTerm tip, TemperatureTerm temperature)
    : words_(fmt::format("{}; {}; {}; {}; {}", reference.words(), filter.words(), sampling.words(),
                         tip.words(), temperature.words())) {}

UncertaintyStatus UncertaintyStatus::none(std::string why) {
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

const UncertaintyStatement* UncertaintyStatus::about(Measurand measurand) const {
  if (!result_) return nullptr;
  if (measurand == Measurand::kSampledPoints) return &result_->sampled;
  return result_->whole ? &*result_->whole : nullptr;
}

StatedValue::StatedValue(std::string symbol, double value_mm, ValueOperator value_operator,
                         UncertaintyStatus uncertainty, Measurand measurand)
    : symbol_(std::move(symbol)),
      value_mm_(value_mm),
      operator_(std::move(value_operator)),
      uncertainty_(std::move(uncertainty)),
      measurand_(measurand) {}

std::string StatedValue::in_digits(double length_mm) const {
  const UncertaintyStatement* known = statement();
  if (known == nullptr) return um(length_mm);
  return fixed(length_mm / core::kMicrometre, decimals_for(known->expanded_mm()));
}

std::string StatedValue::value_text() const {
  const UncertaintyStatement* known = statement();
  if (known == nullptr) return um(value_mm_) + " um";
  return fmt::format("{} um [{}, {}]", in_digits(known->estimate_mm), in_digits(known->low_mm),
                     in_digits(known->high_mm));
}

std::string StatedValue::operator_text() const {
  // Without an interval a value only describes the sampled points.
  if (statement() == nullptr) {
    return fmt::format("{}; {}; no uncertainty stated", operator_.words(),
                       name_of(Measurand::kSampledPoints));
  }
  return fmt::format("{}; {}", operator_.words(), name_of(measurand_));
}

std::string StatedValue::sentence() const {
  const UncertaintyStatement* known = statement();
  if (known == nullptr) return fmt::format("{} = {} ({})", symbol_, value_text(), operator_text());
  return fmt::format("{} = {} um, {:g} % [{}, {}]; as read {} um ({})", symbol_,
                     in_digits(known->estimate_mm), 100.0 * uncertainty_.coverage_1(),
                     in_digits(known->low_mm), in_digits(known->high_mm), in_digits(value_mm_),
                     operator_text());
}

}  // namespace rondure::evaluation
