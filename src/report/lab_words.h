// A lab in words: what to measure next and why, what told readings have changed, where it stands.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/lab.h"
#include "metrics/shown.h"

namespace papilla::report {

// What the worth of designs is shown in. It rises with what is wished for: of what is minimised it
// is the negative value, and its sign here is -1.
ShownUnit worth_unit(const LabFile& file);
double worth_sign(const LabFile& file, const Standing& standing);

// Which design, how surely, how much it is better; what the hypotheses weigh; what no member
// explains; how many readings, and whether a new fit is due.
std::string lab_standing_text(Lab& lab);
// The same in a few sentences, with what it was before the last table: a page's line.
std::string lab_summary_text(Lab& lab);
// Why these experiments and no others.
std::string lab_plan_reason(Lab& lab, const PlanRecord& plan);
// The batch as a table, why, what each outcome would change, what it takes, when to stop.
std::string lab_plan_text(Lab& lab, const PlanRecord& plan);
// What came of a file: readings, notes, the decision before and after.
std::string lab_told_text(const Lab& lab, const Told& told);
// All of it, with the history of decisions: lab.md.
std::string lab_page(Lab& lab);

// One JSON object each.
std::string lab_plan_json(Lab& lab, const PlanRecord& plan);
std::string lab_told_json(const Lab& lab, const Told& told);
std::string lab_state_json(Lab& lab);

// Tables to fill in and to give on.
std::string lab_plan_csv(const Lab& lab, const PlanRecord& plan);
// All readings with the columns of `papilla calibrate`.
std::string lab_readings_csv(const Lab& lab);

}  // namespace papilla::report
