#include "evaluation/part/internal/filtering.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/phrase.h"
#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/part/internal/asked_sections.h"
#include "evaluation/part/internal/layout.h"
#include "evaluation/part/internal/sections.h"
#include "fit/profiles/closed_profile.h"
#include "fit/profiles/harmonics.h"
#include "fit/profiles/open_profile.h"
#include "fit/profiles/profile_filter.h"

namespace rondure::evaluation {
namespace {

using Filter = record::Indication::Filter;

constexpr double kSameGeneratrixDeg = 0.5;
constexpr double kRoundOff = 1e-9;

core::Phrase words_of_filter(Filter filter) {
  switch (filter) {
    case Filter::kNone:
      break;
    case Filter::kGaussian:
      return core::phrase("gaussian");
    case Filter::kRobustGaussian:
      return core::phrase("robust gaussian");
    case Filter::kSpline:
      return core::phrase("spline");
  }
  return core::phrase("unfiltered");
}

fit::ProfileFilter fit_filter(Filter filter) {
  switch (filter) {
    case Filter::kNone:
      break;
    case Filter::kGaussian:
      return fit::ProfileFilter::kGaussian;
    case Filter::kRobustGaussian:
      return fit::ProfileFilter::kRobustGaussian;
    case Filter::kSpline:
      return fit::ProfileFilter::kSpline;
  }
  return fit::ProfileFilter::kNone;
}

core::Result<void> check_carries(const Spacing& spacing, int layer, double cutoff_upr) {
  if (carries(spacing, cutoff_upr)) return {};
  if (spacing.points * (1.0 + kRoundOff) < kProfilePointsPerUndulation * cutoff_upr) {
    return core::fail(error_of(
        core::Code::kSampling,
        core::phrase("layer {}: {:.0f} points in a turn are {:.2f} per undulation at {:g} UPR, at "
                     "least 7 are needed: {:.0f} points, or a cut-off of at most {:.4g} UPR; "
                     "scan, or plan filter \"none\"",
                     layer + 1, spacing.points, spacing.points / cutoff_upr, cutoff_upr,
                     std::ceil(kProfilePointsPerUndulation * cutoff_upr * (1.0 - kRoundOff)),
                     spacing.points / kProfilePointsPerUndulation)));
  }
  return core::fail(error_of(
      core::Code::kSampling,
      core::phrase("layer {}: the largest gap between angles is {:.4g} deg, {:g} UPR allow {:.4g} "
                   "deg (a quarter undulation): scan the whole turn, or plan filter \"none\"",
                   layer + 1, spacing.gap_rad / core::kDegree, cutoff_upr, 90.0 / cutoff_upr)));
}

/// Index of the entry nearest to an angle; entries ascend within a turn from 0.
std::size_t nearest(const std::vector<double>& theta_rad, double angle_rad) {
  if (angle_rad < 0.0) angle_rad += core::kTwoPi;
  const auto after = std::lower_bound(theta_rad.begin(), theta_rad.end(), angle_rad);
  const std::size_t n = theta_rad.size();
  const auto next = static_cast<std::size_t>(after - theta_rad.begin()) % n;
  const std::size_t last = (next + n - 1) % n;
  const auto apart = [&](std::size_t i) {
    return std::abs(std::remainder(angle_rad - theta_rad[i], core::kTwoPi));
  };
  return apart(last) < apart(next) ? last : next;
}

/// Content of a section close to the sampling limit.
struct NearLimit {
  int layer = 0;
  double tail_mm = 0.0;  ///< Root mean square above `from_upr`.
  double from_upr = 0.0;
  double rms_mm = 0.0;  ///< Of the filtered profile.
};

/// Adds a section that holds much close to the highest undulation that its points tell apart: what
/// lies beyond looks like lower ones (drawing, 6.5).
void find_near_limit(const fit::AngularProfile& measured, const std::vector<double>& filtered_mm,
                     int layer, std::vector<NearLimit>& out) {
  const auto even = fit::resampled(measured);
  const std::size_t n = measured.r_mm.size();
  if (!even) return;
  const auto table = fit::harmonics(
      even->profile, {.highest = static_cast<int>((n - 1) / 2), .override_sampling = true});
  if (!table) return;
  double squares = 0.0;
  for (const fit::Harmonic& harmonic : table->harmonics) {
    const bool high = 8.0 * harmonic.number > 3.0 * static_cast<double>(n);
    if (high) squares += 0.5 * harmonic.amplitude_mm * harmonic.amplitude_mm;
  }
  const double tail = std::sqrt(squares);
  const double mean = core::mean(filtered_mm);
  double sum = 0.0;
  for (const double r : filtered_mm) sum += (r - mean) * (r - mean);
  const double rms = std::sqrt(sum / static_cast<double>(filtered_mm.size()));
  constexpr double kMostShare = 0.1;
  constexpr double kLeastTailMm = 1e-6;  // the last digit of the sentence
  if (tail <= std::max(kMostShare * rms, kLeastTailMm)) return;
  out.push_back({layer, tail, 3.0 * static_cast<double>(n) / 8.0, rms});
}

/// One warning for all sections, about the worst. Passes of a layer follow each other.
void warn_of_aliasing(const std::vector<NearLimit>& sections, PreparedSurface& surface) {
  if (sections.empty()) return;
  const NearLimit& worst = *std::ranges::max_element(sections, {}, &NearLimit::tail_mm);
  int layers = 1;
  for (std::size_t i = 1; i < sections.size(); ++i) {
    if (sections[i].layer != sections[i - 1].layer) ++layers;
  }
  const core::Phrase place =
      layers == 1 ? core::phrase("layer {}", worst.layer + 1)
                  : core::phrase("layer {}, the worst of {}", worst.layer + 1, layers);
  surface.warnings.push_back(error_of(
      core::Code::kUndersampled,
      core::phrase("{}: content near the sampling limit, {:.3f} um rms above {:.0f} UPR, more "
                   "than a tenth of RONq {:.3f} um; scan denser",
                   place, worst.tail_mm / core::kMicrometre, worst.from_upr,
                   worst.rms_mm / core::kMicrometre)));
}

/// Filters one section about its circle.
/// @param near_limit  Where a warning is due; null: none is looked for.
core::Result<void> filter_section(PreparedSurface& surface, const SurfaceSection& section,
                                  const Eigen::Matrix<double, 3, 2>& frame,
                                  const fit::FilterOptions& options,
                                  std::vector<NearLimit>* near_limit) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(section.points.size());
  for (const std::size_t i : section.points) {
    points.emplace_back(frame.transpose() * (surface.points_mm[i] - surface.axis.point_mm));
  }
  TRY(const auto profile, round_profile(points));
  const fit::AngularProfile& measured = profile.by_angle;
  std::vector<Eigen::Vector2d> left_out;
  for (const std::size_t row : window_rows(surface, section)) {
    left_out.emplace_back(frame.transpose() *
                          (surface.of->cloud[row].tip_mm - surface.axis.point_mm));
  }
  const Spacing spacing = spacing_of(profile, left_out);
  if (auto checked = check_carries(spacing, section.layer, options.cutoff_upr); !checked) {
    return checked;
  }
  std::vector<double> filtered;
  if (section.gap) {
    TRY(filtered, fit::filter_with_windows(measured, options.cutoff_upr));
  } else {
    TRY(auto line, fit::filter_at_angles(measured, options));
    filtered = std::move(line.r_mm);
    if (near_limit != nullptr) find_near_limit(measured, filtered, section.layer, *near_limit);
  }
  const auto move = [&](std::size_t i, double r) {
    surface.points_mm[section.points[i]] += frame * ((r - profile.r_mm[i]) * profile.outward[i]);
  };
  if (measured.merged == 0) {
    for (std::size_t k = 0; k < filtered.size(); ++k) move(measured.rows[k], filtered[k]);
  } else {
    for (std::size_t i = 0; i < points.size(); ++i) {
      move(i, filtered[nearest(measured.theta_rad, profile.theta_rad[i])]);
    }
  }
  return {};
}

/// A point of a generatrix.
struct GeneratrixPoint {
  double height_mm = 0.0;
  double distance_mm = 0.0;
  std::size_t index = 0;
  std::size_t section = 0;
};

core::Error no_grid(double cutoff_mm, int layer) {
  return error_of(core::Code::kSampling,
                  core::phrase("layer {} has points at other angles than the others, so that no "
                               "generatrix carries a cut-off of {:g} mm along the axis; scan all "
                               "layers at the same angles, or leave cutoff_mm out",
                               layer + 1, cutoff_mm));
}

/// The points of the sections of one pass by angle about the axis, to 0.5 deg.
core::Result<std::vector<std::vector<GeneratrixPoint>>> grid_of(
    const PreparedSurface& surface, const std::vector<std::size_t>& sections, double cutoff_mm) {
  const fit::Axis& axis = surface.axis;
  const auto frame = fit::across(axis.direction);
  std::vector<double> angles;  // of the fullest section
  std::vector<std::vector<double>> all;
  for (const std::size_t s : sections) {
    std::vector<double>& of_section = all.emplace_back();
    for (const std::size_t i : surface.sections[s].points) {
      const Eigen::Vector2d v = frame.transpose() * (surface.points_mm[i] - axis.point_mm);
      const double angle = std::atan2(v.y(), v.x());
      of_section.push_back(angle < 0.0 ? angle + core::kTwoPi : angle);
    }
    if (of_section.size() > angles.size()) angles = of_section;
  }
  std::sort(angles.begin(), angles.end());
  std::vector<std::vector<GeneratrixPoint>> lines(angles.size());
  for (std::size_t j = 0; j < sections.size(); ++j) {
    const SurfaceSection& section = surface.sections[sections[j]];
    for (std::size_t k = 0; k < section.points.size(); ++k) {
      const std::size_t line = nearest(angles, all[j][k]);
      const double apart = std::abs(std::remainder(all[j][k] - angles[line], core::kTwoPi));
      const bool taken = !lines[line].empty() && lines[line].back().section == sections[j];
      if (taken || apart > kSameGeneratrixDeg * core::kDegree) {
        return core::fail(no_grid(cutoff_mm, section.layer));
      }
      const Eigen::Vector3d v = surface.points_mm[section.points[k]] - axis.point_mm;
      const double height = v.dot(axis.direction);
      lines[line].push_back(
          {height, (v - height * axis.direction).norm(), section.points[k], sections[j]});
    }
  }
  return lines;
}

/// A height at which there were points: a section, or a layer that windows took.
struct AxialLevel {
  double height_mm = 0.0;
  std::vector<double> left_out_rad;  ///< About the axis, ascending from 0.

  /// Whether a window took the place at an angle.
  [[nodiscard]] bool has_window(double angle_rad) const {
    if (left_out_rad.empty()) return false;
    const double other = left_out_rad[nearest(left_out_rad, angle_rad)];
    return std::abs(std::remainder(other - angle_rad, core::kTwoPi)) <=
           kSameGeneratrixDeg * core::kDegree;
  }
};

/// The levels of the sections of one pass, in their order, then those of layers that windows took.
std::vector<AxialLevel> axial_levels(const PreparedSurface& surface,
                                     const std::vector<std::size_t>& sections,
                                     std::optional<int> pass) {
  std::vector<AxialLevel> out;
  std::set<std::size_t> placed;
  const auto take = [&](std::size_t row, AxialLevel& level) {
    const double angle = angle_rad(surface, surface.of->cloud[row].tip_mm);
    level.left_out_rad.push_back(angle < 0.0 ? angle + core::kTwoPi : angle);
  };
  for (const std::size_t s : sections) {
    out.push_back({surface.sections[s].height_mm, {}});
    for (const std::size_t row : window_rows(surface, surface.sections[s])) {
      placed.insert(row);
      take(row, out.back());
    }
  }
  std::map<int, std::size_t> taken;  // layers
  for (const LeftOut& left : surface.left_out) {
    if (left.window.empty() || left.row >= surface.of->cloud.size()) continue;
    const CloudPoint& point = surface.of->cloud[left.row];
    if (placed.contains(left.row) || point.pass != pass) continue;
    // Without layers each point is a level of its own.
    const int layer = has_layers(*surface.of) ? point.layer : -1 - static_cast<int>(left.row);
    const auto [known, is_new] = taken.try_emplace(layer, out.size());
    if (is_new) {
      out.push_back({(point.tip_mm - surface.axis.point_mm).dot(surface.axis.direction), {}});
    }
    take(left.row, out[known->second]);
  }
  for (AxialLevel& level : out) std::ranges::sort(level.left_out_rad);
  return out;
}

double widest_step_mm(std::vector<double> heights_mm) {
  std::ranges::sort(heights_mm);
  double out = 0.0;
  for (std::size_t i = 1; i < heights_mm.size(); ++i) {
    out = std::max(out, heights_mm[i] - heights_mm[i - 1]);
  }
  return out;
}

/// Whether the sections stand close enough for a cut-off along the axis, and at every angle: only
/// places that a window took may lack.
core::Result<void> check_layers(const PreparedSurface& surface,
                                const std::vector<std::size_t>& sections,
                                const std::vector<std::vector<GeneratrixPoint>>& lines,
                                const std::vector<AxialLevel>& levels, double cutoff_mm) {
  std::vector<double> heights;
  for (const std::size_t s : sections) heights.push_back(surface.sections[s].height_mm);
  const double length =
      heights.empty() ? 0.0 : std::ranges::max(heights) - std::ranges::min(heights);
  std::vector<double> all;
  for (const AxialLevel& level : levels) all.push_back(level.height_mm);
  double apart = widest_step_mm(all);
  const double between_sections = widest_step_mm(heights);
  for (const auto& line : lines) {
    if (line.size() == sections.size() && between_sections <= apart) continue;
    const double angle = angle_rad(surface, surface.points_mm[line.front().index]);
    std::vector<double> seen;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      const bool here =
          k < sections.size() && std::ranges::any_of(line, [&](const GeneratrixPoint& point) {
            return point.section == sections[k];
          });
      if (here || levels[k].has_window(angle)) seen.push_back(levels[k].height_mm);
    }
    apart = std::max(apart, widest_step_mm(std::move(seen)));
  }
  const bool fine = heights.size() >= 3 &&
                    kProfilePointsPerUndulation * apart <= cutoff_mm * (1 + 1e-3) &&
                    length >= 2.0 * cutoff_mm;
  if (fine) return {};
  return core::fail(error_of(
      core::Code::kSampling,
      core::phrase("{} layers {:.4g} mm apart over {:.4g} mm do not carry a cut-off of {:g} mm "
                   "along the axis: at most {:.4g} mm apart and at least {:g} mm long; leave "
                   "cutoff_mm out",
                   heights.size(), apart, length, cutoff_mm,
                   cutoff_mm / kProfilePointsPerUndulation, 2.0 * cutoff_mm)));
}

/// Filters along the axis, at each angle, about the least-squares axis: 6.3 keeps straight lines.
core::Result<void> filter_along(PreparedSurface& surface, double cutoff_mm) {
  std::map<std::optional<int>, std::vector<std::size_t>> passes;
  for (std::size_t s = 0; s < surface.sections.size(); ++s) {
    const std::size_t row = surface.rows[surface.sections[s].points.front()];
    passes[surface.of->cloud[row].pass].push_back(s);
  }
  fit::OpenFilterOptions options;
  options.cutoff = cutoff_mm;
  options.windows = !surface.left_out.empty();
  options.override_sampling = true;  // check_layers() has looked, with a sentence of layers
  for (const auto& [pass, sections] : passes) {
    // A window may take whole layers, or some angles of them; the others still stand as planned.
    const auto levels = axial_levels(surface, sections, pass);
    if (auto checked = check_layers(surface, sections, {}, levels, cutoff_mm); !checked) {
      return checked;
    }
    TRY(auto lines, grid_of(surface, sections, cutoff_mm));
    if (auto checked = check_layers(surface, sections, lines, levels, cutoff_mm); !checked) {
      return checked;
    }
    for (std::vector<GeneratrixPoint>& line : lines) {
      std::sort(line.begin(), line.end(),
                [](const auto& a, const auto& b) { return a.height_mm < b.height_mm; });
      std::vector<double> heights;
      std::vector<double> distances;
      for (const GeneratrixPoint& point : line) {
        heights.push_back(point.height_mm);
        distances.push_back(point.distance_mm);
      }
      TRY(const auto mean, fit::filter_open(heights, distances, options));
      for (std::size_t i = 0; i < line.size(); ++i) {
        const fit::Axis& axis = surface.axis;
        Eigen::Vector3d& p = surface.points_mm[line[i].index];
        const Eigen::Vector3d v = p - axis.point_mm;
        const Eigen::Vector3d out = v - v.dot(axis.direction) * axis.direction;
        p += (mean.r_mm[i] / line[i].distance_mm - 1.0) * out;
      }
    }
  }
  return {};
}

/// The words of a filter that was applied.
core::Phrase operator_words(const record::Indication& indication, bool cylinder) {
  const core::Phrase name = words_of_filter(*indication.filter);
  if (!indication.cutoff_upr) {
    return core::phrase("{} {:g} mm along the axis, round none", name, *indication.cutoff_mm);
  }
  if (!cylinder) return core::phrase("{} {:g} UPR", name, *indication.cutoff_upr);
  if (!indication.cutoff_mm) {
    return core::phrase("{} {:g} UPR, axial none", name, *indication.cutoff_upr);
  }
  return core::phrase("{} {:g} UPR, {:g} mm along the axis", name, *indication.cutoff_upr,
                      *indication.cutoff_mm);
}

/// Whether the filter is defined for the shape and beside windows.
core::Result<void> check_filter(const PreparedSurface& surface,
                                const record::Indication& indication) {
  const record::Shape shape = surface.of->feature.shape;
  const bool turned = shape == record::Shape::kCylinder || shape == record::Shape::kCircle ||
                      shape == record::Shape::kCone;
  const core::Phrase name = words_of_filter(*indication.filter);
  if (!turned || surface.sections.empty()) {
    return core::fail(error_of(
        core::Code::kMeaning,
        core::phrase("only sections of a cylinder, a circle or a cone are filtered, and this {} "
                     "has none; plan filter \"none\"",
                     std::string(name_of(shape)))));
  }
  if (!indication.cutoff_upr && !(indication.cutoff_mm && shape == record::Shape::kCylinder)) {
    return core::fail(
        error_of(core::Code::kMissingKey,
                 core::phrase("the filter has no cut-off; give cutoff_upr, e.g. 50")));
  }
  constexpr double kLeastCutoff_upr = 2.0;
  if (indication.cutoff_upr && !(*indication.cutoff_upr >= kLeastCutoff_upr)) {
    return core::fail(error_of(
        core::Code::kMeaning,
        core::phrase("a cut-off of {:g} UPR leaves no form, which begins at 2; give cutoff_upr of "
                     "at least 2, e.g. 50",
                     *indication.cutoff_upr)));
  }
  if (*indication.filter == Filter::kGaussian) return {};
  if (indication.cutoff_mm && shape == record::Shape::kCylinder) {
    return core::fail(error_of(
        core::Code::kMeaning,
        core::phrase("the {} filter is not defined along the axis here; plan filter \"gaussian\", "
                     "or leave cutoff_mm out",
                     name)));
  }
  const bool gap = std::any_of(surface.sections.begin(), surface.sections.end(),
                               [](const SurfaceSection& section) { return section.gap; });
  if (gap) {
    return core::fail(error_of(
        core::Code::kMeaning,
        core::phrase("the {} filter is not defined beside a window; plan filter \"gaussian\" or "
                     "\"none\"",
                     name)));
  }
  return {};
}

}  // namespace

core::Result<void> filter(PreparedSurface& surface, const record::Indication& indication,
                          Warnings warnings) {
  surface.filter = core::phrase("unfiltered");
  if (indication.filter.value_or(Filter::kNone) == Filter::kNone) return {};
  if (auto checked = check_filter(surface, indication); !checked) return checked;
  const bool cylinder = surface.of->feature.shape == record::Shape::kCylinder;
  if (indication.cutoff_upr) {
    fit::FilterOptions options;
    options.filter = fit_filter(*indication.filter);
    options.cutoff_upr = *indication.cutoff_upr;
    const auto frame = fit::across(surface.axis.direction);
    std::vector<NearLimit> near_limit;
    for (SurfaceSection& section : surface.sections) {
      auto done = filter_section(surface, section, frame, options,
                                 warnings == Warnings::kFind ? &near_limit : nullptr);
      if (!done) return done;
      section.dense = true;
    }
    warn_of_aliasing(near_limit, surface);
  }
  if (indication.cutoff_mm && cylinder) {
    if (auto done = filter_along(surface, *indication.cutoff_mm); !done) return done;
  }
  surface.filter = operator_words(indication, cylinder);
  return {};
}

}  // namespace rondure::evaluation
