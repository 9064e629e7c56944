#include "evaluation/uncertainty/internal/whole_surface.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace rondure::evaluation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kGridPerUndulation = 8;  // parabolas then find a crest within 1 %
constexpr int kLeastHeights = 13;
// unresolved form ends at this multiple of the resolved undulations
constexpr int kUnresolvedReach = 3;
constexpr int kWaves = 32;  // number of waves that represent unresolved form

/// Refines crests and troughs round each section with parabolas through three places.
void refine_crests(MatrixXd& surface) {
  const Index n = surface.rows();
  const MatrixXd raw = surface;
  for (Index h = 0; h < surface.cols(); ++h) {
    for (Index i = 0; i < n; ++i) {
      const double here = raw(i, h);
      const double before = raw(i == 0 ? n - 1 : i - 1, h);
      const double after = raw(i == n - 1 ? 0 : i + 1, h);
      const double bend = 2.0 * here - before - after;
      const bool crest = here >= before && here >= after;
      const bool trough = here <= before && here <= after;
      if (bend == 0.0 || !(crest || trough)) continue;
      surface(i, h) = here + (after - before) * (after - before) / (8.0 * bend);
    }
  }
}

}  // namespace

WholeSurface::WholeSurface(const FormCloud& cloud, const FormColumns& columns, double low_mm,
                           double high_mm, bool declared)
    : cloud_(cloud), columns_(columns), declared_(declared) {
  const bool section = cloud.kind == FormKind::kRoundness;
  const int heights = section ? 1 : std::max(kLeastHeights, 2 * columns.most_degree() + 1);
  undulations_ = (declared ? 1 : kUnresolvedReach) * std::max(1, columns.most_undulations());
  heights_mm_ = VectorXd::LinSpaced(heights, low_mm, section ? low_mm : high_mm);
  if (cloud.kind == FormKind::kSections) {
    heights_mm_.resize(cloud.points.back().section + 1);
    for (const FormPoint& point : cloud.points) heights_mm_[point.section] = point.height_mm;
  }
}

WholeSurface::Level& WholeSurface::level_for(int undulations) {
  for (Level& level : levels_) {
    if (level.grid.undulations >= undulations) return level;
  }
  int fine = 15;
  while (fine < undulations) fine *= 2;
  fine = std::min(fine, std::max(15, undulations_));
  Level level;
  level.grid = columns_.grid(fine, kGridPerUndulation * fine, heights_mm_);
  std::vector<FormPoint> places;
  for (Index h = 0; h < heights_mm_.size(); ++h) {
    for (const double angle_rad : level.grid.angles_rad) {
      FormPoint place;
      place.angle_rad = angle_rad;
      place.height_mm = heights_mm_[h];
      if (cloud_.kind == FormKind::kSections) place.section = static_cast<int>(h);
      places.push_back(place);
    }
  }
  places.insert(places.end(), cloud_.points.begin(), cloud_.points.end());
  level.value = std::make_unique<FormValue>(cloud_, places);
  const auto place = std::find_if(levels_.begin(), levels_.end(), [&](const Level& other) {
    return other.grid.undulations > fine;
  });
  return *levels_.insert(place, std::move(level));
}

/// Form rougher than the columns: waves beyond them, their variances falling as 1 / k^2.
void WholeSurface::add_waves(const FormDraw& draw, core::KeyedNoise& noise, const FormGrid& grid,
                             MatrixXd& surface) const {
  const int first = columns_.most_undulations() + 1;
  const int last = undulations_;
  const double amplitude_mm = std::sqrt(2.0 * draw.unresolved_mm2 / kWaves);
  for (int wave = 0; wave < kWaves; ++wave) {
    // The inverse of the sum of 1 / k^2, approximated by an integral.
    const double u = noise.uniform();
    const double k = 1.0 / ((1.0 - u) / (first - 0.5) + u / (last + 0.5));
    const double turns =
        std::clamp(std::round(k), static_cast<double>(first), static_cast<double>(last));
    const double phase = core::kTwoPi * noise.uniform();
    const Index degree =
        std::min(static_cast<Index>(noise.uniform() *
                                    static_cast<double>(std::min<Index>(4, grid.along.cols()))),
                 grid.along.cols() - 1);
    surface.noalias() += amplitude_mm * (turns * grid.angles_rad.array() + phase).cos().matrix() *
                         grid.along.col(degree).transpose();
  }
}

double WholeSurface::of(const FormDraw& draw, core::KeyedNoise& noise) {
  int undulations = 2;
  for (const FormGroup& group : columns_.groups()) {
    if (draw.coefficients[group.columns.front()] != 0.0) {
      undulations = std::max(undulations, group.harmonic);
    }
  }
  const bool rough = !declared_ && draw.unresolved_mm2 > 0.0;
  if (rough) undulations = undulations_;
  Level& level = level_for(undulations);
  MatrixXd surface = columns_.on_grid(draw.coefficients, level.grid);
  if (rough) add_waves(draw, noise, level.grid, surface);
  refine_crests(surface);
  all_mm_.resize(surface.size() + draw.form_mm.size());
  all_mm_ << surface.reshaped(), draw.form_mm;
  return level.value->of(all_mm_);
}

}  // namespace rondure::evaluation
