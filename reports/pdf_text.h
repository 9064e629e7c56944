#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "reports/pdf_box.h"

struct _PangoContext;  // NOLINT(bugprone-reserved-identifier): Pango's
struct _PangoLayout;   // NOLINT(bugprone-reserved-identifier): Pango's

// Private to the room: text of report.pdf, through Pango.

namespace rondure::reports::pdf {

/// Families asked for, in this order; fontconfig adds those that have what these lack.
inline constexpr const char* kFamilies = "DejaVu Sans, Noto Sans, Noto Sans CJK SC";
inline constexpr const char* kMonoFamilies = "DejaVu Sans Mono, Noto Sans Mono CJK SC";

struct TextStyle {
  double size_pt = 9.0;
  bool bold = false;
  bool italic = false;
  bool mono = false;
  double rise_pt = 0.0;  ///< Above the baseline; below where negative.
  Colour colour;
};

enum class Align { kLeft, kCentre, kRight };

/// What all text of one document shares: fonts, language; collects what could not be set.
class Press {
 public:
  /// For drawing with `cairo`, which must outlive it.
  Press(cairo_t* cairo, const Source& page);
  ~Press();
  Press(const Press&) = delete;
  Press& operator=(const Press&) = delete;

  [[nodiscard]] const Source& page() const { return page_; }
  [[nodiscard]] _PangoContext* context() const { return context_; }
  /// Whether there is a font with Latin letters; nothing can be set without.
  [[nodiscard]] bool has_fonts() const;
  /// Notes the characters of a layout for which no installed font has a shape.
  void note_missing(_PangoLayout* layout);
  /// The same of a text that another library sets.
  void note_missing(const std::string& text);
  [[nodiscard]] const std::set<char32_t>& missing() const { return missing_; }
  /// Notes a part that could not be set, which is a defect of the program.
  void note_fault(std::string what) { faults_.push_back(std::move(what)); }
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }

 private:
  const Source& page_;
  _PangoContext* context_ = nullptr;
  std::set<char32_t> missing_;
  std::vector<std::string> faults_;
};

/// Collects the words of one paragraph, then sets them. White space counts as in HTML.
class Words {
 public:
  explicit Words(Press& press) : press_(press) {}

  void add(std::string_view text, const TextStyle& style);
  void line_break();
  /// A small drawing that stands in the line like a letter.
  void add(BoxPtr drawing, const TextStyle& style);
  /// Characters that are there only for their direction or width; never collapsed.
  void add_mark(std::string_view mark, const TextStyle& style);

  /// Draws a frame around all added since `from` (of place()).
  void frame_since(std::size_t from);
  [[nodiscard]] std::size_t place() const { return text_.size(); }
  [[nodiscard]] bool empty() const { return text_.empty(); }
  /// As written, for the outline.
  [[nodiscard]] const std::string& text() const { return text_; }

  /// The paragraph; `one_line` ends with an ellipsis where it would need a second line.
  [[nodiscard]] BoxPtr set(Align align, bool one_line = false);

 private:
  friend class TextBox;
  struct Run {
    std::size_t from = 0;
    std::size_t to = 0;
    TextStyle style;
  };
  struct Inset {
    std::size_t at = 0;
    BoxPtr box;
  };
  void put(std::string_view text, const TextStyle& style);
  void put_pending_space();

  Press& press_;
  std::string text_;
  std::vector<Run> runs_;
  std::vector<Inset> insets_;
  std::vector<Span> frames_;  ///< Bytes.
  bool pending_space_ = false;
  TextStyle space_style_;
};

}  // namespace rondure::reports::pdf
