// Belief: what is not known of a finger and of the model itself, as weighted members. A member is
// values of the finger and choices of the model that the data allow; they are common to all
// designs, so what they do to a design cancels in a difference as far as designs are alike.
// Eq. accuracy.15, Eq. calibration.7-10
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "base/rooms.h"
#include "config/node.h"
#include "scene/finger.h"

namespace papilla::scene {

// Values by path: "skin.rms" of the finger, "model.closure" of the model; "water.scale": all
// volumes.
struct BeliefValue {
  std::string path;
  Node value;  // as a file writes it, with its place there
};

struct BeliefMember {
  double weight = 0;       // of all members 1
  std::string hypothesis;  // name of its choices of the model
  std::vector<BeliefValue> set;
};

struct Belief {
  std::string file;
  std::string made_of;  // a line for people: from which data, how
  // Of the weighted samples behind the members; 0: not stated.
  double samples = 0, effective_samples = 0;
  // Measured friction that it holds, each as reading_text: told again it would count twice.
  std::vector<std::string> readings;
  // Of the finger that the members were found for. Where another finger has another value, a
  // member's number moves it by the same factor; a number that is not here replaces the finger's.
  std::vector<BeliefValue> fitted;
  ModelOptions calibrated_for = Finger{}.calibrated_for;  // of that finger
  std::vector<BeliefMember> members;

  double effective_members() const;  // 1 / sum of the squared weights
};

// A measured friction as a line for people, by which it is known again: to six digits. SI; voltage
// and `on` 0 where nothing is driven, `off` 0 where it was not measured.
std::string reading_text(double load, double relative_humidity, double voltage, double off,
                         double on);

// The members' weights are above 0 and sum to 1. Throws InputError with every mistake and its
// place: keys that the finger or the model has not, values outside of their range, conditions of
// the experiment (load, state) and what describes the fit itself.
Belief read_belief(const std::string& path, const Finger& finger = {});
// The belief that a finger names. Throws InputError as read_belief; and where its members were
// found for other model options than the finger's.
Belief belief_of(const Finger& finger);
// What is wrong with the belief that a finger names, each with its place; empty where nothing is,
// or none is named.
std::vector<Problem> belief_problems(const Finger& finger);
// Reads back to the same belief.
std::string belief_text(const Belief& belief);

// A member in the place of what is thought of a finger and its model.
struct MemberScene {
  Finger finger;
  ModelOptions model;
};
MemberScene with_member(const Belief& belief, const BeliefMember& member, const Finger& finger,
                        const ModelOptions& model);

}  // namespace papilla::scene
