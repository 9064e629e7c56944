#include "fit/wheel_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace rondure::fit {
namespace {

constexpr std::size_t kGrid = 2000;
constexpr int kPiecesPerRow = 4;
constexpr double kMostSteps = 1e6;
constexpr std::size_t kBlock = 64;

core::Result<void> check(double radius_mm, const WheelPathOptions& o) {
  if (!(radius_mm > 0.0) || !std::isfinite(radius_mm)) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("the wheel radius is {} mm; above 0 is needed", radius_mm));
  }
  if (!(o.to_mm > o.from_mm) || !std::isfinite(o.to_mm - o.from_mm)) {
    return core::fail(
        core::Code::kBadOption,
        fmt::format("the path runs from {} to {} mm; the end must lie above", o.from_mm, o.to_mm));
  }
  const bool steps = o.cusp_mm ? *o.cusp_mm > 0.0
                               : o.step_mm > 0.0 && (o.to_mm - o.from_mm) / o.step_mm <= kMostSteps;
  if (!steps) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("step {} mm, cusp {} mm: above 0, and at most {:.0f} steps, are "
                                  "needed",
                                  o.step_mm, o.cusp_mm.value_or(0.0), kMostSteps));
  }
  if (o.surface_from_mm.value_or(o.from_mm) > o.from_mm ||
      o.surface_to_mm.value_or(o.to_mm) < o.to_mm) {
    return core::fail(core::Code::kBadOption,
                      fmt::format("the surface, {} to {} mm, must hold the contacts, {} to {} mm",
                                  o.surface_from_mm.value_or(o.from_mm),
                                  o.surface_to_mm.value_or(o.to_mm), o.from_mm, o.to_mm));
  }
  if (o.load_limit > 0.0 && o.load_limit <= 1.0 && o.clearance_mm > 0.0) return {};
  return core::fail(core::Code::kBadOption,
                    fmt::format("limit of R k_s {} (0 to 1), clearance {} mm (above 0)",
                                o.load_limit, o.clearance_mm));
}

struct Sample {
  double x = 0.0;
  SurfacePoint surface;
};
using Samples = std::vector<Sample>;

/// Places over the whole surface: even ones, and those between the rows of a table.
core::Result<Samples> sample(const WheelSurface& surface, const WheelPathOptions& options) {
  const double from = options.surface_from_mm.value_or(options.from_mm);
  const double to = options.surface_to_mm.value_or(options.to_mm);
  std::vector<double> places;
  for (std::size_t i = 0; i <= kGrid; ++i) {
    places.push_back(from + (to - from) * static_cast<double>(i) / kGrid);
  }
  const std::vector<double> rows = surface.rows_mm();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    for (int k = 0; k <= kPiecesPerRow; ++k) {
      const double x = rows[i - 1] + (rows[i] - rows[i - 1]) * k / kPiecesPerRow;
      if (x >= from && x <= to) places.push_back(x);
    }
  }
  std::sort(places.begin(), places.end());
  // Places a rounding apart would leave nothing between neighbours to refine in.
  const double same = 1e-9 * (to - from);
  places.erase(
      std::unique(places.begin(), places.end(), [&](double a, double b) { return b - a <= same; }),
      places.end());
  Samples out;
  for (const double x : places) {
    const auto point = surface.at(x);
    if (!point) return core::fail(point.error());
    out.push_back({x, *point});
  }
  return out;
}

/// Place of the least `cost` between two x, by golden section. `cost` has one minimum there.
template <class Cost>
double least_between(double low, double high, const Cost& cost) {
  constexpr double kGolden = 0.6180339887498949;
  double x1 = high - kGolden * (high - low);
  double x2 = low + kGolden * (high - low);
  double c1 = cost(x1);
  double c2 = cost(x2);
  for (int i = 0; i < 60 && high - low > 1e-10; ++i) {
    if (c1 <= c2) {
      high = x2;
      x2 = x1;
      c2 = c1;
      x1 = high - kGolden * (high - low);
      c1 = cost(x1);
    } else {
      low = x1;
      x1 = x2;
      c1 = c2;
      x2 = low + kGolden * (high - low);
      c2 = cost(x2);
    }
  }
  return c1 <= c2 ? x1 : x2;
}

/// Least of sample and refinement around place i of n samples.
template <class Cost>
std::pair<double, double> refined(const Samples& samples, std::size_t i, const Cost& cost) {
  const double low = samples[i > 0 ? i - 1 : 0].x;
  const double high = samples[std::min(i + 1, samples.size() - 1)].x;
  const double x = least_between(low, high, cost);
  const double found = cost(x);
  const double there = cost(samples[i].x);
  return found < there ? std::pair(x, found) : std::pair(samples[i].x, there);
}

WheelLoad load_of(const WheelSurface& surface, const Samples& samples, double radius_mm) {
  WheelLoad out;
  std::size_t worst = 0;
  out.least_curvature_per_mm = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double k = samples[i].surface.curvature_per_mm();
    out.least_curvature_per_mm = std::min(out.least_curvature_per_mm, k);
    if (k > samples[worst].surface.curvature_per_mm()) worst = i;
  }
  const auto [x, cost] = refined(samples, worst, [&](double at) {
    const auto point = surface.at(at);
    return point ? -point->curvature_per_mm() : 0.0;
  });
  out.x_mm = x;
  out.load = -cost * radius_mm;
  return out;
}

/// A place for a sentence: no "-0", no digits of round-off.
double shown(double x_mm) { return std::round(x_mm * 1e4) / 1e4 + 0.0; }

core::Result<void> check_load(const WheelLoad& load, double radius_mm,
                              const WheelPathOptions& options) {
  if (load.load <= options.load_limit) return {};
  const double concave = load.concave_radius_mm(radius_mm);
  if (load.load >= 1.0) {
    return core::fail(
        core::Code::kGouge,
        fmt::format("wheel radius R = {:.6g} mm exceeds the concave radius of curvature {:.6g} mm "
                    "at x = {} mm; a wheel of at most {:.6g} mm can grind it",
                    radius_mm, concave, shown(load.x_mm), options.load_limit * concave));
  }
  return core::fail(
      core::Code::kGouge,
      fmt::format("wheel radius R = {:.6g} mm is {:.4f} of the concave radius of curvature {:.6g} "
                  "mm at x = {} mm; the limit is {} ({:.6g} mm)",
                  radius_mm, load.load, concave, shown(load.x_mm), options.load_limit,
                  options.load_limit * concave));
}

/// Samples of the surface in blocks with their boxes, so that those far from the wheel are passed
/// over.
class SurfaceBlocks {
 public:
  SurfaceBlocks(const WheelSurface& surface, const Samples& samples)
      : surface_(surface), samples_(samples) {
    for (std::size_t first = 0; first < samples.size(); first += kBlock) {
      Eigen::Array2d low(samples[first].x, samples[first].surface.height_mm);
      Eigen::Array2d high = low;
      for (std::size_t i = first; i < std::min(first + kBlock, samples.size()); ++i) {
        const Eigen::Array2d p(samples[i].x, samples[i].surface.height_mm);
        low = low.min(p);
        high = high.max(p);
      }
      boxes_.push_back({low, high});
    }
  }

  /// Least distance from a centre, `beyond` or less.
  [[nodiscard]] WheelClearance nearest(const Eigen::Vector2d& center, double beyond) const {
    double best = beyond * beyond;
    std::optional<std::size_t> place;
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      const Eigen::Array2d c = center.array();
      const Eigen::Array2d off = (boxes_[b].low - c).max(c - boxes_[b].high).max(0.0);
      if (off.square().sum() >= best) continue;
      for (std::size_t i = b * kBlock; i < std::min((b + 1) * kBlock, samples_.size()); ++i) {
        const double dx = samples_[i].x - center.x();
        const double dz = samples_[i].surface.height_mm - center.y();
        if (dx * dx + dz * dz >= best) continue;
        best = dx * dx + dz * dz;
        place = i;
      }
    }
    if (!place) return {beyond, center.x()};
    const auto [x, distance] = refined(samples_, *place, [&](double at) {
      const auto point = surface_.at(at);
      return point ? std::hypot(at - center.x(), point->height_mm - center.y()) : beyond;
    });
    return {distance, x};
  }

 private:
  struct Box {
    Eigen::Array2d low;
    Eigen::Array2d high;
  };
  const WheelSurface& surface_;
  const Samples& samples_;
  std::vector<Box> boxes_;
};

core::Result<void> check_contact(const WheelPathRow& row, const WheelPathOptions& options) {
  if (row.contact_rad >= options.least_contact_rad &&
      row.contact_rad <= options.greatest_contact_rad) {
    return {};
  }
  return core::fail(core::Code::kWheelArc,
                    fmt::format("the contact at x = {} mm lies {:.3f} deg from the wheel's lowest "
                                "point, outside its trued arc, {:.3f} to {:.3f} deg",
                                shown(row.x_mm), row.contact_rad / core::kDegree,
                                options.least_contact_rad / core::kDegree,
                                options.greatest_contact_rad / core::kDegree));
}

core::Result<WheelPathRow> row_at(const WheelSurface& surface, double x_mm, double radius_mm) {
  const auto point = surface.at(x_mm);
  if (!point) return core::fail(point.error());
  WheelPathRow row;
  row.x_mm = x_mm;
  row.surface = *point;
  const double q = point->stretch();
  row.center_mm = {x_mm - radius_mm * point->slope / q, point->height_mm + radius_mm / q};
  row.contact_rad = std::atan(point->slope);
  row.load = radius_mm * point->curvature_per_mm();
  return row;
}

core::Result<void> check_clearance(const WheelSurface& surface, const Samples& samples,
                                   const WheelPathOptions& options, WheelPath& path) {
  const SurfaceBlocks blocks(surface, samples);
  for (WheelPathRow& row : path.rows) {
    const WheelClearance least = blocks.nearest(row.center_mm, path.radius_mm);
    row.clearance_mm = least.distance_mm - path.radius_mm;
    if (row.clearance_mm >= -options.clearance_mm) continue;
    return core::fail(
        core::Code::kGouge,
        fmt::format("with contact at x = {} mm the wheel of radius {:.6g} mm is {:.3g} mm inside "
                    "the surface at x = {} mm; the limit is {} mm",
                    shown(row.x_mm), path.radius_mm, -row.clearance_mm, shown(least.x_mm),
                    options.clearance_mm));
  }
  return {};
}

core::Result<void> fill_rows(const WheelSurface& surface, const WheelPathOptions& options,
                             WheelPath& path) {
  const double length = options.to_mm - options.from_mm;
  // The slack keeps a whole number of steps from gaining one by round-off.
  const double steps = std::max(1.0, std::ceil(length / path.step_mm * (1.0 - 1e-12)));
  if (steps > kMostSteps) {
    return core::fail(
        core::Code::kBadOption,
        fmt::format("a cusp of {} um needs {:.0f} steps; the limit is {:.0f}",
                    options.cusp_mm.value_or(0.0) / core::kMicrometre, steps, kMostSteps));
  }
  path.step_mm = length / steps;
  const auto count = static_cast<std::size_t>(steps);
  for (std::size_t i = 0; i <= count; ++i) {
    const double share = static_cast<double>(i) / steps;
    const auto row = row_at(surface, options.from_mm + share * length, path.radius_mm);
    if (!row) return core::fail(row.error());
    if (auto checked = check_contact(*row, options); !checked) return checked;
    path.rows.push_back(*row);
  }
  return {};
}

}  // namespace

double WheelPath::machine_z_mm(const WheelPathRow& row) const {
  return row.center_mm.y() - (lowest_point ? radius_mm : 0.0);
}

double cusp_height_mm(double step_mm, double radius_mm, double curvature_per_mm) {
  return step_mm * step_mm / 8.0 * (1.0 / radius_mm - curvature_per_mm);
}

core::Result<WheelLoad> wheel_load(const WheelSurface& surface, double radius_mm,
                                   const WheelPathOptions& options) {
  if (auto checked = check(radius_mm, options); !checked) return core::fail(checked.error());
  const auto samples = sample(surface, options);
  if (!samples) return core::fail(samples.error());
  const WheelLoad load = load_of(surface, *samples, radius_mm);
  if (auto checked = check_load(load, radius_mm, options); !checked) {
    return core::fail(checked.error());
  }
  return load;
}

core::Result<std::vector<WheelClearance>> wheel_clearances(
    const WheelSurface& surface, std::span<const Eigen::Vector2d> centers_mm, double radius_mm,
    const WheelPathOptions& options) {
  if (auto checked = check(radius_mm, options); !checked) return core::fail(checked.error());
  const auto samples = sample(surface, options);
  if (!samples) return core::fail(samples.error());
  const SurfaceBlocks blocks(surface, *samples);
  std::vector<WheelClearance> out;
  for (const auto& center : centers_mm) out.push_back(blocks.nearest(center, 2.0 * radius_mm));
  return out;
}

core::Result<WheelPath> wheel_path(const WheelSurface& surface, double radius_mm,
                                   const WheelPathOptions& options) {
  if (auto checked = check(radius_mm, options); !checked) return core::fail(checked.error());
  const auto samples = sample(surface, options);
  if (!samples) return core::fail(samples.error());
  WheelPath path;
  path.radius_mm = radius_mm;
  path.lowest_point = options.lowest_point;
  path.load = load_of(surface, *samples, radius_mm);
  if (auto checked = check_load(path.load, radius_mm, options); !checked) {
    return core::fail(checked.error());
  }
  const double relief = 1.0 / radius_mm - path.load.least_curvature_per_mm;
  path.step_mm = options.cusp_mm ? std::sqrt(8.0 * *options.cusp_mm / relief) : options.step_mm;
  if (auto filled = fill_rows(surface, options, path); !filled) return core::fail(filled.error());
  path.cusp_mm = cusp_height_mm(path.step_mm, radius_mm, path.load.least_curvature_per_mm);
  if (auto clear = check_clearance(surface, *samples, options, path); !clear) {
    return core::fail(clear.error());
  }
  if (path.load.load > options.load_warning) {
    path.warnings.push_back(
        {core::Code::kLowMargin,
         fmt::format("R k_s reaches {:.4f} at x = {} mm, close to 1: the concave radius there is "
                     "{:.6g} mm",
                     path.load.load, shown(path.load.x_mm), path.load.concave_radius_mm(radius_mm)),
         {}});
  }
  return path;
}

}  // namespace rondure::fit
