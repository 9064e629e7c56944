#include "reports/data/qif/internal/parts.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

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

namespace {

constexpr double kUnit = 1e-9;      ///< Largest |length - 1| of a direction.
constexpr double kRadii_mm = 1e-9;  ///< Largest difference between zone and value.

std::optional<long> whole(std::string_view text) {
  long value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

/// Numbers separated by blanks; a piece that is not a number counts as NaN.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> out;
  constexpr std::string_view kBlanks = " \t\r\n";
  for (std::size_t from = text.find_first_not_of(kBlanks); from != std::string_view::npos;) {
    const std::size_t to = std::min(text.find_first_of(kBlanks, from), text.size());
    double value = std::nan("");
    (void)std::from_chars(text.data() + from, text.data() + to, value);
    out.push_back(value);
    from = text.find_first_not_of(kBlanks, to);
  }
  return out;
}

/// Required end of the name of a reference's target; empty: not a reference.
std::string_view stem_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kStems = {
      {{"FeatureDefinitionId", "FeatureDefinition"},
       {"FeatureNominalId", "FeatureNominal"},
       {"FeatureItemId", "FeatureItem"},
       {"FeatureMeasurementId", "FeatureMeasurement"},
       {"CharacteristicDefinitionId", "CharacteristicDefinition"},
       {"CharacteristicNominalId", "CharacteristicNominal"},
       {"CharacteristicItemId", "CharacteristicItem"},
       {"DatumDefinitionId", "DatumDefinition"},
       {"DatumReferenceFrameId", "DatumReferenceFrame"},
       {"PointSetId", "PointSet"},
       {"SoftwareId", "Software"},
       {"InspectionProgramExecutionSoftware", "Software"},
       {"AnalysisSoftware", "Software"},
       {"StandardId", "Standard"},
       {"SubstituteFeatureAlgorithmId", "Algorithm"},
       {"MeasurementDeviceId", "CMM"}}};
  if (name.ends_with("Ids")) name.remove_suffix(1);
  for (const auto& [reference, stem] : kStems) {
    if (name.ends_with(reference)) return stem;
  }
  return {};
}

class Check {
 public:
  std::vector<std::string> run(const pugi::xml_node& root) {
    collect(root);
    if (const auto highest = whole(root.attribute("idMax").value());
        !highest || (!ids_.empty() && *highest < ids_.rbegin()->first)) {
      tell("idMax is {}, the greatest id {}", root.attribute("idMax").value(),
           ids_.empty() ? 0 : ids_.rbegin()->first);
    }
    walk(root);
    return std::move(faults_);
  }

 private:
  template <class... Values>
  void tell(fmt::format_string<Values...> text, Values&&... values) {
    faults_.push_back(fmt::format(text, std::forward<Values>(values)...));
  }

  void collect(const pugi::xml_node& node) {
    if (const pugi::xml_attribute attribute = node.attribute("id")) {
      const auto id = whole(attribute.value());
      if (!id || *id < 0) {
        tell("<{}> has the id \"{}\", which is no number", node.name(), attribute.value());
      } else if (!ids_.emplace(*id, node).second) {
        tell("id {} stands twice, at <{}> and <{}>", *id, ids_[*id].name(), node.name());
      }
    }
    for (const pugi::xml_node& child : node.children()) collect(child);
  }

  void walk(const pugi::xml_node& node) {
    check_count(node);
    check_reference(node);
    const std::string_view name = node.name();
    if (name.ends_with("PointSet")) check_points(node);
    if (name == "Direction" || name == "Normal") check_directions(node, 1);
    if (node.child("ZoneRadii")) check_radii(node);
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() == pugi::node_element) walk(child);
    }
  }

  void check_count(const pugi::xml_node& node) {
    const pugi::xml_attribute n = node.attribute("n");
    if (!n) return;
    long items = 0;
    for (const pugi::xml_node& child : node.children()) {
      items += child.type() == pugi::node_element ? 1 : 0;
    }
    if (whole(n.value()) != items) {
      tell("<{}> says n = {} and holds {}", node.name(), n.value(), items);
    }
  }

  void check_reference(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    const std::string_view stem = stem_of(name == "Id" ? node.parent().name() : name);
    if (stem.empty() || node.first_child().type() != pugi::node_pcdata) return;
    const auto id = whole(node.text().get());
    const auto target = id ? ids_.find(*id) : ids_.end();
    if (target == ids_.end()) {
      tell("<{}> {} leads nowhere", name, node.text().get());
    } else if (!std::string_view(target->second.name()).ends_with(stem)) {
      tell("<{}> {} leads to a <{}>", name, *id, target->second.name());
    } else if (node.attribute("range")) {
      check_range(node, target->second);
    }
  }

  void check_range(const pugi::xml_node& node, const pugi::xml_node& set) {
    const auto ends = numbers_in(node.attribute("range").value());
    const double count = static_cast<double>(whole(set.attribute("count").value()).value_or(0));
    if (ends.size() == 2 && ends[0] >= 1.0 && ends[0] <= ends[1] && ends[1] <= count) return;
    tell("the range \"{}\" is not within the {} points of the set", node.attribute("range").value(),
         count);
  }

  void check_points(const pugi::xml_node& node) {
    const auto count = static_cast<std::size_t>(whole(node.attribute("count").value()).value_or(0));
    const auto expect = [&](const char* name, std::size_t each) {
      const pugi::xml_node list = node.child(name);
      const std::size_t found = numbers_in(list.text().get()).size();
      if (list && found != count * each) {
        tell("<{}> of {} points holds {} numbers", name, count, found);
      }
    };
    expect("Points", 3);
    expect("Normals", 3);
    expect("Deviations", 1);
    if (const pugi::xml_node normals = node.child("Normals")) check_directions(normals, count);
  }

  void check_directions(const pugi::xml_node& node, std::size_t count) {
    const auto values = numbers_in(node.text().get());
    if (values.size() != 3 * count)
      return tell("<{}> holds {} numbers", node.name(), values.size());
    for (std::size_t i = 0; i < count; ++i) {
      const double length = std::hypot(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
      if (std::abs(length - 1.0) <= kUnit) continue;
      return tell("<{}> {} has the length {:.12g}", node.name(), i + 1, length);
    }
  }

  void check_radii(const pugi::xml_node& node) {
    const pugi::xml_node radii = node.child("ZoneRadii");
    const double width_mm =
        radii.child("MaxRadius").text().as_double() - radii.child("MinRadius").text().as_double();
    const double value_mm = node.child("Value").text().as_double(std::nan(""));
    if (width_mm >= 0.0 && std::abs(width_mm - value_mm) <= kRadii_mm) return;
    tell("<{}>: the zone is {:.12g} wide, the value {:.12g}", node.name(), width_mm, value_mm);
  }

  std::map<long, pugi::xml_node> ids_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> check_qif(std::string_view document) {
  pugi::xml_document xml;
  const auto parsed = xml.load_buffer(document.data(), document.size());
  if (!parsed) {
    return {fmt::format("it is no XML: {} at byte {}", parsed.description(), parsed.offset)};
  }
  const pugi::xml_node root = xml.document_element();
  if (std::string_view(root.name()) != "QIFDocument") return {"it is no QIFDocument"};
  return Check().run(root);
}

}  // namespace rondure::reports
