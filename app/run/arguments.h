#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "record/words.h"

namespace rondure::app {

struct RunArguments {
  std::string plan;       ///< With `resume` also a run directory.
  std::string plan_text;  ///< The plan itself, where `plan` names no file; empty: it does.
  /// What the person calls a place of plan_text, given as JSON pointer; none: the pointer.
  std::function<std::string(const std::string&)> place_name = {};
  std::string out;  ///< Empty: runs/<plan>-<UTC>.
  bool resume = false;
  bool relocate = false;  ///< With `resume`: a part that has moved is located again.
  std::string serial;
  std::string operator_name;
  std::string order;
  std::string customer;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> formats;    ///< Empty: as the plan says.
  std::string language = "en";         ///< Language of page and summary: "en" or "zh".
  bool detail = false;                 ///< All of the page is open.
  std::optional<record::Paper> paper;  ///< Paper of report.pdf; none: as the plan says.
  std::string archive;                 ///< Empty: as the plan says.
  std::string wire_log;                ///< Empty: none.
  bool quiet = false;
  bool verbose = false;  ///< All details after the answer.
  bool step = false;     ///< Each move is confirmed on the terminal and made at reduced speed.
  std::string watch;     ///< Port of the live page; "auto": any free one; empty: no page.
  bool control = false;  ///< With `watch`: a button that stops the run.
  std::optional<double> speed;  ///< Simulated seconds per second; none: no waiting.
};

}  // namespace rondure::app
