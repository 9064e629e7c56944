#include "evaluation/uncertainty/internal/columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "core/decompositions.h"
#include "core/units.h"
#include "fit/geometry/points.h"

namespace rondure::evaluation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostResolved = 150;    // undulations of a closed section
constexpr int kMostHalfWaves = 300;   // along an arc
constexpr int kMostAlong = 3;         // degree
constexpr int kMostAlongLow = 12;     // for 0 and 1 undulations: each layer may have its own size
constexpr int kMostScattered = 5;     // where there are no layers
constexpr int kMostOrder = 20;        // powers of both sides of a face, together
constexpr int kFewOfLayer = 12;       // points whose alternation is a form of its own
constexpr double kOnePhase = 0.98;    // correlation, squared, of cosine and sine at the points
constexpr double kLeastLeft = 1e-3;   // norm of a column after removing position, size and tilt
constexpr double kLeastOnArc = 0.05;  // cosines of an arc are nearly motions

/// Directions of the sides of the rectangle of least area that holds all points. One of its sides
/// is a side of their hull.
Eigen::Matrix2d sides_of(const std::vector<Eigen::Vector2d>& points) {
  const auto hull = fit::convex_hull(points);
  Eigen::Matrix2d best = Eigen::Matrix2d::Identity();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d side = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    Eigen::Matrix2d sides;
    sides << side, Eigen::Vector2d(-side.y(), side.x());
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : hull) box.extend(Eigen::Vector2d(sides.transpose() * p));
    if (box.volume() >= (1.0 - 1e-9) * least) continue;
    least = box.volume();
    best = sides;
  }
  return best;
}

/// Phases at which the points see so many undulations: of high, low, high, low there is one.
std::vector<bool> phases_seen(const VectorXd& angles_rad, int undulations) {
  const Eigen::ArrayXd turned = static_cast<double>(undulations) * angles_rad.array();
  const double cc = turned.cos().square().sum();
  const double ss = turned.sin().square().sum();
  const double cs = (turned.cos() * turned.sin()).sum();
  const bool both =
      cs * cs < kOnePhase * cc * ss && std::min(cc, ss) > (1.0 - kOnePhase) * (cc + ss);
  return both ? std::vector<bool>{false, true} : std::vector<bool>{ss > cc};
}

int octave_of(double undulations) {
  return undulations < 2.0 ? 0 : static_cast<int>(std::floor(std::log2(undulations)));
}

int class_of(int degree) { return degree == 0 ? 0 : (degree <= 2 ? 1 : 2); }

}  // namespace

FormColumns::FormColumns(const FormCloud& cloud, const VectorXd& root_weights)
    : layout_(layout_of(cloud, root_weights)), root_weight_(root_weights) {
  make_rigid(cloud, root_weights);
  const bool section = cloud.kind == FormKind::kRoundness;
  const bool plane = cloud.kind == FormKind::kFlatness && !layout_.arc_rad;
  const bool open = layout_.arc_rad.has_value();
  if (plane && !layout_.layered) {
    make_sides();
    return;
  }
  const int highest = open ? std::min(kMostHalfWaves, layout_.points_per_layer - 1)
                           : std::min(kMostResolved, (layout_.points_per_layer - 1) / 2);
  // Layers of few points tell by each other that they are alternately high and low: an oval at
  // four.
  const int even = layout_.points_per_layer;
  const bool alternate = !section && !plane && !open && layout_.layered && layout_.layers > 1 &&
                         even % 2 == 0 && even >= 4 && even <= kFewOfLayer;
  const auto degrees_of = [&](int harmonic) {
    if (section) return 0;
    if (!layout_.layered) return std::min(layout_.layers - 1, kMostScattered);
    return std::min(layout_.layers - 1, harmonic <= 1 ? kMostAlongLow : kMostAlong);
  };
  make_polynomials(heights_1(height_mm_), degrees_of(0));
  if (plane) radial_1_ = height_mm_ / height_mm_.maxCoeff();
  std::vector<Column> wanted;
  for (int j = 0; j <= highest; ++j) {
    for (int d = 0; d <= std::min<int>(degrees_of(j), static_cast<int>(along_.cols()) - 1); ++d) {
      const bool moves = d <= (section || plane ? 0 : 1);
      if (!open && (j + d == 0 || (j == 1 && moves))) continue;
      wanted.push_back({j, d, false, 1.0, {}});
      if (!open && j > 0) wanted.push_back({j, d, true, 1.0, {}});
    }
  }
  for (int d = 0;
       alternate && d <= std::min(degrees_of(even / 2), static_cast<int>(along_.cols()) - 1); ++d) {
    for (const bool sine : phases_seen(layout_.angle, even / 2))
      wanted.push_back({even / 2, d, sine, 1.0, {}});
  }
  project(std::move(wanted));
}

FormColumns::FormColumns(const FormCloud& cloud, const VectorXd& root_weights,
                         const FormSpectrum& spectrum)
    : layout_(layout_of(cloud, root_weights)), root_weight_(root_weights), legendre_(true) {
  layout_.arc_rad.reset();  // terms of a spectrum are undulations of the full turn
  layout_.regular = false;
  make_rigid(cloud, root_weights);
  middle_mm_ = 0.5 * (spectrum.low_mm + spectrum.high_mm);
  reach_mm_ = 0.5 * (spectrum.high_mm - spectrum.low_mm);
  for (Index i = 0; i < layout_.angle.size(); ++i) {
    layout_.angle[i] = cloud.points[static_cast<std::size_t>(i)].angle_rad;
  }
  int degrees = 0;
  std::vector<FormTerm> terms = spectrum.terms;
  std::erase_if(terms, [](const FormTerm& term) { return term.amplitude_mm == 0.0; });
  std::stable_sort(terms.begin(), terms.end(), [](const FormTerm& a, const FormTerm& b) {
    return a.undulations < b.undulations;
  });
  for (const FormTerm& term : terms) degrees = std::max(degrees, term.degree);
  recurrence_.resize(degrees, 2);
  along_ = root_weight_.asDiagonal() * polynomials(heights_1(height_mm_));
  for (const FormTerm& term : terms) {
    FormGroup group;
    group.undulations = group.harmonic = term.undulations;
    group.degree = term.degree;
    for (const bool sine : {false, true}) {
      if (sine && term.undulations == 0) continue;
      group.columns.push_back(count());
      columns_.push_back({term.undulations, term.degree, sine, term.amplitude_mm, {}});
    }
    groups_.push_back(std::move(group));
    most_undulations_ = std::max(most_undulations_, term.undulations);
    most_degree_ = std::max(most_degree_, term.degree);
  }
}

void FormColumns::make_rigid(const FormCloud& cloud, const VectorXd& root_weights) {
  sections_ = cloud.kind == FormKind::kSections;
  const Index n = static_cast<Index>(cloud.points.size());
  for (const FormPoint& p : cloud.points) middle_mm_ += p.height_mm / static_cast<double>(n);
  for (const FormPoint& p : cloud.points) {
    reach_mm_ = std::max(reach_mm_, std::abs(p.height_mm - middle_mm_));
  }
  height_mm_.resize(n);
  for (Index i = 0; i < n; ++i) {
    height_mm_[i] = cloud.points[static_cast<std::size_t>(i)].height_mm;
  }
  const core::ThinQr qr = core::thin_qr(root_weights.asDiagonal() * rigid_motions(cloud));
  const double root_n = std::sqrt(static_cast<double>(n));
  rigid_ = qr.q * root_n;
  rigid_map_ = root_n * core::inverse_lu(qr.r);
}

VectorXd FormColumns::heights_1(const VectorXd& heights_mm) const {
  if (reach_mm_ == 0.0) return VectorXd::Zero(heights_mm.size());
  return (heights_mm.array() - middle_mm_) / reach_mm_;
}

/// Polynomials orthonormal over the points (recurrence of Stieltjes): Legendre polynomials are not
/// orthonormal at, say, four heights.
void FormColumns::make_polynomials(const VectorXd& q, int degrees) {
  recurrence_ = MatrixXd::Zero(degrees, 2);
  VectorXd before = VectorXd::Zero(q.size());
  VectorXd now = VectorXd::Ones(q.size());
  double scale = 0.0;
  for (Index d = 0; d < degrees; ++d) {
    const double shift = q.cwiseProduct(now).dot(now) / now.squaredNorm();
    VectorXd next = (q.array() - shift).matrix().cwiseProduct(now) - scale * before;
    const double size = std::sqrt(next.squaredNorm() / static_cast<double>(q.size()));
    if (size < 1e-6) {  // no further distinct heights
      recurrence_.conservativeResize(d, 2);
      break;
    }
    recurrence_.row(d) << shift, size;
    before = now;
    now = next / size;
    scale = size;
  }
  along_ = root_weight_.asDiagonal() * polynomials(q);
}

/// Of a plane: r^k times polynomials in r^2, as a smooth surface has them about its middle, made
/// orthonormal over the points. A bow, a saddle is one column then, and a tilt is none.
/// Source: F. Zernike, Physica 1 (1934) 689-704.
MatrixXd FormColumns::radial_polynomials(int undulations) const {
  if (radial_1_.size() == 0) return {};
  MatrixXd out(radial_1_.size(), along_.cols());
  VectorXd next = radial_1_.array().pow(undulations);
  for (Index d = 0; d < out.cols(); ++d) {
    for (int pass = 0; pass < 2; ++pass) {
      for (Index b = 0; b < d; ++b)
        next -= out.col(b).dot(next) / out.col(b).squaredNorm() * out.col(b);
    }
    const double size = std::sqrt(next.squaredNorm() / static_cast<double>(next.size()));
    out.col(d) = size > 1e-12 ? VectorXd(next / size) : VectorXd::Zero(next.size());
    next = out.col(d).cwiseProduct(radial_1_.cwiseAbs2());
  }
  return root_weight_.asDiagonal() * out;
}

MatrixXd FormColumns::polynomials(const VectorXd& q) const {
  MatrixXd out(q.size(), recurrence_.rows() + 1);
  out.col(0).setOnes();
  for (Index d = 0; d < recurrence_.rows(); ++d) {
    VectorXd next;
    if (legendre_) {
      const double k = static_cast<double>(d);
      next = (2.0 * k + 1.0) / (k + 1.0) * q.cwiseProduct(out.col(d));
      if (d > 0) next -= k / (k + 1.0) * out.col(d - 1);
    } else {
      next = (q.array() - recurrence_(d, 0)).matrix().cwiseProduct(out.col(d));
      if (d > 0) next -= recurrence_(d - 1, 1) * out.col(d - 1);
      next /= recurrence_(d, 1);
    }
    out.col(d + 1) = next;
  }
  return out;
}

/// Of a face without circles: products of polynomials along its sides up to one order, about half
/// as many as there are points. A bow, a twist of a machined face is one column then.
void FormColumns::make_sides() {
  const auto n = static_cast<Index>(layout_.angle.size());
  std::vector<Eigen::Vector2d> points;
  for (Index i = 0; i < n; ++i)
    points.emplace_back(height_mm_[i] * std::cos(layout_.angle[i]),
                        height_mm_[i] * std::sin(layout_.angle[i]));
  const Eigen::Matrix2d sides = sides_of(points);
  const int order =
      std::clamp(static_cast<int>(std::sqrt(static_cast<double>(n))) - 1, 2, kMostOrder);
  for (Index k = 0; k < 2; ++k) {
    VectorXd along(n);
    for (Index i = 0; i < n; ++i) along[i] = sides.col(k).dot(points[static_cast<std::size_t>(i)]);
    make_polynomials(along / height_mm_.maxCoeff(), order);
    sides_[static_cast<std::size_t>(k)] = along_;
  }
  sides_[1].array().colwise() /= root_weight_.array();
  std::vector<Column> wanted;
  for (int a = 0; a < sides_[0].cols(); ++a) {
    for (int b = 0; b < sides_[1].cols() && a + b <= order; ++b) {
      if (a + b > 1) wanted.push_back({a, b, false, 1.0, {}});
    }
  }
  project(std::move(wanted));
}

void FormColumns::visit(const std::function<void(std::size_t, const VectorXd&)>& work) const {
  if (sides_[0].size() > 0) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      work(k, sides_[0].col(columns_[k].harmonic).cwiseProduct(sides_[1].col(columns_[k].degree)));
    }
    return;
  }
  const VectorXd step_c = layout_.angle.array().cos();
  const VectorXd step_s = layout_.angle.array().sin();
  VectorXd c = VectorXd::Ones(layout_.angle.size());
  VectorXd s = VectorXd::Zero(layout_.angle.size());
  VectorXd turned(layout_.angle.size());
  VectorXd column(layout_.angle.size());
  int harmonic = 0;
  MatrixXd radial = radial_polynomials(0);
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const Column& wanted = columns_[k];
    for (; harmonic < wanted.harmonic; ++harmonic) {
      turned = c.cwiseProduct(step_c) - s.cwiseProduct(step_s);
      s = s.cwiseProduct(step_c) + c.cwiseProduct(step_s);
      c = turned;
      if (harmonic + 1 == wanted.harmonic) radial = radial_polynomials(wanted.harmonic);
    }
    const MatrixXd& along = radial.size() > 0 ? radial : along_;
    column = (wanted.sine ? s : c).cwiseProduct(along.col(wanted.degree));
    work(k, column);
  }
}

/// Removes position, size and tilt from the columns, drops those with nothing left, and groups the
/// others.
void FormColumns::project(std::vector<Column> wanted) {
  const double n = static_cast<double>(rigid_.rows());
  const double least = layout_.arc_rad ? kLeastOnArc : kLeastLeft;
  columns_ = std::move(wanted);
  std::vector<bool> kept(columns_.size());
  visit([&](std::size_t k, const VectorXd& raw) {
    const VectorXd moved = rigid_.transpose() * raw / n;
    const double all = raw.squaredNorm();
    const double left = all - n * moved.squaredNorm();
    kept[k] = left > least * least * all && all > 0.0;
    if (!kept[k]) return;
    columns_[k].rigid = moved;
    columns_[k].scale = std::sqrt(n / left);
  });
  std::vector<Column> good;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    if (!kept[k]) continue;
    const Column& column = columns_[k];
    const bool same = !good.empty() && good.back().harmonic == column.harmonic &&
                      good.back().degree == column.degree;
    if (!same) {
      FormGroup group;
      group.harmonic = column.harmonic;
      group.degree = column.degree;
      const bool face = sides_[0].size() > 0;
      group.undulations = face              ? column.harmonic + column.degree
                          : layout_.arc_rad ? column.harmonic * std::numbers::pi / *layout_.arc_rad
                                            : static_cast<double>(column.harmonic);
      group.octave = octave_of(group.undulations);
      group.degree_class = face ? 0 : class_of(column.degree);
      groups_.push_back(std::move(group));
    }
    groups_.back().columns.push_back(static_cast<Index>(good.size()));
    most_undulations_ = std::max(most_undulations_, column.harmonic);
    most_degree_ = std::max(most_degree_, column.degree);
    good.push_back(column);
  }
  columns_ = std::move(good);
}

VectorXd FormColumns::products(const VectorXd& values) const {
  const VectorXd moved = rigid_.transpose() * values;
  VectorXd out(count());
  visit([&](std::size_t k, const VectorXd& raw) {
    const Column& column = columns_[k];
    double product = raw.dot(values);
    if (column.rigid.size() > 0) product -= column.rigid.dot(moved);
    out[static_cast<Index>(k)] = column.scale * product;
  });
  return out;
}

MatrixXd FormColumns::matrix(std::span<const std::size_t> groups) const {
  std::vector<Index> place(columns_.size(), -1);
  Index width = 0;
  for (const std::size_t g : groups) {
    for (const Index k : groups_[g].columns) place[static_cast<std::size_t>(k)] = width++;
  }
  MatrixXd out(rigid_.rows(), width);
  const double n = static_cast<double>(rigid_.rows());
  visit([&](std::size_t k, const VectorXd& raw) {
    if (place[k] < 0) return;
    auto column = out.col(place[k]);
    column = raw;
    if (columns_[k].rigid.size() > 0) {
      column -= rigid_ * columns_[k].rigid;
      column -= rigid_ * (rigid_.transpose() * column / n);
    }
    column *= columns_[k].scale;
  });
  return out;
}

FormGrid FormColumns::grid(int undulations, int angles, const VectorXd& heights_mm) const {
  FormGrid out;
  out.undulations = undulations;
  out.angles_rad = VectorXd::LinSpaced(angles + 1, 0.0, core::kTwoPi).head(angles);
  out.heights_mm = heights_mm;
  out.heights_1 = heights_1(heights_mm);
  out.along = polynomials(out.heights_1);
  out.cosines.resize(angles, std::max(1, undulations) + 1);
  out.sines = out.cosines;
  for (Index k = 0; k < out.cosines.cols(); ++k) {
    const VectorXd turned = static_cast<double>(k) * out.angles_rad;
    out.cosines.col(k) = turned.array().cos();
    out.sines.col(k) = turned.array().sin();
  }
  return out;
}

MatrixXd FormColumns::on_grid(const VectorXd& coefficients, const FormGrid& grid) const {
  // For each height the cosines and sines; position, size and tilt are among those of 0 and 1
  // undulations.
  MatrixXd cosines = MatrixXd::Zero(grid.cosines.cols(), grid.heights_mm.size());
  MatrixXd sines = cosines;
  VectorXd moved = VectorXd::Zero(rigid_.cols());
  std::vector<bool> used(static_cast<std::size_t>(cosines.rows()), false);
  used[0] = used[1] = true;
  for (Index k = 0; k < count(); ++k) {
    if (coefficients[k] == 0.0) continue;
    const Column& column = columns_[static_cast<std::size_t>(k)];
    const double size = column.scale * coefficients[k];
    (column.sine ? sines : cosines).row(column.harmonic) +=
        size * grid.along.col(column.degree).transpose();
    used[static_cast<std::size_t>(column.harmonic)] = true;
    if (column.rigid.size() > 0) moved += size * column.rigid;
  }
  const VectorXd motion = rigid_map_ * moved;
  if (sections_) {  // a height each, with a place of its own
    for (Index h = 0; h < cosines.cols(); ++h) {
      cosines(0, h) -= motion[3 * h];
      cosines(1, h) -= motion[3 * h + 1];
      sines(1, h) -= motion[3 * h + 2];
    }
  } else {
    cosines.row(0).array() -= motion[0];
    cosines.row(1).array() -= motion[1];
    sines.row(1).array() -= motion[2];
  }
  if (!sections_ && motion.size() == 5) {
    cosines.row(1) -= motion[3] * grid.heights_1.transpose();
    sines.row(1) -= motion[4] * grid.heights_1.transpose();
  }
  MatrixXd out = MatrixXd::Zero(grid.angles_rad.size(), grid.heights_mm.size());
  for (Index k = 0; k < cosines.rows(); ++k) {
    if (!used[static_cast<std::size_t>(k)]) continue;
    out.noalias() += grid.cosines.col(k) * cosines.row(k);
    if (k > 0) out.noalias() += grid.sines.col(k) * sines.row(k);
  }
  return out;
}

}  // namespace rondure::evaluation
