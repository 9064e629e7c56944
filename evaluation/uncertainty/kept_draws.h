#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace rondure::evaluation {

/// The file of a run directory that holds the draws behind its intervals.
inline constexpr const char* kTrialsFile = "trials.bin";

/// The draws of one evaluation, in the order in which its trials need them. Draws take nearly all
/// of its time and follow from the run alone, so that a later evaluation of the same run by the
/// same program on the same kind of processor can take them in place of drawing: bit for bit the
/// same. Whether bytes are those of the same run is for the caller to know; those of another shape
/// are not taken, whoever wrote them.
class KeptDraws {
 public:
  /// @param known  bytes() of an earlier evaluation; must outlive this. Empty: draws are kept.
  explicit KeptDraws(std::string_view known = {}) : left_(known), knows_(!known.empty()) {}

  /// Fills the chains with the next draws that are known. Where these are not of this shape, the
  /// chains keep their state, and nothing is taken from then on.
  /// @param is_whole  Whether a chain has all that its evaluation reads, given the first one found.
  /// @return  false: they have to be drawn.
  template <class Chain, class IsWhole>
  [[nodiscard]] bool take(std::vector<Chain>& chains, const IsWhole& is_whole) {
    std::vector<Chain> found;
    const bool fits = knows_ && read(found) && found.size() == chains.size() &&
                      std::all_of(found.begin(), found.end(), [&](const Chain& chain) {
                        return is_whole(chain, found.front());
                      });
    if (fits) chains = std::move(found);
    knows_ = fits;
    return fits;
  }
  template <class Chain>
  void keep(const std::vector<Chain>& chains) {
    write(chains);
  }

  /// The draws that were made, not those that were taken.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  // A struct of draws lists its members in members_of(); everything else is numbers and vectors.
  template <class T>
  bool read(T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      if (left_.size() < sizeof value) return false;
      std::memcpy(&value, left_.data(), sizeof value);
      left_.remove_prefix(sizeof value);
      return true;
    } else {
      return members_of(value, [this](auto&... member) { return (read(member) && ...); });
    }
  }
  template <class T>
  bool read(std::vector<T>& values) {
    std::size_t count = 0;
    if (!read(count)) return false;
    for (; count > 0; --count) {  // no memory is taken for what the bytes only claim to hold
      if (!read(values.emplace_back())) return false;
    }
    return true;
  }
  template <class T>
  void write(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      members_of(value, [this](const auto&... member) {
        (write(member), ...);
        return true;
      });
    }
  }
  template <class T>
  void write(const std::vector<T>& values) {
    write(values.size());
    for (const T& value : values) write(value);
  }

  std::string_view left_;
  bool knows_ = false;
  std::string bytes_;
};

/// Makes the evaluations of this thread keep or take their draws, while it lives. There is one for
/// the thread, since it changes no number, and all of the evaluation would carry it otherwise.
class UseOfDraws {
 public:
  explicit UseOfDraws(KeptDraws& draws);
  ~UseOfDraws();
  UseOfDraws(const UseOfDraws&) = delete;
  UseOfDraws& operator=(const UseOfDraws&) = delete;

  /// Those in use on this thread, or nullptr.
  [[nodiscard]] static KeptDraws* current();
};

/// Draws the chains, or takes them as they are known.
/// @param is_whole  As of KeptDraws::take().
/// @param draw      Fills the chains.
template <class Chain, class IsWhole, class Draw>
void draw_or_take(std::vector<Chain>& chains, const IsWhole& is_whole, const Draw& draw) {
  KeptDraws* const kept = UseOfDraws::current();
  if (kept != nullptr && kept->take(chains, is_whole)) return;
  draw();
  if (kept != nullptr) kept->keep(chains);
}

}  // namespace rondure::evaluation
