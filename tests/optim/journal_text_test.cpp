// The journal letter by letter: its head, its lines, their sums, and what is said of a file that
// is none or cannot be written.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "optim/journal.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

std::string bytes_of(const std::string& path) {
  std::stringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

std::string refusal(const std::string& path, bool resume) {
  try {
    Journal(path, "key", resume);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// The vectors of the authors of FNV-1a, 64 bits.
TEST(JournalText, SumsAreFnv1a) {
  EXPECT_EQ(text_hash(""), "cbf29ce484222325");
  EXPECT_EQ(text_hash("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(text_hash("foobar"), "85944171f73967e8");
}

TEST(JournalText, ALineIsItsSumAKeyATabAndAPayload) {
  const JournalRecord record{"k\t1", "a\\b\nc\rd"};
  const std::string body = "k\\t1\ta\\\\b\\nc\\rd";
  EXPECT_EQ(journal_line(record), text_hash(body) + " " + body + "\n");
  JournalRecord back;
  EXPECT_TRUE(parse_journal_line(text_hash(body) + " " + body, back));
  EXPECT_EQ(back, record);
  EXPECT_TRUE(parse_journal_line(text_hash("\t") + " \t", back));  // the least line there is
  EXPECT_EQ(back, JournalRecord{});
}

TEST(JournalText, WhatIsNoLineIsNone) {
  JournalRecord back;
  const auto summed = [](const std::string& body) { return text_hash(body) + " " + body; };
  for (const std::string& line :
       {std::string(), std::string("cbf29ce484222325"), summed(""), summed("no tab"),
        text_hash("k\tp") + "_k\tp", summed("k\tp\\"), summed("k\\\tp"), summed("k\\x\tp"),
        summed("k\tp\\q"), summed("k\tp\tq"), "0" + summed("k\tp").substr(1), summed("k\tp") + " "})
    EXPECT_FALSE(parse_journal_line(line, back)) << line;
}

TEST(JournalText, AFileIsItsHeadAndItsLines) {
  const std::string path = temporary("whole.journal"), head = "papilla-journal 2 key\n";
  std::filesystem::remove(path);
  const JournalRecord one{"a", "1"}, two{"b", "2\n3"};
  {
    Journal journal(path, "key", false);
    EXPECT_EQ(bytes_of(path), head);
    EXPECT_TRUE(journal.records().empty());
    EXPECT_EQ(journal.lost(), 0);
    journal.append(one);
    journal.append(two);
    EXPECT_EQ(journal.records(), (std::vector<JournalRecord>{one, two}));
  }
  EXPECT_EQ(bytes_of(path), head + journal_line(one) + journal_line(two));
  {
    Journal journal(path, "key", true);
    EXPECT_EQ(journal.records(), (std::vector<JournalRecord>{one, two}));
    EXPECT_EQ(journal.lost(), 0);
    EXPECT_EQ(bytes_of(path), head + journal_line(one) + journal_line(two));
    journal.append(one);
  }
  EXPECT_EQ(bytes_of(path), head + journal_line(one) + journal_line(two) + journal_line(one));
}

// A head that is torn is begun anew; one without records needs no resuming; another one is refused.
TEST(JournalText, AHeadAloneIsNoRun) {
  const std::string path = temporary("head.journal"), head = "papilla-journal 2 key\n";
  for (const std::string& before : {std::string(), head.substr(0, 9), head.substr(0, 21), head}) {
    for (const bool resume : {false, true}) {
      write(path, before);
      EXPECT_EQ(refusal(path, resume), "") << before;
      EXPECT_EQ(bytes_of(path), head) << before;
    }
  }
  const std::string other =
      path + ": written for another study, seed or version; use another --out folder";
  for (const std::string& before :
       {std::string("papilla-journal 2 kez\n"), std::string("papilla-journal 1 key\n"),
        std::string("x"), std::string("papilla-journal 2 key2\n"), std::string(500, 'x')}) {
    write(path, before);
    EXPECT_EQ(refusal(path, true), other) << before;
    EXPECT_EQ(bytes_of(path), before);
  }
  write(path, head + journal_line({"a", "1"}));
  EXPECT_EQ(refusal(path, false),
            path +
                ": this folder holds an earlier run; continue it with --resume, or choose "
                "another --out folder");
  EXPECT_EQ(refusal(path, true), "");
  // Of a first record that is torn nothing is kept, and nothing is lost that was whole.
  write(path, head + "0123456789abcdef k\tp");
  EXPECT_EQ(refusal(path, false), "");
  EXPECT_EQ(bytes_of(path), head);
}

TEST(JournalText, LinesBehindADamagedOneAreLost) {
  const std::string path = temporary("lost.journal"), head = "papilla-journal 2 key\n";
  const std::string line = journal_line({"a", "1"});
  for (const auto& [behind, lost] : {std::pair{std::string("damaged\n"), 1},
                                     {"damaged\n" + line, 2},
                                     {"\n" + line + line, 3},
                                     {line.substr(0, 9), 0},
                                     {"damaged\n" + line.substr(0, 9), 1}}) {
    write(path, head + line + behind);
    const Journal journal(path, "key", true);
    EXPECT_EQ(journal.records().size(), 1u) << behind;
    EXPECT_EQ(journal.lost(), lost) << behind;
    EXPECT_EQ(bytes_of(path), head + line);
  }
}

TEST(JournalText, WhereNothingCanBeWrittenItSaysSo) {
  const std::string nowhere = temporary("no such folder") + "/journal";
  EXPECT_EQ(refusal(nowhere, false), "cannot write " + nowhere + ": No such file or directory");
  // A file that may not grow beyond the head and eight letters: the line is torn and told.
  const std::string path = temporary("full.journal"), head = "papilla-journal 2 key\n";
  std::filesystem::remove(path);
  Journal journal(path, "key", false);
  const auto before = ::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small{head.size() + 8, limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  try {
    journal.append({"a", "1"});
  } catch (const InputError& e) {
    message = e.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &limit);
  ::signal(SIGXFSZ, before);
  EXPECT_EQ(message, "cannot write " + path + ": File too large; free some space and use --resume");
  EXPECT_TRUE(journal.records().empty());
  EXPECT_EQ(bytes_of(path), head + journal_line({"a", "1"}).substr(0, 8));
}

}  // namespace
}  // namespace papilla::tests
