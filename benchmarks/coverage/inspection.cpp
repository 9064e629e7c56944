#include "benchmarks/coverage/inspection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

namespace rondure::coverage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;

/// Waves k = 2..highest times degrees 0..2, amplitudes falling as 1/(k (1 + d)).
VectorXd waves(const Places& at, int highest, Random& random) {
  const Eigen::ArrayXd q = at.q.array();
  const std::array<Eigen::ArrayXd, 3> p = {Eigen::ArrayXd::Ones(q.size()), q, 1.5 * q * q - 0.5};
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(q.size());
  for (int k = 2; k <= highest; ++k) {
    const Eigen::ArrayXd c = (k * at.angle_rad.array()).cos();
    const Eigen::ArrayXd s = (k * at.angle_rad.array()).sin();
    for (int d = 0; d < 3; ++d) {
      const double along = random.normal() / (k * (1 + d));
      const double across = random.normal() / (k * (1 + d));
      out += p[static_cast<std::size_t>(d)] * (along * c + across * s);
    }
  }
  return out;
}

}  // namespace

Random::Random(const std::string& name, int trial) {
  std::vector<std::uint32_t> key(name.begin(), name.end());
  key.push_back(static_cast<std::uint32_t>(trial));
  std::seed_seq seed(key.begin(), key.end());
  bits_.seed(seed);
}

double Random::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53;
}

double Random::normal() {  // Box and Muller
  const double size = std::sqrt(-2.0 * std::log(uniform(0.0, 1.0)));
  return size * std::cos(uniform(0.0, 2.0 * kPi));
}

Index Random::below(Index count) {
  return std::min(count - 1, static_cast<Index>(uniform(0.0, static_cast<double>(count))));
}

const std::vector<Layout>& layouts() {  // 50 batches: 1000, 300 or 100 trials
  static const std::vector<Layout> all = {
      {"28", 4, 7, 20},          {"112", 4, 28, 20},        {"240", 5, 48, 20},
      {"480", 5, 96, 20},        {"1440", 4, 360, 6},       {"5000", 10, 500, 2},
      {"circle50", 1, 50, 20},   {"circle100", 1, 100, 20}, {"circle200", 1, 200, 20},
      {"circle400", 1, 400, 20}, {"circle1000", 1, 1000, 6}};
  return all;
}

Places::Places(const Layout& l) : angle_rad(l.points()), q(l.points()) {
  for (int i = 0; i < l.points(); ++i) {
    const int layer = i / l.per_layer;
    const double turn = layer / static_cast<double>(l.layers);
    angle_rad[i] = 2.0 * kPi * (i % l.per_layer + turn) / l.per_layer;
    q[i] = l.circle() ? 0.0 : -1.0 + 2.0 * layer / (l.layers - 1.0);
  }
}

MatrixXd rigid_columns(const Places& at, bool circle) {
  MatrixXd out(at.q.size(), circle ? 3 : 5);
  out.col(0).setOnes();
  out.col(1) = at.angle_rad.array().cos();
  out.col(2) = at.angle_rad.array().sin();
  if (!circle) out.rightCols(2) = at.q.asDiagonal() * out.middleCols(1, 2);
  return out;
}

VectorXd free_of(const MatrixXd& rigid, const VectorXd& y) {
  return y - rigid * rigid.householderQr().solve(y);
}

// The linear programme of the Chebyshev approximation, by the
// simplex method on its dual. A basis is as many points as R has columns and one more, a sign and
// a weight >= 0 each, so that the signed rows sum to zero: no zone is narrower than twice the
// weighted sum of the signed f. Points outside of what the basis gives enter one by one.
Zone minimum_zone(const MatrixXd& rigid, const VectorXd& f) {
  const Index n = rigid.rows();
  const Index m = rigid.cols() + 1;
  Random random("zone", static_cast<int>(n));
  // Repeated angles would leave weights of zero, on which the method can go in circles.
  MatrixXd rows = rigid;
  for (double& entry : rows.rightCols(m - 2).reshaped()) entry += random.uniform(-1e-8, 1e-8);

  std::vector<Index> basis(static_cast<std::size_t>(m));
  MatrixXd system(m, m);  // columns: signed row, 1
  VectorXd sign(m);
  for (double smallest = 0.0; smallest < 1e-2;) {  // points that determine all columns
    for (Index& i : basis) i = random.below(n);
    const MatrixXd picked = rows(basis, Eigen::all);
    const Eigen::JacobiSVD<MatrixXd> svd(picked, Eigen::ComputeFullU);
    smallest = svd.singularValues().minCoeff();
    const VectorXd null = svd.matrixU().col(m - 1);
    for (Index k = 0; k < m; ++k) sign[k] = null[k] < 0.0 ? -1.0 : 1.0;
  }
  for (int step = 0; step < 5000; ++step) {
    VectorXd signed_f(m);
    for (Index k = 0; k < m; ++k) {
      const Index i = basis[static_cast<std::size_t>(k)];
      system.col(k) << sign[k] * rows.row(i).transpose(), 1.0;
      signed_f[k] = sign[k] * f[i];
    }
    const Eigen::PartialPivLU<MatrixXd> lu(system);
    const VectorXd weight = lu.solve(VectorXd::Unit(m, m - 1));
    const VectorXd x = lu.transpose().solve(signed_f);  // motion, then half the width
    const VectorXd left = f - rows * x.head(m - 1);
    Index worst = 0;
    const double most = left.cwiseAbs().maxCoeff(&worst);
    if (most <= x[m - 1] + 1e-10) {
      const VectorXd exact = f - rigid * x.head(m - 1);
      const double width = exact.maxCoeff() - exact.minCoeff();
      return {width, std::abs(width - 2.0 * weight.dot(signed_f))};
    }
    const double entering = left[worst] < 0.0 ? -1.0 : 1.0;
    VectorXd column(m);
    column << entering * rows.row(worst).transpose(), 1.0;
    const VectorXd fall = lu.solve(column);
    Index leaving = -1;
    for (Index k = 0; k < m; ++k) {
      if (fall[k] > 1e-14 &&
          (leaving < 0 || weight[k] * fall[leaving] < weight[leaving] * fall[k])) {
        leaving = k;
      }
    }
    if (leaving < 0) break;
    basis[static_cast<std::size_t>(leaving)] = worst;
    sign[leaving] = entering;
  }
  return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
}

const std::vector<std::string>& surfaces() {
  static const std::vector<std::string> all = {"smooth", "1/k",  "chatter", "barrel",
                                               "burr",   "flat", "scratch"};
  return all;
}

VectorXd ground(const Layout& layout, const Places& at, const std::string& surface,
                Random& random) {
  const Eigen::ArrayXd q = at.q.array();
  const Eigen::ArrayXd angle = at.angle_rad.array();
  Eigen::ArrayXd out;
  if (surface == "1/k") {
    out = waves(at, layout.circle() ? 200 : 150, random);
  } else if (surface == "chatter") {
    const double lobes = random.uniform(0.0, 2.0 * kPi);
    const double chatter = random.uniform(0.0, 2.0 * kPi);
    out = 1.5 * (3.0 * angle + lobes).cos() + 0.4 * (60.0 * angle + chatter).cos() +
          0.3 * random.normal() * q;
  } else if (surface == "barrel") {
    const double taper = random.uniform(0.5, 1.5);
    out = taper * q + random.uniform(0.5, 1.5) * q * q;
    for (int k = 2; k <= 5; ++k) {
      out += 0.3 / k * random.normal() * (k * angle).cos();
      out += 0.3 / k * random.normal() * (k * angle).sin();
    }
  } else {
    out = waves(at, 15, random);
    out += random.normal() / 2.0 * q;
    out += random.normal() / 2.0 * q * q;
  }
  return out * (kForm_um / (out.maxCoeff() - out.minCoeff()));
}

VectorXd with_feature(const Layout& layout, const Places& at, const std::string& surface,
                      VectorXd out, Random& random) {
  if (surface != "burr" && surface != "flat" && surface != "scratch") return out;
  const Index centre = random.below(out.size());
  const double spacing = 2.0 * kPi / layout.per_layer;
  const double angle = at.angle_rad[centre] + random.uniform(-0.3, 0.3) * spacing;
  const double size = surface == "burr"   ? random.uniform(3.0, 10.0)
                      : surface == "flat" ? random.uniform(2.0, 6.0)
                                          : random.uniform(2.0, 5.0);
  for (Index i = 0; i < out.size(); ++i) {
    const double along = at.q[i] - at.q[centre];
    const double t = std::remainder(at.angle_rad[i] - angle, 2.0 * kPi);
    if (surface == "burr") {
      const double distance_mm = std::hypot(kRadius_mm * t, kHalfLength_mm * along);
      out[i] += size * std::exp(-0.5 * std::pow(distance_mm / 0.425, 2));
    } else if (surface == "flat") {
      out[i] += std::min(0.0, 1000.0 * kRadius_mm * t * t / 2.0 - size);
    } else {
      const double off = std::remainder(t - along / 4.0, 2.0 * kPi);
      out[i] -= size * std::exp(-0.5 * std::pow(kRadius_mm * off / 0.15, 2));
    }
  }
  return out;
}

const std::vector<Noise>& noises() {
  using Kind = Noise::Kind;
  static const std::vector<Noise> all = {
      {"0.1", 0.1, Kind::kNormal},        {"0.3", 0.3, Kind::kNormal},
      {"1", 1.0, Kind::kNormal},          {"0.3-t3", 0.3, Kind::kStudent},
      {"0.3-ar", 0.3, Kind::kCorrelated}, {"0.3-spike", 0.3, Kind::kSpike}};
  return all;
}

VectorXd errors(const Layout& layout, const Noise& noise, Random& random) {
  VectorXd out(layout.points());
  for (Index i = 0; i < out.size(); ++i) {
    const double z = random.normal();
    out[i] = z;
    if (noise.kind == Noise::Kind::kStudent) {  // 3 degrees of freedom, whose variance is 3
      double chi2 = 0.0;
      for (int k = 0; k < 3; ++k) chi2 += std::pow(random.normal(), 2);
      out[i] = z / std::sqrt(chi2);
    } else if (noise.kind == Noise::Kind::kCorrelated &&
               i % layout.per_layer != 0) {  // each layer is a scan
      out[i] = 0.9 * out[i - 1] + std::sqrt(1.0 - 0.81) * z;
    }
  }
  if (noise.kind == Noise::Kind::kSpike) {
    out[random.below(out.size())] = random.uniform(-1.0, 1.0) < 0.0 ? -5.0 : 5.0;
  }
  return noise.sigma_um * out;
}

}  // namespace rondure::coverage
