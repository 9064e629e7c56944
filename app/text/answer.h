#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/result.h"
#include "fit/proof/certificate.h"

namespace rondure::app {

/// Exit status of the program.
enum Exit : int {
  kAllWell = 0,  ///< Done; for run and report: everything conforms or is not toleranced.
  kNotConforming =
      1,  ///< Finished, but something does not conform, is undecided or void; verify: not equal.
  kBadInput = 2,   ///< Plan, file or arguments; verify: unreadable.
  kRunFailed = 3,  ///< Machine, fixture or run failed; recorded data are kept.
};

/// Prints why a verb does nothing. Returns its exit status, kBadInput.
[[nodiscard]] int refuse(const core::Error& error);
[[nodiscard]] int refuse(const std::vector<core::Error>& errors);
/// refuse() for an error in the data of a file: names the file if the error has no place.
[[nodiscard]] int refuse_file(const core::Error& error, const std::string& file);

/// @return kNotFinite naming the first number of a document that is not finite (JSON would write
///         it as null, a table as nan), or nothing.
[[nodiscard]] core::Result<void> check_finite(const nlohmann::ordered_json& found);

/// Warnings in the JSON format of every verb, {"code", "what"} each.
[[nodiscard]] nlohmann::ordered_json warnings_json(const std::vector<core::Error>& warnings);
/// Warnings as the last lines of a table.
[[nodiscard]] std::string warnings_text(const std::vector<core::Error>& warnings);

/// A certificate as JSON, and as "certificate global, all centres, gap 1.0e-15 mm; reason". Without
/// a proof the gap is null, and missing in the text.
[[nodiscard]] nlohmann::ordered_json certificate_json(const fit::Certificate& certificate);
[[nodiscard]] std::string certificate_text(const fit::Certificate& certificate);

/// Breaks text between words into lines of at most `columns` bytes: the first begins with `line`,
/// the others with `indent`.
[[nodiscard]] std::string wrapped(std::string_view text, std::string line,
                                  const std::string& indent, std::size_t columns = 78);

/// A word of a command line, quoted for a shell if necessary.
[[nodiscard]] std::string quoted(const std::string& word);

/// Prints a result, as JSON or as a table. If a number is not finite, only the error is printed.
/// @return The exit status of the verb.
[[nodiscard]] int answer(const nlohmann::ordered_json& found, bool as_json,
                         const std::function<std::string()>& table);

}  // namespace rondure::app
