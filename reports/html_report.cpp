#include <fmt/format.h>

#include "reports/html_sections.h"
#include "reports/html_style.h"
#include "reports/language.h"
#include "reports/text.h"
#include "reports/writers.h"

namespace rondure::reports {

std::string write_html(const record::RunRecord& record, const Evaluation& evaluation,
                       Language language) {
  const LanguageScope scope(language);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n",
      tag_of(language));
  html += fmt::format("<title>{} {} - {}</title>\n<style>", escaped(record.header.part_id),
                      escaped(record.header.serial), tr(name_of(evaluation.verdict)));
  html += kStyle;
  html += "</style>\n</head>\n<body>\n<main>\n";
  html += head_section(record) + "\n" + verdict_section(record, evaluation) + "\n";
  for (std::size_t i = 0; i < evaluation.features.size(); ++i) {
    html += feature_section(record, i, evaluation.features[i]) + "\n";
  }
  html += probe_section(record, evaluation) + "\n" + decisions_section(record) + "\n" +
          provenance_section(record);
  return html + "\n<footer>" +
         (record.series.empty() ? tr("Made by Rondure from the touches on record; the raw data are "
                                     "in journal.db and touches.csv beside this page.")
                                : tr("Made by Rondure from the data on record; the raw data are in "
                                     "journal.db and series.csv beside this page.")) +
         "</footer>\n</main>\n</body>\n</html>\n";
}

Language language_of_page(std::string_view page) {
  const std::string mark = fmt::format("<html lang=\"{}\">", tag_of(Language::kChinese));
  return page.substr(0, 200).find(mark) == std::string_view::npos ? Language::kEnglish
                                                                  : Language::kChinese;
}

}  // namespace rondure::reports
