#include "optim/mpi.h"

#include <cstdlib>
#include <string>

#include "base/error.h"

#ifdef PAPILLA_WITH_MPI
#include <mpi.h>

#include <chrono>
#include <thread>
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

Bytes receive_bytes(const MPI_Status& status) {
  int length = 0;
  MPI_Get_count(&status, MPI_CHAR, &length);
  Bytes message(static_cast<std::size_t>(length), '\0');
  MPI_Recv(message.data(), length, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return message;
}

void send_bytes(const Bytes& message, int rank, int tag) {
  MPI_Send(message.data(), static_cast<int>(message.size()), MPI_CHAR, rank, tag, MPI_COMM_WORLD);
}

class MpiTeam : public Team {
 public:
  explicit MpiTeam(int ranks) : ranks_(ranks) {}

  std::size_t size() const override { return static_cast<std::size_t>(ranks_ - 1); }

  std::vector<WorkAnswer> answer(const std::vector<Bytes>& requests) override {
    std::vector<WorkAnswer> out(requests.size());
    std::vector<std::size_t> task(static_cast<std::size_t>(ranks_), 0);
    std::size_t next = 0;
    const auto give = [&](int rank) {
      if (next >= requests.size()) return;
      send_bytes(requests[next], rank, kAsk);
      task[static_cast<std::size_t>(rank)] = next++;
    };
    for (int rank = 1; rank < ranks_; ++rank) give(rank);
    for (std::size_t done = 0; done < requests.size(); ++done) {
      const MPI_Status status = wait_for_message(MPI_ANY_SOURCE, kAnswer);
      out[task[static_cast<std::size_t>(status.MPI_SOURCE)]] = unpack_answer(receive_bytes(status));
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
  for (int rank = 1; rank_ == 0 && rank < size_; ++rank) send_bytes({}, rank, kAsk);
  MPI_Finalize();
}

void MpiSession::serve(const Work& work, const WorkerLimits& limits) {
  Worker worker(work, limits);
  while (true) {
    const Bytes request = receive_bytes(wait_for_message(0, kAsk));
    if (request.empty()) return;  // the end
    worker.send(request);
    send_bytes(pack_answer(worker.receive()), 0, kAnswer);
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
void MpiSession::serve(const Work&, const WorkerLimits&) {}
std::unique_ptr<Team> MpiSession::team() const { return nullptr; }

#endif

}  // namespace papilla
