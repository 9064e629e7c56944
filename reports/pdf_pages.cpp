#include "reports/pdf_pages.h"

#include <algorithm>

namespace rondure::reports::pdf {
namespace {

constexpr double kTiny = 1e-6;
constexpr double kManyLines = 70.0;  ///< What is lower is not cut without need [pt].

/// Where a box may be cut, from its top, rising: bottoms that go through nothing else.
std::vector<double> cuts_of(const Box& box) {
  std::vector<Span> spans;
  box.add_spans(0.0, spans);
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.top < b.top; });
  std::vector<double> cuts;
  double lowest = 0.0;
  for (const Span& span : spans) {
    if (!cuts.empty() || lowest > 0.0) {
      if (span.top >= lowest - kTiny) cuts.push_back(0.5 * (lowest + span.top));
    }
    lowest = std::max(lowest, span.bottom);
  }
  return cuts;
}

bool is_cut(const Brick& brick) { return brick.may_be_cut && brick.box->height() > kManyLines; }

class Pager {
 public:
  Pager(const std::vector<Brick>& bricks, double height) : bricks_(bricks), height_(height) {}

  std::vector<Placed> pages() {
    for (std::size_t i = 0; i < bricks_.size(); ++i) place(i);
    return std::move(placed_);
  }

 private:
  [[nodiscard]] double space_before(const Brick& brick) const {
    return used_ > 0.0 ? brick.space_before : 0.0;
  }

  /// Height up to the first place behind brick `i` where a page may end.
  [[nodiscard]] double chain_height(std::size_t i) const {
    double height = space_before(bricks_[i]);
    for (; i < bricks_.size(); ++i) {
      const Brick& brick = bricks_[i];
      if (is_cut(brick)) {
        const auto cuts = cuts_of(*brick.box);
        return height + (cuts.size() < 2 ? brick.box->height() : cuts[1]);
      }
      height += brick.box->height();
      if (!brick.keep_with_next || i + 1 == bricks_.size()) break;
      height += bricks_[i + 1].space_before;
    }
    return height;
  }

  void new_page() {
    if (used_ > 0.0) ++page_;
    used_ = 0.0;
  }

  void put(const Brick& brick, const Box& box, const Slice& slice) {
    placed_.push_back({&brick, &box, page_, used_, slice});
    used_ += placed_.back().height();
  }

  void place(std::size_t i) {
    const Brick& brick = bricks_[i];
    const double together = chain_height(i);
    const bool too_high = together > height_ + kTiny;
    const double needed =
        too_high ? space_before(brick) + (is_cut(brick) ? 0.0 : brick.box->height()) : together;
    if (used_ + needed > height_ + kTiny && used_ > 0.0) {
      new_page();
      if (brick.head != nullptr && brick.head->height() + brick.box->height() < height_) {
        put(brick, *brick.head, {});
      }
    }
    used_ += space_before(brick);
    const bool fits = used_ + brick.box->height() <= height_ + kTiny;
    if (fits) {
      put(brick, *brick.box, {});
    } else {
      put_in_slices(brick);
    }
  }

  /// As much on each page as fits.
  void put_in_slices(const Brick& brick) {
    const double whole = brick.box->height();
    const auto cuts = cuts_of(*brick.box);
    double from = 0.0;
    while (from + (height_ - used_) < whole - kTiny) {
      const double most = from + height_ - used_;
      const auto next = std::upper_bound(cuts.begin(), cuts.end(), most + kTiny);
      const bool found = next != cuts.begin() && *(next - 1) > from + kTiny;
      if (!found && used_ > 0.0) {
        new_page();
        continue;
      }
      const double to = found ? *(next - 1) : most;
      put(brick, *brick.box, {from, to});
      from = to;
      new_page();
    }
    put(brick, *brick.box, {from, std::numeric_limits<double>::infinity()});
  }

  const std::vector<Brick>& bricks_;
  double height_;
  std::vector<Placed> placed_;
  int page_ = 0;
  double used_ = 0.0;
};

}  // namespace

double Placed::height() const { return std::min(slice.to, box->height()) - slice.from; }

std::vector<Placed> paginate(const std::vector<Brick>& bricks, double height) {
  return Pager(bricks, height).pages();
}

}  // namespace rondure::reports::pdf
