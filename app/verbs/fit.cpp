#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/fit_outcome.h"
#include "app/verbs/verbs.h"
#include "core/encodings.h"
#include "core/error.h"
#include "core/result.h"
#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/part/outliers.h"
#include "evaluation/results/measured_cloud.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cone.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/line.h"
#include "fit/least_squares/plane.h"
#include "fit/least_squares/sections.h"
#include "fit/least_squares/sphere.h"
#include "fit/profiles/form_parameters.h"
#include "fit/proof/certificate.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"
#include "fit/sizes/sizes.h"
#include "plans/checks/points_file.h"
#include "record/words.h"

namespace rondure::app {
namespace {

using Space = std::span<const Eigen::Vector3d>;
using Flat = std::span<const Eigen::Vector2d>;

FitPlace place_of(const Eigen::Vector2d& center) {
  return {.axis = {}, .plane = {}, .center_mm = {center.x(), center.y(), 0.0}, .coordinates = 2};
}
FitPlace place_of(const Eigen::Vector3d& center) {
  return {.axis = {}, .plane = {}, .center_mm = center};
}
FitPlace place_of(const fit::Axis& axis) { return {.axis = axis, .plane = {}}; }
FitPlace place_of(const fit::Plane& plane) { return {.axis = {}, .plane = plane}; }

/// Where a fit lies: its axis, its plane or its centre.
template <class Fit>
FitPlace place_of_fit(const Fit& fit) {
  if constexpr (requires { fit.axis; }) {
    return place_of(fit.axis);
  } else if constexpr (requires { fit.plane; }) {
    return place_of(fit.plane);
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
  out.two_sided = true;
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
  Collector(const FitArguments& arguments, std::size_t points) : wanted_(arguments.reference) {
    out_.shape = arguments.shape;
    out_.feature = core::well_formed(arguments.points.feature);  // a file may be in any encoding
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
      warn(found.error());
    } else {
      refuse(found.error());
    }
  }
  void warn(core::Code code, std::string what) { warn({code, std::move(what), {}}); }
  /// Once: a reference and a size may be absent for the same reason.
  void warn(const core::Error& warning) {
    const bool known = std::ranges::any_of(
        out_.warnings, [&](const core::Error& w) { return w.what == warning.what; });
    if (!known) out_.warnings.push_back(warning);
  }
  void refuse(const core::Error& error) {
    if (!failure_) failure_ = error;
  }
  void add(FitSizes sizes) { out_.sizes = std::move(sizes); }

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
void warn_of_arc(Flat points, const Eigen::Vector2d& center_mm, Collector& collector) {
  const double gap_rad = fit::largest_gap_rad(points, center_mm);
  const double step_rad = core::kTwoPi / static_cast<double>(points.size());
  if (gap_rad <= std::max(90.0 * core::kDegree, 1.5 * step_rad) * (1.0 + 1e-6)) return;
  collector.warn(core::Code::kNotFullSection,
                 fmt::format("the points leave {:.0f} deg of the turn unseen: the deviations are "
                             "those of an arc, and minimum zones are lower bounds of the whole",
                             gap_rad / core::kDegree));
}

void warn_of_arc(Space points, const fit::Axis& axis, Collector& collector) {
  std::vector<Eigen::Vector2d> seen;
  seen.reserve(points.size());
  const auto across = fit::across(axis.direction);
  for (const Eigen::Vector3d& p : points) {
    seen.emplace_back(across.transpose() * (p - axis.point_mm));
  }
  warn_of_arc(seen, Eigen::Vector2d::Zero(), collector);
}

fit::Material material_of(const FitArguments& arguments) {
  return {arguments.inside, 0.5 * arguments.tip_diameter_mm.value_or(0.0)};
}

/// Refuses a tip that leaves nothing of the part, as with a radius typed for a diameter.
void check_tip(const fit::Material& material, double diameter_mm, Collector& collector) {
  if (diameter_mm > 0.0) return;
  collector.refuse({core::Code::kMeaning,
                    fmt::format("with a tip of {:g} mm the diameter comes out as {:.6g} mm: check "
                                "--tip-diameter-mm; a bore needs --inside",
                                2.0 * material.tip_radius_mm, diameter_mm),
                    {}});
}

/// Adds the requested sizes. One that does not exist for the points is empty, with a warning that
/// states the reason.
/// @param global    Returns GG, GN, GX and GC for a material.
/// @param sections  Returns the sections for two-point sizes.
template <class Global, class Sections>
void add_sizes(const FitArguments& arguments, Collector& collector, const Global& global,
               const Sections& sections) {
  if (arguments.sizes.empty()) return;
  const auto wanted = [&](const char* name) {
    return std::ranges::find(arguments.sizes, name) != arguments.sizes.end();
  };
  FitSizes out;
  out.material = material_of(arguments);
  const auto found = global(out.material);
  const core::Result<double> none = found.map([](const auto&) { return 0.0; });
  if (!found && found.error().code == core::Code::kBadOption) {  // a tip that leaves no part
    collector.refuse(
        {core::Code::kMeaning,
         fmt::format("{}: check --tip-diameter-mm; a bore needs --inside", found.error().what),
         {}});
  }
  const std::array<std::pair<const char*, core::Result<double>>, 4> sizes = {
      {{"GG", found ? core::Result<double>(found->gg_mm) : none},
       {"GN", found ? core::Result<double>(found->gn_mm) : none},
       {"GX", found ? found->gx_mm : none},
       {"GC", found ? core::Result<double>(found->gc_mm) : none}}};
  const std::string_view mating = arguments.inside ? "GX" : "GN";
  for (const auto& [name, size] : sizes) {
    if (!wanted(name)) continue;
    out.global.push_back({name, size ? std::optional(*size) : std::nullopt, name != mating});
    if (!size) collector.warn(size.error());
  }
  out.local_wanted = wanted("LP");
  if (out.local_wanted) {
    const auto across = sections();
    const auto pairs = across
                           ? fit::two_point_sizes(*across, out.material)
                           : core::Result<std::vector<fit::LocalSize>>(core::fail(across.error()));
    if (pairs) out.local = fit::rank_sizes(*pairs);
    if (!pairs) collector.warn(pairs.error());
  }
  collector.add(std::move(out));
}

/// The sections of a cylinder: its layers, or groups of neighbouring heights.
core::Result<std::vector<fit::Section>> sections_of(const record::PointTable& table,
                                                    const fit::Axis& axis) {
  std::vector<std::vector<Eigen::Vector3d>> layers(static_cast<std::size_t>(table.layer_count()));
  for (std::size_t i = 0; i < table.layers.size(); ++i) {
    layers[static_cast<std::size_t>(table.layers[i])].push_back(table.points_mm[i]);
  }
  if (layers.empty()) {
    for (const auto& rows : fit::rows_by_height(table.points_mm, axis)) {
      layers.emplace_back();
      for (const std::size_t row : rows) layers.back().push_back(table.points_mm[row]);
    }
  }
  return fit::sections_across(layers, axis);
}

core::Result<FitOutcome> fit_circle(const FitArguments& arguments, const record::PointTable& table,
                                    Collector collector) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(table.points_mm.size());
  for (const Eigen::Vector3d& p : table.points_mm) points.emplace_back(p.head<2>());
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
  add_sizes(
      arguments, collector, [&](const auto& of) { return fit::global_sizes(points, of); },
      [&] { return fit::sections_across(std::span(&table.points_mm, 1), {}); });
  return collector.take();
}

core::Result<FitOutcome> fit_sphere(const FitArguments& arguments, Space points,
                                    Collector collector) {
  collector.add("ls", "LSSP", [&] { return fit::ls_sphere(points).map(kLeastSquares); });
  collector.add("mz", "MZSP", [&] { return fit::min_zone_sphere(points).map(kMinimumZone); });
  collector.add("mc", "MCSP",
                [&] { return fit::min_circumscribed_sphere(points).map(kCircumscribed); });
  collector.add("mi", "MISP", [&] { return fit::max_inscribed_sphere(points).map(kInscribed); });
  add_sizes(
      arguments, collector, [&](const auto& of) { return fit::global_sizes_of_sphere(points, of); },
      [] { return core::Result<std::vector<fit::Section>>(); });
  return collector.take();
}

core::Result<FitOutcome> fit_cylinder(const FitArguments& arguments,
                                      const record::PointTable& table, Collector collector) {
  const Space points = table.points_mm;
  const auto normal = table.layers.empty() ? std::nullopt : fit::layer_normal(points, table.layers);
  const auto ls = fit::ls_cylinder(points, normal);
  if (!ls) return core::fail(ls.error());
  collector.add("ls", "LSCY", [&] { return ls.map(kLeastSquares); });
  warn_of_arc(points, ls->axis, collector);
  if (!normal) {
    if (auto one = fit::check_only_cylinder(points, *ls); !one) collector.warn(one.error());
  }
  const Eigen::Vector3d near = ls->axis.direction;
  // All directions, or, where that takes too long, those about the least-squares axis.
  const fit::AxisScope all{fit::AxisScope::Kind::kHalfSphere};
  const fit::AxisScope cone{fit::AxisScope::Kind::kCone, near};
  fit::CylinderProofOptions proof{.scopes = {all, cone}, .search = {}};
  if (normal) proof.candidates = cone;
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
  add_sizes(
      arguments, collector, [&](const auto& of) { return fit::global_sizes(points, of); },
      [&] { return sections_of(table, ls->axis); });
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

core::Result<FitOutcome> fit_plane(const FitArguments& arguments, Space points,
                                   Collector collector) {
  std::optional<Eigen::Vector3d> outward;
  if (!arguments.outward.empty()) outward = Eigen::Vector3d(arguments.outward.data());
  TRY(const auto ls, fit::ls_plane(points, outward));
  const Eigen::Vector3d& normal = ls.plane.normal;
  constexpr double kLeastRise = 0.1;  // 6 deg out of the plane
  if (outward && !(outward->normalized().dot(normal) > kLeastRise)) {
    return core::fail_with(core::Code::kBadOption,
                           "--outward {:g},{:g},{:g} does not lead out of the plane, whose normal "
                           "is {:.3f},{:.3f},{:.3f}: give a direction out of the material",
                           outward->x(), outward->y(), outward->z(), normal.x(), normal.y(),
                           normal.z());
  }
  if (!outward) {
    collector.warn(core::Code::kMeaning,
                   fmt::format("the side of the material is not stated: peak, valley and outer "
                               "plane are those of a face towards {:.3f},{:.3f},{:.3f}; give "
                               "--outward",
                               normal.x(), normal.y(), normal.z()));
  }
  collector.add("ls", "LSPL", [&]() -> core::Result<FitReference> {
    TRY(const auto form, fit::flatness_parameters(points, ls.plane));
    FitReference out = kLeastSquares(ls);
    out.peak_mm = form.peak_mm;
    out.valley_mm = std::max(0.0, form.valley_mm);  // of a perfect plane it is -0
    return out;
  });
  collector.add("mz", "MZPL", [&] {
    return fit::min_zone_plane(points, outward).map([](const auto& zone) {
      FitReference out;
      out.place = place_of(zone.outer);
      out.deviation_mm = zone.width_mm;
      out.two_sided = true;
      out.outer = zone.top;
      out.inner = zone.bottom;
      out.certificate = zone.certificate;
      return out;
    });
  });
  return collector.take();
}

core::Result<FitOutcome> fit_cone(const FitArguments& arguments, Space points,
                                  Collector collector) {
  TRY(const auto ls, fit::ls_cone(points));
  warn_of_arc(points, ls.cone.axis, collector);
  const fit::Material material = material_of(arguments);
  const auto with_cone = [&](FitReference out, fit::Cone cone) {
    out.place = place_of(cone.axis);
    out.full_angle_deg = core::degrees(cone.full_angle_rad);
    cone.offset_mm = material.surface_radius_mm(cone.offset_mm);
    out.diameter_mm = cone.diameter_mm(0.0);
    check_tip(material, *out.diameter_mm, collector);
    return out;
  };
  collector.add("ls", "LSCO", [&]() -> core::Result<FitReference> {
    FitReference out;
    out.deviation_mm = ls.deviation_mm;
    out.rms_mm = ls.rms_mm;
    return with_cone(std::move(out), ls.cone);
  });
  collector.add("mz", "MZCO", [&] {
    return fit::min_zone_cone(points).map([&](const auto& zone) {
      FitReference out;
      out.deviation_mm = zone.width_mm;
      out.two_sided = true;
      out.outer = zone.outer;
      out.inner = zone.inner;
      out.certificate = zone.certificate;
      return with_cone(std::move(out), zone.cone);
    });
  });
  return collector.take();
}

/// Fits the requested references and sizes of a shape. A reference or size that does not exist for
/// the points is empty in the outcome, with a warning that states the reason.
/// @return The outcome, or why the points cannot be fitted at all.
core::Result<FitOutcome> fit_shape(const FitArguments& arguments, const record::PointTable& table) {
  Collector collector(arguments, table.points_mm.size());
  const Space points = table.points_mm;
  const std::string& shape = arguments.shape;
  if (shape == "cylinder") return fit_cylinder(arguments, table, std::move(collector));
  if (shape == "sphere") return fit_sphere(arguments, points, std::move(collector));
  if (shape == "line") return fit_line(points, std::move(collector));
  if (shape == "plane") return fit_plane(arguments, points, std::move(collector));
  if (shape == "cone") return fit_cone(arguments, points, std::move(collector));
  return fit_circle(arguments, table, std::move(collector));
}

/// Distances of the points from the least-squares feature, but for a constant.
std::vector<double> deviations_mm(const FitReference& ls, Space points) {
  std::vector<double> out;
  const double slope = ls.full_angle_deg ? std::tan(0.5 * *ls.full_angle_deg * core::kDegree) : 0.0;
  for (const Eigen::Vector3d& p : points) {
    if (ls.place.plane) {
      out.push_back(height_mm(*ls.place.plane, p));
    } else if (ls.place.axis) {
      const double along_mm = (p - ls.place.axis->point_mm).dot(ls.place.axis->direction);
      out.push_back(fit::distance_mm(*ls.place.axis, p) - slope * along_mm);
    } else if (ls.place.coordinates == 2) {
      out.push_back((p - ls.place.center_mm).head<2>().norm());
    } else {
      out.push_back((p - ls.place.center_mm).norm());
    }
  }
  return out;
}

/// Names the points that lie more than five robust scales off the least-squares feature, and the
/// share of the deviation that each of the seven farthest carries; the rows count from 0.
void warn_of_gross_points(const FitArguments& arguments, const record::PointTable& table,
                          FitOutcome& outcome) {
  FitArguments alone = arguments;
  alone.reference = "ls";
  alone.sizes.clear();
  const auto ls = fit_shape(alone, table);
  if (!ls || ls->references.empty() || !ls->references.front().found) return;
  const std::vector<double> off_mm = deviations_mm(*ls->references.front().found, table.points_mm);
  const std::vector<bool> far = evaluation::beyond_five_scales(off_mm);
  if (!evaluation::count_of_outliers(far)) return;  // so many are form
  const double middle_mm = core::median(off_mm);
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < far.size(); ++row) {
    if (far[row]) rows.push_back(row);
  }
  std::ranges::stable_sort(rows, std::greater(),
                           [&](std::size_t row) { return std::abs(off_mm[row] - middle_mm); });
  // Of all references the minimum zone, else the first that there is.
  const auto deciding = [](const FitOutcome& of) -> const FitOutcome::Entry* {
    const FitOutcome::Entry* out = nullptr;
    for (const FitOutcome::Entry& entry : of.references) {
      if (entry.found && (out == nullptr || entry.name == "mz")) out = &entry;
    }
    return out;
  };
  const FitOutcome::Entry* whole = deciding(outcome);
  if (whole == nullptr) return;
  alone.reference = whole->name;
  constexpr std::size_t kMostNamed = 7;
  const auto share_of = [&](std::span<const std::size_t> some) {
    std::vector<bool> gone(far.size(), false);
    for (const std::size_t row : some) gone[row] = true;
    record::PointTable without = table;
    without.points_mm.clear();
    without.layers.clear();
    for (std::size_t row = 0; row < gone.size(); ++row) {
      if (gone[row]) continue;
      without.points_mm.push_back(table.points_mm[row]);
      if (!table.layers.empty()) without.layers.push_back(table.layers[row]);
    }
    const auto rest = fit_shape(alone, without);
    const FitOutcome::Entry* other = rest ? deciding(*rest) : nullptr;
    if (other == nullptr) return std::string();
    return fmt::format(" {:.3f} of {:.3f} um",
                       core::micrometres(whole->found->deviation_mm - other->found->deviation_mm),
                       core::micrometres(whole->found->deviation_mm));
  };
  for (std::size_t i = 0; i < std::min(rows.size(), kMostNamed); ++i) {
    std::string said = fmt::format(
        "point {} lies {:+.3f} um off the least-squares feature, more than five robust "
        "scales",
        table.row(rows[i]), core::micrometres(off_mm[rows[i]] - middle_mm));
    if (const std::string share = share_of({&rows[i], 1}); !share.empty())
      said += "; it carries" + share;
    outcome.warnings.push_back({core::Code::kOutliers, std::move(said), {}});
  }
  if (rows.size() < 2) return;
  std::string said = fmt::format("together {} points lie that far off", rows.size());
  if (const std::string share = share_of(rows); !share.empty()) said += " and carry" + share;
  outcome.warnings.push_back({core::Code::kOutliers, std::move(said), {}});
}

/// Gives the contacts the rows of the file in place of those of the points that take part.
void name_rows(const record::PointTable& table, FitReference& found) {
  for (auto* const contacts : {&found.outer, &found.inner}) {
    for (fit::Contact& contact : *contacts) contact.index = table.row(contact.index);
  }
}

/// All of standard input.
core::Result<std::string> standard_input() {
  std::string out;
  std::string part(std::size_t{1} << 20, '\0');
  while (std::cin.read(part.data(), static_cast<std::streamsize>(part.size())) ||
         std::cin.gcount() > 0) {
    out.append(part, 0, static_cast<std::size_t>(std::cin.gcount()));
    if (out.size() > record::kMostPointsBytes) {
      return core::fail_with(core::Code::kFile, "standard input has more than {} bytes, the limit",
                             record::kMostPointsBytes);
    }
  }
  return out;
}

/// The plane of the points of a circle, as a frame with z along the normal.
Eigen::Isometry3d plane_of(const record::PointTable& table) {
  const std::vector<int> one(table.points_mm.size(), 0);
  Eigen::Vector3d normal =
      fit::layer_normal(table.points_mm, one).value_or(Eigen::Vector3d::UnitZ());
  Eigen::Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  if (normal[largest] < 0.0) normal = -normal;
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() << fit::across(normal), normal;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : table.points_mm) sum += p;
  out.translation() = sum / static_cast<double>(table.points_mm.size());
  return out;
}

}  // namespace

core::Result<record::PointTable> load_points(const FitArguments& arguments) {
  const bool piped = arguments.file == "-";
  TRY(const auto bytes,
      piped ? standard_input() : record::read_file(arguments.file, record::kMostPointsBytes));
  const std::string name =
      piped ? "standard input" : std::filesystem::path(arguments.file).filename().string();
  auto table = record::read_points(bytes, name, arguments.points);
  if (!table) return table;
  if (table->dimensions != 3 && arguments.shape != "circle") {
    return core::fail(
        core::Code::kSyntax,
        fmt::format("a {} needs the columns x,y,z, the file has x,y", arguments.shape),
        name + ":1");
  }
  return table;
}

int fit(const FitArguments& arguments) {
  auto table = load_points(arguments);
  if (!table) return refuse(table.error());
  std::optional<Eigen::Isometry3d> plane;
  if (arguments.shape == "circle" && table->dimensions == 3) {
    plane = plane_of(*table);
    for (Eigen::Vector3d& p : table->points_mm) p = plane->inverse() * p;
  }
  auto outcome = fit_shape(arguments, *table);
  if (!outcome) {
    const core::Error& error = outcome.error();
    return refuse(error.at(error.where.empty() ? arguments.file : error.where));
  }
  const auto shape = record::value_named<record::Shape>(arguments.shape);
  if (const auto doubt =
          plans::doubtful_unit(shape.value_or(record::Shape::kPlane), *table, arguments.file)) {
    return refuse(doubt->at(arguments.file));
  }
  outcome->read = table->read;
  if (table->repeated) outcome->warnings.push_back(evaluation::repeated_rows(*table->repeated));
  warn_of_gross_points(arguments, *table, *outcome);
  for (FitOutcome::Entry& entry : outcome->references) {
    if (entry.found) name_rows(*table, *entry.found);
    if (!plane || !entry.found) continue;
    entry.found->place.center_mm = *plane * entry.found->place.center_mm;
    entry.found->place.coordinates = 3;
    entry.found->place.normal = plane->linear().col(2);
  }
  return answer(fit_json(*outcome), arguments.json, [&] { return fit_table(*outcome); });
}

}  // namespace rondure::app
