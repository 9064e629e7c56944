#include "plans/checks/internal/plan_checks.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "core/utc.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/calibration_use.h"
#include "plans/checks/laboratory.h"
#include "plans/schema/json_text.h"
#include "record/archive/place.h"
#include "record/files.h"

namespace rondure::plans {
namespace {

using core::Code;

void check_travel(double min_deg, double max_deg, std::string_view axis, Findings& findings) {
  const std::string lower = fmt::format("/fixture/min_{}_deg", axis);
  if (!findings.sound(lower) || !findings.sound(fmt::format("/fixture/max_{}_deg", axis))) return;
  if (min_deg >= max_deg) {
    findings.meaning(Code::kMeaning, lower,
                     fmt::format("the lower limit {} deg is not below the upper limit {} deg; "
                                 "exchange or correct them",
                                 plain(min_deg), plain(max_deg)));
  } else if (min_deg > 0.0 || max_deg < 0.0) {
    findings.meaning(
        Code::kPoseRange, lower,
        fmt::format("the travel {}..{} deg leaves out 0 deg, the pose where the fixture "
                    "starts; widen it",
                    plain(min_deg), plain(max_deg)));
  }
}

void check_environment(const Plan& plan, Findings& findings) {
  if (!plan.environment || !findings.sound("/environment")) return;
  const EnvironmentPlan& environment = *plan.environment;
  const double assumed_degC = environment.assumed_degC.value_or(environment.min_degC);
  if (environment.min_degC < environment.max_degC) {
    if (assumed_degC >= environment.min_degC && assumed_degC <= environment.max_degC) return;
    findings.meaning(
        Code::kMeaning, "/environment/assumed_degC",
        fmt::format("{} degC is outside the limits {}..{} degC of this plan; every result would "
                    "be void",
                    plain(assumed_degC), plain(environment.min_degC), plain(environment.max_degC)));
    return;
  }
  findings.meaning(Code::kMeaning, "/environment",
                   fmt::format("min_degC {} is not below max_degC {}; every temperature would make "
                               "the result void",
                               plain(environment.min_degC), plain(environment.max_degC)));
}

void check_stylus(const ProbePlan& probe, Findings& findings) {
  if (!findings.sound("/probe")) return;
  const bool long_enough = probe.stylus_length_mm > 0.0;
  if (long_enough != (probe.stylus_diameter_mm > 0.0)) {
    findings.meaning(Code::kMeaning, "/probe/stylus_length_mm",
                     "length and diameter of the stylus belong together; give both, or neither");
  } else if (!long_enough && probe.holder_diameter_mm > 0.0) {
    findings.meaning(Code::kMeaning, "/probe/holder_diameter_mm",
                     "where the holder begins is not known; give stylus_length_mm and "
                     "stylus_diameter_mm");
  } else if (long_enough && probe.stylus_diameter_mm >= probe.tip_diameter_mm) {
    findings.meaning(Code::kMeaning, "/probe/stylus_diameter_mm",
                     fmt::format("a shaft of {} mm is not thinner than the ball of {} mm: it would "
                                 "touch first; correct one of them",
                                 plain(probe.stylus_diameter_mm), plain(probe.tip_diameter_mm)));
  }
}

void check_ends(const DiscPlan& disc, const std::string& where, Findings& findings) {
  if (disc.from_mm < disc.to_mm || !findings.sound(where)) return;
  findings.meaning(Code::kMeaning, where + "/from_mm",
                   fmt::format("the lower end {} mm is not below the upper end {} mm; exchange "
                               "or correct them",
                               plain(disc.from_mm), plain(disc.to_mm)));
}

void check_sections(const PartPlan& part, Findings& findings) {
  if (part.held) check_ends(*part.held, "/part/held", findings);
  for (std::size_t i = 0; i < part.sections.size(); ++i) {
    const std::string where = item_pointer("/part/sections", i);
    if (!findings.sound(where)) continue;
    const SectionPlan& s = part.sections[i];
    check_ends(s, where, findings);
    if (s.bore_diameter_mm >= s.diameter_mm) {
      findings.meaning(Code::kMeaning, where + "/bore_diameter_mm",
                       fmt::format("a hole of {} mm leaves nothing of a section of {} mm; correct "
                                   "one of them",
                                   plain(s.bore_diameter_mm), plain(s.diameter_mm)));
    }
  }
}

void check_datum(const Plan& plan, Findings& findings) {
  const FixturePlan& fixture = *plan.fixture;
  if (!fixture.datum || !findings.sound("/fixture/datum")) return;
  if (fixture.datum->on_holes()) return check_datum_holes(plan, findings);
  const std::size_t spheres = fixture.datum->spheres.size();
  if (spheres >= 3) return;
  findings.meaning(
      Code::kTooFewPoints, "/fixture/datum/spheres",
      fmt::format("{} spheres do not tell where the base is; at least 3 are needed, or holes "
                  "and a seat",
                  spheres));
}

void check_archive(const Plan& plan, Findings& findings) {
  constexpr std::string_view kWhere = "/reports/archive";
  const std::string& archive = plan.reports.archive;
  if (archive.empty() || !findings.sound(kWhere)) return;
  const auto place = record::parse_archive_place(archive, plan.folder);
  if (!place) {
    findings.meaning(place.error().code, std::string(kWhere), place.error().what);
  } else if (place->has_password()) {
    findings.meaning(Code::kMeaning, std::string(kWhere),
                     "the URL holds a password, which every report of the plan would show; take it "
                     "out and put it into ~/.pgpass");
  }
}

void check_needs(const Plan& plan, std::size_t touched, Findings& findings) {
  constexpr std::array<std::string_view, 3> kNeeded = {"/machine", "/fixture", "/probe"};
  for (const std::string_view section : kNeeded) {
    const bool stands = section == "/fixture" && plan.fixture;  // without one
    if (stands || findings.is_given(std::string(section))) continue;
    findings.meaning(
        Code::kMissingKey, std::string(section),
        fmt::format("this key is missing: feature {} is touched by the machine; add it, or "
                    "give the feature a \"source\" file",
                    touched + 1));
  }
  const bool simulated =
      (plan.machine && plan.machine->driver == MachinePlan::Driver::kSimulated) ||
      (plan.fixture && plan.fixture->driver == FixturePlan::Driver::kSimulated);
  if (simulated && !findings.is_given("/simulation")) {
    findings.meaning(
        Code::kMissingKey, "/simulation",
        "this key is missing: the driver is \"simulated\"; say what is simulated, {} is "
        "a typical part on a typical machine");
  }
}

/// Checks the settings of the driver "zaber", and that no other driver has settings that it
/// ignores.
void check_zaber(const FixturePlan& fixture, Findings& findings) {
  constexpr std::string_view kWhere = "/fixture/zaber";
  const bool is_zaber = fixture.driver == FixturePlan::Driver::kZaber;
  if (!is_zaber && findings.is_given(std::string(kWhere))) {
    findings.meaning(
        Code::kMeaning, std::string(kWhere),
        fmt::format("has no effect: the driver is \"{}\"; remove it", name_of(fixture.driver)));
  }
  if (!is_zaber || !findings.sound(kWhere)) return;
  const ZaberPlan stages = fixture.zaber.value_or(ZaberPlan{});
  if (stages.connection == ZaberPlan::Connection::kSerial && stages.device.empty()) {
    findings.meaning(Code::kMissingKey, "/fixture/zaber/device",
                     "this key is missing: the connection is \"serial\"; give its device, e.g. "
                     "\"/dev/ttyUSB0\"");
  }
  const int alpha = stages.alpha.axis == 0 ? 1 : stages.alpha.axis;
  const int beta = stages.beta.axis == 0 ? 2 : stages.beta.axis;
  if (alpha == beta) {
    findings.meaning(Code::kMeaning, "/fixture/zaber/beta/axis",
                     fmt::format("axis {} turns alpha already; give beta another one", beta));
  }
}

/// Checks the drivers of machine and fixture together: both are simulated here, or neither. A
/// fixture with its own driver, or set by hand, works with either.
void check_drivers(const Plan& plan, Findings& findings) {
  if (!plan.machine || !plan.fixture || !findings.sound("/machine/driver") ||
      !findings.sound("/fixture/driver")) {
    return;
  }
  const std::string_view machine = name_of(plan.machine->driver);
  const std::string_view fixture = name_of(plan.fixture->driver);
  if (!is_fixed(plan)) check_zaber(*plan.fixture, findings);
  const bool of_machine = plan.fixture->driver == FixturePlan::Driver::kSimulated ||
                          plan.fixture->driver == FixturePlan::Driver::kIppdme;
  if (!of_machine || machine == fixture) return;
  findings.meaning(Code::kMeaning, "/fixture/driver",
                   fmt::format("a fixture \"{}\" cannot carry a part in front of a machine \"{}\"; "
                               "give both the same driver",
                               fixture, machine));
}

/// Checks a section that one driver needs and no other reads.
void check_driver_section(const FixturePlan& fixture, FixturePlan::Driver driver,
                          std::string_view key, bool given, std::string_view what,
                          Findings& findings) {
  const std::string where = fmt::format("/fixture/{}", key);
  if (fixture.driver == driver && !given && !findings.is_given(where)) {
    findings.meaning(
        Code::kMissingKey, where,
        fmt::format("this key is missing: the driver is \"{}\"; say {}", name_of(driver), what));
  }
  if (fixture.driver != driver && given) {
    findings.meaning(
        Code::kMeaning, where,
        fmt::format("has no effect: the driver is not \"{}\"; remove it", name_of(driver)));
  }
}

void check_thorlabs_axis(const ThorlabsAxisPlan& axis, const std::string& where,
                         Findings& findings) {
  if (!findings.sound(where)) return;
  const bool complete =
      axis.counts_per_deg && axis.velocity_per_deg_s && axis.acceleration_per_deg_s2;
  if (axis.stage == ThorlabsAxisPlan::Stage::kOther && !complete) {
    findings.meaning(Code::kMissingKey, where + "/counts_per_deg",
                     "this key is missing: of the stage \"other\" counts_per_deg, "
                     "velocity_per_deg_s and acceleration_per_deg_s2 must be given");
  }
  if (axis.stage != ThorlabsAxisPlan::Stage::kOther && findings.is_given(where + "/motor")) {
    findings.meaning(Code::kMeaning, where + "/motor",
                     "has no effect: the stage is not \"other\"; remove it");
  }
}

/// Checks the driver-specific sections.
void check_driver_sections(const FixturePlan& fixture, Findings& findings) {
  if (!findings.sound("/fixture/driver")) return;
  check_driver_section(fixture, FixturePlan::Driver::kThorlabs, "thorlabs",
                       fixture.thorlabs.has_value(), "which unit turns which axis", findings);
  check_driver_section(fixture, FixturePlan::Driver::kManual, "reached_pose",
                       fixture.reached_pose.has_value(), "on which spheres the pose is measured",
                       findings);
  if (fixture.thorlabs) {
    check_thorlabs_axis(fixture.thorlabs->alpha, "/fixture/thorlabs/alpha", findings);
    check_thorlabs_axis(fixture.thorlabs->beta, "/fixture/thorlabs/beta", findings);
    if (!fixture.thorlabs->alpha.serial.empty() &&
        fixture.thorlabs->alpha.serial == fixture.thorlabs->beta.serial) {
      findings.meaning(Code::kMeaning, "/fixture/thorlabs/beta/serial",
                       "one unit cannot turn both axes; give the serial number of the other one");
    }
  }
  if (fixture.reached_pose && findings.sound("/fixture/reached_pose") &&
      fixture.reached_pose->spheres.size() < 2) {
    findings.meaning(Code::kTooFewPoints, "/fixture/reached_pose/spheres",
                     "1 sphere does not tell two angles; at least 2 are needed, 3 are better");
  }
}

// Checks for keys of a feature that would be ignored.
void check_without_effect(const FeaturePlan& feature, const std::string& where,
                          Findings& findings) {
  const auto refuse = [&](const std::string& key, std::string_view why) {
    if (!findings.is_given(where + key)) return;
    findings.meaning(Code::kMeaning, where + key, fmt::format("has no effect: {}; remove it", why));
  };
  if (analysis_kind(feature.type) != nullptr) return;  // check_analysis() reports these
  refuse("/spindle", "the feature is touched, not probed by three probes");
  refuse("/wheel", "the feature is no wheel");
  refuse("/contour", "the feature is touched, not ground after axis traces");
  refuse("/rotary_axes", "the feature is a surface, not the fixture");
  refuse("/five_axis", "the feature is a surface, no head");
  if (feature.type != record::Shape::kCircle) refuse("/source/plane", "it is that of a circle");
  if (findings.is_given(where + "/source")) {
    refuse("/sampling", "the points come from a file");
    refuse("/pose_search", "the points come from a file");
  } else if (feature.type != record::Shape::kCylinder) {
    for (const std::string_view key : {"strategy", "steps_deg", "min_step_deg", "max_poses"}) {
      const bool said = feature.pose_search.strategy == record::Strategy::kStartPose;
      if (said && key == "strategy") continue;
      refuse(fmt::format("/pose_search/{}", key),
             fmt::format("a {} is measured in its start pose", name_of(feature.type)));
    }
  }
}

/// Checks that the age of the data of a file can be told.
void check_age(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  if (!feature.source) return;
  const std::string& measured = feature.source->measured_utc;
  if (measured.empty() && feature.source->valid_for_days) {
    findings.meaning(Code::kMissingKey, where + "/source/measured_utc",
                     "this key is missing: valid_for_days counts from the time at which the data "
                     "were measured");
  }
  if (!measured.empty() && !core::parse_utc(measured)) {
    findings.meaning(
        Code::kMeaning, where + "/source/measured_utc",
        fmt::format("{} is no time in UTC such as \"2026-11-21T02:33:02Z\"", in_quotes(measured)));
  }
}

}  // namespace

bool is_touched(const Plan& plan, std::size_t index, const Findings& findings) {
  return !findings.is_given(feature_pointer(index) + "/source") &&
         analysis_kind(plan.features[index].type) == nullptr;
}

void check_equipment(const Plan& plan, Findings& findings) {
  const bool turns = plan.fixture && !is_fixed(plan);
  if (turns) {
    check_travel(plan.fixture->min_alpha_deg, plan.fixture->max_alpha_deg, "alpha", findings);
    check_travel(plan.fixture->min_beta_deg, plan.fixture->max_beta_deg, "beta", findings);
  }
  check_drivers(plan, findings);
  check_environment(plan, findings);
  if (plan.probe) check_stylus(*plan.probe, findings);
  check_qualification(plan, findings);
  check_sections(plan.part, findings);
  if (turns) {
    check_datum(plan, findings);
    check_driver_sections(*plan.fixture, findings);
    check_calibration_use(plan, findings);
  }
  check_fixed_part(plan, findings);
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    if (is_touched(plan, i, findings) || measures_by_touch(plan.features[i])) {
      return check_needs(plan, i, findings);
    }
  }
}

/// Refuses ids of which two tables of corrections would have one name: a control would take that of
/// another feature.
void check_table_names(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string name = record::plain_name(feature.id);
  for (std::size_t k = 0; k < index && record::is_analysis(feature.type); ++k) {
    const FeaturePlan& other = plan.features[k];
    if (other.type != feature.type || other.id == feature.id) continue;
    if (record::plain_name(other.id) != name) continue;
    findings.meaning(Code::kMeaning, feature_pointer(index) + "/id",
                     fmt::format("the tables of corrections of {} and {} would have one name, {}; "
                                 "choose another id",
                                 in_quotes(other.id), in_quotes(feature.id), in_quotes(name)));
  }
}

void check_feature(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index);
  if (const auto twin = earlier_with_same_id(plan.features, index)) {
    findings.meaning(Code::kMeaning, where + "/id",
                     fmt::format("the id {} is that of {} already; choose another",
                                 in_quotes(feature.id), feature_pointer(*twin)));
  }
  check_table_names(plan, index, findings);
  check_without_effect(feature, where, findings);
  check_age(feature, where, findings);
  check_drawing(plan, index, findings);
}

void check_plan(const Plan& plan, Findings& findings) {
  check_equipment(plan, findings);
  check_archive(plan, findings);
  if (const auto found = laboratory_of(plan); !found && findings.sound(found.error().where)) {
    findings.meaning(found.error().code, found.error().where, found.error().what);
  }
  check_uncertainty(plan, findings);
  check_simulated_part(plan, findings);
  check_overlaps(plan, findings);
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    check_feature(plan, i, findings);
    if (is_touched(plan, i, findings)) {
      check_sampling(plan, i, findings);
      check_pose_search(plan, i, findings);
    } else if (analysis_kind(plan.features[i].type) != nullptr) {
      check_analysis(plan, i, findings);
    } else {
      check_points_file(plan, i, findings);
    }
  }
}

}  // namespace rondure::plans
