// The journal letter by letter: its head, its lines, their sums, and what is said of a file that
// is none or cannot be written.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "optim/journal.h"
#include "tests/optim/journal_at.h"
#include "tests/temporary.h"

namespace papilla::tests::journal_text_test {
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
    journal_at(path, "key", resume);
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
    Journal journal = journal_at(path, "key", false);
    EXPECT_EQ(bytes_of(path), head);
    EXPECT_TRUE(journal.records().empty());
    EXPECT_EQ(journal.lost(), 0);
    journal.append(one);
    journal.append(two);
    EXPECT_EQ(journal.records(), (std::vector<JournalRecord>{one, two}));
  }
  EXPECT_EQ(bytes_of(path), head + journal_line(one) + journal_line(two));
  {
    Journal journal = journal_at(path, "key", true);
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
  const std::string other = path +
                            ": written for another study, seed or version of Papilla, or for its "
                            "maps as they were, which alone goes on with it and "
                            "verifies it; a new run needs another folder";
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
    const Journal journal = journal_at(path, "key", true);
    EXPECT_EQ(journal.records().size(), 1u) << behind;
    EXPECT_EQ(journal.lost(), lost) << behind;
    EXPECT_EQ(bytes_of(path), head + line);
  }
}

// Every byte of a journal flipped in turn: what is cut off stands in a copy, whatever it is.
TEST(JournalText, KeepsACopyBeforeItCutsAnythingOff) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "journal", head = "papilla-journal 2 key\n";
  std::string text = head;
  for (const char* payload : {"1", "2 two", "3\n", "4"}) text += journal_line({"key", payload});
  int copies = 0;
  for (std::size_t at = head.size(); at < text.size(); ++at) {
    for (const int mask : {1, 4, 64}) {
      std::string damaged = text;
      damaged[at] = static_cast<char>(damaged[at] ^ mask);
      write(path, damaged);
      const Journal journal = journal_at(path, "key", true);
      const std::string kept = bytes_of(path);
      ASSERT_TRUE(text.starts_with(kept)) << at;  // sound records alone
      ASSERT_LT(kept.size(), text.size()) << at;
      ASSERT_FALSE(journal.kept_copy().empty()) << at << " of " << damaged;
      ASSERT_EQ(bytes_of(journal.kept_copy()), damaged) << at;
      std::filesystem::remove(journal.kept_copy());
      ++copies;
    }
  }
  EXPECT_EQ(copies, 3 * static_cast<int>(text.size() - head.size()));
}

TEST(JournalText, KeepsOneCopyOfOneDamageAndAnotherOfTheNext) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "journal", head = "papilla-journal 2 key\n";
  for (const auto& [behind, name] :
       {std::pair{"one\n", ".damaged"}, {"two\n", ".damaged.2"}, {"one\n", ".damaged"}}) {
    write(path, head + behind);
    EXPECT_EQ(journal_at(path, "key", true).kept_copy(), path + name);
  }
  write(path, head + "0123456789abcdef torn");
  EXPECT_EQ(journal_at(path, "key", true).kept_copy(), "");
}

// A link, a pipe or a folder in its place is not written to, nor waited for.
TEST(JournalText, OpensRegularFilesAlone) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "journal", other = folder.path() / "other";
  write(other, "mine");
  std::filesystem::create_symlink("other", path);
  EXPECT_EQ(refusal(path, false),
            "cannot write " + path +
                ": is a link, which is not followed here; put what it leads to in its place");
  EXPECT_EQ(bytes_of(other), "mine");
  std::filesystem::remove(path);
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(refusal(path, true), "cannot write " + path + ": it is no regular file");
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  EXPECT_EQ(refusal(path, true), "cannot write " + path + ": Is a directory");
}

// What another process appends, up to where it stands; a damaged record ends it.
TEST(JournalReader, ReadsOnWhereItWas) {
  const TemporaryFolder folder;
  const Folder place(folder.path());
  const std::string path = folder.path() / "journal", head = "papilla-journal 2 key\n";
  JournalReader reader("key");
  EXPECT_TRUE(reader.more(place, "journal").empty());  // no file yet
  const JournalRecord a{"a", "1"}, b{"b", "2"};
  const std::string torn = journal_line(b).substr(0, 20);
  write(path, head.substr(0, 5));
  EXPECT_TRUE(reader.more(place, "journal").empty());
  write(path, head + journal_line(a) + torn);
  EXPECT_EQ(reader.more(place, "journal"), std::vector{a});
  EXPECT_TRUE(reader.more(place, "journal").empty());
  write(path, head + journal_line(a) + journal_line(b) + "damaged\n" + journal_line(a));
  EXPECT_EQ(reader.more(place, "journal"), std::vector{b});
  EXPECT_TRUE(reader.more(place, "journal").empty());
  // As a run that is resumed leaves it.
  write(path, head + journal_line(a) + journal_line(b) + journal_line(a));
  EXPECT_EQ(reader.more(place, "journal"), std::vector{a});
  EXPECT_THROW(JournalReader("other").more(place, "journal"), InputError);
}

TEST(JournalText, WhereNothingCanBeWrittenItSaysSo) {
  // A file that may not grow beyond the head and eight letters: the line is torn and told.
  const std::string path = temporary("full.journal"), head = "papilla-journal 2 key\n";
  std::filesystem::remove(path);
  Journal journal = journal_at(path, "key", false);
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
}  // namespace papilla::tests::journal_text_test
