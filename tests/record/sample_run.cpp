#include "tests/record/sample_run.h"

#include <array>
#include <bit>
#include <cmath>
#include <sstream>

#include "core/noise.h"
#include "core/numbers.h"
#include "record/journal/message_text.h"
#include "record/tasks/settings.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// Doubles that break careless storage, between random bit patterns.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}

  double real() {
    constexpr std::array<double, 8> kHard = {
        -0.0, 0.0, 3.0, -1e9, 5e-324, 0.1, 900719925.4740993, core::kGreatestNumber};
    if (whole(3) == 0) return kHard[static_cast<std::size_t>(whole(kHard.size()))];
    while (true) {
      const auto value = std::bit_cast<double>(core::splitmix64(state_));
      if (core::is_measurable(value)) return value;
    }
  }
  int whole(std::uint64_t below) { return static_cast<int>(core::splitmix64(state_) % below); }
  Eigen::Vector3d vector() { return {real(), real(), real()}; }
  std::string text() {
    static const std::array<std::string, 6> kTexts = {"",
                                                      "x",
                                                      "it's \"quoted\"; drop table touch; --",
                                                      "Wellenzapfen \xc3\xb8 25 \xe8\xbd\xb4",
                                                      std::string("with\0zero", 9),
                                                      "two\r\nlines"};
    return kTexts[static_cast<std::size_t>(whole(kTexts.size()))];
  }

 private:
  std::uint64_t state_;
};

Header sample_header(Numbers& n) {
  Header h;
  for (std::string* text :
       {&h.run_id, &h.version, &h.processor, &h.started_utc, &h.plan_file, &h.plan_name,
        &h.plan_revision, &h.plan_text, &h.plan_sha256, &h.part_id, &h.part_name, &h.drawing,
        &h.serial, &h.operator_name, &h.machine, &h.fixture, &h.decision_rule}) {
    *text = n.text();
  }
  h.simulated = n.whole(2) == 1;
  h.seed = 0xfedcba9876543210U + static_cast<std::uint64_t>(n.whole(1000));  // above 2^63
  h.temperature_min_degC = n.real();
  h.temperature_max_degC = n.real();
  return h;
}

Indication sample_indication(Numbers& n) {
  Indication out;
  out.size = Indication::Size::kGN;
  if (n.whole(2) == 1) out.rank = Indication::Rank::kSQ;
  for (int i = n.whole(3); i > 0; --i) out.section_layers.push_back(n.real());
  for (int i = n.whole(3); i > 0; --i) out.datum.push_back(n.text());
  if (n.whole(2) == 1) out.from_mm = n.real();
  if (n.whole(2) == 1) out.filter = Indication::Filter::kSpline;
  if (n.whole(2) == 1) out.decision_rule.emplace().zones = n.text();
  return out;
}

Feature sample_feature(Numbers& n) {
  Feature f;
  f.id = n.text();
  f.shape = n.whole(2) == 0 ? Shape::kCylinder : Shape::kCircle;
  f.side = n.whole(2) == 0 ? Side::kOutside : Side::kInside;
  f.nominal_diameter_mm = n.real();
  f.layers = n.whole(10);
  f.points_per_layer = n.whole(100);
  f.strategy = static_cast<Strategy>(n.whole(5));
  for (int i = n.whole(4) + 1; i > 0; --i) f.search_steps_deg.push_back(n.real());
  f.points_file = n.text();
  f.points_sha256 = n.text();
  if (n.whole(2) == 1) f.tip_radius_mm = n.real();
  for (int i = n.whole(3) + 1; i > 0; --i) {
    Characteristic c;
    c.id = n.text();
    c.form = n.whole(2) == 0 ? Form::kCylindricity : Form::kRoundness;
    constexpr std::array kReferences = {Reference::kLeastSquares, Reference::kMinimumZone,
                                        Reference::kMinimumCircumscribed,
                                        Reference::kMaximumInscribed};
    c.reference = kReferences[static_cast<std::size_t>(n.whole(4))];
    if (n.whole(3) > 0) c.tolerance_mm = n.real();
    c.drawing_zone = n.text();
    if (n.whole(3) > 0) c.lower_mm = n.real();
    c.indication = sample_indication(n);
    f.characteristics.push_back(c);
  }
  return f;
}

PoseVisit sample_pose(Numbers& n, int id, int features) {
  PoseVisit pose;
  pose.id = id;
  pose.feature = n.whole(static_cast<std::uint64_t>(features));
  pose.commanded = {n.real(), n.real()};
  pose.reached = {n.real(), n.real()};
  pose.final_cloud = n.whole(2) == 1;
  pose.time_s = n.real();
  return pose;
}

Touch sample_touch(Numbers& n, std::int64_t id) {
  Touch touch;
  touch.id = id;
  touch.purpose = static_cast<Touch::Purpose>(n.whole(3));
  touch.pose = n.whole(5) - 1;
  touch.layer = n.whole(10);
  touch.point = n.whole(100);
  touch.repeat = n.whole(3);
  touch.tip_mm = n.vector();
  touch.approach = n.vector();
  if (n.whole(5) > 0) touch.temperature_degC = n.real();
  touch.time_s = n.real();
  if (n.whole(5) > 0) touch.scale_temperature_degC = n.real();
  return touch;
}

/// What analyses leave: settings, a mask, series longer than a block, hidden truth.
void add_series(std::uint64_t seed, RunRecord& r) {
  Numbers n(seed ^ 0x5e41e5U);
  Feature& feature = r.features.back();
  feature.settings = {{"phi2_deg", n.real(), ""},
                      {"mode", std::nullopt, n.text()},
                      {"steps", n.real(), n.text()},
                      {"steps", n.real(), ""}};
  feature.characteristics.front().form = Form::kHarmonicLimits;
  feature.characteristics.front().harmonic_limits = {{2, n.whole(50), n.real()}, {3, 7, n.real()}};
  const int index = static_cast<int>(r.features.size()) - 1;
  Series data{index, "data", Series::Role::kData, {{"alpha_deg", "deg"}, {"H1_um", "um"}}, {}};
  for (int i = 0; i < 2 * 300; ++i) data.values.push_back(n.real());
  r.series = {data, {index, "profile", Series::Role::kTruth, {{n.text(), ""}}, {n.real(), -0.0}}};
  r.truth_values = {{index, "RONt_um", n.real()}, {0, n.text(), n.real()}};
}

/// Writes values one after the other, doubles by their bits, texts with their length.
class Bits {
 public:
  Bits& operator<<(double value) { return *this << std::bit_cast<std::int64_t>(value); }
  Bits& operator<<(const std::optional<double>& value) {
    return *this << value.has_value() << value.value_or(0.0);
  }
  Bits& operator<<(const std::string& text) {
    out_ << text.size() << ':' << text << ' ';
    return *this;
  }
  template <class Whole>
  requires std::is_integral_v<Whole> Bits& operator<<(Whole value) {
    out_ << value << ' ';
    return *this;
  }
  Bits& operator<<(const Eigen::Vector3d& v) { return *this << v.x() << v.y() << v.z(); }
  Bits& operator<<(const core::Pose& pose) { return *this << pose.alpha_rad << pose.beta_rad; }
  [[nodiscard]] std::string str() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

void add_head(Bits& bits, const RunRecord& r) {
  const Header& h = r.header;
  bits << h.run_id << h.version << h.processor << h.started_utc << h.plan_file << h.plan_name
       << h.plan_revision << h.plan_text << h.plan_sha256 << h.part_id << h.part_name << h.drawing
       << h.serial << h.operator_name << h.machine << h.fixture << h.decision_rule << h.simulated
       << h.seed << h.temperature_min_degC << h.temperature_max_degC << r.ending
       << r.failure.has_value();
  if (r.failure) bits << static_cast<int>(r.failure->code) << r.failure->what << r.failure->where;
  bits << r.artefact.radius_mm << r.artefact.nominal_tip_radius_mm << r.artefact.radius_tolerance_mm
       << r.artefact.form_limit_mm << r.sealed;
}

void add_settings(Bits& bits, const std::vector<Setting>& settings) {
  bits << settings.size();
  for (const Setting& s : settings) {
    bits << s.name << s.number.has_value() << s.number.value_or(0.0) << s.text;
  }
}

void add_feature(Bits& bits, const Feature& f) {
  bits << f.id << static_cast<int>(f.shape) << static_cast<int>(f.side) << f.nominal_diameter_mm
       << f.layers << f.points_per_layer << static_cast<int>(f.strategy)
       << f.search_steps_deg.size();
  for (const double step_deg : f.search_steps_deg) bits << step_deg;
  bits << f.points_file << f.points_sha256 << f.tip_radius_mm.has_value()
       << f.tip_radius_mm.value_or(0.0) << f.characteristics.size();
  for (const Characteristic& c : f.characteristics) {
    bits << c.id << static_cast<int>(c.form) << static_cast<int>(c.reference) << c.tolerance_mm
         << c.lower_mm << c.drawing_zone;
    add_settings(bits, settings_of_task(c.indication));
    for (const HarmonicLimit& l : c.harmonic_limits) bits << l.first << l.last << l.amplitude_mm;
  }
  add_settings(bits, f.settings);
}

}  // namespace

RunRecord sample_run(std::uint64_t seed, int touches) {
  Numbers n(seed);
  RunRecord r;
  r.header = sample_header(n);
  r.artefact = {n.real(), n.real(), n.real(), n.real()};
  const int features = n.whole(3) + 1;
  for (int i = 0; i < features; ++i) r.features.push_back(sample_feature(n));
  for (int id = 0; id < 4; ++id) r.poses.push_back(sample_pose(n, id, features));
  for (int id = 0; id < touches; ++id) r.touches.push_back(sample_touch(n, id));
  const auto message = [&] {
    return core::Message{core::MessageCode::kLevelPoseUnreachable, {n.text()}};
  };
  r.decisions = {{-1, n.real(), message()}, {0, n.real(), message()}};
  r.results = {{"/features/0/mz/deviation_um", n.real()}, {n.text(), n.real()}};
  r.ending = "failed: the probe met nothing";
  if (n.whole(2) == 1) r.failure = core::Error{core::Code::kNoTouch, n.text(), n.text()};
  r.sealed = true;
  add_series(seed, r);
  Numbers m(seed ^ 0x5e771U);
  r.settings = {{"decision_rule/rule", std::nullopt, m.text()},
                {"uncertainty/trials", m.real(), ""},
                {"calibration", m.real(), m.text()}};
  return r;
}

core::Result<void> write_run(const fs::path& directory, const RunRecord& record) {
  auto journal =
      Journal::create(directory, record.header, record.artefact, record.features, record.settings);
  if (!journal) return core::fail(journal.error());
  core::Result<void> done;
  const auto step = [&](const core::Result<void>& next) {
    if (done) done = next;
  };
  for (PoseVisit pose : record.poses) {
    const bool final_cloud = std::exchange(pose.final_cloud, false);
    step(journal->add(pose));
    if (final_cloud) step(journal->mark_final(pose.id));
  }
  const auto half = static_cast<std::ptrdiff_t>(record.touches.size() / 2);
  step(journal->add(std::span(record.touches.begin(), record.touches.begin() + half)));
  for (auto touch = record.touches.begin() + half; touch != record.touches.end(); ++touch) {
    step(journal->add(*touch));
  }
  for (const Decision& decision : record.decisions) step(journal->add(decision));
  step(journal->add(record.series, record.truth_values));
  step(journal->end(record.ending, record.failure ? &*record.failure : nullptr));
  if (record.sealed) step(journal->seal(record.results));
  return done;
}

core::Result<Journal> reopened(const std::filesystem::path& directory) {
  auto held = hold_journal(directory);
  if (!held) return core::fail(held.error());
  return Journal::reopen(directory, *std::move(held));
}

Touch touch_number(std::int64_t id) {
  Touch touch;
  touch.id = id;
  touch.pose = 0;
  touch.point = static_cast<int>(id);
  touch.tip_mm = Eigen::Vector3d(0.1, 0.2, 0.3) * static_cast<double>(id);
  touch.approach = Eigen::Vector3d(0.6, 0.8, 0.0);
  touch.time_s = static_cast<double>(id);
  return touch;
}

std::string every_bit(const RunRecord& record) {
  Bits bits;
  add_head(bits, record);
  add_settings(bits, record.settings);
  bits << record.features.size();
  for (const Feature& feature : record.features) add_feature(bits, feature);
  bits << record.poses.size();
  for (const PoseVisit& p : record.poses) {
    bits << p.id << p.feature << p.commanded << p.reached << p.final_cloud << p.time_s;
  }
  bits << record.touches.size();
  for (const Touch& t : record.touches) {
    bits << t.id << static_cast<int>(t.purpose) << t.pose << t.layer << t.point << t.repeat
         << t.tip_mm << t.approach << t.temperature_degC << t.time_s << t.scale_temperature_degC;
  }
  for (const Decision& d : record.decisions) {
    bits << d.feature << d.time_s << std::string(core::message_name(d.message.code))
         << arguments_json(d.message);
  }
  for (const Series& s : record.series) {
    bits << s.feature << s.name << static_cast<int>(s.role) << s.columns.size() << s.values.size();
    for (const SeriesColumn& c : s.columns) bits << c.name << c.unit;
    for (const double value : s.values) bits << value;
  }
  for (const TruthValue& t : record.truth_values) bits << t.feature << t.name << t.value;
  for (const StoredResult& r : record.results) bits << r.name << r.value;
  return bits.str();
}

std::string measured_bits(RunRecord record) {
  record.header.run_id.clear();
  record.header.started_utc.clear();
  std::erase_if(record.decisions, [](const Decision& d) { return d.feature < 0; });
  return every_bit(record);
}

}  // namespace rondure::record
