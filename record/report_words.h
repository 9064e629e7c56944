#pragma once

#include <array>

#include "record/words.h"

namespace rondure::record {

/// A format of the files that are derived from a record.
enum class Format { kHtml, kPdf, kJson, kCsv, kQif, kDmis, kCorrections };

/// Paper of report.pdf.
enum class Paper { kA4, kLetter };

constexpr auto words_of(Format) {
  return std::to_array<Word<Format>>({{Format::kHtml, "html"},
                                      {Format::kPdf, "pdf"},
                                      {Format::kJson, "json"},
                                      {Format::kCsv, "csv"},
                                      {Format::kQif, "qif"},
                                      {Format::kDmis, "dmis"},
                                      {Format::kCorrections, "corrections"}});
}
constexpr auto words_of(Paper) {
  return std::to_array<Word<Paper>>({{Paper::kA4, "a4"}, {Paper::kLetter, "letter"}});
}

}  // namespace rondure::record
