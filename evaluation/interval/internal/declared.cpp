#include "evaluation/interval/internal/declared.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/units.h"

namespace rondure::evaluation {
namespace {

using core::kMicroradian;

constexpr double kPerMetre = 1e-3;  // 1/mm in 1/m

/// The settings below one key.
class SettingGroup {
 public:
  SettingGroup(const record::RunRecord& record, std::string path)
      : record_(record), path_("uncertainty/" + std::move(path)) {}

  [[nodiscard]] std::optional<double> given(std::string_view key) const {
    return record::number_in(record_.settings, path_ + std::string(key));
  }
  [[nodiscard]] double number(std::string_view key) const { return given(key).value_or(0.0); }
  [[nodiscard]] std::vector<double> numbers(std::string_view key) const {
    return record::numbers_in(record_.settings, path_ + std::string(key));
  }
  /// All words of a key, in order.
  [[nodiscard]] std::vector<std::string> words(std::string_view key) const {
    std::vector<std::string> out;
    for (const record::Setting& setting : record_.settings) {
      if (!setting.number && setting.name == path_ + std::string(key)) out.push_back(setting.text);
    }
    return out;
  }

 private:
  const record::RunRecord& record_;
  std::string path_;
};

bool declares(const record::RunRecord& record, std::string_view group) {
  const auto groups = SettingGroup(record, "").words("declared");
  return std::find(groups.begin(), groups.end(), group) != groups.end();
}

double value_at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : 0.0;
}

std::optional<ProbeInfluences> probe_influences(const record::RunRecord& record,
                                                const FeatureResult& result,
                                                const std::optional<fit::ProbeTip>& probe) {
  if (!declares(record, "probe")) return std::nullopt;
  const SettingGroup said(record, "probe/");
  ProbeInfluences out;
  out.form_limit_mm = said.number("form_limit_um") * core::kMicrometre;
  out.correlation_length_mm = said.number("correlation_length_mm");
  if (const auto repeatability_um = said.given("repeatability_um")) {
    out.repeatability_mm = *repeatability_um * core::kMicrometre;
    out.degrees_of_freedom = said.number("degrees_of_freedom");
  } else if (out.form_limit_mm == 0.0) {  // a limit includes it
    out.repeatability_known = result.repeat_sigma_mm.has_value();
    out.repeatability_mm = result.repeat_sigma_mm.value_or(0.0);
    out.degrees_of_freedom = result.repeat_freedom;
  }
  const auto tip_um = said.given("tip_radius_um");
  out.tip_radius_mm = tip_um ? *tip_um * core::kMicrometre : (probe ? probe->radius_sigma_mm : 0.0);
  const auto orders = said.numbers("lobes/order");
  const auto amplitudes_um = said.numbers("lobes/amplitude_um");
  for (std::size_t i = 0; i < orders.size(); ++i) {
    out.lobes.push_back(
        {static_cast<int>(orders[i]), value_at(amplitudes_um, i) * core::kMicrometre, 0.0});
  }
  return out;
}

/// Fills the curves of one list of error terms; names as in ISO 230-1: "EYX" is the error along y
/// of the x axis, "EAX" its error about x.
void take_curves(const SettingGroup& said, std::string_view first_letter, std::string_view unit,
                 double unit_value, cmm::GeometricErrors& terms) {
  const bool rotation = first_letter == "A";
  const auto names = said.words("error");
  const auto linear = said.numbers(fmt::format("linear_{}_m", unit));
  const auto quadratic = said.numbers(fmt::format("quadratic_{}_m2", unit));
  const auto wave = said.numbers(fmt::format("wave_{}", unit));
  const auto period = said.numbers("wave_period_mm");
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].size() != 3) continue;  // the plan allows nothing else
    const auto component = static_cast<std::size_t>(names[i][1] - first_letter[0]);
    const auto axis = static_cast<std::size_t>(names[i][2] - 'X');
    if (component > 2 || axis > 2) continue;
    cmm::AxisErrors& errors = terms.axes[axis];
    cmm::ErrorCurve& curve = (rotation ? errors.rotation : errors.translation)[component];
    curve.linear_1_mm = value_at(linear, i) * unit_value * kPerMetre;
    curve.quadratic_1_mm2 = value_at(quadratic, i) * unit_value * kPerMetre * kPerMetre;
    curve.wave = value_at(wave, i) * unit_value;
    if (value_at(period, i) > 0.0) curve.period_mm = period[i];
  }
}

std::optional<MachineInfluences> machine_influences(const record::RunRecord& record) {
  if (!declares(record, "machine")) return std::nullopt;
  const SettingGroup said(record, "machine/");
  MachineInfluences out;
  take_curves(SettingGroup(record, "machine/translations/"), "X", "um", core::kMicrometre,
              out.terms);
  take_curves(SettingGroup(record, "machine/rotations/"), "A", "urad", kMicroradian, out.terms);
  out.terms.squareness_xy_rad = said.number("squareness_xy_urad") * kMicroradian;
  out.terms.squareness_xz_rad = said.number("squareness_xz_urad") * kMicroradian;
  out.terms.squareness_yz_rad = said.number("squareness_yz_urad") * kMicroradian;
  out.terms.tip_offset_mm = {said.number("tip_offset_x_mm"), said.number("tip_offset_y_mm"),
                             said.number("tip_offset_z_mm")};
  out.length_limit_mm = said.number("length_limit_um") * core::kMicrometre;
  out.length_limit_slope = said.number("length_limit_um_m") * core::kMicrometre * kPerMetre;
  return out;
}

std::optional<ThermalInfluences> thermal_influences(const record::RunRecord& record,
                                                    const FeatureResult& result) {
  if (!declares(record, "thermal")) return std::nullopt;
  const SettingGroup said(record, "thermal/");
  const record::Feature& feature = result.feature;
  ThermalInfluences out;
  out.temperature_K = feature.number("temperature_uncertainty_K").value_or(0.0);
  // Points of a file have no temperatures to correct by, but drift as the part does.
  out.expansion_1_K =
      feature.number("part_expansion_per_K").value_or(said.number("expansion_per_K"));
  out.expansion_uncertainty_1_K = feature.number("part_expansion_uncertainty_per_K").value_or(0.0);
  if (result.temperatures) out.from_reference_K = result.temperatures->mean_degC - 20.0;
  out.drift_K = said.number("drift_K");
  out.machine_drift_mm = {said.number("machine_drift_x_um") * core::kMicrometre,
                          said.number("machine_drift_y_um") * core::kMicrometre,
                          said.number("machine_drift_z_um") * core::kMicrometre};
  return out;
}

/// "declared in the plan: 2 UPR 1.5 um, 0 UPR of degree 1 0.5 um; only their ratios count".
std::string source_text(const FormSpectrum& spectrum) {
  std::string out = "declared in the plan:";
  for (const FormTerm& term : spectrum.terms) {
    const double amplitude_um = term.amplitude_mm / core::kMicrometre;
    out += out.back() == ':' ? " " : ", ";
    out += term.degree > 0 ? fmt::format("{} UPR of degree {} {:g} um", term.undulations,
                                         term.degree, amplitude_um)
                           : fmt::format("{} UPR {:g} um", term.undulations, amplitude_um);
  }
  return out + (spectrum.absolute ? "; as they are" : "; only their ratios count");
}

std::optional<FormSpectrum> spectrum_of(const record::RunRecord& record) {
  if (!declares(record, "form_spectrum")) return std::nullopt;
  const SettingGroup said(record, "form_spectrum/");
  FormSpectrum out;
  const auto amplitudes = said.words("amplitudes");
  out.absolute = !amplitudes.empty() && amplitudes.front() == "absolute";
  const auto undulations = said.numbers("terms/undulations");
  const auto degrees = said.numbers("terms/degree");
  const auto amplitudes_um = said.numbers("terms/amplitude_um");
  for (std::size_t i = 0; i < undulations.size(); ++i) {
    out.terms.push_back({static_cast<int>(undulations[i]), static_cast<int>(value_at(degrees, i)),
                         value_at(amplitudes_um, i) * core::kMicrometre});
  }
  out.source = source_text(out);
  return out;
}

UncertaintyOptions options_of(const SettingGroup& said) {
  UncertaintyOptions out;
  out.coverage = 0.01 * said.number("coverage_percent");
  out.least_trials = static_cast<int>(said.number("least_trials"));
  out.most_trials = static_cast<int>(said.number("most_trials"));
  out.tolerance_mm = said.number("tolerance_um") * core::kMicrometre;
  out.budget_trials = static_cast<int>(said.number("budget_trials"));
  out.expected_spots = said.given("expected_spots").value_or(out.expected_spots);
  out.seed = static_cast<std::uint64_t>(said.number("seed"));
  return out;
}

}  // namespace

std::optional<FixtureInfluences> fixture_influences(const record::RunRecord& record) {
  if (!declares(record, "fixture")) return std::nullopt;
  const SettingGroup said(record, "fixture/");
  FixtureInfluences out;
  out.angle_rad = said.number("angle_deg") * core::kDegree;
  out.position_mm = said.number("position_um") * core::kMicrometre;
  out.creep_rad = said.number("creep_deg") * core::kDegree;
  return out;
}

std::optional<Declared> declared_for(const record::RunRecord& record, const FeatureResult& result,
                                     const std::optional<fit::ProbeTip>& probe) {
  const SettingGroup said(record, "");
  if (!said.given("coverage_percent")) return std::nullopt;
  Declared out;
  out.influences.probe = probe_influences(record, result, probe);
  out.influences.machine = machine_influences(record);
  out.influences.thermal = thermal_influences(record, result);
  out.influences.fixture = fixture_influences(record);
  out.options = options_of(said);
  out.spectrum = spectrum_of(record);
  return out;
}

}  // namespace rondure::evaluation
