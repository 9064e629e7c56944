#include "reports/form_trials.h"

#include <algorithm>
#include <system_error>
#include <thread>

namespace rondure::reports {
namespace {

/// Streams of random numbers.
enum Stream : std::uint64_t { kErrors = 1, kSampledForm = 2, kWholeForm = 3, kOneInfluence = 4 };

}  // namespace

void in_parallel(int threads, std::size_t count,
                 const std::function<void(std::size_t, std::size_t, std::size_t)>& work) {
  const auto parts = static_cast<std::size_t>(std::max(1, threads));
  std::vector<std::jthread> others;
  for (std::size_t k = 1; k < parts; ++k) {
    const std::size_t first = count * k / parts;
    const std::size_t last = count * (k + 1) / parts;
    try {
      others.emplace_back([&work, k, first, last] { work(k, first, last); });
    } catch (const std::system_error&) {
      work(k, first, last);
    }
  }
  work(0, 0, count / parts);
}

FormTrials::FormTrials(const FormCloud& cloud, const ErrorModel& errors,
                       const std::optional<FormSpectrum>& spectrum, std::uint64_t seed, int threads)
    : errors_(errors), sampled_form_(cloud, errors), seed_(seed) {
  if (spectrum) whole_form_.emplace(cloud, errors, *spectrum);
  for (int k = 0; k < std::max(1, threads); ++k) {
    Desk desk{FormValue(cloud, cloud.points), std::nullopt};
    if (whole_form_) desk.whole.emplace(cloud, whole_form_->places());
    desks_.push_back(std::move(desk));
  }
  Eigen::VectorXd deviations(static_cast<Eigen::Index>(cloud.points.size()));
  for (Eigen::Index i = 0; i < deviations.size(); ++i) {
    deviations[i] = cloud.points[static_cast<std::size_t>(i)].deviation_mm;
  }
  uncorrected_ = desks_.front().sampled.of(deviations);
}

void FormTrials::sampled_form(std::size_t trial, Desk& desk) const {
  core::KeyedNoise errors(seed_, {kErrors, trial});
  errors_.draw(errors, std::nullopt, desk.errors);
  core::KeyedNoise noise(seed_, {kSampledForm, trial});
  const double size = sampled_form_.size().quantile(noise.uniform());
  sampled_form_.draw(noise, size, desk.errors, desk.form);
}

/// After sampled_form() of the same trial: it meets the same errors.
void FormTrials::whole_form(std::size_t trial, Desk& desk) const {
  core::KeyedNoise noise(seed_, {kWholeForm, trial});
  const double size = whole_form_->size().quantile(noise.uniform());
  whole_form_->draw(noise, size, desk.errors, desk.form);
}

void FormTrials::run(std::size_t count) {
  const std::size_t done = sampled_.size();
  sampled_.resize(done + count);
  if (whole_form_) whole_.resize(done + count);
  in_parallel(static_cast<int>(desks_.size()), count,
              [&](std::size_t thread, std::size_t first, std::size_t last) {
                Desk& desk = desks_[thread];
                for (std::size_t t = done + first; t < done + last; ++t) {
                  sampled_form(t, desk);
                  sampled_[t] = desk.sampled.of(desk.form);
                  if (!whole_form_) continue;
                  whole_form(t, desk);
                  whole_[t] = desk.whole->of(desk.form);
                }
              });
}

/// One trial's part of changes().
void FormTrials::change(std::size_t trial, Desk& desk,
                        std::vector<std::vector<double>>& changes) const {
  sampled_form(trial, desk);
  for (std::size_t influence = 0; influence < changes.size(); ++influence) {
    if (changes[influence].empty()) continue;
    core::KeyedNoise noise(seed_, {kOneInfluence, trial, influence});
    errors_.draw(noise, influence, desk.errors);
    desk.changed = desk.form + desk.errors;
    changes[influence][trial] = desk.sampled.of(desk.changed) - sampled_[trial];
  }
}

std::vector<std::vector<double>> FormTrials::changes(std::size_t count) {
  const std::size_t kept = std::min(count, sampled_.size());
  std::vector<std::vector<double>> changes(errors_.names().size());
  for (std::size_t k = 0; k < changes.size(); ++k) {
    if (errors_.acts(k)) changes[k].resize(kept);
  }
  in_parallel(static_cast<int>(desks_.size()), kept,
              [&](std::size_t thread, std::size_t first, std::size_t last) {
                for (std::size_t t = first; t < last; ++t) change(t, desks_[thread], changes);
              });
  return changes;
}

}  // namespace rondure::reports
