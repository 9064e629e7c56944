#include "reports/history/archive_entry.h"

#include <algorithm>
#include <utility>

#include "core/encodings.h"
#include "core/units.h"
#include "evaluation/analysis.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/results/finding.h"
#include "reports/words/internal/facts.h"
#include "reports/words/internal/messages.h"

namespace rondure::reports {
namespace {

using core::well_formed;

/// "4 x 7 points; worst section; 5 touches per point".
std::string sampling_of(const evaluation::FeatureResult& feature,
                        const record::Characteristic& asked) {
  std::string text = pattern_of(feature);
  if (asked.form == record::Form::kRoundness && feature.layers.size() > 1)
    text += "; worst section";
  if (const std::string repeats = repeats_of(feature); !repeats.empty())
    text.append("; ").append(repeats);
  return text;
}

using CertificateKind = fit::Certificate::Kind;

/// Certificate of the zone or circle of a result; none for least squares, which proves nothing.
template <class Zone, class Enclosing>
CertificateKind certificate_of(record::Reference reference, const Zone& mz, const Enclosing& mc,
                               const Enclosing& mi) {
  switch (reference) {
    case record::Reference::kLeastSquares:
      return CertificateKind::kNone;
    case record::Reference::kMinimumZone:
      return mz ? mz->certificate.kind : CertificateKind::kNone;
    case record::Reference::kMinimumCircumscribed:
      return mc ? mc->certificate.kind : CertificateKind::kNone;
    case record::Reference::kMaximumInscribed:
      return mi ? mi->certificate.kind : CertificateKind::kNone;
  }
  return CertificateKind::kNone;
}

/// The certificate of a result; for sections, the weakest.
CertificateKind certificate_of(const evaluation::FeatureResult& feature,
                               const record::Characteristic& asked) {
  if (asked.form == record::Form::kCylindricity) {
    return certificate_of(asked.reference, feature.mz_cylinder, feature.mc_cylinder,
                          feature.mi_cylinder);
  }
  CertificateKind weakest =
      feature.layers.empty() ? CertificateKind::kNone : CertificateKind::kGlobal;
  for (const evaluation::LayerResult& layer : feature.layers)
    weakest = std::min(weakest, certificate_of(asked.reference, layer.mz, layer.mc, layer.mi));
  return weakest;
}

record::ArchiveResult result_of(const evaluation::FeatureResult& feature,
                                const evaluation::CharacteristicResult& found) {
  const record::Characteristic& asked = found.characteristic;
  record::ArchiveResult out;
  out.feature = well_formed(feature.feature.id);
  out.characteristic = well_formed(asked.id);
  out.symbol = evaluation::symbol_of(asked);
  out.reference = evaluation::reference_of(asked);
  out.filter = feature.analysis ? filter_text(*feature.analysis).english() : "unfiltered";
  if (found.finding) {
    out.filter = found.finding->filter.english();
    if (out.reference.empty()) out.reference = found.finding->reference.english();
  }
  out.sampling =
      feature.analysis ? sampling_text(*feature.analysis).english() : sampling_of(feature, asked);
  // The archive keeps values as they are held: lengths in mm, angles in mrad.
  if (evaluation::unit_of(asked) == core::ValueUnit::kUrad) out.unit = "mrad";
  // A bound is no value: it would enter control limits and capability as one.
  if (found.value && !is_bound(*found.value)) out.value = found.value->quoted_mm();
  out.upper_limit = asked.tolerance_mm;
  out.lower_limit = asked.lower_mm;
  out.verdict = name_of(found.verdict);
  out.certificate =
      fit::name_of(found.finding ? CertificateKind::kNone : certificate_of(feature, asked));
  return out;
}

}  // namespace

record::ArchiveRun archive_entry(const record::RunRecord& record,
                                 const evaluation::Evaluation& evaluation,
                                 std::string journal_sha256) {
  const record::Header& h = record.header;
  record::ArchiveRun run;
  run.head = {.journal_sha256 = std::move(journal_sha256),
              .run_id = well_formed(h.run_id),
              .started_utc = h.started_utc,
              .part_id = well_formed(h.part_id),
              .part_name = well_formed(h.part_name),
              .serial = well_formed(h.serial),
              .operator_name = well_formed(h.operator_name),
              .machine = well_formed(h.machine),
              .fixture = well_formed(h.fixture),
              .simulated = h.simulated,
              .plan_name = well_formed(h.plan_name),
              .plan_revision = well_formed(h.plan_revision),
              .plan_sha256 = h.plan_sha256,
              .version = h.version};
  for (const evaluation::FeatureResult& feature : evaluation.features) {
    for (const evaluation::CharacteristicResult& found : feature.characteristics) {
      run.results.push_back(result_of(feature, found));
    }
  }
  return run;
}

}  // namespace rondure::reports
