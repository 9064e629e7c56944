// Shafts with planted deviations: every characteristic against its definition (methods, drawing
// sections 2 to 5), computed here from the points or from the planted surface.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/results/finding.h"
#include "fit/geometry/axis.h"
#include "tests/core/full.h"
#include "tests/evaluation/drawing_part.h"
#include "tests/evaluation/points_run.h"
#include "tests/evaluation/shaft_oracle.h"

namespace rondure::evaluation {
namespace {

using record::Characteristic;
using record::Form;
using record::Reference;
using record::Shape;
using record::Side;
using Indication = record::Indication;
using Association = Indication::Association;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::Layers;
using test::shaft::about;
using test::shaft::cheapest;
using test::shaft::extreme;
using test::shaft::Fitted;
using test::shaft::Generatrix;
using test::shaft::Least;
using test::shaft::least_cylinder;
using test::shaft::least_squares;
using test::shaft::least_width;
using test::shaft::Line;
using test::shaft::Oracle;
using test::shaft::Points;
using test::shaft::radii_about;
using test::shaft::range;
using test::shaft::regression;
using test::shaft::root_mean_square;
using test::shaft::Round;
using test::shaft::round_zone;
using test::shaft::square_to;
using test::shaft::tilted;
using test::shaft::Turned;

constexpr double kDefinition = 1e-9;  // mm
/// An answer that compare_extremes() has.
constexpr double kElsewhere = std::numeric_limits<double>::quiet_NaN();

// ---- The questions, with their answers.

struct PlantedQuestion {
  Characteristic asked;
  std::vector<double> judged;
  std::vector<double> local = {};  // every section or circle, in any order; empty: not looked at
};

class Questions {
 public:
  PlantedQuestion& add(const std::string& id, Form form, std::vector<double> judged,
                       Reference reference = Reference::kLeastSquares) {
    PlantedQuestion& out = all_.emplace_back();
    out.asked.id = id;
    out.asked.form = form;
    out.asked.reference = reference;
    out.judged = std::move(judged);
    return out;
  }
  /// The worst of several.
  PlantedQuestion& worst(const std::string& id, Form form, const std::vector<double>& local,
                         Reference reference = Reference::kLeastSquares) {
    PlantedQuestion& out =
        add(id, form, {*std::max_element(local.begin(), local.end())}, reference);
    out.local = local;
    return out;
  }
  [[nodiscard]] const std::vector<PlantedQuestion>& all() const { return all_; }
  [[nodiscard]] std::vector<Characteristic> asked() const {
    std::vector<Characteristic> out;
    for (const auto& question : all_) out.push_back(question.asked);
    return out;
  }

 private:
  std::vector<PlantedQuestion> all_;
};

constexpr Reference kReferences[] = {Reference::kLeastSquares, Reference::kMinimumZone,
                                     Reference::kMinimumCircumscribed,
                                     Reference::kMaximumInscribed};
constexpr Indication::Parameter kParameters[] = {
    Indication::Parameter::kPeak, Indication::Parameter::kValley, Indication::Parameter::kRms};

std::string words(const std::string& name, auto word) {
  return name + " " + std::string(record::name_of(word));
}

void ask_sizes(const Oracle& of, Questions& out) {
  using Size = Indication::Size;
  using Rank = Indication::Rank;
  for (const Size size : {Size::kGG, Size::kGN, Size::kGX, Size::kGC}) {
    const bool least_squares_size = size == Size::kGG;
    out.add(words("d", size), Form::kDiameter,
            {least_squares_size ? of.size(of.all, 4, size) : kElsewhere})
        .asked.indication.size = size;
    if (size == Size::kGX) {
      auto& any = out.add("d ACS GX", Form::kDiameter, {kElsewhere, kElsewhere});
      any.asked.indication.size = size;
      any.asked.indication.section = Indication::Section::kACS;
      continue;
    }
    std::vector<double> sections;
    for (const auto& layer : of.layers) sections.push_back(of.size(layer, 2, size));
    auto& any = out.add(words("d ACS", size), Form::kDiameter,
                        {*std::max_element(sections.begin(), sections.end()),
                         *std::min_element(sections.begin(), sections.end())});
    any.local = sections;
    any.asked.indication.size = size;
    any.asked.indication.section = Indication::Section::kACS;
    auto& second = out.add(words("d SCS", size), Form::kDiameter, {sections[1], sections[1]});
    second.asked.indication.size = size;
    second.asked.indication.section = Indication::Section::kSCS;
    second.asked.indication.section_layers = {2.0};
  }
  for (const Rank rank :
       {Rank::kSX, Rank::kSN, Rank::kSA, Rank::kSM, Rank::kSD, Rank::kSR, Rank::kSQ}) {
    out.add(words("d", rank), Form::kDiameter, {of.rank(rank)}).asked.indication.rank = rank;
  }
  out.add("d LP", Form::kDiameter, {of.rank(Rank::kSX), of.rank(Rank::kSN)});
  const bool inside = of.side < 0.0;
  auto& envelope = out.add("d E", Form::kDiameter, {});
  envelope.asked.indication.requirement = Indication::Requirement::kEnvelope;
  envelope.judged = {kElsewhere, of.rank(inside ? Rank::kSX : Rank::kSN)};
}

void ask_form(const Oracle& of, Questions& out) {
  const Round cylinder = least_squares({of.all}, of.axis, 4);
  for (const Reference reference : kReferences) {
    const bool ls = reference == Reference::kLeastSquares;
    out.add(words("CYLt", reference), Form::kCylindricity,
            {ls ? cylinder.width(of.all) : kElsewhere}, reference);
    out.add(words("RONt", reference), Form::kRoundness, {kElsewhere}, reference);
  }
  for (const auto parameter : kParameters) {
    out.add(words("CYL", parameter), Form::kCylindricity,
            {of.parameter(of.all, cylinder, parameter)})
        .asked.indication.parameter = parameter;
    std::vector<double> sections;
    for (std::size_t j = 0; j < of.layers.size(); ++j) {
      sections.push_back(of.parameter(of.layers[j], of.circles[j], parameter));
    }
    out.worst(words("RON", parameter), Form::kRoundness, sections).asked.indication.parameter =
        parameter;
  }
}

void ask_lines(const Oracle& of, Questions& out) {
  std::vector<double> ls;
  std::vector<double> mz;
  std::vector<double> peak;
  std::vector<double> taper;
  std::vector<double> parallel;
  std::vector<double> heights;
  for (const auto& p : of.all) heights.push_back(of.axis.height(p));
  const double length = range(heights);
  const std::size_t half = of.lines.size() / 2;
  const auto apart = [](const Generatrix& from, const Generatrix& line) {
    const double slope = regression(from.h, from.d).slope;
    std::vector<double> off;
    for (std::size_t j = 0; j < line.h.size(); ++j) off.push_back(line.d[j] + slope * line.h[j]);
    return range(off) / std::hypot(1.0, slope);
  };
  for (std::size_t i = 0; i < of.lines.size(); ++i) {
    const Generatrix& line = of.lines[i];
    const Fitted fitted = regression(line.h, line.d);
    ls.push_back(range(fitted.off));
    mz.push_back(least_width(line.h, line.d));
    const auto [low, high] = std::minmax_element(fitted.off.begin(), fitted.off.end());
    peak.push_back(of.side > 0.0 ? *high : -*low);
    if (i >= half) continue;
    const Generatrix& other = of.lines[i + half];
    taper.push_back(0.5 * std::abs(fitted.slope + regression(other.h, other.d).slope) * length);
    parallel.push_back(std::max(apart(line, other), apart(other, line)));
  }
  out.worst("STRt ls", Form::kStraightness, ls);
  out.worst("STRt mz", Form::kStraightness, mz, Reference::kMinimumZone);
  out.worst("STRp", Form::kStraightness, peak).asked.indication.parameter =
      Indication::Parameter::kPeak;
  out.worst("taper", Form::kTaper, taper);
  out.worst("parallelism of generatrices", Form::kGeneratrixParallelism, parallel);
  out.add("STRt median line", Form::kStraightness, {least_cylinder(of.centers, of.axis)},
          Reference::kMinimumZone)
      .asked.indication.of = Indication::Of::kMedianLine;
}

Characteristic& to(PlantedQuestion& question, const std::string& datum, Association association) {
  question.asked.indication.datum = {datum};
  question.asked.indication.association = association;
  return question.asked;
}

/// Location, orientation and run-out of a cylinder about a datum axis.
void ask_about_axis(const Oracle& of, const std::string& datum, Association association,
                    const Line& axis, Questions& out) {
  const std::string name = words(" to " + datum, association);
  std::vector<double> off;
  for (const auto& c : of.centers) off.push_back(2.0 * axis.distance(c));
  to(out.worst("coaxiality" + name, Form::kCoaxiality, off), datum, association);
  auto& first = out.add("concentricity" + name, Form::kConcentricity, {off[0]});
  to(first, datum, association).indication.section = Indication::Section::kSCS;
  first.asked.indication.section_layers = {1.0};
  to(out.add("parallelism" + name, Form::kParallelism, {round_zone(of.centers, axis.direction)}),
     datum, association);
  const Round about_datum{axis, {}, {}};
  std::vector<double> sections;
  for (const auto& layer : of.layers) sections.push_back(about_datum.width(layer));
  to(out.worst("run-out" + name, Form::kRunOut, sections), datum, association);
  to(out.add("total run-out" + name, Form::kTotalRunOut, {about_datum.width(of.all)}), datum,
     association);
}

/// A face of circles about the axis of the shaft.
struct Face {
  Layers circles;
  std::vector<double> radii;
  Vector3d outward;  // to the side without material
};

double range_along(const Points& points, const Vector3d& w) {
  std::vector<double> out;
  for (const auto& p : points) out.push_back((p - points[0]).dot(w));
  return range(out);
}

/// Normal of the least-squares plane, or of the two nearest planes that hold the points.
Vector3d normal_of(const Points& points, const Vector3d& outward, Reference reference) {
  Vector3d mean = Vector3d::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Vector3d n = outward;
  for (int round = 0; round < 10; ++round) {
    const auto [e1, e2] = square_to(n);
    VectorXd tilt;
    if (reference == Reference::kLeastSquares) {
      Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
      Vector3d right = Vector3d::Zero();
      for (const auto& p : points) {
        const Vector3d row((p - mean).dot(e1), (p - mean).dot(e2), 1.0);
        normal += row * row.transpose();
        right += row * (p - mean).dot(n);
      }
      tilt = -normal.ldlt().solve(right);
    } else {
      Eigen::MatrixXd rows(static_cast<Eigen::Index>(2 * points.size()), 4);
      VectorXd bounds(rows.rows());
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(2 * i);
        const Vector3d q = points[i] - mean;
        // Tilts are per 100 mm, so that all unknowns are lengths alike.
        rows.row(at) << -0.01 * q.dot(e1), -0.01 * q.dot(e2), 1.0, 0.0;
        rows.row(at + 1) << 0.01 * q.dot(e1), 0.01 * q.dot(e2), 0.0, -1.0;
        bounds[at] = q.dot(n);
        bounds[at + 1] = -q.dot(n);
      }
      VectorXd cost(4);
      cost << 0.0, 0.0, 1.0, -1.0;
      tilt = 0.01 * cheapest(rows, bounds, cost, VectorXd::Constant(4, 1.0));
    }
    n = (n + tilt[0] * e1 + tilt[1] * e2).normalized();
    if (tilt.head(2).norm() < 1e-15) break;
  }
  return n;
}

void ask_face(const Face& face, Association association, const Line& axis, Questions& out) {
  Points all;
  for (const auto& circle : face.circles) all.insert(all.end(), circle.begin(), circle.end());
  const std::string datum = "A-B";
  const std::string name = words(" to A-B", association);
  std::vector<double> circles;
  for (const auto& circle : face.circles) circles.push_back(range_along(circle, axis.direction));
  using Direction = Indication::Direction;
  to(out.worst("axial run-out" + name, Form::kRunOut, circles), datum, association)
      .indication.direction = Direction::kAxial;
  auto& one = out.add("axial run-out of a circle" + name, Form::kRunOut, {circles[1]});
  to(one, datum, association).indication.direction = Direction::kAxial;
  one.asked.indication.radius_mm = face.radii[1];
  const double total = range_along(all, axis.direction);
  to(out.add("axial total run-out" + name, Form::kTotalRunOut, {total}), datum, association)
      .indication.direction = Direction::kAxial;
  to(out.add("perpendicularity" + name, Form::kPerpendicularity, {total}), datum, association);
}

void ask_flatness(const Face& face, Questions& out) {
  Points all;
  for (const auto& circle : face.circles) all.insert(all.end(), circle.begin(), circle.end());
  const Vector3d ls = normal_of(all, face.outward, Reference::kLeastSquares);
  Vector3d mean = Vector3d::Zero();
  for (const auto& p : all) mean += p / static_cast<double>(all.size());
  std::vector<double> e;
  for (const auto& p : all) e.push_back((p - mean).dot(ls));
  const auto [low, high] = std::minmax_element(e.begin(), e.end());
  const double values[] = {*high, -*low, root_mean_square(e)};
  out.add("FLTt ls", Form::kFlatness, {range(e)});
  for (std::size_t i = 0; i < 3; ++i) {
    out.add(words("FLT", kParameters[i]), Form::kFlatness, {values[i]}).asked.indication.parameter =
        kParameters[i];
  }
  const Vector3d mz = normal_of(all, face.outward, Reference::kMinimumZone);
  out.add("FLTt mz", Form::kFlatness, {range_along(all, mz)}, Reference::kMinimumZone);
}

// ---- The shafts.

/// Random numbers between limits.
class Drawn {
 public:
  explicit Drawn(std::uint64_t seed) : noise_(20261123, {19, seed}) {}
  double in(double low, double high) { return low + (high - low) * noise_.uniform(); }
  double either(double most) { return in(-most, most); }
  int whole(int low, int high) {
    return std::min(high, static_cast<int>(std::floor(in(low, high + 1.0))));
  }

 private:
  core::KeyedNoise noise_;
};

/// A common pose; its axis is not square to machine z, so that layers have an order.
Eigen::Isometry3d common_pose(Drawn& drawn) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translation() = Vector3d(drawn.either(200.0), drawn.either(200.0), drawn.either(200.0));
  do {
    const Vector3d about(drawn.either(1.0), drawn.either(1.0), drawn.either(1.0));
    out.linear() = Eigen::AngleAxisd(drawn.either(3.1), about.normalized()).toRotationMatrix();
  } while (std::abs(out.linear()(2, 2)) < 0.3);
  return out;
}

Turned planted(Drawn& drawn, const Eigen::Isometry3d& pose, double low, double high,
               const Eigen::Isometry3d& own, bool perfect) {
  Turned out;
  out.radius = drawn.in(8.0, 40.0);
  out.length = high - low;
  out.layers = drawn.whole(3, 7);
  out.points = 2 * drawn.whole(6, 60);
  out.start_rad = drawn.in(0.0, core::kTwoPi);
  out.place = pose * own;
  // Of an axis along machine x or y the layers count along that.
  Eigen::Index along = 0;
  out.reversed =
      pose.linear().col(2).cwiseAbs().maxCoeff(&along) > 0.0 && pose.linear()(along, 2) < 0.0;
  if (perfect) return out;
  out.cone = drawn.either(0.004);
  out.barrel = drawn.either(0.003);
  out.bend = drawn.either(0.003);
  for (const int k : {2, 3, 4, 5}) {
    out.lobe[k] = drawn.in(0.0002, 0.003);
    out.phase[k] = drawn.in(0.0, core::kTwoPi);
  }
  return out;
}

Face planted_face(Drawn& drawn, const Eigen::Isometry3d& pose, double height) {
  Face out;
  const int circles = drawn.whole(3, 7);
  const int points = drawn.whole(12, 120);
  const double start = drawn.in(0.0, core::kTwoPi);
  const double tilt = drawn.either(1e-4);
  const double saucer = drawn.either(0.003);
  const double wave = drawn.either(0.002);
  const double turn = drawn.in(0.0, core::kTwoPi);
  for (int j = 0; j < circles; ++j) {
    const double q = 10.0 + 20.0 * j / (circles - 1);
    auto& circle = out.circles.emplace_back();
    out.radii.push_back(q);
    for (int i = 0; i < points; ++i) {
      const double t = start + core::kTwoPi * i / points;
      const double h = tilt * q * std::cos(t - turn) + saucer * q * q / 900.0 +
                       wave * q / 30.0 * std::cos(2.0 * t + turn) +
                       0.3 * wave * std::cos(3.0 * t - 2.0 * turn);
      circle.push_back(pose * Vector3d(q * std::cos(t), q * std::sin(t), height + h));
    }
  }
  out.outward = pose.linear().col(2);
  return out;
}

void compare(const FeatureResult& found, const std::vector<PlantedQuestion>& questions) {
  ASSERT_EQ(found.characteristics.size(), questions.size());
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const CharacteristicResult& one = found.characteristics[i];
    const PlantedQuestion& question = questions[i];
    SCOPED_TRACE(found.feature.id + ": " + question.asked.id);
    EXPECT_TRUE(one.value_mm()) << one.reason.english();
    if (!one.value_mm()) continue;
    std::vector<double> judged = {*one.value_mm()};
    std::vector<double> local;
    if (one.finding) {  // CYLt and RONt without other indications have none
      judged.clear();
      for (const JudgedValue& value : one.finding->judged) judged.push_back(value.value_mm);
      for (const LocalValue& value : one.finding->local) local.push_back(value.value_mm);
    }
    EXPECT_EQ(judged.size(), question.judged.size());
    for (std::size_t k = 0; k < std::min(judged.size(), question.judged.size()); ++k) {
      if (std::isnan(question.judged[k])) continue;
      EXPECT_NEAR(judged[k], question.judged[k], kDefinition);
    }
    if (question.local.empty()) continue;
    std::vector<double> want = question.local;
    std::sort(local.begin(), local.end());
    std::sort(want.begin(), want.end());
    EXPECT_EQ(local.size(), want.size());
    for (std::size_t k = 0; k < std::min(local.size(), want.size()); ++k) {
      EXPECT_NEAR(local[k], want[k], kDefinition);
    }
  }
}

/// Extreme circles and cylinders. Distances bend with the move, so that there are several lowest
/// places some nanometres apart, which a search here need not tell from each other: the value is
/// reached about the reported axis, and no place that is found here is better.
void compare_extremes(const FeatureResult& found, const Oracle& of) {
  SCOPED_TRACE(found.feature.id);
  const auto one = [&](const std::string& id) -> const CharacteristicResult& {
    return *std::find_if(found.characteristics.begin(), found.characteristics.end(),
                         [&](const auto& c) { return c.characteristic.id == id; });
  };
  const auto value = [&](const std::string& id) { return one(id).value_mm().value_or(NAN); };
  ASSERT_TRUE(found.mz_cylinder && found.mc_cylinder && found.mi_cylinder);
  const auto reported = [&](const fit::Axis& axis) {
    return radii_about({axis.point_mm, axis.direction}, {of.all});
  };
  const Round mz = reported(found.mz_cylinder->axis);
  const Round mc = reported(found.mc_cylinder->axis);
  const Round mi = reported(found.mi_cylinder->axis);
  EXPECT_NEAR(value("CYLt mz"), mz.outer[0] - mz.inner[0], kDefinition);
  EXPECT_NEAR(value("CYLt mc"), mc.outer[0] - mc.inner[0], kDefinition);
  EXPECT_NEAR(value("CYLt mi"), mi.outer[0] - mi.inner[0], kDefinition);
  EXPECT_NEAR(value("d GC"), of.diameter(0.5 * (mz.outer[0] + mz.inner[0])), kDefinition);
  // These sizes have a search of their own, which may end at another of the lowest places.
  constexpr double kPlaces = 1e-6;
  EXPECT_NEAR(value("d GN"), of.diameter(mc.outer[0]), kPlaces);
  EXPECT_NEAR(value("d GX"), of.diameter(mi.inner[0]), kPlaces);
  EXPECT_EQ(value("d E"), value(of.side > 0.0 ? "d GN" : "d GX"));
  const Round narrow = extreme({of.all}, of.axis, 4, Least::kZone);
  EXPECT_LE(mz.outer[0] - mz.inner[0], narrow.outer[0] - narrow.inner[0] + kDefinition);
  const double outer = extreme({of.all}, of.axis, 4, Least::kOuter).outer[0];
  EXPECT_LE(mc.outer[0], outer + kDefinition);
  EXPECT_LE(value("d GN"), of.diameter(outer) + kDefinition);
  const double inner = extreme({of.all}, of.axis, 4, Least::kInner).inner[0];
  EXPECT_LE(inner - mi.inner[0], kDefinition);
  EXPECT_GE(value("d GX"), of.diameter(inner) - kDefinition);

  // Without other indications RONt is that of sections square to the minimum-zone axis.
  double worst = 0.0;
  double worst_zone = 0.0;
  const auto& any = one("d ACS GX").finding;
  ASSERT_TRUE(any && any->local.size() == of.layers.size());
  for (std::size_t j = 0; j < of.layers.size(); ++j) {
    worst = std::max(
        worst, about({of.layers[j]}, mz.axis, 2, Reference::kLeastSquares).width(of.layers[j]));
    const Round zone = extreme({of.layers[j]}, mz.axis, 2, Least::kZone);
    worst_zone = std::max(worst_zone, zone.outer[0] - zone.inner[0]);
    EXPECT_GE(any->local[j].value_mm,
              of.size(of.layers[j], 2, Indication::Size::kGX) - kDefinition);
  }
  EXPECT_NEAR(value("RONt ls"), worst, kDefinition);
  EXPECT_LE(value("RONt mz"), worst_zone + kDefinition);
}

/// All with RONDURE_FULL=1. The first four hold every kind: on one axis or not, a shaft or a bore
/// for C.
int shafts() { return test::cases(4, 50, 200); }

}  // namespace

TEST(PlantedShafts, HaveEveryCharacteristicOfItsDefinition) {
  for (int shaft = 0; shaft < shafts(); ++shaft) {
    SCOPED_TRACE(shaft);
    Drawn drawn(static_cast<std::uint64_t>(shaft));
    const bool perfect = shaft % 2 == 0;
    const bool inside = shaft % 3 == 0;
    const double tip = drawn.in(0.5, 2.5);
    const Eigen::Isometry3d pose = common_pose(drawn);
    const auto own = [&](double z, bool straight) {
      if (straight) return tilted(0.0, 0.0, z, 0.0, 0.0);
      return tilted(drawn.either(0.01), drawn.either(0.01), z, drawn.either(1e-4),
                    drawn.either(1e-4));
    };
    const Oracle a(planted(drawn, pose, 0.0, 30.0, own(15.0, perfect), perfect), false, tip);
    const Oracle b(planted(drawn, pose, 120.0, 140.0, own(130.0, perfect), perfect), false, tip);
    const Oracle c(planted(drawn, pose, 60.0, 90.0, own(75.0, false), false), inside, tip);
    const Face d = planted_face(drawn, pose, 150.0);
    std::vector<std::pair<Association, std::pair<Line, Line>>> datums;
    const Line planted_axis{pose.translation(), pose.linear().col(2)};
    if (perfect) {
      for (const auto association :
           {Association::kOneSided, Association::kEqualised, Association::kLs}) {
        datums.push_back({association, {planted_axis, planted_axis}});
      }
    } else {
      const std::vector<Points> both = {a.all, b.all};
      datums.push_back({Association::kLs, {a.axis, least_squares(both, planted_axis, 4).axis}});
    }
    Questions of_a;
    if (!perfect) {
      ask_sizes(a, of_a);
      ask_form(a, of_a);
      ask_lines(a, of_a);
    }
    Questions of_c;
    ask_sizes(c, of_c);
    ask_form(c, of_c);
    ask_lines(c, of_c);
    Questions of_d;
    ask_flatness(d, of_d);
    for (const auto& [association, axes] : datums) {
      ask_about_axis(c, "A", association, axes.first, of_c);
      ask_about_axis(c, "A-B", association, axes.second, of_c);
      ask_face(d, association, axes.second, of_d);
    }
    Points face;
    for (const auto& circle : d.circles) face.insert(face.end(), circle.begin(), circle.end());
    for (const auto& [association, reference] :
         {std::pair{Association::kLs, Reference::kLeastSquares},
          std::pair{Association::kOneSided, Reference::kMinimumZone}}) {
      const double zone = round_zone(c.centers, normal_of(face, d.outward, reference));
      to(of_c.add(words("perpendicularity to D", association), Form::kPerpendicularity, {zone}),
         "D", association);
    }

    record::RunRecord run;
    run.header.run_id = "shaft";
    const auto add = [&](const std::string& id, Shape shape, const Layers& layers,
                         const Questions& questions, Side side = Side::kOutside) {
      record::Feature& feature = reports::add_to_points_run(run, id, shape, layers, side);
      feature.tip_radius_mm = tip;
      feature.characteristics = questions.asked();
      return &feature;
    };
    add("A", Shape::kCylinder, a.layers, of_a);
    add("B", Shape::kCylinder, b.layers, {});
    add("C", Shape::kCylinder, c.layers, of_c, inside ? Side::kInside : Side::kOutside);
    add("D", Shape::kPlane, d.circles, of_d)->settings = {
        test::text_setting("faces", d.outward.z() > 0.0 ? "up" : "down")};
    const Evaluation found = reports::evaluated(run);
    ASSERT_EQ(found.features.size(), 4U);
    compare(found.features[0], of_a.all());
    compare(found.features[2], of_c.all());
    compare(found.features[3], of_d.all());
    if (!perfect) compare_extremes(found.features[0], a);
    compare_extremes(found.features[2], c);
  }
}

}  // namespace rondure::evaluation
