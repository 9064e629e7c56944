#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

namespace rondure::doors {

/// A copy of some bytes in a block of memory that ends with them. The address sanitizer reports a
/// read beyond them; after those of a std::string stand its zero and its spare capacity.
class Exact {
 public:
  explicit Exact(std::string_view bytes)
      : bytes_(std::make_unique<char[]>(bytes.size())), size_(bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), bytes_.get());
  }
  [[nodiscard]] std::string_view view() const { return {bytes_.get(), size_}; }

 private:
  std::unique_ptr<char[]> bytes_;
  std::size_t size_;
};

/// The lengths to which a file of `size` bytes is cut: every one, or `most` of them at equal
/// distances.
[[nodiscard]] inline std::vector<std::size_t> cuts_of(std::size_t size, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t count = std::min(size, most);
  for (std::size_t i = 0; i < count; ++i) out.push_back(i * size / count);
  return out;
}

/// Words and marks in the middle of which a text may end; none among them.
[[nodiscard]] inline const std::vector<std::string_view>& half_words() {
  static const std::vector<std::string_view> all = {
      "",   "NaN",     "-Infinity", "1e999",    "nul", "-", "+", "1e", ".",
      "\"", "\"\\u00", "\xc3",      "\xef\xbb", "/",   "'", "(", "#",  "\r"};
  return all;
}

}  // namespace rondure::doors
