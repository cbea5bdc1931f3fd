// A lab: one folder that holds a decision, the belief behind it, what was measured for it and what
// is to be measured next. The journal is what counts; every other file is made from it again.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"
#include "base/sole_writer.h"
#include "lab/lab_file.h"
#include "lab/matching.h"
#include "lab/member_model.h"
#include "lab/records.h"
#include "lab/response_table.h"
#include "lab/standing.h"
#include "optim/journal.h"

namespace papilla::lab {

inline constexpr const char* kLabFile = "lab.toml";
inline constexpr const char* kJournalFile = "lab.journal";
// Experiments of all candidates: more are no list that anybody measures by.
inline constexpr std::size_t kMostCandidates = 5000;

// What a lab is opened with.
struct Opening {
  LabFile file;                 // designs' files are named below the folder
  std::string belief_text;      // as TOML
  std::vector<Design> designs;  // in the order of the file
  std::optional<RunWorth> worth;
};
// Writes the folder; its journal last, so that what a kill leaves is no lab yet. Throws InputError
// where the folder is a lab already.
void open_lab(const std::string& folder, const Opening& opening);
bool is_lab(const std::string& folder);
// A plan or a reading is in it: one whose first plan failed can be opened anew.
bool has_begun(const std::string& folder);

struct NextOptions {
  std::optional<Aim> aim;  // nothing: the decision where there is one, else hypotheses, parameters
  int count = 10;
  double seconds = 0;             // of work, at most; 0: no limit
  std::string finger = "1", day;  // who will measure and when; "": the date
  std::string date;
};

// What became of a told file.
struct Told {
  TellRecord record;
  int already = 0, empty = 0;  // readings known before; rows not measured yet
  std::string already_of;      // the file and date that had told them
  int fitted = 0;              // readings that the belief was made of
  std::optional<DecisionRecord> before, after;
  // Of a record.
  std::optional<Trace> trace;
  std::optional<Sliding> sliding;
  std::optional<TraceReading> reading;
};

class Lab {
 public:
  // Throws InputError for a folder that is no lab, is damaged, or in which another one works.
  Lab(const std::string& folder, int threads, std::function<void(const std::string&)> note = {});
  Lab(const Lab&) = delete;
  Lab& operator=(const Lab&) = delete;

  const Folder& folder() const { return folder_; }
  const LabFile& file() const { return file_; }
  const Belief& belief() const { return model_->belief(); }
  const std::vector<LabDesign>& designs() const { return designs_; }
  const std::vector<JournalEntry>& entries() const { return entries_; }
  std::vector<PlannedExperiment> planned() const;  // of all plans
  std::vector<FrictionReading> readings() const;   // of all tellings, those replaced left out
  // Of the journal: records that a damage took, and where the damaged one is kept.
  int lost() const { return journal_->lost(); }
  const std::string& kept_copy() const { return journal_->kept_copy(); }
  // Limits of the run's study as the run judged a choice by them, before any reading; none where
  // the lab stands on no run. Known once the lab has a standing.
  const std::vector<RunLimit>& run_limits(std::size_t choice) const;
  // Of the last plan or telling; by the model where there is none.
  const Standing& standing();

  // The batch to measure next; kept in the journal. Throws InputError where nothing can be
  // measured.
  PlanRecord next(const NextOptions& options);
  // A table or a record. Nothing is kept of a file that is refused. `picture`: called with what was
  // told before it is kept, so that no record is kept without its picture.
  Told tell(const std::string& path, const TellOptions& options,
            const std::function<void(const Told&)>& picture);

 private:
  std::vector<Experiment> candidates() const;
  const std::vector<MemberNumbers>& worth();
  void stand();
  DecisionRecord decision(const std::string& date);
  void keep(JournalEntry entry);
  void take_new(const std::vector<FrictionReading>& rows, const TellOptions& options,
                Told& told) const;
  void note_unheld(const std::string& path, TellRecord& record) const;

  Folder folder_;
  SoleWriter sole_;
  LabFile file_;
  std::vector<LabDesign> designs_;
  std::unique_ptr<MemberModel> model_;
  std::unique_ptr<Journal> journal_;
  std::vector<JournalEntry> entries_;
  std::vector<MemberNumbers> worth_;
  std::vector<std::vector<bool>> kept_;
  std::vector<std::vector<RunLimit>> run_limits_;  // of the choices
  std::unique_ptr<ResponseTable> table_;
  std::unique_ptr<Standing> standing_;
};

// "2026-03-01", of today in UTC.
std::string today();

}  // namespace papilla::lab
