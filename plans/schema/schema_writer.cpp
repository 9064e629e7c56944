#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "plans/key_spec.h"
#include "plans/plan.h"
#include "plans/schema/internal/plan_table.h"

namespace rondure::plans {
namespace {

using nlohmann::ordered_json;

// Prints limits of integers without ".0".
ordered_json limit(double value, bool whole) {
  return whole ? ordered_json(static_cast<std::int64_t>(value)) : ordered_json(value);
}

ordered_json number_schema(const NumberSpec& spec, bool whole) {
  ordered_json out;
  out["type"] = whole ? "integer" : "number";
  out[spec.above ? "exclusiveMinimum" : "minimum"] = limit(spec.at_least, whole);
  out["maximum"] = limit(spec.at_most, whole);
  return out;
}

ordered_json text_schema(const TextSpec& spec) {
  ordered_json out;
  out["type"] = "string";
  if (!spec.one_of.empty()) {
    out["enum"] = spec.one_of;
    return out;
  }
  if (!spec.empty_allowed) out["minLength"] = 1;
  out["maxLength"] = kMaxTextBytes;
  return out;
}

// Visitor of plan_table.h that writes the schema of one object.
class SchemaWriter {
 public:
  void text(std::string_view key, const std::string& value, const TextSpec& spec) {
    add(key, text_schema(spec), spec.meaning, spec.required);
    if (!spec.required && !value.empty()) property(key)["default"] = value;
  }
  void text(std::string_view key, const std::optional<std::string>&, const TextSpec& spec) {
    add(key, text_schema(spec), spec.meaning, spec.required);
  }
  template <record::Worded Enum>
  void text(std::string_view key, Enum value, const TextSpec& spec) {
    text(key, std::string(name_of(value)), spec_of_words<Enum>(spec));
  }
  template <record::Worded Enum>
  void text(std::string_view key, const std::optional<Enum>&, const TextSpec& spec) {
    text(key, std::optional<std::string>(), spec_of_words<Enum>(spec));
  }
  void texts(std::string_view key, const std::vector<std::string>& values, const TextSpec& spec) {
    ordered_json out = array_of(text_schema(spec));
    if (!spec.empty_allowed) out["minItems"] = 1;
    out["uniqueItems"] = true;
    add(key, std::move(out), spec.meaning, spec.required);
    property(key)["default"] = values;
  }
  void number(std::string_view key, double value, const NumberSpec& spec) {
    add(key, number_schema(spec, false), spec.meaning, spec.required);
    if (value >= spec.at_least) property(key)["default"] = value;  // otherwise there is no default
  }
  void number(std::string_view key, const std::optional<double>&, const NumberSpec& spec) {
    add(key, number_schema(spec, false), spec.meaning, spec.required);
  }
  void numbers(std::string_view key, const std::array<double, 3>& values, const NumberSpec& spec) {
    ordered_json out = array_of(number_schema(spec, false));
    out["minItems"] = 3;
    out["maxItems"] = 3;
    add(key, std::move(out), spec.meaning, spec.required);
    property(key)["default"] = values;
  }
  void numbers(std::string_view key, const std::vector<double>& values, const NumberSpec& spec) {
    ordered_json out = array_of(number_schema(spec, false));
    out["minItems"] = 1;
    out["maxItems"] = kMaxListItems;
    add(key, std::move(out), spec.meaning, spec.required);
    property(key)["default"] = values;
  }
  template <class Whole>
  void whole(std::string_view key, Whole value, const NumberSpec& spec) {
    add(key, number_schema(spec, true), spec.meaning, spec.required);
    if (!spec.required) property(key)["default"] = value;
  }
  void passed_over(std::string_view key, std::string_view meaning) {
    add(key, text_schema({.meaning = {}}), meaning, false);
  }
  void influence(std::string_view key, const record::Influence&, const NumberSpec& spec) {
    record::DeclaredInfluence value;
    ordered_json out;
    out["oneOf"] = ordered_json::array({number_schema(spec, false), schema_of(value, spec)});
    add(key, out, spec.meaning, spec.required);
  }
  template <class T>
  void object(std::string_view key, T& value, const GroupSpec& spec) {
    add(key, schema_of(value), spec.meaning, spec.required);
  }
  template <class T>
  void object(std::string_view key, std::optional<T>&, const GroupSpec& spec) {
    T value;
    object(key, value, spec);
  }
  template <class T>
  void list(std::string_view key, std::vector<T>&, const GroupSpec& spec) {
    T value;
    ordered_json out = array_of(schema_of(value));
    if (!spec.empty_allowed) out["minItems"] = 1;
    out["maxItems"] = kMaxListItems;
    add(key, std::move(out), spec.meaning, spec.required);
  }

  template <class T, class... Spec>
  static ordered_json schema_of(T& value, const Spec&... spec) {
    SchemaWriter writer;
    describe(writer, value, spec...);
    ordered_json out;
    out["type"] = "object";
    out["properties"] = std::move(writer.properties_);
    if (!writer.required_.empty()) out["required"] = writer.required_;
    out["additionalProperties"] = false;
    return out;
  }

 private:
  static ordered_json array_of(ordered_json items) {
    ordered_json out;
    out["type"] = "array";
    out["items"] = std::move(items);
    return out;
  }

  ordered_json& property(std::string_view key) { return properties_[std::string(key)]; }

  void add(std::string_view key, const ordered_json& schema, std::string_view meaning,
           bool required) {
    ordered_json described;
    described["description"] = meaning;
    described.update(schema);
    property(key) = std::move(described);
    if (required) required_.emplace_back(key);
  }

  ordered_json properties_ = ordered_json::object();
  std::vector<std::string> required_;
};

}  // namespace

std::string plan_schema() {
  Plan defaults;
  ordered_json out;
  out["$schema"] = "http://json-schema.org/draft-07/schema#";
  out["title"] = "Rondure inspection plan";
  out["description"] =
      "What to inspect, with what, and what the drawing asks for. The unit of a "
      "number is the suffix of its key.";
  out.update(SchemaWriter::schema_of(defaults));
  return out.dump(2) + "\n";
}

}  // namespace rondure::plans
