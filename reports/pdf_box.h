#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "reports/pdf_source.h"

// Cairo's and Pango's headers stay in the .cpp files; these are their names.
struct _cairo;  // NOLINT(bugprone-reserved-identifier): Cairo's
using cairo_t = _cairo;

// Private to the room: what a page of report.pdf is put together from. All lengths in pt.

namespace rondure::reports::pdf {

/// Part of a box from its top: what begins inside it is drawn.
struct Slice {
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool holds(double top) const { return top >= from - 1e-6 && top < to - 1e-6; }
};

/// From top to bottom of what a cut must not go through: a line of text, a drawing.
struct Span {
  double top = 0.0;
  double bottom = 0.0;
};

/// How wide a box must be and how wide it would like to be.
struct Widths {
  double least = 0.0;
  double wanted = 0.0;
};

/// Anything that is set: laid out once into a width, then drawn, once a page that shows part of it.
class Box {
 public:
  Box() = default;
  virtual ~Box() = default;
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  [[nodiscard]] virtual Widths widths() const = 0;
  /// Gives it its width; height() holds from then on.
  virtual void lay(double width) = 0;
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  /// Draws what begins in the slice; (x, y) is where the top left of the whole box would be.
  virtual void draw(cairo_t* cairo, double x, double y, const Slice& slice) const = 0;
  /// Adds what must not be cut, `top` being where the box begins.
  virtual void add_spans(double top, std::vector<Span>& spans) const = 0;

 protected:
  double width_ = 0.0;
  double height_ = 0.0;
};

using BoxPtr = std::unique_ptr<Box>;

/// Boxes below each other.
class Stack final : public Box {
 public:
  void add(double space_before, BoxPtr box) {
    parts_.push_back({space_before, 0.0, std::move(box)});
  }
  [[nodiscard]] Widths widths() const override;
  void lay(double width) override;
  void draw(cairo_t* cairo, double x, double y, const Slice& slice) const override;
  void add_spans(double top, std::vector<Span>& spans) const override;

 private:
  struct Part {
    double space_before = 0.0;
    double top = 0.0;
    BoxPtr box;
  };
  std::vector<Part> parts_;
};

/// Boxes beside each other in columns whose widths are given, all beginning at the top, or each in
/// the middle of the highest.
class Beside final : public Box {
 public:
  explicit Beside(bool middle = false) : middle_(middle) {}
  void add(double x, double width, BoxPtr box) { parts_.push_back({x, width, std::move(box)}); }
  /// A line along the bottom.
  void underline(double thickness, const Colour& colour) {
    line_ = thickness;
    colour_ = colour;
  }
  void pad(double above, double below) {
    above_ = above;
    below_ = below;
  }
  [[nodiscard]] Widths widths() const override;
  void lay(double width) override;
  void draw(cairo_t* cairo, double x, double y, const Slice& slice) const override;
  void add_spans(double top, std::vector<Span>& spans) const override;

 private:
  struct Part {
    double x = 0.0;
    double width = 0.0;
    BoxPtr box;
  };
  [[nodiscard]] double top_of(const Part& part) const;

  std::vector<Part> parts_;
  bool middle_ = false;
  double above_ = 0.0;
  double below_ = 0.0;
  double line_ = 0.0;
  Colour colour_;
};

/// How a box is framed.
struct Border {
  double left = 0.0;   ///< Thickness of its left side.
  double round = 0.0;  ///< Thickness of all other sides.
  double top = 0.0;    ///< Thickness of the top side, where it is the only other one.
  bool dashed = false;
  bool filled = false;
  double pad_x = 0.0;  ///< Space between border and content.
  double pad_y = 0.0;
  Colour left_colour;
  Colour colour;
  Colour ground;
};

/// A box inside a border.
class Framed final : public Box {
 public:
  Framed(const Border& border, BoxPtr inside) : border_(border), inside_(std::move(inside)) {}
  [[nodiscard]] Widths widths() const override;
  void lay(double width) override;
  void draw(cairo_t* cairo, double x, double y, const Slice& slice) const override;
  void add_spans(double top, std::vector<Span>& spans) const override;

 private:
  void draw_border(cairo_t* cairo, double x, double top, double bottom) const;

  Border border_;
  BoxPtr inside_;
};

}  // namespace rondure::reports::pdf
