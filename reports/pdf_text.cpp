#include "reports/pdf_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <pango/pangocairo.h>

#ifdef __SANITIZE_ADDRESS__
// Patterns that fontconfig hands to Pango live until the program ends, and Cairo 1.16 loses 0.8 kB
// a document. Nothing is printed of it: the tests read what the program says.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig\nleak:libcairo\n";
}
extern "C" const char* __lsan_default_options();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
#endif

namespace rondure::reports::pdf {

struct ReleaseLayout {
  void operator()(PangoLayout* layout) const { g_object_unref(layout); }
  void operator()(PangoLayoutIter* iter) const { pango_layout_iter_free(iter); }
  void operator()(PangoAttrList* list) const { pango_attr_list_unref(list); }
};
using LayoutPtr = std::unique_ptr<PangoLayout, ReleaseLayout>;
using IterPtr = std::unique_ptr<PangoLayoutIter, ReleaseLayout>;

namespace {

constexpr std::string_view kObject = "\uFFFC";  // stands for a drawing in the line
constexpr double kFramePad = 3.0;
constexpr double kUsualSize = 8.8;
/// A word may be broken where it would make a column wider than this.
constexpr double kLongestWord = 104.0;

int units(double pt) { return static_cast<int>(std::lround(pt * PANGO_SCALE)); }
double points(int units) { return static_cast<double>(units) / PANGO_SCALE; }
guint16 channel(double part) { return static_cast<guint16>(std::lround(65535.0 * part)); }

void insert(PangoAttrList* list, PangoAttribute* attribute, std::size_t from, std::size_t to) {
  attribute->start_index = static_cast<guint>(from);
  attribute->end_index = static_cast<guint>(to);
  pango_attr_list_insert(list, attribute);
}

void style_range(PangoAttrList* list, const TextStyle& style, std::size_t from, std::size_t to) {
  if (style.size_pt != kUsualSize)
    insert(list, pango_attr_size_new(units(style.size_pt)), from, to);
  if (style.mono) insert(list, pango_attr_family_new(kMonoFamilies), from, to);
  if (style.bold) insert(list, pango_attr_weight_new(PANGO_WEIGHT_BOLD), from, to);
  if (style.italic) insert(list, pango_attr_style_new(PANGO_STYLE_OBLIQUE), from, to);
  if (style.rise_pt != 0.0) insert(list, pango_attr_rise_new(units(style.rise_pt)), from, to);
  insert(list,
         pango_attr_foreground_new(channel(style.colour.red), channel(style.colour.green),
                                   channel(style.colour.blue)),
         from, to);
}

}  // namespace

Press::Press(cairo_t* cairo, const Source& page)
    : page_(page), context_(pango_cairo_create_context(cairo)) {
  pango_cairo_context_set_resolution(context_, 72.0);  // a size in pt is one in units of the page
  pango_context_set_round_glyph_positions(context_, FALSE);
  pango_context_set_base_dir(context_, PANGO_DIRECTION_LTR);
  PangoFontDescription* usual = pango_font_description_from_string(kFamilies);
  pango_font_description_set_size(usual, units(kUsualSize));
  pango_context_set_font_description(context_, usual);
  pango_font_description_free(usual);
  pango_context_set_language(context_, pango_language_from_string(page.language.c_str()));
}

Press::~Press() { g_object_unref(context_); }

bool Press::has_fonts() const {
  // Pango lists families that fontconfig only promises, so letters are asked for.
  const LayoutPtr letters(pango_layout_new(context_));
  pango_layout_set_text(letters.get(), "Page 1", -1);
  return pango_layout_get_unknown_glyphs_count(letters.get()) == 0;
}

void Press::note_missing(PangoLayout* layout) {
  if (pango_layout_get_unknown_glyphs_count(layout) == 0) return;
  const IterPtr iter(pango_layout_get_iter(layout));
  do {
    const PangoLayoutRun* run = pango_layout_iter_get_run_readonly(iter.get());
    if (run == nullptr) continue;
    for (int i = 0; i < run->glyphs->num_glyphs; ++i) {
      const PangoGlyph glyph = run->glyphs->glyphs[i].glyph;
      if ((glyph & PANGO_GLYPH_UNKNOWN_FLAG) != 0 && glyph != PANGO_GLYPH_INVALID_INPUT) {
        missing_.insert(static_cast<char32_t>(glyph & ~PANGO_GLYPH_UNKNOWN_FLAG));
      }
    }
  } while (pango_layout_iter_next_run(iter.get()) != FALSE);
}

void Press::note_missing(const std::string& text) {
  const bool ascii =
      std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (ascii) return;
  Words words(*this);
  words.add(text, {});
  words.set(Align::kLeft)->lay(1000.0);
}

/// A paragraph as Pango lays it out.
class TextBox final : public Box {
 public:
  TextBox(Words&& words, Align align, bool one_line)
      : press_(words.press_),
        layout_(pango_layout_new(words.press_.context())),
        insets_(std::move(words.insets_)),
        frames_(std::move(words.frames_)) {
    pango_layout_set_text(layout_.get(), words.text_.data(), static_cast<int>(words.text_.size()));
    pango_layout_set_auto_dir(layout_.get(), FALSE);
    pango_layout_set_wrap(layout_.get(), PANGO_WRAP_WORD_CHAR);
    pango_layout_set_alignment(layout_.get(), align == Align::kLeft     ? PANGO_ALIGN_LEFT
                                              : align == Align::kCentre ? PANGO_ALIGN_CENTER
                                                                        : PANGO_ALIGN_RIGHT);
    if (one_line) {
      pango_layout_set_single_paragraph_mode(layout_.get(), TRUE);
      pango_layout_set_ellipsize(layout_.get(), PANGO_ELLIPSIZE_END);
    }
    const std::unique_ptr<PangoAttrList, ReleaseLayout> list(pango_attr_list_new());
    for (const Words::Run& run : words.runs_) style_range(list.get(), run.style, run.from, run.to);
    for (const Words::Inset& inset : insets_) {
      inset.box->lay(inset.box->widths().wanted);
      const PangoRectangle room = {0, -units(0.8 * inset.box->height()),
                                   units(inset.box->width() + 2.0), units(inset.box->height())};
      insert(list.get(), pango_attr_shape_new(&room, &room), inset.at, inset.at + kObject.size());
    }
    insert(list.get(), pango_attr_insert_hyphens_new(FALSE), 0, words.text_.size());
    pango_layout_set_attributes(layout_.get(), list.get());
  }

  [[nodiscard]] Widths widths() const override {
    constexpr double kSpare = 0.5;  // for what Pango rounds
    constexpr int kLongText = 1500;
    constexpr double kWideEnough = 4000.0;  // as good as endless: laying it out twice more costs
    if (pango_layout_get_character_count(layout_.get()) > kLongText) {
      return {kLongestWord, kWideEnough};
    }
    PangoRectangle room;
    laid_ = -1.0;
    pango_layout_set_wrap(layout_.get(), PANGO_WRAP_WORD);
    pango_layout_set_width(layout_.get(), 0);
    pango_layout_get_extents(layout_.get(), nullptr, &room);
    const double least = std::min(points(room.width), kLongestWord);
    pango_layout_set_wrap(layout_.get(), PANGO_WRAP_WORD_CHAR);
    pango_layout_set_width(layout_.get(), -1);
    pango_layout_get_extents(layout_.get(), nullptr, &room);
    wanted_ = points(room.width) + kSpare;
    return {least + kSpare, wanted_};
  }

  void lay(double width) override {
    if (width == laid_) return;
    width_ = laid_ = width;
    // Text that widths() found to fit is laid out already.
    const bool fits = wanted_ > 0.0 && wanted_ <= width &&
                      pango_layout_get_alignment(layout_.get()) == PANGO_ALIGN_LEFT;
    pango_layout_set_width(layout_.get(), fits ? -1 : std::max(units(width), 1));
    PangoRectangle room;
    pango_layout_get_extents(layout_.get(), nullptr, &room);
    height_ = points(room.height);
    press_.note_missing(layout_.get());
  }

  void draw(cairo_t* cairo, double x, double y, const Slice& slice) const override {
    const IterPtr iter(pango_layout_get_iter(layout_.get()));
    do {
      PangoRectangle room;
      pango_layout_iter_get_line_extents(iter.get(), nullptr, &room);
      if (!slice.holds(points(room.y))) continue;
      cairo_move_to(cairo, x + points(room.x),
                    y + points(pango_layout_iter_get_baseline(iter.get())));
      pango_cairo_show_layout_line(cairo, pango_layout_iter_get_line_readonly(iter.get()));
    } while (pango_layout_iter_next_line(iter.get()) != FALSE);
    draw_insets(cairo, x, y, slice);
    draw_frames(cairo, x, y, slice);
  }

  void add_spans(double top, std::vector<Span>& spans) const override {
    const IterPtr iter(pango_layout_get_iter(layout_.get()));
    do {
      PangoRectangle room;
      pango_layout_iter_get_line_extents(iter.get(), nullptr, &room);
      spans.push_back({top + points(room.y), top + points(room.y + room.height)});
    } while (pango_layout_iter_next_line(iter.get()) != FALSE);
  }

 private:
  [[nodiscard]] PangoRectangle place_of(std::size_t at) const {
    PangoRectangle room;
    pango_layout_index_to_pos(layout_.get(), static_cast<int>(at), &room);
    return room;
  }

  /// Where the line of a place begins.
  [[nodiscard]] double line_top(std::size_t at) const {
    const IterPtr iter(pango_layout_get_iter(layout_.get()));
    PangoRectangle room = {0, 0, 0, 0};
    do {
      const PangoLayoutLine* line = pango_layout_iter_get_line_readonly(iter.get());
      if (line->start_index > static_cast<int>(at)) break;
      pango_layout_iter_get_line_extents(iter.get(), nullptr, &room);
    } while (pango_layout_iter_next_line(iter.get()) != FALSE);
    return points(room.y);
  }

  void draw_insets(cairo_t* cairo, double x, double y, const Slice& slice) const {
    for (const Words::Inset& inset : insets_) {
      if (!slice.holds(line_top(inset.at))) continue;
      const PangoRectangle room = place_of(inset.at);
      inset.box->draw(cairo, x + points(room.x) + 1.0, y + points(room.y), {});
    }
  }

  void draw_frames(cairo_t* cairo, double x, double y, const Slice& slice) const {
    for (const Span& frame : frames_) {
      const auto from = static_cast<std::size_t>(frame.top);
      if (!slice.holds(line_top(from))) continue;
      const PangoRectangle first = place_of(from);
      const PangoRectangle last = place_of(static_cast<std::size_t>(frame.bottom));
      const double top = y + points(std::min(first.y, last.y));
      const double bottom = y + points(std::max(first.y + first.height, last.y + last.height));
      cairo_set_source_rgb(cairo, 0.0, 0.0, 0.0);
      cairo_set_line_width(cairo, 0.8);
      cairo_rectangle(cairo, x + points(first.x) - kFramePad, top,
                      points(last.x - first.x) + 2.0 * kFramePad, bottom - top);
      cairo_stroke(cairo);
    }
  }

  Press& press_;
  LayoutPtr layout_;
  std::vector<Words::Inset> insets_;
  std::vector<Span> frames_;
  mutable double wanted_ = 0.0;  ///< Of widths(), once asked.
  mutable double laid_ = -1.0;   ///< Width for which it is laid out now.
};

void Words::put(std::string_view text, const TextStyle& style) {
  if (text.empty()) return;
  runs_.push_back({text_.size(), text_.size() + text.size(), style});
  text_ += text;
}

void Words::put_pending_space() {
  if (pending_space_ && !text_.empty() && text_.back() != '\n') put(" ", space_style_);
  pending_space_ = false;
}

void Words::add(std::string_view text, const TextStyle& style) {
  constexpr std::string_view kSpace = " \t\r\n\f";
  while (!text.empty()) {
    const std::size_t spaces = std::min(text.find_first_not_of(kSpace), text.size());
    if (spaces > 0) {
      if (!pending_space_) space_style_ = style;
      pending_space_ = true;
      text.remove_prefix(spaces);
      continue;
    }
    const std::string_view word = text.substr(0, text.find_first_of(kSpace));
    put_pending_space();
    put(word, style);
    text.remove_prefix(word.size());
  }
}

void Words::line_break() {
  pending_space_ = false;
  text_ += '\n';
}

void Words::add(BoxPtr drawing, const TextStyle& style) {
  put_pending_space();
  insets_.push_back({text_.size(), std::move(drawing)});
  put(kObject, style);
}

void Words::add_mark(std::string_view mark, const TextStyle& style) {
  put_pending_space();
  put(mark, style);
}

void Words::frame_since(std::size_t from) {
  frames_.push_back({static_cast<double>(from), static_cast<double>(text_.size())});
}

BoxPtr Words::set(Align align, bool one_line) {
  return std::make_unique<TextBox>(std::move(*this), align, one_line);
}

}  // namespace rondure::reports::pdf
