#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/error.h"
#include "core/result.h"
#include "core/units.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/line.h"
#include "fit/least_squares/sphere.h"
#include "fit/proof/certificate.h"
#include "fit/references/min_zone_circle.h"
#include "fit/references/min_zone_cylinder.h"
#include "fit/references/min_zone_line.h"
#include "fit/references/min_zone_sphere.h"
#include "fit/references/one_sided_center.h"
#include "fit/references/one_sided_cylinder.h"
#include "fit/zone/deviation_range.h"
#include "record/csv/points.h"

namespace rondure::app {
namespace {

/// Centre of a circle (two numbers used) or sphere, or the axis of a cylinder or line.
struct FitPlace {
  std::optional<fit::Axis> axis;
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  int coordinates = 3;  ///< Coordinates of the centre: 2 for a circle.
};

/// The result of one reference, for any shape.
struct FitReference {
  FitPlace place;
  std::optional<double> radius_mm;        ///< For least squares, circumscribed, inscribed.
  std::optional<double> inner_radius_mm;  ///< For the minimum zone.
  std::optional<double> outer_radius_mm;
  std::optional<double> diameter_mm;  ///< For the minimum zone of a line.
  double deviation_mm = 0.0;
  std::optional<double> rms_mm;  ///< For least squares.
  std::vector<fit::Contact> outer;
  std::vector<fit::Contact> inner;
  std::optional<fit::Certificate> certificate;  ///< For all but least squares.
  std::optional<fit::DeviationRange> range;     ///< For an inscribed circle that is not unique.
};

/// Results of `rondure fit` for one set of points.
struct FitOutcome {
  struct Entry {
    std::string name;                   ///< "ls", "mz", "mc", "mi".
    std::string title;                  ///< "LSCI", "MZCY", ...
    std::optional<FitReference> found;  ///< Empty if it does not exist for these data.
  };
  std::string shape;
  std::size_t points = 0;
  std::vector<Entry> references;  ///< Those requested, in the order of the names above.
  std::vector<core::Error> warnings;
};

using Json = nlohmann::ordered_json;

Json place_json(const FitPlace& place) {
  const auto three = [](const Eigen::Vector3d& v) -> Json { return {v.x(), v.y(), v.z()}; };
  if (place.axis) {
    return {
        {"axis",
         {{"point_mm", three(place.axis->point_mm)}, {"direction", three(place.axis->direction)}}}};
  }
  Json center = three(place.center_mm);
  if (place.coordinates == 2) center.erase(2);
  return {{"center_mm", center}};
}

Json rows_json(const std::vector<fit::Contact>& contacts) {
  Json out = Json::array();
  for (const fit::Contact& c : contacts) out.push_back(c.index);
  return out;
}

Json reference_json(const FitReference& found) {
  Json out = place_json(found.place);
  const auto put = [&](const char* key, const std::optional<double>& value) {
    if (value) out[key] = *value;
  };
  put("radius_mm", found.radius_mm);
  put("inner_radius_mm", found.inner_radius_mm);
  put("outer_radius_mm", found.outer_radius_mm);
  put("diameter_mm", found.diameter_mm);
  out["deviation_mm"] = found.deviation_mm;
  if (found.range) out["deviation_range_mm"] = {found.range->low_mm, found.range->high_mm};
  put("rms_mm", found.rms_mm);
  if (!found.certificate) return out;
  out["contacts"] = Json::object();
  if (!found.outer.empty() || found.inner_radius_mm) {
    out["contacts"]["outer"] = rows_json(found.outer);
  }
  if (!found.inner.empty() || found.inner_radius_mm) {
    out["contacts"]["inner"] = rows_json(found.inner);
  }
  out["certificate"] = certificate_json(*found.certificate);
  return out;
}

std::string place_line(const FitPlace& place) {
  if (place.axis) {
    const Eigen::Vector3d& p = place.axis->point_mm;
    const Eigen::Vector3d& d = place.axis->direction;
    return fmt::format(
        "    axis through ({:.6f}, {:.6f}, {:.6f}) mm along ({:.9f}, {:.9f}, {:.9f})\n", p.x(),
        p.y(), p.z(), d.x(), d.y(), d.z());
  }
  const Eigen::Vector3d& c = place.center_mm;
  if (place.coordinates == 2) return fmt::format("    centre ({:.6f}, {:.6f}) mm\n", c.x(), c.y());
  return fmt::format("    centre ({:.6f}, {:.6f}, {:.6f}) mm\n", c.x(), c.y(), c.z());
}

std::string radii_line(const FitReference& found) {
  if (found.inner_radius_mm) {
    return fmt::format("    inner radius {:.6f} mm, outer radius {:.6f} mm\n",
                       *found.inner_radius_mm, *found.outer_radius_mm);
  }
  if (found.radius_mm) return fmt::format("    radius {:.6f} mm\n", *found.radius_mm);
  return {};
}

std::string proof_lines(const FitReference& found) {
  if (!found.certificate) return {};
  std::string out = "    contacts";
  for (const auto& c : found.outer) out += fmt::format(" +{}", c.index);
  for (const auto& c : found.inner) out += fmt::format(" -{}", c.index);
  out += " (+ outer, - inner, rows from 0)\n    " + certificate_text(*found.certificate);
  return out + "\n";
}

std::string reference_lines(const FitOutcome::Entry& entry) {
  if (!entry.found) return fmt::format("  {}  does not exist for these points\n", entry.title);
  const FitReference& found = *entry.found;
  std::string out =
      fmt::format("  {}  deviation {:.4f} um", entry.title, core::micrometres(found.deviation_mm));
  if (found.range) {
    out += fmt::format(", not unique: {:.4f} to {:.4f} um", core::micrometres(found.range->low_mm),
                       core::micrometres(found.range->high_mm));
  }
  if (found.rms_mm) out += fmt::format(", rms {:.4f} um", core::micrometres(*found.rms_mm));
  return out + "\n" + place_line(found.place) + radii_line(found) + proof_lines(found);
}

nlohmann::ordered_json fit_json(const FitOutcome& outcome) {
  Json out = {{"shape", outcome.shape}, {"points", outcome.points}};
  for (const FitOutcome::Entry& entry : outcome.references) {
    out[entry.name] = entry.found ? reference_json(*entry.found) : Json(nullptr);
  }
  out["warnings"] = warnings_json(outcome.warnings);
  return out;
}

std::string fit_table(const FitOutcome& outcome) {
  std::string out = fmt::format("{}, {} points\n", outcome.shape, outcome.points);
  for (const FitOutcome::Entry& entry : outcome.references) out += reference_lines(entry);
  return out + warnings_text(outcome.warnings);
}

using Space = std::span<const Eigen::Vector3d>;
using Plane = std::span<const Eigen::Vector2d>;

FitPlace place_of(const Eigen::Vector2d& center) {
  return {std::nullopt, {center.x(), center.y(), 0.0}, 2};
}
FitPlace place_of(const Eigen::Vector3d& center) { return {std::nullopt, center, 3}; }
FitPlace place_of(const fit::Axis& axis) { return {axis, Eigen::Vector3d::Zero(), 3}; }

/// Point at which the fit is given: on its axis, or its centre.
template <class Fit>
FitPlace place_of_fit(const Fit& fit) {
  if constexpr (requires { fit.axis; }) {
    return place_of(fit.axis);
  } else {
    return place_of(fit.center_mm);
  }
}

// The result of a fit as a reference.
constexpr auto kLeastSquares = [](const auto& fit) {
  FitReference out;
  out.place = place_of_fit(fit);
  if constexpr (requires { fit.radius_mm; }) out.radius_mm = fit.radius_mm;
  out.deviation_mm = fit.deviation_mm;
  out.rms_mm = fit.rms_mm;
  return out;
};
constexpr auto kMinimumZone = [](const auto& zone) {
  FitReference out;
  out.place = place_of_fit(zone);
  out.inner_radius_mm = zone.inner_radius_mm;
  out.outer_radius_mm = zone.outer_radius_mm;
  out.deviation_mm = zone.width_mm();
  out.outer = zone.outer;
  out.inner = zone.inner;
  out.certificate = zone.certificate;
  return out;
};
constexpr auto kCircumscribed = [](const auto& fit) {
  FitReference out;
  out.place = place_of_fit(fit);
  out.radius_mm = fit.radius_mm;
  out.deviation_mm = fit.deviation_mm;
  out.outer = fit.contacts;
  out.certificate = fit.certificate;
  return out;
};
constexpr auto kInscribed = [](const auto& fit) {
  FitReference out = kCircumscribed(fit);
  std::swap(out.outer, out.inner);
  return out;
};

/// Collects the references of one set of points.
class Collector {
 public:
  Collector(const std::string& shape, std::string reference, std::size_t points)
      : wanted_(std::move(reference)) {
    out_.shape = shape;
    out_.points = points;
  }

  [[nodiscard]] bool wants(const char* name) const { return wanted_ == "all" || wanted_ == name; }

  /// Adds a reference if it is wanted, or a warning that it does not exist; other errors end the
  /// fit.
  /// @param find  Returns the reference.
  template <class Find>
  void add(const char* name, const char* title, const Find& find) {
    if (!wants(name)) return;
    const core::Result<FitReference> found = find();
    if (found) {
      out_.references.push_back({name, title, *found});
      const auto& certificate = found->certificate;
      if (certificate && certificate->kind == fit::Certificate::Kind::kNone) {
        warn(core::Code::kNoCertificate, certificate->reason);
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

/// Warns about an arc, seen along the axis about the centre: the unseen part can only increase the
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
  const auto ls = fit::ls_circle(points);
  if (ls) warn_of_arc(points, ls->center_mm, collector);
  collector.add("ls", "LSCI", [&] { return ls.map(kLeastSquares); });
  if (collector.wants("mz")) {
    const auto mz = fit::min_zone_circle(points);
    collector.add("mz", "MZCI", [&] { return mz.map(kMinimumZone); });
    if (mz && mz->exact_fit) {
      collector.warn(core::Code::kExactFit,
                     "three different points lie on a circle exactly: the deviation says nothing "
                     "about form");
    }
  }
  collector.add("mc", "MCCI",
                [&] { return fit::min_circumscribed_circle(points).map(kCircumscribed); });
  collector.add("mi", "MICI", [&] {
    return fit::max_inscribed_circle(points).map([](const auto& circle) {
      FitReference out = kInscribed(circle);
      out.range = circle.range;
      return out;
    });
  });
  return collector.take();
}

core::Result<FitOutcome> fit_sphere(Space points, Collector collector) {
  collector.add("ls", "LSSP", [&] { return fit::ls_sphere(points).map(kLeastSquares); });
  collector.add("mz", "MZSP", [&] { return fit::min_zone_sphere(points).map(kMinimumZone); });
  collector.add("mc", "MCSP",
                [&] { return fit::min_circumscribed_sphere(points).map(kCircumscribed); });
  collector.add("mi", "MISP", [&] { return fit::max_inscribed_sphere(points).map(kInscribed); });
  return collector.take();
}

core::Result<FitOutcome> fit_cylinder(Space points, Collector collector) {
  const auto ls = fit::ls_cylinder(points);
  if (!ls) return core::fail(ls.error());
  collector.add("ls", "LSCY", [&] { return ls.map(kLeastSquares); });
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
  collector.add("mz", "MZCY",
                [&] { return fit::min_zone_cylinder(points, near, proof).map(kMinimumZone); });
  if (collector.wants("mc")) {
    const auto mc = fit::min_circumscribed_cylinder(points, near, proof);
    collector.add("mc", "MCCY", [&] { return mc.map(kCircumscribed); });
    warn_of_other(mc);
  }
  if (collector.wants("mi")) {
    const auto mi = fit::max_inscribed_cylinder(points, near, proof);
    collector.add("mi", "MICY", [&] { return mi.map(kInscribed); });
    warn_of_other(mi);
  }
  return collector.take();
}

core::Result<FitOutcome> fit_line(Space points, Collector collector) {
  collector.add("ls", "LSLI", [&] { return fit::ls_line(points).map(kLeastSquares); });
  collector.add("mz", "MZLI", [&] {
    return fit::min_zone_line(points).map([](const auto& zone) {
      FitReference out;
      out.place = place_of(zone.axis);
      out.diameter_mm = zone.diameter_mm;
      out.deviation_mm = zone.diameter_mm;
      out.outer = zone.contacts;
      out.certificate = zone.certificate;
      return out;
    });
  });
  return collector.take();
}

/// Fits the requested references of a shape. A reference that does not exist for the points is
/// empty in the outcome, with a warning that states the reason.
///
/// @param shape      "circle" (z is not used), "cylinder", "sphere", "line".
/// @param reference  "ls", "mz", "mc", "mi" or "all"; a line has "ls" and "mz".
/// @return The outcome, or why the points cannot be fitted at all.
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
  if (!table) return refuse(table.error());
  const auto outcome = fit_shape(arguments.shape, arguments.reference, table->points_mm);
  if (!outcome) {
    const core::Error& error = outcome.error();
    return refuse(error.at(error.where.empty() ? arguments.file : error.where));
  }
  return answer(fit_json(*outcome), arguments.json, [&] { return fit_table(*outcome); });
}

}  // namespace rondure::app
