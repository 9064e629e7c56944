#include "reports/form_spectrum.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/decompositions.h"
#include "core/units.h"

namespace rondure::reports {
namespace {

using core::Code;
using Eigen::Index;

constexpr int kMostUndulations = 200;
constexpr int kMostDegree = 20;
constexpr int kMostCoefficients = 400;  // with the grid below, 32 MB and 1 ms a trial
constexpr std::size_t kMostPlaces = 10'000;

/// Legendre polynomial, by its recurrence.
double legendre(int degree, double q) {
  double before = 0.0;
  double value = 1.0;
  for (int k = 0; k < degree; ++k) {
    const double next = ((2.0 * k + 1.0) * q * value - k * before) / (k + 1.0);
    before = value;
    value = next;
  }
  return value;
}

double height_1(const FormSpectrum& spectrum, double height_mm) {
  const double length = spectrum.high_mm - spectrum.low_mm;
  if (length <= 0.0) return 0.0;
  return 2.0 * (height_mm - spectrum.low_mm) / length - 1.0;
}

bool moves_part(const FormTerm& term) {
  return term.undulations + term.degree == 0 || (term.undulations == 1 && term.degree <= 1);
}

core::Result<void> check_term(const FormTerm& term, FormKind kind) {
  const auto named = [&](const std::string& what) {
    return core::fail(Code::kBadOption, fmt::format("form term of {} undulations, degree {}: {}",
                                                    term.undulations, term.degree, what));
  };
  if (term.undulations < 0 || term.undulations > kMostUndulations) {
    return named(fmt::format("undulations are outside 0..{}", kMostUndulations));
  }
  if (term.degree < 0 || term.degree > kMostDegree) {
    return named(fmt::format("the degree is outside 0..{}", kMostDegree));
  }
  if (kind == FormKind::kRoundness && term.degree != 0) {
    return named("a section has no degree but 0");
  }
  if (moves_part(term)) return named("this is size, place or tilt, not form");
  if (!(term.amplitude_mm >= 0.0 && std::isfinite(term.amplitude_mm))) {
    return named(fmt::format("amplitude {} mm is not a number >= 0", term.amplitude_mm));
  }
  return {};
}

int coefficients_of(const FormTerm& term) { return term.undulations == 0 ? 1 : 2; }

/// Refuses a spectrum that would take gigabytes.
core::Result<void> check_size(const FormSpectrum& spectrum, FormKind kind) {
  int coefficients = 0;
  for (const FormTerm& term : spectrum.terms) coefficients += coefficients_of(term);
  if (coefficients > kMostCoefficients) {
    return core::fail(Code::kBadOption,
                      fmt::format("{} coefficients of the form spectrum; {} at most", coefficients,
                                  kMostCoefficients));
  }
  const std::size_t places = whole_surface(spectrum, kind).size();
  if (places > kMostPlaces) {
    return core::fail(Code::kBadOption,
                      fmt::format("the form spectrum needs a grid of {} places; {} at most: fewer "
                                  "undulations or degrees",
                                  places, kMostPlaces));
  }
  return {};
}

/// Layers of a cloud: rows by height, those within a thousandth of the length together.
std::vector<std::vector<std::size_t>> layers_of(const FormCloud& cloud) {
  std::vector<std::size_t> order(cloud.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto height = [&](std::size_t i) { return cloud.points[i].height_mm; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return height(a) < height(b); });
  std::vector<std::vector<std::size_t>> layers;
  const double near = order.empty() ? 0.0 : 1e-3 * (height(order.back()) - height(order.front()));
  for (const std::size_t i : order) {
    if (layers.empty() || height(i) - height(layers.back().back()) > near) layers.emplace_back();
    layers.back().push_back(i);
  }
  return layers;
}

/// The highest harmonic that every layer determines well; 0 where one has a wide gap.
int highest_harmonic(const FormCloud& cloud, const std::vector<std::vector<std::size_t>>& layers) {
  int highest = kMostUndulations;
  for (const auto& layer : layers) {
    std::vector<double> angles;
    for (const std::size_t i : layer) angles.push_back(cloud.points[i].angle_rad);
    std::sort(angles.begin(), angles.end());
    double gap = angles.front() + core::kTwoPi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    const int of_gap = static_cast<int>(core::kTwoPi / (2.0 * gap));
    highest = std::min({highest, static_cast<int>(layer.size() / 7), of_gap});
  }
  return highest;
}

/// Every term up to a harmonic and a degree, with amplitude 1.
std::vector<FormTerm> all_terms(int highest, int degrees) {
  std::vector<FormTerm> terms;
  for (int p = 0; p <= highest; ++p) {
    for (int d = 0; d <= degrees; ++d) {
      const FormTerm term{p, d, 1.0};
      if (!moves_part(term)) terms.push_back(term);
    }
  }
  return terms;
}

}  // namespace

core::Result<void> check_spectrum(const FormSpectrum& spectrum, FormKind kind) {
  if (spectrum.terms.empty()) {
    return core::fail(Code::kBadOption, "a form spectrum without terms says nothing");
  }
  double power = 0.0;
  for (const FormTerm& term : spectrum.terms) {
    if (const auto good = check_term(term, kind); !good) return good;
    power += term.amplitude_mm;
  }
  if (!(power > 0.0)) {
    return core::fail(Code::kBadOption, "all amplitudes of the form spectrum are 0 mm");
  }
  if (kind == FormKind::kCylindricity && !(spectrum.high_mm > spectrum.low_mm)) {
    return core::fail(Code::kBadOption, fmt::format("the surface ends at {} mm and begins at {} mm",
                                                    spectrum.high_mm, spectrum.low_mm));
  }
  return check_size(spectrum, kind);
}

Eigen::MatrixXd spectrum_columns(const FormSpectrum& spectrum, std::span<const FormPoint> points) {
  Index width = 0;
  for (const FormTerm& term : spectrum.terms) width += coefficients_of(term);
  Eigen::MatrixXd columns(static_cast<Index>(points.size()), width);
  for (Index i = 0; i < columns.rows(); ++i) {
    const FormPoint& point = points[static_cast<std::size_t>(i)];
    const double q = height_1(spectrum, point.height_mm);
    Index column = 0;
    for (const FormTerm& term : spectrum.terms) {
      const double along = term.amplitude_mm * legendre(term.degree, q);
      const double turned = term.undulations * point.angle_rad;
      columns(i, column++) = along * std::cos(turned);
      if (term.undulations > 0) columns(i, column++) = along * std::sin(turned);
    }
  }
  return columns;
}

std::vector<FormPoint> whole_surface(const FormSpectrum& spectrum, FormKind kind) {
  int undulations = 2;
  int degree = 0;
  for (const FormTerm& term : spectrum.terms) {
    if (term.amplitude_mm == 0.0) continue;
    undulations = std::max(undulations, term.undulations);
    degree = std::max(degree, term.degree);
  }
  const int around = std::max(24, 5 * undulations + 1);
  const int along = kind == FormKind::kRoundness ? 1 : std::max(5, 4 * degree + 1);
  std::vector<FormPoint> grid;
  for (int j = 0; j < along; ++j) {
    const double share = along == 1 ? 0.0 : static_cast<double>(j) / (along - 1);
    for (int i = 0; i < around; ++i) {
      FormPoint point;
      point.angle_rad = core::kTwoPi * i / around;
      point.height_mm = spectrum.low_mm + share * (spectrum.high_mm - spectrum.low_mm);
      grid.push_back(point);
    }
  }
  return grid;
}

core::Result<FormSpectrum> own_spectrum(const FormCloud& cloud, double noise_mm) {
  const auto layers = layers_of(cloud);
  const bool section = cloud.kind == FormKind::kRoundness;
  const int degrees =
      section || layers.empty() ? 0 : static_cast<int>(std::min<std::size_t>(layers.size() - 1, 3));
  const int highest = layers.empty() ? 0
                                     : std::min(highest_harmonic(cloud, layers),
                                                kMostCoefficients / (2 * (degrees + 1)) - 1);
  if (highest < 2 || (!section && layers.size() < 3)) {
    return core::fail(Code::kSampling,
                      fmt::format("{} layers that show {} harmonics do not tell the form between "
                                  "them: 3 layers of 14 points, evenly about, at least",
                                  layers.size(), highest));
  }
  FormSpectrum spectrum;
  spectrum.terms = all_terms(highest, degrees);
  if (!section) {
    spectrum.low_mm = cloud.points[layers.front().front()].height_mm;
    spectrum.high_mm = cloud.points[layers.back().back()].height_mm;
  }
  const Eigen::MatrixXd form = spectrum_columns(spectrum, cloud.points);
  const Eigen::MatrixXd rigid = rigid_basis(cloud);
  Eigen::MatrixXd columns(form.rows(), form.cols() + rigid.cols());
  columns << form, rigid;
  Eigen::VectorXd deviations(form.rows());
  for (Index i = 0; i < form.rows(); ++i) {
    deviations[i] = cloud.points[static_cast<std::size_t>(i)].deviation_mm;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::VectorXd found = qr.solve(deviations);
  Index column = 0;
  for (FormTerm& term : spectrum.terms) {
    const Index width = coefficients_of(term);
    const double noise = noise_mm * noise_mm * static_cast<double>(width) /
                         form.middleCols(column, width).squaredNorm() * static_cast<double>(width);
    const double power = found.segment(column, width).squaredNorm() - noise;
    term.amplitude_mm = std::sqrt(std::max(0.0, power) / static_cast<double>(width));
    column += width;
  }
  spectrum.absolute = true;
  spectrum.source = fmt::format("own harmonics 0..{} of {} layers, {} points", highest,
                                layers.size(), cloud.points.size());
  return spectrum;
}

}  // namespace rondure::reports
