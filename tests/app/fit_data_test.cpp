#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kPi = 3.14159265358979323846;

/// The report of a plan that is run and verified in a folder.
nlohmann::json report_of(const test::Scratch& folder, const nlohmann::json& plan) {
  write(folder / "plan.json", plan.dump());
  const Outcome outcome = rondure(
      {"run", folder / "plan.json", "--out", folder / "run", "--quiet", "--format", "json"});
  EXPECT_LE(outcome.status, 1) << outcome.err;
  EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
  return nlohmann::json::parse(read(folder / "run" / "report.json"));
}

/// Text that is no points file, and what the message must hold.
struct BadFile {
  std::string shape;
  std::string bytes;
  std::string place;
  std::string word;
};

TEST(FitData, ABadFileIsRefusedWithItsPlace) {
  const std::string square = "x,y\n1,0\n0,1\n-1,0\n0,-1\n";
  std::string ring;
  for (int i = 0; i < 8; ++i)
    ring += fmt::format("{},{},5\n", std::cos(0.7 * i), std::sin(0.7 * i));
  const std::vector<BadFile> files = {
      {"circle", "", "bad.csv:1", "empty"},
      {"circle", "# nothing\n\n", "bad.csv:2", "comments"},
      {"circle", "x,y\n", "bad.csv:1", "no points"},
      {"circle", square + "nan,1\n", "bad.csv:6", "nan"},
      {"circle", square + "1,-inf\n", "bad.csv:6", "inf"},
      {"circle", square + "1,1e999\n", "bad.csv:6", "1e999"},
      {"circle", square + "1e155,0\n", "bad.csv:6", "beyond the limit of 1e+09 mm"},
      {"circle", square + "-1e100,0\n", "bad.csv:6", "x is -1e100 mm"},
      {"sphere", "x,y,z\n" + ring + "0,0,1e155\n", "bad.csv:10", "z is 1e155 mm"},
      {"line", "x,y,z\n" + ring + "1e155,0,0\n", "bad.csv:10", "x is 1e155 mm"},
      {"cylinder", "x,y,z\n" + ring + "0,1e10,0\n", "bad.csv:10", "y is 1e10 mm"},
      {"roundness", "theta_deg,r_um\n0,1\n1,1e155\n", "bad.csv:3", "r_um is 1e155 um"},
      {"circle", square + "1,zwei\n", "bad.csv:6", "zwei"},
      {"circle", square + "1\n", "bad.csv:6", "1 field"},
      {"circle", square + "1,\n", "bad.csv:6", "y is empty"},
      {"circle", square + "1,2,3\n", "bad.csv:6", "3 fields"},
      {"circle", square + "1;2\n", "bad.csv:6", "1 field in \"1;2\""},
      {"circle", square + "0x10,1\n", "bad.csv:6", "0x10"},
      {"circle", "u,v\n1,2\n", "bad.csv:1", "\"u,v\" names none of the columns"},
      {"circle", "x,x\n1,2\n", "bad.csv:1", "twice"},
      {"circle", std::string("x,y\n1,\0\n", 8), "bad.csv:2", "NUL"},
      {"circle",
       "\x7f"
       "ELF\x02\x01\x01\xff\xfe\xfd\n\x01\x02",
       "bad.csv", "a program"},
      {"circle", "\xff\xfex\1,\1y\1\n\1", "bad.csv:1", "names no columns"},
      {"circle", "x,y,z\n1,2,3\n", "bad.csv", "[too-few-points]"},
      {"cylinder", square, "bad.csv:1", "x,y,z"},
      {"circle", "x,y\n1,1\n", "bad.csv", "[too-few-points]"},
      {"circle", "x,y\n0,0\n1,1\n2,2\n3,3\n", "bad.csv", "[collinear]"},
      {"circle", "x,y\n1,1\n1,1\n1,1\n1,1\n1,1\n", "bad.csv", "[too-few-points]"},
      {"cylinder", "x,y,z\n0,0,0\n1,1,1\n2,2,2\n3,3,3\n4,4,4\n5,5,5\n6,6,6\n7,7,7\n", "bad.csv",
       "["},
      {"cylinder", "x,y,z\n" + ring, "bad.csv", "["},
      {"plane", "x,y,z\n" + ring + "nan,0,0\n", "bad.csv:10", "nan"},
      {"plane", "x,y,z\n1,2,3\n", "bad.csv", "a plane needs at least 3 different points"},
      {"plane", "x,y,z\n0,0,0\n1,1,1\n2,2,2\n", "bad.csv", "lie along one line"},
      {"plane", square, "bad.csv:1", "a plane needs the columns x,y,z"},
      {"plane", "ISO-10303-21;\nHEADER;\n", "bad.csv", "STEP model"},
      {"cone", "x,y,z\n" + ring + "0,0,inf\n", "bad.csv:10", "inf"},
      {"cone", "x,y,z\n1,2,3\n", "bad.csv", "a cone needs at least 6 different points"},
      {"cone", "x,y,z\n" + ring, "bad.csv", "measure at least two sections"},
      {"cone", "x,y,z,layer\n1,2,3,0\n1,2,3,2\n", "bad.csv", "none of layer 1"},
      {"sphere", "x,y,z\n1,2,3\n", "bad.csv", "[too-few-points]"},
      {"sphere", "x,y,z\n" + ring, "bad.csv", "(fit circle)"},
      // The unit is in doubt.
      {"circle", square, "bad.csv", "in mm that is 2 mm, in inches 50.8 mm"},
      {"circle", "x,y\n1,0\n0,1.1\n-1,0\n0,-1\n", "bad.csv", "--unit mm"},
      {"plane", "x,y,z\n0,0,0\n0.5,0,0\n0,0.5,0\n0.5,0.5,0\n", "bad.csv",
       "an extent of 0.5: in mm that is 0.5 mm, in inches 12.7 mm"},
  };
  for (const BadFile& file : files) {
    SCOPED_TRACE(file.shape + ": " + ::testing::PrintToString(file.bytes));
    const Scratch folder;
    write(folder / "bad.csv", file.bytes);
    const Outcome outcome = rondure({"fit", file.shape, folder / "bad.csv", "--json"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, ::testing::AllOf(HasSubstr(file.place), HasSubstr(file.word)));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

// What a measuring program of another country writes: the same circle of radius 25 each time.
TEST(FitData, FilesOfOtherProgramsAreReadAndSaid) {
  const std::string rows = "P1;25,0;0,0\r\nP2;0,0;25,0\r\nP3;-25,0;0,0\r\nP4;0,0;-25,0\r\n";
  const std::string inches = "0.9842519685,0\n0,0.9842519685\n-0.9842519685,0\n0,-0.9842519685\n";
  struct Case {
    std::string bytes;
    std::vector<std::string> options;
    std::string read;
  };
  const std::vector<Case> cases = {
      {"Welle 7\r\nMesspunkt;X-Ist;Y-Ist\r\n;[mm];[mm]\r\n" + rows,
       {},
       "semicolon, decimal comma, X-Ist Y-Ist in mm; 4 points, 50.0 x 50.0 mm"},
      {"Messpunkt;U;V\r\n" + rows, {"--columns", "2,3"}, "columns 2 3 in mm (not stated); 4"},
      {"Messpunkt;U;V\r\n" + rows, {"--columns", "U,V"}, "U V in mm (not stated); 4 points"},
      {"x,y\n" + inches, {"--unit", "inch"}, "comma, decimal point, x y in inch; 4 points"},
      {"x [in],y [in]\n" + inches, {}, "x [in] y [in] in inch; 4 points"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.read);
    const Scratch folder;
    write(folder / "export.txt", c.bytes);
    std::vector<std::string> words = {"fit", "circle", folder / "export.txt", "--json"};
    words.insert(words.end(), c.options.begin(), c.options.end());
    const Outcome outcome = rondure(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto fit = nlohmann::json::parse(outcome.out);
    EXPECT_NEAR(fit["ls"]["radius_mm"], 25.0, 1e-8);
    EXPECT_THAT(fit["read"].get<std::string>(), HasSubstr(c.read));
  }
  EXPECT_THAT(rondure({"fit", "circle", "-"}).err, HasSubstr("standard input:1"));
}

// A circle of radius 25 about (100, 50, 30) whose plane leans by 20 deg, three lobes of 4 um.
TEST(FitData, ACircleInSpaceHasCentreNormalAndRadius) {
  const double lean = 20.0 * kPi / 180.0;
  std::string text = "x,y,z\n";
  for (int i = 0; i < 72; ++i) {
    const double t = 2.0 * kPi * i / 72.0;
    const double r = 25.0 + 0.004 * std::cos(3.0 * t);
    text += fmt::format("{:.12f},{:.12f},{:.12f}\n", 100.0 + r * std::cos(t) * std::cos(lean),
                        50.0 + r * std::sin(t), 30.0 - r * std::cos(t) * std::sin(lean));
  }
  const Scratch folder;
  write(folder / "circle.csv", text);
  const Outcome outcome = rondure({"fit", "circle", folder / "circle.csv", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto fit = nlohmann::json::parse(outcome.out);
  EXPECT_NEAR(fit["mz"]["deviation_mm"], 0.008, 1e-6);
  EXPECT_NEAR(fit["ls"]["radius_mm"], 25.0, 1e-6);
  const auto near = [&](const char* key, std::vector<double> expected) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(fit["ls"][key][k], expected[k], 1e-6) << key;
  };
  near("center_mm", {100.0, 50.0, 30.0});
  near("normal", {std::sin(lean), 0.0, std::cos(lean)});
}

// A plan reads what the verb reads: corrected hits of a bore of 50 mm in five heights, with three
// lobes of 4 um, in inches and with decimal commas.
TEST(FitData, NoZeroHasAMinusSign) {
  const Scratch folder;
  std::string oval = "x,y,z\n";
  for (int i = 0; i < 48; ++i) {
    const double angle = M_PI * (i % 12) / 6.0;
    const double r = 10.0 + 0.003 * std::cos(2.0 * angle);
    oval += fmt::format("{:.6f},{:.6f},{}\n", r * std::cos(angle), r * std::sin(angle), i / 12);
  }
  write(folder / "oval.csv", oval);
  EXPECT_THAT(rondure({"fit", "cylinder", folder / "oval.csv"}).out,
              AllOf(HasSubstr("axis through (0.000000, 0.000000, "), Not(HasSubstr("-0.000000"))));
}

TEST(FitData, APlanReadsTheSameFile) {
  std::string text = "Bohrung 3\r\nPunkt;X-Ist;Y-Ist;Z-Ist;\r\n;inch;inch;inch;\r\n";
  for (int i = 0; i < 5 * 72; ++i) {
    const double t = 2.0 * kPi * (i % 72) / 72.0;
    const double r = 25.0 + 0.004 * std::cos(3.0 * t);
    const int layer = i / 72;
    std::string row = fmt::format("{};{:.12f};{:.12f};{:.12f};\r\n", i, r * std::cos(t) / 25.4,
                                  r * std::sin(t) / 25.4, (6.0 * layer + 0.01 * (i % 3)) / 25.4);
    std::ranges::replace(row, '.', ',');
    text += row;
  }
  const Scratch folder;
  write(folder / "export.csv", text);
  const nlohmann::json plan = {
      {"plan", {{"name", "Bore"}, {"revision", "A"}}},
      {"part", {{"id", "B-3"}}},
      {"features",
       {{{"id", "bore"},
         {"type", "cylinder"},
         {"side", "inside"},
         {"nominal", {{"diameter_mm", 50}}},
         {"source", {{"file", "export.csv"}, {"layers", "heights"}, {"points", "surface"}}},
         {"characteristics",
          {{{"id", "round"}, {"form", "roundness"}, {"filter", "none"}, {"tolerance_um", 20}},
           {{"id", "size"},
            {"form", "diameter"},
            {"size", "GG"},
            {"lower_um", -20},
            {"upper_um", 20}}}}}}}};
  const auto report = report_of(folder, plan);
  const auto& found = report["features"][0]["characteristics"];
  EXPECT_NEAR(found[0]["value_um"], 8.0, 0.001);
  EXPECT_NEAR(found[1]["value_um"], 50000.0, 0.001);
  const auto journal = journal_of(folder / "run");
  const auto& settings = journal.features.at(0).settings;
  const auto said = std::ranges::find(settings, "source/read", &record::Setting::name);
  ASSERT_NE(said, settings.end());
  EXPECT_EQ(
      said->text,
      "semicolon, decimal comma, X-Ist Y-Ist Z-Ist in inch; 360 points, 50.0 x 50.0 x 24.0 mm, "
      "5 heights taken as layers 1 to 5");
}

/// Rows of a shaft of 40 mm: 3 layers of 16 points, with lobes and some noise.
std::vector<std::string> rows_of_shaft() {
  std::mt19937 bits(7);
  std::vector<std::string> out;
  for (int i = 0; i < 3 * 16; ++i) {
    const double t = 2.0 * kPi * i / 16.0;
    const double noise = 0.0005 * (static_cast<double>(bits() % 1000) / 500.0 - 1.0);
    const double r = 20.0 + 0.003 * std::cos(2.0 * t) + noise;
    out.push_back(fmt::format("{},{:.6f},{:.6f},{}\n", i / 16, r * std::cos(t), r * std::sin(t),
                              20 * (i / 16)));
  }
  return out;
}

std::string shaft_file(std::span<const std::string> rows) {
  std::string out = "layer,x,y,z\n";
  for (const std::string& row : rows) out += row;
  return out;
}

TEST(FitData, RowsThatAreThereTwiceTakeNoPart) {
  std::vector<std::string> rows = rows_of_shaft();
  const Scratch folder;
  const auto fitted = [&](const char* name) {
    write(folder / name, shaft_file(rows));
    const Outcome outcome = rondure({"fit", "cylinder", folder / name, "--size", "LP", "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };
  auto once = fitted("once.csv");
  EXPECT_EQ(once["sizes"]["LP"]["pairs"], 24);
  EXPECT_THAT(once["warnings"], IsEmpty());
  rows.insert(rows.end(), rows.begin(), rows.begin() + 5);
  auto again = fitted("again.csv");
  ASSERT_EQ(again["warnings"].size(), 1U) << again["warnings"];
  EXPECT_EQ(again["warnings"][0]["code"], "repeated-rows");
  EXPECT_EQ(again["warnings"][0]["what"],
            "row 48 repeats row 0 and takes no part; 5 rows do (rows from 0)");
  again.erase("warnings");
  once.erase("warnings");
  EXPECT_EQ(again, once);
  // The first row three times: numbers of contacts are those of the file.
  rows = rows_of_shaft();
  rows.insert(rows.begin(), 2, rows.front());
  const auto shifted = fitted("shifted.csv");
  EXPECT_EQ(shifted["sizes"], once["sizes"]);
  for (const char* side : {"outer", "inner"}) {
    const auto& contacts = once["mz"]["contacts"][side];
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const int row = contacts[k];
      EXPECT_EQ(shifted["mz"]["contacts"][side][k], row == 0 ? 0 : row + 2);
    }
  }
}

/// A plan that judges shaft.csv as points of the surface.
nlohmann::json shaft_plan(const nlohmann::json& uncertainty,
                          const nlohmann::json& characteristics) {
  return {{"plan", {{"name", "Shaft"}, {"revision", "A"}}},
          {"part", {{"id", "S-1"}}},
          {"uncertainty", uncertainty},
          {"features",
           {{{"id", "shaft"},
             {"type", "cylinder"},
             {"nominal", {{"diameter_mm", 40}}},
             {"source", {{"file", "shaft.csv"}, {"points", "surface"}}},
             {"characteristics", characteristics}}}}};
}

TEST(FitData, AFileWithEveryRowTwiceHasTheIntervalOfTheSingleFile) {
  const std::vector<std::string> rows = rows_of_shaft();
  const auto judged = [](const std::vector<std::string>& of) {
    const Scratch folder;
    write(folder / "shaft.csv", shaft_file(of));
    const auto plan = shaft_plan({{"probe", {{"repeatability_um", 0.2}}}, {"budget_trials", 0}},
                                 {{{"id", "CYLt"}, {"form", "cylindricity"}, {"tolerance_um", 20}},
                                  {{"id", "GG"},
                                   {"form", "diameter"},
                                   {"size", "GG"},
                                   {"lower_um", -20},
                                   {"upper_um", 20}}});
    return report_of(folder, plan)["features"][0];
  };
  const auto once = judged(rows);
  std::vector<std::string> twice = rows;
  twice.insert(twice.end(), rows.begin(), rows.end());
  const auto doubled = judged(twice);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& expected = once["characteristics"][k];
    const auto& found = doubled["characteristics"][k];
    EXPECT_EQ(found["value_um"], expected["value_um"]);
    ASSERT_FALSE(expected["uncertainty"].is_null());
    EXPECT_EQ(found["uncertainty"], expected["uncertainty"]);
  }
  const auto repeated = [](const nlohmann::json& feature) {
    std::vector<std::string> out;
    for (const auto& warning : feature["warnings"]) {
      if (warning["code"] == "repeated-rows") out.push_back(warning["what"]);
    }
    return out;
  };
  EXPECT_THAT(repeated(once), IsEmpty());
  EXPECT_THAT(repeated(doubled),
              ElementsAre("row 48 repeats row 0 and takes no part; 48 rows do (rows from 0)"));
}

// Points of the surface were corrected by a tip whose radius has an uncertainty, of either sign.
TEST(FitData, ASizeOfSurfacePointsIsAt20DegreesWithTipAndTemperatureInItsInterval) {
  const std::vector<std::string> rows = rows_of_shaft();
  const auto size_of = [&](const nlohmann::json& environment) {
    const Scratch folder;
    write(folder / "shaft.csv", shaft_file(rows));
    nlohmann::json plan = shaft_plan(
        {{"probe",
          {{"repeatability_um", 0.2}, {"tip_radius_um", 0.2}, {"reference_sphere_um", 0.05}}},
         {"thermal", {{"drift_K", 0}}},
         {"budget_trials", 0}},
        {{{"id", "GG"}, {"form", "diameter"}, {"size", "GG"}, {"upper_um", 20}},
         {{"id", "LP"}, {"form", "diameter"}, {"size", "LP"}, {"upper_um", 20}}});
    plan["part"]["expansion_per_K"] = 23e-6;
    if (!environment.is_null()) plan["environment"] = environment;
    return report_of(folder, plan)["features"][0]["characteristics"];
  };
  const auto as_read = size_of(nullptr);
  const auto at_20 = size_of({{"assumed_degC", 22}, {"temperature_uncertainty_K", 0.5}});
  for (std::size_t k = 0; k < 2; ++k) {
    SCOPED_TRACE(k);
    const double read_um = as_read[k]["value_um"];
    EXPECT_NEAR(at_20[k]["value_um"], read_um / (1.0 + 2.0 * 23e-6), 1e-6);
    ASSERT_FALSE(as_read[k]["uncertainty"].is_null()) << as_read[k];
    ASSERT_FALSE(at_20[k]["uncertainty"].is_null()) << at_20[k];
    // 0.2 and 0.05 um of the radius, and 23e-6 x 0.5 K of 40 mm, beside the noise.
    const auto& u = as_read[k]["uncertainty"]["sampled_points"];
    EXPECT_GT(u["high_um"].get<double>() - u["low_um"].get<double>(), 4 * 1.9 * 0.206);
    const auto& warm = at_20[k]["uncertainty"]["sampled_points"];
    EXPECT_GT(warm["high_um"].get<double>() - warm["low_um"].get<double>(),
              2 * 1.9 * std::hypot(2 * 0.206, 0.46));
  }
}

TEST(FitData, WhatIsNoFileIsRefused) {
  const Scratch folder;
  write(folder / "locked.csv", "x,y\n");
  fs::permissions(folder / "locked.csv", fs::perms::none);
  std::vector<fs::path> places = {folder.path(), folder / "absent.csv", "/dev/null"};
  if (::access((folder / "locked.csv").c_str(), R_OK) != 0)
    places.push_back(folder / "locked.csv");  // not for root
  for (const fs::path& place : places) {
    SCOPED_TRACE(place);
    const Outcome outcome = rondure({"fit", "circle", place});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(place.filename().string()));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

/// Radius r + a cos(3 t) + even noise of +-h: the zone is 2 (a + h) as the points grow dense.
struct Planted {
  double radius_mm = 25.0;
  double amplitude_mm = 0.004;
  double noise_mm = 0.0005;
};

std::string planted_points(const Planted& part, bool cylinder, int count) {
  std::mt19937_64 random(20261121);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  std::string text = cylinder ? "x,y,z\n" : "x,y\n";
  for (int i = 0; i < count; ++i) {
    const double t = kPi * even(random);
    const double r =
        part.radius_mm + part.amplitude_mm * std::cos(3.0 * t) + part.noise_mm * even(random);
    text += fmt::format("{:.9f},{:.9f}", 300.0 + r * std::cos(t), -200.0 + r * std::sin(t));
    text += cylinder ? fmt::format(",{:.9f}\n", 40.0 * even(random)) : "\n";
  }
  return text;
}

// One point of dirt: its row, how far it lies off, and what it makes of the deviation.
TEST(FitData, AGrossPointIsNamedWithItsShare) {
  const Scratch folder;
  const auto table_of = [](bool cylinder, int row) {
    std::string table = cylinder ? "x,y,z\n" : "x,y\n";
    for (int i = 0; i < 72; ++i) {
      const double t = (cylinder ? 20.0 : 5.0) * i * kPi / 180.0;
      const double r = 20.0 + 2e-3 * std::cos(2.0 * t) + (i == row ? 0.3 : 0.0);
      table += fmt::format("{:.9f},{:.9f}", r * std::cos(t), r * std::sin(t));
      table += cylinder ? fmt::format(",{}\n", i / 18 * 10) : "\n";
    }
    return table;
  };
  for (const char* shape : {"circle", "cylinder"}) {
    SCOPED_TRACE(shape);
    const bool cylinder = shape == std::string("cylinder");
    write(folder / "dirt.csv", table_of(cylinder, 41));
    const Outcome outcome = rondure({"fit", shape, folder / "dirt.csv"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("point 41 lies +2"), HasSubstr("; it carries 29"),
                                   HasSubstr("[outliers]")));
    write(folder / "clean.csv", table_of(cylinder, -1));
    EXPECT_THAT(rondure({"fit", shape, folder / "clean.csv"}).out, Not(HasSubstr("lies")));
  }
}

TEST(FitData, AHundredThousandPointsGiveThePlantedForm) {
  const Planted part;
  const double zone_mm = 2.0 * (part.amplitude_mm + part.noise_mm);
  for (const bool cylinder : {false, true}) {
    SCOPED_TRACE(cylinder);
    const Scratch folder;
    write(folder / "points.csv", planted_points(part, cylinder, 100'000));
    const Outcome outcome =
        rondure({"fit", cylinder ? "cylinder" : "circle", folder / "points.csv", "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto fit = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(fit["points"], 100'000);
    const double mz = fit["mz"]["deviation_mm"];
    EXPECT_LE(mz, zone_mm);         // the planted axis is one candidate
    EXPECT_GT(mz, 0.97 * zone_mm);  // and no other is much better: extremes lie densely
    EXPECT_LE(mz, fit["ls"]["deviation_mm"].get<double>());
    EXPECT_NEAR(fit["ls"]["radius_mm"], part.radius_mm, 1e-4);
  }
}

}  // namespace
}  // namespace rondure::app::testing
