#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/run/step_prompt.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "cmm/indicators/ascii_probe.h"
#include "cmm/indicators/displacement_probe.h"
#include "cmm/indicators/mitutoyo_itn.h"
#include "core/numbers.h"
#include "core/units.h"
#include "record/csv/series.h"
#include "record/files.h"
#include "wire/serial_port.h"
#include "wire/usb.h"

namespace rondure::app {
namespace {

using Probes = std::vector<std::unique_ptr<cmm::DisplacementProbe>>;

/// The names of the columns: the angle, then one per reading.
std::vector<std::string> columns_of(std::size_t indicators) {
  std::vector<std::string> out = {"alpha_deg"};
  for (std::size_t i = 1; i <= indicators; ++i) out.push_back(fmt::format("H{}_um", i));
  return out;
}

std::string angle_text(const RecordArguments& arguments, int row) {
  return core::shortest(core::on_grid(arguments.from_deg + row * arguments.step_deg, 1e9));
}

/// Number of rows that a table already holds. kMeaning when it is not the beginning of this table.
core::Result<int> rows_in(const std::string& text, const RecordArguments& arguments) {
  const auto names = columns_of(arguments.probes.size());
  std::vector<record::WantedColumn> wanted;
  for (const std::string& name : names) wanted.push_back({name, true});
  const auto table = record::parse_series_csv(text, arguments.out, wanted);
  if (!table) {
    if (table.error().code == core::Code::kNoPoints) return 0;
    return core::fail(table.error());
  }
  if (table->columns.size() != names.size()) {
    return core::fail(core::Code::kMeaning,
                      fmt::format("the table holds a {}, which a recording does not write; give "
                                  "another file",
                                  record::kTemperatureColumn),
                      arguments.out);
  }
  const auto rows = static_cast<int>(table->rows());
  for (int i = 0; i < rows; ++i) {
    const std::string here =
        core::shortest(table->values[static_cast<std::size_t>(i) * names.size()]);
    if (i < arguments.count && here == angle_text(arguments, i)) continue;
    return core::fail(core::Code::kMeaning,
                      fmt::format("row {} is at {} deg, this recording has other angles; give the "
                                  "angles it began with, or another file",
                                  i + 1, here),
                      arguments.out);
  }
  return rows;
}

using OpenProbe = core::Result<std::unique_ptr<cmm::DisplacementProbe>>;

constexpr std::uint16_t kMitutoyo = 0x0fe7;
constexpr std::uint16_t kItn = 0x4001;

OpenProbe open_itn(const std::string& serial, bool inches) {
  auto device = wire::open_usb({kMitutoyo, {kItn}, serial, "Mitutoyo USB-ITN cable"});
  if (!device) return core::fail(device.error().error());
  cmm::MitutoyoItnOptions options;
  if (inches) options.unit_mm = cmm::kInch_mm;
  return cmm::open_mitutoyo_itn(std::move(*device), options);
}

/// Opens an indicator by its word on the command line: "itn", "itn:SERIAL" (a Mitutoyo USB-ITN
/// cable), or "KIND:DEVICE" of an indicator on a serial line, "sylvac:/dev/ttyUSB0".
/// @return  kBadOption for an unknown word; kMachine when the indicator cannot be opened.
OpenProbe open_indicator(const std::string& word, bool inches) {
  const std::size_t colon = word.find(':');
  const std::string kind = word.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : word.substr(colon + 1);
  if (kind == "itn") return open_itn(rest, inches);
  auto settings = cmm::ascii_probe_settings(kind);
  if (!settings || rest.empty()) {
    return core::fail_with(core::Code::kBadOption, "\"{}\" is no indicator; give {}", word,
                           indicator_words());
  }
  if (inches) settings->unit_mm = cmm::kInch_mm;
  TRY(auto line, wire::open_serial(rest, settings->line));
  return cmm::open_ascii_probe(std::move(line), *settings);
}

core::Result<Probes> open_all(const RecordArguments& arguments) {
  Probes out;
  for (const std::string& word : arguments.probes) {
    TRY(auto probe, open_indicator(word, arguments.inches));
    out.push_back(std::move(probe));
  }
  return out;
}

/// One row: an angle and the readings of all indicators.
core::Result<std::string> read_row(const std::string& angle, const Probes& probes) {
  std::string row = angle;
  for (const auto& probe : probes) {
    TRY(const auto reading_mm, probe->read_mm());
    row += fmt::format(",{}", core::shortest(core::on_grid(reading_mm / core::kMicrometre, 1e6)));
  }
  row += '\n';
  return row;
}

/// Header of a new file.
std::string head_of(const Probes& probes) {
  std::string out = "# rondure record: read at stopped angles, one indicator after the other\n";
  for (std::size_t i = 0; i < probes.size(); ++i) {
    out += fmt::format("# H{}: {}\n", i + 1, probes[i]->description());
  }
  return out + fmt::format("{}\n", fmt::join(columns_of(probes.size()), ","));
}

/// Reads angle by angle; each row is on disk before the request for the next angle.
core::Result<void> record_rows(const RecordArguments& arguments, const Probes& probes,
                               std::string text, int from) {
  for (int i = from; i < arguments.count; ++i) {
    const std::string angle = angle_text(arguments, i);
    if (auto ready = ask_to_do(fmt::format("{} of {}: turn the part to {} deg and let it stand",
                                           i + 1, arguments.count, angle));
        !ready) {
      return ready;
    }
    TRY(const auto row, read_row(angle, probes));
    text += row;
    if (auto kept = record::write_file(arguments.out, text); !kept) return kept;
    tell(fmt::format("  {}", row));
  }
  return {};
}

core::Result<void> record_all(const RecordArguments& arguments) {
  if (arguments.rate_Hz) {
    return core::fail(
        cmm::refuse_tracking({}, *arguments.rate_Hz, static_cast<int>(arguments.probes.size())));
  }
  if (auto terminal = StepPrompt::check_terminal("rondure record asks for every angle");
      !terminal) {
    return terminal;
  }
  std::string text;
  int rows = 0;
  if (std::filesystem::exists(arguments.out)) {
    TRY(const auto old, record::read_file(arguments.out, record::kMostPointsBytes));
    TRY(const auto known, rows_in(old, arguments));
    text = old;
    rows = known;
  }
  TRY(const auto probes, open_all(arguments));
  if (text.empty()) text = head_of(probes);
  return record_rows(arguments, probes, std::move(text), rows);
}

}  // namespace

std::string indicator_words() {
  return fmt::format("itn, itn:SERIAL, or KIND:DEVICE with the kinds {}", cmm::ascii_probe_names());
}

int record_readings(const RecordArguments& arguments) {
  listen_for_stop();
  const auto done = record_all(arguments);
  if (done) {
    say_line(arguments.out);
    return kAllWell;
  }
  print_error(done.error());
  const core::Code code = done.error().code;
  if (code != core::Code::kMachine && code != core::Code::kStopped) return kBadInput;
  tell("rondure: what was read is kept; the same command goes on behind it\n");
  return kRunFailed;
}

}  // namespace rondure::app
