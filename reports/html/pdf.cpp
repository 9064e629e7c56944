#include "reports/html/pdf.h"

#include <unistd.h>

#include <cstdlib>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/watch.h"
#include "record/external_program.h"
#include "record/files.h"
#include "record/sha256.h"
#include "reports/html/report.h"

namespace rondure::reports {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDigestMark = "page-sha256-";
constexpr std::string_view kPaperMark = ", paper-";
constexpr std::string_view kPageLanguageMark = ", page-language-";
constexpr std::string_view kDetailMark = ", page-detail";

std::string page_mark(std::string_view html) {
  return fmt::format("{}{}", kDigestMark, record::sha256_hex(std::string(html)));
}

/// The statement of a document about its page: the last such text, since a name may contain one. Up
/// to version 0.2 it was in the document information and ended with a parenthesis.
std::string_view print_statement(std::string_view pdf) {
  const std::size_t at = pdf.rfind(kDigestMark);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = pdf.substr(at, 200);
  return rest.substr(0, rest.find_first_of(")\n"));
}

std::string file_url(const fs::path& file) {
  std::string out = "file://";
  for (const char c : file.string()) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                       std::string_view("/-_.~").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

/// Environment for Chromium, which needs no desktop. Its home is the folder, which is removed
/// afterwards; fonts installed by the user are still found.
std::vector<std::string> print_environment(const record::PrivateFolder& folder) {
  const std::string place = folder.path().string();
  std::vector<std::string> out = {"HOME=" + place, "TMPDIR=" + place, "LANG=C.UTF-8", "TZ=UTC",
                                  "DBUS_SESSION_BUS_ADDRESS=disabled:"};
  for (const char* name : {"PATH", "FONTCONFIG_FILE", "FONTCONFIG_PATH", "XDG_DATA_HOME"}) {
    if (const char* value = std::getenv(name)) out.push_back(fmt::format("{}={}", name, value));
  }
  const char* home = std::getenv("HOME");
  if (home != nullptr && std::getenv("XDG_DATA_HOME") == nullptr) {
    out.push_back(fmt::format("XDG_DATA_HOME={}/.local/share", home));
  }
  return out;
}

std::vector<std::string> print_arguments(const record::PrivateFolder& folder) {
  std::vector<std::string> out = {"--headless",
                                  "--disable-gpu",
                                  "--log-level=3",  // fatal only: others concern the desktop
                                  "--no-pdf-header-footer",
                                  "--export-tagged-pdf",
                                  "--generate-pdf-document-outline",
                                  "--no-first-run",
                                  "--disable-extensions",
                                  "--disable-sync",
                                  "--disable-breakpad",
                                  "--disable-background-networking",
                                  "--disable-component-update",
                                  "--disable-dev-shm-usage",
                                  "--host-resolver-rules=MAP * ~NOTFOUND",
                                  "--user-data-dir=" + (folder / "profile").string(),
                                  "--print-to-pdf=" + (folder / "report.pdf").string()};
  // Chromium refuses to run its sandbox as root. The page loads nothing and runs only our script.
  if (::geteuid() == 0) out.emplace_back("--no-sandbox");
  out.push_back(file_url(folder / "report.html"));
  return out;
}

tl::unexpected<core::Error> not_printed(const std::string& why) {
  return core::fail(core::Code::kFile, fmt::format("the page cannot be printed: {}", why),
                    "report.pdf");
}

}  // namespace

core::Result<fs::path> find_browser() {
  fs::path browser =
      record::find_program({"chromium", "chromium-browser", "google-chrome", "google-chrome-stable",
                            "chrome", "chromium-headless-shell"});
  if (!browser.empty()) return browser;
  return core::fail(core::Code::kFile,
                    "a PDF is printed by Chromium, and none is on PATH; install it (Debian: "
                    "chromium), or leave pdf out of the formats and print report.html",
                    "report.pdf");
}

core::Result<std::string> print_pdf(std::string_view html, Paper paper,
                                    std::chrono::milliseconds time_limit) {
  TRY(const auto browser, find_browser());
  const record::PrivateFolder folder("rondure-pdf");  // Chromium creates its profile in it
  if (folder.path().empty()) return not_printed(record::system_reason(errno));
  std::string page(html);
  page.insert(std::min(page.find("</head>"), page.size()),
              fmt::format("<style>@page{{size:{}}}</style>", record::name_of(paper)));
  if (auto done = record::write_file(folder / "report.html", page); !done) {
    return not_printed(done.error().what);
  }
  const core::Working work("printing report.pdf");
  const auto ran = record::run_program(
      {browser, print_arguments(folder), print_environment(folder), folder / "said", time_limit});
  if (!ran) return not_printed(core::printable(ran.error().what));
  auto bytes = record::read_file(folder / "report.pdf");
  const std::size_t end = bytes ? bytes->rfind("startxref") : std::string::npos;
  if (end == std::string::npos || !bytes->starts_with("%PDF-") ||
      bytes->find("%%EOF", end) == std::string::npos) {
    return not_printed(fmt::format("{} ended without a whole document", browser.string()));
  }
  const Edition edition = edition_of_page(html);
  // Placed where a comment moves no offset that the document states.
  bytes->insert(end, fmt::format("% {}{}{}{}{}{}\n", page_mark(html), kPaperMark,
                                 record::name_of(paper), kPageLanguageMark,
                                 tag_of(edition.language), edition.detail ? kDetailMark : ""));
  return std::move(*bytes);
}

bool is_printed_from(std::string_view html, std::string_view pdf, std::optional<Paper> paper) {
  const std::string_view statement = print_statement(pdf);
  if (!statement.starts_with(page_mark(html))) return false;
  return !paper || statement.find(fmt::format("{}{},", kPaperMark, record::name_of(*paper))) !=
                       std::string_view::npos;
}

Edition edition_of_pdf(std::string_view pdf) {
  const std::string_view statement = print_statement(pdf);
  const std::string chinese = fmt::format("{}{}", kPageLanguageMark, tag_of(Language::kChinese));
  const bool detail = statement.ends_with(kDetailMark);
  const auto rest = statement.substr(0, statement.size() - (detail ? kDetailMark.size() : 0));
  return {rest.ends_with(chinese) ? Language::kChinese : Language::kEnglish, detail};
}

}  // namespace rondure::reports
