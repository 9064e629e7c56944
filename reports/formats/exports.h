#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/data/corrections.h"
#include "reports/history/earlier_results.h"
#include "reports/html/pdf.h"
#include "reports/words/language.h"

namespace rondure::reports {

/// One file that is written from a record.
struct Export {
  record::Format format = record::Format::kHtml;
  std::string file;  ///< Name in the run directory: report.html, touches.csv, ...
};

/// All exports, in the order in which they are written.
[[nodiscard]] const std::vector<Export>& exports();
/// The words of the formats, each once.
[[nodiscard]] std::vector<std::string> all_formats();

/// Whether a run has this export: series.csv only where series were recorded,
/// fixture-calibration.json only of a finished calibration of the fixture, corrections.txt only of
/// a finished run.
[[nodiscard]] bool applies(const Export& what, const record::RunRecord& record);

/// One file with its bytes.
struct Rendered {
  Export what;
  std::string bytes;
};

/// The corrections of a finished run; of any other none. All exports of a run name them: they are
/// computed once.
[[nodiscard]] Corrections corrections_of(const record::RunRecord& record,
                                         const evaluation::Evaluation& evaluation);

/// An export with the files that come with it: of corrections.txt the tables that it names.
/// @param corrections  From corrections_of().
[[nodiscard]] std::vector<Rendered> render_all(const Export& what, const record::RunRecord& record,
                                               const evaluation::Evaluation& evaluation,
                                               const Corrections& corrections, Edition edition = {},
                                               const EarlierResults& earlier = {});

/// The bytes of one export as this program would write it; for report.pdf, the page that it is
/// printed from. Only pages have an edition; files for programs are English.
/// @param earlier  Earlier results from earlier.json of the run directory.
[[nodiscard]] std::string render(const Export& what, const record::RunRecord& record,
                                 const evaluation::Evaluation& evaluation, Edition edition = {},
                                 const EarlierResults& earlier = {});

/// Most bytes of the file of an export that are read: what the journal gives, or the limit of any
/// document. Of a PDF, whose bytes are a browser's, 4 GiB.
[[nodiscard]] std::uintmax_t most_bytes_of(const Rendered& made);

/// How a run's file was written, as the file itself states it.
[[nodiscard]] Edition edition_of(const Export& what, std::string_view bytes);

/// Whether a run directory holds these exports with the bytes that this program would write, and a
/// report.pdf that was printed from such a page on that paper.
[[nodiscard]] bool exports_are_current(const std::filesystem::path& directory,
                                       const std::vector<std::string>& formats,
                                       const record::RunRecord& record,
                                       const evaluation::Evaluation& evaluation,
                                       Edition edition = {}, Paper paper = Paper::kA4);

/// Writes exports into a run directory, each whole or not at all, and their digests into
/// SHA256SUMS.
/// @return The files written; kBadOption for an unknown format; kInternal when report.qif would
///         fail check_qif(); kFile with the system's reason, or when report.pdf cannot be printed,
///         which is tried last; kSyntax for an invalid SHA256SUMS.
[[nodiscard]] core::Result<std::vector<std::filesystem::path>> write_exports(
    const std::filesystem::path& directory, const std::vector<std::string>& formats,
    const record::RunRecord& record, const evaluation::Evaluation& evaluation, Edition edition = {},
    Paper paper = Paper::kA4);

}  // namespace rondure::reports
