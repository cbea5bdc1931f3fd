// The model of one finger, asked for numbers that papers have published: on which skins it answers,
// and the runs that several numbers share.
#pragma once

#include <any>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "forward/fidelity.h"
#include "scene/finger.h"

namespace papilla {

// Where the skins come from: by default 40 that no fit has seen.
struct SkinSampling {
  std::string level = "design";  // of accuracy
  int skins = 40, first_skin = 5000;
  int grid = 0;  // pixels along a patch; 0: the level's

  Fidelity fidelity(int threads) const;
};

class FingerModel {
 public:
  FingerModel(Finger finger, Preset preset, int threads, SkinSampling sampling = {})
      : finger_(std::move(finger)),
        preset_(preset),
        threads_(threads),
        sampling_(std::move(sampling)) {}

  const Finger& finger() const { return finger_; }
  Preset preset() const { return preset_; }
  const SkinSampling& sampling() const { return sampling_; }
  Fidelity fidelity() const { return sampling_.fidelity(threads_); }

  // The value made by `make` at the first call with this key.
  template <class T>
  const T& once(const std::string& key, const std::function<T()>& make) {
    auto found = shared_.find(key);
    if (found == shared_.end()) found = shared_.emplace(key, make()).first;
    return std::any_cast<const T&>(found->second);
  }

 private:
  Finger finger_;
  Preset preset_;
  int threads_;  // 0: all
  SkinSampling sampling_;
  std::map<std::string, std::any> shared_;
};

}  // namespace papilla
