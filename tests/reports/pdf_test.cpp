// report.pdf as other programs read it (poppler's), and how it is broken into pages.

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "reports/exports.h"
#include "reports/pdf_pages.h"
#include "reports/pdf_report.h"
#include "reports/pdf_source.h"
#include "reports/text.h"
#include "reports/writers.h"
#include "synthetic.h"
#include "tests/reports/points_run.h"

namespace rondure::reports {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Pdf pdf_of(const record::RunRecord& record, const std::string& html) {
  auto pdf = write_pdf(record, html);
  EXPECT_TRUE(pdf) << pdf.error().what;
  return pdf ? std::move(*pdf) : Pdf{};
}

Pdf pdf_of(const Case& made) { return pdf_of(made.record, page_of(made)); }

/// What a program says of a document; RONDURE_KEEP names a folder to keep the documents in.
std::string said_of(const Pdf& pdf, const std::string& program, const std::string& after = {}) {
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("rondure_pdf_test.{}.pdf", ::getpid());
  std::ofstream(file, std::ios::binary) << pdf.bytes;
  const std::string command = fmt::format("{} '{}' {} 2>&1", program, file.string(), after);
  std::string said;
  if (FILE* pipe = ::popen(command.c_str(), "r")) {
    std::array<char, 4096> some{};
    for (std::size_t n = 0; (n = std::fread(some.data(), 1, some.size(), pipe)) > 0;) {
      said.append(some.data(), n);
    }
    EXPECT_EQ(::pclose(pipe), 0) << command << ": " << said.substr(0, 500);
  }
  std::filesystem::remove(file);
  return said;
}

void keep(const std::string& name, const Pdf& pdf) {
  if (const char* folder = std::getenv("RONDURE_KEEP")) {
    std::ofstream(std::filesystem::path(folder) / (name + ".pdf"), std::ios::binary) << pdf.bytes;
  }
}

/// Pages in the order in which they were set, head and foot first.
std::vector<std::string> pages_of(const Pdf& pdf) {
  std::vector<std::string> pages;
  const std::string all = said_of(pdf, "pdftotext -raw", "-");
  for (std::size_t from = 0; from < all.size();) {
    const std::size_t end = std::min(all.find('\f', from), all.size());
    pages.push_back(all.substr(from, end - from));
    from = end + 1;
  }
  return pages;
}

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

/// All ink of the pages without their heads and feet.
std::string body_ink(const Pdf& pdf) {
  std::string out;
  for (const std::string& page : pages_of(pdf)) {
    const std::size_t foot = page.find("Rondure 0.");  // and the number of the page
    const std::size_t end = page.find('\n', foot);
    EXPECT_NE(end, std::string::npos) << page.substr(0, 300);
    out += inked(page.substr(std::min(end, page.size())));
  }
  return out;
}

/// Texts of a page: one of each text node, without those of a drawing's title.
void add_texts(const pugi::xml_node& node, std::vector<std::string>& out) {
  for (const pugi::xml_node child : node) {
    if (!pdf::on_paper(child)) continue;
    const std::string_view name = child.name();
    if (name == "title" || name == "desc" || name == "metadata") continue;
    if (child.type() == pugi::node_pcdata && !inked(child.value()).empty()) {
      out.push_back(inked(child.value()));
    }
    add_texts(child, out);
  }
}

std::vector<std::string> texts_of(const std::string& html) {
  std::vector<std::string> out;
  const auto page = pdf::read_page(html);
  EXPECT_TRUE(page) << page.error().what;
  if (page) add_texts(page->tree, out);
  return out;
}

/// Texts of the page that the document lacks; empty when it says all.
std::vector<std::string> lacking(const Pdf& pdf, const std::string& html) {
  const std::string ink = body_ink(pdf);
  std::vector<std::string> out;
  for (const std::string& text : texts_of(html)) {
    if (ink.find(text) == std::string::npos) out.push_back(text.substr(0, 200));
  }
  return out;
}

void expect_uncut(const Pdf& pdf) {
  for (const PdfFigure& figure : pdf.figures) {
    SCOPED_TRACE(fmt::format("page {}, from {} to {}", figure.page, figure.top, figure.bottom));
    EXPECT_TRUE(figure.whole);
    EXPECT_GE(figure.left, kPdfMargin - 1e-6);
    EXPECT_LE(figure.right, kPdfWidth - kPdfMargin + 1e-6);
    EXPECT_GE(figure.top, kPdfTop - 1e-6);
    EXPECT_LE(figure.bottom, kPdfHeight - kPdfBottom + 1e-6);
    EXPECT_GE(figure.page, 1);
    EXPECT_LE(figure.page, pdf.pages);
  }
}

/// Every line of pdffonts ends in "emb sub uni object ID".
void expect_embedded(const Pdf& pdf) {
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

std::vector<std::pair<const char*, Case>> all_kinds() {
  return {{"conforms", cylinder_case(4, 7, 3)},
          {"refined", cylinder_case(4, 7, 150)},
          {"fails", failing_case()},
          {"circle", circle_case(500)},
          {"unfinished", unfinished_case()},
          {"spiral", spiral_case(150)},
          {"dense", cylinder_case(12, 360, 8)}};
}

TEST(Pdf, SaysEveryTextOfThePageAndCutsNoFigure) {
  for (const auto& [name, made] : all_kinds()) {
    SCOPED_TRACE(name);
    const std::string html = page_of(made);
    const Pdf pdf = pdf_of(made.record, html);
    keep(name, pdf);
    EXPECT_GT(texts_of(html).size(), 40U);
    EXPECT_THAT(lacking(pdf, html), ::testing::IsEmpty());
    expect_uncut(pdf);
    EXPECT_TRUE(pdf.missing.empty());
  }
}

TEST(Pdf, SaysEveryTextOfEvaluatedUncertainAndOfEmptyRuns) {
  const record::RunRecord run = points_run(rough_part(7, 4, 36, 6.2), 4);
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation) << evaluation.error().what;
  for (const Case& made : {Case{run, *evaluation}, Case{}}) {
    const std::string html = page_of(made);
    const Pdf pdf = pdf_of(made.record, html);
    EXPECT_THAT(lacking(pdf, html), ::testing::IsEmpty());
    expect_uncut(pdf);
  }
}

TEST(Pdf, AnUnknownTagIsSetAsTextAndWhatIsForTheScreenAloneIsNot) {
  const std::string html =
      "<html lang=\"en\"><head><title>t</title><style>:root{--ink:#123}@media print{a{b:c}}"
      "</style></head><body><main><h1>one</h1><marquee>two "
      "<blink>three</blink><p>four</p></marquee>"
      "<table><caption>five</caption><tr><td>six<aside>seven</aside></td></tr></table>"
      "<details><summary>eight</summary>nine<br>ten</details><div class=\"new thing\">eleven</div>"
      "<dl><dt>twelve</dt><dd>thirteen</dd></dl><figure><pre>fourteen</pre></figure>"
      "<div class=\"print-only\">fifteen</div><ol><li>sixteen</li></ol>"
      "<div class=\"wide screen-only\">never</div><button hidden=\"\">never</button>"
      "<script>if (a < b && c) never();</script></main></body></html>";
  const Pdf pdf = pdf_of({}, html);
  EXPECT_THAT(lacking(pdf, html), ::testing::IsEmpty());
  EXPECT_GE(texts_of(html).size(), 16U);
  EXPECT_THAT(body_ink(pdf),
              AllOf(HasSubstr("fourteen"), HasSubstr("sixteen"), Not(HasSubstr("never"))));
}

TEST(Pdf, TheComparisonOfTextsSeesOneThatIsMissing) {
  const Case made = cylinder_case(4, 7, 3);
  std::string html = page_of(made);
  const Pdf pdf = pdf_of(made.record, html);
  html.insert(html.find("</footer>"), "<b>not on paper</b>");
  EXPECT_THAT(lacking(pdf, html), ::testing::ElementsAre("notonpaper"));
}

TEST(Pdf, EveryPageHasPartRevisionRunAndItsNumber) {
  Case made = cylinder_case(4, 7, 150);
  made.record.header.plan_revision = "C7";
  const Pdf pdf = pdf_of(made);
  const auto pages = pages_of(pdf);
  ASSERT_GE(pages.size(), 3U);
  EXPECT_EQ(static_cast<int>(pages.size()), pdf.pages);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    EXPECT_THAT(pages[i], AllOf(HasSubstr("Part VS-1180 / 0042"), HasSubstr("Revision C7"),
                                HasSubstr("Run " + made.record.header.run_id),
                                HasSubstr(fmt::format("Page {} of {}\n", i + 1, pages.size()))));
  }
  const std::size_t verdict = pages.front().find("Conforms");
  EXPECT_LT(verdict, pages.front().find("Characteristic"));
}

TEST(Pdf, TellsViewersWhatItIs) {
  const Case made = cylinder_case(4, 7, 3);
  const std::string info = said_of(pdf_of(made), "TZ=UTC pdfinfo");
  EXPECT_THAT(info, AllOf(HasSubstr("VS-1180 0042 - conforms\n"), HasSubstr("M. Example\n"),
                          HasSubstr("run " + made.record.header.run_id), HasSubstr("revision"),
                          HasSubstr("page-sha256-"), HasSubstr("Nov 21 02:33:02 2026"),
                          HasSubstr("(A4)"), HasSubstr("JavaScript:      no")));
}

TEST(Pdf, TheSameRecordGivesTheSameBytes) {
  const Case made = failing_case();
  EXPECT_EQ(pdf_of(made).bytes, pdf_of(made).bytes);
}

TEST(Pdf, ChineseHebrewAndArabicAreEmbeddedAndReadable) {
  Case made = cylinder_case(4, 7, 3);
  made.record.header.part_name = "\u5706\u67F1\u5EA6 \u9600\u82AF";
  made.record.header.operator_name = "\u05D0\u05D1\u05D2";
  made.record.header.machine = "\u0645\u0631\u062D\u0628\u0627";
  const Pdf pdf = pdf_of(made);
  keep("scripts", pdf);
  EXPECT_TRUE(pdf.missing.empty()) << missing_in_words(pdf.missing);
  expect_embedded(pdf);
  EXPECT_THAT(body_ink(pdf), HasSubstr("\u5706\u67F1\u5EA6"));
  EXPECT_THAT(said_of(pdf, "pdftotext", "-"), HasSubstr("\u05D0\u05D1\u05D2"));
  EXPECT_THAT(said_of(pdf, "pdfinfo"), HasSubstr("\u05D0\u05D1\u05D2"));
}

TEST(Pdf, AChinesePageIsSetInChinese) {
  const Case made = failing_case();
  const std::string html = write_html(made.record, made.evaluation, Language::kChinese);
  const Pdf pdf = pdf_of(made.record, html);
  keep("chinese", pdf);
  EXPECT_THAT(lacking(pdf, html), ::testing::IsEmpty());
  EXPECT_TRUE(pdf.missing.empty()) << missing_in_words(pdf.missing);
  expect_embedded(pdf);
  expect_uncut(pdf);
  EXPECT_EQ(language_of_pdf(pdf.bytes), Language::kChinese);
  EXPECT_NE(pdf.bytes, pdf_of(made).bytes);
}

TEST(Pdf, HostileTextsStayTextOnEveryPage) {
  for (const std::string& text :
       {std::string("<script>alert(1)</script>"), std::string("</style></title>\"'><svg onload=x>"),
        std::string("&b; &lt; &amp;amp; ]]> <!-- (\\) %PDF-1.4 endobj"), std::string(500, 'W'),
        std::string("\xff\xc3(\x01\x1b[31m"),
        std::string("{0} %s page-sha256-0000, page-language-zh-Hans")}) {
    SCOPED_TRACE(text.substr(0, 40));
    const Case made = hostile_case(text);
    const std::string html = page_of(made);
    const Pdf pdf = pdf_of(made.record, html);
    EXPECT_THAT(lacking(pdf, html), ::testing::IsEmpty());
    EXPECT_THAT(pages_of(pdf).back(), HasSubstr(fmt::format("Page {0} of {0}\n", pdf.pages)));
    expect_uncut(pdf);
    const auto same = pdf_difference(pdf.bytes, pdf.bytes + " ", true);
    EXPECT_FALSE(same) << *same;
    EXPECT_EQ(language_of_pdf(pdf.bytes), Language::kEnglish);
  }
}

TEST(Pdf, TenKilobytesOfANameGoOnOverPages) {
  Case made = cylinder_case(4, 7, 3);
  made.record.header.part_name = std::string(10'000, 'W');
  made.record.header.plan_revision = std::string(10'000, 'R');
  made.record.decisions.at(0).message = {core::MessageCode::kSentence, {std::string(10'000, 'D')}};
  const std::string html = page_of(made);
  const Pdf pdf = pdf_of(made.record, html);
  keep("ten-kilobytes", pdf);
  EXPECT_THAT(lacking(pdf, html), ::testing::IsEmpty());
  expect_uncut(pdf);
}

TEST(Pdf, ACharacterWithoutAFontIsSaidNotJustBoxed) {
  Case made = cylinder_case(4, 7, 3);
  made.record.header.part_name = "\U000F1234";  // of private use: in no font
  const Pdf pdf = pdf_of(made);
  ASSERT_EQ(pdf.missing.size(), 1U);
  EXPECT_THAT(missing_in_words(pdf.missing), HasSubstr("characters of the report: U+F1234."));
  EXPECT_THAT(pages_of(pdf).front(), HasSubstr("U+F1234."));
  EXPECT_EQ(missing_in_words({}), "");
}

TEST(Pdf, APageThatIsNoXmlIsRefusedWithThePlace) {
  const auto made = write_pdf({}, "<html><body><p>open<b></p></body></html>");
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, core::Code::kInternal);
  EXPECT_THAT(made.error().what, HasSubstr("not well-formed"));
  EXPECT_FALSE(write_pdf({}, "no page"));
}

TEST(Pdf, IsComparedByBytesByPageAndByDigest) {
  const std::string old = pdf_of(cylinder_case(4, 7, 3)).bytes;
  const std::string other = pdf_of(failing_case()).bytes;
  const std::string with_other_fonts = old + "%";
  EXPECT_FALSE(pdf_difference(old, old, false));
  EXPECT_FALSE(pdf_difference(old, with_other_fonts, true));
  EXPECT_THAT(pdf_difference(old, with_other_fonts, false).value_or(""), HasSubstr("its bytes"));
  EXPECT_THAT(pdf_difference(old, other, true).value_or(""), HasSubstr("another page"));
}

TEST(Pdf, AReportOf28TouchesIsSetAtOnceWhenTheFontsAreRead) {
  const Case made = cylinder_case(4, 7, 3);
  const std::string html = page_of(made);
  (void)pdf_of(made.record, html);
  double best_s = 1e9;  // of the processor, which may have others to serve
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();
    (void)pdf_of(made.record, html);
    best_s = std::min(best_s, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::printf("a PDF of 28 touches: %.0f ms\n", 1e3 * best_s);
  EXPECT_LT(best_s, 0.25);
}

TEST(Pdf, AHundredThousandPointsAreSetInBoundedTime) {
  const Case made = cylinder_case(1, 100000, 3);
  const std::string html = page_of(made);
  const auto start = std::chrono::steady_clock::now();
  const Pdf pdf = pdf_of(made.record, html);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 5.0);
  EXPECT_LT(pdf.bytes.size(), 5'000'000U);
  EXPECT_EQ(pdf.figures.empty(), false);
  RecordProperty("seconds", std::to_string(took.count()));
}

/// A box of so many lines, each `line` high, that notes what is drawn.
class Lines final : public pdf::Box {
 public:
  Lines(int lines, double line) : lines_(lines), line_(line) { height_ = lines * line; }
  [[nodiscard]] pdf::Widths widths() const override { return {}; }
  void lay(double width) override { width_ = width; }
  void draw(cairo_t*, double, double, const pdf::Slice&) const override {}
  void add_spans(double top, std::vector<pdf::Span>& spans) const override {
    for (int i = 0; i < lines_; ++i) spans.push_back({top + i * line_, top + (i + 1) * line_});
  }
  [[nodiscard]] int lines_in(const pdf::Slice& slice) const {
    int number = 0;
    for (int i = 0; i < lines_; ++i) number += slice.holds(i * line_) ? 1 : 0;
    return number;
  }

 private:
  int lines_;
  double line_;
};

TEST(PdfPages, ShowEveryLineOnceAndCutOnlyWhatMayBeCut) {
  constexpr double kHeight = 700.0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 draw(seed);
    std::vector<pdf::Brick> bricks(40);
    std::vector<const Lines*> boxes;
    for (pdf::Brick& brick : bricks) {
      const int lines =
          draw() % 6 == 0 ? static_cast<int>(draw() % 150) : static_cast<int>(draw() % 9);
      auto box = std::make_unique<Lines>(lines + 1, 8.0 + static_cast<double>(draw() % 5));
      boxes.push_back(box.get());
      brick.box = std::move(box);
      brick.space_before = static_cast<double>(draw() % 20);
      brick.may_be_cut = draw() % 2 == 0;
      brick.keep_with_next = draw() % 5 == 0;
    }
    std::vector<int> shown(bricks.size());
    double below = 0.0;
    int page = 0;
    for (const pdf::Placed& placed : pdf::paginate(bricks, kHeight)) {
      const auto i = static_cast<std::size_t>(placed.brick - bricks.data());
      EXPECT_GE(placed.page, page);
      EXPECT_GE(placed.top, placed.page == page ? below - 1e-6 : -1e-6);
      page = placed.page;
      below = placed.top + placed.height();
      EXPECT_LE(below, kHeight + 1e-3);
      shown[i] += boxes[i]->lines_in(placed.slice);
      const bool whole = placed.height() >= boxes[i]->height() - 1e-6;
      EXPECT_TRUE(whole || bricks[i].may_be_cut || boxes[i]->height() > kHeight);
    }
    for (std::size_t i = 0; i < bricks.size(); ++i) {
      EXPECT_EQ(shown[i], boxes[i]->lines_in({})) << i;
    }
  }
}

TEST(PdfPages, AHeadingGoesWithWhatFollowsAndAHeadIsRepeated) {
  std::vector<pdf::Brick> bricks(70);
  for (pdf::Brick& brick : bricks) brick.box = std::make_unique<Lines>(1, 20.0);
  const pdf::Box* head = bricks[33].box.get();  // 33 rows before it leave room for two more
  bricks[33].keep_with_next = true;
  for (std::size_t i = 34; i < bricks.size(); ++i) bricks[i].head = head;
  bricks[32].keep_with_next = true;
  const auto placed = pdf::paginate(bricks, 700.0);
  int heads = 0;
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const bool ends_page = k + 1 == placed.size() || placed[k + 1].page > placed[k].page;
    EXPECT_FALSE(ends_page && placed[k].brick->keep_with_next) << k;
    heads += placed[k].box == head ? 1 : 0;
    const bool begins_last = k > 0 && placed[k].page == 2 && placed[k - 1].page == 1;
    EXPECT_TRUE(!begins_last || placed[k].box == head) << k;
  }
  EXPECT_EQ(heads, placed.back().page >= 2 ? 3 : 2);
}

}  // namespace
}  // namespace rondure::reports
