// A run that another version of the program wrote: its numbers are compared, its wording is not.

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "core/version.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/sha256.h"
#include "reports/formats/exports.h"
#include "reports/verify/stored_results.h"
#include "reports/verify/verify.h"
#include "tests/evaluation/points_run.h"
#include "tests/record/sample_run.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kProcessor = "this processor";

class RunOfAnotherVersion : public ::testing::Test {
 protected:
  /// A run over points, as if `version` of the program had written it.
  void write_run(const std::string& version, bool print = false) {
    record::RunRecord run = points_run(rough_part(1, 3, 12, core::kTwoPi), 3);
    run.header.version = version;
    run.header.processor = kProcessor;
    run.header.plan_sha256 = record::sha256_hex(run.header.plan_text);
    run.sealed = true;
    const Evaluation evaluation = evaluated(run);
    run.results = stored_results(evaluation);
    if (change_results) change_results(run.results);
    results = run.results.size();
    ASSERT_TRUE(record::write_run(directory, run));
    std::vector<std::string> formats = all_formats();
    if (!print) std::erase(formats, "pdf");
    ASSERT_TRUE(write_exports(directory, formats, run, evaluation));
  }
  /// Changes an export, as another version would have written it: with its digest.
  void rewrite(const std::string& file, const std::string& from, const std::string& to,
               bool listed = true) const {
    std::string bytes = *record::read_file(directory / file);
    const std::size_t at = bytes.find(from);
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, from.size(), to);
    ASSERT_TRUE(record::write_file(directory / file, bytes));
    if (!listed) return;
    ASSERT_TRUE(record::update_checksums(directory, {{file, record::sha256_hex(bytes)}}));
  }
  [[nodiscard]] Verification verified() const {
    const auto out = verify_run(directory, {kProcessor, {}});
    EXPECT_TRUE(out) << out.error().what;
    return out.value_or(Verification{});
  }
  /// All differences in one text.
  [[nodiscard]] std::string difference() const {
    std::string all;
    for (const std::string& line : verified().differences) all += line + "\n";
    return all;
  }

  record::Scratch scratch;
  fs::path directory = scratch / "run";
  std::size_t results = 0;
  std::function<void(std::vector<record::StoredResult>&)> change_results;
};

TEST_F(RunOfAnotherVersion, OfTheSameVersionEveryByteCounts) {
  write_run(std::string(core::kVersion), true);
  EXPECT_THAT(difference(), IsEmpty());
  rewrite("report.html", "</footer>", ".</footer>");
  EXPECT_THAT(difference(), AllOf(HasSubstr("report.html: line "),
                                  HasSubstr("the file itself is as it was written (SHA256SUMS)")));
}

TEST_F(RunOfAnotherVersion, IsEqualWhenOnlyItsWordingDiffers) {
  write_run("0.0.9");
  rewrite("report.html", "</footer>", ", as version 0.0.9 said it</footer>");
  rewrite("report.json", "\"reason\": \"", "\"reason\": \"in other words, ");
  const Verification out = verified();
  EXPECT_THAT(out.differences, IsEmpty());
  EXPECT_THAT(out.what_was_compared,
              HasSubstr("written by version 0.0.9, this is version " + std::string(core::kVersion) +
                        ": numbers that both give within 1e-9, wording and layout of reports "
                        "not compared"));
}

TEST_F(RunOfAnotherVersion, IsNotEqualWhenANumberDiffers) {
  write_run("0.0.9");
  rewrite("report.json", "\"deviation_um\": ", "\"deviation_um\": 1");
  EXPECT_THAT(difference(), AllOf(HasSubstr("report.json: /features/0/"),
                                  HasSubstr("deviation_um: the file says 1")));
  rewrite("touches.csv", "\n0,measure,", "\n0,locate,");
  EXPECT_THAT(difference(), HasSubstr("touches.csv: row 1, column purpose: the file says locate"));
}

TEST_F(RunOfAnotherVersion, IsNotEqualWhenItsOldReportWasChangedSinceThen) {
  write_run("0.0.9");
  rewrite("report.html", "</footer>", ".</footer>", false);
  EXPECT_EQ(difference(),
            "report.html: its bytes were changed after it was written (SHA256SUMS)\n");
}

TEST_F(RunOfAnotherVersion, MayStoreMoreAndFewerResultsButNoOtherNumbers) {
  change_results = [](std::vector<record::StoredResult>& all) { all.front().value += 1e-6; };
  write_run("0.0.9");
  EXPECT_THAT(difference(),
              AllOf(HasSubstr("result /features/0/"), HasSubstr("no longer follows: stored ")));
  fs::remove_all(directory);
  change_results = [](std::vector<record::StoredResult>& all) {
    all.pop_back();
    all.push_back({"/features/0/old/value_um", 3.0});
    all.front().value += 1e-12;
  };
  write_run("0.0.9");
  EXPECT_THAT(difference(), IsEmpty());
  EXPECT_THAT(verified().what_was_compared,
              HasSubstr(std::to_string(results - 1) + " results follow"));
}

}  // namespace
}  // namespace rondure::reports
