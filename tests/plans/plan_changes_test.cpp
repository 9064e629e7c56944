#include "plans/resume/internal/recorded_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rondure::plans {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> lines(std::string_view before, std::string_view now) {
  std::vector<std::string> out;
  for (const core::Error& change : plan_changes(before, now)) {
    out.push_back(change.where + ": " + change.what);
  }
  return out;
}

TEST(PlanChanges, NameEachValueByItsPointerWithOldAndNew) {
  EXPECT_THAT(lines(R"({"a": {"b_um": [1, 2.5, 3]}, "c": "x", "gone": true})",
                    R"({"a": {"b_um": [1, 2.75]}, "c": "y", "new/key": {"d": 1}})"),
              ElementsAre("/a/b_um/1: the run began with 2.5, the plan now says 2.75",
                          "/a/b_um/2: the run began with 3, the plan now says absent",
                          "/c: the run began with \"x\", the plan now says \"y\"",
                          "/gone: the run began with true, the plan now says absent",
                          "/new~1key: the run began with absent, the plan now says an object of 1 "
                          "keys"));
}

TEST(PlanChanges, SeeAnotherKindOfValue) {
  EXPECT_THAT(lines(R"({"a": 1, "b": null, "c": []})", R"({"a": "1", "b": false, "c": {}})"),
              ElementsAre("/a: the run began with 1, the plan now says \"1\"",
                          "/b: the run began with null, the plan now says false",
                          "/c: the run began with an array of 0, the plan now says an object of 0 "
                          "keys"));
}

TEST(PlanChanges, DoNotCountOrderSpacesAndSpellingsOfTheSameNumber) {
  EXPECT_THAT(lines(R"({"a": 100, "b": [0.1, "x"]})", "{ \"b\":[1e-1 ,\"\\u0078\"],\n\"a\":1e2}"),
              ElementsAre());
}

}  // namespace
}  // namespace rondure::plans
