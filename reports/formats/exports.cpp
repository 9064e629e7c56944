#include "reports/formats/exports.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "evaluation/handed_calibration.h"
#include "evaluation/part/find.h"
#include "evaluation/results/measured_cloud.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/sha256.h"
#include "reports/data/qif/internal/parts.h"
#include "reports/data/qif/report.h"
#include "reports/data/writers.h"
#include "reports/html/report.h"

namespace rondure::reports {

namespace {

using record::Format;

constexpr const char* kSeriesFile = "series.csv";

/// The calibration of the fixture; after a failed calibration, a text that no run accepts.
std::string calibration_of(const evaluation::Evaluation& evaluation) {
  const evaluation::FeatureResult* source = calibrated_fixture(evaluation);
  return evaluation::handed_calibration(source ? *source : evaluation::FeatureResult()).text;
}

constexpr const char* kResultsFile = "results.csv";
constexpr const char* kSectionsFile = "sections.csv";

/// "html, json and csv".
std::string enumerated(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
  }
  return text;
}

/// Checks a QIF file before it is written: dangling references would make another program refuse it
/// weeks later.
core::Result<void> look_through(const Export& what, const std::string& bytes) {
  if (what.format != Format::kQif) return {};
  const auto faults = check_qif(bytes);
  if (faults.empty()) return {};
  return core::fail(core::Code::kInternal,
                    fmt::format("{} would not be sound: {}", what.file, faults.front()), what.file);
}

/// Writes one export whole, if it is valid; returns its digest.
core::Result<record::Checksum> write_one(const Export& what, const std::filesystem::path& directory,
                                         std::string bytes, Paper paper) {
  if (what.format == Format::kPdf) {
    TRY(bytes, print_pdf(bytes, paper));
  }
  TRY_DO(look_through(what, bytes));
  TRY_DO(record::write_inside(directory, what.file, bytes));
  return record::Checksum{what.file, record::sha256_hex(bytes)};
}

/// Removes tables for machines that an earlier report wrote and that no longer follow: a machine
/// would still take them. A table that was changed since, or that no report wrote, stays.
/// @return Those removed.
core::Result<std::vector<std::string>> remove_old_tables(const std::filesystem::path& directory,
                                                         const std::vector<Rendered>& current) {
  std::vector<std::string> removed;
  const auto list = record::read_checksums(directory);
  if (!list) return removed;  // nothing was written, or the update of the list tells what is wrong
  for (const record::Checksum& line : *list) {
    if (!line.file.starts_with(std::string(kCorrectionsFolder) + "/")) continue;
    if (std::any_of(current.begin(), current.end(),
                    [&](const Rendered& made) { return made.what.file == line.file; })) {
      continue;
    }
    const auto bytes = record::read_inside(directory, line.file);
    if (!bytes || record::sha256_hex(*bytes) != line.sha256) continue;
    if (auto gone = record::remove_inside(directory, line.file); !gone) {
      return core::fail(core::Code::kFile,
                        fmt::format("the correction no longer follows: {}", gone.error().what),
                        line.file);
    }
    removed.push_back(line.file);
  }
  return removed;
}

}  // namespace

const std::vector<Export>& exports() {
  static const std::vector<Export> all = {
      {Format::kHtml, "report.html"},    {Format::kJson, "report.json"},
      {Format::kCsv, "touches.csv"},     {Format::kCsv, kSeriesFile},
      {Format::kCsv, kResultsFile},      {Format::kCsv, kSectionsFile},
      {Format::kQif, "report.qif"},      {Format::kDmis, "report.dmo"},
      {Format::kJson, kCalibrationFile}, {Format::kCorrections, kCorrectionsFile},
      {Format::kPdf, "report.pdf"}};
  return all;
}

std::vector<std::string> all_formats() {
  std::vector<std::string> out;
  for (const Export& e : exports()) {
    const std::string format(name_of(e.format));
    if (std::find(out.begin(), out.end(), format) == out.end()) out.push_back(format);
  }
  return out;
}

namespace {

/// A stopped run hands out what its complete analyses give: the next feature may need it.
bool has_corrections(const record::RunRecord& record) {
  if (record.ending == "finished") return true;
  for (std::size_t i = 0; i < record.features.size(); ++i) {
    if (record::is_analysis(record.features[i].shape) && evaluation::is_complete(record, i)) {
      return true;
    }
  }
  return false;
}

}  // namespace

bool applies(const Export& what, const record::RunRecord& record) {
  if (what.file == kSeriesFile) {
    return std::any_of(record.series.begin(), record.series.end(), [](const auto& series) {
      return series.role == record::Series::Role::kData;
    });
  }
  if (what.file == kSectionsFile) {
    return std::any_of(record.features.begin(), record.features.end(), [](const auto& feature) {
      const auto& asked = feature.characteristics;
      return std::any_of(asked.begin(), asked.end(), [&](const auto& characteristic) {
        return evaluation::is_found(feature, characteristic);
      });
    });
  }
  if (what.format == Format::kCorrections) return has_corrections(record);
  if (what.file != kCalibrationFile) return true;
  return record.ending == "finished" &&
         std::any_of(record.features.begin(), record.features.end(), [](const auto& feature) {
           return feature.shape == record::Shape::kRotaryAxes;
         });
}

Corrections corrections_of(const record::RunRecord& record,
                           const evaluation::Evaluation& evaluation) {
  return has_corrections(record) ? write_corrections(record, evaluation) : Corrections();
}

std::string render(const Export& what, const record::RunRecord& record,
                   const evaluation::Evaluation& evaluation, Edition edition,
                   const EarlierResults& earlier) {
  return render_all(what, record, evaluation, corrections_of(record, evaluation), edition, earlier)
      .front()
      .bytes;
}

namespace {

std::string bytes_of(const Export& what, const record::RunRecord& record,
                     const evaluation::Evaluation& evaluation, const Corrections& corrections,
                     Edition edition, const EarlierResults& earlier) {
  if (what.file == kCalibrationFile) return calibration_of(evaluation);
  if (what.format == Format::kHtml || what.format == Format::kPdf) {
    return write_html(record, evaluation, edition, earlier, corrections.of_features);
  }
  if (what.format == Format::kJson) {
    return write_json(record, evaluation, corrections.of_features);
  }
  if (what.format == Format::kQif) return write_qif(record, evaluation);
  if (what.format == Format::kDmis) return write_dmis(record, evaluation);
  if (what.format == Format::kCorrections) return corrections.summary;
  if (what.file == kSeriesFile) return write_series_csv(record);
  if (what.file == kResultsFile) return write_results_csv(record, evaluation);
  if (what.file == kSectionsFile) return write_sections_csv(record, evaluation);
  return write_touches_csv(record);
}

}  // namespace

std::vector<Rendered> render_all(const Export& what, const record::RunRecord& record,
                                 const evaluation::Evaluation& evaluation,
                                 const Corrections& corrections, Edition edition,
                                 const EarlierResults& earlier) {
  std::vector<Rendered> out = {
      {what, bytes_of(what, record, evaluation, corrections, edition, earlier)}};
  if (what.format != Format::kCorrections) return out;
  for (const CorrectionTable& table : corrections.tables)
    out.push_back({{what.format, table.file}, table.text});
  return out;
}

std::uintmax_t most_bytes_of(const Rendered& made) {
  return made.what.format == Format::kPdf
             ? record::kMostPointsBytes
             : std::max<std::uintmax_t>(record::kMostDocumentBytes, made.bytes.size());
}

Edition edition_of(const Export& what, std::string_view bytes) {
  if (what.format == Format::kPdf) return edition_of_pdf(bytes);
  return what.format == Format::kHtml ? edition_of_page(bytes) : Edition();
}

bool exports_are_current(const std::filesystem::path& directory,
                         const std::vector<std::string>& formats, const record::RunRecord& record,
                         const evaluation::Evaluation& evaluation, Edition edition, Paper paper) {
  const auto earlier = read_earlier(directory);
  if (!earlier) return false;
  const Corrections corrections = corrections_of(record, evaluation);
  return std::all_of(exports().begin(), exports().end(), [&](const Export& e) {
    if (!applies(e, record)) return true;
    if (std::find(formats.begin(), formats.end(), name_of(e.format)) == formats.end()) return true;
    const auto files = render_all(e, record, evaluation, corrections, edition, *earlier);
    return std::all_of(files.begin(), files.end(), [&](const Rendered& made) {
      const auto bytes = record::read_inside(directory, made.what.file, most_bytes_of(made));
      return bytes && (e.format == Format::kPdf ? is_printed_from(made.bytes, *bytes, paper)
                                                : *bytes == made.bytes);
    });
  });
}

core::Result<std::vector<std::filesystem::path>> write_exports(
    const std::filesystem::path& directory, const std::vector<std::string>& formats,
    const record::RunRecord& record, const evaluation::Evaluation& evaluation, Edition edition,
    Paper paper) {
  for (const std::string& format : formats) {
    const auto known = all_formats();
    if (std::find(known.begin(), known.end(), format) == known.end()) {
      return core::fail_with(core::Code::kBadOption, "format '{}' is unknown; {} can be written",
                             format, enumerated(known));
    }
  }
  TRY(const auto earlier, read_earlier(directory));
  const Corrections corrections = corrections_of(record, evaluation);
  std::vector<std::filesystem::path> written;
  std::vector<record::Checksum> sums;
  std::vector<std::string> gone;
  core::Result<void> done;
  for (const Export& e : exports()) {
    if (!applies(e, record)) continue;
    if (std::find(formats.begin(), formats.end(), name_of(e.format)) == formats.end()) continue;
    std::vector<Rendered> files = render_all(e, record, evaluation, corrections, edition, earlier);
    if (e.format == Format::kCorrections) {
      auto removed = remove_old_tables(directory, files);
      if (!removed) {
        done = core::fail(removed.error());
        break;
      }
      gone = *std::move(removed);
    }
    for (Rendered& made : files) {
      auto sum = write_one(made.what, directory, std::move(made.bytes), paper);
      if (!sum) {
        done = core::fail(sum.error());
        break;
      }
      written.push_back(directory / made.what.file);
      sums.push_back(std::move(*sum));
    }
    if (!done) break;
  }
  // Also lists those written before one failed: an old digest would mark them as changed.
  const auto listed = record::update_checksums(directory, sums, gone);
  if (!done) return core::fail(done.error());
  if (!listed) return core::fail(listed.error());
  return written;
}

}  // namespace rondure::reports
