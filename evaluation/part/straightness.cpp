#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/part/internal/asked_sections.h"
#include "evaluation/part/internal/families.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/measured_cloud.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/column_extremes.h"
#include "fit/least_squares/line.h"
#include "fit/profiles/generatrix.h"
#include "fit/references/min_zone.h"

namespace rondure::evaluation {
namespace {

using Indication = record::Indication;
using record::Form;
using record::Reference;

constexpr double kOneGeneratrix = 0.5 * core::kDegree;
constexpr std::size_t kFewestOnALine = 3;
constexpr int kDenseLines = 36;

/// A place of a section profile in polar coordinates about the axis of the surface.
struct ProfilePlace {
  double angle_rad = 0.0;
  double height_mm = 0.0;
  double distance_mm = 0.0;
  std::size_t point = 0;
};

/// A section as generatrices see it: its points, or the series through them.
class LineSection {
 public:
  LineSection(const PreparedSurface& surface, const SurfaceSection& section) : of_(section) {
    const SurfaceSection pass = by_pass(surface, section).front();
    for (const std::size_t i : pass.points) {
      const Eigen::Vector3d& p = surface.points_mm[i];
      places_.push_back({angle_rad(surface, p),
                         (p - surface.axis.point_mm).dot(surface.axis.direction),
                         fit::distance_mm(surface.axis, p), i});
    }
    for (const std::size_t row : window_rows(surface, section)) {
      left_out_rad_.push_back(angle_rad(surface, surface.of->cloud[row].tip_mm));
    }
  }

  [[nodiscard]] const SurfaceSection& of() const { return of_; }
  [[nodiscard]] bool closed() const { return of_.dense && !of_.gap && left_out_rad_.empty(); }
  /// Angles of the points and of those that a window takes out.
  [[nodiscard]] std::vector<double> angles_rad() const {
    std::vector<double> out = left_out_rad_;
    for (const ProfilePlace& place : places_) out.push_back(place.angle_rad);
    return out;
  }

  /// The place at an angle; nothing where a window takes it out.
  [[nodiscard]] core::Result<std::optional<ProfilePlace>> at(double angle_rad) const {
    const auto apart = [&](double other_rad) {
      return std::abs(std::remainder(other_rad - angle_rad, core::kTwoPi));
    };
    const auto nearest = std::ranges::min_element(
        places_, {}, [&](const ProfilePlace& place) { return apart(place.angle_rad); });
    if (apart(nearest->angle_rad) <= kOneGeneratrix) return *nearest;
    const auto named = [&](double other_rad) { return apart(other_rad) <= kOneGeneratrix; };
    if (std::ranges::any_of(left_out_rad_, named)) return std::nullopt;
    return core::fail(
        core::Code::kSampling,
        core::phrase("layer {} has no point within 0.5 deg of {:.3f} deg: touch all layers at the "
                     "same angles (sampling.stagger 0), or scan",
                     of_.layer + 1, core::degrees(angle_rad)));
  }

 private:
  SurfaceSection of_;
  std::vector<ProfilePlace> places_;
  std::vector<double> left_out_rad_;
};

/// Angles of the generatrices: those of all sections or, of dense ones, every 10 deg. A section
/// without a point at an angle of another refuses it in at(), so that no line is lost in silence.
std::vector<double> angles_of_lines(const std::vector<LineSection>& sections, bool dense) {
  std::vector<double> out;
  if (dense) {
    for (int i = 0; i < kDenseLines; ++i) out.push_back(core::kTwoPi * i / kDenseLines);
    return out;
  }
  out = sections.front().angles_rad();
  for (const LineSection& section : sections) {
    for (const double angle : section.angles_rad()) {
      const auto named = [&](double other_rad) {
        return std::abs(std::remainder(other_rad - angle, core::kTwoPi)) <= kOneGeneratrix;
      };
      if (std::ranges::none_of(out, named)) out.push_back(angle);
    }
  }
  return out;
}

/// The generatrices of dense sections, every 10 deg, by the harmonic series of their profiles.
core::Result<std::vector<TouchedLine>> series_lines(const PreparedSurface& surface,
                                                    const Sections& sections) {
  std::vector<fit::DenseSection> dense;
  for (const SurfaceSection& section : sections) {
    const SurfaceSection pass = by_pass(surface, section).front();
    TRY(const auto flat, projected(surface, std::span(&pass, 1)));
    auto profile = section_profile(flat.front());
    if (!profile) return core::fail(in_layer(section, profile.error()));
    dense.push_back({flat.front().circle.center_mm, core::mean(flat.front().heights_mm),
                     std::move(profile->profile)});
  }
  TRY(auto lines, fit::dense_generatrices(dense, kDenseLines));
  std::vector<TouchedLine> out;
  for (fit::Generatrix& line : lines) out.push_back({std::move(line), {}});
  return out;
}

/// The generatrices of a surface with three points and more.
/// @param opposite  Two of them are to lie in one plane.
core::Result<std::vector<TouchedLine>> lines_of(const PreparedSurface& surface, bool opposite) {
  TRY(const auto all, asked_sections(surface, {}));
  std::vector<LineSection> sections;
  for (const SurfaceSection& section : all) sections.emplace_back(surface, section);
  const bool dense = std::ranges::all_of(all, &SurfaceSection::dense);
  if (dense && std::ranges::all_of(sections, &LineSection::closed)) {
    return series_lines(surface, all);
  }
  std::vector<TouchedLine> out;
  for (const double angle : angles_of_lines(sections, dense)) {
    TouchedLine line;
    line.line.angle_rad = angle;
    for (const LineSection& section : sections) {
      TRY(const auto place, section.at(angle));
      if (!place) continue;
      line.line.heights_mm.push_back(place->height_mm);
      line.line.distances_mm.push_back(place->distance_mm);
      line.points.push_back(place->point);
    }
    if (line.line.heights_mm.size() >= kFewestOnALine) out.push_back(std::move(line));
  }
  if (!out.empty()) return out;
  return core::fail(core::Code::kSampling,
                    opposite ? core::phrase("no angle holds 3 points of different layers: "
                                            "sampling.stagger 0, at least 3 layers and an even "
                                            "number of points a layer, or a scan")
                             : core::phrase("no angle holds 3 points of different layers: "
                                            "sampling.stagger 0 and at least 3 layers, or a scan"));
}

/// lines_of(), once for each surface.
core::Result<std::span<const TouchedLine>> shared_lines(const PreparedSurface& surface,
                                                        bool opposite, SharedLines& shared) {
  if (!shared.found) {
    TRY(shared.found, lines_of(surface, opposite));
  }
  return std::span<const TouchedLine>(*shared.found);
}

/// An angle in the frame of across(), whose zero is any, as the cloud and the reports state it.
double stated_angle_rad(const PreparedSurface& surface, double angle_rad) {
  const Eigen::Vector3d& up = surface.axis.direction;
  const Eigen::Vector3d towards =
      fit::across(up) * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
  const Eigen::Vector2d q = frame_of_angles(*surface.of, up).transpose() * towards;
  const double stated = std::atan2(q.y(), q.x());
  return stated < -core::kSameAngle ? stated + core::kTwoPi : std::max(stated, 0.0);
}

/// Deviations from the least-squares line, out of the material.
ProfileLine picture_of(const PreparedSurface& surface, const TouchedLine& line,
                       const fit::GeneratrixStraightness& straight) {
  const auto& heights = line.line.heights_mm;
  const auto& distances = line.line.distances_mm;
  const auto count = static_cast<double>(heights.size());
  double mean_height = 0.0;
  double mean_distance = 0.0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    mean_height += heights[i] / count;
    mean_distance += distances[i] / count;
  }
  const double sign = surface.material.sign();
  ProfileLine out{stated_angle_rad(surface, line.line.angle_rad), heights, {}};
  for (std::size_t i = 0; i < heights.size(); ++i) {
    out.deviation_mm.push_back(
        sign * (distances[i] - mean_distance - straight.ls_slope * (heights[i] - mean_height)) /
        std::hypot(1.0, straight.ls_slope));
  }
  return out;
}

core::Result<void> check_straightness(const record::Characteristic& asked) {
  if (asked.reference != Reference::kMinimumZone && asked.reference != Reference::kLeastSquares) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("straightness has no circumscribed and no inscribed reference; "
                                   "plan reference \"mz\" or \"ls\""));
  }
  const Indication& indication = asked.indication;
  if (indication.parameter == Indication::Parameter::kTotal) return {};
  if (indication.of == Indication::Of::kMedianLine) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("peak, valley and rms are of a generatrix; a median line has "
                                   "the parameter \"total\" only"));
  }
  if (asked.reference == Reference::kLeastSquares) return {};
  return core::fail(core::Code::kMeaning,
                    core::phrase("peak, valley and rms are defined about the least-squares "
                                 "reference; plan reference \"ls\""));
}

double value_of_line(const fit::GeneratrixStraightness& straight,
                     const record::Characteristic& asked, bool inside) {
  if (asked.reference == Reference::kMinimumZone) return straight.zone_mm;
  switch (asked.indication.parameter) {
    case Indication::Parameter::kTotal:
      return straight.ls.total_mm;
    // Distances grow out of the material of a shaft, into that of a bore.
    case Indication::Parameter::kPeak:
      return inside ? straight.ls.valley_mm : straight.ls.peak_mm;
    case Indication::Parameter::kValley:
      return inside ? straight.ls.peak_mm : straight.ls.valley_mm;
    case Indication::Parameter::kRms:
      return straight.ls.rms_mm;
  }
  return straight.ls.total_mm;
}

/// Marks the greatest local value as the one that decides. Generatrices that are not seen can only
/// add to it.
void judge_worst(const PreparedSurface& surface, const record::Characteristic& asked,
                 Finding& out) {
  const auto worst = std::ranges::max_element(out.local, {}, &LocalValue::value_mm);
  out.worst = static_cast<std::size_t>(worst - out.local.begin());
  out.judged.push_back({symbol_of(asked), worst->value_mm, limits_of(asked)});
  if (asked.tolerance_mm && worst->value_mm > *asked.tolerance_mm) return;
  out.no_verdict = unseen_part(surface, surface.sections, surface.axis);
}

core::Result<Finding> find_generatrices(const PreparedSurface& surface,
                                        const record::Characteristic& asked, SharedLines& shared) {
  TRY(const auto lines, shared_lines(surface, false, shared));
  Finding out;
  for (const TouchedLine& line : lines) {
    TRY(const auto straight,
        fit::generatrix_straightness(line.line.heights_mm, line.line.distances_mm));
    out.local.push_back({.place = LocalValue::Place::kAngle,
                         .position = stated_angle_rad(surface, line.line.angle_rad),
                         .value_mm = value_of_line(straight, asked, surface.material.inside)});
    out.lines.push_back(picture_of(surface, line, straight));
  }
  judge_worst(surface, asked, out);
  add_rows(surface, lines[out.worst].points, out);
  out.reference =
      core::phrase("{} of each generatrix",
                   core::as_it_is(asked.reference == Reference::kMinimumZone ? "MZLI" : "LSLI"));
  return out;
}

core::Result<Finding> find_median_line(const PreparedSurface& surface,
                                       const record::Characteristic& asked, Proof proof) {
  TRY(const auto all, asked_sections(surface, {}));
  if (all.size() < kFewestOnALine) {
    return core::fail(core::Code::kRank,
                      core::phrase("{} sections; a median line of 2 is straight whatever the part: "
                                   "plan at least 3 layers",
                                   all.size()));
  }
  TRY(const auto sections, projected(surface, all));
  Finding out;
  out.centers_mm = fit::median_line(sections);
  double value_mm = 0.0;
  if (asked.reference == Reference::kLeastSquares) {
    TRY(const auto line, fit::median_line_straightness(out.centers_mm));
    value_mm = line.deviation_mm;
  } else {
    TRY(const auto line, fit::min_zone_line(out.centers_mm, proof));
    value_mm = line.diameter_mm;
    // Centres on one line to a picometre leave a certificate nothing to hold on to.
    constexpr double kStraight = 1e-9;
    if (proof == Proof::kFull && value_mm > kStraight &&
        line.certificate.kind == fit::Certificate::Kind::kNone) {
      out.no_verdict =
          core::phrase("no certificate stands behind the {}",
                       core::Phrase(words_of(asked.reference, record::Shape::kCylinder)));
    }
  }
  out.judged.push_back({symbol_of(asked), value_mm, limits_of(asked)});
  const char* reference = asked.reference == Reference::kMinimumZone ? "MZLI" : "LSLI";
  out.reference = core::phrase("{} of the median line", core::as_it_is(reference));
  if (proof == Proof::kNone) return out;
  if (!out.no_verdict) out.no_verdict = unseen_part(surface, all, surface.axis);
  return out;
}

/// Taper and parallelism of the generatrices, in every plane that holds two.
core::Result<Finding> find_taper(const PreparedSurface& surface,
                                 const record::Characteristic& asked, SharedLines& shared) {
  TRY(const auto lines, shared_lines(surface, true, shared));
  std::vector<fit::Generatrix> generatrices;
  for (const TouchedLine& line : lines) generatrices.push_back(line.line);
  const double length_mm = fit::extremes_of(surface.points_mm, [&](const Eigen::Vector3d& p) {
                             return (p - surface.axis.point_mm).dot(surface.axis.direction);
                           }).width();
  const auto planes = fit::opposite_generatrices(generatrices, length_mm);
  if (!planes) {
    if (planes.error().code != core::Code::kSampling) return core::fail(planes.error());
    return core::fail(core::Code::kSampling,
                      core::phrase("no two generatrices lie opposite each other to 0.5 deg: plan "
                                   "an even number of points a layer, or a scan"));
  }
  TRY(const auto mean, fit::taper(surface.points_mm, surface.axis));
  Finding out;
  for (const fit::OppositeGeneratrices& plane : *planes) {
    out.local.push_back(
        {.place = LocalValue::Place::kAngle,
         .position = stated_angle_rad(surface, plane.angle_rad),
         .value_mm = asked.form == Form::kTaper ? plane.taper_mm : plane.parallelism_mm});
  }
  judge_worst(surface, asked, out);
  for (const TouchedLine& line : lines) {
    const double turn = line.line.angle_rad - (*planes)[out.worst].angle_rad;
    if (std::abs(std::remainder(turn, 0.5 * core::kTwoPi)) > kOneGeneratrix) continue;
    add_rows(surface, line.points, out);
    const auto straight =
        fit::generatrix_straightness(line.line.heights_mm, line.line.distances_mm);
    if (straight) out.lines.push_back(picture_of(surface, line, *straight));
  }
  // Fewer than half of them by the points alone: what a window takes out is known.
  const bool window =
      std::ranges::any_of(surface.left_out, [](const LeftOut& l) { return !l.window.empty(); });
  if (!window && 4 * planes->size() < lines.size()) {
    out.no_verdict = core::phrase(
        "{} of {} generatrices have one opposite to them: the taper of the others is not known; "
        "plan an even number of points a layer, or a scan",
        2 * planes->size(), lines.size());
  }
  // A change of diameter over the length: of a cone twice the taper of a plane, which is judged.
  out.numbers.push_back({"diameter change over length", mean.diameter_mm});
  out.numbers.push_back({"cone_angle_deg", core::degrees(mean.cone_angle_rad), false});
  out.reference = core::phrase("{} of opposite generatrices", core::as_it_is("LSLI"));
  return out;
}

}  // namespace

core::Result<Finding> find_straightness(const PreparedSurface& surface,
                                        const record::Characteristic& asked, Proof proof,
                                        SharedLines& shared) {
  if (asked.form != Form::kStraightness) return find_taper(surface, asked, shared);
  TRY_DO(check_straightness(asked));
  if (asked.indication.of == Indication::Of::kMedianLine) {
    return find_median_line(surface, asked, proof);
  }
  return find_generatrices(surface, asked, shared);
}

}  // namespace rondure::evaluation
