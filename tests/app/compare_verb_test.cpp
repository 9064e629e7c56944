// rondure compare: the table of a finished run against its report, what cannot be compared, and
// that nothing of the run changes.
#include <sqlite3.h>

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The value of a cell [um]; the other factors are as they were reported.
double cell_um(const json& study, const std::string& factor, const std::string& level) {
  for (const json& cell : study.at("cells")) {
    bool wanted = cell.at(factor) == level;
    for (const json& other : study.at("factors")) {
      const std::string name = other.at("factor");
      wanted = wanted && (name == factor || cell.at(name) == other.at("reported"));
    }
    if (wanted) return cell.at("value_um");
  }
  ADD_FAILURE() << factor << " " << level;
  return 0.0;
}

TEST(CompareVerb, OfAFinishedRunAgreesWithItsReportAndChangesNothing) {
  const Scratch folder;
  const fs::path run = folder / "run";
  fs::copy(example_runs() / "08_shaft_scanned", run);
  const auto names = names_in(run);
  const Outcome text = rondure({"compare", run});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out,
              AllOf(StartsWith("Why do they differ? Run "), HasSubstr(" as reported; the"),
                    HasSubstr("Gaussian 15 UPR"), HasSubstr("share of variance")));
  std::istringstream lines(text.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;

  const Outcome machine = rondure({"compare", run, "--json"});
  ASSERT_EQ(machine.status, 0);
  const json comparison = json::parse(machine.out);
  const json report = json::parse(read(run / "report.json"));
  const json& feature = report.at("features").at(0);
  std::size_t seen = 0;
  for (const json& study : comparison.at("characteristics")) {
    double sum = study.at("factorial").at("together_share");
    for (const json& factor : study.at("factors")) sum += factor.at("share").get<double>();
    EXPECT_NEAR(sum, 1.0, 1e-12);
    if (study.at("symbol") != "CYLt" || study.at("feature") != feature.at("id")) continue;
    ++seen;
    for (const auto& [level, key] : std::vector<std::pair<std::string, std::string>>{
             {"LSCY", "ls"}, {"MZCY", "mz"}, {"MCCY", "mc"}, {"MICY", "mi"}}) {
      EXPECT_NEAR(cell_um(study, "reference", level), feature.at(key).at("deviation_um"), 1e-6)
          << level;
    }
  }
  EXPECT_GT(seen, 0U);
  EXPECT_EQ(rondure({"compare", run, "--json"}).out, machine.out);
  EXPECT_THAT(rondure({"compare", run, "--all"}).out, HasSubstr("outliers: 3 sigma"));
  EXPECT_EQ(names_in(run), names);
  EXPECT_EQ(rondure({"verify", run}).status, 0);
}

TEST(CompareVerb, RefusesWhatItCannotReadOrCompare) {
  const Scratch folder;
  EXPECT_EQ(rondure({"compare", folder / "nothing"}).status, 2);

  const fs::path damaged = folder / "damaged";
  ASSERT_EQ(run_without_intervals("09_axle_points_file", {"--out", damaged, "--quiet"}).status, 0);
  EXPECT_EQ(rondure({"compare", damaged}).status, 0);
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((damaged / "journal.db").c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, "update touch set tip_x_mm = 1 where id = 3", nullptr, nullptr,
                         nullptr),
            SQLITE_OK);
  sqlite3_close(database);
  const Outcome changed = rondure({"compare", damaged});
  EXPECT_EQ(changed.status, 2);
  EXPECT_EQ(changed.out, "");
  EXPECT_THAT(changed.err, HasSubstr("table touch of the journal was changed after the run"));

  // A collision before the final cloud.
  write_plan(folder / "plan.json", {{"/simulation/part/tilt_deg", 20}});
  ASSERT_EQ(rondure({"run", folder / "plan.json", "--out", folder / "stopped"}).status, 3);
  const Outcome stopped = rondure({"compare", folder / "stopped"});
  EXPECT_EQ(stopped.status, 2);
  EXPECT_THAT(stopped.err, AllOf(HasSubstr("no cylindricity and no roundness with a value"),
                                 HasSubstr("not measured to its end")));

  const Outcome wheel = rondure({"compare", example_runs() / "06_wheel", "--json"});
  ASSERT_EQ(wheel.status, 0) << wheel.err;
  const json compared = json::parse(wheel.out);
  ASSERT_EQ(compared.at("characteristics").size(), 1U);
  EXPECT_EQ(compared.at("characteristics")[0].at("characteristic"), "edge roundness");
  EXPECT_EQ(compared.at("not_compared").size(), 2U);

  const Outcome pin = rondure({"compare", example_runs() / "07_crank_pin"});
  EXPECT_EQ(pin.status, 2);
  EXPECT_THAT(pin.err, HasSubstr("pin / contour: the contour is held against the ground contour"));
}

}  // namespace
}  // namespace rondure::app::testing
