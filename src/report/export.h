// What an export wrote, for people and for programs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/rooms.h"
#include "fabricate/export.h"
#include "fabricate/verify.h"

namespace papilla::report {

// export_design, and export.json beside its files: sizes, polarity, margins, what the layout is,
// and what they were made from. beside: files of other makers in the folder that the record names
// too. warnings: known of the design before, for the record and who reads the result.
Export export_with_record(const Study& study, const ExportOptions& options,
                          const std::string& folder, const FileProgress& progress = {},
                          const std::vector<ExportedFile>& beside = {},
                          const std::vector<std::string>& warnings = {});

// What is known of the files of an export once they are written.
struct ExportVerdict {
  std::vector<FileVerdict> files;    // each against the design
  std::optional<Verification> felt;  // where it was asked for

  bool sound() const;
  bool readable() const;  // as far as they are there
};

// The files, their size, and the judgement of what is felt where there is one.
std::string export_text(const Export& result, const std::string& folder,
                        const ExportVerdict& verdict);
// The record, the folder and the verdict: schema 1, SI.
std::string export_json(const Study& study, const ExportOptions& options, const Export& result,
                        const std::string& folder, const ExportVerdict& verdict);

// One line a fault: "heightmap.gsf: its depth is ...".
std::vector<std::string> fault_lines(const ExportVerdict& verdict);
// A line a file, and what is felt.
std::string verdict_text(const ExportVerdict& verdict);
// Of one or several folders.
std::string verdict_json(const std::vector<std::pair<std::string, ExportVerdict>>& folders);

}  // namespace papilla::report
