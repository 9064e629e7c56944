#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/error.h"
#include "core/pose.h"
#include "evaluation/results/evaluation.h"
#include "record/points/points.h"
#include "record/run_record.h"

// The touches of a pose as a cloud, and f of that cloud.

namespace rondure::evaluation {

/// The measuring touches of a pose, in the order of touching.
[[nodiscard]] std::vector<const record::Touch*> touches_of(const record::RunRecord& record,
                                                           int pose);

/// The cloud of some touches, in the order of layer, pass (where there are several) and point. The
/// repeats of a point are averaged where they lie at one place. Scans only keep about the requested
/// step: their n-th points lie at different angles, and averaging them would smooth the form and
/// cut the chords. Every touch is then a point of its own, with the noise of one touch.
[[nodiscard]] std::vector<CloudPoint> measured_cloud(
    const std::vector<const record::Touch*>& touches);

/// Number of passes over the layers in a cloud: 1 where repeats were averaged.
[[nodiscard]] int passes_of(const std::vector<CloudPoint>& cloud);

/// Noise of one touch, estimated from repeated touches [mm].
struct RepeatNoise {
  double sigma_mm = 0.0;
  int freedom = 0;  ///< Degrees of freedom; 0: no estimate.
};

/// For averaged places: from the scatter of their touches along the approach. For passes that were
/// not averaged: from points of two passes that lie close to each other.
/// @param cloud  With angles and deviations about its axis.
[[nodiscard]] RepeatNoise repeat_noise(const std::vector<const record::Touch*>& touches,
                                       const std::vector<CloudPoint>& cloud);

[[nodiscard]] std::vector<Eigen::Vector3d> tips_of(const std::vector<CloudPoint>& cloud);

/// x and y of the points after rotation.
[[nodiscard]] std::vector<Eigen::Vector2d> projected(const std::vector<Eigen::Vector3d>& points,
                                                     const Eigen::Matrix3d& turn);

/// Directions of angle 0 and of a quarter turn about an axis of a feature, as the angles of its
/// cloud have them: from part x as far as the axis allows (y for an axis near x), counter-clockwise
/// seen against part z.
[[nodiscard]] Eigen::Matrix<double, 3, 2> frame_of_angles(const FeatureResult& feature,
                                                          const Eigen::Vector3d& direction);

/// The warning about rows of a points file that take no part.
[[nodiscard]] core::Error repeated_rows(const record::RepeatedRows& rows);

/// Whether the plan of a run says that the part stands still, without a fixture.
[[nodiscard]] bool stands_still(const record::Feature& feature);

/// Turns the frame of the part to that of the machine for what was touched in a pose: as the plan
/// states the axis of the part, as the pose turns it, and as the run found the base or the part.
[[nodiscard]] Eigen::Matrix3d part_turn(const record::RunRecord& record,
                                        const record::PoseVisit& visit);

/// Rotation of the body by a pose: Rx(alpha) Ry(beta).
[[nodiscard]] Eigen::Matrix3d rotation(const core::Pose& pose);

/// f of a section by the centre search of the strategy; does not set pose and marks.
[[nodiscard]] PoseValue pose_value(const std::vector<Eigen::Vector2d>& section,
                                   record::Strategy strategy);

/// Whether the cloud of a pose is evaluated. A part that was located again while its final cloud
/// was repeated has two marked clouds: the later one counts. All merged poses count.
[[nodiscard]] bool is_final(const record::RunRecord& record, const record::PoseVisit& visit);

/// Whether all of a feature was measured: features are measured one after another, so that of an
/// unfinished run those are complete after which another one was begun, and analyses with data
/// before the last.
[[nodiscard]] bool is_complete(const record::RunRecord& record, std::size_t feature);

/// f of a pose from its own touches; none without touches, or without a fixture.
[[nodiscard]] std::optional<PoseValue> value_of_pose(const record::RunRecord& record,
                                                     const record::PoseVisit& visit,
                                                     record::Strategy strategy);

}  // namespace rondure::evaluation
