#include "evaluation/uncertainty/spectrum.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace rondure::evaluation {
namespace {

using core::Code;
using Eigen::Index;

constexpr int kMostUndulations = 200;
constexpr int kMostDegree = 20;
constexpr int kMostCoefficients = 400;  // with the grid below, 32 MB and 1 ms a trial
constexpr std::size_t kMostPlaces = 20'000;

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
    return core::fail_with(Code::kBadOption, "form term of {} undulations, degree {}: {}",
                           term.undulations, term.degree, what);
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
    return core::fail_with(Code::kBadOption, "{} coefficients of the form spectrum; {} at most",
                           coefficients, kMostCoefficients);
  }
  const std::size_t places = grid_places(spectrum, kind);
  if (places > kMostPlaces) {
    return core::fail_with(
        Code::kBadOption,
        "the form spectrum needs a grid of {} places; {} at most: fewer undulations or degrees",
        places, kMostPlaces);
  }
  return {};
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
  if (kind != FormKind::kRoundness && !(spectrum.high_mm > spectrum.low_mm)) {
    return core::fail_with(Code::kBadOption, "the surface ends at {} mm and begins at {} mm",
                           spectrum.high_mm, spectrum.low_mm);
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

std::size_t grid_places(const FormSpectrum& spectrum, FormKind kind) {
  int undulations = 2;
  int degree = 0;
  for (const FormTerm& term : spectrum.terms) {
    if (term.amplitude_mm == 0.0) continue;
    undulations = std::max(undulations, term.undulations);
    degree = std::max(degree, term.degree);
  }
  const int along = kind == FormKind::kRoundness ? 1 : std::max(5, 2 * degree + 1);
  return static_cast<std::size_t>(8 * undulations * along);
}

}  // namespace rondure::evaluation
