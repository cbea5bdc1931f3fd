// What the records of a run's journal may be. Anybody can have written a journal: whoever reads one
// asks here first.
#pragma once

#include <optional>
#include <string>

#include "base/folder.h"
#include "base/rooms.h"
#include "optim/journal.h"
#include "search/problem.h"
#include "search/protocol.h"

namespace papilla::search {

inline constexpr const char* kJournalName = "journal";

// "; it was interrupted: ...": of a folder whose run has not come to its results; "": no run, or
// one that has ended.
std::string unfinished_hint(const Folder& folder);

// That the journal of a study begins with.
std::string journal_key(const StudyProblem& problem);

// What a record asked; nothing where it cannot be a record of this study: another number of
// variables, tasks, objectives, constraints, humidities or limited metrics, or what is no number
// where the run goes on with numbers. Judgements of Stage::Search and answers of the others then
// decode, and have the shape that everybody counts on.
std::optional<TaskRequest> checked_request(const StudyProblem& problem, const SearchProblem& search,
                                           const JournalRecord& record);

}  // namespace papilla::search
