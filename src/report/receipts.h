// receipts.json: every number of a run's first screen with what it takes to compute it again.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "report/stated_number.h"
#include "search/run.h"

namespace papilla::report {

inline constexpr const char* kReceiptsName = "receipts.json";

struct Receipt {
  std::string id;  // "r07"
  StatedNumber number;
  std::string text;                 // as it is printed; of a number that tables format: ""
  std::vector<std::string> places;  // "run.json#/recommendation", "summary.md"
  std::string inputs;  // SHA-256 of the study and of the questions that the number rests on
};

struct Receipts {
  std::string version, pick;  // of the program; the rule that chose the best design
  bool finish = false;        // the search was ended by request (--finish)
  std::string study;          // SHA-256 of resolved.toml
  // That the run called its study: resolved.toml does not know it; "": not kept.
  std::string name;
  std::vector<Receipt> list;
};

// run and summary: the texts of run.json and summary.md with what is behind their numbers.
Receipts receipts_of(const ResultFiles& files, const nlohmann::ordered_json& run,
                     const std::string& summary);

std::string receipts_text(const Receipts& receipts);
// Throws InputError for a text that receipts_text has not written; file: for its message.
Receipts read_receipts(const std::string& text, const std::string& file);

}  // namespace papilla::report
