#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <tl/expected.hpp>

#include "cmm/ipp/grammar.h"
#include "cmm/ipp_server/backend.h"
#include "cmm/ipp_server/profile.h"
#include "cmm/machine.h"

namespace rondure::cmm::ipp {

/// The six numbers of SetCsyTransformation().
struct CsyTransformation {
  Eigen::Vector3d x0_mm = Eigen::Vector3d::Zero();
  double theta_deg = 0.0;  ///< 0..180.
  double psi_deg = 0.0;
  double phi_deg = 0.0;
};

/// Maps the machine frame to the system: rotation about z by psi, about the new x by theta, about
/// the new z by phi, x_csy = R (x_machine - x0). This follows the chapter on machines, and VDMA
/// 8722; the description of the command in 1.4.3 has x_csy = R x_machine + x0, and servers use one
/// or the other.
[[nodiscard]] Eigen::Isometry3d machine_to_csy(const CsyTransformation& transformation);

/// The transformation to a system whose frame is `X_WC` in that of the machine.
/// @param adds_origin  x_csy = R x_machine + x0.
[[nodiscard]] CsyTransformation transformation_to(const Eigen::Isometry3d& X_WC, bool adds_origin);

/// Settings of a server that the machine does not report itself.
struct ControllerOptions {
  ParameterDefaults defaults;
  NamedPoint point = NamedPoint::kSurface;
  NumberForm numbers = NumberForm::kSixteenDigits;
  double tip_radius_mm = 2.0;      ///< Tool.AvrRadius().
  double temperature_degC = 20.0;  ///< Part temperature, until the first touch has measured it.
  std::string version = "1.4";     ///< GetDMEVersion().
  Profile profile;
};

/// A part of a motion.
struct Phase {
  /// A straight move, made at the end of its time: until then it can be stopped anywhere.
  std::function<Eigen::Vector3d()> target_W_mm;
  /// Any other action: executed at once, then its time passes. Returns the corners of the tip's
  /// path.
  std::function<core::Result<std::vector<Eigen::Vector3d>>()> act;
};

/// A command that takes time.
struct Motion {
  std::vector<Phase> phases;
  std::function<Reply()> reply;  ///< After the last phase.
};

/// State and functions of a server, without tags, queues and time: tools, properties, coordinate
/// systems, reports, and the conversion of a command into a motion of the machine.
///
/// Positions are those of the tip centre. PtMeas(X, Y, Z, IJK) expects the surface, or by
/// ControllerOptions::point the tip centre, at (X,Y,Z). It searches from Approach * IJK before the
/// tip centre expected at contact to Search * IJK beyond it. ScanOnCircle probes its start point
/// likewise and then expects the tip on the circle through it.
class Controller {
 public:
  Controller(Backend& backend, const ControllerOptions& options);

  /// Restores the reports and hints that StartSession() sets.
  void begin_session();

  [[nodiscard]] static bool is_motion(std::string_view method);
  /// Executes a command without motion.
  [[nodiscard]] Outcome execute(const Command& command);
  /// Plans a command with motion; nothing moves yet.
  [[nodiscard]] tl::expected<Motion, Failure> plan_motion(const Command& command);

  /// The failure to report to a client for an error of machine or table.
  [[nodiscard]] Failure failure_of(const core::Error& error, std::string_view method);
  /// Values of the position, for Get() and daemons. 0505 for an unknown name.
  [[nodiscard]] tl::expected<std::vector<Item>, Failure> position_report(
      const std::vector<std::string>& names, const Eigen::Vector3d& tip_W_mm) const;

  [[nodiscard]] Machine& machine() { return backend_.machine(); }
  [[nodiscard]] Eigen::Vector3d position_W_mm() const { return backend_.machine().position_W_mm(); }
  [[nodiscard]] const ControllerOptions& options() const { return options_; }
  [[nodiscard]] bool is_homed();
  [[nodiscard]] bool is_user_enabled() const { return user_enabled_; }
  [[nodiscard]] double travel_speed_mm_s() const { return parameters_.speeds().travel_mm_s; }

 private:
  using Arguments = std::vector<Item>;
  using Handler = std::function<Outcome(Controller&, const Arguments&)>;
  struct Entry {
    std::string_view method;
    Handler handler;
    bool takes_arguments = true;
  };
  static const std::vector<Entry>& entries();

  // Answers and settings.
  Outcome get_error_info(const Arguments& arguments);
  Outcome get_supported_commands(const Arguments&);
  Outcome get_position(const Arguments& arguments);
  Outcome set_touch_report(const Arguments& arguments);
  Outcome set_scan_report(const Arguments& arguments);
  Outcome take_hint(const Arguments& arguments);
  Outcome temperature_sensors(const Arguments&);
  Outcome read_temperature(const Arguments& arguments);
  Outcome read_all_temperatures(const Arguments&);
  // Coordinate systems.
  Outcome set_coord_system(const Arguments& arguments);
  Outcome set_transformation(const Arguments& arguments);
  Outcome get_transformation(const Arguments& arguments);
  // Tools and properties.
  Outcome enum_tools(const Arguments&);
  Outcome change_tool(const Arguments& arguments);
  Outcome find_tool(const Arguments& arguments);
  Outcome get_properties(const Arguments& arguments);
  Outcome set_properties(const Arguments& arguments);
  Outcome enum_properties(const Arguments& arguments);
  Outcome enum_all_properties(const Arguments& arguments);
  [[nodiscard]] std::optional<Item> property(const std::string& name) const;
  [[nodiscard]] int set_property(const std::string& name, double value);
  [[nodiscard]] int set_simulation(std::string_view name, double value);
  // Motions.
  tl::expected<Motion, Failure> plan_home(const Arguments& arguments);
  tl::expected<Motion, Failure> plan_go_to(const Arguments& arguments);
  tl::expected<Motion, Failure> plan_touch(const Arguments& arguments);
  tl::expected<Motion, Failure> plan_scan(const Arguments& arguments);
  tl::expected<Motion, Failure> plan_align(const Arguments& arguments);
  /// The tip centre in contact for the point given in a command.
  [[nodiscard]] Eigen::Vector3d tip_at(const Eigen::Vector3d& named_W_mm,
                                       const Eigen::Vector3d& direction_W) const;
  Motion touch_motion(const TouchCommand& touch);
  Motion scan_motion(const ScanCircleCommand& scan);
  [[nodiscard]] std::vector<double> report_values(const std::string& name,
                                                  const TouchReading& reading,
                                                  const Eigen::Vector3d& direction_W) const;
  [[nodiscard]] Reply touch_reply(const TouchReading& reading,
                                  const Eigen::Vector3d& direction_W) const;
  [[nodiscard]] Reply align_reply(const std::vector<Alignment>& wanted,
                                  const std::vector<double>& limits_deg,
                                  const std::vector<Eigen::Vector3d>& reached) const;
  [[nodiscard]] Reply scan_reply(const std::vector<TouchReading>& readings) const;
  /// (X(..), Y(..), Z(..)) in the active system; a missing value keeps the current position.
  tl::expected<Eigen::Vector3d, Failure> position_argument(const Arguments& arguments,
                                                           bool direction_allowed);
  [[nodiscard]] tl::expected<void, Failure> ready_to_move();

  Backend& backend_;
  ControllerOptions options_;
  ToolParameters parameters_;
  std::string tool_;
  std::string found_tool_;
  std::string csy_ = "MachineCsy";
  CsyTransformation part_csy_;
  Eigen::Isometry3d X_CW_ = Eigen::Isometry3d::Identity();  ///< Machine to the active system.
  std::vector<std::string> touch_report_;
  std::vector<std::string> scan_report_;
  std::optional<TouchReading> last_reading_;
  bool user_enabled_ = false;
  double expansion_ = 0.0;       ///< Part.XpanCoefficient, stored for queries only.
  std::int64_t next_touch_ = 0;  ///< Number of the next touch: key of the simulated noise.
  int feature_ = 0;
};

}  // namespace rondure::cmm::ipp
