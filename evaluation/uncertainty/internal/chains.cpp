#include "evaluation/uncertainty/internal/chains.h"
#include "core/watch.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <thread>

namespace rondure::evaluation {
namespace {

enum Stream : std::uint64_t { kValueStream = 12, kErrorStream = 13 };

constexpr std::size_t kErrorDraws = 50;  // per chain, of errors on a perfect form
constexpr std::size_t kReadDraws = 7;    // per chain, of inspections of a drawn form

}  // namespace

void in_parallel(int threads, std::size_t count,
                 const std::function<void(std::size_t, std::size_t)>& work) {
  const auto parts = std::min(static_cast<std::size_t>(std::max(1, threads)), count);
  std::vector<std::jthread> others;
  for (std::size_t k = 1; k < parts; ++k) {
    const std::size_t first = count * k / parts;
    const std::size_t last = count * (k + 1) / parts;
    try {
      others.emplace_back([&work, first, last] { work(first, last); });
    } catch (const std::system_error&) {
      work(first, last);
    }
  }
  if (parts > 0) work(0, count / parts);
}

/// Working state of one chain.
struct FormChains::Chain {
  Chain(const FormCloud& cloud, const FormModel& model, const std::optional<WholeExtent>& extent,
        std::uint64_t seed, std::uint64_t number)
      : forms(model, seed, number),
        noise(seed, {kValueStream, number}),
        errors(seed, {kErrorStream, number}),
        value(cloud, cloud.points) {
    if (extent) {
      whole.emplace(cloud, model.columns(), extent->low_mm, extent->high_mm, extent->declared);
    }
  }

  FormChain forms;
  core::KeyedNoise noise;   ///< For values.
  core::KeyedNoise errors;  ///< For simulated inspections.
  FormValue value;
  std::optional<WholeSurface> whole;
  Eigen::VectorXd changed = {};
};

FormChains::FormChains(const FormCloud& cloud, const ErrorModel& errors, const FormModel& model,
                       const std::optional<WholeExtent>& whole, std::uint64_t seed, int chains,
                       int threads)
    : errors_(errors), threads_(threads) {
  ChainValues empty;
  empty.changes_mm.resize(errors.names().size());
  empty.tally.spot_counts.assign(cloud.points.size(), 0);
  for (int k = 0; k < chains; ++k) {
    chains_.push_back(
        std::make_unique<Chain>(cloud, model, whole, seed, static_cast<std::uint64_t>(k)));
    values_.push_back(empty);
  }
  Eigen::VectorXd deviations(static_cast<Eigen::Index>(cloud.points.size()));
  for (Eigen::Index i = 0; i < deviations.size(); ++i) {
    deviations[i] = cloud.points[static_cast<std::size_t>(i)].deviation_mm;
  }
  uncorrected_ = chains_.front()->value.of(deviations);
}

FormChains::~FormChains() = default;

void FormChains::run(std::size_t each, std::size_t budget) {
  in_parallel(threads_, chains_.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      for (std::size_t t = 0; t < each; ++t) draw_one(*chains_[k], values_[k], budget);
    }
  });
}

/// Change of the value of a drawn form by each influence alone.
void FormChains::change(Chain& chain, const FormDraw& draw, double value, ChainValues& out) const {
  for (std::size_t influence = 0; influence < out.changes_mm.size(); ++influence) {
    if (!errors_.acts(influence)) continue;
    errors_.draw(chain.errors, influence, chain.changed);
    chain.changed += draw.form_mm;
    out.changes_mm[influence].push_back(chain.value.of(chain.changed) - value);
  }
}

void FormChains::draw_one(Chain& chain, ChainValues& out, std::size_t budget) const {
  core::watch().drawn();
  const std::size_t done = out.sampled_mm.size();
  const FormDraw& draw = chain.forms.next();
  const double value = chain.value.of(draw.form_mm);
  // Where several spots compete for the extreme, noise has already raised their maximum. Raising it
  // once more and reflecting removes that to first order (B. Efron, R. Tibshirani 1993).
  double raise = 0.0;
  if (!draw.spots.empty()) {
    chain.changed = draw.form_mm;
    for (const std::size_t row : draw.spots) {
      const auto i = static_cast<Eigen::Index>(row);
      chain.changed[i] += std::sqrt(errors_.point_variance_mm2()[i]) * chain.noise.normal();
    }
    raise = chain.value.of(chain.changed) - value;
  }
  out.sampled_mm.push_back(value - raise);
  if (chain.whole) {
    out.whole_mm.push_back(std::max(value, chain.whole->of(draw, chain.noise)) - raise);
  }
  out.tally.add(draw);
  if (done < kReadDraws) {
    errors_.draw(chain.errors, std::nullopt, chain.changed);
    chain.changed += draw.form_mm;
    out.read_mm.push_back(chain.value.of(chain.changed));
  }
  if (done < kErrorDraws) {
    errors_.draw(chain.errors, std::nullopt, chain.changed);
    out.of_errors_mm.push_back(chain.value.of(chain.changed));
  }
  if (done < budget) change(chain, draw, value, out);
}

}  // namespace rondure::evaluation
