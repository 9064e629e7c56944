#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "core/decompositions.h"
#include "core/numbers.h"
#include "core/units.h"
#include "evaluation/uncertainty/angular_curve.h"
#include "evaluation/uncertainty/curve_trials.h"
#include "evaluation/wheel/internal/unseen.h"
#include "evaluation/wheel/result.h"
#include "fit/geometry/column_extremes.h"
#include "fit/references/min_zone.h"

namespace rondure::evaluation {
namespace {

using core::kMicrometre;
using core::kMicroradian;
using record::DeclaredInfluence;
using record::Influence;
using record::WheelInfluencesTask;

constexpr std::size_t kMostPoints = 5000;  ///< The trials of more take minutes.
constexpr double kLeastPointError = 1e-9;  ///< mm; an error of 0 leaves no distribution

/// Standard uncertainties and draws of the influences, in mm, rad and parts of 1.
struct Influences {
  double axis_x_mm = 0.0;
  double axis_z_mm = 0.0;
  double scale_1 = 0.0;
  double squareness_rad = 0.0;
  double threshold_mm = 0.0;
  double wear_mm = 0.0;
};

Influences standard_of(const WheelInfluencesTask& said) {
  const double axis_mm = record::u_of(said.axis_um) * kMicrometre;
  return {axis_mm,
          axis_mm,
          record::u_of(said.scale_ppm) * 1e-6,
          record::u_of(said.squareness_urad) * kMicroradian,
          record::u_of(said.threshold_um) * kMicrometre,
          record::u_of(said.wear_um) * kMicrometre};
}

/// A draw in standard uncertainties.
double drawn(const Influence& influence, std::uint64_t seed, std::string_view id,
             std::uint64_t instance, int trial) {
  if (!influence) return 0.0;
  return influence->distribution == DeclaredInfluence::Distribution::kNormal
             ? normal_draw(seed, id, instance, trial)
             : uniform_draw(seed, id, instance, trial);
}

/// Moves the axis by a vector.
void shift_axis(const Eigen::Vector2d& by_mm, Influences& drawn) {
  drawn.axis_x_mm += by_mm.x();
  drawn.axis_z_mm += by_mm.y();
}

/// Adds the errors of an axis that another feature found: the noise of its points, and the
/// squareness of the stage, whose draw moves the points of this wheel as well. The scale of the
/// stage moves points and axis alike: of it remains what it makes of the eccentricity, nothing.
void add_measured_axis(const MeasuredAxis& axis, std::uint64_t seed, int trial,
                       Influences& drawn_influences) {
  if (axis.root_mm) {
    const std::string id = "wheel.center " + axis.feature;
    const auto draw = [&](std::uint64_t direction) {
      return normal_draw(seed, id, direction, trial);
    };
    shift_axis(*axis.root_mm * Eigen::Vector2d(draw(0), draw(1)), drawn_influences);
  }
  const double squareness_rad = record::u_of(axis.squareness_urad) * kMicroradian *
                                drawn(axis.squareness_urad, seed, "stage.squareness", 0, trial);
  shift_axis(squareness_rad * axis.per_squareness_mm, drawn_influences);
}

/// Drawn influences of a trial. Features that name the same stage share its draws.
Influences draw_of(const WheelResult& result, std::uint64_t seed, int trial) {
  const WheelInfluencesTask& said = *result.declared;
  const Influences u = standard_of(said);
  Influences out = {
      u.axis_x_mm * drawn(said.axis_um, seed, "wheel.axis", 0, trial),
      u.axis_z_mm * drawn(said.axis_um, seed, "wheel.axis", 1, trial),
      u.scale_1 * drawn(said.scale_ppm, seed, "stage.scale", 0, trial),
      u.squareness_rad * drawn(said.squareness_urad, seed, "stage.squareness", 0, trial),
      u.threshold_mm * drawn(said.threshold_um, seed, "wheel.threshold", 0, trial),
      u.wear_mm * drawn(said.wear_um, seed, "wheel.wear", 0, trial)};
  if (result.measured_axis) add_measured_axis(*result.measured_axis, seed, trial, out);
  return out;
}

enum class Quantity { kRunOut, kEffectiveRadius, kLsRoundness, kMzRoundness };

/// The edge of a wheel as a curve about the least-squares centre of all points: distance less mean
/// radius at each point.
class Edge {
 public:
  Edge(const std::vector<Eigen::Vector2d>& points_mm, const fit::LsCircle& circle,
       const std::optional<Eigen::Vector2d>& axis_mm)
      : center_mm_(circle.center_mm), radius_mm_(circle.radius_mm), axis_mm_(axis_mm) {
    const auto n = static_cast<Eigen::Index>(points_mm.size());
    Eigen::VectorXd curve(n);
    Eigen::VectorXd oval(n);
    std::vector<double> angles_rad;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Vector2d v = points_mm[static_cast<std::size_t>(i)] - center_mm_;
      curve(i) = v.norm() - radius_mm_;
      normals_.push_back(v.normalized());
      const double angle = std::atan2(v.y(), v.x());
      oval(i) = 0.5 * radius_mm_ * std::sin(2.0 * angle);
      angles_rad.push_back(angle);
    }
    angular_.emplace(angles_rad);
    found_ = angular_->coefficients(curve);
    oval_ = angular_->coefficients(oval);
  }

  [[nodiscard]] MeasuredCurve measured(double point_mm) const {
    constexpr std::size_t kEccentric = 3;  // mean, cosine and sine
    return angular_->measured(found_, point_mm, kEccentric);
  }

  /// Value of a quantity for these coefficients and influences [mm].
  [[nodiscard]] double value(Quantity quantity, std::span<const double> coefficients_mm,
                             const Influences& drawn) const {
    Eigen::VectorXd parts =
        Eigen::Map<const Eigen::VectorXd>(coefficients_mm.data(), found_.size()) +
        drawn.squareness_rad * oval_;
    if (quantity == Quantity::kLsRoundness) parts.head(3).setZero();  // the fit takes them out
    const Eigen::VectorXd curve = angular_->values(parts);
    if (quantity == Quantity::kLsRoundness) return curve.maxCoeff() - curve.minCoeff();
    std::vector<Eigen::Vector2d> points_mm;
    points_mm.reserve(normals_.size());
    const double common_mm = drawn.threshold_mm + drawn.wear_mm;
    for (std::size_t i = 0; i < normals_.size(); ++i) {
      const double distance = radius_mm_ + curve(static_cast<Eigen::Index>(i));
      points_mm.emplace_back((distance * (1.0 + drawn.scale_1) + common_mm) * normals_[i]);
    }
    if (quantity == Quantity::kMzRoundness) {
      const auto zone = fit::min_zone_circle(points_mm, {.global = false, .search = {}});
      return zone ? zone->width_mm() : std::nan("");
    }
    const Eigen::Vector2d axis_mm = axis_mm_.value_or(center_mm_) - center_mm_ +
                                    Eigen::Vector2d(drawn.axis_x_mm, drawn.axis_z_mm);
    const auto reach =
        fit::extremes_of(points_mm, [&](const Eigen::Vector2d& p) { return (p - axis_mm).norm(); });
    return quantity == Quantity::kRunOut ? reach.width() : reach.high;
  }

  /// As measured: the coefficients as found.
  [[nodiscard]] std::vector<double> found_mm() const { return {found_.begin(), found_.end()}; }

  /// Change of a quantity for one standard error of every point, in quadrature [mm].
  [[nodiscard]] double per_point(Quantity quantity, double point_mm) const {
    double squares = 0.0;
    for (const Eigen::Index i : deciding(quantity, point_mm)) {
      const double change = per_u([&](double k) {
        Eigen::VectorXd moved = Eigen::VectorXd::Zero(found_.size());
        moved(i) = k * point_mm;
        const Eigen::VectorXd parts = found_ + angular_->coefficients(moved);
        return value(quantity, {parts.data(), static_cast<std::size_t>(parts.size())}, {});
      });
      squares += change * change;
    }
    return std::sqrt(squares);
  }

  /// Effect of one radian of squareness on the radius of least squares [mm].
  [[nodiscard]] double oval_in_radius_mm() const {
    Eigen::MatrixXd rows(found_.size(), 3);
    Eigen::VectorXd oval(found_.size());
    for (Eigen::Index i = 0; i < found_.size(); ++i) {
      const Eigen::Vector2d& n = normals_[static_cast<std::size_t>(i)];
      rows.row(i) << n.x(), n.y(), 1.0;
      oval(i) = radius_mm_ * n.x() * n.y();  // R / 2 sin 2 theta
    }
    return core::solve_pivoted_qr(rows, oval)(2);
  }

 private:
  /// Rows whose error can move the value: of a zone its contacts; of many points those near the
  /// extremes, as the others move the least-squares circle by too little to show.
  [[nodiscard]] std::vector<Eigen::Index> deciding(Quantity quantity, double point_mm) const {
    constexpr Eigen::Index kMany = 500;
    std::vector<Eigen::Index> out;
    const Eigen::VectorXd curve = angular_->values(found_);
    if (quantity == Quantity::kMzRoundness) {
      std::vector<Eigen::Vector2d> points_mm;
      for (std::size_t i = 0; i < normals_.size(); ++i) {
        points_mm.emplace_back((radius_mm_ + curve(static_cast<Eigen::Index>(i))) * normals_[i]);
      }
      const auto zone = fit::min_zone_circle(points_mm, {.global = false, .search = {}});
      if (!zone) return out;
      for (const auto* side : {&zone->outer, &zone->inner}) {
        for (const fit::Contact& contact : *side) {
          out.push_back(static_cast<Eigen::Index>(contact.index));
        }
      }
      return out;
    }
    const bool about_axis = quantity != Quantity::kLsRoundness;
    const Eigen::Vector2d axis_mm =
        about_axis ? Eigen::Vector2d(axis_mm_.value_or(center_mm_) - center_mm_)
                   : Eigen::Vector2d(Eigen::Vector2d::Zero());
    Eigen::VectorXd reach(found_.size());
    for (Eigen::Index i = 0; i < found_.size(); ++i) {
      reach(i) = ((radius_mm_ + curve(i)) * normals_[static_cast<std::size_t>(i)] - axis_mm).norm();
    }
    const double near_mm = std::max(point_mm, kLeastPointError);
    const double low_mm = reach.minCoeff() + near_mm;
    const double high_mm = reach.maxCoeff() - near_mm;
    for (Eigen::Index i = 0; i < found_.size(); ++i) {
      if (found_.size() <= kMany || reach(i) <= low_mm || reach(i) >= high_mm) out.push_back(i);
    }
    return out;
  }

  Eigen::Vector2d center_mm_;
  double radius_mm_ = 0.0;
  std::optional<Eigen::Vector2d> axis_mm_;
  std::vector<Eigen::Vector2d> normals_;
  std::optional<AngularCurve> angular_;
  Eigen::VectorXd found_;
  Eigen::VectorXd oval_;
};

/// Which influences a quantity depends on.
struct Depends {
  bool axis = false;
  bool scale = false;  ///< Form changes with scale by less than 1e-4 of itself.
  bool squareness = true;
  bool common = false;  ///< Threshold and wear move the radius alone.
};

Depends depends_of(Quantity quantity) {
  const bool effective = quantity == Quantity::kEffectiveRadius;
  return {.axis = effective || quantity == Quantity::kRunOut,
          .scale = effective,
          .squareness = true,
          .common = effective};
}

/// One influence as the report lists it.
InfluenceStatement statement_of(std::string name, const Influence& influence,
                                std::string_view unit) {
  if (!influence) return {std::move(name), false, core::phrase("not declared")};
  const core::Phrase text =
      influence->distribution == DeclaredInfluence::Distribution::kNormal
          ? core::phrase("{:g} {}, normal", influence->value, core::as_it_is(std::string(unit)))
          : core::phrase("half-width {:g} {}, rectangular", influence->value,
                         core::as_it_is(std::string(unit)));
  return {std::move(name), true, text};
}

InfluenceStatement statement_of(const MeasuredAxis& axis) {
  if (!axis.root_mm) return {"measured-axis", false, core::phrase("not declared")};
  return {"measured-axis", true,
          core::phrase("{} and {} um across, by the points of feature {}",
                       core::um(axis.root_mm->col(0).norm()), core::um(axis.root_mm->col(1).norm()),
                       axis.feature)};
}

std::vector<InfluenceStatement> declaration_of(const WheelResult& result, const Depends& depends) {
  const WheelInfluencesTask& said = *result.declared;
  std::vector<InfluenceStatement> out = {statement_of("edge-points", said.point_um, "um")};
  if (depends.axis) {
    if (result.measured_axis) out.push_back(statement_of(*result.measured_axis));
    // Of a measured axis it is what that moved since: another influence, which may be missing.
    out.push_back(statement_of("wheel-axis", said.axis_um, "um"));
  }
  if (depends.scale) out.push_back(statement_of("stage-scale", said.scale_ppm, "ppm"));
  if (depends.squareness) {
    out.push_back(statement_of("stage-squareness", said.squareness_urad, "urad"));
  }
  if (depends.common) {
    out.push_back(statement_of("edge-threshold", said.threshold_um, "um"));
    out.push_back(statement_of("wheel-wear", said.wear_um, "um"));
  }
  return out;
}

std::vector<LinearTerm> budget_of(const WheelResult& result, const Edge& edge, Quantity quantity) {
  const WheelInfluencesTask& said = *result.declared;
  const auto& axis = result.measured_axis;
  const Influences u = standard_of(said);
  const Depends depends = depends_of(quantity);
  const std::vector<double> found_mm = edge.found_mm();
  const auto change = [&](const Influences& one_u, const Eigen::Vector2d& axis_shift_mm) {
    return per_u([&](double k) {
      Influences one = {k * one_u.axis_x_mm,      k * one_u.axis_z_mm,    k * one_u.scale_1,
                        k * one_u.squareness_rad, k * one_u.threshold_mm, k * one_u.wear_mm};
      shift_axis(k * axis_shift_mm, one);
      return edge.value(quantity, found_mm, one);
    });
  };
  const auto alone = [&](double Influences::*member) {
    Influences one;
    one.*member = u.*member;
    return change(one, Eigen::Vector2d::Zero());
  };
  std::vector<LinearTerm> out = {
      {"edge-points", edge.per_point(quantity, record::u_of(said.point_um) * kMicrometre)}};
  if (depends.axis) {
    out.push_back({"wheel-axis-x", alone(&Influences::axis_x_mm)});
    out.push_back({"wheel-axis-z", alone(&Influences::axis_z_mm)});
    if (axis && axis->root_mm) {
      out.push_back({"measured-axis-major", change({}, axis->root_mm->col(0))});
      out.push_back({"measured-axis-minor", change({}, axis->root_mm->col(1))});
    }
  }
  if (depends.scale) out.push_back({"stage-scale", alone(&Influences::scale_1)});
  if (depends.squareness) {
    Influences one;
    one.squareness_rad = u.squareness_rad;
    Eigen::Vector2d axis_shift_mm = Eigen::Vector2d::Zero();
    if (depends.axis && axis) {
      axis_shift_mm = record::u_of(axis->squareness_urad) * kMicroradian * axis->per_squareness_mm;
    }
    out.push_back({"stage-squareness", change(one, axis_shift_mm)});
  }
  if (depends.common) {
    out.push_back({"edge-threshold", alone(&Influences::threshold_mm)});
    out.push_back({"wheel-wear", alone(&Influences::wear_mm)});
  }
  return out;
}

UncertaintyStatus stated(core::Result<UncertaintyResult> found, const UncertaintyOptions& options) {
  if (!found) return UncertaintyStatus::none(found.error().said());
  return UncertaintyStatus::stated(*std::move(found), options.coverage);
}

/// The interval of a quantity of the edge.
UncertaintyStatus interval_of(const WheelResult& result, const Edge& edge, Quantity quantity,
                              double as_measured_mm, const UncertaintyOptions& options) {
  const WheelInfluencesTask& said = *result.declared;
  const auto& axis = result.measured_axis;
  if (depends_of(quantity).axis && axis && !axis->root_mm) {
    return UncertaintyStatus::none(
        core::phrase("feature {} gives the axis and declares no point_um: the uncertainty of the "
                     "axis is not known",
                     axis->feature));
  }
  if (depends_of(quantity).axis && !axis && !said.axis_um) {
    return UncertaintyStatus::none(core::phrase(
        "axis_um, the uncertainty of the axis, is not declared: run-out and effective radius "
        "depend on it"));
  }
  const CurveDraws draws(edge.measured(record::u_of(said.point_um) * kMicrometre), options.seed,
                         "wheel.points");
  TrialValues trials;
  trials.as_measured_mm = as_measured_mm;
  trials.core_center_mm = edge.value(quantity, draws.core_mm(), {});
  for (int t = 0; t < options.least_trials; ++t) {
    const Influences drawn = draw_of(result, options.seed, t);
    trials.values_mm.push_back(edge.value(quantity, draws.draw(t), drawn));
    trials.core_mm.push_back(edge.value(quantity, draws.core_draw(t), drawn));
  }
  return stated(statement_of_trials(std::move(trials), budget_of(result, edge, quantity),
                                    declaration_of(result, depends_of(quantity)), options),
                options);
}

bool is_flat(const Influence& influence) {
  return influence && influence->distribution == DeclaredInfluence::Distribution::kRectangular;
}

/// The independent errors of the radius; where the feature declares its influences.
std::vector<RadiusError> errors_of_radius(const WheelResult& result, const Edge& edge) {
  const WheelInfluencesTask& said = *result.declared;
  const fit::WheelMeasurement& m = result.evaluation.wheel;
  const Influences u = standard_of(said);
  return {{"edge-points", "wheel.radius",
           record::u_of(said.point_um) * kMicrometre * m.factors.radius, false},
          {"wheel-lobes", "wheel.lobes", m.lobes_in_radius_mm, false},
          {"stage-scale", "stage.scale", u.scale_1 * m.radius_mm, is_flat(said.scale_ppm)},
          {"edge-threshold", "wheel.threshold", u.threshold_mm, is_flat(said.threshold_um)},
          {"wheel-wear", "wheel.wear", u.wear_mm, is_flat(said.wear_um)},
          {"stage-squareness", "stage.squareness", u.squareness_rad * edge.oval_in_radius_mm(),
           is_flat(said.squareness_urad)}};
}

/// The interval of R - R_nom with its sign, or of its amount: trials of the signed departure, then
/// folded at 0. The upper end of these lies within T only where both ends of the signed interval
/// lie within +-T.
UncertaintyStatus radius_interval(const WheelResult& result, const Edge& edge, bool with_sign,
                                  const UncertaintyOptions& options) {
  const fit::WheelMeasurement& m = result.evaluation.wheel;
  const auto& nominal_mm = result.task.wheel.nominal_radius_mm;
  if (!nominal_mm) return UncertaintyStatus::none(core::phrase("there is no nominal radius"));
  const double departure_mm = result.judged_radius_mm() - *nominal_mm;
  const WheelInfluencesTask& said = *result.declared;
  std::vector<RadiusError> errors = errors_of_radius(result, edge);
  if (result.expansion_1_K) {  // of the correction to 20 degC
    errors.push_back(
        {"wheel-expansion", "wheel.expansion",
         m.radius_mm * result.above_20_K.value_or(0.0) * record::u_of(said.expansion_per_K),
         is_flat(said.expansion_per_K)});
    errors.push_back({"wheel-temperature", "wheel.temperature",
                      m.radius_mm * *result.expansion_1_K * record::u_of(said.temperature_K),
                      is_flat(said.temperature_K)});
  }
  const auto judged = [&](double value_mm) { return with_sign ? value_mm : std::abs(value_mm); };
  TrialValues trials;
  trials.signed_value = with_sign;
  trials.as_measured_mm = judged(departure_mm);
  for (int t = 0; t < options.least_trials; ++t) {
    trials.values_mm.push_back(judged(departure_mm + drawn_mm(errors, options.seed, t)));
  }
  std::vector<LinearTerm> terms;
  for (const RadiusError& error : errors) terms.push_back({std::string(error.name), error.u_mm});
  const Depends depends = {.axis = false, .scale = true, .squareness = true, .common = true};
  std::vector<InfluenceStatement> declaration = declaration_of(result, depends);
  if (m.lobes_in_radius_mm > 0.0) {
    declaration.push_back({"wheel-lobes", true,
                           core::phrase("lobes of orders 2 and 3, {} um in R, from the residuals "
                                        "of the arc",
                                        core::um(m.lobes_in_radius_mm))});
  }
  if (result.expansion_1_K) {
    declaration.push_back(statement_of("wheel-expansion", said.expansion_per_K, "1/K"));
    declaration.push_back(statement_of("wheel-temperature", said.temperature_K, "K"));
  }
  return stated(
      statement_of_trials(std::move(trials), std::move(terms), std::move(declaration), options),
      options);
}

/// Why there is no interval of anything.
std::optional<core::Phrase> undeclared(const WheelResult& result) {
  if (!result.declared)
    return core::phrase("the plan declares no influences of this feature: wheel/uncertainty");
  if (!result.declared->point_um) {
    return core::phrase(
        "point_um, the uncertainty of a point, is not declared: the spread of the points holds the "
        "form of the wheel as well and does not replace it");
  }
  if (result.points_mm.size() > kMostPoints) {
    return core::phrase("{} points: intervals are computed of at most {}", result.points_mm.size(),
                        kMostPoints);
  }
  return std::nullopt;
}

core::Result<Edge> edge_of(const WheelResult& result) {
  TRY(const auto circle, fit::ls_circle(result.points_mm));
  return Edge(result.points_mm, circle, result.task.wheel.axis_mm);
}

}  // namespace

std::vector<UncertaintyStatus> intervals_of(const WheelResult& result,
                                            std::span<const record::Characteristic> characteristics,
                                            const UncertaintyOptions& options) {
  const auto none = [&](const core::Phrase& why) {
    return std::vector<UncertaintyStatus>(characteristics.size(), UncertaintyStatus::none(why));
  };
  if (const auto why = undeclared(result)) return none(*why);
  const auto edge = edge_of(result);
  if (!edge) return none(edge.error().said());
  std::vector<UncertaintyStatus> out;
  for (const record::Characteristic& asked : characteristics) {
    if (asked.form == record::Form::kRadius) {
      out.push_back(radius_interval(result, *edge, has_signed_limits(asked), options));
      continue;
    }
    const auto value = value_of(result, asked);
    if (!value) {
      out.push_back(UncertaintyStatus::none(value.error().said()));
      continue;
    }
    const Quantity quantity = asked.form == record::Form::kRunOut ? Quantity::kRunOut
                              : asked.reference == record::Reference::kLeastSquares
                                  ? Quantity::kLsRoundness
                                  : Quantity::kMzRoundness;
    out.push_back(interval_of(result, *edge, quantity, value->value_mm, options));
  }
  return out;
}

core::Result<MeasuredRadius> measured_radius(const WheelResult& swept, const std::string& id) {
  const fit::WheelMeasurement& wheel = swept.evaluation.wheel;
  if (wheel.mode != fit::WheelMode::kEnvelope) {
    return core::fail(core::Code::kMeaning,
                      core::phrase("feature {} is no wheel of mode envelope, so it gives no radius "
                                   "with which the wheel grinds",
                                   id));
  }
  if (!wheel.radius_void_because.empty()) {
    return core::fail(core::Code::kMeaning, core::phrase("the radius of feature {} is void: {}", id,
                                                         wheel.radius_void_because));
  }
  if (wheel.form_in_radius_mm() > 0.0) {
    // Its errors count noise. Neighbouring residuals that are alike move the radius by more.
    return core::fail(
        core::Code::kMeaning,
        core::phrase(
            "the points of feature {} see an arc, and neighbouring residuals are alike (tau "
            "{:.2f}): form moves its radius by an unknown amount; measure more of the circle",
            id, wheel.correlation));
  }
  MeasuredRadius out{id, wheel.radius_mm, swept.task.wheel.nominal_radius_mm, std::nullopt};
  if (!swept.declared || !swept.declared->point_um) return out;
  TRY(const auto edge, edge_of(swept));
  out.errors = errors_of_radius(swept, edge);
  return out;
}

UncertaintyStatus effective_radius_interval(const WheelResult& result,
                                            const UncertaintyOptions& options) {
  const auto& runout = result.evaluation.wheel.runout;
  if (!runout) return UncertaintyStatus::none(result.evaluation.wheel.runout_absent);
  if (const auto why = undeclared(result)) return UncertaintyStatus::none(*why);
  const auto edge = edge_of(result);
  if (!edge) return UncertaintyStatus::none(edge.error().said());
  return interval_of(result, *edge, Quantity::kEffectiveRadius, runout->effective_radius_mm,
                     options);
}

}  // namespace rondure::evaluation
