// The verbs that fit an analysis state no interval, and say which plan does.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::HasSubstr;

std::string sample_file(const std::string& name) {
  return std::string(RONDURE_SOURCE_DIR) + "/tests/data/" + name;
}

struct FitOfAnAnalysis {
  std::vector<std::string> words;
  std::string key;  ///< Of the plan that gives the interval.
};

std::vector<FitOfAnAnalysis> fits_of_analyses() {
  return {{{"spindle", sample_file("spindle_dynamic/readings.csv"), "--layout", "reference",
            "--crank-radius", "49", "--wheel-radius", "299.88", "--pin-radius", "24.56"},
           "spindle.uncertainty"},
          {{"wheel", sample_file("spec_wheel/example1.csv"), "--mode", "envelope"},
           "wheel.uncertainty"},
          {{"contour", "--axes", sample_file("spec_contour/axes1.csv"), "--pin",
            sample_file("spec_contour/pin1.csv"), "--prefiltered"},
           "contour.uncertainty"},
          {{"rotary-axes", sample_file("spec_rotary/c_axis.csv")}, "rotary_axes.uncertainty"}};
}

Outcome fit_by_verb(const FitOfAnAnalysis& one, const char* more) {
  std::vector<std::string> words = {"fit"};
  words.insert(words.end(), one.words.begin(), one.words.end());
  if (more != nullptr) words.emplace_back(more);
  return rondure(words);
}

TEST(FitOfAnalyses, SaysWhyThereIsNoIntervalAndWhichPlanGivesIt) {
  for (const FitOfAnAnalysis& one : fits_of_analyses()) {
    SCOPED_TRACE(one.key);
    const Outcome text = fit_by_verb(one, nullptr);
    ASSERT_EQ(text.status, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("no interval is stated: "));
    EXPECT_THAT(text.out, HasSubstr(one.key));
    const auto found = nlohmann::json::parse(fit_by_verb(one, "--json").out);
    EXPECT_THAT(found.at("no_interval_because").get<std::string>(), HasSubstr(one.key));
    EXPECT_THAT(rondure({"fit", one.words.front(), "--help"}).out,
                HasSubstr("No interval is stated here: a plan with " + one.key));
  }
}

}  // namespace
}  // namespace rondure::app::testing
