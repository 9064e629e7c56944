#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "cmm/ipp/grammar.h"

namespace rondure::cmm::ipp {

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
