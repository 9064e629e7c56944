// One table of texts: complete, nothing in it unused, both sides of a line alike; and the reports
// that are written with it.

#include "reports/words/language.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/escaping.h"
#include "reports/formats/exports.h"
#include "reports/html/report.h"
#include "reports/terminal/columns.h"
#include "reports/terminal/summary.h"
#include "reports/words/sentence_format.h"
#include "reports/words/zh.h"
#include "synthetic.h"
#include "tests/reports/english_left.h"
#include "tests/reports/page_text.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<Translation> whole_table() {
  std::vector<Translation> out;
  for (const auto& part : {chinese_page(), chinese_drawings(), chinese_analyses(),
                           chinese_sentences(), chinese_summary(), chinese_live()}) {
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

// ---- The sources -------------------------------------------------------------------------------

/// A string of a source, adjacent literals joined.
struct Literal {
  std::string text;
  std::string before;  ///< The last characters of code in front of it, without spaces.
};

void add_utf8(std::string& out, unsigned code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0U | (code >> 6U));
    out += static_cast<char>(0x80U | (code & 0x3FU));
  } else {
    out += static_cast<char>(0xE0U | (code >> 12U));
    out += static_cast<char>(0x80U | ((code >> 6U) & 0x3FU));
    out += static_cast<char>(0x80U | (code & 0x3FU));
  }
}

/// Reads the strings of C++ text: ordinary and raw ones; comments are left out.
class SourceReader {
 public:
  explicit SourceReader(std::string text) : text_(std::move(text)) {}

  std::vector<Literal> literals() {
    while (at_ < text_.size()) {
      if (skip_comment() || take_raw() || take_string() || skip_letter()) continue;
      const char c = text_[at_++];
      if (std::isspace(static_cast<unsigned char>(c)) != 0) continue;
      joins_ = false;
      before_ += c;
    }
    return std::move(out_);
  }

 private:
  bool begins(std::string_view part) const { return text_.compare(at_, part.size(), part) == 0; }

  bool skip_comment() {
    if (begins("//")) {
      at_ = std::min(text_.find('\n', at_), text_.size());
      return true;
    }
    if (!begins("/*")) return false;
    at_ = std::min(text_.find("*/", at_), text_.size() - 2) + 2;
    return true;
  }

  bool skip_letter() {
    if (text_[at_] != '\'' || (at_ > 0 && std::isdigit(static_cast<unsigned char>(text_[at_ - 1]))))
      return false;
    at_ += text_[at_ + 1] == '\\' ? 4 : 3;
    return true;
  }

  bool take_raw() {
    if (!begins("R\"")) return false;
    const std::size_t open = text_.find('(', at_);
    const std::string close = ")" + text_.substr(at_ + 2, open - at_ - 2) + "\"";
    const std::size_t end = text_.find(close, open);
    add(text_.substr(open + 1, end - open - 1));
    at_ = end + close.size();
    return true;
  }

  bool take_string() {
    if (text_[at_] != '"') return false;
    std::string piece;
    for (++at_; text_[at_] != '"'; ++at_) {
      if (text_[at_] != '\\') {
        piece += text_[at_];
        continue;
      }
      const char kind = text_[++at_];
      if (kind == 'u') {
        add_utf8(piece, static_cast<unsigned>(std::stoul(text_.substr(at_ + 1, 4), nullptr, 16)));
        at_ += 4;
      } else {
        piece += kind == 'n' ? '\n' : kind;
      }
    }
    ++at_;
    add(piece);
    return true;
  }

  void add(const std::string& piece) {
    if (joins_) {
      out_.back().text += piece;
      return;
    }
    out_.push_back({piece, before_.substr(before_.size() > 40 ? before_.size() - 40 : 0)});
    joins_ = true;
  }

  std::string text_;
  std::size_t at_ = 0;
  std::string before_;
  bool joins_ = false;
  std::vector<Literal> out_;
};

std::vector<Literal> literals_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return SourceReader(text.str()).literals();
}

/// Strings of the sources of a room, but for the table itself.
std::vector<Literal> literals_of_room(const std::string& room) {
  std::vector<Literal> out;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(RONDURE_SOURCE_DIR) / room)) {
    const auto extension = entry.path().extension();
    const bool table = entry.path().string().find("/reports/words/zh") != std::string::npos;
    if ((extension != ".h" && extension != ".cpp") || table) continue;
    const auto more = literals_of(entry.path());
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

TEST(LanguageTable, TheReaderOfSourcesJoinsAndUnescapes) {
  const auto found =
      SourceReader("a = tr(\"x \\\"y\\\"\"\n  R\"(z)\" \"\\u00b5m\"); // \"no\"\nb('\"', \"w\")")
          .literals();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].text, "x \"y\"z\u00b5m");
  EXPECT_EQ(found[0].before, "a=tr(");
  EXPECT_EQ(found[1].text, "w");
}

TEST(LanguageTable, HasEveryTextThatTheReportsAskFor) {
  std::set<std::string_view> known;
  const auto table = whole_table();
  for (const Translation& line : table) known.insert(line.english);
  const auto asks = [](const Literal& literal) {
    for (const std::string call : {"tr(", "trf(", "translatable("}) {
      if (!literal.before.ends_with(call)) continue;
      if (literal.before.size() == call.size()) return true;
      const char c = literal.before[literal.before.size() - call.size() - 1];
      return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '.';
    }
    return false;
  };
  std::size_t asked = 0;
  for (const char* room : {"reports", "web", "app"}) {
    for (const Literal& literal : literals_of_room(room)) {
      if (!asks(literal)) continue;
      ++asked;
      EXPECT_EQ(known.count(literal.text), 1U) << "no Chinese for \"" << literal.text << '"';
    }
  }
  EXPECT_GT(asked, 300U);
}

/// The fixed texts of a format, without the marks at their ends that lists are joined by.
std::vector<std::string> pieces_of(std::string_view format) {
  std::vector<std::string> out;
  while (!format.empty()) {
    const std::size_t open = std::min(format.find('{'), format.size());
    const std::string_view piece = format.substr(0, open);
    const std::size_t first = piece.find_first_not_of(" ;,:");
    if (first != std::string_view::npos) {
      out.emplace_back(piece.substr(first, piece.find_last_not_of(" ;,:") + 1 - first));
    }
    const std::size_t close = std::min(format.find('}', open), format.size() - 1);
    format.remove_prefix(close + 1);
  }
  return out;
}

TEST(LanguageTable, HasNothingThatNoSourceSays) {
  std::set<std::string> said;
  std::string all;
  for (const char* room :
       {"reports", "web", "evaluation", "record", "fit", "plans", "cmm", "fixture", "core"}) {
    for (const Literal& literal : literals_of_room(room)) {
      if (said.insert(literal.text).second) all += literal.text + '\n';
    }
  }
  for (const auto& part : {chinese_page(), chinese_drawings(), chinese_analyses(),
                           chinese_summary(), chinese_live()}) {
    for (const Translation& line : part) {
      EXPECT_EQ(said.count(std::string(line.english)), 1U) << '"' << line.english << '"';
    }
  }
  // Evaluation puts some sentences together from parts: every part must be in a source.
  for (const Translation& line : chinese_sentences()) {
    for (const std::string& piece : pieces_of(line.english)) {
      EXPECT_NE(all.find(piece), std::string::npos) << '"' << piece << "\" of " << line.english;
    }
  }
}

// ---- The lines ---------------------------------------------------------------------------------

TEST(LanguageTable, HasEachTextOnce) {
  std::map<std::string_view, int> seen;
  for (const Translation& line : whole_table()) EXPECT_EQ(++seen[line.english], 1) << line.english;
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

bool is_chinese(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= 0xE3; });
}

TEST(LanguageTable, HasTheSameArgumentsOnBothSidesOfAFormat) {
  for (const auto& part : {chinese_page(), chinese_drawings(), chinese_analyses(),
                           chinese_summary(), chinese_live()}) {
    for (const Translation& line : part) {
      EXPECT_EQ(places_of(line.english), places_of(line.chinese)) << line.english;
    }
  }
  // Sentences are filled with texts: an argument has no format of its own, but may be a name.
  for (const Translation& line : chinese_sentences()) {
    std::set<char> english;
    std::set<char> chinese;
    for (const std::string& place : places_of(line.english)) english.insert(place.front());
    for (const std::string& place : places_of(line.chinese)) {
      chinese.insert(place.front());
      EXPECT_TRUE(place.size() == 1 || place.substr(1) == ":s") << line.chinese;
    }
    EXPECT_EQ(english, chinese) << line.english;
  }
}

TEST(LanguageTable, SaysItInChinese) {
  const auto is_name = [](std::string_view text) {  // of a standard, a rule or a person
    for (const char* name : {"ISO ", "JCGM ", "N:1", "Anderson-Darling"}) {
      if (text.find(name) != std::string_view::npos) return true;
    }
    return false;
  };
  for (const Translation& line : whole_table()) {
    if (has_no_words(line.english) || is_name(line.chinese)) continue;
    EXPECT_TRUE(is_chinese(line.chinese)) << line.english;
  }
}

TEST(LanguageTable, HasATitleOfItsOwnForEveryCode) {
  std::set<std::string_view> titles;
  for (int i = 0; i <= static_cast<int>(core::kLastCode); ++i) {
    const auto code = static_cast<core::Code>(i);
    EXPECT_TRUE(is_chinese(chinese_title(code))) << core::code_name(code);
    EXPECT_NE(chinese_title(code), "未知代码") << core::code_name(code);
    EXPECT_TRUE(titles.insert(chinese_title(code)).second) << core::code_name(code);
  }
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

TEST(SentenceFormat, FindsTheArgumentsItWasMadeWith) {
  const SentenceFormat two("{} of {} points");
  EXPECT_EQ(two.arguments_of("3 of 7 points"), (std::vector<std::string>{"3", "7"}));
  EXPECT_EQ(two.arguments_of("3 of 7 point"), std::nullopt);
  EXPECT_EQ(two.arguments_of(" of 7 points"), std::nullopt);
  EXPECT_EQ(two.arguments_of(""), std::nullopt);
  EXPECT_EQ(two.with({"a", "b"}), "a of b points");
  const SentenceFormat twice("{0:g}:1, T >= {0:g} U");
  EXPECT_EQ(twice.arguments_of("4:1, T >= 4 U"), (std::vector<std::string>{"4"}));
  EXPECT_EQ(twice.arguments_of("4:1, T >= 5 U"), std::nullopt);
  EXPECT_EQ(SentenceFormat("{:.3f} um").arguments_of("some um"), std::nullopt);
  EXPECT_EQ(SentenceFormat("{}: {}").arguments_of("a: b: c"),
            (std::vector<std::string>{"a", "b: c"}));
  EXPECT_EQ(SentenceFormat("pose {}; {}").arguments_of("pose 1; 2; 3"),
            (std::vector<std::string>{"1", "2; 3"}));
}

TEST(Told, KnowsSentencesByTheirFormatAndTheirParts) {
  EXPECT_EQ(told("not declared"), "not declared");  // English: as it is
  const LanguageScope scope(Language::kChinese);
  EXPECT_EQ(told("7.958 um is within the tolerance of 12 um by 4.042 um"),
            "7.958 um 未超出公差 12 um，相差 4.042 um");
  EXPECT_EQ(told("the corrected value 5.169 um is within the acceptance limit of 11.691 um "
                 "(tolerance 12 um, guard band 0.309 um)"),
            "修正值 5.169 um 未超出接收限 11.691 um（公差 12 um，保护带 0.309 um）");
  EXPECT_EQ(told("MZCY; unfiltered; 4 x 7 points; mean of 5 touches a point; r_tip 1.9984 mm; 20.4 "
                 "degC; at the sampled points"),
            "MZCY；未滤波；4 x 7 点；每点 5 次触测的均值；测头半径 1.9984 mm；20.4 degC；采样点处");
  EXPECT_EQ(told("4 x 360 points, scanned; 5 passes at places of their own, not averaged"),
            "4 x 360 点，扫描；5 遍扫描，各遍点位不同，未取平均");
  EXPECT_EQ(told("layer 3: no such thing was ever said"), std::nullopt);
  EXPECT_EQ(told("a sentence of somebody else"), std::nullopt);
  EXPECT_EQ(told("-1.5 um"), "-1.5 um");
  EXPECT_EQ(told(""), "");
  EXPECT_EQ(told("harmonic 5 of part unfiltered is nearest to its limit"),
            "工件 unfiltered 的第 5 次谐波最接近其限值");  // a name, not the word
}

TEST(Told, EverySentenceOfTheTableIsRecognisedAndLeavesNoArgumentOut) {
  const LanguageScope scope(Language::kChinese);
  for (const Translation& line : chinese_sentences()) {
    const SentenceFormat english(line.english);
    std::vector<std::string> arguments;
    for (std::size_t i = 0; i < english.arguments(); ++i)
      arguments.push_back(std::to_string(7 + i));
    const auto chinese = told(english.with(arguments));
    ASSERT_TRUE(chinese) << line.english;
    for (const std::string& argument : arguments) EXPECT_THAT(*chinese, HasSubstr(argument));
  }
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
    EXPECT_EQ(language_of_page(page), Language::kChinese);
    EXPECT_EQ(language_of_page(write_html(made.record, made.evaluation)), Language::kEnglish);
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
    std::istringstream lines(
        write_summary(made.record, made.evaluation, SketchStyle::kBraille, Language::kChinese));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(columns(line), 80U) << line;
  }
  const Case made = failing_case();
  const std::string text =
      write_summary(made.record, made.evaluation, SketchStyle::kNone, Language::kChinese);
  EXPECT_THAT(text, StartsWith("不合格\n"));
  EXPECT_THAT(
      text, HasSubstr("  CYLt MZCY      8.300 um   公差 6.000 um       不合格            cyl-A\n"));
}

TEST(ChineseReport, FormatsForProgramsStayEnglish) {
  const Case made = failing_case();
  for (const Export& e : exports()) {
    const std::string english = render(e, made.record, made.evaluation);
    const std::string chinese = render(e, made.record, made.evaluation, Language::kChinese);
    const bool for_people = e.format == "html" || e.format == "pdf";
    EXPECT_EQ(english == chinese, !for_people) << e.file;
    if (e.format == "pdf") continue;  // it states the language of its page: pdf_test.cpp
    EXPECT_EQ(language_of(e, chinese), for_people ? Language::kChinese : Language::kEnglish);
  }
}

}  // namespace
}  // namespace rondure::reports
