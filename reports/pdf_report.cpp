#include "reports/pdf_report.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <cairo-pdf.h>
#include <fmt/format.h>

#include "core/version.h"
#include "record/sha256.h"
#include "reports/words/language.h"
#include "reports/pdf_flow.h"
#include "reports/pdf_look.h"
#include "reports/text.h"
#include "reports/writers.h"

namespace rondure::reports::pdf {
namespace {

constexpr double kTextWidth = kPdfWidth - 2.0 * kPdfMargin;
constexpr double kTextHeight = kPdfHeight - kPdfTop - kPdfBottom;
constexpr double kHeadSize = 7.4;
constexpr std::string_view kDigestMark = "page-sha256-";
constexpr std::string_view kLanguageMark = ", page-language-";

struct ReleaseSurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
};

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

/// One document while it is set.
class Document {
 public:
  Document(const record::RunRecord& record, const Source& page)
      : record_(record),
        page_(page),
        surface_(cairo_pdf_surface_create_for_stream(append, &bytes_, kPdfWidth, kPdfHeight)),
        cairo_(cairo_create(surface_.get())),
        press_(cairo_.get(), page) {}

  core::Result<Pdf> write(std::string_view html);

 private:
  [[nodiscard]] std::vector<Brick> bricks();
  [[nodiscard]] TextStyle small() const;
  void describe(std::string_view html);
  void draw(const Placed& placed, std::vector<PdfFigure>& figures);
  void draw_head_and_foot(int page, int pages);
  void draw_line(double x, double y, double width, Align align, const std::string& text,
                 const TextStyle& style);
  void draw_rule(double y);
  void add_to_outline(const Placed& placed);

  const record::RunRecord& record_;
  const Source& page_;
  std::string bytes_;
  std::unique_ptr<cairo_surface_t, ReleaseSurface> surface_;
  std::unique_ptr<cairo_t, ReleaseSurface> cairo_;
  Press press_;
  std::vector<int> outline_ = {CAIRO_PDF_OUTLINE_ROOT};
};

TextStyle Document::small() const {
  TextStyle style;
  style.size_pt = kHeadSize;
  style.colour = page_.colour("--soft");
  return style;
}

std::vector<Brick> Document::bricks() {
  Flow flow(press_);
  Setting setting;
  setting.width = kTextWidth;
  setting.style.size_pt = kBodySize;
  setting.style.colour = page_.colour("--ink");
  std::vector<Brick> out = flow.bricks(page_.tree.child("body"), setting);
  for (Brick& brick : out) brick.box->lay(kTextWidth);
  if (press_.missing().empty()) return out;
  Words note(press_);
  note.add(missing_in_words({press_.missing().begin(), press_.missing().end()}), setting.style);
  Brick brick;
  brick.box = note.set(Align::kLeft);
  brick.may_be_cut = true;
  brick.box->lay(kTextWidth);
  out.insert(out.begin(), std::move(brick));
  return out;
}

/// The document's own information, as a viewer lists it.
void Document::describe(std::string_view html) {
  const record::Header& header = record_.header;
  const auto set = [&](cairo_pdf_metadata_t what, const std::string& text) {
    cairo_pdf_surface_set_metadata(surface_.get(), what, clean(text).c_str());
  };
  set(CAIRO_PDF_METADATA_TITLE, page_.title);
  set(CAIRO_PDF_METADATA_AUTHOR, header.operator_name);
  set(CAIRO_PDF_METADATA_SUBJECT, trf("Cylindricity report: {}, revision {}, run {}",
                                      header.plan_name, header.plan_revision, header.run_id));
  set(CAIRO_PDF_METADATA_KEYWORDS,
      fmt::format("{}, {}, {}, {}", header.part_id, header.serial, header.drawing, header.run_id));
  // Of the page: ASCII, which Cairo writes as it is.
  set(CAIRO_PDF_METADATA_CREATOR, fmt::format("rondure {}, {}{}{}{}", core::kVersion, kDigestMark,
                                              record::sha256_hex(std::string(html)), kLanguageMark,
                                              tag_of(language_of_page(html))));
  set(CAIRO_PDF_METADATA_CREATE_DATE,
      header.started_utc.empty() ? "1970-01-01T00:00:00Z" : header.started_utc);
}

void Document::draw_line(double x, double y, double width, Align align, const std::string& text,
                         const TextStyle& style) {
  Words words(press_);
  words.add(text, style);
  const BoxPtr box = words.set(align, true);
  box->lay(width);
  box->draw(cairo_.get(), x, y, {});
}

void Document::draw_rule(double y) {
  const Colour line = page_.colour("--line");
  cairo_set_source_rgb(cairo_.get(), line.red, line.green, line.blue);
  cairo_set_line_width(cairo_.get(), 0.6);
  cairo_move_to(cairo_.get(), kPdfMargin, y);
  cairo_line_to(cairo_.get(), kPdfMargin + kTextWidth, y);
  cairo_stroke(cairo_.get());
}

/// "Part ... | Revision ... | Run ..." above, "Page x of y" below.
void Document::draw_head_and_foot(int page, int pages) {
  constexpr double kHeadY = 30.0;
  constexpr double kFootY = kPdfHeight - 40.0;
  const record::Header& header = record_.header;
  const TextStyle style = small();
  const auto field = [](std::string_view name, const std::string& value) {
    constexpr std::size_t kMost = 160;  // no line holds more; Pango need not try with 10 kB
    return fmt::format("{} \u2068{}\u2069", name,
                       value.empty() ? "\u2013" : shortened(clean(value), kMost));
  };
  const std::string part =
      header.serial.empty() ? header.part_id : header.part_id + " / " + header.serial;
  draw_line(kPdfMargin, kHeadY, 0.40 * kTextWidth, Align::kLeft, field(tr("Part"), part), style);
  draw_line(kPdfMargin + 0.42 * kTextWidth, kHeadY, 0.16 * kTextWidth, Align::kLeft,
            field(tr("Revision"), header.plan_revision), style);
  draw_line(kPdfMargin + 0.60 * kTextWidth, kHeadY, 0.40 * kTextWidth, Align::kRight,
            field(tr("Run"), header.run_id), style);
  draw_rule(kHeadY + 13.0);
  draw_line(kPdfMargin, kFootY, 0.5 * kTextWidth, Align::kLeft,
            fmt::format("Rondure {}", core::kVersion), style);
  draw_line(kPdfMargin + 0.5 * kTextWidth, kFootY, 0.5 * kTextWidth, Align::kRight,
            trf("Page {} of {}", page, pages), style);
}

/// Headings as bookmarks, each below the last one of a higher level.
void Document::add_to_outline(const Placed& placed) {
  const Brick& brick = *placed.brick;
  if (brick.level < 1 || placed.box != brick.box.get() || placed.slice.from > 0.0) return;
  const auto depth = std::min(static_cast<std::size_t>(brick.level), outline_.size());
  outline_.resize(depth);
  const std::string place =
      fmt::format("page={} pos=[{:.2f} {:.2f}]", placed.page + 1, kPdfMargin, kPdfTop + placed.top);
  outline_.push_back(cairo_pdf_surface_add_outline(surface_.get(), outline_.back(),
                                                   shortened(clean(brick.heading), 200).c_str(),
                                                   place.c_str(), CAIRO_PDF_OUTLINE_FLAG_OPEN));
}

void Document::draw(const Placed& placed, std::vector<PdfFigure>& figures) {
  const double y = kPdfTop + placed.top;
  placed.box->draw(cairo_.get(), kPdfMargin, y - placed.slice.from, placed.slice);
  add_to_outline(placed);
  if (!placed.brick->figure) return;
  const bool whole = placed.slice.from <= 0.0 && placed.slice.to >= placed.box->height();
  figures.push_back({placed.page + 1, kPdfMargin, y, kPdfMargin + placed.box->width(),
                     y + placed.height(), whole});
}

core::Result<Pdf> Document::write(std::string_view html) {
  if (!press_.has_fonts()) {
    return core::fail(core::Code::kFile,
                      "no font is installed, a PDF cannot be set; install one "
                      "(Debian: fonts-dejavu-core)",
                      "report.pdf");
  }
  const std::vector<Brick> all = bricks();
  const std::vector<Placed> placed = paginate(all, kTextHeight);
  Pdf out;
  out.pages = placed.empty() ? 1 : placed.back().page + 1;
  describe(html);
  std::size_t next = 0;
  for (int page = 0; page < out.pages; ++page) {
    draw_head_and_foot(page + 1, out.pages);
    for (; next < placed.size() && placed[next].page == page; ++next) {
      draw(placed[next], out.figures);
    }
    cairo_show_page(cairo_.get());
  }
  cairo_surface_finish(surface_.get());
  const cairo_status_t status = cairo_surface_status(surface_.get());
  if (status != CAIRO_STATUS_SUCCESS) press_.note_fault(cairo_status_to_string(status));
  if (!press_.faults().empty()) {
    return core::fail(core::Code::kInternal,
                      fmt::format("the report cannot be set: {}", press_.faults().front()),
                      "report.pdf");
  }
  out.missing.assign(press_.missing().begin(), press_.missing().end());
  out.bytes = std::move(bytes_);
  return out;
}

/// What a document states of its page: digest, then language. Cairo writes it behind the names,
/// which may hold anything.
std::string_view statement_in(std::string_view bytes) {
  const std::size_t at = bytes.rfind(kDigestMark);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = bytes.substr(at + kDigestMark.size(), 200);
  return rest.substr(0, rest.find(')'));
}

}  // namespace
}  // namespace rondure::reports::pdf

namespace rondure::reports {

core::Result<Pdf> write_pdf(const record::RunRecord& record, std::string_view html) {
  const LanguageScope scope(language_of_page(html));
  const auto page = pdf::read_page(html);
  if (!page) return core::fail(page.error());
  return pdf::Document(record, *page).write(html);
}

std::string missing_in_words(const std::vector<char32_t>& missing) {
  if (missing.empty()) return {};
  constexpr std::size_t kMost = 8;
  std::string codes;
  for (std::size_t i = 0; i < std::min(missing.size(), kMost); ++i) {
    codes += fmt::format("{}U+{:04X}", i == 0 ? "" : ", ", static_cast<unsigned>(missing[i]));
  }
  if (missing.size() > kMost) codes += ", ...";
  return trf(
      "No installed font has these characters of the report: {}. They are shown as boxes with "
      "their codes. Install a font that has them and write the report again (Debian: "
      "fonts-noto-cjk for "
      "Chinese, fonts-noto-core for others).",
      codes);
}

std::optional<std::string> pdf_difference(std::string_view expected, std::string_view found,
                                          bool as_written) {
  if (expected == found) return std::nullopt;
  const bool same_page = pdf::statement_in(expected) == pdf::statement_in(found);
  if (!same_page) return "it was set from another page than the journal gives";
  if (as_written) return std::nullopt;
  return "its bytes are not those that are set now from the same page";
}

Language language_of_pdf(std::string_view bytes) {
  const std::string mark = fmt::format("{}{}", pdf::kLanguageMark, tag_of(Language::kChinese));
  return pdf::statement_in(bytes).ends_with(mark) ? Language::kChinese : Language::kEnglish;
}

}  // namespace rondure::reports
