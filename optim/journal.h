// Append-only record of every answer. Resuming replays it: the searcher asks the same points again
// and is answered from the file, so any algorithm continues exactly where a kill -9 stopped it. No
// clock in it: the same seed gives the same bytes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::optim {

// What was asked and what came of it: bytes of any kind, best such as a person can read.
struct JournalRecord {
  std::string key, payload;

  bool operator==(const JournalRecord&) const = default;
};

class Journal {
 public:
  // Opens or starts the file; a link is refused. `key` names the problem (a hash of the resolved
  // study); a file of another problem is refused with InputError. A torn last record is cut off.
  // Records are kept only with resume = true; otherwise an existing file is refused.
  Journal(const Folder& folder, const std::string& name, const std::string& key, bool resume);

  const std::vector<JournalRecord>& records() const { return records_; }
  // Whole lines behind the first damaged record, that one included: they are cut off, and the
  // journal as it was is kept beside it. A torn last line is the trace of a kill and does not
  // count.
  int lost() const { return lost_; }
  const std::string& kept_copy() const { return copy_; }  // its path; empty: nothing was lost
  void append(const JournalRecord& record);               // written and flushed to disk on return

 private:
  void write(std::string_view text) const;

  std::string path_, copy_;
  Handle file_;
  int lost_ = 0;
  std::vector<JournalRecord> records_;
};

// Reads along while another process appends.
class JournalReader {
 public:
  explicit JournalReader(const std::string& key);
  // What was appended since, up to the first damaged record: where a run that is resumed goes on.
  // Throws InputError for the journal of another problem.
  std::vector<JournalRecord> more(const Folder& folder, const std::string& name);

 private:
  std::string header_;
  std::size_t read_ = 0;
};

// 16 hexadecimal digits, FNV-1a: to name a problem.
std::string text_hash(const std::string& text);

// One line: a checksum, the key, a tab, the payload; line ends and tabs in them are escaped. A line
// is sound only as it is written, in every letter. Exposed for tests.
std::string journal_line(const JournalRecord& record);
bool parse_journal_line(const std::string& line, JournalRecord& record);

}  // namespace papilla::optim
