#include "reports/pdf_box.h"

#include <algorithm>
#include <array>

#include <cairo.h>

namespace rondure::reports::pdf {

Widths Stack::widths() const {
  Widths out;
  for (const Part& part : parts_) {
    const Widths one = part.box->widths();
    out.least = std::max(out.least, one.least);
    out.wanted = std::max(out.wanted, one.wanted);
  }
  return out;
}

void Stack::lay(double width) {
  width_ = width;
  height_ = 0.0;
  for (Part& part : parts_) {
    part.box->lay(width);
    part.top = height_ + (height_ > 0.0 ? part.space_before : 0.0);
    height_ = part.top + part.box->height();
  }
}

void Stack::draw(cairo_t* cairo, double x, double y, const Slice& slice) const {
  for (const Part& part : parts_) {
    part.box->draw(cairo, x, y + part.top, {slice.from - part.top, slice.to - part.top});
  }
}

void Stack::add_spans(double top, std::vector<Span>& spans) const {
  for (const Part& part : parts_) part.box->add_spans(top + part.top, spans);
}

Widths Beside::widths() const {
  double width = 0.0;
  for (const Part& part : parts_) width = std::max(width, part.x + part.width);
  return {width, width};
}

void Beside::lay(double width) {
  width_ = width;
  height_ = 0.0;
  for (Part& part : parts_) {
    part.box->lay(part.width);
    height_ = std::max(height_, part.box->height());
  }
  height_ += above_ + below_;
}

double Beside::top_of(const Part& part) const {
  const double spare = height_ - above_ - below_ - part.box->height();
  return above_ + (middle_ ? 0.5 * spare : 0.0);
}

void Beside::draw(cairo_t* cairo, double x, double y, const Slice& slice) const {
  for (const Part& part : parts_) {
    const double top = top_of(part);
    part.box->draw(cairo, x + part.x, y + top, {slice.from - top, slice.to - top});
  }
  if (line_ <= 0.0 || slice.to < height_) return;
  cairo_set_source_rgb(cairo, colour_.red, colour_.green, colour_.blue);
  cairo_set_line_width(cairo, line_);
  cairo_move_to(cairo, x, y + height_);
  cairo_line_to(cairo, x + width_, y + height_);
  cairo_stroke(cairo);
}

void Beside::add_spans(double top, std::vector<Span>& spans) const {
  for (const Part& part : parts_) part.box->add_spans(top + top_of(part), spans);
}

Widths Framed::widths() const {
  const Widths inside = inside_->widths();
  const double more = 2.0 * border_.pad_x;
  return {inside.least + more, inside.wanted + more};
}

void Framed::lay(double width) {
  width_ = width;
  inside_->lay(width - 2.0 * border_.pad_x);
  height_ = inside_->height() + 2.0 * border_.pad_y;
}

void Framed::draw(cairo_t* cairo, double x, double y, const Slice& slice) const {
  const double from = std::max(slice.from, 0.0);
  const double to = std::min(slice.to, height_);
  if (to > from) draw_border(cairo, x, y + from, y + to);
  inside_->draw(cairo, x + border_.pad_x, y + border_.pad_y,
                {slice.from - border_.pad_y, slice.to - border_.pad_y});
}

void Framed::draw_border(cairo_t* cairo, double x, double top, double bottom) const {
  const auto ink = [&](const Colour& c) { cairo_set_source_rgb(cairo, c.red, c.green, c.blue); };
  cairo_save(cairo);
  if (border_.filled) {
    ink(border_.ground);
    cairo_rectangle(cairo, x, top, width_, bottom - top);
    cairo_fill(cairo);
  }
  ink(border_.colour);
  if (border_.round > 0.0) {
    constexpr std::array<double, 2> kDash = {3.0, 2.0};
    if (border_.dashed) cairo_set_dash(cairo, kDash.data(), 2, 0.0);
    cairo_set_line_width(cairo, border_.round);
    cairo_rectangle(cairo, x, top, width_, bottom - top);
    cairo_stroke(cairo);
  }
  if (border_.top > 0.0) {
    cairo_set_line_width(cairo, border_.top);
    cairo_move_to(cairo, x, top);
    cairo_line_to(cairo, x + width_, top);
    cairo_stroke(cairo);
  }
  if (border_.left > 0.0) {
    ink(border_.left_colour);
    cairo_rectangle(cairo, x, top, border_.left, bottom - top);
    cairo_fill(cairo);
  }
  cairo_restore(cairo);
}

void Framed::add_spans(double top, std::vector<Span>& spans) const {
  inside_->add_spans(top + border_.pad_y, spans);
}

}  // namespace rondure::reports::pdf
