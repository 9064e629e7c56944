#pragma once

#include <vector>

#include "reports/pdf_pages.h"
#include "reports/pdf_text.h"

// Private to the room: from the tags of the page to what is set.

namespace rondure::reports::pdf {

/// What an element inherits.
struct Setting {
  TextStyle style;
  Align align = Align::kLeft;
  double width = 0.0;           ///< Room [pt].
  double widest_drawing = 1e9;  ///< [pt].
};

/// Sets elements of the page by their tags. What it does not know, it sets as a paragraph or as
/// part of one: no text is ever left out, but that of elements which are not on_paper().
class Flow {
 public:
  explicit Flow(Press& press) : press_(press) {}

  /// The children of an element, one below the other, not laid out.
  [[nodiscard]] std::vector<Brick> bricks(const pugi::xml_node& parent, const Setting& setting);
  /// The same as one box, not laid out.
  [[nodiscard]] BoxPtr stack(const pugi::xml_node& parent, const Setting& setting);
  /// What an element inherits and its tag and classes change.
  [[nodiscard]] Setting inside(const pugi::xml_node& node, const Setting& around) const;
  [[nodiscard]] Press& press() { return press_; }

 private:
  using Nodes = std::vector<pugi::xml_node>;

  void gather(const pugi::xml_node& parent, const Setting& setting, std::vector<Brick>& out);
  void paragraph(const Nodes& run, const Setting& setting, std::vector<Brick>& out);
  void block(const pugi::xml_node& node, const Setting& around, std::vector<Brick>& out);
  void division(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out);
  void heading(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out);
  void figure(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out);
  void figures(const Nodes& all, const Setting& setting, std::vector<Brick>& out);
  void mark_and_words(const Nodes& parts, const Setting& setting, std::vector<Brick>& out);
  void item(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out);
  void framed(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out);
  void definitions(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out);
  void facts(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out);
  void keys(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out);
  void words(const pugi::xml_node& node, const Setting& setting, Words& out);
  void framed_words(const pugi::xml_node& node, const Setting& setting, Words& out);
  [[nodiscard]] BoxPtr definition(const pugi::xml_node& entry, const Setting& setting);

  Press& press_;
};

}  // namespace rondure::reports::pdf
