#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/message.h"
#include "evaluation/results/gate.h"
#include "evaluation/results/stated_value.h"

namespace rondure::reports {

/// The only place where messages become sentences.
///
/// @return  The sentence in the language of the report; none where it contains words of another
///          part of the program (a reason) that are not known in that language. In English always a
///          sentence.
[[nodiscard]] std::optional<std::string> in_words(const core::Message& message);

/// The English sentence of a message.
[[nodiscard]] std::string english_sentence(const core::Message& message);

/// "passed", "warns", "bounds", "voids": as report.json spells it.
[[nodiscard]] const char* name_of(evaluation::Gate::Outcome outcome);
/// The effect of an outcome on the values, in the language of the report: "some values prove
/// nothing".
[[nodiscard]] std::string effect_of(evaluation::Gate::Outcome outcome);
/// Number of a gate with its unit: "0.0431 um"; "-" where it could not be computed.
[[nodiscard]] std::string number_of(const std::optional<double>& number, const std::string& unit);
/// "7 of 8 passed; first-harmonic: chi2 is 12.4": each that did not pass with its reason, in the
/// language of the report.
[[nodiscard]] std::string in_words(const std::vector<evaluation::Gate>& gates);

/// Whether only an upper or a lower bound of a value is stated.
[[nodiscard]] bool is_bound(const evaluation::StatedValue& value);
/// The sign of such a bound before the number; else empty.
[[nodiscard]] std::string_view bound_sign(const evaluation::StatedValue& value,
                                          std::string_view at_most, std::string_view at_least);

}  // namespace rondure::reports
