#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "cmm/ipp/grammar.h"

namespace rondure::cmm::ipp {

/// One entry of the list of I++ DME errors.
struct ErrorEntry {
  int number = 0;    ///< F2, four digits on the wire.
  int severity = 0;  ///< F1: 0 info, 1 warning, 2 the client can recover, 3 the user must, 9 fatal.
  std::string_view text;  ///< The fixed text of the number.
};

/// The entry of a number, or null when the protocol does not define it. Source: I++ DME 1.4.3 and
/// the additions of later issues.
[[nodiscard]] const ErrorEntry* find_error(int number);

/// From this severity on the server aborts pending commands and requires ClearAllErrors().
inline constexpr int kErrorState = 2;

// Numbers that the server uses, named by their meaning.
inline constexpr int kIllegalTag = 1;
inline constexpr int kNoSpace = 2;
inline constexpr int kAborted = 6;
inline constexpr int kIllegalCharacter = 7;
inline constexpr int kProtocolError = 8;
inline constexpr int kUnsupportedCommand = 501;
inline constexpr int kIncorrectArguments = 502;
inline constexpr int kOutOfRange = 504;
inline constexpr int kNotRecognized = 505;
inline constexpr int kNotSupported = 506;
inline constexpr int kIllegalCommand = 507;
inline constexpr int kBadContext = 508;
inline constexpr int kBadArgument = 509;
inline constexpr int kBadProperty = 510;
inline constexpr int kProcessing = 511;
inline constexpr int kNoDaemons = 512;
inline constexpr int kNoSuchDaemon = 513;
inline constexpr int kUseClearAllErrors = 514;
inline constexpr int kDaemonExists = 515;
inline constexpr int kMachineInErrorState = 1000;
inline constexpr int kNoTouch = 1003;
inline constexpr int kAtHome = 1005;
inline constexpr int kSurfaceNotFound = 1006;
inline constexpr int kThetaOutOfRange = 1007;
inline constexpr int kOutOfVolume = 1008;
inline constexpr int kNoNorm = 1010;
inline constexpr int kUnableToMove = 1011;
inline constexpr int kToolNotFound = 1502;
inline constexpr int kToolNotDefined = 1503;
inline constexpr int kMoveOutOfLimits = 2500;
inline constexpr int kCollision = 2504;
inline constexpr int kAngleOutOfRange = 2505;
inline constexpr int kNotAligned = 2506;

/// Whether every character is ASCII 32..126.
[[nodiscard]] bool is_plain(std::string_view text);
/// The first `shown` characters of a line for a message; "?" replaces a character that is not
/// plain, "..." the rest of the line.
[[nodiscard]] std::string excerpt(std::string_view line, std::size_t shown);

/// Reads items from one line, from left to right. Internal to the grammar.
class ItemReader {
 public:
  enum class Manner { kStrict, kLiberal };

  /// Reason why reading stopped.
  struct Fault {
    int number = 0;  ///< 0502, 0509 or 0008.
    std::string what;
  };
  template <class T>
  using Read = tl::expected<T, Fault>;

  ItemReader(std::string_view text, Manner manner) : text_(text), manner_(manner) {}

  /// Reads  letter {letter | digit},  with `dotted` also with points in between. Empty when there
  /// is no name.
  [[nodiscard]] std::string_view read_name(bool dotted);
  /// Reads  "(" [item {"," item}] ")",  with the spaces that the grammar allows.
  [[nodiscard]] Read<std::vector<Item>> read_arguments(int depth);
  /// Reads  item {"," item}  up to the end of the line.
  [[nodiscard]] Read<std::vector<Item>> read_list();
  /// Whether only spaces are left.
  [[nodiscard]] bool at_end();
  [[nodiscard]] std::size_t position() const { return at_; }

 private:
  void skip_spaces();
  [[nodiscard]] bool take(char c);
  [[nodiscard]] tl::unexpected<Fault> fault(int number, std::string_view what) const;
  [[nodiscard]] Read<Item> read_item(int depth);
  [[nodiscard]] Read<Item> read_string();
  [[nodiscard]] Read<Item> read_number_item();
  [[nodiscard]] Read<Item> read_name_or_call(int depth);

  std::string_view text_;
  Manner manner_;
  std::size_t at_ = 0;
};

}  // namespace rondure::cmm::ipp
