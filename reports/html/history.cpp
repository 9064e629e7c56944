#include <fmt/format.h>

#include "reports/escaping.h"
#include "reports/history/earlier_results.h"
#include "reports/history/history.h"
#include "reports/html/sections.h"
#include "reports/words/language.h"

namespace rondure::reports {

std::string history_section(const record::RunRecord& record,
                            const evaluation::Evaluation& evaluation,
                            const EarlierResults& earlier) {
  std::string html;
  for (const RunChart& chart : run_charts(record, evaluation, earlier)) {
    const record::ArchiveResult& result = chart.results.back().result;
    html += fmt::format(R"(<h3>{} · {}</h3><figure><div class="scroll">{}</div><figcaption>)",
                        isolated(result.characteristic),
                        trf("Feature {}", isolated(result.feature)), history_drawing(chart));
    if (const core::Phrase words = capability_in_words(chart); !words.empty()) {
      html += "<b>" + in_sentence(words) + "</b> ";
    }
    for (const core::Phrase& sentence : history_sentences(chart))
      html += in_sentence(sentence) + " ";
    html += "</figcaption></figure>";
  }
  if (html.empty()) return {};
  return fmt::format(
      R"(<section><h2>{}</h2><p class="note">{}</p>{}</section>)", tr("Earlier runs"),
      tr("Results of the same characteristics from the archive, as it was when this run was "
         "reported first; the last is this run."),
      html);
}

}  // namespace rondure::reports
