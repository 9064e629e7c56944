#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "record/key_spec.h"
#include "record/tasks/analysis_influences.h"
#include "record/tasks/feature_reference.h"

namespace rondure::record {

/// A set-up of the ball, in the body of A, from the pivot.
struct HeadBallTask {
  std::string id;
  std::array<double, 3> center_mm = {0.0, 0.0, 0.0};
  std::optional<double> l_mm;  ///< With h_mm in place of the centre: (0, H, -L).
  std::optional<double> h_mm;

  [[nodiscard]] std::array<double, 3> place_mm() const {
    return l_mm && h_mm ? std::array<double, 3>{0.0, *h_mm, -*l_mm} : center_mm;
  }
};

struct HeadPoseTask {
  double c_deg = 0.0;
  double a_deg = 0.0;
};

/// Steps and digits of the compensation table.
struct HeadTableTask {
  double c_step_deg = 5.0;
  double a_step_deg = 5.0;
  double resolution_um = 0.0;
  double resolution_urad = 0.0;
};

/// A measurement with the table of an earlier one loaded.
struct HeadRepeatTask {
  FeatureReference with;
};

/// How a feature of the type "five_axis" is measured and evaluated, as plan and journal spell it:
/// the axes C and A of a swivel head. A member initialiser is the default of its key.
struct FiveAxisTask {
  enum class Sense { kAsCounted, kReversed };

  std::string machine_id;
  std::array<double, 3> target_mm = {0.0, 0.0, 0.0};  ///< Place of the nest.
  Sense c_sense = Sense::kAsCounted;
  Sense a_sense = Sense::kAsCounted;
  std::vector<HeadBallTask> balls;
  std::string poses;                   ///< File of stations and verification.
  std::vector<double> c_stations_deg;  ///< Empty with a file of readings.
  std::vector<double> a_stations_deg;
  std::vector<HeadPoseTask> verification;
  std::vector<std::size_t> verification_rows;  ///< Of the file of poses; not in the journal.
  int references = 3;
  double valid_for_days = 180.0;
  HeadTableTask compensation;
  std::optional<HeadInfluencesTask> uncertainty;
  std::optional<HeadRepeatTask> repeat;

  /// An angle as the control counts it, times these, is right-handed.
  [[nodiscard]] double c_sign() const { return c_sense == Sense::kReversed ? -1.0 : 1.0; }
  [[nodiscard]] double a_sign() const { return a_sense == Sense::kReversed ? -1.0 : 1.0; }
};

RONDURE_WORDS(FiveAxisTask::Sense, {kAsCounted, "as-counted"}, {kReversed, "reversed"});

template <class Visitor>
void describe(Visitor& v, HeadBallTask& p) {
  v.text("id", p.id,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Name of the set-up in the report, unique."});
  v.numbers("center_mm", p.center_mm, within(2000.0, "Centre in the body of A, from the pivot."));
  v.number("L_mm", p.l_mm, within(2000.0, "With H_mm, in place of center_mm: (0, H, -L)."));
  v.number("H_mm", p.h_mm, within(2000.0, "With L_mm."));
}

template <class Visitor>
void describe(Visitor& v, HeadPoseTask& p) {
  v.number("c_deg", p.c_deg, required(within(360.0, "C, at least 5 from 0.")));
  v.number("a_deg", p.a_deg, required(within(180.0, "A, at least 5 from 0.")));
}

template <class Visitor>
void describe(Visitor& v, HeadTableTask& p) {
  v.number("c_step_deg", p.c_step_deg, range(0.1, 30.0, "Step of the table of C."));
  v.number("a_step_deg", p.a_step_deg, range(0.1, 30.0, "Step of the table of A."));
  v.number("resolution_um", p.resolution_um,
           range(0.0, 100.0, "Rounding of its shifts; 0: all digits."));
  v.number("resolution_urad", p.resolution_urad, range(0.0, 100.0, "Rounding of its tilts."));
}

template <class Visitor>
void describe(Visitor& v, HeadRepeatTask& p) {
  v.object("with", p.with,
           {.required = true, .meaning = "The earlier five_axis feature whose table is loaded."});
}

template <class Visitor>
void describe(Visitor& v, FiveAxisTask& p) {
  v.text("machine_id", p.machine_id, {.meaning = "The machine, in the head of its table."});
  v.numbers("target_mm", p.target_mm,
            within(10'000.0, "Where the control holds the ball, machine frame."));
  v.text("c_sense", p.c_sense,
         {.meaning = "reversed: the control counts C left-handed about machine z."});
  v.text("a_sense", p.a_sense, {.meaning = "The same of A about x."});
  v.list("balls", p.balls,
         {.required = true,
          .empty_allowed = false,
          .meaning = "At least 3 set-ups, not on one line; better 4. The first is the origin."});
  v.text(
      "poses", p.poses,
      {.meaning = "A csv in place of the stations and of verification: step (C, A, verification), "
                  "c_deg, a_deg."});
  v.numbers("c_stations_deg", p.c_stations_deg,
            within(360.0, "Angles of C with A at 0: a full circle. With a file, those of it."));
  v.numbers("a_stations_deg", p.a_stations_deg, within(180.0, "The same of A with C at 0."));
  v.list("verification", p.verification, {.meaning = "At least 5 poses of both axes."});
  v.whole("references", p.references,
          range(2, 100, "Readings of each ball at C = A = 0: before, between and after."));
  v.number("valid_for_days", p.valid_for_days,
           above(0.0, 36'500.0, "How long the table may be used."));
  v.object("compensation", p.compensation, {.meaning = "The table that leaves the run."});
  v.object("uncertainty", p.uncertainty,
           {.meaning = "Declared influences; an interval needs all three."});
  v.object("repeat", p.repeat, {.meaning = "The table of an earlier feature is loaded."});
}

}  // namespace rondure::record
