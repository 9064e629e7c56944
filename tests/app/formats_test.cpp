// Every format of one run: written, listed, verified, shown on a terminal.

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/terminal/internal/columns.h"
#include "tests/app/files.h"
#include "tests/app/on_terminal.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kAll = "html,json,csv,qif,dmis";

/// A PATH for programs that are started meanwhile.
class OtherPath {
 public:
  explicit OtherPath(const std::string& path) { ::setenv("PATH", path.c_str(), 1); }
  ~OtherPath() { ::setenv("PATH", before_.c_str(), 1); }
  OtherPath(const OtherPath&) = delete;
  OtherPath& operator=(const OtherPath&) = delete;

 private:
  std::string before_ = std::getenv("PATH");
};

class Formats : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(rondure({"run", example("13_pose_search_virtual.json"), "--out", run_, "--archive",
                       "none", "--format", kAll, "--quiet"})
                  .status,
              0);
  }
  Scratch folder_;
  const std::filesystem::path run_ = folder_ / "run";
};

TEST_F(Formats, AreListedVerifiedAndWrittenAgainByteForByte) {
  const std::vector<std::string> files = {"report.qif", "report.dmo", "results.csv"};
  std::vector<std::string> bytes;
  for (const std::string& file : files) {
    bytes.push_back(read(run_ / file));
    EXPECT_GT(bytes.back().size(), 100U);
    EXPECT_THAT(read(run_ / "SHA256SUMS"), HasSubstr("  " + file + "\n"));
  }
  EXPECT_THAT(rondure({"verify", run_}).out,
              AllOf(HasSubstr("results.csv, report.qif, report.dmo"), Not(HasSubstr("not there"))));
  for (const std::string& file : files) std::filesystem::remove(run_ / file);
  EXPECT_EQ(rondure({"report", run_, "--format", kAll}).status, 0);
  for (std::size_t i = 0; i < files.size(); ++i) EXPECT_EQ(read(run_ / files[i]), bytes[i]);
}

TEST_F(Formats, AChangedDigitIsFoundInEach) {
  for (const char* file : {"report.qif", "report.dmo", "results.csv"}) {
    SCOPED_TRACE(file);
    const std::string bytes = read(run_ / file);
    std::string changed = bytes;
    const std::size_t digit = changed.find_last_of("123456789");
    ASSERT_NE(digit, std::string::npos);
    changed[digit] = changed[digit] == '1' ? '2' : '1';
    write(run_ / file, changed);
    const Outcome outcome = rondure({"verify", run_});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.out, HasSubstr(std::string("not equal: ") + file));
    write(run_ / file, bytes);
  }
}

TEST_F(Formats, ThatWereNotAskedForAreNotMissed) {
  ASSERT_EQ(rondure({"run", example("13_pose_search_virtual.json"), "--out", folder_ / "json",
                     "--archive", "none", "--format", "json", "--quiet"})
                .status,
            0);
  EXPECT_THAT(rondure({"verify", folder_ / "json"}).out,
              AllOf(HasSubstr("exports compared: report.json"), Not(HasSubstr("not there"))));
}

TEST_F(Formats, WithoutChromiumThePdfIsRefusedBeforeTheFirstTouchAndLeftOutOfAllReports) {
  const OtherPath none("/nowhere");
  const std::vector<std::string> asks = {"run",      example("13_pose_search_virtual.json"),
                                         "--out",    folder_ / "pdf",
                                         "--format", "json,pdf"};
  const Outcome ran = rondure(asks);
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("install it (Debian: chromium)"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pdf"));
  EXPECT_EQ(rondure({"report", run_, "--format", "pdf"}).status, 2);
  const Outcome all = rondure({"report", run_});
  EXPECT_EQ(all.status, 0);
  EXPECT_THAT(all.err, HasSubstr("report.pdf is not written: a PDF is printed by Chromium"));
}

/// The same where a Chromium prints; skipped where there is none.
class FormatPdf : public Formats {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium chromium-browser google-chrome >/dev/null") != 0) {
      GTEST_SKIP() << "no Chromium is on PATH (Debian package chromium)";
    }
    Formats::SetUp();
  }
};

TEST_F(FormatPdf, IsPrintedInAnEmptyEnvironmentOnThePaperThatWasAskedFor) {
  Surroundings bare;
  bare.empty_environment = true;
  const Outcome outcome = rondure({"report", run_, "--format", "pdf", "--paper", "letter"}, bare);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const std::string pdf = read(run_ / "report.pdf");
  EXPECT_THAT(pdf, AllOf(::testing::StartsWith("%PDF-"), HasSubstr("/MediaBox [0 0 612 792]"),
                         HasSubstr(", paper-letter,"), HasSubstr("/MarkInfo")));
  EXPECT_THAT(read(run_ / "SHA256SUMS"), HasSubstr("  report.pdf\n"));
}

TEST_F(FormatPdf, IsOnThePaperOfThePlanAndNotPrintedAgainWhenARunIsFinished) {
  write_plan(folder_ / "plan.json",
             {{"/reports", {{"formats", {"json", "pdf"}}, {"paper", "letter"}}}});
  const std::filesystem::path run = folder_ / "letter";
  ASSERT_LE(rondure({"run", folder_ / "plan.json", "--out", run, "--archive", "none"}).status, 1);
  const std::string pdf = read(run / "report.pdf");
  EXPECT_THAT(pdf, HasSubstr(", paper-letter,"));
  EXPECT_THAT(rondure({"run", run, "--resume", "--archive", "none"}).err,
              HasSubstr("there is nothing to resume"));
  EXPECT_EQ(read(run / "report.pdf"), pdf);
  EXPECT_EQ(rondure({"report", run, "--format", "pdf"}).status, 0);
  EXPECT_THAT(read(run / "report.pdf"), HasSubstr(", paper-letter,"));
}

TEST_F(FormatPdf, IsVerifiedByItsDigestAndByThePageThatItNames) {
  ASSERT_EQ(rondure({"report", run_, "--format", "pdf"}).status, 0);
  EXPECT_THAT(rondure({"verify", run_}).out, HasSubstr("report.pdf"));
  const OtherPath without_chromium("/nowhere");
  EXPECT_EQ(rondure({"verify", run_}).status, 0);
  const std::string pdf = read(run_ / "report.pdf");
  write(run_ / "report.pdf", pdf + "%");
  EXPECT_THAT(rondure({"verify", run_}).out,
              HasSubstr("not equal: report.pdf: its bytes were changed after it was written"));
  write(run_ / "report.pdf", pdf);
  replace_in(run_ / "report.pdf", "% page-sha256-", "% page-sha256-0");
  EXPECT_THAT(rondure({"verify", run_}).out,
              HasSubstr("report.pdf: it was printed from another page than the journal gives"));
}

TEST_F(Formats, ThePlanMayAskForThem) {
  write_plan(folder_ / "plan.json", {{"/reports/formats", {"qif", "dmis"}}});
  ASSERT_LE(
      rondure({"run", folder_ / "plan.json", "--out", folder_ / "two", "--archive", "none"}).status,
      1);
  EXPECT_THAT(names_in(folder_ / "two"),
              ::testing::ElementsAre("SHA256SUMS", "journal.db", "report.dmo", "report.qif"));
}

TEST_F(Formats, CorrectionsAreWrittenWhenAskedForAndVerified) {
  const auto run = folder_ / "pins";
  write(folder_ / "plan.json", two_crank_pins().dump());
  ASSERT_EQ(rondure({"run", folder_ / "plan.json", "--out", run, "--archive", "none", "--format",
                     "corrections", "--quiet"})
                .status,
            0);
  EXPECT_THAT(names_in(run),
              ::testing::ElementsAre("SHA256SUMS", "corrections", "corrections.txt", "journal.db"));
  EXPECT_THAT(rondure({"verify", run}).out, HasSubstr("corrections/pin-x-of-c.csv"));
  replace_in(run / "corrections/pin-x-of-c.csv", "\n37,", "\n37,1");
  const Outcome changed = rondure({"verify", run});
  EXPECT_EQ(changed.status, 1);
  EXPECT_THAT(changed.out, HasSubstr("corrections/pin-x-of-c.csv: line "));
  EXPECT_EQ(rondure({"report", run, "--format", "corrections"}).status, 0);
  EXPECT_EQ(rondure({"verify", run}).status, 0);
  // Only by name, and again where they are already; no PDF is wanted here.
  const OtherPath without_chromium("/nowhere");
  ASSERT_EQ(rondure({"report", run}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(run / "corrections.txt"));
  std::filesystem::remove_all(run / "corrections");
  std::filesystem::remove(run / "corrections.txt");
  ASSERT_EQ(rondure({"report", run}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(run / "corrections.txt"));
  // The page and report.json name the file also where it was not written, and how to have it.
  EXPECT_THAT(read(run / "report.html"),
              HasSubstr(R"(<span class="mono">corrections/pin-x-of-c.csv</span> (X over C), )"
                        "written by <span class=\"mono\">--format corrections</span>."));
  EXPECT_THAT(read(run / "report.json"), HasSubstr("\"file\": \"corrections/pin-x-of-c.csv\""));
  EXPECT_EQ(rondure({"verify", run}).status, 0);
}

TEST_F(Formats, CorrectionsSayWhichFeaturesHaveNoneAndWhy) {
  const Outcome told = rondure({"report", run_, "--format", "corrections"});
  EXPECT_EQ(told.status, 0);
  const std::string line = "none: points of a surface give no correction for a machine\n";
  EXPECT_THAT(told.out, HasSubstr(line));
  EXPECT_THAT(read(run_ / "corrections.txt"), HasSubstr(line));
  EXPECT_EQ(rondure({"verify", run_}).status, 0);
}

/// Lines of a terminal, without what ends them.
std::vector<std::string> lines_of(const std::string& shown) {
  std::istringstream stream(shown);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    line.erase(std::min(line.find('\r'), line.size()));
    lines.push_back(line);
  }
  return lines;
}

TEST_F(Formats, ATerminalOfEightyColumnsShowsEachLineWhole) {
  for (const char* locale : {"C.UTF-8", "C"}) {
    SCOPED_TRACE(locale);
    OnTerminal program({"report", run_, "--format", "json"}, locale);
    EXPECT_EQ(program.finish(), 0) << program.shown();
    EXPECT_THAT(program.shown(), HasSubstr("CYLt"));
    for (const std::string& line : lines_of(program.shown())) {
      if (line.find(run_.string()) == std::string::npos) {
        EXPECT_LE(reports::columns(line), 80U) << line;
      }
    }
  }
}

}  // namespace
}  // namespace rondure::app::testing
