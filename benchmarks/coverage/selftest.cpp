#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "benchmarks/coverage/inspection.h"

namespace rondure::coverage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The narrowest zone by trying every set of points that can determine one.
double zone_by_force(const MatrixXd& rigid, const VectorXd& f) {
  const Index m = rigid.cols() + 1;
  std::vector<bool> chosen(static_cast<std::size_t>(f.size()), false);
  std::fill_n(chosen.begin(), m, true);
  double widest = 0.0;
  do {
    std::vector<Index> picked;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (chosen[i]) picked.push_back(static_cast<Index>(i));
    }
    const MatrixXd rows = rigid(picked, Eigen::all);
    const Eigen::JacobiSVD<MatrixXd> svd(rows, Eigen::ComputeFullU);
    const VectorXd null = svd.matrixU().col(m - 1);
    widest = std::max(widest, 2.0 * std::abs(null.dot(f(picked))) / null.cwiseAbs().sum());
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return widest;
}

}  // namespace

int failed_checks() {
  int wrong = 0;
  const auto expect = [&wrong](const std::string& what, double found, double expected,
                               double within) {
    const bool good = std::abs(found - expected) <= within;
    if (!good) ++wrong;
    fmt::print("{} {}: {:.9f}, expected {:.9f} within {:g}\n", good ? "good " : "WRONG", what,
               found, expected, within);
  };
  const auto zone = [&expect](const std::string& what, const MatrixXd& rigid, const VectorXd& f,
                              double expected) {
    const Zone found = minimum_zone(rigid, f);
    expect(what, found.width, expected, 1e-6);
    expect(what + ", gap", found.gap, 0.0, 1e-6);
  };

  // The worked numbers of the specification.
  const Places at(layouts()[0]);
  const MatrixXd rigid = rigid_columns(at, false);
  VectorXd f(28), e(28);
  for (Index i = 0; i < 28; ++i) {
    const double a = at.angle_rad[i];
    const double q = at.q[i];
    f[i] = 1.5 * std::cos(3.0 * a) + 0.8 * q * q + 0.4 * q * std::sin(2.0 * a);
    const double turns = 0.6180339887498949 * static_cast<double>(i + 1);
    e[i] = 0.3 * std::sqrt(12.0) * (turns - std::floor(turns) - 0.5);
  }
  zone("w(f)", rigid, f, 3.335968898);
  zone("w(e)", rigid, e, 0.811193771);
  zone("w(y)", rigid, f + e, 3.653367566);
  expect("squares of y", free_of(rigid, f + e).squaredNorm(), 39.062396234, 1e-8);

  // By force; also with repeated angles, where weights are zero.
  for (const int turn : {0, 1}) {
    for (const Layout& small : {Layout{"circle", 1, 9, 1}, Layout{"3 x 4", 3, 4, 1}}) {
      Places places(small);
      if (turn == 0) {
        for (int i = 0; i < places.q.size(); ++i) {
          places.angle_rad[i] = 2.0 * std::numbers::pi * (i % small.per_layer) / small.per_layer;
        }
      }
      const MatrixXd columns = rigid_columns(places, small.circle());
      Random random("force", turn);
      for (int k = 0; k < 5; ++k) {
        VectorXd y(places.q.size());
        for (double& value : y) value = random.normal();
        zone(fmt::format("{} by force", small.name), columns, y, zone_by_force(columns, y));
      }
    }
  }
  const Layout circle{"circle", 1, 360, 1};
  const Places round(circle);
  zone("three lobes", rigid_columns(round, true), 1.5 * (3.0 * round.angle_rad.array()).cos(), 3.0);

  // The zone of noise alone, from the specification's table: 300 simulations, 4 of their standard
  // deviations on top of what that table leaves open.
  const std::map<std::string, std::pair<double, double>> of_noise = {
      {"28", {3.14, 0.53}}, {"112", {4.45, 0.48}}, {"480", {5.50, 0.42}}, {"1440", {6.21, 0.38}}};
  const Noise unit{"1", 1.0, Noise::Kind::kNormal};
  for (const Layout& layout : layouts()) {
    const auto known = of_noise.find(layout.name);
    if (known == of_noise.end()) continue;
    const MatrixXd columns = rigid_columns(Places(layout), false);
    double mean = 0.0;
    for (int k = 0; k < 300; ++k) {
      Random random("noise alone", k);
      mean += minimum_zone(columns, errors(layout, unit, random)).width / 300.0;
    }
    expect("zone of noise, " + layout.name, mean, known->second.first,
           0.02 + 4.0 * known->second.second / std::sqrt(300.0));
  }

  // Noise and surfaces are what they are called.
  for (const Noise& noise : noises()) {
    double squares = 0.0, neighbours = 0.0, most = 0.0;
    const Layout scan{"scan", 1, 5000, 1};
    for (int k = 0; k < 40; ++k) {
      Random random(noise.name, k);
      const VectorXd drawn = errors(scan, noise, random) / noise.sigma_um;
      squares += drawn.squaredNorm();
      neighbours += drawn.head(4999).dot(drawn.tail(4999));
      most = std::max(most, drawn.cwiseAbs().maxCoeff());
    }
    expect("rms of " + noise.name, std::sqrt(squares / 200000.0), 1.0,
           noise.kind == Noise::Kind::kStudent ? 0.1 : 0.02);
    expect("neighbours of " + noise.name, neighbours / squares,
           noise.kind == Noise::Kind::kCorrelated ? 0.9 : 0.0, 0.05);
    if (noise.kind == Noise::Kind::kStudent) {
      expect("tail of " + noise.name, std::min(most, 15.0), 15.0, 0.0);
    }
  }
  for (const Layout& layout : layouts()) {
    const Places places(layout);
    for (const std::string& surface : surfaces()) {
      Random random(surface, 1);
      const VectorXd made = ground(layout, places, surface, random);
      expect(layout.name + " " + surface, made.maxCoeff() - made.minCoeff(), kForm_um, 1e-9);
    }
  }
  return wrong;
}

}  // namespace rondure::coverage
