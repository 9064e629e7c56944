#include "reports/data/xml_parts.h"

#include <sstream>

#include "reports/escaping.h"

namespace rondure::reports {

pugi::xml_node add(pugi::xml_node parent, const char* name) { return parent.append_child(name); }

pugi::xml_node add(pugi::xml_node parent, const char* name, std::string_view text) {
  pugi::xml_node node = parent.append_child(name);
  node.append_child(pugi::node_pcdata).set_value(clean(text).c_str());
  return node;
}

pugi::xml_node add(pugi::xml_node parent, const char* name, int number) {
  return add(parent, name, std::to_string(number));
}

void set(pugi::xml_node node, const char* name, std::string_view text) {
  node.append_attribute(name).set_value(clean(text).c_str());
}

std::string bytes_of(const pugi::xml_document& document) {
  std::ostringstream out;
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return out.str();
}

}  // namespace rondure::reports
