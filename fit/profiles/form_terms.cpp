#include "fit/profiles/form_terms.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "core/decompositions.h"
#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/geometry/points.h"

namespace rondure::fit {
namespace {

constexpr int kHighestUndulation = 15;

/// Number of terms up to P and K.
Eigen::Index terms_up_to(int axial, int undulation) { return (axial + 1) * (2 * undulation + 1); }

/// K as the sections determine it.
int undulations_of(const std::vector<Section>& sections, int axial, std::size_t points) {
  int out = kHighestUndulation;
  for (const Section& section : sections) {
    const int count = static_cast<int>(section.points_mm.size());
    const double gap = largest_gap_rad(section.points_mm, section.circle.center_mm);
    // A gap of half an undulation hides it.
    const int seen = static_cast<int>(std::ceil(0.5 * core::kTwoPi / gap)) - 1;
    out = std::min({out, (count - 1) / 2, seen});
  }
  while (out > 0 && terms_up_to(axial, out) >= static_cast<Eigen::Index>(points)) --out;
  return out;
}

Eigen::VectorXd terms_at(double zeta, double angle, int axial, int undulation) {
  const double legendre[] = {1.0, zeta, 0.5 * (3.0 * zeta * zeta - 1.0)};
  Eigen::VectorXd out(terms_up_to(axial, undulation));
  Eigen::Index row = 0;
  for (int p = 0; p <= axial; ++p) {
    out(row++) = legendre[p];
    for (int k = 1; k <= undulation; ++k) {
      out(row++) = legendre[p] * std::cos(k * angle);
      out(row++) = legendre[p] * std::sin(k * angle);
    }
  }
  return out;
}

}  // namespace

double FormTerm::amplitude_mm() const { return std::hypot(cosine_mm, sine_mm); }

const FormTerm& FormTerms::at(int axial, int undulation) const {
  assert(axial <= highest_axial && undulation <= highest_undulation);
  return terms[static_cast<std::size_t>(axial * (highest_undulation + 1) + undulation)];
}

core::Result<FormTerms> form_terms(Layers layers_mm, const LsCylinder& cylinder) {
  const auto sections = sections_across(layers_mm, cylinder.axis);
  if (!sections) return core::fail(sections.error());
  if (sections->size() < 2) {
    return core::fail(core::Code::kRank,
                      "one section shows no taper and no bend; measure at least 3 sections");
  }
  const auto points = all_points(layers_mm);
  FormTerms out;
  out.highest_axial = std::min(2, static_cast<int>(sections->size()) - 1);
  out.highest_undulation = undulations_of(*sections, out.highest_axial, points.size());
  const Extremes heights = extremes_of(points, [&](const Eigen::Vector3d& p) {
    return (p - cylinder.axis.point_mm).dot(cylinder.axis.direction);
  });
  const auto frame = across(cylinder.axis.direction);
  const auto row_of = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d v = p - cylinder.axis.point_mm;
    const Eigen::Vector2d q = frame.transpose() * v;
    const double zeta =
        (2.0 * v.dot(cylinder.axis.direction) - heights.low - heights.high) / heights.width();
    return terms_at(zeta, std::atan2(q.y(), q.x()), out.highest_axial, out.highest_undulation);
  };
  const auto deviation = [&](const Eigen::Vector3d& p) {
    return distance_mm(cylinder.axis, p) - cylinder.radius_mm;
  };
  const Eigen::Index count = terms_up_to(out.highest_axial, out.highest_undulation);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  for (const Eigen::Vector3d& p : points) {
    const Eigen::VectorXd row = row_of(p);
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    right += deviation(p) * row;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(
      Eigen::MatrixXd(normal.selfadjointView<Eigen::Lower>()));
  factors.setThreshold(1e-10);
  if (!factors.isInvertible()) {
    return core::fail(core::Code::kRank,
                      fmt::format("the points do not determine the {} terms up to {} undulations: "
                                  "measure all round in sections apart from each other",
                                  count, out.highest_undulation));
  }
  const Eigen::VectorXd x = factors.solve(right);
  double squares = 0.0;
  for (const Eigen::Vector3d& p : points) {
    const double residual = deviation(p) - x.dot(row_of(p));
    squares += residual * residual;
  }
  out.rms_mm = std::sqrt(squares / static_cast<double>(points.size()));
  Eigen::Index at = 0;
  for (int p = 0; p <= out.highest_axial; ++p) {
    out.terms.push_back({p, 0, x(at++), 0.0});
    for (int k = 1; k <= out.highest_undulation; ++k, at += 2) {
      out.terms.push_back({p, k, x(at), x(at + 1)});
    }
  }
  return out;
}

}  // namespace rondure::fit
