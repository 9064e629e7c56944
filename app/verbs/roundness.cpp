#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/roundness.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/units.h"
#include "fit/profiles/roundness_evaluation.h"
#include "record/csv/points.h"

namespace rondure::app {
namespace {

/// Roundness below this is beyond good spindles [um]; it is common for mm in a column of um.
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
    return core::fail(core::Code::kBadOption,
                      fmt::format("--cutoff-upr holds {} numbers, --pass {} needs {}",
                                  arguments.cutoff_upr.size(), arguments.pass,
                                  needed == 2 ? "two: --cutoff-upr 15,150" : "one"));
  }
  out.filter.cutoff_upr = arguments.cutoff_upr.front();
  out.filter.upper_cutoff_upr = arguments.cutoff_upr.back();
  return out;
}

core::Result<record::ProfileTable> load_profile(const std::string& file) {
  const auto bytes = record::read_file(file);
  if (!bytes) return core::fail(bytes.error());
  return record::parse_profile_csv(*bytes, std::filesystem::path(file).filename().string());
}

/// Angles that fill one turn in radians and nothing in degrees.
core::Result<void> check_angle_unit(const std::vector<double>& theta_deg) {
  const auto [low, high] = std::minmax_element(theta_deg.begin(), theta_deg.end());
  const double span = *high - *low;
  if (span < 5.5 || span > core::kTwoPi * 1.001) return {};
  return core::fail(core::Code::kUnits,
                    fmt::format("the angles run over {:.4f} deg; that is one turn in radians, "
                                "theta_deg is in degrees",
                                span));
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
  if (auto checked = check_angle_unit(theta_deg); !checked) return core::fail(checked.error());
  auto out = fit::evaluate_profile(theta, r, options);
  if (!out) return out;
  const auto [low, high] =
      std::minmax_element(out->measured.r_mm.begin(), out->measured.r_mm.end());
  const double range_um = (*high - *low) / core::kMicrometre;
  if (range_um > 0.0 && range_um < kLeastRoundnessUm) {
    out->warnings.push_back(
        {core::Code::kUnits,
         fmt::format("r_um runs over {:.3g} um only, less than {} um: are these mm? Then it is "
                     "{:.3g} um; give r in um",
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

/// The error with the file it came from, where it has no place yet.
core::Error placed(const core::Error& error, const std::string& file) {
  return error.where.empty() ? error.at(std::filesystem::path(file).filename().string()) : error;
}

}  // namespace

int roundness(const RoundnessArguments& arguments) {
  const auto options = options_of(arguments);
  if (!options) {
    print_error(options.error());
    return kBadInput;
  }
  const auto table = load_profile(arguments.file);
  if (!table) {
    print_error(table.error());
    return kBadInput;
  }
  const auto out =
      table->polar ? evaluate_polar(*table, *options) : evaluate_points(*table, *options);
  if (!out) {
    print_error(placed(out.error(), arguments.file));
    return kBadInput;
  }
  return answer(roundness_json(*out, table->polar), arguments.json,
                [&] { return roundness_table(*out, table->polar); });
}

}  // namespace rondure::app
