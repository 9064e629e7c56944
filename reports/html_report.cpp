#include <fmt/format.h>

#include "reports/html_sections.h"
#include "reports/html_style.h"
#include "reports/text.h"
#include "reports/writers.h"

namespace rondure::reports {

std::string write_html(const record::RunRecord& record, const Evaluation& evaluation) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += fmt::format("<title>{} {} - {}</title>\n<style>", escaped(record.header.part_id),
                      escaped(record.header.serial), name_of(evaluation.verdict));
  html += kStyle;
  html += "</style>\n</head>\n<body>\n<main>\n";
  html += head_section(record) + "\n" + verdict_section(record, evaluation) + "\n";
  for (std::size_t i = 0; i < evaluation.features.size(); ++i) {
    html += feature_section(record, i, evaluation.features[i]) + "\n";
  }
  html += probe_section(record, evaluation) + "\n" + decisions_section(record) + "\n" +
          provenance_section(record);
  return html + "\n<footer>Made by Rondure from the " +
         (record.series.empty() ? "touches" : "data") +
         " on record; the raw data are in journal.db and " +
         (record.series.empty() ? "touches.csv" : "series.csv") + " beside this page.</footer>\n" +
         "</main>\n</body>\n</html>\n";
}

}  // namespace rondure::reports
