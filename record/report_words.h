#pragma once

#include "record/words.h"

namespace rondure::record {

/// A format of the files that are derived from a record.
enum class Format { kHtml, kPdf, kJson, kCsv, kQif, kDmis, kCorrections };

/// Paper of report.pdf.
enum class Paper { kA4, kLetter };

RONDURE_WORDS(Format, {kHtml, "html"}, {kPdf, "pdf"}, {kJson, "json"}, {kCsv, "csv"}, {kQif, "qif"},
              {kDmis, "dmis"}, {kCorrections, "corrections"});
RONDURE_WORDS(Paper, {kA4, "a4"}, {kLetter, "letter"});

}  // namespace rondure::record
