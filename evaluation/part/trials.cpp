#include "evaluation/part/trials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "core/decompositions.h"
#include "core/noise.h"
#include "core/watch.h"
#include "evaluation/part/internal/chart.h"
#include "evaluation/uncertainty/internal/chains.h"
#include "evaluation/uncertainty/internal/error_modes.h"
#include "evaluation/uncertainty/internal/sampler.h"
#include "evaluation/uncertainty/internal/statement.h"
#include "evaluation/uncertainty/kept_draws.h"
#include "fit/least_squares/probe_tip.h"

namespace rondure::evaluation {
namespace {

using core::Code;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

enum Stream : std::uint64_t { kSharedStream = 14, kNoiseStream = 15 };

constexpr std::size_t kReadDraws = 7;  // per chain, of inspections of a drawn part
constexpr std::size_t kBiasDraws = 8;  // per chain, of the bias by place, size and shared errors
constexpr std::uint64_t kMostChains = 64;
// Parts that need more than kWorkOfPart have fewer trials, down to these, of which 5 lie beyond
// each end of a 95 % interval.
constexpr int kLeastTrials = 200;

/// A surface with the model of its form.
struct ModelledSurface {
  Chart chart;
  VectorXd read_mm;  ///< Deviations as read.
  MatrixXd rigid;    ///< rigid_basis() of the chart.
  MatrixXd shared;   ///< Effect of each mode of the part on place and size: columns of `rigid`.
  std::unique_ptr<ErrorModel> errors;
  std::unique_ptr<FormModel> model;
  std::optional<core::Error> fault;  ///< Why its points cannot be moved.
};

/// The parts of the declaration that move the features of a part against one another or change
/// their sizes, as modes of all points. Noise of points and temperature are left to others.
Influences shared_influences(const Influences& declared, const Vector3d& middle_mm) {
  Influences out = declared;
  if (out.probe) {
    out.probe->repeatability_mm = 0.0;
    out.probe->form_limit_mm = 0.0;
    out.probe->tip_radius_mm = 0.0;
  }
  if (out.thermal) {
    out.thermal->temperature_K = 0.0;
    out.thermal->expansion_uncertainty_1_K = 0.0;
  }
  if (out.fixture && !out.fixture->pivot_mm) out.fixture->pivot_mm = middle_mm;
  return out;
}

/// Removes the motion of the part as a whole, which changes no characteristic. Left in, it would
/// add its second order to each.
void without_motion(std::span<const TouchedPoint> points, const Vector3d& middle_mm,
                    std::vector<VectorXd>& columns) {
  const auto count = static_cast<Index>(points.size());
  MatrixXd motions(count, 6);
  for (Index i = 0; i < count; ++i) {
    const TouchedPoint& point = points[static_cast<std::size_t>(i)];
    const Vector3d turned = (point.position_mm - middle_mm).cross(point.normal);
    motions.row(i) << point.normal.transpose(), turned.transpose();
  }
  const MatrixXd basis = core::column_space(motions, 1e-9);
  for (VectorXd& column : columns) {
    column.head(count) -= basis * (basis.transpose() * column.head(count));
  }
}

/// Normal of the reference artefact at a touch.
Vector3d normal_at(const fit::ProbeTip& tip, const Vector3d& touch_mm) {
  const Vector3d away = touch_mm - tip.sphere_center_mm;
  return (away - tip.column_axis.dot(away) * tip.column_axis).normalized();
}

}  // namespace

struct PartTrials::Part {
  std::vector<TrialSurface> surfaces;
  UncertaintyOptions options;
  std::vector<ModelledSurface> modelled;
  DeclaredModes modes;  ///< Shared by all features; their columns are not used any more.
  MatrixXd tip_mm;      ///< Effect of each mode on the tip radius of each surface.

  struct Chain;
  struct Values;
  class Run;

  void make_charts();
  void make_models();
  void make_modes(const ReferenceTouches& reference);
  [[nodiscard]] std::vector<bool> surfaces_of(std::span<const TrialQuestion> questions) const;
  [[nodiscard]] int most_trials(std::span<const TrialQuestion> questions,
                                double pivots_of_trial) const;
  void draw_one(std::span<const TrialQuestion> questions, Chain& chain, Values& out) const;
  void move(std::size_t surface, const VectorXd& deviations_mm,
            std::vector<MeasuredSurface>& part) const;
  [[nodiscard]] std::optional<core::Error> fault_of(const TrialQuestion& question) const;
};

/// Working state of one chain.
struct PartTrials::Part::Chain {
  Chain(const Part& part, const std::vector<bool>& used, std::uint64_t number)
      : shared(part.options.seed, {kSharedStream, number}),
        noise(part.options.seed, {kNoiseStream, number}) {
    for (std::size_t s = 0; s < part.surfaces.size(); ++s) {
      forms.push_back(used[s]
                          ? std::make_unique<FormChain>(*part.modelled[s].model, part.options.seed,
                                                        s * kMostChains + number)
                          : nullptr);
      moved.push_back(part.surfaces[s].measured);
    }
    mirrored = moved;
    center = moved;
    other = moved;
  }

  core::KeyedNoise shared;  ///< For the modes of the part.
  core::KeyedNoise noise;   ///< For simulated inspections and spots.
  std::vector<std::unique_ptr<FormChain>> forms;
  std::vector<MeasuredSurface> moved;
  std::vector<MeasuredSurface> mirrored;  ///< Moved the other way, with the same form.
  std::vector<MeasuredSurface> center;    ///< Not moved, with the same form.
  std::vector<MeasuredSurface> other;
};

/// What one chain found: by question, then by trial.
struct PartTrials::Part::Values {
  std::vector<std::vector<std::vector<double>>> rows_mm;
  std::vector<std::vector<std::vector<double>>> read_mm;
  /// Change of the values by place, size and shared errors, free of what is linear in them.
  std::vector<std::vector<std::vector<double>>> bias_mm;
  std::vector<DrawTally> tallies;  ///< By surface.
  std::size_t done = 0;
  double pivots = 0.0;  ///< Of all searches.

  template <class Chain, class Use>
  requires std::same_as<std::remove_const_t<Chain>, Values>
  friend bool members_of(Chain& c, const Use& use) {
    return use(c.rows_mm, c.read_mm, c.bias_mm, c.tallies, c.done, c.pivots);
  }
};

void PartTrials::Part::make_charts() {
  for (const TrialSurface& surface : surfaces) {
    ModelledSurface& made = modelled.emplace_back();
    const FeatureResult& result = *surface.measured.of;
    if (result.failure) {
      made.fault = result.failure;
      continue;
    }
    auto chart = chart_of(result, surface.rows, surface.measured.tips_mm);
    if (!chart) {
      made.fault = chart.error();
      continue;
    }
    made.chart = *std::move(chart);
    FormCloud& cloud = made.chart.cloud;
    for (FormPoint& point : cloud.points) point.pose = surface.pose;
    if (const auto good = check_cloud(cloud); !good) made.fault = good.error();
  }
  // Drift and creep run through the measurement of the whole part.
  double first_s = std::numeric_limits<double>::infinity();
  double last_s = -first_s;
  const auto touched_feature = [&](std::size_t s) {
    return surfaces[s].measured.of->feature.strategy != record::Strategy::kPointsFile;
  };
  const auto visit = [&](const auto& work) {
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      for (std::size_t i = 0; i < modelled[s].chart.cloud.points.size(); ++i) {
        if (touched_feature(s)) {
          work(surfaces[s].measured.of->cloud[surfaces[s].rows[i]].time_s,
               modelled[s].chart.cloud.points[i]);
        }
      }
    }
  };
  visit([&](double time_s, const FormPoint&) {
    first_s = std::min(first_s, time_s);
    last_s = std::max(last_s, time_s);
  });
  visit([&](double time_s, FormPoint& point) {
    point.time_1 = last_s > first_s ? (time_s - first_s) / (last_s - first_s) : 0.0;
  });
}

void PartTrials::Part::make_models() {
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    ModelledSurface& made = modelled[s];
    if (made.fault) continue;
    const Influences& influences = surfaces[s].influences;
    made.rigid = rigid_basis(made.chart.cloud);
    made.read_mm.resize(made.rigid.rows());
    for (Index i = 0; i < made.read_mm.size(); ++i) {
      made.read_mm[i] = made.chart.cloud.points[static_cast<std::size_t>(i)].deviation_mm;
    }
    made.errors = std::make_unique<ErrorModel>(
        touched_points(made.chart, made.chart.cloud.axis.point_mm), made.rigid, influences);
    if (noise_is_unknown(*made.errors, influences)) {
      made.fault = core::error_of(
          Code::kMeaning, core::phrase("no noise of a touch is known: declare "
                                       "probe.repeatability_um or a form limit, or touch each "
                                       "point twice"));
      continue;
    }
    made.model = std::make_unique<FormModel>(made.chart.cloud, *made.errors, nullptr,
                                             options.expected_spots);
    if (const auto good = guard_outliers(*made.model); !good) made.fault = good.error();
  }
}

void PartTrials::Part::make_modes(const ReferenceTouches& reference) {
  std::vector<Index> first(surfaces.size(), 0);
  Vector3d middle = Vector3d::Zero();
  double count = 0.0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (modelled[s].fault) continue;
    for (const std::size_t row : surfaces[s].rows) middle += surfaces[s].measured.tips_mm[row];
    count += static_cast<double>(surfaces[s].rows.size());
  }
  if (count == 0.0) return;
  middle /= count;
  std::vector<TouchedPoint> points;
  const TrialSurface* any = nullptr;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (modelled[s].fault) continue;
    any = &surfaces[s];
    first[s] = static_cast<Index>(points.size());
    const auto more = touched_points(modelled[s].chart, middle);
    points.insert(points.end(), more.begin(), more.end());
  }
  const std::size_t of_part = points.size();
  const auto qualified = reference.column ? fit::qualify_tip_on_column(reference.tips_mm, 0.0)
                                          : fit::qualify_tip(reference.tips_mm, 0.0);
  for (std::size_t i = 0; qualified && i < reference.tips_mm.size(); ++i) {
    TouchedPoint touch;
    touch.position_mm = reference.tips_mm[i];
    touch.normal = normal_at(*qualified, touch.position_mm);
    touch.approach = -touch.normal;
    touch.pose = -1;
    points.push_back(touch);
  }
  const Influences shared = shared_influences(any->influences, middle);
  modes = declared_modes(points, shared);
  const bool limit =
      shared.machine && shared.machine->length_limit_mm + shared.machine->length_limit_slope > 0.0;
  std::vector<VectorXd> tips;  // of each column, by surface
  const std::span<const TouchedPoint> part_points(points.data(), of_part);
  const std::span<const TouchedPoint> touches = std::span(points).subspan(of_part);
  const VectorXd weights =
      touches.empty() || limit ? VectorXd() : fit::radius_weights(reference.tips_mm, *qualified);
  for (const VectorXd& column : modes.columns) {
    const double radius = weights.size() > 0 ? weights.dot(column.tail(weights.size())) : 0.0;
    tips.push_back(VectorXd::Constant(static_cast<Index>(surfaces.size()), radius));
  }
  const auto add = [&](Distribution distribution, const auto& column_of, const auto& tip_of) {
    modes.modes.push_back({0, distribution, static_cast<Index>(modes.columns.size())});
    VectorXd column = VectorXd::Zero(static_cast<Index>(points.size()));
    VectorXd tip(static_cast<Index>(surfaces.size()));
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      tip[static_cast<Index>(s)] = tip_of(surfaces[s]);
      if (modelled[s].fault) continue;
      for (std::size_t i = 0; i < surfaces[s].rows.size(); ++i) {
        const Index at = first[s] + static_cast<Index>(i);
        column[at] = column_of(surfaces[s], points[static_cast<std::size_t>(at)]);
      }
    }
    modes.columns.push_back(std::move(column));
    tips.push_back(std::move(tip));
  };
  const auto nowhere = [](const TrialSurface&, const TouchedPoint&) { return 0.0; };
  const auto probe = [](const TrialSurface& surface) {
    return surface.influences.probe.value_or(ProbeInfluences());
  };
  if (limit) {
    // The constant of the limit may be an error of the tip as well as one of single touches: a
    // length between opposite touches is then out by twice it, however many points there are.
    // Of the machine, hence of all surfaces; one that no question asks about declares nothing.
    add(Distribution::kRectangular, nowhere, [&](const TrialSurface&) {
      return shared.machine->length_limit_mm / (2.0 * std::sqrt(3.0));
    });
  } else {
    add(Distribution::kNormal, nowhere,
        [&](const TrialSurface& surface) { return probe(surface).tip_radius_mm; });
    add(Distribution::kNormal, nowhere,
        [&](const TrialSurface& surface) { return probe(surface).reference_sphere_mm; });
  }
  add(
      Distribution::kNormal,
      [](const TrialSurface& surface, const TouchedPoint& point) {
        return surface.growth_1 * point.distance_mm;
      },
      [](const TrialSurface& surface) {
        return surface.growth_1 * surface.measured.tip_radius_mm.value_or(0.0);
      });
  without_motion(part_points, middle, modes.columns);
  const auto width = static_cast<Index>(modes.columns.size());
  tip_mm.resize(static_cast<Index>(surfaces.size()), width);
  for (Index k = 0; k < width; ++k) tip_mm.col(k) = tips[static_cast<std::size_t>(k)];
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    ModelledSurface& made = modelled[s];
    if (made.fault) continue;
    made.shared.resize(made.rigid.cols(), width);
    for (Index k = 0; k < width; ++k) {
      const VectorXd& column = modes.columns[static_cast<std::size_t>(k)];
      made.shared.col(k) = made.rigid.transpose() * column.segment(first[s], made.rigid.rows());
    }
  }
}

PartTrials::PartTrials(std::vector<TrialSurface> surfaces, const ReferenceTouches& reference,
                       const UncertaintyOptions& options) {
  auto part = std::make_unique<Part>();
  part->surfaces = std::move(surfaces);
  part->options = options;
  part->make_charts();
  part->make_models();
  part->make_modes(reference);
  part_ = std::move(part);
}

PartTrials::~PartTrials() = default;

std::optional<core::Error> PartTrials::Part::fault_of(const TrialQuestion& question) const {
  for (const std::size_t s : question.surfaces) {
    if (modelled[s].fault) return modelled[s].fault;
  }
  return std::nullopt;
}

std::vector<bool> PartTrials::Part::surfaces_of(std::span<const TrialQuestion> questions) const {
  std::vector<bool> out(surfaces.size(), false);
  for (const TrialQuestion& question : questions) {
    if (fault_of(question)) continue;
    for (const std::size_t s : question.surfaces) out[s] = true;
  }
  return out;
}

int PartTrials::Part::most_trials(std::span<const TrialQuestion> questions,
                                  double pivots_of_trial) const {
  double work = 0.0;
  for (const TrialQuestion& question : questions) {
    if (fault_of(question)) continue;
    work += kPointsOfCall;
    for (const std::size_t s : question.surfaces) {
      work += static_cast<double>(surfaces[s].rows.size());
    }
  }
  if (work == 0.0) return 0;
  work += kPointsOfPivot * pivots_of_trial;
  const double most = std::max(kWorkOfPart / work, static_cast<double>(kLeastTrials));
  return static_cast<int>(std::min(most, static_cast<double>(options.most_trials)));
}

/// Puts the points of a surface where deviations say.
void PartTrials::Part::move(std::size_t surface, const VectorXd& deviations_mm,
                            std::vector<MeasuredSurface>& part) const {
  const Chart& chart = modelled[surface].chart;
  const MeasuredSurface& measured = surfaces[surface].measured;
  for (std::size_t i = 0; i < chart.normals.size(); ++i) {
    const std::size_t row = surfaces[surface].rows[i];
    const double by = deviations_mm[static_cast<Index>(i)] - chart.cloud.points[i].deviation_mm;
    part[surface].tips_mm[row] = measured.tips_mm[row] + by * chart.normals[i];
  }
}

void PartTrials::Part::draw_one(std::span<const TrialQuestion> questions, Chain& chain,
                                Values& out) const {
  const VectorXd z = drawn_coefficients(modes, chain.shared);
  const bool inspect = out.done < kReadDraws;
  const bool mirror = out.done < kBiasDraws;
  ++out.done;
  std::vector<bool> spots(surfaces.size(), false);
  VectorXd errors;
  std::vector<VectorXd> inspected(surfaces.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (!chain.forms[s]) continue;
    const ModelledSurface& made = modelled[s];
    const FormDraw& draw = chain.forms[s]->next();
    out.tallies[s].add(draw);
    VectorXd deviations = draw.place_mm + draw.form_mm;
    if (inspect) {
      made.errors->draw(chain.noise, std::nullopt, errors);
      inspected[s] = deviations + errors;
    }
    deviations -= made.rigid * (made.shared * z);
    move(s, deviations, chain.moved);
    if (const auto& tip = surfaces[s].measured.tip_radius_mm) {
      const double by = tip_mm.row(static_cast<Index>(s)).dot(z);
      chain.moved[s].tip_radius_mm = chain.other[s].tip_radius_mm = *tip - by;
      chain.mirrored[s].tip_radius_mm = *tip + by;
    }
    if (mirror) {
      const VectorXd change = draw.place_mm + draw.form_mm - made.read_mm;
      const VectorXd center =
          made.read_mm + change - made.rigid * (made.rigid.transpose() * change);
      move(s, center, chain.center);
      move(s, 2.0 * center - deviations, chain.mirrored);
    }
    // See chains.cpp: noise has raised the maximum of competing spots once; raising it once more
    // and reflecting removes that.
    spots[s] = !draw.spots.empty();
    for (const std::size_t row : draw.spots) {
      const auto i = static_cast<Index>(row);
      deviations[i] += std::sqrt(made.errors->point_variance_mm2()[i]) * chain.noise.normal();
    }
    move(s, deviations, chain.other);
  }
  const PartState moved(chain.moved);
  const PartState raised(chain.other);
  const PartState mirrored(chain.mirrored);
  const PartState center(chain.center);
  for (std::size_t q = 0; q < questions.size(); ++q) {
    if (fault_of(questions[q])) continue;
    std::vector<double> row = questions[q].values(moved);
    const auto& on = questions[q].surfaces;
    if (std::any_of(on.begin(), on.end(), [&](std::size_t s) { return spots[s]; })) {
      const std::vector<double> other = questions[q].values(raised);
      for (std::size_t v = 0; v < row.size(); ++v) row[v] -= other[v] - row[v];
    } else if (mirror) {
      std::vector<double> bias = questions[q].values(mirrored);
      const std::vector<double> middle = questions[q].values(center);
      for (std::size_t v = 0; v < row.size(); ++v) bias[v] = 0.5 * (row[v] + bias[v]) - middle[v];
      out.bias_mm[q].push_back(std::move(bias));
    }
    out.rows_mm[q].push_back(std::move(row));
  }
  out.pivots += moved.pivots() + raised.pivots() + mirrored.pivots() + center.pivots();
  if (!inspect) return;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (!chain.forms[s]) continue;
    move(s, inspected[s], chain.other);
    chain.other[s].tip_radius_mm = surfaces[s].measured.tip_radius_mm;
  }
  const PartState read(chain.other);
  for (std::size_t q = 0; q < questions.size(); ++q) {
    if (!fault_of(questions[q])) out.read_mm[q].push_back(questions[q].values(read));
  }
}

namespace {

/// The values in one place of the rows of a chain.
std::vector<double> column_of(const std::vector<std::vector<double>>& rows, std::size_t place) {
  std::vector<double> out;
  out.reserve(rows.size());
  for (const std::vector<double>& row : rows) out.push_back(row[place]);
  return out;
}

std::vector<double> joined_chains(const std::vector<std::vector<double>>& chains) {
  std::vector<double> out;
  for (const std::vector<double>& chain : chains) out.insert(out.end(), chain.begin(), chain.end());
  return out;
}

/// A value less its bias. No bias makes a deviation negative.
double without_bias(double value_mm, double bias_mm) {
  return value_mm >= 0.0 ? std::max(value_mm - bias_mm, 0.0) : value_mm - bias_mm;
}

double tolerance_of(const std::vector<std::vector<double>>& chains, double coverage) {
  const std::vector<std::span<const double>> spans(chains.begin(), chains.end());
  return numerical_tolerance_mm(spans, coverage);
}

}  // namespace

/// The chains of a part at work on some questions.
class PartTrials::Part::Run {
 public:
  Run(const Part& part, std::span<const TrialQuestion> questions)
      : part_(part), questions_(questions) {
    const std::vector<bool> used = part.surfaces_of(questions);
    for (int k = 0; k < part.options.chains; ++k) {
      chains_.push_back(std::make_unique<Chain>(part, used, static_cast<std::uint64_t>(k)));
      Values& values = values_.emplace_back();
      values.rows_mm.resize(questions.size());
      values.read_mm.resize(questions.size());
      values.bias_mm.resize(questions.size());
      values.tallies.resize(part.surfaces.size());
      for (std::size_t s = 0; s < part.surfaces.size(); ++s) {
        values.tallies[s].spot_counts.assign(part.surfaces[s].rows.size(), 0);
      }
    }
  }

  /// Draws until the numbers are stable. Source: JCGM 101 section 7.9.
  void draw() {
    if (part_.most_trials(questions_, 0.0) == 0) return;
    draw_or_take(
        values_,
        [this](const Values& found, const Values& first) { return is_whole(found, first); },
        [this] { draw_all(); });
    reached_ = part_.options.tolerance_mm > 0.0 && is_stable();
  }

  [[nodiscard]] TrialAnswer answer(std::size_t q) const {
    TrialAnswer out;
    const TrialQuestion& question = questions_[q];
    const auto refused = [&](const core::Error& why) {
      out.values.assign(question.read_mm.size(), core::fail(why));
      return out;
    };
    if (const auto fault = part_.fault_of(question)) return refused(*fault);
    UncertaintyResult common;
    for (const std::size_t s : question.surfaces) {
      auto finding = finding_of_surface(s, common.notes);
      if (!finding) return refused(finding.error());
      if (s == question.surfaces.front()) common.finding = *std::move(finding);
    }
    common.declaration = influence_statements(part_.surfaces[question.surfaces.front()].influences);
    for (std::size_t v = 0; v < question.read_mm.size(); ++v) {
      common.uncorrected_mm = question.read_mm[v];
      out.values.push_back(value(q, v, common));
    }
    for (const Values& chain : values_) {
      out.rows_mm.insert(out.rows_mm.end(), chain.rows_mm[q].begin(), chain.rows_mm[q].end());
    }
    for (std::size_t v = 0; v < question.read_mm.size(); ++v) {
      const double bias = bias_mm(q, v);
      for (std::vector<double>& row : out.rows_mm) row[v] = without_bias(row[v], bias);
    }
    return out;
  }

 private:
  /// Whether kept draws have all rows that are read.
  [[nodiscard]] bool is_whole(const Values& found, const Values& first) const {
    const Values& empty = values_.front();
    bool whole =
        found.done > 0 && found.done == first.done && found.tallies.size() == empty.tallies.size();
    for (std::size_t s = 0; whole && s < found.tallies.size(); ++s) {
      whole = found.tallies[s].spot_counts.size() == empty.tallies[s].spot_counts.size();
    }
    for (const auto* all : {&found.rows_mm, &found.read_mm, &found.bias_mm}) {
      whole = whole && all->size() == questions_.size();
      for (std::size_t q = 0; whole && q < all->size(); ++q) {
        const bool counted = all != &found.rows_mm || part_.fault_of(questions_[q]);
        whole = (counted || (*all)[q].size() == found.done) &&
                std::ranges::all_of((*all)[q], [&](const std::vector<double>& row) {
                  return row.size() == questions_[q].read_mm.size();
                });
      }
    }
    return whole;
  }
  void draw_all() {
    const UncertaintyOptions& options = part_.options;
    const auto each = [&](int trials) {
      return (static_cast<std::size_t>(trials) + chains_.size() - 1) / chains_.size();
    };
    std::size_t most = each(part_.most_trials(questions_, 0.0));
    // The first trials show what the searches take.
    const std::size_t first = std::min(each(kLeastTrials), most);
    core::watch().expect(most * chains_.size());
    more(first);
    double pivots = 0.0;
    for (const Values& chain : values_) pivots += chain.pivots;
    const auto trials = static_cast<double>(first * chains_.size());
    most = std::max(first, each(part_.most_trials(questions_, pivots / trials)));
    core::watch().expect((most - first) * chains_.size());
    const std::size_t least = std::min(each(options.least_trials), most);
    more(std::max(first, options.tolerance_mm > 0.0 ? least : most) - first);
    while (options.tolerance_mm > 0.0 && !is_stable()) {
      const std::size_t done = values_.front().done;
      if (done >= most) break;
      more(std::min(std::max<std::size_t>(least / 2, 1), most - done));
    }
  }

  [[nodiscard]] bool is_stable() const {
    return chains_.size() > 1 && worst_tolerance_mm() <= part_.options.tolerance_mm;
  }

  void more(std::size_t each) {
    in_parallel(threads_of(part_.options), chains_.size(),
                [&](std::size_t first, std::size_t last) {
                  for (std::size_t k = first; k < last; ++k) {
                    for (std::size_t t = 0; t < each; ++t) {
                      part_.draw_one(questions_, *chains_[k], values_[k]);
                      core::watch().drawn();
                    }
                  }
                });
  }

  /// Bias of a value in the trials. Nothing is known of place and size but the points, so that a
  /// trial adds to them once more the errors that are in the points: a distance, or the greatest of
  /// several, grows each time by as much. Source: B. Efron, R. Tibshirani 1993 (bootstrap).
  [[nodiscard]] double bias_mm(std::size_t q, std::size_t v) const {
    double sum = 0.0;
    double count = 0.0;
    for (const Values& chain : values_) {
      for (const std::vector<double>& row : chain.bias_mm[q]) {
        if (!std::isfinite(row[v])) continue;
        sum += row[v];
        count += 1.0;
      }
    }
    return count > 0.0 ? sum / count : 0.0;
  }

  /// The trials of a value without their bias, chain by chain.
  [[nodiscard]] std::vector<std::vector<double>> trials(std::size_t q, std::size_t v) const {
    const double bias = bias_mm(q, v);
    std::vector<std::vector<double>> out;
    for (const Values& chain : values_) {
      std::vector<double>& one = out.emplace_back(column_of(chain.rows_mm[q], v));
      for (double& value : one) value = without_bias(value, bias);
    }
    return out;
  }

  [[nodiscard]] double worst_tolerance_mm() const {
    double worst = 0.0;
    for (std::size_t q = 0; q < questions_.size(); ++q) {
      if (part_.fault_of(questions_[q])) continue;
      for (std::size_t v = 0; v < questions_[q].read_mm.size(); ++v) {
        const auto chains = trials(q, v);
        if (!check_values(joined_chains(chains))) continue;
        worst = std::max(worst, tolerance_of(chains, part_.options.coverage));
      }
    }
    return worst;
  }

  [[nodiscard]] core::Result<FormFinding> finding_of_surface(
      std::size_t s, std::vector<core::Phrase>& notes) const {
    std::vector<DrawTally> tallies;
    for (const Values& chain : values_) tallies.push_back(chain.tallies[s]);
    const std::size_t points = part_.surfaces[s].rows.size();
    FormFinding out = finding_of(tallies, points);
    std::vector<core::Phrase> said;
    TRY_DO(guard_scatter(tallies, part_.modelled[s].chart.cloud, out, said));
    for (core::Phrase& note : said) {
      if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
    }
    for (std::size_t& row : out.spot_rows) row = part_.surfaces[s].rows[row];
    return out;
  }

  [[nodiscard]] core::Result<UncertaintyResult> value(std::size_t q, std::size_t v,
                                                      UncertaintyResult out) const {
    if (!std::isfinite(out.uncorrected_mm)) {
      return core::fail(Code::kReferenceAbsent, core::phrase("there is no value"));
    }
    const double coverage = part_.options.coverage;
    const auto chains = trials(q, v);
    std::vector<double> all = joined_chains(chains);
    TRY_DO(check_values(all));
    out.trials = static_cast<int>(all.size());
    out.tolerance_reached = reached_;
    out.sampled = statement_of(std::move(all), coverage);
    out.sampled.numerical_tolerance_mm = tolerance_of(chains, coverage);
    out.noise_inflation_mm = out.uncorrected_mm - out.sampled.estimate_mm;
    std::vector<double> read;
    for (const Values& chain : values_) {
      for (const std::vector<double>& row : chain.read_mm[q]) read.push_back(row[v]);
    }
    TRY_DO(guard_reading(std::move(read), out.uncorrected_mm));
    return out;
  }

  const Part& part_;
  std::span<const TrialQuestion> questions_;
  std::vector<std::unique_ptr<Chain>> chains_;
  std::vector<Values> values_;
  bool reached_ = false;
};

std::vector<TrialAnswer> PartTrials::answers(std::span<const TrialQuestion> questions) const {
  std::vector<TrialAnswer> out(questions.size());
  if (const auto good = check_options(part_->options); !good) {
    for (std::size_t q = 0; q < questions.size(); ++q) {
      out[q].values.assign(questions[q].read_mm.size(), core::fail(good.error()));
    }
    return out;
  }
  Part::Run run(*part_, questions);
  run.draw();
  for (std::size_t q = 0; q < questions.size(); ++q) out[q] = run.answer(q);
  return out;
}

double share_within(const TrialAnswer& answer, std::span<const Limits> limits) {
  if (answer.rows_mm.empty()) return 0.0;
  std::size_t held = 0;
  for (const std::vector<double>& row : answer.rows_mm) {
    bool all = row.size() == limits.size();
    for (std::size_t v = 0; all && v < row.size(); ++v) all = limits[v].hold(row[v]);
    if (all) ++held;
  }
  return static_cast<double>(held) / static_cast<double>(answer.rows_mm.size());
}

}  // namespace rondure::evaluation
