#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/path/sampling.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;

// Millimetres as messages print them: six digits.
std::string mm(double value_mm) { return fmt::format("{:.6g} mm", value_mm); }

bool check_nominal_given(const FeaturePlan& feature, const std::string& nominal,
                         Findings& findings) {
  using enum record::Shape;
  struct Needed {
    std::string_view key;
    std::string_view meaning;
    std::vector<record::Shape> shapes;
    bool required = true;
  };
  const std::vector<record::Shape> axial = {kCylinder, kCircle, kCone, kSphere};
  const Needed all[] = {
      {"diameter_mm", "the diameter on the drawing", axial},
      {"from_mm", "the lower end of the surface, part z", axial},
      {"to_mm", "the upper end of the surface, part z", axial},
      {"half_angle_deg", "between the axis and the generatrix", {kCone}},
      {"z_mm", "the height of the plane, part z", {kPlane}},
      {"from_diameter_mm", "the inner diameter of the ring; 0: the whole disc", {kPlane}},
      {"to_diameter_mm", "the outer diameter of the ring", {kPlane}},
      {"faces", "the side of the plane that is free to touch", {kPlane}},
      {"center_mm", "", {kSphere}, false},
  };
  bool complete = true;
  for (const Needed& needed : all) {
    const bool given = findings.is_given(member_pointer(nominal, needed.key));
    const bool takes =
        std::find(needed.shapes.begin(), needed.shapes.end(), feature.type) != needed.shapes.end();
    if (given || !takes || !needed.required) continue;
    complete = false;
    findings.meaning(Code::kMissingKey, member_pointer(nominal, needed.key),
                     fmt::format("this key is missing: {}", needed.meaning));
  }
  return complete;
}

/// Checks dimensions of a plane, a cone or a sphere that contradict one another, and the sides of
/// which the machine touches only one.
bool check_dimensions(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  constexpr double kLeastHalfAngle_deg = 0.05;
  const NominalPlan& n = feature.nominal;
  const auto refuse = [&](Code code, const char* key, std::string what) {
    findings.meaning(code, where + key, std::move(what));
    return false;
  };
  if (feature.type == record::Shape::kCylinder || feature.type == record::Shape::kCircle) {
    return true;
  }
  if (feature.sampling.method == record::SamplingMethod::kScan) {
    return refuse(Code::kSampling, "/sampling/method",
                  fmt::format("a {} is touched, not scanned: a scan approaches along the radius; "
                              "leave the key out",
                              name_of(feature.type)));
  }
  if (feature.side == record::Side::kInside) {
    return refuse(
        Code::kUnreachable, "/side",
        feature.type == record::Shape::kPlane
            ? std::string("a plane has no inside; say \"faces\" in nominal and leave the side out")
            : fmt::format("the machine touches a {} only outside; give its points in a file "
                          "(source)",
                          name_of(feature.type)));
  }
  const double radius_mm = 0.5 * n.diameter_mm;
  if (feature.type == record::Shape::kCone) {
    if (std::abs(n.half_angle_deg) < kLeastHalfAngle_deg) {
      return refuse(Code::kMeaning, "/nominal/half_angle_deg",
                    fmt::format("a half angle of {} deg is below {} deg; make the feature a "
                                "\"cylinder\"",
                                plain(n.half_angle_deg), plain(kLeastHalfAngle_deg)));
    }
    const double end_mm =
        radius_mm + (n.to_mm - n.from_mm) * std::tan(n.half_angle_deg * core::kDegree);
    if (end_mm <= 0.0) {
      return refuse(Code::kMeaning, "/nominal/half_angle_deg",
                    fmt::format("the cone of {} at its lower end comes to its apex below its upper "
                                "end; correct the half angle, its sign or the ends",
                                mm(n.diameter_mm)));
    }
  }
  if (feature.type == record::Shape::kSphere &&
      std::max(n.to_mm - n.center_mm[2], n.center_mm[2] - n.from_mm) > radius_mm) {
    return refuse(Code::kMeaning, "/nominal",
                  fmt::format("the ends {} and {} go beyond a sphere of {} about z = {}",
                              mm(n.from_mm), mm(n.to_mm), mm(n.diameter_mm), mm(n.center_mm[2])));
  }
  return true;
}

// Checks that the surface is long enough for the layers.
bool check_extent(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  const NominalPlan& nominal = feature.nominal;
  const double length_mm = layered_mm(feature);
  const auto refuse = [&](Code code, const char* key, std::string what) {
    findings.meaning(code, where + key, std::move(what));
    return false;
  };
  if (length_mm <= 0.0 && feature.type == record::Shape::kPlane) {
    return refuse(Code::kMeaning, "/nominal/from_diameter_mm",
                  fmt::format("the inner diameter {} is not below the outer diameter {}; exchange "
                              "or correct them",
                              mm(nominal.from_diameter_mm), mm(nominal.to_diameter_mm)));
  }
  if (length_mm <= 0.0) {
    return refuse(
        Code::kMeaning, "/nominal/from_mm",
        fmt::format("the lower end {} is not below the upper end {}; exchange or correct them",
                    mm(nominal.from_mm), mm(nominal.to_mm)));
  }
  if (feature.type == record::Shape::kCircle) return true;  // one section, in the middle
  const double margin_mm = feature.sampling.margin_mm;
  if (2.0 * margin_mm >= length_mm) {
    return refuse(
        Code::kSampling, "/sampling/margin_mm",
        fmt::format("two margins of {} leave nothing of a surface {} long; it must be less than {}",
                    mm(margin_mm), mm(length_mm), mm(length_mm / 2.0)));
  }
  return true;
}

bool check_counts(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  constexpr std::int64_t kMaxPoints = 1'000'000;
  const SamplingPlan& sampling = feature.sampling;
  const bool circle = feature.type == record::Shape::kCircle;
  const auto refuse = [&](const char* key, std::string what) {
    findings.meaning(Code::kSampling, where + key, std::move(what));
    return false;
  };
  if (circle && sampling.layers != 1) {
    return refuse(
        "/sampling/layers",
        fmt::format("a circle is 1 layer, {} are asked for; make the feature a \"cylinder\" "
                    "or leave the key out",
                    sampling.layers));
  }
  if (circle && sampling.points_per_layer < 4) {
    return refuse(
        "/sampling/points_per_layer",
        fmt::format("{} points lie on a circle exactly, whatever the part; at least 4 are "
                    "needed",
                    sampling.points_per_layer));
  }
  if (!circle && feature.type != record::Shape::kPlane && sampling.layers < 2) {
    return refuse(
        "/sampling/layers",
        fmt::format("{} layer leaves the {} of the {} undetermined; at least 2 are needed",
                    sampling.layers, feature.type == record::Shape::kSphere ? "centre" : "tilt",
                    name_of(feature.type)));
  }
  const std::int64_t points = std::int64_t{sampling.layers} * sampling.points_per_layer;
  if (points > kMaxPoints) {
    return refuse("/sampling", fmt::format("{} x {} = {} points, the limit is {}", sampling.layers,
                                           sampling.points_per_layer, points, kMaxPoints));
  }
  return true;
}

void check_clamp(const FeaturePlan& feature, const FixturePlan& fixture, const std::string& where,
                 Findings& findings) {
  if (fixture.clamp_from_mm >= fixture.clamp_to_mm) return;
  const auto heights = layer_heights_mm(feature);
  if (!heights) return;  // check_counts() and check_extent() have reported this
  for (std::size_t layer = 0; layer < heights->size(); ++layer) {
    const double z_mm = (*heights)[layer];
    if (z_mm < fixture.clamp_from_mm || z_mm > fixture.clamp_to_mm) continue;
    findings.meaning(
        Code::kSampling, where + "/sampling",
        fmt::format("layer {} of {} at z = {} lies in the clamped band {}..{}; move the "
                    "clamp, or change the layers or the margin",
                    layer + 1, feature.sampling.layers, mm(z_mm), plain(fixture.clamp_from_mm),
                    mm(fixture.clamp_to_mm)));
  }
}

// Checks that the search starts between the axis of a bore and its wall for any position of the
// part.
void check_bore(const Plan& plan, const FeaturePlan& feature, const std::string& where,
                Findings& findings) {
  const double bore_mm = feature.nominal.diameter_mm;
  const double tip_mm = plan.probe->tip_diameter_mm;
  const double room_mm = (bore_mm - tip_mm) / 2.0;
  const double needed_mm = plan.machine->approach_mm + plan.part.location_uncertainty_mm;
  if (room_mm <= 0.0) {
    findings.meaning(Code::kUnreachable, where + "/nominal/diameter_mm",
                     fmt::format("a tip of {} does not enter a bore of {}; take a smaller tip",
                                 mm(tip_mm), mm(bore_mm)));
  } else if (needed_mm > room_mm) {
    findings.meaning(Code::kUnreachable, where + "/nominal/diameter_mm",
                     fmt::format("a bore of {} leaves a tip of {} a way of {} from axis to wall; "
                                 "approach_mm and location_uncertainty_mm need {} together; lower "
                                 "them or take a smaller tip",
                                 mm(bore_mm), mm(tip_mm), mm(room_mm), mm(needed_mm)));
  }
}

}  // namespace

void check_sampling(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index);
  if (!findings.sound(where + "/type")) return;
  const bool counts = findings.sound(where + "/sampling") && check_counts(feature, where, findings);
  if (!findings.sound(where + "/nominal") ||
      !check_nominal_given(feature, where + "/nominal", findings)) {
    return;
  }
  if (!findings.sound(where + "/side") || !check_dimensions(feature, where, findings)) return;
  const bool extent = findings.sound(where + "/sampling") && check_extent(feature, where, findings);
  if (counts && extent && plan.fixture && findings.sound("/fixture")) {
    check_clamp(feature, *plan.fixture, where, findings);
  }
  const bool known = plan.probe && plan.machine && findings.sound("/probe") &&
                     findings.sound("/machine") && findings.sound("/part") &&
                     findings.sound(where + "/side");
  if (feature.side == record::Side::kInside && known) check_bore(plan, feature, where, findings);
}

}  // namespace rondure::plans
