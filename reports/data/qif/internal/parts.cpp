#include "reports/data/qif/internal/parts.h"

#include <sstream>

#include <fmt/format.h>

#include "core/numbers.h"
#include "reports/escaping.h"

namespace rondure::reports {

pugi::xml_node add_list(pugi::xml_node parent, const char* name) {
  pugi::xml_node list = add(parent, name);
  list.append_attribute("n").set_value(0);
  return list;
}

void finish_lists(pugi::xml_node node) {
  for (pugi::xml_node child = node.first_child(); child;) {
    const pugi::xml_node next = child.next_sibling();
    finish_lists(child);
    if (pugi::xml_attribute n = child.attribute("n")) {
      int count = 0;
      for (const pugi::xml_node item : child.children()) count += item.name()[0] != '\0' ? 1 : 0;
      n.set_value(count);
      if (count == 0) node.remove_child(child);
    }
    child = next;
  }
}

std::string text_of(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", core::shortest(v.x()), core::shortest(v.y()),
                     core::shortest(v.z()));
}

QifStatus status_of(evaluation::Verdict verdict) {
  switch (verdict) {
    case evaluation::Verdict::kConforms:
      return {"PASS", "PASS"};
    case evaluation::Verdict::kDoesNotConform:
      return {"FAIL", "FAIL"};
    case evaluation::Verdict::kUndecided:
      return {"INDETERMINATE", "UNKNOWN"};
    case evaluation::Verdict::kNotToleranced:
      return {"NOT_ANALYZED", "NOT_CALCULATED"};
    case evaluation::Verdict::kVoid:
      break;
  }
  return {"UNDEFINED", "UNDEFINED"};
}

void add_references(pugi::xml_node parent, const char* name, const std::vector<int>& ids) {
  if (ids.empty()) return;
  pugi::xml_node list = add_list(parent, name);
  for (const int id : ids) add(list, "Id", id);
}

void add_algorithm(pugi::xml_node parent, record::Reference reference) {
  constexpr std::array<const char*, kReferences> kWords = {"LEASTSQUARES", "MINMAX",
                                                           "MINCIRCUMSCRIBED", "MAXINSCRIBED"};
  add(add(parent, "SubstituteFeatureAlgorithm"), "SubstituteFeatureAlgorithmEnum",
      kWords[static_cast<std::size_t>(reference)]);
}

void add_attributes(pugi::xml_node parent,
                    const std::vector<std::pair<const char*, std::string>>& texts) {
  pugi::xml_node list = add_list(parent, "Attributes");
  for (const auto& [name, text] : texts) {
    if (text.empty()) continue;
    pugi::xml_node attribute = add(list, "AttributeStr");
    set(attribute, "name", name);
    set(attribute, "value", text);
  }
}

pugi::xml_node add(pugi::xml_node parent, const char* name) { return parent.append_child(name); }

pugi::xml_node add(pugi::xml_node parent, const char* name, std::string_view text) {
  pugi::xml_node node = parent.append_child(name);
  node.append_child(pugi::node_pcdata).set_value(clean(text).c_str());
  return node;
}

pugi::xml_node add(pugi::xml_node parent, const char* name, int number) {
  return add(parent, name, std::to_string(number));
}

pugi::xml_node add_numbered(QifDraft& draft, pugi::xml_node parent, const std::string& name) {
  pugi::xml_node node = add(parent, name.c_str());
  node.append_attribute("id").set_value(draft.ids.next());
  return node;
}

int id_of(const pugi::xml_node& node) { return node.attribute("id").as_int(); }

void set(pugi::xml_node node, const char* name, std::string_view text) {
  node.append_attribute(name).set_value(clean(text).c_str());
}

std::string bytes_of(const pugi::xml_document& document) {
  std::ostringstream out;
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return out.str();
}

}  // namespace rondure::reports
