#include "optim/mpi.h"

#include <cstdlib>
#include <string>

#include "base/module.h"
#include "optim/ranks.h"

namespace papilla::optim {
namespace {

// Open MPI, MPICH and Slurm's launcher, PMIx.
int environment_number(std::initializer_list<const char*> names, int otherwise) {
  for (const char* name : names) {
    if (const char* text = std::getenv(name)) return std::atoi(text);
  }
  return otherwise;
}

// Of PMIx the environment has the rank alone; Slurm, which launches by it, says how many there are.
int launched_size() {
  const int by_slurm = std::getenv("PMIX_RANK")
                           ? environment_number({"SLURM_STEP_NUM_TASKS", "SLURM_NTASKS"}, 1)
                           : 1;
  return environment_number({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}, by_slurm);
}

class MpiTeam : public Team {
 public:
  MpiTeam(const Ranks& ranks, int size) : ranks_(ranks), size_(size) {}

  std::size_t size() const override { return static_cast<std::size_t>(size_ - 1); }

  std::vector<WorkAnswer> answer(const std::vector<Bytes>& requests,
                                 const std::atomic<bool>* stop) override {
    std::vector<WorkAnswer> out(requests.size());
    std::vector<std::size_t> task(static_cast<std::size_t>(size_), 0);
    std::size_t next = 0;
    const auto give = [&](int rank) {
      if (next >= requests.size() || (stop && *stop)) return;
      ranks_.send(requests[next], rank, Ranks::Kind::Request);
      task[static_cast<std::size_t>(rank)] = next++;
    };
    for (int rank = 1; rank < size_; ++rank) give(rank);
    for (std::size_t done = 0; done < next; ++done) {
      const Ranks::Message message = ranks_.receive(Ranks::Kind::Answer);
      out[task[static_cast<std::size_t>(message.rank)]] = unpack_answer(message.bytes);
      give(message.rank);
    }
    out.resize(next);
    return out;
  }

 private:
  const Ranks& ranks_;
  int size_;
};

}  // namespace

int launched_rank() {
  if (launched_size() <= 1) return 0;
  return environment_number({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"}, 0);
}

MpiSession::MpiSession() {
  if (launched_size() <= 1) return;
  ranks_ = static_cast<const Ranks*>(load_module(
      "mpi", kRanksInterface,
      "work under an MPI launcher (without one, --jobs takes one machine's processors)"));
  ranks_->begin();
  rank_ = ranks_->rank();
  size_ = ranks_->size();
}

MpiSession::~MpiSession() {
  if (!ranks_) return;
  for (int rank = 1; rank_ == 0 && rank < size_; ++rank)
    ranks_->send({}, rank, Ranks::Kind::Request);
  ranks_->end();
}

void MpiSession::serve(const Work& work, const WorkerLimits& limits) {
  Worker worker(work, limits);
  while (true) {
    const Bytes request = ranks_->receive(Ranks::Kind::Request).bytes;
    if (request.empty()) return;  // the end
    worker.send(request);
    ranks_->send(pack_answer(worker.receive()), 0, Ranks::Kind::Answer);
  }
}

std::unique_ptr<Team> MpiSession::team() const { return std::make_unique<MpiTeam>(*ranks_, size_); }

}  // namespace papilla::optim
