// The draws that a run keeps: reports and comparisons take them, and draw again, with a word, where
// they are not those of this run and this program. No number changes.

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/checksums.h"
#include "record/sha256.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kUnsealed =
    "trials.bin: its draws do not give the results under the seal of the journal; the intervals "
    "are "
    "computed again";

class KeptTrials : public ::testing::Test {
 protected:
  void SetUp() override { fs::copy(example_runs() / "01_spool_simulated", run_); }

  /// Writes the report again and expects the same one.
  [[nodiscard]] std::string told_by_report() const {
    const std::string before = read(run_ / "report.json");
    const Outcome outcome = rondure({"report", run_, "--format", "json"});
    EXPECT_LE(outcome.status, 1) << outcome.err;
    EXPECT_EQ(read(run_ / "report.json"), before);
    return outcome.err;
  }
  [[nodiscard]] std::string trials() const { return read(run_ / "trials.bin"); }
  /// Gives trials.bin these bytes and a line that agrees with them.
  void forge(const std::string& bytes) const {
    write(run_ / "trials.bin", bytes);
    ASSERT_TRUE(record::update_checksums(run_, {{"trials.bin", record::sha256_hex(bytes)}}));
  }

  Scratch folder_;
  fs::path run_ = folder_ / "run";
};

TEST_F(KeptTrials, AreTakenByReportAndCompareAndChangedByNeither) {
  const std::string before = trials();
  ASSERT_FALSE(before.empty());
  EXPECT_EQ(told_by_report(), "");
  EXPECT_EQ(rondure({"compare", run_}).err, "");
  EXPECT_EQ(trials(), before);
  EXPECT_EQ(rondure({"verify", run_}).status, 0);
}

// A run may die between its last report and them.
TEST_F(KeptTrials, AreMadeUpForByResume) {
  const std::string before = trials();
  fs::remove(run_ / "trials.bin");
  const std::string sums = read(run_ / "SHA256SUMS");
  const std::size_t name = sums.find("trials.bin");
  ASSERT_NE(name, std::string::npos);
  const std::size_t line = sums.rfind('\n', name) + 1;
  write(run_ / "SHA256SUMS", sums.substr(0, line) + sums.substr(sums.find('\n', name) + 1));
  const fs::path plan = fs::path(RONDURE_SOURCE_DIR) / "plans/examples/01_spool_simulated.json";
  const Outcome outcome = rondure({"run", plan, "--out", run_, "--resume"});
  EXPECT_LE(outcome.status, 1) << outcome.err;
  EXPECT_EQ(trials(), before);
  EXPECT_EQ(rondure({"verify", run_}).status, 0);
}

// A form value of 1 m would change the verdict.
TEST_F(KeptTrials, ThatSomebodyForgedAreFoundByEveryVerb) {
  const std::string good = trials();
  std::string bytes = good;
  // behind the number of chains and that of the trials of the first one
  const std::size_t first = bytes.find('\n', bytes.find("journal ")) + 1 + 16;
  double value = 0.0;
  std::memcpy(&value, bytes.data() + first, sizeof value);
  ASSERT_GT(value, 1e-6);
  ASSERT_LT(value, 1.0) << "a form value in mm";
  value = 1.0;
  std::memcpy(bytes.data() + first, &value, sizeof value);
  forge(bytes);
  const std::string told = "trials.bin: its draws are not those that the touches give; remove it";
  const Outcome verified = rondure({"verify", run_});
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out, HasSubstr("not equal: " + told));
  EXPECT_THAT(rondure({"sign", run_, "--key", "KEY.pem"}).err, HasSubstr(told));
  EXPECT_THAT(rondure({"compare", run_}).err, HasSubstr("the intervals are computed again"));
  EXPECT_THAT(told_by_report(), HasSubstr(kUnsealed));
  EXPECT_EQ(trials(), good) << "they are kept again";
  EXPECT_EQ(rondure({"verify", run_}).status, 0);
}

// Rows that an evaluation would read beyond their end.
TEST_F(KeptTrials, OfAnotherShapeAreDrawnAgain) {
  const std::string good = trials();
  const std::size_t body = good.find('\n', good.find("journal ")) + 1;
  std::size_t chains = 0;
  std::memcpy(&chains, good.data() + body, sizeof chains);
  forge(good.substr(0, body + sizeof chains) + std::string(400 * chains, '\0'));
  EXPECT_EQ(rondure({"verify", run_}).status, 1);
  EXPECT_THAT(told_by_report(), HasSubstr(kUnsealed));
  EXPECT_EQ(trials(), good) << "they are kept again";
}

TEST_F(KeptTrials, AreMissedByVerifyInALine) {
  fs::remove(run_ / "trials.bin");
  const Outcome verified = rondure({"verify", run_});
  EXPECT_EQ(verified.status, 0);
  EXPECT_THAT(verified.out, AllOf(Not(HasSubstr("not equal")),
                                  HasSubstr("note: trials.bin is not there: report and compare "
                                            "compute the intervals again")));
}

TEST_F(KeptTrials, WithAFlippedBitAreADifferenceWhereverItIs) {
  const std::string good = trials();
  for (const std::size_t at : {std::size_t{3}, good.find("program ") + 9, good.size() - 1}) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    write(run_ / "trials.bin", bytes);
    const Outcome verified = rondure({"verify", run_});
    EXPECT_EQ(verified.status, 1) << at;
    EXPECT_THAT(verified.out,
                HasSubstr("not equal: trials.bin: its bytes were changed after it was written"));
  }
}

TEST_F(KeptTrials, OfAnotherBuildAreNotedAndOfAnotherRunRefused) {
  std::string bytes = trials();
  bytes.replace(bytes.find("program ") + 8, 4, "0000");
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  forge(bytes);
  const Outcome noted = rondure({"verify", run_});
  EXPECT_EQ(noted.status, 0);
  EXPECT_THAT(noted.out, HasSubstr("note: trials.bin: another build or another kind of processor"));
  forge(read(example_runs() / "09_axle_points_file" / "trials.bin"));
  const Outcome refused = rondure({"verify", run_});
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.out, HasSubstr("not equal: trials.bin: it is not of this journal; remove"));
}

TEST_F(KeptTrials, OfAnotherRunOrProgramOrWithOneChangedBitAreDrawnAgain) {
  const std::string good = trials();
  std::string bytes = good;
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  write(run_ / "trials.bin", bytes);
  EXPECT_THAT(told_by_report(), AllOf(HasSubstr("trials.bin: it was changed after it was written"),
                                      HasSubstr("the intervals are computed again")));
  EXPECT_EQ(trials(), good) << "they are kept again";
  EXPECT_EQ(told_by_report(), "");

  bytes = good;
  bytes.replace(bytes.find("program ") + 8, 4, "0000");
  forge(bytes);
  constexpr const char* kForeign = "another build, another processor or another run wrote it";
  EXPECT_THAT(told_by_report(), HasSubstr(kForeign));
  EXPECT_EQ(trials(), good);
  forge(read(example_runs() / "09_axle_points_file" / "trials.bin"));
  EXPECT_THAT(told_by_report(), HasSubstr(kForeign));
  EXPECT_EQ(trials(), good);

  fs::remove(run_ / "trials.bin");
  EXPECT_THAT(told_by_report(), HasSubstr("the intervals are computed again"));
  EXPECT_EQ(trials(), good);
}

TEST_F(KeptTrials, OfASignedRunChangeNothingThatIsSigned) {
  const std::string key = (folder_ / "key.pem").string();
  ASSERT_EQ(std::system(("openssl genpkey -algorithm ed25519 -out '" + key + "'").c_str()), 0);
  ASSERT_EQ(rondure({"sign", run_, "--key", key}).status, 0);
  fs::remove(run_ / "trials.bin");
  const std::string list = read(run_ / "SHA256SUMS");
  EXPECT_THAT(told_by_report(), HasSubstr("the intervals are computed again"));
  EXPECT_EQ(read(run_ / "SHA256SUMS"), list);
  EXPECT_THAT(names_in(run_), Not(Contains("trials.bin")));
}

TEST(RunWithoutIntervals, KeepsNoTrials) {
  const Scratch folder;
  ASSERT_LE(run_without_intervals("09_axle_points_file", {"--out", folder / "run"}).status, 1);
  EXPECT_THAT(names_in(folder / "run"), Not(Contains("trials.bin")));
}

}  // namespace
}  // namespace rondure::app::testing
