// What pages are told as it happens: the newest message of each topic. A page that is slow misses
// what is out of date, never what counts; one that comes back is told all that is.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::studio {

enum class Topic { Form, Session, Shape, Response, Look, Refinement, Slopes, Search, Lab, Notice };
const char* name_of(Topic topic);  // "session", ...

struct Message {
  Topic topic = Topic::Session;
  std::string text;  // JSON, one line
};

class Events {
 public:
  void tell(Topic topic, std::string text);
  // The messages since `seen`, which is moved on; waits for one at most so long. Empty: none came,
  // or it is closed.
  std::vector<Message> since(std::uint64_t& seen, std::chrono::milliseconds wait);
  void close();  // nobody waits any more
  bool closed() const;

 private:
  struct Newest {
    std::uint64_t number = 0;
    std::string text;
  };
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<Topic, Newest> newest_;
  std::uint64_t count_ = 0;
  bool closed_ = false;
};

}  // namespace papilla::studio
