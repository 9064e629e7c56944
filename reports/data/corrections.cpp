#include "reports/data/corrections.h"

#include <cmath>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/correction/corrections.h"
#include "evaluation/handed_calibration.h"
#include "evaluation/results/measured_cloud.h"
#include "record/files.h"
#include "record/sha256.h"
#include "reports/data/analyses.h"

namespace rondure::reports {
namespace {

using core::kMicrometre;
using core::kMicroradian;
using core::printable;
using core::shortest;
using core::um;
using evaluation::FeatureResult;
using record::Shape;

/// SHA-256 of all that was recorded for a feature: rows of its series, places of its touches.
std::string data_hash(const record::RunRecord& record, int feature) {
  std::string text;
  for (const record::Series& series : record.series) {
    if (series.feature != feature || series.role != record::Series::Role::kData) continue;
    text += series.name + "\n";
    for (const double value : series.values) text += shortest(value) + "\n";
  }
  for (const record::PoseVisit& pose : record.poses) {
    if (pose.feature != feature) continue;
    for (const record::Touch& touch : record.touches) {
      if (touch.pose != pose.id) continue;
      text += fmt::format("{} {} {}\n", shortest(touch.tip_mm.x()), shortest(touch.tip_mm.y()),
                          shortest(touch.tip_mm.z()));
    }
  }
  return record::sha256_hex(text);
}

std::string temperature_of(const FeatureResult& result) {
  if (!result.temperatures) return "not recorded";
  return fmt::format("{} degC{}", shortest(result.temperatures->mean_degC),
                     result.temperatures->declared ? ", declared" : "");
}

/// One correction: what it is, in the words of its head.
struct Head {
  std::string kind;
  std::string sense;
  std::string sign;
  std::string validity;
  std::string units;
  std::string gain;
};

std::string head_of(const record::RunRecord& record, int index, const FeatureResult& result,
                    const Head& head) {
  return fmt::format(
      "# rondure correction {}\n# run: {}\n# feature: {}\n# data: sha256 {}\n"
      "# temperature: {}\n# sense: {}\n# sign: {}\n# validity: {}\n# date: {}\n# units: {}\n"
      "# predicted gain: {}\n",
      head.kind, printable(record.header.run_id), printable(result.feature.id),
      data_hash(record, index), temperature_of(result), head.sense, head.sign, head.validity,
      printable(record.header.started_utc), head.units, head.gain);
}

std::string interval_of(const evaluation::UncertaintyStatement& gain) {
  return fmt::format("{} um, interval {} to {} um", um(gain.estimate_mm), um(gain.low_mm),
                     um(gain.high_mm));
}

/// The tables of one feature, and its line of the summary.
struct Handed {
  std::vector<CorrectionTable> tables;
  std::string line;
  core::Phrase none = {};
};

Handed none_because(const core::Phrase& why) {
  return {{}, fmt::format("none: {}", printable(why.english())), why};
}
Handed none_because(const core::Error& why) { return none_because(why.said()); }

Handed contour_tables(const record::RunRecord& record, int index, const FeatureResult& result,
                      const std::string& name) {
  const auto found = evaluation::x_correction(record, result);
  if (!found) return none_because(found.error());
  const auto& facts = std::get<evaluation::ContourResult>(result.analysis->found);
  const bool against = facts.options.axes.c_direction < 0;
  Head head;
  head.kind = "x-of-c";
  head.sense = fmt::format("C as the control counts it, c_axis {}",
                           against ? "against-wheel" : "with-wheel");
  head.sign = "add to command";
  head.validity = fmt::format(
      "crank radius {} mm, wheel radius {} mm, pin radius {} mm; mean of {} part{}; the speed, "
      "gains and temperature of these parts{}",
      shortest(facts.options.geometry.crank_radius_mm),
      shortest(facts.options.geometry.wheel_radius_mm),
      shortest(facts.options.geometry.pin_radius_mm), found->parts,
      found->parts == 1 ? ", u without the spread between parts" : "s",
      std::string(facts.study.traced() ? ""
                                       : "; separation indirect: f is t less the main journal") +
          (facts.gain ? "; on top of the correction that these parts were ground with" : ""));
  head.units = "c_deg deg, x_um um, u_um um; u is a standard uncertainty; linear between the rows";
  head.gain = fmt::format("{}; greatest peak to valley {} um as measured, {} um predicted with it",
                          interval_of(found->gain), um(found->before_mm), um(found->after_mm));
  std::string text = head_of(record, index, result, head) + "c_deg,x_um,u_um\n";
  const auto rows = static_cast<double>(found->x_mm.size());
  for (std::size_t i = 0; i < found->x_mm.size(); ++i) {
    text +=
        fmt::format("{},{},{}\n", shortest(360.0 * static_cast<double>(i) / rows),
                    shortest(found->x_mm[i] / kMicrometre), shortest(found->u_mm[i] / kMicrometre));
  }
  const std::string file = fmt::format("{}/{}-x-of-c.csv", kCorrectionsFolder, name);
  return {{{head.kind, file, std::move(text)}}, fmt::format("{}: {}", file, head.gain)};
}

/// @param rounded  To 1e-6 um or urad: the digits of a table, not those of binary numbers.
std::string axis_rows(const char* key, std::span<const fixture::AxisStation> rows, bool rounded) {
  const auto in = [rounded](double value, double unit) {
    return shortest(rounded ? std::round(value / unit * 1e6) / 1e6 : value / unit);
  };
  std::string text =
      "axis,angle_deg,EX_um,EY_um,EZ_um,EA_urad,EB_urad,EC_urad,u_EX_um,u_EY_um,u_EZ_um,"
      "u_EA_urad,u_EB_urad,u_EC_urad\n";
  for (const fixture::AxisStation& station : rows) {
    text += fmt::format("{},{}", key, shortest(core::stated_degrees(station.angle_rad)));
    const Eigen::Matrix<double, 6, 1> u = station.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    for (const double v : station.errors.shift_mm) text += "," + in(v, kMicrometre);
    for (const double v : station.errors.tilt_rad) text += "," + in(v, kMicroradian);
    for (Eigen::Index k = 0; k < 6; ++k) {
      text += "," + in(u(k), k < 3 ? kMicrometre : kMicroradian);
    }
    text += "\n";
  }
  return text;
}

Handed axis_tables(const record::RunRecord& record, int index, const FeatureResult& result,
                   const std::string& name) {
  const auto gain = evaluation::axis_table_gain(record, result);
  if (!gain) return none_because(gain.error());
  const auto& facts = std::get<evaluation::RotaryResult>(result.analysis->found);
  Handed out;
  const std::string said =
      fmt::format("{}; rms at combined poses {} um without it, {} um with it",
                  interval_of(gain->gain), um(gain->before_mm), um(gain->after_mm));
  for (const evaluation::AxisFacts& axis : evaluation::axes_of(facts)) {
    Head head;
    head.kind = "axis-table";
    head.sense = fmt::format("{} as the fixture reads it, right-handed about its axis", axis.key);
    head.sign = "actual minus nominal";
    head.validity =
        fmt::format("until {}, within the stations", printable(facts.calibration.expires_utc));
    head.units =
        "angle_deg deg, E*_um um, E*_urad urad; u_ is a standard uncertainty; at the origin of the "
        "axis, in the frame that carries it, from the zero pose; location: included";
    head.gain = said;
    const std::string file = fmt::format("{}/{}-{}-table.csv", kCorrectionsFolder, name, axis.key);
    out.tables.push_back({head.kind, file,
                          head_of(record, index, result, head) +
                              axis_rows(axis.key, axis.motion->stations(), false)});
    out.line += (out.line.empty() ? "" : ", ") + file;
  }
  out.line += ": " + said;
  return out;
}

/// One file of a head: both axes in steps, then the location errors, which the table holds already.
Handed head_table(const record::RunRecord& record, int index, const FeatureResult& result,
                  const std::string& name) {
  if (result.failure) return none_because(*result.failure);
  const auto& facts = std::get<evaluation::FiveAxisResult>(result.analysis->found);
  if (facts.gain) {
    return none_because(core::phrase("this run has the table of another feature loaded"));
  }
  if (facts.withheld) return none_because(*facts.withheld);
  Head head;
  head.kind = "axis-table";
  head.sense =
      fmt::format("C and A as the control counts them, c_sense {}, a_sense {}",
                  record::name_of(facts.task.c_sense), record::name_of(facts.task.a_sense));
  head.sign = "actual minus nominal";
  head.validity = fmt::format("machine {}, until {}, within the stations",
                              printable(facts.task.machine_id), printable(facts.expires_utc));
  head.units =
      "angle_deg deg, E*_um um, E*_urad urad; u_ is a standard uncertainty; at the pivot, from C = "
      "A = 0, right-handed; linear between the rows; location: included";
  head.gain = fmt::format("rms at combined poses {} um without it, {} um with it",
                          um(facts.study.before.rms_mm), um(facts.study.left.rms_mm));
  std::string text = head_of(record, index, result, head) + axis_rows("c", facts.c_table, true);
  const std::string a_rows = axis_rows("a", facts.a_table, true);
  text += a_rows.substr(a_rows.find('\n') + 1);
  text += "\nlocation,value,u,unit\n";
  for (const evaluation::HeadLocation& one : evaluation::locations_of(facts)) {
    text += fmt::format("{},{},{},{}\n", record::name_of(one.error),
                        shortest(one.value_mm / kMicrometre), shortest(one.u_mm / kMicrometre),
                        record::is_angle(one.error) ? "urad" : "um");
  }
  const std::string file = fmt::format("{}/{}-head-table.csv", kCorrectionsFolder, name);
  return {{{head.kind, file, std::move(text)}}, fmt::format("{}: {}", file, head.gain)};
}

/// Part and motion over the work angle, of three probes.
Handed spindle_rows(const record::RunRecord& record, int index, const FeatureResult& result,
                    const std::string& name) {
  const auto found = evaluation::spindle_table(result);
  if (!found) return none_because(found.error());
  const auto& facts = std::get<evaluation::SpindleResult>(result.analysis->found);
  const bool pin = found->rows.front().command_mm.has_value();
  std::string missing;
  for (const int order : found->missing) missing += fmt::format(" {}", order);
  Head head;
  head.kind = "spindle-table";
  head.sense =
      "alpha as the readings count it, theta = alpha + beta on the part, RX and RY in the frame of "
      "the probes";
  head.sign = pin ? "as found; x_um add to command" : "as found";
  const auto angles = facts.separation.layout.angles_rad();
  head.validity = fmt::format(
      "probes at {:.7g}, {:.7g}, {:.7g} deg; orders 2 to {}; orders that the probes do not show:{}",
      core::degrees(angles[0]), core::degrees(angles[1]), core::degrees(angles[2]),
      facts.separation.harmonics.size() + 1, missing.empty() ? " none" : missing);
  head.units = fmt::format(
      "alpha_deg deg, theta_deg deg, others um; u_ is a standard uncertainty by noise alone; "
      "linear between the rows{}",
      pin ? "; x_um for a wheel opposite to P1" : "");
  head.gain = fmt::format("none is forecast; synchronous motion X {} um, Y {} um",
                          um(facts.x.synchronous_mm), um(facts.y.synchronous_mm));
  std::string text = head_of(record, index, result, head) +
                     "alpha_deg,theta_deg,profile_um,RX_um,RY_um,u_profile_um,u_RX_um,u_RY_um" +
                     (pin ? ",x_um\n" : "\n");
  const auto in_um = [](double mm) { return shortest(std::round(mm / kMicrometre * 1e6) / 1e6); };
  for (std::size_t i = 0; i < found->rows.size(); ++i) {
    const evaluation::SpindleRow& row = found->rows[i];
    text += fmt::format("{},{},{},{},{},{},{},{}", i,
                        shortest(std::round(core::degrees(row.theta_rad) * 1e6) / 1e6),
                        in_um(row.profile_mm), in_um(row.motion_x_mm), in_um(row.motion_y_mm),
                        in_um(found->u_profile_mm), in_um(found->u_motion_x_mm),
                        in_um(found->u_motion_y_mm));
    text += pin ? fmt::format(",{}\n", in_um(*row.command_mm)) : "\n";
  }
  const std::string file = fmt::format("{}/{}-spindle-table.csv", kCorrectionsFolder, name);
  return {{{head.kind, file, std::move(text)}}, fmt::format("{}: {}", file, head.gain)};
}

/// The path of a wheel over its surface: a table, and the program where the plan asks for one.
Handed wheel_path(const record::RunRecord& record, int index, const FeatureResult& result,
                  const std::string& name) {
  const auto wheel = evaluation::wheel_for_path(result);
  if (!wheel) return none_because(wheel.error());
  const fit::WheelEvaluation& found = (*wheel)->evaluation;
  Head head;
  head.kind = "wheel-path";
  head.sense = "x and z of the plan, material below the surface, the wheel above it";
  head.sign = "places of the wheel, not differences";
  head.validity = fmt::format("R {} mm, {} radius, u {} um, as measured; until the wheel is trued",
                              shortest(found.path->radius_mm), name_of(found.radius),
                              um(found.wheel.radius_uncertainty_mm));
  head.units = "mm, phi_deg deg, clearance_um um";
  head.gain = "none without a nominal radius";
  if (found.forecast && found.forecast->nominal) {
    head.gain = fmt::format("form {} um peak to valley by the nominal radius, {} um by this one",
                            um(found.forecast->nominal->deviation_mm),
                            um(found.forecast->measured.deviation_mm));
  }
  Handed out;
  const std::string file = fmt::format("{}/{}-wheel-path.csv", kCorrectionsFolder, name);
  out.tables.push_back(
      {head.kind, file, head_of(record, index, result, head) + wheel_path_csv(*found.path)});
  out.line = file;
  const auto task = record::task_of<record::WheelTask>(result.feature.settings);
  if (task && task->program) {
    const std::string program = fmt::format("{}/{}-wheel-path.nc", kCorrectionsFolder, name);
    out.tables.push_back(
        {"program", program,
         wheel_gcode(*found.path, {task->program->feed_mm_min, task->program->retract_mm})});
    out.line += ", " + program;
  }
  out.line += ": " + head.gain;
  return out;
}

/// The tables of any feature.
Handed tables_of(const record::RunRecord& record, int index, const FeatureResult& result) {
  const std::string name = record::plain_name(result.feature.id);
  if (result.feature.shape == Shape::kContour) return contour_tables(record, index, result, name);
  if (result.feature.shape == Shape::kRotaryAxes) return axis_tables(record, index, result, name);
  if (result.feature.shape == Shape::kFiveAxis) return head_table(record, index, result, name);
  if (result.feature.shape == Shape::kSpindle) return spindle_rows(record, index, result, name);
  if (result.feature.shape == Shape::kWheel) return wheel_path(record, index, result, name);
  return none_because(core::phrase("points of a surface give no correction for a machine"));
}

}  // namespace

const FeatureResult* calibrated_fixture(const evaluation::Evaluation& evaluation) {
  const FeatureResult* source = nullptr;
  for (const FeatureResult& feature : evaluation.features) {
    const bool later = source != nullptr && source->analysis;
    if (feature.feature.shape == Shape::kRotaryAxes && !later) source = &feature;
  }
  return source;
}

Corrections write_corrections(const record::RunRecord& record,
                              const evaluation::Evaluation& evaluation) {
  Corrections out;
  out.summary = fmt::format("# rondure corrections, run {}\n", printable(record.header.run_id));
  std::set<std::string> taken;
  const FeatureResult* calibration = calibrated_fixture(evaluation);
  if (calibration != nullptr && evaluation::handed_calibration(*calibration).void_because) {
    calibration = nullptr;
  }
  for (std::size_t i = 0; i < evaluation.features.size(); ++i) {
    const FeatureResult& result = evaluation.features[i];
    Handed handed = evaluation::is_complete(record, i)
                        ? tables_of(record, static_cast<int>(i), result)
                        : none_because(core::phrase("the run did not finish"));
    for (const CorrectionTable& table : handed.tables) {
      if (taken.insert(table.file).second) continue;
      // A control would take the table of another feature. `validate` refuses such names.
      handed = none_because(core::phrase("{} is of another feature; rename one", table.file));
      break;
    }
    out.summary += fmt::format("{}: {}\n", printable(result.feature.id), handed.line);
    FeatureCorrections named;
    named.none_because = std::move(handed.none);
    if (&result == calibration && record.ending == "finished") {
      named.files.push_back({"fixture-calibration", kCalibrationFile, record::Format::kJson});
    }
    for (CorrectionTable& table : handed.tables) {
      named.files.push_back({table.kind, table.file});
      out.tables.push_back(std::move(table));
    }
    out.of_features.push_back(std::move(named));
  }
  return out;
}

}  // namespace rondure::reports
