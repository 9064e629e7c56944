#include "evaluation/contour/internal/contour_trials.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "core/units.h"
#include "evaluation/contour/internal/curves.h"
#include "fit/profiles/periodic_spline.h"

namespace rondure::evaluation::contour_trials {

namespace {

using core::kDegree;
using core::kMicrometre;
using core::kMicroradian;

/// The form of a gauge's spindle is spread evenly over these orders.
constexpr int kGaugeFormTo = 5;
/// Errors of the encoders, and of what a main journal leaves, over the orders from 1, or 2, on.
constexpr int kEncoderTo = 10;
constexpr int kMainTo = 10;
constexpr std::size_t kPartsForMains = 4;

/// A curve over alpha from its values at equal steps of a turn.
std::function<double(double)> over_turn(std::vector<double> values) {
  std::vector<double> alpha(values.size());
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    alpha[i] = core::kTwoPi * static_cast<double>(i) / static_cast<double>(alpha.size());
  }
  return [spline = fit::PeriodicSpline(std::move(alpha), std::move(values))](double at) {
    return spline(std::clamp(at - core::kTwoPi * std::floor(at / core::kTwoPi), 0.0, core::kTwoPi));
  };
}

}  // namespace

ContourTrials::ContourTrials(const ContourResult& facts, const UncertaintyOptions& options)
    : facts_(facts), said_(*facts.influences), options_(options), basis_(facts.options) {
  for (const fit::ContourPartResult& part : facts.study.parts) {
    total_.push_back(basis_.of(part.pin.contour.error_mm));
    following_.push_back(basis_.of(part.following.error_mm));
    rest_.push_back(basis_.of(part.direct.rest_mm));
  }
  if (!facts.study.traced()) return;
  if (said_.c_encoder_urad) encoders_.push_back(encoder(false));
  if (said_.x_encoder_um) encoders_.push_back(encoder(true));
  skew_ = skew_effects();
  radius_ = radius_effects();
}

std::optional<core::Phrase> ContourTrials::no_gauge() const {
  if (said_.gauge_um) return std::nullopt;
  return core::phrase("gauge_um is not declared: the noise of the gauge is not known");
}

std::optional<core::Phrase> ContourTrials::no_axes() const {
  if (facts_.wheel_radius && !facts_.wheel_radius->errors) {
    return no_radius_uncertainty(*facts_.wheel_radius);
  }
  if (!facts_.study.traced()) {
    if (said_.main_differs_um) return std::nullopt;
    return core::phrase("no part has traces of the axes, and main_differs_um is not declared");
  }
  if (said_.c_trace_mdeg || said_.x_trace_um || said_.c_encoder_urad || said_.x_encoder_um) {
    return std::nullopt;
  }
  return core::phrase("neither noise of the traces nor errors of the encoders are declared");
}

CurveModel ContourTrials::gauge_model(const Curves& measured, std::string_view what) const {
  std::vector<double> u;
  for (std::size_t i = 0; i < measured.size(); ++i) u.push_back(gauge_u(i, what == "main"));
  auto noise =
      std::make_shared<const NoisyCurves>(basis_, measured, std::move(u), options_.seed, id(what));
  CurveModel out = model_of(measured, std::move(noise), "gauge-noise");
  add_gauge(out);
  say(out, {"gauge_um", "gauge_form_um", "gauge_gain_1"});
  return out;
}

CurveModel ContourTrials::following_model() const {
  std::vector<double> u;
  for (std::size_t i = 0; i < following_.size(); ++i) u.push_back(trace_u(i));
  auto noise = std::make_shared<const NoisyCurves>(basis_, following_, std::move(u), options_.seed,
                                                   id("following"));
  CurveModel out = model_of(following_, std::move(noise), "trace-noise");
  const std::uint64_t seed = options_.seed;
  if (!skew_.empty()) {
    const auto at = [effects = skew_](double z, Curves& curves) {
      for (std::size_t i = 0; i < curves.size(); ++i) {
        for (std::size_t j = 0; j < curves[i].size(); ++j) curves[i][j] -= z * effects[i][j];
      }
    };
    const DrawnInfluence declared{&said_.skew_ms, 1.0, "control.skew"};
    out.effects.push_back({"trace-skew",
                           [at, declared, seed](int trial, Curves& curves) {
                             if (declared.u() == 0.0) return;
                             at(declared.draw(seed, 0, trial) / declared.u(), curves);
                           },
                           at});
  }
  if (!radius_.empty()) {
    const auto moved = [effects = radius_](double mm, Curves& curves) {
      for (std::size_t i = 0; i < curves.size(); ++i) {
        for (std::size_t j = 0; j < curves[i].size(); ++j) curves[i][j] += mm * effects[i][j];
      }
    };
    out.effects.push_back(
        {kWheelRadius,
         [moved, errors = *facts_.wheel_radius->errors, seed](int trial, Curves& curves) {
           moved(drawn_mm(errors, seed, trial), curves);
         },
         [moved, u_mm = facts_.wheel_radius->u_mm()](double z, Curves& curves) {
           moved(z * u_mm, curves);
         }});
  }
  for (const CommonCurves& encoder : encoders_) {
    out.effects.push_back(
        {std::string(encoder.declared.id == kCEncoder ? "c-encoder" : "x-encoder"),
         [encoder, seed](int trial, Curves& curves) { encoder.add(seed, trial, curves); },
         {},
         true});
  }
  out.notes.push_back(
      encoders_.empty()
          ? core::phrase("f as control and encoders show it; their own errors are not declared")
          : core::phrase("f as the axes moved, with the errors of the encoders"));
  say(out, {"c_trace_mdeg", "x_trace_um", "skew_ms", "c_encoder_urad", "x_encoder_um"});
  say_radius(out);
  return out;
}

CurveModel ContourTrials::model_of_f() const {
  return facts_.study.traced() ? following_model() : *indirect_model(following_);
}

CurveModel ContourTrials::rest_model() const {
  const std::size_t parts = rest_.size();
  const std::size_t size = basis_.size();
  const std::vector<double> common2 = common_squares();
  std::vector<double> own2(size, 0.0);
  for (std::size_t i = 0; i < parts; ++i) {
    const double u2 = std::pow(gauge_u(i, false), 2) + std::pow(trace_u(i), 2);
    for (std::size_t j = 0; j < size; ++j) {
      own2[j] += u2 * std::pow(basis_.transmission[j], 2) / static_cast<double>(parts);
    }
  }
  MeasuredCurve curve;
  curve.field = true;
  for (std::size_t r = 0; r < parts; ++r) {
    for (std::size_t j = 0; j < size; ++j) {
      double found = 0.0;
      for (std::size_t i = 0; i < parts; ++i) found += contrast(r, i, parts) * rest_[i][j];
      const double u2 = own2[j] + (r == 0 ? static_cast<double>(parts) * common2[j] : 0.0);
      curve.found_mm.push_back(found / basis_.transmission[j]);
      // An influence known to be zero still needs a number: 1e-6 um.
      curve.u_mm.push_back(std::max(std::sqrt(u2), 1e-9) / basis_.transmission[j]);
      curve.group.push_back(2 * NoisyCurves::octave(Basis::order(j)) + (r == 0 ? 0 : 1));
    }
  }
  const auto draws =
      std::make_shared<const CurveDraws>(std::move(curve), options_.seed, id("rest"));
  CurveModel out;
  out.measured = rest_;
  out.draw = [draws, parts, size, left = basis_.transmission](int trial) {
    const std::vector<double> drawn = draws->draw(trial);
    Curves curves(parts, std::vector<double>(size, 0.0));
    for (std::size_t r = 0; r < parts; ++r) {
      for (std::size_t i = 0; i < parts; ++i) {
        const double share = contrast(r, i, parts);
        for (std::size_t j = 0; j < size; ++j) {
          curves[i][j] += share * left[j] * drawn[r * size + j];
        }
      }
    }
    return curves;
  };
  add_rest_budget(out);
  out.notes.push_back(core::phrase(
      "n is taken for a random curve: in simulations its interval held the truth of four curves in "
      "86 to 99 %, of all together in 96 %"));
  say(out, {"gauge_um", "gauge_form_um", "gauge_gain_1", "gauge_phase_deg", "c_trace_mdeg",
            "x_trace_um", "skew_ms", "c_encoder_urad", "x_encoder_um"});
  say_radius(out);
  return out;
}

std::optional<CurveModel> ContourTrials::indirect_model(const Curves& indirect) const {
  const auto differs = main_differs_mm();
  if (!differs) return std::nullopt;
  std::vector<double> u;
  for (std::size_t i = 0; i < indirect.size(); ++i) {
    u.push_back(std::hypot(gauge_u(i, false), gauge_u(i, true)));
  }
  auto noise = std::make_shared<const NoisyCurves>(basis_, indirect, std::move(u), options_.seed,
                                                   id("indirect"));
  CurveModel out = model_of(indirect, std::move(noise), "gauge-noise");
  add_gauge(out);
  add_difference(*differs, out);
  say(out, {"gauge_um", "gauge_form_um", "gauge_gain_1", "main_differs_um"});
  return out;
}

std::optional<CurveModel> ContourTrials::main_model(const Curves& mains) const {
  const auto differs = main_differs_mm();
  if (!differs) return std::nullopt;
  CurveModel out = gauge_model(mains, "main");
  add_difference(*differs, out);
  say(out, {"main_differs_um"});
  return out;
}

void ContourTrials::add_difference(double differs_mm, CurveModel& out) const {
  const double each = differs_mm / std::sqrt(static_cast<double>(kMainTo - 1));
  const auto columns = static_cast<std::size_t>(2 * (std::min(kMainTo, basis_.highest) - 1));
  out.effects.push_back({"main-differs", [each, columns, name = id("main-differs"),
                                          seed = options_.seed](int trial, Curves& curves) {
                           for (std::size_t i = 0; i < curves.size(); ++i) {
                             for (std::size_t j = 0; j < columns; ++j) {
                               curves[i][j] +=
                                   each * normal_draw(seed, name, i * columns + j, trial);
                             }
                           }
                         }});
}

CurveModel ContourTrials::gain_model() const {
  CurveModel out = gauge_model(total_, "total");
  if (!said_.gauge_phase_deg) return out;
  const DrawnInfluence zero{&said_.gauge_phase_deg, kDegree, "gauge.phase"};
  out.effects.push_back({"gauge-phase", [zero, seed = options_.seed](int trial, Curves& curves) {
                           turn(zero.draw(seed, 0, trial), curves);
                         }});
  return out;
}

std::vector<double> ContourTrials::mean_following_u() const {
  const auto parts = static_cast<double>(following_.size());
  if (!facts_.study.traced()) {
    double u2 = std::pow(main_differs_mm().value_or(0.0), 2);  // all parts may share it
    for (std::size_t i = 0; i < following_.size(); ++i) {
      const double noise = std::hypot(gauge_u(i, false), gauge_u(i, true));
      for (const double left : basis_.transmission) u2 += 0.5 * std::pow(left * noise / parts, 2);
    }
    return std::vector<double>(facts_.options.samples, std::sqrt(u2));
  }
  double trace2 = 0.0;
  for (std::size_t i = 0; i < following_.size(); ++i) {
    for (const double left : basis_.transmission) {
      trace2 += 0.5 * std::pow(left * trace_u(i) / parts, 2);
    }
  }
  const fit::CrankGeometry& crank = facts_.options.geometry;
  const double x = kMicrometre * record::u_of(said_.x_encoder_um);
  const double c = kMicroradian * record::u_of(said_.c_encoder_urad);
  std::vector<double> out(facts_.options.samples, 0.0);
  if (!skew_.empty()) out = fit::contour_of(mean_curve(skew_), out.size());
  std::vector<double> radius(out.size(), 0.0);
  if (!radius_.empty()) radius = fit::contour_of(radius_in_rest(), facts_.options.samples);
  for (std::size_t m = 0; m < out.size(); ++m) {
    const double beta = core::kTwoPi * static_cast<double>(m) / static_cast<double>(out.size());
    const auto [per_x, per_c] = fit::contour_sensitivity(crank, beta);
    out[m] = std::sqrt(out[m] * out[m] + radius[m] * radius[m] + trace2 + std::pow(per_x * x, 2) +
                       std::pow(per_c * c, 2));
  }
  return out;
}

std::string ContourTrials::id(std::string_view what) const {
  return fmt::format("{}.{}", facts_.feature_id, what);
}

void ContourTrials::turn(double angle, Curves& curves) {
  for (auto& curve : curves) {
    for (std::size_t j = 0; j + 1 < curve.size(); j += 2) {
      const double by = Basis::order(j) * angle;
      const double a = curve[j];
      const double b = curve[j + 1];
      curve[j] = a * std::cos(by) - b * std::sin(by);
      curve[j + 1] = a * std::sin(by) + b * std::cos(by);
    }
  }
}

double ContourTrials::contrast(std::size_t row, std::size_t part, std::size_t parts) {
  if (row == 0) return 1.0 / std::sqrt(static_cast<double>(parts));
  if (part > row) return 0.0;
  const auto r = static_cast<double>(row);
  return (part < row ? 1.0 : -r) / std::sqrt(r * (r + 1.0));
}

double ContourTrials::gauge_u(std::size_t part, bool of_main) const {
  const fit::ContourPartResult& one = facts_.study.parts[part];
  const std::size_t rows = of_main ? (one.main ? one.main->rows : 0) : one.pin.rows;
  if (rows == 0) return 0.0;
  return kMicrometre * record::u_of(said_.gauge_um) * std::sqrt(2.0 / static_cast<double>(rows));
}

double ContourTrials::trace_u(std::size_t part) const {
  const fit::CrankGeometry& crank = facts_.options.geometry;
  const double x = kMicrometre * record::u_of(said_.x_trace_um);
  const double c = 1e-3 * kDegree * record::u_of(said_.c_trace_mdeg);
  constexpr int kPlaces = 360;
  double sum = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double alpha = core::kTwoPi * i / kPlaces;
    const double beta = fit::contact_angle_rad(crank, alpha);
    const auto [per_x, per_c] = fit::contour_sensitivity(crank, beta);
    const double density = 1.0 + crank.crank_radius_mm * std::cos(alpha) /
                                     (crank.center_distance_mm() * std::cos(beta - alpha));
    sum += density * density * (per_x * per_x * x * x + per_c * per_c * c * c) / kPlaces;
  }
  return std::sqrt(2.0 / facts_.study.parts[part].axes.samples_per_turn * sum);
}

std::vector<double> ContourTrials::effect(const std::function<double(double)>& x_mm,
                                          const std::function<double(double)>& c_rad) const {
  return effect(x_mm, c_rad, facts_.options.geometry);
}

std::vector<double> ContourTrials::effect(const std::function<double(double)>& x_mm,
                                          const std::function<double(double)>& c_rad,
                                          const fit::CrankGeometry& crank) const {
  std::vector<double> curve(facts_.options.samples);
  for (std::size_t m = 0; m < curve.size(); ++m) {
    const double beta = core::kTwoPi * static_cast<double>(m) / static_cast<double>(curve.size());
    const double alpha = fit::command_angle_rad(crank, beta);
    const auto [per_x, per_c] = fit::contour_sensitivity(crank, beta);
    curve[m] = per_x * x_mm(alpha) + per_c * c_rad(alpha);
  }
  std::vector<double> out = basis_.of(curve);
  for (std::size_t j = 0; j < out.size(); ++j) out[j] *= basis_.transmission[j];
  return out;
}

CommonCurves ContourTrials::encoder(bool of_x) const {
  CommonCurves out;
  out.declared = of_x ? DrawnInfluence{&said_.x_encoder_um, kMicrometre, kXEncoder}
                      : DrawnInfluence{&said_.c_encoder_urad, kMicroradian, kCEncoder};
  const double each = out.declared.u() / std::sqrt(static_cast<double>(kEncoderTo));
  const auto none = [](double) { return 0.0; };
  for (int k = 1; k <= kEncoderTo; ++k) {
    for (const double phase : {0.0, 0.25 * core::kTwoPi}) {
      const auto wave = [&](double alpha) { return each * std::cos(k * alpha - phase); };
      out.columns.push_back(of_x ? effect(wave, none) : effect(none, wave));
    }
  }
  return out;
}

Curves ContourTrials::skew_effects() const {
  if (!said_.skew_ms || facts_.sampling_ms <= 0.0) return {};
  Curves out;
  for (const fit::ContourPartResult& part : facts_.study.parts) {
    const double late = record::u_of(said_.skew_ms) / facts_.sampling_ms * core::kTwoPi /
                        part.axes.samples_per_turn;
    const auto after = fit::turned_curve(part.axes.errors.x_mm, late);
    const auto before = fit::turned_curve(part.axes.errors.x_mm, -late);
    std::vector<double> change(after.size());
    for (std::size_t i = 0; i < change.size(); ++i) change[i] = 0.5 * (after[i] - before[i]);
    out.push_back(effect(over_turn(std::move(change)), [](double) { return 0.0; }));
  }
  return out;
}

Curves ContourTrials::radius_effects() const {
  if (!facts_.wheel_radius || !facts_.wheel_radius->errors) return {};
  constexpr double kStep_mm = 0.1;  // f is linear in the radius to parts of 1e-3 over it
  fit::CrankGeometry greater = facts_.options.geometry;
  fit::CrankGeometry smaller = greater;
  greater.wheel_radius_mm += kStep_mm;
  smaller.wheel_radius_mm -= kStep_mm;
  Curves out;
  for (const fit::ContourPartResult& part : facts_.study.parts) {
    const auto x_mm = over_turn(part.axes.errors.x_mm);
    const auto c_rad = over_turn(part.axes.errors.c_rad);
    out.push_back(effect(x_mm, c_rad, greater));
    const std::vector<double> less = effect(x_mm, c_rad, smaller);
    for (std::size_t j = 0; j < less.size(); ++j) {
      out.back()[j] = (out.back()[j] - less[j]) / (2.0 * kStep_mm);
    }
  }
  return out;
}

void ContourTrials::say_radius(CurveModel& out) const {
  if (facts_.wheel_radius) out.declaration.push_back(statement_of(*facts_.wheel_radius));
}

std::vector<double> ContourTrials::radius_in_rest() const {
  std::vector<double> out = mean_curve(radius_);
  for (double& c : out) c *= -facts_.wheel_radius->u_mm();
  return out;
}

CommonCurves ContourTrials::gauge_form() const {
  CommonCurves out;
  out.declared = {&said_.gauge_form_um, kMicrometre, "gauge.form"};
  const auto columns = std::min(basis_.size(), static_cast<std::size_t>(2 * (kGaugeFormTo - 1)));
  const double each = out.declared.u() / std::sqrt(static_cast<double>(kGaugeFormTo - 1));
  for (std::size_t c = 0; c < columns; ++c) {
    out.columns.emplace_back(basis_.size(), 0.0);
    out.columns.back()[c] = each * basis_.transmission[c];
  }
  return out;
}

void ContourTrials::add_gauge(CurveModel& out) const {
  const std::uint64_t seed = options_.seed;
  if (said_.gauge_form_um) {
    out.effects.push_back({"gauge-form", [form = gauge_form(), seed](int trial, Curves& curves) {
                             form.add(seed, trial, curves);
                           }});
  }
  if (!said_.gauge_gain_1) return;
  const DrawnInfluence gain{&said_.gauge_gain_1, 1.0, "gauge.gain"};
  const auto taken_out = [](double error, Curves& curves) {
    for (auto& curve : curves) {
      for (double& c : curve) c /= 1.0 + error;
    }
  };
  out.effects.push_back(
      {"gauge-gain",
       [gain, taken_out, seed](int trial, Curves& curves) {
         taken_out(gain.draw(seed, 0, trial), curves);
       },
       [gain, taken_out](double z, Curves& curves) { taken_out(z * gain.u(), curves); }});
}

std::vector<double> ContourTrials::mean_total(bool derivative) const {
  std::vector<double> out(basis_.size(), 0.0);
  for (const auto& curve : total_) {
    for (std::size_t j = 0; j < out.size(); ++j) {
      const double k = Basis::order(j);
      const double part =
          derivative ? (j % 2 == 0 ? k * curve[j + 1] : -k * curve[j - 1]) : curve[j];
      out[j] += part / static_cast<double>(total_.size());
    }
  }
  return out;
}

CommonCurves ContourTrials::scaled(std::vector<double> column, const DrawnInfluence& declared) {
  for (double& c : column) c *= declared.u();
  return {{std::move(column)}, declared};
}

std::vector<std::pair<std::string, CommonCurves>> ContourTrials::common_errors() const {
  std::vector<std::pair<std::string, CommonCurves>> out;
  if (said_.gauge_form_um) out.emplace_back("gauge-form", gauge_form());
  if (said_.gauge_gain_1) {
    out.emplace_back("gauge-gain",
                     scaled(mean_total(false), {&said_.gauge_gain_1, 1.0, "gauge.gain"}));
  }
  if (said_.gauge_phase_deg) {
    out.emplace_back("gauge-phase",
                     scaled(mean_total(true), {&said_.gauge_phase_deg, kDegree, "gauge.phase"}));
  }
  if (!skew_.empty()) {
    out.emplace_back("trace-skew",
                     CommonCurves{{mean_curve(skew_)}, {&said_.skew_ms, 1.0, "control.skew"}});
  }
  for (const CommonCurves& encoder : encoders_) {
    out.emplace_back(encoder.declared.id == kCEncoder ? "c-encoder" : "x-encoder", encoder);
  }
  return out;
}

std::vector<double> ContourTrials::common_squares() const {
  std::vector<double> out(basis_.size(), 0.0);
  for (const auto& [name, error] : common_errors()) error.add_squares(out);
  if (!radius_.empty()) {
    const std::vector<double> radius = radius_in_rest();
    for (std::size_t j = 0; j < out.size(); ++j) out[j] += radius[j] * radius[j];
  }
  return out;
}

void ContourTrials::add_rest_budget(CurveModel& out) const {
  const std::uint64_t seed = options_.seed;
  std::vector<double> gauge;
  std::vector<double> trace;
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    gauge.push_back(gauge_u(i, false));
    trace.push_back(trace_u(i));
  }
  for (auto& [name, u] : {std::pair{std::string("gauge-noise"), gauge},
                          std::pair{std::string("trace-noise"), trace}}) {
    const auto noise =
        std::make_shared<const NoisyCurves>(basis_, rest_, u, seed, id("rest-" + name));
    out.effects.push_back({name,
                           [noise](int trial, Curves& curves) { noise->add_noise(trial, curves); },
                           {},
                           false,
                           true});
  }
  if (!radius_.empty()) {
    out.effects.push_back(
        {kWheelRadius,
         [column = radius_in_rest(), u_mm = facts_.wheel_radius->u_mm(),
          errors = *facts_.wheel_radius->errors, seed](int trial, Curves& curves) {
           if (u_mm == 0.0) return;
           const double z = drawn_mm(errors, seed, trial) / u_mm;
           for (auto& curve : curves) {
             for (std::size_t j = 0; j < curve.size(); ++j) curve[j] += z * column[j];
           }
         },
         {},
         false,
         true});
  }
  for (auto& [name, error] : common_errors()) {
    out.effects.push_back(
        {name,
         [error = error, seed](int trial, Curves& curves) { error.add(seed, trial, curves); },
         {},
         false,
         true});
  }
}

std::optional<double> ContourTrials::main_differs_mm() const {
  if (said_.main_differs_um) return kMicrometre * record::u_of(said_.main_differs_um);
  double sum = 0.0;
  std::size_t parts = 0;
  for (const fit::ContourPartResult& part : facts_.study.parts) {
    if (!part.indirect) continue;
    sum += std::pow(part.indirect->rms_difference_mm, 2);
    ++parts;
  }
  if (parts < kPartsForMains) return std::nullopt;
  return std::sqrt(sum / static_cast<double>(parts));
}

void ContourTrials::say(CurveModel& out, std::initializer_list<std::string_view> keys) const {
  struct Key {
    std::string_view key;
    const record::Influence* said;
    std::string_view unit;
    const char* name;  ///< As in the budget.
  };
  for (const Key& key : {Key{"gauge_um", &said_.gauge_um, "um", "gauge-noise"},
                         Key{"gauge_form_um", &said_.gauge_form_um, "um", "gauge-form"},
                         Key{"gauge_gain_1", &said_.gauge_gain_1, "1", "gauge-gain"},
                         Key{"gauge_phase_deg", &said_.gauge_phase_deg, "deg", "gauge-phase"},
                         Key{"c_trace_mdeg", &said_.c_trace_mdeg, "mdeg", "trace-noise"},
                         Key{"x_trace_um", &said_.x_trace_um, "um", "trace-noise"},
                         Key{"skew_ms", &said_.skew_ms, "ms", "trace-skew"},
                         Key{"c_encoder_urad", &said_.c_encoder_urad, "urad", "c-encoder"},
                         Key{"x_encoder_um", &said_.x_encoder_um, "um", "x-encoder"},
                         Key{"main_differs_um", &said_.main_differs_um, "um", "main-differs"}}) {
    if (std::ranges::find(keys, key.key) == keys.end()) continue;
    InfluenceStatement line{key.name, key.said->has_value(), core::phrase("not declared")};
    if (line.covered) {
      line.text = core::phrase("standard uncertainty {:.4g} {}", record::u_of(*key.said),
                               std::string(key.unit));
    }
    if (key.said == &said_.skew_ms && line.covered && skew_.empty()) {
      line.covered = false;
      line.text =
          core::phrase("declared, but without sampling_ms, which turns a time into an angle");
    }
    out.declaration.push_back(std::move(line));
  }
}

core::Phrase nothing_declared() {
  return core::phrase("the plan declares no influences of this feature: contour/uncertainty");
}

}  // namespace rondure::evaluation::contour_trials
