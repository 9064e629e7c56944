#include "evaluation/uncertainty/internal/sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/decompositions.h"
#include "core/statistics.h"
#include "core/units.h"

namespace rondure::evaluation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint64_t kChainStream = 11;
// noise below this counts as none; keeps variances positive
constexpr double kLeastSigma_mm = 1e-8;
constexpr int kWarmUp = 60;    // sweeps before the first draw
constexpr int kSpotSweep = 3;  // from this sweep on spots may be removed
constexpr int kStartRounds = 80;
constexpr double kSpotCandidate = 3.3;  // standard deviations
constexpr double kNoUnresolved = 0.35;  // probability that all form is resolved
constexpr int kVariances = 48;          // steps of the unresolved variance
constexpr double kFlat = 100.0;         // variance of a flat form: 1 % of its value is shrunk away
constexpr Index kFewestFree = 3;        // points beyond place and size that show how large form is
constexpr int kNoiseSteps = 15;         // for noise that is not known exactly
constexpr double kNegligible = -40.0;  // logarithm of the odds of a variance, against the likeliest
constexpr double kOverlap = 0.3;       // overlap of two columns above which they are drawn together
constexpr double kModeOverlap = 0.05;  // squared overlap of a column with a systematic error
constexpr double kCommon = 4.0;        // alpha of a form that four of five parts have
constexpr double kSpectrumRest = 0.05;  // no surface consists of a few declared terms alone
constexpr double kMostValues = 4e7;     // values in the matrix of columns: 320 MB

VectorXd point_variances(const ErrorModel& errors) {
  const VectorXd given = errors.point_variance_mm2();
  const double least = std::max(kLeastSigma_mm * kLeastSigma_mm, 1e-6 * given.mean());
  return given.cwiseMax(least);
}

VectorXd weights_of_points(const ErrorModel& errors) {
  const VectorXd variances = point_variances(errors);
  return (variances.mean() / variances.array()).sqrt();
}

double median_size(const VectorXd& values) {
  std::vector<double> sizes(static_cast<std::size_t>(values.size()));
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    sizes[i] = std::abs(values[static_cast<Index>(i)]);
  }
  return core::upper_median(std::move(sizes));
}

void free_of(const MatrixXd& rigid, VectorXd& values) {
  values -= rigid * (rigid.transpose() * values / static_cast<double>(values.size()));
}

/// Upper limit of the sizes of a band.
double most_size(double least, double power) { return std::max(4.0 * power, 4.0 * least); }

}  // namespace

double spot_log_odds(double rest_mm, double variance_mm2, double per_point) {
  const double square = std::max(rest_mm * rest_mm, variance_mm2);
  return std::log(per_point * std::sqrt(variance_mm2) / (2.0 * square)) +
         0.5 * (std::log(core::kTwoPi * variance_mm2) + rest_mm * rest_mm / variance_mm2);
}

double column_evidence(double product, double square, double variance_mm2, double size_mm2) {
  const double b = product / variance_mm2;
  const double precision = square / variance_mm2 + 1.0 / size_mm2;
  return 0.5 * (b * b / precision - std::log(precision * size_mm2));
}

VarianceOdds variance_odds(const VarianceTerms& terms, double squares_mm2, double count) {
  const double stated = terms.stated_mm2;
  const double lowest = std::log(1e-3 * stated);
  const double step = (std::log(4.0 * (terms.power_mm2 + stated)) - lowest) / (kVariances - 1);
  std::array<double, kVariances + 1> variances{};
  std::array<double, kVariances + 1> prior{};
  double norm = 0.0;
  for (std::size_t k = 1; k < variances.size(); ++k) {
    variances[k] = std::exp(lowest + step * static_cast<double>(k - 1));
    prior[k] = variances[k] / (variances[k] + stated);
    norm += prior[k];
  }
  prior[0] = std::log(kNoUnresolved);
  for (std::size_t k = 1; k < prior.size(); ++k) {
    prior[k] = std::log((1.0 - kNoUnresolved) * prior[k] / norm);
  }
  std::size_t first = 0;
  if (terms.flat) {
    first = kVariances;
    variances[first] = kFlat * (terms.power_mm2 + stated);
    prior[first] = 0.0;
  }
  const double freedom = terms.degrees_of_freedom;
  const int noises = freedom > 0.0 ? kNoiseSteps : 1;
  const double span = std::min(1.2, 1.95 * std::sqrt(2.0 / std::max(freedom, 1e-3)));
  VarianceOdds out;
  double highest = -std::numeric_limits<double>::infinity();
  for (int s = 0; s < noises; ++s) {
    const double g = noises == 1 ? 0.0 : span * (4.0 * s / (noises - 1) - 2.0);
    const double noise = stated * std::exp(g);
    const double of_noise = noises == 1 ? 0.0 : -0.5 * freedom * (g + std::exp(-g));
    for (std::size_t k = first; k < variances.size(); ++k) {
      const double w = noise + terms.floor_mm2 + variances[k];
      const double density = prior[k] + of_noise - 0.5 * (count * std::log(w) + squares_mm2 / w);
      out.push_back({noise, variances[k], density, step});
      highest = std::max(highest, density);
    }
  }
  double sum = 0.0;
  for (VarianceOdd& one : out) {
    const double below = one.probability_1 - highest;
    one.probability_1 = below > kNegligible ? std::exp(below) : 0.0;
    sum += one.probability_1;
  }
  for (VarianceOdd& one : out) one.probability_1 /= sum;
  return out;
}

FormModel::FormModel(const FormCloud& cloud, const ErrorModel& errors, const FormSpectrum* spectrum,
                     double expected_spots)
    : root_weight_(weights_of_points(errors)),
      noise_mm2_(point_variances(errors).mean()),
      residual_mm2_(noise_mm2_),
      freedom_(errors.degrees_of_freedom()),
      expected_spots_(expected_spots),
      columns_(spectrum != nullptr ? FormColumns(cloud, root_weight_, *spectrum)
                                   : FormColumns(cloud, root_weight_)),
      declared_(spectrum != nullptr),
      absolute_(spectrum != nullptr && spectrum->absolute) {
  // Several sections show by each other how large form is.
  const Index fewest = cloud.kind == FormKind::kSections ? kFewestFree - 1 : kFewestFree;
  flat_ = !declared_ && static_cast<Index>(cloud.points.size()) - columns_.rigid().cols() < fewest;
  weigh(cloud, errors);
  start();
  screen();
  assemble();
  correlate(cloud, errors);
  find_bands(cloud.kind);
  find_joint();
  find_seen();
  first_state();
}

double FormModel::flagged_share() const {
  return static_cast<double>(flagged_.size()) / static_cast<double>(y_.size());
}

void FormModel::weigh(const FormCloud& cloud, const ErrorModel& errors) {
  y_.resize(root_weight_.size());
  for (Index i = 0; i < y_.size(); ++i) {
    y_[i] = root_weight_[i] * cloud.points[static_cast<std::size_t>(i)].deviation_mm;
  }
  removed_ = y_;
  free_of(columns_.rigid(), y_);
  removed_ -= y_;
  Index count = 0;
  for (Index k = 0; k < errors.columns().cols(); ++k) {
    if (!errors.columns().col(k).isZero(0.0)) ++count;
  }
  systematic_.resize(y_.size(), count);
  count = 0;
  for (Index k = 0; k < errors.columns().cols(); ++k) {
    if (errors.columns().col(k).isZero(0.0)) continue;
    VectorXd column = root_weight_.cwiseProduct(errors.columns().col(k));
    free_of(columns_.rigid(), column);
    systematic_.col(count++) = column;
  }
}

/// A robust start: first removes low undulations, then always the group or point that stands out
/// most. (A burr gives every column some energy, and draws leave a false start slowly.)
void FormModel::start() {
  const double n = static_cast<double>(y_.size());
  imputed_ = y_;
  VectorXd rest = y_;
  std::vector<bool> flagged(static_cast<std::size_t>(y_.size()), false);
  for (int round = 0; round < kStartRounds && !declared_; ++round) {
    const double scale = core::kSigmaPerMedianDeviation * median_size(rest);
    const double w = std::max(noise_mm2_, scale * scale);
    const double top = rest.cwiseAbs2().maxCoeff();
    const VectorXd products = columns_.products(rest);
    std::vector<std::size_t> taken;
    double strongest = 0.0;
    for (std::size_t g = 0; g < columns_.groups().size(); ++g) {
      const FormGroup& group = columns_.groups()[g];
      double energy = 0.0;
      for (const Index k : group.columns) energy += products[k] * products[k];
      energy /= n * static_cast<double>(group.columns.size());
      const bool low =
          round == 0 && group.undulations <= 15.0 && energy > std::max(4.0 * w, 0.25 * top);
      if (!low && !(energy > std::max(20.0 * w, top))) continue;
      if (!columns_.layout().arc_rad) {
        taken.push_back(g);
      } else if (energy > strongest) {  // nearly dependent columns: one per round
        taken = {g};
        strongest = energy;
      }
    }
    if (!taken.empty()) {
      const MatrixXd columns = columns_.matrix(taken);
      rest -= columns * (columns.transpose() * rest / n);
    } else if (top > 25.0 * w) {
      for (Index i = 0; i < rest.size(); ++i) {
        if (rest[i] * rest[i] <= std::max(25.0 * w, 0.5 * top)) continue;
        flagged[static_cast<std::size_t>(i)] = true;
        imputed_[i] -= rest[i];
        rest[i] = 0.0;
      }
      free_of(columns_.rigid(), rest);
    } else {
      break;
    }
  }
  residual_mm_ = std::sqrt(rest.squaredNorm() / n);
  for (std::size_t i = 0; i < flagged.size(); ++i) {
    if (flagged[i]) flagged_.push_back(i);
  }
  VectorXd free = imputed_;
  free_of(columns_.rigid(), free);
  power_mm2_ = std::max(free.squaredNorm() / n, 1e-3 * noise_mm2_);
  const VectorXd products = columns_.products(free);
  energy_.resize(static_cast<Index>(columns_.groups().size()));
  for (Index g = 0; g < energy_.size(); ++g) {
    const FormGroup& group = columns_.groups()[static_cast<std::size_t>(g)];
    double energy = 0.0;
    for (const Index k : group.columns) energy += products[k] * products[k];
    energy_[g] = energy / (n * static_cast<double>(group.columns.size()));
  }
}

/// Selects the groups that take part: low undulations first, then by energy.
void FormModel::screen() {
  std::vector<std::size_t> order(columns_.groups().size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const double n = static_cast<double>(y_.size());
  if (!declared_) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const bool low_a = columns_.groups()[a].undulations <= 15.0;
      const bool low_b = columns_.groups()[b].undulations <= 15.0;
      if (low_a != low_b) return low_a;
      return energy_[static_cast<Index>(a)] > energy_[static_cast<Index>(b)];
    });
    double most = std::max(400.0, std::min(1000.0, n / 5.0));
    if (n > 20'000.0 && !columns_.layout().regular) most = 400.0;
    most = std::min(most, kMostValues / n);
    double count = static_cast<double>(columns_.rigid().cols());
    std::size_t fits = 0;
    for (; fits < order.size(); ++fits) {
      count += static_cast<double>(columns_.groups()[order[fits]].columns.size());
      if (count > most) break;
    }
    order.resize(fits);
  }
  std::sort(order.begin(), order.end());
  kept_sources_ = std::move(order);
}

void FormModel::assemble() {
  const MatrixXd& rigid = columns_.rigid();
  const MatrixXd form = columns_.matrix(kept_sources_);
  base_ = rigid.cols() + systematic_.cols();
  all_.resize(y_.size(), base_ + form.cols());
  all_ << rigid, systematic_, form;
  square_ = all_.colwise().squaredNorm();
  Index at = base_;
  for (const std::size_t source : kept_sources_) {
    const int width = static_cast<int>(columns_.groups()[source].columns.size());
    groups_.push_back({source, at, width, 0, 0.0});
    at += width;
  }
  if (columns_.layout().regular) {
    if (systematic_.cols() == 0) return;
    gram_ = square_.asDiagonal();
    gram_.middleCols(rigid.cols(), systematic_.cols()) = all_.transpose() * systematic_;
    gram_.middleRows(rigid.cols(), systematic_.cols()) =
        gram_.middleCols(rigid.cols(), systematic_.cols()).transpose();
    return;
  }
  gram_ = MatrixXd::Zero(all_.cols(), all_.cols());
  gram_.selfadjointView<Eigen::Lower>().rankUpdate(all_.transpose());
  gram_.triangularView<Eigen::StrictlyUpper>() = gram_.transpose();
}

/// Noise that neighbours share: its additional contribution to each undulation.
void FormModel::correlate(const FormCloud& cloud, const ErrorModel& errors) {
  const double length = errors.correlation_mm();
  const PointLayout& layout = columns_.layout();
  if (!(length > 0.0) || !layout.layered || layout.arc_rad || declared_) return;
  const int m = layout.points_per_layer;
  const double step = core::kTwoPi * cloud.radius_mm / m;
  const auto gain = [&](int k) {
    double sum = 0.0;
    for (int j = 0; j < m; ++j) {
      const double way = step * std::min(j, m - j);
      sum += std::exp(-way / length) * std::cos(core::kTwoPi * j * k / m);
    }
    return sum;
  };
  double rest = 0.0;
  int count = 0;
  for (int k = columns_.most_undulations() + 1; k <= m / 2; ++k, ++count) rest += gain(k);
  rest = count > 0 ? rest / count : gain(m / 2);
  residual_mm2_ = noise_mm2_ * std::max(rest, 1e-6);
  std::map<int, double> gains;
  for (KeptGroup& group : groups_) {
    const int k = columns_.groups()[group.source].harmonic;
    if (!gains.contains(k)) gains[k] = gain(k);
    group.extra_mm2 = noise_mm2_ * std::max(0.0, gains[k] - rest) / static_cast<double>(y_.size());
  }
}

void FormModel::find_bands(FormKind kind) {
  const double n = static_cast<double>(y_.size());
  if (declared_) {
    const Index width = all_.cols() - base_;
    spectrum_power_ = all_.rightCols(width).squaredNorm() / n;
    FormBand band;
    band.groups = band.kept = static_cast<int>(groups_.size());
    band.always = true;
    bands_.push_back(band);
    return;
  }
  std::map<std::tuple<int, int, int>, std::size_t> places;
  const auto band_of = [&](const FormGroup& group) {
    const bool common = kind == FormKind::kCylindricity && group.harmonic < 2 && group.degree <= 2;
    const int alone = common ? 1 + 3 * group.harmonic + group.degree : 0;
    const auto [place, fresh] =
        places.try_emplace({group.octave, group.degree_class, alone}, bands_.size());
    if (fresh) {
      FormBand band;
      // A form of few groups is as likely as one of many. With 1 in the lowest octaves half of a
      // band is present beforehand, and noise is taken for form where its groups are in truth none.
      // Taper, barrel and bow are the forms that parts have, whatever lobes are absent: a median
      // line shows nothing else, and noise of its size must not be taken for a straight one.
      band.rareness = common ? kCommon
                             : std::max(0.1, std::min(0.5, std::exp2(1.0 - group.octave))) *
                                   (group.degree_class < 2 ? 1.0 : 0.3);
      bands_.push_back(band);
    }
    return place->second;
  };
  for (const FormGroup& group : columns_.groups()) ++bands_[band_of(group)].groups;
  for (KeptGroup& group : groups_) {
    group.band = band_of(columns_.groups()[group.source]);
    // A form similar to a systematic error: otherwise all of it would be attributed to the error.
    double shared = 0.0;
    bool like = false;
    for (Index j = group.first; j < group.first + group.width; ++j) {
      for (Index k = 0; k < systematic_.cols(); ++k) {
        const double product = all_.col(j).dot(systematic_.col(k));
        like = like || product * product > kModeOverlap * n * systematic_.col(k).squaredNorm();
        shared += product * product / (n * n) / group.width;
      }
    }
    // An error below the noise of the coefficient removes no form.
    if (like && shared > noise_mm2_ / n) {
      --bands_[group.band].groups;
      group.band = bands_.size();
      FormBand own;
      own.groups = 1;
      own.always = true;
      own.least_mm2 = shared;
      bands_.push_back(own);
    }
    FormBand& band = bands_[group.band];
    ++band.kept;
    band.extra_mm2 += group.extra_mm2;
  }
  for (FormBand& band : bands_) {
    if (band.kept > 0) band.extra_mm2 /= band.kept;
  }
}

/// Finds the columns that overlap too much to be drawn one after another.
void FormModel::find_joint() {
  joint_.assign(static_cast<std::size_t>(all_.cols()), false);
  if (orthogonal()) return;
  joint_all_ = declared_;
  for (Index j = base_; j < all_.cols() && !joint_all_; ++j) {
    for (Index k = base_; k < j && !joint_all_; ++k) {
      joint_all_ = std::abs(gram_(j, k)) > kOverlap * std::sqrt(square_[j] * square_[k]);
    }
  }
  const Index rigid = columns_.rigid().cols();
  for (Index j = 0; j < all_.cols(); ++j) {
    bool drawn = joint_all_ || (j < base_ && base_ > rigid);
    for (Index k = rigid; k < base_ && !drawn; ++k) {
      drawn = std::abs(gram_(j, k)) > kModeOverlap * std::sqrt(square_[j] * square_[k]);
    }
    joint_[static_cast<std::size_t>(j)] = drawn;
  }
}

void FormModel::find_seen() {
  const Index rigid = columns_.rigid().cols();
  if (!declared_ || all_.cols() - rigid <= y_.size()) return;
  SeenSpectrum& out = seen_.emplace();
  out.free = core::full_q(columns_.rigid()).rightCols(y_.size() - rigid);
  out.columns = out.free.transpose() * all_.rightCols(all_.cols() - rigid);
  const auto systematic = out.columns.leftCols(base_ - rigid);
  const auto form = out.columns.rightCols(all_.cols() - base_);
  out.systematic = systematic * systematic.transpose();
  out.form = form * form.transpose();
}

void FormModel::first_state() {
  const double n = static_cast<double>(y_.size());
  coefficients_ = VectorXd::Zero(all_.cols());
  on_.assign(groups_.size(), declared_);
  for (std::size_t g = 0; g < groups_.size() && !declared_; ++g) {
    on_[g] = bands_[groups_[g].band].always ||
             energy_[static_cast<Index>(groups_[g].source)] > 6.0 * noise_mm2_;
  }
  // Least squares of the groups present; a small ridge term separates overlapping columns.
  std::vector<Index> used;
  for (Index k = 0; k < columns_.rigid().cols(); ++k) used.push_back(k);
  for (std::size_t g = 0; g < groups_.size() && !declared_; ++g) {
    if (!on_[g]) continue;
    for (int k = 0; k < groups_[g].width; ++k) used.push_back(groups_[g].first + k);
  }
  const VectorXd products = all_.transpose() * imputed_;
  if (orthogonal()) {
    for (const Index k : used) coefficients_[k] = products[k] / square_[k];
  } else {
    MatrixXd normal = gram_(used, used);
    normal.diagonal().array() += 20.0 * noise_mm2_ / power_mm2_ + 1e-9 * n;
    const VectorXd found = core::solve_llt(normal, VectorXd(products(used)));
    coefficients_(used) = found;
  }
  size_mm2_.assign(bands_.size(), power_mm2_ / 20.0);
  std::vector<double> sums(bands_.size(), 0.0);
  std::vector<int> counts(bands_.size(), 0);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (!on_[g]) continue;
    sums[groups_[g].band] +=
        coefficients_.segment(groups_[g].first, groups_[g].width).squaredNorm();
    counts[groups_[g].band] += groups_[g].width;
  }
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    if (counts[b] > 0 && sums[b] > 0.0) size_mm2_[b] = sums[b] / counts[b];
    size_mm2_[b] = std::max(size_mm2_[b], std::max(bands_[b].least_mm2, 2.0 * noise_mm2_ / n));
  }
  if (declared_) {
    size_mm2_.front() = absolute_ ? 1.0 : power_mm2_ / std::max(spectrum_power_, 1e-300);
  }
}

FormChain::FormChain(const FormModel& model, std::uint64_t seed, std::uint64_t number)
    : model_(model),
      noise_(seed, {kChainStream, number}),
      coefficients_(model.coefficients_),
      form_(model.coefficients_),
      on_(model.on_),
      size_mm2_(model.size_mm2_),
      share_1_(model.bands_.size(), 0.5),
      spot_(model.points(), false),
      candidates_(model.flagged_),
      y_(model.y_),
      noise_mm2_(model.residual_mm2_),
      variance_mm2_(model.residual_mm2_) {
  for (const std::size_t row : candidates_) {
    spot_[row] = true;
    y_[static_cast<Index>(row)] = model.imputed_[static_cast<Index>(row)];
  }
  pull_ = model_.all_.transpose() * y_;
  if (!model_.orthogonal()) pull_ -= model_.gram_ * coefficients_;
  predict();
}

/// Changes a coefficient.
void FormChain::move(Index column, double by) {
  coefficients_[column] += by;
  if (!model_.orthogonal()) pull_ -= by * model_.gram_.col(column);
}

/// X^T times the residual of the other coefficients.
double FormChain::pull(Index column) const {
  if (model_.orthogonal()) return pull_[column];
  return pull_[column] + model_.square_[column] * coefficients_[column];
}

void FormChain::impute(std::size_t row, double value) {
  const Index i = static_cast<Index>(row);
  const double by = value - y_[i];
  if (by == 0.0) return;
  y_[i] = value;
  pull_ += by * model_.all_.row(i).transpose();
}

/// A gamma variate of scale 1. Source: G. Marsaglia, W. W. Tsang, ACM TOMS 26 (2000) 363.
double FormChain::gamma(double shape) {
  if (shape < 1.0) {
    const double u = 1.0 - noise_.uniform();
    return gamma(shape + 1.0) * std::pow(u, 1.0 / shape);
  }
  const double d = shape - 1.0 / 3.0;
  const double c = 1.0 / std::sqrt(9.0 * d);
  for (;;) {
    const double x = noise_.normal();
    const double root = 1.0 + c * x;
    if (root <= 0.0) continue;
    const double v = root * root * root;
    const double u = 1.0 - noise_.uniform();
    if (std::log(u) < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v;
  }
}

/// Lower limit of the variance that a declared spectrum does not contain.
double FormChain::floor_mm2() const {
  if (!model_.declared_) return 0.0;
  return kSpectrumRest * kSpectrumRest * size_mm2_.front() * model_.spectrum_power_;
}

/// Draws the variance of unresolved form, and of the noise where it is not known exactly.
void FormChain::draw_variances() {
  double squares = 0.0;
  double count = 0.0;
  for (Index i = 0; i < y_.size(); ++i) {
    if (spot_[static_cast<std::size_t>(i)]) continue;
    const double rest = y_[i] - prediction_[i];
    squares += rest * rest;
    count += 1.0;
  }
  const double floor = floor_mm2();
  VarianceOdds odds =
      variance_odds({model_.residual_mm2_, model_.freedom_, model_.power_mm2_, floor, model_.flat_},
                    squares, count);
  double left = noise_.uniform();
  std::size_t chosen = 0;
  while (chosen + 1 < odds.size() && (left -= odds[chosen].probability_1) > 0.0) ++chosen;
  noise_mm2_ = odds[chosen].noise_mm2;
  unresolved_mm2_ = floor;
  if (odds[chosen].unresolved_mm2 > 0.0) {
    unresolved_mm2_ +=
        odds[chosen].unresolved_mm2 * std::exp(odds[chosen].log_step * (noise_.uniform() - 0.5));
  }
  variance_mm2_ = noise_mm2_ + unresolved_mm2_;
  scatter_1_ = count > 0.0 ? squares / (count * noise_mm2_) : 1.0;
}

void FormChain::draw_spots() {
  const double w = variance_mm2_;
  if (sweeps_ == kSpotSweep) {
    for (Index i = 0; i < y_.size(); ++i) {
      const double rest = model_.y_[i] - prediction_[i];
      const auto row = static_cast<std::size_t>(i);
      if (rest * rest > kSpotCandidate * kSpotCandidate * w &&
          !std::binary_search(model_.flagged_.begin(), model_.flagged_.end(), row)) {
        candidates_.push_back(row);
      }
    }
  }
  const double per_point = model_.expected_spots_ / static_cast<double>(y_.size());
  for (const std::size_t row : candidates_) {
    const Index i = static_cast<Index>(row);
    const double rest = model_.y_[i] - prediction_[i];
    spot_[row] = noise_.uniform() < 1.0 / (1.0 + std::exp(-spot_log_odds(rest, w, per_point)));
    impute(row, spot_[row] ? prediction_[i] + std::sqrt(w) * noise_.normal() : model_.y_[i]);
  }
}

/// Draws position, size and tilt with a flat prior; systematic errors with their declared size.
void FormChain::draw_rigid() {
  const double w = model_.flat_ ? noise_mm2_ : variance_mm2_;  // a flat form is free of them
  for (Index j = 0; j < model_.base_; ++j) {
    const double known = j < model_.columns_.rigid().cols() ? 0.0 : 1.0;
    const double precision = model_.square_[j] / w + known;
    const double mean = pull(j) / w / precision;
    move(j, mean + noise_.normal() / std::sqrt(precision) - coefficients_[j]);
  }
}

void FormChain::draw_group(std::size_t g) {
  const KeptGroup& group = model_.groups_[g];
  const FormBand& band = model_.bands_[group.band];
  const double w = variance_mm2_;
  const double with = size_mm2_[group.band] + group.extra_mm2;
  const bool was_zero = !on_[g] && group.extra_mm2 == 0.0;
  for (Index j = group.first; !was_zero && j < group.first + group.width; ++j) {
    move(j, -coefficients_[j]);
  }
  bool on = true;
  if (!band.always) {
    const double share = share_1_[group.band];
    double odds = std::log(share / (1.0 - share));
    for (Index j = group.first; j < group.first + group.width; ++j) {
      odds += column_evidence(pull(j), model_.square_[j], w, with);
      if (group.extra_mm2 > 0.0) {
        odds -= column_evidence(pull(j), model_.square_[j], w, group.extra_mm2);
      }
    }
    on = noise_.uniform() < 1.0 / (1.0 + std::exp(-odds));
  }
  on_[g] = on;
  const double size = on ? with : group.extra_mm2;
  for (Index j = group.first; j < group.first + group.width; ++j) {
    form_[j] = 0.0;
    if (size == 0.0) continue;
    const double precision = model_.square_[j] / w + 1.0 / size;
    move(j, pull(j) / w / precision + noise_.normal() / std::sqrt(precision));
  }
}

/// Draws the columns that overlap, all at once.
void FormChain::draw_together() {
  std::vector<Index> used;
  for (Index j = 0; j < model_.base_; ++j) {
    if (model_.joint_[static_cast<std::size_t>(j)]) used.push_back(j);
  }
  for (std::size_t g = 0; g < on_.size(); ++g) {
    const KeptGroup& group = model_.groups_[g];
    if (!on_[g] && group.extra_mm2 == 0.0) continue;
    for (Index j = group.first; j < group.first + group.width; ++j) {
      if (model_.joint_[static_cast<std::size_t>(j)]) used.push_back(j);
    }
  }
  if (used.empty()) return;
  const Index size = static_cast<Index>(used.size());
  MatrixXd precision = model_.gram_(used, used) / variance_mm2_;
  const VectorXd before = coefficients_(used);
  VectorXd right = VectorXd(pull_(used)) / variance_mm2_ + precision * before;
  const Index rigid = model_.columns_.rigid().cols();
  std::size_t g = 0;
  for (Index a = 0; a < size; ++a) {
    const Index j = used[static_cast<std::size_t>(a)];
    if (j < rigid) continue;
    if (j < model_.base_) {
      precision(a, a) += 1.0;
      continue;
    }
    while (j >= model_.groups_[g].first + model_.groups_[g].width) ++g;
    const KeptGroup& group = model_.groups_[g];
    precision(a, a) += 1.0 / ((on_[g] ? size_mm2_[group.band] : 0.0) + group.extra_mm2);
  }
  const Eigen::LLT<MatrixXd> cholesky(precision);
  VectorXd after = cholesky.matrixL().solve(right);
  for (double& value : after) value += noise_.normal();
  after = cholesky.matrixU().solve(after);
  pull_ -= model_.gram_(Eigen::all, used) * (after - before);
  coefficients_(used) = after;
}

/// Draws all columns of a declared spectrum at the cost of a system of as many equations as points:
/// a form drawn beforehand takes up what it leaves of the deviations.
/// Source: A. Bhattacharya, A. Chakraborty, B. Mallick, Biometrika 103 (2016) 985-991.
void FormChain::draw_seen() {
  const SeenSpectrum& seen = *model_.seen_;
  const Index rigid = model_.columns_.rigid().cols();
  const double size = size_mm2_.front();
  const double sigma = std::sqrt(variance_mm2_);
  auto columns = coefficients_.tail(seen.columns.cols());
  VectorXd variances = VectorXd::Constant(columns.size(), size);
  variances.head(model_.base_ - rigid).setOnes();
  for (Index j = 0; j < columns.size(); ++j) columns[j] = std::sqrt(variances[j]) * noise_.normal();
  VectorXd left = seen.free.transpose() * y_ - seen.columns * columns;
  for (double& value : left) value -= sigma * noise_.normal();
  MatrixXd covariance = seen.systematic + size * seen.form;
  covariance.diagonal().array() += variance_mm2_;
  columns += variances.cwiseProduct(seen.columns.transpose() * core::solve_llt(covariance, left));
  const VectorXd rest = y_ - model_.all_.rightCols(columns.size()) * columns;
  const double n = static_cast<double>(y_.size());
  coefficients_.head(rigid) = model_.columns_.rigid().transpose() * rest / n;
  for (double& value : coefficients_.head(rigid)) value += sigma / std::sqrt(n) * noise_.normal();
}

double FormChain::least_size(const FormBand& band) const {
  if (model_.declared_) {
    return 2.0 * variance_mm2_ / static_cast<double>(y_.size()) /
           std::max(model_.spectrum_power_, 1e-300);
  }
  const double error = variance_mm2_ / static_cast<double>(y_.size()) + band.extra_mm2;
  return std::max(2.0 * error, band.least_mm2);
}

void FormChain::draw_bands() {
  std::vector<double> sums(model_.bands_.size(), 0.0);
  std::vector<int> columns(model_.bands_.size(), 0);
  std::vector<int> counts(model_.bands_.size(), 0);
  for (std::size_t g = 0; g < on_.size(); ++g) {
    const KeptGroup& group = model_.groups_[g];
    for (Index j = group.first; j < group.first + group.width; ++j) {
      form_[j] = on_[g] ? coefficients_[j] : 0.0;
      if (!on_[g] || group.extra_mm2 == 0.0) continue;
      const double size = size_mm2_[group.band];
      const double share = size / (size + group.extra_mm2);
      form_[j] = share * coefficients_[j] + std::sqrt(share * group.extra_mm2) * noise_.normal();
    }
    if (!on_[g]) continue;
    ++counts[group.band];
    columns[group.band] += group.width;
    sums[group.band] += form_.segment(group.first, group.width).squaredNorm();
  }
  for (std::size_t b = 0; b < model_.bands_.size(); ++b) {
    const FormBand& band = model_.bands_[b];
    if (band.kept == 0 || model_.absolute_) continue;
    const double least = least_size(band);
    const double most = model_.declared_
                            ? 10.0 * most_size(least, model_.power_mm2_ / model_.spectrum_power_)
                            : most_size(least, model_.power_mm2_);
    double size = 0.0;
    if (counts[b] == 0) {
      size = least * std::pow(most / least, noise_.uniform());
    } else {
      for (int tries = 0; tries < 50; ++tries) {
        size = 0.5 * sums[b] / gamma(0.5 * columns[b]);
        if (size >= least && size <= most) break;
      }
      size = std::clamp(size, least, most);
    }
    size_mm2_[b] = size;
    if (band.always) continue;
    const double one = gamma(band.rareness + counts[b]);
    const double other = gamma(1.0 + band.groups - counts[b]);
    share_1_[b] = std::clamp(one / (one + other), 1e-9, 1.0 - 1e-9);
  }
}

void FormChain::predict() {
  shape_ = VectorXd::Zero(y_.size());
  prediction_ = VectorXd::Zero(y_.size());
  bool shared = false;
  for (Index j = model_.base_; j < coefficients_.size(); ++j) {
    if (form_[j] != 0.0) shape_.noalias() += form_[j] * model_.all_.col(j);
    shared = shared || form_[j] != coefficients_[j];
  }
  prediction_ = shape_;
  for (Index j = 0; shared && j < coefficients_.size(); ++j) {
    if (j < model_.base_) continue;
    const double error = coefficients_[j] - form_[j];
    if (error != 0.0) prediction_.noalias() += error * model_.all_.col(j);
  }
  prediction_.noalias() += model_.all_.leftCols(model_.base_) * coefficients_.head(model_.base_);
}

void FormChain::sweep() {
  draw_variances();
  if (sweeps_ >= kSpotSweep) draw_spots();
  if (model_.seen_) {
    draw_seen();
  } else {
    draw_rigid();
    for (std::size_t g = 0; g < on_.size(); ++g) {
      if (!model_.joint_all_ || !model_.bands_[model_.groups_[g].band].always) draw_group(g);
    }
    draw_together();
  }
  draw_bands();
  predict();
  ++sweeps_;
}

void FormChain::draw_form() {
  const double share = unresolved_mm2_ / variance_mm2_;
  const double spread = std::sqrt(share * noise_mm2_);
  draw_.form_mm = shape_;
  if (share > 0.0) {
    for (Index i = 0; i < y_.size(); ++i) {
      draw_.form_mm[i] += share * (y_[i] - prediction_[i]) + spread * noise_.normal();
    }
  }
  draw_.spots.clear();
  for (const std::size_t row : candidates_) {
    if (!spot_[row]) continue;
    const Index i = static_cast<Index>(row);
    draw_.spots.push_back(row);
    draw_.form_mm[i] =
        model_.y_[i] - model_.all_.row(i).head(model_.base_).dot(coefficients_.head(model_.base_));
  }
  draw_.form_mm.array() /= model_.root_weight_.array();
  const Index rigid = model_.columns_.rigid().cols();
  draw_.place_mm = model_.removed_;
  draw_.place_mm.noalias() += model_.all_.leftCols(rigid) * coefficients_.head(rigid);
  draw_.place_mm.array() /= model_.root_weight_.array();
  draw_.coefficients = VectorXd::Zero(model_.columns_.count());
  draw_.groups = 0;
  for (std::size_t g = 0; g < on_.size(); ++g) {
    const KeptGroup& group = model_.groups_[g];
    if (!on_[g]) continue;
    ++draw_.groups;
    const auto& columns = model_.columns_.groups()[group.source].columns;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      draw_.coefficients[columns[k]] = form_[group.first + static_cast<Index>(k)];
    }
  }
  draw_.unresolved_mm2 = unresolved_mm2_;
  draw_.noise_mm2 = noise_mm2_;
  draw_.scatter_1 = scatter_1_;
}

const FormDraw& FormChain::next() {
  const int more = sweeps_ == 0 ? kWarmUp + 1 : (y_.size() < 1000 ? 2 : 1);
  for (int k = 0; k < more; ++k) sweep();
  draw_form();
  return draw_;
}

}  // namespace rondure::evaluation
