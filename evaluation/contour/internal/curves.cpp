#include "evaluation/contour/internal/curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/statistics.h"
#include "core/watch.h"
#include "evaluation/uncertainty/curve_trials.h"
#include "evaluation/uncertainty/internal/chains.h"
#include "fit/profiles/profile_filter.h"

namespace rondure::evaluation::contour_trials {
namespace {

constexpr double kLeastTransmission = 0.01;
/// Points on which a peak to valley is read, where the contour has more.
constexpr std::size_t kMostPoints = 2880;

}  // namespace

Basis::Basis(const fit::ContourStudyOptions& options) {
  const auto most = static_cast<int>((options.samples - 1) / 2);
  for (int k = 2; k <= std::min(most, kHighestOrder); ++k) {
    const double left = options.error.filter.filter == fit::ProfileFilter::kNone
                            ? 1.0
                            : std::abs(fit::transmission(options.error.filter, k, options.samples));
    if (left < kLeastTransmission) break;
    highest = k;
    transmission.insert(transmission.end(), 2, left);
  }
  points = options.samples;
  if (points <= kMostPoints) return;
  points = 1;
  while (points < 8 * static_cast<std::size_t>(highest)) points *= 2;
}

double rms_of(std::span<const double> curve) {
  double sum = 0.0;
  for (const double c : curve) sum += c * c;
  return std::sqrt(0.5 * sum);
}

Spread spread_of(const Curves& curves) {
  Spread out;
  out.parts = static_cast<double>(curves.size());
  for (std::size_t j = 0; j < curves.front().size(); ++j) {
    double mean = 0.0;
    for (const auto& curve : curves) mean += curve[j] / out.parts;
    out.mean2 += 0.5 * mean * mean;
    for (const auto& curve : curves) {
      out.spread2 += 0.5 * std::pow(curve[j] - mean, 2) / (out.parts - 1.0);
    }
  }
  return out;
}

std::vector<double> mean_curve(const Curves& curves) {
  std::vector<double> out(curves.front().size(), 0.0);
  for (const auto& curve : curves) {
    for (std::size_t j = 0; j < out.size(); ++j) {
      out[j] += curve[j] / static_cast<double>(curves.size());
    }
  }
  return out;
}

double greatest_range(const Basis& basis, const Curves& curves) {
  double out = 0.0;
  for (const auto& curve : curves) out = std::max(out, basis.range(curve));
  return out;
}

namespace {

constexpr int kBudgetDraws = 200;

/// The budget of every number. One draw of an influence serves all of them.
std::vector<std::vector<LinearTerm>> budgets_of(const CurveModel& model,
                                                const std::vector<Asked>& asked) {
  std::vector<std::vector<LinearTerm>> out(asked.size());
  for (const Effect& effect : model.effects) {
    const int draws = effect.at ? 2 : kBudgetDraws;
    std::vector<std::vector<double>> values(asked.size());
    for (int i = 0; i < draws; ++i) {
      Curves curves = model.measured;
      if (effect.at) {
        effect.at(i == 0 ? 1.0 : -1.0, curves);
      } else {
        effect.draw(i, curves);
      }
      for (std::size_t a = 0; a < asked.size(); ++a) {
        if (asked[a].has_budget) values[a].push_back(asked[a].value(curves));
      }
    }
    for (std::size_t a = 0; a < asked.size(); ++a) {
      if (!asked[a].has_budget) continue;
      const double per_u_mm = effect.at
                                  ? per_u([&](double z) { return values[a][z > 0.0 ? 0 : 1]; })
                                  : core::standard_deviation(values[a], core::mean(values[a]));
      out[a].push_back({effect.name, per_u_mm});
    }
  }
  return out;
}

}  // namespace

std::vector<UncertaintyStatus> states(const CurveModel& model, const std::vector<Asked>& asked,
                                      const UncertaintyOptions& options) {
  std::vector<TrialValues> found(asked.size());
  for (std::size_t a = 0; a < asked.size(); ++a) {
    found[a].as_measured_mm = asked[a].as_measured;
    found[a].signed_value = asked[a].is_signed;
    const auto count = static_cast<std::size_t>(options.least_trials);
    found[a].values_mm.resize(count);
    if (!model.core_draw || !asked[a].convex) continue;
    found[a].core_mm.resize(count);
    found[a].core_center_mm = asked[a].value(model.core_center);
  }
  core::watch().expect(static_cast<std::size_t>(options.least_trials));
  const auto run = [&](std::size_t index) {
    core::watch().drawn();
    const auto trial = static_cast<int>(index);
    Curves curves = model.draw(trial);
    Curves core = model.core_draw ? model.core_draw(trial) : Curves();
    for (const Effect& effect : model.effects) {
      if (effect.in_draws) continue;
      effect.draw(trial, curves);
      // What the truth holds and the estimate does not inflates nothing.
      if (!effect.berkson && model.core_draw) effect.draw(trial, core);
    }
    for (std::size_t a = 0; a < asked.size(); ++a) {
      found[a].values_mm[index] = asked[a].value(curves);
      if (!found[a].core_mm.empty()) found[a].core_mm[index] = asked[a].value(core);
    }
  };
  in_parallel(threads_of(options), static_cast<std::size_t>(options.least_trials),
              [&](std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i) run(i);
              });
  auto budgets = budgets_of(model, asked);
  std::vector<UncertaintyStatus> out;
  for (std::size_t a = 0; a < asked.size(); ++a) {
    auto stated = statement_of_trials(std::move(found[a]), std::move(budgets[a]), model.declaration,
                                      options_of_line(options, asked[a].lines));
    if (!stated) {
      out.push_back(UncertaintyStatus::none(stated.error().said()));
      continue;
    }
    stated->notes.insert(stated->notes.end(), model.notes.begin(), model.notes.end());
    out.push_back(UncertaintyStatus::stated(*std::move(stated), options.coverage));
  }
  return out;
}

NoisyCurves::NoisyCurves(const Basis& basis, Curves measured, std::vector<double> u_mm,
                         std::uint64_t seed, const std::string& id)
    : basis_(basis), measured_(std::move(measured)), u_mm_(std::move(u_mm)), seed_(seed), id_(id) {
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    if (u_mm_[i] <= 0.0) {
      draws_.emplace_back();
      continue;
    }
    MeasuredCurve curve;
    for (std::size_t j = 0; j < basis.size(); ++j) {
      curve.found_mm.push_back(measured_[i][j] / basis.transmission[j]);
      curve.u_mm.push_back(u_mm_[i]);
      curve.group.push_back(octave(Basis::order(j)));
      curve.order.push_back(Basis::order(j));
    }
    draws_.emplace_back(std::in_place, std::move(curve), seed, fmt::format("{}.{}", id, i + 1));
  }
}

void NoisyCurves::add_noise(int trial, Curves& curves) const {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    for (std::size_t j = 0; j < basis_.size(); ++j) {
      curves[i][j] +=
          basis_.transmission[j] * u_mm_[i] * normal_draw(seed_, id_, i * basis_.size() + j, trial);
    }
  }
}

CurveModel model_of(Curves measured, std::shared_ptr<const NoisyCurves> noise, std::string name) {
  CurveModel out;
  out.measured = std::move(measured);
  out.draw = [noise](int trial) { return noise->draw(trial); };
  out.core_draw = [noise](int trial) { return noise->core_draw(trial); };
  out.core_center = noise->center();
  out.effects.push_back({std::move(name),
                         [noise](int trial, Curves& curves) { noise->add_noise(trial, curves); },
                         {},
                         false,
                         true});
  return out;
}

}  // namespace rondure::evaluation::contour_trials
