// Values that are costly to make and never change, kept by key.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

namespace papilla {

// Keeps the values used last: at most `most` of them and, the newest apart, at most `most_weight`
// together. Whether a value comes from here shows in nothing but time and memory. Thread safe; a
// value is made outside the lock, so that threads which miss together make it twice and get the
// first one that is done. A search is linear, from the last used on.
template <class Key, class Value>
class Cache {
 public:
  Cache(std::size_t most, double most_weight) : most_(most), most_weight_(most_weight) {}

  // make(): the value as a shared_ptr<const Value>. weight: in the unit of most_weight.
  template <class Make>
  std::shared_ptr<const Value> get(const Key& key, double weight, const Make& make) {
    if (auto known = find(key)) return known;
    std::shared_ptr<const Value> made = make();
    const std::lock_guard lock(mutex_);
    if (auto known = promote(key)) return known;
    entries_.push_front({key, made, weight});
    weight_ += weight;
    while (entries_.size() > 1 && (entries_.size() > most_ || weight_ > most_weight_)) {
      weight_ -= entries_.back().weight;
      entries_.pop_back();
    }
    return made;
  }

  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    entries_.clear();
    weight_ = 0;
  }

 private:
  struct Entry {
    Key key;
    std::shared_ptr<const Value> value;
    double weight;
  };

  std::shared_ptr<const Value> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    return promote(key);
  }
  // The value, now the first of the list, or null.
  std::shared_ptr<const Value> promote(const Key& key) {
    for (auto it = entries_.begin(); it != entries_.end(); ++it) {
      if (!(it->key == key)) continue;
      entries_.splice(entries_.begin(), entries_, it);
      return entries_.front().value;
    }
    return nullptr;
  }

  std::size_t most_;
  double most_weight_;
  mutable std::mutex mutex_;
  std::list<Entry> entries_;  // last used first
  double weight_ = 0;
};

}  // namespace papilla
