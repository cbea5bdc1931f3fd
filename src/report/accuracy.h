// Speed against error as tables, pictures and the page docs/measured/accuracy.md.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "measure/accuracy.h"
#include "measure/coverage.h"
#include "measure/field_accuracy.h"

namespace papilla::report {

std::string accuracy_text(const std::vector<AccuracyRow>& rows);
std::string coverage_text(const std::vector<CoverageRow>& rows);
// provenance: lines that begin with '#'.
std::string accuracy_csv(const std::vector<AccuracyRow>& rows, const std::string& provenance);
std::string coverage_csv(const std::vector<CoverageRow>& rows, const std::string& provenance);
// A table of coverage_csv, without the parts. Throws InputError.
std::vector<CoverageRow> read_coverage(const std::string& path);
// {"schema": 1, "sweeps": [...]} and {"schema": 1, "coverage": [...]}; null never NaN.
std::string accuracy_json(const std::vector<AccuracyRow>& rows);
std::string coverage_json(const std::vector<CoverageRow>& rows);
// Error of one sweep against work, log-log, a line per quantity.
std::string accuracy_svg(const std::vector<AccuracyRow>& rows, const std::string& sweep);
// The page of the tables sweeps.csv, coverage.csv and coverage_tight.csv in a folder. Throws
// InputError.
std::string accuracy_page(const std::string& folder);

// Columns with units in the head, one row each; seconds to two digits.
std::string field_accuracy_csv(const std::vector<FieldAccuracyRow>& rows);

}  // namespace papilla::report
