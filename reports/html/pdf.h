#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "record/words.h"
#include "reports/html/report.h"

namespace rondure::reports {

using record::Paper;

/// The Chromium on this machine, which prints report.pdf; kFile, naming the package to install,
/// when there is none on PATH.
[[nodiscard]] core::Result<std::filesystem::path> find_browser();

/// Time limit for Chromium; a report takes a few seconds.
inline constexpr std::chrono::milliseconds kPrintTime = std::chrono::minutes(2);

/// report.pdf: the page printed by a headless Chromium in its own print style on that paper. It
/// states the digest of the page that it was printed from.
/// @param html  The page from write_html().
/// @return  The bytes, which differ from call to call; kFile when there is no Chromium, or when it
///          fails, is killed or takes longer than `time_limit`.
[[nodiscard]] core::Result<std::string> print_pdf(
    std::string_view html, Paper paper, std::chrono::milliseconds time_limit = kPrintTime);

/// Whether a report.pdf states that it was printed from this page, and, unless `paper` is empty, on
/// that paper.
[[nodiscard]] bool is_printed_from(std::string_view html, std::string_view pdf,
                                   std::optional<Paper> paper = std::nullopt);

/// edition_of_page() of the page that a report.pdf was printed from.
[[nodiscard]] Edition edition_of_pdf(std::string_view pdf);

}  // namespace rondure::reports
