#include "optim/journal.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "tests/optim/journal_at.h"
#include "tests/temporary.h"

namespace papilla::tests::journal_test {
namespace {

class JournalFile : public ::testing::Test {
 protected:
  void SetUp() override { path_ = temporary("journal"); }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string bytes() const {
    std::stringstream out;
    out << std::ifstream(path_, std::ios::binary).rdbuf();
    return out.str();
  }

  std::string path_;
};

JournalRecord record(int i) {
  if (i % 4 == 3) return {"point " + std::to_string(i), "two\nlines\tand \\ a tab\r"};
  return {"point " + std::to_string(i), "0x1.8p+0 " + std::to_string(7 * i)};
}

TEST_F(JournalFile, RecordsAreExact) {
  for (int i = 0; i < 8; ++i) {
    JournalRecord back;
    std::string line = journal_line(record(i));
    line.pop_back();
    EXPECT_EQ(line.find('\n'), std::string::npos);
    ASSERT_TRUE(parse_journal_line(line, back));
    EXPECT_EQ(back, record(i));
    line[20] ^= 1;
    EXPECT_FALSE(parse_journal_line(line, back));
  }
}

TEST_F(JournalFile, ARecordIsSoundOnlyAsItIsWritten) {
  std::string line = journal_line(record(3));
  line.pop_back();
  // Other letters for the same record, summed anew.
  for (const auto& [from, to] : {std::pair("\\n", "\\x"), {"\\r", "\r"}, {"\t", " "}}) {
    std::string body = line.substr(17);
    const std::size_t at = body.find(from);
    ASSERT_NE(at, std::string::npos);
    body.replace(at, std::string(from).size(), to);
    JournalRecord back;
    EXPECT_FALSE(parse_journal_line(text_hash(body) + " " + body, back)) << to;
  }
}

TEST_F(JournalFile, ACutAtAnyByteLosesAtMostTheTornRecord) {
  {
    Journal journal = journal_at(path_, "key", false);
    for (int i = 0; i < 5; ++i) journal.append(record(i));
  }
  const std::string whole = bytes();
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << whole.substr(0, cut);
    std::size_t kept = 0;
    {
      Journal journal = journal_at(path_, "key", true);
      kept = journal.records().size();
      for (std::size_t i = kept; i < 5; ++i) journal.append(record(static_cast<int>(i)));
    }
    ASSERT_EQ(bytes(), whole) << cut;
  }
}

TEST_F(JournalFile, DamagedRecordsAreCountedATornOneIsNot) {
  {
    Journal journal = journal_at(path_, "key", false);
    for (int i = 0; i < 5; ++i) journal.append(record(i));
  }
  std::string text = bytes();
  text.pop_back();  // the trace of a kill
  std::ofstream(path_, std::ios::binary | std::ios::trunc) << text;
  EXPECT_EQ(journal_at(path_, "key", true).lost(), 0);
  text = bytes();  // four records
  std::size_t begin = 0;
  for (int line = 0; line < 2; ++line) begin = text.find('\n', begin) + 1;
  text[begin + 5] = text[begin + 5] == 'x' ? 'y' : 'x';  // in the second
  std::ofstream(path_, std::ios::binary | std::ios::trunc) << text;
  Journal journal = journal_at(path_, "key", true);
  EXPECT_EQ(journal.records().size(), 1u);
  EXPECT_EQ(journal.lost(), 3);
}

TEST_F(JournalFile, AnotherStudyOrAnUnaskedResumeIsRefused) {
  {
    Journal journal = journal_at(path_, "key", false);
    journal.append(record(0));
  }
  EXPECT_THROW(journal_at(path_, "other", true), InputError);
  EXPECT_THROW(journal_at(path_, "key", false), InputError);
}

}  // namespace
}  // namespace papilla::tests::journal_test
