// Damaged plans, through the reader and all checks but that of the reach.

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "plans/plan.h"
#include "tests/app/files.h"
#include "tests/doors/exact.h"
#include "tests/fuzz/cases.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/seeds.h"
#include "tests/fuzz/wrong_text.h"

namespace rondure::doors {
namespace {

using Json = nlohmann::ordered_json;

std::filesystem::path folder() { return app::testing::source_dir() / "plans" / "examples"; }

const std::vector<std::string>& good_plans() {
  static const std::vector<std::string> plans = [] {
    std::vector<std::string> out;
    for (const auto& file : app::testing::plans_in(folder())) {
      out.push_back(app::testing::read(file));
    }
    return out;
  }();
  return plans;
}

/// "" for a plan, or for problems that can be shown on one line each.
std::string wrong_with_plan(const std::string& text) {
  const Exact exact(text);
  const plans::PlanOrProblems plan = plans::parse_plan(exact.view(), folder(), "plan.json");
  if (plan) return plan->features.empty() ? "a plan without features" : "";
  if (plan.error().empty()) return "refused without a word";
  for (const core::Error& problem : plan.error()) {
    const std::string line = core::to_line(problem);
    if (line.find_first_of("\r\n") != std::string::npos) return "more than a line: " + line;
    if (auto wrong = fuzz::wrong_with_refusal(problem); !wrong.empty()) return wrong;
  }
  return {};
}

/// A plan with some values changed for others, from this plan, from another one or foreign, some
/// keys removed and some doubled under another name.
class ValueDamage {
 public:
  explicit ValueDamage(unsigned seed) : random_(seed) {}

  std::string text() {
    Json plan = any_plan();
    const Json other = any_plan();
    for (std::size_t left = 1 + below(4); left > 0; --left) change(plan, other);
    return plan.dump(static_cast<int>(below(3)) - 1);
  }

 private:
  using Pointer = Json::json_pointer;

  std::size_t below(std::size_t limit) {
    return limit == 0 ? 0 : static_cast<std::size_t>(random_()) % limit;
  }
  Json any_plan() { return Json::parse(good_plans()[below(good_plans().size())]); }

  /// A value at any depth.
  Pointer place_in(const Json& plan) {
    Pointer place;
    const Json* value = &plan;
    while (value->is_structured() && !value->empty() && (place.empty() || below(4) != 0)) {
      auto at = value->begin();
      std::advance(at, static_cast<std::ptrdiff_t>(below(value->size())));
      if (value->is_object()) {
        place.push_back(at.key());
      } else {
        place.push_back(std::to_string(at - value->begin()));
      }
      value = &*at;
    }
    return place;
  }

  Json foreign() {
    static const std::vector<Json> all = {nullptr,
                                          true,
                                          -1,
                                          0,
                                          1,
                                          1e308,
                                          -1e-300,
                                          0.1,
                                          360,
                                          1'000'000,
                                          4.5,
                                          "",
                                          {},
                                          Json::array(),
                                          Json::object(),
                                          "\x7f",
                                          "mm",
                                          "../..",
                                          "none",
                                          {1, 2, 3},
                                          {{"a", 1}},
                                          std::string(3000, 'x'),
                                          std::string("\xef\xbf\xbf"),
                                          9007199254740993LL};
    return all[below(all.size())];
  }

  void change(Json& plan, const Json& other) {
    const Pointer place = place_in(plan);
    if (place.empty()) return;
    Json& value = plan[place];
    Json& parent = plan[place.parent_pointer()];
    switch (below(6)) {
      case 0:
      case 1:
        value = foreign();
        break;
      case 2:
        if (value.is_number()) {
          value = value.get<double>() * static_cast<double>(below(7)) * 0.5 - 1.0;
        }
        break;
      case 3:
        value = other[place_in(other)];
        break;
      case 4:
        if (parent.is_object()) parent.erase(place.back());
        if (parent.is_array()) parent.push_back(Json(value));
        break;
      default:
        if (parent.is_object()) parent[place.back() + (below(2) == 0 ? "_mm" : "s")] = Json(value);
        if (parent.is_array()) parent.erase(0);
    }
  }

  std::mt19937 random_;
};

TEST(PlanDoor, ReadsTheGoodPlans) {
  for (const std::string& text : good_plans()) {
    const Exact exact(text);
    const auto plan = plans::parse_plan(exact.view(), folder(), "plan.json");
    EXPECT_TRUE(plan) << core::to_line(plan.error().front());
  }
  EXPECT_GE(good_plans().size(), 15U);
}

TEST(PlanDoor, StandsDamagedBytes) {
  const fuzz::Mutation mutation(good_plans(), fuzz::json_words());
  fuzz::try_cases({20'000}, [&](unsigned seed) { return wrong_with_plan(mutation.input(seed)); });
}

TEST(PlanDoor, StandsDamagedValues) {
  fuzz::try_cases({4000}, [](unsigned seed) { return wrong_with_plan(ValueDamage(seed).text()); });
}

TEST(PlanDoor, StandsPlansThatEndTooEarly) {
  for (const std::string& text : good_plans()) {
    for (const std::size_t size : cuts_of(text.size(), 20)) {
      for (const std::string_view half : half_words()) {
        const std::string cut = text.substr(0, size).append(half);
        ASSERT_EQ(wrong_with_plan(cut), "") << cut;
      }
    }
  }
}

}  // namespace
}  // namespace rondure::doors
