#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Core>

#include "cmm/ipp/grammar.h"
#include "cmm/ipp_server/backend.h"
#include "cmm/ipp_server/controller.h"
#include "cmm/ipp_server/parameters.h"
#include "wire/tcp_line.h"

namespace rondure::cmm::ipp {

/// Differences among servers of this kind.
struct SeenProfile {
  bool tells_version = true;           ///< false: GetDMEVersion is 0507, as before 1.4.
  bool has_scan_parameters = true;     ///< false: Tool.ScanPar is 0502.
  bool scans = true;                   ///< false: OnScanReport and ScanOnCircle are 0507.
  bool takes_negative_retract = true;  ///< false: clamped to 0 with 0504.
  bool irregular_scans =
      false;  ///< Steps +-3 %, starts within a degree, 2 % of the points missing.
  double tip_radius_mm = 2.0;
  ParameterDefaults defaults;
  /// Simulated seconds of a GoTo per second of the clock; everything else takes no time.
  double speed = std::numeric_limits<double>::infinity();
};

/// Double of the independent server whose dialogue was recorded (tests/data/ipp_dme_dialogue), with
/// a machine behind it. It shares only the grammar with the program. Its answers are those of the
/// recorded server, also where the specification says otherwise.
///
///   values of Get and PtMeas in alphabetical order, Q first in scans; five decimals
///   PtMeas and ScanOnCircle take surface points: the tip centre is a tip radius farther out
///   R refused in GoTo (0502); x = R x_machine + x0; names it does not know 0502, methods 0507
///   the class of the machine as a string, AlignPart answered with vectors in parentheses
///   errors that name the whole command; EndSession refused in an error state (0514)
///   a second StartSession is 0507; AbortE drops what is pending without a word, and daemons
///   the step of a scan is a mean
class SeenServer {
 public:
  SeenServer(Backend& backend, const SeenProfile& profile);

  /// Takes a line from the client. `now_s` is any clock that does not go back.
  void receive(const RawLine& line, double now_s);
  /// Advances motions to the time `now_s`.
  void advance(double now_s);
  /// Called when the client has disconnected.
  void disconnect();
  /// Lines to send, in order.
  [[nodiscard]] std::vector<std::string> take_output();

 private:
  struct Answer {
    std::vector<std::string> data;
    int error = 0;
  };
  struct Move {
    Command command;
    Eigen::Vector3d from_W_mm;
    Eigen::Vector3d to_W_mm;
    double begin_s = 0.0;
    double end_s = 0.0;
  };
  struct Daemon {
    Tag tag;
    double interval_s = 0.1;
    double distance_mm = std::numeric_limits<double>::infinity();
    std::vector<std::string> names;
    double last_s = 0.0;
    Eigen::Vector3d last_W_mm = Eigen::Vector3d::Zero();
  };

  void work(double now_s);
  void close(const Command& command, const Answer& answer);
  void tell_error(const Tag& tag, int number, const std::string& text);
  [[nodiscard]] Answer execute(const Command& command, double now_s);
  [[nodiscard]] Answer in_session(const Command& command, double now_s);
  [[nodiscard]] Answer errors_and_daemons(const Command& command, double now_s);
  [[nodiscard]] Answer tools_and_properties(const Command& command);
  [[nodiscard]] Answer frames(const Command& command);
  [[nodiscard]] Answer reports(const Command& command);
  [[nodiscard]] Answer motions(const Command& command, double now_s);
  [[nodiscard]] Answer touch(const Command& command);
  [[nodiscard]] Answer scan(const Command& command);
  [[nodiscard]] Answer align(const Command& command);
  [[nodiscard]] Answer abort(double now_s);
  [[nodiscard]] std::optional<Eigen::Vector3d> target(const Command& command) const;
  [[nodiscard]] std::string place(std::vector<std::string> names,
                                  const Eigen::Vector3d& tip_W_mm) const;
  [[nodiscard]] Eigen::Vector3d tip_now_W_mm(double now_s) const;
  [[nodiscard]] Eigen::Vector3d to_csy(const Eigen::Vector3d& p_W_mm) const;
  [[nodiscard]] Eigen::Vector3d from_csy(const Eigen::Vector3d& p_mm) const;

  Backend& backend_;
  SeenProfile profile_;
  ToolParameters parameters_;
  std::string tool_;
  bool session_ = false;
  bool error_ = false;
  bool in_part_csy_ = false;
  CsyTransformation part_csy_;
  std::vector<std::string> touch_report_ = {"X", "Y", "Z"};
  std::vector<std::string> scan_report_ = {"Q", "X", "Y", "Z"};
  std::deque<Command> pending_;
  std::optional<Move> move_;
  std::vector<Daemon> daemons_;
  std::vector<std::string> output_;
  std::int64_t touches_ = 0;
  std::mt19937_64 random_{1};
};

/// Runs such a server on a port of this computer, one client after the other, from a thread of its
/// own, until it is destroyed.
class SeenService {
 public:
  SeenService(Backend& backend, const SeenProfile& profile);
  ~SeenService();
  SeenService(const SeenService&) = delete;
  SeenService& operator=(const SeenService&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void serve(wire::LineTransport& client);

  SeenServer server_;
  wire::TcpListener listener_;
  std::uint16_t port_;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace rondure::cmm::ipp
