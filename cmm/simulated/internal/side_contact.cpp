#include "cmm/simulated/internal/side_contact.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include <Eigen/LU>

#include "cmm/simulated/internal/surface_shape.h"
#include "core/decompositions.h"
#include "core/units.h"

namespace rondure::cmm {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// A function of the surface parameters (u, z) with its derivatives.
struct Local {
  double value = 0.0;
  Vector2d gradient = Vector2d::Zero();
  Matrix2d hessian = Matrix2d::Zero();
};

/// A point of the surface relative to the line of the sweep.
struct Sight {
  double along_mm = 0.0;  ///< Position along the line, from the start.
  Vector3d across_mm;     ///< Offset from the line, perpendicular to it.
};

Sight sight(const SphereSweep& sweep, const Vector3d& x_mm) {
  const Vector3d w = x_mm - sweep.start_P_mm;
  const double along = sweep.direction_P.dot(w);
  return {along, w - along * sweep.direction_P};
}

/// Travel s until the sphere reaches a surface point; nothing when the sphere misses the point, or
/// when the point lies before the start: a sphere that starts clear of it never meets it.
std::optional<Local> travel_to(const PartSurface& surface, const SphereSweep& sweep,
                               const Vector2d& at) {
  const SurfaceJet jet = surface_jet(surface, at.x(), at.y());
  const Sight seen = sight(sweep, jet.x_mm);
  const double rho2 = sweep.radius_mm * sweep.radius_mm;
  const double depth2 = rho2 - seen.across_mm.squaredNorm();
  if (seen.along_mm < 0.0 || depth2 < 1e-12 * rho2) return std::nullopt;
  const double depth = std::sqrt(depth2);
  const Vector3d& d = sweep.direction_P;
  const Vector3d m = seen.across_mm + depth * d;  // from the tip centre at contact to the point
  Local s;
  s.value = seen.along_mm - depth;
  s.gradient = Vector2d(m.dot(jet.u), m.dot(jet.z)) / depth;
  const Vector2d p(d.dot(jet.u), d.dot(jet.z));
  Matrix2d h;
  h(0, 0) = jet.u.squaredNorm() + m.dot(jet.uu);
  h(1, 1) = jet.z.squaredNorm() + m.dot(jet.zz);
  h(0, 1) = h(1, 0) = jet.u.dot(jet.z) + m.dot(jet.uz);
  const Matrix2d gp = s.gradient * p.transpose();
  s.hessian = (h - gp - gp.transpose() + s.gradient * s.gradient.transpose()) / depth;
  return s;
}

/// Half the squared distance of a surface point from the line, or from the start of the sweep when
/// its direction is zero.
std::optional<Local> half_distance2(const PartSurface& surface, const SphereSweep& sweep,
                                    const Vector2d& at) {
  const SurfaceJet jet = surface_jet(surface, at.x(), at.y());
  const Vector3d across = sight(sweep, jet.x_mm).across_mm;
  const Vector3d& d = sweep.direction_P;
  const Vector2d p(d.dot(jet.u), d.dot(jet.z));
  Local f;
  f.value = 0.5 * across.squaredNorm();
  f.gradient = {across.dot(jet.u), across.dot(jet.z)};
  f.hessian(0, 0) = jet.u.squaredNorm() + across.dot(jet.uu);
  f.hessian(1, 1) = jet.z.squaredNorm() + across.dot(jet.zz);
  f.hessian(0, 1) = f.hessian(1, 0) = jet.u.dot(jet.z) + across.dot(jet.uz);
  f.hessian -= p * p.transpose();
  return f;
}

/// Newton step; where the function is not convex, with the absolute curvatures, so that it
/// descends.
Vector2d descent_step(const Local& f, bool z_held) {
  constexpr double kLeastCurvature = 1e-12;
  if (z_held) {
    const double curvature = std::max(std::abs(f.hessian(0, 0)), kLeastCurvature);
    return {-f.gradient.x() / curvature, 0.0};
  }
  if (f.hessian(0, 0) > 0.0 && f.hessian.determinant() > 1e-14 * f.hessian.squaredNorm()) {
    return -f.hessian.inverse() * f.gradient;
  }
  Eigen::SelfAdjointEigenSolver<Matrix2d> eigen;
  eigen.computeDirect(f.hessian);
  const Vector2d curvatures = eigen.eigenvalues().cwiseAbs().cwiseMax(kLeastCurvature);
  const Matrix2d& axes = eigen.eigenvectors();
  return -axes * (axes.transpose() * f.gradient).cwiseQuotient(curvatures);
}

struct Minimum {
  Vector2d at = Vector2d::Zero();
  double value = 0.0;
};

/// True when z is at an end of its range and the function falls toward the outside.
bool held_at_rim(const Local& f, double z_mm, double half_length_mm) {
  return (z_mm >= half_length_mm && f.gradient.y() <= 0.0) ||
         (z_mm <= -half_length_mm && f.gradient.y() >= 0.0);
}

/// Magnitude of the slope in the free directions.
double free_slope(const Local& f, double z_mm, double half_length_mm) {
  return held_at_rim(f, z_mm, half_length_mm) ? std::abs(f.gradient.x()) : f.gradient.norm();
}

/// Local minimum over u and |z| <= half length by a safeguarded Newton iteration; nothing when the
/// start is outside the domain of `function` or the iteration does not end.
template <class Function>
std::optional<Minimum> minimise(const Function& function, Vector2d at, double half_length_mm) {
  constexpr int kIterations = 200;
  constexpr double kStep_mm = 1e-12;
  constexpr double kRoundOff_mm = 1e-12;
  auto f = function(at);
  if (!f) return std::nullopt;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Vector2d step = descent_step(*f, held_at_rim(*f, at.y(), half_length_mm));
    const double room = (step.y() > 0.0 ? half_length_mm : -half_length_mm) - at.y();
    const bool to_rim = std::abs(step.y()) > std::abs(room);
    if (to_rim) step *= room / step.y();
    if (!to_rim && step.norm() <= kStep_mm) return Minimum{at + step, f->value};
    // Near the minimum the value is constant to the last bit while the slope still shrinks.
    const double least_slope = 0.5 * free_slope(*f, at.y(), half_length_mm);
    for (;; step *= 0.5) {
      if (step.norm() <= 0.1 * kStep_mm) return Minimum{at, f->value};  // nothing lower
      Vector2d next = at + step;
      next.y() = std::clamp(next.y(), -half_length_mm, half_length_mm);
      auto g = function(next);
      if (!g) continue;
      const bool flatter = g->value < f->value + kRoundOff_mm &&
                           free_slope(*g, next.y(), half_length_mm) < least_slope;
      if (g->value < f->value || flatter) {
        at = next;
        f = g;
        break;
      }
    }
  }
  return std::nullopt;
}

/// Parameters of the contact with the ideal cylinder of infinite length, when it is met steeply
/// enough to be a good start.
std::optional<Vector2d> ideal_contact(const PartSurface& surface, const SphereSweep& sweep) {
  const double offset_mm =
      surface.radius_mm + (surface.inside ? -sweep.radius_mm : sweep.radius_mm);
  const Vector2d s = sweep.start_P_mm.head<2>();
  const Vector2d d = sweep.direction_P.head<2>();
  const double a = d.squaredNorm();
  const double b = s.dot(d);
  const double root2 = b * b - a * (s.squaredNorm() - offset_mm * offset_mm);
  if (a < 0.25 || root2 < 0.0) return std::nullopt;
  const double root = std::sqrt(root2);
  const double travel = (-b + (surface.inside ? root : -root)) / a;
  constexpr double kLeastSine = 0.5;  // root / offset: sine of the angle between line and surface
  if (travel < 0.0 || root < kLeastSine * offset_mm) return std::nullopt;
  const Vector3d center = sweep.start_P_mm + travel * sweep.direction_P;
  return Vector2d(surface.radius_mm * std::atan2(center.y(), center.x()), center.z());
}

/// Whether the sphere can roll over the form without bridging anything.
bool is_gentle(const PartSurface& surface, const ShapeBounds& bounds, double sphere_radius_mm) {
  const double room =
      surface.inside ? 1.0 - sphere_radius_mm / (surface.radius_mm - bounds.deviation_mm) : 1.0;
  return bounds.form_curvature_1_mm * sphere_radius_mm < 0.5 * room;
}

/// Branch and bound over the side: examines every surface box that could be met first.
class SideSearch {
 public:
  /// @param beside  bounds_beside_marks() of the surface.
  SideSearch(const PartSurface& surface, const ShapeBounds& beside, const SphereSweep& sweep)
      : surface_(surface), beside_(beside), sweep_(sweep), bound_mm_(sweep.travel_mm) {}

  core::Result<std::optional<SideContact>> run() {
    push_first_boxes();
    while (!open_.empty() && open_.top().least_mm <= bound_mm_) {
      const Box box = open_.top();
      open_.pop();
      if (box.reach_mm > box.leaf_mm) {
        split(box);
      } else if (starts_in_contact(box)) {
        return found_;
      } else if (!finish(box.center)) {
        if (box.reach_mm < kFinest_mm) return not_found();
        split(box);  // Newton's method converges closer to the minimum
      }
    }
    return found_;
  }

 private:
  struct Box {
    Vector2d center;
    Vector2d half;
    bool around = true;     ///< Longer along the circumference than along the axis.
    double reach_mm = 0.0;  ///< No point of the box is farther from that at its centre.
    double leaf_mm = 0.0;   ///< Reach that is small enough for Newton.
    double least_mm = 0.0;  ///< No point of the box is met before this travel.
    friend bool operator<(const Box& a, const Box& b) { return a.least_mm > b.least_mm; }
  };

  void push_first_boxes() {
    const double turn_mm = core::kTwoPi * surface_.radius_mm;
    const double length_mm = 2.0 * surface_.half_length_mm;
    constexpr int kAround = 8;
    const int along = std::clamp(static_cast<int>(kAround * length_mm / turn_mm), 1, 64);
    const Vector2d half(turn_mm / kAround / 2.0, length_mm / along / 2.0);
    for (int i = 0; i < kAround; ++i) {
      for (int j = 0; j < along; ++j) {
        push({(2 * i + 1) * half.x(), (2 * j + 1) * half.y() - surface_.half_length_mm}, half);
      }
    }
  }

  void push(const Vector2d& center, const Vector2d& half) {
    const BoxBounds bounds = bounds_in_box(surface_, beside_, center, half);
    const double around_mm = bounds.stretch_u * half.x();
    const double along_mm = bounds.stretch_z * half.y();
    const Sight seen = sight(sweep_, point(center));
    const double radius = sweep_.radius_mm + around_mm + along_mm;
    const double depth2 = radius * radius - seen.across_mm.squaredNorm();
    if (depth2 < 0.0) return;  // the sphere misses the point
    const double depth = std::sqrt(depth2);
    if (seen.along_mm + depth < 0.0) return;  // before the start
    // A fraction of the tip and of an undulation.
    const double leaf_mm = std::min(sweep_.radius_mm / 4.0, bounds.wavelength_mm / 16.0);
    open_.push(
        {center, half, around_mm > along_mm, around_mm + along_mm, leaf_mm, seen.along_mm - depth});
  }

  void split(const Box& box) {
    const int longer = box.around ? 0 : 1;
    Vector2d half = box.half;
    half[longer] *= 0.5;
    Vector2d shift = Vector2d::Zero();
    shift[longer] = half[longer];
    push(box.center - shift, half);
    push(box.center + shift, half);
  }

  /// Looks for a surface point near the box that lies within the sphere before it moves.
  bool starts_in_contact(const Box& box) {
    const double radius = sweep_.radius_mm;
    if ((point(box.center) - sweep_.start_P_mm).norm() > radius + box.reach_mm) return false;
    SphereSweep standing = sweep_;
    standing.direction_P.setZero();
    const auto nearest = nearest_to(standing, box.center);
    if (!nearest) return false;
    const Vector3d x = point(nearest->at);
    const double gap_mm = (x - sweep_.start_P_mm).norm() - radius;
    if (gap_mm >= -kTouching_mm) return false;
    found_ = SideContact{gap_mm, x};
    return true;
  }

  /// Adds the local minimum of the travel near `start`; false when Newton's method does not
  /// converge.
  bool finish(const Vector2d& start) {
    const auto travel = [this](const Vector2d& at) { return travel_to(surface_, sweep_, at); };
    Vector2d at = start;
    if (!travel(at)) {
      const auto nearest = nearest_to(sweep_, at);
      if (!nearest) return false;
      if (!travel(nearest->at)) return true;  // the sphere misses the point
      at = nearest->at;
    }
    const auto minimum = minimise(travel, at, surface_.half_length_mm);
    if (!minimum) return false;
    if (minimum->value <= bound_mm_) {
      bound_mm_ = minimum->value;
      found_ = SideContact{minimum->value, point(minimum->at)};
    }
    return true;
  }

  [[nodiscard]] std::optional<Minimum> nearest_to(const SphereSweep& line,
                                                  const Vector2d& near) const {
    const auto distance = [&](const Vector2d& at) { return half_distance2(surface_, line, at); };
    return minimise(distance, near, surface_.half_length_mm);
  }

  [[nodiscard]] Vector3d point(const Vector2d& at) const {
    return surface_jet(surface_, at.x(), at.y()).x_mm;
  }

  static core::Result<std::optional<SideContact>> not_found() {
    return core::fail(core::Code::kNotConverged,
                      "the contact of tip and part was not found within the iteration limit");
  }

  static constexpr double kTouching_mm = 1e-9;  // allowed overlap at the start of a sweep
  static constexpr double kFinest_mm = 1e-6;

  const PartSurface& surface_;
  const ShapeBounds& beside_;
  const SphereSweep& sweep_;
  double bound_mm_ = 0.0;
  std::optional<SideContact> found_;
  std::priority_queue<Box> open_;
};

/// The contact by Newton alone, if it is certain to be the only candidate: the outer optional is
/// empty otherwise.
std::optional<std::optional<SideContact>> gentle_contact(const PartSurface& surface,
                                                         const ShapeBounds& bounds,
                                                         const SphereSweep& sweep) {
  if (!is_gentle(surface, bounds, sweep.radius_mm)) return std::nullopt;
  const double gap_mm = surface.radius_mm - sweep.start_P_mm.head<2>().norm();
  if ((surface.inside ? gap_mm : -gap_mm) <= sweep.radius_mm + bounds.deviation_mm) {
    return std::nullopt;
  }
  const auto ideal = ideal_contact(surface, sweep);
  if (!ideal || std::abs(ideal->y()) >= surface.half_length_mm) return std::nullopt;
  const auto minimum = minimise([&](const Vector2d& at) { return travel_to(surface, sweep, at); },
                                *ideal, surface.half_length_mm);
  if (!minimum || std::abs(minimum->at.y()) >= surface.half_length_mm) return std::nullopt;
  if (minimum->value > sweep.travel_mm) return std::optional<SideContact>{};
  return SideContact{minimum->value, surface_jet(surface, minimum->at.x(), minimum->at.y()).x_mm};
}

/// Whether the sphere stays away from every mark on its whole path.
bool passes_marks(const PartSurface& surface, const SphereSweep& sweep) {
  const Vector3d a = sweep.start_P_mm;
  const Vector3d b = a + sweep.travel_mm * sweep.direction_P;
  const double theta = std::atan2(a.y(), a.x());
  const double turn = std::abs(std::remainder(std::atan2(b.y(), b.x()) - theta, core::kTwoPi));
  // Seen from the axis, a path that does not cross the axis turns by less than half a revolution.
  if (turn > 0.25 * core::kTwoPi) return false;
  return std::none_of(surface.marks.begin(), surface.marks.end(), [&](const SurfaceMark& mark) {
    const double keep_off = sweep.radius_mm + std::abs(mark.height_mm);
    const double least_z = std::min(a.z(), b.z()) - 0.5 * mark.length_mm - mark.z_mm;
    const double most_z = mark.z_mm - 0.5 * mark.length_mm - std::max(a.z(), b.z());
    if (std::max(least_z, most_z) > keep_off) return false;
    const double half = 0.5 * mark.width_mm / surface.radius_mm;
    const double apart =
        std::abs(std::remainder(theta - mark.theta_rad, core::kTwoPi)) - turn - half;
    const double reach = surface.radius_mm - std::abs(mark.height_mm);
    if (apart <= 0.0) return true;
    return reach * std::sin(std::min(apart, 0.25 * core::kTwoPi)) <= keep_off;
  });
}

}  // namespace

core::Result<std::optional<SideContact>> first_side_contact(const PartSurface& surface,
                                                            const SphereSweep& sweep) {
  const ShapeBounds beside = bounds_beside_marks(surface);
  if (surface.marks.empty() || passes_marks(surface, sweep)) {
    if (const auto gentle = gentle_contact(surface, beside, sweep)) return *gentle;
  }
  return SideSearch(surface, beside, sweep).run();
}

}  // namespace rondure::cmm
