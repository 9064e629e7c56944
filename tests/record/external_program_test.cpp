#include "record/external_program.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/files.h"
#include "tests/core/scratch.h"

namespace rondure::record {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class ExternalProgram : public ::testing::Test {
 protected:
  core::Result<void> run_shell(const std::string& script, int limit_ms = 10'000) const {
    return run_program({"/bin/sh",
                        {"-c", script},
                        {"WORD=handed on"},
                        said_,
                        std::chrono::milliseconds(limit_ms)});
  }
  std::string fault_of(const std::string& script, int limit_ms = 10'000) const {
    const auto ran = run_shell(script, limit_ms);
    return ran ? "" : ran.error().what;
  }
  const test::Scratch folder_;
  const std::filesystem::path said_ = folder_ / "said";
};

TEST_F(ExternalProgram, GetsItsArgumentsAndItsEnvironmentAndNothingElse) {
  ASSERT_TRUE(run_shell("echo \"$WORD/$HOME/$#\"; echo more >&2; cat"));
  EXPECT_EQ(read_file(said_).value_or(""), "handed on//0\nmore\n");
}

TEST_F(ExternalProgram, HowItEndedIsSaidWithItsLastLine) {
  EXPECT_THAT(fault_of("echo first; echo last; exit 3"), EndsWith("ended with status 3: last"));
  EXPECT_THAT(fault_of("kill -SEGV $$"), HasSubstr("signal 11"));
  const auto absent = run_program({"/nowhere/program", {}, {}, said_, std::chrono::seconds(1)});
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().what,
              AllOf(HasSubstr("/nowhere/program"), HasSubstr("cannot be started")));
}

TEST_F(ExternalProgram, ItsTimeIsLimitedAndItsChildrenEndWithIt) {
  const std::string mark = said_.string() + ".alive";
  EXPECT_THAT(fault_of("(sleep 1; echo >'" + mark + "') & sleep 60", 200),
              HasSubstr("did not end within 0.2 s and was killed"));
  EXPECT_EQ(fault_of("(sleep 1; echo >'" + mark + "') &"), "");
  ASSERT_TRUE(run_shell("sleep 1.5"));
  EXPECT_FALSE(std::filesystem::exists(mark));
}

TEST_F(ExternalProgram, IsFoundOnPathByTheFirstNameThatIsThere) {
  EXPECT_EQ(find_program({"no-such-program", "sh"}).filename(), "sh");
  EXPECT_TRUE(find_program({"no-such-program"}).empty());
}

}  // namespace
}  // namespace rondure::record
