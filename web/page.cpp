#include "web/page.h"

#include <fmt/format.h>

#include "reports/html/style.h"
#include "reports/words/language.h"

namespace rondure::web {
namespace {

using reports::tr;

constexpr std::string_view kLiveStyle = R"css(
[hidden]{display:none!important}
h2.doing{font-size:22px;margin:24px 0 8px;padding:0;border:0}
progress{display:block;width:100%;max-width:220px;height:10px;margin-top:6px;accent-color:var(--blue)}
#control{margin:18px 0;display:flex;gap:16px;align-items:center;flex-wrap:wrap}
#control button,dialog button{font:inherit;font-weight:650;padding:9px 20px}
button.stop{background:#b93c00;border-color:#b93c00;color:#fff}
button:disabled{opacity:.55;cursor:default}
dialog{border:1px solid var(--line);border-radius:6px;padding:22px 26px;max-width:460px;
background:var(--paper);color:var(--ink)}
dialog::backdrop{background:rgba(0,0,0,.45)}
dialog h2{margin:0 0 8px;padding:0;border:0}
dialog .choices{display:flex;gap:12px;margin-top:18px;flex-wrap:wrap}
)css";

std::string control_part() {
  return fmt::format(
      R"(<div id="control" hidden><button id="stop" class="stop" type="button">{0}</button>)"
      R"(<span id="asked" role="status" hidden>{1}</span>)"
      R"(<span id="refused" role="alert" hidden>{2}</span></div>)"
      R"(<p id="no-token" class="note" hidden>{3}</p>)"
      R"(<dialog id="question" aria-labelledby="question-title" aria-describedby="question-text">)"
      R"(<h2 id="question-title">{4}</h2><p id="question-text">{5}</p><div class="choices">)"
      R"(<button id="yes" class="stop" type="button">{0}</button>)"
      R"(<button id="no" type="button" autofocus>{6}</button></div></dialog>)",
      tr("Stop the run"), tr("The run stops after the present touch."),
      tr("The program did not take this; use Ctrl-C in its terminal."),
      tr("To stop the run from here, open the address that the program printed, with all that "
         "stands "
         "behind the #."),
      tr("Stop the run?"),
      tr("The machine ends the present touch, goes back and up, and everything measured is kept. "
         "The "
         "run can go on later with rondure run --resume. This is no emergency stop."),
      tr("Go on measuring"));
}

}  // namespace

std::string live_style() {
  return fmt::format("{}@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}\n{}",
                     reports::kStyle, reports::kDarkColours, kLiveStyle);
}

std::string live_page(bool control) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<link rel=\"icon\" href=\"data:,\">\n"
      "<link rel=\"stylesheet\" href=\"live.css\">\n"
      "<script src=\"live.js\" defer></script>\n</head>\n<body>\n<main>\n",
      tag_of(reports::language()), tr("Rondure: live view"));
  html += fmt::format(
      "<noscript><div class=\"banner alarm\">{}</div></noscript>\n"
      "<div id=\"announce\" class=\"spoken\" role=\"status\" aria-live=\"polite\"></div>\n"
      "<div id=\"head\"></div>\n"
      "<div id=\"lost\" class=\"banner alarm\" role=\"alert\" hidden><b>{}</b> {}</div>\n",
      tr("This page needs JavaScript."), tr("Connection lost."),
      tr("The program does not answer: it has ended, or this computer is very busy. Its terminal "
         "tells; what was measured is on disk."));
  html += "<section id=\"now\"></section>\n";
  if (control) html += control_part() + "\n";
  html +=
      "<div id=\"result\"></div>\n<div id=\"drawing\"></div>\n<div id=\"poses\"></div>\n"
      "<div id=\"touches\"></div>\n<div id=\"decisions\"></div>\n";
  return html + fmt::format("<footer>{}</footer>\n</main>\n</body>\n</html>\n",
                            tr("Served by Rondure on this computer only. The drawings are those of "
                               "the report, of the touches so far."));
}

}  // namespace rondure::web
