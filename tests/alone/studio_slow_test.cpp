// The studio with searches, in a real browser and killed at any moment. Searches give way to all
// other work: beside other tests they would not end.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "base/files.h"
#include "config/describe.h"
#include "design/design.h"
#include "optim/journal.h"
#include "tests/studio/in_browser.h"
#include "tests/studio/loopback.h"
#include "tests/support/thorough.h"
#include "tests/temporary.h"

namespace papilla::tests::studio_slow_test {
namespace {

namespace fs = std::filesystem;

TEST(SearchesInChromium, TakeAPersonThroughAnHour) { expect_in_browser("hour"); }
TEST(SearchesInChromium, TakeAPersonThroughAnHourByKeysAlone) { expect_in_browser("keys"); }

// A studio in a process of its own, which a test may kill.
class Process {
 public:
  explicit Process(const fs::path& folder) {
    const std::string said = folder / "address";
    fs::remove(said);
    child_ = ::fork();
    if (child_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      const int out = ::open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
      ::dup2(out, 1);
      const std::string in = folder.string();
      const std::string file = in + "/mine.toml";
      ::execl(PAPILLA_PROGRAM, PAPILLA_PROGRAM, "studio", file.c_str(), "--folder", in.c_str(),
              "--no-open", "--quiet", nullptr);
      ::_exit(127);
    }
    for (int i = 0; i < 600; ++i) {
      std::ifstream file(said);
      if (std::string line; std::getline(file, line) && !file.eof()) {
        address_ = line;
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  ~Process() { kill(); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  const std::string& address() const { return address_; }
  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
  }

 private:
  pid_t child_ = -1;
  std::string address_;
};

// Sound records of the newest search's journal.
std::vector<std::string> journal_of(const fs::path& folder) {
  std::vector<std::string> out;
  std::ifstream in(folder / "searches/001/journal", std::ios::binary);
  JournalRecord record;
  for (std::string line; std::getline(in, line);) {
    if (!in.eof() && parse_journal_line(line, record)) out.push_back(line);
  }
  return out;
}

// A number that was answered, and one that was on its way when the studio was killed.
struct Promised {
  int answered = 600, asked = 600;  // nm

  // What is there after a kill: the one or the other, and from now on that.
  void found(double nm, const char* where, int kill) {
    EXPECT_TRUE(std::abs(nm - answered) < 1e-3 || std::abs(nm - asked) < 1e-3)
        << nm << " nm in " << where << " after kill " << kill << ", answered was " << answered
        << ", asked " << asked;
    answered = asked = static_cast<int>(std::lround(nm));
  }
};

double saved_depth(const fs::path& folder) {
  return 1e9 * get_number(read_design(folder / "mine.toml"), "texture.depth");
}
double session_depth(const Place& place) {
  const std::string mark = R"("path":"texture.depth","type":"number","value":")";
  const std::string text = replied(place, place.own("GET", "state")).text;
  const std::size_t at = text.find(mark);
  return at == std::string::npos ? -1 : std::stod(text.substr(at + mark.size()));
}

// Each time a search goes on and designs are changed and saved, until the studio is killed at a
// moment that the seed chooses. PAPILLA_KILLS: how many; PAPILLA_KILLS_FILE: where each is noted.
TEST(KilledStudio, LosesNothingThatItAnswered) {
  const TemporaryFolder folder;
  write_bytes(
      folder.path() / "mine.toml",
      "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n\n[texture]\ndepth = \"600 nm\"\n\n"
      "[environment]\nrelative_humidity = [\"55 %\"]\n");
  const char* wanted = std::getenv("PAPILLA_KILLS");
  const int kills = wanted ? std::atoi(wanted) : cases(4, 8);
  const char* noted = std::getenv("PAPILLA_KILLS_FILE");
  std::string notes =
      "kill,after [ms],changes answered,saves answered,records of the search before\n";
  std::mt19937 random(50);
  Promised design, file;
  std::vector<std::string> journal;
  for (int k = 0; k < kills; ++k) {
    Process studio(folder.path());
    ASSERT_FALSE(studio.address().empty()) << "after kill " << k;
    const Place place(studio.address());
    design.found(session_depth(place), "the session", k);
    file.found(saved_depth(folder.path()), "the file", k);
    const std::vector<std::string> after = journal_of(folder.path());
    ASSERT_GE(after.size(), journal.size());
    EXPECT_TRUE(std::equal(journal.begin(), journal.end(), after.begin())) << "kill " << k;
    const std::string wish =
        R"~({"variables":[{"path":"texture.depth","low":"100 nm","high":"900 nm"}],)~"
        R"~("maximise":["mean(modulation)"],"evaluations":4000})~";
    const Reply search = k == 0 ? replied(place, place.own("POST", "search/start", wish))
                                : replied(place, place.own("POST", "search/resume"));
    EXPECT_EQ(search.status, 200) << search.text;
    // Until the search has found something; where it has found enough, a while is as good.
    const int looks = 4 * static_cast<int>(journal.size()) <= k ? 1200 : 80;
    for (int i = 0; i < looks && journal_of(folder.path()).size() <= journal.size(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const int after_ms = static_cast<int>(random() % 2000);
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(after_ms);
    int changes = 0, saves = 0;
    std::thread killer([&] {
      std::this_thread::sleep_until(end);
      studio.kill();
    });
    for (int i = 0; std::chrono::steady_clock::now() < end; ++i) {
      design.asked = 200 + static_cast<int>(random() % 600);
      const std::string body =
          fmt::format(R"({{"path":"texture.depth","value":"{} nm"}})", design.asked);
      if (replied(place, place.own("POST", "set", body), 5).status != 200) break;
      design.answered = design.asked;
      ++changes;
      if (i % 3 != 0) continue;
      file.asked = design.answered;
      const Reply saved =
          replied(place, place.own("POST", "save", R"({"name":"mine.toml","overwrite":true})"), 5);
      if (saved.status != 200) break;
      file.answered = file.asked;
      ++saves;
    }
    killer.join();
    notes += fmt::format("{},{},{},{},{}\n", k + 1, after_ms, changes, saves, journal.size());
    journal = journal_of(folder.path());
  }
  if (noted) write_bytes(noted, notes);
  EXPECT_GE(4 * static_cast<int>(journal.size()), kills);
}

}  // namespace
}  // namespace papilla::tests::studio_slow_test
