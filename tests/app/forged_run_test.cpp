// Runs that somebody changed on purpose. What a signature covers cannot be replaced from beside it;
// nothing in a journal is run; and where digests were made again so that they fit, the program ends
// in a sentence.

#include <algorithm>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/checksums.h"
#include "record/journal/journal.h"
#include "record/sha256.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/record/meddle.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class ForgedRun : public ::testing::Test {
 protected:
  /// Runs the axle of example 09, 38.2 um out of round, under another tolerance.
  [[nodiscard]] fs::path run_axle(const std::string& name, int tolerance_um) const {
    auto plan = example_plan("09_axle_points_file");
    leave_out_intervals(plan);
    plan["features"][0]["characteristics"][0]["tolerance_um"] = tolerance_um;
    write(folder_ / (name + ".json"), plan.dump());
    (void)rondure({"run", folder_ / (name + ".json"), "--out", folder_ / name, "--serial", name});
    return folder_ / name;
  }
  void sign(const fs::path& run) const {
    const std::string place = "cd '" + folder_.path().string() + "' && openssl ";
    ASSERT_EQ(std::system((place + "genpkey -algorithm ed25519 -out key.pem").c_str()), 0);
    ASSERT_EQ(std::system((place + "pkey -in key.pem -pubout -out public.pem").c_str()), 0);
    ASSERT_EQ(rondure({"sign", run, "--key", folder_ / "key.pem"}).status, 0);
  }
  [[nodiscard]] Outcome verify_signed(const fs::path& run) const {
    return rondure({"verify", run, "--key", folder_ / "public.pem"});
  }

  Scratch folder_;
};

TEST_F(ForgedRun, ALogBesideASignedJournalReplacesNothing) {
  const fs::path bad = run_axle("bad", 20);
  const fs::path good = run_axle("good", 100);
  sign(bad);
  EXPECT_THAT(verify_signed(bad).out, StartsWith("equal: part EMU-AXLE-3, serial bad, does not "));
  const std::string report_json = read(bad / "report.json");
  const std::vector<std::pair<std::string, std::string>> logs = {
      {"journal.db-wal", record::log_that_replaces(bad / "journal.db", good / "journal.db")},
      {"journal.db-journal", record::rollback_to(good / "journal.db")}};
  for (const auto& [name, bytes] : logs) {
    SCOPED_TRACE(name);
    write(bad / name, bytes);
    const std::string named = "not equal: " + name + ": it stands beside the closed journal";
    for (const Outcome& outcome : {rondure({"verify", bad}), verify_signed(bad)}) {
      EXPECT_EQ(outcome.status, 1);
      EXPECT_THAT(outcome.out, AllOf(HasSubstr(named), Not(HasSubstr("report.json"))));
    }
    const std::vector<std::vector<std::string>> readers = {
        {"report", bad},
        {"compare", bad},
        {"history", folder_ / "archive.db", "--add", bad},
        {"sign", bad, "--key", folder_ / "key.pem"},
        {"run", bad, "--resume"},
        {"run", folder_ / "bad.json", "--out", bad, "--serial", "bad", "--resume"}};
    for (const auto& words : readers) {
      SCOPED_TRACE(words.front());
      const Outcome outcome = rondure(words);
      EXPECT_NE(outcome.status, 0);
      EXPECT_THAT(outcome.err, HasSubstr(name));
      EXPECT_THAT(outcome.out, Not(HasSubstr("conform")));
    }
    EXPECT_EQ(read(bad / "report.json"), report_json);
    EXPECT_EQ(read(bad / name), bytes);
    fs::remove(bad / name);
    EXPECT_EQ(verify_signed(bad).status, 0);
  }
  // Without the list nothing is signed, and the log is still not applied.
  write(bad / "journal.db-wal", logs.front().second);
  fs::remove(bad / "SHA256SUMS");
  const Outcome outcome = verify_signed(bad);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("not equal: journal.db-wal"),
                                 HasSubstr("the run is not signed: there is no SHA256SUMS")));
  EXPECT_NE(rondure({"run", bad, "--resume"}).status, 0);
  EXPECT_FALSE(fs::exists(bad / "SHA256SUMS"));
}

TEST_F(ForgedRun, AReportOfAMillionBracketsIsADifference) {
  const fs::path run = run_axle("deep", 100);
  sign(run);
  const std::string report = read(run / "report.json");
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  const std::string told = "the text is nested deeper than 64 levels, from byte 65 on";
  write(run / "report.json", deep);
  const Outcome verified = rondure({"verify", run});
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out, HasSubstr("report.json: " + told));
  const Outcome refused = rondure({"sign", run, "--key", folder_ / "key.pem"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr(told));
  write(run / "report.json", report);
  write(run / "earlier.json", "{\"results\": " + deep + "}");
  EXPECT_THAT(rondure({"verify", run}).out, HasSubstr("the text is nested deeper than 64 levels"));
  write(run / "earlier.json", "{\"results\": [{\"run_id\": 7}]}");
  EXPECT_THAT(rondure({"verify", run}).out,
              AllOf(HasSubstr("a key of number 1 is missing, or has a value of another kind"),
                    Not(HasSubstr("json.exception"))));
}

TEST_F(ForgedRun, AnotherJournalInPlaceOfTheListedOneIsRefused) {
  const fs::path bad = run_axle("bad", 20);
  const fs::path good = run_axle("good", 100);
  fs::copy_file(good / "journal.db", bad / "journal.db", fs::copy_options::overwrite_existing);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"report", bad},
        {"compare", bad},
        {"run", bad, "--resume"},
        {"history", folder_ / "archive.db", "--add", bad}}) {
    const Outcome outcome = rondure(words);
    EXPECT_NE(outcome.status, 0) << words.front();
    EXPECT_THAT(outcome.err, HasSubstr("journal.db is not the file that SHA256SUMS names"));
  }
  EXPECT_THAT(rondure({"verify", bad}).out, HasSubstr("not equal: journal.db: its bytes were "));
}

TEST_F(ForgedRun, ASignedFileThatIsAbsentIsADifference) {
  const fs::path run = run_axle("run", 100);
  sign(run);
  for (const char* file : {"report.html", "report.json", "touches.csv", "results.csv"}) {
    const std::string bytes = read(run / file);
    fs::remove(run / file);
    const Outcome outcome = verify_signed(run);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.out,
              "not equal: " + std::string(file) + ": it is not there, and SHA256SUMS names it\n");
    EXPECT_EQ(rondure({"verify", run}).status, 0);
    write(run / file, bytes);
  }
  write(run / "earlier.json", "{}");
  EXPECT_THAT(verify_signed(run).out, HasSubstr("earlier.json: it is not signed"));
}

// A report takes them into its run charts; the digest was made again.
TEST_F(ForgedRun, EarlierResultsThatCannotBeAreADifference) {
  (void)run_axle("one", 100);
  const fs::path run = run_axle("two", 100);
  const std::string good = read(run / "earlier.json");
  const auto part = good.find("EMU-AXLE-3");
  ASSERT_NE(part, std::string::npos);
  const auto verify_with = [&](const std::string& text) {
    write(run / "earlier.json", text);
    EXPECT_TRUE(record::update_checksums(run, {{"earlier.json", record::sha256_hex(text)}}));
    (void)rondure({"report", run, "--format", "html"});
    return rondure({"verify", run});
  };
  EXPECT_EQ(verify_with(good).status, 0);
  const Outcome other = verify_with(std::string(good).replace(part, 3, "ICE"));
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.out, HasSubstr("not equal: earlier.json: result 1 is of part ICE-AXLE-3 in "
                                   "place of EMU-AXLE-3"));
  const std::string key = "\"started_utc\": \"";
  std::string later = good;
  later.replace(later.find(key) + key.size(), 4, "2999");
  EXPECT_THAT(verify_with(later).out, HasSubstr("earlier.json: result 1 is of no earlier run"));
}

TEST_F(ForgedRun, ATriggerInAnInterruptedJournalIsRefusedByName) {
  write_plan(folder_ / "plan.json", {});
  ASSERT_EQ(rondure({"run", folder_ / "plan.json", "--out", folder_ / "whole", "--quiet"}).status,
            0);
  const record::RunRecord whole = journal_of(folder_ / "whole");
  const fs::path run = folder_ / "run";
  {
    auto journal =
        record::Journal::create(run, whole.header, whole.artefact, whole.features, whole.settings);
    ASSERT_TRUE(journal);
    for (std::size_t i = 0; i < 5; ++i) ASSERT_TRUE(journal->add(whole.touches[i]));
  }
  record::meddle(run / "journal.db",
                 "create trigger smooth after insert on touch begin update touch set tip_x_mm = "
                 "round(tip_x_mm, 2) where id = new.id; end");
  const std::string bytes = read(run / "journal.db");
  const std::vector<std::vector<std::string>> verbs = {
      {"run", run, "--resume"},
      {"run", folder_ / "plan.json", "--out", run, "--resume"},
      {"verify", run},
      {"report", run},
      {"compare", run}};
  for (const auto& words : verbs) {
    const Outcome outcome = rondure(words);
    EXPECT_EQ(outcome.status, 2) << words.front();
    EXPECT_THAT(outcome.err, HasSubstr("it holds the trigger \"smooth\" on table \"touch\""));
  }
  EXPECT_EQ(read(run / "journal.db"), bytes);
}

TEST_F(ForgedRun, NothingIsComputedBehindABrokenChain) {
  const fs::path run = folder_ / "run";
  fs::copy(example_runs() / "07_crank_pin", run);
  const std::string bytes = read(run / "journal.db");
  for (const char* sql :
       {"update series set name = 'x' where id = 1", "update setting set name = 'x' where id = 3",
        "update setting set number = 2147483647.0 / 3 where name = 'samples'"}) {
    SCOPED_TRACE(sql);
    write(run / "journal.db", bytes);
    record::meddle(run / "journal.db", sql);
    const Outcome outcome = rondure({"verify", run});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("was changed after it was written"), Not(HasSubstr("report.json:")),
                      HasSubstr("note: nothing was computed from a journal that is not as it was "
                                "written")));
  }
}

TEST_F(ForgedRun, AChangedPlanInTheJournalIsTold) {
  const fs::path run = run_axle("run", 100);
  record::RunRecord told = journal_of(run);
  told.header.plan_text.replace(told.header.plan_text.find("EMU"), 3, "ICE");
  write_resealed(told, folder_ / "changed");
  const Outcome outcome = rondure({"verify", folder_ / "changed"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("the plan in it is not the one that was measured"));
}

TEST_F(ForgedRun, AnotherVersionAndAMissingListAreSaid) {
  const fs::path run = run_axle("run", 100);
  record::RunRecord told = journal_of(run);
  told.header.version = "0.0.9";
  write_resealed(told, folder_ / "changed");
  fs::remove(folder_ / "changed/SHA256SUMS");
  const Outcome outcome = rondure({"verify", folder_ / "changed"});
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  EXPECT_THAT(outcome.out, AllOf(StartsWith("equal: part EMU-AXLE-3, serial run, conforms: 24 "),
                                 HasSubstr("\nnote: version 0.0.9 measured, this is version "),
                                 HasSubstr("\nnote: there is no SHA256SUMS, which the run wrote")));
}

/// A change of a record whose digests are made again, and what the program must say of it.
struct Resealed {
  const char* example;
  std::function<void(record::RunRecord&)> change;
  const char* told;
};

TEST_F(ForgedRun, WithDigestsMadeAgainEndsInASentence) {
  const auto rename_series = [](const char* from, const char* to) {
    return [=](record::RunRecord& run) {
      for (record::Series& series : run.series) {
        if (series.name == from) series.name = to;
      }
    };
  };
  const auto set = [](const char* name, double number) {
    return [=](record::RunRecord& run) {
      for (auto* settings : {&run.settings, &run.features.front().settings}) {
        for (record::Setting& setting : *settings) {
          if (setting.name == name) setting.number = number;
        }
      }
    };
  };
  const auto rename = [](const char* from, const char* to) {
    return [=](record::RunRecord& run) {
      for (record::Setting& setting : run.features.front().settings) {
        if (setting.name == from) setting.name = to;
      }
    };
  };
  const std::vector<Resealed> cases = {
      {"05_spindle_three_probe", rename_series("data", "x"), "series \"x\" is none of a spindle"},
      {"05_spindle_three_probe", set("samples", 1e9), "\"samples\" is 1e+09, its plan says 1024"},
      {"05_spindle_three_probe", rename("layout", "x"),
       "\"x\" stands where its plan has \"layout\""},
      {"05_spindle_three_probe",
       [](auto& run) {
         run.features.front().settings.push_back({"x", 1.0, {}});
       },
       "\"x\" is not of its plan"},
      {"05_spindle_three_probe",
       [](auto& run) {
         std::erase_if(run.settings, [](const record::Setting& setting) {
           return setting.name == "decision_rule/measurand";
         });
       },
       "stands where its plan has \"decision_rule/measurand\""},
      {"05_spindle_three_probe", [](auto& run) { run.series.front().columns.front().name = "x"; },
       "has no column alpha_deg"},
      {"05_spindle_three_probe", [](auto& run) { run.series.clear(); }, "series are missing"},
      {"06_wheel", set("nominal_radius_mm", -5.0), "\"nominal_radius_mm\" is -5, its plan says 50"},
      {"06_wheel", set("surface/step_mm", -1.0), "\"surface/step_mm\" is -1, its plan says 0.1"},
      {"07_crank_pin", rename_series("pin 2", "pin 9"), "series \"pin 2\" is missing"},
      {"07_crank_pin", rename_series("axes 1", "x"), "series \"x\" is none of a contour"},
      {"07_crank_pin",
       [](auto& run) {
         run.features.front().characteristics.front().form = record::Form::kHarmonicLimits;
         run.features.front().characteristics.front().harmonic_limits = {{2, 2147483647, 0.001}};
       },
       "\"the form\" is \"harmonic-limits\", its plan says \"contour-deviation\""},
      {"03_calibrate_fixture", rename("balls/id", "x"),
       "\"x\" stands where its plan has \"balls/id\""},
      {"03_calibrate_fixture",  // the same settings, as items of other balls
       [](auto& run) {
         std::ranges::stable_sort(run.features.front().settings, {}, &record::Setting::name);
       },
       "stands where its plan has"},
      {"03_inspect_calibrated", set("fixture/max_residual_um", 1e5),
       "\"fixture/max_residual_um\" is 100000, its plan says "},
      {"03_inspect_calibrated", set("fixture/axis_point_mm", 1e5),
       "\"fixture/axis_point_mm\" is 100000, its plan says "},
      {"01_spool_simulated",
       [](auto& run) {
         run.settings.push_back({"head/x", std::nullopt, "y"});
       },
       "\"head/x\" is not of its plan"},
      {"03_calibrate_fixture", [](auto& run) { run.touches.back().layer = 17; },
       "layer 17 is none of its feature"},
      {"09_axle_points_file", set("uncertainty/most_trials", 1e9),
       "\"uncertainty/most_trials\" is 1e+09, its plan says"},
      {"09_axle_points_file", [](auto& run) { run.header.decision_rule = "simple-acceptance"; },
       "\"the decision rule\" is \"simple-acceptance\", its plan says \"n-to-1\""},
      {"09_axle_points_file", [](auto& run) { run.features.front().layers = -1; }, "-1 layers of "},
      {"09_axle_points_file",
       [](auto& run) { run.features.front().characteristics.front().tolerance_mm = 1.0; },
       "\"the upper limit in mm\" is 1, its plan says 0.0"},
      {"09_axle_points_file",  // what another version may leave out are settings
       [](auto& run) {
         run.header.version = "0.0.9";
         run.features.front().characteristics.front().tolerance_mm.reset();
       },
       "stands where its plan has \"the upper limit in mm\""},
      {"09_axle_points_file", [](auto& run) { run.features.front().characteristics.clear(); },
       "stands where its plan has \"the characteristic\""},
      {"07_crank_pin",
       [](auto& run) {
         run.features.front().characteristics.back().harmonic_limits.front().amplitude_mm = 1.0;
       },
       "\"the mask in mm\" is 1, its plan says"},
      {"01_spool_simulated", [](auto& run) { run.artefact.form_limit_mm = 1.0; },
       "\"the limit of the probing form in mm\" is 1, its plan says"},
      {"01_spool_simulated", [](auto& run) { run.touches.back().approach *= 1e8; },
       "its direction has the length 1e+08, not 1"},
      {"01_spool_simulated", [](auto& run) { run.touches.back().layer = 2147483647; },
       "are outside 0..100000000"},
      {"01_spool_simulated", [](auto& run) { run.touches.back().pose = 4711; },
       "pose 4711 is not there"},
      {"01_spool_simulated", [](auto& run) { run.features.front().points_per_layer = 2147483647; },
       "\"the points of a layer\" is 2.14748e+09"},
      {"13_pose_search_virtual",
       [](auto& run) { run.features.front().search_steps_deg.front() = 1e-300; },
       "\"the search step in deg\" is 1e-300"},
      {"01_spool_simulated", [](auto& run) { run.features.front().shape = record::Shape::kWheel; },
       "\"the shape\" is \"wheel\", its plan says \"cylinder\""},
  };
  for (const Resealed& c : cases) {
    SCOPED_TRACE(std::string(c.example) + ": " + c.told);
    record::RunRecord told = journal_of(example_runs() / c.example);
    c.change(told);
    fs::remove_all(folder_ / "forged");
    write_resealed(told, folder_ / "forged");
    const Outcome verified = rondure({"verify", folder_ / "forged"});
    EXPECT_EQ(verified.status, 1);
    EXPECT_THAT(verified.out, AllOf(StartsWith("not equal: the journal does not hold what its "
                                               "evaluation asks for: "),
                                    HasSubstr(c.told)));
    const Outcome reported = rondure({"report", folder_ / "forged"});
    EXPECT_EQ(reported.status, 2);
    EXPECT_THAT(reported.err, HasSubstr(c.told));
    EXPECT_NE(rondure({"history", folder_ / "archive.db", "--add", folder_ / "forged"}).status, 0);
  }
}

}  // namespace
}  // namespace rondure::app::testing
