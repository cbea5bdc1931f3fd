// Append-only record of every answer. Resuming replays it: the searcher asks the same points again
// and is answered from the file, so any algorithm continues exactly where a kill -9 stopped it. No
// clock in it: the same seed gives the same bytes.
#pragma once

#include <string>
#include <vector>

namespace papilla {

// What was asked and what came of it: bytes of any kind, best such as a person can read.
struct JournalRecord {
  std::string key, payload;

  bool operator==(const JournalRecord&) const = default;
};

class Journal {
 public:
  // Opens or starts the file. `key` names the problem (a hash of the resolved study); a file of
  // another problem is refused with InputError. A torn last record is cut off. Records are kept
  // only with resume = true; otherwise an existing file is refused.
  Journal(const std::string& path, const std::string& key, bool resume);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::vector<JournalRecord>& records() const { return records_; }
  // Whole lines behind the first damaged record, that one included: they are cut off. A torn last
  // line is the trace of a kill and does not count.
  int lost() const { return lost_; }
  void append(const JournalRecord& record);  // written and flushed to disk on return

 private:
  std::string path_;
  int file_ = -1, lost_ = 0;
  std::vector<JournalRecord> records_;
};

// 16 hexadecimal digits, FNV-1a: to name a problem.
std::string text_hash(const std::string& text);

// One line: a checksum, the key, a tab, the payload; line ends and tabs in them are escaped. A line
// is sound only as it is written, in every letter. Exposed for tests.
std::string journal_line(const JournalRecord& record);
bool parse_journal_line(const std::string& line, JournalRecord& record);

}  // namespace papilla
