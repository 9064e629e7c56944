#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <optional>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/noise.h"
#include "core/units.h"
#include "core/watch.h"
#include "evaluation/results/stated_value.h"
#include "evaluation/spindle/internal/noise_runs.h"
#include "evaluation/spindle/internal/probe_influences.h"
#include "evaluation/spindle/result.h"
#include "evaluation/uncertainty/curve_trials.h"
#include "fit/spindle/separation_model.h"

namespace rondure::evaluation {
namespace {

using core::phrase;
using record::Form;

constexpr int kNoiseAlone = 200;         ///< Trials of the noise alone, for the budget.
constexpr double kLeastNoise_mm = 1e-9;  ///< 1e-6 um: a coefficient known exactly is drawn there.

/// Orders taken for parts of one kind: 2-7, 8-15, 16-31, ...
int octave_of(int order) { return order < 8 ? 0 : static_cast<int>(std::log2(order)) - 2; }

/// The motion in X and Y, order by order turned to the directions in which its noise is
/// independent.
class NoiseDirections {
 public:
  NoiseDirections(const fit::SeparationModel& model, const fit::ThreeProbeResult& separation,
                  std::uint64_t seed)
      : orders_(model.highest_motion() - 1), turns_(static_cast<std::size_t>(orders_)) {
    struct Power {
      double x = 0.0;
      double y = 0.0;
      std::complex<double> cross;
    };
    std::vector<Power> power(turns_.size());
    visit_noise(model, separation, seed, [&](const fit::SpindleCurves& found) {
      for (std::size_t k = 0; k < turns_.size(); ++k) {
        const auto x = part_of(found.x_mm, k);
        const auto y = part_of(found.y_mm, k);
        power[k].x += std::norm(x) / kNoiseEvaluations;
        power[k].y += std::norm(y) / kNoiseEvaluations;
        power[k].cross += x * std::conj(y) / static_cast<double>(kNoiseEvaluations);
      }
    });
    for (std::size_t k = 0; k < turns_.size(); ++k) {
      const Power& p = power[k];
      Turn& turn = turns_[k];
      turn.phase = std::polar(1.0, std::arg(p.cross));
      const double angle = 0.5 * std::atan2(2.0 * std::abs(p.cross), p.x - p.y);
      turn.c = std::cos(angle);
      turn.s = std::sin(angle);
      const double mixed = 2.0 * std::abs(p.cross) * turn.c * turn.s;
      const double first = p.x * turn.c * turn.c + mixed + p.y * turn.s * turn.s;
      const double second = p.x * turn.s * turn.s - mixed + p.y * turn.c * turn.c;
      // Each holds the powers of a real and of an imaginary part.
      turn.u_first_mm = std::max(kLeastNoise_mm, std::sqrt(std::max(0.0, first) / 2.0));
      turn.u_second_mm = std::max(kLeastNoise_mm, std::sqrt(std::max(0.0, second) / 2.0));
    }
  }

  /// The coefficients of a motion in these directions, four for each order.
  [[nodiscard]] MeasuredCurve turned(const fit::SpindleCurves& curves) const {
    MeasuredCurve out;
    for (std::size_t k = 0; k < turns_.size(); ++k) {
      const Turn& turn = turns_[k];
      const auto x = part_of(curves.x_mm, k);
      const auto y = part_of(curves.y_mm, k) * turn.phase;
      const auto first = turn.c * x + turn.s * y;
      const auto second = turn.c * y - turn.s * x;
      out.found_mm.insert(out.found_mm.end(),
                          {first.real(), first.imag(), second.real(), second.imag()});
      out.u_mm.insert(out.u_mm.end(),
                      {turn.u_first_mm, turn.u_first_mm, turn.u_second_mm, turn.u_second_mm});
      out.group.insert(out.group.end(), 4, octave_of(static_cast<int>(k) + 2));
      const int number = 2 * static_cast<int>(k);  // real and imaginary part together
      out.order.insert(out.order.end(), {number, number, number + 1, number + 1});
    }
    return out;
  }

  /// Back to X and Y.
  [[nodiscard]] std::pair<Eigen::VectorXd, Eigen::VectorXd> straight(
      const std::vector<double>& coefficients) const {
    std::pair<Eigen::VectorXd, Eigen::VectorXd> out = {Eigen::VectorXd(2 * orders_),
                                                       Eigen::VectorXd(2 * orders_)};
    for (std::size_t k = 0; k < turns_.size(); ++k) {
      const Turn& turn = turns_[k];
      const std::complex<double> first(coefficients[4 * k], coefficients[4 * k + 1]);
      const std::complex<double> second(coefficients[4 * k + 2], coefficients[4 * k + 3]);
      const auto x = turn.c * first - turn.s * second;
      const auto y = (turn.s * first + turn.c * second) * std::conj(turn.phase);
      const auto row = 2 * static_cast<Eigen::Index>(k);
      out.first[row] = x.real();
      out.first[row + 1] = -x.imag();
      out.second[row] = y.real();
      out.second[row + 1] = -y.imag();
    }
    return out;
  }

 private:
  struct Turn {
    std::complex<double> phase;
    double c = 1.0;
    double s = 0.0;
    double u_first_mm = 0.0;
    double u_second_mm = 0.0;
  };

  /// a - j b of a cos + b sin.
  static std::complex<double> part_of(const Eigen::VectorXd& coefficients, std::size_t k) {
    const auto row = 2 * static_cast<Eigen::Index>(k);
    return {coefficients[row], -coefficients[row + 1]};
  }

  Eigen::Index orders_ = 0;
  std::vector<Turn> turns_;
};

/// The differences of the revolutions from their mean, as orthonormal contrasts.
class Contrasts {
 public:
  Contrasts(const fit::SeparationModel& model, const fit::ThreeProbeResult& separation)
      : turns_(separation.revolutions), columns_(model.turn_waves().cols()) {
    const auto per_noise = model.motion_per_noise();
    const double readings = static_cast<double>(separation.readings) / turns_;
    for (int direction = 0; direction < 2; ++direction) {
      Eigen::MatrixXd of_turns(columns_, turns_);
      for (int j = 0; j < turns_; ++j) {
        const fit::CentreMotion& turn = separation.motion[static_cast<std::size_t>(j)];
        of_turns.col(j) = model.over_turn(direction == 0 ? turn.x_mm : turn.y_mm);
      }
      const double u = separation.noise_mm * per_noise[static_cast<std::size_t>(direction)] *
                       std::sqrt(2.0 / readings);
      for (int j = 1; j < turns_; ++j) {
        const Eigen::VectorXd contrast =
            (of_turns.leftCols(j).rowwise().sum() - j * of_turns.col(j)) / length(j);
        for (Eigen::Index c = 0; c < columns_; ++c) {
          const int order = static_cast<int>((c + 1) / 2);
          const bool ramp = c + 1 == columns_;  // what it is off by, the waves take up
          curve_.found_mm.push_back(contrast[c]);
          curve_.u_mm.push_back(
              ramp ? kLeastNoise_mm
                   : std::max(kLeastNoise_mm, order == 0 ? u / std::sqrt(2.0) : u));
          curve_.group.push_back(ramp        ? octave_of(model.highest_motion()) + 3
                                 : order < 2 ? order
                                             : octave_of(order) + 2);
        }
      }
    }
  }

  [[nodiscard]] const MeasuredCurve& curve() const { return curve_; }

  /// Coefficients of the differences of the revolutions from their mean, one column for each.
  [[nodiscard]] Eigen::MatrixXd of_turns(const std::vector<double>& contrasts,
                                         int direction) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(columns_, turns_);
    const auto start = static_cast<Eigen::Index>(direction) * (turns_ - 1) * columns_;
    for (int j = 1; j < turns_; ++j) {
      const Eigen::Map<const Eigen::VectorXd> contrast(
          contrasts.data() + start + (j - 1) * columns_, columns_);
      out.leftCols(j).colwise() += contrast / length(j);
      out.col(j) -= contrast * j / length(j);
    }
    return out;
  }

 private:
  static double length(int j) { return std::sqrt(j * (j + 1.0)); }

  int turns_ = 1;
  Eigen::Index columns_ = 0;
  MeasuredCurve curve_;
};

double width(const Eigen::VectorXd& values) { return values.maxCoeff() - values.minCoeff(); }

/// Part and motion of one trial.
struct State {
  Eigen::VectorXd profile_mm;
  Eigen::VectorXd x_mm;
  Eigen::VectorXd y_mm;
  /// X and Y of every revolution less their mean, one column for each; empty: all are alike.
  std::array<Eigen::MatrixXd, 2> turns_mm = {};
  double gain = 1.0;  ///< What the mean gain of the probes makes of them.
};

/// The values that characteristics ask for, as functions of part and motion.
class Values {
 public:
  Values(const SpindleResult& facts, const fit::SeparationModel& model)
      : facts_(facts), model_(model) {
    const fit::FilterOptions& filter = facts.roundness.filter;
    const auto& harmonics = facts.separation.harmonics;
    transmission_ = Eigen::VectorXd::Ones(2 * static_cast<Eigen::Index>(harmonics.size()));
    if (filter.filter == fit::ProfileFilter::kNone) return;
    Eigen::Index row = 0;
    for (const fit::RecoveredHarmonic& h : harmonics) {
      // ISO 16610-21, closed profile.
      const double share = std::exp2(-std::pow(h.order / filter.cutoff_upr, 2.0));
      transmission_.segment(row, 2).setConstant(share);
      row += 2;
    }
  }

  /// @param limit_mm  Of a mask: the line of the value, to which every amplitude is brought.
  /// @return NaN where there is no value.
  /// @param order  Of a mask: one harmonic alone; none: the one that is nearest to its limit.
  [[nodiscard]] double of(const State& state, const record::Characteristic& asked,
                          const AnalysisValue& measured, std::optional<int> order = {}) const {
    switch (asked.form) {
      case Form::kRoundness:
        return roundness(state, asked.reference);
      case Form::kRoundnessRms:
        return std::sqrt(0.5) * state.profile_mm.cwiseProduct(transmission_).norm();
      case Form::kHarmonicLimits:
        return mask(state.profile_mm, asked, order) * measured.limit_mm.value_or(0.0);
      case Form::kMotionSynchronous:
        return std::max(width(model_.motion_waves() * state.x_mm),
                        width(model_.motion_waves() * state.y_mm));
      case Form::kMotionTotal:
        return std::max(total(state, 0), total(state, 1));
      default:
        return state.gain * std::max(asynchronous(state, 0), asynchronous(state, 1));
    }
  }

  /// The harmonics of a mask that bind.
  [[nodiscard]] std::vector<int> binding(const Eigen::VectorXd& profile_mm,
                                         const record::Characteristic& asked) const {
    std::vector<int> out;
    if (asked.form != Form::kHarmonicLimits) return out;
    for (const fit::RecoveredHarmonic& h : facts_.separation.harmonics) {
      if (mask(profile_mm, asked, h.order) > kBindingShare) out.push_back(h.order);
    }
    return out;
  }

 private:
  [[nodiscard]] double roundness(const State& state, record::Reference reference) const {
    const Eigen::VectorXd r = model_.profile_waves() * state.profile_mm.cwiseProduct(transmission_);
    if (reference == record::Reference::kLeastSquares) return width(r);  // no order below 2
    const auto circle =
        reference == record::Reference::kMinimumCircumscribed ? fit::CircleReference::kMc
        : reference == record::Reference::kMaximumInscribed   ? fit::CircleReference::kMi
                                                              : fit::CircleReference::kMz;
    const auto found = fit::roundness_of_profile(
        model_.places_rad(), {r.data(), static_cast<std::size_t>(r.size())}, circle);
    return found ? found->total_mm : std::nan("");
  }

  /// The greatest amplitude in parts of its limit, or that of one order.
  [[nodiscard]] double mask(const Eigen::VectorXd& profile_mm, const record::Characteristic& asked,
                            std::optional<int> order) const {
    double worst = 0.0;
    Eigen::Index row = 0;
    for (const fit::RecoveredHarmonic& h : facts_.separation.harmonics) {
      const double amplitude = profile_mm.segment(row, 2).norm();
      for (const record::HarmonicLimit& line : asked.harmonic_limits) {
        if (h.order >= line.first && h.order <= line.last && order.value_or(h.order) == h.order)
          worst = std::max(worst, amplitude / line.amplitude_mm);
      }
      row += 2;
    }
    return worst;
  }

  [[nodiscard]] static double asynchronous(const State& state, std::size_t direction) {
    const Eigen::MatrixXd& turns = state.turns_mm[direction];
    return (turns.rowwise().maxCoeff() - turns.rowwise().minCoeff()).maxCoeff();
  }

  [[nodiscard]] double total(const State& state, std::size_t direction) const {
    const Eigen::VectorXd mean = model_.motion_waves() * (direction == 0 ? state.x_mm : state.y_mm);
    if (state.turns_mm[direction].size() == 0) return width(mean);
    const Eigen::MatrixXd turns = state.turns_mm[direction].colwise() + mean;
    return turns.maxCoeff() - turns.minCoeff();
  }

  const SpindleResult& facts_;
  const fit::SeparationModel& model_;
  Eigen::VectorXd transmission_;
};

fit::SpindleCurves sum_of(const fit::SpindleCurves& a, double factor, const fit::SpindleCurves& b) {
  return {a.profile_mm + factor * b.profile_mm, a.x_mm + factor * b.x_mm, a.y_mm + factor * b.y_mm};
}

/// Trials of one separation.
class SpindleTrials {
 public:
  SpindleTrials(const SpindleResult& facts, fit::SeparationModel model, std::uint64_t seed,
                bool with_turns)
      : facts_(facts),
        first_(*facts.first_harmonic),
        model_(std::move(model)),
        seed_(seed),
        first_id_("probe.noise.first-harmonic/" + facts.feature_id),
        sources_(probe_sources(*facts.influences, facts.arm, facts.separation.layout,
                               facts.wheel_radius)),
        base_(model_.at(first_.mean)),
        directions_(model_, facts.separation, seed),
        part_(part_curve(), seed, "probe.noise.part/" + facts.feature_id),
        motion_(directions_.turned(base_), seed, "probe.noise.motion/" + facts.feature_id) {
    if (with_turns && facts.separation.revolutions > 1) {
      contrasts_.emplace(model_, facts.separation);
      turns_.emplace(contrasts_->curve(), seed, "probe.noise.turns/" + facts.feature_id);
    }
    const fit::ProbeErrorCovariance prior = covariance_of(sources_);
    for (int i = 0; i < fit::kProbeErrors; ++i) {
      const double step = std::sqrt(prior(i, i));
      if (!(step > 0.0)) continue;
      fit::ProbeErrors up = first_.mean;
      fit::ProbeErrors down = first_.mean;
      up[i] += step;
      down[i] -= step;
      fit::SpindleCurves slope = sum_of(model_.at(up), -1.0, model_.at(down));
      slope = {slope.profile_mm / (2.0 * step), slope.x_mm / (2.0 * step),
               slope.y_mm / (2.0 * step)};
      slopes_.emplace_back(i, std::move(slope));
    }
    straight_ = std::ranges::all_of(sources_, [&](const ProbeSource& s) {
      return straight_to(s, 2.0) && straight_to(s, -2.0);
    });
  }

  [[nodiscard]] Values values() const { return {facts_, model_}; }
  /// The profile of the readings, errors of the probes as the first harmonic shows them.
  [[nodiscard]] const Eigen::VectorXd& profile_mm() const { return base_.profile_mm; }
  [[nodiscard]] const std::vector<ProbeSource>& sources() const { return sources_; }

  /// A trial: noise and, unless `noise_only`, errors of the probes.
  [[nodiscard]] State draw(int trial, bool noise_only) const {
    return moved(part_.draw(trial), motion_.draw(trial),
                 turns_ ? turns_->draw(trial) : std::vector<double>(),
                 noise_only ? fit::ProbeErrors(fit::ProbeErrors::Zero()) : errors(trial));
  }
  [[nodiscard]] State core(int trial) const {
    return moved(part_.core_draw(trial), motion_.core_draw(trial),
                 turns_ ? turns_->core_draw(trial) : std::vector<double>(), errors(trial));
  }
  [[nodiscard]] State core_center() const {
    return moved(part_.core_mm(), motion_.core_mm(),
                 turns_ ? turns_->core_mm() : std::vector<double>(), fit::ProbeErrors::Zero());
  }
  /// Without any draw, a whole evaluation of readings that a source has moved by so many standard
  /// uncertainties.
  [[nodiscard]] State at(const ProbeSource& source, double times) const {
    const fit::ProbeErrors q = first_.mean - times * left_of(source);
    const fit::SpindleCurves curves = model_.at(q);
    State out{curves.profile_mm, curves.x_mm, curves.y_mm};
    if (contrasts_) out.turns_mm = revolutions(contrasts_->curve().found_mm);
    out.gain = 1.0 - q.segment<3>(fit::kFirstGain).mean();
    return out;
  }

 private:
  /// Errors for one standard uncertainty of a source, less what the first harmonic says of them.
  [[nodiscard]] fit::ProbeErrors left_of(const ProbeSource& source) const {
    return source.per_u - first_.gain * (first_.sensitivity * source.per_u);
  }

  /// Change of the curves by errors of the probes, along the slopes.
  [[nodiscard]] fit::SpindleCurves along_slopes(const fit::ProbeErrors& by) const {
    fit::SpindleCurves out = {Eigen::VectorXd::Zero(base_.profile_mm.size()),
                              Eigen::VectorXd::Zero(base_.x_mm.size()),
                              Eigen::VectorXd::Zero(base_.y_mm.size())};
    for (const auto& [component, slope] : slopes_) {
      out.profile_mm += by[component] * slope.profile_mm;
      out.x_mm += by[component] * slope.x_mm;
      out.y_mm += by[component] * slope.y_mm;
    }
    return out;
  }

  /// Whether the slopes give the change by a source within a tenth. Near a layout with probes in
  /// line they do not, and every trial separates anew.
  [[nodiscard]] bool straight_to(const ProbeSource& source, double times) const {
    constexpr double kShare = 0.1;
    const fit::ProbeErrors by = times * left_of(source);
    const fit::SpindleCurves expected = along_slopes(by);
    const fit::SpindleCurves rest =
        sum_of(sum_of(model_.at(first_.mean + by), -1.0, base_), -1.0, expected);
    const auto power = [](const fit::SpindleCurves& c) {
      return c.profile_mm.squaredNorm() + c.x_mm.squaredNorm() + c.y_mm.squaredNorm();
    };
    return power(rest) <= kShare * kShare * power(expected) + kLeastNoise_mm * kLeastNoise_mm;
  }

  /// Revolutions less their mean, over the work, from their contrasts.
  [[nodiscard]] std::array<Eigen::MatrixXd, 2> revolutions(
      const std::vector<double>& contrasts) const {
    return {model_.turn_waves() * contrasts_->of_turns(contrasts, 0),
            model_.turn_waves() * contrasts_->of_turns(contrasts, 1)};
  }

  [[nodiscard]] MeasuredCurve part_curve() const {
    MeasuredCurve out;
    Eigen::Index row = 0;
    for (const fit::RecoveredHarmonic& h : facts_.separation.harmonics) {
      for (int part = 0; part < 2; ++part) {
        out.found_mm.push_back(base_.profile_mm[row++]);
        out.u_mm.push_back(std::max(kLeastNoise_mm, h.sigma_mm));
        out.group.push_back(octave_of(h.order));
        out.order.push_back(h.order);
      }
    }
    return out;
  }

  /// Errors of the probes given the first harmonic, less their expectation.
  [[nodiscard]] fit::ProbeErrors errors(int trial) const {
    fit::ProbeErrors free = fit::ProbeErrors::Zero();
    for (const ProbeSource& source : sources_) {
      free += source.draw(seed_, trial) * source.per_u;
    }
    const Eigen::Vector2d noise(normal_draw(seed_, first_id_, 0, trial),
                                normal_draw(seed_, first_id_, 1, trial));
    return free - first_.gain * (first_.sensitivity * free + first_.u_mm * noise);
  }

  [[nodiscard]] State moved(const std::vector<double>& part, const std::vector<double>& motion,
                            const std::vector<double>& contrasts,
                            const fit::ProbeErrors& by) const {
    const auto xy = directions_.straight(motion);
    State out{
        Eigen::Map<const Eigen::VectorXd>(part.data(), static_cast<Eigen::Index>(part.size())),
        xy.first, xy.second};
    if (!contrasts.empty()) out.turns_mm = revolutions(contrasts);
    const fit::SpindleCurves change =
        straight_ ? along_slopes(by) : sum_of(model_.at(first_.mean + by), -1.0, base_);
    out.profile_mm += change.profile_mm;
    out.x_mm += change.x_mm;
    out.y_mm += change.y_mm;
    const fit::ProbeErrors all = first_.mean + by;
    out.gain = 1.0 - all.segment<3>(fit::kFirstGain).mean();
    return out;
  }

  const SpindleResult& facts_;
  const fit::FirstHarmonic& first_;
  fit::SeparationModel model_;
  std::uint64_t seed_ = 0;
  std::string first_id_;
  std::vector<ProbeSource> sources_;
  fit::SpindleCurves base_;
  NoiseDirections directions_;
  CurveDraws part_;
  CurveDraws motion_;
  std::optional<Contrasts> contrasts_;
  std::optional<CurveDraws> turns_;
  std::vector<std::pair<int, fit::SpindleCurves>> slopes_;
  bool straight_ = true;
};

double deviation_of(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  double power = 0.0;
  for (const double v : values) power += (v - mean) * (v - mean);
  return std::sqrt(power / static_cast<double>(values.size() - 1));
}

/// Why a characteristic has no interval.
std::optional<core::Phrase> missing(const SpindleResult& facts, const record::Characteristic& asked,
                                    const core::Result<AnalysisValue>& measured) {
  if (!measured) return measured.error().said();
  if (asked.form == Form::kMotionAsynchronous) return std::nullopt;
  if (!facts.separation.unrecovered.empty()) {
    return phrase("{} harmonics were not recovered", facts.separation.unrecovered.size());
  }
  return std::nullopt;
}

/// What is to be read beside an interval.
std::vector<core::Phrase> notes_of(const SpindleResult& facts, const record::Characteristic& asked,
                                   int highest_motion) {
  std::vector<core::Phrase> out;
  if (facts.first_harmonic->blind()) {
    out.push_back(
        phrase("the eccentricity is too small to show errors of gains and angles: the interval "
               "rests on their certificates alone (k1-blind)"));
  }
  const bool part = asked.form == Form::kRoundness || asked.form == Form::kRoundnessRms ||
                    asked.form == Form::kHarmonicLimits;
  if (!part) {
    out.push_back(phrase(
        "the interval is of motion up to {} cycles a turn; as read, the value also holds the noise "
        "above",
        highest_motion));
  }
  if (asked.form == Form::kMotionAsynchronous || asked.form == Form::kMotionTotal) {
    out.push_back(phrase("of {} turns", facts.separation.revolutions));
  }
  return out;
}

}  // namespace

std::vector<UncertaintyStatus> intervals_of(const SpindleResult& result,
                                            std::span<const record::Characteristic> characteristics,
                                            const UncertaintyOptions& options) {
  const auto none = [&](const core::Phrase& why) {
    return std::vector<UncertaintyStatus>(characteristics.size(), UncertaintyStatus::none(why));
  };
  if (!result.declares_probes()) {
    return none(
        phrase("gains and angles of the probes are not declared: declare gain_1 and angle_deg in "
               "`uncertainty` of the feature"));
  }
  if (auto why = blind_on_an_arm(result)) return none(*why);
  if (result.no_interval_because) return none(*result.no_interval_because);
  if (result.wheel_radius && !result.wheel_radius->errors) {
    return none(no_radius_uncertainty(*result.wheel_radius));
  }
  auto model = fit::SeparationModel::of(result.separation);
  if (!model) return none(model.error().said());
  const int highest_motion = model->highest_motion();
  const bool with_turns = std::any_of(
      characteristics.begin(), characteristics.end(), [](const record::Characteristic& asked) {
        return asked.form == Form::kMotionAsynchronous || asked.form == Form::kMotionTotal;
      });
  const SpindleTrials trials(result, *std::move(model), options.seed, with_turns);
  const Values values = trials.values();
  const int count = std::max(100, options.least_trials);

  /// One characteristic with an interval.
  struct Asked {
    std::size_t index = 0;
    AnalysisValue measured;
    TrialValues all;
    std::vector<double> noise_mm;
    std::vector<LinearTerm> terms;
    std::optional<int> order = {};  ///< One line of a mask.
    std::size_t lines = 1;          ///< Of so many.
  };
  std::vector<UncertaintyStatus> out = none({});
  std::vector<Asked> wanted;
  for (std::size_t c = 0; c < characteristics.size(); ++c) {
    const auto measured = value_of(result, characteristics[c]);
    if (auto why = missing(result, characteristics[c], measured)) {
      out[c] = UncertaintyStatus::none(*std::move(why));
      continue;
    }
    Asked one{c, *measured, {}, {}, {}};
    one.all.as_measured_mm = measured->value_mm;
    wanted.push_back(std::move(one));
    // After its mask, each line that binds.
    const std::vector<int> lines = values.binding(trials.profile_mm(), characteristics[c]);
    for (const int order : lines) {
      Asked line{c, *measured, {}, {}, {}, order, lines.size()};
      const State read{trials.profile_mm(), {}, {}};
      line.all.as_measured_mm = values.of(read, characteristics[c], *measured, order);
      wanted.push_back(std::move(line));
    }
  }
  const auto value = [&](const State& state, const Asked& one) {
    return values.of(state, characteristics[one.index], one.measured, one.order);
  };
  core::watch().expect(static_cast<std::size_t>(count));
  for (int t = 0; t < count; ++t) {
    core::watch().drawn();
    const State state = trials.draw(t, false);
    const State core = trials.core(t);
    for (Asked& one : wanted) {
      one.all.values_mm.push_back(value(state, one));
      one.all.core_mm.push_back(value(core, one));
    }
  }
  const State center = trials.core_center();
  for (Asked& one : wanted) {
    one.all.core_center_mm = value(center, one);
  }
  for (int t = 0; t < std::min(count, kNoiseAlone); ++t) {
    const State state = trials.draw(t, true);
    for (Asked& one : wanted) one.noise_mm.push_back(value(state, one));
  }
  for (const ProbeSource& source : trials.sources()) {
    const State up = trials.at(source, 1.0);
    const State down = trials.at(source, -1.0);
    for (Asked& one : wanted) {
      one.terms.push_back(
          {source.name, per_u([&](double at) { return value(at > 0.0 ? up : down, one); })});
    }
  }
  const auto declaration =
      probe_declaration(*result.influences, result.arm, result.wheel_radius,
                        result.separation.noise_mm, result.probe_range_mm.has_value());
  std::vector<std::vector<UncertaintyStatement>> lines(characteristics.size());
  for (Asked& one : std::views::reverse(wanted)) {  // the lines before their mask
    one.terms.push_back({"probe-noise", deviation_of(one.noise_mm)});
    auto stated = statement_of_trials(std::move(one.all), std::move(one.terms), declaration,
                                      options_of_line(options, one.lines));
    if (!stated) {
      out[one.index] = UncertaintyStatus::none(stated.error().said());
      continue;
    }
    if (one.order) {
      lines[one.index].push_back(std::move(stated->sampled));
      continue;
    }
    hold_lines_together(lines[one.index], *stated);
    for (core::Phrase& note : notes_of(result, characteristics[one.index], highest_motion)) {
      stated->notes.push_back(std::move(note));
    }
    out[one.index] = UncertaintyStatus::stated(*std::move(stated), options.coverage);
  }
  return out;
}

}  // namespace rondure::evaluation
