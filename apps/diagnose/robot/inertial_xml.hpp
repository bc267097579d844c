// Masses and inertias in the text of a model, where a body's own say nothing: by default they follow from its geoms.
#pragma once

#include <mujoco/mujoco.h>

#include <string>

namespace diagnose_robot {

/// `xml`, a model as MuJoCo writes it, with masses, centres of mass and inertias of all bodies of `m`, whatever their
/// geoms weigh. Bodies have to be those of `m`, in its order.
std::string with_inertials(const std::string& xml, const mjModel* m);

}  // namespace diagnose_robot
