#include "optim/mpi.h"

#include <cstdlib>
#include <string>

#include "base/error.h"

#ifdef PAPILLA_WITH_MPI
#include <mpi.h>

#include <chrono>
#include <thread>

#include "optim/journal.h"
#endif

namespace papilla {
namespace {

// Open MPI, MPICH and Slurm's launcher, PMIx.
int environment_number(std::initializer_list<const char*> names, int otherwise) {
  for (const char* name : names) {
    if (const char* text = std::getenv(name)) return std::atoi(text);
  }
  return otherwise;
}

int launched_size() { return environment_number({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}, 1); }

}  // namespace

int launched_rank() {
  return environment_number({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"}, 0);
}

#ifdef PAPILLA_WITH_MPI
namespace {

constexpr int kAsk = 1, kAnswer = 2;

// MPI's own waiting keeps a processor busy; evaluations take far longer than this nap.
MPI_Status wait_for_message(int source, int tag) {
  MPI_Status status;
  int there = 0;
  while (true) {
    MPI_Iprobe(source, tag, MPI_COMM_WORLD, &there, &status);
    if (there) return status;
    std::this_thread::sleep_for(std::chrono::microseconds(300));
  }
}

std::string receive_text(const MPI_Status& status) {
  int length = 0;
  MPI_Get_count(&status, MPI_CHAR, &length);
  std::string text(static_cast<std::size_t>(length), '\0');
  MPI_Recv(text.data(), length, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return text;
}

void send_text(const std::string& text, int rank, int tag) {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, rank, tag, MPI_COMM_WORLD);
}

class MpiTeam : public Team {
 public:
  explicit MpiTeam(int ranks) : ranks_(ranks) {}

  std::size_t size() const override { return static_cast<std::size_t>(ranks_ - 1); }

  std::vector<Outcome> evaluate(const std::vector<Point>& points) override {
    std::vector<Outcome> out(points.size());
    std::vector<std::size_t> task(static_cast<std::size_t>(ranks_), 0);
    std::size_t next = 0;
    const auto give = [&](int rank) {
      if (next >= points.size()) return;
      Evaluation request;
      request.unit = points[next];
      send_text(journal_line(request), rank, kAsk);
      task[static_cast<std::size_t>(rank)] = next++;
    };
    for (int rank = 1; rank < ranks_; ++rank) give(rank);
    for (std::size_t done = 0; done < points.size(); ++done) {
      const MPI_Status status = wait_for_message(MPI_ANY_SOURCE, kAnswer);
      std::string line = receive_text(status);
      line.pop_back();
      Evaluation reply;
      if (!parse_journal_line(line, reply)) reply.outcome.reason = "a garbled answer";
      out[task[static_cast<std::size_t>(status.MPI_SOURCE)]] = std::move(reply.outcome);
      give(status.MPI_SOURCE);
    }
    return out;
  }

 private:
  int ranks_;
};

}  // namespace

MpiSession::MpiSession() {
  if (launched_size() <= 1) return;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

MpiSession::~MpiSession() {
  if (!active()) return;
  for (int rank = 1; rank_ == 0 && rank < size_; ++rank) send_text("", rank, kAsk);
  MPI_Finalize();
}

void MpiSession::serve(const Evaluate& evaluate, const WorkerLimits& limits) {
  Worker worker(evaluate, limits);
  while (true) {
    std::string line = receive_text(wait_for_message(0, kAsk));
    if (line.empty()) return;
    line.pop_back();
    Evaluation request, reply;
    if (parse_journal_line(line, request)) {
      worker.send(request.unit);
      reply.outcome = worker.receive();
    } else {
      reply.outcome.reason = "a garbled request";
    }
    send_text(journal_line(reply), 0, kAnswer);
  }
}

std::unique_ptr<Team> MpiSession::team() const { return std::make_unique<MpiTeam>(size_); }

#else

MpiSession::MpiSession() {
  if (launched_size() > 1) {
    throw InputError(
        "started by an MPI launcher, but this papilla was built without MPI: configure with "
        "-DPAPILLA_MPI=ON, or use --jobs on one machine");
  }
}
MpiSession::~MpiSession() = default;
void MpiSession::serve(const Evaluate&, const WorkerLimits&) {}
std::unique_ptr<Team> MpiSession::team() const { return nullptr; }

#endif

}  // namespace papilla
