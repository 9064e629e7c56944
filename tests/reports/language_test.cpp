// The catalogue of texts: complete, nothing in it unused, both sides of a line alike; and the
// reports that are written with it.

#include "reports/words/language.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/escaping.h"
#include "reports/formats/exports.h"
#include "reports/html/report.h"
#include "reports/terminal/internal/columns.h"
#include "reports/terminal/summary.h"
#include "reports/words/internal/zh.h"
#include "synthetic.h"
#include "tests/app/program.h"
#include "tests/reports/english_left.h"
#include "tests/reports/page_text.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// ---- The sources -------------------------------------------------------------------------------

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The sources of rooms, a line each. xgettext ends at a string that is not UTF-8: `left_out`.
std::string sources_of(const std::vector<std::string>& rooms,
                       const std::vector<std::string>& left_out = {}) {
  std::string out;
  for (const std::string& room : rooms) {
    const fs::path root = fs::path(RONDURE_SOURCE_DIR) / room;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      const std::string file = entry.path().string();
      const bool is_left_out =
          std::any_of(left_out.begin(), left_out.end(),
                      [&](const std::string& part) { return file.find(part) != file.npos; });
      if (!is_left_out && (file.ends_with(".h") || file.ends_with(".cpp"))) out += file + '\n';
    }
  }
  return out;
}

/// Runs a command; its status and what it said.
std::pair<int, std::string> run(const std::string& command, const fs::path& said) {
  const int status = std::system((command + " >'" + said.string() + "' 2>&1").c_str());
  return {status, text_of(said)};
}

/// Writes the strings of sources (`how`: which) as a template of a catalogue.
void extract(const std::string& sources, const std::string& how, const fs::path& to) {
  const fs::path files = to.string() + ".files";
  std::ofstream(files) << sources;
  const auto [status, said] =
      run("xgettext --language=C++ --from-code=UTF-8 --no-wrap --add-location=file " + how +
              " --files-from='" + files.string() + "' --output='" + to.string() + "'",
          to.string() + ".said");
  ASSERT_EQ(status, 0) << said;
}

constexpr const char* kAsked =
    "--keyword --keyword=tr --keyword=trf --keyword=translatable --keyword=phrase";
const fs::path kCatalogue = fs::path(RONDURE_SOURCE_DIR) / "reports/words/zh.po";

TEST(LanguageTable, HasEveryTextThatTheReportsAskFor) {
  const app::testing::Scratch folder;
  ASSERT_NO_FATAL_FAILURE(extract(sources_of({"reports", "web", "app", "evaluation", "fit"}),
                                  kAsked, folder / "asked"));
  const std::string asked = text_of(folder / "asked");
  EXPECT_GT(std::count(asked.begin(), asked.end(), '\n'), 3 * 600);  // place, text and translation
  const auto [status, said] = run(
      "msgcmp " + kCatalogue.string() + " '" + (folder / "asked").string() + "'", folder / "said");
  // A line of the catalogue that no tr() names is none too many: a variable may.
  EXPECT_EQ(status, 0) << said;
}

TEST(LanguageTable, ATextWithoutChineseFailsTheComparison) {
  const app::testing::Scratch folder;
  for (const char* function : {"tr", "core::phrase"}) {
    std::ofstream(folder / "more.cpp")
        << "auto a = " << function << "(\"nobody translated \" \"this\");\n";
    ASSERT_NO_FATAL_FAILURE(
        extract((folder / "more.cpp").string() + '\n', kAsked, folder / "asked"));
    EXPECT_THAT(text_of(folder / "asked"), HasSubstr("msgid \"nobody translated this\"\n"));
    const auto [status, said] =
        run("msgcmp " + kCatalogue.string() + " '" + (folder / "asked").string() + "'",
            folder / "said");
    EXPECT_NE(status, 0);
    EXPECT_THAT(said, HasSubstr("this message is used but not defined"));
  }
}

/// A text as a catalogue spells it, without the quotes at its ends.
std::string escaped_in_catalogue(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

TEST(LanguageTable, HasNothingThatNoSourceSays) {
  const app::testing::Scratch folder;
  const std::string sources = sources_of(
      {"reports", "web", "evaluation", "record", "fit", "plans", "cmm", "fixture", "core"},
      {"/record/csv/", "/record/journal/"});
  ASSERT_NO_FATAL_FAILURE(extract(sources, "--extract-all", folder / "all"));
  const std::string all = text_of(folder / "all");
  for (const Translation& line : chinese_texts()) {
    if (line.context == Translation::kCode) continue;
    const std::string message = "msgid \"" + escaped_in_catalogue(line.english) + "\"\n";
    EXPECT_NE(all.find(message), std::string::npos) << message;
  }
}

// ---- The lines ---------------------------------------------------------------------------------

TEST(LanguageTable, IsTheCatalogueInItsWholeLength) {
  const std::string catalogue = text_of(kCatalogue);
  std::size_t messages = 0;
  for (std::size_t at = catalogue.find("\nmsgid "); at != std::string::npos;
       at = catalogue.find("\nmsgid ", at + 1)) {
    ++messages;
  }
  EXPECT_EQ(chinese_texts().size(), messages - 1);  // one is the head of the catalogue
  EXPECT_GT(messages, 900U);
}

/// The places of a format: how often each argument stands there, and as what.
std::multiset<std::string> places_of(std::string_view format) {
  std::multiset<std::string> out;
  int next = 0;
  for (std::size_t open = format.find('{'); open != std::string_view::npos;
       open = format.find('{', open + 1)) {
    std::string inside(format.substr(open + 1, format.find('}', open) - open - 1));
    if (inside.empty() || inside.front() == ':') inside = std::to_string(next++) + inside;
    out.insert(inside);
  }
  return out;
}

/// Whether a format counts some of its places and numbers others, which {fmt} refuses.
bool mixes_places(std::string_view format) {
  bool counts = false;
  bool numbers = false;
  for (std::size_t open = format.find('{'); open != std::string_view::npos;
       open = format.find('{', open + 1)) {
    const char next = format[open + 1];
    (next >= '0' && next <= '9' ? numbers : counts) = true;
  }
  return counts && numbers;
}

bool is_chinese(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= 0xE3; });
}

TEST(LanguageTable, HasTheSameArgumentsOnBothSidesOfAFormat) {
  for (const Translation& line : chinese_texts()) {
    EXPECT_EQ(places_of(line.english), places_of(line.chinese)) << line.english;
    EXPECT_FALSE(mixes_places(line.chinese)) << line.chinese;
  }
}

/// Whether a text says nothing in words: numbers, units, marks and symbols alone ("MZCY", "{} um").
/// Three small letters in a row are a word, but for the units deg, degC and urad.
bool has_no_words(std::string_view text) {
  const auto is_small = [](char c) { return c >= 'a' && c <= 'z'; };
  while (!text.empty()) {
    const auto first = std::find_if(text.begin(), text.end(), is_small);
    const auto last = std::find_if_not(first, text.end(), is_small);
    const std::string_view word(first, last);
    if (word.size() >= 3 && word != "deg" && word != "urad") return false;
    text = std::string_view(last, text.end());
  }
  return true;
}

TEST(LanguageTable, SaysItInChinese) {
  const auto is_name = [](std::string_view text) {  // of a standard, a rule or a person
    for (const char* name : {"ISO ", "JCGM ", "N:1", "Anderson-Darling"}) {
      if (text.find(name) != std::string_view::npos) return true;
    }
    return false;
  };
  for (const Translation& line : chinese_texts()) {
    if (has_no_words(line.english) || is_name(line.chinese)) continue;
    EXPECT_TRUE(is_chinese(line.chinese)) << line.english;
  }
}

TEST(LanguageTable, HasATitleOfItsOwnForEveryCode) {
  const LanguageScope scope(Language::kChinese);
  std::set<std::string> titles;
  for (int i = 0; i <= static_cast<int>(core::kLastCode); ++i) {
    const auto code = static_cast<core::Code>(i);
    EXPECT_TRUE(is_chinese(title_of(code))) << core::code_name(code);
    EXPECT_TRUE(titles.insert(title_of(code)).second) << core::code_name(code);
  }
  const auto is_title = [](const Translation& line) { return line.context == Translation::kCode; };
  EXPECT_EQ(std::count_if(chinese_texts().begin(), chinese_texts().end(), is_title),
            static_cast<long>(titles.size()));
}

// ---- Scope and sentences -----------------------------------------------------------------------

TEST(LanguageScope, LastsAsLongAsItsObjectInItsThreadOnly) {
  EXPECT_EQ(tr("void"), "void");
  {
    const LanguageScope outer(Language::kChinese);
    EXPECT_EQ(tr("void"), "无效");
    std::string elsewhere;
    std::thread([&] { elsewhere = tr("void"); }).join();
    EXPECT_EQ(elsewhere, "void");
    {
      const LanguageScope inner(Language::kEnglish);
      EXPECT_EQ(tr("void"), "void");
    }
    EXPECT_EQ(tr("void"), "无效");
    EXPECT_EQ(tr("no such text"), "no such text");
    EXPECT_EQ(trf("Feature {} has {} of {} points.", "A", 3, 7), "要素 A 测得 7 个点中的 3 个。");
  }
  EXPECT_EQ(language(), Language::kEnglish);
  EXPECT_EQ(language_named("fr"), std::nullopt);
  for (const std::string& name : language_names()) EXPECT_TRUE(language_named(name)) << name;
}

TEST(Phrase, IsMadeInTheLanguageOfTheReport) {
  const core::Phrase value = core::phrase("the corrected value {}", "5.169 um");
  const core::Phrase sentence =
      core::phrase("{} is within the acceptance limit of {} (tolerance {}, guard band {})", value,
                   "11.691 um", "12 um", "0.309 um");
  const std::string english =
      "the corrected value 5.169 um is within the acceptance limit of 11.691 um (tolerance 12 um, "
      "guard band 0.309 um)";
  EXPECT_EQ(in_words(sentence), english);
  const LanguageScope scope(Language::kChinese);
  EXPECT_EQ(in_words(sentence),
            "修正值 5.169 um 未超出接收限 11.691 um（公差 12 um，保护带 0.309 um）");
  EXPECT_EQ(sentence.english(), english);  // what programs read has no language
  EXPECT_EQ(in_words(joined(core::phrase("{}, scanned", core::phrase("{} x {} points", 4, 360)),
                            core::phrase("r_tip {:.4f} mm", 1.9984))),
            "4 x 360 点，扫描；测头半径 1.9984 mm");
  EXPECT_EQ(in_words(core::Phrase("finished")), "已完成");
  EXPECT_EQ(in_words(core::Phrase()), "");
}

TEST(Phrase, WithAPartThatNobodyTranslatedIsLeftToEnglish) {
  const LanguageScope scope(Language::kChinese);
  EXPECT_EQ(in_words(core::Phrase("a sentence of somebody else")), std::nullopt);
  EXPECT_EQ(in_words(core::phrase("layer {}: {}", 3, core::Phrase("a machine {said} this"))),
            std::nullopt);
  EXPECT_EQ(in_sentence(core::Phrase("7.1 um, said <b>")),
            "<bdi lang=\"en\">7.1 \u00b5m, said &lt;b&gt;</bdi>");
}

TEST(Phrase, NeverTakesANameForAWord) {
  const LanguageScope scope(Language::kChinese);
  EXPECT_EQ(
      in_words(core::phrase("harmonic {} of part {} is nearest to its limit", 5, "unfiltered")),
      "工件 unfiltered 的第 5 次谐波最接近其限值");
  EXPECT_EQ(in_words(core::phrase("part {}", "{} void; none")), "工件 {} void; none");
}

TEST(Phrase, OfASentenceThatIsAlreadyTextStaysEnglish) {
  const LanguageScope scope(Language::kChinese);
  const core::Error read = {core::Code::kMeaning, "7.958 um is within the tolerance of 12 um", {}};
  EXPECT_EQ(in_words(read.said()), std::nullopt);  // nothing recognises sentences
  const core::Error made =
      core::error_of(core::Code::kMeaning, core::phrase("the probe was not qualified"));
  EXPECT_EQ(in_words(made.at("/probe").said()), "测头未经校准");
  EXPECT_EQ(made.what, "the probe was not qualified");
}

// ---- The reports -------------------------------------------------------------------------------

std::vector<std::string> user_texts_of(const Case& made) {
  const record::Header& h = made.record.header;
  std::vector<std::string> out = {h.part_id,       h.part_name, h.drawing, h.serial,
                                  h.operator_name, h.plan_name, h.run_id,  h.plan_file,
                                  h.plan_revision, h.plan_file};
  for (const evaluation::FeatureResult& result : made.evaluation.features) {
    out.insert(out.end(), {result.feature.id, result.feature.points_file});
    for (const auto& c : result.characteristics) out.push_back(c.characteristic.id);
  }
  return out;
}

std::string chinese_page_of(const Case& made) {
  return write_html(made.record, made.evaluation, Language::kChinese);
}

TEST(ChineseReport, HasNoEnglishThatDoesNotSayThatItIsEnglish) {
  const std::array<std::pair<const char*, Case>, 6> cases = {{{"conforms", cylinder_case(4, 7, 3)},
                                                              {"many", cylinder_case(14, 9, 150)},
                                                              {"fails", failing_case()},
                                                              {"circle", circle_case(500)},
                                                              {"unfinished", unfinished_case()},
                                                              {"spiral", spiral_case(20000)}}};
  for (const auto& [name, made] : cases) {
    SCOPED_TRACE(name);
    const std::string page = chinese_page_of(made);
    EXPECT_EQ(testing::english_left(page, user_texts_of(made)), "");
    EXPECT_EQ(testing::first_unbalanced_tag(page), "");
    EXPECT_THAT(page, StartsWith("<!DOCTYPE html>\n<html lang=\"zh-Hans\">"));
    EXPECT_EQ(edition_of_page(page), Language::kChinese);
    EXPECT_EQ(edition_of_page(write_html(made.record, made.evaluation)), Language::kEnglish);
  }
}

TEST(ChineseReport, TheCheckSeesEnglish) {
  const std::string page = "<p lang=\"en\">words<b>more</b></p><p>8 um <i aria-label=\"x\"/>{}</p>";
  EXPECT_EQ(testing::english_left(page, {}), "");
  EXPECT_EQ(testing::english_left(page + "<p>mean</p>", {}), "mean");
  EXPECT_EQ(testing::english_left(page + "<p>mean</p>", {"mean"}), "");
  EXPECT_EQ(testing::english_left("<svg aria-label=\"height\"></svg>", {}),
            "<svg aria-label=\"height\"");
}

TEST(ChineseReport, TitlesWhatOtherRoomsSayInEnglish) {
  const std::string page = chinese_page_of(unfinished_case());
  EXPECT_THAT(page, HasSubstr("意外接触：<bdi lang=\"en\">The probe met something 3.1 mm before"));
  EXPECT_THAT(page, HasSubstr("没有数据点：<bdi lang=\"en\">"));
}

TEST(ChineseReport, LeavesHostileTextsText) {
  for (const std::string& name :
       {std::string("<script>alert(1)</script>"), std::string("\"'><svg onload=alert(1)>"),
        std::string("{0} {{}} %s {:s}"), std::string("void; none: unfiltered"),
        std::string("\xff\xc3(\x01\x1b[31m"), std::string(10000, 'W'), std::string()}) {
    SCOPED_TRACE(name.substr(0, 40));
    const Case made = hostile_case(name);
    const std::string page = chinese_page_of(made);
    EXPECT_EQ(testing::first_unbalanced_tag(page), "");
    EXPECT_EQ(page.find("<script"), page.rfind("<script"));  // the page's own
    EXPECT_EQ(page.find("<script>alert"), std::string::npos);
    EXPECT_EQ(page.find("<svg onload"), std::string::npos);
    EXPECT_EQ(page.find('\x1b'), std::string::npos);
    EXPECT_THAT(page, HasSubstr("<h1><bdi>" + escaped(name) + "</bdi>"));
  }
}

TEST(ChineseReport, TheSummaryFitsEightyColumnsAndSaysTheVerdict) {
  for (const Case& made : {cylinder_case(4, 7, 3), failing_case(), circle_case(500),
                           unfinished_case(), hostile_case("圆柱度圆柱度 圆柱度圆柱度")}) {
    std::istringstream lines(write_summary(made.record, made.evaluation, Language::kChinese));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(columns(line), 80U) << line;
  }
  const Case made = failing_case();
  const std::string text = write_summary(made.record, made.evaluation, Language::kChinese);
  EXPECT_THAT(text,
              StartsWith("2 项中 1 项合格；land-A 的 cyl-A超出公差 6 µm，超出量 2.30 µm。\n"));
  EXPECT_THAT(text, HasSubstr("  CYLt MZCY    cyl-A：不合格\n"));
}

TEST(ChineseReport, FormatsForProgramsStayEnglish) {
  const Case made = failing_case();
  for (const Export& e : exports()) {
    const std::string english = render(e, made.record, made.evaluation);
    const std::string chinese = render(e, made.record, made.evaluation, Language::kChinese);
    const bool for_people = e.format == record::Format::kHtml || e.format == record::Format::kPdf;
    EXPECT_EQ(english == chinese, !for_people) << e.file;
    if (e.format == record::Format::kPdf)
      continue;  // it states the language of its page: pdf_test.cpp
    EXPECT_EQ(edition_of(e, chinese), for_people ? Language::kChinese : Language::kEnglish);
  }
}

}  // namespace
}  // namespace rondure::reports
