// What an export wrote, for people and for programs.
#pragma once

#include <optional>
#include <string>

#include "base/rooms.h"
#include "fabricate/export.h"
#include "fabricate/verify.h"

namespace papilla::report {

// export_design, and export.json beside its files: sizes, polarity, margins, what the layout is.
Export export_with_record(const Design& design, const ExportOptions& options,
                          const std::string& folder);

// The files, their size, and the judgement where there is one.
std::string export_text(const Export& result, const std::string& folder,
                        const std::optional<Verification>& verification);
// The record, the folder, and the judgement where there is one: schema 1, SI.
std::string export_json(const Design& design, const ExportOptions& options, const Export& result,
                        const std::string& folder, const std::optional<Verification>& verification);

}  // namespace papilla::report
