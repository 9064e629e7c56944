#pragma once

#include <string>
#include <string_view>

#include <pugixml.hpp>

// Private to the room: what the writer of QIF is made of.

namespace rondure::reports {

/// A new last child. Text passes clean(): XML 1.0 forbids most control characters even as entities,
/// which pugixml would write.
pugi::xml_node add(pugi::xml_node parent, const char* name);
pugi::xml_node add(pugi::xml_node parent, const char* name, std::string_view text);
pugi::xml_node add(pugi::xml_node parent, const char* name, int number);

/// A new attribute, its text cleaned in the same way.
void set(pugi::xml_node node, const char* name, std::string_view text);

/// The document as bytes: declaration, UTF-8, two spaces a level, LF.
[[nodiscard]] std::string bytes_of(const pugi::xml_document& document);

}  // namespace rondure::reports
