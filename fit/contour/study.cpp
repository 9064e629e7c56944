#include "fit/contour/study.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/statistics.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

/// Most samples of a turn; gauges give some thousands.
constexpr std::size_t kMostSamples = 100'000;

MeasuredContourOptions gauge_options(const ContourStudyOptions& options, bool main) {
  MeasuredContourOptions out;
  out.phase_offset_rad = main ? options.main_phase_offset_rad : options.phase_offset_rad;
  out.direction = options.gauge_direction;
  out.samples = options.samples;
  out.nominal_mm = main ? options.main_radius_mm : options.geometry.pin_radius_mm;
  out.error = options.error;
  out.error.filtered_already = options.prefiltered;
  return out;
}

core::Result<void> check_axis_sampling(AxisTurn& axes, const FilterOptions& filter) {
  if (filter.filter == ProfileFilter::kNone) return {};
  const double cutoff = filter.highest_cutoff_upr();
  const double samples = axes.samples_per_turn;
  if (cutoff >= samples / 2.0) {
    return core::fail_with(
        core::Code::kSampling,
        "the control has {:.1f} samples a turn; a cut-off of {} UPR needs more than {}", samples,
        cutoff, 2.0 * cutoff);
  }
  if (samples < kSamplesPerUndulation * cutoff * (1.0 - 1e-9)) {
    axes.warnings.push_back(
        {core::Code::kUndersampled,
         fmt::format("the control has {:.1f} samples a turn, {:.1f} an undulation at {} UPR; at "
                     "least 6 are advised",
                     samples, samples / cutoff, cutoff)});
  }
  return {};
}

void warn_of_undercut(ContourPartResult& part) {
  if (!part.ground.undercut) return;
  part.axes.warnings.push_back(
      {core::Code::kUndercut,
       fmt::format("the wheel path cuts under the contour near C = {:.2f} deg (1 - Rgw kappa = "
                   "{:.3g}, regular above 0): the contour is the envelope of all wheel positions",
                   part.ground.least_regular_rad / core::kDegree, part.ground.regularity)});
}

/// Computes f from the axes alone.
core::Result<void> follow(const AxisTrace& trace, const ContourStudyOptions& options,
                          ContourPartResult& out) {
  TRY(auto axes, last_turn(trace, options.axes));
  out.axes = std::move(axes);
  out.positions = check_positions(out.axes, options.geometry);
  if (out.positions && !out.positions->contradiction.empty()) {
    return core::fail(core::Code::kInconsistent, out.positions->contradiction);
  }
  TRY_DO(check_axis_sampling(out.axes, options.error.filter));
  TRY(auto following, following_contour(out.axes.errors, options));
  out.ground = std::move(following.ground);
  out.following = std::move(following.error);
  warn_of_undercut(out);
  return {};
}

/// t less the main journal.
std::vector<double> above_main(const ContourPartResult& part) {
  return separate_contour(part.pin.contour.error_mm, part.main->contour.error_mm).rest_mm;
}

IndirectSeparation indirect(const ContourPartResult& part) {
  IndirectSeparation out;
  out.following_mm = above_main(part);
  const auto& direct = part.following.error_mm;
  out.correlation = correlation_of(out.following_mm, direct);
  out.rms_difference_mm =
      core::root_mean_square(separate_contour(out.following_mm, direct).rest_mm);
  return out;
}

core::Error placed(const core::Error& error, const std::string& where) {
  return error.where.empty() ? error.at(where) : error;
}

using CurveOf = std::function<const std::vector<double>&(const ContourPartResult&)>;

std::optional<Repeatability> compared(const std::vector<ContourPartResult>& parts,
                                      const CurveOf& curve_of) {
  std::vector<std::vector<double>> curves;
  for (const ContourPartResult& part : parts) curves.push_back(curve_of(part));
  auto out = repeatability(curves);
  if (!out) return std::nullopt;
  return *std::move(out);
}

void compare(ContourStudy& study) {
  const auto& parts = study.parts;
  if (parts.size() >= 2) {
    using Part = ContourPartResult;
    study.total = compared(
        parts, [](const Part& p) -> const auto& { return p.pin.contour.error_mm; });
    study.following = compared(
        parts, [](const Part& p) -> const auto& { return p.following.error_mm; });
    study.rest = compared(
        parts, [](const Part& p) -> const auto& { return p.direct.rest_mm; });
    if (study.traced()) {
      study.c_error = compared(
          parts, [](const Part& p) -> const auto& { return p.axes.errors.c_rad; });
      study.x_error = compared(
          parts, [](const Part& p) -> const auto& { return p.axes.errors.x_mm; });
    }
    bool all_mains = true;
    for (const Part& part : parts) all_mains = all_mains && part.main.has_value();
    if (all_mains) {
      study.main = compared(
          parts, [](const Part& p) -> const auto& { return p.main->contour.error_mm; });
    }
  }
  double following = 0.0;
  double rest = 0.0;
  for (const ContourPartResult& part : parts) {
    following += part.direct.following_mm2;
    rest += part.direct.rest_mm2;
  }
  study.amplitude_ratio = rest > 0.0 ? std::sqrt(following / rest) : 0.0;
}

void collect_warnings(ContourStudy& study) {
  for (std::size_t i = 0; i < study.parts.size(); ++i) {
    const ContourPartResult& part = study.parts[i];
    const auto add = [&](const std::vector<core::Error>& from, const char* what) {
      for (const core::Error& warning : from) {
        study.warnings.push_back(warning.at(fmt::format("parts/{}/{}", i, what)));
      }
    };
    add(part.axes.warnings, "axes");
    add(part.pin.warnings, "pin");
    if (part.main) add(part.main->warnings, "main");
  }
}

/// f with the errors of the axes taken so many times, in the mean of the parts; empty where one has
/// no such contour.
std::vector<double> mean_following_of(const ContourStudy& study, double x_times, double c_times,
                                      const ContourStudyOptions& options) {
  std::vector<double> out(options.samples, 0.0);
  for (const ContourPartResult& part : study.parts) {
    AxisErrors errors = part.axes.errors;
    for (double& x : errors.x_mm) x *= x_times;
    for (double& c : errors.c_rad) c *= c_times;
    const auto found = following_contour(errors, options);
    if (!found) return {};
    for (std::size_t m = 0; m < out.size(); ++m) {
      out[m] += found->error.error_mm[m] / static_cast<double>(study.parts.size());
    }
  }
  return out;
}

/// One axis alone may be read with the wrong sign, or C in the wrong unit. The mean of the parts
/// shows it best: f repeats from part to part more than the rest does.
std::optional<AxisDoubt> axis_doubt(const ContourStudy& study, const ContourStudyOptions& options) {
  using Kind = AxisDoubt::Kind;
  const std::vector<double>& total =
      study.total ? study.total->mean_curve : study.parts.front().pin.contour.error_mm;
  const std::vector<double> given = mean_following_of(study, 1.0, 1.0, options);
  if (given.empty()) return std::nullopt;
  std::optional<AxisDoubt> likeliest;
  for (const auto& [kind, x, c] : {std::tuple{Kind::kSignOfX, -1.0, 1.0},
                                   {Kind::kSignOfC, 1.0, -1.0},
                                   {Kind::kRadiansAsDegrees, 1.0, 1.0 / core::kDegree}}) {
    const std::vector<double> other = mean_following_of(study, x, c, options);
    if (other.empty() || !fits_better({total, given}, other)) continue;
    const double rms_mm = std::sqrt(separate_contour(total, other).rest_mm2);
    if (!likeliest || rms_mm < likeliest->rms_mm) {
      likeliest = {kind, std::sqrt(separate_contour(total, given).rest_mm2), rms_mm};
    }
  }
  return likeliest;
}

/// Adds warnings for settings that the data of all parts contradict.
void diagnose(ContourStudy& study, const ContourStudyOptions& options) {
  std::vector<CurvePair> pairs;
  for (const ContourPartResult& part : study.parts) {
    pairs.push_back({part.pin.contour.error_mm, part.following.error_mm});
  }
  study.sense = sense_evidence(pairs);
  study.axis = axis_doubt(study, options);
  study.offset = correlation_offset(pairs);
  const SenseEvidence& sense = study.sense;
  const auto warn = [&](core::Code code, std::string what) {
    study.warnings.push_back({code, std::move(what)});
  };
  if (sense.sign_suspect()) {
    warn(core::Code::kSense,
         fmt::format("the following part opposes the contour: correlation {:.2f}, rest {:.3g} um "
                     "rms, with the other sign of the axis errors {:.3g} um; error_sign {} rather "
                     "than {}?",
                     sense.as_given, sense.rms_difference_mm / core::kMicrometre,
                     sense.rms_sum_mm / core::kMicrometre, -options.axes.error_sign,
                     options.axes.error_sign));
  } else if (sense.sense_suspect()) {
    warn(core::Code::kSense,
         fmt::format(
             "the contour fits the mirrored following part (correlation {:.2f}) better than "
             "the given one ({:.2f}); c_direction {} rather than {}, or the gauge turns the "
             "other way?",
             sense.mirrored, sense.as_given, -options.axes.c_direction, options.axes.c_direction));
  } else if (study.offset.alignment_suspect()) {
    warn(core::Code::kAlignment,
         fmt::format("correlation would turn the following part by {}{:.2f} deg, more than 2 deg "
                     "and 3 times what the rest explains ({:.2f} deg): is the phase offset of the "
                     "gauge right? Nothing was turned for that",
                     study.offset.at_edge ? "at least " : "",
                     study.offset.angle_rad / core::kDegree, study.offset.u_rad / core::kDegree));
  }
}

}  // namespace

std::optional<PositionCheck> check_positions(const AxisTurn& axes, const CrankGeometry& geometry) {
  const std::size_t n = axes.x_mm.size();
  if (n == 0) return std::nullopt;
  std::vector<double> ideal(n);
  for (std::size_t i = 0; i < n; ++i) {
    ideal[i] =
        wheel_position_mm(geometry, core::kTwoPi * static_cast<double>(i) / static_cast<double>(n));
  }
  PositionCheck out;
  out.stroke_mm = peak_to_valley(axes.x_mm);
  out.expected_mm = peak_to_valley(ideal);
  const auto stated = spectrum(ideal);
  double mean = 0.0;
  for (std::size_t i = 0; i < n; ++i) mean += (axes.x_mm[i] - ideal[i]) / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) ideal[i] = axes.x_mm[i] - ideal[i] - mean;
  out.course_mm = core::root_mean_square(ideal);
  if (std::abs(out.stroke_mm - out.expected_mm) <= PositionCheck::kStrokeLimit &&
      out.course_mm <= PositionCheck::kCourseLimit) {
    return out;
  }
  // d = R cos(alpha) + Lc - R^2/(4 Lc) (1 - cos(2 alpha)) ...: the first harmonic gives crank
  // radius and zero, the second R^2/Lc.
  const auto f = spectrum(axes.x_mm);
  const double radius = 2.0 * std::abs(f[1]) / static_cast<double>(n);
  const double length = geometry.center_distance_mm() * std::abs(stated[2]) /
                        std::max(std::abs(f[2]), 1e-9) *
                        std::pow(radius / geometry.crank_radius_mm, 2);
  out.contradiction = fmt::format(
      "the recorded X positions contradict the geometry: stroke {:.3f} mm, expected "
      "{:.3f} mm (limit {} mm), and {:.3f} mm rms off the ideal motion (limit {} mm). "
      "They fit a crank radius of {:.3f} mm (stated {:g}), wheel and pin radii of "
      "{:.0f} mm together (stated {:g}) and C turned by {:.2f} deg: correct these, the "
      "zero of C or the column of X",
      out.stroke_mm, out.expected_mm, PositionCheck::kStrokeLimit, out.course_mm,
      PositionCheck::kCourseLimit, radius, geometry.crank_radius_mm, length,
      geometry.center_distance_mm(), -std::arg(f[1]) / core::kDegree);
  return out;
}

core::Result<FollowingContour> following_contour(const AxisErrors& errors,
                                                 const ContourStudyOptions& options) {
  GroundContourOptions how;
  how.samples = options.samples;
  how.refine = options.refine_path;
  if (options.method == ContourMethod::kAsPublished) how.form = ParallelForm::kDifferences;
  TRY(auto ground, ground_contour(options.geometry, errors, how));
  std::vector<double> deviation = ground.r_mm;
  for (double& r : deviation) r -= options.geometry.pin_radius_mm;
  TRY(auto error, contour_error(deviation, options.geometry.pin_radius_mm, options.error));
  return FollowingContour{std::move(ground), std::move(error)};
}

core::Result<ContourPartResult> contour_part(const ContourPart& part,
                                             const ContourStudyOptions& options) {
  ContourPartResult out;
  out.traced = part.trace.has_value();
  if (part.trace) {
    if (auto followed = follow(*part.trace, options, out); !followed) {
      return core::fail(placed(followed.error(), "axes"));
    }
  } else if (!part.main) {
    return core::fail(core::Code::kNoPoints,
                      "neither a trace of the axes nor a main journal shows f: give one of them",
                      "main");
  }
  auto pin =
      measured_contour(part.pin.angle_rad, part.pin.deviation_mm, gauge_options(options, false));
  if (!pin) return core::fail(placed(pin.error(), "pin"));
  out.pin = *std::move(pin);
  if (part.main) {
    auto main = measured_contour(part.main->angle_rad, part.main->deviation_mm,
                                 gauge_options(options, true));
    if (!main) return core::fail(placed(main.error(), "main"));
    out.main = *std::move(main);
  }
  if (!out.traced) {
    out.following.error_mm = above_main(out);
    out.following.peak_to_valley_mm = peak_to_valley(out.following.error_mm);
    out.following.rms_mm = core::root_mean_square(out.following.error_mm);
    out.direct = separate_contour(out.pin.contour.error_mm, out.following.error_mm);
    return out;
  }
  const CurvePair pair = {out.pin.contour.error_mm, out.following.error_mm};
  out.offset = correlation_offset({&pair, 1});
  if (options.method == ContourMethod::kAsPublished) {
    out.following.error_mm = turned_curve(out.following.error_mm, out.offset.angle_rad);
  }
  out.direct = separate_contour(out.pin.contour.error_mm, out.following.error_mm);
  if (out.main) out.indirect = indirect(out);
  return out;
}

core::Result<ContourStudy> contour_study(std::span<const ContourPart> parts,
                                         const ContourStudyOptions& options) {
  if (std::max(options.samples, options.axes.samples) > kMostSamples) {
    return core::fail_with(core::Code::kBadOption,
                           "{} samples of a contour and {} of the axes; the limit is {}",
                           options.samples, options.axes.samples, kMostSamples);
  }
  if (parts.empty()) {
    return core::fail(core::Code::kNoPoints, "no part is given; at least one is needed");
  }
  ContourStudy study;
  const bool traced = parts.front().trace.has_value();
  if (!traced && options.method == ContourMethod::kAsPublished) {
    return core::fail(core::Code::kBadOption,
                      "the method as-published turns what traces give; without traces it has "
                      "nothing to turn");
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].trace.has_value() != traced) {
      return core::fail_with(core::Code::kNoPoints,
                             "part {} has traces of the axes, part {} has none: give traces of all "
                             "parts, or of none",
                             traced ? 1 : i + 1, traced ? i + 1 : 1);
    }
    auto part = contour_part(parts[i], options);
    if (!part) {
      return core::fail(part.error().at(fmt::format("parts/{}/{}", i, part.error().where)));
    }
    study.parts.push_back(*std::move(part));
  }
  compare(study);
  collect_warnings(study);
  if (traced) diagnose(study, options);
  return study;
}

const std::vector<double>& mean_following(const ContourStudy& study) {
  return study.following ? study.following->mean_curve : study.parts.front().following.error_mm;
}

std::vector<double> x_table_mm(const ContourStudy& study, const CrankGeometry& geometry,
                               const XTableOptions& options) {
  const std::vector<double>& f = mean_following(study);
  std::vector<double> out;
  if (options.highest_order > 0) {
    // Through samples as fine as those of f: orders above the last one must not fold into the rows.
    const std::size_t samples = std::max(f.size(), options.rows);
    Spectrum half = spectrum(x_compensation_mm(geometry, f, samples));
    half.resize(static_cast<std::size_t>(options.highest_order) + 1);
    half.resize(options.rows / 2 + 1);
    const double scale = static_cast<double>(options.rows) / static_cast<double>(samples);
    for (Complex& one : half) one *= scale;
    out = series_of(half, options.rows);
  } else {
    out = x_compensation_mm(geometry, f, options.rows);
  }
  const double constant = core::mean(out);
  for (double& x : out) {
    x -= constant;
    if (options.resolution_mm > 0.0) {
      x = std::round(x / options.resolution_mm) * options.resolution_mm;
    }
  }
  return out;
}

double closed_at(std::span<const double> curve, double angle_rad) {
  const double turns = angle_rad / core::kTwoPi;
  const double place = (turns - std::floor(turns)) * static_cast<double>(curve.size());
  const double below = std::floor(place);
  const auto i = static_cast<std::size_t>(below) % curve.size();
  const double share = place - below;
  return (1.0 - share) * curve[i] + share * curve[(i + 1) % curve.size()];
}

}  // namespace rondure::fit
