#include "studio/events.h"

#include <utility>

namespace papilla::studio {

const char* name_of(Topic topic) {
  switch (topic) {
    case Topic::Form:
      return "form";
    case Topic::Session:
      return "session";
    case Topic::Shape:
      return "shape";
    case Topic::Response:
      return "response";
    case Topic::Look:
      return "look";
    case Topic::Refinement:
      return "refinement";
    case Topic::Slopes:
      return "slopes";
    case Topic::Search:
      return "search";
    case Topic::Lab:
      return "lab";
    case Topic::Notice:
      return "notice";
  }
  return "";
}

void Events::tell(Topic topic, std::string text) {
  {
    const std::lock_guard lock(mutex_);
    newest_[topic] = {++count_, std::move(text)};
  }
  changed_.notify_all();
}

std::vector<Message> Events::since(std::uint64_t& seen, std::chrono::milliseconds wait) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, wait, [&] { return closed_ || count_ > seen; });
  std::vector<Message> out;
  if (closed_) return out;
  // As they were told: a curve is not kept waiting by a picture that was made after it.
  std::map<std::uint64_t, Message> in_order;
  for (const auto& [topic, newest] : newest_) {
    if (newest.number > seen) in_order[newest.number] = {topic, newest.text};
  }
  for (auto& [number, message] : in_order) out.push_back(std::move(message));
  seen = count_;
  return out;
}

void Events::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

bool Events::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

}  // namespace papilla::studio
