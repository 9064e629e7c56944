#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "evaluation/results/evaluation.h"

namespace rondure::reports {

struct QifDraft;

/// Adds a last child. Text passes clean(): XML 1.0 forbids most control characters even as
/// entities, which pugixml would write.
pugi::xml_node add(pugi::xml_node parent, const char* name);
pugi::xml_node add(pugi::xml_node parent, const char* name, std::string_view text);
pugi::xml_node add(pugi::xml_node parent, const char* name, int number);

/// Adds a last child with the next id of the document, and returns it with that id.
pugi::xml_node add_numbered(QifDraft& draft, pugi::xml_node parent, const std::string& name);
[[nodiscard]] int id_of(const pugi::xml_node& node);

/// Adds an attribute, its text cleaned in the same manner.
void set(pugi::xml_node node, const char* name, std::string_view text);

/// The document as bytes: declaration, UTF-8, two spaces per level, LF.
[[nodiscard]] std::string bytes_of(const pugi::xml_document& document);

/// Issues the ids of one document: from 1, each once. QIF needs the highest (`idMax`).
class QifIds {
 public:
  [[nodiscard]] int next() { return ++last_; }
  [[nodiscard]] int last() const { return last_; }

 private:
  int last_ = 0;
};

/// The lists of a document, created in the order of the schema and filled in any order.
struct QifLists {
  pugi::xml_node datum_definitions = {};
  pugi::xml_node datum_frames = {};
  pugi::xml_node feature_definitions = {};
  pugi::xml_node feature_nominals = {};
  pugi::xml_node feature_items = {};
  pugi::xml_node characteristic_definitions = {};
  pugi::xml_node characteristic_nominals = {};
  pugi::xml_node characteristic_items = {};
  pugi::xml_node measured_features = {};
  pugi::xml_node point_sets = {};
  pugi::xml_node measured_characteristics = {};
};

/// A datum feature of the document.
struct QifDatum {
  int definition = 0;
  std::size_t feature = 0;  ///< Of the evaluation.
};

/// A document under construction.
struct QifDraft {
  pugi::xml_document document = {};
  QifIds ids = {};
  QifLists lists = {};
  int software = 0;
  std::optional<int> device = {};               ///< None where the points came from a file.
  std::string frame = {};                       ///< Frame of the points of the current feature.
  std::map<std::string, QifDatum> datums = {};  ///< By label.
  std::map<std::string, int> frames = {};       ///< Datum reference frames, by "A-B, C".
};

/// References in the order of record::Reference.
inline constexpr std::size_t kReferences = 4;

/// A surface or circle of the document, and the fits to its points.
struct QifShape {
  record::Shape shape = record::Shape::kCylinder;
  int nominal = 0;
  int item = 0;
  std::array<std::optional<int>, kReferences> measured = {};
};

/// The shapes of one feature of the plan; none for an analysis of series.
struct QifFeature {
  std::optional<QifShape> whole = {};
  std::vector<QifShape> sections = {};  ///< For a cylinder: one circle per layer.
};

/// Writes definition, nominal, item, point set and measurements of one feature.
[[nodiscard]] QifFeature add_qif_feature(QifDraft& draft, const evaluation::FeatureResult& feature);

/// Writes definition, nominal, item and measurement of each characteristic of a feature.
void add_qif_characteristics(QifDraft& draft, const QifFeature& places,
                             const evaluation::FeatureResult& feature);

/// The words of QIF for a verdict.
struct QifStatus {
  const char* of_characteristic;
  const char* of_part;
};
[[nodiscard]] QifStatus status_of(evaluation::Verdict verdict);

/// A list with `n`, which finish_lists() sets.
pugi::xml_node add_list(pugi::xml_node parent, const char* name);
/// Sets `n` of all lists below a node and removes empty ones, which QIF does not allow.
void finish_lists(pugi::xml_node node);

/// "x y z" in the shortest text that reads back to the same doubles.
[[nodiscard]] std::string text_of(const Eigen::Vector3d& v);
/// A list of references: <name n="2"><Id>4</Id><Id>9</Id></name>; nothing without ids.
void add_references(pugi::xml_node parent, const char* name, const std::vector<int>& ids);
/// <SubstituteFeatureAlgorithm> of a reference.
void add_algorithm(pugi::xml_node parent, record::Reference reference);
/// <Attributes> with texts; empty texts are omitted.
void add_attributes(pugi::xml_node parent,
                    const std::vector<std::pair<const char*, std::string>>& texts);

/// Checks what the QIF schema does not: ids are unique and not above `idMax`; each reference
/// (elements ...Id, lists ...Ids, ranges of points) refers to an element of its kind; `n` counts
/// its items; point sets hold three numbers for each point and normal; directions have length 1
/// (within 1e-9); the two zone radii differ by the value (within 1e-9 mm).
///
/// @param document  A QIF 3.0 document as XML. Needs no schema and no file.
/// @return  One sentence for each fault; none for a valid document. Time and memory O(bytes).
[[nodiscard]] std::vector<std::string> check_qif(std::string_view document);

}  // namespace rondure::reports
