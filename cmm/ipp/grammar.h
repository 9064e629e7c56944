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

/// I++ DME, the language between a measuring program and a coordinate measuring machine, as text,
/// in both directions: commands of a client and answers of a server. Lines are given without their
/// CR LF.
/// Source: I++ DME 1.4.3, sections on lexical rules and transactions.
namespace rondure::cmm::ipp {

inline constexpr std::uint16_t kDefaultPort = 1294;
/// Tool.Id() of rondure simulate-cmm, for any active tool: identifies it to a client without a
/// request that other servers do not know.
inline constexpr std::string_view kSimulatorId = "rondure simulate-cmm";
inline constexpr std::size_t kMaxLineLength = 65536;  ///< Characters, without CR LF.
inline constexpr int kMaxDepth = 8;                   ///< Nesting depth of parentheses.
inline constexpr std::size_t kTagLength = 5;

/// The point whose coordinates are given in PtMeas and as the start of ScanOnCircle. The
/// specification means the surface (6.3.2.13: the approach includes the tool radius); some servers
/// expect the centre of the tip. The reported point is the centre of the tip in both cases.
enum class NamedPoint { kSurface, kCenter };

/// The first five characters of a line.
struct Tag {
  /// E0001..E9999 of the fast queue; E0000 is an unsolicited message of the server.
  bool event = false;
  int number = 0;  ///< 1..99999; for an event 0..9999.

  friend bool operator==(const Tag&, const Tag&) = default;
};

inline constexpr Tag kUnsolicited = {true, 0};

/// "00042" or "E0042".
[[nodiscard]] std::string to_text(const Tag& tag);
/// Parses a tag: five digits, not all 0, or E and four digits; nothing for any other text.
[[nodiscard]] std::optional<Tag> read_tag(std::string_view text);

/// An argument of a command, or an item of data in a response.
struct Item {
  enum class Kind {
    kNumber,  ///< 1.5
    kString,  ///< "Probe1"
    kName,    ///< PartCsy, Tool.Name, E0001
    kCall,    ///< X(10), Tool.Name(), IJK(0,0,1)
    kVector,  ///< (0, 0, 1); only servers, and beyond the grammar
  };

  Kind kind = Kind::kName;
  double number = 0.0;          ///< For kNumber.
  std::string text;             ///< For kString the contents; for kName and kCall the name.
  std::vector<Item> arguments;  ///< For kCall and kVector.

  friend bool operator==(const Item&, const Item&) = default;
};

[[nodiscard]] Item number_item(double value);
[[nodiscard]] Item string_item(std::string_view contents);
[[nodiscard]] Item name_item(std::string_view name);
[[nodiscard]] Item call_item(std::string_view name, std::vector<Item> arguments = {});
/// X(1.5), IJK(0,0,1).
[[nodiscard]] Item call_item(std::string_view name, std::initializer_list<double> values);
[[nodiscard]] Item call_item(std::string_view name, const Eigen::Vector3d& values);

/// The text for the wire. Numbers as wire_number(). A string cannot hold a double quote and has no
/// escapes: a double quote becomes a single one, characters outside ASCII 32..126 become "?", and
/// an empty string, which the grammar forbids, becomes one space.
[[nodiscard]] std::string to_text(const Item& item, NumberForm form = NumberForm::kSixteenDigits);
/// Items joined by ", "; bare numbers by "," as in scan data.
[[nodiscard]] std::string to_text(std::span<const Item> items,
                                  NumberForm form = NumberForm::kSixteenDigits);

/// The call with this name, or null. The order of reports varies, so match by name.
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

/// A line as received, without its end.
struct RawLine {
  std::string text;
  bool crlf = true;  ///< Ended by CR LF, not by LF alone.
};

/// Why a line is not a command.
struct Refusal {
  int number = 0;          ///< Number in the error list (internal/errors.h).
  std::optional<Tag> tag;  ///< None when the line has no tag for an answer.
  std::string what;        ///< Explanation for the user and the log.
};

/// Reads a line from a client, strictly: the grammar decides, and an event tag must belong to an
/// event command and vice versa. Only spaces after the last parenthesis are tolerated.
/// @param line  Any bytes, without CR LF.
/// @return  The command; or 0001, 0002 (tag), 0007 (a character outside ASCII 32..126), 0008 (too
///          long, too deep), 0502 (form of the arguments), 0507 (no such method), 0509 (a malformed
///          number). O(length) time and memory; throws only bad_alloc.
[[nodiscard]] tl::expected<Command, Refusal> parse_command(std::string_view line);
/// As above; 0007 for a line that ends with LF alone.
[[nodiscard]] tl::expected<Command, Refusal> parse_command(const RawLine& line);

/// An error report of the server:  Error(severity, number, method, text).
struct ErrorReport {
  int severity = 0;
  int number = 0;
  std::string method;  ///< The failed method; often the whole command.
  std::string text;

  friend bool operator==(const ErrorReport&, const ErrorReport&) = default;
};

/// The report for a number, with severity and text from the list; an unknown number has severity 3
/// and the text "Error <number>".
[[nodiscard]] ErrorReport error_report(int number, std::string_view method);

/// "error 1006, severity 2: Surface not found (00012 PtMeas(...))".
[[nodiscard]] std::string in_words(const ErrorReport& error);

/// A line of a server.
struct Response {
  enum class Kind { kAck, kData, kError, kComplete };

  Tag tag;
  Kind kind = Kind::kAck;
  std::vector<Item> data;  ///< For kData; empty when its text follows no grammar (XML).
  std::string raw;         ///< For kData: the text after "# ".
  ErrorReport error;       ///< For kError.
};

[[nodiscard]] std::string ack_line(const Tag& tag);
[[nodiscard]] std::string complete_line(const Tag& tag);
[[nodiscard]] std::string data_line(const Tag& tag, std::span<const Item> items,
                                    NumberForm form = NumberForm::kSixteenDigits);
[[nodiscard]] std::string error_line(const Tag& tag, const ErrorReport& error);

/// Reads a line from a server, liberally: accepts bare strings and vectors, an unquoted method or a
/// number of one to four digits in an error, any spaces, numbers with more digits than allowed,
/// data of any form (`raw`).
/// @return  The response; or kSyntax when there is no tag and response character, a character
///          outside ASCII 32..126, a line above kMaxLineLength, or an error report without number.
[[nodiscard]] core::Result<Response> parse_response(std::string_view line);

}  // namespace rondure::cmm::ipp
