// How often the interval of a form value holds the truth, and how often the verdict from it is
// wrong. Nothing of the program is called but measurement_uncertainty() and apply_rule(): they are
// judged.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <numbers>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "benchmarks/coverage/inspection.h"
#include "evaluation/decision/decision.h"
#include "evaluation/uncertainty/uncertainty.h"

namespace rondure::coverage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kBatches = 50;  // that the usual trials of a cell are done in
constexpr std::array kMargins_um = {-0.5, -0.25, 0.0, 0.25, 0.5, 1.0, 1.5};  // T minus truth

struct Cell {
  const Layout* layout;
  std::string surface;
  const Noise* noise;

  [[nodiscard]] std::string name() const {
    return layout->name + " " + surface + " " + noise->name;
  }
  /// Every surface at 0.3 um, every noise on smooth and burr.
  [[nodiscard]] bool first_choice() const {
    return noise->name == "0.3" || surface == "smooth" || surface == "burr";
  }
};

/// Counts and sums over the trials of a cell; all but `trials`, `seconds` and `voids` over those
/// with an interval.
struct Tally {
  /// `astray`: the estimate lies outside of its own interval.
  int trials = 0, inside = 0, above = 0, below = 0, astray = 0;
  double width = 0, bias = 0, as_read_bias = 0, seconds = 0, largest_zone_difference = 0;
  std::array<int, kMargins_um.size()> accepted{}, accepted_as_corrected{}, rejected{};
  std::map<std::string, int> voids = {};

  [[nodiscard]] int stated() const { return inside + above + below; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Tally, trials, inside, above, below, astray, width, bias,
                                   as_read_bias, seconds, largest_zone_difference, accepted,
                                   accepted_as_corrected, rejected, voids)

void add(Tally& sum, const Tally& one) {
  for (const auto part :
       {&Tally::trials, &Tally::inside, &Tally::above, &Tally::below, &Tally::astray}) {
    sum.*part += one.*part;
  }
  for (const auto part : {&Tally::width, &Tally::bias, &Tally::as_read_bias, &Tally::seconds}) {
    sum.*part += one.*part;
  }
  sum.largest_zone_difference = std::max(sum.largest_zone_difference, one.largest_zone_difference);
  for (const auto part : {&Tally::accepted, &Tally::accepted_as_corrected, &Tally::rejected}) {
    for (std::size_t k = 0; k < kMargins_um.size(); ++k) (sum.*part)[k] += (one.*part)[k];
  }
  for (const auto& [reason, count] : one.voids) sum.voids[reason] += count;
}

/// A sentence without its numbers, so that like is counted with like.
std::string without_numbers(const std::string& text) {
  return std::regex_replace(text, std::regex("-?[0-9][0-9.e+-]*"), "#");
}

/// ISO 14253-1 with limits near the truth.
void judge_decisions(const evaluation::UncertaintyResult& found, double truth_um, Tally& tally) {
  evaluation::DecisionRule rule;
  rule.kind = evaluation::DecisionRule::Kind::kIso14253;
  const evaluation::KnownValue value{found.uncorrected_mm, found.sampled};
  for (std::size_t k = 0; k < kMargins_um.size(); ++k) {
    const double limit_mm = (truth_um + kMargins_um[k]) / 1000.0;
    const auto outcome =
        evaluation::apply_rule(rule, value, {.lower_mm = {}, .upper_mm = limit_mm});
    if (!outcome) {
      ++tally.voids["decision: " + without_numbers(outcome.error().what)];
      continue;
    }
    tally.accepted[k] += outcome->verdict == evaluation::Verdict::kConforms;
    tally.rejected[k] += outcome->verdict == evaluation::Verdict::kDoesNotConform;
    tally.accepted_as_corrected[k] += found.sampled.high_mm <= limit_mm;
  }
}

/// One inspection. Noise that is not plain is declared as by a user who does not know better:
/// normal.
void run_trial(const Cell& cell, int trial, int draws, Tally& tally) {
  const Layout& layout = *cell.layout;
  const Places at(layout);
  const MatrixXd rigid = rigid_columns(at, layout.circle());
  Random random(cell.name(), trial);
  const VectorXd form =
      with_feature(layout, at, cell.surface, ground(layout, at, cell.surface, random), random);
  const VectorXd read = free_of(rigid, form + errors(layout, *cell.noise, random));
  const Zone truth = minimum_zone(rigid, form);
  const Zone as_read = minimum_zone(rigid, read);
  ++tally.trials;
  if (!(truth.gap < 1e-6 && as_read.gap < 1e-6)) {
    ++tally.voids["the judge could not prove its own zone"];
    return;
  }

  evaluation::FormCloud cloud;
  cloud.kind =
      layout.circle() ? evaluation::FormKind::kRoundness : evaluation::FormKind::kCylindricity;
  cloud.radius_mm = kRadius_mm;
  for (Index i = 0; i < read.size(); ++i) {
    evaluation::FormPoint point;
    point.angle_rad = std::remainder(at.angle_rad[i], 2.0 * std::numbers::pi);
    point.height_mm = kHalfLength_mm * at.q[i];
    point.deviation_mm = read[i] / 1000.0;
    point.time_1 = static_cast<double>(i) / static_cast<double>(read.size() - 1);
    cloud.points.push_back(point);
  }
  evaluation::Influences influences;
  influences.probe.emplace().repeatability_mm = cell.noise->sigma_um / 1000.0;
  evaluation::UncertaintyOptions options;  // otherwise as in a plan that sets none
  options.most_trials = draws;
  options.budget_trials = 0;
  options.threads = 1;
  options.seed = static_cast<std::uint64_t>(trial) + 1;

  const std::clock_t start = std::clock();
  const auto found = evaluation::measurement_uncertainty(cloud, influences, std::nullopt, options);
  tally.seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  if (!found) {
    ++tally.voids[without_numbers(found.error().what)];
    return;
  }
  const double low_um = 1000.0 * found->sampled.low_mm;
  const double high_um = 1000.0 * found->sampled.high_mm;
  const double estimate_um = 1000.0 * found->sampled.estimate_mm;
  if (!std::isfinite(low_um + high_um + estimate_um)) {
    ++tally.voids["a number that is not finite"];
    return;
  }
  tally.above += truth.width > high_um;
  tally.below += truth.width < low_um;
  tally.inside += truth.width >= low_um && truth.width <= high_um;
  tally.astray += estimate_um < low_um || estimate_um > high_um;
  tally.width += high_um - low_um;
  tally.bias += estimate_um - truth.width;
  tally.as_read_bias += 1000.0 * found->uncorrected_mm - truth.width;
  tally.largest_zone_difference = std::max(
      tally.largest_zone_difference, std::abs(1000.0 * found->uncorrected_mm - as_read.width));
  judge_decisions(*found, truth.width, tally);
}

struct Request {
  std::string results = "build/coverage.jsonl";
  std::string only;
  std::string part = "1/1";
  int trials = 1000;
  int draws = evaluation::UncertaintyOptions{}.most_trials;
  bool full = false, table = false, selftest = false;
};

std::vector<Cell> cells_of(const Request& request, bool all) {
  std::vector<Cell> out;
  const std::regex only(request.only);
  for (const Layout& layout : layouts()) {
    for (const Noise& noise : noises()) {
      for (const std::string& surface : surfaces()) {
        const Cell cell{&layout, surface, &noise};
        if ((all || cell.first_choice()) && std::regex_search(cell.name(), only)) {
          out.push_back(cell);
        }
      }
    }
  }
  return out;
}

using Results = std::map<std::string, std::map<int, Tally>>;  // cell, batch

/// What is in the results file. A line that an interrupted run left half written is not counted.
Results read_results(const std::string& path) {
  Results out;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const auto entry = nlohmann::json::parse(line, nullptr, false);
    if (!entry.is_object()) continue;
    out[entry.at("cell").get<std::string>()][entry.at("batch").get<int>()] =
        entry.at("tally").get<Tally>();
  }
  return out;
}

/// Batch by batch through all cells, so that an early look shows every cell.
int run_cells(const Request& request) {
  int part = 0, parts = 0;
  if (std::sscanf(request.part.c_str(), "%d/%d", &part, &parts) != 2 || part < 1 || part > parts) {
    fmt::print(stderr, "--part {} is not I/N with I = 1..N\n", request.part);
    return 2;
  }
  const auto cells = cells_of(request, request.full);
  const Results done = read_results(request.results);
  const int batches = (request.trials * kBatches + 999) / 1000;
  int number = 0;
  for (int batch = 0; batch < batches; ++batch) {
    fmt::print(stderr, "batch {} of {} of {} cells\n", batch + 1, batches, cells.size());
    for (const Cell& cell : cells) {
      if (number++ % parts != part - 1) continue;
      const auto known = done.find(cell.name());
      if (known != done.end() && known->second.count(batch) == 1) continue;
      Tally tally;
      for (int k = 0; k < cell.layout->batch; ++k) {
        run_trial(cell, batch * cell.layout->batch + k, request.draws, tally);
      }
      const nlohmann::json entry = {
          {"cell", cell.name()}, {"batch", batch}, {"draws", request.draws}, {"tally", tally}};
      std::ofstream file(request.results, std::ios::app);
      // One write a batch, so that two processes do not mix lines; it starts a line whatever
      // an interrupted run left.
      file << "\n" + entry.dump() + "\n" << std::flush;
      if (!file) {
        fmt::print(stderr, "{}: cannot be written\n", request.results);
        return 1;
      }
    }
  }
  return 0;
}

/// "95.1 (0.7)": percent and its binomial standard deviation, which is not zero for 0 or n of n.
std::string percent(int count, int of) {
  if (of == 0) return "-";
  const double p = (count + 1.0) / (of + 2.0);
  return fmt::format("{:.1f} ({:.1f})", 100.0 * count / of, 100.0 * std::sqrt(p * (1.0 - p) / of));
}

int print_table(const Request& request) {
  Results results = read_results(request.results);
  std::vector<std::pair<std::string, Tally>> rows;
  for (const Cell& cell : cells_of(request, true)) {
    Tally sum;
    for (const auto& [batch, tally] : results[cell.name()]) add(sum, tally);
    if (sum.trials > 0) rows.emplace_back(cell.name(), sum);
  }
  fmt::print(
      "Cell: points, surface, noise [um]. Percent, standard deviation in brackets; of inspections "
      "with an interval. **Bold**:\nbelow 93 %. 0.3-t3: Student, 3 degrees of freedom; 0.3-ar: "
      "each reading 0.9 of the one before it and new noise;\n0.3-spike: one reading off by 5 "
      "standard deviations. All three of 0.3 um rms and declared as normal of 0.3 um.\n\n"
      "| cell | trials | truth inside | truth above | truth below | width, um | bias, um | bias as "
      "read, um | void | CPU s |\n|---|---|---|---|---|---|---|---|---|---|\n");
  Tally all;
  for (const auto& [name, t] : rows) {
    const int n = t.stated();
    const bool low = n > 0 && t.inside < 0.93 * n;
    const double each = n > 0 ? 1.0 / n : 0.0;
    fmt::print("| {} | {} | {}{}{} | {} | {} | {:.3f} | {:+.3f} | {:+.3f} | {} | {:.3f} |\n", name,
               t.trials, low ? "**" : "", percent(t.inside, n), low ? "**" : "",
               percent(t.above, n), percent(t.below, n), each * t.width, each * t.bias,
               each * t.as_read_bias, t.trials - n, t.seconds / t.trials);
    add(all, t);
  }
  fmt::print(
      "\nISO 14253-1, percent: conforms / the same by the corrected value / does not conform, "
      "by T minus truth [um]. Wrong: the\nlargest of conforms at T <= truth and of does not "
      "conform at T >= truth. Of all trials; void is neither.\n\n| cell | wrong conforms | "
      "wrong does not conform |");
  for (const double margin : kMargins_um) fmt::print(" {:+g} |", margin);
  fmt::print("\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, t] : rows) {
    int wrong_accept = 0, wrong_reject = 0;
    std::string line;
    for (std::size_t k = 0; k < kMargins_um.size(); ++k) {
      if (kMargins_um[k] <= 0.0) wrong_accept = std::max(wrong_accept, t.accepted[k]);
      if (kMargins_um[k] >= 0.0) wrong_reject = std::max(wrong_reject, t.rejected[k]);
      const double each = 100.0 / t.trials;
      line += fmt::format(" {:.0f}/{:.0f}/{:.0f} |", each * t.accepted[k],
                          each * t.accepted_as_corrected[k], each * t.rejected[k]);
    }
    fmt::print("| {} | {} | {} |{}\n", name, percent(wrong_accept, t.trials),
               percent(wrong_reject, t.trials), line);
  }
  fmt::print(
      "\n{} inspections; {} estimates outside of their interval; value as read against the zone of "
      "the judge: {:.6f} um at most.\n",
      all.trials, all.astray, all.largest_zone_difference);
  for (const auto& [reason, count] : all.voids) fmt::print("* void {}: {}\n", count, reason);
  return 0;
}

}  // namespace
}  // namespace rondure::coverage

int main(int argc, char** argv) {
  using namespace rondure::coverage;
  Request request;
  CLI::App app("How often the interval of a form value holds the truth, by simulated inspections.");
  app.add_option("--results", request.results, "file that finished batches are appended to")
      ->capture_default_str();
  app.add_option("--trials", request.trials,
                 "trials of a cell up to 480 points; 0.3 of them above, 0.1 at 5000")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--only", request.only, "cells whose name matches, such as '^480 smooth'");
  app.add_option("--part", request.part, "I/N: this process does part I of N")
      ->capture_default_str();
  app.add_option("--draws", request.draws, "most_trials of the engine")->capture_default_str();
  app.add_flag("--full", request.full, "every surface with every noise");
  app.add_flag("--table", request.table, "only prints the table of the results");
  app.add_flag("--selftest", request.selftest, "checks the judge itself");
  CLI11_PARSE(app, argc, argv);
  if (request.selftest) return failed_checks() == 0 ? 0 : 1;
  if (request.table) return print_table(request);
  return run_cells(request);
}
