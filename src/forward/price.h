// What an evaluation takes on the machine at hand, before it is begun.
#pragma once

#include <functional>
#include <vector>

#include "base/rooms.h"
#include "forward/fidelity.h"
#include "geometry/texture.h"
#include "scene/scene.h"

namespace papilla::forward {

// Processor time [s] that the work takes, which is done on this thread alone.
double work_seconds(const std::function<void()>& work);

// Processor time of one core [s] that `evaluate` takes: two skins at every humidity, a control skin
// and a 3-D field at the first and the last of them are solved and counted as often as the fidelity
// asks. Unlike `Plan::seconds`, which searches plan by and which is the same on every machine, it
// knows how hard this scene is and how fast this machine; `papilla bench --prices` says how well.
// Cost: what it solves, a third of a draft and less of what has more skins.
double measured_seconds(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

// Seconds that each processor of this machine takes, all of them at work, for a second of work as
// plans price it of the first scene: how fast the machine is, what else it does at this moment, how
// hard these scenes are. Of the clock. Cost: .6 s at least.
double machine_pace(const std::vector<Scene>& scenes, const Texture& texture,
                    const Fidelity& fidelity);

}  // namespace papilla::forward
