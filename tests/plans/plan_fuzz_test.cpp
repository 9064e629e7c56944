#include <array>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "plans/schema/json_text.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

std::string spool() { return testing::bytes_of(testing::example("01_spool_simulated.json")); }

// Whatever was damaged: a plan that is accepted can be measured.
void expect_measurable(const Plan& plan) {
  ASSERT_FALSE(plan.features.empty());
  for (const FeaturePlan& feature : plan.features) {
    const bool circle = feature.type == record::Shape::kCircle;
    EXPECT_GE(feature.sampling.layers, circle ? 1 : 2);
    EXPECT_GE(feature.sampling.points_per_layer, 3);
    EXPECT_GE(feature.nominal.diameter_mm, 1.0);
    EXPECT_LE(feature.nominal.diameter_mm, 1000.0);
    if (!circle) {
      EXPECT_GT(feature.nominal.to_mm - feature.nominal.from_mm, 2.0 * feature.sampling.margin_mm);
    }
    for (const double step_deg : feature.pose_search.steps_deg) EXPECT_GT(step_deg, 0.0);
  }
  EXPECT_TRUE(plan.machine && plan.fixture && plan.probe && plan.simulation);
  EXPECT_GT(plan.probe->tip_diameter_mm, 0.0);
  const EnvironmentPlan environment = plan.environment.value_or(EnvironmentPlan());
  EXPECT_LT(environment.min_degC, environment.max_degC);
}

// A plan, or at least one problem that can be shown on one line of UTF-8.
void expect_plan_or_problems(const std::string& text) {
  const PlanOrProblems result = parse_plan(text, "", "plan.json");
  if (result) return expect_measurable(*result);
  ASSERT_FALSE(result.error().empty());
  for (const core::Error& problem : result.error()) {
    const std::string line = core::to_line(problem);
    ASSERT_EQ(line.find_first_of("\r\n"), std::string::npos) << line;
    ASSERT_EQ(first_not_utf8(line), line.size()) << line;
  }
}

TEST(PlanFuzz, ThreeThousandDamagedTextsGiveAPlanOrProblems) {
  const std::string original = spool();
  ASSERT_FALSE(original.empty());
  for (unsigned seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string text = original;
    const unsigned edits = 1 + random() % 8;
    for (unsigned i = 0; i < edits && !text.empty(); ++i) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random() % 256);
          break;
        case 1:
          text.erase(at, 1 + random() % 20);
          break;
        case 2:
          text.insert(at, 1, "{}[]\",:-.0e\\"[random() % 12]);
          break;
        default:
          text.insert(at, original, random() % original.size(), random() % 40);
          break;
      }
    }
    expect_plan_or_problems(text);
    if (HasFatalFailure()) return;
  }
}

struct Span {
  std::size_t first = 0;
  std::size_t length = 0;
};

// Where the values of a JSON text without brackets in its texts stand: scalars, objects, arrays.
std::vector<Span> values_of(const std::string& text) {
  std::vector<Span> out;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '{' || c == '[') {
      open.push_back(i);
    } else if (c == '}' || c == ']') {
      out.push_back({open.back(), i + 1 - open.back()});
      open.pop_back();
    } else if (c == '"') {
      const std::size_t first = i;
      do {
        ++i;
        if (text[i] == '\\') i += 2;
      } while (text[i] != '"');
      out.push_back({first, i + 1 - first});
    } else if (std::string("-0123456789tfn").find(c) != std::string::npos) {
      const std::size_t end = text.find_first_of(",]} \n", i);
      out.push_back({i, end - i});
      i = end - 1;
    }
  }
  return out;
}

TEST(PlanFuzz, AThousandForeignValuesGiveAPlanOrProblems) {
  const std::string original = spool();
  const std::vector<Span> places = values_of(original);
  ASSERT_GT(places.size(), 150U);
  const std::string deep = std::string(50, '[') + std::string(50, ']');
  const std::string long_text = "\"" + std::string(20'000, 'x') + "\"";
  const std::array<std::string, 13> foreign = {"null",     "-1",   "1e308", "\"\"",
                                               "[]",       "{}",   "true",  deep,
                                               long_text,  "-0.0", "4.5",   "9007199254740993",
                                               "[1, 2, 3]"};
  for (unsigned seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Span place = places[random() % places.size()];
    std::string text = original;
    text.replace(place.first, place.length, foreign[random() % foreign.size()]);
    expect_plan_or_problems(text);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace rondure::plans
