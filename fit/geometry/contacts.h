#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace rondure::fit {

/// A point on the boundary of a zone, with its multiplier in the stationarity condition.
struct Contact {
  std::size_t index = 0;    ///< Row of the point in the input.
  double multiplier = 0.0;  ///< >= 0; the multipliers of each side sum to 1.
};

/// The contacts of one side. A linear programme over at most four unknowns has at most five
/// contacts per side, so a fixed array holds them and fits in loops allocate nothing.
class Contacts {
 public:
  static constexpr std::size_t kCapacity = 6;

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const Contact& operator[](std::size_t i) const { return contacts_[i]; }
  [[nodiscard]] Contact& operator[](std::size_t i) { return contacts_[i]; }
  [[nodiscard]] const Contact* begin() const { return contacts_.data(); }
  [[nodiscard]] const Contact* end() const { return contacts_.data() + size_; }
  [[nodiscard]] Contact* begin() { return contacts_.data(); }
  [[nodiscard]] Contact* end() { return contacts_.data() + size_; }
  void clear() { size_ = 0; }
  void push_back(const Contact& contact) {
    assert(size_ < kCapacity);
    contacts_[size_++] = contact;
  }

 private:
  std::array<Contact, kCapacity> contacts_{};
  std::size_t size_ = 0;
};

}  // namespace rondure::fit
