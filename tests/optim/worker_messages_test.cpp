// What goes over the pipes of workers and what comes of it: messages of any size, failures by
// their letters, teams of any size.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "optim/mpi.h"
#include "optim/worker.h"
#include "tests/temporary.h"

namespace papilla::tests::worker_messages_test {
namespace {

using Reason = WorkFailure::Reason;

TEST(Messages, AnAnswerIsALetterAndItsBytes) {
  const auto packed = [](Reason reason) { return pack_answer({{}, WorkFailure{reason, "why"}}); };
  EXPECT_EQ(pack_answer({"bytes", std::nullopt}), "+bytes");
  EXPECT_EQ(pack_answer({"", std::nullopt}), "+");
  EXPECT_EQ(packed(Reason::Crashed), "cwhy");
  EXPECT_EQ(packed(Reason::TimedOut), "twhy");
  EXPECT_EQ(packed(Reason::OutOfMemory), "mwhy");
  EXPECT_EQ(packed(Reason::Threw), "xwhy");
  for (const char* message : {"+bytes", "+", "cwhy", "twhy", "mwhy", "xwhy"})
    EXPECT_EQ(pack_answer(unpack_answer(message)), message);
  EXPECT_EQ(unpack_answer("").failure, (WorkFailure{Reason::Crashed, "an empty answer"}));
  EXPECT_EQ(unpack_answer("?why").failure, (WorkFailure{Reason::Crashed, "a garbled answer"}));
  EXPECT_EQ(unpack_answer("xone\ntwo\rthree").failure,
            (WorkFailure{Reason::Threw, "one two three"}));
}

// Far more than a pipe holds at a time, there and back, and nothing at all.
TEST(Messages, OfAnySizeArriveAsTheyWere) {
  Worker worker(
      [](const Bytes& request) {
        Bytes out = request;
        for (char& c : out) c = static_cast<char>(c + 1);
        return out + "!";
      },
      {.seconds = 30});
  for (const std::size_t size : {0u, 1u, 65536u, 3000001u}) {
    Bytes request(size, 'a'), expected(size, 'b');
    for (std::size_t k = 0; k < size; k += 1000) request[k] = 'x', expected[k] = 'y';
    worker.send(request);
    const WorkAnswer answer = worker.receive();
    EXPECT_FALSE(answer.failure);
    EXPECT_TRUE(answer.bytes == expected + "!") << size;
  }
}

// A child keeps what it knows from one request to the next; after a crash the next is another.
TEST(Messages, OneChildAnswersUntilItDies) {
  Worker worker(
      [](const Bytes& request) -> Bytes {
        if (request == "crash") std::abort();
        if (request == "odd") throw 7;
        return std::to_string(::getpid());
      },
      {.seconds = 8});
  const auto ask = [&](const Bytes& request) {
    worker.send(request);
    return worker.receive();
  };
  EXPECT_EQ(worker.descriptor(), -1);  // nothing is waited for
  worker.send("who");
  EXPECT_GE(worker.descriptor(), 0);
  EXPECT_GT(worker.seconds_left(), 1);
  EXPECT_LE(worker.seconds_left(), 8);
  const Bytes first = worker.receive().bytes;
  EXPECT_EQ(worker.descriptor(), -1);
  EXPECT_NE(first, std::to_string(::getpid()));
  EXPECT_EQ(ask("who").bytes, first);
  EXPECT_EQ(ask("odd").failure, (WorkFailure{Reason::Threw, "an exception of an unknown kind"}));
  EXPECT_EQ(ask("who").bytes, first);
  EXPECT_EQ(ask("crash").failure, (WorkFailure{Reason::Crashed, "the evaluation crashed"}));
  const Bytes second = ask("who").bytes;
  EXPECT_NE(second, first);
  EXPECT_EQ(worker.receive().failure,
            (WorkFailure{Reason::Crashed, "the evaluation crashed"}));  // nothing was asked
}

// Somebody else's kill is no answer of the work: it is asked once more, of a team too, and what
// crashes again is the work's own.
TEST(Messages, AKilledChildIsAskedOnceMore) {
  const TemporaryFolder folder;
  const auto killed_first = [&](int times) -> Work {
    return [&folder, times](const Bytes& request) -> Bytes {
      for (int k = 0; k < times; ++k) {
        const std::string mark = folder.path() / (request + std::to_string(k));
        const int file = ::open(mark.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
        if (file >= 0) ::kill(::getpid(), SIGKILL);
      }
      return request + "!";
    };
  };
  Worker once(killed_first(1), {.seconds = 30});
  once.send("a");
  EXPECT_EQ(once.receive(), (WorkAnswer{"a!", std::nullopt}));
  Worker twice(killed_first(2), {.seconds = 30});
  twice.send("b");
  EXPECT_EQ(twice.receive().failure, (WorkFailure{Reason::Crashed, "the evaluation crashed"}));
  twice.send("b");
  EXPECT_EQ(twice.receive().bytes, "b!");
  const auto team = make_local_team(2, killed_first(1), {.seconds = 30});
  const std::vector<WorkAnswer> answers = team->answer({"c", "d", "e"});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(answers[i].bytes, std::string(1, "cde"[i]) + "!");
}

TEST(Messages, WorkThatTakesTooLongIsEndedAndTold) {
  Worker worker(
      [](const Bytes&) -> Bytes {
        for (;;) ::pause();
      },
      {.seconds = 0.2});
  worker.send("");
  EXPECT_EQ(worker.receive().failure,
            (WorkFailure{Reason::TimedOut, "took longer than 0 s and was ended"}));
}

// Ctrl-Z and `fg` in a terminal: a run and its workers are stopped and go on.
TEST(Team, ThatWasStoppedByATerminalEndsNoWorkForIt) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::setpgid(0, 0);
    const auto team = make_local_team(2,
                                      [](const Bytes& request) {
                                        std::this_thread::sleep_for(std::chrono::milliseconds(600));
                                        return request;
                                      },
                                      {.seconds = 2});
    const std::vector<WorkAnswer> answers = team->answer({"a", "b", "c"});
    const bool all = answers.size() == 3 && answers[0].bytes == "a" && answers[1].bytes == "b" &&
                     answers[2].bytes == "c";
    ::_exit(all ? 0 : 1);
  }
  ASSERT_GT(child, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  ASSERT_EQ(::kill(-child, SIGSTOP), 0);
  std::this_thread::sleep_for(std::chrono::seconds(3));
  ASSERT_EQ(::kill(-child, SIGCONT), 0);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

// More workers than requests, one for all of them, none asked for: each answer at its place.
TEST(Team, OfAnySizeAnswersInTheOrderOfTheRequests) {
  const Work work = [](const Bytes& request) { return request + request; };
  std::vector<Bytes> requests;
  for (int i = 0; i < 5; ++i) requests.push_back(std::to_string(i));
  for (const auto& [asked, size] : {std::pair{0u, 1u}, {1u, 1u}, {2u, 2u}, {7u, 7u}}) {
    const auto team = make_local_team(asked, work, {.seconds = 30});
    EXPECT_EQ(team->size(), size);
    EXPECT_TRUE(team->answer({}).empty());
    for (int round = 0; round < 2; ++round) {
      const std::vector<WorkAnswer> answers = team->answer(requests);
      ASSERT_EQ(answers.size(), 5u);
      for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(answers[i].bytes, requests[i] + requests[i]);
    }
  }
  const WorkerLimits usual;
  EXPECT_EQ(usual.seconds, 600);
  EXPECT_EQ(usual.bytes, 8.0 * 1024 * 1024 * 1024);
}

// Two of five have been begun when it is stopped: both are answered, none of the others is begun.
TEST(Team, ThatIsStoppedAnswersWhatItHasBegun) {
  const TemporaryFolder folder;
  const auto is_there = [&](const std::string& name) {
    return std::filesystem::exists(folder.path() / name);
  };
  const auto wait_for = [&](const std::string& name) {
    while (!is_there(name)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  };
  const auto team = make_local_team(2,
                                    [&](const Bytes& request) -> Bytes {
                                      std::ofstream(folder.path() / request);
                                      wait_for("go");
                                      return request + "!";
                                    },
                                    {.seconds = 30});
  std::atomic<bool> stop{false};
  std::thread stopping([&] {
    wait_for("0");
    wait_for("1");
    stop = true;
    std::ofstream(folder.path() / "go");
  });
  const std::vector<WorkAnswer> answers = team->answer({"0", "1", "2", "3", "4"}, &stop);
  stopping.join();
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].bytes, "0!");
  EXPECT_EQ(answers[1].bytes, "1!");
  EXPECT_FALSE(is_there("2"));
  EXPECT_TRUE(team->answer({"2"}, &stop).empty());
  EXPECT_EQ(team->answer({"2"}).front().bytes, "2!");
}

// Of PMIx the environment has no number of ranks: a rank whose number nobody says works alone.
TEST(Launcher, OfPmixIsKnownWithTheNumberOfRanksThatSlurmSays) {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", "PMI_SIZE", "PMI_RANK"})
    if (std::getenv(name)) GTEST_SKIP() << "launched by MPI";
  ::setenv("PMIX_RANK", "1", 1);
  EXPECT_EQ(launched_rank(), 0);
  ::setenv("SLURM_STEP_NUM_TASKS", "2", 1);
  EXPECT_EQ(launched_rank(), 1);
  ::unsetenv("PMIX_RANK");
  EXPECT_EQ(launched_rank(), 0);
  ::unsetenv("SLURM_STEP_NUM_TASKS");
}

}  // namespace
}  // namespace papilla::tests::worker_messages_test
