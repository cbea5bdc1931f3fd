// The processes of an MPI job behind an interface (internal to optim): the module papilla_mpi.so
// (optim/modules/mpi.cpp), which is loaded when a launcher started the program as one of several.
#pragma once

#include "base/rooms.h"
#include "optim/worker.h"

namespace papilla::optim {

class Ranks {
 public:
  struct Message {
    int rank = 0;  // who sent it
    Bytes bytes;
  };

  virtual ~Ranks() = default;
  virtual void begin() const = 0;  // once, before all else
  virtual void end() const = 0;    // once, after all else
  virtual int rank() const = 0;    // of this process
  virtual int size() const = 0;    // of the job
  // Of one of two kinds: messages of another kind wait.
  enum class Kind { Request, Answer };
  virtual void send(const Bytes& bytes, int rank, Kind kind) const = 0;
  virtual Message receive(Kind kind) const = 0;  // from whoever sends first; waits
};

// Version of the class above: the module of another build is refused.
constexpr int kRanksInterface = 1;

}  // namespace papilla::optim
