#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "plans/path/obstacle.h"
#include "plans/path/solid_mesh.h"
#include "plans/path/travel.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Obstacles of the tool.
enum class Body {
  kFeature,
  kSection,
  kShoulder,
  kRing,
  kHeld,  ///< What holds a part without a fixture.
  kRim,
  kTable,
  kSphere,
  kStem,
  kColumn,
  kDowel,  ///< A dowel or bolt head on the base.
  kRingSphere,
  kBody,      ///< fixture.bodies.
  kPartMesh,  ///< One of them that is the part itself.
  kVolume
};
/// The part of the tool that meets an obstacle.
enum class Limb { kBall, kShaft, kHolder };

/// Distances that the tool keeps on a move.
enum class Phase {
  kTravel,  ///< The clearance, from all obstacles.
  kNear,    ///< Beside the surface to be touched: from the part, only the approach if that is less.
  /// From the pre-touch point to the contact: the ball meets the surface, the shaft keeps
  /// kTouchGap_mm from the part.
  kTouch,
};

inline constexpr double kTouchGap_mm = 0.25;

/// Moves of the tip, machine frame: `phases[i]` is the phase of the move to `corners[i + 1]`.
struct Way {
  Polyline corners;
  std::vector<Phase> phases;
};

/// Sum of the lengths of the straight moves [mm].
[[nodiscard]] double length_mm(const Polyline& path);

/// Positions of part and clamping ring, machine frame.
struct Placement {
  Eigen::Isometry3d X_WP = Eigen::Isometry3d::Identity();  ///< Best estimate of the part.
  /// Nominal seat of the part, at the ring.
  Eigen::Isometry3d X_WN = Eigen::Isometry3d::Identity();
};

/// The frame of a body of the plan in the machine.
[[nodiscard]] Eigen::Isometry3d frame_of(BodyPlan::Frame frame, const FixturePlan& fixture,
                                         const Placement& placement);

/// A place where the tool would come too close to an obstacle.
struct Hit {
  Body body = Body::kFeature;
  Limb limb = Limb::kBall;
  double gap_mm = 0.0;                                 ///< To keep between tool and obstacle.
  const char* key = "";                                ///< Of the plan, that asks for the gap;
  double location_mm = 0.0;                            ///< and in it what the place may be off,
  double body_mm = 0.0;                                ///< and what the body asks for itself.
  Eigen::Vector3d tip_W_mm = Eigen::Vector3d::Zero();  ///< End of the move on which the hit occurs.
  std::string name = {};                               ///< Of a body of the plan.
};

/// "the shaft of the stylus would come nearer than 5 mm (machine.clearance_mm) to the clamping ring
/// on the way to machine (1.0, 2.0, 3.0) mm".
[[nodiscard]] std::string in_words(const Hit& hit);

/// The tool, pointing to machine -z: ball, shaft from its centre up, holder above the shaft. Shaft
/// and holder are modelled with round ends, as swept balls, which is slightly more than the real
/// tool.
struct Tool {
  double tip_radius_mm = 2.0;
  double shaft_length_mm = 0.0;  ///< 0: only the ball is considered.
  double shaft_radius_mm = 0.0;
  double holder_radius_mm = 0.0;  ///< 0: no holder.
};

/// All obstacles in the cell during the inspection of one feature, as simple solids: the surface,
/// sections of the part beside it, clamping ring, rim of the bowl, table, reference sphere with its
/// stem, spheres on base and ring of the fixture, balls of a calibration, the bodies of the plan;
/// and the volume of the machine.
class Scene {
 public:
  /// @param touched  `center_mm`, in `plan` itself, of the sphere that is to be touched, which is
  ///                 then no obstacle; null: all spheres are.
  Scene(const Plan& plan, const FeaturePlan& feature,
        const std::array<double, 3>* touched = nullptr);

  [[nodiscard]] const Tool& tool() const { return tool_; }
  /// The first place on these moves where the tool comes too close, if there is one. Exact except
  /// for the margins of Obstacle::meets(), which err on the safe side.
  [[nodiscard]] std::optional<Hit> first_hit(const Way& way, const Placement& placement,
                                             const PathGeometry& geometry) const;

 private:
  enum class Frame { kMachine, kSeat, kPart, kBodies };
  struct Solid {
    Body body = Body::kFeature;
    Frame frame = Frame::kMachine;
    BodyPlan::Frame of = BodyPlan::Frame::kBase;  ///< Of Frame::kBodies.
    /// From its frame to its own one.
    Eigen::Isometry3d into_own = Eigen::Isometry3d::Identity();
    Revolved shape;
    std::shared_ptr<const SolidMesh> mesh = {};  ///< In place of `shape`.
    double more_mm = 0.0;                        ///< Kept beside what the move keeps.
    std::string name = {};                       ///< Of a body of the plan.
    std::vector<Obstacle> grown = {};            ///< Solids with the clearances requested so far.
  };

  void add(Body body, Frame frame, const Eigen::Vector3d& origin_mm, const Revolved& shape);
  void add_part(const Plan& plan, const FeaturePlan& feature);
  void add_bodies(const FixturePlan& fixture, bool with_part);
  void add_cell(const Plan& plan, const FeaturePlan& feature);
  void add_spheres(const Plan& plan, const FeaturePlan& feature,
                   const std::array<double, 3>* touched);
  struct Gap {
    double mm;
    const char* key;
  };
  /// What this limb keeps from a body in a phase; none where it may touch.
  [[nodiscard]] static std::optional<Gap> gap(Body body, Limb limb, Phase phase,
                                              const PathGeometry& geometry);
  [[nodiscard]] static bool meets(Solid& solid, const Sweep& sweep, double room_mm);
  [[nodiscard]] Eigen::Isometry3d machine_into(const Solid& solid,
                                               const Placement& placement) const;
  [[nodiscard]] bool inside_volume(const Eigen::Vector3d& tip_W_mm) const;

  Tool tool_;
  FixturePlan fixture_;
  Eigen::Vector3d volume_min_mm_;
  Eigen::Vector3d volume_max_mm_;
  mutable std::vector<Solid> solids_;
};

}  // namespace rondure::plans
