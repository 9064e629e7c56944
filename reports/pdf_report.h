#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "record/run_record.h"
#include "reports/words/language.h"

namespace rondure::reports {

/// Where a drawing with its caption stands in a PDF [pt, from the top left of the paper].
struct PdfFigure {
  int page = 0;  ///< From 1.
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  bool whole = true;  ///< Not cut: one that is no higher than a page never is.
};

/// A report on paper.
struct Pdf {
  std::string bytes;
  int pages = 0;
  std::vector<PdfFigure> figures;
  /// Characters for which no font is installed. The PDF shows their codes in boxes, and says so.
  std::vector<char32_t> missing;
};

/// Paper and margins [pt]: A4, text 180 x 259 mm.
inline constexpr double kPdfWidth = 595.276;
inline constexpr double kPdfHeight = 841.89;
inline constexpr double kPdfMargin = 42.52;
inline constexpr double kPdfTop = 53.0;
inline constexpr double kPdfBottom = 54.0;

/// report.pdf, set from the page that write_html() made of the same record, so that both say the
/// same. All fonts are embedded. No clock: the creation date is the start of the run; the same page
/// gives the same bytes with the same fonts and libraries.
/// @return  The document; kFile when no font is installed; kInternal for a page that is not
/// well-formed or a drawing that cannot be drawn.
[[nodiscard]] core::Result<Pdf> write_pdf(const record::RunRecord& record, std::string_view html);

/// What `rondure` tells of characters without a font: "report.pdf: no installed font has ..." with
/// what to do; empty without any.
[[nodiscard]] std::string missing_in_words(const std::vector<char32_t>& missing);

/// Why a PDF on disk is not the one that is set now, or nothing. Bytes that are as they were
/// written (`as_written`) and were set from the same page differ in fonts and libraries alone.
[[nodiscard]] std::optional<std::string> pdf_difference(std::string_view expected,
                                                        std::string_view found, bool as_written);

/// The language of the page that a PDF was set from, as the PDF states it.
[[nodiscard]] Language language_of_pdf(std::string_view bytes);

}  // namespace rondure::reports
