// report.pdf as other programs read it (poppler's), and what becomes of it when Chromium fails.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "record/files.h"
#include "reports/formats/exports.h"
#include "reports/html/pdf.h"
#include "reports/html/report.h"
#include "synthetic.h"
#include "tests/core/scratch.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A folder that is removed at the end; PATH and TMPDIR are as a test needs them meanwhile.
class PdfFolder {
 public:
  PdfFolder() { fs::create_directory(path_); }
  ~PdfFolder() {
    ::setenv("PATH", search_path_.c_str(), 1);
    ::unsetenv("TMPDIR");
  }
  PdfFolder(const PdfFolder&) = delete;
  PdfFolder& operator=(const PdfFolder&) = delete;

  [[nodiscard]] fs::path operator/(const char* name) const { return path_ / name; }

  /// From now on the only Chromium is this shell script, which finds the PDF to write in $pdf; and
  /// temporary files go to "temporary".
  void have_browser(const std::string& script) const {
    std::ofstream(path_ / "chromium")
        << "#!/bin/sh\nfor a; do case $a in --print-to-pdf=*) pdf=${a#*=};; esac; done\n"
        << script << "\n";
    fs::permissions(path_ / "chromium", fs::perms::owner_all);
    fs::create_directory(path_ / "temporary");
    ::setenv("PATH", (path_.string() + ":/usr/bin:/bin").c_str(), 1);
    ::setenv("TMPDIR", (path_ / "temporary").c_str(), 1);
  }

 private:
  test::Scratch scratch_;
  fs::path path_ = scratch_ / "#1 % of all";
  std::string search_path_ = std::getenv("PATH") != nullptr ? std::getenv("PATH") : "";
};

/// What a program says of a document.
std::string said_of(const std::string& pdf, const std::string& program,
                    const std::string& after = {}) {
  const PdfFolder folder;
  std::ofstream(folder / "report.pdf", std::ios::binary) << pdf;
  const std::string command =
      fmt::format("{} '{}' {} 2>&1", program, (folder / "report.pdf").string(), after);
  std::string said;
  if (FILE* pipe = ::popen(command.c_str(), "r")) {
    std::array<char, 4096> some{};
    for (std::size_t n = 0; (n = std::fread(some.data(), 1, some.size(), pipe)) > 0;) {
      said.append(some.data(), n);
    }
    EXPECT_EQ(::pclose(pipe), 0) << command << ": " << said.substr(0, 500);
  }
  return said;
}

/// The tests of the printed document; without Chromium and poppler-utils they are skipped.
class Pdf : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto browser = find_browser(); !browser) GTEST_SKIP() << browser.error().what;
    if (std::system("command -v pdftotext >/dev/null") != 0) {
      GTEST_SKIP() << "pdftotext is not installed (Debian package poppler-utils)";
    }
  }

  static std::string printed(const std::string& html, Paper paper) {
    auto pdf = print_pdf(html, paper);
    EXPECT_TRUE(pdf) << pdf.error().what;
    return pdf.value_or("");
  }
  static std::string printed(const Case& made, Paper paper = Paper::kA4) {
    return printed(page_of(made), paper);
  }
};

/// What neither has ink: white space, marks of direction, joiners.
bool is_blank(char32_t c) {
  return c <= U' ' || c == 0x7F || c == 0xA0 || c == 0x85 || (c >= 0x2000 && c <= 0x200F) ||
         (c >= 0x2028 && c <= 0x202E) || (c >= 0x2060 && c <= 0x206F) || c == 0xFEFF || c == 0x3000;
}

/// Letters with ink, as UTF-8.
std::string inked(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    char32_t code = length == 1 ? lead : lead & (0xFFU >> (length + 1));
    for (std::size_t k = 1; k < length && i + k < text.size(); ++k) {
      code = (code << 6) | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
    }
    if (!is_blank(code)) out += text.substr(i, length);
    i += length;
  }
  return out;
}

/// All ink of the pages between the margins, in the order of the page.
std::string body_ink(const std::string& pdf) {
  return inked(said_of(pdf, "pdftotext -raw -x 0 -y 36 -W 595 -H 772", "-"));
}

bool on_paper(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const std::string style = fmt::format(" {} ", node.attribute("class").value());
  return name != "script" && name != "style" && name != "title" && name != "desc" &&
         !node.attribute("hidden") && style.find(" screen-only ") == std::string::npos &&
         style.find(" spoken ") == std::string::npos;
}

/// Texts of the page that the document lacks; empty when it says all.
void add_lacking(const pugi::xml_node& node, const std::string& ink,
                 std::vector<std::string>& out) {
  for (const pugi::xml_node child : node) {
    if (!on_paper(child)) continue;
    const std::string text = inked(child.value());
    if (ink.find(text) == std::string::npos) out.push_back(text.substr(0, 200));
    add_lacking(child, ink, out);
  }
}

std::vector<std::string> lacking(const std::string& pdf, const std::string& html) {
  pugi::xml_document page;
  EXPECT_TRUE(page.load_buffer(html.data(), html.size(),
                               pugi::parse_default | pugi::parse_doctype | pugi::parse_ws_pcdata));
  std::vector<std::string> out;
  add_lacking(page.child("html").child("body"), body_ink(pdf), out);
  return out;
}

/// Every line of pdffonts ends in "emb sub uni object ID".
void expect_embedded(const std::string& pdf) {
  std::istringstream lines(said_of(pdf, "pdffonts"));
  std::string line;
  std::getline(lines, line);
  const std::size_t column = line.find("emb");
  ASSERT_NE(column, std::string::npos) << line;
  std::getline(lines, line);
  int fonts = 0;
  while (std::getline(lines, line)) {
    EXPECT_EQ(line.substr(column, 3), "yes") << line;
    ++fonts;
  }
  EXPECT_GE(fonts, 2);
}

/// The texts of its pages, head and foot included.
std::vector<std::string> pages_of(const std::string& pdf) {
  std::vector<std::string> pages;
  std::istringstream all(said_of(pdf, "pdftotext -layout", "-"));
  for (std::string page; std::getline(all, page, '\f');) pages.push_back(page);
  return pages;
}

TEST_F(Pdf, SaysEveryTextOfThePage) {
  for (const auto& [name, made] :
       {std::pair("conforms", cylinder_case(4, 7, 3)), std::pair("fails", failing_case()),
        std::pair("circle", circle_case(500)), std::pair("unfinished", unfinished_case())}) {
    SCOPED_TRACE(name);
    std::string html = write_html(made.record, made.evaluation, Edition(Language::kEnglish, true));
    const std::string pdf = printed(html, Paper::kA4);
    EXPECT_THAT(lacking(pdf, html), IsEmpty());
    EXPECT_EQ(edition_of_pdf(pdf), Edition(Language::kEnglish, true));
    html.insert(html.find("</footer>"), "<b>not on paper</b>");
    EXPECT_THAT(lacking(pdf, html), ::testing::ElementsAre("notonpaper"));
  }
}

TEST_F(Pdf, HasItsTitleItsPaperItsFontsAndThePageThatItWasPrintedFrom) {
  const Case made = cylinder_case(4, 7, 3);
  const std::string html = page_of(made);
  const std::string a4 = printed(html, Paper::kA4);
  EXPECT_THAT(said_of(a4, "pdfinfo"),
              AllOf(HasSubstr("VS-1180 0042 - conforms\n"), HasSubstr("Tagged:          yes"),
                    HasSubstr("JavaScript:      no"), HasSubstr("(A4)")));
  expect_embedded(a4);
  const std::string pdf = printed(html, Paper::kLetter);
  EXPECT_THAT(said_of(pdf, "pdfinfo"), HasSubstr("(letter)"));
  EXPECT_TRUE(is_printed_from(html, pdf));
  EXPECT_TRUE(is_printed_from(html, pdf, Paper::kLetter));
  EXPECT_FALSE(is_printed_from(html, pdf, Paper::kA4));
  EXPECT_FALSE(is_printed_from(page_of(failing_case()), pdf));
  EXPECT_FALSE(is_printed_from(html, ""));
  const std::size_t at = pdf.rfind("page-sha256-");
  ASSERT_NE(at, std::string::npos);
  // As version 0.2 stated it, within the document information.
  const std::string earlier = "/Creator (rondure 0.2.0, " + pdf.substr(at, 76) +
                              ", page-language-zh-Hans)\n/Title (t)\n%%EOF";
  EXPECT_TRUE(is_printed_from(html, earlier));
  EXPECT_EQ(edition_of_pdf(earlier), Language::kChinese);
}

TEST_F(Pdf, EveryPageHasPartRevisionRunSimulatedAndItsNumberAndNoPathOfAFile) {
  Case made = cylinder_case(4, 7, 150);
  made.record.header.plan_revision = "C7";
  const auto pages = pages_of(printed(made));
  ASSERT_GE(pages.size(), 3U);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    EXPECT_THAT(pages[i],
                AllOf(HasSubstr("Part VS-1180 / 0042"), HasSubstr("Revision C7 · SIMULATED"),
                      HasSubstr("Run 01_spool_simulated"), Not(HasSubstr("file:")),
                      Not(HasSubstr("report.html"))));
    EXPECT_THAT(inked(pages[i]), ::testing::EndsWith(fmt::format("{}/{}", i + 1, pages.size())));
  }
  EXPECT_LT(pages.front().find("Conforms"), pages.front().find("Characteristic"));
}

TEST_F(Pdf, AChinesePageIsPrintedInChinese) {
  const Case made = failing_case();
  const std::string html = write_html(made.record, made.evaluation, Language::kChinese);
  const std::string pdf = printed(html, Paper::kA4);
  EXPECT_THAT(body_ink(pdf), HasSubstr("不合格"));
  EXPECT_THAT(pages_of(pdf).back(), HasSubstr("版本"));
  expect_embedded(pdf);
  EXPECT_EQ(edition_of_pdf(pdf), Language::kChinese);
}

TEST_F(Pdf, HostileNamesStayTextInTheHeadOfEachPage) {
  for (const std::string& text :
       {std::string("</style><b>q</b>\"'}\\{"), std::string("<!-- */ %PDF-1.4 endobj"),
        std::string("page-sha256-0000, page-language-zh-Hans"), std::string(10'000, 'W')}) {
    SCOPED_TRACE(text.substr(0, 40));
    Case made = cylinder_case(4, 7, 3);
    made.record.header.part_id = text;
    made.record.header.serial.clear();
    const std::string html = page_of(made);
    const std::string pdf = printed(html, Paper::kA4);
    EXPECT_THAT(inked(pages_of(pdf).back()), HasSubstr("Part" + inked(text).substr(0, 16)));
    EXPECT_TRUE(is_printed_from(html, pdf, Paper::kA4));
    EXPECT_EQ(edition_of_pdf(pdf), Language::kEnglish);
  }
}

TEST(PdfFailure, WithoutChromiumThePackageIsNamed) {
  const PdfFolder folder;
  ::setenv("PATH", "/nowhere::relative", 1);
  const auto pdf = print_pdf("<html><head></head></html>", Paper::kA4);
  ASSERT_FALSE(pdf);
  EXPECT_EQ(pdf.error().code, core::Code::kFile);
  EXPECT_THAT(pdf.error().what, AllOf(HasSubstr("install it (Debian: chromium)"),
                                      HasSubstr("leave pdf out of the formats")));
}

TEST(PdfFailure, ChromiumThatIsKilledFailsHangsOrEndsWithHalfADocumentIsToldAndLeavesNothing) {
  struct Fault {
    const char* script;
    const char* what;
  };
  for (const Fault& fault :
       {Fault{"printf %%PDF-1.4 >\"$pdf\"; kill -9 $$", "was ended by signal 9 (Killed)"},
        Fault{"echo No usable sandbox! >&2; exit 21", "ended with status 21: No usable sandbox!"},
        Fault{"sleep 60 & sleep 60", "did not end within 0.5 s and was killed"},
        Fault{"printf '%%PDF-1.4 startxref' >\"$pdf\"", "without a whole document"},
        Fault{"exit 0", "without a whole document"}}) {
    SCOPED_TRACE(fault.script);
    const PdfFolder folder;
    folder.have_browser(fault.script);
    const auto pdf =
        print_pdf("<html><head></head></html>", Paper::kA4, std::chrono::milliseconds(500));
    ASSERT_FALSE(pdf);
    EXPECT_THAT(pdf.error().what,
                AllOf(HasSubstr("the page cannot be printed: "), HasSubstr(fault.what)));
    EXPECT_TRUE(fs::is_empty(folder / "temporary"));
  }
}

TEST(PdfFailure, AnEarlierPdfStaysAndTheOtherReportsAreWritten) {
  const PdfFolder folder;
  folder.have_browser("printf %%PDF-1.4 >\"$pdf\"; kill -9 $$");
  const Case made = cylinder_case(4, 7, 3);
  std::ofstream(folder / "report.pdf") << "earlier";
  const auto written =
      write_exports(folder / "", {"pdf", "html", "qif"}, made.record, made.evaluation);
  ASSERT_FALSE(written);
  EXPECT_EQ(record::read_file(folder / "report.pdf").value_or(""), "earlier");
  EXPECT_TRUE(fs::exists(folder / "report.html") && fs::exists(folder / "report.qif"));
}

}  // namespace
}  // namespace rondure::reports
