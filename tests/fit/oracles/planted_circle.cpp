#include <algorithm>
#include <array>
#include <cmath>

#include "core/noise.h"
#include "core/units.h"
#include "planted.h"
#include "planted_fill.h"
#include "witness.h"

namespace rondure::test {
namespace {

struct CircleContacts {
  std::vector<double> angle_rad;  ///< The outer ones first.
  Eigen::Index outer = 0;
  double growth = 0.0;
};

CircleContacts draw_contacts(Reference reference, core::KeyedNoise& noise) {
  const std::size_t contacts = reference == Reference::kMinZone ? 4 : 3;
  const Eigen::Index outer = reference == Reference::kMinZone         ? 2
                             : reference == Reference::kCircumscribed ? 3
                                                                      : 0;
  while (true) {
    CircleContacts out;
    out.outer = outer;
    Eigen::MatrixXd gradients(2, static_cast<Eigen::Index>(contacts));
    for (std::size_t i = 0; i < contacts; ++i) {
      out.angle_rad.push_back(core::kTwoPi * noise.uniform());
      gradients.col(static_cast<Eigen::Index>(i)) << -std::cos(out.angle_rad[i]),
          -std::sin(out.angle_rad[i]);
    }
    const auto witness = weigh(gradients, outer);
    if (!witness || witness->growth < 0.05) continue;
    out.growth = witness->growth;
    return out;
  }
}

}  // namespace

PlantedCircle plant_circle(const Plot& plot, std::uint64_t seed) {
  core::KeyedNoise noise(seed, {81, static_cast<std::uint64_t>(plot.reference)});
  const CircleContacts contacts = draw_contacts(plot.reference, noise);
  const Band band = draw_band(plot, contacts.growth * plot.radius_mm / 20.0, noise);
  PlantedCircle out;
  out.optimum = band.optimum(plot.reference);
  out.optimum.growth = contacts.growth;
  for (std::size_t i = 0; i < contacts.angle_rad.size(); ++i) {
    const double r = static_cast<Eigen::Index>(i) < contacts.outer ? band.high_mm : band.low_mm;
    out.points.emplace_back(r * std::cos(contacts.angle_rad[i]),
                            r * std::sin(contacts.angle_rad[i]));
  }
  const double start = core::kTwoPi * noise.uniform();
  for (int k = 0; k < plot.fill; ++k) {
    const double angle = start + core::kTwoPi * (k + 0.6 * noise.uniform()) / plot.fill;
    const double r = band.inside(noise.uniform());
    out.points.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  const double away = core::kTwoPi * noise.uniform();
  out.center_mm = plot.offset_mm * Eigen::Vector2d(std::cos(away), std::sin(away));
  for (auto& p : out.points) p += out.center_mm;
  out.optimum.contacts = shuffle(out.points, contacts.angle_rad.size(), noise);
  return out;
}

}  // namespace rondure::test
