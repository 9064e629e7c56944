#include <cmath>
#include <cstdlib>
#include <iostream>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/plans/bad_plans.h"
#include "tests/plans/files.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// How far the typical errors of a machine change the zone of a part of 50 mm [um]. Pre-travel,
/// lobes 0.6, and backlash, 0.3, change radii by up to 0.75; squareness by 4 urad x 27 mm / 2 =
/// 0.05 across and 3.5 urad x 40 mm as tilt, which costs no form; waves of axes by 0.4 and
/// rotations of 1 urad at a lever of 400 mm by 0.4: together below 2 um of radius.
double machine_bound_um(const json& plan) {
  const auto errors = "/simulation/machine/errors"_json_pointer;
  return plan.contains(errors) && plan.at(errors) == "typical" ? 2.0 * 2.0 : 0.0;
}

/// How far the zone of noisy points can be from that of the true ones [um].
///
/// If no radial distance changes by more than d, the gap max - min about any axis changes by no
/// more than 2 d, and so does its least value over all axes. The mean of r touches of one point
/// errs by a normal deviate of sigma / sqrt(r), which exceeds four of its standard deviations once
/// in 16 000 points: d = 4 sigma / sqrt(r). Turning the whole cloud (fixture) or changing all radii
/// alike (tip) leaves the gap as it is.
double noise_bound_um(const json& plan) {
  const double sigma_um = plan.at("/simulation/probe/repeatability_um"_json_pointer);
  const double repeats = plan.at("/features/0/pose_search/repeats"_json_pointer);
  return 2.0 * 4.0 * sigma_um / std::sqrt(repeats) + machine_bound_um(plan);
}

/// The lines of touches.csv without the comment that names the run.
std::string touches_of(const fs::path& run) {
  const std::string text = read(run / "touches.csv");
  return text.substr(text.find('\n') + 1);
}

/// Whether a drawing asks more than unfiltered peak-to-valley form.
bool has_finding(const json& report) {
  for (const json& feature : report.at("features")) {
    for (const json& characteristic : feature.at("characteristics")) {
      if (characteristic.contains("finding")) return true;
    }
  }
  return false;
}

/// Whether the fixture is calibrated: by touches, and with a file for other runs.
bool calibrates(const json& plan) { return plan.at("features").at(0).at("type") == "rotary_axes"; }

/// Whether it is no surface: the data are series, or balls.
bool is_analysis(const json& plan) {
  const std::string type = plan.at("features").at(0).at("type");
  return type != "cylinder" && type != "circle";
}

/// Whether a feature is recorded as a series.
bool has_series(const json& plan) {
  for (const json& feature : plan.at("features")) {
    const std::string type = feature.at("type");
    if (type == "spindle" || type == "wheel" || type == "contour" || type == "five_axis")
      return true;
  }
  return false;
}

/// What an independent validator says of the reports in the runs of a folder; "" when all are
/// valid.
std::string reports_fault(const fs::path& folder) {
  const std::string command = "cd '" + folder.string() + "' && /usr/bin/python3 '" +
                              (source_dir() / "tests/app/reports_are_valid.py").string() + "' '" +
                              (source_dir() / "plans/schema/report.schema.json").string() +
                              "' */ >said 2>&1";
  return std::system(command.c_str()) == 0 ? std::string() : read(folder / "said");
}

/// The same of their QIF files, by the schemas beside the project; without those, says so.
std::string qif_fault(const fs::path& folder) {
  const fs::path schemas = source_dir() / "../shared/qif";
  if (!fs::exists(schemas / "catalog.xml")) {
    std::cout << "QIF not held against its schema, which is not there: " << schemas.string()
              << "\n";
    return {};
  }
  const std::string command =
      "cd '" + folder.string() + "' && XML_CATALOG_FILES='" + (schemas / "catalog.xml").string() +
      "' xmllint --nonet --noout --schema '" +
      (schemas / "QIFApplications/QIFDocument.xsd").string() + "' */report.qif >said 2>&1";
  return std::system(command.c_str()) == 0 ? std::string() : read(folder / "said");
}

/// A run that stops at a fault, with all reports: void results, a QIF file nevertheless.
void run_until_a_fault(const fs::path& folder) {
  write_plan_with_intervals(folder / "fault.json",
                            {{"/simulation/faults", {{"connection_lost_at_touch", 60}}}});
  EXPECT_EQ(rondure({"run", folder / "fault.json", "--out", folder / "fault", "--format",
                     "html,json,csv,qif,dmis"})
                .status,
            3);
}

/// Compares the reported cylindricity of a run with its hidden truth.
void expect_near_truth(const fs::path& run, const json& plan) {
  const json report = json::parse(read(run / "report.json"));
  for (const json& feature : report.at("features")) {
    for (const json& asked : feature.at("characteristics")) {
      const bool cylt = asked.at("form") == "cylindricity" && asked.contains("simulation");
      if (!cylt || asked.at("reference") != "MZCY") continue;
      const double truth_um = asked.at("simulation").at(0).at("truth_um");
      EXPECT_NEAR(asked.at("value_um"), truth_um, noise_bound_um(plan));
      EXPECT_GT(truth_um, noise_bound_um(plan) / 2.0);
      return;
    }
  }
  ADD_FAILURE() << "no cylindricity has a truth";
}

TEST(Examples, RunConformVerifyAndWriteTheirReports) {
  const auto plans = plans_in(example(""));
  EXPECT_EQ(plans.size(), 23U);
  std::set<std::string> parts;
  for (const fs::path& plan : plans) {
    if (needs_server(plan)) continue;  // ipp_run_test.cpp
    SCOPED_TRACE(plan.filename().string());
    const std::string name = plan.stem().string();
    const fs::path run = example_runs() / name;
    const json report = json::parse(read(run / "report.json"));
    const std::string verdict = report.at("verdict");
    const Outcome ran = example_outcome(name);
    EXPECT_EQ(ran.status, verdict == "conforms" || verdict == "not toleranced" ? 0 : 1);
    EXPECT_THAT(ran.err, IsEmpty());
    std::vector<std::string> files = {"SHA256SUMS",  "journal.db", "report.dmo", "report.html",
                                      "report.json", "report.qif", "results.csv"};
    const json asked = json::parse(read(plan));
    if (calibrates(asked)) files.insert(files.begin() + 1, "fixture-calibration.json");
    // Examples of one part stand in one archive: the later ones show the earlier ones.
    const bool again = !parts.insert(asked.at("part").at("id").get<std::string>()).second;
    if (again) files.insert(files.begin() + 1, "earlier.json");
    if (has_finding(report)) files.emplace_back("sections.csv");
    if (has_series(asked)) files.emplace_back("series.csv");
    files.emplace_back("touches.csv");
    auto there = names_in(run);
    const bool kept = std::erase(there, "trials.bin") > 0;
    EXPECT_TRUE(
        kept ||
        !std::set<std::string>({"01_spool_simulated", "09_axle_points_file"}).contains(name));
    EXPECT_THAT(there, ::testing::ElementsAreArray(files));
    const Outcome verified = rondure({"verify", run});
    EXPECT_EQ(verified.status, 0);
    EXPECT_THAT(verified.out, HasSubstr("equal: "));
    for (const char* file : {"report.html", "report.json", "touches.csv"}) {
      EXPECT_THAT(verified.out, HasSubstr(file));
    }
  }
  const Scratch stopped;
  run_until_a_fault(stopped.path());
  for (const fs::path& folder : {example_runs(), stopped.path()}) {
    EXPECT_EQ(reports_fault(folder), "");
    EXPECT_EQ(qif_fault(folder), "");
  }
}

// With the seed of each plan, and with another one with RONDURE_FULL=1 (./test.sh --full).
TEST(Examples, TheReportedCyltAgreesWithTheHiddenTruthWithinTheNoise) {
  const bool full = std::getenv("RONDURE_FULL") != nullptr;
  int simulated = 0;
  for (const fs::path& plan : plans_in(example(""))) {
    const json asked = json::parse(read(plan));
    if (!asked.contains("simulation") || is_analysis(asked) || needs_server(plan)) continue;
    SCOPED_TRACE(plan.filename().string());
    ++simulated;
    expect_near_truth(example_runs() / plan.stem(), asked);
    if (!full) continue;
    const Scratch folder;
    ASSERT_LE(rondure({"run", plan, "--out", folder / "run", "--seed", "1"}).status, 1);
    expect_near_truth(folder / "run", asked);
  }
  EXPECT_GE(simulated, 5);
}

// Both from the filtered profile about its own circle: beside 10.44 um of the part stood the 12.5
// um of the profile itself.
TEST(Examples, TheTruthOfARoundnessIsFilteredAsItsValue) {
  const fs::path run = example_runs() / "05_spindle_three_probe";
  const json report = json::parse(read(run / "report.json"));
  int compared = 0;
  for (const json& asked : report.at("features").at(0).at("characteristics")) {
    if (!asked.at("form").get<std::string>().starts_with("roundness")) continue;
    ++compared;
    EXPECT_NEAR(asked.at("value_um").get<double>(), asked["simulation"][0]["truth_um"], 0.05);
  }
  EXPECT_EQ(compared, 2) << "RONt and RONq";
}

// Of the harmonic that was judged, and of the same part.
TEST(Examples, AMaskStandsBesideTheTruthOfItsHarmonic) {
  struct Mask {
    const char* example;
    double planted_um;  // harmonic 16 of the part; harmonic 2 of the third pin, by its axes too
    double within_um;
  };
  for (const Mask& mask :
       {Mask{"05_spindle_three_probe", 0.5, 0.001}, Mask{"07_crank_pin", 2.595, 0.01}}) {
    SCOPED_TRACE(mask.example);
    const json report = json::parse(read(example_runs() / mask.example / "report.json"));
    const json& asked = report.at("/features/0/characteristics/2"_json_pointer);
    ASSERT_EQ(asked.at("form"), "harmonic-limits");
    ASSERT_EQ(asked.at("simulation").size(), 1U);
    const double truth_um = asked["simulation"][0]["truth_um"];
    EXPECT_NEAR(truth_um, mask.planted_um, mask.within_um);
    EXPECT_NE(truth_um, asked.at("value_um").get<double>());
  }
}

TEST(Examples, ValidateNamesWhatIsNotDeclared) {
  EXPECT_THAT(rondure({"validate", example("01_spool_simulated.json")}).out,
              HasSubstr("uncertainty: not declared, so in no interval: machine-length-limit"));
  EXPECT_THAT(rondure({"validate", example("16_four_analyses.json")}).out,
              HasSubstr("feature wheel: not declared, so in no interval: expansion_per_K"));
  EXPECT_THAT(rondure({"validate", example("15_shaft_drawing.json")}).out,
              HasSubstr("uncertainty: not declared, no value has an interval"));
}

/// The call-outs of a report that do not conform, as "feature: characteristic".
std::vector<std::string> failing(const json& report) {
  std::vector<std::string> out;
  for (const json& feature : report.at("features")) {
    for (const json& c : feature.at("characteristics")) {
      if (c.at("verdict") == "conforms") continue;
      out.push_back(feature.at("id").get<std::string>() + ": " + c.at("id").get<std::string>());
    }
  }
  return out;
}

TEST(Examples, OfAShaftDrawingOnlyTheSpoiledCallOutsFail) {
  const Scratch folder;
  json plan = json::parse(read(example("15_shaft_drawing.json")));
  for (json& surface : plan.at("/simulation/features"_json_pointer)) {
    const std::string id = surface.at("id");
    if (id == "journal B") surface["lobes"][0]["amplitude_um"] = 1.3;  // RONt 2.6
    if (id == "bore D") surface["diameter_error_um"] = -2;
    if (id == "seat C") surface["offset_x_um"] = 9;  // coaxiality 16, run-out 17
    if (id == "face E") surface["saucer_um"] = 20;   // flatness 20 (28^2 - 24^2) / 30^2
    if (id == "cone G") surface["offset_y_um"] = 7;  // run-out 13
  }
  write(folder / "plan.json", plan.dump(2));
  ASSERT_EQ(rondure({"run", folder / "plan.json", "--out", folder / "run"}).status, 1);
  EXPECT_THAT(failing(json::parse(read(folder / "run" / "report.json"))),
              ::testing::ElementsAre("journal B: RONt 2, 50 UPR", "seat C: coaxiality 10",
                                     "seat C: run-out 12", "seat C: total run-out 15",
                                     "bore D: 18H7 E", "face E: flat 4", "cone G: cone run-out 8"));
}

TEST(Examples, FourAnalysesUnderIso14253EndWithAVerdictEach) {
  const fs::path run = example_runs() / "16_four_analyses";
  EXPECT_THAT(read(run / "report.html"), HasSubstr("<summary>Drawings, call-outs that conform"))
      << "nothing has to be looked at in an analysis that conforms";
  EXPECT_THAT(read(example_runs() / "05_spindle_three_probe" / "report.html"),
              ::testing::Not(HasSubstr("<summary>Drawings")));
  EXPECT_EQ(example_outcome("16_four_analyses").status, 0);
  const json report = json::parse(read(run / "report.json"));
  EXPECT_EQ(report.at("verdict"), "conforms");
  ASSERT_EQ(report.at("features").size(), 4U);
  for (const json& feature : report.at("features")) {
    for (const json& c : feature.at("characteristics")) {
      EXPECT_EQ(c.at("verdict"), "conforms") << feature.at("id") << ' ' << c.dump();
    }
  }
}

TEST(Examples, EveryTypeOfFeatureIsVoidOutsideTheTemperatureLimits) {
  json plan = json::parse(read(example("16_four_analyses.json")));
  plan["simulation"]["temperature_degC"] = 35.0;
  const Scratch folder;
  write(folder / "plan.json", plan.dump(2));
  EXPECT_EQ(rondure({"run", folder / "plan.json", "--out", folder / "run"}).status, 1);
  const json report = json::parse(read(folder / "run" / "report.json"));
  EXPECT_EQ(report.at("verdict"), "void");
  for (const json& feature : report.at("features")) {
    for (const json& c : feature.at("characteristics")) {
      SCOPED_TRACE(c.dump());
      EXPECT_EQ(c.at("verdict"), "void");
      EXPECT_THAT(c.at("reason").get<std::string>(),
                  HasSubstr("temperature 35.00 degC is outside 18..22 degC"));
    }
  }
}

TEST(Examples, OneSeedGivesTheSameTouchesAndAnotherGivesOthers) {
  const Scratch folder;
  const fs::path plan = folder / "plan.json";
  write_plan(plan, {});
  for (const char* run : {"a", "b"})
    ASSERT_EQ(rondure({"run", plan, "--out", folder / run}).status, 0);
  ASSERT_LE(rondure({"run", plan, "--out", folder / "c", "--seed", "5"}).status, 1);
  EXPECT_GT(touches_of(folder / "a").size(), 1000U);
  EXPECT_EQ(touches_of(folder / "a"), touches_of(folder / "b"));
  EXPECT_NE(touches_of(folder / "a"), touches_of(folder / "c"));
}

TEST(Examples, TheDefaultSeedIsThatOfThePlan) {
  const Scratch folder;
  const fs::path plan = example("14_bore_simulated.json");
  const json asked = json::parse(read(plan));
  const std::string seed = asked.at("/simulation/seed"_json_pointer).dump();
  ASSERT_LE(rondure({"run", plan, "--out", folder / "run", "--seed", seed}).status, 1);
  EXPECT_EQ(touches_of(example_runs() / plan.stem()), touches_of(folder / "run"));
}

// Three of the bad plans, all with RONDURE_FULL=1: tests/plans compares the words of each with the
// approved ones.
TEST(BadPlans, AreRefusedInTheWordsOfTheReaderAndLeaveNothing) {
  const bool full = std::getenv("RONDURE_FULL") != nullptr;
  const std::set<std::string> chosen = {"01_truncated.json", "40_points_file_bad.json",
                                        "55_everything_at_once.json"};
  const Scratch root;  // as the repository, whose files the plans name
  fs::create_directories(root / "tests/data");
  for (const char* named : {"plans", "tests/data/nist_cyl_13"}) {
    fs::create_directory_symlink(source_dir() / named, root / named);
  }
  const fs::path place = root / "tests/data/bad_plans";
  fs::copy(plans::testing::bad_plans_folder(), place);
  std::size_t refused = 0;
  const auto all = plans::testing::bad_plans();
  for (const plans::testing::BadPlan& bad : all) {
    if (!full && !chosen.contains(bad.file)) continue;
    SCOPED_TRACE(bad.file);
    ++refused;
    const fs::path plan = place / bad.file;
    write(plan, bad.text);
    const Scratch folder;
    const Outcome validated = rondure({"validate", plan});
    const Outcome ran = rondure({"run", plan, "--out", folder / "run"});
    EXPECT_EQ(validated.status, 2);
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.err, plans::testing::lines_of(plans::read_plan(plan)));
    EXPECT_THAT(validated.err, ::testing::StartsWith(ran.err));
    EXPECT_THAT(validated.out + ran.out, IsEmpty());
    EXPECT_THAT(names_in(folder.path()), IsEmpty());
  }
  EXPECT_EQ(refused, full ? all.size() : 3U);
}

}  // namespace
}  // namespace rondure::app::testing
