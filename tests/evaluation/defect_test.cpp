// Results that break an invariant: found, never printed, kept for a bug report.

#include "evaluation/defect.h"

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "core/version.h"
#include "evaluation/evaluate.h"
#include "record/files.h"
#include "tests/core/scratch.h"
#include "tests/evaluation/points_run.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

evaluation::FeatureResult sound_result() {
  const auto out = evaluate(points_run(rough_part(5, 4, 15, core::kTwoPi), 4));
  EXPECT_TRUE(out) << (out ? "" : out.error().what);
  return out ? out->features.at(0) : evaluation::FeatureResult{};
}

TEST(Invariants, HoldForResultsThatAreSound) {
  EXPECT_FALSE(broken_invariant(sound_result()).has_value());
}

TEST(Invariants, EveryBrokenRuleIsFoundByItsName) {
  struct Break {
    std::string rule;
    std::function<void(evaluation::FeatureResult&)> how;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Break> breaks = {
      {"MZCY <= LSCY", [](auto& r) { r.ls_cylinder->deviation_mm *= 0.5; }},
      {"MZCY <= LSCY", [&](auto& r) { r.ls_cylinder->deviation_mm = nan; }},
      {"MZCY <= MCCY", [](auto& r) { r.mc_cylinder->deviation_mm *= 0.5; }},
      {"MZCY <= MICY", [](auto& r) { r.mi_cylinder->deviation_mm *= 0.5; }},
      {"certificate of MZCY", [](auto& r) { r.mz_cylinder->outer_radius_mm -= 1e-6; }},
      {"certificate of MZCY", [](auto& r) { r.mz_cylinder->axis.point_mm.x() += 1e-4; }},
      {"certificate of MCCY", [](auto& r) { r.mc_cylinder->radius_mm -= 1e-6; }},
      {"certificate of MCCY", [](auto& r) { r.mc_cylinder->contacts.front().multiplier += 1e-3; }},
      {"certificate of MICY", [](auto& r) { r.mi_cylinder->radius_mm += 1e-6; }},
      {"certificate of MICY", [](auto& r) { r.mi_cylinder->contacts.front().index = 1000; }},
      {"MZCI <= LSCI, layer 2", [](auto& r) { r.layers[1].ls->deviation_mm *= 0.5; }},
      {"MZCI <= MCCI, layer 3", [](auto& r) { r.layers[2].mc->deviation_mm *= 0.5; }},
      {"MZCI <= MICI, layer 4", [](auto& r) { r.layers[3].mi->deviation_mm *= 0.5; }},
      {"certificate of MZCI, layer 1", [](auto& r) { r.layers[0].mz->center_mm.x() += 1e-4; }},
      {"certificate of MCCI, layer 2", [](auto& r) { r.layers[1].mc->center_mm.y() += 1e-4; }},
      {"certificate of MICI, layer 3", [](auto& r) { r.layers[2].mi->radius_mm += 1e-6; }},
      // Radii of references that are the best of all; their witness is made to hold.
      {"radius of MCCI <= outer radius of MZCI, layer 1",
       [](auto& r) {
         r.layers[0].mz->certificate.kind = fit::Certificate::Kind::kNone;
         r.layers[0].mz->outer_radius_mm = r.layers[0].mc->radius_mm - 1e-6;
       }},
      {"inner radius of MZCI <= radius of MICI, layer 1",
       [](auto& r) {
         r.layers[0].mi->certificate.kind = fit::Certificate::Kind::kGlobal;
         r.layers[0].mz->certificate.kind = fit::Certificate::Kind::kNone;
         r.layers[0].mz->inner_radius_mm = r.layers[0].mi->radius_mm + 1e-6;
       }},
      // Without a certificate there is no witness, but the relations stay.
      {"RONt <= CYLt, layer 1",
       [](auto& r) {
         auto& zone = *r.layers[0].mz;
         zone.certificate.kind = fit::Certificate::Kind::kNone;
         zone.outer_radius_mm += 1.0;
         for (double* other : {&r.layers[0].ls->deviation_mm, &r.layers[0].mc->deviation_mm,
                               &r.layers[0].mi->deviation_mm})
           *other += 1.0;
       }},
  };
  for (const Break& b : breaks) {
    SCOPED_TRACE(b.rule);
    evaluation::FeatureResult result = sound_result();
    b.how(result);
    const auto broken = broken_invariant(result);
    ASSERT_TRUE(broken.has_value());
    EXPECT_EQ(broken->rule, b.rule);
    EXPECT_THAT(broken->found, ::testing::Not(IsEmpty()));
  }
}

class DefectFile : public ::testing::Test {
 protected:
  test::Scratch scratch;
  fs::path folder = scratch.path();
};

TEST_F(DefectFile, HoldsTheRuleAllNumbersAndThePoints) {
  evaluation::FeatureResult result = sound_result();
  result.mi_cylinder->radius_mm += 1e-6;
  result.layers[2].mi = core::fail(core::Code::kReferenceAbsent, "a reason");
  const evaluation::Defect defect{*broken_invariant(result), result};
  const auto header = points_run({}, 1).header;
  ASSERT_TRUE(keep_defects({defect, defect}, header, folder, "this processor"));
  const core::Error error = error_of(defect);
  EXPECT_EQ(error.code, core::Code::kInternal);
  EXPECT_EQ(error.where, "land");
  EXPECT_THAT(error.what, HasSubstr("certificate of MICY"));
  EXPECT_THAT(error.what, HasSubstr("report it with defect.txt"));
  const std::string text = *record::read_file(folder / "defect.txt");
  const std::string dump = dump_of(defect, header, "this processor");
  EXPECT_EQ(text, dump + dump);
  for (const std::string& line :
       {fmt::format("version = {}", core::kVersion), std::string("processor = this processor"),
        std::string("measured_by_version = 0.0.7"), std::string("feature = land"),
        std::string("rule = certificate of MICY"), "found = " + defect.broken.found,
        fmt::format("radius_mm = {:.17g}", result.mi_cylinder->radius_mm),
        fmt::format("outer_radius_mm = {:.17g}", result.mz_cylinder->outer_radius_mm),
        fmt::format("deviation_mm = {:.17g}", result.layers[3].mc->deviation_mm)}) {
    EXPECT_THAT(text, HasSubstr(line + "\n"));
  }
  EXPECT_THAT(text, HasSubstr("[layer 3 MICI]\nabsent = "));
  for (std::size_t i = 0; i < result.cloud.size(); ++i) {
    const Eigen::Vector3d& p = result.cloud[i].tip_mm;
    EXPECT_THAT(text,
                HasSubstr(fmt::format("{} = {:.17g} {:.17g} {:.17g}\n", i, p.x(), p.y(), p.z())));
  }
}

TEST_F(DefectFile, ThatCannotBeWrittenLeavesTheJournalAsEvidence) {
  evaluation::FeatureResult result = sound_result();
  result.ls_cylinder->deviation_mm = 0.0;
  const evaluation::Defect defect{*broken_invariant(result), result};
  const auto kept = keep_defects({defect}, {}, folder / "nowhere" / "at all", "this processor");
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().code, core::Code::kInternal);
  EXPECT_THAT(kept.error().what, HasSubstr("journal.db"));
  EXPECT_THAT(kept.error().what, HasSubstr("could not be written"));
  EXPECT_THAT(kept.error().what, HasSubstr("MZCY <= LSCY"));
}

TEST_F(DefectFile, IsNotWrittenForASoundRun) {
  const auto checked =
      evaluation::evaluate_checked(points_run(rough_part(6, 3, 9, core::kTwoPi), 3));
  EXPECT_TRUE(keep_defects(checked.defects, {}, folder, "this processor"));
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace rondure::reports
