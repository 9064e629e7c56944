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

/// Identity of the server.
struct Identity {
  std::string version;             ///< "1.4"; "before 1.4" when the server cannot report it.
  std::string machine_class;       ///< "CartCMMWithRotaryTable"; "" when not reported.
  std::vector<std::string> tools;  ///< Without the reserved names that cannot measure.
  bool scans = false;              ///< The server accepts a scan report.
  std::string no_scans;            ///< Why it cannot scan.
  bool has_temperatures = false;   ///< The server may report temperatures of part and scales.
  bool tells_time = false;         ///< Points are reported with temperature and machine time.
  bool simulated = false;          ///< The server is rondure simulate-cmm.
};

/// Values reported with a probed point.
struct PointReport {
  Eigen::Vector3d tip_W_mm = Eigen::Vector3d::Zero();
  std::optional<double> tip_radius_mm;           ///< ER.
  std::optional<Eigen::Vector3d> normal_W;       ///< IJK, if the server reports it unasked.
  std::optional<double> temperature_degC;        ///< Part temperature.
  std::optional<double> scale_temperature_degC;  ///< Temperature of the machine scales.
  std::optional<double> time_s;
};

/// Finds a value of the reply by name, in any position: servers change the order, spread values
/// over several lines, and put them inside the name of a method.
[[nodiscard]] const Item* find_value(const Reply& reply, std::string_view name);
[[nodiscard]] std::optional<double> find_number(const Reply& reply, std::string_view name);
/// X, Y and Z.
[[nodiscard]] core::Result<Eigen::Vector3d> find_point(const Reply& reply);
/// All vectors, written in parentheses or as bare numbers, three per vector.
[[nodiscard]] std::vector<Eigen::Vector3d> find_vectors(const Reply& reply);
/// All bare numbers in groups of three, as reported by a scan with X(),Y(),Z().
[[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> scan_points(const Reply& reply);

/// The requests of a client, as values instead of lines. Errors that only refuse a request are
/// cleared at once (is_refusal()); any other error leaves the server in its error state and is kept
/// as fault() until clear().
class Dialogue {
 public:
  using Milliseconds = std::chrono::milliseconds;

  Dialogue(std::unique_ptr<wire::LineTransport> line, const SessionOptions& options,
           Milliseconds limit);
  ~Dialogue();  ///< Ends the session with EndSession() if the connection still works.
  Dialogue(const Dialogue&) = delete;
  Dialogue& operator=(const Dialogue&) = delete;

  /// Starts a new session, identifies the server, keeps the machine frame active and sets the
  /// contents of reports. kMachine when the server uses another language or version, or reports a
  /// fault.
  [[nodiscard]] core::Result<Identity> start();

  /// One command with its answer.
  [[nodiscard]] Outcome<Reply> ask(std::string_view method, std::vector<Item> arguments = {});
  /// ask() for a motion, with its own time limit; a requested stop ends it.
  [[nodiscard]] Outcome<Reply> move(std::string_view method, std::vector<Item> arguments,
                                    Milliseconds limit);
  /// As ask(); nothing when the server does not know the command, argument or property, or knows it
  /// only with a tool.
  [[nodiscard]] core::Result<std::optional<Reply>> ask_if_known(std::string_view method,
                                                                std::vector<Item> arguments);

  /// Chooses the coordinate system of everything that is said from then on: MachineCsy, PartCsy.
  [[nodiscard]] core::Result<void> choose_system(std::string_view name);
  /// Where the tip stands, in the chosen system; start() chooses that of the machine.
  [[nodiscard]] core::Result<Eigen::Vector3d> position_W_mm();
  [[nodiscard]] core::Result<bool> is_homed();
  /// Name of the active tool; "" for none.
  [[nodiscard]] core::Result<std::string> active_tool();
  /// The number of a property, or nothing when the server does not have it.
  [[nodiscard]] core::Result<std::optional<double>> property(std::string_view name);
  /// Sets the properties whose values differ. kOutOfRange when the server clamps one.
  [[nodiscard]] core::Result<void> set(std::span<const std::pair<std::string_view, double>> values);
  /// Whether the active tool may have a property or block of properties; false when the server
  /// lists its properties and this one is missing. Avoids requests that the server would refuse.
  [[nodiscard]] core::Result<bool> tool_may_have(std::string_view name);
  /// After a tool change the properties have the defaults of the tool and must be read again.
  void forget_properties() {
    known_.clear();
    tool_list_.reset();
  }

  [[nodiscard]] core::Result<PointReport> point_of(const Reply& reply) const;

  /// The fault reported by the machine; "" when there is none.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Blocks every motion until clear().
  void hold(std::string why) { fault_ = std::move(why); }
  /// Clears errors with ClearAllErrors(). kMachine, with the message of the machine, when an error
  /// remains.
  [[nodiscard]] core::Result<void> clear();
  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] const Session& session() const { return session_; }

 private:
  [[nodiscard]] core::Result<void> fresh_session();
  [[nodiscard]] core::Result<void> check_state();
  [[nodiscard]] core::Result<std::string> version();
  [[nodiscard]] core::Result<void> choose_reports(Identity& identity);
  [[nodiscard]] core::Result<bool> is_simulator();
  /// The properties of the active tool as listed by the server; "" when it has no list.
  [[nodiscard]] core::Result<std::string> tool_list();
  /// Clears a refusal; keeps any other failure as the fault.
  void settle(const Failure& failure);

  Session session_;
  Milliseconds limit_;
  std::map<std::string, double, std::less<>> known_;  ///< Properties set by this client.
  std::optional<std::string> tool_list_;              ///< Reply to EnumAllProp(Tool()), unparsed.
  std::string fault_;
  bool started_ = false;
};

}  // namespace rondure::cmm::ipp::client
