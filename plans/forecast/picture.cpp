#include "plans/forecast/picture.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cmm/simulated/part.h"
#include "core/numbers.h"
#include "core/units.h"
#include "plans/analyses/features.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/scene.h"

namespace rondure::plans {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPanel_px = 460.0;
constexpr double kMargin_px = 30.0;
constexpr double kHead_px = 64.0;
constexpr int kCorners = 72;  // corners of a drawn circle

/// One view: the two machine axes shown, and its place.
struct View {
  int right = 0;
  int up = 2;
  Vector2d low = Vector2d::Zero();  ///< Lower end of the drawn window [mm].
  double px_per_mm = 1.0;
  Vector2d origin_px = Vector2d::Zero();  ///< Lower left corner of the window.

  [[nodiscard]] Vector2d flat(const Vector3d& p) const { return {p(right), p(up)}; }
  [[nodiscard]] Vector2d px(const Vector3d& p) const {
    const Vector2d d = px_per_mm * (flat(p) - low);
    return {origin_px.x() + d.x(), origin_px.y() - d.y()};
  }
};

struct DrawnShape {
  std::vector<Vector3d> points_W;  ///< Their convex hull is drawn.
  const char* fill = "";
  bool framed = true;  ///< Whether it affects the size of the window.
  /// A surface whose outline is drawn in place of the hull, with its frame.
  std::shared_ptr<const SolidMesh> mesh = {};
  Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
};

/// Degrees to two digits; drops the sign of a rounded zero.
double hundredths(double angle_rad) {
  return std::round(100.0 * angle_rad / core::kDegree) / 100.0 + 0.0;
}

/// Text escaped for XML.
std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      out += c;
    }
  }
  return out;
}

/// Corners of the hull in order, by Andrew's chain.
std::vector<Vector2d> hull(std::vector<Vector2d> p) {
  std::sort(p.begin(), p.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  const auto right_turn = [](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) <= 0.0;
  };
  std::vector<Vector2d> out;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = out.size();
    for (const Vector2d& q : p) {
      while (out.size() >= start + 2 && right_turn(out[out.size() - 2], out.back(), q))
        out.pop_back();
      out.push_back(q);
    }
    out.pop_back();
    std::reverse(p.begin(), p.end());
  }
  return out;
}

std::vector<Vector3d> cylinder(const Eigen::Isometry3d& X, double radius_mm, double from_mm,
                               double to_mm) {
  std::vector<Vector3d> out;
  for (int k = 0; k < kCorners; ++k) {
    const double theta = core::kTwoPi * k / kCorners;
    for (const double z : {from_mm, to_mm}) {
      out.emplace_back(X * Vector3d(radius_mm * std::cos(theta), radius_mm * std::sin(theta), z));
    }
  }
  return out;
}

std::vector<Vector3d> ball(const Vector3d& center, double radius_mm) {
  std::vector<Vector3d> out;
  for (int k = 0; k < kCorners; ++k) {
    const double t = core::kTwoPi * k / kCorners;
    out.emplace_back(center + radius_mm * Vector3d(std::cos(t), std::sin(t), 0.0));
    out.emplace_back(center + radius_mm * Vector3d(std::cos(t), 0.0, std::sin(t)));
  }
  return out;
}

/// Part, ring, rim, sphere and the bodies of the plan. Bodies without a size in the plan are not
/// drawn.
std::vector<DrawnShape> shapes_of(const Plan& plan, const ForecastStage& stage) {
  std::vector<DrawnShape> out;
  const FixturePlan& fixture = *plan.fixture;
  const Vector3d axis = vector3(fixture.axis_point_mm);
  if (fixture.rim_diameter_mm > 0.0) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Vector3d(axis.x(), axis.y(), 0.0);
    const double foot_mm = std::max(fixture.table_height_mm, fixture.rim_height_mm - 60.0);
    out.push_back({cylinder(X, 0.5 * fixture.rim_diameter_mm, foot_mm, fixture.rim_height_mm),
                   "#d9d4c7", true});
  }
  const bool sphere = stage.feature < 0;
  const QualificationPlan& q = plan.probe->qualification;
  const Eigen::Isometry3d at_artefact(Eigen::Translation3d(vector3(q.place_mm())));
  out.push_back({q.on_column() ? cylinder(at_artefact, 0.5 * q.column_diameter_mm, q.column_from_mm,
                                          q.column_to_mm)
                               : ball(at_artefact.translation(), 0.5 * q.sphere_diameter_mm),
                 "#c9d3dd", sphere});
  if (sphere) return out;
  const FeaturePlan& feature = plan.features[static_cast<std::size_t>(stage.feature)];
  const bool shows_part = is_touched(feature);
  for (const BodyPlan& body : fixture.bodies) {
    if (body.frame == BodyPlan::Frame::kPart && !shows_part) continue;
    const Eigen::Isometry3d X_WF = frame_of(body.frame, fixture, stage.placement);
    DrawnShape drawn{corners_of(body), "#cfc8b8", true, body.mesh, X_WF * placed_body(body)};
    for (Vector3d& corner : drawn.points_W) corner = X_WF * corner;
    out.push_back(std::move(drawn));
  }
  const Eigen::Isometry3d& X_WP = stage.placement.X_WP;
  if (fixture.ring_diameter_mm > 0.0 && fixture.clamp_from_mm < fixture.clamp_to_mm) {
    out.push_back({cylinder(stage.placement.X_WN, 0.5 * fixture.ring_diameter_mm,
                            fixture.clamp_from_mm, fixture.clamp_to_mm),
                   "#b9b1a0", true});
  }
  const auto add_piece = [&](const PartPiece& piece, const char* colour) {
    const Revolved& solid = piece.solid;
    const Eigen::Isometry3d X = X_WP * Eigen::Translation3d(piece.origin_mm);
    out.push_back({solid.ball ? ball(X.translation(), solid.outer_mm)
                              : cylinder(X, solid.widest_mm(), solid.from_mm, solid.to_mm),
                   colour, true});
  };
  for (const PartPiece& piece : part_beside(plan, feature)) add_piece(piece, "#aebfcc");
  const double radius_mm = 0.5 * feature.nominal.diameter_mm;
  const NominalPlan& n = feature.nominal;
  if (feature.side == record::Side::kInside) {
    out.push_back(
        {cylinder(X_WP, radius_mm + cmm::kBlockWall_mm, n.from_mm, n.to_mm), "#aebfcc", true});
    out.push_back({cylinder(X_WP, radius_mm, n.from_mm, n.to_mm), "#f4f7f9", true});
  } else {
    add_piece(piece_of(feature), "#8fb0c9");
  }
  return out;
}

/// The path of the tip below the park height, around the part.
Polyline low_path(const Plan& plan, const ForecastStage& stage) {
  Polyline out;
  double highest = -1e9;
  for (const Vector3d& p : stage.contacts_W) highest = std::max(highest, p.z());
  const double sky_mm = plan.machine->park_mm[2];
  for (const Vector3d& corner : stage.moves_W) {
    Vector3d p = corner;
    // The descent from the park height is drawn only over its last part.
    if (p.z() >= sky_mm - 1e-9) p.z() = std::min(p.z(), highest + 40.0);
    out.push_back(p);
  }
  return out;
}

void fit_window(View& view, const std::vector<DrawnShape>& shapes, const Polyline& path) {
  Vector2d low = Vector2d::Constant(1e9);
  Vector2d high = Vector2d::Constant(-1e9);
  const auto take = [&](const Vector3d& p) {
    low = low.cwiseMin(view.flat(p));
    high = high.cwiseMax(view.flat(p));
  };
  for (const DrawnShape& shape : shapes) {
    if (!shape.framed) continue;
    for (const Vector3d& p : shape.points_W) take(p);
  }
  for (const Vector3d& p : path) take(p);
  const double side = std::max({(high - low).x(), (high - low).y(), 1.0});
  view.px_per_mm = kPanel_px / side;
  view.low = 0.5 * (low + high) - Vector2d::Constant(0.5 * side);
}

std::string points_of(const std::vector<Vector2d>& points) {
  std::string out;
  for (const Vector2d& p : points) out += fmt::format("{:.1f},{:.1f} ", p.x(), p.y());
  return out;
}

/// The outline of a surface, seen along the axis that the view leaves out.
std::string outline(const View& view, const DrawnShape& shape) {
  const Vector3d along = Vector3d::Unit(view.right).cross(Vector3d::Unit(view.up));
  std::string path;
  for (const auto& [from, to] : shape.mesh->outline_mm(shape.X_WM.linear().transpose() * along)) {
    const Vector2d a = view.px(shape.X_WM * from);
    const Vector2d b = view.px(shape.X_WM * to);
    path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", a.x(), a.y(), b.x(), b.y());
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#8a8272\"/>\n", path);
}

std::string panel(const View& view, const std::vector<DrawnShape>& shapes, const Polyline& path,
                  const ForecastStage& stage, const char* title, const char* up) {
  const double x = view.origin_px.x();
  const double y = view.origin_px.y() - kPanel_px;
  std::string out = fmt::format(
      "<text x=\"{0:.0f}\" y=\"{1:.0f}\" font-weight=\"bold\">{2}</text>\n"
      "<svg x=\"{0:.0f}\" y=\"{3:.0f}\" width=\"{4:.0f}\" height=\"{4:.0f}\" viewBox=\"{0:.0f} "
      "{3:.0f} {4:.0f} {4:.0f}\">\n"
      "<rect x=\"{0:.0f}\" y=\"{3:.0f}\" width=\"{4:.0f}\" height=\"{4:.0f}\" fill=\"#ffffff\" "
      "stroke=\"#999999\"/>\n",
      x, y - 8.0, title, y, kPanel_px);
  for (const DrawnShape& shape : shapes) {
    if (shape.mesh) {
      out += outline(view, shape);
      continue;
    }
    std::vector<Vector2d> flat;
    for (const Vector3d& p : shape.points_W) flat.push_back(view.px(p));
    out += fmt::format("<polygon points=\"{}\" fill=\"{}\" stroke=\"#555555\"/>\n",
                       points_of(hull(std::move(flat))), shape.fill);
  }
  std::vector<Vector2d> corners;
  for (const Vector3d& p : path) corners.push_back(view.px(p));
  out += fmt::format(
      "<polyline points=\"{}\" fill=\"none\" stroke=\"#c0392b\" stroke-width=\"0.8\"/>\n",
      points_of(corners));
  for (const Vector3d& contact : stage.contacts_W) {
    const Vector2d p = view.px(contact);
    out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"#1b4f72\"/>\n", p.x(),
                       p.y());
  }
  return out + fmt::format("</svg>\n<text x=\"{:.0f}\" y=\"{:.0f}\">x right, {} up</text>\n", x,
                           y + kPanel_px + 16.0, up);
}

/// A round length that is about a fifth of a panel.
double bar_mm(double px_per_mm) { return core::round_below(0.2 * kPanel_px / px_per_mm); }

}  // namespace

std::string forecast_picture(const Plan& plan, const ForecastStage& stage) {
  const std::vector<DrawnShape> shapes = shapes_of(plan, stage);
  const Polyline path = low_path(plan, stage);
  View side{0, 2};
  View top{0, 1};
  fit_window(side, shapes, path);
  fit_window(top, shapes, path);
  const double scale = std::min(side.px_per_mm, top.px_per_mm);
  for (View* view : {&side, &top}) {
    view->low -= Vector2d::Constant(0.5 * kPanel_px * (1.0 / scale - 1.0 / view->px_per_mm));
    view->px_per_mm = scale;
  }
  side.origin_px = {kMargin_px, kHead_px + kPanel_px};
  top.origin_px = {2.0 * kMargin_px + kPanel_px, kHead_px + kPanel_px};
  const double width = 3.0 * kMargin_px + 2.0 * kPanel_px;
  const double height = kHead_px + kPanel_px + 50.0;
  const double bar = bar_mm(scale);
  const std::string name = stage.feature < 0
                               ? std::string(plan.probe->qualification.name())
                               : plan.features[static_cast<std::size_t>(stage.feature)].id;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 "
      "0 "
      "{0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#f7f7f5\"/>\n"
      "<text x=\"{2:.0f}\" y=\"24\" font-size=\"15\">{3}, pose ({4:.2f}, {5:.2f}) deg: {6} "
      "touches, "
      "way of the tip {7:.0f} mm, {8:.0f} s</text>\n",
      width, height, kMargin_px, xml_text(name), hundredths(stage.pose.alpha_rad),
      hundredths(stage.pose.beta_rad), stage.touches, stage.path_mm / stage.times,
      stage.time_s / stage.times);
  out += panel(side, shapes, path, stage, "From the side", "z");
  out += panel(top, shapes, path, stage, "From above", "y");
  out += fmt::format(
      "<line x1=\"{0:.1f}\" y1=\"{1:.0f}\" x2=\"{2:.1f}\" y2=\"{1:.0f}\" stroke=\"#000000\" "
      "stroke-width=\"2\"/>\n<text x=\"{2:.1f}\" y=\"{1:.0f}\" dx=\"6\" dy=\"4\">{3:g} mm</text>\n"
      "</svg>\n",
      kMargin_px + 150.0, height - 20.0, kMargin_px + 150.0 + bar * scale, bar);
  return out;
}

}  // namespace rondure::plans
