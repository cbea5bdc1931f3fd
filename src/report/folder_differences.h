// What a folder of results says otherwise than the same run made again.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"
#include "report/text_difference.h"

namespace papilla::report {

// Of a number that has a receipt: its words and text name it.
struct ReceiptDifference {
  std::string words, text;
  std::string says;  // for people, with the place
};
struct FolderDifferences {
  std::vector<ReceiptDifference> receipts;
  std::vector<std::string> others;
};

// there: as it is found; here: made again; run and summary: of run.json and summary.md with their
// what is behind their numbers. Maps and pictures are judged by their sums alone.
FolderDifferences folder_differences(const Folder& there, const Folder& here,
                                     const nlohmann::ordered_json& run, const std::string& summary);

}  // namespace papilla::report
