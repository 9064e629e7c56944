#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "cmm/ipp/numbers.h"
#include "core/result.h"

/// I++ DME, the language between a measuring program and a coordinate measuring machine, as text.
/// Both directions: what a client sends and what a server answers. Lines are without their CR LF
/// here.
/// Source: I++ DME 1.4.3, sections on lexical rules and transactions.
namespace rondure::cmm::ipp {

inline constexpr std::uint16_t kDefaultPort = 1294;
/// Tool.Id() of rondure simulate-cmm, whatever tool is active: a client knows it by this without
/// asking for anything that other servers do not have.
inline constexpr std::string_view kSimulatorId = "rondure simulate-cmm";
inline constexpr std::size_t kMaxLineLength = 65536;  ///< Characters, without CR LF.
inline constexpr int kMaxDepth = 8;                   ///< Of parentheses in parentheses.
inline constexpr std::size_t kTagLength = 5;

/// The point meant by the coordinates in PtMeas and the start in ScanOnCircle. The specification
/// means the surface (6.3.2.13: the approach includes the tool radius); some servers take the
/// centre of the tip. The reported point is the centre of the tip in both cases.
enum class NamedPoint { kSurface, kCenter };

/// The first five characters of a line.
struct Tag {
  bool event = false;  ///< E0001..E9999 of the fast queue; E0000 is the server's, unsolicited.
  int number = 0;      ///< 1..99999, of an event 0..9999.

  friend bool operator==(const Tag&, const Tag&) = default;
};

inline constexpr Tag kUnsolicited = {true, 0};

/// "00042" or "E0042".
[[nodiscard]] std::string to_text(const Tag& tag);
/// Nothing for anything but five digits, not all 0, or E and four digits.
[[nodiscard]] std::optional<Tag> read_tag(std::string_view text);

/// An argument of a command, or a piece of data of a response.
struct Item {
  enum class Kind {
    kNumber,  ///< 1.5
    kString,  ///< "Probe1"
    kName,    ///< PartCsy, Tool.Name, E0001
    kCall,    ///< X(10), Tool.Name(), IJK(0,0,1)
    kVector,  ///< (0, 0, 1); only servers, and beyond the grammar
  };

  Kind kind = Kind::kName;
  double number = 0.0;          ///< Of kNumber.
  std::string text;             ///< Of kString the contents; of kName and kCall the name.
  std::vector<Item> arguments;  ///< Of kCall and kVector.

  friend bool operator==(const Item&, const Item&) = default;
};

[[nodiscard]] Item number_item(double value);
[[nodiscard]] Item string_item(std::string_view contents);
[[nodiscard]] Item name_item(std::string_view name);
[[nodiscard]] Item call_item(std::string_view name, std::vector<Item> arguments = {});
/// X(1.5), IJK(0,0,1).
[[nodiscard]] Item call_item(std::string_view name, std::initializer_list<double> values);
[[nodiscard]] Item call_item(std::string_view name, const Eigen::Vector3d& values);

/// As it stands on the wire. Numbers as wire_number(). A string cannot hold a double quote and has
/// no escapes: a double quote becomes a single one, what is not ASCII 32..126 becomes "?", and an
/// empty string, which the grammar forbids, one space.
[[nodiscard]] std::string to_text(const Item& item, NumberForm form = NumberForm::kSixteenDigits);
/// Joined by ", "; bare numbers by "," as in scan data.
[[nodiscard]] std::string to_text(std::span<const Item> items,
                                  NumberForm form = NumberForm::kSixteenDigits);

/// The call with this name, or null. Reports come back in any order: match by name.
[[nodiscard]] const Item* find_call(std::span<const Item> items, std::string_view name);
/// The only argument of a call, when it is a number.
[[nodiscard]] std::optional<double> single_number(const Item& call);
/// The numbers of a call or vector; nothing when any argument is something else.
[[nodiscard]] std::optional<std::vector<double>> numbers_of(const Item& call);
/// The three numbers of a call or vector.
[[nodiscard]] std::optional<Eigen::Vector3d> vector_of(const Item& call);
/// The contents of a string, or of a call whose only argument is one: "T" and Tool.Name("T").
[[nodiscard]] std::optional<std::string> string_of(const Item& item);

/// A command of a client:  tag method(arguments).
struct Command {
  Tag tag;
  std::string method;
  std::vector<Item> arguments;

  friend bool operator==(const Command&, const Command&) = default;
};

[[nodiscard]] std::string to_line(const Command& command,
                                  NumberForm form = NumberForm::kSixteenDigits);
/// The command without its tag.
[[nodiscard]] std::string method_text(const Command& command,
                                      NumberForm form = NumberForm::kSixteenDigits);

/// A line as it came, without its end.
struct RawLine {
  std::string text;
  bool crlf = true;  ///< Ended by CR LF and not by LF alone.
};

/// Why a line is no command.
struct Refusal {
  int number = 0;          ///< Of the error list (internal/errors.h).
  std::optional<Tag> tag;  ///< None when the line has no tag that could be answered.
  std::string what;        ///< For a person, and for the log.
};

/// Reads a line from a client, strictly: the grammar decides, and an event tag belongs to event
/// commands and to them only. Spaces after the last parenthesis are accepted all the same.
/// @param line  Any bytes, without CR LF.
/// @return  The command; or 0001, 0002 (tag), 0007 (a character outside ASCII 32..126), 0008 (too
///          long, too deep), 0502 (form of the arguments), 0507 (no such method),
///          0509 (a number out of form). O(length) time and memory; never throws but bad_alloc.
[[nodiscard]] tl::expected<Command, Refusal> parse_command(std::string_view line);
/// The same; 0007 for a line that LF alone ends.
[[nodiscard]] tl::expected<Command, Refusal> parse_command(const RawLine& line);

/// An error as the server reports it:  Error(severity, number, method, text).
struct ErrorReport {
  int severity = 0;
  int number = 0;
  std::string method;  ///< What failed; often the whole command.
  std::string text;

  friend bool operator==(const ErrorReport&, const ErrorReport&) = default;
};

/// The report of a number with the severity and text of the list; a number that is not there is 3,
/// "Error <number>".
[[nodiscard]] ErrorReport error_report(int number, std::string_view method);

/// "error 1006, severity 2: Surface not found (00012 PtMeas(...))".
[[nodiscard]] std::string in_words(const ErrorReport& error);

/// A line of a server.
struct Response {
  enum class Kind { kAck, kData, kError, kComplete };

  Tag tag;
  Kind kind = Kind::kAck;
  std::vector<Item> data;  ///< Of kData; empty when its text follows no grammar (XML).
  std::string raw;         ///< Of kData: the text after "# ".
  ErrorReport error;       ///< Of kError.
};

[[nodiscard]] std::string ack_line(const Tag& tag);
[[nodiscard]] std::string complete_line(const Tag& tag);
[[nodiscard]] std::string data_line(const Tag& tag, std::span<const Item> items,
                                    NumberForm form = NumberForm::kSixteenDigits);
[[nodiscard]] std::string error_line(const Tag& tag, const ErrorReport& error);

/// Reads a line from a server, liberally: bare strings and vectors, an unquoted method or a number
/// of one to four digits in an error, any spaces, numbers with more digits than allowed, data of
/// any form (`raw`).
/// @return  The response; or kSyntax when there is no tag and response character, a character
///          outside ASCII 32..126, a line above kMaxLineLength, or an error report without number.
[[nodiscard]] core::Result<Response> parse_response(std::string_view line);

}  // namespace rondure::cmm::ipp
