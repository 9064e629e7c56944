#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cmm/ipp_client/session.h"
#include "cmm/machine.h"
#include "core/result.h"

namespace rondure::cmm::ipp::client {

/// Who answers at the other end.
struct Identity {
  std::string version;             ///< "1.4"; "before 1.4" of a server that cannot say.
  std::string machine_class;       ///< "CartCMMWithRotaryTable"; "" of a server that cannot say.
  std::vector<std::string> tools;  ///< Without the reserved names that measure nothing.
  bool scans = false;              ///< It takes a scan report.
  std::string no_scans;            ///< Why not.
  bool has_temperatures = false;   ///< It may know those of part and scales.
  bool tells_temperature = false;  ///< Points come with the temperature of the part,
  bool tells_time = false;         ///< and with the time of the machine's clock [s].
  bool simulated = false;          ///< It is rondure simulate-cmm.
};

/// What a probed point came with.
struct PointReport {
  Eigen::Vector3d tip_W_mm = Eigen::Vector3d::Zero();
  std::optional<double> tip_radius_mm;           ///< ER.
  std::optional<Eigen::Vector3d> normal_W;       ///< IJK, where the server gives it unasked.
  std::optional<double> temperature_degC;        ///< Of the part.
  std::optional<double> scale_temperature_degC;  ///< Of the scales of the machine.
  std::optional<double> time_s;
};

/// The values of the reply by name, wherever they stand: servers change the order, spread them over
/// lines, and put them inside the name of a method.
[[nodiscard]] const Item* find_value(const Reply& reply, std::string_view name);
[[nodiscard]] std::optional<double> find_number(const Reply& reply, std::string_view name);
/// X, Y and Z.
[[nodiscard]] core::Result<Eigen::Vector3d> find_point(const Reply& reply);
/// All vectors, written in parentheses or as bare numbers, three a vector.
[[nodiscard]] std::vector<Eigen::Vector3d> find_vectors(const Reply& reply);
/// All bare numbers in groups of three, as a scan with the report X(),Y(),Z() gives them.
[[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> scan_points(const Reply& reply);

/// What a client asks of a server, in values instead of lines. Errors of the server that are mere
/// refusals are taken back at once (is_refusal()); another one leaves the server in its error state
/// and is kept as fault() until clear().
class Dialogue {
 public:
  using Milliseconds = std::chrono::milliseconds;

  Dialogue(std::unique_ptr<wire::LineTransport> line, const SessionOptions& options,
           Milliseconds limit);
  ~Dialogue();  ///< Ends the session politely, where it still goes on.
  Dialogue(const Dialogue&) = delete;
  Dialogue& operator=(const Dialogue&) = delete;

  /// Begins a fresh session, asks who answers, keeps the machine frame active and says what reports
  /// shall hold. kMachine when the server speaks another language or version, or reports a fault.
  [[nodiscard]] core::Result<Identity> start();

  /// One command with its answer.
  [[nodiscard]] Outcome<Reply> ask(std::string_view method, std::vector<Item> arguments = {});
  /// The same for a motion: with its own time limit, and ended when a stop is asked for.
  [[nodiscard]] Outcome<Reply> move(std::string_view method, std::vector<Item> arguments,
                                    Milliseconds limit);
  /// As ask(); nothing when the server does not know the command, argument or property, or does
  /// not without a tool.
  [[nodiscard]] core::Result<std::optional<Reply>> ask_if_known(std::string_view method,
                                                                std::vector<Item> arguments);

  [[nodiscard]] core::Result<Eigen::Vector3d> position_W_mm();
  [[nodiscard]] core::Result<bool> is_homed();
  /// Name of the active tool; "" for none.
  [[nodiscard]] core::Result<std::string> active_tool();
  /// The number of a property, or nothing when the server does not have it.
  [[nodiscard]] core::Result<std::optional<double>> property(std::string_view name);
  /// Sets properties that have not these values already. kOutOfRange when the server clamps one.
  [[nodiscard]] core::Result<void> set(std::span<const std::pair<std::string_view, double>> values);
  /// Whether the active tool may have a property or block of properties; false where the server
  /// lists those it has, and this one is not among them. Asked so that a server need not refuse.
  [[nodiscard]] core::Result<bool> tool_may_have(std::string_view name);
  /// A tool change gives the properties their own values again, and may give others.
  void forget_properties() {
    known_.clear();
    tool_list_.reset();
  }

  [[nodiscard]] core::Result<PointReport> point_of(const Reply& reply) const;

  /// What the machine reports; "" when all is well.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Keeps the machine still from here until clear().
  void hold(std::string why) { fault_ = std::move(why); }
  /// Takes errors back: ClearAllErrors(). kMachine, with what the machine says, when one stays.
  [[nodiscard]] core::Result<void> clear();
  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] const Session& session() const { return session_; }

 private:
  [[nodiscard]] core::Result<void> fresh_session();
  [[nodiscard]] core::Result<void> check_state();
  [[nodiscard]] core::Result<std::string> version();
  [[nodiscard]] core::Result<void> choose_reports(Identity& identity);
  [[nodiscard]] core::Result<bool> is_simulator();
  /// The properties of the active tool as the server lists them; "" where it does not.
  [[nodiscard]] core::Result<std::string> tool_list();
  /// Takes back a refusal, keeps anything else as the fault.
  void settle(const Failure& failure);

  Session session_;
  Milliseconds limit_;
  std::map<std::string, double, std::less<>> known_;  ///< Properties as set from here.
  std::optional<std::string> tool_list_;  ///< What EnumAllProp(Tool()) told, as it came.
  std::string fault_;
  bool started_ = false;
};

}  // namespace rondure::cmm::ipp::client
