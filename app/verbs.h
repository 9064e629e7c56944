#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rondure::app {

/// Exit status of the program (DESIGN, command line).
enum Exit : int {
  kAllWell = 0,  ///< Done; for run and report: everything conforms or is not toleranced.
  kNotConforming =
      1,  ///< Finished, but something does not conform, is undecided or void; verify: not equal.
  kBadInput = 2,   ///< Plan, file or arguments; verify: unreadable.
  kRunFailed = 3,  ///< Machine, fixture or run failed; what was measured is kept.
};

struct ValidateArguments {
  std::string plan;
};
[[nodiscard]] int validate(const ValidateArguments& arguments);

struct RunArguments {
  std::string plan;
  std::string out;  ///< Empty: runs/<plan>-<UTC>.
  std::string serial;
  std::string operator_name;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> formats;  ///< Empty: as the plan says.
  bool quiet = false;
};
[[nodiscard]] int run(const RunArguments& arguments);

struct ReportArguments {
  std::string directory;
  std::vector<std::string> formats;
};
[[nodiscard]] int report(const ReportArguments& arguments);

struct VerifyArguments {
  std::string directory;
  std::string key;  ///< Public key file; empty: the signature is not checked.
};
[[nodiscard]] int verify(const VerifyArguments& arguments);

struct SignArguments {
  std::string directory;
  std::string key;  ///< Private key file.
};
[[nodiscard]] int sign(const SignArguments& arguments);

struct FitArguments {
  std::string shape;  ///< "circle", "cylinder", "sphere" or "line".
  std::string file;
  std::string reference = "all";
  bool json = false;
};
[[nodiscard]] int fit(const FitArguments& arguments);

struct RoundnessArguments {
  std::string file;
  std::string filter = "gaussian";
  std::string pass = "low";
  std::string reference = "all";
  std::vector<double> cutoff_upr = {50.0};  ///< Two for a band.
  bool override_sampling = false;
  bool inside = false;
  bool json = false;
};
[[nodiscard]] int roundness(const RoundnessArguments& arguments);

struct SelfTestArguments {
  double cutoff_upr = 50.0;  ///< Of the table; the standard ones are checked besides.
};
[[nodiscard]] int selftest_filters(const SelfTestArguments& arguments);

}  // namespace rondure::app
