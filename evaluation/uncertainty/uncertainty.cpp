#include "evaluation/uncertainty/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/statistics.h"
#include "core/units.h"
#include "core/watch.h"
#include "evaluation/uncertainty/internal/chains.h"
#include "evaluation/uncertainty/internal/statement.h"
#include "evaluation/uncertainty/kept_draws.h"

namespace rondure::evaluation {
namespace {

using core::Code;

using ValuesOf = std::vector<double> ChainValues::*;

std::vector<double> all_of(const FormChains& chains, ValuesOf values) {
  std::vector<double> out;
  for (const ChainValues& chain : chains.values()) {
    out.insert(out.end(), (chain.*values).begin(), (chain.*values).end());
  }
  return out;
}

double left_open(const FormChains& chains, ValuesOf values, double coverage) {
  std::vector<std::span<const double>> all;
  for (const ChainValues& chain : chains.values()) all.emplace_back(chain.*values);
  return numerical_tolerance_mm(all, coverage);
}

core::Result<void> check_all(const FormCloud& cloud, const Influences& influences,
                             const std::optional<FormSpectrum>& spectrum,
                             const UncertaintyOptions& options) {
  if (const auto good = check_cloud(cloud); !good) return good;
  if (const auto good = check_influences(influences); !good) return good;
  if (spectrum && !spectrum->terms.empty()) {
    if (const auto good = check_spectrum(*spectrum, cloud.kind); !good) return good;
  }
  return check_options(options);
}

core::Result<void> check_all_values(const FormChains& chains) {
  if (auto good = check_values(all_of(chains, &ChainValues::sampled_mm)); !good) return good;
  return check_values(all_of(chains, &ChainValues::whole_mm));
}

constexpr std::size_t kManyPoints = 20'000;
constexpr int kTrialsOfMany = 1000;

/// Whether more draws would change no printed number.
bool is_stable(const FormChains& chains, const UncertaintyOptions& options) {
  const double worst = std::max(left_open(chains, &ChainValues::sampled_mm, options.coverage),
                                left_open(chains, &ChainValues::whole_mm, options.coverage));
  return options.chains > 1 && worst <= options.tolerance_mm;
}

/// Draws until the numbers are stable. Source: JCGM 101 section 7.9.
void draw_chains(FormChains& chains, const UncertaintyOptions& options, std::size_t points) {
  const int most_asked =
      points > kManyPoints ? std::min(options.most_trials, kTrialsOfMany) : options.most_trials;
  const auto each = [&](int trials) {
    return static_cast<std::size_t>((trials + options.chains - 1) / options.chains);
  };
  const std::size_t most = each(most_asked);
  const std::size_t least = std::min(each(options.least_trials), most);
  const std::size_t budget = options.budget_trials > 0 ? each(options.budget_trials) : 0;
  core::watch().expect(most * static_cast<std::size_t>(options.chains));
  chains.run(options.tolerance_mm > 0.0 ? least : most, budget);
  while (options.tolerance_mm > 0.0 && check_all_values(chains) && !is_stable(chains, options)) {
    const std::size_t done = chains.values().front().sampled_mm.size();
    if (done >= most) break;
    chains.run(std::min(std::max<std::size_t>(least / 2, 1), most - done), budget);
  }
}

core::Result<UncertaintyResult> run_chains(FormChains& chains, const UncertaintyOptions& options,
                                           std::size_t points) {
  const ChainValues empty = chains.values().front();
  const auto is_whole = [&](const ChainValues& chain, const ChainValues& first) {
    return !chain.sampled_mm.empty() && chain.sampled_mm.size() == first.sampled_mm.size() &&
           chain.whole_mm.size() == first.whole_mm.size() &&
           (chain.whole_mm.empty() || chain.whole_mm.size() == chain.sampled_mm.size()) &&
           chain.changes_mm.size() == empty.changes_mm.size() &&
           chain.tally.spot_counts.size() == points;
  };
  draw_or_take(chains.values(), is_whole, [&] { draw_chains(chains, options, points); });
  TRY_DO(check_all_values(chains));
  UncertaintyResult out;
  out.tolerance_reached = options.tolerance_mm > 0.0 && is_stable(chains, options);
  out.uncorrected_mm = chains.uncorrected_mm();
  out.sampled = statement_of(all_of(chains, &ChainValues::sampled_mm), options.coverage);
  out.sampled.numerical_tolerance_mm =
      left_open(chains, &ChainValues::sampled_mm, options.coverage);
  out.noise_inflation_mm = out.uncorrected_mm - out.sampled.estimate_mm;
  if (!chains.values().front().whole_mm.empty()) {
    out.whole = statement_of(all_of(chains, &ChainValues::whole_mm), options.coverage);
    out.whole->measurand = Measurand::kWholeSurface;
    out.whole->numerical_tolerance_mm = left_open(chains, &ChainValues::whole_mm, options.coverage);
    out.sampling_loss_mm = out.sampled.estimate_mm - out.whole->estimate_mm;
  }
  out.trials = static_cast<int>(out.sampled.values_mm.size());
  return out;
}

// quantile of the inflation that the declared errors can produce
constexpr double kErrorLimit = 0.975;

std::vector<DrawTally> tallies_of(const FormChains& chains) {
  std::vector<DrawTally> out;
  for (const ChainValues& chain : chains.values()) out.push_back(chain.tally);
  return out;
}

tl::unexpected<core::Error> void_interval(Code code, core::Phrase why) {
  return core::fail(code, std::move(why));
}

/// Checks that the correction is not larger than the declared errors can produce.
core::Result<void> guard_correction(const FormChains& chains, const UncertaintyResult& found) {
  std::vector<double> errors = all_of(chains, &ChainValues::of_errors_mm);
  std::erase_if(errors, [](double value) { return !std::isfinite(value); });
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const auto rank = static_cast<std::size_t>(kErrorLimit * static_cast<double>(errors.size()));
  const double most = errors[std::min(rank, errors.size() - 1)];
  // Round-off of the fits is not a correction.
  if (found.noise_inflation_mm <= most + 1e-6) return {};
  return void_interval(Code::kInconsistent,
                       core::phrase("the correction of {:.3g} um is more than the declared errors "
                                    "can make ({:.3g} um): no interval is stated",
                                    1e3 * found.noise_inflation_mm, 1e3 * most));
}

core::Result<std::vector<BudgetLine>> budget_of(const FormChains& chains, const ErrorModel& errors,
                                                const UncertaintyOptions& options) {
  std::vector<BudgetLine> budget;
  if (options.budget_trials == 0) return budget;
  for (std::size_t k = 0; k < errors.names().size(); ++k) {
    std::vector<double> changes;
    for (const ChainValues& chain : chains.values()) {
      changes.insert(changes.end(), chain.changes_mm[k].begin(), chain.changes_mm[k].end());
    }
    TRY_DO(check_values(changes));
    BudgetLine line;
    line.name = errors.names()[k];
    if (!changes.empty()) {
      line.shift_mm = core::mean(changes);
      line.standard_uncertainty_mm = core::standard_deviation(changes, line.shift_mm);
    }
    budget.push_back(line);
  }
  const std::vector<double> whole = all_of(chains, &ChainValues::whole_mm);
  if (!whole.empty()) {  // uncertainty of the form between the points
    std::vector<double> loss = all_of(chains, &ChainValues::sampled_mm);
    for (std::size_t t = 0; t < loss.size(); ++t) loss[t] -= whole[t];
    BudgetLine line;
    line.name = "sampling";
    line.measurand = Measurand::kWholeSurface;
    line.shift_mm = core::mean(loss);
    line.standard_uncertainty_mm = core::standard_deviation(loss, line.shift_mm);
    budget.push_back(line);
  }
  share_out(budget);
  return budget;
}

constexpr int kDenseLayers = 3;
constexpr int kDensePoints = 14;  // per layer

/// The ends of the surface; kSampling where a cloud cannot show its own spectrum.
core::Result<std::optional<WholeExtent>> extent_of(const FormCloud& cloud, const FormModel& model,
                                                   const std::optional<FormSpectrum>& spectrum) {
  if (!spectrum) return std::optional<WholeExtent>();
  WholeExtent out;
  out.low_mm = spectrum->low_mm;
  out.high_mm = spectrum->high_mm;
  out.declared = !spectrum->terms.empty();
  if (out.declared) return std::optional<WholeExtent>(out);
  const PointLayout& layout = model.columns().layout();
  const bool section = cloud.kind == FormKind::kRoundness || cloud.kind == FormKind::kSections;
  if (!layout.layered || layout.arc_rad || (!section && layout.layers < kDenseLayers) ||
      layout.points_per_layer < kDensePoints) {
    const int layers = section ? 1 : kDenseLayers;
    return void_interval(
        Code::kSampling,
        layout.arc_rad
            ? core::phrase("{} layers of {} points on a part of the turn do not tell the form "
                           "between them: {} layers of {} points, all the way round, at least; or "
                           "declare a form spectrum",
                           layout.layers, layout.points_per_layer, layers, kDensePoints)
            : core::phrase("{} layers of {} points do not tell the form between them: {} layers of "
                           "{} points, all the way round, at least; or declare a form spectrum",
                           layout.layers, layout.points_per_layer, layers, kDensePoints));
  }
  if (section) return std::optional<WholeExtent>(out);
  const auto [low, high] = std::minmax_element(
      cloud.points.begin(), cloud.points.end(),
      [](const FormPoint& a, const FormPoint& b) { return a.height_mm < b.height_mm; });
  out.low_mm = low->height_mm;
  out.high_mm = high->height_mm;
  return std::optional<WholeExtent>(out);
}

/// "own undulations 0..13 and degrees 0..3 of 4 layers, 112 points; rougher form up to 39".
core::Phrase source_of(const FormModel& model, const FormSpectrum& spectrum) {
  if (!spectrum.terms.empty()) return spectrum.source;
  const FormColumns& columns = model.columns();
  return core::phrase(
      "what {} points in {} layers show: up to {} undulations and degree {}; what they do not "
      "resolve, up to {} undulations",
      model.points(), columns.layout().layers, columns.most_undulations(), columns.most_degree(),
      3 * columns.most_undulations());
}

/// Without known noise there is no interval, only bounds. The lower one counts everything that the
/// model does not follow as noise.
tl::unexpected<core::Error> only_bounds(const FormCloud& cloud, const Influences& influences,
                                        const FormModel& model, const UncertaintyOptions& options) {
  core::Phrase why = core::phrase(
      "no noise of a touch is known: declare probe.repeatability_um or a form limit, or touch each "
      "point twice");
  Influences all_noise = influences;
  all_noise.probe = influences.probe.value_or(ProbeInfluences{});
  all_noise.probe->repeatability_mm = model.residual_mm();
  if (all_noise.probe->repeatability_mm > 0.0) {
    const ErrorModel errors(cloud, all_noise);
    const FormModel lowest(cloud, errors, nullptr, options.expected_spots);
    FormChains chains(cloud, errors, lowest, std::nullopt, options.seed, 1, 1);
    chains.run(200, 0);
    const double low = core::mean(chains.values().front().sampled_mm);
    why =
        core::phrase("{}; the value lies between {:.2f} and {:.2f} um, without a probability", why,
                     1e3 * std::min(low, chains.uncorrected_mm()), 1e3 * chains.uncorrected_mm());
  }
  return void_interval(Code::kMeaning, std::move(why));
}

}  // namespace

core::Result<UncertaintyResult> measurement_uncertainty(const FormCloud& cloud,
                                                        const Influences& influences,
                                                        const std::optional<FormSpectrum>& spectrum,
                                                        const UncertaintyOptions& options) {
  TRY_DO(check_all(cloud, influences, spectrum, options));
  const ErrorModel errors(cloud, influences);
  const bool declared = spectrum && !spectrum->terms.empty();
  const FormModel model(cloud, errors, declared ? &*spectrum : nullptr, options.expected_spots);
  if (noise_is_unknown(errors, influences)) return only_bounds(cloud, influences, model, options);
  TRY_DO(guard_outliers(model));
  TRY(const auto extent, extent_of(cloud, model, spectrum));
  FormChains chains(cloud, errors, model, extent, options.seed, options.chains,
                    threads_of(options));
  auto found = run_chains(chains, options, cloud.points.size());
  if (!found) return found;
  UncertaintyResult& out = *found;
  const std::vector<DrawTally> tallies = tallies_of(chains);
  out.finding = finding_of(tallies, cloud.points.size());
  TRY_DO(guard_scatter(tallies, cloud, out.finding, out.notes));
  // The bound holds where the value is a seminorm of the deviations.
  const bool two_sided = cloud.reference == record::Reference::kMinimumZone ||
                         cloud.reference == record::Reference::kLeastSquares;
  if (two_sided) {
    TRY_DO(guard_correction(chains, out));
  }
  TRY_DO(guard_reading(all_of(chains, &ChainValues::read_mm), out.uncorrected_mm));
  TRY(out.budget, budget_of(chains, errors, options));
  out.declaration = influence_statements(influences);
  if (spectrum) out.spectrum_source = source_of(model, *spectrum);
  return found;
}

core::Result<Eigen::VectorXd> simulated_deviations(const FormCloud& nominal,
                                                   const ErrorModel& errors,
                                                   const FormSpectrum& spectrum,
                                                   std::uint64_t seed) {
  TRY_DO(check_all(nominal, Influences{}, spectrum, {}));
  const Eigen::MatrixXd columns = spectrum_columns(spectrum, nominal.points);
  core::KeyedNoise noise(seed, {0});
  Eigen::VectorXd deviations;
  errors.draw(noise, std::nullopt, deviations);
  for (Eigen::Index k = 0; k < columns.cols(); ++k) deviations += noise.normal() * columns.col(k);
  const Eigen::MatrixXd rigid = rigid_basis(nominal);
  return deviations - rigid * (rigid.transpose() * deviations);
}

}  // namespace rondure::evaluation
