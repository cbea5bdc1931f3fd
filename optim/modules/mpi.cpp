// The module papilla_mpi.so (optim/ranks.h).
#include <mpi.h>

#include <chrono>
#include <thread>

#include "optim/ranks.h"

namespace papilla::optim {
namespace {

int tag_of(Ranks::Kind kind) { return kind == Ranks::Kind::Request ? 1 : 2; }

// MPI's own waiting keeps a processor busy; evaluations take far longer than this nap.
MPI_Status wait_for_message(int tag) {
  MPI_Status status;
  int there = 0;
  while (true) {
    MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status);
    if (there) return status;
    std::this_thread::sleep_for(std::chrono::microseconds(300));
  }
}

class MpiRanks final : public Ranks {
 public:
  void begin() const override {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  }
  void end() const override { MPI_Finalize(); }
  int rank() const override {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
  }
  int size() const override {
    int size = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    return size;
  }
  void send(const Bytes& bytes, int rank, Kind kind) const override {
    MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, rank, tag_of(kind),
             MPI_COMM_WORLD);
  }
  Message receive(Kind kind) const override {
    const MPI_Status status = wait_for_message(tag_of(kind));
    int length = 0;
    MPI_Get_count(&status, MPI_CHAR, &length);
    Message message{status.MPI_SOURCE, Bytes(static_cast<std::size_t>(length), '\0')};
    MPI_Recv(message.bytes.data(), length, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG,
             MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return message;
  }
};

}  // namespace
}  // namespace papilla::optim

extern "C" const papilla::optim::Ranks* papilla_mpi(int version) {
  static const papilla::optim::MpiRanks ranks;
  return version == papilla::optim::kRanksInterface ? &ranks : nullptr;
}
