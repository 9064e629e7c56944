#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/run/arguments.h"
#include "app/text/answer.h"
#include "fit/spindle/probe_layout.h"
#include "record/archive/archive.h"
#include "record/points/points.h"
#include "record/words.h"

namespace CLI {
class App;
}

namespace rondure::plans {
struct Plan;
}

namespace rondure::app {

struct ValidateArguments {
  std::string plan;
};
[[nodiscard]] int validate(const ValidateArguments& arguments);
/// Says on the terminal what a valid plan hardly means: plans::doubts_of().
void tell_doubts(const std::vector<core::Error>& doubts);

struct PlanArguments {
  std::string plan;
  bool json = false;
  std::string svg;                             ///< File for a picture; empty: none.
  std::string feature;                         ///< Feature to draw; empty: the first.
  std::optional<std::string> target_expanded;  ///< Length with unit, the largest U allowed.
};
[[nodiscard]] int plan(const PlanArguments& arguments);

[[nodiscard]] int run(const RunArguments& arguments);

struct SimulateCmmArguments {
  std::string plan;
  std::uint16_t port = 1294;
  std::string address = "127.0.0.1";
  double speed = 1.0;  ///< Simulated seconds per second; infinity: no waiting.
  std::optional<std::uint64_t> seed;
  double silence_limit_s = 60.0;  ///< Another client may replace one that is silent for this time.
  std::string profile = "as-specified";  ///< Name of one of cmm::ipp::profiles().
  std::string wire_log;                  ///< File; empty: none.
};
[[nodiscard]] int simulate_cmm(const SimulateCmmArguments& arguments);

struct ReportArguments {
  std::string directory;
  std::vector<std::string> formats;
  std::string language = "en";         ///< Language of page and summary: "en" or "zh".
  bool detail = false;                 ///< All of the page is open.
  bool verbose = false;                ///< All details after the answer.
  std::optional<record::Paper> paper;  ///< Paper of report.pdf; none: as the plan says.
};
[[nodiscard]] int report(const ReportArguments& arguments);

struct VerifyArguments {
  std::string directory;
  std::string key;  ///< Public key file; empty: the signature is not checked.
};
[[nodiscard]] int verify(const VerifyArguments& arguments);

struct CompareArguments {
  std::string directory;
  bool all = false;  ///< Prints every combination.
  bool json = false;
};
[[nodiscard]] int compare(const CompareArguments& arguments);

struct HistoryArguments {
  std::optional<std::string> archive;  ///< By default runs/archive.db.
  record::ArchiveFilter filter;
  std::string since;  ///< Day or time, UTC; also for `until`.
  std::string until;
  std::string verdict;  ///< Words separated by blanks or hyphens.
  /// Number of runs, default 50; of results for charts, default 1000, and for CSV, default all.
  std::optional<std::size_t> last;
  bool chart = false;
  bool json = false;
  std::string csv;  ///< File, or "-".
  std::string svg;
  bool push = false;
  std::string queue = "runs/archive-queue.db";
  std::vector<std::string> add;  ///< Run directories.
};
[[nodiscard]] int history(const HistoryArguments& arguments);

struct ExplainArguments {
  std::string code;  ///< Of a message, with or without its brackets; empty: lists all.
};
[[nodiscard]] int explain(const ExplainArguments& arguments);

struct SignArguments {
  std::string directory;
  std::string key;  ///< Private key file.
};
[[nodiscard]] int sign(const SignArguments& arguments);

struct FitArguments {
  std::string shape;  ///< "circle", "cylinder", "cone", "sphere", "plane" or "line".
  std::string file;
  record::PointsOptions points;  ///< How the file is read.
  std::string reference = "all";
  std::vector<std::string> sizes;  ///< "GG", "GN", "GX", "GC", "LP".
  std::optional<double> tip_diameter_mm;
  record::PointsAre points_are = record::PointsAre::kTipCentres;
  bool inside = false;
  std::vector<double> outward;  ///< Of a plane, three numbers; empty: not known.
  bool json = false;
  // The following members ask for a plan in memory, see fit_or_run().
  std::string out;                     ///< Run directory; empty: no run.
  std::string save_plan;               ///< File for the plan; empty: none.
  std::optional<double> tolerance_um;  ///< Of the form; none: the value is reported, not judged.
  std::string part;                    ///< Empty: the name of the file.
  std::string drawing;
  std::string serial;
  std::string operator_name;
};
[[nodiscard]] int fit(const FitArguments& arguments);
/// The points that a fit takes; errors name the file, or its line.
[[nodiscard]] core::Result<record::PointTable> load_points(const FitArguments& arguments);
/// fit(), or with `out` or `save_plan` the plan of which `arguments` are the settings: it is
/// written or run, to a page and a journal that `verify` and `sign` take like any other.
/// @return  Exit status of the program.
[[nodiscard]] int fit_or_run(const FitArguments& arguments);

struct RoundnessArguments {
  std::string file;
  record::PointsOptions points;
  std::string filter = "gaussian";
  std::string pass = "low";
  std::string reference = "all";
  std::vector<double> cutoff_upr = {50.0};  ///< Two for a band.
  bool override_sampling = false;
  bool inside = false;
  bool json = false;
};
[[nodiscard]] int roundness(const RoundnessArguments& arguments);

/// A plan in memory: one feature of the type, its files and keys.
struct AnalysisArguments {
  std::string type;                   ///< "wheel", "spindle" or "contour".
  std::vector<std::string> files;     ///< One; of a contour the gauge's, one a pin.
  std::vector<std::string> axes;      ///< Of a contour, one a pin, or none.
  std::vector<std::string> main;      ///< The same.
  std::vector<std::string> settings;  ///< "KEY=VALUE" each.
  std::vector<std::string> asked;     ///< "FORM" or "FORM=LIMIT" each; empty: the usual ones.
  bool json = false;
  std::string out;        ///< Run directory; empty: the run leaves nothing behind.
  std::string save_plan;  ///< File for the plan; empty: none.
  std::string serial;
  std::string operator_name;
};
/// Evaluates the files as a run of that plan, and prints its summary or report.json, or writes the
/// plan or the run.
[[nodiscard]] int fit_analysis(const AnalysisArguments& arguments);

struct RotaryAxesArguments {
  std::vector<std::string> files;
  std::string axis;               ///< x, y, z or a,b,c; empty: by the name of the axis.
  std::vector<double> origin_mm;  ///< Empty: 0,0,0.
  double reference_deg = 0.0;
  std::vector<double> range_deg;  ///< Range of the axis; empty: any.
  std::string method = "exact";
  std::string curve = "spline";
  std::vector<double> place_mm;  ///< Place whose uncertainty is stated; empty: the origin.
  bool keep_outliers = false;
  double repeat_urad = 0.0;  ///< Of the axis.
  /// Of the coordinates y and z at which tools hold the balls, each set up by itself; none: all
  /// balls stand on one plate.
  std::optional<double> tool_um;
  bool json = false;
};
[[nodiscard]] int rotary_axes(const RotaryAxesArguments& arguments);

struct DesignArguments {
  fit::LayoutSearch search;                    ///< Its ranges come from the two members below.
  std::vector<double> p2_deg = {40.0, 140.0};  ///< Lower and upper end of the range.
  std::vector<double> p3_deg = {-140.0, -40.0};
  bool json = false;
};
[[nodiscard]] int design_probes(const DesignArguments& arguments);

struct RecordArguments {
  std::vector<std::string> probes;  ///< Words as listed by indicator_words().
  double from_deg = 0.0;
  double step_deg = 10.0;
  int count = 36;
  std::string out;
  bool inches = false;
  std::optional<double> rate_Hz;  ///< Always refused, with the reason.
};
/// The words that name an indicator, for help and messages.
[[nodiscard]] std::string indicator_words();
[[nodiscard]] int record_readings(const RecordArguments& arguments);

struct DevicesArguments {
  bool json = false;
};
[[nodiscard]] int devices(const DevicesArguments& arguments);

struct ServerDeviceArguments {
  std::string place;     ///< HOST or HOST:PORT.
  double limit_s = 5.0;  ///< Time limit for the connection and for each answer.
  bool json = false;
};
/// Surveys an I++ DME server; nothing moves.
[[nodiscard]] int server_device(const ServerDeviceArguments& arguments);

// The command line of `fit`, and of the verbs below it.
void add_fit(CLI::App& app, FitArguments& arguments);
void add_roundness(CLI::App& fit_verb, RoundnessArguments& arguments);
void add_spindle(CLI::App& fit_verb, AnalysisArguments& arguments);
void add_contour(CLI::App& fit_verb, AnalysisArguments& arguments);
void add_wheel(CLI::App& fit_verb, AnalysisArguments& arguments);
void add_rotary_axes(CLI::App& fit_verb, RotaryAxesArguments& arguments);

}  // namespace rondure::app
