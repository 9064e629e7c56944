#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/fit.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/result.h"
#include "core/units.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/line.h"
#include "fit/least_squares/sphere.h"
#include "fit/references/min_zone_circle.h"
#include "fit/references/min_zone_cylinder.h"
#include "fit/references/min_zone_line.h"
#include "fit/references/min_zone_sphere.h"
#include "fit/references/one_sided_center.h"
#include "fit/references/one_sided_cylinder.h"
#include "record/csv/points.h"

namespace rondure::app {
namespace {

using Space = std::span<const Eigen::Vector3d>;
using Plane = std::span<const Eigen::Vector2d>;

FitPlace place_of(const Eigen::Vector2d& center) {
  return {std::nullopt, {center.x(), center.y(), 0.0}, 2};
}
FitPlace place_of(const Eigen::Vector3d& center) { return {std::nullopt, center, 3}; }
FitPlace place_of(const fit::Axis& axis) { return {axis, Eigen::Vector3d::Zero(), 3}; }

template <class Ls>
FitReference least_squares(const Ls& ls, FitPlace place) {
  FitReference out;
  out.place = std::move(place);
  out.radius_mm = ls.radius_mm;
  out.deviation_mm = ls.deviation_mm;
  out.rms_mm = ls.rms_mm;
  return out;
}

template <class Zone>
FitReference minimum_zone(const Zone& zone, FitPlace place) {
  FitReference out;
  out.place = std::move(place);
  out.inner_radius_mm = zone.inner_radius_mm;
  out.outer_radius_mm = zone.outer_radius_mm;
  out.deviation_mm = zone.width_mm();
  out.outer = zone.outer;
  out.inner = zone.inner;
  out.certificate = zone.certificate;
  return out;
}

template <class Fit>
FitReference one_sided(const Fit& fit, FitPlace place, bool outside) {
  FitReference out;
  out.place = std::move(place);
  out.radius_mm = fit.radius_mm;
  out.deviation_mm = fit.deviation_mm;
  (outside ? out.outer : out.inner) = fit.contacts;
  out.certificate = fit.certificate;
  return out;
}

/// Collects the references of one set of points.
class Collector {
 public:
  Collector(const std::string& shape, std::string reference, std::size_t points)
      : wanted_(std::move(reference)) {
    out_.shape = shape;
    out_.points = points;
  }

  [[nodiscard]] bool wants(const char* name) const { return wanted_ == "all" || wanted_ == name; }

  /// Adds a reference, or says in a warning that it does not exist; other errors end the fit.
  void add(const char* name, const char* title, const core::Result<FitReference>& found) {
    if (found) {
      out_.references.push_back({name, title, *found});
      const auto& certificate = found->certificate;
      if (certificate && certificate->kind == fit::Certificate::Kind::kNone) {
        out_.warnings.push_back({core::Code::kNoCertificate, certificate->reason, {}});
      }
    } else if (found.error().code == core::Code::kReferenceAbsent) {
      out_.references.push_back({name, title, std::nullopt});
      out_.warnings.push_back(found.error());
    } else if (!failure_) {
      failure_ = found.error();
    }
  }
  void warn(core::Code code, std::string what) { out_.warnings.push_back({code, what, {}}); }

  [[nodiscard]] core::Result<FitOutcome> take() {
    if (failure_) return core::fail(*failure_);
    return std::move(out_);
  }

 private:
  std::string wanted_;
  FitOutcome out_;
  std::optional<core::Error> failure_;
};

/// The result of a fit as a reference.
template <class Fit, class Convert>
core::Result<FitReference> as_reference(const core::Result<Fit>& fit, const Convert& convert) {
  if (!fit) return core::fail(fit.error());
  return convert(*fit);
}

/// Warns about an arc, seen along the axis about the centre: the unseen part can only add to the
/// deviation.
void warn_of_arc(Plane points, const Eigen::Vector2d& center_mm, Collector& collector) {
  const double gap_rad = fit::largest_gap_rad(points, center_mm);
  const double step_rad = core::kTwoPi / static_cast<double>(points.size());
  if (gap_rad <= std::max(90.0 * core::kDegree, 1.5 * step_rad) * (1.0 + 1e-6)) return;
  collector.warn(core::Code::kNotFullSection,
                 fmt::format("the points leave {:.0f} deg of the turn unseen: the deviations are "
                             "those of an arc, and minimum zones are lower bounds of the whole",
                             gap_rad / core::kDegree));
}

core::Result<FitOutcome> fit_circle(Plane points, Collector collector) {
  if (const auto ls = fit::ls_circle(points)) warn_of_arc(points, ls->center_mm, collector);
  if (collector.wants("ls")) {
    collector.add("ls", "LSCI", as_reference(fit::ls_circle(points), [](const auto& f) {
                    return least_squares(f, place_of(f.center_mm));
                  }));
  }
  if (collector.wants("mz")) {
    const auto mz = fit::min_zone_circle(points);
    collector.add("mz", "MZCI", as_reference(mz, [](const auto& f) {
                    return minimum_zone(f, place_of(f.center_mm));
                  }));
    if (mz && mz->exact_fit) {
      collector.warn(core::Code::kExactFit,
                     "three different points lie on a circle exactly: the deviation says nothing "
                     "about form");
    }
  }
  if (collector.wants("mc")) {
    collector.add("mc", "MCCI",
                  as_reference(fit::min_circumscribed_circle(points), [](const auto& f) {
                    return one_sided(f, place_of(f.center_mm), true);
                  }));
  }
  if (collector.wants("mi")) {
    collector.add("mi", "MICI", as_reference(fit::max_inscribed_circle(points), [](const auto& f) {
                    FitReference out = one_sided(f, place_of(f.center_mm), false);
                    out.range = f.range;
                    return out;
                  }));
  }
  return collector.take();
}

core::Result<FitOutcome> fit_sphere(Space points, Collector collector) {
  if (collector.wants("ls")) {
    collector.add("ls", "LSSP", as_reference(fit::ls_sphere(points), [](const auto& f) {
                    return least_squares(f, place_of(f.center_mm));
                  }));
  }
  if (collector.wants("mz")) {
    collector.add("mz", "MZSP", as_reference(fit::min_zone_sphere(points), [](const auto& f) {
                    return minimum_zone(f, place_of(f.center_mm));
                  }));
  }
  if (collector.wants("mc")) {
    collector.add("mc", "MCSP",
                  as_reference(fit::min_circumscribed_sphere(points), [](const auto& f) {
                    return one_sided(f, place_of(f.center_mm), true);
                  }));
  }
  if (collector.wants("mi")) {
    collector.add("mi", "MISP", as_reference(fit::max_inscribed_sphere(points), [](const auto& f) {
                    return one_sided(f, place_of(f.center_mm), false);
                  }));
  }
  return collector.take();
}

core::Result<FitOutcome> fit_cylinder(Space points, Collector collector) {
  const auto ls = fit::ls_cylinder(points);
  if (!ls) return core::fail(ls.error());
  if (collector.wants("ls")) collector.add("ls", "LSCY", least_squares(*ls, place_of(ls->axis)));
  std::vector<Eigen::Vector2d> seen;
  seen.reserve(points.size());
  const auto across = fit::across(ls->axis.direction);
  for (const Eigen::Vector3d& p : points) {
    seen.emplace_back(across.transpose() * (p - ls->axis.point_mm));
  }
  warn_of_arc(seen, Eigen::Vector2d::Zero(), collector);
  const Eigen::Vector3d near = ls->axis.direction;
  // All directions, or, where that takes too long, those about the least-squares axis.
  const fit::AxisScope all{fit::AxisScope::Kind::kHalfSphere};
  const fit::AxisScope cone{fit::AxisScope::Kind::kCone, near};
  const fit::CylinderProofOptions proof{.scopes = {all, cone}, .search = {}};
  const auto warn_of_other = [&](const core::Result<fit::OneSidedCylinder>& f) {
    if (!f || !f->other) return;
    collector.warn(
        core::Code::kSeveralOptima,
        fmt::format("another cylinder of radius {:.6f} mm is better; its axis leans by "
                    "{:.3g} deg and lies {:.3g} mm off: it is not the one next to the "
                    "least-squares axis",
                    f->other->radius_mm, f->other->lean_rad / core::kDegree, f->other->apart_mm));
  };
  if (collector.wants("mz")) {
    const auto mz = fit::min_zone_cylinder(points, near, proof);
    collector.add("mz", "MZCY", as_reference(mz, [](const auto& f) {
                    return minimum_zone(f, place_of(f.axis));
                  }));
  }
  if (collector.wants("mc")) {
    const auto mc = fit::min_circumscribed_cylinder(points, near, proof);
    collector.add("mc", "MCCY", as_reference(mc, [](const auto& f) {
                    return one_sided(f, place_of(f.axis), true);
                  }));
    warn_of_other(mc);
  }
  if (collector.wants("mi")) {
    const auto mi = fit::max_inscribed_cylinder(points, near, proof);
    collector.add("mi", "MICY", as_reference(mi, [](const auto& f) {
                    return one_sided(f, place_of(f.axis), false);
                  }));
    warn_of_other(mi);
  }
  return collector.take();
}

core::Result<FitOutcome> fit_line(Space points, Collector collector) {
  if (collector.wants("ls")) {
    collector.add("ls", "LSLI", as_reference(fit::ls_line(points), [](const auto& f) {
                    FitReference out;
                    out.place = place_of(f.axis);
                    out.deviation_mm = f.deviation_mm;
                    out.rms_mm = f.rms_mm;
                    return out;
                  }));
  }
  if (collector.wants("mz")) {
    collector.add("mz", "MZLI", as_reference(fit::min_zone_line(points), [](const auto& f) {
                    FitReference out;
                    out.place = place_of(f.axis);
                    out.diameter_mm = f.diameter_mm;
                    out.deviation_mm = f.diameter_mm;
                    out.outer = f.contacts;
                    out.certificate = f.certificate;
                    return out;
                  }));
  }
  return collector.take();
}

/// Fits the requested references of a shape. A reference that does not exist for the points is
/// empty in the outcome, with a warning that gives the reason.
///
/// @param shape      "circle" (z is not used), "cylinder", "sphere", "line".
/// @param reference  "ls", "mz", "mc", "mi" or "all"; a line has "ls" and "mz".
/// @return Why the points cannot be fitted at all.
core::Result<FitOutcome> fit_shape(const std::string& shape, const std::string& reference,
                                   Space points_mm) {
  Collector collector(shape, reference, points_mm.size());
  if (shape == "cylinder") return fit_cylinder(points_mm, std::move(collector));
  if (shape == "sphere") return fit_sphere(points_mm, std::move(collector));
  if (shape == "line") return fit_line(points_mm, std::move(collector));
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(points_mm.size());
  for (const Eigen::Vector3d& p : points_mm) flat.emplace_back(p.head<2>());
  return fit_circle(flat, std::move(collector));
}

core::Result<record::PointTable> load_points(const FitArguments& arguments) {
  const auto bytes = record::read_file(arguments.file);
  if (!bytes) return core::fail(bytes.error());
  const std::string name = std::filesystem::path(arguments.file).filename().string();
  auto table = record::parse_points_csv(*bytes, name);
  if (!table) return table;
  const int needed = arguments.shape == "circle" ? 2 : 3;
  if (table->dimensions != needed) {
    return core::fail(core::Code::kSyntax,
                      fmt::format("a {} needs the columns {}, the file has {}", arguments.shape,
                                  needed == 2 ? "x,y" : "x,y,z", needed == 2 ? "x,y,z" : "x,y"),
                      name + ":1");
  }
  return table;
}

}  // namespace

int fit(const FitArguments& arguments) {
  const auto table = load_points(arguments);
  if (!table) {
    print_error(table.error());
    return kBadInput;
  }
  const auto outcome = fit_shape(arguments.shape, arguments.reference, table->points_mm);
  if (!outcome) {
    const core::Error& error = outcome.error();
    print_error(error.at(error.where.empty() ? arguments.file : error.where));
    return kBadInput;
  }
  return answer(fit_json(*outcome), arguments.json, [&] { return fit_table(*outcome); });
}

}  // namespace rondure::app
