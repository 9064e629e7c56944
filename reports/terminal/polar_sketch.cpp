#include "reports/terminal/polar_sketch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/section.h"
#include "reports/words/internal/facts.h"

namespace rondure::reports {
namespace {

constexpr double kInner = 0.62;  ///< Radius of the inner circle in the drawing, whose edge is at 1.
constexpr double kOuter = 0.97;

/// A field of dots. Characters are twice as high as wide: an ASCII character is one dot wide and
/// counts two in height, a braille character has two by four dots.
class DotCanvas {
 public:
  explicit DotCanvas(bool braille)
      : braille_(braille),
        width_(braille ? 2 * kSketchColumns : kSketchColumns),
        height_(braille ? 4 * kSketchRows : kSketchRows),
        dots_(static_cast<std::size_t>(width_ * height_), ' '),
        marks_(static_cast<std::size_t>(kSketchColumns * kSketchRows), ' ') {}

  /// x to the right, y up, both in [-1, 1]. `ink` is the letter for the dot in ASCII.
  void dot(double x, double y, char ink) {
    const int column = place(x, width_);
    const int row = place(-y, height_);
    char& there = dots_[static_cast<std::size_t>(row * width_ + column)];
    if (there == ' ' || ink == '*') there = ink;
  }

  /// A character at a contact: 'O' outer, 'I' inner.
  void mark(double x, double y, char ink) {
    marks_[static_cast<std::size_t>(place(-y, kSketchRows) * kSketchColumns +
                                    place(x, kSketchColumns))] = ink;
  }

  [[nodiscard]] std::vector<std::string> rows() const {
    std::vector<std::string> out(kSketchRows);
    for (int row = 0; row < kSketchRows; ++row) {
      for (int column = 0; column < kSketchColumns; ++column) {
        out[static_cast<std::size_t>(row)] += character(row, column);
      }
    }
    return out;
  }

 private:
  static int place(double at, int size) {
    return std::clamp(static_cast<int>(std::floor(0.5 * (at + 1.0) * size)), 0, size - 1);
  }

  [[nodiscard]] std::string character(int row, int column) const {
    const char mark = marks_[static_cast<std::size_t>(row * kSketchColumns + column)];
    if (!braille_) {
      const char there = dots_[static_cast<std::size_t>(row * width_ + column)];
      return {mark != ' ' ? mark : there};
    }
    if (mark != ' ') return mark == 'O' ? "\u25CF" : "\u25CB";
    // The bits of U+2800: left column 1 2 3 7, right column 4 5 6 8, from the top.
    constexpr std::array<std::array<unsigned, 2>, 4> kBits = {
        {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}}};
    unsigned bits = 0;
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 2; ++c) {
        const int at = (4 * row + r) * width_ + 2 * column + c;
        if (dots_[static_cast<std::size_t>(at)] != ' ') {
          bits |= kBits[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
        }
      }
    }
    if (bits == 0) return " ";
    return {static_cast<char>(0xE2), static_cast<char>(0xA0 | (bits >> 6U)),
            static_cast<char>(0x80 | (bits & 0x3FU))};
  }

  bool braille_;
  int width_;
  int height_;
  std::string dots_;
  std::string marks_;
};

/// Radius in the drawing for a deviation: the zone fills the ring between the two circles.
double drawn_radius(double deviation_mm, double zone_mm) {
  const double share = std::clamp(deviation_mm / zone_mm + 0.5, -0.2, 1.0);
  return kInner + share * (kOuter - kInner);
}

void draw_circle(DotCanvas& canvas, double radius, int dots) {
  for (int i = 0; i < dots; ++i) {
    const double t = core::kTwoPi * i / dots;
    canvas.dot(radius * std::cos(t), radius * std::sin(t), '.');
  }
}

/// Draws straight lines between neighbours in angle and radius; a gap in the data stays open.
void draw_profile(DotCanvas& canvas, const evaluation::Section& section, double zone_mm) {
  const std::size_t n = section.profile.size();
  for (std::size_t i = 0; i < n; ++i) {
    const evaluation::SectionPoint& a = section.profile[i];
    evaluation::SectionPoint b = section.profile[(i + 1) % n];
    if (i + 1 == n) b.angle_rad += core::kTwoPi;
    const double gap = b.angle_rad - a.angle_rad;
    const bool joined = has_line(section) && gap <= section.widest_gap_rad;
    const int steps = joined ? std::max(1, static_cast<int>(gap * 24.0)) : 1;
    for (int k = 0; k < steps; ++k) {
      const double s = static_cast<double>(k) / steps;
      const double t = a.angle_rad + s * gap;
      const double r = drawn_radius(
          a.deviation_mm + s * (joined ? b.deviation_mm - a.deviation_mm : 0.0), zone_mm);
      canvas.dot(r * std::cos(t), r * std::sin(t), '*');
    }
  }
}

void draw_contacts(DotCanvas& canvas, const evaluation::FeatureResult& feature) {
  for (const evaluation::CloudPoint& point : feature.cloud) {
    if (!point.outer_contact && !point.inner_contact) continue;
    const double r = point.outer_contact ? kOuter : kInner;
    canvas.mark(r * std::cos(point.angle_rad), r * std::sin(point.angle_rad),
                point.outer_contact ? 'O' : 'I');
  }
}

double extent_mm(const evaluation::Section& section) {
  const auto [low, high] =
      std::minmax_element(section.profile.begin(), section.profile.end(),
                          [](const evaluation::SectionPoint& a, const evaluation::SectionPoint& b) {
                            return a.deviation_mm < b.deviation_mm;
                          });
  return section.profile.empty() ? 0.0 : high->deviation_mm - low->deviation_mm;
}

}  // namespace

std::optional<PolarSketch> polar_sketch(const evaluation::FeatureResult& feature,
                                        SketchStyle style) {
  const auto zone = zone_of(feature);
  if (style == SketchStyle::kNone || !zone || !(zone->deviation_mm > 0.0)) return {};
  const std::vector<evaluation::Section> sections = sections_of(feature);
  const auto widest =
      std::max_element(sections.begin(), sections.end(),
                       [](const evaluation::Section& a, const evaluation::Section& b) {
                         return extent_mm(a) < extent_mm(b);
                       });
  if (widest == sections.end() || widest->profile.empty()) return {};
  const bool braille = style == SketchStyle::kBraille;
  DotCanvas canvas(braille);
  draw_circle(canvas, kInner, braille ? 48 : 20);
  draw_circle(canvas, kOuter, braille ? 72 : 36);
  draw_profile(canvas, *widest, zone->deviation_mm);
  draw_contacts(canvas, feature);
  return PolarSketch{canvas.rows(), title_of(*widest),
                     static_cast<std::size_t>(widest - sections.begin()) + 1, sections.size()};
}

}  // namespace rondure::reports
