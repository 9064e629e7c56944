#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <fmt/core.h>

namespace rondure::core {

/// A sentence or a part of one as data: an English format text, which is also its key in the
/// catalogue of a language, and the arguments. Made by phrase(); words of a language are made where
/// a person reads them (reports/words).
class Phrase {
 public:
  /// A number, a text that stays as it is in every language (a name, a symbol), or another phrase.
  struct Argument;

  Phrase();
  /// A text of one piece: a word that a catalogue may know, or a sentence of which only the English
  /// text is known (of a machine, of a journal).
  explicit Phrase(std::string_view text);
  /// Use phrase(), which checks the format.
  Phrase(std::string_view format, std::vector<Argument> arguments);

  [[nodiscard]] const std::string& format() const { return format_; }
  [[nodiscard]] const std::vector<Argument>& arguments() const { return arguments_; }
  [[nodiscard]] bool empty() const { return format_.empty(); }

  /// The English text.
  [[nodiscard]] std::string english() const;
  /// English is what programs read: where a text is asked for, a phrase is its English text.
  operator std::string() const { return english(); }  // NOLINT(google-explicit-constructor)

  /// Whether both are the same text in English.
  friend bool operator==(const Phrase& a, const Phrase& b);
  friend bool operator==(const Phrase& a, std::string_view b);
  friend std::ostream& operator<<(std::ostream& out, const Phrase& phrase);

 private:
  std::string format_;
  std::vector<Argument> arguments_;
};

struct Phrase::Argument {
  std::variant<double, long long, unsigned long long, std::string, Phrase> value;

  template <class T>
  explicit Argument(const T& from) : value(kept(from)) {}

 private:
  template <class T>
  static auto kept(const T& from) {
    if constexpr (std::is_same_v<T, Phrase>) {
      return from;
    } else if constexpr (std::is_floating_point_v<T>) {
      return static_cast<double>(from);
    } else if constexpr (std::is_integral_v<T>) {
      return static_cast<std::conditional_t<std::is_signed_v<T>, long long, unsigned long long>>(
          from);
    } else {
      return std::string(from);
    }
  }
};

/// A format text of any language with the arguments of a phrase, each of which is formatted as the
/// text says. Those that are phrases must have become texts.
[[nodiscard]] std::string filled(std::string_view format,
                                 const std::vector<Phrase::Argument>& arguments);

namespace internal {
/// The type of an argument that a format sees.
template <class T>
using Shown = std::conditional_t<std::is_same_v<T, Phrase>, std::string, std::decay_t<const T>>;
}  // namespace internal

/// "{:.3f} um is above the limit of {:g} um" with its arguments; the compiler checks the format. A
/// test holds that each literal here has its line in the catalogue.
template <class... Arguments>
[[nodiscard]] Phrase phrase(fmt::format_string<internal::Shown<Arguments>...> format,
                            const Arguments&... arguments) {
  const fmt::string_view text = format;
  return {std::string_view(text.data(), text.size()), {Phrase::Argument(arguments)...}};
}

/// A text that is alike in every language: a symbol, a name. Empty for an empty one.
[[nodiscard]] Phrase as_it_is(std::string_view text);

/// Both, joined by a semicolon; where one is empty, the other.
[[nodiscard]] Phrase joined(const Phrase& first, const Phrase& second);

}  // namespace rondure::core
