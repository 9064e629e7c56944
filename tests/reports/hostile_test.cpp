// Names, notes and messages that try to be something else stay text in every format.

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "core/encodings.h"
#include "reports/data/qif/internal/parts.h"
#include "reports/data/qif/report.h"
#include "reports/data/writers.h"
#include "reports/escaping.h"
#include "reports/html/report.h"
#include "reports/terminal/internal/columns.h"
#include "reports/terminal/summary.h"
#include "reports/words/language.h"
#include "synthetic.h"
#include "tests/reports/page_text.h"
#include "tests/reports/qif_schema.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using core::well_formed;

using testing::first_unbalanced_tag;

std::string repeated(std::string_view piece, std::size_t times) {
  std::string out;
  for (std::size_t i = 0; i < times; ++i) out += piece;
  return out;
}

std::vector<std::string> markup() {
  return {"<script>alert(1)</script>",
          "</script><script>alert(1)</script>",
          "<img src=x onerror=alert(1)>",
          "\"'><svg onload=alert(1)>",
          "</style></title><script>x</script>",
          "<!--",
          "-->",
          "<![CDATA[",
          "]]>",
          "<?xml version=\"1.0\"?>",
          "<!DOCTYPE a [<!ENTITY b SYSTEM \"file:///etc/passwd\">]>",
          "&b; &lt; &amp;amp; &#0; &#x1;",
          "javascript:alert(1)",
          "</QIFDocument>",
          "</testcase></testsuite></testsuites>"};
}

std::vector<std::string> quotes_and_lines() {
  return {"\"",
          "'",
          "\"\"\"",
          "a,b;c\td",
          "a\"b,\"c\"",
          "\\\" \\n \\u0000 \\",
          "first\nsecond",
          "first\r\nENDFIL\r\nFA(F1)=FEAT/CYLNDR",
          "'\nENDFIL\n",
          "ends with $",
          "$$ comment $",
          "'' it''s '",
          "\u2028line\u2029separators",
          "{0} {{}} %s %n",
          "${jndi:ldap://x/y} $(reboot) `reboot`"};
}

std::vector<std::string> formulas() {
  return {"=1+1",
          "=cmd|'/c calc'!A1",
          "+1",
          "-2+3",
          "@SUM(A1)",
          "\t=1+1",
          "=HYPERLINK(\"http://x\",\"y\")"};
}

std::vector<std::string> scripts_and_bytes() {
  return {"\u5706\u67F1\u5EA6 \u0394 \u00E9\u0301",
          "\u05D0\u05D1\u05D2 \u0645\u0631\u062D\u0628\u0627",
          "\u202Egnp.exe\u202C",
          "\u2066isolate\u2069 \u200F\u200E \uFEFF",
          "\U0001F9EA\U00020BB7",
          std::string("nul\0inside", 10),
          "\x01\x02\x07\x08\x0B\x0C\x1F\x7F",
          "\x1b[2J\x1b]0;title\x07\x9b",
          "\u0085\u009B31m",
          "\xFF\xFE \xC3( \xED\xA0\x80 \xF4\x90\x80\x80",
          "\uFFFE\uFFFF\uFDD0",
          std::string(10'000, 'W'),
          repeated("\u5706\"<&'", 1'500)};
}

/// Fifty.
std::vector<std::string> hostile_texts() {
  std::vector<std::string> out;
  for (const auto& some : {markup(), quotes_and_lines(), formulas(), scripts_and_bytes()}) {
    out.insert(out.end(), some.begin(), some.end());
  }
  return out;
}

/// A case that is like it in every number.
const Case& harmless() {
  static const Case made = hostile_case("harmless");
  return made;
}

/// A table by RFC 4180; lines of comment left out.
std::vector<std::vector<std::string>> rows_of(std::string_view text) {
  std::vector<std::vector<std::string>> rows;
  while (text.starts_with('#')) text.remove_prefix(text.find('\n') + 1);
  bool quoted = false;
  rows.emplace_back(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && quoted && text.substr(i + 1).starts_with('"')) {
      rows.back().back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      rows.back().emplace_back();
    } else if (c == '\n' && !quoted) {
      rows.emplace_back(1);
    } else {
      rows.back().back() += c;
    }
  }
  EXPECT_FALSE(quoted);
  rows.pop_back();  // behind the last line break
  return rows;
}

/// Printable, or a line feed; above ASCII what clean() lets through.
bool has_control(std::string_view text, std::string_view allowed) {
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 || byte == 0x7F) && allowed.find(c) == std::string_view::npos) return true;
  }
  return false;
}

class Hostile : public ::testing::TestWithParam<std::size_t> {
 protected:
  const std::string text_ = hostile_texts().at(GetParam());
  const Case made_ = hostile_case(text_);

  /// A field of a table: text as it is, or behind an apostrophe where a spreadsheet would compute.
  void expect_field(const std::string& field) const {
    EXPECT_TRUE(field == clean(text_) || field == "'" + clean(text_)) << field;
    EXPECT_TRUE(field.empty() || std::string("=+-@\t").find(field[0]) == std::string::npos);
  }
};

TEST_P(Hostile, StaysTextInThePage) {
  const std::string page = write_html(made_.record, made_.evaluation);
  const std::string plain = write_html(harmless().record, harmless().evaluation);
  const auto opened = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '<');
  };
  EXPECT_EQ(first_unbalanced_tag(page), "");
  EXPECT_EQ(opened(page), opened(plain));
  EXPECT_FALSE(has_control(page, "\n\t"));
  EXPECT_NE(page.find("<bdi>" + escaped(text_) + "</bdi>"), std::string::npos);
}

TEST_P(Hostile, StaysTextInJson) {
  const auto document = nlohmann::json::parse(write_json(made_.record, made_.evaluation));
  const std::string name = document.at("header").at("part_name");
  EXPECT_EQ(name, nlohmann::json::parse(nlohmann::json(text_).dump(
                      -1, ' ', false, nlohmann::json::error_handler_t::replace)));
  EXPECT_EQ(document.at("features").at(0).at("id"), name);
}

TEST_P(Hostile, StaysTextInTables) {
  const auto touches = rows_of(write_touches_csv(made_.record));
  ASSERT_EQ(touches.size(), 1 + made_.record.touches.size());
  for (const auto& row : touches) ASSERT_EQ(row.size(), 16U);
  expect_field(touches.back()[2]);
  const std::string results = write_results_csv(made_.record, made_.evaluation);
  const auto rows = rows_of(results);
  ASSERT_EQ(rows.size(), 4U);
  for (const auto& row : rows) ASSERT_EQ(row.size(), 16U);
  for (const std::size_t column : {0, 1, 2, 3, 4, 5, 11}) expect_field(rows[1][column]);
  EXPECT_FALSE(has_control(results, "\n\t"));
}

TEST_P(Hostile, StaysTextInQif) {
  const std::string bytes = write_qif(made_.record, made_.evaluation);
  const auto faults = check_qif(bytes);
  EXPECT_TRUE(faults.empty()) << faults.front();
  pugi::xml_document xml;
  ASSERT_TRUE(xml.load_buffer(bytes.data(), bytes.size()));
  const pugi::xml_node root = xml.document_element();
  EXPECT_EQ(root.select_node("Features/FeatureItems/*[1]/FeatureName").node().text().get(),
            clean(text_));
  EXPECT_EQ(root.select_node("Product/PartSet/Part/Header/Name").node().text().get(), clean(text_));
  EXPECT_FALSE(has_control(bytes, "\n\t"));
}

TEST_P(Hostile, StaysACommentInDmis) {
  const auto statements = [](const Case& made) {
    std::istringstream lines(write_dmis(made.record, made.evaluation));
    std::string out;
    for (std::string line; std::getline(lines, line);) {
      EXPECT_FALSE(has_control(line, ""));
      EXPECT_FALSE(line.ends_with('$')) << line;  // it would continue
      for (const char c : line) EXPECT_LT(static_cast<unsigned char>(c), 0x7F);
      if (!line.starts_with("$$ ")) out += line + "\n";
    }
    return out;
  };
  EXPECT_EQ(statements(made_), statements(harmless()));
}

TEST_P(Hostile, StaysTextOnTheTerminal) {
  const std::string shown = write_summary(made_.record, made_.evaluation);
  EXPECT_FALSE(has_control(shown, "\n"));
  EXPECT_EQ(shown.find("\u202E"), std::string::npos);
  EXPECT_EQ(shown.find("\u009B"), std::string::npos);
  EXPECT_EQ(well_formed(shown), shown);
  std::istringstream lines(shown);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(columns(line), 80U) << line;
}

INSTANTIATE_TEST_SUITE_P(Texts, Hostile, ::testing::Range(std::size_t{0}, hostile_texts().size()));

TEST(HostileTexts, AreFifty) { EXPECT_EQ(hostile_texts().size(), 50U); }

TEST(HostileTexts, LeaveQifValidAgainstItsSchema) {
  std::vector<std::string> documents;
  for (const std::string& text : hostile_texts()) {
    const Case made = hostile_case(text);
    documents.push_back(write_qif(made.record, made.evaluation));
  }
  testing::expect_valid_qif(documents);
}

}  // namespace
}  // namespace rondure::reports
