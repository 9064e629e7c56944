#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/units.h"
#include "fit/profiles/roundness.h"
#include "record/points/points.h"

namespace rondure::app {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> contact_angles(const fit::RoundnessEvaluation& evaluation,
                                   const std::vector<std::size_t>& rows) {
  std::vector<double> out;
  for (const std::size_t row : rows) out.push_back(core::degrees(evaluation.theta_rad[row]));
  return out;
}

Json filter_json(const fit::RoundnessEvaluation& evaluation) {
  const fit::FilterOptions& filter = evaluation.filter;
  Json out = {{"name", fit::name_of(filter.filter)}};
  if (filter.filter == fit::ProfileFilter::kNone) return out;
  out["pass"] = fit::name_of(filter.pass);
  if (filter.pass == fit::PassBand::kBand) {
    out["cutoff_upr"] = {filter.cutoff_upr, filter.upper_cutoff_upr};
  } else {
    out["cutoff_upr"] = filter.cutoff_upr;
  }
  out["points_per_undulation"] = evaluation.sampling.points_per_undulation;
  out["sampling_overridden"] = evaluation.sampling.overridden;
  if (evaluation.filter_iterations > 0) out["iterations"] = evaluation.filter_iterations;
  return out;
}

Json value_json(const fit::RoundnessEvaluation& evaluation, const fit::Roundness& value) {
  Json out = {{"RONt_um", core::micrometres(value.total_mm)}};
  if (value.parameters) {
    out["RONp_um"] = core::micrometres(value.parameters->peak_mm);
    out["RONv_um"] = core::micrometres(value.parameters->valley_mm);
    out["RONq_um"] = core::micrometres(value.parameters->rms_mm);
  }
  if (value.range)
    out["RONt_range_um"] = {core::micrometres(value.range->low_mm),
                            core::micrometres(value.range->high_mm)};
  out["center_mm"] = {value.center_mm.x(), value.center_mm.y()};
  out["radius_mm"] = value.radius_mm;
  if (value.reference == fit::CircleReference::kLs) return out;
  if (value.reference != fit::CircleReference::kMi)
    out["contacts_deg"]["outer"] = contact_angles(evaluation, value.outer);
  if (value.reference != fit::CircleReference::kMc)
    out["contacts_deg"]["inner"] = contact_angles(evaluation, value.inner);
  out["certificate"] = certificate_json(value.certificate);
  return out;
}

Json harmonics_json(const fit::HarmonicTable& table) {
  Json out = Json::array();
  for (const fit::Harmonic& h : table.harmonics) {
    Json row = {{"upr", h.number}, {"amplitude_um", core::micrometres(h.amplitude_mm)}};
    row["phase_deg"] = h.phase_rad ? Json(core::degrees(*h.phase_rad)) : Json(nullptr);
    row["crest_deg"] = h.crest_rad() ? Json(core::degrees(*h.crest_rad())) : Json(nullptr);
    out.push_back(std::move(row));
  }
  return out;
}

std::string filter_line(const fit::RoundnessEvaluation& evaluation) {
  const fit::FilterOptions& filter = evaluation.filter;
  if (filter.filter == fit::ProfileFilter::kNone) return "  filter    none\n";
  const bool band = filter.pass == fit::PassBand::kBand;
  std::string out =
      fmt::format("  filter    {}, {} pass, {} UPR, {:.1f} points per undulation{}",
                  fit::name_of(filter.filter), fit::name_of(filter.pass),
                  band ? fmt::format("{} to {}", filter.cutoff_upr, filter.upper_cutoff_upr)
                       : fmt::format("{}", filter.cutoff_upr),
                  evaluation.sampling.points_per_undulation,
                  evaluation.sampling.overridden ? " (too few, overridden)" : "");
  if (evaluation.filter_iterations > 0)
    out += fmt::format(", {} iterations", evaluation.filter_iterations);
  if (evaluation.interpolated) {
    out += fmt::format("\n  resampled {} values by a periodic cubic spline, error about {:.2g} um",
                       evaluation.samples, core::micrometres(evaluation.resampling_error_mm));
  }
  return out + "\n";
}

std::string degrees_list(const std::vector<double>& angles) {
  std::string out;
  for (const double angle : angles) out += fmt::format(" {:.3f}", angle);
  return out;
}

std::string value_lines(const fit::RoundnessEvaluation& evaluation, const fit::Roundness& value,
                        bool polar) {
  std::string name(fit::name_of(value.reference));
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  std::string out = fmt::format("  {}CI  RONt {:.4f} um", name, core::micrometres(value.total_mm));
  if (value.parameters) {
    out += fmt::format(", RONp {:.4f} um, RONv {:.4f} um, RONq {:.4f} um",
                       core::micrometres(value.parameters->peak_mm),
                       core::micrometres(value.parameters->valley_mm),
                       core::micrometres(value.parameters->rms_mm));
  }
  if (value.range) {
    out += fmt::format(", not unique: {:.4f} to {:.4f} um", core::micrometres(value.range->low_mm),
                       core::micrometres(value.range->high_mm));
  }
  out += polar ? fmt::format("\n    centre off by ({:.4f}, {:.4f}) um\n",
                             core::micrometres(value.center_mm.x()),
                             core::micrometres(value.center_mm.y()))
               : fmt::format("\n    centre ({:.6f}, {:.6f}) mm, radius {:.6f} mm\n",
                             value.center_mm.x(), value.center_mm.y(), value.radius_mm);
  if (value.reference == fit::CircleReference::kLs) return out;
  out += "    contacts at deg";
  if (!value.outer.empty())
    out += ", outer" + degrees_list(contact_angles(evaluation, value.outer));
  if (!value.inner.empty())
    out += ", inner" + degrees_list(contact_angles(evaluation, value.inner));
  out += "\n";
  out += "    " + certificate_text(value.certificate);
  return out + "\n";
}

/// The ten greatest harmonics from 2 on that are not zero in four decimals, by number.
std::string harmonic_lines(const fit::HarmonicTable& table) {
  constexpr std::size_t kShown = 10;
  constexpr double kLeastUm = 5e-5;
  std::vector<fit::Harmonic> form;
  for (const fit::Harmonic& h : table.harmonics) {
    if (h.number > 1 && core::micrometres(h.amplitude_mm) >= kLeastUm) form.push_back(h);
  }
  if (form.empty()) return {};
  std::stable_sort(form.begin(), form.end(),
                   [](const auto& a, const auto& b) { return a.amplitude_mm > b.amplitude_mm; });
  form.resize(std::min(form.size(), kShown));
  std::sort(form.begin(), form.end(),
            [](const auto& a, const auto& b) { return a.number < b.number; });
  std::string out = fmt::format(
      "  harmonics before the filter, the {} greatest of 2 to {}\n    UPR  amplitude um  phase "
      "deg\n",
      form.size(), table.harmonics.back().number);
  for (const fit::Harmonic& h : form) {
    out += fmt::format("    {:3d}  {:12.4f}  {:>9}\n", h.number, core::micrometres(h.amplitude_mm),
                       h.phase_rad ? fmt::format("{:.3f}", core::degrees(*h.phase_rad)) : "-");
  }
  return out;
}

nlohmann::ordered_json roundness_json(const fit::RoundnessEvaluation& evaluation, bool polar) {
  Json out = {{"shape", "roundness"},
              {"points", evaluation.points},
              {"model", polar ? "profile" : "points"},
              {"filter", filter_json(evaluation)},
              {"samples", evaluation.samples}};
  out["resampling"] = {{"method", evaluation.interpolated ? "periodic cubic spline" : "none"},
                       {"error_um", core::micrometres(evaluation.resampling_error_mm)}};
  for (const fit::Roundness& value : evaluation.values) {
    out[std::string(fit::name_of(value.reference))] = value_json(evaluation, value);
  }
  for (const fit::CircleReference reference : evaluation.absent) {
    out[std::string(fit::name_of(reference))] = nullptr;
  }
  out["harmonics"] = harmonics_json(evaluation.harmonics);
  out["warnings"] = warnings_json(evaluation.warnings);
  return out;
}

std::string roundness_table(const fit::RoundnessEvaluation& evaluation, bool polar) {
  std::string out =
      fmt::format("roundness, {} points\n", evaluation.points) + filter_line(evaluation);
  for (const fit::Roundness& value : evaluation.values)
    out += value_lines(evaluation, value, polar);
  return out + harmonic_lines(evaluation.harmonics) + warnings_text(evaluation.warnings);
}

/// A smaller roundness is better than good spindles achieve [um]; usually the column of um holds
/// mm.
constexpr double kLeastRoundnessUm = 0.05;
/// Radii outside these suggest metres or micrometres [mm].
constexpr double kLeastRadius = 0.5;
constexpr double kGreatestRadius = 500.0;

core::Result<fit::RoundnessOptions> options_of(const RoundnessArguments& arguments) {
  using fit::PassBand;
  using fit::ProfileFilter;
  fit::RoundnessOptions out;
  out.inside = arguments.inside;
  out.filter.override_sampling = arguments.override_sampling;
  using fit::CircleReference;
  out.references.clear();
  for (const auto reference :
       {CircleReference::kLs, CircleReference::kMz, CircleReference::kMc, CircleReference::kMi}) {
    const bool wanted = arguments.reference == fit::name_of(reference);
    if (wanted || arguments.reference == "all") out.references.push_back(reference);
  }
  for (const auto filter : {ProfileFilter::kNone, ProfileFilter::kGaussian, ProfileFilter::kTwoRc,
                            ProfileFilter::kRobustGaussian, ProfileFilter::kSpline}) {
    if (fit::name_of(filter) == arguments.filter) out.filter.filter = filter;
  }
  for (const auto pass : {PassBand::kLow, PassBand::kHigh, PassBand::kBand}) {
    if (fit::name_of(pass) == arguments.pass) out.filter.pass = pass;
  }
  const std::size_t needed = out.filter.pass == PassBand::kBand ? 2 : 1;
  if (arguments.cutoff_upr.size() != needed) {
    return core::fail_with(core::Code::kBadOption,
                           "--cutoff-upr holds {} numbers, --pass {} needs {}",
                           arguments.cutoff_upr.size(), arguments.pass,
                           needed == 2 ? "two: --cutoff-upr 15,150" : "one");
  }
  out.filter.cutoff_upr = arguments.cutoff_upr.front();
  out.filter.upper_cutoff_upr = arguments.cutoff_upr.back();
  return out;
}

core::Result<record::ProfileTable> load_profile(const RoundnessArguments& arguments) {
  TRY(const auto bytes, record::read_file(arguments.file, record::kMostPointsBytes));
  return record::read_profile(bytes, std::filesystem::path(arguments.file).filename().string(),
                              arguments.points);
}

/// Refuses angles that fill one turn in radians and nothing in degrees.
core::Result<void> check_angle_unit(const std::vector<double>& theta_deg) {
  const auto [low, high] = std::minmax_element(theta_deg.begin(), theta_deg.end());
  const double span = *high - *low;
  if (span < 5.5 || span > core::kTwoPi * 1.001) return {};
  return core::fail_with(
      core::Code::kUnits,
      "the angles run over {:.4f} deg; that is one turn in radians, theta_deg is in degrees", span);
}

core::Result<fit::RoundnessEvaluation> evaluate_polar(const record::ProfileTable& table,
                                                      const fit::RoundnessOptions& options) {
  std::vector<double> theta_deg;
  std::vector<double> theta;
  std::vector<double> r;
  for (const Eigen::Vector2d& row : table.rows) {
    theta_deg.push_back(row.x());
    theta.push_back(row.x() * core::kDegree);
    r.push_back(row.y() * core::kMicrometre);
  }
  TRY_DO(check_angle_unit(theta_deg));
  auto out = fit::evaluate_profile(theta, r, options);
  if (!out) return out;
  if (out->values.empty()) return out;
  const double range_um = out->values.front().total_mm / core::kMicrometre;  // without eccentricity
  if (range_um > 0.0 && range_um < kLeastRoundnessUm) {
    out->warnings.push_back(
        {core::Code::kUnits,
         fmt::format("roundness is {:.3g} um only, less than {} um: is r in mm? Then it is {:.3g} "
                     "um; give r in um",
                     range_um, kLeastRoundnessUm, 1e3 * range_um),
         {}});
  }
  return out;
}

core::Result<fit::RoundnessEvaluation> evaluate_points(const record::ProfileTable& table,
                                                       const fit::RoundnessOptions& options) {
  auto out = fit::evaluate_section(table.rows, options);
  if (!out) return out;
  if (out->values.empty()) return out;
  const double radius = out->values.front().radius_mm;
  if (radius < kLeastRadius || radius > kGreatestRadius) {
    out->warnings.push_back(
        {core::Code::kUnits,
         fmt::format("the radius is {:.4g} mm, outside {} to {} mm: x and y are "
                     "in mm",
                     radius, kLeastRadius, kGreatestRadius),
         {}});
  }
  return out;
}

}  // namespace

int roundness(const RoundnessArguments& arguments) {
  const auto options = options_of(arguments);
  if (!options) return refuse(options.error());
  const auto table = load_profile(arguments);
  if (!table) return refuse(table.error());
  const auto out =
      table->polar ? evaluate_polar(*table, *options) : evaluate_points(*table, *options);
  if (!out) return refuse_file(out.error(), arguments.file);
  return answer(roundness_json(*out, table->polar), arguments.json,
                [&] { return roundness_table(*out, table->polar); });
}

}  // namespace rondure::app
