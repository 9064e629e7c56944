#include "tests/plans/true_part.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include "core/decompositions.h"
#include "core/units.h"
#include "plans/analyses/features.h"
#include "plans/cell/internal/hidden_errors.h"
#include "plans/path/sampling.h"
#include "tests/plans/least_greatest.h"

namespace rondure::plans {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using record::Form;
using record::Shape;
using Indication = record::Indication;

constexpr int kAround = 1440;  // even, and a multiple of the ten degrees of generatrices
constexpr int kUnknowns = 4;   // of an axis: place and slopes

/// A straight line that rises along the part axis.
struct Line {
  Vector3d point = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitZ();

  [[nodiscard]] Vector3d radial(const Vector3d& p) const {
    const Vector3d w = p - point;
    return w - w.dot(direction) * direction;
  }
  [[nodiscard]] double height(const Vector3d& p) const { return (p - point).dot(direction); }
};

/// A feature of the noise-free part, part frame.
struct Truth {
  const FeaturePlan* plan = nullptr;
  const record::Feature* asked = nullptr;
  std::string letter;
  cmm::SimulatedPart::Placed placed;
  std::vector<double> places_mm;  ///< Heights of the sections, radii of the circles of a plane.
  std::vector<std::vector<Vector3d>> sections;

  [[nodiscard]] double side() const { return plan->side == record::Side::kInside ? -1.0 : 1.0; }
  [[nodiscard]] std::vector<Vector3d> all() const {
    std::vector<Vector3d> out;
    for (const auto& section : sections) out.insert(out.end(), section.begin(), section.end());
    return out;
  }
  /// The point of a section, or of the circle about `axis`, at an angle.
  [[nodiscard]] Vector3d at(double place_mm, double theta_rad, const Line& axis) const;
};

Vector3d on_face(const cmm::SimulatedPart::Placed& placed, const cmm::FaceSurface& face,
                 double radius_mm, double theta_rad, const Line& axis) {
  // Out of the axis square to it, then along it onto the face.
  const Vector3d across = (Vector3d::UnitX() - axis.direction.x() * axis.direction).normalized();
  const Vector3d foot =
      axis.point + radius_mm * (std::cos(theta_rad) * across +
                                std::sin(theta_rad) * axis.direction.cross(across));
  const Eigen::Isometry3d X_SP = placed.X_PS.inverse();
  double along_mm = 0.0;
  for (int i = 0; i < 20; ++i) {
    const Vector3d p = X_SP * Vector3d(foot + along_mm * axis.direction);
    const double off_mm = face.height_at(p.x(), p.y()) - p.z();
    along_mm += off_mm / (X_SP.linear() * axis.direction).z();
    if (std::abs(off_mm) < 1e-14) break;
  }
  return foot + along_mm * axis.direction;
}

Vector3d Truth::at(double place_mm, double theta_rad, const Line& axis) const {
  if (const auto* face = std::get_if<cmm::FaceSurface>(&placed.surface)) {
    return on_face(placed, *face, place_mm, theta_rad, axis);
  }
  const auto* round = std::get_if<cmm::PartSurface>(&placed.surface);
  const auto point = [&](double z_mm) {
    if (round == nullptr) {
      const auto& ball = std::get<cmm::BallSurface>(placed.surface);
      const double rise = std::clamp(z_mm / ball.radius_mm, -1.0, 1.0);
      const double flat = std::sqrt(1.0 - rise * rise);
      const Vector3d u(flat * std::cos(theta_rad), flat * std::sin(theta_rad), rise);
      return Vector3d(placed.X_PS * Vector3d(ball.radius_at(u) * u));
    }
    const double r = round->radius_at(theta_rad, z_mm);
    return Vector3d(placed.X_PS * Vector3d(r * std::cos(theta_rad), r * std::sin(theta_rad), z_mm));
  };
  double z_mm = place_mm - placed.X_PS.translation().z();
  Vector3d out = point(z_mm);
  for (int i = 0; i < 20 && std::abs(out.z() - place_mm) > 1e-13; ++i) {
    z_mm += place_mm - out.z();
    out = point(z_mm);
  }
  return out;
}

/// The greatest value of a function of the angle, refined where samples are greatest.
double greatest_around(const std::function<double(double)>& value) {
  const double step = core::kTwoPi / kAround;
  double best = -std::numeric_limits<double>::infinity();
  double at = 0.0;
  for (int i = 0; i < kAround; ++i) {
    const double here = value(i * step);
    if (here > best) std::tie(best, at) = std::pair(here, i * step);
  }
  for (double width = step; width > 1e-10; width *= 0.7) {
    for (const double beside : {at - 0.5 * width, at + 0.5 * width}) {
      const double here = value(beside);
      if (here > best) std::tie(best, at) = std::pair(here, beside);
    }
  }
  return best;
}

double least_around(const std::function<double(double)>& value) {
  return -greatest_around([&](double theta) { return -value(theta); });
}

Line line_of(const VectorXd& x, double middle_mm) {
  return {Vector3d(x[0], x[1], middle_mm), Vector3d(x[2], x[3], 1.0).normalized()};
}

double middle_of(const std::vector<Vector3d>& points) {
  double sum = 0.0;
  for (const Vector3d& p : points) sum += p.z();
  return sum / static_cast<double>(points.size());
}

/// sign * distance of each point from the line, with the gradient in its place and slopes.
Functions distances(const std::vector<Vector3d>& points, const VectorXd& x, double middle_mm,
                    double sign) {
  const Line line = line_of(x, middle_mm);
  const double length = std::sqrt(1.0 + x[2] * x[2] + x[3] * x[3]);
  Functions out{VectorXd(static_cast<Index>(points.size())),
                MatrixXd(static_cast<Index>(points.size()), kUnknowns)};
  for (Index i = 0; i < out.value.size(); ++i) {
    const Vector3d& p = points[static_cast<std::size_t>(i)];
    const Vector3d radial = line.radial(p);
    const double d = radial.norm();
    const Vector3d u = d > 0.0 ? Vector3d(radial / d) : Vector3d::Zero();
    const double lever = line.height(p) / length;
    out.value[i] = sign * d;
    out.gradient.row(i) << -sign * u.x(), -sign * u.y(), -sign * lever * u.x(),
        -sign * lever * u.y();
  }
  return out;
}

/// Which axis of one surface or of several: by the greatest distances (circumscribed, for a bore
/// inscribed), by the least width, by least squares, or the other way round than `kOneSided`.
enum class Fit { kMating, kOpposite, kZone, kLeastSquares };

/// Least squares with a radius for each surface.
std::optional<Line> least_squares(const std::vector<std::vector<Vector3d>>& surfaces,
                                  double middle_mm) {
  VectorXd x = VectorXd::Zero(kUnknowns);
  for (int i = 0; i < 50; ++i) {
    MatrixXd normal = MatrixXd::Zero(kUnknowns, kUnknowns);
    VectorXd right = VectorXd::Zero(kUnknowns);
    for (const auto& points : surfaces) {
      Functions d = distances(points, x, middle_mm, 1.0);
      const Eigen::RowVectorXd mean = d.gradient.colwise().mean();
      d.gradient.rowwise() -= mean;
      d.value.array() -= d.value.mean();
      normal += d.gradient.transpose() * d.gradient;
      right -= d.gradient.transpose() * d.value;
    }
    normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();
    const VectorXd step = core::solve_ldlt(normal, right);
    x += step;
    if (step.norm() < 1e-14) return line_of(x, middle_mm);
  }
  return std::nullopt;
}

std::optional<Line> axis_of(const std::vector<const Truth*>& of, Fit fit) {
  std::vector<std::vector<Vector3d>> surfaces;
  std::vector<Vector3d> all;
  for (const Truth* truth : of) {
    surfaces.push_back(truth->all());
    all.insert(all.end(), surfaces.back().begin(), surfaces.back().end());
  }
  const double middle_mm = middle_of(all);
  const auto start = least_squares(surfaces, middle_mm);
  if (!start || fit == Fit::kLeastSquares) return start;
  VectorXd x(kUnknowns);
  x << start->point.x(), start->point.y(), start->direction.x() / start->direction.z(),
      start->direction.y() / start->direction.z();
  const auto found = least_greatest(
      [&](const VectorXd& at) {
        std::vector<Functions> groups;
        for (std::size_t i = 0; i < of.size(); ++i) {
          const double side = fit == Fit::kOpposite ? -of[i]->side() : of[i]->side();
          groups.push_back(distances(surfaces[i], at, middle_mm, side));
          if (fit == Fit::kZone) {
            groups.push_back(distances(surfaces[i], at, middle_mm, -side));
          }
        }
        return groups;
      },
      x);
  if (!found) return std::nullopt;
  return line_of(*found, middle_mm);
}

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  void take(double value) {
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  [[nodiscard]] double width() const { return greatest - least; }
};

/// Range of the distances of a section from an axis, at all angles.
Range radial_range(const Truth& truth, double place_mm, const Line& axis) {
  const auto distance = [&](double theta) {
    return axis.radial(truth.at(place_mm, theta, axis)).norm();
  };
  return {least_around(distance), greatest_around(distance)};
}

/// Range of the heights of a circle of a face along an axis.
Range axial_range(const Truth& truth, double radius_mm, const Line& axis) {
  const auto height = [&](double theta) { return axis.height(truth.at(radius_mm, theta, axis)); };
  return {least_around(height), greatest_around(height)};
}

/// Centre of a section: least squares in its plane.
std::optional<Vector3d> center_of(const std::vector<Vector3d>& section) {
  const double z_mm = section.front().z();
  Eigen::Vector2d center(0.0, 0.0);
  for (int i = 0; i < 50; ++i) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    double mean = 0.0;
    for (const Vector3d& p : section) mean += (p.head<2>() - center).norm();
    mean /= static_cast<double>(section.size());
    for (const Vector3d& p : section) {
      const Eigen::Vector2d off = p.head<2>() - center;
      const Vector3d row(-off.x() / off.norm(), -off.y() / off.norm(), -1.0);
      normal += row * row.transpose();
      right -= row * (off.norm() - mean);
    }
    const Vector3d step = core::solve_ldlt(normal, right);
    center += step.head<2>();
    if (step.head<2>().norm() < 1e-14) return Vector3d(center.x(), center.y(), z_mm);
  }
  return std::nullopt;
}

/// Radius of the least circle round a few points, through two or three of them.
double least_circle(const std::vector<Eigen::Vector2d>& points) {
  double best = points.size() < 2 ? 0.0 : std::numeric_limits<double>::infinity();
  const auto take = [&](const Eigen::Vector2d& center) {
    double radius = 0.0;
    for (const Eigen::Vector2d& p : points) radius = std::max(radius, (p - center).norm());
    best = std::min(best, radius);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      take(0.5 * (points[i] + points[j]));
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        Eigen::Matrix2d sides;
        sides.row(0) = points[j] - points[i];
        sides.row(1) = points[k] - points[i];
        if (std::abs(sides.determinant()) < 1e-18) continue;
        const Eigen::Vector2d half(0.5 * sides.row(0).squaredNorm(),
                                   0.5 * sides.row(1).squaredNorm());
        take(points[i] + sides.inverse() * half);
      }
    }
  }
  return best;
}

/// Normal of the narrowest pair of planes around a face, or of its least-squares plane; out of it.
std::optional<Vector3d> face_normal(const Truth& face, bool ls) {
  const std::vector<Vector3d> points = face.all();
  const auto of = [](const VectorXd& x) { return Vector3d(-x[0], -x[1], 1.0); };
  const auto heights = [&](const VectorXd& x, double sign) {
    Functions out{VectorXd(static_cast<Index>(points.size())),
                  MatrixXd(static_cast<Index>(points.size()), 2)};
    const double length = of(x).norm();
    for (Index i = 0; i < out.value.size(); ++i) {
      const Vector3d& p = points[static_cast<std::size_t>(i)];
      const double h = of(x).dot(p) / length;
      out.value[i] = sign * h;
      for (int k = 0; k < 2; ++k) {
        out.gradient(i, k) = sign * (-p[k] / length - h * x[k] / (length * length));
      }
    }
    return out;
  };
  VectorXd x = VectorXd::Zero(2);
  for (int i = 0; i < 20; ++i) {
    Functions h = heights(x, 1.0);
    const Eigen::RowVectorXd mean = h.gradient.colwise().mean();
    h.gradient.rowwise() -= mean;
    h.value.array() -= h.value.mean();
    const MatrixXd normal = h.gradient.transpose() * h.gradient;
    const VectorXd right = h.gradient.transpose() * h.value;
    x -= core::solve_ldlt(normal, right);
  }
  const double out_of = face.plan->nominal.faces != record::Faces::kDown ? 1.0 : -1.0;
  if (ls) return out_of * of(x).normalized();
  const auto found = least_greatest(
      [&](const VectorXd& at) {
        return std::vector<Functions>{heights(at, 1.0), heights(at, -1.0)};
      },
      x);
  if (!found) return std::nullopt;
  return out_of * of(*found).normalized();
}

/// A datum: an axis, or the outward normal of a plane.
struct Datum {
  std::optional<Line> axis;
  std::optional<Vector3d> normal;
};

/// The surfaces of a part with their truths.
class TruePart {
 public:
  explicit TruePart(std::vector<Truth> features) : features_(std::move(features)) {}

  [[nodiscard]] std::vector<record::TruthValue> values() const;

 private:
  struct Named {
    std::string suffix;
    double value_mm = 0.0;
    bool size = false;
  };

  void add_values(const Truth& of, const record::Characteristic& c,
                  std::vector<record::TruthValue>& out) const;
  [[nodiscard]] std::vector<const Truth*> named(const std::string& name) const;
  [[nodiscard]] std::optional<Datum> datum_of(const record::Characteristic& c) const;
  [[nodiscard]] static std::vector<Named> sizes(const Truth& of, const Indication& asked);
  [[nodiscard]] static std::optional<double> form(const Truth& of, const record::Characteristic& c);
  [[nodiscard]] static std::optional<double> about(const Truth& of, const record::Characteristic& c,
                                                   const Datum& datum);

  std::vector<Truth> features_;
};

std::vector<const Truth*> TruePart::named(const std::string& name) const {
  const auto one = [&](const std::string& wanted) -> const Truth* {
    for (const Truth& truth : features_) {
      const bool named_so = truth.letter == wanted || truth.plan->id == wanted;
      if (named_so && !truth.sections.empty()) return &truth;
    }
    return nullptr;
  };
  if (const Truth* whole = one(name)) return {whole};
  std::vector<const Truth*> out;
  std::size_t from = 0;
  while (from <= name.size()) {
    const std::size_t to = std::min(name.find('-', from), name.size());
    out.push_back(one(name.substr(from, to - from)));
    if (out.back() == nullptr) return {};
    from = to + 1;
  }
  return out;
}

std::optional<Datum> TruePart::datum_of(const record::Characteristic& c) const {
  using Association = Indication::Association;
  // Of a system with an axis first only the axis counts for what is asked here.
  const auto of = named(c.indication.datum.front());
  const auto association = c.indication.association.value_or(Association::kOneSided);
  if (of.empty() || association == Association::kEqualised) return std::nullopt;
  Datum out;
  if (of.front()->plan->type == Shape::kPlane) {
    if (of.size() > 1 || association == Association::kZone) return std::nullopt;
    out.normal = face_normal(*of.front(), association == Association::kLs);
    return out.normal ? std::optional(out) : std::nullopt;
  }
  for (const Truth* truth : of) {
    if (truth->plan->type != Shape::kCylinder) return std::nullopt;
  }
  const Fit fit = association == Association::kLs     ? Fit::kLeastSquares
                  : association == Association::kZone ? Fit::kZone
                                                      : Fit::kMating;
  out.axis = axis_of(of, fit);
  return out.axis ? std::optional(out) : std::nullopt;
}

/// Two-point sizes of all sections: the sums of opposite radii about the centre of each.
std::vector<double> two_point_sizes(const Truth& of) {
  std::vector<double> out;
  for (const auto& section : of.sections) {
    const auto center = center_of(section);
    if (!center) return {};
    const std::size_t half = section.size() / 2;
    for (std::size_t i = 0; i < half; ++i) {
      out.push_back((section[i] - *center).head<2>().norm() +
                    (section[i + half] - *center).head<2>().norm());
    }
  }
  return out;
}

double rank_of(std::vector<double> sizes, Indication::Rank rank) {
  std::sort(sizes.begin(), sizes.end());
  const std::size_t n = sizes.size();
  double mean = 0.0;
  for (const double size : sizes) mean += size / static_cast<double>(n);
  double squares = 0.0;
  for (const double size : sizes) squares += (size - mean) * (size - mean);
  switch (rank) {
    case Indication::Rank::kSX:
      return sizes.back();
    case Indication::Rank::kSN:
      return sizes.front();
    case Indication::Rank::kSA:
      return mean;
    case Indication::Rank::kSM:
      return n % 2 == 1 ? sizes[n / 2] : 0.5 * (sizes[n / 2 - 1] + sizes[n / 2]);
    case Indication::Rank::kSD:
      return 0.5 * (sizes.front() + sizes.back());
    case Indication::Rank::kSR:
      return sizes.back() - sizes.front();
    case Indication::Rank::kSQ:
      return std::sqrt(squares / static_cast<double>(n));
  }
  return 0.0;
}

std::vector<TruePart::Named> TruePart::sizes(const Truth& of, const Indication& asked) {
  using Size = Indication::Size;
  std::vector<Named> out;
  const bool envelope = asked.requirement == Indication::Requirement::kEnvelope;
  if (of.plan->type != Shape::kCylinder || asked.section != Indication::Section::kAll) return out;
  const auto global = [&](Fit fit, const char* word) {
    const auto axis = axis_of({&of}, fit);
    if (!axis) return;
    Range range;
    double mean = 0.0;
    for (const double place : of.places_mm) {
      const Range here = radial_range(of, place, *axis);
      range.take(here.least);
      range.take(here.greatest);
    }
    const std::vector<Vector3d> points = of.all();
    for (const Vector3d& p : points) {
      mean += axis->radial(p).norm() / static_cast<double>(points.size());
    }
    const bool circumscribed = (fit == Fit::kMating) == (of.side() > 0.0);
    const double radius = fit == Fit::kLeastSquares ? mean
                          : fit == Fit::kZone       ? 0.5 * (range.least + range.greatest)
                          : circumscribed           ? range.greatest
                                                    : range.least;
    out.push_back({word, 2.0 * radius, true});
  };
  if (envelope) {
    global(Fit::kMating, of.side() > 0.0 ? " GN" : " GX");
  } else if (asked.size != Size::kLP) {
    const bool shaft = of.side() > 0.0;
    if (asked.size == Size::kGG) global(Fit::kLeastSquares, "");
    if (asked.size == Size::kGC) global(Fit::kZone, "");
    if (asked.size == Size::kGN) global(shaft ? Fit::kMating : Fit::kOpposite, "");
    if (asked.size == Size::kGX) global(shaft ? Fit::kOpposite : Fit::kMating, "");
    return out;
  }
  const std::vector<double> pairs = two_point_sizes(of);
  if (pairs.empty()) return out;
  if (asked.rank) {
    out.push_back({"", rank_of(pairs, *asked.rank), true});
  } else {
    out.push_back({" SX", rank_of(pairs, Indication::Rank::kSX), true});
    out.push_back({" SN", rank_of(pairs, Indication::Rank::kSN), true});
  }
  return out;
}

/// A straight line through a profile: intercept and slope.
Eigen::Vector2d regression(const std::vector<Eigen::Vector2d>& profile) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : profile) {
    const Eigen::Vector2d row(1.0, p.x());
    normal += row * row.transpose();
    right += row * p.y();
  }
  return normal.inverse() * right;
}

/// Width of a profile between two parallel lines: about its regression, or the least of all.
double straightness_of(const std::vector<Eigen::Vector2d>& profile, bool ls) {
  const auto width = [&](double slope) {
    Range range;
    for (const Eigen::Vector2d& p : profile) range.take(p.y() - slope * p.x());
    return range.width() / std::sqrt(1.0 + slope * slope);
  };
  if (ls) return width(regression(profile)[1]);
  // The narrowest pair of lines lies along a side of the hull.
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < profile.size(); ++i) {
    for (std::size_t j = i + 1; j < profile.size(); ++j) {
      const Eigen::Vector2d side = profile[j] - profile[i];
      best = std::min(best, width(side.y() / side.x()));
    }
  }
  return best;
}

std::optional<double> TruePart::form(const Truth& of, const record::Characteristic& c) {
  const bool ls = c.reference == record::Reference::kLeastSquares;
  if (c.form == Form::kFlatness) {
    if (of.plan->type != Shape::kPlane) return std::nullopt;
    const auto normal = face_normal(of, ls);
    if (!normal) return std::nullopt;
    Range range;
    for (const Vector3d& p : of.all()) range.take(normal->dot(p));
    return range.width();
  }
  const bool round = of.plan->type == Shape::kCylinder || of.plan->type == Shape::kCircle;
  if (!round || c.indication.parameter != Indication::Parameter::kTotal) return std::nullopt;
  const bool outside = of.side() > 0.0;
  const auto fit_of = [&] {
    switch (c.reference) {
      case record::Reference::kLeastSquares:
        return Fit::kLeastSquares;
      case record::Reference::kMinimumZone:
        return Fit::kZone;
      case record::Reference::kMinimumCircumscribed:
        return outside ? Fit::kMating : Fit::kOpposite;
      case record::Reference::kMaximumInscribed:
        return outside ? Fit::kOpposite : Fit::kMating;
    }
    return Fit::kZone;
  };
  if (c.form == Form::kCylindricity) {
    const auto axis = axis_of({&of}, fit_of());
    if (!axis) return std::nullopt;
    Range range;
    for (const double place : of.places_mm) {
      const Range here = radial_range(of, place, *axis);
      range.take(here.least);
      range.take(here.greatest);
    }
    return range.width();
  }
  if (c.form == Form::kRoundness) {
    double worst = 0.0;
    for (std::size_t i = 0; i < of.sections.size(); ++i) {
      Truth one = of;
      one.places_mm = {of.places_mm[i]};
      one.sections = {of.sections[i]};
      const auto axis = axis_of({&one}, fit_of());  // all heights alike: it stays upright
      if (!axis) return std::nullopt;
      worst = std::max(worst, radial_range(one, one.places_mm.front(), *axis).width());
    }
    return worst;
  }
  const bool median = c.indication.of == Indication::Of::kMedianLine;
  if (of.plan->type != Shape::kCylinder || (c.form == Form::kStraightness && median)) {
    return std::nullopt;
  }
  const auto axis = axis_of({&of}, Fit::kLeastSquares);
  if (!axis) return std::nullopt;
  const auto profile_at = [&](double theta) {
    std::vector<Eigen::Vector2d> out;
    for (const double place : of.places_mm) {
      const Vector3d p = of.at(place, theta, *axis);
      out.emplace_back(axis->height(p), axis->radial(p).norm());
    }
    return out;
  };
  const double length_mm = of.places_mm.back() - of.places_mm.front();
  const auto of_angle = [&](double theta) {
    const auto near = profile_at(theta);
    if (c.form == Form::kStraightness) return straightness_of(near, ls);
    const auto far = profile_at(theta + 0.5 * core::kTwoPi);
    const double slope = regression(near)[1];
    if (c.form == Form::kTaper) {
      return std::abs(slope + regression(far)[1]) * 0.5 * length_mm;
    }
    Range range;
    for (const Eigen::Vector2d& p : far) range.take(p.y() + slope * p.x());
    return range.width() / std::sqrt(1.0 + slope * slope);
  };
  return greatest_around(of_angle);
}

std::optional<double> TruePart::about(const Truth& of, const record::Characteristic& c,
                                      const Datum& datum) {
  const Indication& asked = c.indication;
  const bool plane = of.plan->type == Shape::kPlane;
  const Vector3d along = datum.axis ? datum.axis->direction : *datum.normal;
  if (c.form == Form::kRunOut || c.form == Form::kTotalRunOut) {
    const bool axial = asked.direction == Indication::Direction::kAxial;
    if (!datum.axis || axial != plane) return std::nullopt;
    Range all;
    double worst = 0.0;
    std::vector<double> places = of.places_mm;
    if (asked.radius_mm) places = {*asked.radius_mm};
    for (const double place : places) {
      const Range here =
          axial ? axial_range(of, place, *datum.axis) : radial_range(of, place, *datum.axis);
      worst = std::max(worst, here.width());
      all.take(here.least);
      all.take(here.greatest);
    }
    const double slant = asked.direction == Indication::Direction::kConical
                             ? std::cos(of.plan->nominal.half_angle_deg * core::kDegree)
                             : 1.0;
    return c.form == Form::kTotalRunOut ? all.width() : slant * worst;
  }
  if (plane) {
    const bool fits = datum.axis ? c.form == Form::kPerpendicularity : c.form == Form::kParallelism;
    if (!fits) return std::nullopt;
    Range range;
    for (const Vector3d& p : of.all()) range.take(along.dot(p));
    return range.width();
  }
  std::vector<Vector3d> centers;
  for (std::size_t i = 0; i < of.sections.size(); ++i) {
    const auto& layers = asked.section_layers;
    const bool wanted =
        asked.section != Indication::Section::kSCS ||
        std::find(layers.begin(), layers.end(), static_cast<double>(i + 1)) != layers.end();
    if (!wanted) continue;
    const auto center = center_of(of.sections[i]);
    if (!center) return std::nullopt;
    centers.push_back(*center);
  }
  if (centers.empty()) return std::nullopt;
  if (c.form == Form::kCoaxiality || c.form == Form::kConcentricity) {
    if (!datum.axis) return std::nullopt;
    double far = 0.0;
    for (const Vector3d& center : centers) far = std::max(far, datum.axis->radial(center).norm());
    return 2.0 * far;
  }
  const bool round_zone =
      datum.axis ? c.form == Form::kParallelism : c.form == Form::kPerpendicularity;
  if (round_zone) {
    const Vector3d x = (Vector3d::UnitX() - along.x() * along).normalized();
    const Vector3d y = along.cross(x);
    std::vector<Eigen::Vector2d> flat;
    for (const Vector3d& center : centers) flat.emplace_back(x.dot(center), y.dot(center));
    return 2.0 * least_circle(flat);
  }
  if (datum.axis || c.form != Form::kParallelism) return std::nullopt;
  Range range;
  for (const Vector3d& center : centers) range.take(along.dot(center));
  return range.width();
}

void TruePart::add_values(const Truth& of, const record::Characteristic& c,
                          std::vector<record::TruthValue>& out) const {
  const Indication& i = c.indication;
  const bool plain =
      i.filter.value_or(Indication::Filter::kNone) == Indication::Filter::kNone &&
      i.outliers.value_or(Indication::Outliers::kNone) == Indication::Outliers::kNone &&
      !i.from_mm && !i.to_mm;
  if (!plain) return;
  const auto index = static_cast<int>(&of - features_.data());
  if (c.form == Form::kDiameter) {
    for (const Named& size : sizes(of, i)) {
      out.push_back({index, c.id + size.suffix + "_mm", size.value_mm});
    }
    return;
  }
  std::optional<double> value;
  if (i.datum.empty()) {
    value = form(of, c);
  } else if (const auto datum = datum_of(c)) {
    value = about(of, c, *datum);
  }
  if (value) out.push_back({index, c.id + "_um", *value / core::kMicrometre});
}

std::vector<record::TruthValue> TruePart::values() const {
  std::vector<record::TruthValue> out;
  for (const Truth& truth : features_) {
    if (truth.sections.empty()) continue;
    for (const record::Characteristic& c : truth.asked->characteristics) add_values(truth, c, out);
  }
  return out;
}

/// The noise-free surface of a feature at its planned sections; without sections where a window
/// takes a part of it.
Truth truth_of(const SimulationPlan& simulation, const FeaturePlan& plan,
               const record::Feature& asked) {
  Truth out;
  out.plan = &plan;
  out.asked = &asked;
  if (!is_touched(plan)) return out;
  for (const record::Setting& setting : asked.settings) {
    if (setting.name == "letter") out.letter = setting.text;
    if (setting.name.starts_with("exclude/")) return out;
  }
  const auto targets = sampling_targets(plan);
  if (!targets) return out;
  out.placed = placed_surface(simulation, plan);
  const SurfaceChart chart(plan);
  for (const Target& target : *targets) {
    if (target.point != 0) continue;
    const Vector3d p = chart.contact_point(target);
    out.places_mm.push_back(plan.type == Shape::kPlane ? p.head<2>().norm() : p.z());
  }
  for (const double place : out.places_mm) {
    auto& section = out.sections.emplace_back();
    for (int i = 0; i < kAround; ++i) {
      section.push_back(out.at(place, core::kTwoPi * i / kAround, Line()));
    }
  }
  return out;
}

}  // namespace

std::vector<record::TruthValue> truths_of(const Plan& plan,
                                          std::span<const record::Feature> features) {
  if (!plan.simulation || !has_whole_part(plan)) return {};
  std::vector<Truth> truths;
  for (std::size_t i = 0; i < std::min(features.size(), plan.features.size()); ++i) {
    truths.push_back(truth_of(*plan.simulation, plan.features[i], features[i]));
  }
  return TruePart(std::move(truths)).values();
}

}  // namespace rondure::plans
