#include <gtest/gtest.h>

#include "plans/schema/internal/key_list.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

// Both committed texts come from plan_table.h; RONDURE_REWRITE=1 writes them again.
TEST(PlanSchema, TheCommittedSchemaIsTheOneOfTheTable) {
  const auto path = testing::source_dir() / "plans" / "schema" / "plan.schema.json";
  if (testing::rewriting()) {
    ASSERT_TRUE(record::write_file(path, plan_schema()));
  }
  EXPECT_EQ(testing::bytes_of(path), plan_schema());
}

TEST(PlanSchema, TheKeysInTheDocumentationAreThoseOfTheTable) {
  const auto path = testing::source_dir() / "docs" / "plan.md";
  const std::string mark = "<!-- keys: written by the test, from plans/schema/internal/plan_table.h -->\n";
  const std::string document = testing::bytes_of(path);
  const std::size_t at = document.find(mark);
  ASSERT_NE(at, std::string::npos);
  const std::string fresh = document.substr(0, at) + mark + key_list_markdown();
  if (testing::rewriting()) {
    ASSERT_TRUE(record::write_file(path, fresh));
  }
  EXPECT_EQ(testing::bytes_of(path), fresh);
}

}  // namespace
}  // namespace rondure::plans
