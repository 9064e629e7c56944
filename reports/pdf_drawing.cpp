#include "reports/pdf_drawing.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include <cairo.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>

namespace rondure::reports::pdf {
namespace {

struct ReleaseDrawing {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(GError* error) const { g_error_free(error); }
};
using Handle = std::unique_ptr<RsvgHandle, ReleaseDrawing>;

/// Takes the reason out of GLib's hands.
std::string reason_of(GError* error) {
  const std::unique_ptr<GError, ReleaseDrawing> owned(error);
  return owned ? owned->message : "no reason given";
}

/// Natural size [pt]: the attributes where they are numbers, else the view box.
std::pair<double, double> size_of(const pugi::xml_node& svg) {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
  std::istringstream box(svg.attribute("viewBox").value());
  box >> x >> y >> width >> height;
  const double asked = svg.attribute("width").as_double();
  const bool relative = std::string_view(svg.attribute("width").value()).ends_with('%');
  const double scale = asked > 0.0 && !relative && width > 0.0 ? asked / width : 1.0;
  return {kPxToPt * scale * width, kPxToPt * scale * height};
}

/// The element as a document of its own.
std::string document_of(const pugi::xml_node& svg) {
  pugi::xml_document copy;
  pugi::xml_node root = copy.append_copy(svg);
  if (!root.attribute("xmlns")) {
    root.prepend_attribute("xmlns").set_value("http://www.w3.org/2000/svg");
  }
  std::ostringstream bytes;
  copy.save(bytes, "", pugi::format_raw | pugi::format_no_declaration);
  return bytes.str();
}

class Drawing final : public Box {
 public:
  Drawing(Press& press, Handle handle, double width, double height, bool centred)
      : press_(press),
        handle_(std::move(handle)),
        natural_width_(width),
        natural_height_(height),
        centred_(centred) {}

  [[nodiscard]] Widths widths() const override {
    constexpr double kLeastShare = 0.6;  // of its size, where a table is narrow
    return {kLeastShare * natural_width_, natural_width_};
  }

  void lay(double width) override {
    width_ = width;
    scale_ = natural_width_ > 0.0 ? std::min(1.0, width / natural_width_) : 0.0;
    height_ = scale_ * natural_height_;
  }

  void draw(cairo_t* cairo, double x, double y, const Slice& slice) const override {
    if (!slice.holds(0.0) || !handle_) return;
    const double width = scale_ * natural_width_;
    const double left = centred_ ? 0.5 * (width_ - width) : 0.0;
    const RsvgRectangle place = {x + left, y, width, height_};
    cairo_save(cairo);
    GError* error = nullptr;
    if (rsvg_handle_render_document(handle_.get(), cairo, &place, &error) == FALSE) {
      press_.note_fault(fmt::format("a drawing cannot be drawn: {}", reason_of(error)));
    }
    cairo_restore(cairo);
  }

  void add_spans(double top, std::vector<Span>& spans) const override {
    spans.push_back({top, top + height_});
  }

 private:
  Press& press_;
  Handle handle_;
  double natural_width_ = 0.0;
  double natural_height_ = 0.0;
  double scale_ = 1.0;
  bool centred_ = false;
};

/// The style of drawings, with the fonts of the report and what its rules for print say.
std::string style_of(const Source& page) {
  return page.drawing_style +
         fmt::format(
             "svg{{font-family:{}}}.print-only{{display:inline}}.screen-only{{display:none}}",
             kFamilies);
}

Handle read(Press& press, const std::string& document) {
  GError* error = nullptr;
  const auto* bytes = reinterpret_cast<const guint8*>(document.data());
  Handle handle(rsvg_handle_new_from_data(bytes, document.size(), &error));
  if (!handle) {
    press.note_fault(fmt::format("a drawing cannot be read: {}", reason_of(error)));
    return nullptr;
  }
  const std::string style = style_of(press.page());
  const auto* css = reinterpret_cast<const guint8*>(style.data());
  if (rsvg_handle_set_stylesheet(handle.get(), css, style.size(), &error) == FALSE) {
    press.note_fault(fmt::format("the style of a drawing: {}", reason_of(error)));
  }
  return handle;
}

}  // namespace

double drawing_width(const pugi::xml_node& svg) { return size_of(svg).first; }

BoxPtr set_drawing(Press& press, const pugi::xml_node& svg, double widest, bool centred) {
  auto [width, height] = size_of(svg);
  if (!(width > 0.0) || !(height > 0.0)) {
    press.note_fault("a drawing has no size");
    return std::make_unique<Drawing>(press, nullptr, 0.0, 0.0, centred);
  }
  if (width > widest) {
    height *= widest / width;
    width = widest;
  }
  for (const auto& text : svg.select_nodes(".//text")) {
    press.note_missing(text.node().text().get());
  }
  return std::make_unique<Drawing>(press, read(press, document_of(svg)), width, height, centred);
}

}  // namespace rondure::reports::pdf
