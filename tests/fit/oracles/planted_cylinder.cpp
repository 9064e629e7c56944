#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include "core/noise.h"
#include "core/units.h"
#include "planted.h"
#include "planted_fill.h"
#include "witness.h"

namespace rondure::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Contacts in the frame of the axis, the outer ones first.
struct CylinderContacts {
  VectorXd angle_rad;
  VectorXd height_mm;
  Index outer = 0;
  double growth = 0.0;
  double curvature = 0.0;
};

double sign_of(const CylinderContacts& contacts, Index i) {
  return i < contacts.outer ? 1.0 : -1.0;
}

/// Columns (n, s n / Z) with the sign of the gradients.
MatrixXd gradients(const CylinderContacts& contacts, double half_length_mm) {
  MatrixXd out(4, contacts.angle_rad.size());
  for (Index i = 0; i < out.cols(); ++i) {
    const Eigen::Vector2d n(std::cos(contacts.angle_rad(i)), std::sin(contacts.angle_rad(i)));
    out.col(i) << -n, -contacts.height_mm(i) / half_length_mm * n;
  }
  return out;
}

Index draw_outer(Reference reference, Index contacts, core::KeyedNoise& noise) {
  if (reference == Reference::kCircumscribed) return contacts;
  if (reference == Reference::kInscribed) return 0;
  return 2 + static_cast<Index>(noise.uniform() * static_cast<double>(contacts - 3));
}

VectorXd draw_angles(Index n, core::KeyedNoise& noise) {
  VectorXd out(n);
  for (Index i = 0; i < n; ++i) out(i) = core::kTwoPi * noise.uniform();
  return out;
}

std::optional<CylinderContacts> draw_full(const Plot& plot, core::KeyedNoise& noise) {
  const Index n = plot.reference == Reference::kMinZone ? 6 : 5;
  CylinderContacts out{draw_angles(n, noise), VectorXd(n), draw_outer(plot.reference, n, noise)};
  for (Index i = 0; i < n; ++i)
    out.height_mm(i) = plot.half_length_mm * (2.0 * noise.uniform() - 1);
  const auto witness = weigh(gradients(out, plot.half_length_mm), out.outer);
  if (!witness || witness->growth < 0.03) return std::nullopt;
  out.growth = witness->growth;
  return out;
}

/// Multipliers that balance the normals: a point of the solutions' line, by chance.
VectorXd balanced(const CylinderContacts& contacts, core::KeyedNoise& noise) {
  const Index n = contacts.angle_rad.size();
  MatrixXd rows = MatrixXd::Zero(4, n);
  for (Index i = 0; i < n; ++i) {
    rows.col(i).head<2>() = sign_of(contacts, i) * Eigen::Vector2d(std::cos(contacts.angle_rad(i)),
                                                                   std::sin(contacts.angle_rad(i)));
    rows(i < contacts.outer ? 2 : 3, i) = 1.0;
  }
  const Eigen::Vector4d sums(0.0, 0.0, contacts.outer > 0 ? 1.0 : 0.0,
                             contacts.outer < n ? 1.0 : 0.0);
  const MatrixXd kernel = Eigen::FullPivLU<MatrixXd>(rows).kernel();
  return rows.completeOrthogonalDecomposition().solve(sums) +
         0.3 * noise.normal() * kernel.col(0).normalized();
}

/// Heights that balance the tilts for these multipliers, between -Z and Z.
VectorXd level(const CylinderContacts& contacts, const VectorXd& weights, double half_length_mm,
               core::KeyedNoise& noise) {
  MatrixXd rows(2, weights.size());
  for (Index i = 0; i < weights.size(); ++i) {
    rows.col(i) = sign_of(contacts, i) * weights(i) *
                  Eigen::Vector2d(std::cos(contacts.angle_rad(i)), std::sin(contacts.angle_rad(i)));
  }
  const MatrixXd kernel = Eigen::FullPivLU<MatrixXd>(rows).kernel();
  VectorXd mix(kernel.cols());
  for (Index k = 0; k < mix.size(); ++k) mix(k) = noise.normal();
  VectorXd heights = kernel * mix;
  heights.array() -= (heights.maxCoeff() + heights.minCoeff()) / 2.0;  // equal heights balance too
  return heights * (half_length_mm / heights.maxCoeff());
}

/// x^T H x of the distance of a contact (methods, certificates section 1), x in mm.
double bend(double angle_rad, double height_mm, double radius_mm, double half_length_mm,
            const Eigen::Vector4d& x) {
  const Eigen::Vector2d n(std::cos(angle_rad), std::sin(angle_rad));
  const Eigen::Vector2d m(-n.y(), n.x());
  const Eigen::Vector2d tilt = x.tail<2>() / half_length_mm;
  const double side = m.dot(x.head<2>() + height_mm * tilt);
  return side * side / radius_mm - radius_mm * std::pow(n.dot(tilt), 2);
}

std::optional<CylinderContacts> draw_curved(const Plot& plot, core::KeyedNoise& noise) {
  const Index n = plot.reference == Reference::kMinZone ? 5 : 4;
  CylinderContacts out{draw_angles(n, noise), VectorXd(n), draw_outer(plot.reference, n, noise)};
  const VectorXd weights = balanced(out, noise);
  if (weights.minCoeff() < 0.05) return std::nullopt;
  out.height_mm = level(out, weights, plot.half_length_mm, noise);
  const MatrixXd columns = gradients(out, plot.half_length_mm);
  MatrixXd equal(n, 4);  // differences of the gradients of each side
  for (Index i = 0; i < n; ++i) {
    equal.row(i) = (columns.col(i) - columns.col(i < out.outer ? 0 : out.outer)).transpose();
  }
  const Eigen::FullPivLU<MatrixXd> lu(equal);
  if (lu.dimensionOfKernel() != 1) return std::nullopt;
  const Eigen::Vector4d free = lu.kernel().col(0).normalized();
  const Eigen::MatrixXd frame = Eigen::HouseholderQR<MatrixXd>(free).householderQ();
  const auto witness = weigh(frame.rightCols(3).transpose() * columns, out.outer);
  if (!witness || witness->growth < 0.05) return std::nullopt;
  out.growth = witness->growth;
  for (Index i = 0; i < n; ++i) {
    out.curvature +=
        sign_of(out, i) * weights(i) *
        bend(out.angle_rad(i), out.height_mm(i), plot.radius_mm, plot.half_length_mm, free);
  }
  if (out.curvature < 0.1 / plot.radius_mm) return std::nullopt;
  return out;
}

/// Most that the form may be: a small part of the ball in which no other optimum lies.
double ball(const Plot& plot, const CylinderContacts& contacts) {
  const double bent = 1.0 / plot.radius_mm + plot.radius_mm / std::pow(plot.half_length_mm, 2);
  if (!plot.curved) return contacts.growth / (20.0 * bent);
  return 0.1 * contacts.curvature * contacts.growth / (bent * bent);
}

Eigen::Isometry3d draw_place(double offset_mm, core::KeyedNoise& noise) {
  const auto normal4 = [&] {
    const double a = noise.normal();
    const double b = noise.normal();
    const double c = noise.normal();
    return Eigen::Vector4d(a, b, c, noise.normal());
  };
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.rotate(Eigen::Quaterniond(normal4()).normalized());
  place.pretranslate(offset_mm * normal4().head<3>().normalized());
  return place;
}

}  // namespace

PlantedCylinder plant_cylinder(const Plot& plot, std::uint64_t seed) {
  core::KeyedNoise noise(seed,
                         {82, static_cast<std::uint64_t>(plot.reference), plot.curved ? 1U : 0U});
  std::optional<CylinderContacts> contacts;
  while (!contacts) contacts = plot.curved ? draw_curved(plot, noise) : draw_full(plot, noise);
  const Band band = draw_band(plot, ball(plot, *contacts), noise);
  PlantedCylinder out;
  out.optimum = band.optimum(plot.reference);
  out.optimum.growth = contacts->growth;
  out.optimum.curvature = contacts->curvature;
  out.half_length_mm = plot.half_length_mm;
  const auto add = [&](double r, double angle, double z) {
    out.points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  };
  const Index n = contacts->angle_rad.size();
  for (Index i = 0; i < n; ++i) {
    add(i < contacts->outer ? band.high_mm : band.low_mm, contacts->angle_rad(i),
        contacts->height_mm(i));
  }
  const int layers = 2 + static_cast<int>(3.0 * noise.uniform());
  const int around = std::max(5, plot.fill / layers);
  for (int k = 0; k < layers * around; ++k) {
    const double angle = core::kTwoPi * (k / layers + 0.6 * noise.uniform()) / around;
    const double z = plot.half_length_mm * (2.0 * (k % layers) / (layers - 1) - 1.0);
    add(band.inside(noise.uniform()), angle, z);
  }
  const Eigen::Isometry3d place = draw_place(plot.offset_mm, noise);
  for (auto& p : out.points) p = place * p;
  out.center_mm = place.translation();
  out.direction = place.rotation().col(2);
  out.optimum.contacts = shuffle(out.points, static_cast<std::size_t>(n), noise);
  return out;
}

Plot draw_plot(Reference reference, std::uint64_t seed) {
  core::KeyedNoise noise(seed, {83});
  Plot plot;
  plot.reference = reference;
  plot.radius_mm = std::pow(200.0, noise.uniform());
  plot.half_length_mm = plot.radius_mm * std::pow(10.0, 1.3 * noise.uniform() - 0.3);
  plot.form_mm = plot.radius_mm * std::pow(10.0, -3.0 - 3.0 * noise.uniform());
  plot.offset_mm = 500.0 * noise.uniform();
  plot.fill = 12 + static_cast<int>(20.0 * noise.uniform());
  return plot;
}

}  // namespace rondure::test
