// Work on the ranks of an MPI job: rank 0 searches and writes, the others evaluate. Active
// only when a launcher (mpirun, srun) started the program as one of several.
#pragma once

#include <memory>

#include "base/rooms.h"
#include "optim/worker.h"

namespace papilla::optim {

class Ranks;

// Rank of this process as its launcher names it in the environment, without starting MPI; 0 when
// there is no launcher.
int launched_rank();

// Starts MPI when the program was launched as one of several processes and ends it in the
// destructor; rank 0 then sends the others home. Throws std::runtime_error when launched so but
// built without MPI.
class MpiSession {
 public:
  MpiSession();
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  bool active() const { return size_ > 1; }
  int rank() const { return rank_; }

  // For the other ranks: works on what rank 0 asks, in a worker process, until it ends.
  void serve(const Work& work, const WorkerLimits& limits);
  // For rank 0.
  std::unique_ptr<Team> team() const;

 private:
  const Ranks* ranks_ = nullptr;  // null: alone
  int rank_ = 0, size_ = 1;
};

}  // namespace papilla::optim
