#include "evaluation/contour/internal/trials.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/uncertainty/curve_trials.h"
#include "evaluation/uncertainty/internal/chains.h"
#include "evaluation/uncertainty/internal/statement.h"
#include "fit/profiles/periodic_spline.h"
#include "fit/profiles/profile_filter.h"

namespace rondure::evaluation {
namespace {

using core::kDegree;
using core::kMicrometre;
using core::kMicroradian;
using record::ContourInfluencesTask;
using record::Form;

constexpr double kLeastTransmission = 0.01;
constexpr int kHighestOrder = 720;
/// Points on which a peak to valley is read, where the contour has more.
constexpr std::size_t kMostPoints = 2880;
/// The form of a gauge's spindle is spread evenly over these orders.
constexpr int kGaugeFormTo = 5;
/// Errors of the encoders, and of what a main journal leaves, over the orders from 1, or 2, on.
constexpr int kEncoderTo = 10;
constexpr int kMainTo = 10;
constexpr int kBudgetDraws = 200;
constexpr std::size_t kPartsForMains = 4;

/// Harmonics 2 .. highest of each part: a2, b2, a3, b3, ...
using Curves = std::vector<std::vector<double>>;

/// Where the curves are known: up to which order, and what the filter leaves of each.
struct Basis {
  explicit Basis(const fit::ContourStudyOptions& options) {
    const auto most = static_cast<int>((options.samples - 1) / 2);
    for (int k = 2; k <= std::min(most, kHighestOrder); ++k) {
      const double left =
          options.error.filter.filter == fit::ProfileFilter::kNone
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

  [[nodiscard]] std::vector<double> of(std::span<const double> error_mm) const {
    return fit::contour_coefficients(error_mm, highest);
  }
  [[nodiscard]] double range(const std::vector<double>& curve) const {
    return fit::peak_to_valley(fit::contour_of(curve, points));
  }
  [[nodiscard]] std::size_t size() const { return transmission.size(); }
  [[nodiscard]] static int order(std::size_t j) { return static_cast<int>(j / 2) + 2; }

  int highest = 1;
  std::size_t points = 0;
  std::vector<double> transmission;  ///< Of each coefficient.
};

double rms_of(std::span<const double> curve) {
  double sum = 0.0;
  for (const double c : curve) sum += c * c;
  return std::sqrt(0.5 * sum);
}

/// Mean square of the mean curve, and of the parts about it.
struct Spread {
  double mean2 = 0.0;
  double spread2 = 0.0;
  double parts = 0.0;

  [[nodiscard]] double index() const {
    const double repeating = mean2 - spread2 / parts;
    return repeating + spread2 > 0.0 ? repeating / (repeating + spread2) : 0.0;
  }
};

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

/// A declared influence with its draws.
struct DrawnInfluence {
  const record::Influence* said = nullptr;
  double unit = 1.0;  ///< From the unit of the key to that of the calculation.
  std::string_view id;

  [[nodiscard]] double u() const { return unit * record::u_of(*said); }
  [[nodiscard]] double draw(std::uint64_t seed, std::uint64_t instance, int trial) const {
    if (u() == 0.0) return 0.0;
    const bool flat =
        *said && (*said)->distribution == record::DeclaredInfluence::Distribution::kRectangular;
    return u() * (flat ? uniform_draw(seed, id, instance, trial)
                       : normal_draw(seed, id, instance, trial));
  }
};

/// An influence on the curves of all parts at once.
struct Effect {
  std::string name;
  /// Adds a draw.
  std::function<void(int, Curves&)> draw;
  /// Adds so many standard uncertainties; empty where more than one number is drawn.
  std::function<void(double, Curves&)> at = {};
  bool berkson = false;
  bool in_draws = false;  ///< The draws of the curves hold it: it stands in the budget alone.
};

/// How the curves of all parts are drawn.
struct CurveModel {
  Curves measured;
  std::function<Curves(int)> draw;
  std::function<Curves(int)> core_draw = {};  ///< Empty: a random field, which is not turned.
  Curves core_center = {};
  std::vector<Effect> effects = {};
  std::vector<InfluenceStatement> declaration = {};
  std::vector<core::Phrase> notes = {};
};

/// A number read from the curves.
struct Asked {
  std::function<double(const Curves&)> value;
  double as_measured = 0.0;
  bool convex = true;
  bool is_signed = false;
  bool has_budget = true;  ///< Of an index, which is no length, none is printed.
  std::size_t lines = 1;   ///< Of how many lines of a mask it is one, for its coverage.
};

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

/// All numbers from the same trials.
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
  const auto run = [&](std::size_t index) {
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

/// Draws of curves whose noise is independent from part to part. The noise is known before the
/// filter, where all orders have the same: the filter acts on the draws.
class NoisyCurves {
 public:
  /// @param u_mm  Of a coefficient before the filter, one for each part; 0: known exactly.
  NoisyCurves(const Basis& basis, Curves measured, std::vector<double> u_mm, std::uint64_t seed,
              const std::string& id)
      : basis_(basis),
        measured_(std::move(measured)),
        u_mm_(std::move(u_mm)),
        seed_(seed),
        id_(id) {
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

  /// 2-7, 8-15, 16-31, ...
  static int octave(int order) { return order < 8 ? 0 : std::ilogb(order) - 2; }

  [[nodiscard]] Curves draw(int trial) const {
    return each([&](const CurveDraws& draws) { return draws.draw(trial); });
  }
  [[nodiscard]] Curves core_draw(int trial) const {
    return each([&](const CurveDraws& draws) { return draws.core_draw(trial); });
  }
  [[nodiscard]] Curves center() const {
    return each([](const CurveDraws& draws) { return draws.core_mm(); });
  }
  /// The noise alone, for a budget.
  void add_noise(int trial, Curves& curves) const {
    for (std::size_t i = 0; i < curves.size(); ++i) {
      for (std::size_t j = 0; j < basis_.size(); ++j) {
        curves[i][j] += basis_.transmission[j] * u_mm_[i] *
                        normal_draw(seed_, id_, i * basis_.size() + j, trial);
      }
    }
  }

 private:
  template <class Of>
  [[nodiscard]] Curves each(const Of& of) const {
    Curves out = measured_;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!draws_[i]) continue;
      out[i] = of(*draws_[i]);
      for (std::size_t j = 0; j < basis_.size(); ++j) out[i][j] *= basis_.transmission[j];
    }
    return out;
  }

  Basis basis_;
  Curves measured_;
  std::vector<double> u_mm_;
  std::uint64_t seed_ = 0;
  std::string id_;
  std::vector<std::optional<CurveDraws>> draws_;
};

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

/// Random curves common to all parts: `columns` with one draw each.
struct CommonCurves {
  Curves columns;  ///< Change of a curve for one standard uncertainty, with sign.
  DrawnInfluence declared;

  void add(std::uint64_t seed, int trial, Curves& curves) const {
    const double u = declared.u();
    if (u == 0.0) return;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double z = declared.draw(seed, c, trial) / u;
      for (auto& curve : curves) {
        for (std::size_t j = 0; j < curve.size(); ++j) curve[j] += z * columns[c][j];
      }
    }
  }
  /// Adds the squares of the standard uncertainties of the coefficients.
  void add_squares(std::vector<double>& squares) const {
    for (const auto& column : columns) {
      for (std::size_t j = 0; j < column.size(); ++j) squares[j] += column[j] * column[j];
    }
  }
};

/// All curves of a study and what is declared of them.
class ContourTrials {
 public:
  ContourTrials(const ContourResult& facts, const UncertaintyOptions& options)
      : facts_(facts), said_(*facts.influences), options_(options), basis_(facts.options) {
    for (const fit::ContourPartResult& part : facts.study.parts) {
      total_.push_back(basis_.of(part.pin.contour.error_mm));
      following_.push_back(basis_.of(part.following.error_mm));
      rest_.push_back(basis_.of(part.direct.rest_mm));
    }
    if (said_.c_encoder_urad) encoders_.push_back(encoder(false));
    if (said_.x_encoder_um) encoders_.push_back(encoder(true));
    skew_ = skew_effects();
  }

  [[nodiscard]] const Basis& basis() const { return basis_; }
  [[nodiscard]] const Curves& total() const { return total_; }
  [[nodiscard]] const Curves& following() const { return following_; }
  [[nodiscard]] const Curves& rest() const { return rest_; }
  [[nodiscard]] const UncertaintyOptions& options() const { return options_; }

  [[nodiscard]] std::optional<core::Phrase> no_gauge() const {
    if (said_.gauge_um) return std::nullopt;
    return core::phrase("gauge_um is not declared: the noise of the gauge is not known");
  }
  [[nodiscard]] std::optional<core::Phrase> no_axes() const {
    if (said_.c_trace_mdeg || said_.x_trace_um || said_.c_encoder_urad || said_.x_encoder_um) {
      return std::nullopt;
    }
    return core::phrase("neither noise of the traces nor errors of the encoders are declared");
  }

  /// Of t, or of the main journals.
  [[nodiscard]] CurveModel gauge_model(const Curves& measured, std::string_view what) const {
    std::vector<double> u;
    for (std::size_t i = 0; i < measured.size(); ++i) u.push_back(gauge_u(i, what == "main"));
    auto noise = std::make_shared<const NoisyCurves>(basis_, measured, std::move(u), options_.seed,
                                                     id(what));
    CurveModel out = model_of(measured, std::move(noise), "gauge-noise");
    add_gauge(out);
    say(out, {"gauge_um", "gauge_form_um", "gauge_gain_1"});
    return out;
  }

  [[nodiscard]] CurveModel following_model() const {
    std::vector<double> u;
    for (std::size_t i = 0; i < following_.size(); ++i) u.push_back(trace_u(i));
    auto noise = std::make_shared<const NoisyCurves>(basis_, following_, std::move(u),
                                                     options_.seed, id("following"));
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
    return out;
  }

  /// n: a random field. Its errors are drawn in the mean of the parts, which holds what is common
  /// to them, and in the contrasts between them, which hold what is not.
  [[nodiscard]] CurveModel rest_model() const {
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
        "n is a random curve: simulations found its interval to hold the truth some 5 % less "
        "often than it says"));
    say(out, {"gauge_um", "gauge_form_um", "gauge_gain_1", "gauge_phase_deg", "c_trace_mdeg",
              "x_trace_um", "skew_ms", "c_encoder_urad", "x_encoder_um"});
    return out;
  }

  /// f by the main journal; nothing without a number for how far it differs from n.
  /// @param indirect  t minus the main journals.
  [[nodiscard]] std::optional<CurveModel> indirect_model(const Curves& indirect) const {
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
    // What the two journals do not share is another curve for each part.
    const double each = *differs / std::sqrt(static_cast<double>(kMainTo - 1));
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
    say(out, {"gauge_um", "gauge_form_um", "gauge_gain_1", "main_differs_um"});
    return out;
  }

  /// Of t for the gain of a correction: the zero of the gauge turns t against the axes.
  [[nodiscard]] CurveModel gain_model() const {
    CurveModel out = gauge_model(total_, "total");
    if (!said_.gauge_phase_deg) return out;
    const DrawnInfluence zero{&said_.gauge_phase_deg, kDegree, "gauge.phase"};
    out.effects.push_back({"gauge-phase", [zero, seed = options_.seed](int trial, Curves& curves) {
                             turn(zero.draw(seed, 0, trial), curves);
                           }});
    return out;
  }

  /// Standard uncertainty of the mean f at the angles of the contours.
  [[nodiscard]] std::vector<double> mean_following_u() const {
    const double parts = static_cast<double>(following_.size());
    double trace2 = 0.0;
    for (std::size_t i = 0; i < following_.size(); ++i) {
      for (const double left : basis_.transmission) {
        trace2 += 0.5 * std::pow(left * trace_u(i) / parts, 2);
      }
    }
    const fit::CrankGeometry& crank = facts_.options.geometry;
    const double x = kMicrometre * record::u_of(said_.x_encoder_um);
    const double c = kMicroradian * record::u_of(said_.c_encoder_urad);
    std::vector<double> out = fit::contour_of(mean_skew(), facts_.options.samples);
    for (std::size_t m = 0; m < out.size(); ++m) {
      const double beta = core::kTwoPi * static_cast<double>(m) / static_cast<double>(out.size());
      const auto [per_x, per_c] = fit::contour_sensitivity(crank, beta);
      out[m] =
          std::sqrt(out[m] * out[m] + trace2 + std::pow(per_x * x, 2) + std::pow(per_c * c, 2));
    }
    return out;
  }

 private:
  static constexpr std::string_view kCEncoder = "control.c-encoder";
  static constexpr std::string_view kXEncoder = "control.x-encoder";

  [[nodiscard]] std::string id(std::string_view what) const {
    return fmt::format("{}.{}", facts_.feature_id, what);
  }

  /// Turns curves: out(beta) = curve(beta - angle).
  static void turn(double angle, Curves& curves) {
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

  /// The rows of an orthonormal set: the mean, then each part against those before it.
  static double contrast(std::size_t row, std::size_t part, std::size_t parts) {
    if (row == 0) return 1.0 / std::sqrt(static_cast<double>(parts));
    if (part > row) return 0.0;
    const auto r = static_cast<double>(row);
    return (part < row ? 1.0 : -r) / std::sqrt(r * (r + 1.0));
  }

  /// Noise of the gauge in a coefficient, before the filter.
  [[nodiscard]] double gauge_u(std::size_t part, bool of_main) const {
    const fit::ContourPartResult& one = facts_.study.parts[part];
    const std::size_t rows = of_main ? (one.main ? one.main->rows : 0) : one.pin.rows;
    if (rows == 0) return 0.0;
    return kMicrometre * record::u_of(said_.gauge_um) * std::sqrt(2.0 / static_cast<double>(rows));
  }

  /// Noise of the traces in a coefficient of f, before the filter. White noise e of N samples over
  /// alpha becomes w(beta) e(alpha(beta)) with dbeta = (dbeta/dalpha) dalpha, hence the mean square
  /// of w dbeta/dalpha over alpha.
  [[nodiscard]] double trace_u(std::size_t part) const {
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

  /// Coefficients of f that errors of the axes give, to first order.
  [[nodiscard]] std::vector<double> effect(const std::function<double(double)>& x_mm,
                                           const std::function<double(double)>& c_rad) const {
    const fit::CrankGeometry& crank = facts_.options.geometry;
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

  /// Errors of an encoder repeat from part to part. Their standard uncertainty at each position is
  /// spread evenly over the orders 1 to 10 of alpha.
  [[nodiscard]] CommonCurves encoder(bool of_x) const {
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

  /// Change of f of each part when X is late against C by one standard uncertainty; empty where the
  /// skew is not declared or its unit cannot be converted.
  [[nodiscard]] Curves skew_effects() const {
    if (!said_.skew_ms || facts_.sampling_ms <= 0.0) return {};
    Curves out;
    for (const fit::ContourPartResult& part : facts_.study.parts) {
      const double late = record::u_of(said_.skew_ms) / facts_.sampling_ms * core::kTwoPi /
                          part.axes.samples_per_turn;
      const auto after = fit::turned_curve(part.axes.errors.x_mm, late);
      const auto before = fit::turned_curve(part.axes.errors.x_mm, -late);
      std::vector<double> alpha(after.size());
      std::vector<double> change(after.size());
      for (std::size_t i = 0; i < alpha.size(); ++i) {
        alpha[i] = core::kTwoPi * static_cast<double>(i) / static_cast<double>(alpha.size());
        change[i] = 0.5 * (after[i] - before[i]);
      }
      const fit::PeriodicSpline spline(std::move(alpha), std::move(change));
      out.push_back(effect(
          [&](double at) {
            return spline(
                std::clamp(at - core::kTwoPi * std::floor(at / core::kTwoPi), 0.0, core::kTwoPi));
          },
          [](double) { return 0.0; }));
    }
    return out;
  }

  /// The gauge's spindle over its orders, the same in all parts.
  [[nodiscard]] CommonCurves gauge_form() const {
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

  void add_gauge(CurveModel& out) const {
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

  /// Coefficients of the mean of t, and of its derivative by the angle.
  [[nodiscard]] std::vector<double> mean_total(bool derivative) const {
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

  /// One column times one declared number.
  static CommonCurves scaled(std::vector<double> column, const DrawnInfluence& declared) {
    for (double& c : column) c *= declared.u();
    return {{std::move(column)}, declared};
  }

  /// What all parts share of the errors of n, by influence.
  [[nodiscard]] std::vector<std::pair<std::string, CommonCurves>> common_errors() const {
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
                       CommonCurves{{mean_skew()}, {&said_.skew_ms, 1.0, "control.skew"}});
    }
    for (const CommonCurves& encoder : encoders_) {
      out.emplace_back(encoder.declared.id == kCEncoder ? "c-encoder" : "x-encoder", encoder);
    }
    return out;
  }

  [[nodiscard]] std::vector<double> mean_skew() const {
    std::vector<double> mean(basis_.size(), 0.0);
    for (const auto& curve : skew_) {
      for (std::size_t j = 0; j < mean.size(); ++j) {
        mean[j] += curve[j] / static_cast<double>(skew_.size());
      }
    }
    return mean;
  }

  [[nodiscard]] std::vector<double> common_squares() const {
    std::vector<double> out(basis_.size(), 0.0);
    for (const auto& [name, error] : common_errors()) error.add_squares(out);
    return out;
  }

  void add_rest_budget(CurveModel& out) const {
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
      out.effects.push_back(
          {name,
           [noise](int trial, Curves& curves) { noise->add_noise(trial, curves); },
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

  /// How far n and the main journal differ: as declared, or from the parts that have both.
  [[nodiscard]] std::optional<double> main_differs_mm() const {
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

  void say(CurveModel& out, std::initializer_list<std::string_view> keys) const {
    struct Key {
      std::string_view name;
      const record::Influence* said;
      std::string_view unit;
    };
    for (const Key& key :
         {Key{"gauge_um", &said_.gauge_um, "um"}, Key{"gauge_form_um", &said_.gauge_form_um, "um"},
          Key{"gauge_gain_1", &said_.gauge_gain_1, "1"},
          Key{"gauge_phase_deg", &said_.gauge_phase_deg, "deg"},
          Key{"c_trace_mdeg", &said_.c_trace_mdeg, "mdeg"},
          Key{"x_trace_um", &said_.x_trace_um, "um"}, Key{"skew_ms", &said_.skew_ms, "ms"},
          Key{"c_encoder_urad", &said_.c_encoder_urad, "urad"},
          Key{"x_encoder_um", &said_.x_encoder_um, "um"},
          Key{"main_differs_um", &said_.main_differs_um, "um"}}) {
      if (std::ranges::find(keys, key.name) == keys.end()) continue;
      InfluenceStatement line{std::string(key.name), key.said->has_value(),
                              core::phrase("not declared")};
      std::ranges::replace(line.name, '_', '-');
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

  const ContourResult& facts_;
  const ContourInfluencesTask& said_;
  UncertaintyOptions options_;
  Basis basis_;
  Curves total_;
  Curves following_;
  Curves rest_;
  std::vector<CommonCurves> encoders_;
  Curves skew_;
};

core::Phrase nothing_declared() {
  return core::phrase("the plan declares no influences of this feature: contour/uncertainty");
}

double greatest_range(const Basis& basis, const Curves& curves) {
  double out = 0.0;
  for (const auto& curve : curves) out = std::max(out, basis.range(curve));
  return out;
}

/// The greatest share of a limit that any harmonic of any part takes, and that limit.
struct MaskShare {
  double share = 0.0;
  double limit_mm = 0.0;
};

MaskShare worst_share(const Curves& curves, const std::vector<record::HarmonicLimit>& mask) {
  MaskShare out;
  for (const auto& curve : curves) {
    for (const record::HarmonicLimit& line : mask) {
      for (std::size_t j = 0; j + 1 < curve.size(); j += 2) {
        const int k = Basis::order(j);
        if (k < line.first || k > line.last) continue;
        const double share = std::hypot(curve[j], curve[j + 1]) / line.amplitude_mm;
        if (share > out.share) out = {share, line.amplitude_mm};
      }
    }
  }
  return out;
}

/// The greatest share of its limit that one harmonic takes in any part; 0 outside the mask.
double harmonic_share(const Curves& curves, const std::vector<record::HarmonicLimit>& mask,
                      int order) {
  std::vector<record::HarmonicLimit> own;
  for (const record::HarmonicLimit& line : mask) {
    if (order >= line.first && order <= line.last) own.push_back({order, order, line.amplitude_mm});
  }
  return worst_share(curves, own).share;
}

/// The amplitudes of a mask that bind, each brought to the limit of the worst.
std::vector<Asked> mask_lines(const record::Characteristic& asked, const ContourTrials& trials) {
  const double limit_mm = worst_share(trials.total(), asked.harmonic_limits).limit_mm;
  std::vector<Asked> out;
  for (int k = 2; k <= trials.basis().highest; ++k) {
    const double share = harmonic_share(trials.total(), asked.harmonic_limits, k);
    if (share <= kBindingShare) continue;
    Asked line;
    line.value = [&mask = asked.harmonic_limits, limit_mm, k](const Curves& curves) {
      return harmonic_share(curves, mask, k) * limit_mm;
    };
    line.as_measured = share * limit_mm;
    line.has_budget = false;
    out.push_back(std::move(line));
  }
  for (Asked& line : out) line.lines = out.size();
  return out;
}

/// The interval of a mask from those of its lines.
UncertaintyStatus of_mask_lines(const UncertaintyStatus& greatest,
                                std::span<const UncertaintyStatus> lines) {
  if (!greatest.result()) return greatest;
  std::vector<UncertaintyStatement> said;
  for (const UncertaintyStatus& line : lines) {
    if (!line.result()) return line;
    said.push_back(line.result()->sampled);
  }
  UncertaintyResult result = *greatest.result();
  hold_lines_together(said, result);
  return UncertaintyStatus::stated(std::move(result), greatest.coverage_1());
}

/// Whether the harmonic that decides is among those of the trials: the value is that of all
/// harmonics of the mask.
bool is_nearest(const MaskShare& worst, const core::Result<AnalysisValue>& measured) {
  constexpr double kRoundOff = 1e-6;
  return !measured || !measured->limit_mm ||
         measured->value_mm / *measured->limit_mm <= worst.share * (1.0 + kRoundOff);
}

/// The number that a characteristic reads from t.
Asked asked_of(const record::Characteristic& asked, const ContourResult& facts,
               const ContourTrials& trials) {
  Asked out;
  if (asked.form == Form::kContourSpread) {
    out.value = [](const Curves& curves) { return std::sqrt(spread_of(curves).spread2); };
  } else if (asked.form == Form::kHarmonicLimits) {
    // In units of the line that binds, so that a trial below it has every amplitude below its own.
    const double limit_mm = worst_share(trials.total(), asked.harmonic_limits).limit_mm;
    out.value = [&mask = asked.harmonic_limits, limit_mm](const Curves& curves) {
      return worst_share(curves, mask).share * limit_mm;
    };
  } else {
    out.value = [&basis = trials.basis()](const Curves& curves) {
      return greatest_range(basis, curves);
    };
  }
  const auto measured = value_of(facts, asked);
  out.as_measured = measured ? measured->value_mm : out.value(trials.total());
  return out;
}

/// s is the standard deviation of these parts; of the process behind them it says less.
core::Phrase process_note(double spread_mm, std::size_t parts) {
  const auto freedom = static_cast<double>(parts - 1);
  const auto bound = [&](double p) {
    return spread_mm / kMicrometre * std::sqrt(freedom / core::chi_square_quantile(p, freedom));
  };
  return core::phrase(
      "s is that of these {} parts; if one shape dominates, s of the process lies between {:.3g} "
      "and "
      "{:.3g} um (95 %)",
      parts, bound(0.975), bound(0.025));
}

UncertaintyStatus with_note(const UncertaintyStatus& status, core::Phrase note) {
  if (!status.result()) return status;
  UncertaintyResult result = *status.result();
  result.notes.push_back(std::move(note));
  return UncertaintyStatus::stated(std::move(result), status.coverage_1());
}

/// Peak to valley and rms of every part, and the index; of the mains the index alone.
void add_numbers(ContourNumber::Curve curve, const Curves& measured,
                 const std::optional<CurveModel>& model, const core::Phrase& why,
                 const Basis* basis, const UncertaintyOptions& options,
                 std::vector<ContourNumber>& out) {
  std::vector<ContourNumber> numbers;
  std::vector<Asked> asked;
  const bool each_part = curve != ContourNumber::Curve::kMain;
  for (std::size_t i = 0; each_part && i < measured.size(); ++i) {
    for (const auto kind : {ContourNumber::Kind::kPeakToValley, ContourNumber::Kind::kRms}) {
      const bool range = kind == ContourNumber::Kind::kPeakToValley;
      Asked one;
      one.value = [basis, i, range](const Curves& c) {
        return range ? basis->range(c[i]) : rms_of(c[i]);
      };
      one.as_measured = one.value(measured);
      numbers.push_back({curve, kind, i, one.as_measured});
      asked.push_back(std::move(one));
    }
  }
  if (measured.size() >= 2) {
    Asked one;
    one.value = [](const Curves& c) { return spread_of(c).index(); };
    one.as_measured = one.value(measured);
    one.convex = false;
    one.is_signed = true;
    one.has_budget = false;
    numbers.push_back({curve, ContourNumber::Kind::kIndex, std::nullopt, one.as_measured});
    asked.push_back(std::move(one));
  }
  std::vector<UncertaintyStatus> found(numbers.size(), UncertaintyStatus::none(why));
  if (model) found = states(*model, asked, options);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i].uncertainty = found[i];
    out.push_back(std::move(numbers[i]));
  }
}

}  // namespace

double gauge_noise_factor(const fit::FilterOptions& filter, std::size_t points) {
  double sum = 0.0;
  for (std::size_t k = 2; k < (points + 1) / 2; ++k) {
    sum += std::norm(fit::transmission(filter, static_cast<double>(k), points));
  }
  return std::sqrt(2.0 / static_cast<double>(points) * sum);
}

std::vector<UncertaintyStatus> total_intervals(const ContourResult& facts,
                                               std::span<const record::Characteristic> asked,
                                               const UncertaintyOptions& options) {
  const auto none = [&](const core::Phrase& why) {
    return std::vector<UncertaintyStatus>(asked.size(), UncertaintyStatus::none(why));
  };
  if (!facts.influences) return none(nothing_declared());
  if (facts.total_void) return none(*facts.total_void);
  const ContourTrials trials(facts, options);
  if (const auto missing = trials.no_gauge()) return none(*missing);
  std::vector<Asked> numbers;
  std::vector<std::size_t> rows;
  std::vector<UncertaintyStatus> out = none({});
  for (std::size_t a = 0; a < asked.size(); ++a) {
    if (asked[a].form == Form::kContourSpread && !facts.study.total) {
      out[a] = UncertaintyStatus::none(core::phrase("one part shows no spread"));
      continue;
    }
    if (asked[a].form == Form::kHarmonicLimits) {
      const MaskShare worst = worst_share(trials.total(), asked[a].harmonic_limits);
      if (worst.limit_mm == 0.0 || !is_nearest(worst, value_of(facts, asked[a]))) {
        out[a] = UncertaintyStatus::none(
            worst.limit_mm == 0.0
                ? core::phrase("the mask names no harmonic that the filter passes")
                : core::phrase("the harmonic nearest to its limit is one that the filter does not "
                               "pass, or above order {}: the trials do not hold it",
                               kHighestOrder));
        continue;
      }
    }
    numbers.push_back(asked_of(asked[a], facts, trials));
    rows.push_back(a);
  }
  // After the numbers, the lines of their masks.
  std::vector<std::pair<std::size_t, std::size_t>> of_mask;  // first and count
  for (const std::size_t row : rows) {
    std::vector<Asked> lines;
    if (asked[row].form == Form::kHarmonicLimits) lines = mask_lines(asked[row], trials);
    of_mask.emplace_back(numbers.size(), lines.size());
    std::ranges::move(lines, std::back_inserter(numbers));
  }
  if (numbers.empty()) return out;
  const auto found = states(trials.gauge_model(trials.total(), "total"), numbers, options);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out[rows[i]] =
        asked[rows[i]].form == Form::kContourSpread
            ? with_note(found[i], process_note(facts.study.total->spread, facts.names.size()))
            : of_mask_lines(found[i],
                            std::span(found).subspan(of_mask[i].first, of_mask[i].second));
  }
  return out;
}

UncertaintyStatus gain_interval(const ContourResult& facts,
                                std::span<const std::vector<double>> change_mm,
                                const UncertaintyOptions& options) {
  if (!facts.influences) return UncertaintyStatus::none(nothing_declared());
  if (facts.total_void) return UncertaintyStatus::none(*facts.total_void);
  const ContourTrials trials(facts, options);
  if (const auto missing = trials.no_gauge()) return UncertaintyStatus::none(*missing);
  Curves change;
  for (const auto& curve : change_mm) change.push_back(trials.basis().of(curve));
  Asked gain;
  gain.value = [&basis = trials.basis(), &change](const Curves& curves) {
    Curves after = curves;
    for (std::size_t i = 0; i < after.size(); ++i) {
      for (std::size_t j = 0; j < after[i].size(); ++j) after[i][j] += change[i][j];
    }
    return greatest_range(basis, curves) - greatest_range(basis, after);
  };
  gain.as_measured = gain.value(trials.total());
  gain.convex = false;
  gain.is_signed = true;
  gain.has_budget = false;
  return states(trials.gain_model(), {gain}, options).front();
}

core::Result<std::vector<double>> mean_following_u(const ContourResult& facts,
                                                   const UncertaintyOptions& options) {
  if (!facts.influences) return core::fail(core::Code::kMissingKey, nothing_declared());
  const ContourTrials trials(facts, options);
  if (const auto missing = trials.no_axes()) return core::fail(core::Code::kMissingKey, *missing);
  return trials.mean_following_u();
}

std::vector<ContourNumber> contour_numbers(const ContourResult& facts,
                                           const UncertaintyOptions& options) {
  using Curve = ContourNumber::Curve;
  std::vector<ContourNumber> out;
  // Without a declaration the numbers stand with the reason why they have no interval.
  static const ContourInfluencesTask kNothing;
  ContourResult complete = facts;
  if (!facts.influences) complete.influences = kNothing;
  const ContourTrials trials(complete, options);
  const auto reason = [&](const std::optional<core::Phrase>& voided,
                          std::optional<core::Phrase> missing) {
    if (voided) return voided;
    if (!facts.influences) return std::optional(nothing_declared());
    return missing;
  };
  const auto add = [&](Curve curve, const Curves& measured, const std::optional<core::Phrase>& why,
                       const auto& model) {
    const std::optional<CurveModel> made = why ? std::nullopt : std::optional<CurveModel>(model());
    add_numbers(curve, measured, made, why.value_or(core::Phrase()), &trials.basis(), options, out);
  };
  add(Curve::kTotal, trials.total(), reason(facts.total_void, trials.no_gauge()),
      [&] { return trials.gauge_model(trials.total(), "total"); });
  add(Curve::kFollowing, trials.following(), reason(facts.following_void, trials.no_axes()),
      [&] { return trials.following_model(); });
  add(Curve::kRest, trials.rest(),
      reason(facts.rest_void, trials.no_gauge() ? trials.no_gauge() : trials.no_axes()),
      [&] { return trials.rest_model(); });
  Curves mains;
  Curves indirect;
  for (const fit::ContourPartResult& part : facts.study.parts) {
    if (!part.main || !part.indirect) return out;
    mains.push_back(trials.basis().of(part.main->contour.error_mm));
    indirect.push_back(trials.basis().of(part.indirect->following_mm));
  }
  add(Curve::kMain, mains, reason(std::nullopt, trials.no_gauge()),
      [&] { return trials.gauge_model(mains, "main"); });
  auto model = trials.indirect_model(indirect);
  auto why = reason(facts.total_void, trials.no_gauge());
  if (!why && facts.indirect_is_bound) {
    why = core::phrase("pins and main journals differ: f from the main journal is only a bound");
  }
  if (!why && !model) {
    why =
        core::phrase("main_differs_um is not declared, and fewer than 4 parts have both journals");
  }
  add(Curve::kIndirect, indirect, why, [&] { return *std::move(model); });
  return out;
}

}  // namespace rondure::evaluation
