#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "reports/drawings/internal/svg.h"
#include "reports/escaping.h"
#include "reports/html/internal/solid_scene.h"
#include "reports/html/plots.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::fixed;
using core::um;

// The drawing is complete as written. For other views the script reads data attributes: "p" is a
// place (angle, radius, height), "ring" a closed line (height, radii), "body" and "cap" a radius,
// "h" a height. The n-th ring of the near group belongs to the n-th of the far group.

constexpr double kSolidWidth = 680.0;
constexpr double kSolidHeight = 420.0;
constexpr double kX = 270.0;  ///< x of the centre.
constexpr double kY = 208.0;
constexpr double kLabels = 14.0;  ///< Distance of the labels of angles.
constexpr std::size_t kCircleSteps = 60;

/// Both halves of a closed line: the one that faces the reader, and the other.
struct Halves {
  std::string near;
  std::string far;
};

Halves halves_of(const SolidRing& ring, const SolidCamera& camera) {
  const bool circle = ring.radii.size() == 1;
  const std::size_t steps = circle ? kCircleSteps : ring.radii.size();
  const double step_deg = 360.0 / static_cast<double>(steps);
  const auto radius = [&](std::size_t i) { return circle ? ring.radii[0] : ring.radii[i % steps]; };
  Halves out;
  const std::string* last = nullptr;
  for (std::size_t i = 0; i < steps; ++i) {
    const double angle = static_cast<double>(i) * step_deg;
    const bool near = seen(camera, angle + 0.5 * step_deg, 1.0, 0.0).faces;
    std::string& d = near ? out.near : out.far;
    if (!std::isfinite(radius(i)) || !std::isfinite(radius(i + 1))) {
      last = nullptr;
      continue;
    }
    if (last != &d) {
      const SolidSeen from = seen(camera, angle, radius(i), ring.height);
      d += fmt::format("M{:.1f} {:.1f}", kX + from.x, kY + from.y);
    }
    const SolidSeen to = seen(camera, angle + step_deg, radius(i + 1), ring.height);
    d += fmt::format("L{:.1f} {:.1f}", kX + to.x, kY + to.y);
    last = &d;
  }
  return out;
}

std::string data_of(const SolidRing& ring) {
  std::string text = fmt::format("{:.1f}", ring.height);
  for (const double radius : ring.radii) {
    text += std::isfinite(radius) ? fmt::format(" {:.1f}", radius) : " -";
  }
  return text;
}

/// Outline of a cylinder: its flanks, the nearer half of one end and the farther half of the other.
std::string outline(double radius, const SolidScene& scene, const SolidCamera& camera) {
  const double flank = scene.half_height * std::cos(camera.pitch_deg * core::kDegree);
  const double flat = radius * std::abs(std::sin(camera.pitch_deg * core::kDegree));
  return fmt::format(
      "M{0:.1f} {1:.1f}L{0:.1f} {2:.1f}A{3:.1f} {4:.1f} 0 0 0 {5:.1f} {2:.1f}"
      "L{5:.1f} {1:.1f}A{3:.1f} {4:.1f} 0 0 0 {0:.1f} {1:.1f}Z",
      kX - radius, kY - flank, kY + flank, radius, flat, kX + radius);
}

/// The marks of one point: a disc, and a triangle or a square on a contact.
std::string point_marks(const SolidPoint& point, const evaluation::CloudPoint& measured,
                        double disc, double half_zone_mm, const SolidSeen& at) {
  const std::string place =
      fmt::format(R"(data-p="{:.1f} {:.1f} {:.1f}")", point.angle_deg, point.radius, point.height);
  const double x = kX + at.x;
  const double y = kY + at.y;
  if (measured.outer_contact) {
    return fmt::format(
        R"(<path class="outer" {} data-o="0 -7.2" d="M{:.1f} {:.1f}l6.5 11.7h-13z"/>)", place, x,
        y - 7.2);
  }
  if (measured.inner_contact) {
    return fmt::format(
        R"(<path class="inner" {} data-o="-5.1 -5.1" d="M{:.1f} {:.1f}h10.2v10.2h-10.2z"/>)", place,
        x - 5.1, y - 5.1);
  }
  return fmt::format(R"(<circle class="disc" {} cx="{:.1f}" cy="{:.1f}" r="{:.1f}" fill="{}"/>)",
                     place, x, y, disc, diverging_colour(measured.deviation_mm / half_zone_mm));
}

/// Markup of the drawing by depth: far objects are drawn first.
struct Layers {
  std::string far;
  std::string near;
};

void add_ring(Layers& layers, const SolidRing& ring, std::string_view css_class,
              const SolidCamera& camera, bool both_seen) {
  const Halves halves = halves_of(ring, camera);
  layers.far += fmt::format(R"(<path class="ring {}{}" d="{}"/>)", css_class,
                            both_seen ? "" : " away", halves.far);
  layers.near += fmt::format(R"(<path class="ring {}" data-ring="{}" d="{}"/>)", css_class,
                             data_of(ring), halves.near);
}

Layers layers_of(const SolidScene& scene, const evaluation::FeatureResult& feature,
                 double half_zone_mm, const SolidCamera& camera) {
  Layers layers;
  add_ring(layers, {scene.half_height, {scene.outer}}, "outside", camera, camera.pitch_deg > 0.0);
  add_ring(layers, {-scene.half_height, {scene.outer}}, "outside", camera, camera.pitch_deg < 0.0);
  for (const SolidRing& section : scene.sections) {
    add_ring(layers, section, scene.dense ? "section dense" : "section", camera, false);
  }
  const std::size_t n = scene.points.size();
  const double disc = n <= 120 ? 5.0 : n <= 500 ? 3.2 : 2.4;
  for (const SolidPoint& point : scene.points) {
    const SolidSeen at = seen(camera, point.angle_deg, point.radius, point.height);
    (at.faces ? layers.near : layers.far) +=
        point_marks(point, feature.cloud[point.row], disc, half_zone_mm, at);
  }
  return layers;
}

std::string labels_of(const SolidScene& scene, const SolidCamera& camera) {
  std::string out;
  const double radius = scene.outer + kLabels;
  for (const int angle : {0, 90, 180, 270}) {
    const SolidSeen at = seen(camera, angle, radius, scene.half_height);
    out += fmt::format(R"(<text class="label" data-p="{} {:.1f} {:.1f}" x="{:.1f}" y="{:.1f}" )"
                       R"(text-anchor="middle">{}°</text>)",
                       angle, radius, scene.half_height, kX + at.x, kY + at.y + 4.0, angle);
  }
  const double flank = scene.half_height * std::cos(camera.pitch_deg * core::kDegree);
  for (const bool upper : {true, false}) {
    const double height = upper ? scene.half_height : -scene.half_height;
    out += fmt::format(
        R"(<text class="label" data-h="{:.1f}" x="{:.1f}" y="{:.1f}" text-anchor="start">{} mm</text>)",
        height, kX + scene.outer + 44.0, kY + (upper ? -flank : flank) + 4.0,
        fixed(upper ? scene.high_mm : scene.low_mm, 2));
  }
  return out;
}

/// The whole drawing, as seen from `camera`.
std::string drawing(const SolidScene& scene, const evaluation::FeatureResult& feature,
                    double half_zone_mm) {
  const SolidCamera camera;
  const double sine = std::abs(std::sin(camera.pitch_deg * core::kDegree));
  const double cosine = std::cos(camera.pitch_deg * core::kDegree);
  const Layers layers = layers_of(scene, feature, half_zone_mm, camera);
  Svg svg(kSolidWidth, kSolidHeight, "wide turn", tr("Cylinder and its zone in three dimensions"));
  svg.describe(trf(
      "Two coaxial cylinders {} µm apart in radius about the minimum-zone axis, {} points between "
      "them coloured by deviation, {} of them contact points.",
      um(2.0 * half_zone_mm), scene.points.size(),
      std::count_if(
          feature.cloud.begin(), feature.cloud.end(),
          [](const evaluation::CloudPoint& p) { return p.outer_contact || p.inner_contact; })));
  svg.add(fmt::format(R"(<g class="far">{}</g>)", layers.far));
  svg.add(fmt::format(R"(<path class="solid-glass" data-body="{:.1f}" d="{}"/>)", scene.outer,
                      outline(scene.outer, scene, camera)));
  svg.add(fmt::format(R"(<path class="solid-body" data-body="{:.1f}" d="{}"/>)", scene.inner,
                      outline(scene.inner, scene, camera)));
  svg.add(fmt::format(
      R"(<ellipse class="solid-cap" data-cap="{:.1f}" cx="{:.1f}" cy="{:.1f}" rx="{:.1f}" ry="{:.1f}"/>)",
      scene.inner, kX, kY - scene.half_height * cosine, scene.inner, scene.inner * sine));
  const double end = (scene.half_height + 26.0) * cosine;
  svg.line(kX, kY - end, kX, kY + end, "solid-axis");
  svg.add(fmt::format(R"(<g class="near">{}</g>)", layers.near));
  svg.add(labels_of(scene, camera));
  deviation_scale(svg, 594.0, 60.0, 360.0, half_zone_mm);
  return svg.str();
}

/// Buttons and the view in words; the script makes them visible.
std::string tools(const SolidScene& scene) {
  const SolidCamera camera;
  const auto button = [](std::string_view turn, std::string_view name, std::string_view sign) {
    return fmt::format(
        R"(<button type="button" data-turn="{}" aria-label="{}" title="{}">{}</button>)", turn,
        escaped(name), escaped(name), sign);
  };
  return fmt::format(
      R"(<div class="tools screen-only" hidden="hidden" data-half="{:.1f}" )"
      R"(data-centre="{} {}" data-view="{} {}" data-words="{}">{}{}{}{}{}<output></output></div>)",
      scene.half_height, kX, kY, camera.yaw_deg, camera.pitch_deg,
      escaped(tr("turned {}°, tilted {}°")), button("-15 0", tr("Turn left"), "◀"),
      button("15 0", tr("Turn right"), "▶"), button("0 -15", tr("Tilt back"), "▲"),
      button("0 15", tr("Tilt forward"), "▼"),
      fmt::format(R"(<button type="button" data-turn="reset">{}</button>)", tr("Reset view")));
}

std::string caption(const SolidScene& scene, std::size_t all) {
  std::string text = trf(
      "The zone between two cylinders about the minimum-zone axis (orange: outer, blue: inner) and "
      "the points, coloured by their deviation in µm; triangles touch the outer, squares the inner "
      "cylinder. Deviations are magnified {}× against the radius; heights, from the mean point, "
      "are {}.",
      fixed(scene.magnification, 0),
      std::abs(scene.height_share - 1.0) < 1e-9
          ? tr("to scale")
          : trf("drawn at {:.2g}× the scale of the radius", scene.height_share));
  if (!scene.sections.empty() && !scene.dense) {
    text += tr(" Dotted lines guide the eye only.");
  }
  if (scene.left_out > 0) {
    text +=
        trf(" {} of {} points are drawn: of each cell of 5° by 1/24 of the height the one farthest "
            "from the middle of the zone; all are in touches.csv.",
            all - scene.left_out, all);
  }
  return text;
}

}  // namespace

std::string solid_view(const evaluation::FeatureResult& feature, const evaluation::Zone& zone) {
  if (feature.cloud.empty() || feature.feature.shape != record::Shape::kCylinder) return {};
  const auto [low_mm, high_mm] = heights_of(feature);
  if (feature.layers.size() == 1 || !(high_mm > low_mm)) return {};
  const SolidScene scene = solid_scene_of(feature, zone);
  const double half_zone_mm = std::max(0.5 * zone.deviation_mm, 1e-5);
  return fmt::format(
      R"(<h3>{}</h3><figure class="solid"><div class="scroll">{}</div>)"
      R"({}<figcaption>{}<span class="screen-only turn-note" hidden="hidden">{}</span></figcaption>)"
      "</figure>",
      tr("Cylinder in three dimensions"), drawing(scene, feature, half_zone_mm), tools(scene),
      caption(scene, feature.cloud.size()),
      tr(" Drag it to turn it, or use the arrow keys when it has the focus; Home resets the "
         "view."));
}

}  // namespace rondure::reports
