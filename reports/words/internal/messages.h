#pragma once

#include <optional>
#include <string>

#include "core/message.h"

namespace rondure::reports {

/// The only place where messages become sentences.
///
/// @return  The sentence in the language of the report; none where it contains words of another
///          part of the program (a reason) that are not known in that language. In English always a
///          sentence.
[[nodiscard]] std::optional<std::string> in_words(const core::Message& message);

/// The English sentence of a message.
[[nodiscard]] std::string english_sentence(const core::Message& message);

}  // namespace rondure::reports
