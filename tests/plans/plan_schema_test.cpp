#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "plans/schema/internal/key_list.h"
#include "record/tasks/settings.h"
#include "record/tasks/spindle.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

// What a plan leaves out, and what the journal of another version of the program does not hold.
TEST(PlanSchema, HasTheDefaultsOfTheTask) {
  const auto schema = nlohmann::json::parse(plan_schema());
  const nlohmann::json::json_pointer place(
      "/properties/features/items/properties/spindle/properties");
  const auto& keys = schema.at(place);
  std::size_t found = 0;
  for (const record::Setting& setting : record::settings_of_task(record::SpindleTask())) {
    SCOPED_TRACE(setting.name);
    const auto& fallback = keys.at(setting.name).at("default");
    if (setting.number) {
      EXPECT_EQ(fallback.get<double>(), *setting.number);
    } else {
      EXPECT_EQ(fallback.get<std::string>(), setting.text);
    }
    ++found;
  }
  EXPECT_EQ(found + 8, keys.size()) << "eight keys have no default: three angles, the noise, the "
                                       "range and the tips of the probes, the feature "
                                       "that gives the wheel radius and the declared influences";
}

// Both committed texts come from plan_table.h; RONDURE_REWRITE=1 writes them again.
TEST(PlanSchema, TheCommittedSchemaIsTheOneOfTheTable) {
  const auto path = testing::source_dir() / "plans" / "schema" / "plan.schema.json";
  if (testing::rewriting()) {
    ASSERT_TRUE(record::write_file(path, plan_schema()));
  }
  EXPECT_EQ(testing::bytes_of(path), plan_schema());
}

TEST(PlanSchema, TheKeysInTheDocumentationAreThoseOfTheTable) {
  const std::string mark =
      "<!-- keys: from plans/schema/internal/plan_table.h; written by RONDURE_REWRITE=1 "
      "build/release/tests/plans/plans_tests -->\n";
  const auto pages = key_list_pages();
  EXPECT_EQ(pages.size(), 11U);
  for (const auto& [page, tables] : pages) {
    SCOPED_TRACE(page);
    const auto path = testing::source_dir() / "docs" / page;
    const std::string document = testing::bytes_of(path);
    const std::size_t at = document.find(mark);
    ASSERT_NE(at, std::string::npos);
    const std::string fresh = document.substr(0, at) + mark + tables;
    if (testing::rewriting()) {
      ASSERT_TRUE(record::write_file(path, fresh));
    }
    EXPECT_EQ(testing::bytes_of(path), fresh);
  }
}

}  // namespace
}  // namespace rondure::plans
